//! Real tosses of an acrylic cube, measured at 148 Hz (Pfrommer, Halm, Posa 2020, ContactNets).
//!
//! A folder of CSV files, one a toss: time, position (z up), quaternion `w, x, y, z`, velocity, angular velocity in the
//! body's axes. All tosses run in one scene, far apart.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use sim::gallery::build::{body, floor, scene, surface, then, turn};
use sim::gallery::{Judgement, Track};
use sim::measure::{length, rotate};
use sim::{Mass, Pose, Scene, Shape, Velocity};

/// The cube: side, m; mass, kg; moment of inertia, kg m²; and the friction and restitution that its authors fitted.
const SIDE_M: f64 = 0.1048;
const MASS_KG: f64 = 0.37;
const MOMENT_KG_M2: f64 = 8.1e-4;
const FRICTION: f64 = 0.18;
const RESTITUTION: f64 = 0.125;
const G: f64 = 9.81;

/// m between tosses.
const APART_M: f64 = 4.0;

struct Sample {
    time_s: f64,
    pose: Pose,
    velocity: Velocity,
}

/// All tosses of a folder, in the order of their names, Y up.
pub struct Tosses {
    tosses: Vec<Vec<Sample>>,
}

impl Tosses {
    /// # Errors
    /// The folder holds no toss, or a file is not what it should be: which, where, and what was expected.
    pub fn load(folder: &Path) -> Result<Self> {
        let listing = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
        let mut files: Vec<_> = listing.filter_map(|entry| Some(entry.ok()?.path())).collect();
        files.retain(|file| file.extension().is_some_and(|extension| extension == "csv"));
        files.sort();
        let tosses = files.iter().map(|file| load(file)).collect::<Result<Vec<_>>>()?;
        if tosses.is_empty() {
            bail!("{}: no CSV file of a toss in it", folder.display());
        }
        Ok(Self { tosses })
    }

    pub(super) fn about(&self) -> String {
        format!(
            "{} real tosses of a cube, mu {FRICTION}, e {RESTITUTION}; in flight the measured places scatter by {:.1} mm",
            self.tosses.len(),
            self.noise_m() * 1e3
        )
    }

    /// s, between two frames.
    pub(super) fn dt_s(&self) -> f64 {
        let toss = &self.tosses[0];
        (toss[toss.len() - 1].time_s - toss[0].time_s) / (toss.len() - 1) as f64
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.tosses.iter().map(|toss| toss[toss.len() - 1].time_s).fold(0.0, f64::max)
    }

    fn place(n: usize) -> [f64; 3] {
        [APART_M * (n % 10) as f64, 0.0, APART_M * (n / 10) as f64]
    }

    pub(super) fn scene(&self) -> Scene {
        let s = surface(FRICTION, RESTITUTION);
        let mass = Mass {
            mass_kg: MASS_KG,
            inertia_kg_m2: [MOMENT_KG_M2, MOMENT_KG_M2, MOMENT_KG_M2, 0.0, 0.0, 0.0],
        };
        let mut entities = vec![floor(s)];
        for (n, toss) in self.tosses.iter().enumerate() {
            let start = &toss[0];
            let shape = Shape::Box { half_extents: [0.5 * SIDE_M; 3] };
            let mut cube = body("cube", mass, [0.0; 3], shape, s);
            let place = Self::place(n);
            cube.pose.position = std::array::from_fn(|k| start.pose.position[k] + place[k]);
            cube.pose.rotation = start.pose.rotation;
            cube.velocity = start.velocity;
            entities.push(cube);
        }
        scene("cube-tosses", entities)
    }

    /// Means over the frames of each toss, then over the tosses.
    pub(super) fn judge(&self, track: &Track) -> Vec<Judgement> {
        let (mut away, mut turned) = (0.0, 0.0);
        for (n, toss) in self.tosses.iter().enumerate() {
            let place = Self::place(n);
            let frames: Vec<(f64, f64)> = toss
                .iter()
                .zip(&track.moments)
                .skip(1)
                .map(|(sample, moment)| {
                    let pose = moment.poses[n + 1];
                    let off = |k: usize| pose.position[k] - place[k] - sample.pose.position[k];
                    (length(std::array::from_fn(off)), angle_deg(pose.rotation, sample.pose.rotation))
                })
                .collect();
            let count = (frames.len() * self.tosses.len()) as f64;
            away += frames.iter().map(|(away, _)| away).sum::<f64>() / count;
            turned += frames.iter().map(|(_, turned)| turned).sum::<f64>() / count;
        }
        let figure = |figure, unit, value| Judgement { figure, unit, limit: f64::INFINITY, value };
        vec![
            figure("mean error of the place", "widths", away / SIDE_M),
            figure("mean error of the rotation", "deg", turned),
            figure("scatter of the measured place", "widths", self.noise_m() / SIDE_M),
        ]
    }

    /// Root mean square distance of the measured places before the first touch from the parabola that fits them
    /// best, m.
    fn noise_m(&self) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        for toss in &self.tosses {
            let flight: Vec<&Sample> = toss.iter().take_while(|sample| lowest(&sample.pose) > 2e-3).collect();
            if flight.len() < 6 {
                continue;
            }
            for axis in 0..3 {
                let fall = if axis == 1 { G } else { 0.0 };
                let points: Vec<[f64; 2]> = flight
                    .iter()
                    .map(|s| [s.time_s, s.pose.position[axis] + 0.5 * fall * s.time_s * s.time_s])
                    .collect();
                squares += line_residual(&points);
            }
            // Six numbers are fitted to three a frame.
            count += flight.len() as f64 - 2.0;
        }
        if count > 0.0 { (squares / count).sqrt() } else { 0.0 }
    }
}

/// Height of the cube's lowest corner.
fn lowest(pose: &Pose) -> f64 {
    let down =
        rotate([-pose.rotation[0], -pose.rotation[1], -pose.rotation[2], pose.rotation[3]], [0.0, 1.0, 0.0]);
    pose.position[1] - 0.5 * SIDE_M * down.iter().map(|x| x.abs()).sum::<f64>()
}

/// Sum of the squared distances from the straight line that fits best.
fn line_residual(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean: [f64; 2] = std::array::from_fn(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let moment = |a: usize, b: usize| points.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>();
    moment(1, 1) - moment(0, 1).powi(2) / moment(0, 0)
}

/// Angle between two rotations, degrees.
fn angle_deg(a: [f64; 4], b: [f64; 4]) -> f64 {
    let dot: f64 = (0..4).map(|k| a[k] * b[k]).sum();
    (2.0 * dot.abs().min(1.0).acos()).to_degrees()
}

fn load(file: &Path) -> Result<Vec<Sample>> {
    let text = fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    let mut samples = Vec::new();
    for (line, row) in text.lines().enumerate().skip(1) {
        let at = || format!("{}:{}: expected 14 numbers, found {row:?}", file.display(), line + 1);
        let numbers: Vec<f64> =
            row.split(',').map(|field| field.trim().parse()).collect::<Result<_, _>>().with_context(at)?;
        let [t, x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz] = numbers[..] else { bail!(at()) };
        // Z up to Y up: a quarter turn about x, back.
        let rotation = then([qx, qy, qz, qw], turn([1.0, 0.0, 0.0], -90.0));
        samples.push(Sample {
            time_s: t,
            pose: Pose { position: [x, z, -y], rotation },
            velocity: Velocity { linear: [vx, vz, -vy], angular: rotate(rotation, [wx, wy, wz]) },
        });
    }
    if samples.len() < 2 {
        bail!("{}: expected a header and two rows or more", file.display());
    }
    Ok(samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_toss_that_went_as_simulated_has_no_error() {
        let folder = tempfile::tempdir().expect("a folder");
        // Free fall for ten frames, turning about the vertical (z up).
        let mut text = "header\n".to_owned();
        for k in 0..10 {
            let t = f64::from(k) / 148.0;
            let (sin, cos) = (0.5 * 3.0 * t).sin_cos();
            text += &format!("{t},0.1,0.2,{},{cos},0,0,{sin},0,0,{},0,0,3\n", 1.0 - 0.5 * G * t * t, -G * t);
        }
        fs::write(folder.path().join("0.csv"), text).expect("written");
        let tosses = Tosses::load(folder.path()).expect("read");
        assert!(tosses.noise_m() < 1e-9 && (tosses.dt_s() - 1.0 / 148.0).abs() < 1e-12);
        let subject = super::super::Subject::tosses(tosses);
        let setup = super::super::Setup::default_of(super::super::Engine::Physique, subject.dt_s);
        let (track, _) =
            super::super::record(&subject, &setup, &super::super::Programs::default()).expect("runs");
        for judgement in subject.judge(&track) {
            assert!(judgement.value.abs() < 1e-6, "{judgement:?}");
        }
    }

    #[test]
    fn a_bad_row_names_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("7.csv"), "header\n1,2,three\n").expect("written");
        let error = Tosses::load(folder.path()).err().map(|error| format!("{error:#}")).unwrap_or_default();
        assert!(error.contains("7.csv:2: expected 14 numbers"), "{error}");
    }
}
