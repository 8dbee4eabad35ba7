//! Furniture: table, chair, stool, bookshelf, lamp.

use super::glb::{Material, Part};
use super::materials::{BRASS, LINEN, OAK, PAPER, PINE};
use super::mesh::Mesh;

/// A box part from its lowest corner `from` to its highest corner `to`, in metres.
fn block(name: &'static str, material: Material, from: [f64; 3], to: [f64; 3], chamfer: f64) -> Part {
    let half = std::array::from_fn(|axis| 0.5 * (to[axis] - from[axis]));
    let center = std::array::from_fn(|axis| 0.5 * (to[axis] + from[axis]));
    Part { name, material, mesh: Mesh::cuboid(half, chamfer).at(center) }
}

/// Four tapered legs at (±x, ±z), from the floor to `top`, as one mesh.
fn legs(x: f64, z: f64, top: f64, foot_radius: f64, top_radius: f64) -> Mesh {
    [(-x, -z), (-x, z), (x, z), (x, -z)].iter().fold(Mesh::default(), |legs, &(x, z)| {
        legs.and(&Mesh::cone((foot_radius, 0.0), (top_radius, top), 16).at([x, 0.0, z]))
    })
}

/// 1.4 x 0.75 x 0.8 m.
pub(super) fn table() -> Vec<Part> {
    vec![
        block("table top", OAK, [-0.70, 0.715, -0.40], [0.70, 0.75, 0.40], 0.006),
        block("apron", OAK, [-0.60, 0.63, -0.30], [0.60, 0.715, 0.30], 0.004),
        Part { name: "table legs", material: OAK, mesh: legs(0.62, 0.32, 0.72, 0.022, 0.034) },
    ]
}

/// 0.42 x 0.88 x 0.46 m.
pub(super) fn chair() -> Vec<Part> {
    let slats = [0.52, 0.63, 0.74].iter().fold(Mesh::default(), |slats, &y| {
        slats.and(&Mesh::cuboid([0.17, 0.03, 0.008], 0.003).at([0.0, y, -0.195]))
    });
    let posts = [-0.18, 0.18].iter().fold(Mesh::default(), |posts, &x| {
        posts.and(&Mesh::cuboid([0.018, 0.22, 0.016], 0.005).at([x, 0.66, -0.195]))
    });
    vec![
        block("seat", PINE, [-0.21, 0.43, -0.22], [0.21, 0.46, 0.22], 0.008),
        Part { name: "chair legs", material: PINE, mesh: legs(0.17, 0.17, 0.44, 0.015, 0.02) },
        Part { name: "back posts", material: PINE, mesh: posts },
        Part { name: "back slats", material: PINE, mesh: slats },
        block("top rail", PINE, [-0.205, 0.83, -0.215], [0.205, 0.88, -0.175], 0.008),
    ]
}

/// 0.34 m across, 0.45 m high.
pub(super) fn stool() -> Vec<Part> {
    let ring: Vec<[f64; 3]> = (0..=24)
        .map(|step| f64::from(step) * std::f64::consts::TAU / 24.5)
        .map(|angle| [0.115 * angle.cos(), 0.16, -0.115 * angle.sin()])
        .collect();
    vec![
        Part { name: "seat", material: OAK, mesh: Mesh::cylinder(0.17, 0.415, 0.45, 0.006, 32) },
        Part { name: "stool legs", material: OAK, mesh: legs(0.085, 0.085, 0.42, 0.014, 0.019) },
        Part { name: "foot ring", material: BRASS, mesh: Mesh::tube(&ring, 0.008, 10) },
    ]
}

/// 0.8 x 1.8 x 0.3 m, with a few books on it.
pub(super) fn bookshelf() -> Vec<Part> {
    let (width, height, depth, board) = (0.40, 1.80, 0.15, 0.02);
    let sides = [-width + board / 2.0, width - board / 2.0].iter().fold(Mesh::default(), |sides, &x| {
        sides.and(&Mesh::cuboid([board / 2.0, height / 2.0, depth], 0.002).at([x, height / 2.0, 0.0]))
    });
    let shelves = (0..6).fold(Mesh::default(), |shelves, row| {
        let y = 0.05 + f64::from(row) * (height - 0.07) / 5.0;
        shelves.and(&Mesh::cuboid([width - board, board / 2.0, depth], 0.002).at([0.0, y, 0.0]))
    });
    let books = (0..10).fold(Mesh::default(), |books, index| {
        let (row, place) = (index / 5, index % 5);
        let tall = 0.11 + 0.012 * f64::from((index * 7) % 5);
        let y = 0.06 + f64::from(row + 1) * (height - 0.07) / 5.0 + tall;
        let x = -0.34 + 0.055 * f64::from(place) + 0.12 * f64::from(row);
        books.and(&Mesh::cuboid([0.02, tall, 0.10], 0.002).at([x, y, 0.02]))
    });
    vec![
        Part { name: "sides", material: PINE, mesh: sides },
        Part { name: "shelves", material: PINE, mesh: shelves },
        block("back panel", PINE, [-0.40, 0.0, -0.158], [0.40, 1.80, -0.15], 0.001),
        Part { name: "books", material: PAPER, mesh: books },
    ]
}

/// A table lamp, 0.5 m high.
pub(super) fn lamp() -> Vec<Part> {
    let shade = [(0.0, 0.33), (0.15, 0.30), (0.09, 0.50), (0.0, 0.49)];
    vec![
        Part { name: "foot", material: BRASS, mesh: Mesh::cylinder(0.11, 0.0, 0.025, 0.006, 40) },
        Part { name: "stem", material: BRASS, mesh: Mesh::cylinder(0.012, 0.02, 0.34, 0.0, 16) },
        Part { name: "lamp shade", material: LINEN, mesh: Mesh::lathe(&shade, 40) },
    ]
}
