//! `enmm import` writes a case for a drawing that `enmm check` accepts once nothing is open, and names all that is.

use std::fs;

use crate::support::Place;

fn place() -> Place {
    let place = Place::with("");
    let drawing = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/keys/section.dxf");
    fs::copy(drawing, place.path("section.dxf")).expect("a drawing");
    place
}

#[test]
fn one_command_makes_the_section_of_a_drawing() {
    let place = place();
    let answer = place.answers(0, &["import", "section.dxf", "--examples"]);
    answer.assert_printed(&[
        "note: $INSUNITS is 4 (millimetres): coordinates are taken times 0.001",
        "TERRAIN  outline   1 LWPOLYLINE",
        "FAULTS   joint     2 ARC, 2 LINE, 1 TEXT",
        "BEDDING  joint     2 LINE, 1 LWPOLYLINE, 1 SPLINE",
        "GWL      water     1 LWPOLYLINE",
        "BOLTS    bolt      2 LINE",
        "FRAME    ignore    1 3DFACE",
        "assumed: layer \"TERRAIN\" is \"outline\": its closed line is the largest of the drawing",
        "assumed: mesh.size is 0.5 m",
        "assumed: the edge (0, 0) to (40, 0) is held in xy",
        "example values: [joint_law.faults]: friction_deg",
        "open: layer \"FRAME\": 3DFACE is of a type that is not read; explode it in the drawing",
        "section.toml: fill in what is open, then: enmm check section.toml",
    ]);
    let found = place.answers(0, &["check", "section.toml", "--json"]).json();
    // Six sides, less the triangle of the face: 40 × 20 − (10 + 18)/2 × 16.
    assert!((found["total_area"].as_f64().expect("an area") - (800.0 - 224.0)).abs() < 1e-6, "{found}");
    assert!(found["blocks"].as_u64().expect("blocks") > 1, "{found}");
    assert_eq!(found["ignored_joints"], 0);
    let again = place.enmm(&["import", "section.dxf"]);
    again.assert_bad_input(&["cannot write section.toml (it is there already)"]);
}

#[test]
fn values_that_no_drawing_has_stay_open() {
    let place = place();
    let answer = place.answers(0, &["import", "section.dxf", "-o", "open.toml"]);
    assert!(answer.stdout.contains("open: [rock.rock]: density, young, poisson"), "{answer:?}");
    let checked = place.enmm(&["check", "open.toml"]);
    checked.assert_bad_input(&["open.toml:", "is missing"]);
    // Each open value, filled in, is one error less; then the case is accepted.
    let mut text = fs::read_to_string(place.path("open.toml")).expect("a case");
    for (key, value) in
        [("density", "2650"), ("young", "20e9"), ("poisson", "0.25"), ("friction_deg", "30"), ("area", "5e-4")]
    {
        text = text.replace(&format!("# {key} =  # OPEN"), &format!("{key} = {value}  # OPEN"));
    }
    fs::write(place.path("open.toml"), text).expect("written");
    place.answers(0, &["check", "open.toml"]);
}

#[test]
fn a_drawing_that_cannot_be_read_is_named() {
    let place = place();
    place.enmm(&["import", "none.dxf"]).assert_bad_input(&["none.dxf: cannot read the file"]);
    fs::write(place.path("binary.dxf"), b"AutoCAD Binary DXF\r\n\x1a\0\xb9").expect("written");
    place.enmm(&["import", "binary.dxf"]).assert_bad_input(&["binary.dxf: it is a binary DXF"]);
    assert_eq!(place.names(), ["binary.dxf", "case.toml", "section.dxf"]);
}

/// A name of 65 536 letters was a panic; control characters reached the terminal, and a case that was no TOML.
#[test]
fn names_of_layers_are_neither_obeyed_nor_too_long_for_a_table() {
    let drawing = |name: &str| {
        let ring: String = [[0, 0], [20, 0], [20, 10], [0, 10]].map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).concat();
        format!(
            "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\noutline\n90\n4\n70\n1\n{ring}0\nLINE\n8\n{name}\n10\n0\n\
             20\n5\n11\n20\n21\n5\n0\nENDSEC\n0\nEOF\n"
        )
    };
    let place = Place::with("");
    let import = |name: &str, case: &str| {
        fs::write(place.path("map.dxf"), drawing(name)).expect("written");
        place.enmm(&["import", "map.dxf", "--examples", "-o", case])
    };
    import(&"L".repeat(65_536), "long.toml").assert_bad_input(&["LLL", "65536 letters", "at most 255"]);
    let names = ["\u{1b}]0;taken\u{7}red", "\u{202e}evil\u{ad}", "a\" = 1 [[bolt]] b\\", &"L".repeat(255)];
    for (k, name) in names.into_iter().enumerate() {
        let case = format!("{k}.toml");
        let answer = import(name, &case);
        assert_eq!(answer.status, Some(0), "{answer:?}");
        let shown = answer.stdout.trim_end().chars().filter(|c| *c != '\n');
        assert!(!shown.clone().any(|c| c.is_control() || "\u{202e}\u{ad}".contains(c)), "{answer:?}");
        place.answers(0, &["check", &case]);
    }
}
