//! What does rapier make of the same scene? The only crate that names rapier3d.
//!
//! Same shapes, mass properties, combine rules, gravity and step. The program of this crate runs scenes for another
//! process ([`wire`]): rapier's build with eight lanes cannot be linked into one that has four.

#![forbid(unsafe_code)]

mod convert;
pub mod wire;
mod world;

pub use world::{Baseline, Defaults, LARGEST_LENGTH_UNIT_M, Touch, length_unit_m};

/// rapier's version, and its lanes.
#[must_use]
pub fn version() -> String {
    format!("{}{}", rapier3d::VERSION, if cfg!(feature = "simd8") { " simd8" } else { "" })
}
