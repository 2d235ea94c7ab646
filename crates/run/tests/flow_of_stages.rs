//! Claim: a run tells the water that goes through joints in each stage, in `flow.csv` and its summary, and one without
//! such water leaves no `flow.csv` of an earlier run.

use enmm::model::case::{FlowTime, Pictures, StageFlow};
use enmm_io::LoadedCase;
use enmm_run::{RunOptions, run};

use crate::quiet_run::example;

/// Transmissivity (m²/s) of 0.1 mm: γe³/12μ. Half of the plane has that, half an eighth of it, below a head of 28 m.
#[test]
fn a_run_tells_the_flow_of_its_stages() {
    let mut case = example("../flow/seepage_slide.toml");
    (case.output.frames, case.output.pictures) = (true, Pictures::Usual(false));
    case.stages[0].duration = 0.02;
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions { directory: folder.path().join("run"), ..RunOptions::default() };
    let loaded = LoadedCase::of(case.clone(), "case").expect("a case");
    let summary = run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    let half = 0.5 * 32.8474042_f64.hypot(23.0);
    let exact = 9810.0 * 1e-12 / (12.0 * 1e-3) * 28.0 / (9.0 * half);
    let told: Vec<_> = summary.flow.iter().map(|row| (&*row.stage, &*row.name, row.enters, row.leaves)).collect();
    assert_eq!(told.len(), 3, "{told:?}");
    let near = |found: f64, exact: f64| assert!((found - exact).abs() <= 1e-9 * exact.abs(), "{found} {exact}");
    for ((stage, name, enters, leaves), (own, exact)) in
        told.into_iter().zip([("crack", [exact, 0.0]), ("reservoir", [0.0; 2]), ("air", [0.0, exact])])
    {
        assert_eq!((stage, name), ("gravity", own));
        near(enters, exact[0]);
        near(leaves, exact[1]);
    }
    let path = options.directory.join("flow.csv");
    let text = std::fs::read_to_string(&path).expect("flow.csv");
    let row: Vec<&str> = text.lines().nth(1).expect("a row").split(',').collect();
    assert_eq!(row[..2], ["gravity", "crack"]);
    near(row[2].parse().expect("a number"), exact);
    near(row[5].parse().expect("a number"), exact * 6e4);
    let wet = std::fs::read_dir(options.directory.join("frames")).expect("frames").filter_map(Result::ok);
    assert!(wet.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with("water")));
    (case.flow, case.heads) = (None, Vec::new());
    case.joint_laws.values_mut().for_each(|law| law.aperture = None);
    let loaded = LoadedCase::of(case, "case").expect("a case");
    let dry = run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    assert!(dry.flow.is_empty() && !path.exists());
}

/// Two stages: the head falls over an hour in the second one. Entered, left and stored close, rounds of the first are
/// told, and a warning says that joints still drain.
#[test]
fn a_run_tells_the_water_of_a_time_and_the_rounds_of_openings() {
    let mut case = example("../flow/seepage_slide.toml");
    (case.output.frames, case.output.pictures) = (false, Pictures::Usual(false));
    let flow = case.flow.as_mut().expect("flow");
    (flow.coupled, flow.storage) = (true, 1e-2);
    case.stages[0].convergence = Some(1e-4);
    // An even plane, which does not slide.
    for name in ["plane", "toe"] {
        let law = case.joint_laws.get_mut(name).expect("a law of the example");
        (law.aperture, law.cohesion) = (None, 200e3);
    }
    let mut later = case.stages[0].clone();
    (later.name, later.duration) = ("later".to_owned(), 0.02);
    later.flow = Some(StageFlow::Over(FlowTime { time: 3600.0, steps: 4 }));
    later.heads.insert("crack".to_owned(), 24.0);
    case.stages.push(later);
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions { directory: folder.path().join("run"), ..RunOptions::default() };
    let loaded = LoadedCase::of(case, "case").expect("a case");
    let summary = run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(summary.flow.len(), 6);
    let rounds = summary.flow[0].rounds.expect("rounds");
    assert!(rounds.agree && rounds.asked <= 1e-2 && summary.flow[0].water.is_none(), "{rounds:?}");
    let later: Vec<_> = summary.flow[3..].iter().map(|row| row.water.expect("water")).collect();
    let [entered, left] = [later.iter().map(|w| w.entered).sum::<f64>(), later.iter().map(|w| w.left).sum()];
    let stored = later[0].stored;
    assert!(stored < 0.0 && left > entered && later.iter().all(|w| w.time == 3600.0));
    assert!((entered - left - stored).abs() <= 1e-11 * left && later[0].residual.abs() <= 1e-11 * left);
    assert!(summary.warnings.iter().any(|text| text.contains("the joints still drain")), "{:?}", summary.warnings);
    let text = std::fs::read_to_string(options.directory.join("flow.csv")).expect("flow.csv");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == 17), "{text}");
    assert_eq!((rows[1][9], rows[1][15], rows[4][15]), ("", &*rounds.count.to_string(), ""));
    assert_eq!(rows[4][13].parse::<f64>().expect("a number"), stored);
}
