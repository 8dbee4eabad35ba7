//! One impact at one point, in the time scale of its own: a micro-collision.
//!
//! While two surfaces press on each other for an instant, nothing moves and the velocity u of B relative to A at the
//! point changes with the normal impulse p alone (the paper's eq. 3; Darboux 1880, Keller 1986):
//!
//! ```text
//! du/dp = K (f, 1)      K Delassus matrix of the point, f friction impulse per normal impulse
//! f = -μ u_t / |u_t|    while it slides
//! f = -K_tt⁻¹ k_tn      while it sticks, which it can where |f| ≤ μ
//! dW/dp = u_n           work of the normal impulse: W_c taken up until u_n = 0, then e² W_c given back
//! ```
//!
//! So the sliding direction turns, stops or reverses within the impact. Restitution is energetic (Stronge 1990): of
//! the work taken up in compression the share e² comes back. With Newton's ratio of speeds or Poisson's of impulses
//! an impact with friction can create energy; with this one it cannot, since friction and compression only take.
//!
//! Where the direction of sliding keeps its line (spheres, planar impacts, sticking, and the slip that starts from
//! rest, which leaves along the one direction û with `k_tn - μ K_tt û = c û`, c > 0) everything is linear in p and
//! solved in closed form. Else Runge and Kutta's fourth order runs over s with `dp = |u_t| ds`, in which the turning
//! stays gentle while the slip dies out.

use crate::math::{Mat2, Mat3, Vec2, Vec3, tangents};

/// Sine of the angle to its own rate within which sliding counts as straight.
const STRAIGHT: f64 = 1e-9;
/// Slip, as a share of the speeds at the start, that counts as none: far below what the integration resolves.
const NO_SLIP: f64 = 1e-8;
/// Change of the slip, as a share of it, in a step of the integration; and the same if the slip went the worst way.
const MAX_CHANGE: [f64; 2] = [0.05, 0.25];
/// Steps of the integration, at most: what is left is taken as straight.
const MAX_STEPS: usize = 2000;

/// How an impact went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sliding {
    /// Without friction.
    Frictionless,
    /// Along one line, if at all: closed form.
    Straight,
    /// In a curve: integrated.
    Turning,
}

/// One point of contact at the moment of an impact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MicroCollision<'a> {
    /// K in `u = K p`, 1/kg, world.
    pub(crate) delassus: &'a Mat3,
    /// World, from A to B.
    pub(crate) normal: Vec3,
    /// Of B relative to A, m/s, world; approaching.
    pub(crate) velocity: Vec3,
    pub(crate) friction: f64,
    /// Energetic coefficient of restitution.
    pub(crate) restitution: f64,
}

impl MicroCollision<'_> {
    /// Impulse on B, N s, world. `integrate` takes the general way also where a closed form would do.
    pub(crate) fn impulse(&self, integrate: bool) -> (Vec3, Sliding) {
        let [t1, t2] = tangents(&self.normal);
        let (k1, k2, kn) = (self.delassus * t1, self.delassus * t2, self.delassus * self.normal);
        let mut course = Course {
            tt: Mat2::new(t1.dot(&k1), t1.dot(&k2), t1.dot(&k2), t2.dot(&k2)),
            tn: Vec2::new(t1.dot(&kn), t2.dot(&kn)),
            nn: self.normal.dot(&kn),
            friction: self.friction,
            restitution: self.restitution,
            state: State {
                slip: Vec2::new(t1.dot(&self.velocity), t2.dot(&self.velocity)),
                approach: self.normal.dot(&self.velocity),
                ..State::default()
            },
            compressing: true,
        };
        let sliding = course.run(integrate);
        let State { tangential, normal, .. } = course.state;
        (t1 * tangential.x + t2 * tangential.y + self.normal * normal, sliding)
    }
}

/// Velocities, impulses and work so far, in contact axes.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    slip: Vec2,
    /// Normal velocity, negative in compression, m/s.
    approach: f64,
    tangential: Vec2,
    normal: f64,
    /// J, taken up by the normal impulse, and given back.
    taken: f64,
    given: f64,
}

/// An impact under way.
struct Course {
    tt: Mat2,
    tn: Vec2,
    nn: f64,
    friction: f64,
    restitution: f64,
    state: State,
    compressing: bool,
}

impl Course {
    fn run(&mut self, integrate: bool) -> Sliding {
        if self.friction <= 0.0 {
            self.straight(&Vec2::zeros(), f64::INFINITY);
            return Sliding::Frictionless;
        }
        let none = NO_SLIP * (self.state.slip.norm() + self.state.approach.abs());
        let mut sliding = Sliding::Straight;
        if self.state.slip.norm() > none {
            let direction = self.state.slip.normalize();
            let over = if integrate || !self.keeps_its_line(&direction) {
                sliding = Sliding::Turning;
                self.turning(none)
            } else {
                self.straight(&(direction * -self.friction), self.slip_left(&direction))
            };
            if over {
                return sliding;
            }
        }
        self.state.slip = Vec2::zeros();
        self.straight(&self.pull_at_rest(), f64::INFINITY);
        sliding
    }

    /// Rate of the slip per normal impulse while it slides along `direction`.
    fn slip_rate(&self, direction: &Vec2) -> Vec2 {
        self.tn - self.tt * direction * self.friction
    }

    fn keeps_its_line(&self, direction: &Vec2) -> bool {
        let rate = self.slip_rate(direction);
        rate.perp(direction).abs() <= STRAIGHT * rate.norm()
    }

    /// Normal impulse until a slip along `direction` has stopped.
    fn slip_left(&self, direction: &Vec2) -> f64 {
        let along = self.slip_rate(direction).dot(direction);
        if along < 0.0 { self.state.slip.norm() / -along } else { f64::INFINITY }
    }

    /// Friction per normal impulse from where the slip is zero: what holds it, if that is inside the cone; else it
    /// slides off along û with `(μ K_tt + c) û = k_tn`, and |û| = 1 gives c.
    fn pull_at_rest(&self) -> Vec2 {
        let solve = |c: f64| {
            let matrix = self.tt * self.friction + Mat2::identity() * c;
            matrix.try_inverse().unwrap_or_else(Mat2::zeros) * self.tn
        };
        // At c = 0 this is K_tt⁻¹ k_tn / μ.
        let holding = solve(0.0);
        if holding.norm() <= 1.0 {
            return holding * -self.friction;
        }
        // |û| falls as c grows, and is below 1 at c = |k_tn|.
        let (mut low, mut high) = (0.0, self.tn.norm());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if solve(middle).norm() > 1.0 { low = middle } else { high = middle }
        }
        solve(high).normalize() * -self.friction
    }

    /// Goes on with friction `pull` per normal impulse for at most `span` N s; `true` once the impact is over.
    fn straight(&mut self, pull: &Vec2, span: f64) -> bool {
        let slip_rate = self.tt * pull + self.tn;
        let rate = self.nn + self.tn.dot(pull);
        let mut left = span;
        // Compression, restitution, and where the normal velocity turns back once more, both again.
        for _ in 0..4 {
            let speed = self.state.approach;
            let due = self.due();
            let event = if self.compressing {
                if speed >= 0.0 {
                    0.0
                } else if rate > 0.0 {
                    -speed / rate
                } else {
                    f64::INFINITY
                }
            } else {
                // speed p + rate p² / 2 = due, or else the speed is back at zero first.
                let root = speed * speed + 2.0 * rate * due;
                if due <= 0.0 {
                    0.0
                } else if root >= 0.0 && speed + root.sqrt() > 0.0 {
                    2.0 * due / (speed + root.sqrt())
                } else {
                    speed / -rate
                }
            };
            let step = event.min(left);
            if !step.is_finite() {
                // Without an end: the energy would grow with the impulse, so it does not occur but by rounding.
                return true;
            }
            let work = (speed + 0.5 * rate * step) * step;
            let state = &mut self.state;
            if self.compressing {
                state.taken -= work
            } else {
                state.given += work
            }
            state.approach += rate * step;
            state.slip += slip_rate * step;
            state.tangential += pull * step;
            state.normal += step;
            if event > left {
                return false;
            }
            left -= step;
            if self.passed() {
                return true;
            }
        }
        true
    }

    /// J still to be given back.
    fn due(&self) -> f64 {
        self.restitution * self.restitution * self.state.taken - self.state.given
    }

    /// At the end of compression or of restitution: turns to the other, or says that the impact is over.
    fn passed(&mut self) -> bool {
        if self.compressing {
            self.state.approach = 0.0;
            self.compressing = false;
            return self.restitution <= 0.0;
        }
        // Far above what finding the moment leaves, far below what anybody sees.
        let over = self.due() <= 1e-8 * self.state.taken;
        if !over {
            self.compressing = true;
        }
        over
    }

    /// Integrates while the slip turns, until it is below `none`; `true` once the impact is over.
    fn turning(&mut self, none: f64) -> bool {
        let fastest = self.tn.norm() + self.friction * self.tt.norm();
        for _ in 0..MAX_STEPS {
            if self.state.slip.norm() <= none {
                return false;
            }
            let now = self.slip_rate(&self.state.slip.normalize()).norm();
            let step = (MAX_CHANGE[0] / now).min(MAX_CHANGE[1] / fastest);
            let next = self.moved(step);
            let past = |state: &State| {
                if self.compressing {
                    state.approach
                } else {
                    // Whichever comes first: the work is given back, or it approaches again.
                    let due = self.restitution * self.restitution * state.taken - state.given;
                    (-due).max(-state.approach)
                }
            };
            if past(&next) < 0.0 {
                self.state = next;
                continue;
            }
            // The moment lies within the step: false position, Illinois' way, on the length of the step.
            // At its start the speed is zero on the way up, so what is still due stands for both there.
            let before = if self.compressing { self.state.approach } else { -self.due() };
            let (mut low, mut high) = ((0.0, before), (step, past(&next)));
            let mut at = next;
            for _ in 0..40 {
                let s = if high.1 > low.1 {
                    high.0 - high.1 * (high.0 - low.0) / (high.1 - low.1)
                } else {
                    high.0
                };
                at = self.moved(s);
                let value = past(&at);
                if value.abs() <= 1e-14 * (high.1.abs() + low.1.abs()) || high.0 - low.0 <= 1e-15 * step {
                    break;
                }
                if value < 0.0 {
                    low = (s, value);
                    high.1 *= 0.5;
                } else {
                    high = (s, value);
                    low.1 *= 0.5;
                }
            }
            self.state = at;
            if self.passed() {
                return true;
            }
        }
        let direction = self.state.slip.normalize();
        self.straight(&(direction * -self.friction), self.slip_left(&direction))
    }

    /// The state after `ds` of `dp = |u_t| ds`.
    fn moved(&self, ds: f64) -> State {
        let rate = |state: &State| {
            let size = state.slip.norm();
            let direction = if size > 0.0 { state.slip / size } else { Vec2::zeros() };
            let work = size * state.approach;
            State {
                slip: self.slip_rate(&direction) * size,
                approach: (self.nn - self.friction * self.tn.dot(&direction)) * size,
                tangential: direction * (-self.friction * size),
                normal: size,
                taken: if self.compressing { -work } else { 0.0 },
                given: if self.compressing { 0.0 } else { work },
            }
        };
        let start = &self.state;
        let k1 = rate(start);
        let k2 = rate(&start.plus(&k1, 0.5 * ds));
        let k3 = rate(&start.plus(&k2, 0.5 * ds));
        let k4 = rate(&start.plus(&k3, ds));
        start.plus(&k1, ds / 6.0).plus(&k2, ds / 3.0).plus(&k3, ds / 3.0).plus(&k4, ds / 6.0)
    }
}

impl State {
    fn plus(&self, rate: &Self, ds: f64) -> Self {
        Self {
            slip: self.slip + rate.slip * ds,
            approach: self.approach + rate.approach * ds,
            tangential: self.tangential + rate.tangential * ds,
            normal: self.normal + rate.normal * ds,
            taken: self.taken + rate.taken * ds,
            given: self.given + rate.given * ds,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The point's velocity after the impact, and its impulse.
    fn struck(k: &Mat3, mu: f64, e: f64, u: Vec3, integrate: bool) -> (Vec3, Vec3, Sliding) {
        let impact =
            MicroCollision { delassus: k, normal: Vec3::z(), velocity: u, friction: mu, restitution: e };
        let (p, sliding) = impact.impulse(integrate);
        (u + k * p, p, sliding)
    }

    /// A rod of half length l and mass 1 whose lower tip, at `degrees` to the ground, hits it in the plane x z.
    fn rod(degrees: f64) -> Mat3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let off = -3.0 * sin * cos;
        Mat3::new(1.0 + 3.0 * sin * sin, 0.0, off, 0.0, 4.0, 0.0, off, 0.0, 1.0 + 3.0 * cos * cos)
    }

    /// The reference vectors of planar impacts: angle, μ, e, u_t before; u_t, u_n after, p_t, p_n.
    const PLANAR: [([f64; 4], [f64; 4]); 8] = [
        ([45.0, 0.1, 0.5, -1.0], [-1.797872, 0.5, 0.063830, 0.638298]),
        ([45.0, 0.5, 0.5, -1.0], [-1.214286, 0.5, 0.428571, 0.857143]),
        ([45.0, 1.0, 0.5, -1.0], [0.0, 0.632456, 1.237171, 1.395285]),
        ([45.0, 0.5, 1.0, -0.3], [-0.585714, 1.0, 0.571429, 1.142857]),
        ([45.0, 0.5, 0.5, 0.5], [-0.114489, 0.392334, 0.138069, 0.639775]),
        ([45.0, 0.5, 1.0, 0.5], [-0.170537, 0.784667, 0.250165, 0.863966]),
        ([30.0, 0.6, 0.6, 0.1], [-0.140204, 0.562422, 0.312246, 0.605551]),
        ([63.4349488, 2.0, 0.5, -1.0], [0.0, 0.662628, 0.898788, 1.713234]),
    ];

    #[test]
    fn planar_impacts_meet_the_reference() {
        for integrate in [false, true] {
            for ([degrees, mu, e, ut], expected) in PLANAR {
                let (u, p, sliding) = struck(&rod(degrees), mu, e, Vec3::new(ut, 0.0, -1.0), integrate);
                for (found, expected) in [u.x, u.z, p.x, p.z].into_iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 2e-6,
                        "{degrees} degrees, mu {mu}, e {e}, u_t {ut}, {sliding:?}: {u:?}, {p:?}, not {expected}"
                    );
                }
                assert_eq!(sliding == Sliding::Turning, integrate);
            }
        }
    }

    #[test]
    fn impacts_of_a_corner_meet_the_reference() {
        #[rustfmt::skip]
        let k = Mat3::new(
            3.021706, 0.196153, 1.894359,
            0.196153, 5.054988, -1.968962,
            1.894359, -1.968962, 3.923306,
        );
        let cases = [
            (0.1, 0.5, [1.0, 0.5, -2.0], [2.29087, -1.04915, 0.98794], 0.80372),
            (0.3, 0.5, [1.0, 0.5, -2.0], [1.94897, -1.06760, 0.96091], 0.90484),
            (0.3, 0.5, [-1.0, 0.5, -2.0], [0.53605, -0.49662, 0.83563], 0.75908),
            (0.8, 0.5, [1.0, 0.5, -2.0], [0.68427, -0.42656, 0.88979], 1.45188),
            (0.3, 1.0, [0.2, -0.4, -2.0], [1.86492, -1.61999, 1.99888], 1.28714),
        ];
        for (mu, e, before, after, normal) in cases {
            let (u, p, sliding) = struck(&k, mu, e, Vec3::from(before), false);
            assert!((u - Vec3::from(after)).amax() < 1e-4, "mu {mu}, e {e}: {u:?}, expected {after:?}");
            assert!((p.z - normal).abs() < 1e-4, "mu {mu}, e {e}: p_n {}, expected {normal}", p.z);
            assert_eq!(sliding, Sliding::Turning);
        }
    }

    /// K of a body struck at `arm`, z being the normal.
    fn delassus(inverse_moments: [f64; 3], arm: Vec3) -> Mat3 {
        let r = arm.cross_matrix();
        Mat3::identity() - r * Mat3::from_diagonal(&Vec3::from(inverse_moments)) * r
    }

    proptest! {
        #[test]
        fn energy_is_never_created_and_friction_stays_in_its_cone(
            inverse in [0.1..20.0_f64, 0.1..20.0, 0.1..20.0],
            arm in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
            slip in [-5.0..5.0_f64, -5.0..5.0],
            approach in -5.0..-1e-3_f64,
            mu in prop_oneof![Just(0.0), 0.0..3.0_f64],
            e in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64],
        ) {
            let k = delassus(inverse, Vec3::from(arm));
            let before = Vec3::new(slip[0], slip[1], approach);
            let (after, p, _) = struck(&k, mu, e, before, false);
            // Change of the kinetic energy: p · (u + u') / 2.
            let gained = 0.5 * p.dot(&(before + after));
            let scale = 0.5 * p.norm() * (before.norm() + after.norm());
            prop_assert!(gained <= 1e-6 * scale, "gains {gained} of {scale} J: {p:?}");
            prop_assert!(after.z >= -1e-9, "still approaches at {}", after.z);
            prop_assert!(p.xy().norm() <= mu * p.z * (1.0 + 1e-6) + 1e-12, "outside the cone: {p:?}");
        }

        #[test]
        fn closed_form_and_integration_agree(
            moment in 0.1..20.0_f64,
            arm in -1.0..1.0_f64,
            angle in 0.0..std::f64::consts::TAU,
            slip in -3.0..3.0_f64,
            mu in 0.01..2.0_f64,
            e in 0.0..1.0_f64,
        ) {
            // Struck in the plane of its arm: the slip stays in that plane.
            let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::z_axis(), angle);
            let flat = delassus([moment; 3], Vec3::new(arm, 0.0, -0.7));
            let k = turn.matrix() * flat * turn.matrix().transpose();
            let before = turn * Vec3::new(slip, 0.0, -1.0);
            let (closed, ..) = struck(&k, mu, e, before, false);
            let (integrated, _, sliding) = struck(&k, mu, e, before, true);
            prop_assert!((closed - integrated).norm() < 1e-5, "{closed:?}, integrated {integrated:?}, {sliding:?}");
        }
    }
}
