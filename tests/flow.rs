//! Claims: water that flows in joints is at rest where all heads are equal, and presses then as still water does; flows
//! are those of hand calculations of nets of two joints, before and after an excavation and a rock bridge; what enters
//! leaves, and states are the same to the bit by any number of threads and through bytes.

use allocation_counter::measure;

use crate::common::{case, refusal, run_stage, simulation, step, through_bytes};
use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm::model::bytes::{Keeper, encode};
use enmm::model::{FlowBalance, Seepage, Simulation, State};

/// A slope over a bench with four joints that cross, and water on its left.
fn slope(more: &str) -> String {
    format!(
        "title = \"slope\"\n[domain]\noutline = [[0, 0], [12, 0], [12, 8], [6, 8], [2, 3], [0, 3]]\n[mesh]\n\
         size = 0.7\nangle_deg = 11\norigin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 2], [12, 2]]\n[[joint]]\n\
         points = [[1, 0], [12, 7]]\n[[joint]]\npoints = [[9.1, 0], [8, 8]]\n[[joint]]\n\
         points = [[4.0, 5.5], [12, 4.3]]\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 40\n[[fix]]\nedge = [[0, 0], [12, 0]]\n[[fix]]\nedge = [[0, 0], [0, 3]]\n\
         axes = \"x\"\n[[fix]]\nedge = [[12, 0], [12, 8]]\naxes = \"x\"\n{more}[[stage]]\nname = \"rest\"\n\
         kind = \"static\"\nduration = 2.0\n"
    )
}

/// The balance of the stage in progress.
fn balance(simulation: &Simulation) -> &FlowBalance {
    flowing(simulation).balances.last().expect("a balance")
}

fn flowing(simulation: &Simulation) -> &Seepage {
    simulation.state().seepage.as_ref().expect("water that flows")
}

/// Forces of water of 1000 kg/m³ on covers sum a few dozen parts of them each: 1e-12 of the weight of the rock is
/// rounding.
#[test]
fn where_all_heads_are_equal_water_presses_as_if_it_were_still() {
    let still = simulation(&slope("[water]\nlevel = 6.3\n"));
    let flow = "[flow]\naperture = 1e-4\n[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = 6.3\n";
    let moving = simulation(&slope(&format!("[water]\nlevel = 6.3\njoints = false\n{flow}")));
    let weight: f64 = still.model().mass_matrix.total.iter().map(|mass| mass * 9.81).sum();
    let [a, b] = [&still, &moving].map(Simulation::load_forces);
    let pushed: f64 = a.iter().map(Vector::norm).sum();
    let apart = a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!("{pushed:.3e} N/m of water, {:.1e} of the weight apart", apart / weight);
    assert!(pushed > 0.5 * weight && apart <= 1e-12 * weight, "{apart} of {weight}");
    assert!(balance(&moving).sums.as_flattened().iter().all(|q| *q < 1e-18), "{:?}", balance(&moving));
}

/// A plate with a level joint at a height of 4 m, two joints from there to its top, and what else.
fn plate(joint: &str, more: &str, stages: &str) -> String {
    format!(
        "title = \"plate\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 8], [0, 8]]\njoint_law = \"joint\"\n[mesh]\n\
         size = 0.9\norigin = [0.131, 0.077]\n{joint}[[joint]]\npoints = [[4, 4], [4, 8]]\n[[joint]]\n\
         points = [[6, 4], [6, 8]]\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n[joint_law.joint]\n\
         friction_deg = 40\n[[fix]]\nedge = [[0, 0], [10, 0]]\n[[fix]]\nedge = [[0, 0], [0, 8]]\n[[fix]]\n\
         edge = [[10, 0], [10, 8]]\n[flow]\naperture = 2e-4\naperture_min = 2e-4\naperture_max = 2e-4\n[[head]]\n\
         name = \"left\"\nedge = [[0, 0], [0, 8]]\nlevel = 7.0\n[[head]]\nname = \"right\"\n\
         edge = [[10, 0], [10, 8]]\nlevel = 4.5\n{more}[[stage]]\nname = \"rest\"\nkind = \"static\"\n\
         duration = 0.3\n{stages}"
    )
}

const LEVEL_JOINT: &str = "[[joint]]\npoints = [[0, 4], [10, 4]]\n";
/// Transmissivity (m²/s) of its joints: γe³/12μ.
const T: f64 = 1000.0 * 9.81 * 8e-12 / (12.0 * 1e-3);

/// Checks what enters and leaves left, right, from the reservoir and from the air (m²/s), to rounding.
fn assert_flows<const N: usize>(simulation: &Simulation, exact: [[f64; 2]; N]) {
    let FlowBalance { sums, residual, .. } = balance(simulation);
    assert_eq!(sums.len(), N);
    for (k, (found, exact)) in sums.iter().zip(exact).enumerate() {
        let off = [0, 1].map(|side| (found[side] - exact[side]).abs());
        assert!(off.iter().all(|off| *off <= 1e-12 * T), "{k}: {found:?} instead of {exact:?}");
    }
    let through: f64 = sums.iter().map(|sum| sum[0] - sum[1]).sum();
    assert!(through.abs() <= 1e-12 * T && *residual <= 1e-12 * T, "{through} {residual}");
}

#[test]
fn an_excavation_opens_outcrops() {
    let stages = "[[stage]]\nname = \"dig\"\nkind = \"static\"\nduration = 0.3\nexcavate = [[5, 6]]\n[[stage]]\n\
                  name = \"lower\"\nkind = \"static\"\nduration = 0.3\nheads = { left = 6.0 }\n";
    let mut dug = simulation(&plate(LEVEL_JOINT, "", stages));
    let through = T * 2.5 / 10.0;
    assert_flows(&dug, [[through, 0.0], [0.0, through], [0.0; 2], [0.0; 2]]);
    run_stage(&mut dug);
    assert!(dug.next_stage().expect("a stage"));
    let [left, right] = [T * 3.0 / 4.0, T * 0.5 / 4.0];
    assert_flows(&dug, [[left, 0.0], [right, 0.0], [0.0; 2], [0.0, left + right]]);
    run_stage(&mut dug);
    assert!(dug.next_stage().expect("a stage"));
    let left = T * 2.0 / 4.0;
    assert_flows(&dug, [[left, 0.0], [right, 0.0], [0.0; 2], [0.0, left + right]]);
}

/// A pit that has a face in the water fills with it: its outcrops have that head, and its bare faces bear its pressure.
#[test]
fn water_of_the_reservoir_fills_an_excavation_that_it_reaches() {
    let stages = "[[stage]]\nname = \"dig\"\nkind = \"static\"\nduration = 0.3\nexcavate = [[5, 6]]\n";
    let water = "[water]\nlevel = 9.0\njoints = false\n";
    let mut dug = simulation(&plate(LEVEL_JOINT, water, stages));
    run_stage(&mut dug);
    assert!(dug.next_stage().expect("a stage"));
    let [left, right] = [T * 2.0 / 4.0, T * 4.5 / 4.0];
    assert_flows(&dug, [[0.0, left], [0.0, right], [left + right, 0.0], [0.0; 2]]);
    // The floor of the pit, 2 m wide, bears 5 m of water; the sums of the walls level out.
    let floor = crate::common::claims::block_at(&dug, [5.0, 2.0]);
    let forces = dug.load_forces();
    let down: f64 = dug.model().covers.covers_of(floor).map(|i| forces[i].y).sum();
    let under = |q: f64, from: f64, to: f64| q * 4.0 * 0.5 * (from + to);
    let exact = -9810.0 * (5.0 * 2.0 + under(1.0, 3.0, 5.0) + under(1.0, 5.0, 0.5));
    // Faces have moved by some micrometres under their weight.
    assert!((down / exact - 1.0).abs() < 1e-5, "{down} instead of {exact}");
}

#[test]
fn a_rock_bridge_keeps_water_back_until_it_breaks() {
    let joint = "[[joint]]\npoints = [[0, 4], [4, 4]]\n[[bridge]]\npoints = [[4, 4], [6, 4]]\nlaw = \"bridge\"\n\
                 [[joint]]\npoints = [[6, 4], [10, 4]]\n";
    let law = |tension: f64| {
        format!(
            "[joint_law.bridge]\nfriction_deg = 40\ntension = {tension:?}\ncohesion = {tension:?}\n\
             residual_cohesion = 0\n"
        )
    };
    let lift = "[[load]]\nkind = \"traction\"\nedge = [[0, 8], [10, 8]]\ntraction = [0, 6e5]\n";
    let stages = "[[stage]]\nname = \"again\"\nkind = \"static\"\nduration = 0.3\n";
    for (tension, holds) in [(1e9, true), (1e3, false)] {
        let mut model = simulation(&plate(joint, &(law(tension) + lift), stages));
        assert_flows(&model, [[0.0; 2]; 4]);
        run_stage(&mut model);
        assert!(model.next_stage().expect("a stage"));
        let through = if holds { 0.0 } else { T * 2.5 / 10.0 };
        assert_flows(&model, [[through, 0.0], [0.0, through], [0.0; 2], [0.0; 2]]);
    }
}

/// Two steps of a slope in which water flows, through bytes in the middle when `stopped`.
fn run(threads: usize, stopped: bool) -> State {
    let text = slope(
        "[water]\nlevel = 4.0\njoints = false\n[flow]\naperture = 1e-4\n[[head]]\nname = \"hill\"\n\
         edge = [[12, 0], [12, 8]]\nlevel = 7.5\n",
    ) + "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 1.0\n[[stage]]\nname = \"lower\"\n\
         kind = \"static\"\nduration = 1.0\nheads = { hill = 6.5 }\nwater = { level = 3.5 }\n";
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(&text);
        let through = |one: Simulation| if stopped { through_bytes(&one, &text) } else { one };
        step(&mut one, 60);
        one = through(one);
        let held = flowing(&one).unknowns.clone();
        assert!(one.next_stage().expect("a stage"));
        assert_eq!(flowing(&one).unknowns, held, "a dynamic stage holds the pressures of before");
        step(&mut one, 40);
        one = through(one);
        assert!(one.next_stage().expect("a stage"));
        assert_ne!(flowing(&one).unknowns, held);
        step(&mut one, 40);
        let state = one.state().clone();
        step(&mut one, 5);
        one.return_to(&state);
        assert!(*one.state() == state);
        state
    })
}

#[test]
fn a_step_with_water_in_joints_allocates_nothing() {
    let flow = "[flow]\naperture = 1e-4\n[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = 7.5\n";
    let mut model = simulation(&slope(&format!("[water]\nlevel = 4.0\njoints = false\n{flow}")));
    model.set_serial(true);
    step(&mut model, 400);
    let found = measure(|| step(&mut model, 50));
    assert_eq!(found.count_total, 0, "{found:?}");
}

#[test]
fn threads_and_bytes_change_no_bit_and_what_enters_leaves() {
    let one = run(1, false);
    let balances = &one.seepage.as_ref().expect("water that flows").balances;
    let FlowBalance { stage, sums, residual, .. } = balances.last().expect("a balance");
    assert_eq!((balances.len(), *stage), (2, 2), "one of each static stage");
    let [enters, leaves] = [0, 1].map(|side| sums.iter().map(|sum| sum[side]).sum::<f64>());
    println!("{enters:.3e} m2/s enter, {:.1e} of them stay, residual {residual:.1e}", enters - leaves);
    assert!(enters > 1e-7 && (enters - leaves).abs() <= 1e-11 * enters, "{enters} {leaves}");
    for (threads, stopped) in [(2, false), (8, false), (1, true)] {
        let other = run(threads, stopped);
        let bits = |state: &State| encode(Keeper::Model, state, "hash").expect("bytes");
        assert!(bits(&one) == bits(&other), "{threads} threads, stopped: {stopped}");
    }
}

/// Openings since the start count at the start of a later stage: the lid, held at both ends, is lifted off its joint,
/// which takes more water then, and within the greatest aperture.
#[test]
fn joints_that_have_opened_take_more_water_in_the_next_stage() {
    let lift = "[[load]]\nkind = \"traction\"\nedge = [[0, 8], [10, 8]]\ntraction = [0, 6e5]\n";
    let stages = "[[stage]]\nname = \"again\"\nkind = \"static\"\nduration = 0.3\n";
    let through = |most: &str| {
        let text = plate(LEVEL_JOINT, lift, stages).replace("aperture_max = 2e-4\n", most);
        let mut model = simulation(&text);
        let before = balance(&model).sums[0][0];
        run_stage(&mut model);
        assert!(model.next_stage().expect("a stage"));
        balance(&model).sums[0][0] / before
    };
    let [free, bounded] = ["", "aperture_max = 2.2e-4\n"].map(through);
    println!("{free:.4} and {bounded:.4} times the flow");
    assert!(free > 1.01 && bounded > 1.01 && bounded <= 1.1_f64.powi(3) && bounded <= free, "{free} {bounded}");
}

/// Heads that say nothing, joints that no water reaches, and no water at all.
#[test]
fn flow_that_looks_unintended_is_doubted() {
    let head = |level: f64| format!("[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = {level:?}\n");
    let told = |more: &str| simulation(&slope(more)).built().warnings.join("\n");
    let flow = "[flow]\naperture = 1e-4\n";
    let water = "[water]\nlevel = 6.3\njoints = false\n";
    assert_eq!(told(&format!("{water}{flow}{}", head(7.0))), "");
    assert!(told(&format!("{water}{flow}{}", head(6.3))).starts_with("flow: all heads are equal and no water flows"));
    assert!(told(&format!("{flow}{}", head(-1.0))).starts_with("flow: no water enters"));
    let alone = "[[joint]]\npoints = [[9.3, 2.5], [9.9, 3.9], [11, 3], [9.3, 2.5]]\nlaw = \"joint\"\n";
    let text = slope(&format!("{water}{flow}{}{alone}", head(7.0)));
    assert!(simulation(&text).built().warnings.join("\n").contains("meet neither a head nor an outcrop"));
    let soil = slope(&format!("{water}{flow}{}", head(7.0)));
    let soil = soil.replace("young = 1e10", "young = 1e10\nfriction_deg = 40\ncohesion = 1e6");
    assert!(simulation(&soil).built().warnings.join("\n").contains("pores of rock that yields"));
}

#[test]
fn a_survey_counts_the_net() {
    let survey = simulation(&plate(LEVEL_JOINT, "", "")).flow_survey().expect("a net");
    println!("{survey:?}");
    assert_eq!((survey.heads, survey.outcrops, survey.dead_ends), (2, 2, 0));
    assert!((survey.length - 18.0).abs() < 1e-9 && survey.isolated == 0.0 && survey.nodes == survey.pieces + 1);
    assert!(survey.transmissivity.iter().all(|found| (found / T - 1.0).abs() < 1e-9), "{survey:?}");
}

#[test]
fn a_state_without_its_flow_is_refused() {
    let model = simulation(&plate(LEVEL_JOINT, "", ""));
    let mut state = model.state().clone();
    state.seepage.as_mut().expect("flow").unknowns[0] = f64::NAN;
    assert!(model.check(&state).expect_err("refused").to_string().starts_with("seepage.unknowns[0] is NaN"));
    state.seepage = None;
    assert!(model.check(&state).is_err());
}

#[test]
fn what_flow_needs_and_excludes_is_told() {
    let head = "[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = 7.5\n";
    let flow = format!("[flow]\naperture = 1e-4\n{head}");
    for (more, key, message) in [
        (head.to_owned(), "head[0]", "has no effect without [flow]"),
        (format!("[flow]\n{head}"), "flow.aperture", "is missing, and joint_law.joint has no aperture either"),
        (format!("{flow}[water]\nlevel = 3.0\n"), "water.joints", "write `joints = false`"),
        (format!("{flow}[gravity]\ny = 0.0\n"), "flow", "needs gravity"),
        (format!("{flow}[solver]\nintegrator = \"implicit\"\n"), "flow", "use the explicit one"),
        (format!("[flow]\naperture = 1e-4\naperture_max = 5e-5\n{head}"), "flow.aperture", "must be at least"),
        (format!("[flow]\naperture = 1e-4\naperture_min = 1e-2\n{head}"), "flow.aperture_min", "must be at most"),
        (flow.replace("[[12, 0], [12, 8]]", "[[6, 8], [7, 8]]"), "head[0].edge", "no end and no crossing of a joint"),
        (flow.clone() + &head.replace("hill", "lake"), "head[1].edge", "that head \"hill\" holds too"),
        (flow.replace("hill", "air"), "head[0].name", "rename the head"),
        (flow.replace("hill", "the hill"), "head[0].name", "must begin with a letter"),
        (flow.replace("1e-4", "0.0"), "flow.aperture", "must be greater than 0"),
    ] {
        let text = slope(&more);
        let told = refusal(&text);
        assert!(told.contains(&format!("{key}: ")) && told.contains(message), "{more}\n{told}");
    }
    let stages = |kind: &str, more: &str| {
        slope(&flow) + &format!("[[stage]]\nname = \"next\"\nkind = \"{kind}\"\nduration = 1.0\n{more}")
    };
    let cut = "[[stage.cut]]\npoints = [[8.5, 4], [12, 5]]\nlaw = \"joint\"\n";
    for (text, message) in [
        (stages("static", "heads = { hil = 3.0 }\n"), "no head is named \"hil\", did you mean \"hill\"?"),
        (stages("static", "heads = { hill = 1e30 }\n"), "stage[1].heads: is 1e30 m, must be"),
        (stages("dynamic", "heads = { hill = 3.0 }\n"), "give it in a static stage"),
        (stages("static", cut), "flow: cannot follow blocks that break or that a stage cuts, as stage[1].cut does"),
    ] {
        let told = refusal(&text);
        assert!(told.contains(message), "{text}\n{told}");
    }
    assert!(case(&stages("static", "heads = { hill = 3.0 }\n")).stages[1].heads["hill"] == 3.0);
}

/// A host that steps far or near, or goes back, finds the same bits: dynamic stages hold the pressures.
#[test]
fn steps_of_a_host_change_no_bit() {
    let flow = "[flow]\naperture = 1e-4\n[[head]]\nname = \"hill\"\nedge = [[12, 0], [12, 8]]\nlevel = 7.5\n";
    let text = slope(&format!("[water]\nlevel = 4.0\njoints = false\n{flow}"));
    let text = text + "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 1.0\n";
    let end = 0.05;
    let host = || Cosimulation::new(case(&text)).unwrap_or_else(|e| panic!("{e}"));
    let run = |model: &mut Cosimulation, parts: u32| {
        for part in 0..parts {
            let from = end * f64::from(part) / f64::from(parts);
            model.do_step(from, end / f64::from(parts)).unwrap_or_else(|e| panic!("{e}"));
        }
    };
    let [mut whole, mut parts] = [host(), host()];
    run(&mut whole, 1);
    parts.start().unwrap_or_else(|e| panic!("{e}"));
    let saved = parts.save();
    run(&mut parts, 10);
    assert!(whole.simulation().state() == parts.simulation().state());
    parts.restore(&saved).unwrap_or_else(|e| panic!("{e}"));
    run(&mut parts, 2);
    assert!(whole.simulation().state() == parts.simulation().state());
    assert!(flowing(whole.simulation()).unknowns.iter().any(|head| *head > 1.0));
}
