//! One fault put into a clean world, and where it has to be found.

use importer::Asset;
use serde_json::Value;

use crate::world::{Rng, World};

/// A kind of fault.
#[derive(Clone, Copy)]
pub(crate) struct Mutation {
    pub name: &'static str,
    pub code: &'static str,
    /// The model that it must be found at; empty where it belongs to none.
    pub model: &'static str,
    /// File and words of the line that it must point at.
    pub at: Option<(&'static str, &'static str)>,
    pub flags: &'static [&'static str],
    pub change: fn(&mut World, &mut Rng),
    pub tamper: Option<Tamper>,
}

/// A change of the catalogue of models itself: what no file can bring about on purpose.
#[derive(Clone, Copy)]
pub(crate) enum Tamper {
    Asset(fn(&mut Asset)),
    Proof(fn(&mut Value)),
}

pub(crate) const fn fault(
    name: &'static str,
    code: &'static str,
    change: fn(&mut World, &mut Rng),
) -> Mutation {
    Mutation { name, code, model: "", at: None, flags: &[], change, tamper: None }
}

/// A change of what was measured of a model.
pub(crate) const fn asset(name: &'static str, code: &'static str, change: fn(&mut Asset)) -> Mutation {
    Mutation { tamper: Some(Tamper::Asset(change)), ..fault(name, code, |_, _| {}) }
}

/// A change of how a model's trials went.
pub(crate) const fn proof(name: &'static str, code: &'static str, change: fn(&mut Value)) -> Mutation {
    Mutation { tamper: Some(Tamper::Proof(change)), ..fault(name, code, |_, _| {}) }
}

impl Mutation {
    pub(crate) const fn of(self, model: &'static str) -> Self {
        Self { model, ..self }
    }

    pub(crate) const fn at(self, file: &'static str, words: &'static str) -> Self {
        Self { at: Some((file, words)), ..self }
    }

    pub(crate) const fn with(self, flags: &'static [&'static str]) -> Self {
        Self { flags, ..self }
    }
}
