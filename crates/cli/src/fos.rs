//! `enmm fos`: finds the factor of safety of a case by strength reduction.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use enmm::model::BoltCondition;
use enmm::model::case::{STANDARD_GRAVITY, Support};
use enmm_report::PAGE;
use enmm_run::fos::{Found, remedy};
use enmm_run::summary::BoltRecord;
use enmm_run::{FosError, FosOptions, Seismic};
use enmm_stability::left_out_stages;
use enmm_stability::limit_analysis::DUCTILE;
use enmm_stability::strength_reduction::seismic::{Direction, SeismicTrial, YieldAcceleration};
use enmm_stability::strength_reduction::{
    End, FailingBlock, MechanismOptions, Progress, Reduction, TOLERANCE, Trial, Verdict,
};

use crate::case::CaseArguments;
use crate::interrupt::{INTERRUPT, listen};
use crate::progress::Search;
use crate::run::{check_folder, directory_for, print_record, results_folder};
use crate::{
    AT_MOST, BAD_INPUT, FAILED, Failure, INTERRUPTED, OrFail, Outcome, fail, listed, print_line, tell_line, told,
};

/// Arguments of `enmm fos`.
#[derive(Args)]
#[command(after_help = "Example: enmm fos slope.toml --low 0.8 --high 2")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Directory for the results; default: NAME/fos, where NAME is that of the case file.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Least F that is tried, and the first.
    #[arg(long)]
    low: Option<f64>,
    /// Greatest F that is tried, and the second.
    #[arg(long)]
    high: Option<f64>,
    /// Width of the final bracket relative to F.
    #[arg(long, default_value_t = TOLERANCE)]
    tolerance: f64,
    /// Ignore mechanisms of less rock (m²), such as single key blocks: they are reported and removed, and the search
    /// begins again. Default: 1.5 % of the free rock; 0 counts all.
    #[arg(long, value_name = "AREA")]
    least_area: Option<f64>,
    /// Look at the slope after this static stage; default: after the last.
    #[arg(long, value_name = "NAME")]
    stage: Option<String>,
    /// Mechanisms to find, each without the blocks of those before.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=100))]
    mechanisms: u16,
    /// Meshes to look for it on, with the same geometry: that of the case, and each finer by √2 than the one before.
    /// More than one gives the error of the mesh.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=10))]
    meshes: u16,
    /// Look for the yield acceleration as well: the horizontal acceleration of all rock, out of the slope, over that of
    /// gravity, at which the slope just stands; with Newmark's block under the records of the case. The slope falls to
    /// the side of its lower ground, or to that which is named.
    #[arg(long, value_name = "SIDE", num_args = 0..=1, require_equals = true)]
    seismic: Option<Option<Side>>,
    /// Threads; default: all. Results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Replace results of another case in the directory.
    #[arg(long)]
    force: bool,
    /// Draw no pictures and no page: only tables are wanted.
    #[arg(long)]
    no_pictures: bool,
    /// Print one JSON object, that of fos.json.
    #[arg(long)]
    json: bool,
    /// Print each trial as a JSON object before that; how the Python package follows a search.
    #[arg(long, hide = true, requires = "json")]
    trials: bool,
}

/// The side to which a slope falls.
#[derive(Clone, Copy, ValueEnum)]
enum Side {
    /// To smaller x.
    Left,
    /// To greater x.
    Right,
}

impl From<Side> for Direction {
    fn from(side: Side) -> Self {
        match side {
            Side::Left => Self::Left,
            Side::Right => Self::Right,
        }
    }
}

/// Heads the columns of [`row`].
const HEAD: &str = "trial           F  verdict   by            time (s)  displacement (m)  speed (m/s)  kinetic (J/m)  \
                    failing    steps  wall (s)";

/// Finds the factor of safety of a case.
pub fn fos(arguments: &Arguments) -> Outcome {
    find(arguments).map_err(|failure| failure.json(arguments.json))
}

fn find(arguments: &Arguments) -> Outcome {
    let default = directory_for(&arguments.case.path, "fos");
    let options = FosOptions {
        directory: results_folder(arguments.output.as_ref(), default, arguments.force)?,
        low: arguments.low,
        high: arguments.high,
        tolerance: arguments.tolerance,
        mechanisms: MechanismOptions { least_area: arguments.least_area, count: arguments.mechanisms.into() },
        threads: arguments.threads.map(usize::from),
        pictures: !arguments.no_pictures,
        stage: arguments.stage.clone(),
        meshes: arguments.meshes.into(),
        seismic: arguments.seismic.is_some(),
        direction: arguments.seismic.flatten().map(Direction::from),
        interrupt: Some(&INTERRUPT),
    };
    options.check().or_fail(BAD_INPUT)?;
    let loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    check_folder(&options.directory, &loaded, arguments.force).or_fail(BAD_INPUT)?;
    listen()?;
    let left_out = left_out_stages(&loaded.case).filter(|_| !arguments.json && arguments.stage.is_none());
    if let Some(warning) = &left_out {
        tell_line(&format!("warning: {warning}"));
    }
    let search = Search::new(arguments.json);
    let mut hear = |trial: &Trial, progress: Progress| {
        search.trial(progress.trials, progress.expected, || {
            if arguments.trials {
                print_line(&trial_line(trial, progress));
            }
            if progress.trials == 1 && !arguments.json {
                print_line(HEAD);
            }
            if !arguments.json {
                print_line(&row(trial, progress));
            }
        });
    };
    let mut hear_seismic = |trial: &SeismicTrial, progress: Progress| {
        search.trial(progress.trials, progress.expected, || {
            if arguments.trials {
                print_line(&seismic_line(trial, progress));
            }
            if !arguments.json {
                print_line(&seismic_row(trial, progress));
            }
        });
    };
    let found = enmm_run::fos(&loaded, &options, &mut hear, &mut hear_seismic);
    drop(search);
    let found = found.map_err(|error| match error {
        FosError::NoRest(_) => Failure::new(error, FAILED).on(&loaded),
        FosError::Case(_) => Failure::new(error, BAD_INPUT).on(&loaded),
        FosError::Output(_) => Failure::new(error, FAILED),
        FosError::Interrupted => Failure::new(error, INTERRUPTED),
        _ => Failure::new(error, BAD_INPUT),
    })?;
    report(arguments, &found, &options.directory, left_out.as_ref())
}

/// A trial in words, with its number and about how many there will be, as a JSON object.
pub fn trial_line(trial: &Trial, progress: Progress) -> String {
    let Progress { trials, expected } = progress;
    let text = format!("trial {trials} of about {expected}, F = {:.4} {}", trial.factor, trial.verdict.name());
    serde_json::json!({ "trial": text, "done": trials, "expected": expected }).to_string()
}

/// The same of a trial with an acceleration of all rock.
fn seismic_line(trial: &SeismicTrial, progress: Progress) -> String {
    let Progress { trials, expected } = progress;
    let text = format!("trial {trials} of about {expected}, k = {:.5} {}", trial.coefficient, trial.verdict().name());
    serde_json::json!({ "trial": text, "done": trials, "expected": expected }).to_string()
}

fn seismic_row(trial: &SeismicTrial, progress: Progress) -> String {
    let number = format!("{} of ~{}", progress.trials, progress.expected);
    format!("{number:<9}k = {:7.5}  {:<8}  {}", trial.coefficient, trial.verdict().name(), trial.word())
}

fn row(t: &Trial, progress: Progress) -> String {
    let number = format!("{} of ~{}", progress.trials, progress.expected);
    format!(
        "{number:<9}{:8.5}  {:<8}  {:<12}  {:8.3}  {:16.3e}  {:11.3e}  {:13.3e}  {:7}  {:7}  {:8.2}",
        t.factor,
        t.verdict.name(),
        t.reason.name(),
        t.time,
        t.displacement,
        t.speed,
        t.kinetic,
        t.failing.len(),
        t.steps,
        t.wall
    )
}

/// Prints what was found, without the warning that was printed before the first trial.
fn report(arguments: &Arguments, found: &Found, directory: &Path, told: Option<&String>) -> Outcome {
    if arguments.json {
        print_record(directory, "fos.json")?;
    } else {
        let results = format!("{:<20} {}\n", "results", directory.display());
        let page = format!("{:<20} {}", "page to open", directory.join(PAGE).display());
        let searches =
            found.searches.iter().map(|search| result(search, found, told)).chain(chips(found)).chain(meshes(found));
        let searches = searches.chain(found.seismic.as_ref().map(seismic));
        let page = (!arguments.no_pictures).then_some(page);
        print_line(searches.chain([results]).chain(page).collect::<String>().trim_end());
    }
    if found.meshes.as_ref().is_some_and(|meshes| meshes.is_interrupted) {
        return Ok(fail(&"interrupted; the factors of the meshes so far are kept", INTERRUPTED));
    }
    if found.seismic.as_ref().and_then(|seismic| seismic.found.as_ref()).is_some_and(|k| k.end == End::Interrupted) {
        return Ok(fail(&"interrupted; the trials of the yield acceleration so far are kept", INTERRUPTED));
    }
    let main = found.main();
    let message = remedy(main).unwrap_or_default();
    Ok(match main.end {
        End::Found | End::StableThroughout if main.at_most().is_some() => {
            let doubt = main.doubt().unwrap_or_default();
            fail(&format!("the factor of safety is at most the upper bound of limit analysis: {doubt}"), AT_MOST)
        }
        End::Found => ExitCode::SUCCESS,
        End::StableThroughout => {
            if !arguments.json {
                print_line(&message);
            }
            ExitCode::SUCCESS
        }
        End::Interrupted => fail(&message, INTERRUPTED),
        End::UnstableThroughout | End::Failed(_) => fail(&message, FAILED),
    })
}

/// Results of a search, as lines of a name and a text.
fn result(reduction: &Reduction, found: &Found, before: Option<&String>) -> String {
    let mut lines = vec![String::new()];
    let mut tell = |name: &str, text: String| lines.push(format!("{name:<20} {text}"));
    if let (Some(most), Some(low)) = (reduction.at_most(), reduction.low) {
        tell("factor of safety", format!("at most {most:.4}, an upper bound: trials were stable up to {low:.4}"));
    } else if let (Some(factor), Some(low), Some(high)) = (reduction.factor(), reduction.low, reduction.high) {
        tell("factor of safety", format!("{factor:.4} (stable at {low:.4}, not at {high:.4})"));
    } else if let Some(least) = reduction.at_least() {
        tell("factor of safety", format!("at least {least:.4}"));
    }
    reduction.others().into_iter().for_each(|(name, text)| tell(name, text));
    match (&reduction.bracket, &reduction.bound) {
        (Some(bracket), _) => {
            tell(
                "limit analysis",
                format!(
                    "{} to {}, lower and upper bound where rock dilates by its friction",
                    bracket.lower, bracket.upper
                ),
            );
        }
        (None, Ok(bound)) => {
            tell("limit analysis", bound.summary());
            if let Some(way) = bound.level_tops.way {
                tell("", format!("its mechanism {}", way.words()));
            }
            if bound.softens {
                tell("", DUCTILE.to_owned());
            }
        }
        (None, Err(refused)) => tell("limit analysis", format!("none: {refused}")),
    }
    if let Some(pressed) = reduction.simulation.pressure_in_joints() {
        let at_bound = reduction.bound.as_ref().ok().and_then(|bound| bound.joint_water);
        let beside = at_bound.map_or(String::new(), |bound| format!(", with {bound:.4e} N/m in limit analysis"));
        tell("water in joints", format!("presses with {pressed:.4e} N/m{beside}"));
    }
    if let Some(bolts) = bolts(reduction) {
        tell("bolts", bolts);
    }
    if reduction.trials.iter().any(|trial| trial.verdict == Verdict::Caught) {
        tell("caught", "flowed farther than elasticity explains and came to rest again: not stable".to_owned());
    }
    if let Some(trial) = reduction.first_unstable() {
        tell("mechanism", mechanism(trial, reduction, found));
        let name = |b: &FailingBlock| format!("{} at ({:.2}, {:.2}) m", b.block, b.position.x, b.position.y);
        tell("failing blocks", listed(trial.failing.iter().map(name)));
    }
    let warnings = reduction.warnings.iter().filter(|&warning| before != Some(warning));
    let notes = &reduction.simulation.built().notes;
    if matches!(reduction.end, End::StableThroughout) {
        // They say why nothing fails.
        lines.extend(told::lines(warnings, 0).into_iter().chain(notes.iter().map(|note| format!("note: {note}"))));
    } else {
        lines.extend(told::lines(warnings, notes.len()));
    }
    lines.join("\n") + "\n"
}

/// The factor of the slope beside those of its chips.
fn chips(found: &Found) -> Option<String> {
    let factor = |search: &Reduction| match (search.at_most(), search.factor(), search.at_least()) {
        (Some(most), ..) => format!("at most {most:.4}"),
        (None, Some(factor), _) => format!("{factor:.4}"),
        (None, None, Some(least)) => format!("at least {least:.4}"),
        (None, None, None) => "none".to_owned(),
    };
    let of_chip = |chip: &Reduction| {
        let area = chip.first_unstable().map_or(0.0, Trial::failing_area);
        format!("chip of {area:.1} m² {}", factor(chip))
    };
    let chips: Vec<String> = found.chips().map(of_chip).collect();
    (!chips.is_empty())
        .then(|| format!("\n{:<20} slope {}; {}\n", "altogether", factor(found.main()), chips.join(", ")))
}

/// The factor on each mesh, and the error of that of the case.
fn meshes(found: &Found) -> Option<String> {
    let meshes = found.meshes.as_ref()?;
    let mut lines =
        vec![String::new(), format!("{:<20} {:>10} {:>9}  factor of safety", "meshes", "size (m)", "elements")];
    for on in &meshes.searches {
        let elements = on.counts.map_or_else(String::new, |[elements, _]| elements.to_string());
        let factor = match on.bracket {
            Some([low, high]) => format!("{:.4} (stable at {low:.4}, not at {high:.4})", 0.5 * (low + high)),
            None => on.end.replace('_', " "),
        };
        lines.push(format!("{:<20} {:>10.4} {elements:>9}  {factor}", "", on.size));
    }
    let text = match (meshes.extrapolated(), meshes.error()) {
        (Some([at_zero, within]), Some(error)) => {
            let small = if error.abs() <= within { ", no more than the brackets leave open" } else { "" };
            format!("{error:+.4} of F, which is {at_zero:.4} ± {within:.4} on a mesh of 0 m by a straight line{small}")
        }
        _ => "none: fewer than two factors, or none on the mesh of the case".to_owned(),
    };
    lines.push(format!("{:<20} {text}", "error of the mesh"));
    Some(lines.join("\n") + "\n")
}

/// The yield acceleration, Newmark's block and the run, as lines of a name and a text.
fn seismic(seismic: &Seismic) -> String {
    let mut lines = vec![String::new()];
    let mut tell = |name: &str, text: String| lines.push(format!("{name:<20} {text}"));
    if let Some(found) = &seismic.found {
        tell("yield acceleration", yield_text(found));
        match &found.bound {
            Ok(bound) => tell("limit analysis", format!("ky at most {bound:.4}, where its factor is 1")),
            Err(refused) => tell("limit analysis", format!("none: {refused}")),
        }
        if let Some(trial) = found.failing.as_ref().and_then(|failing| failing.first_unstable()) {
            let way = found.mechanism().map_or_else(String::new, |mechanism| format!(" by {}", mechanism.noun()));
            tell("mechanism", format!("{} blocks{way}: {:.4} m²", trial.failing.len(), trial.failing_area()));
        }
    }
    for block in &seismic.blocks {
        tell(
            "Newmark's block",
            format!(
                "{:.4} m under {} with a peak of {:.3} g, {:.4} m under it reversed",
                block.displacement,
                block.record,
                block.pga / STANDARD_GRAVITY,
                block.reversed
            ),
        );
    }
    if let Some(run) = &seismic.run {
        let slip = run.slip.map_or_else(String::new, |slip| format!(", slip of a joint up to {slip:.4} m"));
        let (stage, summary) = (&run.stage, run.summary.display());
        tell("the run", format!("{:.4} m in stage {stage}{slip} ({summary})", run.displacement));
    }
    lines.extend(seismic.remedy.iter().map(|remedy| format!("note: {remedy}")));
    lines.join("\n") + "\n"
}

/// The coefficient of the yield acceleration with its bracket and side.
fn yield_text(found: &YieldAcceleration) -> String {
    let side = found.direction.name();
    match (found.coefficient(), found.low, found.high) {
        (Some(k), Some(low), Some(high)) => {
            format!("ky = {k:.4}, {:.3} m/s² to the {side} (stands at {low:.4}, not at {high:.4})", k * found.gravity)
        }
        (_, Some(low), _) => format!("ky at least {low:.4} to the {side}"),
        (_, None, Some(high)) => format!("ky below {high:.4} to the {side}"),
        (_, None, None) => "none".to_owned(),
    }
}

/// Greatest force of each bolt, and by which convention.
fn bolts(reduction: &Reduction) -> Option<String> {
    let all = BoltRecord::of(&reduction.simulation);
    let there = all.iter().filter(|bolt| bolt.state != BoltCondition::Absent);
    let mut most = BTreeMap::<u32, &BoltRecord>::new();
    for bolt in there {
        let greatest = most.entry(bolt.bolt).or_insert(bolt);
        *greatest = if bolt.force > greatest.force { bolt } else { *greatest };
    }
    let of = |bolt: &&BoltRecord| {
        let name = bolt.name.clone().unwrap_or_else(|| format!("bolt[{}]", bolt.bolt));
        let share = bolt.utilisation.map_or_else(String::new, |share| format!(", {:.0} % of yield", 100.0 * share));
        let how = bolt.support.map_or("as the rock stretches it", |support| match support {
            Support::Active => "active, at its pretension",
            Support::Passive => "passive, at its yield force",
        });
        format!("{name} {:.1} kN{share} ({how})", bolt.force / 1e3)
    };
    (!most.is_empty()).then(|| listed(most.values().map(of)))
}

/// How much rock fails.
fn mechanism(trial: &Trial, reduction: &Reduction, found: &Found) -> String {
    let blocks = if trial.failing.len() == 1 { "block" } else { "blocks" };
    let way = reduction.mechanism.map_or_else(String::new, |mechanism| format!(" by {}", mechanism.noun()));
    let fate = if trial.verdict == Verdict::Caught { ", caught after sliding" } else { "" };
    let passed = match found.which.least_area {
        _ if found.which.counts(reduction) => "",
        Some(_) => "; passed over, less than --least-area",
        None => "; passed over as a chip, less than 1.5 % of the free rock: --least-area 0 counts it",
    };
    format!(
        "{} {blocks}{way}{fate}: {:.4} m², {:.4e} kg/m, {:.1} % of the free rock{passed}",
        trial.failing.len(),
        trial.failing_area(),
        trial.failing_mass(),
        100.0 * trial.failing_area() / reduction.free_area
    )
}
