//! Soft things and liquids: pillow, towel, sponge, teddy bear; milk, honey, a drop of water.

use super::glb::Part;
use super::materials::{COTTON, FOAM, HONEY, MILK, PILLOW, PLUSH, WATER};
use super::mesh::Mesh;

/// 0.6 x 0.14 x 0.4 m: thick in the middle, pinched to a seam with pointed corners.
pub(super) fn pillow() -> Vec<Part> {
    let ball = Mesh::sphere(1.0, 32, 64);
    let mesh = ball.map(|[x, y, z]| {
        // From the unit sphere to a square one (exponent 1/2 across), thinned where the seam is.
        let square = |a: f64, b: f64| {
            let length = a.hypot(b);
            if length == 0.0 { 0.0 } else { a / length * length.powf(0.8) * corner(a / length) }
        };
        [0.30 * square(x, z), 0.07 + 0.07 * y.signum() * y.abs().powf(1.25), 0.20 * square(z, x)]
    });
    vec![Part { name: "pillow", material: PILLOW, mesh }]
}

/// Distance from the centre to the edge of a rounded square, in a direction with cosine `cosine` to a side.
fn corner(cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    (cosine.abs().powi(6) + sine.powi(6)).powf(-1.0 / 6.0)
}

/// A towel folded to three layers, 0.3 x 0.045 x 0.2 m.
pub(super) fn towel() -> Vec<Part> {
    // A zigzag as one tube of rectangular section: its outline, drawn in the x-y plane, swept along z.
    let (reach, thick, gap) = (0.14, 0.013, 0.0032);
    let mut upper = Vec::new();
    let mut lower = Vec::new();
    let bend = 6;
    let mut arc = |x: f64, y: f64, outward: f64, outer_above: bool| {
        let (outer, inner) = (thick + gap / 2.0, gap / 2.0);
        for step in 0..=bend {
            let angle = std::f64::consts::PI * (f64::from(step) / f64::from(bend) - 0.5);
            let point = |radius: f64| [x + outward * radius * angle.cos(), y + radius * angle.sin()];
            let (above, below) = if outer_above { (outer, inner) } else { (inner, outer) };
            upper.push(point(above));
            lower.push(point(below));
        }
    };
    // Two bends, at the right between layers 1 and 2, at the left between layers 2 and 3.
    arc(reach, thick + gap / 2.0, 1.0, true);
    arc(-reach, 2.0 * thick + 1.5 * gap, -1.0, false);
    let mut outer = vec![[-reach, 0.0]];
    let mut inner = vec![[-reach, thick]];
    outer.extend(&upper);
    inner.extend(&lower);
    outer.push([reach, 2.0 * thick + 2.0 * gap]);
    inner.push([reach, 3.0 * thick + 2.0 * gap]);
    vec![Part { name: "towel", material: COTTON, mesh: ribbon(&outer, &inner, 0.2) }]
}

/// A band between two lines of equal length in the x-y plane, extruded to `width` along z.
fn ribbon(outer: &[[f64; 2]], inner: &[[f64; 2]], width: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for (o, i) in outer.iter().zip(inner) {
        for ([x, y], z) in [(*o, 1.0), (*o, -1.0), (*i, -1.0), (*i, 1.0)] {
            mesh.positions.push([x, y, z * width / 2.0]);
        }
    }
    let mut quad = |[a, b, c, d]: [u32; 4]| mesh.triangles.extend([[a, b, c], [a, c, d]]);
    let last = 4 * (outer.len() as u32 - 1);
    for section in 0..outer.len() as u32 - 1 {
        let (here, next) = (4 * section, 4 * section + 4);
        for corner in 0..4 {
            let after = (corner + 1) % 4;
            quad([here + corner, here + after, next + after, next + corner]);
        }
    }
    quad([0, 3, 2, 1]);
    quad([last, last + 1, last + 2, last + 3]);
    mesh
}

/// 110 x 40 x 70 mm.
pub(super) fn sponge() -> Vec<Part> {
    vec![Part {
        name: "sponge",
        material: FOAM,
        mesh: Mesh::cuboid([0.055, 0.02, 0.035], 0.005).at([0.0, 0.02, 0.0]),
    }]
}

/// 0.36 m high, sitting.
pub(super) fn teddy_bear() -> Vec<Part> {
    let blob = |radius: f64, stretch: [f64; 3], center: [f64; 3]| {
        Mesh::sphere(radius, 14, 22).stretched(stretch).at(center)
    };
    let limbs = [
        (0.045, [0.9, 0.9, 1.6], [0.075, 0.041, 0.09]),
        (0.045, [0.9, 0.9, 1.6], [-0.075, 0.041, 0.09]),
        (0.035, [0.9, 1.7, 0.9], [0.115, 0.145, 0.02]),
        (0.035, [0.9, 1.7, 0.9], [-0.115, 0.145, 0.02]),
    ];
    let ears =
        [(0.032, [1.0, 1.0, 0.5], [0.062, 0.335, 0.0]), (0.032, [1.0, 1.0, 0.5], [-0.062, 0.335, 0.0])];
    let all = |blobs: &[(f64, [f64; 3], [f64; 3])]| {
        blobs
            .iter()
            .fold(Mesh::default(), |all, &(radius, stretch, center)| all.and(&blob(radius, stretch, center)))
    };
    vec![
        Part { name: "teddy body", material: PLUSH, mesh: blob(0.10, [1.0, 1.12, 0.9], [0.0, 0.112, 0.0]) },
        Part { name: "head", material: PLUSH, mesh: blob(0.08, [1.05, 0.95, 0.95], [0.0, 0.27, 0.01]) },
        Part { name: "ears", material: PLUSH, mesh: all(&ears) },
        Part { name: "limbs", material: PLUSH, mesh: all(&limbs) },
        Part { name: "snout", material: PLUSH, mesh: blob(0.034, [1.0, 0.8, 0.9], [0.0, 0.255, 0.078]) },
    ]
}

/// A puddle, 0.3 m across and 6 mm deep.
pub(super) fn milk_puddle() -> Vec<Part> {
    let rim = [(0.0, 0.0), (0.148, 0.0), (0.15, 0.002), (0.145, 0.005), (0.12, 0.006), (0.0, 0.0062)];
    let wavy = Mesh::lathe(&rim, 64).map(|[x, y, z]| {
        let angle = z.atan2(x);
        let reach = 1.0 + 0.10 * (3.0 * angle).sin() + 0.05 * (5.0 * angle + 1.0).cos();
        [x * reach, y, z * reach]
    });
    vec![Part { name: "milk puddle", material: MILK, mesh: wavy }]
}

/// A drop of 4 mm radius with its tip up.
pub(super) fn water_drop() -> Vec<Part> {
    let mut outline = vec![(0.0, 0.0)];
    outline.extend((1..20).map(|step| {
        let t = std::f64::consts::PI * f64::from(step) / 20.0;
        (0.004 * t.sin() * (t / 2.0).cos().powf(0.8), 0.0055 * (1.0 - t.cos()))
    }));
    outline.push((0.0, 0.011));
    vec![Part { name: "water drop", material: WATER, mesh: Mesh::lathe(&outline, 24) }]
}

/// A spoonful of honey, 40 mm across.
pub(super) fn honey() -> Vec<Part> {
    let heap = [(0.0, 0.0), (0.019, 0.0), (0.021, 0.003), (0.018, 0.008), (0.010, 0.012), (0.0, 0.013)];
    vec![Part { name: "honey", material: HONEY, mesh: Mesh::lathe(&heap, 40) }]
}
