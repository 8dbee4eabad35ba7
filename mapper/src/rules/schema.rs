//! JSON Schemas, so that editors complete and check what people write.
//!
//! Names that a file may add to (presets, categories) are offered, not enforced: the mapper's own errors are
//! better than an editor's.

use serde_json::{Map, Value, json};

use crate::attribute::ATTRIBUTES;
use crate::rules::ruleset::Ruleset;
use crate::text::units::Dimension;

/// Of `catalog.yaml`.
#[must_use]
pub fn catalogue(rules: &Ruleset) -> String {
    let figures = figures();
    let names: Vec<&str> = ATTRIBUTES.iter().map(|spec| spec.name).collect();
    let kind_spec = object(
        json!({ "preset": names_of("preset"), "attributes": { "type": "array", "items": { "enum": names } }, "note": text() }),
        &["preset", "attributes"],
    );
    let mut preset = figures.clone();
    preset.extend(map(json!({ "kind": kind(), "aliases": words(), "note": text() })));
    let mut shared = settings();
    for name in ["mass", "category", "subcategory"] {
        shared.remove(name);
    }
    shared.extend(map(json!({
        "aliases": words(),
        "group": text(),
        "note": text(),
        "size": range(Dimension::Length, "Longest extent of real ones."),
        "mass": range(Dimension::Mass, "Mass of real ones."),
    })));
    let mut subcategory = shared.clone();
    subcategory.insert(
        "synset".to_owned(),
        json!({ "type": "string", "pattern": "^.+\\.[nvasr]\\.[0-9]{2}$", "description": "WordNet 3.0" }),
    );
    let mut category = shared;
    category.insert(
        "subcategories".to_owned(),
        json!({ "type": "object", "additionalProperties": closed(subcategory, &[]) }),
    );
    let pair = json!({
        "between": { "type": "array", "items": names_of("preset"), "minItems": 2, "maxItems": 2 },
        "friction_static": pure(0.0, 3.0),
        "friction_dynamic": pure(0.0, 3.0),
        "restitution": pure(0.0, 1.0),
        "source": names_of("source"),
        "note": text(),
    });
    let condition = json!({ "$ref": "#/$defs/condition" });
    let rule = object(
        json!({ "name": text(), "when": condition, "set": closed(settings(), &[]), "confidence": pure(0.0, 1.0), "note": text() }),
        &["name", "when", "set"],
    );
    let words_section = object(
        json!({ "noise": words(), "brands": words(), "colours": words(), "qualities": words(), "vague": words(), "general": words() }),
        &[],
    );
    let top = json!({
        "version": { "const": 1 },
        "sources": { "type": "object", "additionalProperties": text() },
        "words": words_section,
        "defaults": closed(figures, &[]),
        "kinds": object(json!({ "rigid": kind_spec, "soft": kind_spec, "fluid": kind_spec }), &["rigid", "soft", "fluid"]),
        "presets": { "type": "object", "additionalProperties": closed(preset, &["kind"]) },
        "pairs": { "type": "array", "items": object(pair, &["between"]) },
        "categories": { "type": "object", "additionalProperties": closed(category, &[]) },
        "rules": { "type": "array", "items": rule },
    });
    let schema = map(object(top, &["version", "kinds", "presets", "categories"]));
    let condition = map(json!({ "condition": condition_schema() }));
    document(rules, "Physique catalogue", schema, condition)
}

/// Of a project override file.
#[must_use]
pub fn overrides(rules: &Ruleset) -> String {
    let part = json!({ "type": "object", "additionalProperties": closed(settings(), &[]) });
    let entry = object(
        json!({ "match": words(), "set": closed(settings(), &[]), "parts": part, "confidence": pure(0.0, 1.0), "note": text() }),
        &["match"],
    );
    let top = json!({
        "version": { "const": 1 },
        "proposed_by": text(),
        "overrides": { "type": "array", "items": entry },
    });
    document(rules, "Physique overrides", map(object(top, &["overrides"])), Map::new())
}

/// Of `NAME.physics.yaml` beside a model.
#[must_use]
pub fn sidecar(rules: &Ruleset) -> String {
    let mut top = settings();
    top.extend(map(json!({
        "version": { "const": 1 },
        "title": text(),
        "tags": words(),
        "note": text(),
        "parts": { "type": "object", "additionalProperties": closed(settings(), &[]) },
    })));
    document(rules, "Physique sidecar", map(closed(top, &[])), Map::new())
}

/// Of `SCENE.yaml`.
#[must_use]
pub fn scene(rules: &Ruleset) -> String {
    let vector = json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
    let rotation = json!({ "anyOf": [
        { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 },
        object(json!({ "axis": vector, "angle": quantity(Dimension::Angle, "") }), &["axis", "angle"]),
    ]});
    let material = json!({ "anyOf": [
        names_of("preset"),
        object(json!({
            "preset": names_of("preset"),
            "friction": pure(0.0, 10.0),
            "restitution": pure(0.0, 1.0),
            "rolling_resistance": pure(0.0, 1.0),
            "density": quantity(Dimension::Density, ""),
        }), &[]),
    ]});
    let length = quantity(Dimension::Length, "");
    let child = map(json!({
        "shape": { "enum": ["sphere", "box", "capsule", "cylinder", "cone", "hull", "mesh", "height-field", "half-space"] },
        "size": { "type": "array", "items": length, "minItems": 3, "maxItems": 3 },
        "radius": length,
        "height": length,
        "points": { "type": "array", "items": vector },
        "positions": { "type": "array", "items": vector },
        "triangles": { "type": "array", "items": { "type": "array", "items": { "type": "integer", "minimum": 0 } } },
        "heights": { "type": "array", "items": { "type": "array", "items": { "type": "number" } } },
        "spacing": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
        "material": material,
        "position": vector,
        "rotation": rotation,
        "mass": quantity(Dimension::Mass, ""),
    }));
    let mut entity = child.clone();
    entity.extend(map(json!({
        "name": text(),
        "model": text(),
        "children": { "type": "array", "items": closed(child, &["shape", "material"]) },
        "velocity": vector,
        "angular_velocity": vector,
        "static": { "type": "boolean" },
    })));
    let action = object(
        json!({
            "at": quantity(Dimension::Time, ""),
            "entity": text(),
            "set_pose": object(json!({ "position": vector, "rotation": rotation }), &[]),
            "set_velocity": object(json!({ "linear": vector, "angular": vector }), &[]),
        }),
        &["at", "entity"],
    );
    let top = json!({
        "name": text(),
        "gravity": vector,
        "dt": quantity(Dimension::Time, "Length of a step."),
        "duration": quantity(Dimension::Time, ""),
        "floor": { "anyOf": [{ "const": false }, material] },
        "entities": { "type": "array", "items": closed(entity, &[]) },
        "actions": { "type": "array", "items": action },
    });
    document(rules, "Physique scene", map(object(top, &["entities"])), Map::new())
}

fn document(rules: &Ruleset, title: &str, schema: Map<String, Value>, more: Map<String, Value>) -> String {
    let mut top = map(json!({ "$schema": "https://json-schema.org/draft/2020-12/schema", "title": title }));
    top.extend(schema);
    let mut defs = definitions(rules);
    defs.extend(more);
    top.insert("$defs".to_owned(), Value::Object(defs));
    let mut text = serde_json::to_string_pretty(&Value::Object(top)).unwrap_or_default();
    text.push('\n');
    text
}

fn map(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

fn object(properties: Value, required: &[&str]) -> Value {
    closed(map(properties), required)
}

fn closed(properties: Map<String, Value>, required: &[&str]) -> Value {
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn text() -> Value {
    json!({ "type": "string" })
}

fn words() -> Value {
    json!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": ["string", "number"] } }] })
}

fn kind() -> Value {
    json!({ "enum": ["rigid", "soft", "fluid"] })
}

fn pure(min: f64, max: f64) -> Value {
    json!({ "type": "number", "minimum": min, "maximum": max })
}

/// A number and one of the dimension's units.
fn quantity(dimension: Dimension, description: &str) -> Value {
    if dimension == Dimension::Pure {
        return json!({ "type": "number" });
    }
    let units: Vec<String> = dimension.units().map(|unit| unit.replace('.', "\\.")).collect();
    let pattern = format!("^[-+]?[0-9]*\\.?[0-9]+([eE][-+]?[0-9]+)? ?({})$", units.join("|"));
    let mut made = map(json!({ "type": "string", "pattern": pattern }));
    let example = format!("1 {}", dimension.si_unit());
    made.insert("examples".to_owned(), json!([example]));
    if !description.is_empty() {
        made.insert("description".to_owned(), json!(description));
    }
    Value::Object(made)
}

fn range(dimension: Dimension, description: &str) -> Value {
    let item = quantity(dimension, "");
    json!({ "type": "array", "items": item, "minItems": 2, "maxItems": 2, "description": description })
}

/// Known names, written once: see [`definitions`].
fn names_of(what: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{what}") })
}

/// What the rest of a schema refers to.
fn definitions(rules: &Ruleset) -> Map<String, Value> {
    let mut all = Map::new();
    for what in ["preset", "category", "source"] {
        all.insert(what.to_owned(), known_names(rules, what));
    }
    all
}

/// Known names first, any other allowed.
fn known_names(rules: &Ruleset, what: &str) -> Value {
    let mut names: Vec<&str> = match what {
        "preset" => rules.presets.iter().map(|preset| &*preset.name).collect(),
        "category" => rules.categories.iter().map(|category| &*category.name).collect(),
        "source" => rules.sources.keys().map(|key| &**key).collect(),
        _ => Vec::new(),
    };
    names.sort_unstable();
    json!({ "anyOf": [{ "enum": names }, { "type": "string" }] })
}

fn figures() -> Map<String, Value> {
    let mut figures = Map::new();
    for spec in &ATTRIBUTES {
        let bare = match spec.dimension {
            Dimension::Pure => pure(spec.min, spec.max),
            dimension => quantity(dimension, ""),
        };
        let sourced = object(json!({ "value": bare, "source": source(), "note": text() }), &["value"]);
        figures.insert(spec.name.to_owned(), json!({ "anyOf": [bare, sourced] }));
    }
    figures
}

fn source() -> Value {
    let one = names_of("source");
    json!({ "anyOf": [one, { "type": "array", "items": { "type": "string" } }] })
}

fn settings() -> Map<String, Value> {
    let mut all = figures();
    let mass_model = json!({ "anyOf": [
        { "const": "solid" },
        object(json!({ "shell": quantity(Dimension::Length, "Thickness of the wall."), "range": range(Dimension::Length, "") }), &["shell"]),
        object(json!({ "fill": pure(0.0, 1.0), "range": { "type": "array", "items": pure(0.0, 1.0) } }), &["fill"]),
        object(json!({ "fixed": quantity(Dimension::Mass, ""), "range": range(Dimension::Mass, "") }), &["fixed"]),
    ]});
    all.extend(map(json!({
        "category": names_of("category"),
        "subcategory": text(),
        "kind": kind(),
        "preset": names_of("preset"),
        "mass_model": mass_model,
        "anchored": { "type": "boolean" },
        "contents": object(json!({ "preset": names_of("preset"), "fill": pure(0.0, 1.0) }), &["preset", "fill"]),
        "collider_tolerance": quantity(Dimension::Length, "Error that its collider may have; 2 % of the diagonal where nobody says."),
        "unit": { "anyOf": [{ "enum": ["m", "cm", "mm", "in", "ft"] }, quantity(Dimension::Length, "What one file unit is worth.")] },
    })));
    all
}

fn condition_schema() -> Value {
    let this = json!({ "$ref": "#/$defs/condition" });
    let several = json!({ "type": "array", "items": this });
    let presets = names_of("preset");
    object(
        json!({
            "all": several,
            "any": several,
            "not": this,
            "path": words(),
            "word": words(),
            "alias": words(),
            "material": { "anyOf": [presets, { "type": "array", "items": presets }] },
            "size": range(Dimension::Length, "Longest extent in the unit that the file states."),
            "aspect": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
            "closed": { "type": "boolean" },
            "bodies": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
            "hull_ratio": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
            "extension": words(),
        }),
        &[],
    )
}
