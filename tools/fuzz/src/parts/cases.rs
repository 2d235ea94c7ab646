//! Case files with mistakes: read, built, and stepped a few times.

use std::fs;
use std::path::{Path, PathBuf};

use engine::model::{Case, Simulation};
use enmm_io::{LoadedCase, parse_case};
use enmm_run::bound;

use crate::parts::{Act, Outcome, finite};
use crate::random::Random;
use crate::trace::Trace;

/// Where good cases are.
const FOLDERS: [&str; 5] =
    ["examples/cases", "crates/cli/templates", "ffi/capi/tests/cases", "ffi/fmi/tests/cases", "python_tests"];
/// Cells of the mesh over the bounding box above which an input is left out.
const CELLS_MAX: f64 = 2e4;
/// Lines of generated joints above which an input is left out.
const LINES_MAX: f64 = 300.0;
/// Steps of a model.
const STEPS: usize = 4;
/// Blocks up to which the limit analysis is tried as well.
const BOUND_MAX: usize = 30;

/// Replacements of numbers.
const NUMBERS: &str = "0 -0.0 1 -1 0.5 2 1e-3 1e-6 1e-9 1e-12 1e-300 5e-324 1e3 1e6 1e9 1e12 1e15 1e150 1e300 1e308 \
                       nan inf -inf 9223372036854775807 1e999 true";

/// Reads the good cases.
pub fn make() -> Result<Act, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in FOLDERS {
        let entries = fs::read_dir(root.join(folder)).map_err(|error| format!("{folder}: {error}"))?;
        paths.extend(
            entries.flatten().map(|entry| entry.path()).filter(|path| path.extension() == Some("toml".as_ref())),
        );
    }
    paths.sort();
    let read = |path: &PathBuf| fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let good = paths.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let base = root.join("examples/cases");
    Ok(Box::new(move |random, trace| {
        let text = spoilt(&good, random);
        trace.say(|| text.clone());
        attempt(&text, &base, trace)
    }))
}

/// Reads, builds and steps a case.
fn attempt(text: &str, base: &Path, trace: &mut Trace) -> Result<Outcome, String> {
    let loaded = match parse_case(text, "case.toml", base) {
        Ok(loaded) => loaded,
        Err(error) => return told(&error.to_string()).map(|()| Outcome::Done(1)),
    };
    if is_flood(&loaded.case) {
        return Ok(Outcome::Skipped);
    }
    let model = enmm_implicit::simulation(loaded.case.clone());
    trace.say(|| format!("# built: {:?}", model.as_ref().map(|model| model.model().covers.block_count())));
    match model {
        Ok(model) => watched(model, &loaded, trace),
        Err(error) => told(&error.to_string()).map(|()| Outcome::Done(2)),
    }
}

/// Steps a model and reads what hosts and files would see of it.
fn watched(mut model: Simulation, loaded: &LoadedCase, trace: &mut Trace) -> Result<Outcome, String> {
    model.set_serial(true);
    model.validate_stages().map_or_else(|error| told(&error.to_string()), Ok)?;
    let areas: Vec<f64> = model.model().covers.blocks().map(|b| model.model().covers.block_area(b)).collect();
    if let Some(b) = areas.iter().position(|&area| !(area.is_finite() && area > 0.0)) {
        return Err(format!("block {b} has an area of {}", areas[b]));
    }
    if areas.len() <= BOUND_MAX {
        trace.say(|| "# limit analysis".to_owned());
        // Most models have no bound, and say so.
        let _ = bound(loaded);
    }
    let Ok(mut model) = enmm_implicit::simulation(loaded.case.clone()) else {
        return Err("it builds once only".to_owned());
    };
    model.set_serial(true);
    for step in 0..STEPS {
        trace.say(|| format!("# step {step}"));
        let report = match model.advance(true) {
            Ok(report) => report,
            Err(error) => return told(&error.to_string()).map(|()| Outcome::Done(4 + step as u64)),
        };
        let ledger = &report.ledger;
        finite(
            "time, step, energies, unbalanced ratio, penetration and speed",
            &[
                report.time,
                report.dt,
                ledger.kinetic,
                ledger.strain,
                ledger.potential,
                ledger.external_work,
                report.penetration_max,
                report.speed_max,
            ],
        )?;
        let state = model.state();
        let numbers = state.displacement.iter().chain(&state.velocity).flat_map(|v| [v.x, v.y]);
        finite("displacements and velocities", &numbers.collect::<Vec<_>>())?;
    }
    let seen = model.block_states();
    let numbers = seen.iter().flat_map(|b| [b.centroid.x, b.centroid.y, b.velocity.x, b.velocity.y, b.area, b.mass]);
    finite("states of blocks", &numbers.collect::<Vec<_>>())?;
    Ok(Outcome::Done(4 + STEPS as u64))
}

/// A message says something.
fn told(message: &str) -> Result<(), String> {
    if message.trim().len() > 10 { Ok(()) } else { Err(format!("an error that says no more than {message:?}")) }
}

/// Whether the case asks for a mesh or for joints that are too many for a campaign.
fn is_flood(case: &Case) -> bool {
    let points = case.domain.outline.iter().chain(case.domain.islands.iter().flatten());
    let bound = |axis: usize| {
        let values = points.clone().map(move |p| p[axis]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
    };
    let [width, height] = [bound(0), bound(1)].map(|[low, high]| high - low);
    let reach = width.hypot(height);
    let cells = (width / case.mesh.size + 2.0) * (height / case.mesh.size + 2.0) * 2.3;
    let lines = |set: &engine::model::case::JointSet| {
        let pieces = set.trace_length.map_or(1.0, |length| 1.0 + reach / (length + set.gap));
        (1.0 + reach / set.spacing) * pieces
    };
    let lines: f64 = case.joint_sets.iter().map(lines).sum();
    // A model without a bound has no lines either: not a number is a flood.
    !(cells < CELLS_MAX && lines < LINES_MAX)
}

/// One of the good cases with mistakes.
fn spoilt(good: &[String], random: &mut Random) -> String {
    let mut text = good[random.below(good.len())].clone();
    if random.chance(15) {
        return bytes_spoilt(text.into_bytes(), random);
    }
    loop {
        text = match random.below(10) {
            0..=4 => number_changed(&text, random),
            5 => element_cut(&text, random),
            _ => line_changed(&text, good, random),
        };
        if random.chance(45) {
            return text;
        }
    }
}

fn bytes_spoilt(mut bytes: Vec<u8>, random: &mut Random) -> String {
    for _ in 0..=random.below(6) {
        let at = random.below(bytes.len());
        match random.below(4) {
            0 => bytes.truncate(at),
            1 => bytes.insert(at, random.pick(b"\"'[]{}=,.#\n\t\0-+e_9\xff")),
            2 if !bytes.is_empty() => drop(bytes.remove(at)),
            _ if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            _ => (),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Places of numbers: start and end.
fn numbers_in(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let is_part = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'_' | b'+' | b'-');
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let end = at + bytes[at..].iter().take_while(|&&b| is_part(b)).count();
        if text.get(at..end).is_some_and(|token| token.parse::<f64>().is_ok()) {
            found.push((at, end));
        }
        at = end.max(at + 1);
    }
    found
}

fn number_changed(text: &str, random: &mut Random) -> String {
    let places = numbers_in(text);
    let Some(&(start, end)) = places.get(random.below(places.len())) else { return text.to_owned() };
    let old: f64 = text[start..end].parse().unwrap_or_default();
    let scale = random.pick(&[-1.0, 1e-6, 1e-3, 0.1, 0.5, 0.999_999_999, 1.000_000_1, 2.0, 10.0, 1e3, 1e6]);
    let new = match random.below(4) {
        0 => random.pick(&NUMBERS.split(' ').collect::<Vec<_>>()).to_owned(),
        1 => {
            let (start, end) = places[random.below(places.len())];
            text[start..end].to_owned()
        }
        2 => format!("{:?}", old + random.between(-1e-6, 1e-6)),
        _ => format!("{:?}", old * scale),
    };
    format!("{}{new}{}", &text[..start], &text[end..])
}

/// Cuts a piece between two commas or brackets, or doubles it.
fn element_cut(text: &str, random: &mut Random) -> String {
    let marks: Vec<usize> = text.bytes().enumerate().filter(|(_, b)| b",[]".contains(b)).map(|(k, _)| k).collect();
    if marks.len() < 2 {
        return text.to_owned();
    }
    let first = random.below(marks.len() - 1);
    let last = (first + 1 + random.below(4)).min(marks.len() - 1);
    let (start, end) = (marks[first], marks[last]);
    match random.below(3) {
        0 => format!("{}{}{}", &text[..end], &text[start..end], &text[end..]),
        _ => format!("{}{}", &text[..start], &text[end..]),
    }
}

fn line_changed(text: &str, good: &[String], random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let (at, other) = (random.below(lines.len()), random.below(lines.len()));
    let donor: Vec<&str> = good[random.below(good.len())].lines().collect();
    let foreign = donor[random.below(donor.len())];
    let Some(line) = lines.get(at).cloned() else { return foreign.to_owned() };
    let split = |line: &str| line.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()));
    match random.below(8) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(other, line),
        2 => lines.swap(at, other),
        3 => lines.insert(at, foreign.to_owned()),
        4 => {
            let block = random.below(donor.len());
            let end = donor.iter().skip(block + 1).position(|line| line.starts_with('[')).unwrap_or(donor.len());
            lines.extend(donor.iter().skip(block).take(end + 1).map(|&line| line.to_owned()));
        }
        5 => lines.truncate(at),
        _ => match (split(&line), split(foreign), split(&lines[other])) {
            (Some((key, _)), Some((_, value)), _) if random.chance(40) => lines[at] = format!("{key}={value}"),
            (Some((key, _)), _, Some((_, value))) if random.chance(60) => lines[at] = format!("{key}={value}"),
            (Some((_, value)), Some((key, _)), _) => lines[at] = format!("{key}={value}"),
            _ => lines[at] = String::new(),
        },
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_and_names_are_none() {
        let text = "a1 = [-1.5, 2e-3] # x2\nsize=7";
        let found: Vec<&str> = numbers_in(text).into_iter().map(|(start, end)| &text[start..end]).collect();
        assert_eq!(found, ["-1.5", "2e-3", "7"]);
    }
}
