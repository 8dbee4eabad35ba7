//! Analytical shapes: their triangles for the eye and the colliders, their mass properties in closed form.

mod lathe;
mod profile;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::asset::Mesh;
use crate::measure::MassProperties;

/// A shape in its own frame: about the origin, its axis Y. Lengths in file units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PrimitiveForm {
    /// Full extents.
    Box {
        size: [f64; 3],
    },
    Sphere {
        radius: f64,
    },
    /// A cone frustum where the radii differ, a cone where one of them is 0.
    Cylinder {
        height: f64,
        bottom: f64,
        top: f64,
    },
    /// The hull of two spheres, their centres `height` apart.
    Capsule {
        height: f64,
        bottom: f64,
        top: f64,
    },
}

/// A shape in its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Primitive {
    pub form: PrimitiveForm,
    /// Images of the three axes, then the translation.
    pub transform: [[f64; 3]; 4],
}

impl PrimitiveForm {
    /// Whether it has a size that could be.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let fine = |value: f64| value.is_finite() && value > 0.0 && value < 1e12;
        let round = |height: f64, bottom: f64, top: f64| {
            height.is_finite() && height < 1e12 && bottom >= 0.0 && top >= 0.0 && fine(bottom.max(top))
        };
        match *self {
            Self::Box { size } => size.into_iter().all(fine),
            Self::Sphere { radius } => fine(radius),
            Self::Cylinder { height, bottom, top } => fine(height) && round(height, bottom, top),
            // Two spheres, one within the other, are one sphere: `height` may be nothing.
            Self::Capsule { height, bottom, top } => height >= 0.0 && round(height, bottom, top),
        }
    }
}

impl Primitive {
    /// Closed, counter-clockwise from outside, in its place.
    #[must_use]
    pub fn mesh(&self) -> Mesh {
        let (axes, offset) = self.parts();
        let mut mesh = lathe::mesh(&self.form);
        for position in &mut mesh.positions {
            *position = (axes * Vector3::from(*position) + offset).into();
        }
        if axes.determinant() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        mesh
    }

    /// Of unit density, in its place: the solid, and the surface where the transform keeps its form.
    #[must_use]
    pub fn mass_properties(&self) -> (MassProperties, Option<MassProperties>) {
        let (axes, offset) = self.parts();
        let (solid, surface) = profile::mass_properties(&self.form);
        let scale = axes.determinant().abs().cbrt();
        let squares = axes.transpose() * axes / (scale * scale);
        let is_similar = (squares - Matrix3::identity()).amax() < 1e-9;
        let surface = is_similar.then(|| moved(&surface, &axes, &offset, scale * scale));
        (moved(&solid, &axes, &offset, scale.powi(3)), surface)
    }

    fn parts(&self) -> (Matrix3<f64>, Vector3<f64>) {
        let [x, y, z, offset] = self.transform.map(Vector3::from);
        (Matrix3::from_columns(&[x, y, z]), offset)
    }
}

/// Second moments go with the axes on both sides: `∫ x xᵀ` of the image is `growth A (∫ x xᵀ) Aᵀ`.
fn moved(of: &MassProperties, axes: &Matrix3<f64>, offset: &Vector3<f64>, growth: f64) -> MassProperties {
    let [xx, yy, zz, xy, xz, yz] = of.inertia;
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let second = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    let second = axes * second * axes.transpose() * growth;
    let inertia = Matrix3::identity() * second.trace() - second;
    MassProperties {
        measure: of.measure * growth,
        centroid: (axes * Vector3::from(of.centroid) + offset).into(),
        inertia: [
            inertia[(0, 0)],
            inertia[(1, 1)],
            inertia[(2, 2)],
            inertia[(0, 1)],
            inertia[(0, 2)],
            inertia[(1, 2)],
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{measure, weld};

    #[test]
    fn triangles_come_to_the_closed_form() {
        // A turn, a stretch, a mirror and a shift.
        let transform = [[0.0, 2.0, 0.0], [-1.0, 0.0, 0.5], [0.0, 0.0, 3.0], [7.0, -8.0, 9.0]];
        for form in [
            PrimitiveForm::Box { size: [1.0, 2.0, 3.0] },
            PrimitiveForm::Sphere { radius: 1.5 },
            PrimitiveForm::Cylinder { height: 3.0, bottom: 1.0, top: 0.4 },
            PrimitiveForm::Cylinder { height: 3.0, bottom: 0.0, top: 1.0 },
            PrimitiveForm::Capsule { height: 2.0, bottom: 0.5, top: 0.5 },
            PrimitiveForm::Capsule { height: 2.0, bottom: 0.9, top: 0.3 },
        ] {
            let primitive = Primitive { form, transform };
            let measures = measure(&weld(&primitive.mesh()));
            assert!(measures.closed && measures.wound_consistently, "{form:?}");
            let (exact, _) = primitive.mass_properties();
            let found = measures.solid.unwrap();
            assert_eq!(measures.inside_out_bodies, 0, "{form:?}");
            assert!((found.measure / exact.measure - 1.0).abs() < 6e-3, "{form:?}");
            for (found, exact) in found.centroid.into_iter().zip(exact.centroid) {
                assert!((found - exact).abs() < 1e-2, "{form:?}: {found} for {exact}");
            }
            for axis in 0..3 {
                assert!((found.inertia[axis] / exact.inertia[axis] - 1.0).abs() < 1.5e-2, "{form:?}");
            }
        }
    }
}
