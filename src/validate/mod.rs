//! The same scene in rapier, and what the two engines agree on.

#[cfg(feature = "validate")]
mod rapier;
mod verdict;

use serde::{Deserialize, Serialize};
use sim::{Scene, Shape, measure};

use crate::settle::{Outcome, Rest};

#[cfg(feature = "validate")]
pub use rapier::{parameters, run_rapier};
pub use verdict::{Verdict, judge};

/// One setting as both engines have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Parameter {
    pub name: String,
    pub ours: String,
    pub rapier: String,
}

/// One model's drop in rapier, and what came of comparing it with ours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    pub verdict: Verdict,
    pub rapier: Outcome,
    /// Where they differ: whether they agree once no surface bounces. Which way a tall thing tips after landing
    /// on several points at once is where engines differ most.
    pub agrees_without_restitution: Option<bool>,
    /// Corners of the hull's face that it stands on in ours.
    pub corners_under: usize,
}

impl Comparison {
    /// What differs, in a line; empty where nothing does.
    #[must_use]
    pub fn difference(&self) -> String {
        let bounce = match self.agrees_without_restitution {
            Some(true) => "; alike where nothing bounces",
            Some(false) => "; also where nothing bounces",
            None => "",
        };
        let corners = if self.rapier_lost_corners() {
            format!(
                "; stands on a face of {} corners, of which rapier keeps {RAPIER_CORNERS}",
                self.corners_under
            )
        } else {
            String::new()
        };
        if self.verdict.agrees { String::new() } else { format!("{}{bounce}{corners}", self.verdict.remark) }
    }

    /// It tipped over in rapier from a face that rapier does not hold whole.
    #[must_use]
    pub fn rapier_lost_corners(&self) -> bool {
        let Verdict { agrees, ours, rapier, .. } = &self.verdict;
        !agrees && self.corners_under > RAPIER_CORNERS && ours.settled && ours.tipped_deg < rapier.tipped_deg
    }
}

/// Corners of a hull's face that rapier keeps in a manifold: the first four, which lie side by side, so that a
/// prism of six sides or more falls over (parry3d 0.31.1, `ConvexPolyhedron::local_support_feature`).
const RAPIER_CORNERS: usize = 4;

/// How near to the lowest point a corner counts as one that the body stands on, as a share of its size.
const CORNER_SHARE: f64 = 1e-3;

/// The most corners of any hull of the body on which it stands.
#[must_use]
pub fn corners_under(scene: &Scene, rest: &Rest) -> usize {
    let Some(entity) = scene.entities.get(rest.entity) else { return 0 };
    let down = |point: [f64; 3]| measure::dot(point, rest.down);
    let hulls: Vec<Vec<f64>> = entity
        .shapes
        .iter()
        .filter_map(|child| {
            let Shape::Hull { points } = &child.shape else { return None };
            Some(
                points.iter().map(|&point| down(measure::transform(&child.body_from_shape, point))).collect(),
            )
        })
        .collect();
    let lowest = hulls.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
    let near = |depths: &Vec<f64>| {
        depths.iter().filter(|&&depth| lowest - depth <= CORNER_SHARE * rest.size_m).count()
    };
    hulls.iter().map(near).max().unwrap_or(0)
}

/// The same scene with every restitution 0.
#[must_use]
pub fn without_restitution(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for child in scene.entities.iter_mut().flat_map(|entity| &mut entity.shapes) {
        child.surface.restitution = 0.0;
    }
    for pair in &mut scene.pairs {
        pair.restitution = Some(0.0);
    }
    scene
}

#[cfg(test)]
mod tests {
    use sim::{ChildShape, Entity, Motion, Pose, Surface, Velocity};

    use super::*;

    #[test]
    fn the_corners_that_a_prism_stands_on_are_those_of_its_base() {
        let corner = |k: u32, y: f64| {
            let angle = std::f64::consts::TAU * f64::from(k) / 6.0;
            [0.1 * angle.cos(), y, 0.1 * angle.sin()]
        };
        let points = (0..6).flat_map(|k| [corner(k, -0.3), corner(k, 0.3)]).collect();
        let child = ChildShape {
            shape: Shape::Hull { points },
            body_from_shape: Pose::IDENTITY,
            surface: Surface::new(0.5, 0.4),
            part: 0,
        };
        let entity = Entity {
            name: "prism".to_owned(),
            motion: Motion::Static,
            pose: Pose::IDENTITY,
            velocity: Velocity::default(),
            shapes: vec![child],
        };
        let scene = Scene::new("", vec![entity]);
        let rest = |down| verdict::tests::rest(0.3, down);
        let under = |down| corners_under(&scene, &Rest { entity: 0, size_m: 0.6, ..rest(down) });
        assert_eq!(under([0.0, -1.0, 0.0]), 6);
        let side = std::f64::consts::FRAC_PI_6;
        assert_eq!(under([side.cos(), 0.0, side.sin()]), 4);
        assert_eq!(without_restitution(&scene).entities[0].shapes[0].surface.restitution, 0.0);
    }
}
