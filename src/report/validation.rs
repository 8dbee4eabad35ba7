//! `validation.csv`: how every drop went in both engines, a model a line.

use std::io::{self, Write};

use super::Line;
use crate::settle::{Outcome, Rest};
use crate::simulate::quoted;

const HEADER: &str = "model,verdict,remark,mass_kg,size_m,height_difference_m,side_difference_deg,\
    settled_ours,settled_rapier,settled_at_s_ours,settled_at_s_rapier,rest_height_m_ours,rest_height_m_rapier,\
    tipped_deg_ours,tipped_deg_rapier,energy_rise_share_ours,energy_rise_share_rapier,\
    max_penetration_m_ours,max_penetration_m_rapier,rest_penetration_m_ours,rest_penetration_m_rapier";

/// Writes every drop of the run. A field is empty where there is nothing to say: no comparison, no rest.
///
/// # Errors
/// `out` cannot be written.
pub fn write_validation(out: &mut dyn Write, lines: &[Line]) -> io::Result<()> {
    writeln!(out, "{HEADER}")?;
    for line in lines {
        let Some(dropped) = &line.dropped else { continue };
        let Some(ours) = dropped.outcome.bodies.first() else { continue };
        let verdict = line.comparison.as_ref().map(|comparison| &comparison.verdict);
        let rapier = line
            .comparison
            .as_ref()
            .and_then(|comparison| Some((&comparison.rapier, comparison.rapier.bodies.first()?)));
        let word = match verdict {
            None => "not compared",
            Some(verdict) if verdict.agrees => "agrees",
            Some(_) => "differs",
        };
        let mut fields = vec![
            quoted(&line.model),
            word.to_owned(),
            quoted(&remark(line)),
            number(Some(dropped.mass_kg)),
            number(Some(ours.size_m)),
            number(verdict.map(|verdict| verdict.height_difference_m)),
            number(verdict.map(|verdict| verdict.side_difference_deg)),
        ];
        let both = |fields: &mut Vec<String>, field: &dyn Fn(&Outcome, &Rest) -> String| {
            fields.push(field(&dropped.outcome, ours));
            fields.push(rapier.map(|(outcome, rest)| field(outcome, rest)).unwrap_or_default());
        };
        both(&mut fields, &|_, rest| rest.settled.to_string());
        both(&mut fields, &|_, rest| number(rest.settled_at_s));
        both(&mut fields, &|_, rest| number(Some(rest.height_m)));
        both(&mut fields, &|_, rest| number(Some(rest.tipped_deg)));
        both(&mut fields, &|outcome, _| number(outcome.energy_rise_share));
        both(&mut fields, &|_, rest| number(Some(rest.max_penetration_m)));
        both(&mut fields, &|_, rest| number(Some(rest.rest_penetration_m)));
        writeln!(out, "{}", fields.join(","))?;
    }
    Ok(())
}

/// What differs, or what was forgiven.
fn remark(line: &Line) -> String {
    match &line.comparison {
        Some(comparison) if comparison.verdict.agrees => comparison.verdict.remark.clone(),
        Some(comparison) => comparison.difference(),
        None => String::new(),
    }
}

/// Six significant digits: more than either engine is right to.
fn number(value: Option<f64>) -> String {
    value.map(|value| format!("{value:.5e}")).unwrap_or_default()
}
