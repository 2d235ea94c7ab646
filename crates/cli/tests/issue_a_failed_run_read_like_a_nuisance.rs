//! A cut that toppled by ten metres in its static stage ended with exit status 0, `finished` and a warning about a
//! block that moved by 47 µm/s, tens of thousands of steps after it had gone.

use crate::support::{Outcome, Place, json};

/// A rectangle of this width along a plane of 30° and this height across it, which stands on it, with friction (°),
/// and what comes after the static stage. Beside it lies a chip of 16 cm², less than a thousandth of it.
fn on_a_plane([width, height]: [f64; 2], friction_deg: f64, more: &str) -> String {
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let at = |[along, across]: [f64; 2]| [along * cosine - across * sine, along * sine + across * cosine];
    let (left, right) = (5.0, 5.0 + width);
    let [end, start] = [11.96, 11.92];
    let tops = [[end, 0.0], [end, 0.04], [start, 0.04], [start, 0.0], [right, 0.0], [right, height], [left, height]];
    let corners: Vec<[f64; 2]> = tops.into_iter().chain([[left, 0.0]]).map(at).collect();
    let outline: Vec<[f64; 2]> = [[0.0, -1.0], [10.5, -1.0], at([12.2, 0.0])]
        .into_iter()
        .chain(corners.iter().copied())
        .chain([[0.0, 0.0]])
        .collect();
    let joint = |from: f64, to: f64, law: &str| {
        format!("[[joint]]\npoints = [{:?}, {:?}]\nlaw = {law:?}\n", at([from, 0.0]), at([to, 0.0]))
    };
    format!(
        "title = \"On a plane\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = 0.5\nleast_block = 0\n{}{}\
         [rock.rock]\ndensity = 2600\nyoung = 1e9\npoisson = 0.25\n[joint_law.plane]\nfriction_deg = {friction_deg}\n\
         [joint_law.ice]\nfriction_deg = 5\n[[fix]]\nedge = [[0, -1], [10.5, -1]]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\n{more}",
        joint(left, right, "plane"),
        joint(start, end, "ice"),
    )
}

fn run(case: &str) -> (Place, Outcome) {
    let place = Place::with(case);
    let outcome = place.enmm(&["run", "case.toml", "-o", "out"]);
    (place, outcome)
}

#[test]
fn a_slope_that_fails_in_a_static_stage_is_said_to_and_ends_it_early() {
    for (block, friction, mechanism) in [([0.8, 3.0], 60.0, "toppling"), ([2.0, 1.0], 15.0, "sliding")] {
        let (place, outcome) = run(&on_a_plane(block, friction, ""));
        assert_eq!(outcome.status, Some(4), "{outcome:?}");
        let verdict = format!("the slope failed in stage rest by {mechanism}: 1 block, largest displacement 0.5");
        assert!(outcome.stdout.contains(&verdict), "{outcome:?}");
        let summary = json(&place.path("out/summary.json"));
        assert!(summary["verdict"].as_str().expect("a line").starts_with(&verdict));
        assert_eq!((&summary["status"], &summary["failed"]), (&"finished".into(), &true.into()));
        let stage = &summary["stages"][0];
        assert_eq!((&stage["ended_early"], &stage["converged"]), (&true.into(), &false.into()));
        assert_eq!(stage["failure"]["mechanism"], mechanism);
        assert!(stage["time"].as_f64().expect("a time") < 5.0, "{stage}");
        for name in ["checkpoint.enmm", "film.bin", "frames/elements_0001.vtu", "stage1_joints.png"] {
            assert!(place.path("out").join(name).exists(), "{name}");
        }
        let again = place.answers(4, &["run", "case.toml", "-o", "out", "--resume", "out/checkpoint.enmm", "--quiet"]);
        assert!(again.stdout.is_empty() && again.stderr.starts_with(&verdict), "{again:?}");
    }
}

#[test]
fn a_slope_at_rest_has_not_failed_although_a_chip_slides_off() {
    // Gravity grows so slowly that the chip has gone that far before the block rests.
    let more = "ramp = 2.0\n[solver]\nfailure_displacement = 0.05\n";
    let (place, outcome) = run(&on_a_plane([2.0, 1.0], 45.0, more));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    outcome.assert_printed(&["verdict              the slope has not failed: largest displacement 0.000"]);
    let summary = json(&place.path("out/summary.json"));
    assert_eq!((&summary["failed"], &summary["stages"][0]["failure"]), (&false.into(), &serde_json::Value::Null));
    let chip = std::fs::read_to_string(place.path("out/blocks.csv")).expect("blocks");
    let far = |row: &str| row.split(',').nth(6).and_then(|x| x.parse::<f64>().ok()).is_some_and(|x| x < -0.05);
    assert!(chip.lines().any(far), "the chip is gone: {chip}");
}

#[test]
fn a_failure_in_a_dynamic_stage_is_a_line_and_no_exit_status() {
    let loss = "[[stage]]\nname = \"loss\"\nkind = \"dynamic\"\nduration = 1.0\n\
                [[stage.law]]\nlaw = \"plane\"\nfriction_deg = 5\n";
    let (place, outcome) = run(&on_a_plane([2.0, 1.0], 45.0, loss));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    outcome.assert_printed(&["the slope failed in stage loss by sliding: 1 block, largest displacement"]);
    let summary = json(&place.path("out/summary.json"));
    assert_eq!(summary["failed"], true);
    assert_eq!(summary["stages"][1]["ended_early"], false);
    // ½g(sin 30° − cos 30° tan 5°)t²
    let way = 0.5 * 9.81 * (0.5 - 3f64.sqrt() / 2.0 * 5f64.to_radians().tan());
    let moved = &summary["permanent"][0];
    let close = |value: &serde_json::Value| (value.as_f64().expect("a number") / way - 1.0).abs() < 0.02;
    let joint = moved["joints"].as_array().and_then(|joints| joints.iter().find(|slip| slip["joint"] == "joint[0]"));
    assert!(close(&moved["displacement"]) && close(&joint.expect("the joint of the block")["slip"]), "{way} {moved}");
}
