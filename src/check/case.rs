//! A model on its way through the layers.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Result;
use importer::{Catalogue, ModelRow};
use mapper::Kind;
use rayon::prelude::*;

use super::entry::{Entry, Locked};
use super::observe;
use super::policy::Subject;
use crate::pipeline;
use crate::report::Line;

/// What is known of it before anybody looks.
pub(super) struct Case {
    pub row: ModelRow,
    pub line: Line,
    /// Its file, as seen from here.
    pub file: PathBuf,
    /// Subcategory and preset; the category is in the line.
    pub subcategory: String,
    pub preset: String,
    pub entry: Option<Entry>,
}

/// Of all models, in their order.
pub(super) fn cases(catalogue: &Catalogue, lines: Vec<(ModelRow, Line)>) -> Result<Vec<Case>> {
    let here = std::env::current_dir().unwrap_or_default();
    lines
        .into_par_iter()
        .map(|(row, line)| {
            let path = row.path();
            let file = path.strip_prefix(&here).map_or_else(|_| path.clone(), Path::to_path_buf);
            let mapped: Option<Locked> = line
                .standing
                .as_ref()
                .map(|_| pipeline::mapped_part(catalogue, &row.model))
                .transpose()?
                .flatten();
            let entry = row.key.zip(mapped.as_ref()).map(|(key, mapped)| Entry::new(&key, mapped));
            let category = entry.as_ref().map_or("", |entry| entry.category.as_str());
            let subcategory = category.split_once('/').map_or("", |(_, sub)| sub).to_owned();
            let preset = entry.as_ref().map_or_else(String::new, |entry| entry.preset.clone());
            Ok(Case { row, line, file, subcategory, preset, entry })
        })
        .collect()
}

/// Their lines of a lock.
pub(super) fn entries(cases: &[Case]) -> BTreeMap<String, Entry> {
    cases.iter().filter_map(|case| Some((case.row.model.clone(), case.entry.clone()?))).collect()
}

impl Case {
    pub fn category(&self) -> &str {
        self.line.standing.as_ref().and_then(|standing| standing.category.as_deref()).unwrap_or_default()
    }

    pub fn standing(&self) -> observe::Standing<'_> {
        observe::Standing {
            model: &self.row.model,
            asset: self.row.key,
            mapped: self.line.standing.as_ref().map(|_| [self.category(), &self.subcategory, &self.preset]),
        }
    }

    /// What it is to a policy.
    pub fn subject(&self) -> Subject<'_> {
        Subject { model: &self.row.model, category: self.category(), subcategory: &self.subcategory }
    }

    /// Why it is not simulated; `None` where it is.
    pub fn left_out(&self) -> Option<&'static str> {
        match &self.line.standing {
            None => Some("not mapped"),
            Some(standing) if standing.kind == Kind::Soft => Some("soft"),
            Some(standing) if standing.kind == Kind::Fluid => Some("fluid"),
            Some(standing) if standing.anchored => Some("fixed in place"),
            Some(_) => None,
        }
    }
}
