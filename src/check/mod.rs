//! The gate: is the mapping sound, what does it change for which models, and do those models still behave?
//!
//! `rule` says what is looked for, [`observe`] looks at rules and models, [`prove`] simulates them. An
//! [`Observation`] is what was seen, whether it is within its bound or not; a [`Policy`] makes [`Finding`]s of
//! observations. `gate` runs the layers (`data` and `runtime`, a `case` a model) and lets `judge` have the last word. [`mod@format`] writes the report for people and machines, [`lock`] and
//! [`diff`] hold a mapping against an earlier one.

mod adopt;
mod baseline;
mod case;
mod changed;
pub mod config;
mod data;
pub mod diff;
mod distribution;
mod drift;
pub mod entry;
mod finding;
pub mod format;
mod gate;
mod judge;
mod layer_set;
mod limit;
pub mod lock;
mod observation;
pub mod observe;
pub mod page;
mod place;
mod policy;
pub mod prove;
mod remap;
mod report;
mod rule;
mod rules;
mod runtime;
mod selector;
mod severity;
pub mod side;
pub mod source;
mod suppression;
mod touched;

pub use adopt::map_error;
pub use baseline::Baseline;
pub use changed::GitTree;
pub use distribution::{Distribution, distributions};
pub use finding::Finding;
pub use gate::{Models, Request, check, lock as lock_of};
pub use layer_set::Layers;
pub use limit::Limit;
pub use observation::Observation;
pub use place::{Place, Places};
pub use policy::{Adjustments, Level, Policy, Subject};
pub use report::{Report, Runtime};
pub use rule::{Bound, Family, Layer, Rule};
pub use selector::Selector;
pub use severity::Severity;

/// Categories and subcategories of which three stand on each other, unless the configuration says otherwise.
pub const STACKS: [&str; 8] =
    ["brick", "book", "crate", "cardboard-box", "cinder-block", "pallet", "toy-block", "box"];
