//! Streams a run to rerun: the only crate that names it.
//!
//! [`Recording`] shows one scene, [`Gallery`] many models, each in a scene of its own, on one grid. Both hand out
//! a [`sim::FrameSink`] whose `frame` copies what it is given into an owned block and returns; one worker
//! thread turns blocks into columns and sends them to a file, a live viewer, or both, while the run goes on.
//!
//! Metres, seconds, right-handed, Y up; timelines `step` and `sim_time`. A file whose writer was killed still
//! opens, without its footer.

mod aggregate;
mod block;
mod blueprint;
mod body;
mod bounds;
mod contact;
mod error;
mod event;
mod gallery;
mod grid;
mod hull;
mod instance;
mod mesh;
mod output;
mod palette;
mod path;
mod place;
mod plot;
mod program;
mod queue;
mod recorder;
mod recording;
mod scenery;
mod tessellate;
mod track;
mod visual;
mod worker;

pub use error::ViewerError;
pub use gallery::{Gallery, GallerySink, Slot};
pub use output::{Output, Written};
pub use program::{INSTALL_HINT, RERUN_VERSION, open_command, viewer_version};
pub use recording::{Recording, RerunSink};
pub use visual::{ColliderMesh, Visual, VisualMesh};
