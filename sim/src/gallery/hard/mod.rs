//! The hard set: scenes on which engines are known to fail, each with the figure that says by how far. The
//! numbers H1 to H21 are those of the reports; H10 and H16 need joints.

mod contact;
mod degenerate;
mod far;
mod friction;
mod impact;
mod stack;
mod top;

use super::Exhibit;

pub(super) const EXHIBITS: [&[Exhibit]; 7] = [
    stack::EXHIBITS,
    friction::EXHIBITS,
    impact::EXHIBITS,
    contact::EXHIBITS,
    far::EXHIBITS,
    top::EXHIBITS,
    degenerate::EXHIBITS,
];
