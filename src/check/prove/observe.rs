//! What a proof says, rule by rule, with the line that most likely has to change.

use std::path::Path;

use mapper::{Mapped, Provenance};

use super::super::observation::Observation;
use super::super::place::Places;
use super::trials::{HOLD_SHARE, SLIDE_SHARE};
use super::{Both, Proof};
use crate::check::rule::Rule;

/// A tilt after which a body has fallen, degrees: the bound of SIM012 and SIM013.
const FALLEN_DEG: f64 = 15.0;

/// By the statics of its base, what tips only beyond this tilt stands, degrees.
const SURE_DEG: f64 = 4.0;

/// Everything that the runtime layer sees of a model.
#[must_use]
pub fn observations(
    proof: &Proof,
    model: &str,
    file: &Path,
    mapped: &Mapped,
    places: &Places,
) -> Vec<Observation> {
    let by = |name: &str| mapped.attribute(name).map(|attribute| &attribute.provenance);
    let friction = by("friction_dynamic");
    let restitution = by("restitution");
    let mass = by("mass");
    let preset = mapped.preset_by.as_ref();
    let shape = preset.or(mass);
    let at = |observation: Observation, by: Option<&Provenance>| {
        let observation = observation.of(model).at(by.and_then(|by| places.of(by, Some(file))));
        match by {
            Some(by) => observation.because(&by.by),
            None => observation,
        }
    };
    let mut seen = Vec::new();
    let drop = &proof.drop;
    let come = if drop.settled { "came to rest" } else { "never came to rest: still moving" };
    let message = format!(
        "dropped from twice its height it {come} {:.1} s after it landed; it has {:.1} s",
        drop.rest_after_s, drop.rests_within_s
    );
    // What never rested has run to the end of its time, which is beyond the bound; a bound raised further by the
    // user must not make it a body that rests.
    let share = if drop.settled { drop.rest_after_s / drop.rests_within_s } else { f64::INFINITY };
    seen.push(at(Observation::measured("SIM002", share, message), restitution.or(shape)));
    seen.push(at(
        Observation::measured(
            "SIM003",
            drop.energy_rise_percent,
            "as it fell and came to rest its energy rose",
        ),
        shape,
    ));
    seen.push(at(Observation::measured("SIM004", drop.rest_depth, "its depth in the floor at rest"), mass));
    seen.push(at(Observation::measured("SIM005", drop.most_depth, "its greatest depth in the floor"), mass));
    if drop.tunnelled {
        seen.push(at(
            Observation::fact("SIM006", "dropped from twice its height it fell through the floor"),
            mass,
        ));
    }
    seen.push(at(
        Observation::measured(
            "SIM007",
            drop.launch_percent,
            "after it landed it rose above where it was dropped from",
        ),
        restitution.or(shape),
    ));
    if drop.quarantined {
        seen.push(at(Observation::fact("SIM008", "its state became infinite or no number"), mass));
    }
    if !drop.rapier_differs.is_empty() {
        let message = format!("dropped from twice its height: {}", drop.rapier_differs);
        seen.push(at(Observation::fact("SIM016", message), shape));
    }
    stand(proof, &mut seen, &|seen| at(seen, shape));
    if let Some(stay) = &proof.stay {
        seen.push(at(
            Observation::measured(
                "SIM011",
                stay.ours,
                "left where it came to rest it drifted in two seconds",
            ),
            shape,
        ));
        if crosses("SIM011", stay) {
            let message = format!(
                "left where it came to rest it drifts, in limits of a resting body: {}",
                written(stay, "x")
            );
            seen.push(at(Observation::fact("SIM018", message), shape));
        }
    }
    if let Some(slope) = &proof.slope {
        let message = format!("friction {:.3} with the floor", slope.friction);
        seen.push(at(Observation::measured("SIM015", slope.friction.atan().to_degrees(), message), friction));
        let degrees = |share: f64| (share * slope.friction).atan().to_degrees();
        let tried = [
            ("SIM009", HOLD_SHARE, &slope.hold_percent, "% of its size"),
            ("SIM010", SLIDE_SHARE, &slope.slide_percent, "% of the closed form"),
        ];
        for (code, share, way, unit) in tried {
            let Some(way) = way else { continue };
            let message = format!(
                "its way down a slope of {:.1} degrees, friction {:.3}",
                degrees(share),
                slope.friction
            );
            seen.push(at(Observation::measured(code, way.ours, message.clone()), friction));
            if crosses(code, way) {
                seen.push(at(
                    Observation::fact("SIM017", format!("{message}: {}", written(way, unit))),
                    friction,
                ));
            }
        }
    }
    if let Some(stack) = &proof.stack {
        seen.push(at(
            Observation::measured("SIM014", stack.ours, "height that the top of three lost"),
            shape,
        ));
        if crosses("SIM014", stack) {
            let message = format!("height that the top of three lost: {}", written(stack, "%"));
            seen.push(at(Observation::fact("SIM019", message), shape));
        }
    }
    seen
}

fn stand(proof: &Proof, seen: &mut Vec<Observation>, at: &dyn Fn(Observation) -> Observation) {
    let stand = &proof.stand;
    let tilt = &stand.tilt_deg;
    let should = stand.tips_at_deg > SURE_DEG;
    let message =
        format!("put down as modelled it tilted; by its base it tips at {:.1} degrees", stand.tips_at_deg);
    let code = if should { "SIM013" } else { "SIM012" };
    seen.push(at(Observation::measured(code, tilt.ours, message)));
    let differs = tilt.rapier.is_some_and(|rapier| (rapier > FALLEN_DEG) != (tilt.ours > FALLEN_DEG));
    // On the edge between standing and falling either may be right.
    if differs && should {
        seen.push(at(Observation::fact(
            "SIM018",
            format!("put down as modelled it tilts: {}", written(tilt, "degrees")),
        )));
    }
}

/// Whether the engines are on two sides of the rule's own bound.
fn crosses(code: &str, both: &Both<f64>) -> bool {
    let bound = Rule::find(code).and_then(|rule| rule.bound);
    bound
        .zip(both.rapier)
        .is_some_and(|(bound, rapier)| bound.is_crossed(rapier) != bound.is_crossed(both.ours))
}

fn written(both: &Both<f64>, unit: &str) -> String {
    let number = super::super::rule::written;
    let rapier = both.rapier.map_or_else(|| "not asked".to_owned(), number);
    format!("{} {unit} in ours, {rapier} {unit} in rapier", number(both.ours))
}
