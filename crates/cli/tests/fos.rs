//! Claim: `enmm fos` finds the factor of safety of a block on an incline, writes its results and answers with the
//! promised statuses.

use std::fs;

use crate::extent::by_extent;
use crate::support::{Place, ROAD_CUT, incline, json};

#[test]
fn stages_that_are_left_out_are_told_once() {
    let place = Place::with(&incline(0.65, "[[stage]]\nname = \"quake\"\nkind = \"dynamic\"\nduration = 0.1\n"));
    let answer = place.answers(0, &["fos", "case.toml", "--tolerance", "0.1"]);
    let told = format!("{}{}", answer.stderr, answer.stdout);
    assert_eq!(told.matches("are left out: quake").count(), 1, "{answer:?}");
    let found = json(&place.path("case/fos/fos.json"));
    assert!(found["warnings"].to_string().contains("are left out: quake"), "{found}");
}

#[test]
fn run_fos_and_bound_of_one_case_leave_a_page_each() {
    let place = Place::with(&incline(0.65, ""));
    let pages = ["case/report.html", "case/fos/report.html", "case/bound/report.html"];
    let read = |page: &str| fs::read(place.path(page)).expect("a page");
    let mut first = Vec::new();
    for (command, page) in ["run", "fos", "bound"].into_iter().zip(pages) {
        let answer = place.answers(0, &[command, "case.toml"]);
        assert!(answer.stdout.contains(page), "{answer:?}");
        first.push(read(page));
    }
    for (page, first) in pages.into_iter().zip(first) {
        assert!(read(page) == first, "{page} was replaced");
    }
    assert_eq!(place.names(), ["case", "case.toml"], "one folder for a case");
}

#[test]
fn a_search_for_tables_alone_removes_the_drawings_of_the_search_before() {
    let place = Place::with(&incline(0.65, ""));
    let search = ["fos", "case.toml", "-o", "out", "--tolerance", "0.1"];
    let left = |words: &[&str]| {
        place.answers(0, words);
        place.names_in("out")
    };
    assert_eq!(
        left(&search),
        ["failure.png", "failure.svg", "fos.csv", "fos.json", "fos.png", "fos.svg", "report.html"]
    );
    assert_eq!(left(&[&search[..], &["--no-pictures"]].concat()), ["fos.csv", "fos.json"]);
}

/// FoS = tan φ/tan a = 2·tan φ; the bracket of 1 % about it, and 0.5 % for the judge.
#[test]
fn a_block_on_an_incline_has_the_factor_of_its_tangents() {
    let place = Place::with(&incline(0.65, ""));
    let answer = place.answers(0, &["fos", "case.toml", "-o", "out", "--tolerance", "0.01"]);
    assert!(answer.stdout.contains("factor of safety") && answer.stdout.contains("verdict"), "{answer:?}");
    for name in ["fos.json", "fos.csv", "fos.png", "failure.png"] {
        assert!(fs::metadata(place.path("out").join(name)).is_ok_and(|file| file.len() > 0), "{name}");
    }
    let found = json(&place.path("out/fos.json"));
    let factor = found["factor_of_safety"].as_f64().expect("a factor");
    assert!((factor / 1.3 - 1.0).abs() < 0.01, "{factor}");
    assert_eq!(found["status"], "found");
    let bound = found["bound"]["level_tops"]["factor"].as_f64().expect("a bound");
    assert!((bound / 1.3 - 1.0).abs() < 3e-4 && answer.stdout.contains("limit analysis"), "{bound}");
    assert!(answer.stdout.contains("1 of ~") && answer.stdout.contains("100.0 % of the free rock"), "{answer:?}");
    assert_eq!((&found["failing"]["blocks"], &found["failing"]["share"]), (&1.into(), &1.0.into()));
    let failing = found["failing_blocks"].as_array().expect("blocks");
    assert_eq!(failing.len(), 1, "{failing:?}");
    assert!(failing[0]["place"][0].as_f64().is_some_and(|x| (2.4..4.0).contains(&x)), "{failing:?}");
    let trials = found["trials"].as_array().expect("trials").len();
    assert_eq!(fs::read_to_string(place.path("out/fos.csv")).expect("a table").lines().count(), 1 + trials);
}

#[test]
fn threads_change_nothing_and_json_is_the_file() {
    let place = Place::with(&incline(0.4, ""));
    let mut texts = Vec::new();
    for threads in ["1", "2"] {
        let arguments = ["fos", "case.toml", "--json", "-o", threads, "--threads", threads, "--tolerance", "0.02"];
        let printed = place.answers(0, &arguments).json();
        assert_eq!(printed, json(&place.path(threads).join("fos.json")));
        texts.push(fs::read_to_string(place.path(threads).join("fos.csv")).expect("a table"));
        assert!((printed["factor_of_safety"].as_f64().expect("a factor") / 0.8 - 1.0).abs() < 0.015, "{printed}");
        assert_eq!(printed["rest"]["strength_factor"], 1000.0, "its joints hold until the trials begin");
    }
    let without_wall = |text: &str| -> Vec<String> {
        text.lines().map(|line| line.rsplit_once(',').expect("columns").0.to_owned()).collect()
    };
    assert_eq!(without_wall(&texts[0]), without_wall(&texts[1]));
}

#[test]
fn a_slope_that_cannot_fail_in_range_has_at_least_its_end() {
    let place = Place::with(&incline(0.65, ""));
    let answer = place.answers(0, &["fos", "case.toml", "-o", "out", "--low", "0.9", "--high", "1.1"]);
    assert!(answer.stdout.contains("at least 1.1") && answer.stdout.contains("--high"), "{answer:?}");
    let found = json(&place.path("out/fos.json"));
    assert_eq!((&found["status"], found["at_least"].as_f64()), (&"stable_throughout".into(), Some(1.1)));
}

#[test]
fn bad_input_exits_with_2_and_writes_nothing() {
    let place = Place::with(&incline(0.65, "").replace("\"static\"", "\"dynamic\""));
    place.enmm(&["fos", "case.toml"]).assert_bad_input(&["case.toml:", "stage", "static"]);
    place.enmm(&["fos", "none.toml"]).assert_bad_input(&["none.toml"]);
    place.enmm(&["fos", "case.toml", "--tolerance", "0"]).assert_bad_input(&["--tolerance", "0.5"]);
    place.enmm(&["fos", "case.toml", "--least-area=-1"]).assert_bad_input(&["--least-area", "0 m²"]);
    place.enmm(&["fos", "case.toml", "--low", "2", "--high", "1"]).assert_bad_input(&["--low", "--high"]);
    assert_eq!(place.names(), ["case.toml"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_exits_with_130_and_keeps_the_trials() {
    use std::io::{BufRead, BufReader};
    use std::process::Command;

    use crate::support::Outcome;

    let place = Place::with(&incline(0.65, "").replace("size = 0.9", "size = 0.06"));
    let mut child = place.start(&["fos", "case.toml", "-o", "out"]);
    let mut rows = BufReader::new(child.stdout.take().expect("its output"));
    let mut row = String::new();
    while !row.starts_with("1 of ~") {
        row.clear();
        assert!(rows.read_line(&mut row).expect("text") > 0, "it ended before its first trial");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs").success());
    child.stdout = Some(rows.into_inner());
    let answer = Outcome::of(child.wait_with_output().expect("an end"));
    assert_eq!(answer.status, Some(130), "{answer:?}");
    let found = json(&place.path("out/fos.json"));
    assert_eq!(found["status"], "interrupted");
    assert!(found["trials"].as_array().is_some_and(|trials| !trials.is_empty()), "{found}");
}

/// The wedge of the template above its fault: 94.605 m², 40°, c = 40 kPa, φ = 32°, bolts that fall by 10°. With T on
/// the side of the forces, F = (c·l + (W cos α + T sin(α + δ)) tan φ)/(W sin α − T cos(α + δ)).
#[test]
fn bolts_are_an_active_or_a_passive_support_as_the_case_says() {
    let place = Place::with("");
    place.answers(0, &["new", "slope", "-o", "slope.toml"]);
    let (weight, length) = (94.605 * 2.650 * 9.81, (15f64 * 15.0 + 12.586 * 12.586).sqrt());
    let (dip, fall, friction) = (12.586f64.atan2(15.0), 10f64.to_radians(), 32f64.to_radians().tan());
    for (support, tension, share) in [("active", 150.0, 0.4), ("passive", 375.0, 1.0)] {
        let normal = weight * dip.cos() + tension * (dip + fall).sin();
        let driving = weight * dip.sin() - tension * (dip + fall).cos();
        let exact = (40.0 * length + normal * friction) / driving;
        let set = format!("bolt_pattern[0].support={support}");
        // Two trials, each 2 % from the formula.
        let [low, high] = [0.98, 1.02].map(|share| (share * exact).to_string());
        let range = ["--low", &low, "--high", &high, "--tolerance", "0.1"];
        for (command, range) in [("fos", &range[..]), ("bound", &[])] {
            let asked = [command, "slope.toml", "--set", "mesh.size=3", "--set", &set, "--json"];
            let found = place.answers(0, &[&asked[..], range].concat()).json();
            let factor = match command {
                "fos" => found["factor_of_safety"].as_f64(),
                _ => found["level_tops"]["factor"].as_f64(),
            };
            let factor = factor.expect("a factor");
            assert!((factor / exact - 1.0).abs() < 0.02, "{support} by {command}: {factor}, {exact}");
            if command == "fos" {
                assert_eq!(found["bolts"].as_array().map(Vec::len), Some(3), "{found}");
                assert_eq!(found["bolts"][0]["support"], support);
                let of_yield = found["bolts"][0]["utilisation"].as_f64().expect("a share");
                assert!((of_yield - share).abs() < 0.01, "{of_yield}");
            }
        }
    }
    let set = ["--set", "bolt_pattern[0].support=active", "--set", "bolt_pattern[0].pretension=0"];
    let refused = place.enmm(&[&["check", "slope.toml"], &set[..]].concat());
    assert!(refused.status == Some(2) && refused.stderr.contains("pretension"), "{refused:?}");
}

/// Seed 5 of the bedding of `road_cut` cuts off a chip of 1.4 m² on the face.
#[test]
fn a_chip_is_named_beside_the_slope() {
    let place = Place::with("");
    let search = ["fos", ROAD_CUT, "--set", "joint_set[0].seed=5", "--tolerance", "0.02", "-o", "out", "--no-pictures"];
    let answer = place.answers(0, &search);
    let found = json(&place.path("out/fos.json"));
    let [slope, chip] = [&found["factor_of_safety"], &found["chips"][0]["factor_of_safety"]].map(|f| f.as_f64());
    let (slope, chip) = (slope.expect("a factor"), chip.expect("a factor of a chip"));
    assert!((slope / 1.3176 - 1.0).abs() < 0.01 && chip < slope, "{slope}, {chip}");
    assert!(answer.stdout.contains(&format!("slope {slope:.4}; chip of ")), "{answer:?}");
    place.answers(0, &[&search[..], &["--least-area", "0"]].concat());
    assert_eq!(json(&place.path("out/fos.json"))["factor_of_safety"].as_f64(), Some(chip));
}

/// Before its bolts are installed, the cut has the factor of its formula without them (`road_cut.toml`). The quick form
/// has a wide bracket, since trials close to that factor creep for long.
#[test]
fn a_search_looks_at_the_slope_after_the_stage_that_is_named() {
    let place = Place::with("");
    let (tolerance, within) = by_extent([("0.11", 0.055), ("0.03", 0.005), ("0.03", 0.005)]);
    let search = ["fos", ROAD_CUT, "--stage", "gravity", "--tolerance", tolerance, "-o", "out", "--no-pictures"];
    place.answers(0, &search);
    let found = json(&place.path("out/fos.json"));
    let [low, high] = ["stable", "unstable"].map(|side| found["bracket"][side].as_f64().expect("an end"));
    assert!(low < 1.0313 && 1.0313 < high && high < 1.12 * low, "{low} to {high}");
    let factor = found["factor_of_safety"].as_f64().expect("a factor");
    assert!((factor / 1.0313 - 1.0).abs() < within, "{factor}");
    assert_eq!(found["stage"], "gravity", "a factor without its stage would pass for that of the bolted cut");
    let bolts = found["bolts"].as_array().expect("bolts");
    assert!(bolts.iter().all(|bolt| bolt["state"] == "absent"), "{found}");
    let refused = place.answers(2, &["fos", ROAD_CUT, "--stage", "quake", "-o", "none"]);
    assert!(refused.stderr.contains("gravity, bolts"), "{refused:?}");
}

/// The dry slide of `road_cut` has F = 1.1627, with 3 m of water in its crack 1.0313.
#[test]
fn a_stage_that_draws_the_water_down_gives_the_dry_factor() {
    let place = Place::with("");
    let text = fs::read_to_string(ROAD_CUT).expect("an example");
    let text = text.replace("install = [\"rows\"]", "water = { level = -20.0 }");
    fs::write(place.path("case.toml"), text).expect("a case");
    let near = ["--low", "1.1", "--high", "1.2"];
    for (command, key, range) in [("fos", "factor_of_safety", &near[..]), ("bound", "level_tops", &[])] {
        let found = place.answers(0, &[&[command, "case.toml", "--json"], range].concat()).json();
        let factor = found[key].as_f64().or(found[key]["factor"].as_f64()).expect("a factor");
        assert!((factor / 1.1627 - 1.0).abs() < 0.005, "{command}: {factor}");
    }
    let refused = place.enmm(&["check", "case.toml", "--set", "stage[0].water.level=1"]);
    assert!(refused.status == Some(2) && refused.stderr.contains("first stage"), "{refused:?}");
}

/// A slope in soil with two elements over its height locks: it rests at its strength over 1.05, where no rock can.
#[test]
fn a_factor_above_the_upper_bound_is_at_most_that_and_has_a_status_of_its_own() {
    let sides = "[[fix]]\nedge = [[0, -5], [40, -5]]\n[[fix]]\nedge = [[40, -5], [40, 10]]\naxes = \"x\"\n\
                 [[fix]]\nedge = [[0, -5], [0, 0]]\naxes = \"x\"\n";
    let place = Place::with(&format!(
        "title = \"soil\"\n[domain]\noutline = [[0, -5], [40, -5], [40, 10], [20, 10], [10, 0], [0, 0]]\n[mesh]\n\
         size = 5\n[rock.soil]\ndensity = 2000\nyoung = 100e6\npoisson = 0.3\nfriction_deg = 20\ncohesion = 10e3\n\
         tension = 0\n{sides}[[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration_max = 20.0\n"
    ));
    let answer = place.answers(5, &["fos", "case.toml", "-o", "out", "--no-pictures", "--low", "1", "--high", "1.05"]);
    assert!(answer.stdout.contains("at most 0.91") && answer.stderr.contains("too coarse"), "{answer:?}");
    let found = json(&place.path("out/fos.json"));
    assert!(found["factor_of_safety"].is_null(), "{found}");
    let most = found["at_most"].as_f64().expect("a number");
    assert!((0.88..0.93).contains(&most) && found["bound"]["upper"]["factor"].as_f64() == Some(most), "{most}");
}

/// A block slides as one piece on any mesh: F = tan φ/tan α, and no mesh differs by more than the brackets leave open.
#[test]
fn finer_meshes_tell_the_error_of_the_mesh() {
    let place = Place::with(&incline(0.65, "").replace("duration = 5.0", "duration = 1.0"));
    let words = ["fos", "case.toml", "-o", "out", "--tolerance", "0.01", "--meshes", "3"];
    let answer = place.answers(0, &words);
    answer.assert_printed(&["meshes", "error of the mesh", "0.4500"]);
    let meshes = json(&place.path("out/fos.json"))["meshes"].clone();
    let searches = meshes["searches"].as_array().expect("a list");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let sizes: Vec<f64> = searches.iter().map(|on| number(&on["mesh_size"])).collect();
    assert!(sizes.len() == 3 && sizes[0] == 0.9 && (sizes[2] - 0.45).abs() < 1e-12, "{sizes:?}");
    assert!((sizes[1] - 0.9 / 2f64.sqrt()).abs() < 1e-12, "{sizes:?}");
    assert!(number(&searches[2]["elements"]) > 2.0 * number(&searches[0]["elements"]), "{meshes}");
    assert!(searches.iter().all(|on| (number(&on["factor_of_safety"]) / 1.3 - 1.0).abs() < 0.01), "{meshes}");
    assert!(number(&meshes["mesh_error"]).abs() <= number(&meshes["extrapolated_within"]), "{meshes}");
    place.answers(0, &["report", "out", "--no-pdf"]);
    let report = std::fs::read_to_string(place.path("out/report_a4.html")).expect("a report");
    assert!(report.contains("Error of the mesh in F"), "the error of the mesh on page 1");
    assert!(json(&place.path("out/fos.json"))["factor_of_safety"] == searches[0]["factor_of_safety"]);
}

/// ky = tan(φ − α) of a block on a plane, with Newmark's block under a rectangular pulse of 4 m/s² for 0.2 s, into the
/// slope as it is and out of it reversed: A (A − ky g) t²/(2 ky g), and the run beside it.
#[test]
fn the_yield_acceleration_stands_beside_newmarks_block_and_the_run() {
    let pulse = "[[base_motion]]\ntable = [[0.0, 4.0], [0.2, 4.0]]\nkind = \"acceleration\"\nstage = \"quake\"\n\
                 [[stage]]\nname = \"quake\"\nkind = \"dynamic\"\nduration = 0.3\n";
    let place = Place::with(&incline(0.65, pulse).replace("duration = 5.0", "duration = 1.0"));
    place.answers(0, &["run", "case.toml"]);
    let answer = place.answers(0, &["fos", "case.toml", "--seismic", "--tolerance", "0.01"]);
    answer.assert_printed(&["yield acceleration", "Newmark's block", "the run"]);
    let seismic = json(&place.path("case/fos/fos.json"))["seismic"].clone();
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{seismic}"));
    // The plane falls by 1 in 2 (tan α = 0.5), and tan φ = 0.65.
    let exact = (0.65 - 0.5) / (1.0 + 0.65 * 0.5);
    let k = number(&seismic["yield_coefficient"]);
    assert!((k / exact - 1.0).abs() < 0.01, "{k} of {exact}");
    let block = &seismic["newmark"][0];
    let yields = k * number(&seismic["gravity"]);
    let way = 4.0 * (4.0 - yields) * 0.2 * 0.2 / (2.0 * yields);
    let ways = [number(&block["displacement"]), number(&block["displacement_reversed"])];
    let out = if seismic["direction"] == "left" { 0 } else { 1 };
    assert!((ways[out] / way - 1.0).abs() < 1e-9 && ways[1 - out] == 0.0, "{ways:?} of {way}");
    assert!(number(&seismic["run"]["displacement"]) > 0.0, "{seismic}");
    assert!(place.path("case/fos/seismic.csv").is_file() && place.path("case/fos/seismic.png").is_file());
    place.answers(0, &["report", "case", "--no-pdf"]);
    let report = fs::read_to_string(place.path("case/report_a4.html")).expect("a report");
    assert!(report.contains("<h2>Earthquake</h2>") && report.contains("Yield acceleration over gravity"));
    place.answers(0, &["fos", "case.toml", "--tolerance", "0.1"]);
    assert!(!place.path("case/fos/seismic.csv").exists(), "a search without it removes that of the search before");
    let refused = place.answers(2, &["fos", "case.toml", "--seismic=up"]);
    assert!(refused.stderr.contains("left") && refused.stderr.contains("right"), "{refused:?}");
}

/// Generated joints are those of the mesh of the case, and so are crumbs: one of 0.00125 m² is between the defaults of
/// the least block of the first two meshes.
#[test]
fn finer_meshes_have_the_same_blocks() {
    let set = r#"
[[joint]]
points = [[4.37764, 2.75528], [4.35528, 2.82236]]
law = "plane"
[[joint_set]]
angle_deg = 153.435
spacing = 0.21
spacing_sd = 0.1
seed = 3
law = "plane"
region = [[2.7, 2.6], [4.1, 2.0], [4.5, 2.8], [3.2, 3.5]]
"#;
    let place = Place::with(&(incline(0.65, "") + set));
    let words = ["fos", "case.toml", "-o", "out", "--tolerance", "0.2", "--least-area", "0", "--meshes", "3"];
    place.answers(0, &words);
    let meshes = json(&place.path("out/fos.json"))["meshes"].clone();
    let searches = meshes["searches"].as_array().expect("a list");
    let blocks: Vec<Option<u64>> = searches.iter().map(|on| on["blocks"].as_u64()).collect();
    assert!(blocks.len() == 3 && blocks[0].is_some_and(|count| count >= 5), "{meshes}");
    assert!(blocks.iter().all(|count| *count == blocks[0]), "{blocks:?}");
}
