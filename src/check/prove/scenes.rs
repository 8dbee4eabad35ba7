//! The scenes of the trials, made from the one in which a model is dropped.

use sim::{Entity, Pose, Scene, measure};

use super::base;

/// Index of the body in a drop scene; the floor is 0.
pub(super) const BODY: usize = 1;

/// A slope is gravity tilted over a level floor: the same physics, and the pose at rest can be kept as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// Unit, level: the way down.
    pub down: [f64; 3],
    pub angle_rad: f64,
}

/// With its lowest point at `clearance_m` above the floor, upright as it was modelled.
pub(super) fn above(scene: &Scene, clearance_m: f64) -> Scene {
    placed(scene, Pose::IDENTITY, clearance_m)
}

/// With the rotation of `pose`, at its level position, its lowest point at `clearance_m` above the floor.
pub(super) fn placed(scene: &Scene, pose: Pose, clearance_m: f64) -> Scene {
    let mut scene = scene.clone();
    if let Some(body) = scene.entities.get_mut(BODY) {
        let low = base::lowest(&body.shapes, &Pose { position: [0.0; 3], ..pose });
        body.pose = Pose { position: [pose.position[0], clearance_m - low, pose.position[2]], ..pose };
    }
    scene
}

/// In exactly this pose, at rest.
pub(super) fn resting(scene: &Scene, pose: Pose) -> Scene {
    let mut scene = scene.clone();
    if let Some(body) = scene.entities.get_mut(BODY) {
        body.pose = pose;
    }
    scene
}

/// The same floor as a slope.
pub(super) fn tilted(scene: &Scene, tilt: Tilt) -> Scene {
    let mut scene = scene.clone();
    let g = measure::length(scene.gravity);
    let (sin, cos) = tilt.angle_rad.sin_cos();
    scene.gravity = [g * sin * tilt.down[0], -g * cos, g * sin * tilt.down[2]];
    scene
}

/// `count` of them on each other, upright, touching.
pub(super) fn stacked(scene: &Scene, count: usize) -> Scene {
    let mut scene = above(scene, 0.0);
    let Some(body) = scene.entities.get(BODY).cloned() else { return scene };
    let height = height(&body);
    scene.entities.truncate(BODY);
    for level in 0..count {
        let mut copy = body.clone();
        copy.name = format!("{} {level}", body.name);
        #[expect(clippy::cast_precision_loss, reason = "a count of three")]
        let up = height * level as f64;
        copy.pose.position[1] += up;
        scene.entities.push(copy);
    }
    scene
}

/// Of the body as it stands in its pose, m.
pub(super) fn height(body: &Entity) -> f64 {
    let high = measure::body_support(&body.shapes, &body.pose, [0.0, 1.0, 0.0]).unwrap_or(0.0);
    high - base::lowest(&body.shapes, &body.pose)
}
