//! Damaged rules, overrides, sidecars, tags and tables are read or refused with a place; damaged names have an answer.
//!
//! Mutations are drawn from a counter, so that a failure repeats. `FUZZ_CASES=3000000 cargo test --release --test fuzz`
//! searches for minutes; a plain test run takes the first few thousand.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::{SMALL, rules};
use mapper::{
    MapError, Mapper, ModelFacts, Overrides, Ruleset, Sidecar, Tags, check_rules, map_table, parse_yaml,
};

/// What the grammars are made of, and what has broken parsers before.
const WORDS: [&str; 56] = [
    "\n",
    "\n  ",
    "\n    ",
    "  ",
    "\t",
    ":",
    ": ",
    "- ",
    "-",
    "?",
    "[",
    "]",
    "{",
    "}",
    ",",
    "'",
    "\"",
    "#",
    " #",
    "|",
    ">",
    "&a",
    "*a",
    "!!str",
    "---",
    "...",
    "%",
    "@",
    "\u{feff}",
    "\u{0}",
    "\r\n",
    "é",
    "中",
    "🪑",
    "kg/m3",
    "mm",
    "1e999",
    "-0",
    "NaN",
    "0.5",
    "99999999999999999999",
    "null",
    "~",
    "match",
    "set",
    "parts",
    "mass",
    "preset",
    "oak",
    "when",
    "any",
    "not",
    "word",
    "**/*",
    "[a-",
    "{a,b",
];

/// SplitMix64 (Steele, Lea and Flood 2014): a fixed stream for each case.
struct Draw(u64);

impl Draw {
    fn next(&mut self, below: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((mixed ^ (mixed >> 31)) % below.max(1) as u64).unwrap()
    }

    /// A place between two letters.
    fn place(&mut self, text: &str) -> usize {
        let mut at = self.next(text.len() + 1);
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    }

    fn damaged(&mut self, seed: &str) -> String {
        let mut text = seed.to_owned();
        for _ in 0..=self.next(4) {
            let (one, other) = (self.place(&text), self.place(&text));
            let (from, to) = (one.min(other), one.max(other));
            match self.next(6) {
                // A short cut as often as a long one.
                0 => text.replace_range(from..to, ""),
                1 => {
                    let end =
                        text[from..].char_indices().nth(self.next(4)).map_or(text.len(), |(at, _)| from + at);
                    text.replace_range(from..end, "");
                }
                2 => text.insert_str(from, WORDS[self.next(WORDS.len())]),
                3 => {
                    let again = text[from..to].to_owned();
                    text.insert_str(to, &again);
                }
                4 => text.truncate(to),
                _ => {
                    let moved: String = text.drain(from..to).collect();
                    let at = self.place(&text);
                    text.insert_str(at, &moved);
                }
            }
            text.truncate(text.floor_char_boundary(8192));
        }
        text
    }
}

fn cases(few: u64) -> std::ops::Range<u64> {
    0..std::env::var("FUZZ_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(few)
}

/// Every fault points into the text that was read, and says something.
fn refused(text: &str, error: &MapError) {
    let shown = error.to_string();
    assert!(!error.diagnostics().is_empty(), "{text:?}");
    for fault in error.diagnostics() {
        let inside = fault.line >= 1 && fault.line as usize <= text.lines().count() + 1;
        assert!(inside && !fault.message.is_empty(), "{text:?}\n{shown}");
    }
}

#[test]
fn damaged_files_are_read_or_refused_with_a_place() {
    let rules = rules();
    let mapper = Mapper::new(rules.clone(), Overrides::none());
    let seeds = [
        SMALL,
        "version: 1\nproposed_by: net\noverrides:\n  - match: ['a/**', \"*.glb\"]\n    confidence: 0.7\n    set: { preset: oak, mass: 4.2 kg }\n    parts:\n      'Seat*': { preset: steel }\n      0: { density: 500 kg/m3 }\n",
        "# weighed\npreset: oak # ours\nmass: 2.4kg\ntitle: Dog bowl\ntags: [steel, 'a b']\nmass_model: { shell: 2 mm }\nunit: cm\n",
        "path,tags\r\na/b.glb,oak; stool\n\"c, d.obj\",\"a \"\"b\"\"\"\n",
        "{ \"a/b.glb\": [\"oak\", \"stool\"], \"c.obj\": \"a, b\" }",
        "id,path,name,text,dim_x,dim_y,dim_z,solid_volume_m3\n1,a/b.glb,\"oak, chair\",x;y,0.9,0.8,,0.01\n2,,,,,,,\n",
    ];
    for case in cases(6000) {
        let mut draw = Draw(case);
        let kind = draw.next(seeds.len());
        let text = draw.damaged(seeds[kind]);
        let failed = match kind {
            0 => Ruleset::parse("a", &text).map(|rules| drop(check_rules(&rules))).err(),
            1 => Overrides::parse("a", &text, &rules).err(),
            2 => Sidecar::parse("a", &text, &rules).err(),
            3 | 4 => Tags::parse("a", &text).err(),
            _ => map_table(&mapper, "a", &text, &[]).err(),
        };
        if let Some(error) = failed {
            refused(&text, &error);
        }
        if let Err(error) = parse_yaml("a", &text) {
            refused(&text, &error);
        }
    }
}

#[test]
fn damaged_names_have_one_answer() {
    let mapper =
        Mapper::new(Ruleset::embedded().unwrap_or_else(|error| panic!("{error}")), Overrides::none());
    let seeds = [
        "furniture/OfficeChair_03.glb\nOak office chair (with wheels)\nswivel;black\nSeat_low\nleather",
        "b03_coffee_cup_2013__vray.obj\nPistol \"Viper\" - game ready, 12 fl oz\ntoy car\nBox007\nsteel",
        "food/pears_raw.stl\nPears, raw, red\n450 g\nzoWBjc0jbTs\nwood",
    ];
    for case in cases(4000) {
        let mut draw = Draw(case);
        let text = draw.damaged(seeds[draw.0 as usize % seeds.len()]);
        let mut lines = text.lines().map(str::to_owned);
        let facts = ModelFacts {
            model: lines.next().unwrap_or_default(),
            title: lines.next(),
            tags: lines.next().into_iter().collect(),
            names: lines.next().into_iter().collect(),
            materials: lines.next().into_iter().collect(),
            extents: [Some(text.len() as f64 / 64.0), None, None],
            metres_per_unit: 1.0,
            unit_stated: case % 2 == 0,
            shape: None,
            parts: Vec::new(),
            stated: Vec::new(),
        };
        let consulted = mapper.consult(&facts, None, &[]);
        let mapped = consulted.answer();
        assert!((0.0..=1.0).contains(&mapped.confidence), "{text:?}");
        assert!(mapped.number("mass").is_none_or(|mass| mass > 0.0 && mass.is_finite()), "{text:?}");
        assert_eq!(mapped, mapper.map(&facts, &[]), "{text:?}");
        assert_eq!(consulted.reach(), mapper.consult(&facts, None, &[]).reach(), "{text:?}");
    }
}
