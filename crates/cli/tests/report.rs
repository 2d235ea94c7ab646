//! Claim: `enmm report` prints what lies in a folder of results; all its numbers stand in the records there; the table
//! `[report]` changes neither the fingerprint of a case nor its results.

use std::fs;
use std::path::Path;

use crate::json::numbers;
use crate::support::{Place, incline, json};

const NOTES: &str = "[report]\nproject = \"Quarry North\"\nauthor = \"R. Ock\"\n[section]\nazimuth_deg = 75\n";

/// The text of the tables without the numbers of records and without heads: what digits it has are names.
fn words_of_cells(html: &str) -> String {
    let cells = html.split("<td").skip(1).filter_map(|cell| cell.split_once('>')?.1.split("</td>").next());
    let without = |cell: &str| {
        let parts = cell.split("<data").enumerate();
        let words = parts.map(|(k, part)| if k == 0 { part } else { part.split("</data>").nth(1).unwrap_or_default() });
        words.collect::<String>()
    };
    cells.map(without).collect::<Vec<_>>().join("\n")
}

#[test]
fn all_results_of_a_case_are_printed_with_the_numbers_of_their_records() {
    let place = Place::with(&incline(0.65, NOTES));
    let wide = ["fos", "case.toml", "--low", "0.5", "--high", "3"];
    for arguments in [&["run", "case.toml"][..], &wide, &["bound", "case.toml"]] {
        place.answers(0, arguments);
    }
    let answer = place.answers(0, &["report", "case", "--no-pdf"]);
    assert!(answer.stdout.contains("report_a4.html"), "{answer:?}");
    let html = fs::read_to_string(place.path("case/report_a4.html")).expect("the report");
    let mut known = Vec::new();
    for name in ["case/summary.json", "case/fos/fos.json", "case/bound/bound.json"] {
        numbers(&json(&place.path(name)), &mut known);
    }
    let shown: Vec<&str> = html.split("<data value=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(shown.len() > 60, "{}", shown.len());
    for value in shown {
        assert!(known.contains(&value.parse().expect("a number")), "{value}");
    }
    // Texts of the record with numbers: its fingerprint, and the verdict in one line.
    let text = |key: &str| json(&place.path("case/summary.json"))[key].as_str().expect("a text").to_owned();
    let words = words_of_cells(&html).replace(&text("case_hash"), "").replace(&text("verdict"), "");
    let words = words.replace(&format!("enmm {}", env!("CARGO_PKG_VERSION")), "");
    let stray: Vec<&str> = words.lines().filter(|line| line.contains(|c: char| c.is_ascii_digit())).collect();
    assert!(stray.is_empty(), "numbers that are none of a record: {stray:?}");
    for text in
        ["Quarry North", "Factor of safety F", "Limit analysis", "Case file", "Probability of failure: enmm sample"]
    {
        assert!(html.contains(text), "{text}");
    }
    let letters: Vec<String> = html.split(|c: char| !c.is_alphabetic()).map(str::to_lowercase).collect();
    assert!(!letters.iter().any(|word| ["cover", "covers", "star", "stars", "ledger"].contains(&word.as_str())));
    assert_eq!(html.matches("<img").count(), pictures(&place.path("case")), "all pictures that a report shows");
}

/// Pictures in a folder of a run and its search that a report shows.
fn pictures(folder: &Path) -> usize {
    let names = |folder: &Path| -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        entries.map(|name| name.to_string_lossy().into_owned()).filter(|name| name.ends_with(".svg")).collect()
    };
    let shown = names(folder).into_iter().chain(names(&folder.join("fos"))).filter(|name| name != "deformed.svg");
    shown.count()
}

#[test]
fn the_notes_of_a_report_are_no_part_of_the_case() {
    let [with, without] = [NOTES, ""].map(|notes| Place::with(&incline(0.65, notes)));
    let bound = |place: &Place| {
        place.answers(0, &["bound", "case.toml"]);
        json(&place.path("case/bound/bound.json"))
    };
    let [with, without] = [&with, &without].map(bound);
    assert_eq!(with["case_hash"], without["case_hash"]);
    assert_eq!(with["bound"], without["bound"]);
    assert_eq!(with["input"]["report"]["author"], "R. Ock");
    assert_eq!(without["input"]["report"], serde_json::json!({}));
}

#[test]
fn notes_that_say_nothing_and_folders_without_results_are_refused() {
    let place = Place::with(&incline(0.65, "[report]\nauthor = \" \"\n"));
    place.enmm(&["bound", "case.toml"]).assert_bad_input(&["report.author: is empty, must say something"]);
    let place = Place::with(&incline(0.65, ""));
    place.enmm(&["report", "nowhere"]).assert_bad_input(&["nowhere is no directory"]);
    place.enmm(&["report", "."]).assert_bad_input(&["holds no results", "fos.json (enmm fos)", "with -o ."]);
}

/// A converter that is not there leaves the page, and says what to do.
#[test]
fn a_converter_that_does_not_start_is_named() {
    let place = Place::with(&incline(0.65, ""));
    place.answers(0, &["bound", "case.toml"]);
    let answer = place.answers(3, &["report", "case", "--converter", "no_such_program"]);
    assert!(answer.stderr.contains("no_such_program"), "{answer:?}");
    assert!(place.path("case/report_a4.html").is_file() && !place.path("case/report_a4.pdf").exists());
}

/// Notes mode and names of its profile, and waits or writes a PDF.
#[cfg(unix)]
fn browser(place: &Place, name: &str, end: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let script = format!(
        "#!/bin/sh\nfor a; do case $a in --user-data-dir=*) stat -c %a \"${{a#*=}}\" > mode;; \
         --print-to-pdf=*) pdf=${{a#*=}};; esac; done\n{end}\n"
    );
    fs::write(place.path(name), script).expect("written");
    fs::set_permissions(place.path(name), fs::Permissions::from_mode(0o755)).expect("executable");
    place.path(name).display().to_string()
}

/// The profile lay at a place that other users could foresee and make, and stayed when the program was killed.
#[cfg(unix)]
#[test]
fn the_profile_of_the_browser_is_private_and_goes_away() {
    use std::process::Command;
    let place = Place::with(&incline(0.65, ""));
    place.answers(0, &["bound", "case.toml"]);
    fs::create_dir_all(place.path("tmp/enmm_browser.99999999-left")).expect("made");
    fs::create_dir_all(place.path("tmp/enmm_browser.notes")).expect("made");
    let report = |converter: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_enmm"));
        command.args(["report", "case", "--converter", converter]).current_dir(place.path("."));
        command.env("TMPDIR", place.path("tmp"));
        command
    };
    let printed = report(&browser(&place, "prints", "printf %%PDF- > $pdf")).status().expect("the program runs");
    assert!(printed.success() && place.path("case/report_a4.pdf").is_file());
    assert_eq!(fs::read_to_string(place.path("mode")).expect("noted").trim(), "700");
    assert_eq!(place.names_in("tmp"), ["enmm_browser.notes"], "a folder of another name stays");
    fs::remove_file(place.path("mode")).expect("removed");
    let mut waiting = report(&browser(&place, "waits", "exec sleep 100")).spawn().expect("the program runs");
    while !place.path("mode").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(Command::new("kill").arg(waiting.id().to_string()).status().expect("kill runs").success());
    assert_eq!(waiting.wait().expect("an end").code(), Some(130));
    assert_eq!(place.names_in("tmp"), ["enmm_browser.notes"]);
    assert!(!place.names_in("case").iter().any(|name| name.ends_with(".tmp")), "{:?}", place.names_in("case"));
}
