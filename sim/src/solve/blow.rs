//! The impulses of one impact between two bodies.
//!
//! At one point they are those of a micro-collision. At several points at once (a face lands flat) restitution is
//! Newton's on each point, with Coulomb's cone. Newton's hypothesis can create energy where friction couples with
//! the normal direction (Kane and Levinson 1985); the impulses are then blended with those of the plastic impact,
//! which never does, until the kinetic energy does not rise.

use crate::body::Body;
use crate::math::{Mat2, Mat3, Vec2, Vec3, tangents};
use crate::solve::friction::Friction;
use crate::solve::micro_collision::{MicroCollision, Sliding};

/// Sweeps over the points of one impact.
const SWEEPS: usize = 24;

/// m/s, below which a contact of this restitution is left to the contact solver. The flights of a Zeno sequence sum to
/// 2 v / g (1 - e): the slower its decay, the slower the bounces that still take longer than a substep all together.
pub(crate) fn slowest_bounce(threshold: f64, restitution: f64) -> f64 {
    threshold * (1.0 - restitution).max(1.0 / 32.0)
}

/// Storage for an impact at several points, which serves all of them; by row.
#[derive(Clone, Default)]
pub(crate) struct BlowBuffers {
    /// m/s, along the normals before the impact.
    approach: Vec<f64>,
    blocks: Vec<Mat3>,
    /// N s on B.
    plastic: Vec<Vec3>,
    elastic: Vec<Vec3>,
}

/// One touching point of an impact.
#[derive(Clone)]
pub(crate) struct Row {
    pub(crate) at: (usize, usize),
    pub(crate) normal: Vec3,
    pub(crate) arm_a: Vec3,
    pub(crate) arm_b: Vec3,
    pub(crate) friction: f64,
    pub(crate) restitution: f64,
}

/// Two bodies at the moment of an impact.
pub(crate) struct Blow {
    inv_mass: [f64; 2],
    inv_inertia: [Mat3; 2],
    /// Velocity and spin of A and B.
    pub(crate) state: [[Vec3; 2]; 2],
}

impl Blow {
    pub(crate) fn new(a: &Body, b: &Body) -> Self {
        Self {
            inv_mass: [a.inv_mass, b.inv_mass],
            inv_inertia: [a, b].map(Body::world_inv_inertia),
            state: [[a.velocity, a.spin], [b.velocity, b.spin]],
        }
    }

    /// Velocity of B's surface relative to A's at a row.
    fn relative(&self, row: &Row) -> Vec3 {
        let [[va, wa], [vb, wb]] = self.state;
        vb + wb.cross(&row.arm_b) - va - wa.cross(&row.arm_a)
    }

    fn apply(&mut self, row: &Row, impulse: &Vec3) {
        let [[va, wa], [vb, wb]] = &mut self.state;
        *va -= impulse * self.inv_mass[0];
        *wa -= self.inv_inertia[0] * row.arm_a.cross(impulse);
        *vb += impulse * self.inv_mass[1];
        *wb += self.inv_inertia[1] * row.arm_b.cross(impulse);
    }

    /// Delassus matrix of a row: u = K p.
    fn delassus(&self, row: &Row) -> Mat3 {
        let block = |inv_mass: f64, inv_inertia: &Mat3, arm: &Vec3| {
            let r = arm.cross_matrix();
            Mat3::identity() * inv_mass - r * inv_inertia * r
        };
        block(self.inv_mass[0], &self.inv_inertia[0], &row.arm_a)
            + block(self.inv_mass[1], &self.inv_inertia[1], &row.arm_b)
    }

    /// Applies the impact and hands every row's impulse on B to `record`; returns the largest approach speed, and
    /// how it went where it was at one point. Slower than `threshold` m/s it is plastic. `integrate` takes the
    /// general way also where a closed form would do.
    pub(crate) fn resolve(
        &mut self,
        rows: &[Row],
        threshold: f64,
        integrate: bool,
        buffers: &mut BlowBuffers,
        record: impl FnMut((usize, usize), &Vec3),
    ) -> (f64, Option<Sliding>) {
        match rows {
            [row] => {
                let (speed, sliding) = self.strike(row, threshold, integrate, record);
                (speed, Some(sliding))
            }
            _ => (self.land(rows, threshold, buffers, record), None),
        }
    }

    /// At one point.
    fn strike(
        &mut self,
        row: &Row,
        threshold: f64,
        integrate: bool,
        mut record: impl FnMut((usize, usize), &Vec3),
    ) -> (f64, Sliding) {
        let velocity = self.relative(row);
        let speed = -velocity.dot(&row.normal);
        let impact = MicroCollision {
            delassus: &self.delassus(row),
            normal: row.normal,
            velocity,
            friction: row.friction,
            restitution: if speed > slowest_bounce(threshold, row.restitution) {
                row.restitution
            } else {
                0.0
            },
        };
        let (impulse, sliding) = impact.impulse(integrate);
        self.apply(row, &impulse);
        record(row.at, &impulse);
        (speed.max(0.0), sliding)
    }

    /// At several points at once.
    fn land(
        &mut self,
        rows: &[Row],
        threshold: f64,
        buffers: &mut BlowBuffers,
        mut record: impl FnMut((usize, usize), &Vec3),
    ) -> f64 {
        let BlowBuffers { approach, blocks, plastic, elastic } = buffers;
        let before = self.state;
        approach.clear();
        approach.extend(rows.iter().map(|row| self.relative(row).dot(&row.normal)));
        blocks.clear();
        blocks.extend(rows.iter().map(|row| self.delassus(row)));
        let rebound = |i: usize| {
            let slowest = slowest_bounce(threshold, rows[i].restitution);
            if approach[i] < -slowest { -rows[i].restitution * approach[i] } else { 0.0 }
        };
        self.impulses(rows, blocks, |_| 0.0, plastic);
        let plastic_state = std::mem::replace(&mut self.state, before);
        self.impulses(rows, blocks, rebound, elastic);
        let elastic_state = self.state;

        let blend = self.energy_blend(&before, &plastic_state, &elastic_state);
        for body in 0..2 {
            for part in 0..2 {
                let (from, to) = (plastic_state[body][part], elastic_state[body][part]);
                self.state[body][part] = from + (to - from) * blend;
            }
        }
        for (row, (from, to)) in rows.iter().zip(plastic.iter().zip(elastic.iter())) {
            record(row.at, &(from + (to - from) * blend));
        }
        approach.iter().fold(0.0, |fastest, speed| fastest.max(-speed))
    }

    /// Sequential impulses until the normal speeds reach `target`; puts the impulses on B by row into `total`.
    fn impulses(
        &mut self,
        rows: &[Row],
        blocks: &[Mat3],
        target: impl Fn(usize) -> f64,
        total: &mut Vec<Vec3>,
    ) {
        total.clear();
        total.resize(rows.len(), Vec3::zeros());
        for _ in 0..SWEEPS {
            for (i, row) in rows.iter().enumerate() {
                let n = row.normal;
                let old = total[i].dot(&n);
                let mass = 1.0 / n.dot(&(blocks[i] * n));
                let new = (old + mass * (target(i) - self.relative(row).dot(&n))).max(0.0);
                self.apply(row, &(n * (new - old)));
                total[i] += n * (new - old);
                if row.friction > 0.0 {
                    self.rub(row, &blocks[i], &mut total[i]);
                }
            }
        }
    }

    /// Friction of one row inside its cone.
    fn rub(&mut self, row: &Row, block: &Mat3, total: &mut Vec3) {
        let n = row.normal;
        let [u, v] = tangents(&n);
        let project = |x: &Vec3| Vec2::new(x.dot(&u), x.dot(&v));
        let off = u.dot(&(block * v));
        let friction = Friction::new(&Mat2::new(u.dot(&(block * u)), off, off, v.dot(&(block * v))));
        let old = project(total);
        let limit = row.friction * total.dot(&n);
        let (new, _) = friction.solve(&old, &project(&self.relative(row)), limit);
        let change = u * (new.x - old.x) + v * (new.y - old.y);
        self.apply(row, &change);
        *total += change;
    }

    /// Largest share of the way from the plastic to the elastic velocities that creates no kinetic energy: a
    /// quadratic in the share, since energy is one in velocity.
    fn energy_blend(&self, before: &[[Vec3; 2]; 2], from: &[[Vec3; 2]; 2], to: &[[Vec3; 2]; 2]) -> f64 {
        let way: [[Vec3; 2]; 2] = std::array::from_fn(|i| std::array::from_fn(|j| to[i][j] - from[i][j]));
        let constant = self.energy(from, from) - self.energy(before, before);
        let linear = 2.0 * self.energy(from, &way);
        let square = self.energy(&way, &way);
        if square <= 0.0 || constant + linear + square <= 0.0 {
            return 1.0;
        }
        let root = (linear * linear - 4.0 * square * constant).max(0.0).sqrt();
        ((root - linear) / (2.0 * square)).clamp(0.0, 1.0)
    }

    /// Twice the kinetic energy as a bilinear form of two velocity states.
    fn energy(&self, x: &[[Vec3; 2]; 2], y: &[[Vec3; 2]; 2]) -> f64 {
        (0..2)
            .filter(|&i| self.inv_mass[i] > 0.0)
            .map(|i| {
                let inertia = self.inv_inertia[i].try_inverse().unwrap_or_else(Mat3::zeros);
                x[i][0].dot(&y[i][0]) / self.inv_mass[i] + x[i][1].dot(&(inertia * y[i][1]))
            })
            .sum()
    }
}
