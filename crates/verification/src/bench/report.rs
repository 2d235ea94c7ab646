//! Writes what was timed: `results.md`, `results.json` and two plots of cost against size.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use super::survey;
use super::{BenchReport, Machine, Measured, Model};
use enmm_io::files::{at_path, write_atomic};
use enmm_picture::{Chart, ChartSeries, chart_picture};

/// Origin of a set of results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// Commit and date, or whatever tells one set of results from another.
    pub label: String,
    /// Command that made it.
    pub command: String,
}

impl Origin {
    /// Results of a program with these words; the command is without their label and without their folder.
    pub fn of(label: &str, program: &str, mut words: impl Iterator<Item = String>) -> Self {
        let mut command = program.to_owned();
        while let Some(word) = words.next() {
            if ["--output", "--label"].contains(&word.as_str()) {
                words.next();
            } else {
                command.extend([" ", &word]);
            }
        }
        Self { label: label.to_owned(), command }
    }
}

/// Files of a report: data, page, and the plots of steps and of slopes.
pub const REPORT_FILES: [&str; 4] = ["results.json", "results.md", "step.svg", "slope.svg"];

/// Writes results into a directory, which is made if it is not there.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_report(report: &BenchReport, origin: &Origin, directory: &Path) -> io::Result<()> {
    std::fs::create_dir_all(directory).map_err(at_path(directory))?;
    let json = serde_json::json!({ "label": origin.label, "command": origin.command, "report": report });
    let write = |name: &str, text: &str| write_atomic(&directory.join(name), text.as_bytes());
    let [data, page, steps, slopes] = REPORT_FILES;
    write(data, &format!("{json:#}\n"))?;
    write(page, &markdown(report, origin))?;
    write(steps, &chart_picture(&step_chart(report)).svg())?;
    write(slopes, &chart_picture(&slope_chart(report)).svg())
}

/// The results as a page.
pub fn markdown(report: &BenchReport, origin: &Origin) -> String {
    let mut text = String::from("# What standard models cost\n\n");
    let _ = writeln!(text, "{}; enmm {}, threads for the models: {}.\n", origin.label, report.version, report.threads);
    let _ = writeln!(text, "    {}\n\n{INTRODUCTION}\n", origin.command);
    push_machine(&mut text, &report.machine);
    push_table(&mut text, "Steps", &STEP_HEAD, report.models.iter().map(step_row));
    push_table(&mut text, "Stages (ms per step)", &STAGE_HEAD, report.models.iter().map(stage_row));
    push_table(&mut text, "Build, memory and output", &BUILD_HEAD, report.models.iter().map(build_row));
    let continua = report.models.iter().filter_map(continuum_row);
    push_table(&mut text, "Elements beside others (million updates per second)", &survey::ELEMENT_HEAD, continua);
    let slopes = report.models.iter().filter_map(slope_row);
    push_table(&mut text, "Slopes beside others (seconds per simulated second)", &survey::SLOPE_HEAD, slopes);
    let _ = writeln!(text, "{}\n\n![cost of a step](step.svg)\n\n![cost of a second](slope.svg)", survey::SOURCE);
    text
}

const INTRODUCTION: &str = "A model is built, brought to a state (at rest, or in motion), and timed in windows of \
steps that all start\nfrom that state; each step counts with its quickest time, which other programs on the machine \
hardly touch. Elements of\nheld rock, which no step touches, are not counted. Windows of slopes lie where they take up \
gravity; their first\nsecond, with `--first-second`, is wall time from the model as built.";

const STEP_HEAD: [&str; 12] = [
    "model",
    "blocks",
    "elements",
    "contacts",
    "ms per step",
    "s per simulated s",
    "sweeps",
    "M contact × sweeps/s",
    "M elements/s of the stage",
    "of the whole step",
    "share of bandwidth",
    "share of FMA",
];
const STAGE_HEAD: [&str; 9] =
    ["model", "search", "elements", "entrance", "sweep", "commit", "rest", "searches per step", "ms per search"];
const BUILD_HEAD: [&str; 11] = [
    "model",
    "built in s",
    "peak MB",
    "fixed bytes per element",
    "state",
    "buffers",
    "bytes per contact",
    "moved bytes per element",
    "operations per element",
    "frame ms",
    "checkpoint ms",
];

/// Appends the line of the machine and its limits.
pub fn push_machine(text: &mut String, machine: &Machine) {
    let processor = machine.processor.as_deref().unwrap_or("unknown processor");
    let _ = writeln!(text, "Machine: {processor}, {} cores, {}.\n", machine.cores, machine.caches.join(", "));
    let level = |name: String, unit: &str, one: f64, all: f64| {
        vec![name, format!("{:.0} {unit}", one / 1e9), format!("{:.0} {unit}", all / 1e9)]
    };
    let bandwidth = machine.bandwidth.iter().map(|found| {
        level(format!("triad, {} ({} KB)", found.level, found.bytes / 1024), "GB/s", found.one, found.all)
    });
    let peak = machine.multiply_add.map(|[one, all]| level("multiply and add".to_owned(), "GFLOP/s", one, all));
    push_table(text, "Limits, measured in the same run", &["limit", "one thread", "all"], bandwidth.chain(peak));
}

/// Appends a table under a heading; nothing where it has no rows.
pub fn push_table(text: &mut String, title: &str, head: &[&str], rows: impl Iterator<Item = Vec<String>>) {
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(text, "## {title}\n\n| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()));
    text.extend(rows.iter().map(|row| format!("| {} |\n", row.join(" | "))));
    text.push('\n');
}

fn step_row(found: &Measured) -> Vec<String> {
    let millions = |rate: f64| digits(rate / 1e6);
    let share = |share: Option<f64>| share.map_or_else(none, |share| format!("{:.0} %", 100.0 * share));
    vec![
        found.model.clone(),
        found.blocks.to_string(),
        found.elements.to_string(),
        found.contacts.to_string(),
        digits(found.ms_per_step),
        digits(found.seconds_per_simulated_second),
        digits(found.sweeps_mean),
        found.contact_sweeps_per_second.map_or_else(none, millions),
        millions(found.elements_per_second),
        millions(found.step_elements_per_second),
        share(found.share_of_bandwidth),
        share(found.share_of_operations),
    ]
}

fn stage_row(found: &Measured) -> Vec<String> {
    let of_step = |ms: f64| format!("{} ({:.0} %)", digits(ms), 100.0 * ms / found.ms_per_step);
    let mut row = vec![found.model.clone()];
    row.extend(found.stages.named().map(|(_, ms)| of_step(ms)));
    row.push(digits(found.searches as f64 / found.steps as f64));
    row.push(found.ms_per_search.map_or_else(none, digits));
    row
}

fn build_row(found: &Measured) -> Vec<String> {
    let per_element = |bytes: usize| format!("{:.0}", bytes as f64 / (found.elements + found.held_elements) as f64);
    vec![
        found.model.clone(),
        digits(found.build_seconds),
        found.memory_peak.map_or_else(none, |peak| digits(peak as f64 / 1e6)),
        per_element(found.heap_bytes[0]),
        per_element(found.heap_bytes[1]),
        per_element(found.heap_bytes[2]),
        found.bytes_per_contact.map_or_else(none, digits),
        digits(found.bytes_per_element),
        digits(found.operations_per_element),
        digits(found.frame_ms),
        digits(found.checkpoint_ms),
    ]
}

fn continuum_row(found: &Measured) -> Option<Vec<String>> {
    let others = survey::element_rates(&Model::parse(&found.model)?)?;
    let mut row = vec![found.model.clone(), digits(found.elements_per_second / 1e6)];
    row.extend(others.map(digits));
    Some(row)
}

fn slope_row(found: &Measured) -> Option<Vec<String>> {
    let others = survey::slope_seconds(&Model::parse(&found.model)?)?;
    let mut row = vec![found.model.clone(), found.first_second.map_or_else(none, digits)];
    row.push(digits(found.seconds_per_simulated_second));
    row.extend(others.iter().map(|seconds| seconds.map_or_else(none, digits)));
    Some(row)
}

/// Milliseconds per step over elements.
fn step_chart(report: &BenchReport) -> Chart {
    let point = |found: &Measured| [found.elements as f64, found.ms_per_step];
    let series = families(report, &[("continuum", None), ("4 elements a block", Some(4)), ("16", Some(16))], point);
    Chart {
        title: "Cost of a step".to_owned(),
        axes: ["elements".to_owned(), "ms per step".to_owned()],
        logarithmic: [true; 2],
        series,
    }
}

/// Seconds per simulated second over blocks, beside others: of the first second where that was run.
fn slope_chart(report: &BenchReport) -> Chart {
    let seconds = |found: &Measured| found.first_second.unwrap_or(found.seconds_per_simulated_second);
    let point = |found: &Measured| [found.blocks as f64, seconds(found)];
    let mut series =
        families(report, &[("enmm, 4 elements a block", Some(4)), ("enmm, 16 elements a block", Some(16))], point);
    series.extend(survey::slope_lines().map(|(name, points)| ChartSeries { name, points, marks: false }));
    Chart {
        title: "Cost of a simulated second of a sliding slope".to_owned(),
        axes: ["blocks".to_owned(), "s per simulated s".to_owned()],
        logarithmic: [true; 2],
        series,
    }
}

/// A line for each family of models: continua, or slopes of so many elements a block.
fn families(
    report: &BenchReport,
    wanted: &[(&str, Option<usize>)],
    point: impl Fn(&Measured) -> [f64; 2],
) -> Vec<ChartSeries> {
    let line = |&(name, each): &(&str, Option<usize>)| {
        let is_of = |found: &&Measured| match Model::parse(&found.model) {
            Some(Model::Continuum(_)) => each.is_none(),
            Some(Model::Slope(_, elements)) => each == Some(elements),
            _ => false,
        };
        let mut points: Vec<[f64; 2]> = report.models.iter().filter(is_of).map(&point).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ChartSeries { name: name.to_owned(), points, marks: false }
    };
    wanted.iter().map(line).filter(|series| !series.points.is_empty()).collect()
}

/// A number in three digits.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    let decimals =
        if size >= 100.0 || size == 0.0 { 0 } else { (2 - size.log10().floor() as i32).clamp(0, 6) as usize };
    format!("{value:.decimals$}")
}

/// The cell of a figure that is not there.
pub fn none() -> String {
    "–".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!([1234.5, 12.345, 1.0, 0.012_345, 0.0].map(digits), ["1234", "12.3", "1.00", "0.0123", "0"]);
    }

    #[test]
    fn tables_name_what_was_timed() {
        let found = Measured { model: "slope_500x4".to_owned(), blocks: 503, ..Measured::default() };
        let continuum = Measured { model: "continuum_10000".to_owned(), ..Measured::default() };
        let report = BenchReport { version: "1".to_owned(), models: vec![found, continuum], ..BenchReport::default() };
        let text = markdown(&report, &Origin { label: "today".to_owned(), command: "enmm bench".to_owned() });
        assert!(
            text.contains("| slope_500x4 | 503 |")
                && text.contains("today; enmm 1,")
                && text.contains("\n    enmm bench\n"),
            "{text}"
        );
        assert!(text.contains("## Slopes beside others") && text.contains("## Elements beside others"), "{text}");
        let wide = |line: &&str| line.chars().count() > 120 && !line.starts_with('|');
        assert_eq!(text.lines().find(wide), None);
    }
}
