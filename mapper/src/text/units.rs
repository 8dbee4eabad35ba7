//! Quantities as people write them: a number and a unit, into SI.

use std::fmt;

/// What a quantity measures. Each has one SI unit, in which it is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// A pure number, written bare.
    Pure,
    Length,
    Mass,
    Density,
    Pressure,
    DynamicViscosity,
    SurfaceTension,
    Time,
    Velocity,
    AngularVelocity,
    Acceleration,
    Angle,
}

/// Why a text is no quantity of the dimension that was due.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnitError {
    #[error("expected a number followed by a unit, found {found:?}")]
    NoNumber { found: String },
    #[error("{found:?} is not a finite number")]
    NotFinite { found: String },
    #[error("a {dimension} needs its unit")]
    UnitMissing { dimension: Dimension, number: String },
    #[error("a {dimension} is not measured in {unit:?}")]
    WrongUnit { dimension: Dimension, unit: String },
    #[error("expected a bare number, found the unit {unit:?}")]
    UnitOnPure { unit: String },
}

/// Unit, what it measures, its worth in SI. The first of a dimension is the SI unit itself.
const UNITS: &[(&str, Dimension, f64)] = &[
    ("m", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 0.01),
    ("mm", Dimension::Length, 0.001),
    ("um", Dimension::Length, 1e-6),
    ("km", Dimension::Length, 1000.0),
    ("in", Dimension::Length, 0.0254),
    ("ft", Dimension::Length, 0.3048),
    ("kg", Dimension::Mass, 1.0),
    ("g", Dimension::Mass, 1e-3),
    ("mg", Dimension::Mass, 1e-6),
    ("t", Dimension::Mass, 1000.0),
    ("lb", Dimension::Mass, 0.453_592_37),
    ("oz", Dimension::Mass, 0.028_349_523_125),
    ("kg/m3", Dimension::Density, 1.0),
    ("g/cm3", Dimension::Density, 1000.0),
    ("kg/l", Dimension::Density, 1000.0),
    ("Pa", Dimension::Pressure, 1.0),
    ("kPa", Dimension::Pressure, 1e3),
    ("MPa", Dimension::Pressure, 1e6),
    ("GPa", Dimension::Pressure, 1e9),
    ("Pa.s", Dimension::DynamicViscosity, 1.0),
    ("mPa.s", Dimension::DynamicViscosity, 1e-3),
    ("cP", Dimension::DynamicViscosity, 1e-3),
    ("N/m", Dimension::SurfaceTension, 1.0),
    ("mN/m", Dimension::SurfaceTension, 1e-3),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("min", Dimension::Time, 60.0),
    ("m/s", Dimension::Velocity, 1.0),
    ("km/h", Dimension::Velocity, 1.0 / 3.6),
    ("rad/s", Dimension::AngularVelocity, 1.0),
    ("deg/s", Dimension::AngularVelocity, std::f64::consts::PI / 180.0),
    ("rpm", Dimension::AngularVelocity, std::f64::consts::PI / 30.0),
    ("m/s2", Dimension::Acceleration, 1.0),
    ("rad", Dimension::Angle, 1.0),
    ("deg", Dimension::Angle, std::f64::consts::PI / 180.0),
];

impl Dimension {
    /// The SI unit, `1` for a pure number.
    #[must_use]
    pub fn si_unit(self) -> &'static str {
        UNITS.iter().find(|(_, dimension, _)| *dimension == self).map_or("1", |(unit, ..)| unit)
    }

    /// Every unit of this dimension, the SI unit first.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        UNITS.iter().filter(move |(_, dimension, _)| *dimension == self).map(|(unit, ..)| *unit)
    }

    /// `kg, g, lb`
    #[must_use]
    pub fn unit_list(self) -> String {
        self.units().collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pure => "pure number",
            Self::Length => "length",
            Self::Mass => "mass",
            Self::Density => "density",
            Self::Pressure => "pressure",
            Self::DynamicViscosity => "dynamic viscosity",
            Self::SurfaceTension => "surface tension",
            Self::Time => "time",
            Self::Velocity => "velocity",
            Self::AngularVelocity => "angular velocity",
            Self::Acceleration => "acceleration",
            Self::Angle => "angle",
        })
    }
}

/// Reads `7850 kg/m3`, `2mm`, or `0.4` where the dimension is pure, and gives it in SI.
///
/// # Errors
/// A text without a finite number, without the unit that is due, or with one of another dimension.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, UnitError> {
    let text = text.trim();
    let (number, unit) = split(text);
    let unit = unit.trim();
    if number.is_empty() {
        return Err(UnitError::NoNumber { found: text.to_owned() });
    }
    let value: f64 = number.parse().map_err(|_| UnitError::NoNumber { found: text.to_owned() })?;
    if !value.is_finite() {
        return Err(UnitError::NotFinite { found: number.to_owned() });
    }
    if dimension == Dimension::Pure {
        return match unit {
            "" => Ok(value),
            _ => Err(UnitError::UnitOnPure { unit: unit.to_owned() }),
        };
    }
    if unit.is_empty() {
        return Err(UnitError::UnitMissing { dimension, number: number.to_owned() });
    }
    let (.., factor) = UNITS
        .iter()
        .find(|(name, of, _)| *name == unit && *of == dimension)
        .ok_or_else(|| UnitError::WrongUnit { dimension, unit: unit.to_owned() })?;
    let scaled = value * factor;
    if scaled.is_finite() { Ok(scaled) } else { Err(UnitError::NotFinite { found: text.to_owned() }) }
}

/// Number and unit as one text, in SI, read back by [`parse`] to the same bits.
#[must_use]
pub fn format(value: f64, dimension: Dimension) -> String {
    match dimension {
        Dimension::Pure => format!("{value}"),
        _ => format!("{value} {}", dimension.si_unit()),
    }
}

/// Splits after the number; an `e` belongs to it only where digits follow.
fn split(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let at = bytes[end];
        let sign_ok = end == 0 || matches!(bytes[end - 1], b'e' | b'E');
        let exponent = matches!(at, b'e' | b'E')
            && end > 0
            && bytes.get(end + 1).is_some_and(|next| {
                next.is_ascii_digit() || (matches!(next, b'+' | b'-') && bytes.len() > end + 2)
            });
        if at.is_ascii_digit() || at == b'.' || (matches!(at, b'+' | b'-') && sign_ok) || exponent {
            end += 1;
        } else {
            break;
        }
    }
    text.split_at(end)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn units_come_out_in_si() {
        for (text, dimension, expected) in [
            ("7850 kg/m3", Dimension::Density, 7850.0),
            ("7.85 g/cm3", Dimension::Density, 7850.0),
            ("2 mm", Dimension::Length, 0.002),
            ("2mm", Dimension::Length, 0.002),
            ("12 in", Dimension::Length, 0.3048),
            ("1 ft", Dimension::Length, 0.3048),
            ("250 g", Dimension::Mass, 0.25),
            ("210 GPa", Dimension::Pressure, 210e9),
            ("84 mPa.s", Dimension::DynamicViscosity, 0.084),
            ("72.8 mN/m", Dimension::SurfaceTension, 0.0728),
            ("1e3 Pa", Dimension::Pressure, 1000.0),
            ("1.5e-3 m", Dimension::Length, 0.0015),
            ("-0.5", Dimension::Pure, -0.5),
            ("180 deg", Dimension::Angle, std::f64::consts::PI),
        ] {
            let value = parse(text, dimension).unwrap();
            assert!((value - expected).abs() <= 1e-12 * expected.abs(), "{text}: {value}");
        }
    }

    #[test]
    fn a_bare_number_where_a_unit_is_due_is_an_error() {
        assert!(matches!(parse("7850", Dimension::Density), Err(UnitError::UnitMissing { .. })));
        assert!(matches!(parse("0.5 kg", Dimension::Pure), Err(UnitError::UnitOnPure { .. })));
        assert!(matches!(parse("3 kg", Dimension::Length), Err(UnitError::WrongUnit { .. })));
        assert!(matches!(parse("m", Dimension::Length), Err(UnitError::NoNumber { .. })));
        assert!(matches!(parse("1e999 m", Dimension::Length), Err(UnitError::NotFinite { .. })));
        for text in ["", ".", "-", "nan m", "inf m", "1 2 m", "--1 m", "1e m"] {
            assert!(parse(text, Dimension::Length).is_err(), "{text:?}");
        }
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back_to_the_same_bits(
            value in prop::num::f64::NORMAL | prop::num::f64::ZERO,
            unit in 0..UNITS.len(),
        ) {
            let dimension = UNITS[unit].1;
            prop_assert_eq!(parse(&format(value, dimension), dimension).unwrap().to_bits(), value.to_bits());
        }

        #[test]
        fn no_text_makes_it_panic(text in any::<String>()) {
            let _ = parse(&text, Dimension::Mass);
            let _ = parse(&text, Dimension::Pure);
        }
    }
}
