//! Claims: joints take the rain that they can and the rest runs off, water stands under rain as Dupuit has it, and
//! balances are the same to the bit by any number of threads and through bytes.

use crate::common::{refusal, run_stage, simulation, step};
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{FlowBalance, Simulation, State};

/// Transmissivity (m²/s) of joints of 0.1 mm: γe³/12μ.
const T: f64 = 1000.0 * 9.81 * 1e-12 / (12.0 * 1e-3);

/// Water that enters, leaves and runs off (m²/s) at each head, in rain, from the reservoir and from the air.
fn sums(simulation: &Simulation) -> &[[f64; 3]] {
    &balance(simulation).sums
}

fn balance(simulation: &Simulation) -> &FlowBalance {
    simulation.state().seepage.as_ref().and_then(|seepage| seepage.balances.last()).expect("a balance")
}

/// Checks flows to a share of 1e-12 of the transmissivity.
fn assert_sums(simulation: &Simulation, exact: &[[f64; 3]]) {
    let found = sums(simulation);
    let off = found.as_flattened().iter().zip(exact.as_flattened()).map(|(found, exact)| (found - exact).abs());
    assert!(found.len() == exact.len() && off.fold(0.0, f64::max) <= 1e-12 * T, "{found:?} instead of {exact:?}");
}

/// A plate, 10 m by 8 m, with rain on its top, a joint down to its free base and what else.
fn plate(rate: f64, more: &str, stages: &str) -> String {
    format!(
        "title = \"plate\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 8], [0, 8]]\n[mesh]\nsize = 0.9\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[3, 0], [3, 8]]\n[rock.rock]\ndensity = 2600\nyoung = 1e10\n\
         poisson = 0.25\n[joint_law.joint]\nfriction_deg = 40\n[[fix]]\nedge = [[0, 0], [0, 8]]\n[[fix]]\n\
         edge = [[10, 0], [10, 8]]\n[flow]\naperture = 1e-4\naperture_min = 1e-4\naperture_max = 1e-4\n[[rain]]\n\
         name = \"sky\"\nedge = [[0, 8], [10, 8]]\nrate = {rate:e}\n{more}[[stage]]\nname = \"rest\"\n\
         kind = \"static\"\nduration = 0.3\n{stages}"
    )
}

#[test]
fn a_joint_takes_rain_up_to_its_capacity_and_the_rest_runs_off() {
    for share in [0.3, 1.0, 2.5] {
        let model = simulation(&plate(share * T / 10.0, "", ""));
        let enters = T * f64::min(share, 1.0);
        assert_sums(&model, &[[enters, 0.0, share * T - enters], [0.0; 3], [0.0, enters, 0.0]]);
    }
}

/// Three outcrops at 3, 5 and 8 m, of which the edge from 0 to 10 m gives 4, 2.5 and 3.5 m; stages change the rate.
#[test]
fn outcrops_share_the_ground_between_them_and_stages_change_the_rain() {
    let more = "[[joint]]\npoints = [[5, 0], [5, 8]]\n[[joint]]\npoints = [[8, 0], [8, 8]]\n";
    let stages = "[[stage]]\nname = \"storm\"\nkind = \"static\"\nduration = 0.3\nrain = { sky = 4.0e-7 }\n\
                  [[stage]]\nname = \"sun\"\nkind = \"static\"\nduration = 0.3\nrain = { sky = 0.0 }\n";
    let mut model = simulation(&plate(0.1 * T, more, stages));
    // All of it enters: 0.4, 0.25 and 0.35 of the capacity of a joint.
    assert_sums(&model, &[[T, 0.0, 0.0], [0.0; 3], [0.0, T, 0.0]]);
    run_stage(&mut model);
    assert!(model.next_stage().expect("a stage"));
    let enters: f64 = [4.0, 2.5, 3.5].iter().map(|width| f64::min(4e-7 * width, T)).sum();
    assert_sums(&model, &[[enters, 0.0, 4e-6 - enters], [0.0; 3], [0.0, enters, 0.0]]);
    run_stage(&mut model);
    assert!(model.next_stage().expect("a stage"));
    assert_sums(&model, &[[0.0; 3]; 3]);
}

/// An aquifer of joints 1 m apart, 20 m long, beside 4 m of water: h² = H² + wL²/K.
#[test]
fn a_mound_under_rain_is_that_of_dupuit() {
    let level = |y: f64| format!("[[joint]]\npoints = [[0, {y:?}], [20, {y:?}]]\n");
    let upright = |x: f64| format!("[[joint]]\npoints = [[{x:?}, 0], [{x:?}, 8]]\n");
    let joints: String = (0..8).map(|k| level(f64::from(k) + 0.5)).collect();
    let joints: String = joints + &(0..20).map(|k| upright(f64::from(k) + 0.5)).collect::<String>();
    let rate = T * (36.0 - 16.0) / 400.0;
    let text = format!(
        "title = \"mound\"\n[domain]\noutline = [[0, 0], [20, 0], [20, 8], [0, 8]]\n[mesh]\nsize = 0.9\n\
         origin = [0.131, 0.077]\n{joints}[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 40\n[[fix]]\nedge = [[0, 0], [20, 0]]\n[[fix]]\nedge = [[0, 0], [0, 8]]\n\
         axes = \"x\"\n[flow]\naperture = 1e-4\n[[head]]\nname = \"river\"\nedge = [[20, 0], [20, 8]]\nlevel = 4.0\n\
         [[rain]]\nname = \"sky\"\nedge = [[0, 8], [20, 8]]\nrate = {rate:e}\n[[stage]]\nname = \"wet\"\n\
         kind = \"static\"\nduration = 0.3\n"
    );
    let model = simulation(&text);
    let (net, state) = (model.model().flow.as_ref().expect("a net"), model.state());
    let unknowns = &state.seepage.as_ref().expect("water").unknowns;
    let at = |x: f64| {
        let foot = net.places.iter().position(|place| (place.x - x).hypot(place.y - 0.5) < 1e-6).expect("a node");
        unknowns[foot] + 0.5
    };
    let [far, middle] = [0.5, 9.5].map(at);
    let exact = |x: f64| (36.0 - rate * x * x / T).sqrt();
    println!("{far:.4} of {:.4} m, {middle:.4} of {:.4} m", exact(0.5), exact(9.5));
    assert!((far / exact(0.5) - 1.0).abs() < 0.02 && (middle / exact(9.5) - 1.0).abs() < 0.02, "{far} {middle}");
    let [river, rain, reservoir, air] = sums(&model) else { panic!("{:?}", sums(&model)) };
    assert!((rain[0] / (20.0 * rate) - 1.0).abs() < 1e-12 && rain[2] <= 1e-12 * rain[0], "all enters: {rain:?}");
    let leaves = river[1] + rain[1] + air[1] - river[0] - reservoir[0];
    assert!((leaves / rain[0] - 1.0).abs() < 1e-11, "{leaves} of {}", rain[0]);
}

/// A stage in rain, another and a third with more, through bytes in the middle when `stopped`.
fn run(threads: usize, stopped: bool) -> State {
    let more = "[[joint]]\npoints = [[0, 3], [10, 5]]\n[[joint]]\npoints = [[6, 0], [8, 8]]\n";
    let text = plate(
        0.2 * T,
        more,
        "[[stage]]\nname = \"storm\"\nkind = \"static\"\nduration = 0.3\n\
                                     rain = { sky = 1e-6 }\n",
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(&text);
        step(&mut one, 30);
        let before = one.state().clone();
        if stopped {
            let bytes = encode(Keeper::Model, one.state(), "hash").expect("bytes");
            one = simulation(&text);
            let state: State = decode(Keeper::Model, &bytes, "hash").expect("a state");
            one.check(&state).expect("a state of this model");
            one.restore(state);
        }
        assert!(one.next_stage().expect("a stage"));
        step(&mut one, 30);
        let state = one.state().clone();
        one.restore(before);
        assert!(one.next_stage().expect("a stage"));
        step(&mut one, 30);
        assert!(*one.state() == state, "a rollback over the start of a stage");
        state
    })
}

#[test]
fn threads_and_bytes_change_no_bit_of_rain() {
    let one = run(1, false);
    let FlowBalance { sums, .. } = one.seepage.as_ref().and_then(|flow| flow.balances.last()).expect("a balance");
    assert!(sums[0][0] > 0.0 && sums[0][2] > 0.0, "{sums:?}");
    assert!((sums[0][0] + sums[0][2] - 1e-5).abs() < 1e-17, "rain enters or runs off: {sums:?}");
    for (threads, stopped) in [(2, false), (8, false), (1, true)] {
        let other = run(threads, stopped);
        let bits = |state: &State| encode(Keeper::Model, state, "hash").expect("bytes");
        assert!(bits(&one) == bits(&other), "{threads} threads, stopped: {stopped}");
    }
}

#[test]
fn rain_that_cannot_fall_is_told() {
    let text = plate(1e-7, "", "");
    let second = "[[rain]]\nname = \"cloud\"\nedge = [[2, 8], [4, 8]]\nrate = 1e-7\n";
    for (text, key, message) in [
        (text.replace("[[0, 8], [10, 8]]\nrate", "[[4, 8], [10, 8]]\nrate"), "rain[0].edge", "no joint crops out"),
        (text.replace("[[0, 8], [10, 8]]\nrate", "[[0, 8], [0, 0]]\nrate"), "rain[0].edge", "is vertical"),
        (plate(-1e-7, "", ""), "rain[0].rate", "must be at least 0"),
        (plate(10.0, "", ""), "rain[0].rate", "10 mm in an hour are 2.8e-6 m/s"),
        (plate(1e-7, second, ""), "rain[1].edge", "on which rain \"sky\" falls too"),
        (plate(1e-7, &second.replace("cloud", "sky"), ""), "rain[1].name", "sky"),
        (text.replace("\"sky\"", "\"air\""), "rain[0].name", "rename the rain"),
        (text.replace("[flow]\naperture = 1e-4\naperture_min = 1e-4\naperture_max = 1e-4\n", ""), "rain[0]", "[flow]"),
    ] {
        let told = refusal(&text);
        assert!(told.contains(&format!("{key}: ")) && told.contains(message), "{text}\n{told}");
    }
    let stage = |kind: &str, name: &str, rate: f64| {
        let stage =
            format!("[[stage]]\nname = \"next\"\nkind = \"{kind}\"\nduration = 1.0\nrain = {{ {name} = {rate:?} }}\n");
        refusal(&plate(1e-7, "", &stage))
    };
    assert!(stage("static", "ski", 1e-7).contains("no rain is named \"ski\", did you mean \"sky\"?"));
    assert!(stage("static", "sky", -1.0).contains("stage[1].rain: is -1 m/s, must be at least 0"));
    assert!(stage("dynamic", "sky", 1e-7).contains("give it in a static stage"));
    assert!(simulation(&plate(0.0, "", "")).built().warnings.join("\n").contains("no [[rain]] falls"));
}
