//! A drop in rapier, and both engines' settings side by side.

use baseline::{Baseline, Defaults, LARGEST_LENGTH_UNIT_M, length_unit_m};
use sim::{Scene, Settings};

use crate::settle::{Outcome, Trace};

use super::Parameter;

/// Runs `scene` in rapier, at most for `max_time_s`; with `stop_at_rest` no longer than until all sleep.
///
/// # Errors
/// rapier cannot hold the scene.
pub fn run_rapier(
    scene: &Scene,
    settings: &Settings,
    max_time_s: f64,
    stop_at_rest: bool,
) -> Result<Outcome, String> {
    let mut baseline = Baseline::new(scene, settings)?;
    let mut trace = Trace::new(scene);
    trace.push(0, 0.0, |entity| baseline.state(entity), false);
    let steps = (max_time_s / settings.dt_s).round() as u64;
    while baseline.steps() < steps && !(stop_at_rest && baseline.at_rest()) {
        let acted = baseline.step();
        trace.push(baseline.steps(), baseline.time_s(), |entity| baseline.state(entity), acted);
    }
    Ok(trace.outcome())
}

/// Both engines' settings side by side, as they are set for `scene`, or for any scene.
#[must_use]
pub fn parameters(scene: Option<&Scene>, settings: &Settings) -> Vec<Parameter> {
    let rapier = Defaults::new();
    let scaled = |value: f64| match scene {
        Some(scene) => format!("{:.4}", value * length_unit_m(scene)),
        None => format!("{value} times the length unit"),
    };
    let gravity = scene.map_or(Scene::GRAVITY, |scene| scene.gravity);
    let unit = match scene {
        Some(scene) => format!("{:.4}", length_unit_m(scene)),
        None => format!("size of the smallest moving body, at most {LARGEST_LENGTH_UNIT_M}"),
    };
    let row =
        |name: &str, ours: String, theirs: String| Parameter { name: name.to_owned(), ours, rapier: theirs };
    let same = |name: &str, value: String| row(name, value.clone(), value);
    vec![
        same("gravity (m/s2)", format!("{gravity:?}")),
        same("step (s)", format!("{:.6}", settings.dt_s)),
        row(
            "substeps a step",
            settings.substeps.to_string(),
            format!("{} (solver iterations)", settings.substeps),
        ),
        same("friction of a pair", "as known, else geometric mean".to_owned()),
        same("restitution of a pair", "as known, else maximum".to_owned()),
        row("rolling resistance of a pair", "maximum".to_owned(), "not modelled".to_owned()),
        same("damping, linear and angular", "0".to_owned()),
        same("shapes, mass, inertia", "the scene's".to_owned()),
        row(
            "sleeping",
            on(settings.sleeping),
            format!("{}, below {} m/s", on(settings.sleeping), scaled(0.05)),
        ),
        same("still before sleep (s)", format!("{}", settings.sleep_delay_s)),
        row(
            "contact stiffness (Hz, damping ratio)",
            format!("{} / {}", settings.contact_hertz, settings.contact_damping_ratio),
            format!(
                "{} / {}, against static {} / {}",
                rapier.contact[0], rapier.contact[1], rapier.static_contact[0], rapier.static_contact[1]
            ),
        ),
        row(
            "fastest push out of an overlap (m/s)",
            format!("{}", settings.max_push_speed_m_s),
            scaled(rapier.max_push_speed),
        ),
        row("length unit (m)", "from each body's size".to_owned(), unit),
        row("friction model", "Coulomb cone a point".to_owned(), "Simplified (its default)".to_owned()),
        row("corners of a face it stands on", "all that matter".to_owned(), "the first four".to_owned()),
        row("precision", "f64 state".to_owned(), "f32".to_owned()),
    ]
}

fn on(flag: bool) -> String {
    if flag { "on" } else { "off" }.to_owned()
}
