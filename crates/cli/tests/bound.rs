//! Claim: `enmm bound` prints the bounds of a case as text and as JSON, distinguishes factors from none and from no
//! end, and answers with the promised statuses.

use crate::support::{Place, ROAD_CUT, incline, json};

#[test]
fn a_block_on_an_incline_is_bounded_by_its_tangents() {
    let place = Place::with(&incline(0.65, ""));
    let answer = place.answers(0, &["bound", "case.toml"]);
    assert!(answer.stdout.contains("associated            1.3000         upper bound"), "{answer:?}");
    assert!(answer.stdout.contains("without normality     1.3000         estimate, no bound"), "{answer:?}");
    assert!(answer.stdout.contains("slides as one: such bounds lie close to the factor"), "{answer:?}");
    let found = place.enmm(&["bound", "case.toml", "--json"]).json();
    for kind in ["associated", "level_tops", "catching", "bare", "estimate"] {
        assert_eq!(found[kind]["end"], "found");
        assert!(found[kind]["factor"].as_f64().is_some_and(|factor| (factor - 1.3).abs() < 1e-4), "{found}");
    }
    assert_eq!(found["level_tops"]["mechanism"].as_array().map(Vec::len), Some(1));
    assert!(
        found["level_tops"]["meaning"].as_str().is_some_and(|meaning| meaning.starts_with("upper bound")),
        "{found}"
    );
    assert_eq!(place.names(), ["case", "case.toml"], "the page goes to the folder of the case");
    let files =
        std::fs::read_dir(place.path("case/bound")).expect("a folder").map(|file| file.expect("a file").file_name());
    let mut files: Vec<_> = files.collect();
    files.sort();
    assert_eq!(files, ["bound.json", "report.html"], "the page holds its film");
}

/// The rigid wedge of `road_cut` has F = 1.3176 with its bolts and 1.0313 before they are installed.
#[test]
fn a_bound_looks_at_the_slope_after_the_stage_that_is_named() {
    let place = Place::with("");
    for (stage, formula) in [("gravity", 1.0313), ("bolts", 1.3176)] {
        place.answers(0, &["bound", ROAD_CUT, "--stage", stage, "-o", "out"]);
        let found = json(&place.path("out/bound.json"));
        let factor = found["bound"]["level_tops"]["factor"].as_f64().expect("a factor");
        assert!((factor / formula - 1.0).abs() < 1e-3, "{stage}: {factor}");
        assert_eq!(found["stage"], stage);
    }
    place.answers(0, &["report", "out"]);
    let report = std::fs::read_to_string(place.path("out/report_a4.html")).expect("a report");
    assert!(report.contains("After the stage</th><td>bolts"), "the report does not name the stage");
    let refused = place.answers(2, &["bound", ROAD_CUT, "--stage", "quake", "-o", "none"]);
    assert!(refused.stderr.contains("gravity, bolts"), "{refused:?}");
    assert!(!place.path("none").exists());
}

#[test]
fn a_block_on_a_level_floor_never_falls() {
    let outline = "[[0, -1], [8, -1], [8, 2], [4, 2], [4, 3], [3, 3], [3, 2], [0, 2]]";
    let case = incline(0.65, "");
    let lines = case.lines().map(|line| match line {
        _ if line.starts_with("outline") => format!("outline = {outline}\n"),
        _ if line.starts_with("points") => "points = [[4, 2], [3, 2]]\n".to_owned(),
        _ => format!("{line}\n"),
    });
    let level: String = lines.collect();
    let place = Place::with(&level);
    let answer = place.answers(0, &["bound", "case.toml"]);
    assert!(answer.stdout.contains("at least 1000") && answer.stdout.contains("none"), "{answer:?}");
    let answer = place.enmm(&["bound", "case.toml", "--json"]);
    assert!(answer.stdout.contains("\"at_least\""), "{answer:?}");
}

/// Rock of 10 MPa holds the block, so that the joint decides.
fn yielding(more: &str) -> Place {
    Place::with(&incline(0.65, more).replace("poisson = 0.25", "poisson = 0.25\ncohesion = 1e7"))
}

#[test]
fn rock_that_yields_is_bounded_from_both_sides() {
    let place = yielding("");
    let answer = place.answers(0, &["bound", "case.toml", "--triangles", "300"]);
    assert!(answer.stdout.contains("lower bound") && answer.stdout.contains("upper bound"), "{answer:?}");
    let found = place.enmm(&["bound", "case.toml", "--triangles", "300", "--json"]).json();
    let [lower, upper] = ["lower", "upper"].map(|kind| found[kind]["factor"].as_f64().expect("a factor"));
    assert!(1.26 < lower && lower <= 1.3 && (1.3 - 1e-4..1.301).contains(&upper), "{lower} to {upper}");
    assert!(found["upper"]["mechanism"].as_array().is_some_and(|moving| moving.len() > 10), "{found}");
    assert_eq!(place.names(), ["case", "case.toml"], "the page goes to the folder of the case");
}

#[test]
fn what_rock_that_yields_cannot_bear_is_bad_input() {
    let place = yielding("[[load]]\nkind = \"point\"\npoint = [0.1, 0.1]\nforce = [0.0, -1.0]\n");
    let answer = place.answers(2, &["bound", "case.toml", "--json"]);
    assert!(answer.stdout.contains("\"error\"") && answer.stderr.contains("load[0].kind"), "{answer:?}");
    place.answers(2, &["bound", "case.toml", "--triangles", "10"]);
}
