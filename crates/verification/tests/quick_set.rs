//! Claim: the report in `docs/` is that of the code, and the quick set passes but for what the report states as missed.
//!
//! The full set takes minutes, so it does not run with every change. `cargo xtask verify` therefore writes beside the
//! rows of the full set those of the quick form of every quick problem into `docs/verification.json`. Here
//! - the document must follow from the record to the letter, and the record must have every problem with its title,
//!   source and parameters: checked without a run;
//! - the quick set is solved again and compared row by row with its record: names, units, exact values, tolerances,
//!   reasons, verdicts, and computed values to a hundredth of their tolerance (bits may differ between the mathematical
//!   libraries of machines). A change of a problem, of its formula or of the engine shows here;
//! - the full form of some problems, with `ENMM_LONG=1` (`cargo xtask long`) of all, is compared in the same way.

use crate::common::extent::by_extent;
use std::path::{Path, PathBuf};

use enmm_verification::problems::ALL;
use enmm_verification::{ParameterRecord, Record, Request, RowRecord, ToleranceKind, choose, report, solve_all};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

fn committed() -> Record {
    let record = report::read(&docs()).unwrap_or_else(|error| panic!("{error}"));
    record.expect("docs/verification.json: run `cargo xtask verify`")
}

fn solve(quick: bool, only: &[&str]) -> Record {
    let only = only.iter().map(|id| (*id).to_owned()).collect();
    let jobs =
        choose(ALL, &Request { only, quick, ..Request::default() }).unwrap_or_else(|trouble| panic!("{trouble}"));
    Record::of(&solve_all(jobs, 2, |_, _| ()))
}

/// Differences between rows that are computed now and rows of the report.
fn differences(id: &str, now: &[RowRecord], reported: &[RowRecord]) -> Vec<String> {
    let names = |rows: &[RowRecord]| rows.iter().map(|row| row.quantity.clone()).collect::<Vec<_>>();
    if names(now) != names(reported) {
        return vec![format!("{id}: rows {:?}, in the report {:?}", names(now), names(reported))];
    }
    let differs = |(now, then): (&RowRecord, &RowRecord)| {
        let numbers = |row: &RowRecord| [row.exact, row.tolerance];
        let same = numbers(now).iter().zip(numbers(then)).all(|(a, b)| near(*a, b, 0.0))
            && (&now.unit, now.judged, &now.reason, &now.origin)
                == (&then.unit, then.judged, &then.reason, &then.origin)
            && now.pass == then.pass
            && (now.judged == ToleranceKind::Shown || near(now.computed, then.computed, room(then)));
        (!same).then(|| format!("{id}: {now:?}, in the report {then:?}"))
    };
    now.iter().zip(reported).filter_map(differs).collect()
}

/// A hundredth of a row's tolerance, in its unit.
fn room(row: &RowRecord) -> f64 {
    let scale = if row.judged == ToleranceKind::Relative { row.exact.unwrap_or_default().abs() } else { 1.0 };
    0.01 * row.tolerance.unwrap_or_default() * scale
}

fn near(a: Option<f64>, b: Option<f64>, room: f64) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= room + 1e-9 * b.abs(),
        (a, b) => a == b,
    }
}

fn hold(problems: &[String]) {
    assert!(problems.is_empty(), "run `cargo xtask verify` and look at what changed:\n{}", problems.join("\n"));
}

#[test]
fn the_report_has_every_problem_as_the_code_has_it() {
    let record = committed();
    let ids: Vec<&str> = record.problems.iter().map(|p| p.id.as_str()).collect();
    assert_eq!(ids, ALL.iter().map(|p| p.id).collect::<Vec<_>>(), "run `cargo xtask verify`");
    for (problem, stated) in ALL.iter().zip(&record.problems) {
        let head = (stated.title.as_str(), stated.source.as_str(), stated.quick);
        assert_eq!(head, (problem.title, problem.source, problem.quick), "{}: run `cargo xtask verify`", problem.id);
        let parameters: Vec<_> = problem.parameters.iter().map(|p| ParameterRecord::of(p, p.default)).collect();
        assert_eq!(stated.parameters, parameters, "{}: run `cargo xtask verify`", problem.id);
        assert!(stated.trouble.is_some() || !stated.rows.is_empty(), "{} has no row", problem.id);
    }
}

#[test]
fn the_document_and_its_plots_follow_from_the_record() {
    let record = committed();
    let document = std::fs::read_to_string(docs().join(report::DOCUMENT)).expect("docs/verification.md");
    assert!(document == report::document(&record), "docs/verification.md differs: run `cargo xtask verify`");
    let mut shown: Vec<String> = record.problems.iter().flat_map(|p| &p.plots).map(|[_, file]| file.clone()).collect();
    let entries = std::fs::read_dir(docs().join(report::PLOTS)).expect("docs/verification");
    let mut there: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    shown.sort();
    there.sort();
    assert_eq!(there, shown, "run `cargo xtask verify`");
}

#[test]
fn the_record_has_a_row_on_each_line() {
    let text = std::fs::read_to_string(docs().join(report::RECORD)).expect("docs/verification.json");
    assert!(text == report::json(&committed()), "docs/verification.json differs: run `cargo xtask verify`");
    let rows: usize = committed().problems.iter().map(|p| p.rows.len() + p.quick_rows.len()).sum();
    assert_eq!(text.lines().filter(|line| line.contains("\"computed\":")).count(), rows);
}

/// The table of `docs/book/trust.md`: mechanism, problem, value, exact value with its source, difference.
#[test]
fn the_page_on_trust_quotes_the_report() {
    let page = std::fs::read_to_string(docs().join("book/trust.md")).expect("the page");
    let record = committed();
    let mut quoted = 0;
    for line in page.lines() {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [_, id, value, exact, difference] = cells[..] else { continue };
        let Some(problem) = record.problem(id) else { continue };
        let exact = exact.split(',').next().unwrap_or_default();
        let quotes = |row: &RowRecord| {
            let [Some(computed), Some(of_row), Some(error)] = [row.computed, row.exact, row.error] else {
                return false;
            };
            let error = format!("{:.2} %", 100.0 * error);
            (format!("{computed:.4}"), format!("{of_row:.4}"), error) == (value.into(), exact.into(), difference.into())
        };
        assert!(problem.rows.iter().any(quotes), "{line}");
        quoted += 1;
    }
    assert_eq!(quoted, 13, "rows of the table");
    let soil = record.problem("C13").expect("C13").rows.iter().filter_map(|row| row.computed);
    let other = page.lines().find(|line| line.starts_with("| slope in soil of Griffiths")).expect("a row");
    assert!(
        soil.map(|value| format!("| {value:.4} (twenty elements) |")).any(|cell| other.ends_with(&cell)),
        "{other}"
    );
}

#[test]
fn the_quick_set_gives_what_the_report_states() {
    let (record, now) = (committed(), solve(true, &[]));
    let mut problems = Vec::new();
    for problem in &now.problems {
        let stated = record.problem(&problem.id).unwrap_or_else(|| panic!("{} is not in the report", problem.id));
        // A problem without rows in both has its trouble stated there.
        if let Some(trouble) = problem.trouble.as_ref().filter(|_| stated.trouble.is_none()) {
            problems.push(format!("{}: {trouble}", problem.id));
        }
        problems.extend(differences(&problem.id, &problem.rows, &stated.quick_rows));
        let known = |row: &RowRecord| stated.missed().any(|other| other.quantity == row.quantity);
        let missed = problem.missed().filter(|row| !known(row));
        problems.extend(missed.map(|row| format!("{}: {} is missed", problem.id, row.quantity)));
    }
    hold(&problems);
}

/// Problems whose full form runs in CI, for their quick form leaves out much of the claim: ten turns, meshes fine
/// enough for limits and orders, all ratios of toppling blocks.
const ALWAYS: &[&str] = &["A3", "B1", "B2", "B3", "C1", "C6"];

#[test]
fn long_the_full_set_gives_what_the_report_states() {
    let (record, now) = (committed(), solve(false, by_extent([&ALWAYS[..1], ALWAYS, &[]])));
    let stated = |id: &str| record.problem(id).unwrap_or_else(|| panic!("{id} is not in the report"));
    let of =
        |problem: &enmm_verification::ProblemRecord| differences(&problem.id, &problem.rows, &stated(&problem.id).rows);
    hold(&now.problems.iter().flat_map(of).collect::<Vec<_>>());
}
