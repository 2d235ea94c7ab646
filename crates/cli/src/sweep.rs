//! `enmm sweep`: the factor of safety of a case, or its displacement, over values of keys, as a curve, a contour or a
//! tornado.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use enmm::model::case::EnsembleOutput;
use enmm_io::files::{remove_if_there, write_atomic};
use enmm_io::{CaseError, LoadedCase};
use enmm_run::{
    Change, Crossing, Effect, EnsembleOptions, SampleOutput, SearchOptions, Sweep, SweepKind, SweepResult,
    sweep as find,
};

use crate::case::CaseArguments;
use crate::run::{directory_for, results_folder};
use crate::workers::{WorkArguments, Workers, report};
use crate::{BAD_INPUT, FAILED, OrFail, Outcome};

/// Name of the spreadsheet of a sweep.
const SPREADSHEET: &str = "sweep.xlsx";
/// Samples of a curve that are printed.
const PRINTED: usize = 50;
/// Crossings of a contour that are printed.
const CROSSINGS: usize = 20;

/// Examples, below the options.
const EXAMPLES: &str = "\
Example: enmm sweep slope.toml joint_law.fault.friction_deg=20:40:21
         enmm sweep slope.toml joint_law.fault.friction_deg=20:40:11 joint_law.fault.cohesion=0:50e3:11
         enmm sweep slope.toml joint_law.fault.friction_deg=25,35 mesh.size=1,2 --one-by-one --of fos";

/// Arguments of `enmm sweep`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// A key with its values, FIRST:LAST:COUNT or VALUE,VALUE: one key makes a curve, two make a contour.
    #[arg(required = true, value_name = "KEY=VALUES")]
    changes: Vec<String>,
    /// Change each key alone, the others as they are in the case: a tornado of any number of keys.
    #[arg(long)]
    one_by_one: bool,
    /// Command whose result each sample gets: a factor of safety, or a displacement of `run`.
    #[arg(long, value_name = "COMMAND", default_value = "bound")]
    of: Of,
    /// Directory for the results; default: NAME/sweep, where NAME is that of the case file.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    work: WorkArguments,
    /// Write all tables as the spreadsheet sweep.xlsx beside sweep.csv as well.
    #[arg(long)]
    xlsx: bool,
    /// Print one JSON object, that of sweep.json.
    #[arg(long)]
    json: bool,
}

/// Commands of which a sample has a result.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Of {
    /// Limit analysis, in a fraction of a second a sample: the bound where level tops pass.
    Bound,
    /// Strength reduction, in seconds or minutes a sample.
    Fos,
    /// All stages, in seconds or minutes a sample: largest displacement in the last one, and whether the slope failed.
    Run,
}

impl Of {
    fn output(self) -> SampleOutput {
        match self {
            Self::Bound => EnsembleOutput::LevelTops.into(),
            Self::Fos => EnsembleOutput::FactorOfSafety.into(),
            Self::Run => SampleOutput::Displacement,
        }
    }
}

/// Works out a sweep.
pub fn sweep(arguments: &Arguments) -> Outcome {
    work_out(arguments).map_err(|failure| failure.json(arguments.json))
}

fn work_out(arguments: &Arguments) -> Outcome {
    let (case, work) = (&arguments.case, &arguments.work);
    let sweep = asked(arguments).or_fail(BAD_INPUT)?;
    work.search().fos().check().or_fail(BAD_INPUT)?;
    let loaded = load(case, &sweep).or_fail(BAD_INPUT)?;
    let directory = results_folder(arguments.output.as_ref(), directory_for(&case.path, "sweep"), work.force)?;
    let workers = Workers { case, loaded: &loaded, work, quiet: arguments.json };
    let (found, options) = workers.find(directory, |options, ask, hear| find(&loaded, &sweep, options, ask, hear))?;
    let path = options.directory.join(SPREADSHEET);
    // One of an earlier sweep would be taken for that of this one.
    remove_if_there(&path).or_fail(FAILED)?;
    if arguments.xlsx {
        let tables = enmm_export::tables(&options.directory).and_then(|tables| enmm_export::workbook(&tables));
        write_atomic(&path, &tables.or_fail(FAILED)?).or_fail(FAILED)?;
    }
    let json = arguments.json.then_some((&*options.directory, "sweep.json"));
    report(json, || table(&found, &options), found.rows.len(), [&found.failed, &found.doubtful])
}

/// The sweep that the arguments ask for.
fn asked(arguments: &Arguments) -> Result<Sweep, String> {
    let changes = arguments.changes.iter().map(|text| Change::parse(text)).collect::<Result<Vec<_>, _>>()?;
    if arguments.of != Of::Fos && arguments.work.search() != SearchOptions::default() {
        let given = arguments.work.search().given().into_keys().next().unwrap_or_default().replace('_', "-");
        return Err(format!("--{given}: is an option of searches, which --of fos makes; add it"));
    }
    Sweep::new(changes, arguments.one_by_one, arguments.of.output())
}

/// The case, after a look at each value, so that wrong keys and values are found before any sample.
fn load(case: &CaseArguments, sweep: &Sweep) -> Result<LoadedCase, CaseError> {
    let loaded = case.load()?;
    sweep.settings().iter().try_for_each(|settings| case.load_with(settings).map(drop))?;
    Ok(loaded)
}

/// Results, as lines of a name and a text.
fn table(found: &SweepResult, options: &EnsembleOptions) -> String {
    let of = &found.sweep;
    let mut lines = Vec::new();
    let mut tell = |name: &str, text: String| lines.push(format!("{name:<23} {text}"));
    let keys = of.changes.iter().map(|change| match change.values.len() {
        1 => format!("1 value of {}", change.key),
        n => format!("{n} values of {}", change.key),
    });
    tell(of.kind.name(), keys.collect::<Vec<_>>().join(", "));
    let [low, high] = found.range();
    tell(&of.output.name().replace('_', " "), format!("{} to {}", number(found, low), number(found, high)));
    match of.kind {
        SweepKind::Curve if found.rows.len() <= PRINTED => {
            (0..found.rows.len())
                .for_each(|k| tell(&format!("  {}", digits(found.samples[k][0].1.number())), output(found, k)));
        }
        SweepKind::Tornado => {
            tell("  the case", output(found, 0));
            found.effects().iter().for_each(|of| tell(&format!("  {}", number(found, of.range)), effect(found, of)));
        }
        _ => {}
    }
    let crossings = found.crossings();
    let limit = if found.has_factors() { format!("F = {}", found.limit) } else { "failure".to_owned() };
    for crossing in crossings.iter().take(CROSSINGS) {
        tell(&limit, crosses(found, crossing));
    }
    match crossings.len() {
        0 => tell(&limit, no_crossing(found)),
        n if n > CROSSINGS => tell("", format!("and {} more: see sweep.json", n - CROSSINGS)),
        _ => {}
    }
    tell("store", options.store.display().to_string());
    tell("results", options.directory.display().to_string());
    lines.join("\n")
}

/// A factor, or a displacement.
fn number(found: &SweepResult, output: f64) -> String {
    if found.has_factors() { format!("{output:.4}") } else { format!("{output:.3e} m") }
}

/// Output of a sample, with the way in which it is a limit alone, or how its run ended.
fn output(found: &SweepResult, k: usize) -> String {
    match (found.output(k), found.status(k)) {
        (None, _) => "no answer".to_owned(),
        (Some(factor), "found") => number(found, factor),
        (Some(output), status) => format!("{} ({})", number(found, output), status.replace('_', " ")),
    }
}

/// Outputs of the values of a key.
fn effect(found: &SweepResult, effect: &Effect) -> String {
    let outputs = effect.outputs.iter().map(|(value, output)| format!("{} at {value}", number(found, *output)));
    format!("by {}: {}", effect.key, outputs.collect::<Vec<_>>().join(", "))
}

/// Where the factor passes the limit.
fn crosses(found: &SweepResult, crossing: &Crossing) -> String {
    let key = |k: usize| &found.sweep.changes[k].key;
    let [low, high] = crossing.between.map(digits);
    let place = match crossing.value {
        Some(value) => format!("at {} = {}", key(0), digits(value)),
        None if found.has_factors() => {
            format!("at {} between {low} and {high}, where a factor is a limit or has no answer", key(0))
        }
        None => format!("begins at {} between {low} and {high}", key(0)),
    };
    match crossing.at {
        Some(at) => format!("{place}, {} = {at}", key(1)),
        None => place,
    }
}

/// Six digits of a number.
fn digits(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded:?}").trim_end_matches(".0").to_owned()
}

/// Why there is no crossing.
fn no_crossing(found: &SweepResult) -> String {
    let [low, high] = found.range();
    let fails = || (0..found.rows.len()).filter_map(|k| found.fails(k));
    match found.sweep.kind {
        _ if !found.has_factors() && fails().next().is_none() => "no run has a verdict".to_owned(),
        _ if !found.has_factors() && fails().all(|fails| fails) => "at all values".to_owned(),
        _ if !found.has_factors() && !fails().any(|fails| fails) => "at no value".to_owned(),
        _ if !found.has_factors() => "at some values".to_owned(),
        _ if low >= found.limit => "is not crossed: no factor is below it".to_owned(),
        _ if high < found.limit => "is not crossed: all factors are below it".to_owned(),
        SweepKind::Contour => format!("is not crossed along {}", found.sweep.changes[0].key),
        _ => "lies between the factors of these changes: sweep one of the keys for its value".to_owned(),
    }
}
