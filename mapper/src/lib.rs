//! What should it behave like, and who said so?
//!
//! Names, sizes and shapes go in ([`ModelFacts`]); a category, a kind and a full set of physical attributes come
//! out ([`Mapped`]), each with the line that set it. What kinds of things there are stands in `catalog.yaml`
//! ([`Ruleset`]), what people say of single models in override files ([`Overrides`], [`Sidecar`]). [`Mapper::map`]
//! touches no file: the same facts give the same answer.
//!
//! Who has the last word, lowest first: built-in default, kind, preset, category, subcategory, rule, a machine's
//! proposal, model file, project override, sidecar override, command line.

#![forbid(unsafe_code)]

mod answer;
mod attribute;
mod explain;
mod facts;
mod mapped;
mod mapper;
mod names;
mod rigid;
mod rules;
pub mod scene;
pub mod scene_file;
mod scene_shape;
pub mod shapes_file;
mod table;
mod tags;
mod text;

pub use answer::consult::Consulted;
pub use answer::reach::Reach;
pub use attribute::{
    ATTRIBUTES, Attribute, AttributeSpec, Class, Kind, Layer, MassModel, Provenance, Value, attribute_id,
};
pub use explain::explain;
pub use facts::{ModelFacts, PartFacts, ShapeFacts, SpreadFacts};
pub use mapped::{ColliderTolerance, Contents, Finding, Mapped, Scale, Trace};
pub use mapper::Mapper;
pub use rules::category::{Alias, Category, Range, Subcategory};
pub use rules::check::check_rules;
pub use rules::overrides::{Overrides, SetValue, Sidecar, sidecar_path};
pub use rules::preset::{Figure, Pair, Preset};
pub use rules::ruleset::{Ruleset, Stats};
pub use rules::schema;
pub use rules::settings::{Setting, What};
pub use table::{HEADER as TABLE_HEADER, Record, map_table, read as read_table};
pub use tags::Tags;
pub use text::article::with_article;
pub use text::error::{Diagnostic, MapError};
pub use text::reader::{Fields, Reader, nearest};
#[doc(hidden)]
pub use text::yaml::scalars as yaml_scalars;
pub use text::yaml::{Data, Document, Node, Span, parse as parse_yaml};
pub use text::{edit, units};
