//! Claim: a stage cuts the rock along a line that was not drawn before, and the model goes on as if nothing else had
//! happened.

use enmm::model::Simulation;
use enmm::model::bytes::{Keeper, decode, encode};

use crate::common::random::Random;
use crate::common::{case, refusal, run_all, run_stage, simulation, step};

const ROCK: &str = "[rock.rock]\ndensity = 2600\nyoung = 30e6\npoisson = 0.25\n";

/// A plate of 4 m by 2 m that flies and spins free, and is cut along a line while it does; none where the line ends
/// before it has cut an element.
fn plate(size: f64, angle: f64, [a, b]: [[f64; 2]; 2]) -> Option<Simulation> {
    let case = case(&format!(
        "title = \"plate\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 2], [0, 2]]\n[gravity]\ny = 0\n[mesh]\n\
         size = {size}\nangle_deg = {angle}\norigin = [0.0137, 0.0071]\nleast_block = 0\n{ROCK}\
         [joint_law.joint]\nfriction_deg = 30\n[[initial_velocity]]\nvelocity = [3, -2]\nangular_velocity = 5\n\
         [[stage]]\nname = \"flight\"\nkind = \"dynamic\"\nduration = 0.1\ndamping = 0\n[[stage]]\nname = \"cut\"\n\
         kind = \"dynamic\"\nduration = 0.1\ndamping = 0\ncut = [{{ points = [{a:?}, {b:?}], law = \"joint\" }}]\n"
    ));
    let built = Simulation::new(case);
    assert!(built.as_ref().err().is_none_or(|error| error.message.contains("cuts no rock")), "{built:?}");
    built.ok()
}

/// Mass, momentum, angular momentum and kinetic energy.
fn sums(simulation: &Simulation) -> [f64; 5] {
    let (momentum, angular) = simulation.momentum();
    let mass = simulation.workspace().mass_matrix.total.iter().sum();
    [mass, momentum.x, momentum.y, angular, simulation.energies().kinetic]
}

/// What a random cut of the plate changes of its sums, relative to them, and the number of its parts.
fn changes(random: &mut Random, size: f64, is_whole: bool) -> ([f64; 5], usize) {
    // Half of them lead from one long side to the other.
    let mut point = |y: f64, height: f64| [-0.2 + 4.4 * random.unit(), y + height * random.unit()];
    let mut flying = loop {
        let ends = if is_whole { [point(-0.2, 0.1), point(2.1, 0.1)] } else { [point(-0.2, 2.4), point(-0.2, 2.4)] };
        let length = (ends[0][0] - ends[1][0]).hypot(ends[0][1] - ends[1][1]);
        if let Some(plate) = plate(size, 60.0 * ends[0][0], ends).filter(|_| length > 1.5) {
            break plate;
        }
    };
    step(&mut flying, 7);
    let before = sums(&flying);
    assert!(flying.next_stage().unwrap_or_else(|e| panic!("{e}")));
    let after = sums(&flying);
    let parts = flying.model().covers.block_count();
    step(&mut flying, 1);
    ([0, 1, 2, 3, 4].map(|k| after[k] / before[k] - 1.0), parts)
}

/// Sums of partial cuts stay to round-off. A plate that falls in two keeps its momentum, and its angular momentum by a
/// spin of both parts, which takes kinetic energy.
#[test]
fn random_cuts_keep_mass_and_momentum_and_never_add_energy() {
    let count = if std::env::var("ENMM_FULL").is_ok() { 1000 } else { 250 };
    let mut random = Random::new(17);
    let (mut split, mut worst, mut loss) = (0, [0.0_f64; 5], 0.0_f64);
    for k in 0..count {
        let (changes, parts) = changes(&mut random, 0.5, k % 2 == 0);
        println!("{k}: {parts} parts, {changes:?}");
        let limits = if parts == 1 { [1e-13; 5] } else { [1e-12, 1e-12, 1e-12, 1e-12, 1e-13] };
        for j in 0..5 {
            let change = if j == 4 && parts > 1 { changes[j].max(0.0) } else { changes[j].abs() };
            assert!(change <= limits[j], "cut {k} into {parts}: sum {j} by {change:e}");
            worst[j] = worst[j].max(change);
        }
        if parts > 1 {
            (split, loss) = (split + 1, loss.max(-changes[4]));
        }
    }
    println!("{split} of {count} fall in two; worst {worst:?}; loss {loss:e}");
    assert!(split > count / 10 && split < count);
}

/// Two blocks of soft rock on a base, on seams that hold, so that rest does not depend on the way there; a stage may
/// cut and dig.
fn blocks(joints: &str, stage: &str) -> Simulation {
    simulation(&format!(
        "title = \"blocks\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 8], [0, 8]]\n[mesh]\nsize = 0.8\n\
         origin = [0.0137, 0.0071]\n{ROCK}[joint_law.joint]\nfriction_deg = 35\n[joint_law.seam]\n\
         friction_deg = 35\ncohesion = 1e8\ntension = 1e8\nnormal_stiffness = 1e9\nshear_stiffness = 1e9\n\
         [joint_law.bond]\nfriction_deg = 45\ncohesion = 1e9\ntension = 1e9\n\
         normal_stiffness = 1e11\nshear_stiffness = 1e11\n[[fix]]\nedge = [[0, 0], [10, 0]]\n[[joint]]\n\
         points = [[3.3, 0.5], [3.3, 9]]\nlaw = \"seam\"\n[[joint]]\npoints = [[-1, 0.5], [11, 0.5]]\n\
         law = \"seam\"\n{joints}[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\n\
         convergence = 1e-6\n{stage}"
    ))
}

fn stage(name: &str, more: &str) -> String {
    format!("[[stage]]\nname = \"{name}\"\nkind = \"static\"\nduration = 20\nconvergence = 1e-6\n{more}\n")
}

/// Greatest displacement of the elements of one simulation that are still there, and greatest difference to another.
fn difference(one: &Simulation, other: &Simulation) -> [f64; 2] {
    let covers = &one.model().covers;
    assert_eq!(covers.element_centroid, other.model().covers.element_centroid);
    let there = covers.elements().filter(|&e| !one.state().removed[covers.element_block[e]]);
    let moved = |of: &Simulation, e| of.model().sample(e, covers.element_centroid[e], &of.state().displacement);
    let both = there.map(|e| [moved(one, e), moved(other, e)]).map(|[a, b]| [a.norm(), (a - b).norm()]);
    both.fold([0.0; 2], |most, now| [0, 1].map(|k| f64::max(most[k], now[k])))
}

/// Rock of which a stage digs away a part along a line that it cuts itself comes to rest where the same rock does with
/// that line drawn from the start.
#[test]
fn a_cut_and_an_excavation_end_where_the_drawn_joint_does() {
    let line = "points = [[5.1, 9], [5.1, 4.1], [11, 4.1]]";
    let digs = "excavate = [[8, 6]]";
    let mut cut = blocks("", &stage("dig", &format!("{digs}\ncut = [{{ {line}, law = \"joint\" }}]")));
    let mut drawn = blocks(&format!("[[joint]]\n{line}\nlaw = \"joint\"\n"), &stage("dig", digs));
    run_all(&mut cut);
    run_all(&mut drawn);
    assert_eq!(cut.model().labels.len(), 4);
    let [most, apart] = difference(&cut, &drawn);
    println!("moved {most:e} m, apart {apart:e} m");
    assert!(apart < 1e-6 * 10.0 && apart < 1e-3 * most, "{apart} of {most}");
}

/// A cut whose bond holds changes next to nothing, and the rock rests as with the line drawn from the start. The line
/// ends on faces of the outline and, as a crack, in the rock.
#[test]
fn a_cut_whose_bond_holds_leaves_the_rock_at_rest() {
    for line in ["points = [[4, 9], [11, 3]]", "points = [[4, 9], [7, 3]]", "points = [[2, 9], [9, 2.5]]"] {
        let dynamic = format!(
            "[[stage]]\nname = \"cut\"\nkind = \"dynamic\"\nduration = 0.05\n\
             cut = [{{ {line}, law = \"bond\" }}]\n"
        );
        let mut cut = blocks("", &(dynamic + &stage("rest again", "")));
        let mut drawn = blocks(&format!("[[joint]]\n{line}\nlaw = \"bond\"\n"), "");
        run_stage(&mut drawn);
        run_stage(&mut cut);
        cut.next_stage().unwrap_or_else(|e| panic!("{e}"));
        let mut most = 0.0_f64;
        while cut.state().stage_step < 200 {
            let ledger = cut.advance(true).unwrap_or_else(|e| panic!("{e}")).ledger;
            most = most.max(ledger.kinetic / ledger.strain);
        }
        run_all(&mut cut);
        let [moved, apart] = difference(&cut, &drawn);
        println!("{line}: kinetic {most:e} of strain; apart {apart:e} of {moved:e} m");
        assert!(most < 2e-2, "{most}");
        assert!(apart < 1e-3 * moved, "{apart} of {moved}");
    }
}

/// Text of a slope whose upper half slips on a joint and is held by a rock bridge and a bolt, on rock that yields; what
/// follows is its second stage.
fn held_slope(stage: &str) -> String {
    format!(
        "title = \"slope\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 8], [0, 8]]\n[mesh]\nsize = 0.8\n\
         origin = [0.0137, 0.0071]\n{ROCK}cohesion = 50e3\nfriction_deg = 30\n[joint_law.joint]\nfriction_deg = 12\n\
         [joint_law.bond]\nfriction_deg = 45\ncohesion = 1e9\ntension = 1e9\n[joint_law.bridge]\nfriction_deg = 40\n\
         cohesion = 1e6\ntension = 1e6\nbreaks = \"by section\"\n[[joint]]\npoints = [[-1, 6.2], [4, 4.7]]\n\
         law = \"joint\"\n[[bridge]]\npoints = [[4, 4.7], [7, 3.8]]\nlaw = \"bridge\"\n[[joint]]\n\
         points = [[7, 3.8], [11, 2.6]]\nlaw = \"joint\"\n[[bolt]]\nname = \"anchor\"\npoints = [[9.5, 5.5], [1, 5]]\n\
         young = 200e9\narea = 5e-4\nanchorage = \"grouted\"\npretension = 20e3\n[[fix]]\nedge = [[0, 0], [10, 0]]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\nconvergence = 1e-5\n[[stage]]\n\
         name = \"cut\"\n{stage}"
    )
}

/// A cut whose bond holds, across the joint beside the bridge, changes nothing of what slips, bonds, pulls and has
/// yielded beside it. A bar that it crosses can be stretched there from then on.
#[test]
fn a_cut_leaves_joints_bridges_bolts_and_yielded_rock_as_they_are() {
    let cut = "kind = \"dynamic\"\nduration = 0.05\ncut = [{ points = [[7.6, 9], [8.4, 2]], law = \"bond\" }]\n";
    let mut slope = simulation(&held_slope(cut));
    run_stage(&mut slope);
    let yielded = |of: &Simulation| -> f64 {
        let covers = &of.model().covers;
        covers.elements().map(|e| of.model().plastic_strain(of.state(), e) * covers.element_area[e]).sum()
    };
    let pulls = |of: &Simulation| of.state().bolts.iter().map(|bolt| bolt.force).collect::<Vec<f64>>();
    let slips = |of: &Simulation| of.state().contacts.iter().filter(|contact| contact.slip.abs() > 1e-6).count();
    let (strain, strained, bars, slipped) = (slope.energies().strain, yielded(&slope), pulls(&slope), slips(&slope));
    assert!(strained > 0.0 && bars.len() == 1 && bars[0] > 1e3 && slipped > 0, "{strained} {bars:?} {slipped}");
    assert!(slope.next_stage().unwrap_or_else(|e| panic!("{e}")));
    // Means over patches of rock that yields end at a cut, which changes its energy by as much as they differ.
    assert!((slope.energies().strain / strain - 1.0).abs() < 1e-3, "{} of {strain}", slope.energies().strain);
    assert!((yielded(&slope) / strained - 1.0).abs() < 1e-9, "{} of {strained}", yielded(&slope));
    let now = pulls(&slope);
    assert!(now.len() == 2 && now.iter().sum::<f64>() == bars[0] && now.contains(&0.0), "{now:?} of {bars:?}");
    assert!(slips(&slope) >= slipped);
    step(&mut slope, 100);
    let energies = slope.energies();
    assert!(energies.kinetic < 1e-4 * energies.strain, "{energies:?}");
    assert_eq!(slope.state().sections, [None]);
}

/// Cuts that no run can make are refused with their key and a remedy.
#[test]
fn cuts_that_cannot_be_made_are_refused() {
    let cut = |kind: &str, points: &str| {
        held_slope(&format!("kind = \"{kind}\"\nduration = 0.1\ncut = [{{ points = {points}, law = \"joint\" }}]\n"))
    };
    let refused = |text: &str, key: &str, words: &str| {
        let message = refusal(text);
        assert!(message.contains(key) && message.contains(words), "{message}");
    };
    let across = cut("static", "[[7.6, 9], [8.4, 2]]");
    refused(&cut("static", "[[12, 0], [12, 8]]"), "stage[1].cut[0]", "cuts no rock");
    refused(&cut("static", "[[9.99, 9], [9.99, 7.9], [11, 7.9]]"), "stage[1].cut", "less than mesh.least_block");
    refused(&cut("static", "[[5, 9], [5, -1]]"), "stage[1].cut", "meets a fixed or quiet edge");
    refused(&across.replace("law = \"joint\" }", "law = \"none\" }"), "stage[1].cut[0].law", "none");
    let elastic = across.replace("breaks = \"by section\"\n", "").replace("cohesion = 50e3\nfriction_deg = 30\n", "");
    refused(&format!("{elastic}[solver]\nintegrator = \"implicit\"\n"), "stage[1].cut[0]", "solver.integrator");
}

/// The build warns of later cuts before the run, as of all else.
#[test]
fn warnings_about_cuts_of_later_stages_stand_at_the_start() {
    let cut = "kind = \"static\"\nduration = 0.1\ncut = [{ points = [[7.6, 9], [8.4, 2]], law = \"weak\" }]\n";
    let law = "[joint_law.weak]\nfriction_deg = 30\ntension = 1e6\ntension_energy = 1e-3\n";
    let slope = simulation(&(held_slope(cut) + law));
    let warnings = &slope.built().warnings;
    let is_told = |text: &String| text.contains("on: joint_law.weak.tension_energy: snap-back");
    assert_eq!(warnings.iter().filter(|text| is_told(text)).count(), 1, "{warnings:?}");
}

/// A run with a cut has the same bits on other threads, when it goes back to a state before the cut, and when it takes
/// up a state after the cut in another process.
#[test]
fn a_cut_has_the_same_bits_by_threads_rollback_and_bytes() {
    let build = || {
        let cut = "cut = [{ points = [[2, 9], [9, 2.5]], law = \"joint\" }]";
        blocks("", &stage("cut", cut).replace("static", "dynamic").replace("convergence = 1e-6\n", ""))
    };
    let bytes = |simulation: &Simulation| {
        let mut state = simulation.state().clone();
        state.counters.searches = 0;
        encode(Keeper::Model, &state, "").expect("bytes")
    };
    let on = |mut simulation: Simulation| {
        if simulation.state().stage == 0 {
            assert!(simulation.next_stage().unwrap_or_else(|e| panic!("{e}")));
        }
        let after = simulation.state().clone();
        step(&mut simulation, 60);
        (after, simulation)
    };
    let mut one = build();
    step(&mut one, 300);
    let before = one.state().clone();
    let (after, mut one) = on(one);
    let end = bytes(&one);
    one.return_to(&before);
    assert_eq!(one.model().covers.block_count(), 3);
    let (_, one) = on(one);
    assert!(bytes(&one) == end, "back to before the cut");
    let saved = encode(Keeper::Model, &after, "hash").expect("bytes");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool");
    let other = pool.install(|| {
        let mut other = build();
        let state = decode(Keeper::Model, &saved, "hash").expect("a state");
        other.check(&state).unwrap_or_else(|e| panic!("{e}"));
        other.restore(state);
        bytes(&on(other).1)
    });
    assert!(other == end, "from bytes, on other threads");
}
