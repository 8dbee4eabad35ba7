//! One body as an entity of its own: its mesh once, its poses and states as columns.

use rerun::components::TransformFrameId;
use rerun::{
    AsComponents, CoordinateFrame, EntityPath, InstancePoses3D, Mesh3D, RecordingStream, TimeColumn,
    Transform3D,
};
use sim::SleepState;

use crate::block::Block;
use crate::error::ViewerError;
use crate::mesh::Mesh;
use crate::palette;
use crate::place::{Drawn, Placement};
use crate::scenery::Look;

/// A colour for a state.
type Paint = fn(SleepState) -> [u8; 4];

/// A body with what was last sent of it: nothing is sent twice, so that a sleeper costs nothing.
pub(crate) struct Body {
    path: EntityPath,
    overlay: Option<EntityPath>,
    /// The colour and the state's factor on it; `None` where the state shows elsewhere.
    tinted: Option<([u8; 4], Paint)>,
    last_pose: Option<Drawn>,
    last_state: Option<SleepState>,
}

/// Times of some rows of a block, on both timelines.
pub(crate) fn times(block: &Block, rows: &[usize]) -> [TimeColumn; 2] {
    let steps = rows.iter().map(|row| i64::try_from(block.rows[*row].step).unwrap_or(i64::MAX));
    let seconds = rows.iter().map(|row| block.rows[*row].time_s);
    [
        TimeColumn::new_sequence("step", steps.collect::<Vec<_>>()),
        TimeColumn::new_duration_secs("sim_time", seconds.collect::<Vec<_>>()),
    ]
}

impl Body {
    /// Logs the meshes. The overlay hangs on the body's frame, so its poses are sent once.
    pub(crate) fn begin(
        stream: &RecordingStream,
        look: &Look,
        path: EntityPath,
        overlay: EntityPath,
        placement: &Placement,
        tint: bool,
    ) -> Result<Self, ViewerError> {
        let mesh = Mesh::of(&look.body);
        let paint = if look.visual { palette::tint } else { palette::state };
        let tinted = (tint && !look.fixed).then_some((mesh.color, paint as Paint));
        let archetype = if tinted.is_some() { mesh.geometry() } else { mesh.archetype() };
        // On the instance and not in the transform, of which the viewer takes all parts from one row.
        let mut scale = InstancePoses3D::update_fields();
        if (placement.scale - 1.0).abs() > f32::EPSILON {
            scale = scale.with_scales([[placement.scale; 3]]);
        }
        let log = |at: &EntityPath, parts: &[&dyn AsComponents]| {
            let batches = parts.iter().flat_map(|part| part.as_serialized_batches());
            stream.log_serialized_batches(at.clone(), true, batches).map_err(ViewerError::encode)
        };
        log(&path, &[&archetype, &scale])?;
        let overlay = (!look.overlay.is_empty()).then_some(overlay);
        if let Some(overlay) = &overlay {
            let frame = CoordinateFrame::new(TransformFrameId::from_entity_path(&path));
            log(overlay, &[&Mesh::of(&look.overlay).geometry(), &frame, &scale])?;
        }
        Ok(Self { path, overlay, tinted, last_pose: None, last_state: None })
    }

    /// Sends what changed of body `index` in `block`.
    pub(crate) fn block(
        &mut self,
        stream: &RecordingStream,
        block: &Block,
        index: usize,
        placement: &Placement,
    ) -> Result<(), ViewerError> {
        let at = |row: usize| row * block.bodies + index;
        let mut moved = Vec::new();
        let mut changed = Vec::new();
        for row in 0..block.rows.len() {
            let (pose, state) = (block.poses[at(row)], block.sleep[at(row)]);
            if self.last_pose.replace(pose) != Some(pose) {
                moved.push(row);
            }
            if self.last_state.replace(state) != Some(state) {
                changed.push(row);
            }
        }
        if !moved.is_empty() {
            let pose = |row: &usize| block.poses[at(*row)];
            let columns = Transform3D::update_fields()
                .with_many_translation(moved.iter().map(|row| placement.apply(pose(row).position)))
                .with_many_quaternion(
                    moved.iter().map(|row| rerun::Quaternion::from_xyzw(pose(row).rotation)),
                )
                .columns_of_unit_batches()
                .map_err(ViewerError::encode)?;
            stream
                .send_columns(self.path.clone(), times(block, &moved), columns)
                .map_err(ViewerError::encode)?;
        }
        let states = || changed.iter().map(|row| block.sleep[at(*row)]);
        let send = |path: &EntityPath, colors: Vec<[u8; 4]>| {
            let columns = Mesh3D::update_fields()
                .with_many_albedo_factor(colors.into_iter().map(palette::albedo))
                .columns_of_unit_batches()
                .map_err(ViewerError::encode)?;
            stream.send_columns(path.clone(), times(block, &changed), columns).map_err(ViewerError::encode)
        };
        if !changed.is_empty() {
            if let Some(overlay) = &self.overlay {
                send(overlay, states().map(palette::overlay).collect())?;
            }
            if let Some((color, paint)) = self.tinted {
                send(&self.path, states().map(|s| palette::times(color, paint(s))).collect())?;
            }
        }
        Ok(())
    }
}
