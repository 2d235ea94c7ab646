//! Claim: a quiet boundary holds in static stages, keeps its reaction in dynamic ones, lets plane waves leave and
//! brings them in.

use crate::common::claims::stresses;
use crate::common::parts::dynamic;
use crate::common::{refusal, run_stage, simulation};
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{Simulation, State, StepReport};

const STATIC: &str = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n";

/// A block of 12 m × 8 m with a joint, quiet below and at both sides, and stages.
fn text(stages: &str, extra: &str) -> String {
    format!(
        "title = \"quiet\"\n[domain]\noutline = [[0.0, 0.0], [12.0, 0.0], [12.0, 8.0], [0.0, 8.0]]\n[mesh]\n\
         size = 1.1\nangle_deg = 11\n[[joint]]\npoints = [[-1.0, 4.0], [13.0, 4.6]]\n[joint_law.joint]\n\
         friction_deg = 35.0\n[rock.rock]\ndensity = 2500.0\nyoung = 1e9\npoisson = 0.25\n[[quiet]]\n\
         edge = [[0.0, 0.0], [12.0, 0.0]]\n{extra}[[quiet]]\nedge = [[12.0, 0.0], [12.0, 8.0]]\naxes = \"x\"\n\
         [[free_field]]\nedge = [[0.0, 0.0], [0.0, 8.0]]\n{stages}[[monitor]]\nname = \"top\"\npoint = [6.0, 7.9]\n"
    )
}

fn block(stages: &str, extra: &str) -> Simulation {
    simulation(&text(stages, extra))
}

fn step(simulation: &mut Simulation, seconds: f64) -> StepReport {
    let steps = simulation.steps_in(seconds);
    (0..steps).fold(StepReport::default(), |_, k| simulation.advance(k + 1 == steps).unwrap_or_else(|e| panic!("{e}")))
}

/// The reactions of the springs stay as constant forces: a model at rest stays at rest when motion begins, and when a
/// static stage gives the springs back. The forces out of balance at 1e-7 of the weight move it by 1e-7 of the
/// settlement (3e-4 m), over and over as nothing holds it to its place: 1e-4 of it is allowed.
#[test]
fn what_was_borne_is_borne_on() {
    let stages = format!("{STATIC}{}{}", dynamic("wait", 0.5, 0.0), STATIC.replace("settle", "again"));
    let mut simulation = block(&stages, "");
    run_stage(&mut simulation);
    let settled = simulation.monitor(0).0;
    assert!(settled.y < -1e-4, "{settled}");
    for _ in 0..2 {
        assert!(simulation.next_stage().unwrap());
        let report = run_stage(&mut simulation);
        let moved = (simulation.monitor(0).0 - settled).norm();
        println!("moved {moved:e} m of {settled}");
        assert!(moved < 1e-4 * settled.norm(), "{moved}");
        let ledger = report.ledger;
        assert!(ledger.residual().abs() < 1e-3 * ledger.largest(), "{ledger:?}");
    }
}

/// In-situ stress is carried from the start, as by fixities: a continuum under uniform stress that its boundaries
/// balance does not move, up to the rounding of the stress itself.
#[test]
fn in_situ_stress_is_borne_from_the_start() {
    let edges = ["[[0, 0], [4, 0]]", "[[4, 0], [4, 4]]", "[[4, 4], [0, 4]]"];
    let quiets: String = edges.iter().map(|e| format!("[[quiet]]\nedge = {e}\n")).collect();
    let mut simulation = simulation(&format!(
        "title = \"in situ\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 4], [0, 4]]\n[mesh]\nsize = 0.7\nangle_deg = 9\n\
         [rock.rock]\ndensity = 2600\nyoung = 1e9\npoisson = 0.25\n[gravity]\ny = 0\n[in_situ]\nsxx = -1e6\n\
         syy = -2e6\nsxy = 2e5\n{quiets}[[free_field]]\nedge = [[0, 0], [0, 4]]\naxes = \"xy\"\n{}[[monitor]]\n\
         name = \"middle\"\npoint = [1.9, 3.0]\n",
        dynamic("wait", 0.05, 0.0)
    ));
    run_stage(&mut simulation);
    assert!(simulation.monitor(0).0.norm() < 1e-12, "{}", simulation.monitor(0).0);
    let state = simulation.state().clone();
    assert!(stresses(&simulation, &state).iter().flatten().all(|s| s.abs() < 1e-2));
}

/// A wave in the model with everything in use: the state alone makes the rest of the run, to the bit, from any moment
/// on and on any number of threads.
#[test]
fn the_state_alone_goes_on_to_the_bit() {
    let wave = "wave = [0.1, 0.05]\ntable = [[0.0, 0.0], [0.01, 1.0], [0.02, 0.0]]\n\
                [[base_motion]]\ntable = [[0.0, 1.0], [0.015, -1.0]]\n";
    let stages = format!("{STATIC}{}{}", dynamic("wave", 0.02, 0.05), dynamic("after", 0.03, 0.05));
    let mut first = block(&stages, wave);
    let mut second = first.clone();
    second.set_serial(true);
    run_stage(&mut first);
    assert!(first.next_stage().unwrap());
    step(&mut first, 0.008);
    let bytes = encode(Keeper::Model, first.state(), "case").unwrap();
    let state: State = decode(Keeper::Model, &bytes, "case").unwrap();
    assert!(second.check(&state).is_ok() && first.state() == &state);
    second.restore(state);
    assert!(first.state().columns[0].velocity.iter().any(|v| v.norm() > 1e-6));
    for simulation in [&mut first, &mut second] {
        run_stage(simulation);
        assert!(simulation.next_stage().unwrap());
        run_stage(simulation);
    }
    assert!(first.state() == second.state());
    let mut short = first.state().clone();
    short.columns[0].velocity.pop();
    assert!(first.check(&short).is_err(), "a column of another length");
}

/// Places without rock and sides that are not vertical.
#[test]
fn places_that_cannot_be_quiet_are_named() {
    for (from, to, message) in [
        ("edge = [[12.0, 0.0], [12.0, 8.0]]", "edge = [[13.0, 0.0], [13.0, 8.0]]", "quiet[1].edge: no outer boundary"),
        ("[[free_field]]\nedge = [[0.0, 0.0]", "[[free_field]]\nedge = [[0.1, 0.0]", "free_field[0].edge: runs from"),
        ("axes = \"x\"", "scale = 2.0", "quiet[1].scale: belongs to a wave"),
        ("axes = \"x\"", "wave = [1.0, 0.0]", "quiet[1].table: is missing"),
    ] {
        let text = text(&dynamic("wave", 1.0, 0.0), "");
        assert!(text.contains(from));
        let error = refusal(&text.replacen(from, to, 1));
        assert!(error.contains(message), "{error}");
    }
}
