//! Geometry of the wrong unit, names of other programs, water on islands and beyond the end of its line gave a factor
//! without a word; a bound that could not be found dropped the notes that said why; `enmm import` read drawings alone.

use std::fs;

use enmm::model::bytes::Keeper;

use crate::support::{Outcome, Place};

/// Tangent of the plane on which the slope slides, from the face to the top.
const SLOPE: f64 = 0.8;
/// Tangents of friction of the default law and of the weak one.
const FRICTION: f64 = 0.577_350_269_189_625_8;
const WEAK: f64 = 0.363_970_234_266_202_4;

/// A slope of 24 m whose joint comes from a file.
fn slide(file: &str) -> String {
    format!(
        "title = \"slide\"\n[domain]\ngeometry_file = {file:?}\njoint_law = \"fault\"\n[mesh]\nsize = 2.0\n[rock.r]\n\
         density = 2600\nyoung = 20e9\npoisson = 0.25\n[joint_law.fault]\nfriction_deg = 30\n[joint_law.weak]\n\
         friction_deg = 20\n[[fix]]\nedge = [[0, 0], [40, 0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\n\
         duration = 5.0\n"
    )
}

/// A file of GeoJSON with the slope, and a plane with these properties.
fn collection(properties: &str) -> String {
    let feature = |properties: &str, kind: &str, coordinates: &str| {
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{{properties}}}, \"geometry\": {{\"type\": {kind:?}, \
             \"coordinates\": {coordinates}}}}}"
        )
    };
    let outline = feature("", "Polygon", "[[[0, 0], [40, 0], [40, 24], [12, 24], [0, 0]]]");
    let plane = feature(properties, "LineString", "[[3, 7.2], [30, 28.8]]");
    format!("{{\"type\": \"FeatureCollection\", \"features\": [{outline}, {plane}]}}")
}

fn bound(place: &Place, case: &str) -> (f64, Vec<String>) {
    let found = place.answers(0, &["bound", case, "--json"]).json();
    let warnings = found["warnings"].as_array().expect("a list").iter().map(ToString::to_string).collect();
    (found["level_tops"]["factor"].as_f64().expect("a factor"), warnings)
}

fn near(found: f64, formula: f64) {
    assert!((found / formula - 1.0).abs() < 1e-4, "{found}, not {formula}");
}

#[test]
fn files_of_other_programs_have_the_factor_of_their_laws() {
    let place = Place::with("");
    let plain = "{\"outline\": [[0, 0], [40, 0], [40, 24], [12, 24]], \"TRACES\": [[[3, 7.2], [30, 28.8]]]}";
    for (name, text, friction) in [
        ("byte_order_mark.geojson", format!("\u{feff}{}", collection("")), FRICTION),
        ("property_law.geojson", collection("\"LAW\": \"weak\""), WEAK),
        ("property_layer.geojson", collection("\"Layer\": \"WEAK\""), WEAK),
        ("key_traces.json", plain.to_owned(), FRICTION),
    ] {
        fs::write(place.path(name), text).expect("written");
        fs::write(place.path("case.toml"), slide(name)).expect("written");
        let (factor, warnings) = bound(&place, "case.toml");
        near(factor, friction / SLOPE);
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
}

/// A drawing in metres whose header has the millimetres of a template.
#[test]
fn a_slope_of_24_millimetres_was_a_note() {
    let place = Place::with("");
    let corners = |points: &[[f64; 2]]| points.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).collect::<String>();
    let line = |layer: &str, closed: u8, points: &[[f64; 2]]| {
        format!("0\nLWPOLYLINE\n8\n{layer}\n90\n{}\n70\n{closed}\n{}", points.len(), corners(points))
    };
    let outline = line("outline", 1, &[[0.0, 0.0], [40.0, 0.0], [40.0, 24.0], [12.0, 24.0]]);
    let plane = line("FAULT", 0, &[[3.0, 7.2], [30.0, 28.8]]);
    let drawing = |unit: u8| {
        format!(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{unit}\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{outline}{plane}\
             0\nENDSEC\n0\nEOF\n"
        )
    };
    for (unit, name, scale) in [(4, "millimetres", 0.001), (1, "inches", 0.0254)] {
        fs::write(place.path("map.dxf"), drawing(unit)).expect("written");
        let small = slide("map.dxf").replace("size = 2.0", &format!("size = {}", 2.0 * scale));
        let small = small.replace("[40, 0]]", &format!("[{}, 0]]", 40.0 * scale));
        fs::write(place.path("case.toml"), &small).expect("written");
        let answer = place.answers(0, &["check", "case.toml"]);
        let first = format!("drawing                map.dxf: {name} ($INSUNITS is {unit}), taken times {scale}");
        assert_eq!(answer.stdout.lines().next(), Some(first.as_str()));
        let is_told = answer.stdout.contains("slopes are 1 m to 10 km long");
        assert_eq!(is_told, 40.0 * scale < 1.0, "{answer:?}");
        let metres = format!("{}\n[transform]\nscale = 1\n", slide("map.dxf"));
        fs::write(place.path("case.toml"), metres).expect("written");
        near(bound(&place, "case.toml").0, FRICTION / SLOPE);
        fs::remove_file(place.path("map.toml")).ok();
        let imported = place.enmm(&["import", "map.dxf"]);
        assert_eq!(imported.stdout.contains("warning: the rock is 0.04"), unit == 4, "{imported:?}");
    }
}

/// A block on a floor under 3 m of water: its joint is dry, so that 1 m of water on its top and a third side press it
/// down. It stands on the floor as an island, or as a part of the outline.
fn block(is_island: bool, water: &str) -> String {
    let outline = if is_island {
        "outline = [[-3, -1], [5, -1], [5, 0], [-3, 0]]\nislands = [[[0, 0], [2, 0], [2, 2], [0, 2]]]"
    } else {
        "outline = [[-3, -1], [5, -1], [5, 0], [2, 0], [2, 2], [0, 2], [0, 0], [-3, 0]]"
    };
    format!(
        "title = \"block\"\n[domain]\n{outline}\n[mesh]\nsize = 0.5\norigin = [0.13, 0.08]\n[rock.r]\ndensity = 2500\n\
         young = 5e9\npoisson = 0.2\n[joint_law.j]\nfriction_deg = 30\n[[joint]]\npoints = [[0, 0], [2, 0]]\n[[fix]]\n\
         edge = [[-3, -1], [5, -1]]\n[water]\nlevel = 3.0\njoints = false\n{water}\n[[load]]\nkind = \"block\"\n\
         point = [1, 0.5]\nforce = [4000, 0]\n[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 5.0\n"
    )
}

#[test]
fn no_water_pressed_on_an_island() {
    let place = Place::with("");
    let [weight, top] = [2500.0 * 9.81 * 4.0, 1000.0 * 9.81 * 1.0 * 2.0];
    // Water on both sides is in balance; on the left alone it pushes by its depth of 1 to 3 m.
    let push = 1000.0 * 9.81 * (3.0 * 3.0 - 1.0) / 2.0;
    for (water, down, along) in [
        ("", weight + top, 4000.0),
        ("faces = [[[0, 2], [2, 2]]]", weight + top, 4000.0),
        ("faces = [[[0, 0], [0, 2]]]", weight, 4000.0 + push),
    ] {
        for is_island in [false, true] {
            fs::write(place.path("case.toml"), block(is_island, water)).expect("written");
            near(bound(&place, "case.toml").0, FRICTION * down / along);
        }
    }
    // The joint, the floor and the island lie on each other where the mesh crosses them: no end of the drawing moved.
    let checked = place.enmm(&["check", "case.toml"]);
    assert!(checked.status == Some(0) && !checked.stdout.contains("merged within"), "{checked:?}");
    let port = "[[port]]\nname = \"top\"\nboundary = [[0, 2], [2, 2]]\npressure = 9810\n";
    let text = block(true, "faces = [[[0, 0], [0, 2]]]").replace("[[load]]", &format!("{port}[[load]]"));
    fs::write(place.path("case.toml"), text).expect("written");
    near(bound(&place, "case.toml").0, FRICTION * (weight + top) / (4000.0 + push));
}

/// A joint that runs along the face is a face, not a joint: water reaches it though joints are dry.
#[test]
fn a_joint_drawn_along_the_face_kept_the_water_off() {
    let place = Place::with("");
    let top = "[[joint]]\npoints = [[0, 2], [2, 2]]\n[[fix]]";
    fs::write(place.path("case.toml"), block(false, "").replace("[[fix]]", top)).expect("written");
    let [weight, top] = [2500.0 * 9.81 * 4.0, 1000.0 * 9.81 * 1.0 * 2.0];
    near(bound(&place, "case.toml").0, FRICTION * (weight + top) / 4000.0);
}

#[test]
fn a_water_line_that_ends_in_the_rock_flooded_the_pit() {
    let place = Place::with("");
    let slope = "outline = [[-20, -10], [40, -10], [40, 30], [15, 30], [0, 0], [-20, 0]]";
    let case = |table: &str| {
        let text = slide("none.json").replace("geometry_file = \"none.json\"", slope);
        let text = text.replace("[[0, 0], [40, 0]]", "[[-20, -10], [40, -10]]");
        text.replace("[[fix]]", &format!("[[joint]]\npoints = [[0, 0], [40, 32]]\n[water]\ntable = {table}\n[[fix]]"))
    };
    let checked = |table: &str| {
        fs::write(place.path("case.toml"), case(table)).expect("written");
        let answer = place.answers(0, &["check", "case.toml"]);
        let told = |kind: &str| {
            let lines = answer.stdout.lines().filter_map(|line| line.strip_prefix(kind));
            lines.filter(|line| line.contains("above the ground")).map(str::to_owned).collect::<Vec<_>>()
        };
        [told("warning: "), told("note: ")]
    };
    let none = Vec::<String>::new();
    let flooded = "water.table: stands 12 m above the ground from x -20 to 6 m: the line ends inside the rock at (8, \
                   12) m and is level beyond; draw it on to where the ground is dry";
    assert_eq!(checked("[[8, 12], [40, 20]]"), [vec![flooded.to_owned()], none.clone()]);
    let sloping = "water.table: stands 8 m above the ground from x -20 to 2.857 m: the line slopes there, which still \
                   water does not; draw it below the face";
    assert_eq!(checked("[[-20, 8], [0, 6], [40, 20]]")[0].len(), 1);
    assert_eq!(checked("[[-20, 8], [10, 5], [40, 20]]")[0], [sloping]);
    // A lake, and a line from the toe, are as they should be; a line from the face is a lake, for a note.
    assert_eq!(checked("[[-20, 4], [2, 4], [40, 20]]"), [none.clone(), none.clone()]);
    assert_eq!(checked("[[-20, 0], [0, 0], [40, 20]]"), [none.clone(), none.clone()]);
    let lake = checked("[[5, 10], [40, 20]]");
    assert_eq!(lake[0], none);
    assert_eq!(lake[1].len(), 1, "{lake:?}");
    assert!(lake[1][0].contains("stands 10 m above the ground from x -20 to 5 m: the line ends at (5, 10) m"));
}

/// Where the command fails, and the notes that stand above the error.
fn told(answer: &Outcome) -> (&str, Vec<&str>) {
    let mut lines: Vec<&str> = answer.stderr.lines().collect();
    (lines.pop().expect("an error"), lines)
}

#[test]
fn notes_were_dropped_where_every_block_is_held() {
    let place = Place::with(&slide("plan.json"));
    let plan = "{\"outline\": [[0, 0], [40, 0], [40, 24], [12, 24]], \"north\": 7, \"joints\": [[[60, 7], [61, 8]]]}";
    fs::write(place.path("plan.json"), plan).expect("written");
    let checked = place.enmm(&["check", "case.toml"]);
    let listed: Vec<&str> =
        checked.stdout.lines().filter(|line| line.starts_with("note: ") || line.starts_with("warning: ")).collect();
    assert!(listed.len() > 1 && listed[0].starts_with("warning: 1 joint trace cuts no rock"), "{listed:?}");
    assert_eq!(listed[1], "note: plan.json: keys not used: north");
    let answer = place.enmm(&["bound", "case.toml"]);
    let (error, above) = told(&answer);
    assert!(error.starts_with("error: ") && error.contains("every block is held"), "{error}");
    assert_eq!(above, listed);
    let found = place.enmm(&["bound", "case.toml", "--json"]).json();
    assert!(found["notes"].to_string().contains("keys not used: north"), "{found}");
    assert!(found["warnings"].to_string().contains("cuts no rock"), "{found}");
    // A search without end is no error, and has them all too.
    let answer = place.enmm(&["fos", "case.toml"]);
    assert!(answer.stdout.contains("the slope bears even F = 20"), "{answer:?}");
    answer.assert_printed(&listed);
    // A run needs no block that moves; it says how many notes there are.
    let answer = place.enmm(&["run", "case.toml"]);
    assert!(answer.stderr.contains("warning: 1 joint trace cuts no rock"), "{answer:?}");
    assert!(answer.stderr.contains("note: 1 note on the drawing and the build, see `enmm check`"), "{answer:?}");
}

#[test]
fn other_files_than_drawings_were_no_drawings() {
    let place = Place::with("");
    let table = "trace,x,y,law\no,0,0,outline\no,40,0,outline\no,40,24,outline\no,12,24,outline\np,3,7.2,Plane A\n\
                 p,30,28.8,Plane A\n";
    for (name, text, law) in [
        ("property.geojson", collection("\"Layer\": \"Plane A\""), "Plane A"),
        ("table.csv", table.to_owned(), "Plane A"),
        ("plain.geojson", collection(""), "joints"),
        ("text.wkt", "POLYGON ((0 0, 40 0, 40 24, 12 24))\nLINESTRING (3 7.2, 30 28.8)\n".to_owned(), "joints"),
    ] {
        fs::write(place.path(name), text).expect("written");
        let answer = place.answers(0, &["import", name, "--examples", "-o", &format!("{name}.toml")]);
        answer.assert_printed(&["coordinates are in metres", "outline", "joint ", law]);
        let case = fs::read_to_string(place.path(&format!("{name}.toml"))).expect("a case");
        assert!(case.contains("joint_law") && !case.contains("[layers"), "{case}");
        let (factor, warnings) = bound(&place, &format!("{name}.toml"));
        near(factor, FRICTION / SLOPE);
        assert!(warnings.is_empty(), "{warnings:?}");
    }
    place.enmm(&["import", "slope.shp"]).assert_bad_input(&["the extension is none of"]);
}

#[test]
fn states_of_another_keeper_were_damaged() {
    let place = Place::with(&crate::support::case(0.05));
    place.answers(0, &["run", "case.toml", "-o", "out"]);
    let loaded = enmm_io::load_case(&place.path("case.toml")).expect("a case");
    let mut model = loaded.cosimulation().expect("a model");
    let of_run = fs::read(place.path("out/checkpoint.enmm")).expect("a checkpoint");
    let saved = model.deserialize(&of_run).expect("the state of the run");
    model.restore(&saved).expect("of the same case");
    fs::write(place.path("model.enmm"), model.serialize(&saved).expect("bytes")).expect("written");
    let answer = place.answers(0, &["run", "case.toml", "-o", "out", "--resume", "model.enmm"]);
    assert!(answer.stderr.contains("goes on from the state of a host"), "{answer:?}");
    let of_fmu = enmm::model::bytes::encode(Keeper::Fmu, &0u8, "of an FMU").expect("bytes");
    let error = model.deserialize(&of_fmu).expect_err("refused").to_string();
    assert_eq!(error, "this is the state of an FMU, not of a library model: an instance of the same FMU continues it");
    fs::write(place.path("fmu.enmm"), of_fmu).expect("written");
    let answer = place.enmm(&["run", "case.toml", "-o", "out", "--resume", "fmu.enmm"]);
    answer.assert_bad_input(&["this is the state of an FMU, not of a run"]);
}

/// A set that fills a region of its own ends there on purpose; sets and bolts have their names.
#[test]
fn sets_at_their_own_region_were_held_by_rock() {
    let outline = "outline = [[0, 0], [40, 0], [40, 24], [12, 24]]";
    let set =
        "[[joint_set]]\nname = \"J1\"\nangle_deg = 38\nspacing = 3\nregion = [[14, 6], [36, 6], [36, 19], [14, 19]]\n";
    let text = slide("none.json").replace("geometry_file = \"none.json\"", outline);
    let text = text.replace("[[fix]]", &format!("{set}[[joint]]\npoints = [[36.8, 2], [36.8, 23]]\n[[fix]]"));
    let place = Place::with(&text);
    let checked = place.answers(0, &["check", "case.toml"]);
    let held: Vec<&str> = checked.stdout.lines().filter(|line| line.contains("intact rock holds")).collect();
    assert!(held.iter().all(|line| !line.contains("J1 ends")), "{held:?}");
    // Two ends of a joint in the rock, near the lines of a set: these are called by their names.
    let near = text.replace("[[36.8, 2], [36.8, 23]]", "[[20, 10], [22, 11]]");
    let near = near.replace(outline, &format!("{outline}\nnear_ends = 2.0"));
    fs::write(place.path("case.toml"), near).expect("written");
    let checked = place.enmm(&["check", "case.toml"]);
    assert!(checked.stdout.contains(" J1") && !checked.stdout.contains("joint_set[0]"), "{checked:?}");
}
