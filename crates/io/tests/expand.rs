//! Claim: dips, persistence, K0, bolt patterns, cuts and `duration_max` mean the plain case that they stand for, and
//! every way into the engine gets that.

use std::path::Path;

use crate::common::{run_all, simulation};
use enmm::model::Simulation;
use enmm::model::case::{Bolt, Case, Side};
use enmm_io::{LoadedCase, parse_case};

const REST: &str = "[rock.rock]\ndensity = 2500\nyoung = 1e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 35\n\
                    [[fix]]\nedge = [[0, 0], [20, 0]]\n";
const STAGE: &str = "[[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration = 5.0\n";

/// A rock of 20 m by 10 m with these keys; `stages` are the last of it.
fn text(keys: &str, stages: &str) -> String {
    format!(
        "title = \"words\"\n[domain]\noutline = [[0, 0], [20, 0], [20, 10], [0, 10]]\n[mesh]\nsize = 2.0\n{keys}{REST}\
         {stages}"
    )
}

fn loaded(text: &str) -> LoadedCase {
    parse_case(text, "case.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

fn error(text: &str) -> String {
    parse_case(text, "case.toml", Path::new("")).unwrap_err().to_string()
}

/// Asserts that two cases are one: values, fingerprint, and what an FMU would read of it.
fn assert_same(written: &str, plain: &str) {
    let (written, plain) = (loaded(written), loaded(plain));
    assert_eq!(written.case, plain.case);
    assert_eq!(written.hash, plain.hash);
    let packed = serde_json::to_string(&written.case).unwrap();
    let again = LoadedCase::of(serde_json::from_str::<Case>(&packed).unwrap(), "again").unwrap();
    assert_eq!((&again.case, &again.hash, again.warnings.len()), (&written.case, &written.hash, 0));
}

#[test]
fn a_dip_has_a_side_and_an_angle_none() {
    let set = |keys: &str| text(&format!("[[joint_set]]\n{keys}\nspacing = 3.0\n"), STAGE);
    let plain = set("angle_deg = 40");
    assert_same(&set("dip_deg = 40\ndips = \"left\""), &plain);
    assert_same(&set("dip_deg = 40\ndips = \"right\""), &set("angle_deg = -40"));
    assert_eq!(loaded(&plain).warnings, [""; 0]);
    assert_same(&set("angle_deg = 40\nangle_sd_deg = 3"), &set("angle_deg = 40\ndip_sd_deg = 3"));
    for (keys, message) in [
        ("", "joint_set[0]: has no direction; add `angle_deg`"),
        ("dip_deg = 40\nangle_deg = 3", "joint_set[0].dip_deg: is 40, and `angle_deg` is 3; keep one of them"),
        ("angle_deg = 40\ndips = \"left\"", "joint_set[0].dips: belongs to `dip_deg`, which is not given"),
        ("dip_deg = 112\ndips = \"left\"", "case.toml:7: joint_set[0].dip_deg: is 112 degrees, must be at least 0"),
        ("dip_deg = 40\ndip_direction_deg = 90", "joint_set[0].dip_direction_deg: is 90, but the case does not say"),
        ("dip_deg = 40", "case.toml:7: joint_set[0].dip_deg: is 40, but its side is missing; add `dips = \"left\"`"),
        ("angle_deg = 400", "joint_set[0].angle_deg: is 400 degrees, must be at least -360 and at most 360"),
        ("angle_deg = 1\nangle_sd_deg = 3\ndip_sd_deg = 2", "joint_set[0].angle_sd_deg: is 3, and `dip_sd_deg`"),
        ("angle_deg = 1\nangle_sd_deg = 31", "angle_sd_deg: is 31 degrees, must be at least 0 and at most 30"),
        ("angle_deg = 1\nspacing_sd = 3.1", "joint_set[0].spacing_sd: is 3.1 m, must be at most the mean, 3 m"),
    ] {
        assert!(error(&set(keys)).contains(message), "{}", error(&set(keys)));
    }
    // Values that pass the checks can be built.
    for keys in ["angle_deg = 1\nangle_sd_deg = 30", "angle_deg = 1\nspacing_sd = 3.0"] {
        Simulation::new(loaded(&set(keys)).case).unwrap_or_else(|error| panic!("{keys}: {error}"));
    }
    assert_eq!(serde_json::to_string(&Side::Left).unwrap(), "\"left\"");
}

/// tan(apparent dip) = tan(dip)·cos(angle between dip direction and section): D. M. Ragan, Structural Geology.
#[test]
fn the_section_cuts_joints_at_their_apparent_dip() {
    let section = |dip: f64, direction: f64, azimuth: f64| {
        let keys = format!(
            "[section]\nazimuth_deg = {azimuth:?}\n[[joint_set]]\ndip_deg = {dip:?}\ndip_direction_deg = \
             {direction:?}\nspacing = 3.0\nspacing_sd = 0.5\n"
        );
        text(&keys, STAGE)
    };
    for (dip, direction, azimuth) in
        [(60.0, 120.0, 90.0), (60.0, 300.0, 90.0), (35.0, 10.0, 350.0), (75.0, 200.0, 90.0)]
    {
        let set = loaded(&section(dip, direction, azimuth)).case.joint_sets.remove(0);
        let off = f64::to_radians(direction - azimuth);
        let apparent = (f64::to_radians(dip).tan() * off.cos()).atan().to_degrees();
        assert!((set.angle_deg.unwrap() + apparent).abs() < 1e-12, "{set:?}");
        // The pole (sin dip cos off, sin dip sin off, cos dip): its part in the section stretches the spacing.
        let out = f64::to_radians(dip).sin() * off.sin();
        assert!((set.spacing * (1.0 - out * out).sqrt() - 3.0).abs() < 1e-12, "{set:?}");
        assert!((set.spacing_sd / set.spacing - 0.5 / 3.0).abs() < 1e-12, "{set:?}");
    }
    // Pictures and the report show the azimuth; the model, and what is stored of it, do not depend on it.
    let [with, without] = ["[section]\nazimuth_deg = 90\n", ""].map(|section| loaded(&text(section, STAGE)));
    assert_eq!((with.warnings.len(), &with.hash), (0, &without.hash));
    assert_eq!(with.case.section.map(|section| section.azimuth_deg), Some(90.0));
    let refused = error(&section(88.0, 180.0, 90.0));
    assert!(refused.contains("joint_set[0]: the joints lie within 2.0° of the section"), "{refused}");
}

#[test]
fn persistence_stands_for_gap_or_length() {
    let set = |keys: &str| text(&format!("[[joint_set]]\nangle_deg = 10\nspacing = 3.0\n{keys}\n"), STAGE);
    assert_same(&set("trace_length = 3.0\npersistence = 0.75"), &set("trace_length = 3.0\ngap = 1.0"));
    assert_same(&set("gap = 1.0\npersistence = 0.75"), &set("trace_length = 3.0\ngap = 1.0"));
    assert_same(&set("persistence = 1.0"), &set(""));
    for (keys, message) in [
        ("trace_length = 3.0\ngap = 1.0\npersistence = 0.5", "but `trace_length` and `gap` make it 0.7500; keep two"),
        ("persistence = 0.5", "joint_set[0].persistence: is 0.5, which needs a length; add `trace_length` or `gap`"),
        (
            "trace_length = 3.0\npersistence = 1.5",
            "joint_set[0].persistence: is 1.5, must be greater than 0 and at most 1",
        ),
        ("fisher_k = 20", "joint_set[0].fisher_k: is 20, but the angles are not Fisher's"),
        ("angle_distribution = \"fisher\"", "which needs `fisher_k`, the concentration"),
        ("spacing_distribution = \"lognormal\"", "joint_set[0].spacing_sd: is 0 m, so that `spacing_distribution`"),
        ("spacing_distribution = \"uniform\"\nspacing_sd = 2", "must be at most 1.732051 m, the mean over √3"),
        ("spacing_distribution = \"exponential\"\nspacing_sd = 2", "of an exponential distribution is its mean, 3 m"),
        ("trace_length_distribution = \"uniform\"", "has no effect on joints that do not end; add `trace_length`"),
        ("origin = [0, 99]", "joint_set[0]: "),
        (
            "ends_on = \"fault\"\ntrace_length = 9",
            "no joint law is named \"fault\", did you mean \"joint\"?; sets: none",
        ),
    ] {
        let text = set(keys);
        let error = match parse_case(&text, "case.toml", Path::new("")) {
            Err(error) => error.to_string(),
            Ok(loaded) => Simulation::new(loaded.case).map(|_| ()).unwrap_err().to_string(),
        };
        assert!(error.contains(message), "{error}");
    }
}

/// Bedding at y = 1, 3, 5, …; upright joints that end on it.
#[test]
fn joints_end_on_others() {
    let keys = "[[joint_set]]\nname = \"bedding\"\nangle_deg = 0\nspacing = 2.0\norigin = [0, 1]\n\
                [[joint_set]]\nangle_deg = 90\nspacing = 1.0\ntrace_length = 3.0\ngap = 1.0\nends_on = \"bedding\"\n";
    let simulation = simulation(&text(keys, STAGE));
    let upright = simulation.built().traces.iter().filter(|(points, _)| (points[0].x - points[1].x).abs() < 1e-9);
    let mut ends = [0; 2];
    for (points, _) in upright {
        let [low, high] = [points[0].y.min(points[1].y), points[0].y.max(points[1].y)];
        let bedding = |y: f64| ((y - 1.0) / 2.0 - ((y - 1.0) / 2.0).round()).abs() < 1e-9;
        ends[usize::from(bedding(low) && bedding(high))] += 1;
        let layer = |y: f64| ((y - 1.0) / 2.0).floor();
        assert_eq!(layer(low + 1e-6), layer(high - 1e-6), "{low} to {high} crosses the bedding");
    }
    assert!(ends[0] > 5 && ends[1] > 15, "{ends:?}");
}

#[test]
fn joints_in_a_region_take_its_law() {
    let keys = "[[joint]]\npoints = [[-1, 5], [21, 5]]\nlaw = \"joint\"\n[[joint_set]]\nangle_deg = 90\nspacing = 5.0\n\
                law = \"strong\"\n[[law_region]]\nregion = [[4, 0], [9, 0], [9, 10], [4, 10]]\nfrom = \"joint\"\n\
                to = \"weathered\"\n[joint_law.strong]\nfriction_deg = 50\n[joint_law.weathered]\nfriction_deg = 20\n";
    let changed = simulation(&text(keys, STAGE));
    let plain = keys.split("[[law_region]]").next().unwrap().to_owned() + "[joint_law.strong]\nfriction_deg = 50\n";
    let plain = simulation(&text(&plain, STAGE));
    assert_eq!(changed.model().covers.block_count(), plain.model().covers.block_count());
    let length = |name: &str| -> f64 {
        let law = changed.case().joint_laws.keys().position(|law| law == name).unwrap();
        let traces = changed.built().traces.iter().filter(|(_, of)| of.index() == law);
        traces.flat_map(|(points, _)| points.windows(2)).map(|pair| (pair[1] - pair[0]).norm()).sum()
    };
    assert!((length("weathered") - 5.0).abs() < 1e-9 && (length("joint") - 17.0).abs() < 1e-9);
    assert!((length("strong") - 40.0).abs() < 1e-9, "{}", length("strong"));
    let idle = "law_region[0]: no joint in it takes the law \"weathered\"; correct or remove it";
    assert!(!changed.built().warnings.iter().any(|warning| warning == idle), "{:?}", changed.built().warnings);
    let away = simulation(&text(&keys.replace("[9, 10], [4, 10]]", "[9, 1], [4, 1]]"), STAGE));
    assert!(away.built().warnings.iter().any(|warning| warning == idle), "{:?}", away.built().warnings);
    let wrong = error(&text(&keys.replace("to = \"weathered\"", "to = \"wethered\""), STAGE));
    assert!(wrong.contains("law_region[0].to: no joint law is named \"wethered\", did you mean"), "{wrong}");
}

#[test]
fn k0_is_the_weight_of_the_rock_above() {
    let weight = 2500.0 * 9.81;
    let plain = format!(
        "[in_situ]\nsxx = 0.0\nsyy = 0.0\ngradient = [{:?}, {weight:?}, 0.0]\ny_reference = 10.0\n",
        0.5 * weight
    );
    assert_same(&text("[in_situ]\nk0 = 0.5\n", STAGE), &text(&plain, STAGE));
    let deep = plain.replace("y_reference = 10.0", "y_reference = 100.0");
    assert_same(&text("[in_situ]\nk0 = 0.5\ny_reference = 100\ndensity = 2500\n", STAGE), &text(&deep, STAGE));
    for (keys, message) in [
        ("[in_situ]\nk0 = 0.5\nsyy = -1e6\n", "in_situ.syy: follows from `k0` and the weight of the rock; remove it"),
        ("[in_situ]\nsyy = -1e6\n", "in_situ.sxx: is missing; add `sxx = -1e6` (Pa, tension positive), or give `k0`"),
        ("[in_situ]\nk0 = -0.5\n", "in_situ.k0: is -0.5, must be at least 0 and at most 20"),
        ("[in_situ]\nk0 = 0.5\n[gravity]\ny = 0\n", "in_situ.k0: needs gravity that acts straight down"),
    ] {
        assert!(error(&text(keys, STAGE)).contains(message), "{}", error(&text(keys, STAGE)));
    }
    // Rock under its own weight with K0 = ν/(1−ν) between smooth sides is at rest from the start: strain ε_xx is 0.
    let sides = "[[fix]]\nedge = [[0, 0], [0, 10]]\naxes = \"x\"\n[[fix]]\nedge = [[20, 0], [20, 10]]\naxes = \"x\"\n\
                 [[monitor]]\nname = \"top\"\npoint = [10, 10]\n";
    let k0 = 0.25 / 0.75;
    let mut simulation = simulation(&text(&format!("[in_situ]\nk0 = {k0:?}\n{sides}"), STAGE));
    run_all(&mut simulation);
    // Without in-situ stress the top sinks by ρ·g·h²/(2·(λ+2μ)), 1.0e-3 m.
    let sunk = simulation.monitor(0).0.norm();
    assert!(sunk < 2e-5, "{sunk}");
}

/// A face at x = 12 − 0.5·y above y = 2: heads lie on it, whether the line lies before or behind it.
#[test]
fn heads_of_a_bolt_pattern_lie_on_the_face() {
    let outline = "[[0, 0], [12, 0], [11, 2], [7, 10], [0, 10]]";
    let case = |line: &str, keys: &str| {
        let bolts = format!(
            "[[bolt_pattern]]\nname = \"rows\"\nline = {line}\n{keys}\nlength = 3.0\nangle_deg = 170\nyoung = 2e11\n\
             area = 5e-4\nspacing = 2.0\nactive = false\n"
        );
        let stage = STAGE.to_owned() + "install = [\"rows\"]\n";
        text(&bolts, &stage).replace("[[0, 0], [20, 0], [20, 10], [0, 10]]", outline).replace("[20, 0]]", "[12, 0]]")
    };
    for line in ["[[11, 3], [8, 9]]", "[[11.5, 2.9], [8.5, 8.9]]"] {
        let case = loaded(&case(line, "count = 4")).case;
        assert_eq!(case.bolts.len(), 4);
        for bolt in &case.bolts {
            let [[x, y], [far_x, far_y]] = bolt.points;
            assert!((x - (12.0 - 0.5 * y)).abs() < 1e-12, "{bolt:?}");
            let direction = [(far_x - x) / 3.0, (far_y - y) / 3.0];
            let (sin, cos) = 170f64.to_radians().sin_cos();
            assert!((direction[0] - cos).abs() < 1e-12 && (direction[1] - sin).abs() < 1e-12, "{bolt:?}");
        }
        assert_eq!(case.stages[0].install, ["rows_1", "rows_2", "rows_3", "rows_4"]);
    }
    let by_distance = loaded(&case("[[10.5, 3], [10.5, 8]]", "distance = 2.5")).case;
    assert_eq!(by_distance.bolts.len(), 3);
    let bar = |(k, bolt): (usize, &Bolt)| {
        let (number, points) = (k + 1, bolt.points);
        format!(
            "[[bolt]]\nname = \"rows_{number}\"\npoints = {points:?}\nyoung = 2e11\narea = 5e-4\nspacing = 2.0\n\
             active = false\n"
        )
    };
    let plain: String = by_distance.bolts.iter().enumerate().map(bar).collect();
    let written = case("[[10.5, 3], [10.5, 8]]", "distance = 2.5");
    let start = written.find("[[bolt_pattern]]").unwrap();
    let rest = written[start..].find("[rock.rock]").unwrap() + start;
    let plain = written[..start].to_owned() + &plain + &written[rest..];
    let names = "install = [\"rows_1\", \"rows_2\", \"rows_3\"]";
    assert_same(&written, &plain.replace("install = [\"rows\"]", names));
    for (line, keys, message) in [
        ("[[11, 3], [8, 9]]", "", "bolt_pattern[0]: has neither of `count` and `distance`, must have exactly 1"),
        ("[[11, 3], [8, 90]]", "count = 2", "bolt 2 through (8, 90) m at 170° meets no face of the rock"),
        ("[[11, 3], [8, 9]]", "count = 4\npretension = -1", "bolt_pattern[0].pretension: is -1 N, must be at least 0"),
        ("[[11, 3], [8, 9]]", "distance = 1e-9", "bolt_pattern[0].distance: is 0.000000001 m, which gives 6708203933"),
    ] {
        assert!(error(&case(line, keys)).contains(message), "{}", error(&case(line, keys)));
    }
    // Too long: the far end is in the air, and the error names the pattern.
    let long = loaded(&case("[[11, 3], [8, 9]]", "count = 4").replace("length = 3.0", "length = 40.0"));
    let invalid = Simulation::new(long.case.clone()).map(|_| ()).unwrap_err();
    let error = long.source.locate(&invalid.key, &invalid.message).to_string();
    assert!(error.starts_with("case.toml:8: bolt_pattern[0].line: "), "{error}");
}

/// Half of the rock hangs on a cut: it sinks by its elasticity alone, of the order ρ·g·L²/E = 2500·9.81·100/1e9 m, and
/// does not open. Then a stage takes it away.
#[test]
fn a_cut_holds_until_a_stage_digs_along_it() {
    let keys = "[[cut]]\npoints = [[10, -1], [10, 11]]\n[[monitor]]\nname = \"end\"\npoint = [20, 10]\n";
    let stages = "[[stage]]\nname = \"hang\"\nkind = \"static\"\nduration_max = 5.0\n[[stage]]\nname = \"dig\"\n\
                  kind = \"static\"\nduration_max = 5.0\nexcavate_region = [[10, 0], [20, 0], [20, 10], [10, 10]]\n";
    let mut simulation = simulation(&text(keys, stages).replace("edge = [[0, 0], [20, 0]]", "block = [5, 5]"));
    let laws = &simulation.case().joint_laws;
    assert_eq!(laws.keys().collect::<Vec<_>>(), ["cut", "joint"]);
    assert_eq!(simulation.case().default_joint_law(), Some("joint"));
    let report = crate::common::run_stage(&mut simulation);
    assert!(simulation.at_rest(&report));
    let sunk = simulation.monitor(0).0.y;
    assert!((-0.02..-1e-4).contains(&sunk), "{sunk}");
    let glued = simulation.contacts();
    assert!(!glued.is_empty());
    assert!(simulation.next_stage().unwrap());
    let report = crate::common::run_stage(&mut simulation);
    assert!(simulation.at_rest(&report) && simulation.contacts().is_empty());
}

#[test]
fn joints_do_not_take_the_law_of_cuts_by_default() {
    let keys = "[[cut]]\npoints = [[10, -1], [10, 11]]\n[[joint]]\npoints = [[0, 5], [20, 5]]\n";
    let text = text(keys, STAGE).replace("[joint_law.joint]\nfriction_deg = 35\n", "");
    assert!(error(&text).contains("joint_law: joint[0] needs a joint law, but there is none"), "{}", error(&text));
    let alone = text.replace("[[joint]]\npoints = [[0, 5], [20, 5]]\n", "");
    assert_eq!(loaded(&alone).case.joint_laws.len(), 1);
}

#[test]
fn static_stages_may_take_at_most_duration_max() {
    let stage = |kind: &str, keys: &str| text("", &format!("[[stage]]\nname = \"a\"\nkind = \"{kind}\"\n{keys}\n"));
    assert_same(&stage("static", "duration_max = 5.0"), &stage("static", "duration = 5.0"));
    for (kind, keys, message) in [
        (
            "dynamic",
            "duration_max = 5",
            "stage[0].duration_max: is 5 s, but a dynamic stage takes its whole `duration`",
        ),
        ("static", "duration = 4\nduration_max = 5", "stage[0].duration_max: is 5 s, and `duration` is 4 s; keep one"),
        ("static", "", "stage[0].duration: is missing or 0 s, must be greater than 0 and at most 1e9"),
        ("static", "duration_max = -5", "case.toml:17: stage[0].duration_max: is -5 s, must be greater than 0"),
    ] {
        assert!(error(&stage(kind, keys)).contains(message), "{}", error(&stage(kind, keys)));
    }
}

#[test]
fn a_case_that_is_not_expanded_is_refused() {
    let mut case = loaded(&text("", STAGE)).case;
    case.stages[0].duration_max = Some(3.0);
    let invalid = Simulation::new(case).map(|_| ()).unwrap_err();
    assert!(invalid.to_string().starts_with("stage: is not expanded; load the case through `enmm_io`"), "{invalid}");
}

/// A drawn table moves with its shift, and so do level surfaces of stages; a shift of nothing is none.
#[test]
fn a_shift_moves_all_surfaces_of_the_water() {
    let stage = |level: &str| format!("{STAGE}[[stage]]\nname = \"later\"\nkind = \"static\"\nduration = 1.0\n{level}");
    let water = |keys: &str| format!("[water]\n{keys}\n");
    for (written, plain) in [
        ("table = [[0, 4], [20, 6.5]]\nshift = -1.25", "table = [[0, 2.75], [20, 5.25]]"),
        ("level = 4.0\nshift = 0.5", "level = 4.5"),
        ("level = 4.0\nshift = 0", "level = 4.0"),
    ] {
        assert_same(&text(&water(written), STAGE), &text(&water(plain), STAGE));
    }
    let shifted = text(&water("level = 6.0\nshift = 1.0"), &stage("water = { table = [[0, 2], [20, 3]] }\n"));
    let plain = text(&water("level = 7.0"), &stage("water = { table = [[0, 3], [20, 4]] }\n"));
    assert_same(&shifted, &plain);
    let told = error(&text(&water("shift = 1.0"), STAGE));
    assert!(told.contains("water: has 0 of `level` and `table`"), "{told}");
    let told = error(&text(&water("level = 4.0\nshift = 1e30"), STAGE));
    assert!(told.contains("water.shift") && told.contains("1e30"), "{told}");
    let mut bare = loaded(&text(&water("level = 4.0"), STAGE)).case;
    bare.water.iter_mut().for_each(|water| water.shift = Some(1.0));
    assert!(bare.validate().expect_err("it is not expanded").to_string().starts_with("water: is not expanded"));
}
