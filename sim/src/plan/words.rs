//! The plan in words: what was chosen for whom, why, and what is left out for it.

use std::fmt;

use super::{Aspect, Choice, Facts, Plan};

impl Plan {
    /// Every choice with its reason, one or more an aspect.
    #[must_use]
    pub fn choices(&self) -> Vec<Choice> {
        Aspect::ALL.into_iter().flat_map(|aspect| self.choices_of(aspect)).collect()
    }

    fn choices_of(&self, aspect: Aspect) -> Vec<Choice> {
        let choice = |scope: &str, model, reason: String, skips| {
            vec![Choice { aspect, scope: scope.to_owned(), model, reason, skips }]
        };
        let Facts { fixed, bouncy, rough, resisting, .. } = self.facts;
        let moving = self.moving();
        if self.full(aspect) {
            return choice("scene", self.full_model(aspect), "asked for".to_owned(), "");
        }
        match aspect {
            Aspect::Meetings if self.meetings() => choice(
                "scene",
                "pairs by overlapping bounds",
                format!("{moving} bodies move among {fixed} fixed ones"),
                "",
            ),
            Aspect::Meetings => choice(
                "scene",
                "none",
                if moving == 0 { "nothing moves".to_owned() } else { "there is nothing to meet".to_owned() },
                "broad phase, narrow phase, contacts",
            ),
            Aspect::Flight => choice(
                "islands of one body with nothing near, each step",
                "parabola from the launch state, the whole step at once",
                "gravity is constant, so the closed form is exact".to_owned(),
                "small steps",
            ),
            Aspect::Rotation => self.rotation_choices(),
            Aspect::Impacts if self.impacts() => choice(
                "contacts of restitution above 0",
                "impacts at their time, pair after pair",
                format!("{bouncy} entities bounce"),
                "",
            ),
            Aspect::Impacts => choice(
                "scene",
                "none",
                if self.meetings() { "no surface bounces".to_owned() } else { "nothing meets".to_owned() },
                "search for times of impact, micro-collisions",
            ),
            Aspect::MicroCollisions if !self.impacts() => {
                choice("scene", "none", "there are no impacts".to_owned(), "micro-collisions")
            }
            Aspect::MicroCollisions if rough < 2 => choice(
                "every impact",
                "without friction: one division",
                "no two rough surfaces can meet".to_owned(),
                "sliding in the impact",
            ),
            Aspect::MicroCollisions => choice(
                "each impact",
                "closed form where the sliding keeps its line, else integrated against the normal impulse",
                "the direction turns only where the Delassus matrix couples it".to_owned(),
                "integration of straight sliding",
            ),
            Aspect::Friction if self.meetings() && rough >= 2 => choice(
                "contacts of friction above 0",
                "Coulomb's cone at every contact point",
                format!("{rough} entities are rough"),
                "",
            ),
            Aspect::Friction => choice(
                "scene",
                "none",
                if self.meetings() {
                    "no two rough surfaces can meet".to_owned()
                } else {
                    "nothing meets".to_owned()
                },
                "friction rows",
            ),
            Aspect::Islands => self.island_choices(),
            Aspect::Rolling if self.rolling() => choice(
                "round contacts of rolling resistance above 0",
                "Coulomb's law on spins",
                format!("{resisting} entities resist rolling"),
                "",
            ),
            Aspect::Rolling => choice(
                "scene",
                "none",
                if self.meetings() {
                    "no surface resists rolling".to_owned()
                } else {
                    "nothing meets".to_owned()
                },
                "rolling constraints",
            ),
        }
    }

    fn rotation_choices(&self) -> Vec<Choice> {
        let Facts { isotropic, symmetric, asymmetric, .. } = self.facts;
        [
            (
                isotropic,
                "constant spin",
                "all principal moments are equal",
                "precession, integration, turning the inertia tensor",
            ),
            (
                symmetric,
                "regular precession in closed form",
                "two principal moments are equal",
                "integration",
            ),
            (
                asymmetric,
                "Runge and Kutta's fourth order, momentum and energy held",
                "all principal moments differ",
                "",
            ),
        ]
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, model, reason, skips)| Choice {
            aspect: Aspect::Rotation,
            scope: format!("{count} bodies"),
            model,
            reason: reason.to_owned(),
            skips,
        })
        .collect()
    }

    fn island_choices(&self) -> Vec<Choice> {
        let Facts { balls, weightless, .. } = self.facts;
        let moving = self.moving();
        let choice = |scope: &str, model, reason: &str, skips| Choice {
            aspect: Aspect::Islands,
            scope: scope.to_owned(),
            model,
            reason: reason.to_owned(),
            skips,
        };
        if !self.meetings() {
            return vec![choice("scene", "none", "nothing meets", "contacts")];
        }
        if weightless {
            let reason = "without gravity nothing rests on anything";
            return vec![choice("scene", "sweeps", reason, "the lone body's intervals, direct solve")];
        }
        let lone = choice(
            "one body on what stands still, unless made of balls, each step",
            "intervals that keep the energy, from landing to landing",
            "a body that pivots, rocks or whips is beyond sweeps with the arms of the step's beginning",
            "sweeps",
        );
        let direct = choice(
            "up to 48 bodies, a heavy one on a light one, or four and more, or wedged and quiet, each step",
            "direct solve",
            "sweeps carry a load down n bodies in n² sweeps, and under a mass ratio r in r",
            "sweeps",
        );
        let swept = choice(
            if moving > balls { "every other island, each step" } else { "every island of few, each step" },
            "sweeps, eight at a time",
            "what is low, light, quick or round settles in one sweep a pass",
            "the lone body's intervals, direct solve",
        );
        let takes = [(moving > balls, lone), (moving > 1, direct), (moving > 1 || balls > 0, swept)];
        takes.into_iter().filter(|(taken, _)| *taken).map(|(_, choice)| choice).collect()
    }

    fn full_model(&self, aspect: Aspect) -> &'static str {
        match aspect {
            Aspect::Meetings => "pairs by overlapping bounds",
            Aspect::Flight => "small steps for every body",
            Aspect::Rotation => "Runge and Kutta's fourth order for every body",
            Aspect::Impacts => "impacts at their time for every pair",
            Aspect::MicroCollisions => "every impact integrated against the normal impulse",
            Aspect::Friction => "friction rows for every contact",
            Aspect::Rolling => "rolling constraints at every round contact",
            Aspect::Islands => {
                "direct solve for every island of up to 48 bodies, intervals for every lone body"
            }
        }
    }
}

/// A line a choice: `aspect: model, for scope: reason; leaves out …`.
impl fmt::Display for Plan {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Choice { aspect, scope, model, reason, skips } in self.choices() {
            write!(out, "{:<17} {model} ({scope}): {reason}", aspect.name())?;
            if skips.is_empty() { writeln!(out)? } else { writeln!(out, "; leaves out {skips}")? }
        }
        Ok(())
    }
}
