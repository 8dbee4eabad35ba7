//! Exact integrals of 1, x and x xᵀ over solids and surfaces of triangles.
//!
//! A solid is the signed sum of tetrahedra from a point to every triangle. Over a simplex of `n` dimensions and
//! measure `m`, with corners `v` and their sum `s`: `∫ x xᵀ = m (Σ v vᵀ + s sᵀ) / ((n + 1)(n + 2))`.
//!
//! B. Mirtich, Fast and Accurate Computation of Polyhedral Mass Properties, 1996.
//! J. Blow, A. Binstock, How to find the inertia tensor (or other mass properties) of a 3D solid body, 2004.
//! F. Tonon, Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor, 2004.

use nalgebra::{Matrix3, SymmetricEigen};

use crate::asset::Mesh;

use super::{MassProperties, bounds, center};

pub(super) type Point = [f64; 3];

/// A symmetric matrix: xx, yy, zz, xy, xz, yz.
type Symmetric = [f64; 6];

/// Integrals of 1, `x - origin` and its dyad over a body of unit density.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moments {
    measure: f64,
    first: Point,
    second: Symmetric,
    /// Near the body, so that little is lost to cancellation.
    origin: Point,
}

/// Of what a surface encloses, counter-clockwise from outside; negative where it is inside out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Volume(Moments);

/// Of the surface itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Area(Moments);

impl Volume {
    /// Of the tetrahedra from the middle of these triangles' bounds.
    pub fn of(positions: &[Point], triangles: &[[u32; 3]]) -> Self {
        let corners: Vec<Point> =
            triangles.iter().flatten().map(|&corner| positions[corner as usize]).collect();
        let (min, max) = bounds(&corners);
        let origin = center(min, max);
        let mut moments = Moments { origin, ..Moments::default() };
        for corners in corners.chunks_exact(3) {
            let [a, b, c] = [corners[0], corners[1], corners[2]].map(|corner| minus(corner, origin));
            let volume = dot(a, cross(b, c)) / 6.0;
            moments.add_simplex(volume, &[a, b, c], 4.0, 20.0);
        }
        Self(moments)
    }

    /// Of cubes of this side about these centres.
    pub fn of_cells(centres: &[Point], side: f64) -> Self {
        let (min, max) = bounds(centres);
        let mut moments = Moments { origin: center(min, max), ..Moments::default() };
        let (volume, own) = (side.powi(3), side.powi(5) / 12.0);
        for centre in centres {
            let offset = minus(*centre, moments.origin);
            let dyad = dyad(offset);
            moments.measure += volume;
            for (axis, value) in offset.into_iter().enumerate() {
                moments.first[axis] += volume * value;
                moments.second[axis] += own;
            }
            for (total, value) in moments.second.iter_mut().zip(dyad) {
                *total += volume * value;
            }
        }
        Self(moments)
    }

    pub fn total(&self) -> f64 {
        self.0.measure
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self(self.0.plus(&other.0))
    }

    pub fn negated(&self) -> Self {
        self.times(-1.0)
    }

    /// As if its density were `factor`.
    pub fn times(&self, factor: f64) -> Self {
        Self(Moments {
            measure: factor * self.0.measure,
            first: self.0.first.map(|value| factor * value),
            second: self.0.second.map(|value| factor * value),
            origin: self.0.origin,
        })
    }

    /// `None` where they are of no body that could be: volume not positive, or an inertia tensor whose principal
    /// moments break the triangle inequality.
    pub fn properties(&self) -> Option<MassProperties> {
        let central = self.0.central()?;
        let possible = self.0.measure > 0.0 && central.is_possible();
        possible.then(|| central.properties())
    }
}

impl Area {
    pub fn of(mesh: &Mesh, triangles: &[[u32; 3]], origin: Point) -> Self {
        let mut moments = Moments { origin, ..Moments::default() };
        for triangle in triangles {
            let corners = triangle.map(|corner| minus(mesh.positions[corner as usize], origin));
            let [a, b, c] = corners;
            let normal = cross(minus(b, a), minus(c, a));
            let area = 0.5 * norm(normal);
            moments.add_simplex(area, &corners, 3.0, 12.0);
        }
        Self(moments)
    }

    /// Zeros, about the origin of the sum, for a surface without area.
    pub fn properties(&self) -> MassProperties {
        self.0
            .central()
            .filter(|_| self.0.measure > 0.0)
            .map_or(MassProperties { measure: 0.0, centroid: self.0.origin, inertia: [0.0; 6] }, |central| {
                central.properties()
            })
    }
}

impl Moments {
    /// Adds a simplex of one corner at the origin (a solid's) or none (a surface's) and three given ones.
    fn add_simplex(&mut self, measure: f64, corners: &[Point; 3], count: f64, weight: f64) {
        let [a, b, c] = corners;
        let sum: Point = std::array::from_fn(|axis| a[axis] + b[axis] + c[axis]);
        self.measure += measure;
        for (total, value) in self.first.iter_mut().zip(sum) {
            *total += measure * value / count;
        }
        let [da, db, dc, ds] = [*a, *b, *c, sum].map(dyad);
        for (at, total) in self.second.iter_mut().enumerate() {
            *total += measure / weight * (da[at] + db[at] + dc[at] + ds[at]);
        }
    }

    fn about(&self, origin: Point) -> Self {
        let offset = minus(self.origin, origin);
        let dyad = dyad(offset);
        let [x, y, z] = self.first;
        let [dx, dy, dz] = offset;
        let cross_terms =
            [2.0 * x * dx, 2.0 * y * dy, 2.0 * z * dz, x * dy + y * dx, x * dz + z * dx, y * dz + z * dy];
        Self {
            measure: self.measure,
            first: std::array::from_fn(|axis| self.first[axis] + self.measure * offset[axis]),
            second: std::array::from_fn(|at| self.second[at] + cross_terms[at] + self.measure * dyad[at]),
            origin,
        }
    }

    fn plus(&self, other: &Self) -> Self {
        if self.measure == 0.0 && self.first == [0.0; 3] {
            return *other;
        }
        let other = other.about(self.origin);
        Self {
            measure: self.measure + other.measure,
            first: std::array::from_fn(|axis| self.first[axis] + other.first[axis]),
            second: std::array::from_fn(|at| self.second[at] + other.second[at]),
            origin: self.origin,
        }
    }

    /// About the centroid; `None` where the sums are not finite or there is nothing.
    fn central(&self) -> Option<Self> {
        let centroid: Point = std::array::from_fn(|axis| self.origin[axis] + self.first[axis] / self.measure);
        let central = self.about(centroid);
        let finite = central.second.iter().chain(&centroid).all(|value| value.is_finite());
        finite.then_some(Self { first: [0.0; 3], ..central })
    }

    /// The second moments of any mass are positive semidefinite, which is the triangle inequality of its principal
    /// moments of inertia.
    fn is_possible(&self) -> bool {
        let [xx, yy, zz, xy, xz, yz] = self.second;
        let matrix = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let largest = xx.abs().max(yy.abs()).max(zz.abs());
        let scaled = if largest > 0.0 { matrix / largest } else { matrix };
        SymmetricEigen::new(scaled).eigenvalues.iter().all(|&value| value >= -1e-9)
    }

    fn properties(&self) -> MassProperties {
        let [xx, yy, zz, xy, xz, yz] = self.second;
        MassProperties {
            measure: self.measure,
            centroid: self.origin,
            inertia: [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz],
        }
    }
}

fn dyad([x, y, z]: Point) -> Symmetric {
    [x * x, y * y, z * z, x * y, x * z, y * z]
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}
