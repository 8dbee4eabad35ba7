//! Watches bodies come to rest and says how: the same measures for both engines.

use serde::{Deserialize, Serialize};
use sim::measure::{self, Plane};
use sim::{ChildShape, Event, Frame, FrameSink, Mass, Pose, Scene, Settings, SleepState, Velocity};

/// A body rests when its farthest point moves slower than this share of `sqrt(g * size)`: the speed at which
/// it would rise by 0.02 % of its size.
const REST_SPEED_SHARE: f64 = 0.02;

/// How long it has to be that slow, s.
const REST_TIME_S: f64 = 0.5;

/// How one body came to rest, or did not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rest {
    pub entity: usize,
    pub name: String,
    pub settled: bool,
    /// s, after which it hardly moved any more; absent where it never settled.
    pub settled_at_s: Option<f64>,
    /// m, of the centre of mass above the highest half-space below it, else above the world's origin.
    pub height_m: f64,
    /// The world's down in the body's axes: which side it lies on, whatever way it is turned about the vertical.
    pub down: [f64; 3],
    /// Angle between that and the same at the start: how far it tipped over, degrees.
    pub tipped_deg: f64,
    /// Deepest overlap with a half-space, ever and at the end, m.
    pub max_penetration_m: f64,
    pub rest_penetration_m: f64,
    /// Largest and smallest extent of its shapes, m.
    pub size_m: f64,
    pub smallest_side_m: f64,
    /// World from body at the end.
    pub position_m: [f64; 3],
    pub rotation: [f64; 4],
}

/// How a whole run went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    pub steps: u64,
    pub time_s: f64,
    pub bodies: Vec<Rest>,
    /// Largest rise of the whole energy above an earlier minimum, J; what actions put in is not counted.
    pub energy_rise_j: f64,
    /// The same over the energy to be lost by falling: the sum of `m g h`, `h` the height above the planes at
    /// the start. Absent where nothing is above a plane.
    pub energy_rise_share: Option<f64>,
}

impl Outcome {
    #[must_use]
    pub fn settled(&self) -> bool {
        self.bodies.iter().all(|body| body.settled)
    }

    /// Latest settling time of any body, if all settled.
    #[must_use]
    pub fn settled_at_s(&self) -> Option<f64> {
        self.bodies
            .iter()
            .map(|body| body.settled_at_s)
            .try_fold(0.0, |latest: f64, at| Some(latest.max(at?)))
    }

    #[must_use]
    pub fn max_penetration_m(&self) -> f64 {
        self.bodies.iter().map(|body| body.max_penetration_m).fold(0.0, f64::max)
    }
}

struct Body {
    entity: usize,
    name: String,
    shapes: Vec<ChildShape>,
    mass: Mass,
    reach: f64,
    rest_speed: f64,
    start: Pose,
    last: Pose,
    last_moving_s: f64,
    asleep: bool,
    penetration: f64,
    max_penetration: f64,
}

/// Collects an [`Outcome`] from the poses of a run.
pub struct Trace {
    gravity: [f64; 3],
    planes: Vec<Plane>,
    bodies: Vec<Body>,
    fall_energy: f64,
    lowest_energy: f64,
    energy_rise: f64,
    steps: u64,
    time_s: f64,
}

impl Trace {
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let g = measure::length(scene.gravity);
        let planes: Vec<Plane> = scene
            .entities
            .iter()
            .filter(|entity| measure::mass_of(entity).is_none())
            .flat_map(Plane::of)
            .collect();
        let bodies: Vec<Body> = scene
            .entities
            .iter()
            .enumerate()
            .filter_map(|(index, entity)| {
                let size = measure::extents(&entity.shapes).into_iter().fold(0.0, f64::max);
                Some(Body {
                    entity: index,
                    name: entity.name.clone(),
                    shapes: entity.shapes.clone(),
                    mass: measure::mass_of(entity)?,
                    reach: measure::reach(&entity.shapes),
                    rest_speed: REST_SPEED_SHARE * (g * size).sqrt(),
                    start: entity.pose,
                    last: entity.pose,
                    last_moving_s: 0.0,
                    asleep: false,
                    penetration: 0.0,
                    max_penetration: 0.0,
                })
            })
            .collect();
        let fall_energy = bodies
            .iter()
            .filter_map(|body| {
                let above = clearance(&planes, &body.shapes, &body.start)?;
                Some(body.mass.mass_kg * g * above.max(0.0))
            })
            .sum();
        Self {
            gravity: scene.gravity,
            planes,
            bodies,
            fall_energy,
            lowest_energy: f64::INFINITY,
            energy_rise: 0.0,
            steps: 0,
            time_s: 0.0,
        }
    }

    /// Takes a step's state, entry `i` being that of the scene's entity `i`. `acted`: an action took effect in
    /// it, so that a rise of energy is no fault.
    pub fn push(
        &mut self,
        step: u64,
        time_s: f64,
        state: impl Fn(usize) -> (Pose, Velocity, bool),
        acted: bool,
    ) {
        (self.steps, self.time_s) = (step, time_s);
        let mut energy = 0.0;
        for body in &mut self.bodies {
            let (pose, velocity, asleep) = state(body.entity);
            let speed = measure::length(velocity.linear) + measure::length(velocity.angular) * body.reach;
            if !asleep && (step == 0 || speed > body.rest_speed) {
                body.last_moving_s = time_s;
            }
            body.asleep = asleep;
            body.penetration =
                clearance(&self.planes, &body.shapes, &pose).map_or(0.0, |clearance| (-clearance).max(0.0));
            body.max_penetration = body.max_penetration.max(body.penetration);
            body.last = pose;
            energy += measure::energy(&body.mass, &pose, &velocity, self.gravity);
        }
        if acted {
            self.lowest_energy = energy;
        }
        self.lowest_energy = self.lowest_energy.min(energy);
        self.energy_rise = self.energy_rise.max(energy - self.lowest_energy);
    }

    #[must_use]
    pub fn outcome(&self) -> Outcome {
        Outcome {
            steps: self.steps,
            time_s: self.time_s,
            bodies: self.bodies.iter().map(|body| self.rest(body)).collect(),
            energy_rise_j: self.energy_rise,
            energy_rise_share: (self.fall_energy > 0.0).then(|| self.energy_rise / self.fall_energy),
        }
    }

    fn rest(&self, body: &Body) -> Rest {
        let settled = body.asleep || self.time_s - body.last_moving_s >= REST_TIME_S;
        let extents = measure::extents(&body.shapes);
        let down = |pose: &Pose| measure::rotate_back(pose.rotation, [0.0, -1.0, 0.0]);
        let floor = self
            .planes
            .iter()
            .filter(|plane| plane.normal[1] > 0.0)
            .map(|plane| {
                let away = std::array::from_fn(|axis| plane.point[axis] - body.last.position[axis]);
                body.last.position[1] + measure::dot(away, plane.normal) / plane.normal[1]
            })
            .reduce(f64::max);
        Rest {
            entity: body.entity,
            name: body.name.clone(),
            settled,
            settled_at_s: settled.then_some(body.last_moving_s),
            height_m: body.last.position[1] - floor.unwrap_or(0.0),
            down: down(&body.last),
            tipped_deg: angle_deg(down(&body.start), down(&body.last)),
            max_penetration_m: body.max_penetration,
            rest_penetration_m: body.penetration,
            size_m: extents.into_iter().fold(0.0, f64::max),
            smallest_side_m: extents.into_iter().fold(f64::INFINITY, f64::min),
            position_m: body.last.position,
            rotation: body.last.rotation,
        }
    }
}

/// Least clearance above any of the planes; `None` without planes or without bounded shapes.
fn clearance(planes: &[Plane], shapes: &[ChildShape], pose: &Pose) -> Option<f64> {
    planes.iter().filter_map(|plane| plane.clearance(shapes, pose)).reduce(f64::min)
}

/// Angle between two unit vectors, degrees, exact also where they are nearly equal.
#[must_use]
pub fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let apart: [f64; 3] = std::array::from_fn(|axis| a[axis] - b[axis]);
    let together: [f64; 3] = std::array::from_fn(|axis| a[axis] + b[axis]);
    2.0 * measure::length(apart).atan2(measure::length(together)).to_degrees()
}

impl FrameSink for Trace {
    fn begin(&mut self, _: &Scene, _: &Settings) {}

    fn frame(&mut self, frame: &Frame<'_>) {
        let Some(rigid) = frame.rigid else { return };
        let acted = frame.events.iter().any(|event| matches!(event, Event::Acted { .. }));
        let state = |entity: usize| {
            (rigid.poses[entity], rigid.velocities[entity], rigid.sleep[entity] == SleepState::Asleep)
        };
        self.push(frame.step, frame.time_s, state, acted);
    }

    fn end(&mut self) {}
}

#[cfg(test)]
mod tests {
    use sim::{Entity, Motion, Shape, Surface};

    use super::*;

    fn scene() -> Scene {
        let surface = Surface::new(0.5, 0.0);
        let child = |shape| ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 };
        let mass = Mass { mass_kg: 3.0, inertia_kg_m2: [1.2, 1.2, 1.2, 0.0, 0.0, 0.0] };
        let entity = |name: &str, motion, y, shape| Entity {
            name: name.to_owned(),
            motion,
            pose: Pose::at([0.0, y, 0.0]),
            velocity: Velocity::default(),
            shapes: vec![child(shape)],
        };
        Scene {
            name: "one ball".to_owned(),
            gravity: [0.0, -10.0, 0.0],
            entities: vec![
                entity("floor", Motion::Static, 1.0, Shape::HalfSpace),
                entity("ball", Motion::Dynamic(mass), 3.0, Shape::Sphere { radius: 1.0 }),
            ],
            actions: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// Height and vertical speed a step of 0.1 s.
    fn outcome(states: &[(f64, f64)]) -> Outcome {
        let mut trace = Trace::new(&scene());
        for (step, &(height, speed)) in states.iter().enumerate() {
            let velocity = Velocity { linear: [0.0, speed, 0.0], angular: [0.0; 3] };
            let state = |_: usize| (Pose::at([0.0, height, 0.0]), velocity, false);
            trace.push(step as u64, step as f64 * 0.1, state, false);
        }
        trace.outcome()
    }

    #[test]
    fn a_body_that_stops_has_settled_when_it_stopped() {
        let mut states = vec![(3.0, 0.0), (2.5, -3.0), (1.99, -1.0)];
        states.extend([(2.0, 0.0); 8]);
        let outcome = outcome(&states);
        let rest = &outcome.bodies[0];
        assert_eq!((rest.settled, rest.settled_at_s), (true, Some(0.2)));
        assert!((rest.height_m - 1.0).abs() < 1e-12);
        assert!((rest.max_penetration_m - 0.01).abs() < 1e-12 && rest.rest_penetration_m == 0.0);
        assert_eq!((rest.down, rest.tipped_deg), ([0.0, -1.0, 0.0], 0.0));
    }

    #[test]
    fn a_body_still_moving_at_the_end_has_not() {
        let mut states = vec![(2.0, 0.0); 8];
        states.push((2.0, 1.0));
        assert!(!outcome(&states).settled());
    }

    #[test]
    fn a_rise_of_energy_is_counted_against_the_fall() {
        // From 3 m down to 2 m at rest (30 J lost), then up by 0.1 m: 3 J of 30 J.
        let outcome = outcome(&[(3.0, 0.0), (2.0, 0.0), (2.1, 0.0)]);
        assert!((outcome.energy_rise_j - 3.0).abs() < 1e-9);
        assert!((outcome.energy_rise_share.expect("above a plane") - 0.1).abs() < 1e-9);
    }

    #[test]
    fn angles_are_right_at_both_ends() {
        assert!(angle_deg([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]) == 0.0);
        assert!((angle_deg([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]) - 180.0).abs() < 1e-12);
        let tiny = 1e-9_f64;
        assert!((angle_deg([1.0, 0.0, 0.0], [1.0, tiny, 0.0]) - tiny.to_degrees()).abs() < 1e-15);
    }
}
