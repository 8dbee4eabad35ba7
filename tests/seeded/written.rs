//! Faults in what people write: rules, overrides, sidecars, configuration, lock and baseline.

use crate::mutation::{Mutation, fault};
use crate::world::{World, cuboid, glb};

const CATALOG: &str = "catalog.yaml";
const OVERRIDES: &str = "models/overrides.yaml";
const SIDECAR: &str = "models/storage/crate_b.physics.yaml";
const LOCK: &str = "physique.lock";
const BASELINE: &str = "baseline.txt";
const CRATE: &str = "storage/crate_a.glb";
const CRATE_B: &str = "storage/crate_b.glb";
const BRICK: &str = "storage/brick_a.glb";
const ANVIL: &str = "tools/anvil.glb";

pub(crate) const MUTATIONS: &[Mutation] = &[
    fault("a tab for blanks in the rules", "MAP001", |w, _| w.edit(CATALOG, "  steel:\n    kind", "  steel:\n\tkind"))
        .at(CATALOG, "\tkind"),
    fault("an open bracket in the overrides", "MAP001", |w, _| w.edit(OVERRIDES, "{ friction_dynamic", "{ [friction_dynamic")),
    fault("an alias of YAML", "MAP001", |w, _| w.edit(CATALOG, "preset: foam\n", "preset: *foam\n")).at(CATALOG, "*foam"),
    fault("rules that are not there", "MAP002", |w, _| drop(w.files.remove(CATALOG))),
    fault("a misspelt key of a preset", "MAP003", |w, _| w.edit(CATALOG, "    restitution:", "    restitutoin:"))
        .at(CATALOG, "restitutoin"),
    fault("a misspelt key of an override", "MAP003", |w, _| w.edit(OVERRIDES, "    set:", "    sets:")).at(OVERRIDES, "sets:"),
    fault("a misspelt key of a sidecar", "MAP003", |w, _| w.edit(SIDECAR, "mass:", "mas:")).of(CRATE_B).at(SIDECAR, "mas:"),
    fault("a list for a map", "MAP004", |w, _| w.edit(CATALOG, "        mass_model: solid\n", "        mass_model: [solid]\n"))
        .at(CATALOG, "[solid]"),
    fault("a word for a flag", "MAP004", |w, _| w.edit(CATALOG, "anchored: true", "anchored: maybe")).at(CATALOG, "maybe"),
    fault("a preset that nobody defined", "MAP005", |w, _| w.edit(CATALOG, "preset: ceramic\n", "preset: ceramics\n"))
        .at(CATALOG, "ceramics"),
    fault("a category that nobody defined", "MAP005", |w, _| w.edit(OVERRIDES, "set: {", "set: { category: tool,"))
        .at(OVERRIDES, "category: tool,"),
    fault("a source that nobody listed", "MAP005", |w, _| w.edit(CATALOG, "kPa, source: handbook", "kPa, source: hearsay"))
        .at(CATALOG, "hearsay"),
    fault("two rules of one name", "MAP006", |w, _| rule(w, "metal-crate  # again", "{ word: metal }", "{ preset: steel }"))
        .at(CATALOG, "# again"),
    fault("a key twice", "MAP006", |w, _| w.edit(CATALOG, "        preset: foam\n", "        preset: foam\n        preset: oak\n")),
    fault("a rule without a condition", "MAP007", |w, _| {
        w.edit(CATALOG, "    when: { path: '**/metal/**', word: crate }\n", "");
    })
    .at(CATALOG, "- name: metal-crate"),
    fault("an override without a glob", "MAP007", |w, _| w.edit(OVERRIDES, "  - match: 'tools/*.glb'\n    set", "  - set"))
        .at(OVERRIDES, "- set"),
    fault("one alias for two things", "MAP008", |w, _| {
        w.edit(CATALOG, "        size: [20 cm, 70 cm]\n", "        aliases: [crate]\n        size: [20 cm, 70 cm]\n");
    })
    .at(CATALOG, "aliases: [crate]"),
    fault("a rule that cannot hold", "MAP009", |w, _| {
        rule(w, "neither", "{ all: [{ size: [1 m, 2 m] }, { size: [3 m, 4 m] }] }", "{ preset: steel }");
    })
    .at(CATALOG, "- name: neither"),
    fault("a rule in the shadow of another", "MAP010", |w, _| {
        rule(w, "later", "{ path: '**/metal/**', word: crate }", "{ preset: ceramic }");
    })
    .at(CATALOG, "- name: metal-crate"),
    fault("a rule that doubts itself", "MAP011", |w, _| {
        rule(w, "doubtful", "{ word: box }", "{ subcategory: crate }\n    confidence: 0.3");
    })
    .at(CATALOG, "- name: doubtful"),
    fault("a subcategory of no material", "MAP012", |w, _| w.edit(CATALOG, "        preset: ceramic\n", ""))
        .at(CATALOG, "brick:"),
    fault("a category of nothing", "MAP013", |w, _| w.edit(CATALOG, "  garden:\n", "  empty: {}\n  garden:\n")).at(CATALOG, "empty:"),
    fault("a pair twice", "MAP014", |w, _| {
        w.edit(CATALOG, "categories:\n", "  - { between: [oak, steel], friction_static: 0.6, friction_dynamic: 0.44, source: tables }\ncategories:\n");
    })
    .at(CATALOG, "[oak, steel]"),
    fault("an override of what has been renamed", "MAP015", |w, _| {
        w.edit(OVERRIDES, "overrides:\n", "overrides:\n  - match: 'tool/*.glb'\n    set: { restitution: 0.2 }\n");
    })
    .at(OVERRIDES, "'tool/*.glb'"),
    fault("a value set twice for one glob", "MAP016", |w, _| {
        let text = w.text(OVERRIDES) + "  - match: 'tools/*.glb'\n    set: { friction_dynamic: 0.42 }\n";
        w.put(OVERRIDES, &text);
    })
    .at(OVERRIDES, "set: { friction_dynamic"),
    fault("a rule that sets nothing", "MAP017", |w, _| rule(w, "idle", "{ word: idle }", "{}")).at(CATALOG, "- name: idle"),
    fault("a preset that nothing names", "MAP018", |w, _| {
        w.edit(CATALOG, "  foam:\n", "  jelly:\n    kind: soft\n    density: { value: 990 kg/m3, source: handbook }\n    youngs_modulus: { value: 5 kPa, source: handbook }\n    poisson_ratio: { value: 0.4, source: handbook }\n  foam:\n");
    })
    .at(CATALOG, "jelly:"),
    fault("a source that nothing cites", "MAP019", |w, _| w.edit(CATALOG, "  tables:", "  folklore: What people say\n  tables:"))
        .at(CATALOG, "folklore"),
    fault("a name that says nothing", "MAP020", |w, _| w.put_box("misc/q17.glb", [0.2, 0.1, 0.2])).of("misc/q17.glb"),
    fault("a category by a thread", "MAP021", |w, _| {
        rule(w, "guess", "{ path: 'misc/**' }", "{ subcategory: crate }\n    confidence: 0.55");
        w.put_box("misc/q17.glb", [0.2, 0.16, 0.2]);
    })
    .of("misc/q17.glb")
    .at(CATALOG, "{ subcategory: crate }"),
    fault("many names that say nothing", "MAP022", |w, _| {
        (0..4).for_each(|index| w.put_box(&format!("misc/q{index}.glb"), [0.2, 0.1, 0.2 + 0.01 * f64::from(index)]));
    }),
    fault("a suppression of nothing", "MAP023", |w, _| {
        let text = w.text("physique.yaml") + "suppress:\n  - { code: MAS002, match: 'tools/**', reason: it was once }\n";
        w.put("physique.yaml", &text);
    })
    .at("physique.yaml", "MAS002"),
    fault("a comment that suppresses nothing", "MAP023", |w, _| {
        w.edit(CATALOG, "        preset: foam\n", "        preset: foam  # physique: allow ATT003: sticky\n");
    })
    .at(CATALOG, "allow ATT003"),
    fault("a suppression without a reason", "MAP024", |w, _| {
        w.edit(CATALOG, "        preset: foam\n", "        preset: foam  # physique: allow ATT003\n");
    })
    .at(CATALOG, "allow ATT003"),
    fault("one file under two names", "MAP025", |w, _| {
        let bytes = w.files[&format!("models/{CRATE}")].clone();
        w.put_model("tools/anvil_2.glb", bytes);
    })
    .of("tools/anvil_2.glb"),
    fault("a restitution that gains energy", "ATT001", |w, _| number(w, "steel", "restitution", "1.4")).at(CATALOG, "{ value: 1.4,"),
    fault("a density of nothing on earth", "ATT001", |w, _| w.edit(OVERRIDES, "set: {", "set: { density: 99999 kg/m3,"))
        .at(OVERRIDES, "99999"),
    fault("ranges the wrong way round", "ATT001", |w, _| w.edit(CATALOG, "[20 cm, 70 cm]", "[70 cm, 20 cm]"))
        .at(CATALOG, "[70 cm, 20 cm]"),
    fault("a density without its unit", "ATT002", |w, _| w.edit(CATALOG, "998 kg/m3", "998")).at(CATALOG, "value: 998"),
    fault("a density in metres", "ATT002", |w, _| w.edit(CATALOG, "998 kg/m3", "998 m")).at(CATALOG, "998 m"),
    fault("a mass without its unit", "ATT002", |w, _| w.put(SIDECAR, "mass: 9\n")).of(CRATE_B).at(SIDECAR, "mass: 9"),
    fault("a preset easier to start than to keep moving", "ATT003", |w, _| number(w, "steel", "friction_static", "0.2"))
        .at(CATALOG, "value: 0.2, source: tables"),
    fault("an override easier to start than to keep moving", "ATT003", |w, _| {
        w.edit(OVERRIDES, "set: {", "set: { friction_static: 0.21,");
    })
    .of(ANVIL)
    .at(OVERRIDES, "0.21"),
    fault("a preset that lacks a value", "ATT004", |w, _| {
        w.edit(CATALOG, "    poisson_ratio: { value: 0.2, source: handbook }\n", "");
    })
    .at(CATALOG, "foam:"),
    fault("a preset without a density", "ATT005", |w, _| w.edit(CATALOG, "    density: { value: 998 kg/m3, source: handbook }\n", ""))
        .at(CATALOG, "        preset: water"),
    fault("a viscosity of wood", "ATT006", |w, _| w.put(SIDECAR, "parts:\n  '0': { dynamic_viscosity: 1 Pa.s }\n"))
        .of(CRATE_B)
        .at(SIDECAR, "dynamic_viscosity"),
    fault("a value that nobody chose", "ATT007", |w, _| {
        let line = line_of(w, "oak", "restitution");
        w.edit(CATALOG, &line, "");
    })
    .of(CRATE)
    .at(CATALOG, "  restitution: { value: 0.3"),
    fault("a pair easier to start than to keep moving", "ATT008", |w, _| {
        w.edit(CATALOG, "[steel, oak], friction_static: 0.6", "[steel, oak], friction_static: 0.3");
    })
    .at(CATALOG, "friction_static: 0.3"),
    fault("a preset that bounces for ever", "ATT009", |w, _| number(w, "steel", "restitution", "0.99")).at(CATALOG, "{ value: 0.99,"),
    fault("a preset that grips like glue", "ATT010", |w, _| number(w, "steel", "friction_static", "2.5")).at(CATALOG, "{ value: 2.5,"),
    fault("a preset that slides off a table", "ATT011", |w, _| number(w, "steel", "friction_dynamic", "0.005"))
        .at(CATALOG, "{ value: 0.005,"),
    fault("a figure from nowhere", "ATT012", |w, _| {
        w.edit(CATALOG, "youngs_modulus: { value: 50 kPa, source: handbook }", "youngs_modulus: 50 kPa");
    })
    .at(CATALOG, "youngs_modulus: 50 kPa"),
    fault("a mass model outside its own range", "MAS012", |w, _| {
        w.edit(CATALOG, "mass_model: { fill: 0.2 }", "mass_model: { fixed: 90 kg }");
    })
    .at(CATALOG, "fixed: 90 kg"),
    fault("a lock that is not there", "LCK001", |w, _| drop(w.files.remove(LOCK))).with(&["--locked"]),
    fault("a lock that a merge has left open", "LCK002", |w, _| {
        let text = w.text(LOCK) + "=======\n";
        w.put(LOCK, &text);
    })
    .with(&["--locked"])
    .at(LOCK, "======="),
    fault("a lock out of order", "LCK002", |w, _| {
        let line = lock_line(w, "garden/pillar.glb");
        w.edit(LOCK, &line, "");
        let text = w.text(LOCK) + &line;
        w.put(LOCK, &text);
    })
    .with(&["--locked"])
    .at(LOCK, "garden/pillar.glb"),
    fault("a lock with a model twice", "LCK002", |w, _| {
        let line = lock_line(w, ANVIL);
        w.edit(LOCK, &line, &line.repeat(2));
    })
    .with(&["--locked"]),
    fault("a model that came in unseen", "LCK003", |w, _| w.put_box("storage/crate_new.glb", [0.2, 0.16, 0.2]))
        .of("storage/crate_new.glb")
        .with(&["--locked"]),
    fault("a model that has gone", "LCK004", |w, _| drop(w.files.remove(&format!("models/{BRICK}"))))
        .of(BRICK)
        .at(LOCK, BRICK)
        .with(&["--locked"]),
    fault("a model with other bytes", "LCK005", |w, _| {
        let half = w.boxes[CRATE];
        w.put_model(CRATE, glb(cuboid(half.map(|side| side * 1.01))));
    })
    .of(CRATE)
    .at(LOCK, CRATE)
    .with(&["--locked"]),
    fault("a model that has become another thing", "LCK006", |w, _| w.edit(SIDECAR, "mass:", "subcategory: brick\nmass:"))
        .of(CRATE_B)
        .at(LOCK, CRATE_B)
        .with(&["--locked"]),
    fault("a model of another material", "LCK007", |w, _| w.edit(OVERRIDES, "set: {", "set: { preset: oak,"))
        .of(ANVIL)
        .at(LOCK, ANVIL)
        .with(&["--locked"]),
    fault("a model of other values", "LCK008", |w, _| number(w, "ceramic", "density", "1999 kg/m3"))
        .of(BRICK)
        .at(LOCK, BRICK)
        .with(&["--locked"]),
    fault("a model that another rule decides", "LCK009", |w, _| {
        let line = lock_line(w, BRICK);
        let mut fields: Vec<&str> = line.split('\t').collect();
        fields[2] = "rule:gone";
        let changed = fields.join("\t");
        w.edit(LOCK, &line, &changed);
    })
    .of(BRICK)
    .at(LOCK, BRICK)
    .with(&["--locked"]),
    fault("a lock by another version", "LCK010", |w, _| w.edit(LOCK, "# tool ", "# tool 0.0.")).at(LOCK, "# tool").with(&["--locked"]),
    fault("a baseline that has aged", "LCK011", |w, _| {
        w.put(BASELINE, "# physique baseline 1\n0123456789abcdef MAS002 tools/anvil.glb\n");
    })
    .at(BASELINE, "anvil")
    .with(&["--baseline", BASELINE]),
    fault("a baseline of something else", "LCK012", |w, _| w.put(BASELINE, "{}\n")).at(BASELINE, "{}").with(&["--baseline", BASELINE]),
];

/// Adds a rule.
fn rule(world: &mut World, name: &str, when: &str, set: &str) {
    let text = format!("{}  - name: {name}\n    when: {when}\n    set: {set}\n", world.text(CATALOG));
    world.put(CATALOG, &text);
}

/// The line of an attribute of a preset.
fn line_of(world: &World, preset: &str, attribute: &str) -> String {
    let text = world.text(CATALOG);
    let from = text.find(&format!("  {preset}:\n")).expect("a preset");
    let at = from + text[from..].find(&format!("    {attribute}:")).expect("an attribute");
    let end = at + text[at..].find('\n').expect("a line") + 1;
    text[at..end].to_owned()
}

/// Gives an attribute of a preset another value; the line is made to differ from those of other presets.
fn number(world: &mut World, preset: &str, attribute: &str, value: &str) {
    let text = world.text(CATALOG);
    let from = text.find(&format!("  {preset}:\n")).expect("a preset");
    let at = from + text[from..].find(&format!("    {attribute}:")).expect("an attribute");
    let end = at + text[at..].find('\n').expect("a line");
    let source = if attribute == "density" { "handbook" } else { "tables" };
    let line = format!("    {attribute}: {{ value: {value}, source: {source} }}");
    world.put(CATALOG, &format!("{}{line}{}", &text[..at], &text[end..]));
}

fn lock_line(world: &World, model: &str) -> String {
    let text = world.text(LOCK);
    let line = text.lines().find(|line| line.starts_with(model)).expect("a line of the lock");
    format!("{line}\n")
}
