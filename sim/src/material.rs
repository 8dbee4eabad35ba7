//! Friction and restitution of two surfaces in contact: what is known of the pair, else what the rules of combination
//! make of the two.

use crate::scene::Surface;

/// What is known of two materials in contact. `None`: the rule of combination holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialPair {
    /// [`Surface::material`] of the two, in any order.
    pub between: [u32; 2],
    /// Coulomb coefficient.
    pub friction: Option<f64>,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: Option<f64>,
}

/// The coefficients of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    pub friction: f64,
    pub restitution: f64,
}

impl Meeting {
    /// Of two surfaces; where a pair of materials stands twice the first holds.
    #[must_use]
    pub fn of(pairs: &[MaterialPair], a: &Surface, b: &Surface) -> Self {
        let known = a
            .material
            .zip(b.material)
            .and_then(|(a, b)| pairs.iter().find(|pair| pair.between == [a, b] || pair.between == [b, a]));
        Self {
            friction: known.and_then(|pair| pair.friction).unwrap_or_else(|| pair_friction(a, b)),
            restitution: known.and_then(|pair| pair.restitution).unwrap_or_else(|| pair_restitution(a, b)),
        }
    }
}

/// Rule for the friction of a pair: the geometric mean.
#[must_use]
pub fn pair_friction(a: &Surface, b: &Surface) -> f64 {
    (a.friction * b.friction).sqrt()
}

/// Rule for the restitution of a pair: the larger.
#[must_use]
pub fn pair_restitution(a: &Surface, b: &Surface) -> f64 {
    a.restitution.max(b.restitution)
}

/// Rule for the rolling resistance of a pair: the larger.
#[must_use]
pub fn pair_rolling_resistance(a: &Surface, b: &Surface) -> f64 {
    a.rolling_resistance.max(b.rolling_resistance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_pair_beats_the_rules_and_an_unknown_one_does_not() {
        let of =
            |friction, restitution, material| Surface { material, ..Surface::new(friction, restitution) };
        let (ice, steel) = (of(0.1, 0.3, Some(7)), of(0.4, 0.6, Some(2)));
        let pairs = [
            MaterialPair { between: [7, 2], friction: Some(0.02), restitution: None },
            MaterialPair { between: [2, 2], friction: None, restitution: Some(0.1) },
        ];
        for (a, b) in [(ice, steel), (steel, ice)] {
            assert_eq!(Meeting::of(&pairs, &a, &b), Meeting { friction: 0.02, restitution: 0.6 });
        }
        assert_eq!(Meeting::of(&pairs, &steel, &steel), Meeting { friction: 0.4, restitution: 0.1 });
        let nameless = Surface::new(0.4, 0.2);
        assert_eq!(Meeting::of(&pairs, &ice, &nameless), Meeting { friction: 0.2, restitution: 0.3 });
    }
}
