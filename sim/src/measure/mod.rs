//! One ruler in double precision, for any engine: what a state is, from the scene and its poses alone.
//!
//! Nothing here is used by the step, and nothing that an engine says of itself is used here: a solver that
//! misjudges its own contacts is not believed.

mod depth;
mod distance;
mod polyhedron;
mod posed;
mod round;
mod support;
mod terrain;

pub use depth::{Depths, Overlap};
pub(crate) use polyhedron::hull_moments;
pub use support::{
    Momentum, Plane, body_support, cross, dot, energy, extents, length, mass_of, moment_about, momentum,
    reach, rotate, rotate_back, support, transform,
};
