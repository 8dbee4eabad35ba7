//! What changed in a group of models, in words, one an attribute.

use super::words::{attribute, category, ratio, thousands};
use super::{CHANGED_FILE, Pairs};

/// Where more than one in so many goes the other way, no middle is told: there is none.
const FEW: usize = 5;

/// What changed for most comes first.
pub(super) fn of(cause: &str, pairs: &Pairs<'_>) -> Vec<String> {
    let mut told = Vec::new();
    let Some((_, first_was, first_now)) = pairs.first() else { return told };
    if first_was.category != first_now.category {
        told.push(format!("{} becomes {}", category(&first_was.category), category(&first_now.category)));
    }
    if first_was.preset != first_now.preset {
        told.push(format!("of {} instead of {}", first_now.preset, first_was.preset));
    }
    let mut names: Vec<&str> = Vec::new();
    for (_, was, now) in pairs {
        for held in now.values.iter().chain(&was.values) {
            if !names.contains(&held.name.as_str()) {
                names.push(&held.name);
            }
        }
    }
    // What changes for most comes first, then what else follows from: density before mass, as it stands in the lock.
    let mut attributes: Vec<(usize, String)> =
        names.into_iter().filter_map(|name| change(name, pairs)).collect();
    attributes.sort_by_key(|(models, _)| std::cmp::Reverse(*models));
    told.extend(attributes.into_iter().map(|(_, words)| words));
    let other_file = first_was.input != first_now.input;
    if other_file && cause != CHANGED_FILE {
        told.push("the file changed too".to_owned());
    } else if other_file && told.is_empty() {
        told.push("other bytes, the same physics".to_owned());
    }
    if told.is_empty() {
        told.push(if first_was.rule == first_now.rule {
            "digits beyond the sixth".to_owned()
        } else {
            format!("decided anew (before by {}), the same physics", first_was.rule)
        });
    }
    told
}

/// One attribute over all models of a group, with how many it changes for; `None` where it is as it was.
fn change(name: &str, pairs: &Pairs<'_>) -> Option<(usize, String)> {
    let differing: Vec<(Option<&str>, Option<&str>)> = pairs
        .iter()
        .map(|(_, was, now)| {
            (was.held(name).map(|held| held.value.as_str()), now.held(name).map(|held| held.value.as_str()))
        })
        .filter(|(was, now)| was != now)
        .collect();
    let first = differing.first()?;
    let of = if differing.len() == pairs.len() {
        String::new()
    } else {
        format!(" of {} of them", thousands(differing.len() as f64))
    };
    let name = format!("{}{of}", attribute(name));
    let words = if differing.iter().all(|pair| pair == first) {
        one_change(&name, *first)
    } else {
        many_changes(&name, &differing)
    };
    Some((differing.len(), words))
}

/// The same change everywhere: `density 700 to 2,180 kg/m3`.
fn one_change(name: &str, (was, now): (Option<&str>, Option<&str>)) -> String {
    let shown = |value: &str| {
        let (number, unit) = value.split_once(' ').unwrap_or((value, ""));
        let number = number.parse().map_or_else(|_| number.replace('_', " "), thousands);
        (number, unit.to_owned())
    };
    let words = match (was.map(shown), now.map(shown)) {
        (Some((was, unit)), Some((now, new_unit))) => {
            let unit = if unit == new_unit { String::new() } else { format!(" {unit}") };
            format!("{name} {was}{unit} to {now} {new_unit}")
        }
        (None, Some((now, unit))) => format!("{name} is new: {now} {unit}"),
        (Some((was, unit)), None) => format!("{name} is gone: it was {was} {unit}"),
        (None, None) => format!("{name} changes"),
    };
    words.trim_end().to_owned()
}

/// Another change for every model: `mass up 3.1 times (2.9 to 3.3)`.
fn many_changes(name: &str, differing: &[(Option<&str>, Option<&str>)]) -> String {
    let number =
        |value: Option<&str>| value?.split(' ').next()?.parse::<f64>().ok().filter(|value| *value > 0.0);
    let mut ratios: Vec<f64> =
        differing.iter().filter_map(|(was, now)| Some(number(*now)? / number(*was)?)).collect();
    ratios.sort_by(f64::total_cmp);
    let (Some(least), Some(most)) = (ratios.first(), ratios.last()) else { return format!("{name} changes") };
    if ratios.len() < differing.len() {
        return format!("{name} changes");
    }
    let up = ratios.iter().filter(|ratio| **ratio > 1.0).count();
    if up.min(ratios.len() - up) * FEW > ratios.len() {
        return format!("{name} between {} and {}", ratio(*least), ratio(*most));
    }
    let spread =
        if most / least > 1.05 { format!(" ({} to {})", ratio(*least), ratio(*most)) } else { String::new() };
    format!("{name} {}{spread}", ratio(ratios[ratios.len() / 2]))
}

#[cfg(test)]
mod tests {
    use super::many_changes;

    #[test]
    fn a_middle_is_told_where_nearly_all_go_one_way() {
        let pair = |was, now| (Some(was), Some(now));
        let mut differing = vec![pair("1 kg", "0.9 kg"); 9];
        assert_eq!(many_changes("mass", &differing), "mass down 10 %");
        differing.push(pair("1 kg", "3 kg"));
        assert_eq!(many_changes("mass", &differing), "mass down 10 % (down 10 % to up 3 times)");
        differing.extend([pair("1 kg", "3 kg"); 4]);
        assert_eq!(many_changes("mass", &differing), "mass between down 10 % and up 3 times");
    }
}
