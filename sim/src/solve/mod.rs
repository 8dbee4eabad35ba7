//! What do contacts do to velocities?

pub(crate) mod blow;
pub(crate) mod direct;
pub(crate) mod friction;
pub(crate) mod hold;
pub(crate) mod impact;
pub(crate) mod lone;
pub(crate) mod micro_collision;
pub(crate) mod rolling;
pub(crate) mod softness;
pub(crate) mod substeps;
pub(crate) mod wide;
