//! Claims: a drain under a dam leaves the uplift of a triangle before it and takes the flow of Darcy, wherever it
//! crosses the joint; a pump lowers the head by what it takes, and takes what arrives where the joint runs dry.

use crate::common::{refusal, run_stage, simulation, step};
use enmm::geometry::Point;
use enmm::model::bytes::{Keeper, encode};
use enmm::model::{FlowBalance, Simulation, State};

/// Transmissivity (m²/s) of joints of 0.1 mm: γe³/12μ.
const T: f64 = 1000.0 * 9.81 * 1e-12 / (12.0 * 1e-3);
/// Height of the joint (m).
const BASE: f64 = 3.0;

/// Water that enters, leaves and runs off (m²/s) at both heads, at drains, from the reservoir and from the air.
fn sums(simulation: &Simulation) -> &[[f64; 3]] {
    let FlowBalance { sums, .. } =
        simulation.state().seepage.as_ref().and_then(|flow| flow.balances.last()).expect("a balance");
    sums
}

/// Checks flows to a share of 1e-12 of the transmissivity.
fn assert_sums(simulation: &Simulation, exact: &[[f64; 2]]) {
    let found = sums(simulation);
    let exact = exact.iter().flat_map(|[enters, leaves]| [*enters, *leaves, 0.0]);
    let off = found.as_flattened().iter().zip(exact.clone()).map(|(found, exact)| (found - exact).abs());
    let is_near = off.fold(0.0, f64::max) <= 1e-12 * T;
    assert!(
        found.len() * 3 == exact.clone().count() && is_near,
        "{found:?} instead of {:?}",
        exact.collect::<Vec<_>>()
    );
}

/// A dam, 20 m wide, on a joint with heads (m above the joint) at its heel and toe.
fn dam(heads: [f64; 2], more: &str, stages: &str) -> String {
    let [heel, toe] = heads.map(|head| head + BASE);
    format!(
        "title = \"dam\"\n[domain]\noutline = [[0, 0], [20, 0], [20, 9], [0, 9]]\n[mesh]\nsize = 1.3\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 3], [20, 3]]\n[rock.rock]\ndensity = 2600\nyoung = 1e10\n\
         poisson = 0.25\n[joint_law.joint]\nfriction_deg = 40\n[[fix]]\nedge = [[0, 0], [20, 0]]\n[[fix]]\n\
         edge = [[0, 3], [0, 9]]\n[flow]\naperture = 1e-4\naperture_min = 1e-4\naperture_max = 1e-4\n[[head]]\n\
         name = \"heel\"\nedge = [[0, 0], [0, 9]]\nlevel = {heel:?}\n[[head]]\nname = \"toe\"\n\
         edge = [[20, 0], [20, 9]]\nlevel = {toe:?}\n{more}[[stage]]\nname = \"full\"\nkind = \"static\"\n\
         duration = 0.3\n{stages}"
    )
}

/// A drain from a mouth (m, x and height above the joint) to a far end.
fn drain(points: [[f64; 2]; 2], more: &str) -> String {
    let [a, b] = points.map(|[x, y]| [x, y + BASE]);
    format!("[[drain]]\nname = \"row\"\npoints = [{a:?}, {b:?}]\n{more}")
}

/// Force (N/m) of water that lifts the dam.
fn uplift(simulation: &Simulation) -> f64 {
    let dam = crate::common::claims::block_at(simulation, [10.0, 8.0]);
    let forces = simulation.load_forces();
    simulation.model().covers.covers_of(dam).map(|i| forces[i].y).sum()
}

/// Faces of the start, before anything has moved.
#[test]
fn a_drain_cuts_the_uplift_of_a_dam() {
    let (head, stages) = (12.0, "");
    let full = simulation(&dam([head, 0.0], "", stages));
    assert!((uplift(&full) / (9810.0 * head * 20.0 / 2.0) - 1.0).abs() < 1e-12, "{}", uplift(&full));
    // Upright through the joint, on a slope, with its mouth and with its far end on it.
    for (points, from) in [
        ([[4.4, -1.0], [4.4, 2.0]], 4.4),
        ([[4.0, -0.5], [6.0, 1.5]], 4.5),
        ([[4.4, 0.0], [5.0, 3.0]], 4.4),
        ([[7.0, -2.0], [5.1, 0.0]], 5.1),
    ] {
        let drained = simulation(&dam([head, 0.0], &drain(points, ""), stages));
        let found = uplift(&drained);
        assert!((found / (9810.0 * head * from / 2.0) - 1.0).abs() < 1e-12, "{points:?}: {found}");
        let flow = T * head / from;
        assert_sums(&drained, &[[flow, 0.0], [0.0, 0.0], [0.0, flow], [0.0; 2], [0.0; 2]]);
    }
}

/// With its mouth above the joint the drain holds that head, and gives no less to the toe.
#[test]
fn the_mouth_of_a_drain_keeps_water_above_it_back() {
    let text = dam(
        [12.0, 1.0],
        &drain([[5.0, 3.0], [5.0, -1.0]], "active = false\n"),
        "[[stage]]\nname = \"bored\"\n\
         kind = \"static\"\nduration = 0.3\ndrain = [\"row\"]\n",
    );
    let mut model = simulation(&text);
    let through = T * 11.0 / 20.0;
    assert_sums(&model, &[[through, 0.0], [0.0, through], [0.0; 2], [0.0; 2], [0.0; 2]]);
    run_stage(&mut model);
    assert!(model.next_stage().expect("a stage"));
    let [heel, toe] = [T * 9.0 / 5.0, T * 2.0 / 15.0];
    assert_sums(&model, &[[heel, 0.0], [0.0, toe], [0.0, heel - toe], [0.0; 2], [0.0; 2]]);
    assert!(model.dry_drains().is_empty());
    // A mouth above the heads gives water that nobody has.
    let high = simulation(&dam([1.0, 0.0], &drain([[5.0, 3.0], [5.0, -1.0]], ""), ""));
    assert!(high.dry_drains()[0].starts_with("drain \"row\" brings"), "{:?}", high.dry_drains());
}

/// Halfway between heads of 10 m, 0.5 T lower the head to 7.5 m; 6 T cannot be had.
#[test]
fn a_pump_takes_its_flow_until_the_joint_runs_dry() {
    let with = |share: f64| {
        let pump = format!("pump = {:e}\n", share * T);
        simulation(&dam([10.0, 10.0], &drain([[10.0, 6.5], [10.0, -1.0]], &pump), ""))
    };
    let model = with(0.5);
    let net = model.model().flow.as_ref().expect("a net");
    let well = net.places.iter().position(|place| (place - Point::new(10.0, BASE)).norm() < 1e-9).expect("a node");
    let head = model.state().seepage.as_ref().expect("water").unknowns[well];
    println!("{head:.12} m");
    assert!((head / 7.5 - 1.0).abs() < 1e-12, "{head}");
    let half = 0.25 * T;
    assert_sums(&model, &[[half, 0.0], [half, 0.0], [0.0, 0.5 * T], [0.0; 2], [0.0; 2]]);
    assert!(model.dry_drains().is_empty(), "{:?}", model.dry_drains());
    let dry = with(6.0);
    assert_sums(&dry, &[[T, 0.0], [T, 0.0], [0.0, 2.0 * T], [0.0; 2], [0.0; 2]]);
    assert!(dry.dry_drains()[0].starts_with("the pump of drain \"row\" runs dry"), "{:?}", dry.dry_drains());
}

fn run(threads: usize) -> State {
    let drains = drain([[5.0, 1.0], [5.0, -1.0]], "active = false\n")
        + &drain([[9.0, 1.0], [9.5, -1.0]], "pump = 1e-7\n").replace("row", "well");
    let stages = "[[stage]]\nname = \"bored\"\nkind = \"static\"\nduration = 0.3\ndrain = [\"row\"]\n";
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(&dam([12.0, 1.0], &drains, stages));
        step(&mut one, 20);
        let before = one.state().clone();
        assert!(one.next_stage().expect("a stage"));
        step(&mut one, 20);
        let state = one.state().clone();
        one.restore(before);
        assert!(one.next_stage().expect("a stage"));
        step(&mut one, 20);
        assert!(*one.state() == state, "a rollback over the start of a stage");
        state
    })
}

#[test]
fn threads_change_no_bit_of_drains() {
    let bits = |threads: usize| encode(Keeper::Model, &run(threads), "hash").expect("bytes");
    let one = bits(1);
    assert!([2, 8].map(bits).iter().all(|other| *other == one));
}

#[test]
fn drains_that_drain_nothing_are_told() {
    let own = drain([[5.0, 1.0], [5.0, -1.0]], "");
    let stage = |kind: &str, name: &str| {
        format!("[[stage]]\nname = \"next\"\nkind = \"{kind}\"\nduration = 1.0\ndrain = [\"{name}\"]\n")
    };
    let off = own.clone() + "active = false\n";
    for (drains, stages, message) in [
        (drain([[5.0, 1.0], [5.0, 2.0]], ""), String::new(), "drain[0].points: crosses no joint"),
        (own.clone() + &own.replace("row", "other"), String::new(), "where drain \"row\" does too"),
        (own.clone() + &own, String::new(), "drain[1].name"),
        (own.replace("row", "heel"), String::new(), "drain[0].name: is \"heel\", as a head is called"),
        (own.clone() + "pump = 0.0\n", String::new(), "drain[0].pump: is 0 m²/s, must be greater than 0"),
        (own.clone(), stage("static", "row"), "stage[1].drain: drain \"row\" acts already"),
        (off.clone(), stage("static", "raw"), "no drain is named \"raw\", did you mean \"row\"?"),
        (off, stage("dynamic", "row"), "give it in a static stage"),
    ] {
        let told = refusal(&dam([12.0, 0.0], &drains, &stages));
        assert!(told.contains(message), "{message}\n{told}");
    }
}
