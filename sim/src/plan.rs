//! The plan: which models a scene needs, and why the others are left out.
//!
//! [`Plan::of`] looks at a scene once, before the first step, and picks for each [`Aspect`] the cheapest model that is
//! right. Some choices hold for the scene (nothing bounces: no search for impacts), some for a body (how it turns), and
//! some are made again each step: an island is a flight while nothing is near it, a contact has no friction row where
//! its pair has no friction. What a step then really did stands in [`crate::Work`].

use std::fmt;

use crate::material::MaterialPair;
use crate::math::symmetric;
use crate::rotation::Rotor;
use crate::scene::{Entity, Motion, Scene, Surface};

/// What a choice is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Aspect {
    /// Whether any two things can meet.
    Meetings,
    /// How something moves that nothing is near.
    Flight,
    /// How a body turns between contacts.
    Rotation,
    /// Whether impacts are looked for at their time.
    Impacts,
    /// How the impulse of one impact is found.
    MicroCollisions,
    /// Whether contacts have friction rows.
    Friction,
    /// Whether contacts resist rolling.
    Rolling,
}

/// A choice, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    pub aspect: Aspect,
    /// Who it holds for.
    pub scope: String,
    pub model: &'static str,
    pub reason: String,
    /// What is not done because of it; empty where nothing is left out.
    pub skips: &'static str,
}

/// The models of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    full: u8,
    facts: Facts,
}

/// What a scene has, as far as a choice depends on it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Facts {
    fixed: usize,
    isotropic: usize,
    symmetric: usize,
    asymmetric: usize,
    /// Entities with a shape of restitution, friction or rolling resistance above 0.
    bouncy: usize,
    rough: usize,
    resisting: usize,
}

impl Aspect {
    /// Every aspect.
    pub const ALL: [Self; 7] = [
        Self::Meetings,
        Self::Flight,
        Self::Rotation,
        Self::Impacts,
        Self::MicroCollisions,
        Self::Friction,
        Self::Rolling,
    ];

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Meetings => "meetings",
            Self::Flight => "flight",
            Self::Rotation => "rotation",
            Self::Impacts => "impacts",
            Self::MicroCollisions => "micro-collisions",
            Self::Friction => "friction",
            Self::Rolling => "rolling",
        }
    }
}

impl Plan {
    /// The cheapest models that are right for `scene`.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        // By its own surfaces, or by a known pair of materials that it belongs to.
        let has = |entity: &Entity, own: fn(&Surface) -> f64, known: fn(&MaterialPair) -> Option<f64>| {
            entity.shapes.iter().any(|child| {
                let in_pair = |pair: &MaterialPair| {
                    child.surface.material.is_some_and(|material| pair.between.contains(&material))
                        && known(pair).is_some_and(|value| value > 0.0)
                };
                own(&child.surface) > 0.0 || scene.pairs.iter().any(in_pair)
            })
        };
        let mut facts = Facts::default();
        for entity in &scene.entities {
            match &entity.motion {
                Motion::Static => facts.fixed += 1,
                Motion::Dynamic(mass) => match Rotor::of(&symmetric(mass.inertia_kg_m2)) {
                    Rotor::Isotropic => facts.isotropic += 1,
                    Rotor::Symmetric { .. } => facts.symmetric += 1,
                    Rotor::Asymmetric => facts.asymmetric += 1,
                },
            }
            facts.bouncy += usize::from(has(entity, |surface| surface.restitution, |pair| pair.restitution));
            facts.rough += usize::from(has(entity, |surface| surface.friction, |pair| pair.friction));
            facts.resisting += usize::from(has(entity, |surface| surface.rolling_resistance, |_| None));
        }
        Self { full: 0, facts }
    }

    /// The same, with the full model of one aspect, needed or not: to measure what the cheap one costs in error.
    #[must_use]
    pub fn with_full(mut self, aspect: Aspect) -> Self {
        self.full |= 1 << aspect as u8;
        self
    }

    fn full(&self, aspect: Aspect) -> bool {
        self.full >> aspect as u8 & 1 == 1
    }

    /// Whether pairs are searched for at all.
    pub(crate) fn meetings(&self) -> bool {
        let Facts { fixed, .. } = self.facts;
        let moving = self.moving();
        self.full(Aspect::Meetings) || moving >= 2 || moving == 1 && fixed >= 1
    }

    /// Whether what nothing is near flies a whole step at once.
    pub(crate) fn flight(&self) -> bool {
        !self.full(Aspect::Flight)
    }

    /// How a body of this inertia tensor turns.
    pub(crate) fn rotor(&self, inertia: &crate::math::Mat3) -> Rotor {
        if self.full(Aspect::Rotation) { Rotor::Asymmetric } else { Rotor::of(inertia) }
    }

    /// Whether impacts are looked for.
    pub(crate) fn impacts(&self) -> bool {
        self.full(Aspect::Impacts) || self.meetings() && self.facts.bouncy > 0
    }

    /// Whether also pairs without restitution are asked for their impacts.
    pub(crate) fn every_pair_bounces(&self) -> bool {
        self.full(Aspect::Impacts)
    }

    /// Whether every impact is integrated, closed form or not.
    pub(crate) fn integrates_every_impact(&self) -> bool {
        self.full(Aspect::MicroCollisions)
    }

    /// Whether a contact of this coefficient of friction has friction rows.
    pub(crate) fn friction(&self, coefficient: f64) -> bool {
        self.full(Aspect::Friction) || coefficient > 0.0
    }

    /// Whether any contact may resist rolling.
    pub(crate) fn rolling(&self) -> bool {
        self.full(Aspect::Rolling) || self.meetings() && self.facts.resisting > 0
    }

    /// Whether a contact whose surfaces have this coefficient of rolling resistance resists rolling.
    pub(crate) fn resists_rolling(&self, coefficient: f64) -> bool {
        self.full(Aspect::Rolling) || coefficient > 0.0
    }

    fn moving(&self) -> usize {
        self.facts.isotropic + self.facts.symmetric + self.facts.asymmetric
    }

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

    fn full_model(&self, aspect: Aspect) -> &'static str {
        match aspect {
            Aspect::Meetings => "pairs by overlapping bounds",
            Aspect::Flight => "small steps for every body",
            Aspect::Rotation => "Runge and Kutta's fourth order for every body",
            Aspect::Impacts => "impacts at their time for every pair",
            Aspect::MicroCollisions => "every impact integrated against the normal impulse",
            Aspect::Friction => "friction rows for every contact",
            Aspect::Rolling => "rolling constraints at every round contact",
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
