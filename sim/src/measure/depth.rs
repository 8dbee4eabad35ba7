//! How deep bodies of a scene overlap, from their poses.
//!
//! Boxes and hulls by all separating axes (15 for two boxes), spheres and capsules by exact distances, cylinders
//! and cones by their support functions, half-spaces by the support function, static meshes and height fields by the
//! nearest triangle.

use super::posed::{Posed, Solid, overlap};
use super::support::Plane;
use super::terrain::Terrain;
use crate::math::{Frame3, Vec3};
use crate::scene::{Motion, Pose, Scene, Shape};

/// Two entities that overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    pub a: u32,
    pub b: u32,
    /// m, the shortest way to part them
    pub depth_m: f64,
}

struct Child {
    entity: u32,
    dynamic: bool,
    body_from_shape: Frame3,
    solid: Solid,
}

/// The shapes of a scene, ready to be measured at any poses. Half-spaces and meshes stay where the scene has them.
pub struct Depths {
    children: Vec<Child>,
    planes: Vec<(u32, Plane)>,
    terrains: Vec<(u32, Terrain)>,
}

impl Depths {
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut depths = Self { children: Vec::new(), planes: Vec::new(), terrains: Vec::new() };
        for (index, entity) in (0..).zip(&scene.entities) {
            depths.planes.extend(Plane::of(entity).map(|plane| (index, plane)));
            let world_from_body = Frame3::from(&entity.pose);
            for child in &entity.shapes {
                let body_from_shape = Frame3::from(&child.body_from_shape);
                let frame = world_from_body.compose(&body_from_shape);
                if let Shape::TriangleMesh { positions, triangles } = &child.shape {
                    depths.terrains.push((index, Terrain::new(positions, triangles, &frame)));
                } else if let Shape::HeightField(field) = &child.shape {
                    let (positions, triangles) = field.mesh();
                    depths.terrains.push((index, Terrain::new(&positions, &triangles, &frame)));
                } else if let Some(solid) = Solid::new(&child.shape) {
                    let dynamic = matches!(entity.motion, Motion::Dynamic(_));
                    depths.children.push(Child { entity: index, dynamic, body_from_shape, solid });
                }
            }
        }
        depths
    }

    /// The deepest overlap at these poses (world from body, one an entity), if any two bodies overlap.
    #[must_use]
    pub fn deepest(&self, poses: &[Pose]) -> Option<Overlap> {
        let mut deepest: Option<Overlap> = None;
        self.visit(poses, true, |found| {
            if deepest.is_none_or(|known| found.depth_m > known.depth_m) {
                deepest = Some(found);
            }
            deepest.map_or(0.0, |known| known.depth_m)
        });
        deepest
    }

    /// Every overlap of two shapes at these poses.
    #[must_use]
    pub fn all(&self, poses: &[Pose]) -> Vec<Overlap> {
        let mut all = Vec::new();
        self.visit(poses, false, |found| {
            all.push(found);
            0.0
        });
        all
    }

    /// Calls `see` for overlaps deeper than what it last returned; the cheap ones first where only the `deepest`
    /// counts.
    fn visit(&self, poses: &[Pose], deepest: bool, mut see: impl FnMut(Overlap) -> f64) {
        let mut floor = 0.0;
        let mut found = |a: u32, b: u32, depth_m: f64, floor: &mut f64| {
            if depth_m > *floor {
                let next = see(Overlap { a: a.min(b), b: a.max(b), depth_m });
                *floor = if deepest { next } else { 0.0 };
            }
        };
        let mut posed: Vec<(&Child, Posed<'_>)> = self
            .children
            .iter()
            .filter_map(|child| {
                let pose = poses.get(child.entity as usize)?;
                let frame = Frame3::from(pose).compose(&child.body_from_shape);
                frame.position.iter().all(|x| x.is_finite()).then(|| (child, child.solid.at(&frame)))
            })
            .collect();
        for (child, shape) in posed.iter().filter(|(child, _)| child.dynamic) {
            for (entity, plane) in &self.planes {
                let normal = Vec3::from(plane.normal);
                let height =
                    normal.dot(&(shape.position - Vec3::from(plane.point))) - shape.support(&-normal);
                found(child.entity, *entity, -height, &mut floor);
            }
            for (entity, terrain) in &self.terrains {
                found(child.entity, *entity, terrain.depth(shape), &mut floor);
            }
        }
        let axis = widest(posed.iter().map(|(_, shape)| shape.position));
        posed.sort_by(|(_, a), (_, b)| a.min[axis].total_cmp(&b.min[axis]));
        for (i, (child, shape)) in posed.iter().enumerate() {
            for (other_child, other) in
                posed[i + 1..].iter().take_while(|(_, o)| o.min[axis] <= shape.max[axis])
            {
                if child.entity == other_child.entity
                    || !(child.dynamic || other_child.dynamic)
                    || !shape.near(other)
                {
                    continue;
                }
                if let Some(depth_m) = overlap(shape, other, floor) {
                    found(child.entity, other_child.entity, depth_m, &mut floor);
                }
            }
        }
    }
}

/// The axis along which points vary most.
fn widest(points: impl Iterator<Item = Vec3> + Clone) -> usize {
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let n = points.clone().count().max(1) as f64;
    let mean = points.clone().sum::<Vec3>() / n;
    let spread = points.map(|point| (point - mean).map(|x| x * x)).sum::<Vec3>();
    spread.imax()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]
mod tests {
    use super::*;
    use crate::gallery::build::{body, cube, cuboid, cylinder, fixed, floor, scene, sphere};
    use crate::scene::{Entity, Mass, Surface};

    const S: Surface = Surface::new(0.5, 0.0);
    const MASS: Mass = Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0] };

    fn turned(mut entity: Entity, axis: [f64; 3], degrees: f64) -> Entity {
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        entity.pose.rotation = [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos];
        entity
    }

    fn depth(entities: Vec<Entity>) -> f64 {
        let scene = scene("depth", entities);
        let poses: Vec<Pose> = scene.entities.iter().map(|entity| entity.pose).collect();
        Depths::new(&scene).deepest(&poses).map_or(0.0, |overlap| overlap.depth_m)
    }

    fn capsule(position: [f64; 3]) -> Entity {
        body("capsule", MASS, position, Shape::Capsule { half_height: 0.5, radius: 0.25 }, S)
    }

    fn assert_depth(entities: Vec<Entity>, expected: f64, what: &str) {
        let found = depth(entities);
        assert!((found - expected).abs() < 1e-9, "{what}: {found} m, expected {expected} m");
    }

    #[test]
    fn boxes_overlap_as_their_nearest_faces_or_edges_say() {
        assert_depth(vec![cube([0.0; 3], S), cube([0.9, 0.3, 0.2], S)], 0.1, "face to face");
        assert_depth(vec![cube([0.0; 3], S), cube([1.01, 0.0, 0.0], S)], 0.0, "apart");
        // One turned by 45 degrees about z: its edge points at the other's face.
        let edge = 0.5f64.sqrt();
        let other = turned(cube([0.5 + edge - 0.05, 0.0, 0.0], S), [0.0, 0.0, 1.0], 45.0);
        assert_depth(vec![cube([0.0; 3], S), other], 0.05, "edge on face");
        // Two edges that cross at a right angle: the diagonals of both lie along x.
        let a = turned(cuboid([0.0; 3], [0.5; 3], 1000.0, S), [0.0, 0.0, 1.0], 45.0);
        let b = turned(cuboid([2.0 * edge - 0.02, 0.0, 0.0], [0.5; 3], 1000.0, S), [0.0, 1.0, 0.0], 45.0);
        assert_depth(vec![a, b], 0.02, "edge across edge");
    }

    #[test]
    fn a_hull_of_a_box_s_corners_measures_as_the_box() {
        let corners =
            (0..8).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 0.5 } else { -0.5 })).collect();
        for (position, axis, degrees) in
            [([0.7, 0.6, 0.3], [0.0, 0.6, 0.8], 33.0), ([0.2, 0.9, -0.4], [1.0, 0.0, 0.0], 71.0)]
        {
            let as_box = vec![cube([0.0; 3], S), turned(cube(position, S), axis, degrees)];
            let shape = Shape::Hull { points: Vec::clone(&corners) };
            let hull = turned(body("hull", MASS, position, shape, S), axis, degrees);
            let (expected, found) = (depth(as_box), depth(vec![cube([0.0; 3], S), hull]));
            assert!(expected > 0.01 && (found - expected).abs() < 1e-12, "{found} of {expected}");
        }
    }

    #[test]
    fn round_things_overlap_by_their_distance() {
        assert_depth(
            vec![sphere([0.0; 3], 0.5, 1.0, S), sphere([0.6, 0.0, 0.8 - 0.1], 0.5, 1.0, S)],
            1.0 - 0.85f64.sqrt(),
            "spheres",
        );
        assert_depth(
            vec![cube([0.0; 3], S), sphere([1.2, 0.9, 0.0], 0.9, 1.0, S)],
            0.9 - 0.65f64.sqrt(),
            "corner",
        );
        assert_depth(vec![cube([0.0; 3], S), sphere([0.4, 0.0, 0.0], 0.3, 1.0, S)], 0.4, "centre inside");
        assert_depth(vec![cube([0.0; 3], S), capsule([0.7, 0.0, 0.0])], 0.05, "capsule along a face");
        assert_depth(
            vec![capsule([0.0; 3]), turned(capsule([0.4, 0.0, 0.0]), [1.0, 0.0, 0.0], 90.0)],
            0.1,
            "crossed capsules",
        );
        assert_depth(vec![floor(S), turned(capsule([0.0, 0.2, 0.0]), [0.0, 0.0, 1.0], 90.0)], 0.05, "lying");
    }

    #[test]
    fn cylinders_and_cones_overlap_by_side_rim_and_end() {
        let can = |position| cylinder(position, 0.5, 0.5, 1000.0, S);
        assert_depth(vec![can([0.0; 3]), cube([0.0, 0.98, 0.0], S)], 0.02, "box on its end");
        assert_depth(vec![can([0.0; 3]), can([0.6, 0.3, 0.7])], 1.0 - 0.85f64.sqrt(), "side to side");
        assert_depth(vec![can([0.0; 3]), sphere([0.0, 0.95, 0.0], 0.5, 1.0, S)], 0.05, "sphere on its end");
        assert_depth(
            vec![can([0.0; 3]), turned(can([0.95, 0.0, 0.0]), [1.0, 0.0, 0.0], 90.0)],
            0.05,
            "crossed",
        );
        // A rim that points down: half height times cos plus radius times sin.
        let lean = 30f64.to_radians();
        let low = 0.5 * lean.cos() + 0.5 * lean.sin();
        let leaning = turned(can([0.0, 0.5 + low - 0.03, 0.0]), [0.0, 0.0, 1.0], 30.0);
        assert_depth(vec![cuboid([0.0; 3], [3.0, 0.5, 3.0], 1.0, S), leaning], 0.03, "rim on face");
        let cone = |position| body("cone", MASS, position, Shape::Cone { half_height: 0.5, radius: 0.5 }, S);
        assert_depth(vec![cube([0.0; 3], S), cone([0.0, 0.97, 0.0])], 0.03, "cone on its base");
        assert_depth(vec![cube([0.0, 0.97, 0.0], S), cone([0.0; 3])], 0.03, "tip below a face");
        // A ball beside the middle of its side, whose normal is (2, 1) / √5.
        let (away, beside) = (0.25 - 0.01, 5.0_f64.sqrt());
        let ball = sphere([0.25 + 2.0 * away / beside, away / beside, 0.0], 0.25, 1.0, S);
        assert_depth(vec![cone([0.0; 3]), ball], 0.01, "ball on a cone's side");
        let found = depth(vec![cube([0.0; 3], S), turned(can([0.85, 0.85, 0.0]), [0.0, 0.0, 1.0], 20.0)]);
        let (sin, cos) = 20f64.to_radians().sin_cos();
        assert!((found - (0.5 - 0.35 * (sin + cos))).abs() < 1e-6, "side on edge: {found}");
    }

    #[test]
    fn a_mesh_is_as_deep_as_the_ground_that_it_paves() {
        let positions: Vec<[f64; 3]> =
            (0..5).flat_map(|i| (0..5).map(move |k| [f64::from(i) - 2.0, 0.0, f64::from(k) - 2.0])).collect();
        let triangles = (0..4_u32)
            .flat_map(|i| (0..4_u32).map(move |k| i * 5 + k))
            .flat_map(|n| [[n, n + 1, n + 5], [n + 5, n + 1, n + 6]])
            .collect();
        let ground = fixed("ground", Pose::IDENTITY, Shape::TriangleMesh { positions, triangles }, S);
        let on = |entity: Entity| depth(vec![ground.clone(), entity]);
        for (entity, what) in [
            (cube([0.2, 0.49, 0.3], S), "cube"),
            (sphere([0.3, 0.49, 0.1], 0.5, 1.0, S), "sphere"),
            (capsule([0.1, 0.74, 0.1]), "capsule"),
            (cylinder([0.1, 0.49, 0.1], 0.5, 0.5, 1.0, S), "cylinder"),
        ] {
            assert!((on(entity) - 0.01).abs() < 1e-9, "{what}");
        }
        assert!(on(cube([0.0, 0.51, 0.0], S)) == 0.0);
    }

    #[test]
    fn the_deepest_is_the_deepest_of_all_and_static_pairs_do_not_count() {
        let wall = |x: f64| fixed("wall", Pose::at([x, 0.0, 0.0]), Shape::Box { half_extents: [0.5; 3] }, S);
        let scene =
            scene("many", vec![wall(0.0), wall(0.2), cube([0.95, 0.0, 0.0], S), cube([1.9, 0.0, 0.0], S)]);
        let poses: Vec<Pose> = scene.entities.iter().map(|entity| entity.pose).collect();
        let depths = Depths::new(&scene);
        let all = depths.all(&poses);
        assert_eq!(all.len(), 3, "{all:?}");
        let deepest = depths.deepest(&poses).unwrap();
        assert_eq!((deepest.a, deepest.b), (1, 2));
        assert!((deepest.depth_m - 0.25).abs() < 1e-12);
    }
}
