//! What follows for one model? The category that wins, every value by precedence, unit, mass, and what
//! contradicts.

pub(crate) mod amount;
pub(crate) mod consistency;
pub(crate) mod consult;
pub(crate) mod decide;
pub(crate) mod mass;
pub(crate) mod material;
pub(crate) mod reach;
pub(crate) mod resolve;
pub(crate) mod scale;
pub(crate) mod stated;
pub(crate) mod weigh;
