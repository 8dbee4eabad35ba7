//! Things to drop: ball, crate, hammer, dumbbell, toy blocks; and a tree, which stays where it is.

use super::glb::Part;
use super::materials::{BARK, CAST_IRON, LEAVES, OAK, PINE, RUBBER, STEEL};
use super::mesh::Mesh;

/// 220 mm across.
pub(super) fn ball() -> Vec<Part> {
    vec![Part { name: "ball", material: RUBBER, mesh: Mesh::sphere(0.11, 24, 40).at([0.0, 0.11, 0.0]) }]
}

/// 0.5 m a side: panels in a frame of posts.
pub(super) fn wooden_crate() -> Vec<Part> {
    let (half, beam) = (0.25, 0.025);
    let middle = half - beam;
    let mut frame = Mesh::default();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (i, j) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            // Only one of the three beams that meet at a corner runs through; the others end a hair before it, so
            // that no corners coincide.
            let mut size = [beam; 3];
            size[axis] = if axis == 1 { half } else { half - 2.0 * beam - 0.001 };
            let mut center = [0.0, half, 0.0];
            center[u] += i * middle;
            center[v] += j * middle;
            frame = frame.and(&Mesh::cuboid(size, 0.003).at(center));
        }
    }
    let inside = half - 0.015;
    vec![
        Part { name: "frame", material: OAK, mesh: frame },
        Part { name: "panels", material: PINE, mesh: Mesh::cuboid([inside; 3], 0.002).at([0.0, half, 0.0]) },
    ]
}

/// A claw-less hammer lying on its side, 0.33 m long: a heavy steel head on a light handle.
pub(super) fn hammer() -> Vec<Part> {
    let handle = [
        (0.0, 0.0),
        (0.014, 0.002),
        (0.017, 0.02),
        (0.015, 0.10),
        (0.011, 0.20),
        (0.011, 0.315),
        (0.0, 0.317),
    ];
    let face = [(0.0, 0.0), (0.014, 0.0), (0.016, 0.003), (0.016, 0.022), (0.012, 0.03), (0.0, 0.03)];
    let head = Mesh::cuboid([0.014, 0.016, 0.035], 0.003).at([0.0, 0.295, -0.01]);
    let head = head.and(&Mesh::lathe(&face, 24).turned(0, -90.0).at([0.0, 0.295, 0.053]));
    let lying = |mesh: Mesh| mesh.turned(2, 90.0).at([0.16, 0.02, 0.0]);
    vec![
        Part { name: "hammer handle", material: OAK, mesh: lying(Mesh::lathe(&handle, 20)) },
        Part { name: "hammer head", material: STEEL, mesh: lying(head) },
    ]
}

/// 10 kg or so of cast iron on a steel bar, 0.3 m long.
pub(super) fn dumbbell() -> Vec<Part> {
    // The plates are hexagons that rest on a side.
    let apothem = 0.075 * std::f64::consts::FRAC_PI_6.cos();
    let lying = |mesh: Mesh| mesh.turned(2, 90.0).at([0.0, apothem, 0.0]);
    let plate = |from: f64| Mesh::cylinder(0.075, from, from + 0.05, 0.008, 6);
    let plates = plate(0.07).and(&plate(-0.12));
    vec![
        Part { name: "grip", material: STEEL, mesh: lying(Mesh::cylinder(0.016, -0.15, 0.15, 0.002, 20)) },
        Part { name: "dumbbell plates", material: CAST_IRON, mesh: lying(plates.turned(1, 30.0)) },
    ]
}

/// Three building blocks in a stack, 60 mm wide.
pub(super) fn toy_blocks() -> Vec<Part> {
    let block = |y: f64, turn: f64| Mesh::cuboid([0.03; 3], 0.003).turned(1, turn).at([0.0, y, 0.0]);
    vec![
        Part { name: "lower block", material: PINE, mesh: block(0.03, 0.0) },
        Part { name: "middle block", material: OAK, mesh: block(0.0902, 14.0) },
        Part { name: "upper block", material: PINE, mesh: block(0.1504, -9.0) },
    ]
}

/// 3.6 m high: a trunk and four crowns.
pub(super) fn tree() -> Vec<Part> {
    let trunk = [(0.0, 0.0), (0.22, 0.0), (0.14, 0.12), (0.11, 1.0), (0.06, 2.4), (0.0, 2.5)];
    let crowns = [
        ([0.0, 2.7, 0.0], 0.90),
        ([0.55, 2.2, 0.15], 0.62),
        ([-0.50, 2.25, 0.30], 0.60),
        ([-0.05, 2.15, -0.58], 0.64),
    ];
    let leaves = crowns.iter().fold(Mesh::default(), |leaves, &(center, radius)| {
        leaves.and(&Mesh::sphere(radius, 12, 20).stretched([1.0, 0.88, 1.0]).at(center))
    });
    vec![
        Part { name: "trunk", material: BARK, mesh: Mesh::lathe(&trunk, 16) },
        Part { name: "crown", material: LEAVES, mesh: leaves },
    ]
}
