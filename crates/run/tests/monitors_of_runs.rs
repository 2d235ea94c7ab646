//! Claim: runs, runs that go on from a checkpoint and runs of hosts write the same monitors, gauges and lines, and
//! displacements in them count from the end of the stage that the case names.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use enmm::model::case::{Case, JointMonitor, Line, Pictures};
use enmm_io::LoadedCase;
use enmm_record::Recording;
use enmm_run::{Observer, RunOptions, RunProgress, run};
use tempfile::{TempDir, tempdir};

use crate::quiet_run::example;

/// A block that settles and slides, with a gauge in the plane, a line through the block, and stress at its centre.
fn measured() -> Case {
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = 0.1;
    case.output.pictures = Pictures::Usual(false);
    case.output.history_interval = Some(0.004);
    case.output.since = Some("settle".to_owned());
    case.monitors[0].stress = true;
    let (name, point) = ("plane".to_owned(), [0.433, -0.25]);
    case.joint_monitors.push(JointMonitor { name, point, joint: None, length: None });
    let (name, from, to) = ("height".to_owned(), [0.433, -0.2], [0.9, 0.6]);
    case.lines.push(Line { name, from, to, points: Some(5) });
    case
}

fn loaded() -> LoadedCase {
    LoadedCase::of(measured(), "measured.toml").expect("a case")
}

fn options(folder: &TempDir) -> RunOptions<'_> {
    RunOptions { directory: folder.path().to_owned(), ..RunOptions::default() }
}

/// Head and rows of a table of numbers and names.
fn table(folder: &Path, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut rows = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    (rows.next().expect("a head"), rows.collect())
}

/// A column of a table as numbers.
fn column((head, rows): &(Vec<String>, Vec<Vec<String>>), name: &str) -> Vec<f64> {
    let k = head.iter().position(|other| other == name).unwrap_or_else(|| panic!("{name} in {head:?}"));
    rows.iter().map(|row| row[k].parse().unwrap_or_else(|_| panic!("{name}: {}", row[k]))).collect()
}

/// Until the block slides it has settled by micrometres, and then it counts from there: down the plane, which is to the
/// right of the gauge, as far as the gauge slips; across the plane it keeps the stress of its weight, σn = −W cos β/L
/// of a block of 1 m.
#[test]
fn history_and_lines_count_from_the_end_of_a_stage() {
    let folder = tempdir().expect("a folder");
    let summary = run(&loaded(), &options(&folder), &mut ()).expect("a run");
    let history = table(folder.path(), "history.csv");
    let [stage, slip, opening] = ["stage", "plane_slip [m]", "plane_opening [m]"].map(|name| column(&history, name));
    let [ux, uy] = ["block_ux [m]", "block_uy [m]"].map(|name| column(&history, name));
    let slides = stage.iter().position(|&stage| stage == 2.0).expect("the second stage");
    assert!(slip[slides - 1].abs() < 1e-4 && slip[slides - 1] != 0.0);
    for k in slides..stage.len() {
        let moved = ux[k].hypot(uy[k]);
        assert!((slip[k] - moved).abs() <= 1e-3 * moved + 1e-8, "{k}: slip {}, moved {moved}", slip[k]);
        assert!(opening[k].abs() < 1e-6, "{k}: {}", opening[k]);
    }
    assert!(slip.last().is_some_and(|&slip| slip > 3e-3));
    let normal = column(&history, "plane_normal_stress [Pa]")[slides - 1];
    let weight = 2650.0 * 9.81 * 0.75_f64.sqrt();
    assert!((normal + weight).abs() < 0.01 * weight, "{normal}, exact {}", -weight);
    assert!(column(&history, "block_stress_yy [Pa]")[slides - 1] < 0.0);
    let lines = table(folder.path(), "lines.csv");
    assert_eq!(column(&lines, "stage"), [[1.0; 5], [2.0; 5]].concat());
    let [x, along, across] = ["ux [m]", "along [m]", "across [m]"].map(|name| column(&lines, name));
    let y = column(&lines, "uy [m]");
    for k in 0..10 {
        assert!((along[k].hypot(across[k]) - x[k].hypot(y[k])).abs() < 1e-15, "{k}");
    }
    let last = *slip.last().expect("a row");
    assert!(x[5..].iter().zip(&y[5..]).all(|(x, y)| (x.hypot(*y) - last).abs() < 1e-3 * last), "{x:?} {y:?}, {last}");
    assert_eq!(
        (summary.measured.lines.len(), summary.measured.joint_monitors.len(), summary.measured.monitors.len()),
        (2, 1, 1)
    );
    assert_eq!(summary.measured.joint_monitors[0].slip, last);
    assert_eq!(summary.measured.lines[1].points[4].displacement[0], x[9]);
}

/// Stops a run in the second stage.
struct Stop<'a>(&'a AtomicBool);

impl Observer for Stop<'_> {
    fn step(&mut self, progress: &RunProgress) {
        if progress.stage_number == 2 && progress.step.is_multiple_of(50) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn a_run_that_goes_on_and_a_host_write_the_same() {
    let loaded = loaded();
    let [whole, part, hosted] = [(); 3].map(|()| tempdir().expect("a folder"));
    run(&loaded, &options(&whole), &mut ()).expect("a run");
    let raised = AtomicBool::new(false);
    let stop = RunOptions { interrupt: Some(&raised), ..options(&part) };
    run(&loaded, &stop, &mut Stop(&raised)).expect("a run that is stopped");
    let halfway = fs::read(part.path().join("lines.csv")).expect("lines so far");
    let checkpoint = Some(part.path().join("checkpoint.enmm"));
    run(&loaded, &RunOptions { resume: checkpoint, ..options(&part) }, &mut ()).expect("a run that goes on");
    let mut model = loaded.cosimulation().expect("a model");
    Recording::open(&mut model, &loaded, &hosted.path().join("r")).expect("a folder that can be written");
    while model.time() < model.stop_time() - 1e-12 {
        let (t, end) = (model.time(), model.stop_time());
        model.do_step(t, 0.01_f64.min(end - t)).expect("a step");
    }
    Recording::close(&mut model).expect("results");
    for name in ["history.csv", "lines.csv"] {
        let file = |folder: &Path| fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let own = file(whole.path());
        assert!(own == file(part.path()), "{name} of a run that went on");
        assert!(own == file(&hosted.path().join("r")), "{name} of a host");
        assert!(name == "history.csv" || own != halfway, "{name} of the run that was stopped");
    }
}

/// A checkpoint whose displacements count from elsewhere is of another case.
#[test]
fn a_checkpoint_goes_on_with_the_stage_from_which_it_counts() {
    let folder = tempdir().expect("a folder");
    run(&loaded(), &options(&folder), &mut ()).expect("a run");
    let mut other = measured();
    other.output.since = None;
    let other = LoadedCase::of(other, "measured.toml").expect("a case");
    let (again, checkpoint) = (tempdir().expect("a folder"), folder.path().join("checkpoint.enmm"));
    let error = run(&other, &RunOptions { resume: Some(checkpoint), ..options(&again) }, &mut ()).expect_err("another");
    assert!(error.to_string().contains("of case "), "{error}");
}

/// The case of the keys of monitors: its pictures have the line and the gauge, and the line of the second stage has the
/// motion of that alone.
#[test]
fn the_case_of_the_manual_draws_its_lines() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/keys/monitors.toml");
    let loaded = enmm_io::load_case(&path).unwrap_or_else(|error| panic!("{error}"));
    let folder = std::mem::ManuallyDrop::new(tempdir().expect("a folder"));
    println!("PICS {}", folder.path().display());
    let summary = run(&loaded, &options(&folder), &mut ()).expect("a run");
    let text =
        |name: &str| fs::read_to_string(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    for (name, stages) in [("stage1_lines.svg", &["gravity"][..]), ("stage2_lines.svg", &["gravity", "cut"])] {
        let picture = text(name);
        let words = ["inclinometer", "displacement across the line [mm]", "displacement along the line [mm]"];
        assert!(words.iter().chain(stages).all(|word| picture.contains(word)), "{name}");
    }
    let history = text("history.svg");
    assert!(["opening of joints", "slip of joints", "bench"].iter().all(|word| history.contains(word)));
    assert!(text("deformed.svg").contains("since the end of gravity"));
    let [gravity, cut] = &summary.measured.lines[..] else { panic!("two stages") };
    let [gravity, cut] =
        [gravity, cut].map(|line| line.points.iter().map(|point| point.displacement[1].abs()).fold(0.0, f64::max));
    // 20 m of rock settle by some ½ρgH²/E = 0.26 mm, and what is left rises by less when 4 m beside it go.
    let settled = 0.5 * 2650.0 * 9.81 * 20.0 * 20.0 / 20e9;
    assert!((0.5 * settled..2.0 * settled).contains(&gravity), "{gravity}, {settled}");
    assert!(cut < 0.5 * gravity && cut > 0.0, "{cut}, {gravity}");
}
