//! Every verb and flag.

use std::path::PathBuf;

use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};

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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    #[default]
    Text,
    Json,
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
    /// Import, and say what each model is and which physics it has
    Map(MapArgs),
    /// Step a scene file, or drop one model, and write poses or a recording
    Simulate(SimulateArgs),
    /// Write values of a model into the file beside it, or into a project file, keeping all else in it
    Set(SetArgs),
    /// Print values of a model with unit and the line that set them
    Get(GetArgs),
    /// Find faults in rules and overrides
    Check(CheckArgs),
    /// Print every attribute of a model with its value, unit, source line and what it overrode
    Explain(ExplainArgs),
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
    #[arg(long, value_name = "TIME", value_parser = seconds, default_value = "15s")]
    pub time: f64,
    /// Do not compare with rapier
    #[arg(long)]
    pub no_validate: bool,
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
}

#[derive(Clone, Debug, Args)]
pub(super) struct ImportAloneArgs {
    pub model: PathBuf,
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

#[derive(Clone, Debug, Args)]
pub(super) struct CheckArgs {
    /// Folder of models: overrides that match none of them are found as well
    pub models: Option<PathBuf>,
    /// Check the rules: what is unreachable, shadowed, claimed twice, or contradicts itself
    #[arg(long, required = true)]
    pub rules: bool,
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
    /// overrides.yaml and NAME.physics.yaml
    Overrides,
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
