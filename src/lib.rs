//! Gives every model in a 3D database its physics.
//!
//! ```text
//! files ─▶ importer ─▶ catalogue (SQLite) ─▶ mapper ─▶ Scene ─▶ sim ─▶ Frame ─▶ viewer (rerun)
//!                                                                        └▶ validate (rapier)
//! ```
//!
//! This package is the ends of the pipe and the glue: the command line ([`cli`]), the flow over a folder of models
//! ([`pipeline`]), one scene ([`simulate`]), how bodies come to rest ([`settle`]), the comparison with rapier
//! ([`validate`]), how fast and how wrong both are on scenes with a known truth ([`mod@bench`]), what is told at the end
//! ([`report`]), the gate of a team's mapping ([`check`]), and a model database made by code ([`demo`]).
//!
//! SI units, right-handed, Y up, quaternions `x, y, z, w`.

#![forbid(unsafe_code)]

pub mod bench;
pub mod check;
pub mod cli;
pub mod demo;
pub mod pipeline;
pub mod report;
pub mod settle;
pub mod simulate;
pub mod validate;
