//! Which category wins, and why the others lost.

use std::sync::Arc;

use crate::attribute::{Layer, Provenance};
use crate::mapped::Trace;
use crate::names::evidence::{Evidence, THRESHOLD, category_of};
use crate::names::lexicon::Target;
use crate::rules::rule::Rule;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{CategoryId, Setting, SubcategoryId, What};

/// Traces kept: what lost by far explains nothing.
const KEPT: usize = 8;

/// The category of a model.
#[derive(Clone, Debug, Default)]
pub(crate) struct Decision {
    pub category: Option<CategoryId>,
    pub subcategory: Option<SubcategoryId>,
    pub confidence: f64,
    /// Every claim, the winner first.
    pub trace: Vec<Trace>,
}

struct Claim {
    target: Target,
    confidence: f64,
    layer: Layer,
    /// Predicates of a rule, letters of an alias.
    specificity: usize,
    by: Provenance,
    because: String,
}

/// Order among claims: what people wrote for this model, else the surer, else a rule before an alias, else the
/// more specific, else the first in the file.
#[must_use]
pub(crate) fn decide(
    rules: &Ruleset,
    evidence: &Evidence,
    matched: &[&Rule],
    above: &[(&Setting, f64)],
) -> Decision {
    let mut claims: Vec<Claim> = Vec::with_capacity(evidence.candidates.len() + 2);
    for (setting, confidence) in above {
        let Some(target) = target_of(&setting.what) else { continue };
        let by = setting.by.clone();
        let because = format!("set by {}", by.by);
        let confidence = *confidence;
        claims.push(Claim { target, confidence, layer: by.layer, specificity: 0, by, because });
    }
    // Of two people the later layer is right.
    claims.reverse();
    for rule in matched {
        for setting in &rule.set {
            let Some(target) = target_of(&setting.what) else { continue };
            claims.push(Claim {
                target,
                confidence: rule.confidence,
                layer: Layer::Rule,
                specificity: rule.specificity as usize,
                by: setting.by.clone(),
                because: format!("rule `{}` holds", rule.name),
            });
        }
    }
    claims.extend(evidence.candidates.iter().map(|candidate| Claim {
        target: candidate.target,
        confidence: candidate.confidence,
        layer: Layer::Subcategory,
        specificity: candidate.letters,
        by: candidate.by.clone(),
        because: candidate.because.clone(),
    }));
    claims.sort_by(|a, b| {
        let rank = |claim: &Claim| if claim.layer > Layer::Rule { claim.layer as u8 } else { 0 };
        rank(b)
            .cmp(&rank(a))
            .then(b.confidence.total_cmp(&a.confidence))
            .then(b.layer.cmp(&a.layer))
            .then(b.specificity.cmp(&a.specificity))
    });
    refine(rules, &mut claims);
    let won = claims.first().filter(|first| first.confidence >= THRESHOLD);
    let mut decision = Decision::default();
    if let Some(winner) = won {
        decision.category = Some(category_of(rules, winner.target));
        decision.subcategory = match winner.target {
            Target::Subcategory(id) => Some(id),
            Target::Category(_) => None,
        };
        decision.confidence = winner.confidence;
    }
    let best = won.map(|winner| (winner.confidence, winner.layer));
    decision.trace = claims
        .into_iter()
        .take(KEPT)
        .enumerate()
        .map(|(index, claim)| trace(rules, claim, index == 0 && best.is_some(), best))
        .collect();
    decision
}

fn target_of(what: &What) -> Option<Target> {
    match what {
        What::Category(id) => Some(Target::Category(*id)),
        What::Subcategory(id) => Some(Target::Subcategory(*id)),
        _ => None,
    }
}

/// A category alone, won, gives way to the best of its own subcategories that anything spoke for.
fn refine(rules: &Ruleset, claims: &mut Vec<Claim>) {
    let Some(Claim { target: Target::Category(category), confidence, layer, .. }) = claims.first() else {
        return;
    };
    let (category, confidence, layer) = (*category, *confidence, *layer);
    let finer = claims.iter().position(|claim| {
        matches!(claim.target, Target::Subcategory(_))
            && category_of(rules, claim.target) == category
            && claim.confidence >= THRESHOLD * 0.6
    });
    if let Some(at) = finer {
        let mut claim = claims.remove(at);
        claim.confidence = claim.confidence.max(confidence);
        claim.layer = claim.layer.max(layer);
        claims.insert(0, claim);
    }
}

fn trace(rules: &Ruleset, claim: Claim, won: bool, best: Option<(f64, Layer)>) -> Trace {
    let lost_because = match best {
        _ if won => String::new(),
        None => format!("{:.2} is below the threshold of {THRESHOLD:.2}", claim.confidence),
        Some((_, layer)) if layer > claim.layer && layer > Layer::Rule => format!("beaten by the {layer}"),
        Some((confidence, _)) if claim.confidence < confidence => {
            format!("less sure: {:.2} against {confidence:.2}", claim.confidence)
        }
        Some(_) => "as sure, but less specific or later in the file".to_owned(),
    };
    let subcategory: Option<Arc<str>> = match claim.target {
        Target::Subcategory(id) => Some(Arc::clone(&rules.subcategories[id].name)),
        Target::Category(_) => None,
    };
    let because = match claim.target {
        Target::Subcategory(_) => claim.because,
        Target::Category(id) => format!("{} (category {})", claim.because, rules.categories[id].name),
    };
    Trace { by: claim.by, because, subcategory, confidence: claim.confidence, won, lost_because }
}
