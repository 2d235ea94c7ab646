//! Claim: a base motion acts by its exact impulse, from the start of its stage, and its work is in the ledger.

use std::path::Path;

use crate::common::claims::assert_ledger;
use crate::common::parts::{dynamic, rock};
use crate::common::{run_all, run_stage, simulation};
use enmm::model::Simulation;

/// A free block without gravity, its motions, and a dynamic stage of `seconds`.
fn block(motions: &str, stages: &str) -> String {
    format!(
        "title = \"base\"\n[domain]\noutline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]\n[mesh]\nsize = 0.9\n\
         {}[gravity]\ny = 0.0\n{motions}{stages}[[monitor]]\nname = \"m\"\npoint = [1.0, 0.5]\n",
        rock(1e9, 2500.0)
    )
}

fn velocity(simulation: &Simulation) -> [f64; 2] {
    let v = simulation.monitor(0).1;
    [v.x, v.y]
}

/// A pulse with jumps between grid points: the block has −∫a dt to rounding of a thousand steps, 1e-11 of it, whatever
/// the step is; its kinetic energy is the work of the base.
#[test]
fn a_pulse_between_grid_points_gives_its_exact_impulse() {
    for (from, to, a) in [(0.0, 0.1, 2.0), (0.01234567, 0.0456789, -3.0), (0.0, 0.00001, 1e3)] {
        let motion = format!("[[base_motion]]\ntable = [[{from}, {a}], [{to}, {a}]]\n");
        let mut simulation = simulation(&block(&motion, &dynamic("shake", 0.2, 0.0)));
        let report = run_stage(&mut simulation);
        let expected = -a * (to - from);
        let [x, y] = velocity(&simulation);
        assert!(
            (x - expected).abs() < 1e-11 * expected.abs() && y.abs() < 1e-11 * expected.abs(),
            "{x} of {expected}, {y}"
        );
        let energy = 0.5 * 2500.0 * 2.0 * expected * expected;
        assert!((report.ledger.external_work / energy - 1.0).abs() < 1e-9, "{:?}", report.ledger);
        assert_ledger(&report);
    }
}

/// A velocity table gives the base its velocity, and the last one for ever; scale and axis as written.
#[test]
fn a_velocity_is_kept_at_the_end_of_its_rows() {
    let motion =
        "[[base_motion]]\nkind = \"velocity\"\naxis = \"y\"\nscale = 0.5\ntable = [[0.01, 0.0], [0.0333, 3.0]]\n";
    let mut simulation = simulation(&block(motion, &dynamic("shake", 0.1, 0.0)));
    run_stage(&mut simulation);
    let [x, y] = velocity(&simulation);
    assert!((y + 1.5).abs() < 1e-12 && x.abs() < 1e-12, "{x} {y}");
}

/// A motion begins with its stage and counts time from there, through a change of stage. Velocities are those of half a
/// step before.
#[test]
fn a_motion_waits_for_its_stage() {
    let stages = ["one", "two", "three"].map(|name| dynamic(name, 0.1, 0.0)).concat();
    let motion = "[[base_motion]]\nstage = \"two\"\ntable = [[0.05, 1.0], [0.15, 1.0]]\n";
    let mut simulation = simulation(&block(motion, &stages));
    let speeds = [0.0, -0.05, -0.1].map(|expected| {
        run_stage(&mut simulation);
        let [x, _] = velocity(&simulation);
        assert!((x - expected).abs() < 0.51 * simulation.model().dt, "{x} of {expected}");
        simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
        x
    });
    assert!(speeds[0] == 0.0);
}

/// Static stages feel no base: a block at rest under gravity stays where it is.
#[test]
fn static_stages_feel_no_motion() {
    let stages =
        "[[stage]]\nname = \"hold\"\nkind = \"static\"\nduration = 0.05\n".to_owned() + &dynamic("shake", 0.05, 0.0);
    let motion = "[[base_motion]]\ntable = [[0.0, 1.0], [1.0, 1.0]]\n";
    let mut simulation = simulation(&block(motion, &stages));
    run_stage(&mut simulation);
    assert_eq!(velocity(&simulation), [0.0; 2]);
    run_all(&mut simulation);
    assert!((velocity(&simulation)[0] + 0.05).abs() < 0.51 * simulation.model().dt);
}

/// The rows of a file are those of a table: the case that is loaded holds them and names no file.
#[test]
fn a_record_comes_from_a_file_beside_the_case() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("quake.csv"), "# station 7\ntime,acceleration,more\n0.0,0.1,5\n0.1,0.1,5\n")
        .unwrap();
    let text = block("[[base_motion]]\nfile = \"quake.csv\"\nscale = 9.81\n", &dynamic("shake", 0.2, 0.0));
    let loaded = enmm_io::parse_case(&text, "case.toml", folder.path()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.base_motions[0].table, Some(vec![[0.0, 0.1], [0.1, 0.1]]));
    assert_eq!(loaded.case.base_motions[0].file, None);
    let mut simulation = Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    run_stage(&mut simulation);
    assert!((velocity(&simulation)[0] + 0.0981).abs() < 1e-12);
}

#[track_caller]
fn assert_refused(motion: &str, files: &[(&str, &str)], message: &str) {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let text = block(motion, &dynamic("shake", 0.2, 0.0));
    let error = enmm_io::parse_case(&text, "case.toml", folder.path()).map(|_| ()).unwrap_err().to_string();
    let error = error.replace(&format!("{}/", folder.path().display()), "");
    assert!(error.starts_with(message), "{error}");
}

#[test]
fn records_that_cannot_be_used_are_named_with_their_line() {
    let file = "[[base_motion]]\nfile = \"q.csv\"\n";
    assert_refused(file, &[], "case.toml:13: base_motion[0].file: \"q.csv\": cannot read the file");
    assert_refused(file, &[("q.csv", "t,a\n0,1\n1,x\n")], "q.csv:3: \"x\" is no number");
    assert_refused(
        file,
        &[("q.csv", "t,a\n0,1\n2,1\n1,1\n")],
        "q.csv:4: base_motion[0].table[2]: time is 1 s, must be",
    );
    assert_refused(file, &[("q.csv", "0,1\n1,1e9\n")], "q.csv:2: base_motion[0].table[1]: times `scale` is 1e9 m/s²");
    let velocity = "[[base_motion]]\nkind = \"velocity\"\nfile = \"q.csv\"\n";
    assert_refused(velocity, &[("q.csv", "# v\n0,1\n1,2\n")], "q.csv:2: base_motion[0].table[0]: starts with 1 m/s");
    let both = "[[base_motion]]\nfile = \"q.csv\"\ntable = [[0.0, 1.0], [1.0, 1.0]]\n";
    assert_refused(
        both,
        &[("q.csv", "0,1\n1,1\n")],
        "case.toml:14: base_motion[0].table: the rows are also in \"q.csv\"",
    );
    assert_refused("[[base_motion]]\n", &[], "case.toml:12: base_motion[0].table: is missing");
    let stage = "[[base_motion]]\nstage = \"shaek\"\ntable = [[0.0, 1.0], [1.0, 1.0]]\n";
    assert_refused(stage, &[], "case.toml:13: base_motion[0].stage: no dynamic stage is named \"shaek\", did you mean");
    assert_refused("[[base_motion]]\ntable = [[0.0, 1.0]]\n", &[], "case.toml:13: base_motion[0].table: has 1 row");
    let error = simulationless(Path::new("."));
    assert!(error.contains("the file is not read into the case"), "{error}");
}

/// A case that was not loaded through `io` keeps its file, and cannot be built.
fn simulationless(folder: &Path) -> String {
    let text = block("[[base_motion]]\ntable = [[0.0, 1.0], [1.0, 1.0]]\n", &dynamic("shake", 0.2, 0.0));
    let mut case = enmm_io::parse_case(&text, "case.toml", folder).unwrap().case;
    case.base_motions[0].table = None;
    case.base_motions[0].file = Some("q.csv".into());
    Simulation::new(case).map(|_| ()).unwrap_err().to_string()
}
