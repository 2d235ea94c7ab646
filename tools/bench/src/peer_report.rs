//! Writes how long programs took beside each other: `peers.md` and `peers.json`.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use super::peers::{Compared, PeerReport, Timed};
use enmm_io::files::{at_path, write_atomic};
use enmm_picture::counted;
use enmm_verification::bench::{Origin, digits, none, push_machine, push_table};

const INTRODUCTION: &str = "\
Every program simulates the same polygons of blocks from the same first instant, on one thread, turn by turn in rounds
with the others; who is first changes from round to round. Times are of the steps without building the model: wall time,
or the processor's time of the thread where that is less; a pass over elements counts with its quickest time. The ratio
is that of one round: how many times as long as enmm a program took. A step is a substep where steps have
them. Way is the mean displacement of the centroids of the blocks; overlaps are those of the polygons of the corners,
after the last step, in parts of the mesh size.";

const SLOPE_HEAD: [&str; 12] = [
    "model",
    "program",
    "blocks",
    "elements",
    "contacts",
    "s per simulated s",
    "steps per simulated s",
    "ms per step",
    "times enmm",
    "way (m)",
    "mean overlap (% of mesh size)",
    "greatest",
];
const ELEMENT_HEAD: [&str; 5] = ["model", "program", "elements", "M updates/s", "times enmm"];

/// Writes what was compared into a directory, which is made if it is not there.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_peers(report: &PeerReport, origin: &Origin, directory: &Path) -> io::Result<()> {
    std::fs::create_dir_all(directory).map_err(at_path(directory))?;
    let json = serde_json::json!({ "label": origin.label, "command": origin.command, "report": report });
    write_atomic(&directory.join("peers.json"), format!("{json:#}\n").as_bytes())?;
    write_atomic(&directory.join("peers.md"), peers_markdown(report, origin).as_bytes())
}

/// The comparison as a page.
pub fn peers_markdown(report: &PeerReport, origin: &Origin) -> String {
    let mut text = String::from("# enmm beside other programs\n\n");
    let rounds = counted(report.rounds, "round");
    let _ = writeln!(text, "{}; enmm {}, {rounds}.\n", origin.label, report.version);
    let _ = writeln!(text, "    {}\n\n{INTRODUCTION}\n", origin.command);
    push_machine(&mut text, &report.machine);
    let rows = |row: fn(&Compared, &Timed) -> Vec<String>, of_slopes: bool| {
        let models = report.models.iter().filter(move |compared| compared.size.is_some() == of_slopes);
        models.flat_map(move |compared| compared.programs.iter().map(move |timed| row(compared, timed)))
    };
    let title = format!("Sliding slopes, the first {} s of motion", report.duration);
    push_table(&mut text, &title, &SLOPE_HEAD, rows(slope_row, true));
    push_table(&mut text, "Elements alone", &ELEMENT_HEAD, rows(element_row, false));
    push_table(&mut text, "Settings", &["program", "settings"], settings(report).into_iter());
    push_table(&mut text, "Left out", &["what and why"], report.left_out.iter().map(|line| vec![line.clone()]));
    text
}

fn slope_row(compared: &Compared, timed: &Timed) -> Vec<String> {
    let count = |count: Option<usize>| count.map_or_else(none, |count| count.to_string());
    let size = compared.size.unwrap_or(f64::NAN);
    let outcome = timed.outcome;
    let share = |length: f64| digits(100.0 * length / size);
    vec![
        compared.model.clone(),
        timed.program.clone(),
        count(outcome.map(|outcome| outcome.blocks)),
        count(timed.elements),
        count(timed.contacts),
        digits(timed.median()),
        timed.steps.map_or_else(none, digits),
        timed.steps.map_or_else(none, |steps| digits(1e3 * timed.median() / steps)),
        ratio(compared, timed),
        outcome.map_or_else(none, |outcome| digits(outcome.way)),
        outcome.map_or_else(none, |outcome| share(outcome.overlap_mean)),
        outcome.map_or_else(none, |outcome| share(outcome.overlap_max)),
    ]
}

fn element_row(compared: &Compared, timed: &Timed) -> Vec<String> {
    let elements = timed.elements.map_or_else(none, |count| count.to_string());
    let rate = digits(1.0 / timed.median());
    vec![compared.model.clone(), timed.program.clone(), elements, rate, ratio(compared, timed)]
}

/// Median and range of the ratios to this program, which is the first.
fn ratio(compared: &Compared, timed: &Timed) -> String {
    match &compared.programs[..] {
        [own, ..] if own != timed => {
            let [least, middle, most] = timed.ratios(own).map(digits);
            format!("**{middle}** ({least}–{most})")
        }
        _ => none(),
    }
}

/// Each program with its settings, once.
fn settings(report: &PeerReport) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for timed in report.models.iter().flat_map(|compared| &compared.programs) {
        let row = vec![timed.program.clone(), timed.settings.clone()];
        if !found.contains(&row) {
            found.push(row);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Outcome;

    #[test]
    fn tables_follow_from_stored_times() {
        let timed = |program: &str, seconds: [f64; 3], elements, outcome| Timed {
            program: program.to_owned(),
            settings: format!("settings of {program}"),
            seconds: seconds.into(),
            elements,
            contacts: Some(7),
            steps: Some(1000.0),
            outcome,
        };
        let outcome = Outcome { blocks: 500, way: 0.93, overlap_mean: 0.001, overlap_max: 0.02 };
        let slope = Compared {
            model: "slope_500x4".to_owned(),
            size: Some(2.0),
            programs: vec![
                timed("enmm 1", [1.0, 2.0, 4.0], Some(2022), Some(outcome)),
                timed("box 2", [3.0, 4.0, 20.0], None, Some(outcome)),
            ],
        };
        let continuum = Compared {
            model: "continuum_10000".to_owned(),
            size: None,
            programs: vec![timed("enmm 1", [0.0025; 3], Some(9999), None)],
        };
        let models = vec![slope, continuum];
        let left_out = vec!["third: why".to_owned()];
        let report = PeerReport { rounds: 3, duration: 1.0, models, left_out, ..PeerReport::default() };
        let text = peers_markdown(&report, &Origin { label: "today".to_owned(), command: "enmm bench".to_owned() });
        for line in [
            "| slope_500x4 | enmm 1 | 500 | 2022 | 7 | 2.00 | 1000 | 2.00 | – | 0.930 | 0.0500 | 1.00 |",
            "| slope_500x4 | box 2 | 500 | – | 7 | 4.00 | 1000 | 4.00 | **3.00** (2.00–5.00) | 0.930 | 0.0500 | 1.00 |",
            "| continuum_10000 | enmm 1 | 9999 | 400 | – |",
            "| enmm 1 | settings of enmm 1 |",
            "| third: why |",
        ] {
            assert!(text.lines().any(|found| found == line), "{line} in {text}");
        }
        let wide = |line: &&str| line.chars().count() > 120 && !line.starts_with('|');
        assert_eq!(text.lines().find(wide), None);
    }
}
