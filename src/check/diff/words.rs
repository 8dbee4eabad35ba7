//! Numbers and nouns as people write them.

use super::super::rule::written;

/// A change of a mass, size or other number that is told as a ratio from here on; below it in percent.
const TIMES: f64 = 1.5;

/// `up 3.1 times`, `down 12 %`
pub(super) fn ratio(value: f64) -> String {
    let (direction, times) = if value >= 1.0 { ("up", value) } else { ("down", 1.0 / value) };
    if times >= TIMES {
        format!("{direction} {} times", short(times))
    } else {
        format!("{direction} {} %", short((value - 1.0).abs() * 100.0))
    }
}

fn short(value: f64) -> String {
    if value >= 100.0 { thousands(value.round()) } else { written((value * 10.0).round() / 10.0) }
}

/// `2,180`
pub(super) fn thousands(value: f64) -> String {
    let text = written(value);
    let (whole, rest) = text
        .split_once('.')
        .map_or((text.as_str(), String::new()), |(whole, rest)| (whole, format!(".{rest}")));
    if whole.len() <= 4 && !(whole.len() == 4 && whole.bytes().all(|digit| digit.is_ascii_digit()))
        || whole.contains('e')
    {
        return text;
    }
    let mut grouped = String::new();
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && (whole.len() - index) % 3 == 0 && grouped != "-" {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped + &rest
}

/// As engineers call it: `dynamic friction` for `friction_dynamic`, `part 2's density` for `part2.density`.
pub(super) fn attribute(name: &str) -> String {
    if let Some((part, name)) = name.strip_prefix("part").and_then(|rest| rest.split_once('.')) {
        return format!("part {part}'s {}", attribute(name));
    }
    match name {
        "friction_static" => "static friction".to_owned(),
        "friction_dynamic" => "dynamic friction".to_owned(),
        "youngs_modulus" => "Young's modulus".to_owned(),
        "poisson_ratio" => "Poisson's ratio".to_owned(),
        other => other.replace('_', " "),
    }
}

/// `mug` of `kitchen/mug`.
pub(super) fn category(path: &str) -> String {
    if path == "-" { "uncategorized".to_owned() } else { path.rsplit('/').next().unwrap_or(path).to_owned() }
}

/// Of a subcategory's name: English plurals as far as such names need them.
pub(super) fn plural(noun: &str) -> String {
    let ends = |endings: &[&str]| endings.iter().any(|ending| noun.ends_with(ending));
    match noun.strip_suffix('y') {
        Some(stem) if !ends(&["ay", "ey", "oy", "uy"]) => format!("{stem}ies"),
        _ if ends(&["s", "x", "ch", "sh", "z"]) => format!("{noun}es"),
        _ => format!("{noun}s"),
    }
}

pub(super) fn counted(count: usize, noun: &str) -> String {
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let number = thousands(count as f64);
    if count == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_nouns_are_written_as_people_do() {
        assert_eq!(
            [700.0, 2180.0, 12_500.0, 0.25, 1.5e9].map(thousands),
            ["700", "2,180", "12,500", "0.25", "1.500e9"]
        );
        assert_eq!(
            ["friction_dynamic", "part2.density", "mass_model"].map(attribute),
            ["dynamic friction", "part 2's density", "mass model"]
        );
        assert_eq!(
            ["mug", "box", "berry", "tray", "dish"].map(plural),
            ["mugs", "boxes", "berries", "trays", "dishes"]
        );
        assert_eq!(
            [3.1, 0.5, 1.12, 0.9].map(ratio),
            ["up 3.1 times", "down 2 times", "up 12 %", "down 10 %"]
        );
    }
}
