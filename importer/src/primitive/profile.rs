//! Mass properties of analytical shapes, in closed form.
//!
//! All but the box are shapes of revolution about Y whose profile is made of straight lines and arcs. Along each
//! stretch every integrand is a polynomial of degree five or less in the height, so three Gauss points are exact.

use std::f64::consts::{PI, TAU};

use crate::measure::MassProperties;

use super::PrimitiveForm;

/// A piece of a profile from `from` to `to` along Y.
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
    pub curve: Curve,
}

pub(super) enum Curve {
    /// Radii at the ends.
    Line(f64, f64),
    /// On a sphere of this centre and radius.
    Arc { centre: f64, radius: f64 },
}

/// Moments of a shape of revolution: measure, along the axis first and second, across the axis second.
#[derive(Default)]
struct Sums {
    measure: f64,
    along: f64,
    along_squared: f64,
    across_squared: f64,
}

impl Curve {
    fn radius(&self, from: f64, to: f64, y: f64) -> f64 {
        match self {
            Self::Line(start, end) => start + (end - start) * (y - from) / (to - from),
            Self::Arc { centre, radius } => (radius * radius - (y - centre) * (y - centre)).max(0.0).sqrt(),
        }
    }

    /// Radius times the length of the curve for a step along Y.
    fn radius_times_slope(&self, from: f64, to: f64, y: f64) -> f64 {
        match self {
            Self::Line(start, end) => {
                let slope = (end - start) / (to - from);
                self.radius(from, to, y) * slope.hypot(1.0)
            }
            Self::Arc { radius, .. } => *radius,
        }
    }
}

impl Stretch {
    /// Gauss-Legendre of three points: exact to degree five.
    fn integrate(&self, mut each: impl FnMut(f64, f64)) {
        let (middle, half) = (0.5 * (self.from + self.to), 0.5 * (self.to - self.from));
        let far = 0.6_f64.sqrt();
        for (at, weight) in [(-far, 5.0 / 9.0), (0.0, 8.0 / 9.0), (far, 5.0 / 9.0)] {
            each(middle + half * at, half * weight);
        }
    }
}

impl Sums {
    fn add(&mut self, measure: f64, y: f64, across_squared: f64) {
        self.measure += measure;
        self.along += measure * y;
        self.along_squared += measure * y * y;
        self.across_squared += across_squared;
    }

    /// Symmetric about Y: `across_squared` is ∫ x² = ∫ z².
    fn properties(&self) -> MassProperties {
        let middle = self.along / self.measure;
        let along = self.along_squared - self.measure * middle * middle;
        let across = self.across_squared;
        MassProperties {
            measure: self.measure,
            centroid: [0.0, middle, 0.0],
            inertia: [along + across, 2.0 * across, along + across, 0.0, 0.0, 0.0],
        }
    }
}

/// Where the common tangent cone touches, then cap, cone, cap. One sphere within the other stands alone.
fn capsule(height: f64, bottom: f64, top: f64) -> Vec<Stretch> {
    let (low, high) = (-0.5 * height, 0.5 * height);
    if (bottom - top).abs() >= height {
        let (centre, radius) = if bottom >= top { (low, bottom) } else { (high, top) };
        return vec![Stretch {
            from: centre - radius,
            to: centre + radius,
            curve: Curve::Arc { centre, radius },
        }];
    }
    let sine = (bottom - top) / height;
    let cosine = (1.0 - sine * sine).sqrt();
    let (from, to) = (low + bottom * sine, high + top * sine);
    vec![
        Stretch { from: low - bottom, to: from, curve: Curve::Arc { centre: low, radius: bottom } },
        Stretch { from, to, curve: Curve::Line(bottom * cosine, top * cosine) },
        Stretch { from: to, to: high + top, curve: Curve::Arc { centre: high, radius: top } },
    ]
}

/// From bottom to top; empty for a box.
pub(super) fn profile(form: &PrimitiveForm) -> Vec<Stretch> {
    match *form {
        PrimitiveForm::Box { .. } => Vec::new(),
        PrimitiveForm::Sphere { radius } => {
            vec![Stretch { from: -radius, to: radius, curve: Curve::Arc { centre: 0.0, radius } }]
        }
        PrimitiveForm::Cylinder { height, bottom, top } => {
            vec![Stretch { from: -0.5 * height, to: 0.5 * height, curve: Curve::Line(bottom, top) }]
        }
        PrimitiveForm::Capsule { height, bottom, top } => capsule(height, bottom, top),
    }
}

/// Of unit density, in the shape's own frame: the solid and the surface.
pub(super) fn mass_properties(form: &PrimitiveForm) -> (MassProperties, MassProperties) {
    if let PrimitiveForm::Box { size } = *form {
        return of_box(size);
    }
    let (mut solid, mut surface) = (Sums::default(), Sums::default());
    for stretch in &profile(form) {
        let (from, to) = (stretch.from, stretch.to);
        stretch.integrate(|y, weight| {
            let radius = stretch.curve.radius(from, to, y);
            let disc = PI * radius * radius * weight;
            solid.add(disc, y, 0.25 * disc * radius * radius);
            let band = TAU * stretch.curve.radius_times_slope(from, to, y) * weight;
            surface.add(band, y, 0.5 * band * radius * radius);
        });
    }
    if let PrimitiveForm::Cylinder { height, bottom, top } = *form {
        for (y, radius) in [(-0.5 * height, bottom), (0.5 * height, top)] {
            let disc = PI * radius * radius;
            surface.add(disc, y, 0.25 * disc * radius * radius);
        }
    }
    (solid.properties(), surface.properties())
}

fn of_box([a, b, c]: [f64; 3]) -> (MassProperties, MassProperties) {
    let volume = a * b * c;
    let (aa, bb, cc) = (a * a, b * b, c * c);
    let solid = [bb + cc, aa + cc, aa + bb].map(|sum| volume * sum / 12.0);
    // ∫ x² over the two faces across x, and over the four along it.
    let second = |a: f64, b: f64, c: f64| b * c * a * a / 2.0 + (a * b + a * c) * a * a / 6.0;
    let (xx, yy, zz) = (second(a, b, c), second(b, c, a), second(c, a, b));
    let properties = |measure: f64, [x, y, z]: [f64; 3]| MassProperties {
        measure,
        centroid: [0.0; 3],
        inertia: [x, y, z, 0.0, 0.0, 0.0],
    };
    (properties(volume, solid), properties(2.0 * (a * b + b * c + c * a), [yy + zz, xx + zz, xx + yy]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{found} for {expected}");
    }

    #[test]
    fn spheres_cylinders_cones_and_capsules_are_those_of_the_tables() {
        let (solid, surface) = mass_properties(&PrimitiveForm::Sphere { radius: 2.0 });
        near(solid.measure, 32.0 / 3.0 * PI);
        near(solid.inertia[0], 0.4 * solid.measure * 4.0);
        near(solid.inertia[1], solid.inertia[0]);
        near(surface.measure, 16.0 * PI);
        near(surface.inertia[1], 2.0 / 3.0 * surface.measure * 4.0);

        let (solid, surface) =
            mass_properties(&PrimitiveForm::Cylinder { height: 3.0, bottom: 2.0, top: 2.0 });
        near(solid.measure, 12.0 * PI);
        near(solid.inertia[1], 0.5 * solid.measure * 4.0);
        near(solid.inertia[0], solid.measure * (3.0 * 4.0 + 9.0) / 12.0);
        near(surface.measure, 20.0 * PI);

        let (solid, _) = mass_properties(&PrimitiveForm::Cylinder { height: 4.0, bottom: 1.0, top: 0.0 });
        near(solid.measure, 4.0 / 3.0 * PI);
        near(solid.centroid[1], -1.0);
        near(solid.inertia[1], 0.3 * solid.measure);

        let (solid, surface) =
            mass_properties(&PrimitiveForm::Capsule { height: 3.0, bottom: 0.5, top: 0.5 });
        near(solid.measure, PI * 0.25 * 3.0 + PI / 6.0);
        near(surface.measure, TAU * 0.5 * 3.0 + PI);
    }

    #[test]
    fn a_tapered_capsule_with_one_sphere_inside_the_other_is_the_larger() {
        let (solid, _) = mass_properties(&PrimitiveForm::Capsule { height: 0.2, bottom: 1.0, top: 0.5 });
        near(solid.measure, 4.0 / 3.0 * PI);
        near(solid.centroid[1], -0.1);
    }
}
