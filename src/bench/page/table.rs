//! Tables of the report, for the page and as CSV.

use std::fmt::Write as _;

use super::{escaped, short};
use crate::bench::clock::CLOCK;
use crate::bench::engine::Engine;
use crate::bench::machine::Machine;
use crate::bench::run::{Row, Sheet};
use crate::simulate::quoted;
use crate::validate::Parameter;

fn row(out: &mut String, class: &str, cells: &[String]) {
    let _ = write!(out, "<tr class=\"{class}\">");
    for cell in cells {
        let _ = write!(out, "<td>{cell}</td>");
    }
    out.push_str("</tr>\n");
}

fn head(names: &[&str]) -> String {
    let cells: Vec<String> = names.iter().map(|name| format!("<th>{name}</th>")).collect();
    format!("<div class=\"wide\"><table><tr>{}</tr>\n", cells.join(""))
}

const TAIL: &str = "</table></div>\n";

/// The scene's error in a row, coloured by whether it passes.
fn verdict(row: Option<&Row>) -> String {
    let Some(row) = row else { return String::new() };
    if let Some(reason) = &row.refused {
        return format!("<span class=\"fail\" title=\"{}\">refused</span>", escaped(reason));
    }
    let Some(figure) = row.errors.as_ref().and_then(|errors| errors.figures.first()) else {
        return String::new();
    };
    format!("<span class=\"{}\">{}</span>", class(figure.passes), short(figure.value))
}

const fn class(passes: bool) -> &'static str {
    if passes { "pass" } else { "fail" }
}

fn ms(row: Option<&Row>) -> String {
    row.and_then(|row| row.ms).map_or_else(String::new, |ms| short(ms.mean))
}

fn at_equal_error(sheet: &Sheet) -> String {
    match sheet.at_equal_error() {
        Some((row, ratio)) => {
            format!("<span title=\"{} {}\">{ratio:.2}</span>", row.setup.engine.name(), escaped(&row.label))
        }
        None if sheet.default_of(Engine::Physique).and_then(Row::error).is_some() => "never".to_owned(),
        None => String::new(),
    }
}

/// How many of the scene's figures are good enough.
fn reached(row: Option<&Row>) -> String {
    let Some((row, passes)) = row.and_then(|row| Some((row, row.passes()?))) else { return String::new() };
    let figures = row.errors.iter().flat_map(|errors| &errors.figures).filter(|f| f.limit.is_finite());
    let (good, all) = figures.fold((0, 0), |(good, all), f| (good + u32::from(f.passes), all + 1));
    format!("<span class=\"{}\">{good} of {all}</span>", class(passes))
}

/// All scenes, a line each.
pub(super) fn overview(sheets: &[Sheet]) -> String {
    let simd8 = sheets.iter().any(|sheet| sheet.default_of(Engine::RapierSimd8).is_some());
    let mut out = head(&[
        "scene",
        "bodies",
        "Physique ms",
        "rapier ms",
        if simd8 { "simd8 ms" } else { "" },
        "x rapier",
        "at equal error",
        "error",
        "unit",
        "Physique",
        "rapier",
        "must reach",
        "figures reached",
        "rapier",
    ]);
    for sheet in sheets {
        let (ours, theirs) = (sheet.default_of(Engine::Physique), sheet.default_of(Engine::Rapier));
        let figure = sheet.rows.iter().find_map(|row| row.errors.as_ref()?.figures.first());
        let ratio = ours.and_then(|row| row.over_rapier);
        row(
            &mut out,
            "",
            &[
                format!("<a href=\"#{0}\">{0}</a>", escaped(&sheet.scene)),
                sheet.bodies.to_string(),
                ms(ours),
                ms(theirs),
                ms(sheet.default_of(Engine::RapierSimd8)),
                ratio.map_or_else(String::new, |r| format!("{:.2} (&lt; {:.2})", r.mean, r.upper_95)),
                at_equal_error(sheet),
                figure.map_or_else(String::new, |figure| escaped(figure.figure)),
                figure.map_or("", |figure| figure.unit).to_owned(),
                verdict(ours),
                verdict(theirs),
                figure.filter(|f| f.limit.is_finite()).map_or_else(String::new, |figure| short(figure.limit)),
                reached(ours),
                reached(theirs),
            ],
        );
    }
    out + TAIL
}

/// The scene's own figures, engine by engine as they come.
pub(super) fn figures(sheet: &Sheet) -> String {
    let defaults: Vec<&Row> =
        sheet.rows.iter().filter(|row| row.is_default && row.errors.is_some()).collect();
    let Some(first) = defaults.iter().find_map(|row| row.errors.as_ref()) else { return String::new() };
    if first.figures.is_empty() {
        return String::new();
    }
    let mut names = vec!["figure", "must reach"];
    names.extend(defaults.iter().map(|row| row.setup.engine.name()));
    let mut out = head(&names);
    for (index, figure) in first.figures.iter().enumerate() {
        let unit = if figure.unit.is_empty() { String::new() } else { format!(" ({})", figure.unit) };
        let limit = if figure.limit.is_finite() { short(figure.limit) } else { String::new() };
        let mut cells = vec![format!("{}{unit}", escaped(figure.figure)), limit];
        for row in &defaults {
            let figure = row.errors.as_ref().and_then(|errors| errors.figures.get(index));
            let cell = |f: &crate::bench::Figure| {
                format!("<span class=\"{}\">{}</span>", class(f.passes), short(f.value))
            };
            cells.push(figure.map_or_else(String::new, cell));
        }
        row(&mut out, "", &cells);
    }
    out + TAIL
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, short)
}

/// Every setup: its frames and its errors by class.
pub(super) fn rows(sheet: &Sheet) -> String {
    let mut out = head(&[
        "setup",
        "ms mean",
        "median",
        "p99",
        "max",
        "min",
        "x rapier",
        "error",
        "depth mm",
        "at end",
        "sink mm",
        "drift mm",
        "energy rise J",
        "momentum",
        "own limit mm",
        "Signorini m/s",
        "Coulomb",
        "dissipation",
    ]);
    for one in &sheet.rows {
        let name = format!("{} {}", one.setup.engine.name(), escaped(&one.label));
        let class = if one.is_default { "default" } else { "" };
        if let Some(reason) = &one.refused {
            let _ = writeln!(
                out,
                "<tr class=\"{class}\"><td>{name}</td><td colspan=\"17\">{}</td></tr>",
                escaped(reason)
            );
            continue;
        }
        let ms = one.ms.unwrap_or_default();
        let ratio =
            one.over_rapier.map_or_else(String::new, |r| format!("{:.2} (&lt; {:.2})", r.mean, r.upper_95));
        let mut cells = vec![name];
        cells.extend([ms.mean, ms.median, ms.p99, ms.max, ms.min].map(short));
        cells.extend([ratio, verdict(Some(one))]);
        if let Some(errors) = &one.errors {
            let lengths = [errors.depth_max_m, errors.depth_end_m, errors.sink_m, errors.drift_m];
            cells.extend(lengths.map(|length| short(length * 1e3)));
            cells.push(short(errors.energy_rise_j));
            cells.push(optional(errors.momentum_change));
            cells.push(optional(errors.own_limit_m.map(|length| length * 1e3)));
            let laws = &errors.laws;
            cells.extend([laws.signorini_m_s, laws.coulomb, laws.dissipation].map(optional));
        }
        row(&mut out, class, &cells);
    }
    out + TAIL
}

pub(super) fn machine(machine: &Machine, seconds: f64) -> String {
    let mut out = head(&["what", "here"]);
    for (name, value) in machine.lines() {
        row(&mut out, "", &[escaped(name), escaped(&value)]);
    }
    row(&mut out, "", &["clock".to_owned(), CLOCK.to_owned()]);
    row(&mut out, "", &["the whole report took".to_owned(), format!("{seconds:.0} s")]);
    out + TAIL
}

pub(super) fn parameters(parameters: &[Parameter]) -> String {
    let mut out = head(&["setting", "Physique", "rapier"]);
    for parameter in parameters {
        row(&mut out, "", &[escaped(&parameter.name), escaped(&parameter.ours), escaped(&parameter.rapier)]);
    }
    out + TAIL
}

/// A line a setup, a column a number; empty where there is none.
pub(super) fn csv(sheets: &[Sheet]) -> String {
    let mut out = "scene,bodies,duration_s,engine,dt_s,substeps,stiffness,default,ms_mean,ms_median,ms_p99,ms_max,ms_min,over_rapier,over_rapier_upper_95,\
         error,error_unit,error_value,error_limit,passes,depth_max_m,depth_end_m,sink_m,drift_m,energy_rise_j,\
         energy_change_j,momentum_change,own_limit_m,signorini_m_s,coulomb,dissipation,refused\n"
        .to_owned();
    for sheet in sheets {
        for one in &sheet.rows {
            let mut cells = vec![
                quoted(&sheet.scene),
                sheet.bodies.to_string(),
                sheet.duration_s.to_string(),
                one.setup.engine.name().to_owned(),
                one.setup.dt_s.to_string(),
                one.setup.substeps.to_string(),
                one.setup.stiffness.to_string(),
                one.is_default.to_string(),
            ];
            let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
            let ms = |of: fn(&crate::simulate::Milliseconds) -> f64| number(one.ms.as_ref().map(of));
            cells.extend([ms(|m| m.mean), ms(|m| m.median), ms(|m| m.p99), ms(|m| m.max), ms(|m| m.min)]);
            cells.extend([
                number(one.over_rapier.map(|r| r.mean)),
                number(one.over_rapier.map(|r| r.upper_95)),
            ]);
            let figure = one.errors.as_ref().and_then(|errors| errors.figures.first());
            cells.extend([
                figure.map_or_else(String::new, |f| quoted(f.figure)),
                figure.map_or("", |f| f.unit).to_owned(),
                number(figure.map(|f| f.value)),
                number(figure.map(|f| f.limit)),
                figure.map_or_else(String::new, |f| f.passes.to_string()),
            ]);
            let errors = one.errors.as_ref();
            let of = |pick: fn(&crate::bench::Errors) -> Option<f64>| number(errors.and_then(pick));
            cells.extend([
                of(|e| Some(e.depth_max_m)),
                of(|e| Some(e.depth_end_m)),
                of(|e| Some(e.sink_m)),
                of(|e| Some(e.drift_m)),
                of(|e| Some(e.energy_rise_j)),
                of(|e| Some(e.energy_change_j)),
                of(|e| e.momentum_change),
                of(|e| e.own_limit_m),
                of(|e| e.laws.signorini_m_s),
                of(|e| e.laws.coulomb),
                of(|e| e.laws.dissipation),
                one.refused.as_deref().map_or_else(String::new, quoted),
            ]);
            out += &cells.join(",");
            out.push('\n');
        }
    }
    out
}
