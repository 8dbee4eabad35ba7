//! The hard set: scenes on which engines are known to fail, each with the figure that says by how far. The
//! numbers H1 to H21 are those of the reports; H10 and H16 need joints.

mod contact;
mod degenerate;
mod far;
mod friction;
mod impact;
mod stack;
mod top;

use super::criterion::Criterion;
use super::{Exhibit, Group};
use crate::scene::Scene;

pub(super) const EXHIBITS: [&[Exhibit]; 7] = [
    stack::EXHIBITS,
    friction::EXHIBITS,
    impact::EXHIBITS,
    contact::EXHIBITS,
    far::EXHIBITS,
    top::EXHIBITS,
    degenerate::EXHIBITS,
];

const fn hard(
    name: &'static str,
    about: &'static str,
    duration_s: f64,
    scene: fn() -> Scene,
    criteria: &'static [Criterion],
) -> Exhibit {
    Exhibit { name, about, group: Group::Hard, duration_s, scene, criteria }
}
