//! First page, warnings, and what is missing.

use serde_json::Value;

use super::number::{Digits, mass, percent, plain};
use super::parts::{chapter, entries, part, text, texts};
use super::records::{Record, Records};
use super::results::{factor_cell, limit_factor, permanent_motions, stage_of_factor};
use super::sweep::first_crossing;
use super::table::{Cell, facts, list, paragraph, text_html};

/// Project, author, date, version and the main results.
pub fn title_page(records: &Records) -> String {
    let Some(first) = records.all().next() else { return String::new() };
    let notes = records.with_input().map_or(&Value::Null, |record| &record.json["input"]["report"]);
    let title = text(&first.json["title"]);
    let project = Some(text(&notes["project"])).filter(|project| !project.is_empty());
    let note = |key: &str| match text(&notes[key]) {
        "" => Cell::Empty,
        note => Cell::from(note),
    };
    let rows = [
        ("Model", if project.is_some() { Cell::from(title) } else { Cell::Empty }),
        ("Number", note("number")),
        ("Client", note("client")),
        ("Author", note("author")),
        ("Date", note("date")),
        ("Program", Cell::from(format!("enmm {}", text(&first.json["version"])))),
        ("Case file", Cell::from(text(&first.json["case_file"]))),
        ("Fingerprint of the case", Cell::from(text(&first.json["case_hash"]))),
        ("Values set on the command line", settings(&first.json)),
        ("Remarks", note("remarks")),
    ];
    format!(
        "<header>\n<div class=\"title\">\n<h1>{}</h1>\n<p class=\"what\">Stability of a jointed rock slope: input and \
         results</p>\n</div>\n{}{}</header>\n",
        text_html(project.unwrap_or(title)),
        main_results(records),
        facts(&rows)
    )
}

fn settings(json: &Value) -> Cell {
    let settings: Vec<&str> = entries(&json["settings"]).iter().filter_map(Value::as_str).collect();
    if settings.is_empty() { Cell::Empty } else { Cell::from(settings.join(", ")) }
}

/// The results that a reader looks for first, in a frame.
fn main_results(records: &Records) -> String {
    let mut rows: Vec<(&str, Cell)> = Vec::new();
    if let Some(run) = &records.run {
        rows.push(("Verdict", Cell::from(run_words(&run.json))));
    }
    if let Some(fos) = &records.fos {
        let failing = &fos.json["failing"];
        rows.push(("Factor of safety F", factor_cell(&fos.json)));
        rows.push((
            "F on a mesh of 0 m, by a straight line",
            plain(&fos.json["meshes"]["extrapolated"], "", Digits::Three).into(),
        ));
        rows.push(("Error of the mesh in F", plain(&fos.json["meshes"]["mesh_error"], "", Digits::Three).into()));
        rows.push(("F where corners hold", plain(&fos.json["factor_corners_hold"], "", Digits::Three).into()));
        rows.push(("F after the stage", stage_of_factor(&fos.json)));
        rows.push(("Area that fails", plain(&failing["area"], "m²", Digits::Three).into()));
        rows.push(("Mass that fails", mass(&failing["mass"]).into()));
        rows.push(("Upper bound by limit analysis", limit_factor(&fos.json["bound"])));
    }
    if let Some(bound) = records.bound.as_ref().filter(|_| records.fos.is_none()) {
        rows.push(("Upper bound by limit analysis", limit_factor(&bound.json["bound"])));
        rows.push(("F after the stage", stage_of_factor(&bound.json)));
    }
    if let Some(ensemble) = &records.ensemble {
        rows.push(("Probability of failure", percent(&ensemble.json["probability_of_failure"]).into()));
    }
    if let Some(sweep) = &records.sweep {
        rows.push(("F passes the limit at", first_crossing(&sweep.json)));
    }
    let motions = records.run.as_ref().map_or(String::new(), |run| permanent_motions(&run.json));
    format!("<div class=\"result\">\n{}{motions}</div>\n", facts(&rows))
}

/// The verdict of a run; of a version without verdicts, how it ended.
fn run_words(json: &Value) -> String {
    let verdict = text(&json["verdict"]);
    if !verdict.is_empty() {
        return verdict.to_owned();
    }
    let moving: Vec<&str> = entries(&json["stages"])
        .iter()
        .filter(|stage| stage["converged"] == Value::Bool(false))
        .map(|stage| text(&stage["name"]))
        .collect();
    match text(&json["status"]) {
        "finished" if moving.is_empty() => "finished".to_owned(),
        "finished" => format!("finished; not at rest at the end of {}", moving.join(", ")),
        status => status.to_owned(),
    }
}

/// Warnings and notes of all records, each once.
pub fn warnings(records: &Records) -> String {
    let mut all: [Vec<String>; 2] = [Vec::new(), Vec::new()];
    let mut add = |kind: usize, messages: Vec<String>| {
        for message in messages {
            if !all[kind].contains(&message) {
                all[kind].push(message);
            }
        }
    };
    add(0, differences(records));
    for record in records.all() {
        for place in [&record.json, &record.json["bound"]] {
            add(0, texts(&place["warnings"]));
            add(1, texts(&place["notes"]));
        }
        add(0, texts(&Value::from_iter([record.json["doubt"].clone(), record.json["remedy"].clone()])));
        let failure = text(&record.json["failure"]["cause"]);
        add(0, if failure.is_empty() { Vec::new() } else { vec![format!("the run failed: {failure}")] });
        for key in ["without_answer", "doubtful"] {
            let count = entries(&record.json[key]).len();
            let what = if key == "doubtful" { "a doubtful factor" } else { "no answer" };
            add(0, if count > 0 { vec![format!("samples with {what}: {count}")] } else { Vec::new() });
        }
    }
    let [warnings, notes] = all;
    let none = if warnings.is_empty() { paragraph("The program gave no warnings.") } else { String::new() };
    let head = format!("Notes ({})", notes.len());
    let notes = part(&head, &list(&notes));
    chapter("Warnings", &format!("{none}<div class=\"warnings\">\n{}{notes}</div>\n", list(&warnings)))
}

/// Records that belong to other versions of the case than the first.
fn differences(records: &Records) -> Vec<String> {
    let hash = |record: &Record| text(&record.json["case_hash"]).to_owned();
    let Some(first) = records.all().next() else { return Vec::new() };
    let others = records.all().filter(|record| hash(record) != hash(first));
    others
        .map(|record| {
            format!(
                "{} is the result of another version of the case (fingerprint {}) than {} ({}): the tables of input \
                 hold for the latter",
                record.name,
                hash(record),
                first.name,
                hash(first)
            )
        })
        .collect()
}

/// What the report could hold and does not.
pub fn missing(records: &Records) -> String {
    let mut lines = Vec::new();
    let commands = [
        (&records.run, "Stages, displacements, stresses and histories", "enmm run"),
        (&records.fos, "Factor of safety by strength reduction", "enmm fos"),
        (&records.ensemble, "Probability of failure", "enmm sample"),
        (&records.sweep, "Factor over values of keys", "enmm sweep"),
    ];
    for (record, what, command) in commands {
        if record.is_none() {
            lines.push(format!("{what}: {command} was not run in this folder."));
        }
    }
    if records.fos.is_none() && records.bound.is_none() {
        lines.push("Factor by limit analysis: neither enmm bound nor enmm fos was run in this folder.".to_owned());
    }
    match records.with_input() {
        None => {
            lines.push("Input: the results are of a version that did not record it; run the case again.".to_owned())
        }
        Some(record) => {
            if record.json["input"]["section"].is_null() {
                lines.push("Azimuth of the section: the case has no table [section].".to_owned());
            }
            let notes = record.json["input"]["report"].as_object();
            if notes.is_none_or(|notes| notes.is_empty()) {
                lines.push("Project, author, client and date: the case has no table [report].".to_owned());
            }
        }
    }
    let pictures = [
        (&records.run, "model"),
        (&records.fos, "failure"),
        (&records.ensemble, "ensemble"),
        (&records.sweep, "sweep"),
    ];
    for (record, name) in pictures {
        if record.as_ref().is_some_and(|record| matches!(record.picture(name), Ok(None))) {
            lines.push(format!("Picture {name}.svg: it was not drawn."));
        }
    }
    chapter("Not in this report", &list(&lines))
}
