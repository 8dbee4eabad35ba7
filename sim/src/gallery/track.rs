//! A run as poses and velocities, whatever engine it came from: what the criteria of the gallery judge.

use std::sync::OnceLock;

use crate::measure::{self, Depths};
use crate::scene::{Motion, Pose, Scene, Velocity};

/// Bytes of poses that a track keeps at most; longer runs of many bodies keep every second, third, … frame.
const MOST_BYTES: usize = 192 << 20;

/// State of every entity of the scene at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    pub time_s: f64,
    /// World from body.
    pub poses: Vec<Pose>,
    pub velocities: Vec<Velocity>,
}

/// A whole run. The start is its first moment, the end its last.
pub struct Track {
    pub scene: Scene,
    pub moments: Vec<Moment>,
    /// J, kinetic and potential, after every step, the start first.
    pub energy_j: Vec<f64>,
    /// J, largest rise above what the energy had been before, actions apart.
    pub energy_rise_j: f64,
    /// J, largest kinetic energy of the whole scene.
    pub kinetic_max_j: f64,
    lowest_j: f64,
    every: usize,
    pushed: usize,
    last: Option<Moment>,
    /// m, deepest overlap of every moment, once asked for.
    depths_m: OnceLock<Vec<f64>>,
}

impl Track {
    /// An empty track of about `steps` steps.
    #[must_use]
    pub fn new(scene: &Scene, steps: usize) -> Self {
        let moment = scene.entities.len() * (size_of::<Pose>() + size_of::<Velocity>());
        Self {
            scene: scene.clone(),
            moments: Vec::new(),
            energy_j: Vec::new(),
            energy_rise_j: 0.0,
            kinetic_max_j: 0.0,
            lowest_j: f64::INFINITY,
            every: (moment * steps).div_ceil(MOST_BYTES).max(1),
            pushed: 0,
            last: None,
            depths_m: OnceLock::new(),
        }
    }

    /// Takes the state after a step (the first time: the start). `acted`: an action of the scene took effect in it.
    pub fn push(&mut self, time_s: f64, poses: &[Pose], velocities: &[Velocity], acted: bool) {
        let energy = self.energy_of(poses, velocities, self.scene.gravity);
        self.kinetic_max_j = self.kinetic_max_j.max(self.energy_of(poses, velocities, [0.0; 3]));
        if acted {
            self.lowest_j = energy;
        }
        self.lowest_j = self.lowest_j.min(energy);
        self.energy_rise_j = self.energy_rise_j.max(energy - self.lowest_j);
        self.energy_j.push(energy);
        let moment = Moment { time_s, poses: poses.to_vec(), velocities: velocities.to_vec() };
        if self.pushed.is_multiple_of(self.every) {
            self.moments.push(moment);
            self.last = None;
        } else {
            self.last = Some(moment);
        }
        self.pushed += 1;
    }

    /// After the last step: the end is kept whatever its turn.
    pub fn finish(&mut self) {
        self.moments.extend(self.last.take());
    }

    /// Kinetic energy, and potential in `gravity`.
    fn energy_of(&self, poses: &[Pose], velocities: &[Velocity], gravity: [f64; 3]) -> f64 {
        let bodies = self.scene.entities.iter().zip(poses).zip(velocities);
        bodies
            .filter_map(|((entity, pose), velocity)| {
                Some(measure::energy(&measure::mass_of(entity)?, pose, velocity, gravity))
            })
            .sum()
    }

    /// Indices of the entities that move.
    pub fn dynamic(&self) -> impl Iterator<Item = usize> + '_ {
        let entities = self.scene.entities.iter().enumerate();
        entities.filter(|(_, entity)| matches!(entity.motion, Motion::Dynamic(_))).map(|(index, _)| index)
    }

    /// Index of the `n`th entity that moves.
    #[must_use]
    pub fn body(&self, n: usize) -> usize {
        self.dynamic().nth(n).unwrap_or(0)
    }

    #[must_use]
    pub fn start(&self) -> &Moment {
        &self.moments[0]
    }

    #[must_use]
    pub fn end(&self) -> &Moment {
        &self.moments[self.moments.len() - 1]
    }

    /// The first moment at `time_s` or later, else the last.
    #[must_use]
    pub fn at(&self, time_s: f64) -> &Moment {
        self.moments.iter().find(|moment| moment.time_s >= time_s - 1e-9).unwrap_or_else(|| self.end())
    }

    /// Moments from `time_s` on.
    pub fn from(&self, time_s: f64) -> impl Iterator<Item = &Moment> {
        self.moments.iter().filter(move |moment| moment.time_s >= time_s - 1e-9)
    }

    /// s
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end().time_s
    }

    /// Deepest overlap of any two bodies at every moment, m.
    pub fn depths_m(&self) -> &[f64] {
        self.depths_m.get_or_init(|| {
            let depths = Depths::new(&self.scene);
            let depth =
                |moment: &Moment| depths.deepest(&moment.poses).map_or(0.0, |overlap| overlap.depth_m);
            self.moments.iter().map(depth).collect()
        })
    }

    /// Deepest overlap of any two bodies from `time_s` on, m.
    #[must_use]
    pub fn deepest_m(&self, time_s: f64) -> f64 {
        let moments = self.moments.iter().zip(self.depths_m());
        moments
            .filter(|(moment, _)| moment.time_s >= time_s - 1e-9)
            .map(|(_, depth)| *depth)
            .fold(0.0, f64::max)
    }

    /// Deepest overlap in the last second, m.
    #[must_use]
    pub fn end_depth_m(&self) -> f64 {
        self.deepest_m(self.duration_s() - 1.0)
    }

    /// How far any body is at the end from where it was at `time_s`: along gravity, and across it, m.
    #[must_use]
    pub fn moved_since_m(&self, time_s: f64) -> (f64, f64) {
        let g = measure::length(self.scene.gravity);
        let down = self.scene.gravity.map(|x| if g > 0.0 { x / g } else { 0.0 });
        let (start, end) = (self.at(time_s), self.end());
        self.dynamic().fold((0.0, 0.0), |(sink, drift): (f64, f64), i| {
            let away: [f64; 3] =
                std::array::from_fn(|axis| end.poses[i].position[axis] - start.poses[i].position[axis]);
            let fall = measure::dot(away, down);
            let across: [f64; 3] = std::array::from_fn(|axis| away[axis] - fall * down[axis]);
            // A comparison with NaN is false: a lost body must count as moved without bound.
            if away.iter().all(|x| x.is_finite()) {
                (sink.max(fall.abs()), drift.max(measure::length(across)))
            } else {
                (f64::INFINITY, f64::INFINITY)
            }
        })
    }

    /// Largest change of height of any body since the start, m: how far something that should stand has sunk.
    #[must_use]
    pub fn sink_m(&self) -> f64 {
        self.moved_since_m(0.0).0
    }

    /// Largest change of place across gravity of any body since the start, m.
    #[must_use]
    pub fn drift_m(&self) -> f64 {
        self.moved_since_m(0.0).1
    }

    /// Total linear and angular momentum at a moment.
    #[must_use]
    pub fn momentum(&self, moment: &Moment) -> measure::Momentum {
        let mut total = measure::Momentum::default();
        for i in self.dynamic() {
            if let Some(mass) = measure::mass_of(&self.scene.entities[i]) {
                let one = measure::momentum(&mass, &moment.poses[i], &moment.velocities[i]);
                for axis in 0..3 {
                    total.linear[axis] += one.linear[axis];
                    total.angular[axis] += one.angular[axis];
                }
            }
        }
        total
    }

    /// Whether every number of the end is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let end = self.end();
        end.poses.iter().all(|pose| pose.position.iter().chain(&pose.rotation).all(|x| x.is_finite()))
    }
}
