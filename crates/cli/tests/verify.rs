//! Claim: `enmm verify` prints computed beside exact values, as a table or as JSON, writes cases that run, and exits
//! with 0 when all pass, 1 when one does not, 2 when a request names nothing that exists.

use crate::support::{Place, case};

fn place() -> Place {
    Place::with(&case(0.02))
}

#[test]
fn a_problem_shows_as_a_table_with_its_verdict() {
    let answer = place().answers(0, &["verify", "--only", "D5", "--quick"]);
    for part in
        ["D5  Drop on a spring", "m = 2500 kg/m", "computed", "exact", "tolerance", "pass", "1 passed, 0 failed"]
    {
        assert!(answer.stdout.contains(part), "{part:?} is not in {}", answer.stdout);
    }
}

#[test]
fn json_is_one_object_with_rows_and_parameters() {
    let object = place().answers(0, &["verify", "--only", "D5", "--quick", "--json", "--set", "D5.H=0.3"]).json();
    assert_eq!(object["passed"], true);
    let problem = &object["problems"][0];
    assert_eq!(problem["id"], "D5");
    let height = problem["parameters"].as_array().expect("parameters").iter().find(|p| p["name"] == "H");
    assert_eq!(height.expect("H")["value"], 0.3);
    assert!(problem["wall"].as_f64().expect("seconds") > 0.0);
    let row = &problem["rows"][0];
    // √(2·9.81·0.3)
    assert!((row["exact"].as_f64().expect("a number") - 2.426_108).abs() < 1e-6, "{row}");
    for key in ["computed", "error", "tolerance"] {
        assert!(row[key].is_number(), "{key} of {row}");
    }
    for key in ["quantity", "reason", "origin", "judged"] {
        assert!(row[key].as_str().is_some_and(|text| !text.is_empty()), "{key} of {row}");
    }
    assert_eq!(row["pass"], true);
}

#[test]
fn the_list_names_problems_parameters_and_ranges_and_runs_nothing() {
    let answer = place().enmm(&["verify", "--list"]);
    assert_eq!(answer.status, Some(0));
    for part in ["C6 ", "D5 ", "k_low", "from 0.05 to", "quick"] {
        assert!(answer.stdout.contains(part), "{part:?} is not in {}", answer.stdout);
    }
    let object = place().enmm(&["verify", "--list", "--json", "--only", "D"]).json();
    let problems = object["problems"].as_array().expect("problems");
    assert!(problems.iter().all(|p| p["id"].as_str().is_some_and(|id| id.starts_with('D'))), "{object}");
}

#[test]
fn cases_and_report_are_written_and_the_cases_run() {
    let place = place();
    place.answers(0, &["verify", "--only", "D5", "--quick", "--write", "cases", "-o", "report"]);
    assert!(place.path("report/verification/d5-1.svg").exists());
    assert!(std::fs::read_to_string(place.path("report/verification.md")).expect("a report").contains("## D5 Drop"));
    place.answers(0, &["run", "cases/d5/default_step.toml", "-o", "results", "--quiet"]);
}

#[test]
fn a_problem_that_does_not_pass_exits_with_1() {
    // Blocks nearly as wide as tan a are refused by the problem itself: it has no rows, so it fails.
    let answer = place().answers(1, &["verify", "--only", "C6", "--quick", "--set", "k=0.57"]);
    assert!(answer.stdout.contains("FAILED") && answer.stdout.contains("0 passed, 1 failed: C6"), "{answer:?}");
}

#[test]
fn wrong_arguments_exit_with_2_and_name_the_remedy() {
    let place = place();
    let refuse = |arguments: &[&str], parts: &[&str]| place.enmm(arguments).assert_bad_input(parts);
    refuse(&["verify", "--only", "D9"], &["\"D9\"", "nearest is C9"]);
    refuse(&["verify", "--only", "D5", "--set", "height=1"], &["\"height\"", "m, k, H, omega_dt"]);
    refuse(&["verify", "--only", "D5", "--set", "H=100"], &["H is 100 m", "from 0.05 to 5"]);
    refuse(&["verify", "--only", "D5", "--set", "H"], &["NAME=VALUE"]);
    refuse(&["verify", "--only", "D5", "-o", "case.toml/x"], &["case.toml/x", "another directory"]);
    place.answers(2, &["verify", "--integrator", "magic"]);
    assert_eq!(place.names(), ["case.toml"]);
}

#[test]
fn an_output_name_that_is_taken_by_a_folder_is_found_before_the_work() {
    let place = place();
    for (command, name) in [
        (&["verify", "--only", "D5", "--quick", "-o", "out"][..], "out/verification.json"),
        (&["bench", "--models", "continuum_200", "--seconds", "0.1", "-o", "out"], "out/step.svg"),
    ] {
        std::fs::create_dir_all(place.path(name)).expect("a folder");
        let answer = place.enmm(command);
        answer.assert_bad_input(&[name, "no regular file"]);
        assert_eq!(answer.stdout, "", "{answer:?}");
        std::fs::remove_dir(place.path(name)).expect("removed");
    }
    std::fs::write(place.path("out/verification"), "").expect("a file");
    place.enmm(&["verify", "--only", "D5", "--quick", "-o", "out"]).assert_bad_input(&["out/verification"]);
}
