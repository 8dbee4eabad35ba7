//! Builders of closed triangle meshes: what the demo's models are put together from.

use std::f64::consts::{PI, TAU};

/// A closed surface in metres, Y up, wound counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A box with its edges cut off by `chamfer`, centred at the origin.
    #[must_use]
    pub fn cuboid(half: [f64; 3], chamfer: f64) -> Self {
        let mut mesh = Self::default();
        // Corner `c` (bits: sign of x, y, z) has three vertices; vertex `k` lies on the face of axis `k`.
        for corner in 0..8_u32 {
            for face in 0..3 {
                mesh.positions.push(std::array::from_fn(|axis| {
                    let reach = if axis == face { half[axis] } else { half[axis] - chamfer };
                    if corner >> axis & 1 == 1 { reach } else { -reach }
                }));
            }
        }
        let at = |corner: u32, face: u32| corner * 3 + face;
        for axis in 0..3_u32 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for side in 0..2_u32 {
                let corner = |i: u32, j: u32| side << axis | i << u | j << v;
                let face = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(|c| at(c, axis));
                mesh.quad(face, side == 0);
            }
            // The strip along an edge parallel to `axis` joins the faces of `u` and `v`.
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let corner = |k: u32| k << axis | i << u | j << v;
                let strip = [at(corner(0), u), at(corner(1), u), at(corner(1), v), at(corner(0), v)];
                mesh.quad(strip, i == j);
            }
        }
        for corner in 0..8_u32 {
            let triangle = [at(corner, 0), at(corner, 1), at(corner, 2)];
            mesh.triangle(triangle, corner.count_ones() % 2 == 0);
        }
        mesh
    }

    /// The surface that a profile of `(radius, height)` sweeps about the Y axis.
    ///
    /// The profile starts and ends on the axis (radius 0) and runs counter-clockwise as seen with the radius to
    /// the right and height up: from the bottom, over the outside, to the top (and back down the inside).
    #[must_use]
    pub fn lathe(profile: &[(f64, f64)], segments: u32) -> Self {
        let mut mesh = Self::default();
        let rings: Vec<u32> = profile
            .iter()
            .map(|&(radius, height)| {
                let first = mesh.next();
                if radius == 0.0 {
                    mesh.positions.push([0.0, height, 0.0]);
                } else {
                    for step in 0..segments {
                        let angle = TAU * f64::from(step) / f64::from(segments);
                        mesh.positions.push([radius * angle.cos(), height, -radius * angle.sin()]);
                    }
                }
                first
            })
            .collect();
        for (low, high) in (0..profile.len()).zip(1..profile.len()) {
            for step in 0..segments {
                let after = (step + 1) % segments;
                match (profile[low].0 == 0.0, profile[high].0 == 0.0) {
                    (true, true) => {}
                    (true, false) => {
                        mesh.triangles.push([rings[low], rings[high] + after, rings[high] + step])
                    }
                    (false, true) => {
                        mesh.triangles.push([rings[low] + step, rings[low] + after, rings[high]])
                    }
                    (false, false) => mesh.quad(
                        [rings[low] + step, rings[low] + after, rings[high] + after, rings[high] + step],
                        false,
                    ),
                }
            }
        }
        mesh
    }

    /// Along Y from `low` to `high`, its rims cut off by `chamfer`.
    #[must_use]
    pub fn cylinder(radius: f64, low: f64, high: f64, chamfer: f64, segments: u32) -> Self {
        let inner = radius - chamfer;
        if chamfer == 0.0 {
            return Self::lathe(&[(0.0, low), (radius, low), (radius, high), (0.0, high)], segments);
        }
        let profile = [
            (0.0, low),
            (inner, low),
            (radius, low + chamfer),
            (radius, high - chamfer),
            (inner, high),
            (0.0, high),
        ];
        Self::lathe(&profile, segments)
    }

    /// A round bar that narrows or widens along Y.
    #[must_use]
    pub fn cone(low: (f64, f64), high: (f64, f64), segments: u32) -> Self {
        Self::lathe(&[(0.0, low.1), low, high, (0.0, high.1)], segments)
    }

    /// Centred at the origin.
    #[must_use]
    pub fn sphere(radius: f64, rings: u32, segments: u32) -> Self {
        let profile: Vec<(f64, f64)> = (0..=rings)
            .map(|ring| {
                let angle = PI * f64::from(ring) / f64::from(rings);
                let across = if ring == 0 || ring == rings { 0.0 } else { radius * angle.sin() };
                (across, -radius * angle.cos())
            })
            .collect();
        Self::lathe(&profile, segments)
    }

    /// A tube of circular section along an open path, ended by flat caps. Sections stand across the path.
    #[must_use]
    pub fn tube(path: &[[f64; 3]], radius: f64, segments: u32) -> Self {
        let mut mesh = Self::default();
        let last = path.len() - 1;
        // The frame is carried along the path, so that neighbouring sections are not twisted.
        let mut side = perpendicular(direction(path[0], path[1]));
        for (index, &center) in path.iter().enumerate() {
            let along = direction(path[index.saturating_sub(1)], path[(index + 1).min(last)]);
            side = unit(subtract(side, scale(along, dot(side, along))));
            let other = cross(along, side);
            for step in 0..segments {
                let angle = TAU * f64::from(step) / f64::from(segments);
                let offset = add(scale(side, radius * angle.cos()), scale(other, radius * angle.sin()));
                mesh.positions.push(add(center, offset));
            }
        }
        for ring in 0..last as u32 {
            let (low, high) = (ring * segments, (ring + 1) * segments);
            for step in 0..segments {
                let after = (step + 1) % segments;
                mesh.quad([low + step, low + after, high + after, high + step], false);
            }
        }
        for (ring, center, flip) in [(0, path[0], true), (last as u32, path[last], false)] {
            let middle = mesh.next();
            mesh.positions.push(center);
            for step in 0..segments {
                let after = (step + 1) % segments;
                mesh.triangle([middle, ring * segments + step, ring * segments + after], flip);
            }
        }
        mesh
    }

    /// Every position through `map`, which must keep left and right apart (no mirror).
    #[must_use]
    pub fn map(mut self, map: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        for position in &mut self.positions {
            *position = map(*position);
        }
        self
    }

    /// Moved by `offset`.
    #[must_use]
    pub fn at(self, offset: [f64; 3]) -> Self {
        self.map(|position| add(position, offset))
    }

    /// Stretched along the axes by positive factors.
    #[must_use]
    pub fn stretched(self, factors: [f64; 3]) -> Self {
        self.map(|position| std::array::from_fn(|axis| position[axis] * factors[axis]))
    }

    /// Turned about `axis` (0 x, 1 y, 2 z) by `degrees`, counter-clockwise seen against the axis.
    #[must_use]
    pub fn turned(self, axis: usize, degrees: f64) -> Self {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        self.map(|position| {
            let mut turned = position;
            turned[u] = cos * position[u] - sin * position[v];
            turned[v] = sin * position[u] + cos * position[v];
            turned
        })
    }

    /// Both surfaces as one mesh; they may overlap.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        let first = self.next();
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|index| index + first)));
        self
    }

    fn next(&self) -> u32 {
        u32::try_from(self.positions.len()).unwrap_or(u32::MAX)
    }

    fn triangle(&mut self, [a, b, c]: [u32; 3], flip: bool) {
        self.triangles.push(if flip { [a, c, b] } else { [a, b, c] });
    }

    fn quad(&mut self, [a, b, c, d]: [u32; 4], flip: bool) {
        self.triangle([a, b, c], flip);
        self.triangle([a, c, d], flip);
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn scale(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|value| value * factor)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    scale(a, 1.0 / dot(a, a).sqrt())
}

fn direction(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    unit(subtract(to, from))
}

fn perpendicular(direction: [f64; 3]) -> [f64; 3] {
    let other = if direction[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    unit(cross(direction, other))
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Volume by the divergence theorem, positive where the winding is outward.
    pub(in super::super) fn volume(mesh: &Mesh) -> f64 {
        mesh.triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
                dot(a, cross(b, c)) / 6.0
            })
            .sum()
    }

    /// Every edge is run once in each direction.
    pub(in super::super) fn is_closed(mesh: &Mesh) -> bool {
        let mut edges = BTreeMap::new();
        for &[a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from, to)).or_insert(0) += 1;
            }
        }
        edges.iter().all(|(&(from, to), &count)| count == 1 && edges.get(&(to, from)) == Some(&1))
    }

    fn assert_volume(mesh: &Mesh, expected: f64) {
        assert!(is_closed(mesh), "open or wound both ways");
        let volume = volume(mesh);
        assert!((volume - expected).abs() < 1e-12 * expected.max(1.0), "{volume} instead of {expected}");
    }

    #[test]
    fn a_box_has_its_volume_less_the_chamfers() {
        let (half, c) = ([0.5, 1.0, 2.0], 0.1);
        // Each edge loses a prism of section c²/2; at a corner three prisms of length c overlap in what is
        // counted thrice instead of once: the solid between the cut planes there is c³ less three c³/3 + c³/6.
        let exact = {
            let inner: [f64; 3] = std::array::from_fn(|axis| 2.0 * (half[axis] - c));
            let core = inner[0] * inner[1] * inner[2];
            let slabs = 2.0 * c * (inner[0] * inner[1] + inner[1] * inner[2] + inner[2] * inner[0]);
            let wedges = 4.0 * (c * c / 2.0) * (inner[0] + inner[1] + inner[2]);
            core + slabs + wedges + 8.0 * c * c * c / 6.0
        };
        assert_volume(&Mesh::cuboid(half, c), exact);
    }

    #[test]
    fn a_lathe_of_n_segments_encloses_the_prism_of_its_polygon() {
        let n = 24_u32;
        let polygon = 0.5 * f64::from(n) * (TAU / f64::from(n)).sin();
        assert_volume(&Mesh::cylinder(0.3, -1.0, 1.0, 0.0, n), polygon * 0.09 * 2.0);
    }

    #[test]
    fn a_vessel_encloses_its_wall_alone() {
        let n = 32_u32;
        let polygon = 0.5 * f64::from(n) * (TAU / f64::from(n)).sin();
        let cup = [(0.0, 0.0), (2.0, 0.0), (2.0, 3.0), (1.0, 3.0), (1.0, 1.0), (0.0, 1.0)];
        assert_volume(&Mesh::lathe(&cup, n), polygon * (4.0 * 3.0 - 1.0 * 2.0));
    }

    #[test]
    fn a_tube_and_a_sphere_are_closed_and_outward() {
        let path: Vec<[f64; 3]> =
            (0..=12).map(|i| f64::from(i) * PI / 12.0).map(|t| [t.sin(), t.cos(), 0.1 * t]).collect();
        let tube = Mesh::tube(&path, 0.1, 10);
        assert!(is_closed(&tube));
        assert!(volume(&tube) > 0.0);
        let ball = Mesh::sphere(1.0, 48, 96);
        assert!(is_closed(&ball));
        assert!((volume(&ball) / (4.0 / 3.0 * PI) - 1.0).abs() < 5e-3);
    }

    #[test]
    fn turning_keeps_the_volume() {
        let mesh = Mesh::cuboid([0.1, 0.2, 0.3], 0.01);
        let before = volume(&mesh);
        for axis in 0..3 {
            let turned = mesh.clone().turned(axis, 33.0).at([1.0, 2.0, 3.0]);
            assert!((volume(&turned) - before).abs() < 1e-12);
        }
    }
}
