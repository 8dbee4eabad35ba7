//! A step that has seen its scene takes no memory from the heap.

#![allow(
    unsafe_code,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "an allocator is unsafe by its trait; a test may stop and say so"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use sim::{Settings, World, gallery};

/// The system's allocator, counting.
struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);
static HELD_BYTES: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        HELD_BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD_BYTES.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// One test, for the counters are the process's.
#[test]
fn a_warm_step_takes_no_memory() {
    // A standing pile that is swept, a tower that is solved directly, a heap with impacts.
    for (name, warm_s, seconds) in [("seed-10", 1.0, 0.5), ("stack-20", 1.0, 1.0), ("seed-9", 3.0, 1.0)] {
        let exhibit = gallery::by_name(name).expect(name);
        let settings = Settings { sleeping: false, ..Settings::default() };
        let before = HELD_BYTES.load(Ordering::Relaxed);
        let scene = (exhibit.scene)();
        let mut world = World::new(&scene, &settings).unwrap();
        let go = |world: &mut World, until: f64| {
            while world.time_s() < until - 1e-9 {
                world.step();
            }
        };
        go(&mut world, warm_s);
        let held = HELD_BYTES.load(Ordering::Relaxed) - before;
        let points = world.frame().contacts.unwrap().points.len();
        println!("{name}: {} bodies, {points} points, {held} bytes", scene.entities.len());
        let start = ALLOCATIONS.load(Ordering::Relaxed);
        go(&mut world, warm_s + seconds);
        let taken = ALLOCATIONS.load(Ordering::Relaxed) - start;
        assert_eq!(taken, 0, "allocations of {name} from {warm_s} to {} s", warm_s + seconds);
    }
}
