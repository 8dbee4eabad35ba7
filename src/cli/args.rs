//! Every verb and flag.

use std::path::PathBuf;

use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};
use importer::Shard;

use crate::check::lock::DEFAULT_FILE;

/// Gives every 3D model its physics: reads meshes, works out what they are, attaches mass, friction, bounce,
/// stiffness or viscosity with the reason for every value, proves it by simulation, and shows it in rerun.
#[derive(Clone, Debug, Parser)]
#[command(name = "physique", version, propagate_version = true, subcommand_required = true)]
#[command(after_help = "Exit codes: 0 done and clean, 1 findings, 2 could not run, 130 interrupted.\n\
    Results go to stdout, progress and messages to stderr.\n\n\
    physique demo              everything, on a small database of its own\n\
    physique run MODELS        everything, on a folder of yours")]
pub(super) struct Cli {
    #[command(flatten)]
    pub global: Global,
    #[command(subcommand)]
    pub verb: Verb,
}

/// Flags that every verb knows.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Global options")]
pub(super) struct Global {
    /// How results are printed
    #[arg(long, global = true, value_enum, default_value_t)]
    pub format: Format,
    /// Folder for results [default: ./physique-out, for demo ./physique-demo]; for map --table the file
    #[arg(long, global = true, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Catalogue of what is known of every model [default: catalogue.db in --out]
    #[arg(long, global = true, value_name = "FILE")]
    pub db: Option<PathBuf>,
    /// Rules, categories and presets [default: the built-in catalog.yaml]
    #[arg(long, global = true, value_name = "FILE")]
    pub catalog: Option<PathBuf>,
    /// Threads; 0 is one a core
    #[arg(long, global = true, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// No progress and no notices
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// A line on stderr for every model
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
}

/// Every verb has the first two; `check` all, `diff` Markdown as well.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    #[default]
    Text,
    Json,
    /// check: the place with a caret, the measure, the way out (what text is there)
    Full,
    /// check: a line a finding
    Concise,
    /// check: a JSON object a line
    Jsonl,
    /// check: JUnit's XML
    Junit,
    /// check: SARIF 2.1.0
    Sarif,
    /// check: annotations of a GitHub workflow
    Github,
    /// check: GitLab's code quality report
    Gitlab,
    /// check, diff: for a job's summary or a comment
    Markdown,
    /// check: one page with pictures of the offenders
    Html,
}

#[derive(Clone, Debug, Subcommand)]
pub(super) enum Verb {
    /// Import, map, drop, compare with rapier and record a folder of models
    Run(RunArgs),
    /// Read models, measure them and make colliders, into the catalogue
    Import(ImportArgs),
    /// Print one model's asset or failure: what a run does elsewhere with a model that was in work when one died
    #[command(hide = true)]
    ImportAlone(ImportAloneArgs),
    /// Join catalogues, as shards of one folder made them, into the one of --out or --db
    Merge(MergeArgs),
    /// Import, and say what each model is and which physics it has
    Map(MapArgs),
    /// Step a scene file, or drop one model, and write poses or a recording
    Simulate(SimulateArgs),
    /// Write values of a model into the file beside it, or into a project file, keeping all else in it
    Set(SetArgs),
    /// Print values of a model with unit and the line that set them
    Get(GetArgs),
    /// Gate for CI: is the mapping sound, and do the models still behave
    Check(Box<CheckArgs>),
    /// Write down what the mapping says of every model, to be committed and reviewed
    Lock(LockArgs),
    /// Say what changed between two locks, catalogues, rules or git references
    Diff(DiffArgs),
    /// Print every attribute of a model with its value, unit, source line and what it overrode; or the page of a
    /// rule of `check`: explain MAS002; `explain rules` lists them
    Explain(ExplainArgs),
    /// Speed against error, in Physique and in rapier: scenes with a known truth, or your own; or, with --colliders, how
    /// true and how dear a folder's colliders are
    Report(ReportArgs),
    /// Write a small model database made by code and run everything on it
    Demo(DemoArgs),
    /// Open a recording in the viewer, or say how
    View(ViewArgs),
    /// Print versions, and whether what is needed is there
    Doctor,
    /// Print a JSON Schema, for editors that complete and check YAML
    Schema(SchemaArgs),
}

/// Flags that decide a mapping.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct Mapping {
    /// Project override file, may be repeated [default: proposals.yaml and overrides.yaml in MODELS, if there]
    #[arg(long, value_name = "FILE")]
    pub overrides: Vec<PathBuf>,
    /// Set a value for every model, over all files: mass=2.4kg, preset=oak, unit=cm; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Tags of models: CSV with the columns path and tags (parted by ;), or JSON { path: [tag, ...] }; may be
    /// given once
    #[arg(long, value_name = "FILE")]
    pub tags: Option<PathBuf>,
}

/// Flags that decide a drop.
#[derive(Clone, Debug, Args)]
pub(super) struct Dropping {
    /// Preset whose surface the floor has
    #[arg(long, value_name = "PRESET", default_value = "concrete")]
    pub floor: String,
    /// Give up on a drop that has not come to rest by then
    #[arg(long, value_name = "TIME", value_parser = seconds, default_value = "60s")]
    pub time: f64,
    /// Do not compare with rapier
    #[arg(long)]
    pub no_validate: bool,
}

/// Dividing a folder over machines.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct Dividing {
    /// Only share I of N of the models, told by their paths: the same on every machine; `merge` joins the catalogues
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
}

impl Dividing {
    pub(super) fn shard(self) -> Shard {
        self.shard.unwrap_or(Shard::WHOLE)
    }
}

/// Flags that decide a recording.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct Showing {
    /// Also show it in a viewer while it runs
    #[arg(long)]
    pub view: bool,
    /// Write no recording
    #[arg(long, conflicts_with = "view")]
    pub no_record: bool,
}

#[derive(Clone, Debug, Args)]
pub(super) struct RunArgs {
    /// Folder of models (glb, gltf, obj, stl, ply, off, xyz, pcd, vox, binvox, shapes.yaml), searched through, or one model
    pub models: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub dropping: Dropping,
    #[command(flatten)]
    pub showing: Showing,
    #[command(flatten)]
    pub dividing: Dividing,
}

#[derive(Clone, Debug, Args)]
pub(super) struct DemoArgs {
    #[command(flatten)]
    pub dropping: Dropping,
    #[command(flatten)]
    pub showing: Showing,
}

#[derive(Clone, Debug, Args)]
pub(super) struct ImportArgs {
    /// Folder of models, or one model
    pub models: PathBuf,
    /// Read, measure and store only; a later run makes the colliders
    #[arg(long)]
    pub no_colliders: bool,
    #[command(flatten)]
    pub dividing: Dividing,
}

#[derive(Clone, Debug, Args)]
pub(super) struct ImportAloneArgs {
    pub model: PathBuf,
}

#[derive(Clone, Debug, Args)]
pub(super) struct MergeArgs {
    /// Catalogues, or folders of results with one in them; where two know a model, the later one's word stands
    #[arg(required = true, value_name = "CATALOGUE")]
    pub from: Vec<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub(super) struct MapArgs {
    /// Folder of models, or one model
    #[arg(required_unless_present = "table")]
    pub models: Option<PathBuf>,
    /// Map the rows of a CSV table instead: id, and path, name, text, dim_x, dim_y, dim_z (m), solid_volume_m3 as
    /// far as known. The answers go to the file --out, else to stdout
    #[arg(long, value_name = "FILE.csv", conflicts_with = "models")]
    pub table: Option<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Clone, Debug, Args)]
pub(super) struct SetArgs {
    /// Model file
    pub model: PathBuf,
    /// What to set: mass=2.4kg, preset=oak, category=seating, unit=cm
    #[arg(required = true, value_name = "NAME=VALUE")]
    pub values: Vec<String>,
    /// Write into this project override file instead of the sidecar
    #[arg(long, value_name = "FILE")]
    pub project: Option<PathBuf>,
    /// Models that the project file's entry is for [default: MODEL, below the file's folder]
    #[arg(long, value_name = "GLOB", requires = "project")]
    pub glob: Option<String>,
}

#[derive(Clone, Debug, Args)]
pub(super) struct GetArgs {
    /// Model file
    pub model: PathBuf,
    /// Which value: mass, density, category, preset [default: all]
    pub name: Option<String>,
    /// Folder that the model belongs to; as for explain
    #[arg(long, value_name = "DIR")]
    pub root: Option<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
}

/// Where levels and bounds come from.
#[derive(Clone, Debug, Args)]
pub(super) struct PolicyArgs {
    /// Levels, bounds and suppressions [default: ./physique.yaml, if there]
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// default, strict, simready, or one of the configuration's
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
}

#[derive(Clone, Debug, Args)]
pub(super) struct CheckArgs {
    /// Folder of models or one model, and YAML files: rules, overrides, sidecars. Without models --db checks what a
    /// catalogue has, and --layer static the rules alone
    pub paths: Vec<PathBuf>,
    /// The same as --layer static
    #[arg(long)]
    pub rules: bool,
    /// Run this layer, may be repeated [default: all]
    #[arg(long, value_name = "LAYER", value_delimiter = ',', value_parser = ["static", "data", "runtime"])]
    pub layer: Vec<String>,
    #[command(flatten)]
    pub policy: PolicyArgs,
    #[command(flatten)]
    pub levels: LevelArgs,
    #[command(flatten)]
    pub reporting: ReportingArgs,
    /// Accept the findings that this file lists, and fail on new ones only
    #[arg(long, value_name = "FILE")]
    pub baseline: Option<PathBuf>,
    /// Write today's findings into --baseline
    #[arg(long, requires = "baseline")]
    pub update_baseline: bool,
    /// Fail where the mapping is not as this lock file has it [default file: physique.lock]
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = DEFAULT_FILE, require_equals = true)]
    pub locked: Option<PathBuf>,
    /// Only models and files that changed since this git reference, and models that changed rules map otherwise
    #[arg(long, value_name = "GITREF")]
    pub changed_since: Option<String>,
    /// Preset whose surface the floor has
    #[arg(long, value_name = "PRESET", default_value = "concrete")]
    pub floor: String,
    /// Do not compare with rapier
    #[arg(long)]
    pub no_validate: bool,
    #[command(flatten)]
    pub mapping: Mapping,
}

/// Which rules, how bad, how many.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Rules: codes (MAS002), families (MAS), `warnings` or `all`, parted by commas")]
pub(super) struct LevelArgs {
    /// Only these
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    pub select: Vec<String>,
    /// Not these
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    pub ignore: Vec<String>,
    /// Errors
    #[arg(short = 'D', long, value_name = "RULES", value_delimiter = ',')]
    pub deny: Vec<String>,
    /// Warnings
    #[arg(short = 'W', long, value_name = "RULES", value_delimiter = ',')]
    pub warn: Vec<String>,
    /// Not reported
    #[arg(short = 'A', long, value_name = "RULES", value_delimiter = ',')]
    pub allow: Vec<String>,
    /// Errors only where there are more: 'MAS002>1%', 'SIM>10'; may be repeated
    #[arg(long, value_name = "LIMIT")]
    pub error_if: Vec<String>,
    /// Lowest severity that ends with exit code 1 [default: the configuration's, else error]
    #[arg(long, value_name = "SEVERITY", value_parser = ["info", "warning", "error"])]
    pub fail_on: Option<String>,
}

/// What is written where.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Reports")]
pub(super) struct ReportingArgs {
    /// Write the report of --format into this file instead of stdout
    #[arg(long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write another report as well: sarif=physique.sarif, html=report.html; may be repeated
    #[arg(long, value_name = "FORMAT=FILE")]
    pub report: Vec<String>,
    /// Lowest severity that reports for people show
    #[arg(long, value_name = "SEVERITY", value_parser = ["info", "warning", "error"], default_value = "warning")]
    pub show: String,
    /// Show no more findings than this, the worst first
    #[arg(long, value_name = "N")]
    pub max_issues: Option<usize>,
    /// End with exit code 0 whatever is found
    #[arg(long)]
    pub exit_zero: bool,
    /// Write how every measured value is spread over the models, as CSV: what to choose bounds from
    #[arg(long, value_name = "FILE")]
    pub distribution: Option<PathBuf>,
}

#[derive(Clone, Debug, Args)]
pub(super) struct LockArgs {
    /// Folder of models, or one model [default: what the catalogue --db has]
    pub models: Option<PathBuf>,
    /// The lock file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_FILE)]
    pub output: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Clone, Debug, Args)]
pub(super) struct DiffArgs {
    /// Lock file, catalogue (.db), rules (.yaml), folder of models, or git reference. A git reference is its
    /// physique.lock, else its rules on the models of --db
    pub before: String,
    /// The same, for now
    pub after: String,
    /// Also look at the changed models on both sides, simulate them, and say what fails now by the levels and bounds
    /// of --config
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub policy: PolicyArgs,
    /// Name of the lock file that git references have
    #[arg(long, value_name = "FILE", default_value = DEFAULT_FILE)]
    pub lock_file: PathBuf,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Clone, Debug, Args)]
pub(super) struct ExplainArgs {
    /// Model file
    pub model: PathBuf,
    /// Folder that the model belongs to; rules see the path from here [default: the catalogue's, else the folder
    /// above the model's]
    #[arg(long, value_name = "DIR")]
    pub root: Option<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Clone, Debug, Args)]
pub(super) struct SimulateArgs {
    /// Scene file (.yaml), or a model to drop
    pub scene: PathBuf,
    /// Write every pose of every step
    #[arg(long, value_name = "FILE.csv")]
    pub poses: Option<PathBuf>,
    /// Write a recording [default: recording.rrd in --out, if given]
    #[arg(long, value_name = "FILE.rrd")]
    pub record: Option<PathBuf>,
    /// Show it in a viewer while it runs
    #[arg(long)]
    pub view: bool,
    /// How long to simulate [default: the scene's, else 10s]
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub time: Option<f64>,
    /// Length of a step: 0.01s or 1/120 [default: the scene's, else 1/60]
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub dt: Option<f64>,
    /// Small steps a step
    #[arg(long, value_name = "N")]
    pub substeps: Option<u32>,
    /// Stiffness of contacts, as the frequency of their springs; `report --budget` advises it
    #[arg(long, value_name = "HZ")]
    pub contact_hertz: Option<f64>,
    /// Let no body fall asleep
    #[arg(long)]
    pub no_sleep: bool,
    /// End once everything is at rest
    #[arg(long)]
    pub until_rest: bool,
    /// Print which models the scene needs and why, what was done, and the time of each phase
    #[arg(long)]
    pub explain: bool,
    /// Run the same in rapier and compare
    #[arg(long)]
    pub validate: bool,
    /// Preset whose surface the floor under a single model has
    #[arg(long, value_name = "PRESET", default_value = "concrete")]
    pub floor: String,
    #[command(flatten)]
    pub mapping: Mapping,
}

#[derive(Clone, Debug, Args)]
pub(super) struct ReportArgs {
    /// Scenes of the gallery by name or by its start (`seed-*`), or scene files (.yaml) [default: the whole gallery]
    pub scenes: Vec<String>,
    /// Name the scenes of the gallery
    #[arg(long)]
    pub list: bool,
    /// Only the engines as they come: no other substep counts, no stiffer contacts
    #[arg(long)]
    pub quick: bool,
    /// Which settings to use for an error up to 1mm, or a step within 2ms
    #[arg(long, value_name = "1mm|2ms")]
    pub budget: Option<String>,
    /// Rounds for the clock, each engine in turn
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub rounds: usize,
    /// Seconds of clocked rounds a scene, about: dear scenes get fewer rounds
    #[arg(long, value_name = "S", default_value_t = 6.0)]
    pub seconds: f64,
    /// Build rapier with eight lanes from the sources, for the comparison
    #[arg(long)]
    pub build_simd8: bool,
    /// Runner of rapier with eight lanes [default: where --build-simd8 puts it, if there]
    #[arg(long, value_name = "FILE")]
    pub simd8: Option<PathBuf>,
    /// Folder of real cube tosses, for the scene cube-tosses
    #[arg(long, value_name = "DIR")]
    pub tosses: Option<PathBuf>,
    /// Folder of a model database that holds animals/dog.stl, for the scene seed-dog
    #[arg(long, value_name = "DIR")]
    pub models: Option<PathBuf>,
    #[command(flatten)]
    pub mapping: Mapping,
    #[command(flatten)]
    pub colliders: ColliderArgs,
}

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Colliders")]
pub(super) struct ColliderArgs {
    /// Measure the colliders of these models, ours beside parry's; with --out also a table, a page of pictures and
    /// each model's convex pieces as JSON lists of points in file units
    #[arg(long, value_name = "MODELS")]
    pub colliders: Option<PathBuf>,
    /// Error a collider may have, as a share of the model's diagonal
    #[arg(long, value_name = "SHARE", default_value_t = 0.02, requires = "colliders")]
    pub tolerance: f64,
    /// Of how many models, spread evenly, a pile of twenty copies is stepped
    #[arg(long, value_name = "N", default_value_t = 10, requires = "colliders")]
    pub piles: usize,
}

#[derive(Clone, Debug, Args)]
pub(super) struct ViewArgs {
    /// Recording (.rrd)
    pub recording: PathBuf,
    /// Only print the command
    #[arg(long)]
    pub print: bool,
}

#[derive(Clone, Debug, Args)]
pub(super) struct SchemaArgs {
    /// Of which file
    #[arg(value_enum)]
    pub of: SchemaOf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum SchemaOf {
    /// catalog.yaml: categories, presets, rules
    Catalog,
    /// overrides.yaml: what people say of many models
    Overrides,
    /// NAME.physics.yaml: what they say of the model beside it
    Sidecar,
    /// A scene for `physique simulate`
    Scene,
}

/// Seconds: `10`, `10s`, `250ms`, `1/60`.
fn seconds(text: &str) -> Result<f64, String> {
    let wrong = || format!("expected a time above 0, as 10s, 250ms or 1/60, found {text:?}");
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    let text = text.trim();
    let (value, unit) = match (text.strip_suffix("ms"), text.strip_suffix('s')) {
        (Some(value), _) => (value, 1e-3),
        (None, Some(value)) => (value, 1.0),
        (None, None) => (text, 1.0),
    };
    let value = match value.split_once('/') {
        Some((over, under)) => number(over)? / number(under)?,
        None => number(value)?,
    };
    if value > 0.0 && value.is_finite() { Ok(value * unit) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn clap_finds_no_fault() {
        Cli::command().debug_assert();
    }

    #[test]
    fn times_are_read_with_and_without_a_unit() {
        for (text, expected) in
            [("10s", 10.0), ("2.5", 2.5), ("250 ms", 0.25), ("1/60", 1.0 / 60.0), (" 1/120 s", 1.0 / 120.0)]
        {
            assert_eq!(seconds(text), Ok(expected), "{text}");
        }
        for text in ["", "0", "-1s", "1/0", "ten", "nan", "inf", "5m"] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
