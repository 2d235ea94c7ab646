//! Claim: a report holds what its folder holds and says what is missing; all its numbers are those of the records; it
//! shows text as text; a folder without results, or with a broken one, is an error with a remedy.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use enmm_report::paper::{Converter, REPORT, Records, RecordsError, report_html, write_report};
use serde_json::{Value, json};

use crate::json::numbers;

fn input() -> Value {
    json!({
        "report": { "project": "Quarry <North>", "author": "R. Ock & Co", "date": "2026-11-25" },
        "section": { "azimuth_deg": 75.0 },
        "gravity": { "x": 0.0, "y": -9.81 },
        "rocks": { "gneiss": { "density": 2650.0, "young": 20e9, "poisson": 0.25, "cohesion": null } },
        "joint_laws": { "fault": { "kind": "mohr_coulomb", "friction_deg": 32.5, "cohesion": 40e3, "tension": 0.0 } },
        "joint_sets": [{ "name": "bedding", "dip_deg": 20.0, "dips": "right", "spacing": 4.0, "seed": 1 }],
        "joints": [{ "law": "fault", "count": 2, "length": 25.1234 }],
        "water": { "level": null, "table": [[0.0, 0.0], [40.0, 6.0]], "density": 1000.0, "joints": true },
        "in_situ": null,
        "bolts": [{
            "name": "row_1", "points": [[2.5, 4.9], [20.2, 1.8]], "length": 18.0, "anchorage": "ends",
            "spacing": 2.0, "area": 5e-4, "pretension": 100e3, "yield_force": 250e3
        }],
        "loads": [], "base_motions": [], "random": [],
        "stages": [{ "name": "gravity", "kind": "static", "install": [] }],
        "case_text": "title = \"a < b\"\n"
    })
}

fn fos() -> Value {
    json!({
        "title": "Bench slope", "version": "0.1.0", "case_file": "slope.toml", "case_hash": "0123456789abcdef",
        "settings": [], "factor_of_safety": 1.44288, "at_least": null,
        "bracket": { "stable": 1.44108, "unstable": 1.44468 },
        "failing": { "verdict": "caught", "blocks": 8, "area": 94.605, "mass": 250703.4, "share": 0.14412 },
        "bound": { "level_tops": { "factor": 1.6254, "end": "found", "limit": 1.6254 }, "warnings": [], "notes": [] },
        "trials": [{ "factor": 1.0, "verdict": "stable", "displacement": 3.78e-5, "failing_blocks": 0,
                     "failing_area": 0.0 }],
        "bolts": [
            { "bolt": 0, "force": 211400.0, "utilisation": 0.8456, "state": "elastic" },
            { "bolt": 0, "force": 105.0, "utilisation": 0.00042, "state": "elastic" }
        ],
        "mechanisms": [],
        "warnings": ["the energy ledger of a trial is open"], "notes": [],
        "input": input()
    })
}

fn folder_with(files: &[(&str, &Value)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, value) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("made");
        fs::write(path, value.to_string()).expect("written");
    }
    folder
}

fn html(folder: &Path) -> String {
    report_html(&Records::read(folder).expect("records"))
}

#[test]
fn every_number_of_the_tables_is_one_of_the_record() {
    let folder = folder_with(&[("fos.json", &fos())]);
    let html = html(folder.path());
    let mut known = Vec::new();
    numbers(&fos(), &mut known);
    let shown: Vec<f64> = html.split("<data value=\"").skip(1).map(number).collect();
    assert!(shown.len() > 30, "{}", shown.len());
    for value in shown {
        assert!(known.contains(&value), "{value}");
    }
    for (value, text) in [
        ("1.44288", "1.44"),
        ("94.605", "94.6"),
        ("250703.4", "251"),
        ("0.8456", "84.6"),
        ("40000", "40"),
        ("32.5", "32.5"),
    ] {
        assert!(html.contains(&format!("<data value=\"{value}\">{text}</data>")), "{value}");
    }
    // The largest tension along the bolt alone is shown.
    assert!(!html.contains("0.00042"));
}

/// A run in which a block broke, and another one is near to it.
#[test]
fn breaks_of_blocks_are_listed_with_what_their_sections_carried() {
    let section = json!({
        "block": 3, "ends": [[13.0, 10.0], [13.0, 14.0]], "length": 4.0, "share": 1.0132, "failure": "bends",
        "normal": 218_600.0, "shear": -774_912.0, "moment": -2.1503e6
    });
    let mut broken = section.clone();
    broken["time"] = json!(0.07582);
    broken["stage"] = json!(1);
    broken["part"] = json!(12);
    let mut near = section;
    near["failure"] = json!("splits");
    near["share"] = json!(0.5627);
    near["block"] = json!(41);
    let mut run = fos();
    run["status"] = json!("finished");
    run["breaks"] = json!([broken]);
    run["worst_sections"] = json!([near]);
    let folder = folder_with(&[("summary.json", &run)]);
    let shown = html(folder.path());
    let part =
        |title: &str| shown.split(&format!("<h3>{title}</h3>")).nth(1).and_then(|rest| rest.split("<h3>").next());
    let breaks = part("Blocks that broke").expect("a part");
    for number in [
        "0.07582\">0.0758",
        "3\">3",
        "12\">12",
        "13\">13.0",
        "14\">14.0",
        "1.0132\">1.01",
        "218600\">219",
        "-774912\">−775",
        "-2150300\">−2.15",
    ] {
        assert!(breaks.contains(&format!("<data value=\"{number}</data>")), "{number} in {breaks}");
    }
    assert!(breaks.contains("bending"), "{breaks}");
    let nearest = part("Blocks nearest to breaking at the end of the run").expect("a part");
    assert!(
        nearest.contains("its core") && nearest.contains("0.5627\">0.563") && nearest.contains(">41<"),
        "{nearest}"
    );
    run["breaks"] = Value::Null;
    let folder = folder_with(&[("summary.json", &run)]);
    assert!(!html(folder.path()).contains("Blocks that broke"));
}

fn number(text: &str) -> f64 {
    text.split('"').next().expect("a value").parse().expect("a number")
}

#[test]
fn names_are_text_and_the_words_of_the_method_are_not_used() {
    let folder = folder_with(&[("fos.json", &fos())]);
    let html = html(folder.path());
    assert!(html.contains("Quarry &lt;North&gt;") && html.contains("R. Ock &amp; Co") && html.contains("a &lt; b"));
    assert!(html.contains("the energy balance of a trial is open"));
    let words: Vec<String> =
        html.split(|c: char| !c.is_alphabetic()).map(str::to_lowercase).filter(|word| !word.is_empty()).collect();
    for word in ["cover", "covers", "star", "stars", "ledger"] {
        assert!(!words.iter().any(|own| own == word), "{word}");
    }
    assert!(!words.windows(2).any(|pair| pair[0] == "level" && pair[1] == "tops"));
    assert!(!html.contains("<script") && !html.replace("http-equiv", "").contains("http"), "no program and no network");
}

#[test]
fn what_is_not_there_is_named() {
    let folder = folder_with(&[("fos/fos.json", &fos())]);
    let html = html(folder.path());
    for line in ["enmm run was not run", "enmm sample was not run", "Picture failure.svg: it was not drawn"] {
        assert!(html.contains(line), "{line}");
    }
    assert!(!html.contains("the case has no table [section]"));
}

#[test]
fn results_of_different_cases_are_told_apart() {
    let mut run = fos();
    run["case_hash"] = json!("fedcba9876543210");
    run["status"] = json!("finished");
    let folder = folder_with(&[("summary.json", &run), ("fos.json", &fos())]);
    assert!(html(folder.path()).contains("another version of the case (fingerprint 0123456789abcdef)"));
}

/// A report goes to others: a link in a folder of a stranger put any file of the reader into it.
#[cfg(unix)]
#[test]
fn a_report_reads_no_links_pipes_devices_or_other_files_as_pictures() {
    let folder = folder_with(&[("fos/fos.json", &fos())]);
    let place = |name: &str| folder.path().join(name);
    fs::write(place("secret"), "<svg >SECRET</svg>").expect("written");
    let pipe = || std::process::Command::new("mkfifo").arg(place("fos/fos.svg")).status().expect("mkfifo runs");
    std::os::unix::fs::symlink("../secret", place("fos/failure.svg")).expect("linked");
    assert!(pipe().success());
    let shown = html(folder.path());
    for told in ["failure.svg is left out: it is a link", "fos.svg is left out: it is a directory, a pipe or a device"]
    {
        assert!(shown.contains(told), "{told}");
    }
    fs::remove_file(place("fos/failure.svg")).expect("removed");
    fs::write(place("fos/failure.svg"), "root:x:0:0").expect("written");
    let shown = html(folder.path());
    assert!(shown.contains("failure.svg is left out: it is no picture") && !shown.contains("base64"));
    fs::rename(place("fos"), place("elsewhere")).expect("renamed");
    std::os::unix::fs::symlink("elsewhere", place("fos")).expect("linked");
    assert!(matches!(Records::read(folder.path()), Err(RecordsError::Link(_))));
    fs::remove_file(place("fos")).expect("removed");
    std::os::unix::fs::symlink("elsewhere/fos.json", place("fos.json")).expect("linked");
    assert!(matches!(Records::read(folder.path()), Err(RecordsError::Unreadable { .. })));
}

#[test]
fn pictures_are_part_of_the_file() {
    let folder = folder_with(&[("fos.json", &fos())]);
    fs::write(folder.path().join("failure.svg"), "<svg xmlns=\"x\"/>").expect("written");
    let records = Records::read(folder.path()).expect("records");
    let path = write_report(folder.path(), &records).expect("written");
    assert_eq!(path, folder.path().join(REPORT));
    let html = fs::read_to_string(path).expect("text");
    assert!(html.contains("src=\"data:image/svg+xml;base64,PHN2ZyB4bWxucz0ieCIvPg==\""));
}

#[test]
fn folders_without_results_and_broken_records_are_errors() {
    let empty = folder_with(&[]);
    let message = |folder: &Path| Records::read(folder).expect_err("no records").to_string();
    assert!(message(empty.path()).contains("fos.json (enmm fos)"));
    assert!(matches!(Records::read(&empty.path().join("none")), Err(RecordsError::NoFolder(_))));
    for text in ["{", "[1]", "\"text\""] {
        fs::write(empty.path().join("fos.json"), text).expect("written");
        assert!(message(empty.path()).contains("run the command that wrote it again"), "{text}");
    }
    // Records of other types than expected are shown as far as they go.
    fs::write(empty.path().join("fos.json"), "{\"trials\": 3, \"input\": [], \"warnings\": {\"a\": 1}}")
        .expect("written");
    assert!(html(empty.path()).contains("did not record it"));
}

/// A program that makes no PDF leaves none, and nothing else.
#[cfg(unix)]
#[test]
fn a_converter_that_fails_leaves_nothing() {
    let folder = folder_with(&[("fos.json", &fos())]);
    let page = write_report(folder.path(), &Records::read(folder.path()).expect("records")).expect("written");
    let before = fs::read_dir(folder.path()).expect("a folder").count();
    for program in ["/bin/true", "/bin/false", "/does/not/exist"] {
        let pdf = folder.path().join("out.pdf");
        let error = Converter::named(Path::new(program))
            .convert(&page, &pdf, &AtomicBool::new(false))
            .expect_err("no PDF")
            .to_string();
        assert!(error.contains(program), "{error}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), before);
    }
}

/// Rock by Hoek–Brown, energies of fracture, supports and drawdowns were added after the tables of input.
#[test]
fn no_strength_of_the_input_is_left_out() {
    let mut record = fos();
    let input = &mut record["input"];
    input["rocks"]["gneiss"]["hoek_brown"] = json!({ "sigma_ci": 30e6, "mi": 7.5, "gsi": 45.0, "d": 0.7 });
    input["joint_laws"]["fault"]["tension_energy"] = json!(51.0);
    input["joint_laws"]["fault"]["shear_energy"] = json!(502.0);
    input["bolts"][0]["support"] = json!("passive");
    input["stages"][0]["water"] = json!({ "level": 3.25, "table": null });
    let folder = folder_with(&[("fos.json", &record)]);
    let html = html(folder.path());
    for part in ["<data value=\"30000000\">30</data>", "45", "7.5", "0.7", "51", "502", "passive", "3.25"] {
        assert!(html.contains(part), "{part}");
    }
    for head in ["Hoek–Brown σci", "GSI", "Energy of fracture, slip", "Support", "Water in later stages"] {
        assert!(html.contains(head), "{head}");
    }
}

/// The record of a run of a slope that an earthquake has shaken.
fn quake() -> Value {
    json!({
        "title": "Shaken", "version": "0.1.0", "case_file": "slope.toml", "case_hash": "0123456789abcdef",
        "settings": [], "status": "finished", "failed": false,
        "verdict": "the slope has not failed: largest displacement 0.0383 m in stage quake",
        "stages": [{ "name": "quake", "kind": "dynamic", "time": 12.0, "converged": null, "failure": null }],
        "permanent": [{
            "stage": "quake", "displacement": 0.03829, "block": 3, "place": [50.66, 25.54],
            "joints": [{ "joint": "joint[0]", "slip": 0.03837, "place": [47.88, 22.52] }],
            "monitors": [{ "name": "crest", "place": [71.0, 49.5], "displacement": [-0.03098, -0.02187] }],
            "laws": [
                { "law": "bedding", "slip": 0.03837, "place": [47.88, 22.52] },
                { "law": "cross", "slip": 0.00412, "place": [63.11, 35.07] }
            ]
        }],
        "earthquakes": [{
            "stages": ["quake"], "time": [1.2, 13.2], "interval": 0.0051,
            "motions": [
                { "name": "quiet[0]", "of": "outcrop", "axis": "x", "pga": 3.3551, "pga_g": 0.34212, "pgv": 0.2013,
                  "pgd": 0.05541, "arias": 1.2077, "duration": 7.3312 },
                { "name": "crest", "of": "monitor", "axis": "y", "pga": 5.1277, "pga_g": 0.52288, "pgv": 0.2919,
                  "pgd": 0.12013, "arias": 2.6044, "duration": 6.9907 }
            ]
        }],
        "model": { "blocks": 11, "area": 4500.0, "mesh_size": 1.5 },
        "bolts": [], "warnings": [], "notes": [], "input": input()
    })
}

#[test]
fn the_first_page_begins_with_the_verdict_and_has_what_an_earthquake_left() {
    let folder = folder_with(&[("summary.json", &quake()), ("fos.json", &fos())]);
    let html = html(folder.path());
    let first = html.split("</header>").next().expect("a first page");
    let places = ["Verdict", "the slope has not failed", "F after the stage", "joint[0]", "crest", "Date"];
    let at = places.map(|text| first.find(text).unwrap_or_else(|| panic!("{text} is not on the first page")));
    assert!(at.is_sorted(), "{at:?}");
    for number in ["0.03829", "0.03837", "-0.03098", "-0.02187"] {
        assert!(first.contains(&format!("<data value=\"{number}\">")), "{number}");
    }
    assert!(first.contains("F after the stage</th><td>gravity</td>"), "the record names none: the last static stage");
}

#[test]
fn an_earthquake_has_a_chapter_with_its_motions_and_what_slipped() {
    let html = html(folder_with(&[("summary.json", &quake())]).path());
    let chapter = html.split("<h2>Earthquake</h2>").nth(1).and_then(|rest| rest.split("</section>").next());
    let chapter = chapter.expect("a chapter");
    let places = ["quiet[0], outcrop", "crest", "3.3551", "0.52288", "2.6044", "Joint law", "bedding", "cross"];
    let at = places.map(|text| chapter.find(text).unwrap_or_else(|| panic!("{text} is not in the chapter")));
    assert!(at.is_sorted(), "{at:?}");
    assert!(chapter.contains("<data value=\"0.00412\">4.12</data>"), "slip in millimetres");
    let mut known = Vec::new();
    numbers(&quake(), &mut known);
    for value in chapter.split("<data value=\"").skip(1).map(number) {
        assert!(known.contains(&value), "{value}");
    }
}

#[test]
fn a_yield_acceleration_stands_beside_newmarks_block_and_the_run() {
    let mut record = fos();
    record["seismic"] = json!({
        "yield_coefficient": 0.1234, "bracket": { "stable": 0.1231, "unstable": 0.1237 }, "bound": 0.1249,
        "direction": "left", "failing": { "mechanism": "slides" },
        "newmark": [{ "record": "quiet[0]", "pga_g": 0.342, "displacement": 0.0261, "displacement_reversed": 0.0557 }],
        "run": { "displacement": 0.0363 }
    });
    let html = html(folder_with(&[("fos.json", &record)]).path());
    let chapter = html.split("<h2>Earthquake</h2>").nth(1).and_then(|rest| rest.split("</section>").next());
    let chapter = chapter.expect("a chapter");
    for text in ["0.1234", "0.1249", ">left<", ">slides<", "0.0261", "0.0557", "0.0363"] {
        assert!(chapter.contains(text), "{text} is not in the chapter");
    }
}

#[test]
fn a_report_of_a_slope_that_nothing_shook_has_no_earthquake() {
    assert!(!html(folder_with(&[("fos.json", &fos())]).path()).contains("Earthquake"));
}

#[test]
fn a_stage_that_failed_is_named_with_its_mechanism() {
    let mut run = quake();
    run["stages"][0] = json!({
        "name": "gravity", "kind": "static", "time": 7.8, "converged": false, "ended_early": true,
        "failure": { "mechanism": "toppling" }
    });
    let html = html(folder_with(&[("summary.json", &run)]).path());
    assert!(html.contains("FAILED by toppling, ended early"));
}

/// A sweep that `enmm sweep` has made of one key.
fn swept() -> Value {
    let sample = |angle: f64, factor: f64, status: &str| {
        let values = json!({ "joint_law.fault.friction_deg": angle });
        json!({ "values": values, "level_tops": factor, "status": status })
    };
    json!({
        "title": "Bench slope", "version": "0.1.0", "case_file": "slope.toml", "case_hash": "0123456789abcdef",
        "settings": [], "kind": "curve", "output": "level_tops", "limit": 1.0,
        "keys": [{ "key": "joint_law.fault.friction_deg", "values": [20.0, 30.0, 40.0] }],
        "samples": [sample(20.0, 0.8123, "found"), sample(30.0, 1.2345, "found"), sample(40.0, 1000.0, "at_least")],
        "crossings": [{ "value": 24.4457, "between": [20.0, 30.0] }],
        "without_answer": [], "doubtful": [], "input": input()
    })
}

#[test]
fn a_sweep_has_a_chapter_with_its_picture_crossings_and_samples() {
    let folder = folder_with(&[("fos.json", &fos()), ("sweep/sweep.json", &swept())]);
    fs::write(folder.path().join("sweep/sweep.svg"), "<svg xmlns=\"x\"/>").expect("written");
    let shown = html(folder.path());
    let chapter = shown.split("<h2>Sweep of values</h2>").nth(1).and_then(|rest| rest.split("<h2>").next());
    let chapter = chapter.expect("a chapter");
    for number in ["0.8123\">0.812", "1.2345\">1.23", "24.4457\">24.4457", "30\">30"] {
        assert!(chapter.contains(&format!("<data value=\"{number}</data>")), "{number} in {chapter}");
    }
    assert!(chapter.contains("at least") && chapter.contains("<figure>") && chapter.contains("an upper bound"));
    let first = shown.split("</header>").next().expect("a first page");
    assert!(first.contains("joint_law.fault.friction_deg = <data value=\"24.4457\">24.4</data>"), "{first}");
    let mut known = Vec::new();
    [fos(), swept()].iter().for_each(|record| numbers(record, &mut known));
    assert!(shown.split("<data value=\"").skip(1).map(number).all(|value| known.contains(&value)));
}

#[test]
fn a_sweep_of_changes_one_by_one_has_their_effects() {
    let mut record = swept();
    record["kind"] = json!("tornado");
    record["crossings"] = Value::Null;
    record["of_the_case"] = json!(1.1111);
    record["effects"] = json!([{ "key": "angle", "outputs": [[20.0, 0.8123], [30.0, 1.2345]], "range": 0.4222 }]);
    let shown = html(folder_with(&[("sweep.json", &record)]).path());
    for part in ["1.1111\">1.11", "0.4222\">0.422", "Each key alone, the greatest effect first"] {
        assert!(shown.contains(part), "{part}");
    }
    assert!(!shown.contains("F passes the limit at") && !shown.contains("Nowhere among these values"));
}
