//! Turns a panic in a model's stage into a failure of that model, without a word on stderr.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    /// How many guards this thread is inside: the panic hook is silent only there.
    static DEPTH: Cell<u32> = const { Cell::new(0) };
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

static HOOK: Once = Once::new();

/// Runs `work`; a panic comes back as its message and the line of code it came from.
///
/// # Errors
/// What the panic said.
pub(crate) fn catch<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    HOOK.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if DEPTH.get() == 0 {
                previous(info);
            } else {
                // The file's name alone: the rest of the path names the machine it was built on.
                PLACE.set(info.location().map(|at| {
                    format!("{}:{}", at.file().rsplit(['/', '\\']).next().unwrap_or_default(), at.line())
                }));
            }
        }));
    });
    DEPTH.set(DEPTH.get() + 1);
    let outcome = panic::catch_unwind(AssertUnwindSafe(work));
    DEPTH.set(DEPTH.get() - 1);
    outcome.map_err(|payload| {
        let place = PLACE.take().map(|place| format!(" ({place})")).unwrap_or_default();
        format!("{}{place}", message(payload.as_ref()))
    })
}

fn message(payload: &(dyn Any + Send)) -> &str {
    payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_comes_back_with_its_message_and_its_line() {
        let caught = catch(|| -> u32 { panic!("corner {} is missing", 7) });
        let text = caught.expect_err("it panicked");
        assert!(text.starts_with("corner 7 is missing (guard.rs:"), "{text}");
        assert_eq!(catch(|| 5), Ok(5));
    }
}
