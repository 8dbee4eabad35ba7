//! Points on a surface to a closed surface through them.
//!
//! Normals by the nearest neighbours' plane, turned outwards by what can be reached from outside; the field that the
//! points wind around (Barill et al. 2018, the "clouds" of its title); its level of a half as triangles.

mod level;
mod neighbours;
mod normals;

use crate::asset::Mesh;
use crate::measure::{Element, WindingTree};

pub(crate) type Point = [f64; 3];

/// Points as a file gives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cloud {
    pub name: String,
    pub positions: Vec<Point>,
    /// As many as positions, or none.
    pub normals: Vec<Point>,
}

/// A surface through points, and how far it may lie from the one that they were taken from.
pub(crate) struct Through {
    pub mesh: Mesh,
    pub deviation: f64,
}

/// More points than this say no more of the shape: one a cell of a grid is kept.
const MOST_POINTS: usize = 60_000;

/// Points that a plane is laid through.
const NEIGHBOURS: usize = 12;

/// `most_cells` of the field along the longest side. `None` where the points enclose nothing: too few, in a plane, or an open sheet.
pub(crate) fn surface(cloud: &Cloud, most_cells: usize) -> Option<Through> {
    let (positions, given) = thinned(cloud);
    if positions.len() < 4 {
        return None;
    }
    let near = neighbours::nearest(&positions, NEIGHBOURS.min(positions.len() - 1));
    let reach: Vec<f64> = near.iter().map(|near| near.reach).collect();
    let spacing = median(near.iter().map(|near| near.spacing).collect());
    if !(spacing > 0.0 && spacing.is_finite()) {
        return None;
    }
    let normals = if given.is_empty() { normals::outward(&positions, &near, spacing)? } else { given };
    // The disc around a point that holds its share: k neighbours lie within the reach.
    let share = |reach: f64| std::f64::consts::PI * reach * reach / NEIGHBOURS as f64;
    let elements = positions
        .iter()
        .zip(normals.iter().zip(&reach))
        .map(|(&centre, (normal, &reach))| Element::Disc { centre, vector: normal.map(|n| n * share(reach)) })
        .collect();
    let tree = WindingTree::new(elements);
    let mesh = level::surface(&positions, spacing, most_cells, |point| tree.at(point));
    (!mesh.triangles.is_empty()).then_some(Through { mesh, deviation: 0.5 * spacing })
}

fn thinned(cloud: &Cloud) -> (Vec<Point>, Vec<Point>) {
    let mut positions = cloud.positions.clone();
    let mut normals = cloud.normals.clone();
    let mut cells = 512.0;
    loop {
        let kept = one_a_cell(&positions, cells);
        let few = kept.len() <= MOST_POINTS;
        if few || cells < 32.0 {
            // Points in one place say nothing twice.
            normals = if normals.is_empty() { normals } else { kept.iter().map(|&at| normals[at]).collect() };
            positions = kept.iter().map(|&at| positions[at]).collect();
            return (positions, normals);
        }
        cells *= 0.75;
    }
}

fn one_a_cell(positions: &[Point], cells: f64) -> Vec<usize> {
    let (low, longest) = extent(positions);
    let size = if longest > 0.0 { longest / cells } else { 1.0 };
    let few = positions.len() <= MOST_POINTS;
    let mut seen = std::collections::HashSet::new();
    let key = |point: &Point| -> [i64; 3] {
        std::array::from_fn(|axis| {
            let value = point[axis] + 0.0;
            #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)]
            let cell = if few { value.to_bits() as i64 } else { ((value - low[axis]) / size) as i64 };
            cell
        })
    };
    (0..positions.len()).filter(|&at| seen.insert(key(&positions[at]))).collect()
}

/// The lowest corner and the longest side.
fn extent(positions: &[Point]) -> (Point, f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in positions {
        low = std::array::from_fn(|axis| low[axis].min(point[axis]));
        high = std::array::from_fn(|axis| high[axis].max(point[axis]));
    }
    (low, (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max))
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::measure::{measure, weld};

    /// As even as points on a sphere can be: the golden angle from pole to pole.
    fn sphere(count: u32) -> Vec<Point> {
        (0..count)
            .map(|at| {
                let y = 1.0 - 2.0 * (f64::from(at) + 0.5) / f64::from(count);
                let (sine, cosine) = (f64::from(at) * PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
                let ring = (1.0 - y * y).sqrt();
                [ring * cosine, y, ring * sine]
            })
            .collect()
    }

    fn volume_of(positions: Vec<Point>) -> Option<f64> {
        let cloud = Cloud { positions, ..Cloud::default() };
        let measures = measure(&weld(&surface(&cloud, 56)?.mesh));
        assert!(measures.closed && measures.wound_consistently);
        measures.signed_volume
    }

    #[test]
    fn a_sphere_of_points_has_the_volume_of_a_sphere() {
        let volume = volume_of(sphere(5_000)).unwrap();
        assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 0.02, "{volume}");
    }

    #[test]
    fn a_torus_of_points_keeps_its_hole() {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let points = (0..12_000).map(|at| {
            let (u, v) = (2.0 * PI * f64::from(at) / 12_000.0, 2.0 * PI * (f64::from(at) * golden).fract());
            let ring = 3.0 + v.cos();
            [ring * u.cos(), v.sin(), ring * u.sin()]
        });
        let volume = volume_of(points.collect()).unwrap();
        assert!((volume / (6.0 * PI * PI) - 1.0).abs() < 0.04, "{volume}");
    }

    #[test]
    fn a_box_of_random_points_is_a_box() {
        let mut state = 7_u64;
        let mut chance = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let points = (0..20_000).map(|at: usize| {
            let mut point = [chance() * 2.0, chance() * 2.0, chance() * 2.0];
            point[at % 3] = if (at / 3).is_multiple_of(2) { 0.0 } else { 2.0 };
            point
        });
        let volume = volume_of(points.collect()).unwrap();
        assert!((volume / 8.0 - 1.0).abs() < 0.03, "{volume}");
    }

    #[test]
    fn a_plane_and_a_few_points_enclose_nothing() {
        let plane = (0..400).map(|at| [f64::from(at % 20), 0.0, f64::from(at / 20)]).collect();
        assert_eq!(volume_of(plane), None);
        assert_eq!(volume_of(vec![[0.0; 3], [1.0, 0.0, 0.0]]), None);
        assert_eq!(volume_of(vec![[1.0; 3]; 50]), None);
    }
}
