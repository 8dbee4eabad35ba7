//! One simulated scene on the worker's side: it logs what never changes once, then every block.

use rerun::RecordingStream;

use crate::block::Block;
use crate::body::Body;
use crate::bounds::Bounds;
use crate::contact::Contacts;
use crate::error::ViewerError;
use crate::grid::Cell;
use crate::instance::{self, Class};
use crate::path;
use crate::place::Placement;
use crate::scenery::{Scenery, Script};
use crate::{event, plot};

/// More moving bodies than this are drawn as instances.
const MAX_ENTITIES: usize = 300;

/// Where a scene stands in the recording.
#[derive(Clone, Debug)]
pub(crate) enum Stage {
    /// It has the recording for itself.
    Alone,
    /// In a cell of a gallery.
    Cell(Cell),
}

enum Bodies {
    /// With the indices of the entities they show.
    Apart(Vec<(usize, Body)>),
    Instances(Vec<Class>),
}

/// A scene that is being recorded.
pub(crate) struct Track {
    placement: Placement,
    statics: Vec<(usize, Body)>,
    bodies: Bodies,
    contacts: Contacts,
    cell: Option<Cell>,
    names: Vec<String>,
    /// What the eye should frame.
    pub(crate) bounds: Bounds,
    /// m, height of the ground.
    pub(crate) floor: Option<f32>,
}

impl Track {
    pub(crate) fn begin(
        stream: &RecordingStream,
        stage: Stage,
        script: &Script,
    ) -> Result<Self, ViewerError> {
        let scenery = Scenery::of(script);
        let names = scenery.looks.iter().map(|look| look.name.clone()).collect();
        match stage {
            Stage::Alone => Self::alone(stream, script, &scenery, names),
            Stage::Cell(cell) => Self::in_cell(stream, cell, &scenery, names),
        }
    }

    fn alone(
        stream: &RecordingStream,
        script: &Script,
        scenery: &Scenery,
        names: Vec<String>,
    ) -> Result<Self, ViewerError> {
        let placement = Placement::IDENTITY;
        let many = scenery.dynamic() > MAX_ENTITIES;
        let (mut statics, mut apart) = (Vec::new(), Vec::new());
        for (index, look) in scenery.looks.iter().enumerate() {
            if look.fixed || !many {
                let root = if look.fixed { "world/statics" } else { "world/bodies" };
                let at = path::join(root, &[&look.name]);
                let overlay = path::join("world/colliders", &[&look.name]);
                let body = Body::begin(stream, look, at, overlay, &placement, true)?;
                if look.fixed { &mut statics } else { &mut apart }.push((index, body));
            }
        }
        let bodies = if many {
            Bodies::Instances(instance::begin(stream, script, scenery)?)
        } else {
            Bodies::Apart(apart)
        };
        plot::begin(stream)?;
        let reach = (scenery.bounds.radius(), scenery.weight_n * script.dt_s);
        let contacts = Contacts::begin(stream, &[], Some(reach))?;
        Ok(Self {
            placement,
            statics,
            bodies,
            contacts,
            cell: None,
            names,
            bounds: scenery.bounds,
            floor: scenery.floor,
        })
    }

    fn in_cell(
        stream: &RecordingStream,
        cell: Cell,
        scenery: &Scenery,
        names: Vec<String>,
    ) -> Result<Self, ViewerError> {
        let floor = scenery.floor.unwrap_or(scenery.bodies.min[1]);
        let placement = cell.place(&scenery.bodies, floor);
        let moving: Vec<_> = scenery.looks.iter().enumerate().filter(|(_, look)| !look.fixed).collect();
        let mut apart = Vec::new();
        for (index, look) in &moving {
            let at = |root: &str| {
                let own: &[&str] = if moving.len() > 1 { &[&look.name] } else { &[] };
                path::join(root, &[&[cell.category.as_str(), cell.name.as_str()], own].concat())
            };
            let body =
                Body::begin(stream, look, at("world/models"), at("world/colliders"), &placement, false)?;
            apart.push((*index, body));
        }
        let contacts = Contacts::begin(stream, &[&cell.category, &cell.name], None)?;
        let bodies = Bodies::Apart(apart);
        let bounds = scenery.bounds;
        Ok(Self {
            placement,
            statics: Vec::new(),
            bodies,
            contacts,
            cell: Some(cell),
            names,
            bounds,
            floor: scenery.floor,
        })
    }

    pub(crate) fn block(&mut self, stream: &RecordingStream, block: &Block) -> Result<(), ViewerError> {
        for (index, body) in &mut self.statics {
            body.block(stream, block, *index, &self.placement)?;
        }
        match &mut self.bodies {
            Bodies::Apart(bodies) => {
                for (index, body) in bodies {
                    body.block(stream, block, *index, &self.placement)?;
                }
            }
            Bodies::Instances(classes) => {
                for class in classes {
                    class.block(stream, block)?;
                }
            }
        }
        self.contacts.block(stream, block, &self.placement)?;
        if let Some(cell) = &mut self.cell {
            let Bodies::Apart(bodies) = &self.bodies else { return Ok(()) };
            let moving: Vec<usize> = bodies.iter().map(|(index, _)| *index).collect();
            cell.block(stream, block, &moving)
        } else {
            plot::block(stream, block)?;
            event::block(stream, block, &self.names)
        }
    }
}
