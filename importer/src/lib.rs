//! Model files in, measured assets out.
//!
//! [`read`] gives geometry and names, [`import`] adds measures and collider candidates. Everything is in the
//! file's own units and axes; see [`FileFrame`]. No input makes this crate panic: a panic inside a library it
//! stands on comes out as [`ImportError::Panic`].

#![forbid(unsafe_code)]

mod asset;
mod batch;
pub mod catalogue;
mod cloud;
pub mod collider;
mod discover;
mod error;
mod guard;
mod hash;
mod import;
pub mod measure;
mod options;
mod primitive;
mod read;
mod shapes_reader;

pub use asset::{
    Asset, AssetKey, Axis, FileFrame, Format, Geometry, Mesh, Note, Part, Source, SourcePart, Stated,
    StatedValue,
};
pub use batch::{Alone, Answer, Outcome, Progress, Shard, import_folder, import_shard, in_shard};
pub use catalogue::{Catalogue, CatalogueError, Failure, ModelRow, StageRow};
pub use discover::discover;
pub use error::ImportError;
pub use guard::catch_panic;
pub use import::{asset_of, import};
pub use measure::{BodyRole, BodyVolume, MassProperties, Measures, VolumeMethod, Welded, measure, weld};
pub use options::Options;
pub use primitive::{Primitive, PrimitiveForm};
pub use read::{read, read_bytes};
pub use shapes_reader::{NamedShape, ShapesFault, ShapesReader};

/// Enters every key under which results are kept: raise it when the same bytes would give another asset.
pub const ALGORITHM_VERSION: u32 = 5;
