//! What do contacts do to velocities?

pub(crate) mod blow;
pub(crate) mod contact;
pub(crate) mod friction;
pub(crate) mod impact;
pub(crate) mod micro_collision;
pub(crate) mod rolling;
pub(crate) mod softness;
