//! Vessels: mug, bottle, bowl, wine glass, barrel. All are turned on a lathe: up the outside, down the inside.

use std::f64::consts::PI;

use super::glb::Part;
use super::materials::{CERAMIC, GLASS, OAK, PORCELAIN, STEEL};
use super::mesh::Mesh;

/// 95 mm high, 3 to 4 mm of wall, with a handle.
pub(super) fn mug() -> Vec<Part> {
    let wall = [
        (0.0, 0.003),
        (0.030, 0.003),
        (0.033, 0.0),
        (0.040, 0.006),
        (0.042, 0.091),
        (0.0405, 0.095),
        (0.0385, 0.093),
        (0.0365, 0.012),
        (0.033, 0.008),
        (0.0, 0.007),
    ];
    let handle: Vec<[f64; 3]> = (0..=20)
        .map(|step| PI * f64::from(step) / 20.0)
        .map(|angle| [0.039 + 0.030 * angle.sin(), 0.048 + 0.028 * angle.cos(), 0.0])
        .collect();
    vec![
        Part { name: "mug body", material: CERAMIC, mesh: Mesh::lathe(&wall, 48) },
        Part { name: "handle", material: CERAMIC, mesh: Mesh::tube(&handle, 0.0055, 12) },
    ]
}

/// A wine bottle, 300 mm high, 4 mm of glass.
pub(super) fn bottle() -> Vec<Part> {
    let wall = [
        (0.0, 0.012),
        (0.022, 0.004),
        (0.032, 0.0),
        (0.0375, 0.006),
        (0.0375, 0.180),
        (0.034, 0.200),
        (0.022, 0.222),
        (0.015, 0.240),
        (0.014, 0.285),
        (0.0155, 0.288),
        (0.0155, 0.298),
        (0.014, 0.300),
        (0.0095, 0.298),
        (0.0100, 0.240),
        (0.017, 0.222),
        (0.030, 0.198),
        (0.0335, 0.178),
        (0.0335, 0.012),
        (0.030, 0.007),
        (0.0, 0.018),
    ];
    vec![Part { name: "bottle", material: GLASS, mesh: Mesh::lathe(&wall, 48) }]
}

/// 160 mm across, 4 mm of wall.
pub(super) fn bowl() -> Vec<Part> {
    let arc = |radius: f64, from: f64, to: f64| {
        (0..=10).map(move |step| {
            let angle = from + (to - from) * f64::from(step) / 10.0;
            (radius * angle.sin(), 0.082 - radius * angle.cos())
        })
    };
    let mut wall = vec![(0.0, 0.004), (0.026, 0.004), (0.028, 0.0), (0.033, 0.0)];
    wall.extend(arc(0.080, 0.46, 1.45));
    wall.extend(arc(0.0755, 1.47, 0.15));
    wall.push((0.0, 0.0075));
    vec![Part { name: "bowl", material: PORCELAIN, mesh: Mesh::lathe(&wall, 48) }]
}

/// 200 mm high.
pub(super) fn wine_glass() -> Vec<Part> {
    let wall = [
        (0.0, 0.0),
        (0.035, 0.0),
        (0.036, 0.002),
        (0.012, 0.006),
        (0.0045, 0.015),
        (0.004, 0.085),
        (0.010, 0.096),
        (0.028, 0.112),
        (0.039, 0.135),
        (0.040, 0.150),
        (0.033, 0.199),
        (0.0318, 0.200),
        (0.0306, 0.199),
        (0.0375, 0.150),
        (0.0365, 0.136),
        (0.026, 0.115),
        (0.009, 0.101),
        (0.0, 0.098),
    ];
    vec![Part { name: "wine glass", material: GLASS, mesh: Mesh::lathe(&wall, 48) }]
}

/// 0.9 m high, with three steel hoops.
pub(super) fn barrel() -> Vec<Part> {
    let radius = |y: f64| 0.29 + 0.06 * (1.0 - ((y - 0.45) / 0.45).powi(2));
    let mut staves = vec![(0.0, 0.03), (0.265, 0.03), (0.27, 0.0)];
    staves.extend((0..=12).map(|step| f64::from(step) * 0.9 / 12.0).map(|y| (radius(y), y)));
    staves.extend([(0.27, 0.9), (0.265, 0.87), (0.0, 0.87)]);
    let hoops = [0.12, 0.45, 0.78].iter().fold(Mesh::default(), |hoops, &y| {
        let (low, high) = (y - 0.025, y + 0.025);
        let outer = |y: f64| radius(y) + 0.004;
        let inner = radius(low).min(radius(high)) - 0.01;
        let ring = [(inner, low), (outer(low), low), (outer(high), high), (inner, high), (inner, low)];
        hoops.and(&hoop(&ring, 48))
    });
    vec![
        Part { name: "staves", material: OAK, mesh: Mesh::lathe(&staves, 48) },
        Part { name: "hoops", material: STEEL, mesh: hoops },
    ]
}

/// A ring whose section is the closed loop `profile` (its last point repeats the first).
fn hoop(profile: &[(f64, f64)], segments: u32) -> Mesh {
    let open = Mesh::lathe(profile, segments);
    // The repeated ring of vertices is joined to the first, which closes the surface.
    let first_of_last = (profile.len() as u32 - 1) * segments;
    let triangles = open
        .triangles
        .iter()
        .map(|triangle| triangle.map(|i| if i >= first_of_last { i - first_of_last } else { i }))
        .collect();
    Mesh { positions: open.positions[..first_of_last as usize].to_vec(), triangles }
}
