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

/// The face of this outline is its longest steep edge, from (8, 0) up to (4, 2), which dips to the right by 26.6°.
#[test]
fn sets_in_space_fail_as_computed_by_hand() {
    let place = Place::with(&incline(30f64.to_radians().tan(), SETS));
    let answer = place.enmm(&["stereonet", "case.toml", "--face", "65/120", "-o", "net.svg"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
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
    // The default face is that of the outline, and x points to 300°.
    let own = place.enmm(&["stereonet", "case.toml", "--equal-angle"]);
    assert!(own.stdout.contains("face                  26.6°/300.0°") && own.stdout.contains("plane failure: none"));
    let own = fs::read_to_string(place.path("case.stereonet.svg")).expect("a picture");
    assert!(own.contains("equal angle (Wulff)"));
    let wrong = place.enmm(&["stereonet", "case.toml", "--face", "95/120"]);
    assert!(wrong.status == Some(2) && wrong.stderr.contains("write a dip of 0 to 90"), "{wrong:?}");
    place.enmm(&["stereonet", "case.toml", "-o", "case.toml"]).assert_bad_input(&[
        "cannot write the picture",
        "case.toml",
        "choose another file",
    ]);
}
