//! `enmm check` says of each record what was read and when it acts, and `run` warns as it does.

use std::fs;

use crate::support::{Place, case};

#[test]
fn check_has_a_line_and_the_warnings_of_each_record() {
    let motion =
        "[[base_motion]]\nfile = \"quake.csv\"\n[[base_motion]]\nfile = \"quake.csv\"\nscale = 0.01\naxis = \"y\"\n";
    let place = Place::with(&case(0.01).replacen("[[load]]", &format!("{motion}[[load]]"), 1));
    fs::write(place.path("quake.csv"), "t,a\n0,0\n0.004,2\n0.008,0\n").expect("written");
    let checked = place.enmm(&["check", "case.toml"]);
    checked.assert_printed(&[
        "record base_motion[0]: quake.csv (columns 1 and 2), acceleration in m/s² as no unit is named, 3 rows, 0 to \
         0.008 s, peak 2 m/s² (0.204 g), acts in ",
        "acceleration in m/s² as no unit is named, 3 rows times 0.01, 0 to 0.008 s, peak 0.02 m/s²",
        "warning: base_motion[1]: the peak of \"quake.csv\" is 0.02 m/s² (0.00204 g), below 0.01 g",
    ]);
    let json: serde_json::Value =
        serde_json::from_str(&place.enmm(&["check", "case.toml", "--json"]).stdout).expect("JSON");
    let records = json["records"].as_array().expect("records");
    assert_eq!(records.len(), 2);
    assert_eq!((&records[0]["rows"], &records[0]["peak"]), (&3.into(), &2.0.into()));
    assert_eq!(records[0]["kind"], "acceleration");
    let warnings = json["warnings"].as_array().expect("warnings");
    assert_eq!(warnings.iter().filter(|w| w.as_str().is_some_and(|w| w.contains("below 0.01 g"))).count(), 1);
}
