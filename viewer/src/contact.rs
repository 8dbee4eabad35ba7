//! Contact points as dots, their impulses as arrows.

use rerun::{Arrows3D, EntityPath, Points3D, Radius, RecordingStream};

use crate::block::{Block, Touch};
use crate::body::times;
use crate::error::ViewerError;
use crate::palette;
use crate::path;
use crate::place::Placement;

/// Radius of a dot in points of the screen: contacts of a 5 cm cup and of a house read alike.
const DOT: f32 = 3.5;

/// The contacts of one scene.
pub(crate) struct Contacts {
    dots: EntityPath,
    arrows: Option<EntityPath>,
    /// m an N s; an arrow of the scene's radius carries the whole weight for a step.
    length: f32,
    /// m, the longest arrow, so that an impact does not cross the picture.
    longest: f32,
    last_empty: bool,
}

impl Contacts {
    /// `names` is the path under `world/contacts`; arrows are drawn where `reach` is known: the scene's radius in
    /// metres and the impulse of its weight in a step, N s.
    pub(crate) fn begin(
        stream: &RecordingStream,
        names: &[&str],
        reach: Option<(f32, f64)>,
    ) -> Result<Self, ViewerError> {
        let dots = path::join("world/contacts", &[names, &["points"]].concat());
        let style = Points3D::update_fields()
            .with_radii([Radius::new_ui_points(DOT)])
            .with_colors([palette::color(palette::CONTACT)]);
        stream.log_static(dots.clone(), &style).map_err(ViewerError::encode)?;
        let Some((radius, impulse)) = reach.filter(|(_, impulse)| *impulse > 0.0) else {
            return Ok(Self { dots, arrows: None, length: 0.0, longest: 0.0, last_empty: true });
        };
        let arrows = path::join("world/contacts", &[names, &["impulses"]].concat());
        let style = Arrows3D::update_fields()
            .with_radii([Radius::new_ui_points(1.5)])
            .with_colors([palette::color(palette::IMPULSE)]);
        stream.log_static(arrows.clone(), &style).map_err(ViewerError::encode)?;
        #[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
        let length = (f64::from(radius) / impulse) as f32;
        Ok(Self { dots, arrows: Some(arrows), length, longest: 1.5 * radius, last_empty: true })
    }

    /// An empty list is sent once, to take the last contacts away.
    pub(crate) fn block(
        &mut self,
        stream: &RecordingStream,
        block: &Block,
        placement: &Placement,
    ) -> Result<(), ViewerError> {
        let mut rows = Vec::new();
        for row in 0..block.rows.len() {
            let count = block.contacts_of(row).len();
            if block.rows[row].contacts_kept && !(count == 0 && self.last_empty) {
                rows.push(row);
                self.last_empty = count == 0;
            }
        }
        if rows.is_empty() {
            return Ok(());
        }
        let touches = || rows.iter().flat_map(|row| block.contacts_of(*row));
        let counts = || rows.iter().map(|row| block.contacts_of(*row).len());
        let positions = || touches().map(|touch| placement.apply(touch.position));
        let columns = Points3D::update_fields()
            .with_positions(positions())
            .columns(counts())
            .map_err(ViewerError::encode)?;
        let sent = stream.send_columns(self.dots.clone(), times(block, &rows), columns);
        sent.map_err(ViewerError::encode)?;
        let Some(arrows) = &self.arrows else { return Ok(()) };
        let columns = Arrows3D::update_fields()
            .with_origins(positions())
            .with_vectors(touches().map(|touch| self.arrow(touch)))
            .columns(counts())
            .map_err(ViewerError::encode)?;
        stream.send_columns(arrows.clone(), times(block, &rows), columns).map_err(ViewerError::encode)
    }

    fn arrow(&self, touch: &Touch) -> [f32; 3] {
        let vector = touch.impulse.map(|x| x * self.length);
        let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
        let cut = if length > self.longest { self.longest / length } else { 1.0 };
        vector.map(|x| x * cut)
    }
}
