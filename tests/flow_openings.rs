//! Claims: apertures that follow openings settle with the rock, at the closed form of a joint between free columns, and
//! under a slope whatever the mesh; states in the middle of it are the same to the bit by any number of threads,
//! through bytes and after a return; who has no time or no answer is told.

use crate::common::extent::by_extent;
use crate::common::{example, refusal, run_stage, simulation, step};
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{FlowBalance, Rounds, Seepage, Simulation, State};

fn flowing(simulation: &Simulation) -> &Seepage {
    simulation.state().seepage.as_ref().expect("water that flows")
}

fn balance(simulation: &Simulation) -> &FlowBalance {
    flowing(simulation).balances.last().expect("a balance")
}

fn rounds(simulation: &Simulation) -> Rounds {
    balance(simulation).rounds.expect("rounds")
}

const ROCK: &str = "[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n";

/// Pressure (Pa) at the inlet, and aperture (m) without water under the load.
const PRESSURE: f64 = 1e5;
const APERTURE: f64 = 1e-4;

/// Columns that slide along each other without friction on a level joint, 10 m long, which a load keeps closed. A first
/// stage without water closes it to [`APERTURE`].
fn columns(count: usize, stiffness: f64, more: &str) -> String {
    let sides: String = (1..count)
        .map(|k| {
            let x = 10.0 * k as f64 / count as f64;
            format!("[[joint]]\npoints = [[{x}, 1], [{x}, 2]]\nlaw = \"side\"\n")
        })
        .collect();
    let load = 2e5 + 2600.0 * 9.81;
    let (aperture, level) = (APERTURE + load / stiffness, 1.0 + PRESSURE / 9810.0);
    format!(
        "title = \"columns\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 2], [0, 2]]\n[mesh]\nsize = 2.0\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 1], [10, 1]]\nlaw = \"joint\"\n{sides}{ROCK}\
         [joint_law.joint]\nfriction_deg = 30\nnormal_stiffness = {stiffness:e}\nshear_stiffness = {stiffness:e}\n\
         aperture = {aperture:e}\n[joint_law.side]\nfriction_deg = 0\naperture = 0\n[[fix]]\nedge = [[0, 0], [10, 0]]\n\
         [[fix]]\nedge = [[0, 1], [0, 2]]\naxes = \"x\"\n[[fix]]\nedge = [[10, 1], [10, 2]]\naxes = \"x\"\n[[load]]\n\
         kind = \"traction\"\nedge = [[0, 2], [10, 2]]\ntraction = [0, -2e5]\n[flow]\ncoupled = true\n\
         aperture_min = 2e-5\naperture_max = 4e-3\n{more}[[head]]\nname = \"inlet\"\nedge = [[0, 0], [0, 2]]\n\
         level = 0.0\n[[head]]\nname = \"outlet\"\nedge = [[10, 0], [10, 2]]\nlevel = 1.0\n[[stage]]\nname = \"dry\"\n\
         kind = \"static\"\nduration = 5.0\nconvergence = 1e-6\n[[stage]]\nname = \"wet\"\nkind = \"static\"\n\
         duration = 20.0\nconvergence = 1e-6\nheads = {{ inlet = {level:?} }}\n"
    )
}

/// With e = e0 + p/kn, q = -e³/12μ dp/dx makes e⁴ linear.
#[test]
fn a_joint_between_free_columns_has_the_flow_of_its_openings() {
    for (stiffness, exact, middle) in [(1e10, 9.66875e-7, 53_554.7), (1e9, 3.12500e-6, 70_747.6)] {
        let fourth = |p: f64| (APERTURE + p / stiffness).powi(4);
        let formula = stiffness * (fourth(PRESSURE) - fourth(0.0)) / (48.0 * 1e-3 * 10.0);
        assert!((formula / exact - 1.0_f64).abs() < 1e-5, "{formula}");
        let mut model = simulation(&columns(80, stiffness, ""));
        run_stage(&mut model);
        assert!(model.next_stage().expect("a stage"));
        run_stage(&mut model);
        let net = model.model().flow.as_ref().expect("a net");
        let away = |k: &usize| (net.places[*k].x - 5.0).hypot(net.places[*k].y - 1.0);
        let near = (0..net.places.len()).min_by(|a, b| away(a).total_cmp(&away(b))).expect("a node");
        let (q, p) = (balance(&model).sums[0][0], 9810.0 * flowing(&model).unknowns[near]);
        let rounds = rounds(&model);
        println!(
            "kn {stiffness:e}: q {q:.5e} ({:+.1e}), p {p:.1} ({:+.1e}), {rounds:?}, {} pieces, {:.3} s, {} steps",
            q / exact - 1.0,
            p / middle - 1.0,
            net.pieces.iter().filter(|piece| net.apertures[piece.law.index()] > 0.0).count(),
            model.time(),
            model.state().step
        );
        assert!((q / exact - 1.0).abs() <= 1e-3 && (p / middle - 1.0).abs() <= 1e-3, "{q} {p}");
        assert!(rounds.agree && rounds.count <= 20 && model.unsettled_apertures().is_none());
    }
}

/// The slope of `examples/flow/seepage_slide.toml` with an even plane that does not slide.
fn slide(size: f64, law: &str, flow: &str) -> String {
    let text = std::fs::read_to_string(crate::common::root().join("examples/flow/seepage_slide.toml")).expect("a case");
    text.replace("size = 2.0", &format!("size = {size:?}"))
        .replace("aperture = 0.5e-4\n", "")
        .replace("friction_deg = 35.0\ncohesion = 25e3", &format!("friction_deg = 45.0\ncohesion = 200e3{law}"))
        .replace("[flow]\naperture = 1e-4\n", &format!("[flow]\n{flow}"))
}

/// Force (N/m) of water on both parts of the plane.
fn uplift(model: &Simulation) -> f64 {
    let net = model.model().flow.as_ref().expect("a net");
    let of = |piece: &enmm::model::tables::FlowPiece| {
        let unknowns = piece.nodes.map(|node| flowing(model).unknowns[node as usize]);
        let heights = piece.nodes.map(|node| net.places[node as usize].y);
        let wet = enmm::model::tables::wet(unknowns, heights);
        wet.map_or(0.0, |wet| {
            0.5 * 9810.0 * (wet.heads[0] + wet.heads[1]) * (wet.span[1] - wet.span[0]).abs() * piece.length
        })
    };
    let on_plane = |piece: &&enmm::model::tables::FlowPiece| {
        let [a, b] = piece.nodes.map(|node| net.places[node as usize]);
        (a.x - b.x).abs() > 1e-6
    };
    net.pieces.iter().filter(on_plane).map(of).sum()
}

/// The answer does not depend on the mesh, whether closure is a property of the joint or that of the solver's springs,
/// which does not count.
#[test]
fn a_coupled_slope_does_not_depend_on_its_mesh() {
    let sizes: &[f64] = by_extent([&[2.0, 1.0], &[2.0, 1.0, 0.5], &[2.0, 1.0, 0.5]]);
    for (law, flow) in [
        ("", "aperture = 2e-4\ncoupled = true\n"),
        ("\nnormal_stiffness = 2e9\nshear_stiffness = 1e9", "aperture = 2e-4\naperture_min = 2e-5\ncoupled = true\n"),
    ] {
        let found: Vec<f64> = sizes
            .iter()
            .map(|&size| {
                let mut model = simulation(&slide(size, law, flow));
                let start = uplift(&model);
                run_stage(&mut model);
                let end = uplift(&model);
                println!(
                    "{law:?} size {size}: U {start:.5e} -> {end:.5e}, {:?}, {:.2} s",
                    rounds(&model),
                    model.time()
                );
                assert!(rounds(&model).agree, "{:?}", model.unsettled_apertures());
                end
            })
            .collect();
        assert!(found.iter().all(|u| (u / found[0] - 1.0).abs() <= 0.02), "{found:?}");
    }
}

/// Some steps into the rounds of a stage, through bytes there when `stopped`, and on.
fn run(threads: usize, stopped: bool) -> State {
    let text = columns(4, 1e9, "");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(&text);
        run_stage(&mut one);
        assert!(one.next_stage().expect("a stage"));
        while balance(&one).rounds.is_none_or(|rounds| rounds.count < 3) {
            let wanted = one.rest_due();
            one.advance(wanted).unwrap_or_else(|e| panic!("{e}"));
        }
        assert_eq!(flowing(&one).rounds.len(), 3);
        if stopped {
            let bytes = encode(Keeper::Model, one.state(), "hash").expect("bytes");
            let mut other = simulation(&text);
            let state: State = decode(Keeper::Model, &bytes, "hash").expect("a state");
            other.check(&state).expect("a state of this model");
            other.restore(state);
            one = other;
        }
        let middle = one.state().clone();
        run_stage(&mut one);
        let end = one.state().clone();
        one.return_to(&middle);
        run_stage(&mut one);
        assert!(*one.state() == end, "a return to the middle of the rounds");
        end
    })
}

#[test]
fn rounds_have_the_same_bits_by_threads_bytes_and_returns() {
    let one = run(1, false);
    let seepage = one.seepage.as_ref().expect("flow");
    assert!(seepage.rounds.is_empty() && seepage.balances[1].rounds.is_some_and(|rounds| rounds.agree));
    for (threads, stopped) in [(2, false), (8, false), (1, true)] {
        let other = run(threads, stopped);
        let bits = |state: &State| encode(Keeper::Model, state, "hash").expect("bytes");
        assert!(bits(&one) == bits(&other), "{threads} threads, stopped: {stopped}");
    }
}

#[test]
fn stages_without_time_or_answer_are_told_and_states_with_wrong_rounds_refused() {
    let mut model = simulation(&columns(4, 1e10, ""));
    step(&mut model, 5);
    let told = model.unsettled_apertures().expect("a doubt");
    assert!(told.contains("let the stage last longer"), "{told}");
    let mut state = model.state().clone();
    let seepage = state.seepage.as_mut().expect("flow");
    seepage.balances[0].rounds = Some(Rounds { count: 21, asked: 0.1, piece: 0, is_over: true, agree: false });
    assert!(model.check(&state).expect_err("refused").to_string().contains("seepage.balances.rounds.count"));
    state.seepage.as_mut().expect("flow").balances[0].rounds =
        Some(Rounds { count: 20, asked: 0.1, piece: 0, is_over: true, agree: false });
    model.check(&state).expect("a state of this model");
    model.restore(state);
    let told = model.unsettled_apertures().expect("a doubt");
    assert!(told.contains("do not agree after 20 rounds") && told.contains("10.5 %"), "{told}");
    let apart = columns(4, 1e10, "").replace("coupled = true", "coupled = false");
    let mut apart = simulation(&apart);
    run_stage(&mut apart);
    assert!(apart.unsettled_apertures().is_none() && balance(&apart).rounds.is_none());
    assert!(refusal(&columns(4, 1e10, "").replace("coupled = true", "coupled = 1")).contains("coupled"));
    assert!(!example("plane_slide").contains("[flow]"), "the case of other tests is dry");
}

/// Apertures (m) of the level joint now.
fn apertures(model: &Simulation) -> Vec<f64> {
    flowing(model).apertures.iter().flatten().copied().filter(|aperture| *aperture > 0.0).collect()
}

/// Barton, Bandis and Bakhtar: E = JRC/5·(0.2σc/JCS - 0.1) mm at the start, and e = E²/JRC^2.5 µm, at most E; the load
/// closes E by σ/kn.
#[test]
fn rough_joints_have_the_apertures_of_barton() {
    let load = 2e5 + 2600.0 * 9.81;
    for (jrc, key, start) in [
        (10.0_f64, "mechanical_aperture = 2.5e-4", 2.5e-4_f64),
        (10.0, "intact_strength = 120e6", 1e-3 * 2.0 * (0.2 * 1.2 - 0.1)),
        (4.0, "mechanical_aperture = 2e-4", 2e-4),
    ] {
        let hydraulic = |mechanical: f64| mechanical.min(1e-6 * (1e6 * mechanical).powi(2) / jrc.powf(2.5));
        let rough = format!("kind = \"barton_bandis\"\njrc = {jrc:?}\njcs = 100e6\n{key}\n");
        let text = columns(2, 1e10, "").replace("young = 1e10", "young = 1e12");
        let law = text.find("aperture = 1.2").expect("an aperture");
        let end = law + text[law..].find('\n').expect("a line") + 1;
        let text = format!("{}{rough}{}", &text[..law], &text[end..]);
        let mut model = simulation(&text);
        let near = |found: &[f64], exact: f64| {
            assert!(!found.is_empty() && found.iter().all(|e| (e / exact - 1.0).abs() < 2e-3), "{found:?} {exact:e}");
        };
        near(&apertures(&model), hydraulic(start));
        run_stage(&mut model);
        assert!(model.next_stage().expect("a stage"));
        near(&apertures(&model), hydraulic(start - load / 1e10));
        let flat = text.replace("kind = \"barton_bandis\"", "kind = \"mohr_coulomb\"").replace("jcs = 100e6\n", "");
        assert!(refusal(&flat).contains("a law of kind mohr_coulomb does not have it"));
        assert!(refusal(&text.replace(key, &format!("aperture = 1e-4\n{key}"))).contains("gives the aperture, and so"));
        let weak = refusal(&text.replace(key, "intact_strength = 40e6"));
        assert!(weak.contains("intact_strength: is 40000000 Pa, and gives a mechanical aperture of -"), "{weak}");
        let dry = &text[..text.find("[flow]").expect("flow")];
        let dry = format!("{dry}[[stage]]\nname = \"dry\"\nkind = \"static\"\nduration = 1.0\n");
        let dry = dry.replace("friction_deg = 0\naperture = 0", "friction_deg = 0");
        assert!(refusal(&dry).contains("has no effect without [flow]"), "{}", refusal(&dry));
    }
}
