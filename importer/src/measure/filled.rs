//! The volume that a soup of triangles winds around: cells counted where the winding number is over a half.
//!
//! A. Jacobson, L. Kavan, O. Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized Winding Numbers,
//! 2013.

use super::bounds;
use super::moments::{Point, Volume};
use super::winding::{Element, WindingTree};

/// Cells along the longest side: blocks of four.
const BLOCKS: u32 = 12;
const IN_BLOCK: u32 = 4;

/// What is surely inside has at least, surely outside at most, these: the spread between them is the bound.
const SURE: [f64; 2] = [0.7, 0.3];

/// Volume with the half width of its bound.
pub(super) struct Filled {
    pub volume: Volume,
    pub half_width: f64,
}

/// `None` where nothing is over a half.
pub(super) fn filled(positions: &[Point], triangles: &[[u32; 3]]) -> Option<Filled> {
    let corners: Vec<Point> = triangles.iter().flatten().map(|&corner| positions[corner as usize]).collect();
    let (min, max) = bounds(&corners);
    let longest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
    if longest <= 0.0 || !longest.is_finite() {
        return None;
    }
    let elements = corners.as_chunks::<3>().0.iter().map(|corners| Element::Triangle(*corners)).collect();
    let tree = WindingTree::new(elements);
    let block = longest / f64::from(BLOCKS);
    let cell = block / f64::from(IN_BLOCK);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let blocks: [u32; 3] =
        std::array::from_fn(|axis| ((max[axis] - min[axis]) / block).ceil().max(1.0) as u32);
    // The middle cells of a thin piece lie in its middle.
    let start: Point =
        std::array::from_fn(|axis| 0.5 * (min[axis] + max[axis]) - 0.5 * block * f64::from(blocks[axis]));
    let mut inside = Vec::new();
    let (mut surely, mut perhaps, mut edge) = (0_u64, 0_u64, 0_u64);
    for at in 0..blocks[0] * blocks[1] * blocks[2] {
        let place = [at % blocks[0], at / blocks[0] % blocks[1], at / (blocks[0] * blocks[1])];
        let corner: Point = std::array::from_fn(|axis| start[axis] + block * f64::from(place[axis]));
        let middle = corner.map(|value| value + 0.5 * block);
        let whole = tree.is_clear(middle, 1.8 * block).then(|| tree.at(middle).abs());
        // Far from the surface the field is smooth.
        let whole = whole.filter(|winding| !(0.15..0.85).contains(winding));
        let mut any = [false; 2];
        for cell_at in 0..IN_BLOCK.pow(3) {
            let place = [cell_at % IN_BLOCK, cell_at / IN_BLOCK % IN_BLOCK, cell_at / IN_BLOCK.pow(2)];
            let middle: Point =
                std::array::from_fn(|axis| corner[axis] + cell * (f64::from(place[axis]) + 0.5));
            let winding = whole.unwrap_or_else(|| tree.at(middle).abs());
            surely += u64::from(winding > SURE[0]);
            perhaps += u64::from(winding > SURE[1]);
            any[usize::from(winding > 0.5)] = true;
            if winding > 0.5 {
                inside.push(middle);
            }
        }
        edge += u64::from(any == [true; 2]) * u64::from(IN_BLOCK * IN_BLOCK);
    }
    let volume = Volume::of_cells(&inside, cell);
    let cells = inside.len() as u64;
    let spread = (perhaps - cells).max(cells - surely) as f64;
    // Where the surface crosses a cell, counting rounds it up or down.
    let half_width = (spread + (edge as f64).sqrt()) * cell.powi(3);
    (cells > 0).then_some(Filled { volume, half_width })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_squares_apart_fill_a_cube() {
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for face in 0..6_usize {
            let (axis, sign) = (face / 2, if face % 2 == 0 { -0.5 } else { 0.5 });
            let first = positions.len() as u32;
            for (u, v) in [(-0.49, -0.49), (0.49, -0.49), (0.49, 0.49), (-0.49, 0.49)] {
                let mut point = [0.0; 3];
                point[axis] = sign;
                point[(axis + 1) % 3] = u;
                point[(axis + 2) % 3] = v;
                positions.push(point);
            }
            let faces = if sign > 0.0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 2, 1], [0, 3, 2]] };
            triangles.extend(faces.map(|corners| corners.map(|corner: u32| corner + first)));
        }
        let filled = filled(&positions, &triangles).unwrap();
        assert!(
            (filled.volume.total() - 1.0).abs() < filled.half_width.min(0.05),
            "{}",
            filled.volume.total()
        );
        let solid = filled.volume.properties().unwrap();
        assert!((solid.inertia[0] / solid.measure - 1.0 / 6.0).abs() < 5e-3);
    }
}
