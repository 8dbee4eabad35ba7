//! What should it behave like, and who said so?
//!
//! Names, sizes and shapes go in ([`ModelFacts`]); a category, a kind and a full set of physical attributes come
//! out ([`Mapped`]), each with the line that set it. What kinds of things there are stands in `catalog.yaml`
//! ([`Ruleset`]), what people say of single models in override files ([`Overrides`], [`Sidecar`]). [`Mapper::map`]
//! touches no file: the same facts give the same answer.
//!
//! Who has the last word, lowest first: built-in default, kind, preset, category, subcategory, rule, a machine's
//! proposal, project override, sidecar override, command line.

#![forbid(unsafe_code)]

mod attribute;
mod category;
mod check;
mod consistency;
mod decide;
pub mod edit;
mod error;
mod explain;
mod facts;
mod lexicon;
mod mapped;
mod mapper;
mod mass;
mod matcher;
mod overrides;
mod preset;
mod reader;
mod resolve;
mod rigid;
mod rule;
mod ruleset;
mod scale;
pub mod scene;
pub mod scene_file;
mod scene_shape;
pub mod schema;
mod settings;
mod spelling;
mod table;
mod tags;
mod tokens;
pub mod units;
mod yaml;

pub use attribute::{
    ATTRIBUTES, Attribute, AttributeSpec, Class, Kind, Layer, MassModel, Provenance, Value, attribute_id,
};
pub use category::{Alias, Category, Range, Subcategory};
pub use check::check_rules;
pub use error::{Diagnostic, MapError};
pub use explain::explain;
pub use facts::{ModelFacts, PartFacts, ShapeFacts, SpreadFacts};
pub use mapped::{Contents, Finding, Mapped, Scale, Trace};
pub use mapper::Mapper;
pub use overrides::{Overrides, SetValue, Sidecar, sidecar_path};
pub use preset::{Figure, Pair, Preset};
pub use ruleset::{Ruleset, Stats};
pub use settings::{Setting, What};
pub use table::{HEADER as TABLE_HEADER, Record, map_table, read as read_table};
pub use tags::Tags;
#[doc(hidden)]
pub use yaml::scalars as yaml_scalars;
