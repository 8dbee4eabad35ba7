//! Who touches whom, and where?

pub(crate) mod broad;
pub(crate) mod half_space;
pub(crate) mod manifold;
pub(crate) mod narrow;
pub(crate) mod pair;
pub(crate) mod parry;
