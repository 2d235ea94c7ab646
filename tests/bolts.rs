//! Rock bolts hang, yield, break and hold joints together as elastic–plastic bars do, at any stiffness, through
//! checkpoints to the bit, and with a closed ledger.

use crate::common::claims::{advance, assert_ledger, block_at};
use crate::common::{refusal, run_stage, simulation, through_bytes};
use enmm::model::Simulation;

const G: f64 = 9.81;
const AREA: f64 = 2.0 * 0.8;
const DENSITY: f64 = 2500.0;
const WEIGHT: f64 = AREA * DENSITY * G;

/// A block of 2 m × 0.8 m that hangs below a held slab, from which a smooth joint parts it, and bolts.
fn roof(bolts: &str, stages: &str) -> String {
    format!(
        "title = \"roof\"\n[domain]\noutline = [[-1, 0], [3, 0], [3, 1], [-1, 1]]\n\
         islands = [[[0, -0.8], [2, -0.8], [2, 0], [0, 0]]]\n[mesh]\nsize = 0.5\norigin = [0.031, 0.017]\n\
         [joint_law.joint]\nfriction_deg = 0.0\n[rock.rock]\ndensity = {DENSITY}\nyoung = 2e10\npoisson = 0.2\n\
         [[fix]]\nblock = [-0.5, 0.5]\n{bolts}{stages}"
    )
}

fn bolt(x: f64, young: f64, more: &str) -> String {
    format!("[[bolt]]\npoints = [[{x:?}, -0.4], [{x:?}, 0.6]]\nyoung = {young:e}\narea = 1e-3\n{more}\n")
}

const SETTLE: &str = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n";
const DROP: &str = "[[stage]]\nname = \"drop\"\nkind = \"dynamic\"\nduration = 2.0\ndamping = 0.0\n";

fn forces(simulation: &Simulation) -> Vec<f64> {
    simulation.state().bolts.iter().map(|b| b.force).collect()
}

fn hang(simulation: &Simulation) -> f64 {
    -simulation.motion_of(block_at(simulation, [1.03, -0.41])).displacement.y
}

/// Two bars off the middle by e1 and e2 share the weight by the lever; each gets longer by T·L/EA. The rock between
/// joint and anchor strains by some 1e-6 of its size: nothing against the bars' 2e-3 (E·A = 1e7 N). Spacing 2 m halves.
#[test]
fn bars_share_the_weight_by_the_lever() {
    let bars = bolt(0.5, 1e10, "") + &bolt(1.25, 2e10, "spacing = 2.0");
    let mut sim = simulation(&roof(&bars, SETTLE));
    let report = run_stage(&mut sim);
    // Moments about the middle x = 1, for the small turn that leaves both bars straight.
    let exact = [WEIGHT * 0.25 / 0.75, WEIGHT * 0.5 / 0.75];
    for (found, exact) in forces(&sim).iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} of {exact}");
    }
    let stretch = |k: usize| forces(&sim)[k] * 1.0 / 1e7;
    let mean = stretch(0) + (stretch(1) - stretch(0)) * (0.5 / 0.75);
    assert!((hang(&sim) / mean - 1.0).abs() < 5e-3, "{} of {mean}", hang(&sim));
    assert_ledger(&report);
}

/// A bar that yields at 1.3 times the weight stops the fall of the block after a plastic way: dropped from rest with no
/// tension, energy balance W·x = Y·x − Y²/2k gives x = Y²/(2k(Y − W)). Then it hangs by W on the unloaded bar.
/// Stiffness and yield are those of the bar: rock strains 1e-5 of that, so 1 %.
#[test]
fn a_bar_that_yields_stops_the_block_after_its_plastic_way() {
    let (limit, stiffness) = (1.3 * WEIGHT, 1e-3 * 1e10);
    let text = roof(&bolt(1.0, 1e10, &format!("yield_force = {limit:e}")), DROP);
    let mut sim = simulation(&text);
    let mut deepest = 0.0f64;
    let mut report = Default::default();
    for _ in 0..sim.steps_in(0.5) / 20 {
        report = advance(&mut sim, 20);
        deepest = deepest.max(hang(&sim));
    }
    let exact = limit * limit / (2.0 * stiffness * (limit - WEIGHT));
    println!("deepest {deepest} of {exact}; {:?}", sim.state().bolts);
    assert!((deepest / exact - 1.0).abs() < 1e-2, "{deepest} of {exact}");
    let bar = sim.state().bolts[0];
    let plastic = limit * (bar.rest - bar.natural);
    let ledger = report.ledger;
    assert!((ledger.bolt_dissipation() / plastic - 1.0).abs() < 2e-2, "{} of {plastic}", ledger.bolt_dissipation());
    assert!(ledger.contact_dissipation().abs() < 1e-3 * plastic);
    assert_ledger(&report);
}

/// The same bar breaks when its elongation passes the rupture strain on the way, and the block falls freely from then.
#[test]
fn a_bar_breaks_at_its_rupture_strain() {
    let text = roof(&bolt(1.0, 1e10, &format!("yield_force = {:e}\nrupture_strain = 4e-3", 1.3 * WEIGHT)), DROP);
    let mut sim = simulation(&text);
    while !sim.state().bolts[0].broken {
        assert!(hang(&sim) < 4.1e-3, "it breaks at 4 mm");
        advance(&mut sim, 1);
    }
    assert!(hang(&sim) > 3.9e-3);
    let speed = |sim: &Simulation| -sim.motion_of(block_at(sim, [1.03, -0.41])).velocity.y;
    let (before, start) = (speed(&sim), sim.time());
    let report = advance(&mut sim, 1000);
    let gain = speed(&sim) - before;
    assert!((gain / (G * (sim.time() - start)) - 1.0).abs() < 1e-2, "it falls freely");
    assert_eq!(forces(&sim), [0.0]);
    assert_ledger(&report);
}

/// Grouted bars press the block against the slab by their pretension, less the weight; in a soft joint the bar gives as
/// much as the joint opens. The smooth joint leaves the block free to swing along it, which takes long: 1e-5 is rest.
/// With stiff bars (2e11 Pa over 5 cm of free length: k·W·dt² of some hundreds) the step is the rock's own and the
/// model is at rest. A stage installs a second bar, which has its pretension at once.
#[test]
fn grouted_bars_need_no_smaller_step_and_come_by_stage() {
    let bars = bolt(0.5, 2e11, "anchorage = \"grouted\"\nname = \"first\"\npretension = 4e4")
        + &bolt(1.5, 2e11, "anchorage = \"grouted\"\nname = \"second\"\npretension = 3e4\nactive = false");
    let more = "[[stage]]\nname = \"install\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-5\ninstall = \
    [\"second\"]\n";
    let mut sim = simulation(&roof(&bars, &(SETTLE.replace("1e-7", "1e-5") + more)));
    let plain = simulation(&roof("", SETTLE));
    assert_eq!(sim.model().dt, plain.model().dt);
    run_stage(&mut sim);
    assert!(forces(&sim)[0] > 3.5e4 && forces(&sim)[1] == 0.0, "{:?}", forces(&sim));
    assert!(sim.next_stage().expect("it fits"));
    assert_eq!(forces(&sim)[1], 3e4);
    let report = run_stage(&mut sim);
    let normal: f64 = sim.contacts().iter().map(|c| c.history.normal_force).sum();
    let exact = forces(&sim).iter().sum::<f64>() - WEIGHT;
    assert!((normal / exact - 1.0).abs() < 1e-3, "{normal} of {exact}");
    assert!(report.ledger.kinetic < 1e-6 && sim.at_rest(&report));
    assert_ledger(&report);
}

#[test]
fn a_saved_state_goes_on_with_the_same_bits() {
    let stage = "[[stage]]\nname = \"drop\"\nkind = \"dynamic\"\nduration = 2.0\n";
    let text = roof(&bolt(0.8, 1e10, &format!("yield_force = {:e}", 1.3 * WEIGHT)), stage);
    let mut sim = simulation(&text);
    advance(&mut sim, 300);
    let mut other = simulation(&text);
    let mut copy = other.state().clone();
    copy.clone_from(sim.state());
    assert!(other.check(&copy).is_ok());
    other.restore(copy);
    advance(&mut sim, 300);
    advance(&mut other, 300);
    assert_eq!(sim.state(), other.state());
}

#[test]
fn bolts_that_cannot_be_are_errors() {
    let named = |more: &str| bolt(1.0, 2e11, more);
    let install = |name: &str| SETTLE.to_owned() + &format!("install = [\"{name}\"]\n");
    for (bolts, stages, words) in [
        (bolt(9.0, 2e11, ""), SETTLE.into(), "bolt[0].points[0]: there is no rock"),
        (named("").replace("0.6]]", "-0.2]]") + "anchorage = \"grouted\"\n", SETTLE.into(), "crosses no joint"),
        (named("active = false"), SETTLE.into(), "no stage can install the bolt"),
        (named("name = \"a\"\nactive = false"), install("b"), "no bolt is named \"b\""),
        (named("name = \"a\""), install("a"), "is there already"),
        (named("pretension = 3e5\nyield_force = 2e5"), SETTLE.into(), "at which the bar yields"),
        (named("free_length = 0.1"), SETTLE.into(), "bolt[0].free_length"),
        (named("name = \"a\"\nactive = false"), install("a") + "excavate = [[1.0, -0.4]]\n", "has been removed"),
    ] {
        let message = refusal(&roof(&bolts, &stages));
        assert!(message.contains(words), "{message}");
    }
}

/// A grouted bolt through an opening crosses its two joints and reports how much of it is in air.
#[test]
fn a_bolt_through_an_opening_warns() {
    let text = roof(&bolt(1.0, 2e11, "anchorage = \"grouted\""), SETTLE)
        .replace("points = [[1.0, -0.4]", "points = [[1.0, -1.5]")
        .replace("islands = [", "islands = [[[0, -2], [2, -2], [2, -1.2], [0, -1.2]], ");
    let sim = simulation(&text);
    assert_eq!(sim.model().bolts.len(), 1);
    let warning = &sim.built().warnings.iter().find(|w| w.contains("outside the rock")).expect("a warning").clone();
    assert!(warning.contains("0.400 m"), "{warning}");
}

/// A held slab and a smaller one beside it, parted by a smooth joint at x = 0 that opens; a grouted bar from a plate on
/// the small one's face through the joint far into the held one, and a pull on the small one.
fn pulled(pull: f64, bar: &str, stages: &str) -> String {
    format!(
        "title = \"pull\"\n[domain]\noutline = [[-4, 0], [1, 0], [1, 1], [-4, 1]]\n[mesh]\nsize = 0.4\n\
         [[joint]]\npoints = [[0, -1], [0, 2]]\n[joint_law.joint]\nfriction_deg = 0.0\n[gravity]\ny = 0\n\
         [rock.rock]\ndensity = {DENSITY}\nyoung = 1e11\npoisson = 0.2\n[[fix]]\nblock = [-2, 0.5]\n\
         [[fix]]\nedge = [[0, 0], [1, 0]]\naxes = \"y\"\n[[load]]\nkind = \"block\"\npoint = [0.5, 0.5]\n\
         force = [{pull}, 0]\n[[bolt]]\npoints = [[1, 0.51], [-3.6, 0.51]]\nanchorage = \"grouted\"\nplate = true\n\
         young = 2e11\narea = 5e-4\n{bar}\n{stages}"
    )
}

/// Force (N/m) of the bar where it passes the middle between neighbouring points, by the distance from the joint (m).
fn along(simulation: &Simulation) -> Vec<(f64, f64)> {
    let rows = simulation.model().bolts.iter().zip(&simulation.state().bolts);
    rows.map(|(segment, bar)| (-0.5 * (segment.points[0].x + segment.points[1].x), bar.force)).collect()
}

/// In rock that hardly strains the force falls off from the joint by e^(−αx), α² = bond stiffness/EA (I. W. Farmer
/// 1975), and the whole pull passes the joint. Points a fifth of 1/α apart: (0.2)²/24 of x·α, and the rock strains.
#[test]
fn a_bond_that_holds_sheds_the_force_by_farmers_exponential() {
    let (pull, bond_stiffness, axial): (f64, f64, f64) = (60e3, 4e8, 2e11 * 5e-4);
    let mut sim = simulation(&pulled(pull, &format!("bond = 1e9\nbond_stiffness = {bond_stiffness:e}"), SETTLE));
    let report = run_stage(&mut sim);
    let alpha = (bond_stiffness / axial).sqrt();
    let held: Vec<(f64, f64)> = along(&sim).into_iter().filter(|(x, _)| (0.0..1.2).contains(x)).collect();
    assert!(held.len() > 8, "{held:?}");
    for (x, force) in held {
        let exact = pull * (-alpha * x).exp();
        assert!((force / exact - 1.0).abs() < 0.01, "{x}: {force} of {exact}");
    }
    assert!(sim.state().bolts.iter().all(|bar| bar.slid == [0.0; 2]));
    assert_ledger(&report);
}

/// Beyond that the bar slips next to the joint, where each metre holds `bond` and no more: the force falls in a line
/// over pull/bond − 1/α, and by the exponential from there. At a spacing of 2 m the rock feels half of each bar. A pull
/// of more than bond times length draws the bar out. The same bits on two threads and through a saved state.
#[test]
fn a_bond_that_slips_holds_by_its_length() {
    let (bond, bond_stiffness, axial): (f64, f64, f64) = (200e3, 4e8, 2e11 * 5e-4);
    let alpha = (bond_stiffness / axial).sqrt();
    let keys = format!("bond = {bond:e}\nbond_stiffness = {bond_stiffness:e}\nspacing = 2.0");
    let pull = 300e3;
    let mut sim = simulation(&pulled(0.5 * pull, &keys, SETTLE));
    let report = run_stage(&mut sim);
    let slips = pull / bond - 1.0 / alpha;
    for (x, force) in along(&sim).into_iter().filter(|(x, _)| (0.0..2.4).contains(x)) {
        let exact = if x < slips { pull - bond * x } else { bond / alpha * (-alpha * (x - slips)).exp() };
        assert!((2.0 * force - exact).abs() < 0.01 * pull, "{x}: {} of {exact}", 2.0 * force);
    }
    let bars = sim.model().bolts.iter().zip(&sim.state().bolts);
    let slid: Vec<f64> = bars.filter(|(_, bar)| bar.slid[1] != 0.0).map(|(s, _)| -s.points[1].x).collect();
    let farthest = slid.into_iter().fold(0.0, f64::max);
    let step = sim.model().bolts[5].points[0].x - sim.model().bolts[5].points[1].x;
    assert!((farthest - slips).abs() < step, "slips to {farthest} of {slips}");
    let lost = report.ledger.bolt_dissipation();
    assert!(lost > 0.0, "{lost}");
    assert_ledger(&report);
    // 3.6 m hold 720 kN: less passes the joint whole, more goes on drawing the bar out.
    let drawn = |pull: f64| {
        let mut sim = simulation(&pulled(0.5 * pull, &keys, SETTLE));
        let steps = sim.steps_in(0.4);
        advance(&mut sim, steps);
        let most = forces(&sim).into_iter().fold(0.0, f64::max);
        (2.0 * most, sim.motion_of(block_at(&sim, [0.5, 0.5])).displacement.x)
    };
    let [(held, stays), (full, goes)] = [drawn(600e3), drawn(1100e3)];
    assert!((held - 600e3).abs() < 0.01 * 600e3, "{held}");
    assert!((full - bond * 3.6).abs() < 0.01 * bond * 3.6, "{full} of {}", bond * 3.6);
    assert!(goes > 2.0 * stays, "{stays} {goes}");
}

/// A grouted bar with a bond goes on from a saved state to the bit, and through threads.
#[test]
fn a_bond_keeps_its_bits() {
    let text = pulled(150e3, "bond = 200e3\nbond_stiffness = 4e8\nyield_force = 2e5", DROP);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut sim = simulation(&text);
            advance(&mut sim, 400);
            sim
        })
    };
    let mut first = run(1);
    assert!(first.state() == run(2).state(), "threads change bits");
    let mut second = through_bytes(&first, &text);
    advance(&mut first, 200);
    advance(&mut second, 200);
    assert!(first.state() == second.state());
    assert!(first.state().bolts.iter().any(|bar| bar.slid[0] != 0.0));
}

/// Keys of a bond that do not go together, and one too stiff for the step.
#[test]
fn a_bond_says_what_it_needs() {
    for (bar, message) in [
        ("bond = 2e5", "bolt[0].bond_stiffness: is missing"),
        ("bond_stiffness = 1e9", "bolt[0].bond_stiffness: belongs to"),
        ("bond = 2e5\nbond_stiffness = 1e9\nfree_length = 0.2", "beside `free_length`"),
        ("bond = 2e5\nbond_stiffness = 1e9\nsupport = \"passive\"\nyield_force = 1e5", "beside `support`"),
        ("bond = 2e5\nbond_stiffness = 9e13", "bolt[0].bond_stiffness: is 9.000e13"),
    ] {
        let found = refusal(&pulled(0.0, bar, SETTLE));
        assert!(found.contains(message), "{bar}: {found}");
    }
}

/// A block of 2 m × 0.8 m between two held pillars, 1 m from each, and a skin along their feet.
fn held_by_a_skin(strength: &str, stages: &str) -> String {
    format!(
        "title = \"skin\"\n[domain]\noutline = [[-3, 0], [-1, 0], [-1, 1], [-3, 1]]\n\
         islands = [[[0, 0], [2, 0], [2, 0.8], [0, 0.8]], [[3, 0], [5, 0], [5, 1], [3, 1]]]\n[mesh]\nsize = 0.5\n\
         [joint_law.joint]\nfriction_deg = 0.0\n[rock.rock]\ndensity = {DENSITY}\nyoung = 2e10\npoisson = 0.2\n\
         [[fix]]\nblock = [-2, 0.5]\n[[fix]]\nblock = [4, 0.5]\n[[skin]]\nname = \"mesh\"\n\
         line = [[-1, 0], [0, 0], [2, 0], [3, 0]]\nthickness = 0.1\nyoung = 1e7\ndistance = 10.0\n{strength}\n\
         {stages}"
    )
}

/// Two members that hang in a V: 2T·sin θ = W with T = EA(1/cos θ − 1), by bisection.
fn tension_of_a_v(weight: f64, axial: f64) -> f64 {
    let tension = |angle: f64| axial * (1.0 / angle.cos() - 1.0);
    let (mut low, mut high) = (0.0, 1.5);
    for _ in 0..100 {
        let half: f64 = 0.5 * (low + high);
        if 2.0 * tension(half) * half.sin() < weight { low = half } else { high = half }
    }
    tension(low)
}

/// A skin across a gap carries a loose block by its tension alone, as two bars in a V do, and breaks at its strength.
#[test]
fn a_skin_carries_a_block_over_a_gap_and_breaks_at_its_strength() {
    let exact = tension_of_a_v(WEIGHT, 1e6);
    let mut sim = simulation(&held_by_a_skin(&format!("tension = {:e}", 25.0 * exact), SETTLE));
    let report = run_stage(&mut sim);
    let found = forces(&sim);
    assert_eq!(found.len(), 3);
    assert!((found[0] / exact - 1.0).abs() < 0.01 && (found[2] / exact - 1.0).abs() < 0.01, "{found:?} {exact}");
    assert_ledger(&report);
    let strength = 0.8 * exact;
    let mut sim = simulation(&held_by_a_skin(&format!("tension = {:e}", 10.0 * strength), SETTLE));
    let mut most = 0.0f64;
    while !sim.state().bolts[0].broken {
        most = most.max(forces(&sim)[0]);
        advance(&mut sim, 1);
    }
    assert!((most / strength - 1.0).abs() < 0.01, "{most} of {strength}");
    assert_eq!(forces(&sim)[0], 0.0);
}

/// A stage installs all members of a skin by its name; members of one block are no mistake.
#[test]
fn a_stage_installs_a_skin_by_its_name() {
    let stage = "[[stage]]\nname = \"spray\"\nkind = \"dynamic\"\nduration = 1.0\ninstall = [\"mesh\"]\n";
    let sim = simulation(&held_by_a_skin("active = false", stage));
    let names: Vec<_> = sim.case().bolts.iter().filter_map(|bolt| bolt.name.clone()).collect();
    assert_eq!(names, ["mesh_1", "mesh_2", "mesh_3"]);
    assert!(sim.state().bolts.iter().all(|bar| bar.active), "{:?}", sim.state().bolts);
    assert!(sim.built().warnings.iter().all(|text| !text.contains("holds nothing")), "{:?}", sim.built().warnings);
}
