//! The grid of a gallery: a cell a model, categories one after another like words in lines.

use rerun::{Boxes3D, EntityPath, FillMode, RecordingStream};
use sim::SleepState;

use crate::block::Block;
use crate::body::times;
use crate::bounds::Bounds;
use crate::error::ViewerError;
use crate::palette;
use crate::path;
use crate::place::Placement;

/// Distance of two columns and of two rows, which leave room for labels; the largest side of a model in a cell.
const PITCH: [f32; 2] = [1.0, 1.25];
const MODEL: f32 = 0.66;
/// From the middle of a pad to its category's label, towards the eye.
const LABEL_AHEAD: f32 = 0.55;
/// Half the side of a pad, and half its thickness.
const PAD: f32 = 0.43;
const PAD_DEPTH: f32 = 0.012;
/// Width over depth of the whole grid that suits the view.
const ASPECT: f32 = 0.85;

/// More categories than this are not told apart by gaps and labels of their own, which would hide the models.
const MOST_LABELS: usize = 28;

/// Column and row of every slot, and what is written where.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Grid {
    pub(crate) cells: Vec<[usize; 2]>,
    /// The cell in front of which a label stands, and its text: a category before its first model or, where there
    /// are many, what a row begins and ends with.
    labels: Vec<([usize; 2], String)>,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Categories in the order given; an empty cell between two in one row where they are few.
    pub(crate) fn of(categories: &[&str]) -> Self {
        let misfit = |grid: &Self| {
            #[expect(clippy::cast_precision_loss, reason = "a grid has few cells")]
            let aspect = grid.columns as f32 * PITCH[0] / (grid.rows.max(1) as f32 * PITCH[1]);
            (aspect / ASPECT).ln().abs()
        };
        let runs = 1 + categories.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let flow = if runs > MOST_LABELS { Self::dense } else { Self::flow };
        let most = categories.len().clamp(1, 64);
        let grids = (1..=most).map(|columns| flow(categories, columns));
        grids.min_by(|a, b| misfit(a).total_cmp(&misfit(b))).unwrap_or_default()
    }

    /// One after another without gaps.
    fn dense(categories: &[&str], columns: usize) -> Self {
        let cells = (0..categories.len()).map(|slot| [slot % columns, slot / columns]).collect();
        let label = |(row, names): (usize, &[&str])| {
            let (first, last) = (leaf(names[0]), leaf(names[names.len() - 1]));
            let text = if first == last { first.to_owned() } else { format!("{first} … {last}") };
            ([1.min(columns - 1), row], text)
        };
        let labels = categories.chunks(columns).enumerate().map(label).collect();
        Self { cells, labels, columns, rows: categories.len().div_ceil(columns) }
    }

    fn flow(categories: &[&str], columns: usize) -> Self {
        let mut grid = Self { columns, ..Self::default() };
        let (mut column, mut row, mut at) = (0, 0, 0);
        while at < categories.len() {
            let run = categories[at..].iter().take_while(|c| **c == categories[at]).count();
            if column > 0 {
                column += 1;
                // A category is kept in one piece where a row can hold it.
                if column >= columns || (column + run > columns && run <= columns) {
                    (column, row) = (0, row + 1);
                }
            }
            grid.labels.push(([column, row], leaf(categories[at]).to_owned()));
            for _ in 0..run {
                if column == columns {
                    (column, row) = (0, row + 1);
                }
                grid.cells.push([column, row]);
                column += 1;
            }
            at += run;
        }
        grid.rows = if grid.cells.is_empty() { 0 } else { row + 1 };
        grid
    }

    /// Where each label stands, and its text.
    pub(crate) fn labels(&self) -> impl Iterator<Item = ([f32; 3], &str)> {
        self.labels.iter().map(|(cell, text)| {
            let [x, y, z] = self.middle(*cell);
            ([x, y + 0.02, z + LABEL_AHEAD], text.as_str())
        })
    }

    /// Middle of a slot's pad, on its top: rows come towards the eye, so that the first is the farthest.
    pub(crate) fn center(&self, slot: usize) -> [f32; 3] {
        self.middle(self.cells.get(slot).copied().unwrap_or_default())
    }

    #[expect(clippy::cast_precision_loss, reason = "a grid has few cells")]
    fn middle(&self, [column, row]: [usize; 2]) -> [f32; 3] {
        let from_middle = |index: usize, count: usize| index as f32 - (count as f32 - 1.0) / 2.0;
        [PITCH[0] * from_middle(column, self.columns), 0.0, PITCH[1] * from_middle(row, self.rows)]
    }

    #[expect(clippy::cast_precision_loss, reason = "a grid has few cells")]
    pub(crate) fn bounds(&self) -> Bounds {
        let [x, z] = [0, 1].map(|i| [self.columns, self.rows][i].max(1) as f32 * PITCH[i] / 2.0);
        Bounds { min: [-x, 0.0, -z], max: [x, MODEL, z] }
    }
}

/// `chair` of `furniture/chair`: labels keep their size on the screen, so short ones hide less.
fn leaf(category: &str) -> &str {
    category.rsplit('/').next().unwrap_or(category)
}

/// One model's place.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) category: String,
    pub(crate) name: String,
    /// Middle of the pad's top.
    pub(crate) center: [f32; 3],
    last: Option<SleepState>,
}

impl Cell {
    pub(crate) fn new(category: &str, name: &str, center: [f32; 3]) -> Self {
        Self { category: category.to_owned(), name: name.to_owned(), center, last: None }
    }

    /// Puts `bounds` over the middle of the pad, its largest side as large as the cell allows and the height
    /// `floor` of the scene on the pad.
    pub(crate) fn place(&self, bounds: &Bounds, floor: f32) -> Placement {
        let largest = bounds.size().into_iter().fold(0.0, f32::max);
        let scale = if largest > 0.0 { MODEL / largest } else { 1.0 };
        let [x, _, z] = bounds.center();
        let base = [x, floor, z];
        Placement { offset: std::array::from_fn(|i| self.center[i] - scale * base[i]), scale }
    }

    fn pad(&self) -> EntityPath {
        path::join("world/pads", &[&self.category, &self.name])
    }

    /// The pad's box, without a colour.
    fn pad_box(&self) -> Boxes3D {
        let [x, y, z] = self.center;
        Boxes3D::update_fields()
            .with_centers([[x, y - PAD_DEPTH, z]])
            .with_half_sizes([[PAD, PAD_DEPTH, PAD]])
            .with_fill_mode(FillMode::Solid)
    }

    /// A pad of one colour.
    pub(crate) fn still_pad(&self, stream: &RecordingStream, color: [u8; 4]) -> Result<(), ViewerError> {
        let pad = self.pad_box().with_colors([palette::color(color)]);
        stream.log_static(self.pad(), &pad).map_err(ViewerError::encode)
    }

    /// Colours the pad by the liveliest of the bodies.
    pub(crate) fn block(
        &mut self,
        stream: &RecordingStream,
        block: &Block,
        moving: &[usize],
    ) -> Result<(), ViewerError> {
        if self.last.is_none() {
            stream.log_static(self.pad(), &self.pad_box()).map_err(ViewerError::encode)?;
        }
        let (mut rows, mut colors) = (Vec::new(), Vec::new());
        for row in 0..block.rows.len() {
            let states = moving.iter().map(|index| block.sleep[row * block.bodies + index]);
            let state = states.min_by_key(|state| *state as u8).unwrap_or(SleepState::Asleep);
            if self.last.replace(state) != Some(state) {
                rows.push(row);
                colors.push(palette::color(palette::pad(state)));
            }
        }
        if rows.is_empty() {
            return Ok(());
        }
        let columns = Boxes3D::update_fields()
            .with_colors(colors)
            .columns_of_unit_batches()
            .map_err(ViewerError::encode)?;
        stream.send_columns(self.pad(), times(block, &rows), columns).map_err(ViewerError::encode)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn categories_stay_whole_and_cells_are_used_once() {
        let names: Vec<String> = (0..10).flat_map(|c| vec![format!("c{c}"); 3 + 2 * c]).collect();
        let categories: Vec<&str> = names.iter().map(String::as_str).collect();
        let grid = Grid::of(&categories);
        assert_eq!(grid.cells.len(), categories.len());
        let used: std::collections::BTreeSet<_> = grid.cells.iter().collect();
        assert_eq!(used.len(), categories.len());
        assert!(grid.cells.iter().all(|[c, r]| *c < grid.columns && *r < grid.rows));
        for pair in grid.cells.windows(2).zip(categories.windows(2)) {
            let ([a, b], [x, y]) = (pair.0, pair.1) else { continue };
            if x != y && a[1] == b[1] {
                assert_eq!(b[0] - a[0], 2, "an empty cell between categories");
            }
        }
        assert_eq!((Grid::of(&[]).cells.len(), grid.labels.len()), (0, 10));
    }

    #[test]
    fn many_categories_share_rows_without_gaps_and_a_label_a_row() {
        let names: Vec<String> = (0..90).flat_map(|c| vec![format!("c{c:02}"); 4]).collect();
        let categories: Vec<&str> = names.iter().map(String::as_str).collect();
        let grid = Grid::of(&categories);
        assert_eq!(grid.labels.len(), grid.rows);
        assert!(grid.columns * (grid.rows - 1) < 360 && grid.columns * grid.rows >= 360);
        assert!(grid.labels[0].1.starts_with("c00 … "), "{:?}", grid.labels[0]);
    }

    #[test]
    fn a_model_stands_on_its_pad_and_fits_it() {
        let cell = Cell::new("chair", "a", [3.0, 0.0, -2.0]);
        let bounds = Bounds { min: [10.0, 0.5, 10.0], max: [12.0, 4.5, 11.0] };
        let placement = cell.place(&bounds, 0.5);
        let (low, high) = (placement.apply(bounds.min), placement.apply(bounds.max));
        assert!(low[1].abs() < 1e-6 && (high[1] - MODEL).abs() < 1e-6);
        assert!(((low[0] + high[0]) / 2.0 - 3.0).abs() < 1e-6);
    }
}
