//! The plan: which models a scene needs, and why the others are left out.
//!
//! [`Plan::of`] looks at a scene once, before the first step, and picks for each [`Aspect`] the cheapest model that is
//! right. Some choices hold for the scene (nothing bounces: no search for impacts), some for a body (how it turns), and
//! some are made again each step: an island is a flight while nothing is near it, a contact has no friction row where
//! its pair has no friction. What a step then really did stands in [`crate::Work`].

mod words;

use crate::material::MaterialPair;
use crate::math::symmetric;
use crate::rotation::Rotor;
use crate::scene::{ChildShape, Entity, Motion, Scene, Shape, Surface};

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
    /// How the contacts of an island are solved together.
    Islands,
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
    /// Moving entities that are made of balls alone.
    balls: usize,
    weightless: bool,
}

impl Aspect {
    /// Every aspect.
    pub const ALL: [Self; 8] = [
        Self::Meetings,
        Self::Flight,
        Self::Rotation,
        Self::Impacts,
        Self::MicroCollisions,
        Self::Friction,
        Self::Rolling,
        Self::Islands,
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
            Self::Islands => "islands",
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
        let mut facts = Facts { weightless: scene.gravity == [0.0; 3], ..Facts::default() };
        for entity in &scene.entities {
            let is_ball = |child: &ChildShape| matches!(child.shape, Shape::Sphere { .. });
            let moves = matches!(entity.motion, Motion::Dynamic(_));
            facts.balls += usize::from(moves && entity.shapes.iter().all(is_ball));
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

    /// Whether islands are solved directly, or alone, that sweeps would do for.
    pub(crate) fn solves_every_island(&self) -> bool {
        self.full(Aspect::Islands)
    }

    fn moving(&self) -> usize {
        self.facts.isotropic + self.facts.symmetric + self.facts.asymmetric
    }
}
