//! What is known of kinds of things, and who may say otherwise? `catalog.yaml` and override files, read.

pub(crate) mod category;
pub(crate) mod check;
pub(crate) mod contact;
pub(crate) mod overrides;
pub(crate) mod preset;
pub(crate) mod print;
pub(crate) mod rule;
pub(crate) mod ruleset;
pub mod schema;
pub(crate) mod settings;
