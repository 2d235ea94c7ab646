//! Values that are mostly slips in a unit or a sign are reported with the usual range, traces without effect with their
//! place; a stage shorter than a step is refused. All of them once passed in silence.

use std::path::Path;

use enmm::model::Simulation;
use enmm::model::assemble::ignored_traces;
use enmm_io::{LoadedCase, load_case, parse_case};

/// A block of 10 m by 6 m on its base, with nothing unusual.
const CASE: &str = "title = \"t\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 6], [0, 6]]\n[mesh]\nsize = 1.5\n\
                    [rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
                    [[fix]]\nedge = [[0, 0], [10, 0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.5\n";

fn loaded(text: &str) -> LoadedCase {
    parse_case(text, "case.toml", Path::new("")).expect("reads")
}

fn warnings(text: &str) -> Vec<String> {
    let LoadedCase { case, mut warnings, .. } = loaded(text);
    warnings.extend(Simulation::new(case).expect("builds").built().warnings.iter().cloned());
    warnings
}

#[test]
fn each_slip_is_told_with_its_key_value_and_range() {
    assert_eq!(warnings(CASE), [""; 0]);
    let outline = "outline = [[0, 0], [10, 0], [10, 6], [0, 6]]";
    let millimetres = CASE.replace(outline, "outline = [[0, 0], [30000, 0], [30000, 15000], [0, 15000]]");
    let slip = |from: &str, to: &str| CASE.replace(from, to);
    let set = "[[joint_set]]\nangle_deg = 0\nspacing = 0.1\nregion = [[-1, 2], [11, 2], [11, 2.5], [-1, 2.5]]\n";
    let millimetres = millimetres.replace("size = 1.5", "size = 3000").replace("[10, 0]]", "[30000, 0]]");
    for (text, parts) in [
        (CASE.replace("50e9", "9e4"), ["rock.granite.young: is 90000 Pa", "1e9 to 1e11 Pa"]),
        (CASE.replace("2650", "26.5"), ["rock.granite.density: is 26.5 kg/m³", "looks like kN/m³: write 2701"]),
        (CASE.replace("[[fix]]", "[gravity]\ny = 9.81\n[[fix]]"), ["gravity.y: is 9.81 m/s²", "upwards"]),
        (CASE.replace("[[fix]]\nedge = [[0, 0], [10, 0]]\n", ""), ["fix: there is none", "falls"]),
        (CASE.replace("size = 1.5", "size = 11"), ["mesh.size: is 11 m", "the whole model"]),
        (CASE.replace("[[fix]]", "[in_situ]\nsxx = 1e6\nsyy = -1e6\n[[fix]]"), ["in_situ: pulls", "by 1.000e6 Pa"]),
        (CASE.replace("edge = [[0, 0], [10, 0]]", "edge = [[-45, 0], [55, 0]]"), ["fix[0].edge: is 100", "only 10"]),
        (
            slip("friction_deg = 30", "friction_deg = 30\ncohesion = 20"),
            ["joint_law.j.cohesion: is 20 Pa", "20 looks like kPa: write 20000"],
        ),
        (
            CASE.replace("friction_deg = 30", "friction_deg = 0.7"),
            ["joint_law.j.friction_deg: is 0.7°", "tangent of 35.0°"],
        ),
        (
            CASE.replace("[[fix]]", "[water]\nlevel = 430\n[[fix]]"),
            ["water.level: reaches y = 430 m", "0.000000 and 6"],
        ),
        (
            CASE.replace("[[fix]]", "[water]\ntable = [[0, 7], [10, 7]]\n[[fix]]"),
            ["water.table: reaches y = 7 m", "holds it"],
        ),
        (CASE.replace("[[fix]]", &format!("{set}[[fix]]")), ["joint_set[0].spacing: is 0.1 m", "0.15"]),
        (
            CASE.replace("[[fix]]", "[[bolt]]\npoints = [[2, 2], [4, 2]]\nyoung = 2e11\narea = 5e-4\n[[fix]]"),
            ["bolt[0]: both ends lie in one block", "both sides of a joint"],
        ),
        (millimetres, ["domain.outline: the rock is 30000", "millimetres by 1000"]),
    ] {
        let told = warnings(&text);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(parts.iter().all(|part| told[0].contains(part)), "{parts:?}: {told:?}");
    }
}

/// Rock dilates by its friction angle only where a case says so, and is told from a third of that on.
#[test]
fn rock_that_dilates_much_is_told() {
    let told = |strength: &str| {
        let text = CASE.replace("poisson = 0.25", &format!("poisson = 0.25\n{strength}"));
        warnings(&text).into_iter().find(|warning| warning.contains("dilates by"))
    };
    let mass = "sigma_ci = 50e6, mi = 10, gsi = 45";
    for (strength, by) in [
        ("cohesion = 1e5\nfriction_deg = 39", None),
        ("cohesion = 1e5\nfriction_deg = 39\ndilation_deg = 13", None),
        ("cohesion = 1e5\nfriction_deg = 39\ndilation_deg = 14", Some("14° (φ 39.000°)")),
        ("cohesion = 1e5\nfriction_deg = 39\ndilation_deg = 39", Some("39° (associated)")),
        (&format!("hoek_brown = {{ {mass} }}"), None),
        (
            &format!("hoek_brown = {{ {mass}, associated = true }}"),
            Some("its friction angle at each stress (associated)"),
        ),
        (&format!("dilation_deg = 40\nhoek_brown = {{ {mass} }}"), Some("40° (φ ")),
    ] {
        let start = by.map(|by| format!("rock.granite: dilates by {by}"));
        let (told, start) = (told(strength).unwrap_or_default(), start.unwrap_or_default());
        assert!(told.starts_with(&start) && told.is_empty() == start.is_empty(), "{strength}: {told}");
    }
}

#[test]
fn ignored_traces_are_named_with_their_places() {
    let away: String = (20..27).map(|x| format!("[[joint]]\npoints = [[{x}, 1], [{x}, 2.5]]\n")).collect();
    let told = warnings(&CASE.replace("[[fix]]", &format!("[[joint]]\npoints = [[-1, 3], [11, 3]]\n{away}[[fix]]")));
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("7 joint traces cut no rock"), "{told:?}");
    assert!(told[0].contains("joint[1] from (20.000000, 1.000000) to (20.000000, 2.500000) m"), "{told:?}");
    assert!(told[0].contains("joint[5]") && !told[0].contains("joint[6]"), "{told:?}");
    assert!(told[0].ends_with("and 2 more"), "{told:?}");
}

/// Some traces of a set always lie beside the rock: that is no news. A set of which all do is.
#[test]
fn a_set_that_misses_the_rock_is_told() {
    let set = |keys: &str| {
        CASE.replace("[[fix]]", &format!("[[joint_set]]\nangle_deg = 20\nspacing = 1.0\nseed = 1\n{keys}\n[[fix]]"))
    };
    let around = "region = [[-5, -5], [15, -5], [15, 15], [-5, 15]]";
    let told = warnings(&set(around));
    assert!(told.iter().all(|warning| warning.contains("merged within the snap tolerance")), "{told:?}");
    let simulation = Simulation::new(loaded(&set(around)).case).expect("builds");
    assert!(!ignored_traces(&simulation.built().noding).is_empty(), "the region reaches beyond the rock");
    let told = warnings(&set("region = [[20, 0], [25, 0], [25, 5], [20, 5]]"));
    assert!(told.iter().any(|warning| warning.starts_with("joint_set[0]: none of its ")), "{told:?}");
}

#[test]
fn a_stage_shorter_than_a_step_is_refused() {
    // With 50 Pa instead of 50 GPa waves take seconds through an element, and one step was longer than the stage.
    let error = Simulation::new(loaded(&CASE.replace("50e9", "50")).case).expect_err("no step fits").to_string();
    assert!(error.starts_with("stage[0].duration: is 0.5 s, less than one internal step of "), "{error}");
}

#[test]
fn the_examples_have_nothing_unusual() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cases");
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let loaded = load_case(&path).expect("reads");
            let simulation = Simulation::new(loaded.case).expect("builds");
            let told = &simulation.built().warnings;
            let known = |warning: &String| warning.contains("merged") || warning.contains("cut no rock");
            assert!(told.iter().all(known), "{told:?}");
        }
    }
}
