//! The manual: `verification.md`, the same as data in `verification.json`, and the plots in `verification/`.
//!
//! The document follows from the record alone and holds no wall times, so that it changes only when the numbers do.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use enmm_io::files::{at_path, write_atomic};

use crate::record::{ParameterRecord, ProblemRecord, Record, RowRecord, ToleranceKind};
use crate::{Solved, lines, plot, text};

/// Name of the document.
pub const DOCUMENT: &str = "verification.md";
/// Name of the record.
pub const RECORD: &str = "verification.json";
/// Folder of the plots.
pub const PLOTS: &str = "verification";
/// Levels of the record that are indented: record, problems, problem, and the lists of rows, parameters and plots.
const INDENTED: usize = 4;
/// Columns of running text.
const COLUMNS: usize = 110;

/// Writes document, record and plots into a directory; returns the paths.
///
/// # Errors
/// When the file system refuses it.
pub fn write(record: &Record, solved: &[Solved], directory: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = vec![directory.join(DOCUMENT), directory.join(RECORD)];
    let plots = directory.join(PLOTS);
    std::fs::create_dir_all(&plots).map_err(at_path(&plots))?;
    write_atomic(&paths[0], document(record).as_bytes())?;
    write_atomic(&paths[1], json(record).as_bytes())?;
    for solved in solved {
        let drawn = solved.outcome.iter().flat_map(|outcome| &outcome.plots);
        for (k, plot) in drawn.enumerate() {
            let path = plots.join(plot::file_name(solved.job.problem.id, k));
            write_atomic(&path, plot::picture(plot).svg().as_bytes())?;
            paths.push(path);
        }
    }
    Ok(paths)
}

/// Removes plots of an earlier report that this one does not show.
///
/// # Errors
/// When the file system refuses it.
pub fn remove_stale_plots(record: &Record, directory: &Path) -> io::Result<()> {
    let folder = directory.join(PLOTS);
    let Ok(entries) = std::fs::read_dir(&folder) else { return Ok(()) };
    let shown = |name: &str| record.problems.iter().flat_map(|p| &p.plots).any(|[_, file]| file == name);
    for entry in entries {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.ends_with(".svg") && !shown(&name) {
            std::fs::remove_file(&path).map_err(at_path(&path))?;
        }
    }
    Ok(())
}

/// Reads the record of a report; none if there is no file.
///
/// # Errors
/// A file that cannot be read or is no record.
pub fn read(directory: &Path) -> io::Result<Option<Record>> {
    let path = directory.join(RECORD);
    if !path.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(&path).map_err(at_path(&path))?;
    serde_json::from_str(&text).map(Some).map_err(io::Error::other).map_err(at_path(&path))
}

/// The record as text, one row, parameter or plot per line.
pub fn json(record: &Record) -> String {
    lines::json(record, INDENTED)
}

/// Misses of `now` that `before` does not state: problems without rows, rows that fail.
pub fn new_misses(now: &Record, before: &Record) -> Vec<String> {
    let mut found = Vec::new();
    for problem in &now.problems {
        let known = before.problem(&problem.id);
        if let Some(trouble) = problem.trouble.as_ref().filter(|_| known.is_none_or(|k| k.trouble.is_none())) {
            found.push(format!("{}: {trouble}", problem.id));
        }
        let stated = |row: &RowRecord| known.is_some_and(|k| k.missed().any(|other| other.quantity == row.quantity));
        found.extend(problem.missed().filter(|row| !stated(row)).map(|row| missed_line(problem, row)));
    }
    found
}

/// The document.
pub fn document(record: &Record) -> String {
    let mut out = String::from("# Verification\n\n");
    let rows = || record.problems.iter().flat_map(|p| &p.rows);
    let judged = rows().filter(|row| row.judged != ToleranceKind::Shown).count();
    let passed = record.problems.iter().filter(|p| p.passed).count();
    let total = record.problems.len();
    paragraph(
        &mut out,
        &format!(
            "Problems with known answers, solved by `enmm verify`: {passed} of {total} problems pass, with {judged} \
             values judged. This document, `verification.json` beside it (the same numbers for programs) and the plots \
             are written by `cargo xtask verify`; do not edit them. Other values of the parameters are solved with \
             `enmm verify --only ID --set NAME=VALUE`, and the models behind a problem are written as case files with \
             `enmm verify --only ID --write DIR`."
        ),
    );
    paragraph(
        &mut out,
        "An error is relative to the exact value unless it has a unit. A tolerance is derived, for the reason whose \
         number it cites; a value outside its tolerance is **MISSED**. Exact values are closed forms evaluated with \
         the problem's parameters unless marked as published or numerical. `shown only` marks values for comparison.",
    );
    missed_section(&mut out, record);
    contents(&mut out, record);
    for problem in &record.problems {
        section(&mut out, problem);
    }
    out
}

fn paragraph(out: &mut String, text: &str) {
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(out, "{}\n", text::wrapped(text, COLUMNS));
}

fn missed_section(out: &mut String, record: &Record) {
    let mut lines: Vec<String> = Vec::new();
    for problem in &record.problems {
        lines.extend(problem.trouble.iter().map(|trouble| format!("{}: {trouble}", problem.id)));
        lines.extend(problem.missed().map(|row| missed_line(problem, row)));
    }
    if lines.is_empty() {
        return;
    }
    out.push_str("## Missed\n\n");
    for line in lines {
        let _ = writeln!(out, "- {}", text::wrapped(&format!("**MISSED** {line}"), COLUMNS).replace('\n', "\n  "));
    }
    out.push('\n');
}

fn missed_line(problem: &ProblemRecord, row: &RowRecord) -> String {
    let [computed, exact] = [row.computed, row.exact].map(|value| text::quantity(value, &row.unit));
    let (error, tolerance) = (text::error(row), text::tolerance(row));
    format!("{}, {}: {computed}, should be {exact}; error {error}, tolerance {tolerance}", problem.id, row.quantity)
}

fn contents(out: &mut String, record: &Record) {
    out.push_str("## Contents\n\n| | problem | worst error | of tolerance | verdict |\n|---|---|---|---|---|\n");
    for problem in &record.problems {
        let link = format!("[{}](#{})", problem.id, anchor(problem));
        let worst = problem.worst();
        let error = worst.map_or_else(|| "–".to_owned(), |row| format!("{} ({})", text::error(row), row.quantity));
        let share = worst.and_then(RowRecord::share).filter(|share| share.is_finite());
        let share = share.map_or_else(|| "–".to_owned(), |share| format!("{} %", text::number(100.0 * share, 2)));
        let verdict = if problem.passed { "pass" } else { "**MISSED**" };
        let _ = writeln!(out, "| {link} | {} | {} | {share} | {verdict} |", cell(&problem.title), cell(&error));
    }
    out.push('\n');
}

/// The anchor that Markdown makes of a section's head.
fn anchor(problem: &ProblemRecord) -> String {
    let kept = |c: &char| c.is_alphanumeric() || *c == ' ' || *c == '-' || *c == '_';
    head(problem).to_lowercase().chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
}

fn head(problem: &ProblemRecord) -> String {
    format!("{} {}", problem.id, problem.title)
}

fn section(out: &mut String, problem: &ProblemRecord) {
    let _ = writeln!(out, "## {}\n", head(problem));
    paragraph(out, &problem.source);
    parameter_table(out, &problem.parameters);
    if let Some(trouble) = &problem.trouble {
        paragraph(out, &format!("**MISSED**: no result, because: {trouble}"));
    }
    if !problem.rows.is_empty() {
        row_table(out, &problem.rows);
    }
    for [title, file] in &problem.plots {
        let _ = writeln!(out, "![{}]({PLOTS}/{file})\n", title.replace(['[', ']'], ""));
    }
}

fn parameter_table(out: &mut String, parameters: &[ParameterRecord]) {
    if parameters.is_empty() {
        return;
    }
    out.push_str("| parameter | value | range | |\n|---|---|---|---|\n");
    for p in parameters {
        let value = text::quantity(Some(p.value), &p.unit);
        let changed = if p.value == p.default { String::new() } else { format!(" (default {})", p.default) };
        let [low, high] = p.range.map(|limit| text::number(limit, 7));
        let _ = writeln!(out, "| `{}` | {}{changed} | {low} to {high} | {} |", p.name, cell(&value), cell(&p.doc));
    }
    out.push('\n');
}

/// The rows of a problem, and below them why their tolerances are what they are: each reason once, under a number that
/// the rows cite.
fn row_table(out: &mut String, rows: &[RowRecord]) {
    let mut reasons: Vec<&str> = Vec::new();
    out.push_str("| quantity | computed | exact | error | tolerance | verdict |\n|---|---|---|---|---|---|\n");
    for row in rows {
        if !row.reason.is_empty() && !reasons.contains(&row.reason.as_str()) {
            reasons.push(&row.reason);
        }
        let number = reasons.iter().position(|reason| *reason == row.reason);
        out.push_str(&row_line(row, number.map_or_else(String::new, |k| format!(" ({})", k + 1))));
    }
    out.push('\n');
    let numbered = reasons.iter().enumerate().map(|(k, reason)| format!("({}) {reason}", k + 1)).collect::<Vec<_>>();
    if !numbered.is_empty() {
        paragraph(out, &format!("Tolerances: {}.", numbered.join("; ")));
    }
}

/// A row of the table; `mark` cites the reason of its tolerance.
fn row_line(row: &RowRecord, mark: String) -> String {
    let [computed, exact] = [row.computed, row.exact].map(|value| text::quantity(value, &row.unit));
    let exact = if row.origin == "closed form" { exact } else { format!("{exact} ({})", row.origin) };
    let verdict = match text::verdict(row) {
        "MISSED" => "**MISSED**",
        other => other,
    };
    let tolerance = text::tolerance(row) + &mark;
    let cells = [&row.quantity, &computed, &exact, &text::error(row), &tolerance].map(|text| cell(text));
    format!("| {} | {verdict} |\n", cells.join(" | "))
}

/// A text that may stand in a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
