//! What did people write, and where? YAML with a place for every node, quantities with their units, faults
//! with a caret, and edits that keep everything else.

pub(crate) mod article;
pub mod edit;
pub(crate) mod error;
pub(crate) mod reader;
pub mod units;
pub(crate) mod yaml;
