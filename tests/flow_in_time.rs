//! Claims: flow that takes time goes on from that of the stage before. The head in a crack falls and a column drains as
//! by hand, a net is drawn down as a porous layer, and after a long time the flow is the steady one, after drains and
//! excavations too. What enters has left or is in the joints, and states are the same to the bit by any number of
//! threads, through bytes and after a return.

use crate::common::{refusal, run_stage, simulation, step, through_bytes};
use enmm::model::bytes::{Keeper, encode};
use enmm::model::{FlowBalance, Seepage, Simulation, StageWater, State};

/// Transmissivity (m²/s) of joints of 0.1 mm: γe³/12μ.
const T: f64 = 1000.0 * 9.81 * 1e-12 / (12.0 * 1e-3);

fn flowing(simulation: &Simulation) -> &Seepage {
    simulation.state().seepage.as_ref().expect("water that flows")
}

fn balance(simulation: &Simulation) -> &FlowBalance {
    flowing(simulation).balances.last().expect("a balance")
}

/// Water of the stage in progress, whose balance closes to rounding.
fn water(simulation: &Simulation) -> &StageWater {
    let water = balance(simulation).water.as_ref().expect("a stage with a time of flow");
    let [entered, left, _] = water.totals();
    let size = entered.max(left).max(water.stored.abs());
    assert!(water.residual().abs() <= 1e-11 * size, "{:.1e} of {size:.3e}: {water:?}", water.residual());
    water
}

/// Head (m) at the node that is nearest to a place.
fn head(simulation: &Simulation, at: [f64; 2]) -> f64 {
    let net = simulation.model().flow.as_ref().expect("a net");
    let away = |k: &usize| (net.places[*k].x - at[0]).hypot(net.places[*k].y - at[1]);
    let near = (0..net.places.len()).min_by(|a, b| away(a).total_cmp(&away(b))).expect("a node");
    net.places[near].y + flowing(simulation).unknowns[near]
}

/// Begins the next stage, before anything has moved.
fn next(simulation: &mut Simulation) {
    assert!(simulation.next_stage().unwrap_or_else(|e| panic!("{e}")));
}

/// A stage with a time of flow (s).
fn over(name: &str, time: f64, steps: u32, more: &str) -> String {
    format!(
        "[[stage]]\nname = \"{name}\"\nkind = \"static\"\nduration = 0.3\nflow = {{ time = {time:?}, steps = {steps} \
         }}\n{more}"
    )
}

const ROCK: &str = "[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n";
const REST: &str = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.3\n";

/// A crack of 5 mm, 20 m high, that a joint of 0.1 mm and 10 m drains at its foot, where the head falls from 16 m.
#[test]
fn the_head_in_a_crack_falls_as_steps_let_it() {
    let tau = 5e-3 * 10.0 / T;
    for steps in [20, 80] {
        let text = format!(
            "title = \"crack\"\n[domain]\noutline = [[0, 0], [12, 0], [12, 22], [0, 22]]\n[mesh]\nsize = 1.0\n\
             origin = [0.131, 0.077]\n[[joint]]\npoints = [[2, 2], [2, 22]]\nlaw = \"crack\"\n[[joint]]\n\
             points = [[2, 2], [12, 2]]\nlaw = \"joint\"\n{ROCK}[joint_law.crack]\nfriction_deg = 40\n\
             aperture = 5e-3\n[joint_law.joint]\nfriction_deg = 40\naperture = 1e-4\n[[fix]]\n\
             edge = [[0, 0], [12, 0]]\n[flow]\n[[head]]\nname = \"exit\"\nedge = [[12, 0], [12, 22]]\nlevel = 18.0\n\
             {REST}{}{}",
            over("open", 1e-3, 1, "heads = { exit = 2.0 }\n"),
            over("fall", tau, steps, "")
        );
        let mut model = simulation(&text);
        assert!((head(&model, [2.0, 2.0]) - 18.0).abs() < 1e-9);
        next(&mut model);
        next(&mut model);
        let found = (head(&model, [2.0, 2.0]) - 2.0) / 16.0;
        let exact = (1.0 + 1.0 / f64::from(steps)).powi(-(steps as i32));
        println!("{steps} steps: {found:.6}, exact {exact:.6}");
        assert!((found - exact).abs() < 1e-4, "{found} {exact}");
        assert!((water(&model).stored / (-5e-3 * 16.0 * (1.0 - exact)) - 1.0).abs() < 1e-3);
        assert_eq!(flowing(&model).time, 1e-3 + tau);
    }
}

/// A full joint that is open at its foot drains with a unit gradient: half of it in the time H/2K, K = T/e.
#[test]
fn half_of_a_column_with_an_open_foot_drains_in_half_its_time() {
    let half = 5.0 * 1e-4 / T;
    let text = format!(
        "title = \"column\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 10], [0, 10]]\n[mesh]\nsize = 0.5\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[2, 0], [2, 10]]\n{ROCK}[joint_law.joint]\n\
         friction_deg = 40\n[[fix]]\nedge = [[0, 0], [0, 10]]\n[[fix]]\nedge = [[4, 0], [4, 10]]\n[flow]\n\
         aperture = 1e-4\n[[head]]\nname = \"foot\"\nedge = [[0, 0], [4, 0]]\nlevel = 10.0\n{REST}{}{}",
        over("open", 1e-6, 1, "heads = { foot = 0.0 }\n"),
        over("drain", half, 40, "")
    );
    let mut model = simulation(&text);
    next(&mut model);
    next(&mut model);
    let pieces = model.flow_survey().expect("a net").pieces;
    let (left, outflow) = (1.0 + water(&model).stored / 1e-3, balance(&model).sums[0][1]);
    println!("{pieces} pieces: {left:.6} are left, outflow {:.6} T", outflow / T);
    assert!(pieces >= 20 && (left - 0.5).abs() < 1e-3 && (outflow / T - 1.0).abs() < 1e-3);
    let doubt = model.unfinished_drainage().expect("a doubt");
    assert!(doubt.contains("still drain") && doubt.contains("100.0 %"), "{doubt}");
}

/// The water (m) at the far side and in the middle of a porous layer on a tight base, of `levels[0]` all through, a
/// `time` (s) after its other side has gone to `levels[1]`: Boussinesq's equation, in small implicit steps.
fn boussinesq(length: f64, levels: [f64; 2], conductivity: f64, storage: f64, time: f64) -> [f64; 2] {
    const CELLS: usize = 200;
    let (dx, steps) = (length / CELLS as f64, 2000);
    let dt = time / f64::from(steps);
    let mut h = vec![levels[0]; CELLS];
    for _ in 0..steps {
        let side = levels[1];
        let between = |a: f64, b: f64| conductivity * 0.5 * (a + b) / (dx * dx);
        let mut low: Vec<f64> = (1..CELLS).map(|k| between(h[k - 1], h[k])).collect();
        low.insert(0, 0.0);
        let edge = 2.0 * between(h[CELLS - 1], side);
        // Elimination from the far side on.
        let (mut slope, mut value) = (vec![0.0; CELLS], vec![0.0; CELLS]);
        for k in 0..CELLS {
            let next = if k + 1 < CELLS { low[k + 1] } else { edge };
            let before = if k == 0 { [0.0; 2] } else { [slope[k - 1], value[k - 1]] };
            let diagonal = storage / dt + low[k] * (1.0 - before[0]) + next;
            slope[k] = next / diagonal;
            value[k] = (storage / dt * h[k] + low[k] * before[1]) / diagonal;
        }
        let mut after = side;
        for k in (0..CELLS).rev() {
            after = slope[k] * after + value[k];
            h[k] = after;
        }
    }
    [h[0], 0.5 * (h[CELLS / 2 - 1] + h[CELLS / 2])]
}

/// Level and upright joints at a spacing in 40 m of rock, whose right side is lowered by 4 m, from where
/// it has just filled a level joint. The lowest joint
/// lies a spacing above 0, so that the layer begins half a spacing above. All lies in one triangle of the mesh, so that
/// the nodes of the net are the crossings: a level joint drains where another leads down from it.
#[test]
fn a_net_is_drawn_down_as_a_porous_layer() {
    let spacing = 0.5;
    let lines = |count: usize, line: &dyn Fn(f64) -> String| -> String {
        (0..count).map(|k| line((k as f64 + 0.5) * spacing)).collect()
    };
    let joints = lines(80, &|x| format!("[[joint]]\npoints = [[{x}, 0.25], [{x}, 11]]\n"))
        + &lines(21, &|y| format!("[[joint]]\npoints = [[0, {0}], [40, {0}]]\n", y + 0.25));
    let (conductivity, porosity) = (T / spacing, 2.0 * 1e-4 / spacing);
    let time = 0.25 * 1600.0 / (conductivity * 8.0 / porosity);
    let text = format!(
        "title = \"net\"\n[domain]\noutline = [[0, 0.25], [40, 0.25], [40, 11], [0, 11]]\n[mesh]\nsize = 100.0\n\
         least_block = 0\norigin = [-30.0, -5.0]\n{joints}{ROCK}[joint_law.joint]\nfriction_deg = 40\n[[fix]]\n\
         edge = [[0, 0.25], [40, 0.25]]\n[[fix]]\nedge = [[0, 0.25], [0, 11]]\n[flow]\naperture = 1e-4\n[[head]]\n\
         name = \"side\"\nedge = [[40, 0.25], [40, 11]]\nlevel = 10.02\n{REST}{}{}",
        over("open", 1e-3, 1, "heads = { side = 6.02 }\n"),
        over("lower", time, 60, "")
    );
    let mut model = simulation(&text);
    next(&mut model);
    next(&mut model);
    let found = [head(&model, [0.25, 0.5]), head(&model, [20.0, 0.5])];
    let exact = boussinesq(40.0, [9.77, 5.77], conductivity, porosity, time).map(|h| h + 0.25);
    println!("{found:?} m, Boussinesq {exact:?} m");
    assert!(exact[0] < 9.0 && exact[1] < exact[0] - 0.3, "the layer is drawn down");
    assert!((0..2).all(|k| (found[k] - exact[k]).abs() <= 0.02 * 4.0), "{found:?} {exact:?}");
    let [_, left, _] = water(&model).totals();
    assert!(left > 0.0 && model.unfinished_drainage().is_some());
}

/// A slope over a bench with joints that cross, water before it, a drain and a stage that digs.
fn slope(stages: &str) -> String {
    format!(
        "title = \"slope\"\n[domain]\noutline = [[0, 0], [12, 0], [12, 8], [6, 8], [2, 3], [0, 3]]\n[mesh]\n\
         size = 0.9\norigin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 2], [12, 2]]\n[[joint]]\n\
         points = [[1, 0], [12, 7]]\n[[joint]]\npoints = [[9.1, 0], [8, 8]]\n[[joint]]\n\
         points = [[4.0, 5.5], [12, 4.3]]\n{ROCK}[joint_law.joint]\nfriction_deg = 40\nnormal_stiffness = 1e11\n\
         shear_stiffness = 1e11\n[[fix]]\nedge = [[0, 0], [12, 0]]\n[[fix]]\nedge = [[0, 0], [0, 3]]\naxes = \"x\"\n\
         [[fix]]\nedge = [[12, 0], [12, 8]]\naxes = \"x\"\n[water]\nlevel = 4.0\njoints = false\n[flow]\n\
         aperture = 1e-4\nstorage = 1e-3\n[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = 7.5\n\
         [[rain]]\nname = \"top\"\nedge = [[6, 8], [12, 8]]\nrate = 1e-8\n[[drain]]\nname = \"row\"\n\
         points = [[4, 3], [10, 4]]\nactive = false\n{REST}{stages}"
    )
}

/// Levels go evenly, drains act and rock is gone from the start of the stage on; after a long time all is steady.
#[test]
fn after_a_long_time_the_flow_is_the_steady_one() {
    for changes in [
        "heads = { hill = 5.5 }\nwater = { level = 3.5 }\nrain = { top = 3e-8 }\n",
        "drain = [\"row\"]\n",
        "excavate = [[11, 6.8]]\nwater = { level = 5.0 }\n",
    ] {
        let steady = format!("[[stage]]\nname = \"steady\"\nkind = \"static\"\nduration = 0.3\n{changes}");
        let [mut steady, mut long] = [slope(&steady), slope(&over("long", 1e12, 12, changes))].map(|t| simulation(&t));
        next(&mut steady);
        next(&mut long);
        _ = water(&long);
        let [a, b] = [&steady, &long].map(|model| balance(model).sums.as_flattened());
        let through = a.iter().copied().fold(0.0, f64::max);
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{apart:.1e} of {through:.3e} m2/s apart");
        assert!(through > 1e-8 && apart <= 1e-6 * through, "{changes}: {a:?} {b:?}");
        assert_eq!(long.unfinished_drainage(), None);
    }
}

/// A host that has moved the level lets it go from there: two stages in half the time each are one.
#[test]
fn the_way_begins_where_the_last_stage_has_ended() {
    let half = "heads = { hill = 6.5 }\nwater = { level = 3.75 }\nrain = { top = 2e-8 }\n";
    let all = "heads = { hill = 5.5 }\nwater = { level = 3.5 }\nrain = { top = 3e-8 }\n";
    let mut whole = simulation(&slope(&over("all", 8000.0, 8, all)));
    let mut parts = simulation(&slope(&(over("half", 4000.0, 4, half) + &over("rest", 4000.0, 4, all))).replacen(
        "name = \"rest\"",
        "name = \"start\"",
        1,
    ));
    next(&mut whole);
    next(&mut parts);
    assert_eq!(parts.unfinished_drainage(), None, "a later stage goes on");
    let first = water(&parts).stored;
    next(&mut parts);
    let [a, b] = [&whole, &parts].map(|model| &flowing(model).unknowns);
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-9, "{apart}");
    assert!((first + water(&parts).stored - water(&whole).stored).abs() < 1e-12);
    assert!(water(&whole).stored < 0.0 && flowing(&parts).time == 8000.0);
}

/// A rest, a stage with a time of flow and some steps after it, through bytes in the middle when `stopped`.
fn run(threads: usize, stopped: bool) -> State {
    let text = slope(&over(
        "lower",
        3600.0,
        12,
        "heads = { hill = 6.5 }\nwater = { level = 3.5 }\ndrain = [\"row\"]\nexcavate = [[11, 6.8]]\n",
    ));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(&text);
        let through = |one: Simulation| if stopped { through_bytes(&one, &text) } else { one };
        step(&mut one, 40);
        one = through(one);
        let before = one.state().clone();
        next(&mut one);
        let begun = one.state().clone();
        one.return_to(&before);
        next(&mut one);
        assert!(*one.state() == begun);
        one = through(one);
        step(&mut one, 40);
        one.state().clone()
    })
}

#[test]
fn threads_bytes_and_returns_change_no_bit() {
    let one = run(1, false);
    for (threads, stopped) in [(2, false), (8, false), (1, true)] {
        let other = run(threads, stopped);
        let bits = |state: &State| encode(Keeper::Model, state, "hash").expect("bytes");
        assert!(bits(&one) == bits(&other), "{threads} threads, stopped: {stopped}");
    }
}

#[test]
fn a_time_that_flow_cannot_take_is_refused() {
    let stage = |kind: &str, flow: &str| {
        slope(&format!("[[stage]]\nname = \"next\"\nkind = \"{kind}\"\nduration = 1.0\nflow = {flow}\n"))
    };
    let dry = stage("static", "{ time = 1.0, steps = 2 }");
    let dry = dry.replace("[flow]\naperture = 1e-4\nstorage = 1e-3\n", "");
    let (head, rain, drain) = (dry.find("[[head]]"), dry.find("[[stage]]"), "");
    let dry = format!("{}{}{drain}", &dry[..head.expect("a head")], &dry[rain.expect("a stage")..]);
    for (text, message) in [
        (stage("dynamic", "{ time = 1.0, steps = 2 }"), "stage[1].flow: has a time, but only static stages have it"),
        (stage("static", "{ time = 0.0, steps = 2 }"), "stage[1].flow.time: is 0"),
        (stage("static", "{ time = 1.0, steps = 0 }"), "stage[1].flow.steps: is 0"),
        (stage("static", "{ time = 1.0 }"), "steps"),
        (stage("static", "{ tim = 1.0, steps = 2 }"), "tim"),
        (dry, "stage[1].flow: has no effect without [flow]"),
        (
            slope("").replace("duration = 0.3", "duration = 0.3\nflow = { time = 1.0, steps = 2 }"),
            "stage[0].flow: has a time, and is in the first stage",
        ),
        (slope("").replace("storage = 1e-3", "storage = -1.0"), "flow.storage: is -1"),
    ] {
        let told = refusal(&text);
        assert!(told.contains(message), "{text}\n{told}");
    }
    let mut model = simulation(&slope(&over("next", 10.0, 2, "")));
    next(&mut model);
    let mut state = model.state().clone();
    state.seepage.as_mut().expect("flow").time = f64::NAN;
    assert!(model.check(&state).expect_err("refused").to_string().starts_with("seepage.time is NaN"));
}

/// The rock relaxes once, under the pressures at the end of the time.
#[test]
fn the_rock_rests_under_the_pressures_at_the_end() {
    let mut model = simulation(&slope(&over("lower", 1e4, 8, "heads = { hill = 5.5 }\n")));
    let pushed = |model: &Simulation| model.load_forces().iter().map(|force| force.norm()).sum::<f64>();
    let before = pushed(&model);
    next(&mut model);
    let after = pushed(&model);
    assert!(after < 0.97 * before, "{after} {before}");
    let held = flowing(&model).unknowns.clone();
    run_stage(&mut model);
    assert_eq!(flowing(&model).unknowns, held);
}
