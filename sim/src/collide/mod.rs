//! Who touches whom, and where?

pub(crate) mod anchor;
pub(crate) mod axes;
pub(crate) mod boxes;
pub(crate) mod broad;
pub(crate) mod bvh;
pub(crate) mod cache;
pub(crate) mod convex;
pub(crate) mod edges;
pub(crate) mod foresee;
pub(crate) mod gjk;
pub(crate) mod half_space;
pub(crate) mod manifold;
pub(crate) mod mesh;
pub(crate) mod narrow;
pub(crate) mod near;
pub(crate) mod packed;
pub(crate) mod pair;
pub(crate) mod parry;
pub(crate) mod planes;
pub(crate) mod polytope;
#[cfg(test)]
mod reference;
pub(crate) mod region;
pub(crate) mod relative;
pub(crate) mod round;
pub(crate) mod sat;
pub(crate) mod slide;
pub(crate) mod surface;
pub(crate) mod sweep;
pub(crate) mod touch;
pub(crate) mod travel;
pub(crate) mod update;
