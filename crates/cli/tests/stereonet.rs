//! `enmm stereonet` draws sets and face and prints what fails kinematically, by hand-computed cases.

use std::fs;

use crate::support::{Place, incline};

const SETS: &str = r#"
[section]
azimuth_deg = 300
[[joint_set]]
name = "slide"
dip_deg = 40
dip_direction_deg = 125
spacing = 1
[[joint_set]]
name = "columns"
dip_deg = 80
dip_direction_deg = 300
spacing = 1
[[joint_set]]
name = "flat"
dip_deg = 10
dips = "left"
spacing = 1
"#;

#[test]
fn sets_in_space_fail_as_computed_by_hand() {
    let place = Place::with(&incline(30f64.to_radians().tan(), SETS));
    let answer = place.answers(0, &["stereonet", "case.toml", "--face", "65/120", "-o", "net.svg"]);
    answer.assert_printed(&[
        "face                  65.0°/120.0°",
        // tan(apparent) = tan 40°·cos(125° − 300°), so 39.9° against the x axis; to the left.
        "slide                 40.0°/125.0°, φ 30.0°; in the section 39.9° down to the left",
        "columns               80.0°/300.0°, φ 30.0°; in the section 80.0° down to the right",
        "flat                  10.0°/120.0°, φ 30.0°; ⊥ in the section 10.0° down to the left",
        "plane failure: slide\n",
        "wedge failure: none\n",
        "toppling: columns\n",
        "note: ⊥: known in the section alone, taken normal to it",
    ]);
    let svg = fs::read_to_string(place.path("net.svg")).expect("a picture");
    for part in ["equal area (Schmidt), lower hemisphere", "plane failure: slide", "face 65°/120°", "friction 30°"] {
        assert!(svg.contains(part), "{part:?} is not in the picture");
    }
    // The block on the slope has a side that dips the other way: the outline does not say which edge is the face.
    place.enmm(&["stereonet", "case.toml"]).assert_bad_input(&["26.6/300 (4.5 m)", "63.4/120 (0.9 m)", "--face"]);
    let own = place.enmm(&["stereonet", "case.toml", "--face", "26.6/300", "--equal-angle"]);
    assert!(own.stdout.contains("face                  26.6°/300.0°") && own.stdout.contains("plane failure: none"));
    let own = fs::read_to_string(place.path("case.stereonet.svg")).expect("a picture");
    assert!(own.contains("equal angle (Wulff)"));
    let wrong = place.enmm(&["stereonet", "case.toml", "--face", "95/120"]);
    assert!(wrong.status == Some(2) && wrong.stderr.contains("write a dip of 0 to 90"), "{wrong:?}");
    place.enmm(&["stereonet", "case.toml", "--face", "65/120", "-o", "case.toml"]).assert_bad_input(&[
        "cannot write the picture",
        "case.toml",
        "choose another file",
    ]);
}

/// A cut of 20 m that dips by 60°, its benches, a pit and ground without a face, computed from their corners.
#[test]
fn the_face_is_that_of_the_outline_only_where_its_edges_agree() {
    let run = 20.0 / 60f64.to_radians().tan();
    let case = |outline: &str| {
        let text = incline(0.5, SETS);
        let lines = text.lines().filter(|line| !line.starts_with("points"));
        let line = |line: &str| match line {
            _ if line.starts_with("outline") => format!("outline = {outline}"),
            "[[joint]]" => String::new(),
            _ if line.starts_with("block") || line.starts_with("point ") => line.replace("0.2", "-9.0"),
            _ => line.to_owned(),
        };
        lines.map(line).collect::<Vec<_>>().join("\n")
    };
    let face = |outline: &str| {
        let place = Place::with(&case(outline));
        let answer = place.enmm(&["stereonet", "case.toml"]);
        let line = answer.stdout.lines().find_map(|line| line.strip_prefix("face")).map(|face| face.trim().to_owned());
        line.ok_or(answer.stderr)
    };
    let plain = face(&format!("[[-30, -10], [30, -10], [30, 0], [0, 0], [-{run}, 20], [-30, 20]]"));
    assert_eq!(plain.as_deref(), Ok("60.0°/300.0°"));
    let half = run / 2.0;
    let benches = format!(
        "[[-30, -10], [30, -10], [30, 0], [0, 0], [-{half}, 10], [-{}, 10], [-{}, 20], [-30, 20]]",
        half + 4.0,
        run + 4.0
    );
    assert_eq!(face(&benches).as_deref(), Ok("60.0°/300.0°"), "benches of one dip are one face");
    let ditch = format!("[[-30, -10], [30, -10], [30, 0], [2, 0], [1.5, -0.5], [0, 0], [-{run}, 20], [-30, 20]]");
    assert_eq!(face(&ditch).as_deref(), Ok("60.0°/300.0°"), "a ditch is no part of it");
    let broken = face("[[-30, -10], [30, -10], [30, 0], [0, 0], [-10, 10], [-14, 20], [-30, 20]]");
    let message = broken.expect_err("45° below, 68.2° above");
    assert!(message.contains("45.0/300 (14.1 m), 68.2/300 (10.8 m)") && message.contains("--face"), "{message}");
    let pit = face("[[-30, -10], [30, -10], [30, 20], [20, 20], [10, 0], [-10, 0], [-20, 20], [-30, 20]]");
    let message = pit.expect_err("walls on both sides");
    assert!(message.contains("63.4/300 (22.4 m)") && message.contains("63.4/120 (22.4 m)"), "{message}");
    let level = face("[[-30, -10], [30, -10], [30, 0], [-30, 0]]").expect_err("no face");
    assert!(level.contains("no edge that dips by 20°") && level.contains("--face"), "{level}");
}
