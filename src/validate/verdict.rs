//! Do two engines say the same of a body at rest?
//!
//! Trajectories are not compared: after the first bounce they part by chaos. What is compared is where a body
//! comes to rest above the floor and on which side it lies.

use serde::{Deserialize, Serialize};
use sim::{Mass, Scene, measure};

use crate::settle::{Outcome, Rest, angle_deg};

/// Rest heights agree within this, m, or within [`HEIGHT_SHARE`] of the body's size.
const HEIGHT_M: f64 = 2e-3;
const HEIGHT_SHARE: f64 = 0.02;

/// The sides they lie on agree within this, degrees.
const SIDE_DEG: f64 = 3.0;

/// Two sides of a symmetric body (a die on another face, a barrel rolled on) count as one where the moments of
/// inertia about the vertical agree within this share and the heights agree too.
const MOMENT_SHARE: f64 = 0.02;

/// What the comparison of one body came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    pub entity: usize,
    pub name: String,
    pub agrees: bool,
    /// What differs, in one sentence; what was forgiven, where they agree.
    pub remark: String,
    /// Ours minus rapier's, m.
    pub height_difference_m: f64,
    /// Angle between the sides they lie on, degrees.
    pub side_difference_deg: f64,
    pub ours: Rest,
    pub rapier: Rest,
}

/// Compares every body of `scene` that moves, given how it came to rest in both.
#[must_use]
pub fn judge(scene: &Scene, ours: &Outcome, rapier: &Outcome) -> Vec<Verdict> {
    let bodies = ours.bodies.iter().zip(&rapier.bodies);
    bodies
        .filter_map(|(a, b)| Some(judge_body(a, b, &measure::mass_of(scene.entities.get(a.entity)?)?)))
        .collect()
}

fn judge_body(ours: &Rest, rapier: &Rest, mass: &Mass) -> Verdict {
    let height_difference_m = ours.height_m - rapier.height_m;
    let side_difference_deg = angle_deg(ours.down, rapier.down);
    let height_limit = HEIGHT_M.max(HEIGHT_SHARE * ours.size_m);
    let (agrees, remark) = if !(ours.settled && rapier.settled) {
        let who = match (ours.settled, rapier.settled) {
            (false, false) => "neither engine brings it to rest",
            (false, true) => "it does not come to rest in ours",
            _ => "it does not come to rest in rapier",
        };
        (false, who.to_owned())
    } else if height_difference_m.abs() > height_limit {
        let remark = format!(
            "rests {:.1} mm {} in ours (limit {:.1} mm), {:.0} degrees apart",
            height_difference_m.abs() * 1e3,
            if height_difference_m > 0.0 { "higher" } else { "lower" },
            height_limit * 1e3,
            side_difference_deg
        );
        (false, remark)
    } else if side_difference_deg <= SIDE_DEG {
        (true, String::new())
    } else if same_by_symmetry(ours, rapier, mass) {
        (
            true,
            format!(
                "on another side of the same height and moment of inertia, {side_difference_deg:.0} degrees apart"
            ),
        )
    } else {
        (false, format!("lies on another side, {side_difference_deg:.1} degrees apart (limit {SIDE_DEG})"))
    };
    Verdict {
        entity: ours.entity,
        name: ours.name.clone(),
        agrees,
        remark,
        height_difference_m,
        side_difference_deg,
        ours: ours.clone(),
        rapier: rapier.clone(),
    }
}

fn same_by_symmetry(ours: &Rest, rapier: &Rest, mass: &Mass) -> bool {
    let (a, b) = (measure::moment_about(mass, ours.down), measure::moment_about(mass, rapier.down));
    (a - b).abs() <= MOMENT_SHARE * a.max(b)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const BRICK: Mass = Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] };
    const DIE: Mass = Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0] };

    pub(in super::super) fn rest(height_m: f64, down: [f64; 3]) -> Rest {
        Rest {
            entity: 1,
            name: "body".to_owned(),
            settled: true,
            settled_at_s: Some(0.5),
            height_m,
            down,
            tipped_deg: 0.0,
            max_penetration_m: 0.0,
            rest_penetration_m: 0.0,
            size_m: 0.2,
            smallest_side_m: 0.1,
            position_m: [0.0, height_m, 0.0],
            rotation: [0.0, 0.0, 0.0, 1.0],
        }
    }

    #[test]
    fn heights_agree_within_two_hundredths_of_the_size() {
        assert!(judge_body(&rest(0.1, [0.0, -1.0, 0.0]), &rest(0.1039, [0.0, -1.0, 0.0]), &BRICK).agrees);
        let verdict = judge_body(&rest(0.1, [0.0, -1.0, 0.0]), &rest(0.1041, [0.0, -1.0, 0.0]), &BRICK);
        assert!(!verdict.agrees && verdict.remark.contains("4.1 mm lower"), "{}", verdict.remark);
    }

    #[test]
    fn another_side_counts_as_the_same_only_where_the_body_cannot_tell() {
        let (upright, lying) = (rest(0.1, [0.0, -1.0, 0.0]), rest(0.1, [-1.0, 0.0, 0.0]));
        assert!(judge_body(&upright, &lying, &DIE).agrees);
        assert!(!judge_body(&upright, &lying, &BRICK).agrees);
    }

    #[test]
    fn a_body_that_never_rests_agrees_with_nothing() {
        let still = rest(0.1, [0.0, -1.0, 0.0]);
        let moving = Rest { settled: false, settled_at_s: None, ..still.clone() };
        let verdict = judge_body(&still, &moving, &DIE);
        assert!(!verdict.agrees && verdict.remark.contains("rapier"));
    }
}
