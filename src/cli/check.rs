//! `physique check`: the gate, and the pages of its rules.

use std::fs;
use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, anyhow, bail};
use mapper::{MapError, Sidecar};

use super::End;
use super::args::{CheckArgs, Format, Global, Mapping, PolicyArgs, ReportingArgs};
use super::given::Given;
use super::progress::Bars;
use super::{interrupt, job, output};
use crate::check::{
    self, Baseline, GitTree, Layer, Layers, Level, Limit, Models, Observation, Places, Policy, Report,
    Request, Rule, Selector, Severity, config, format, page,
};
use crate::pipeline::{Job, RecordTo, Settings, Upto};

/// # Errors
/// Flags or configuration are not right, the catalogue cannot be opened, or a report not written.
pub(super) fn check(global: &Global, args: &CheckArgs) -> Result<End> {
    let given = Given::of(&args.paths)?;
    let policy = policy(args)?;
    let reports = reports(&args.reporting)?;
    if args.paths.is_empty() && global.db.is_none() && layers(args) != Layers::only(&[Layer::Static]) {
        bail!(
            "nothing to check: name a folder of models, or a catalogue with --db; `--layer static` checks the rules alone"
        );
    }
    let layers = layers(args).and(|layer| policy.asks_for(layer));
    if layers == Layers::only(&[]) {
        bail!("there is nothing to look for: --select, --ignore and --layer leave no rule");
    }
    let (global, mapping) = given.laid_over(global, &args.mapping);
    let models = match (&given.models, &global.db) {
        (Some(_), _) => Models::Folder,
        (None, Some(db)) if !db.is_file() => {
            bail!("{}: no such catalogue; name a folder of models, and it is made", db.display())
        }
        (None, Some(_)) => Models::Catalogue,
        (None, None) => Models::None,
    };
    let root = given.models.as_deref().unwrap_or(Path::new("."));
    let overrides_from = match models {
        Models::Catalogue => job::root_in(&job::db(&global)),
        _ => root.to_path_buf(),
    };
    let overrides = job::override_files(&mapping, &overrides_from);
    let (job, faults) = job_or_faults(&global, args, &mapping, &given, &overrides_from)?;
    let changed_since = match &args.changed_since {
        Some(name) => Some((GitTree::open(root, name)?, name.clone())),
        None => None,
    };
    let request = Request {
        job,
        faults,
        models,
        places: Places { catalog: global.catalog.clone() },
        overrides,
        policy,
        layers,
        locked: args.locked.clone(),
        baseline: args.baseline.clone().filter(|_| !args.update_baseline),
        changed_since,
    };
    job::start_threads(&global)?;
    let bars = Bars::new(&global);
    let report = check::check(&request, &bars)?;
    bars.finish();
    write(&global, args, &reports, &report)?;
    if report.stopped {
        // A baseline of what was seen so far would bring back, as new, all that it had accepted of the rest.
        return Ok(End::Interrupted);
    }
    if args.update_baseline
        && let Some(file) = &args.baseline
    {
        output::file(file, |to| {
            Ok(to.write_all(
                Baseline::text(&report.findings, report.fail_on.min(Severity::Warning)).as_bytes(),
            )?)
        })?;
        return Ok(End::Clean);
    }
    Ok(if report.failing() > 0 && !args.reporting.exit_zero { End::Findings } else { End::Clean })
}

fn layers(args: &CheckArgs) -> Layers {
    if args.rules {
        return Layers::only(&[Layer::Static]);
    }
    if args.layer.is_empty() {
        return Layers::ALL;
    }
    let wanted: Vec<Layer> =
        Layer::ALL.into_iter().filter(|layer| args.layer.iter().any(|name| name == layer.name())).collect();
    Layers::only(&wanted)
}

/// The job, or why rules and overrides make none: faults in what is checked are findings and no reason to stop.
fn job_or_faults(
    global: &Global,
    args: &CheckArgs,
    mapping: &Mapping,
    given: &Given,
    root: &Path,
) -> Result<(Option<Job<'static>>, Vec<Observation>)> {
    let made = job::mapping(global, mapping, root);
    let (mapper, inputs, sets) = match made {
        Ok(made) => made,
        Err(error) => match error.downcast_ref::<MapError>() {
            Some(fault) => return Ok((None, check::map_error(fault))),
            None => return Err(error),
        },
    };
    let mut faults = Vec::new();
    for path in &given.sidecars {
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        if let Err(fault) = Sidecar::parse(&path.display().to_string(), &text, mapper.rules()) {
            faults.extend(check::map_error(&fault));
        }
    }
    let drop = Settings {
        floor: args.floor.clone(),
        validate: cfg!(feature = "validate") && !args.no_validate,
        ..Settings::default()
    };
    let job = Job {
        models: given.models.clone().unwrap_or_default(),
        db: job::db(global),
        options: job::import_options(),
        mapper,
        inputs,
        sets,
        drop,
        record: RecordTo::default(),
        shard: importer::Shard::WHOLE,
        threads: global.threads,
        upto: Upto::Map,
        stop: interrupt::flag(),
    };
    Ok((Some(job), faults))
}

/// Of the configuration, else of a built-in profile.
///
/// # Errors
/// The configuration cannot be read, or there is no such profile.
pub(super) fn configured(args: &PolicyArgs) -> Result<Policy> {
    let profile = args.profile.as_deref();
    let found = Path::new(config::DEFAULT_FILE).is_file().then(|| PathBuf::from(config::DEFAULT_FILE));
    match args.config.clone().or(found) {
        Some(file) => {
            let text = fs::read_to_string(&file)
                .with_context(|| format!("cannot read the configuration {}", file.display()))?;
            Ok(config::parse(&file.display().to_string(), &text, profile)?)
        }
        None => config::built_in(profile).map_err(|error| anyhow!(error)),
    }
}

/// The same with what the command line says on top.
fn policy(args: &CheckArgs) -> Result<Policy> {
    let mut policy = configured(&args.policy)?;
    let levels = &args.levels;
    if !levels.select.is_empty() {
        policy.select = parsed("--select", &levels.select)?;
    }
    let ignored: Vec<Selector> = parsed("--ignore", &levels.ignore)?;
    policy.ignore.extend(ignored);
    let given = [
        ("--allow", &levels.allow, Level::Allow),
        ("--warn", &levels.warn, Level::Warn),
        ("--deny", &levels.deny, Level::Deny),
    ];
    for (flag, names, level) in given {
        for selector in parsed::<Selector>(flag, names)? {
            policy.command_line.level(selector, level);
        }
    }
    let limits: Vec<Limit> = parsed("--error-if", &levels.error_if)?;
    policy.limits.extend(limits);
    if let Some(name) = &levels.fail_on {
        policy.fail_on = severity(name);
    }
    Ok(policy)
}

fn parsed<T: FromStr<Err = String>>(flag: &str, texts: &[String]) -> Result<Vec<T>> {
    texts.iter().map(|text| text.parse().map_err(|error: String| anyhow!("{flag}: {error}"))).collect()
}

/// Of a name that clap has checked.
fn severity(name: &str) -> Severity {
    [Severity::Info, Severity::Warning].into_iter().find(|s| s.name() == name).unwrap_or(Severity::Error)
}

/// What `--report` asks for, format by format.
fn reports(args: &ReportingArgs) -> Result<Vec<(format::Format, PathBuf)>> {
    let parsed = |asked: &String| {
        let (name, file) = asked.split_once('=').filter(|(_, file)| !file.is_empty()).ok_or_else(|| {
            anyhow!("--report: expected FORMAT=FILE, as sarif=physique.sarif, found {asked:?}")
        })?;
        let format = name.parse().map_err(|error: String| anyhow!("--report: {error}"))?;
        Ok((format, PathBuf::from(file)))
    };
    args.report.iter().map(parsed).collect()
}

fn write(
    global: &Global,
    args: &CheckArgs,
    reports: &[(format::Format, PathBuf)],
    report: &Report,
) -> Result<()> {
    let reporting = &args.reporting;
    let style =
        |colour| format::Style { show: severity(&reporting.show), most: reporting.max_issues, colour };
    let wanted = named(global.format);
    match &reporting.output {
        Some(file) => output::file(file, |to| Ok(format::write(to, report, wanted, style(false))?))?,
        None => {
            let colour = io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
            output::result(|out| format::write(out, report, wanted, style(colour)))?;
        }
    }
    for (format, file) in reports {
        output::file(file, |to| Ok(format::write(to, report, *format, style(false))?))?;
    }
    if let Some(file) = &reporting.distribution {
        output::file(file, |to| Ok(to.write_all(check::distributions(report).as_bytes())?))?;
    }
    Ok(())
}

fn named(format: Format) -> format::Format {
    match format {
        Format::Text | Format::Full => format::Format::Full,
        Format::Json => format::Format::Json,
        Format::Concise => format::Format::Concise,
        Format::Jsonl => format::Format::Jsonl,
        Format::Junit => format::Format::Junit,
        Format::Sarif => format::Format::Sarif,
        Format::Github => format::Format::Github,
        Format::Gitlab => format::Format::Gitlab,
        Format::Markdown => format::Format::Markdown,
        Format::Html => format::Format::Html,
    }
}

/// `explain` is asked for a rule, or for all of them.
pub(super) fn is_about_rules(name: &Path) -> bool {
    let name = name.to_string_lossy();
    // A name without folder and ending is no model's: it may be a slip in a rule's.
    !Path::new(&*name).exists() && !name.contains(['/', '\\', '.'])
}

/// # Errors
/// There is no such rule, or stdout cannot be written.
pub(super) fn explain(name: &Path) -> Result<End> {
    let name = name.to_string_lossy();
    let text = match Rule::find(&name).or_else(|| Rule::all().find(|rule| rule.name == name)) {
        Some(rule) => page::page(rule),
        None if name == "rules" => page::list(),
        None => {
            let meant = Rule::nearest(&name)
                .map_or_else(String::new, |rule| format!("; did you mean {} ({})?", rule.code, rule.name));
            bail!("{name} is no file and no rule{meant} `physique explain rules` lists all rules");
        }
    };
    output::result(|out| out.write_all(text.as_bytes()))?;
    Ok(End::Clean)
}
