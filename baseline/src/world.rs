//! A scene as rapier holds it.

use rapier3d::dynamics::{CoefficientCombineRule, FrictionModel};
use rapier3d::prelude::{
    ActiveHooks, ColliderBuilder, ContactModificationContext, ModifiableContacts, PhysicsHooks, PhysicsWorld,
    RigidBody, RigidBodyHandle,
};
use sim::{Change, MaterialPair, Pose, Scene, Settings, Velocity, measure};

use super::convert::{body, pose, shape, vector};

/// Largest length unit, m: what rapier's own tolerances are made for.
pub const LARGEST_LENGTH_UNIT_M: f64 = 1.0;

/// A scene as rapier holds it, stepped by the caller.
pub struct Baseline {
    world: PhysicsWorld,
    pairs: KnownPairs,
    /// Of entity `i` of the scene.
    handles: Vec<RigidBodyHandle>,
    dynamic: Vec<bool>,
    /// Not yet done, the next one last.
    actions: Vec<sim::Action>,
    dt_s: f64,
    steps: u64,
}

/// User data of a collider of no known material.
const NO_MATERIAL: u128 = u128::MAX;

/// Gives contacts of known pairs of materials their coefficients.
struct KnownPairs(Vec<MaterialPair>);

impl PhysicsHooks for KnownPairs {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let material = |handle| context.colliders.get(handle).map(|collider| collider.user_data);
        let (Some(a), Some(b)) = (material(context.collider1), material(context.collider2)) else { return };
        let same = |pair: &&MaterialPair| {
            let [one, other] = pair.between.map(u128::from);
            (one, other) == (a, b) || (other, one) == (a, b)
        };
        let Some(pair) = self.0.iter().find(same) else { return };
        let ModifiableContacts::Rigid(contacts) = &mut context.contacts else { return };
        if let Some(friction) = pair.friction {
            *contacts.friction = friction as f32;
        }
        if let Some(restitution) = pair.restitution {
            *contacts.restitution = restitution as f32;
        }
    }
}

impl Baseline {
    /// # Errors
    /// A shape that rapier cannot hold: which and why.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, String> {
        Self::stiffer(scene, settings, 1.0)
    }

    /// The same with the frequencies of the contact springs `stiffness` times rapier's defaults.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn stiffer(scene: &Scene, settings: &Settings, stiffness: f64) -> Result<Self, String> {
        let mut world = PhysicsWorld::new();
        world.gravity = vector(scene.gravity);
        let parameters = &mut world.integration_parameters;
        parameters.dt = settings.dt_s as f32;
        parameters.num_solver_iterations = settings.substeps as usize;
        parameters.length_unit = length_unit_m(scene) as f32;
        parameters.friction_model = FrictionModel::Simplified;
        parameters.contact_softness.natural_frequency *= stiffness as f32;
        parameters.static_contact_softness.natural_frequency *= stiffness as f32;
        let mut handles = Vec::with_capacity(scene.entities.len());
        for entity in &scene.entities {
            let handle = world.insert_body(body(entity, settings.sleeping));
            for (index, child) in entity.shapes.iter().enumerate() {
                let shape = shape(&child.shape)
                    .map_err(|reason| format!("entity {:?}, shape {index}: {reason}", entity.name))?;
                let collider = ColliderBuilder::new(shape)
                    .position(pose(&child.body_from_shape))
                    .density(0.0)
                    .friction(child.surface.friction as f32)
                    .friction_combine_rule(CoefficientCombineRule::GeometricMean)
                    .restitution(child.surface.restitution as f32)
                    .restitution_combine_rule(CoefficientCombineRule::Max)
                    .user_data(child.surface.material.map_or(NO_MATERIAL, u128::from))
                    .active_hooks(match scene.pairs.is_empty() {
                        true => ActiveHooks::empty(),
                        false => ActiveHooks::MODIFY_SOLVER_CONTACTS,
                    });
                world.insert_collider(collider, Some(handle));
            }
            handles.push(handle);
        }
        let mut actions = scene.actions.clone();
        actions.sort_by(|a, b| b.time_s.total_cmp(&a.time_s));
        let dynamic = scene.entities.iter().map(|entity| measure::mass_of(entity).is_some()).collect();
        let pairs = KnownPairs(scene.pairs.clone());
        Ok(Self { world, pairs, handles, dynamic, actions, dt_s: settings.dt_s, steps: 0 })
    }

    /// One step; true where an action took effect in it.
    pub fn step(&mut self) -> bool {
        self.steps += 1;
        let mut acted = false;
        // A hair of the step, so that an action at a step's very end is not taken a step early by rounding.
        let end = self.time_s() - 1e-9 * self.dt_s;
        while let Some(action) = self.actions.pop_if(|action| action.time_s < end) {
            acted = true;
            self.act(&action);
        }
        self.world.step_with_events(&self.pairs, &());
        acted
    }

    fn act(&mut self, action: &sim::Action) {
        let Some(body) =
            self.handles.get(action.entity).and_then(|&handle| self.world.bodies.get_mut(handle))
        else {
            return;
        };
        match action.change {
            Change::SetPose(to) => body.set_position(pose(&to), true),
            Change::SetVelocity(to) => {
                body.set_linvel(vector(to.linear), true);
                body.set_angvel(vector(to.angular), true);
            }
        }
    }

    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.steps
    }

    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.dt_s
    }

    /// Pose, velocity and whether asleep, of entity `index` of the scene.
    #[must_use]
    pub fn state(&self, index: usize) -> (Pose, Velocity, bool) {
        let Some(body) = self.handles.get(index).and_then(|&handle| self.world.bodies.get(handle)) else {
            return (Pose::IDENTITY, Velocity::default(), true);
        };
        let [x, y, z, w] = body.rotation().to_array().map(f64::from);
        // f32 quaternions are off unit length by 1e-7, which would stretch shapes and moments.
        let norm = (x * x + y * y + z * z + w * w).sqrt();
        let pose = Pose {
            position: body.translation().to_array().map(f64::from),
            rotation: [x / norm, y / norm, z / norm, w / norm],
        };
        let velocity = Velocity {
            linear: body.linvel().to_array().map(f64::from),
            angular: body.angvel().to_array().map(f64::from),
        };
        (pose, velocity, body.is_sleeping())
    }

    /// The manifolds that carried something in the last substep.
    #[must_use]
    pub fn touches(&self) -> Vec<Touch> {
        // Bodies went in in the order of the entities, and none was ever taken out.
        let entity = |handle: Option<RigidBodyHandle>| Some(handle?.into_raw_parts().0 as usize);
        let mut touches = Vec::new();
        for pair in self.world.contact_pairs() {
            for manifold in pair.solver_manifolds() {
                let data = &manifold.data;
                let (Some(a), Some(b)) = (entity(data.rigid_body1), entity(data.rigid_body2)) else {
                    continue;
                };
                let from_a = self.dynamic.get(a).copied().unwrap_or(false);
                let anchor = self.state(if from_a { a } else { b }).0.position;
                let (mut normal_impulse, mut center, mut friction) = (0.0, [0.0; 3], [0.0; 3]);
                for point in manifold.points.iter().filter(|point| point.data.warmstart_impulse > 0.0) {
                    let impulse = f64::from(point.data.warmstart_impulse);
                    let arm = if from_a { point.data.solver_dp1 } else { point.data.solver_dp2 };
                    let arm = arm.to_array().map(f64::from);
                    normal_impulse += impulse;
                    center = std::array::from_fn(|k| center[k] + impulse * (anchor[k] + arm[k]));
                    // One friction constraint a manifold: every point holds the whole, as it acts on the first body.
                    friction = point.data.warmstart_tangent_world.to_array().map(|x| -f64::from(x));
                }
                if normal_impulse > 0.0 {
                    touches.push(Touch {
                        a,
                        b,
                        position: center.map(|x| x / normal_impulse),
                        normal: data.normal.to_array().map(f64::from),
                        normal_impulse,
                        friction_impulse: friction,
                    });
                }
            }
        }
        touches
    }

    /// All that can move sleep, and no action is left to wake them.
    #[must_use]
    pub fn at_rest(&self) -> bool {
        self.actions.is_empty()
            && self
                .handles
                .iter()
                .zip(&self.dynamic)
                .filter(|&(_, &dynamic)| dynamic)
                .all(|(&handle, _)| self.world.bodies.get(handle).is_none_or(RigidBody::is_sleeping))
    }
}

/// rapier's tolerances are lengths for things of about a metre: they are scaled by the size of the smallest
/// body that moves, as ours are.
#[must_use]
pub fn length_unit_m(scene: &Scene) -> f64 {
    scene
        .entities
        .iter()
        .filter(|entity| measure::mass_of(entity).is_some())
        .map(|entity| measure::extents(&entity.shapes).into_iter().fold(0.0, f64::max))
        .filter(|&size| size > 0.0)
        .fold(LARGEST_LENGTH_UNIT_M, f64::min)
}

/// rapier's own settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defaults {
    /// Solver iterations, which are substeps.
    pub iterations: u32,
    /// Hz and damping ratio of a contact between moving bodies, and of one against a static body.
    pub contact: [f64; 2],
    pub static_contact: [f64; 2],
    /// Length units a second: the fastest push out of an overlap.
    pub max_push_speed: f64,
}

impl Defaults {
    #[must_use]
    #[expect(clippy::new_without_default, reason = "there is nothing to choose")]
    pub fn new() -> Self {
        let parameters = PhysicsWorld::new().integration_parameters;
        let spring = |spring: &rapier3d::dynamics::SpringCoefficients<f32>| {
            [f64::from(spring.natural_frequency), f64::from(spring.damping_ratio)]
        };
        Self {
            iterations: parameters.num_solver_iterations as u32,
            contact: spring(&parameters.contact_softness),
            static_contact: spring(&parameters.static_contact_softness),
            max_push_speed: f64::from(parameters.normalized_max_corrective_velocity),
        }
    }
}

/// A manifold as rapier solved it in the last substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Entities; `normal` points from `a` to `b`.
    pub a: usize,
    pub b: usize,
    /// m, world: the mean of its points, weighted by their impulses
    pub position: [f64; 3],
    pub normal: [f64; 3],
    /// N s
    pub normal_impulse: f64,
    /// N s, on `b`
    pub friction_impulse: [f64; 3],
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test may stop at the first surprise")]
mod tests {
    use sim::{Action, ChildShape, Entity, Mass, Motion, Shape, Surface};

    use super::*;

    /// A ball of 1 kg and radius 0.1 m, `height` above a floor at 0.
    fn ball(height: f64, restitution: f64) -> Scene {
        let surface = Surface::new(0.5, restitution);
        let child = |shape| ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 };
        let entity = |name: &str, motion, y, shape| Entity {
            name: name.to_owned(),
            motion,
            pose: Pose::at([0.0, y, 0.0]),
            velocity: Velocity::default(),
            shapes: vec![child(shape)],
        };
        let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [0.004, 0.004, 0.004, 0.0, 0.0, 0.0] };
        let floor = entity("floor", Motion::Static, 0.0, Shape::HalfSpace);
        let ball = entity("ball", Motion::Dynamic(mass), height + 0.1, Shape::Sphere { radius: 0.1 });
        Scene::new("ball", vec![floor, ball])
    }

    #[test]
    fn the_mass_properties_are_the_scene_s_and_not_the_shapes() {
        let mut scene = ball(1.0, 0.0);
        let inertia = [0.3, 0.4, 0.5, 0.02, -0.03, 0.01];
        scene.entities[1].motion = Motion::Dynamic(Mass { mass_kg: 7.0, inertia_kg_m2: inertia });
        let mut baseline = Baseline::new(&scene, &Settings::default()).expect("built");
        // rapier sums up mass properties at the start of a step.
        baseline.step();
        let properties = baseline.world.bodies[baseline.handles[1]].mass_properties().local_mprops;
        assert!((properties.mass() - 7.0).abs() < 1e-5);
        let matrix = properties.reconstruct_inertia_matrix();
        for (row, column, expected) in
            [(0, 0, 0.3), (1, 1, 0.4), (2, 2, 0.5), (0, 1, 0.02), (0, 2, -0.03), (1, 2, 0.01)]
        {
            assert!((matrix.col(column)[row] - expected).abs() < 1e-5, "{row} {column}: {matrix:?}");
        }
    }

    #[test]
    fn a_ball_falls_and_comes_to_rest_on_its_radius() {
        let mut baseline = Baseline::new(&ball(0.2, 0.0), &Settings::default()).expect("built");
        while !baseline.at_rest() && baseline.time_s() < 5.0 {
            baseline.step();
        }
        assert!(baseline.at_rest(), "awake after {} s", baseline.time_s());
        let (pose, _, asleep) = baseline.state(1);
        assert!(asleep && (pose.position[1] - 0.1).abs() < 1e-3, "{pose:?}");
    }

    #[test]
    fn friction_is_told_as_it_acts_on_the_second_body() {
        let mut scene = ball(0.0, 0.0);
        scene.entities[1].velocity.linear = [3.0, 0.0, 0.0];
        let mut baseline = Baseline::new(&scene, &Settings::default()).expect("built");
        let mut told = 0;
        for _ in 0..5 {
            baseline.step();
            for touch in baseline.touches() {
                let on_ball =
                    if touch.b == 1 { touch.friction_impulse } else { touch.friction_impulse.map(|x| -x) };
                assert!(on_ball[0] < 0.0, "{touch:?} drives the ball on");
                told += 1;
            }
        }
        assert!(told > 0);
    }

    #[test]
    fn an_action_takes_effect_in_the_first_step_that_ends_after_its_time() {
        let mut scene = ball(50.0, 0.0);
        scene.gravity = [0.0; 3];
        let change = Change::SetVelocity(Velocity { linear: [1.0, 0.0, 0.0], angular: [0.0; 3] });
        scene.actions.push(Action { time_s: 0.05, entity: 1, change });
        let settings = Settings { dt_s: 0.02, ..Settings::default() };
        let mut baseline = Baseline::new(&scene, &settings).expect("built");
        let acted: Vec<bool> = (0..5).map(|_| baseline.step()).collect();
        assert_eq!(acted, [false, false, true, false, false]);
        assert!((baseline.state(1).0.position[0] - 0.06).abs() < 1e-6);
    }
}
