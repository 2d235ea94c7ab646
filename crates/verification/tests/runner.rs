//! Claim: problems are chosen and set as requested or refused with a remedy, solved in order, and one that fails or
//! panics shows as failed and takes no other with it.

use enmm::model::case::Integrator;
use enmm_verification::{
    Job, Outcome, Parameter, Problem, ProblemRecord, Record, Request, Row, Setup, Tolerance, Trouble, choose, report,
    solve_all, text, write_cases,
};

const SIZE: Parameter = Parameter { name: "size", unit: "m", default: 2.0, range: [1.0, 3.0], doc: "a size" };
const ANGLE: Parameter = Parameter { name: "a_deg", unit: "°", default: 30.0, range: [0.0, 90.0], doc: "an angle" };

const CASE: &str = "title = \"t\"\n[domain]\noutline = [[0, 0], [1, 0], [1, 1], [0, 1]]\n[mesh]\nsize = 0.7\n\
                    [rock.r]\ndensity = 2000\nyoung = 1e9\npoisson = 0.2\n[[stage]]\nname = \"s\"\nkind = \"dynamic\"\n\
                    duration = 0.01\n";

const fn problem(
    id: &'static str,
    parameters: &'static [Parameter],
    quick: bool,
    run: fn(&mut Setup) -> Result<Outcome, Trouble>,
) -> Problem {
    Problem { id, title: "title", source: "s = |a|", parameters, quick, implicit: quick, run }
}

static ALL: [Problem; 5] = [
    problem("A1", &[SIZE], true, square),
    problem("A10", &[SIZE, ANGLE], false, square),
    problem("A2", &[ANGLE], true, panics),
    problem("B1", &[], true, fails),
    problem("B2", &[SIZE], false, misses),
];

fn square(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let size = setup.get("size");
    setup.simulation("a case", CASE.to_owned())?;
    setup.simulation("a case", CASE.replace("0.7", "0.6"))?;
    let row = Row::new("area", "m²", size * size * 1.001, size * size).within(Tolerance::Relative(1e-2), "because");
    Ok(Outcome { rows: vec![row], plots: Vec::new() })
}

fn panics(setup: &mut Setup) -> Result<Outcome, Trouble> {
    panic!("no angle of {}", setup.get("a_deg"))
}

fn fails(_: &mut Setup) -> Result<Outcome, Trouble> {
    Err(Trouble("no model".to_owned()))
}

fn misses(_: &mut Setup) -> Result<Outcome, Trouble> {
    let row = Row::new("a|b", "", f64::NAN, 1.0).within(Tolerance::Absolute(0.5), "it must be near");
    let shown = Row::new("shown", "s", 3.0, 1.0);
    Ok(Outcome { rows: vec![row, shown], plots: Vec::new() })
}

fn request(only: &[&str], set: &[&str]) -> Request {
    let texts = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    Request { only: texts(only), set: texts(set), integrator: None, quick: false }
}

fn ids(request: &Request) -> Vec<&'static str> {
    let jobs = choose(&ALL, request).unwrap_or_else(|trouble| panic!("{trouble}"));
    jobs.iter().map(|job| job.problem.id).collect()
}

#[test]
fn problems_are_chosen_by_id_prefix_quick_set_and_parameter() {
    assert_eq!(ids(&request(&[], &[])), ["A1", "A10", "A2", "B1", "B2"]);
    // A full ID is that problem alone, a beginning all that begin so; order and case do not matter.
    assert_eq!(ids(&request(&["b", "a1"], &[])), ["A1", "B1", "B2"]);
    assert_eq!(ids(&request(&["A"], &[])), ["A1", "A10", "A2"]);
    assert_eq!(ids(&Request { quick: true, ..request(&[], &[]) }), ["A1", "A2", "B1"]);
    assert_eq!(ids(&request(&[], &["size=2.5"])), ["A1", "A10", "B2"]);
    assert_eq!(ids(&request(&[], &["size=2.5", "a_deg=1"])), ["A10"]);
    assert_eq!(ids(&request(&[], &["a10.size=2.5"])), ["A10"]);
    assert_eq!(ids(&request(&[], &["A2.a_deg=3", "A1.size=2"])), ["A1", "A2"]);
    assert_eq!(ids(&Request { integrator: Some(Integrator::Implicit), ..request(&[], &[]) }), ["A1", "A2", "B1"]);
}

#[test]
fn values_reach_the_problems_they_are_meant_for() {
    let jobs = choose(&ALL, &request(&["A1", "A10"], &["size=3", "A10.size=1.5"])).expect("jobs");
    assert_eq!(jobs.iter().map(|job| job.values.get("size")).collect::<Vec<_>>(), [3.0, 1.5]);
}

#[test]
fn what_cannot_be_is_refused_with_a_remedy() {
    let refused = |request: &Request, parts: &[&str]| {
        let trouble = choose(&ALL, request).err().unwrap_or_else(|| panic!("{request:?} is taken")).to_string();
        assert!(parts.iter().all(|part| trouble.contains(part)), "{trouble}");
    };
    refused(&request(&["B7"], &[]), &["\"B7\"", "nearest is B1", "--list"]);
    refused(&request(&[""], &[]), &["\"\""]);
    refused(&request(&["ü"], &[]), &["\"ü\""]);
    refused(&request(&["A1"], &["width=2"]), &["\"width\"", "there are size"]);
    refused(&request(&["A1", "A2"], &["size=2"]), &["A2: no parameter \"size\"", "it has a_deg"]);
    refused(&request(&["A1"], &["size=4"]), &["size is 4 m", "from 1 to 3"]);
    refused(&request(&["A1"], &["size=NaN"]), &["size is NaN"]);
    refused(&request(&["A1"], &["size=x"]), &["\"x\" is no number"]);
    refused(&request(&["A1"], &["size"]), &["NAME=VALUE"]);
    refused(&request(&["A1"], &["B2.size=2"]), &["B2 is not among the chosen"]);
    refused(&request(&[], &["B7.size=2"]), &["nearest is B1"]);
    refused(&request(&[], &["B1.size=2"]), &["there are none"]);
    refused(&request(&[], &["B2.size=2", "a_deg=3"]), &["B2 is not among the chosen"]);
    let implicit = Request { integrator: Some(Integrator::Implicit), ..request(&["B2"], &[]) };
    refused(&implicit, &["B2: not solved with the implicit"]);
}

#[test]
fn a_panic_or_a_failure_takes_no_other_with_it() {
    let jobs = || choose(&ALL, &request(&[], &[])).expect("jobs");
    for threads in [1, 2, 9] {
        let solved = solve_all(jobs(), threads, |place, solved| assert_eq!(ALL[place].id, solved.job.problem.id));
        let verdicts: Vec<bool> = solved.iter().map(|s| s.passes()).collect();
        assert_eq!(verdicts, [true, true, false, false, false]);
        let record = Record::of(&solved);
        assert!(!record.passed);
        let trouble = |k: usize| record.problems[k].trouble.as_deref();
        assert_eq!([trouble(0), trouble(2), trouble(3)], [None, Some("panicked: no angle of 30"), Some("no model")]);
        let table = text::table(&record.problems[2]);
        assert!(table.contains("A2  title") && table.contains("FAILED"), "{table}");
    }
    assert!(solve_all(Vec::<Job>::new(), 2, |_, _| ()).is_empty());
}

#[test]
fn records_survive_writing_and_reading_and_state_what_is_missed() {
    let solved = solve_all(choose(&ALL, &request(&[], &[])).expect("jobs"), 2, |_, _| ());
    let record = Record::of(&solved).without_wall();
    let read: Record = serde_json::from_str(&report::json(&record)).expect("a record");
    assert_eq!(read, record);
    let document = report::document(&record);
    for part in [
        "**MISSED** B2, a|b: no number, should be 1",
        "| a\\|b | no number | 1 | – | 0.5 (1) | **MISSED** |",
        "Tolerances: (1) it must be near.",
        "no model",
    ] {
        assert!(document.contains(part), "{part} is not in\n{document}");
    }
    assert!(report::new_misses(&record, &record).is_empty());
    assert_eq!(report::new_misses(&record, &Record::default()).len(), 3);
    assert_eq!(record.problems[4].worst().expect("a row").quantity, "a|b");
    let table = text::table(&ProblemRecord::of(&solved[4]));
    assert!(table.contains("MISSED a|b: the tolerance is for: it must be near"), "{table}");
}

#[test]
fn cases_are_written_under_names_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let implicit = Request { integrator: Some(Integrator::Implicit), ..request(&["A1"], &[]) };
    let mut jobs = choose(&ALL, &implicit).expect("jobs");
    // The result of the implicit integrator does not matter here: the text must name it.
    jobs[0].integrator = Integrator::Explicit;
    let mut solved = solve_all(jobs, 1, |_, _| ());
    solved[0].job.integrator = Integrator::Implicit;
    let paths = write_cases(&solved[0], folder.path()).expect("written");
    let names: Vec<_> = paths.iter().map(|p| p.file_name().expect("a name").to_string_lossy().into_owned()).collect();
    assert_eq!(names, ["a_case.toml", "a_case-2.toml"]);
    for path in paths {
        let loaded = enmm_io::load_case(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.case.solver.integrator, Integrator::Implicit);
    }
}
