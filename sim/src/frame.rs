//! The output of a simulation: the state after a step, pushed to sinks as borrowed slices.

use crate::scene::{Pose, Scene, Velocity};
use crate::settings::Settings;

/// Version of the frame's meaning. A new optional block is no new version; a changed one is.
pub const FRAME_VERSION: u32 = 1;

/// The paper's three states of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum SleepState {
    Active,
    /// Slow enough, waiting for its island.
    Drowsy,
    Asleep,
}

/// Rigid bodies, one entry an entity of the scene, in its order.
#[derive(Clone, Copy, Debug)]
pub struct RigidBlock<'a> {
    /// World from body.
    pub poses: &'a [Pose],
    pub velocities: &'a [Velocity],
    pub sleep: &'a [SleepState],
}

/// Soft bodies: vertices of all, body `i` owning `offsets[i]..offsets[i + 1]`.
#[derive(Clone, Copy, Debug)]
pub struct SoftBlock<'a> {
    pub offsets: &'a [u32],
    /// m, world
    pub vertices: &'a [[f32; 3]],
}

/// Fluid particles with ids that stay with a particle for its life.
#[derive(Clone, Copy, Debug)]
pub struct FluidBlock<'a> {
    pub ids: &'a [u64],
    /// m, world
    pub positions: &'a [[f32; 3]],
    pub born: &'a [u64],
    pub died: &'a [u64],
}

/// One point of a contact manifold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Entities in the scene; `normal` points from `a` to `b`.
    pub a: u32,
    pub b: u32,
    /// m, world, midway between the surfaces
    pub position: [f64; 3],
    pub normal: [f64; 3],
    /// m, positive where the surfaces overlap
    pub depth_m: f64,
    /// N s, over the whole step
    pub normal_impulse_n_s: f64,
    /// N s, of friction on `b` over the whole step, world
    pub friction_impulse_n_s: [f64; 3],
}

/// Touching contact points.
#[derive(Clone, Copy, Debug)]
pub struct ContactBlock<'a> {
    pub points: &'a [ContactPoint],
}

/// Something that happened in a step, in a fixed order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    FellAsleep {
        entity: u32,
    },
    WokeUp {
        entity: u32,
    },
    /// A bounce, resolved at its time.
    Impact {
        a: u32,
        b: u32,
        speed_m_s: f64,
    },
    /// Two bodies have come to overlap by more than a quarter of the smaller's inner radius: a pose that cannot be, or
    /// one that contacts could not prevent.
    Overlap {
        a: u32,
        b: u32,
        depth_m: f64,
    },
    /// Non-finite state: put back to its last good pose, stopped and left out from here on.
    Quarantined {
        entity: u32,
    },
    /// Action `index` of the scene took effect.
    Acted {
        index: u32,
    },
}

/// Quantities of the whole scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metrics {
    /// J
    pub kinetic_j: f64,
    /// J, gravity's, zero at the world's origin
    pub potential_j: f64,
    /// m, deepest overlap of any contact point
    pub max_penetration_m: f64,
    pub contacts: u32,
    pub awake: u32,
}

/// The state after a step. Step 0 is the start.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    pub version: u32,
    pub step: u64,
    pub time_s: f64,
    pub rigid: Option<RigidBlock<'a>>,
    pub soft: Option<SoftBlock<'a>>,
    pub fluid: Option<FluidBlock<'a>>,
    pub contacts: Option<ContactBlock<'a>>,
    pub events: &'a [Event],
    pub metrics: Metrics,
}

/// Takes frames as they come. Called from the thread that steps, so a slow sink hands its work on.
pub trait FrameSink {
    /// Once, before the first frame.
    fn begin(&mut self, scene: &Scene, settings: &Settings);
    /// After every step; nothing borrowed may be kept.
    fn frame(&mut self, frame: &Frame<'_>);
    /// Once, after the last frame, also when the run was cut short.
    fn end(&mut self);
}
