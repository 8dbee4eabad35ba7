//! What happens next? A rigid-body solver that knows no file, no clock, no randomness and no log.
//!
//! [`Scene`] → [`World::new`] → [`World::step`] → [`Frame`] → any number of [`FrameSink`]s.
//!
//! SI units, right-handed, Y up, quaternions `x, y, z, w`. State is f64. The same scene and settings give the
//! same bits, in debug and release: no fused multiply-add, no transcendental function of the platform, no order
//! that depends on a hash. Golden hashes hold it on x86-64; for other processors parry's convex hulls are not proven.
//!
//! A step: actions; pairs whose bounds overlap; manifolds of those pairs, matched with the step before; then small
//! steps, each of impacts at their time, forces, soft contacts with Coulomb friction, motion, and a relaxation
//! that takes out the speed which pushing overlaps apart has put in; at the end sleep. Between contacts a body
//! moves exactly: on a parabola, with its angular momentum kept.

mod body;
mod collide;
mod error;
mod flight;
mod frame;
pub mod gallery;
mod height_field;
mod island;
mod material;
mod math;
pub mod measure;
pub mod mechanics;
mod output;
mod phase;
mod plan;

mod probe;
mod rotation;
mod run;
mod saved;
mod scene;
mod settings;
mod shape;
mod sleep;
mod solve;
mod step;
mod work;
mod world;

pub use error::SceneError;
pub use frame::{
    ContactBlock, ContactPoint, Event, FRAME_VERSION, FluidBlock, Frame, FrameSink, Metrics, RigidBlock,
    SleepState, SoftBlock,
};
pub use height_field::HeightField;
pub use material::{MaterialPair, Meeting, pair_friction, pair_restitution, pair_rolling_resistance};
pub use phase::{Observer, Phase};
pub use plan::{Aspect, Choice, Plan};
pub use probe::Probe;
pub use run::{RunLimit, RunReport, run, run_observed};
pub use saved::SavedState;
pub use scene::{Action, Change, ChildShape, Entity, Mass, Motion, Pose, Scene, Shape, Surface, Velocity};
pub use settings::{Precision, Settings};
pub use step::StepReport;
pub use work::Work;
pub use world::World;
