//! An undamped elastic block keeps its energy: leapfrog drifts by less than 1e-6 in 2e4 steps. A million steps lose
//! neither energy nor memory nor bits.

use allocation_counter::measure;

use crate::common::extent::by_extent;
use crate::common::parts::{dynamic, rock};
use crate::common::simulation;
use enmm::geometry::Vector;
use enmm::internals::step::energies;
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{Simulation, State};

/// One irregular block that swings freely after a uniform stretch.
fn case(mesh: &str) -> String {
    format!(
        "title = \"swing\"\n[domain]\noutline = [[0.0, 0.0], [3.0, 0.2], [3.4, 1.6], [1.8, 1.2], [0.3, 1.9]]\n\
        [mesh]\n{mesh}\n\
         [gravity]\ny = 0.0\n{}{}",
        rock(1e9, 2500.0),
        dynamic("swing", 1e3, 0.0)
    )
}

/// ½v⁻·M·v⁺ + U: what leapfrog keeps exactly in a linear system. The product of two fields is a difference of squares.
fn kept(simulation: &mut Simulation) -> f64 {
    let before = simulation.state().clone();
    simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    let after = &simulation.state().velocity;
    let with = |f: &dyn Fn(&Vector, &Vector) -> Vector| {
        let mut state = before.clone();
        state.velocity = before.velocity.iter().zip(after).map(|(a, b)| f(a, b)).collect();
        energies(simulation.model(), &state, &simulation.workspace().mass_matrix)
    };
    let mean = with(&|a, b| (a + b) * 0.5);
    mean.kinetic - with(&|a, b| (b - a) * 0.5).kinetic + mean.strain
}

/// Strain of 1e-6 keeps the corotated block linear to 1e-6 of its energy, a difference that swings; the drift between
/// the means over 500 steps at both ends of 2e4 steps is what rounding leaves: 2e4·1e-16 and the rest of that swing.
#[test]
fn an_undamped_block_keeps_its_energy() {
    for mesh in ["size = 0.4", "size = 0.9\nangle_deg = 21.0\norigin = [0.2, 0.1]"] {
        let mut simulation = simulation(&case(mesh));
        let mut state = simulation.state().clone();
        let stars = &simulation.model().covers.star_position;
        state.displacement = stars.iter().map(|x| Vector::new(1e-6 * x.x + 4e-7 * x.y, -7e-7 * x.y)).collect();
        simulation.restore(state);
        // The first kick is half a step, from rest: the sum holds from the second on.
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let first = kept(&mut simulation);
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for _ in 0..20_000 {
            let report = simulation.advance(false);
            report.unwrap_or_else(|e| panic!("{e}"));
            largest = largest.max(simulation.state().velocity[0].norm());
        }
        for _ in 0..100 {
            worst = worst.max((kept(&mut simulation) / first - 1.0).abs());
        }
        println!("{mesh:?}: {first:e} J, drift {worst:e}");
        assert!(first > 0.0 && largest > 1e-5, "it must swing: {largest:e} m/s");
        assert!(worst < 1e-6, "drift {worst:e}");
    }
}

/// A block without friction in a bin, thrown so that it bounces on floor and walls, which are springs, for ever; at the
/// default step, which is 0.87 of the critical one.
fn bouncing() -> Simulation {
    simulation(&format!(
        "title = \"bin\"\n[domain]\n\
         outline = [[0, 0], [4, 0], [4, 3], [3.5, 3], [3.5, 0.5], [0.5, 0.5], [0.5, 3], [0, 3]]\n\
         islands = [[[1.5, 0.8], [2.5, 0.9], [2.4, 1.9], [1.4, 1.8]]]\n[mesh]\nsize = 1.1\norigin = [0.03, 0.02]\n\
         [joint_law.spring]\nfriction_deg = 0.0\nnormal_stiffness = 1e8\n[[fix]]\nblock = [0.2, 0.2]\n\
         [[initial_velocity]]\nblock = [2, 1.3]\nvelocity = [0.7, 0.0]\n{}{}",
        rock(1e10, 2500.0),
        dynamic("bounce", 1e9, 0.0)
    ))
}

/// A block that the friction of an incline holds.
fn resting() -> Simulation {
    let text = include_str!("../examples/cases/block_on_incline.toml").replace("duration = 1.0", "duration = 1e9");
    let mut simulation = simulation(&text.replace("friction_deg = 20.0", "friction_deg = 34.0"));
    crate::common::run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    simulation
}

/// Residual (J/m) of a step and its largest energy. The ledger takes the kinetic energy as the mean of those before and
/// after the kick; that is above what leapfrog keeps by ¼I·(v⁺ − v⁻) with the impulse I of stress and gravity (Eq. 28).
/// Without this share, which swings with the waves in the rock, the sum of all energies and works is constant in a
/// linear system, whatever contacts do.
fn residual(simulation: &mut Simulation) -> [f64; 2] {
    let before = simulation.state().clone();
    let report = simulation.advance(true).unwrap_or_else(|error| panic!("{error}"));
    let change: Vec<Vector> = simulation.state().velocity.iter().zip(&before.velocity).map(|(a, b)| a - b).collect();
    // So small a way that the difference of both energies is their slope, and so large that it is above rounding.
    let way = 1e-7 / change.iter().map(Vector::norm).fold(f64::MIN_POSITIVE, f64::max);
    let stored = |way: f64| {
        let displacement = before.displacement.iter().zip(&change).map(|(u, v)| u + v * way).collect();
        let moved = State { displacement, ..before.clone() };
        let energies = energies(simulation.model(), &moved, &simulation.workspace().mass_matrix);
        energies.strain + energies.potential
    };
    let impulse = -(stored(way) - stored(-way)) / (2.0 * way) * 0.5 * (before.dt_last + report.dt);
    [report.ledger.residual() - 0.25 * impulse, report.ledger.largest()]
}

/// Measures of a run of many steps.
#[derive(Debug, Default)]
struct Endured {
    /// Largest residual over the largest energy so far, in the first tenth of the steps and in all of them.
    residual: [f64; 2],
    /// Memory that came on after the first tenth (bytes).
    grown: i64,
    /// Whether the second half from a checkpoint in another model gives the same bits.
    same_bits: bool,
}

/// Takes `steps`, and the second half of them once more from a checkpoint.
fn endure(make: fn() -> Simulation, steps: u64) -> Endured {
    let advance = |simulation: &mut Simulation, report: bool| {
        simulation.advance(report).unwrap_or_else(|error| panic!("{error}"));
    };
    let mut simulation = make();
    // All memory is then of this thread, which counts what it takes; other tests have threads of their own.
    simulation.set_serial(true);
    let (mut endured, mut largest) = (Endured::default(), 0.0f64);
    let mut take = |simulation: &mut Simulation, steps: std::ops::Range<u64>| {
        let mut worst = 0.0f64;
        for k in steps {
            if k % 100 == 99 {
                let [residual, energy] = residual(simulation);
                largest = largest.max(energy);
                worst = worst.max(residual.abs() / largest);
            } else {
                advance(simulation, false);
            }
        }
        worst
    };
    endured.residual[0] = take(&mut simulation, 0..steps / 10);
    let mut worst = endured.residual[0];
    let mut watched = |simulation: &mut Simulation, steps: std::ops::Range<u64>| {
        measure(|| worst = worst.max(take(simulation, steps))).bytes_current
    };
    let first = watched(&mut simulation, steps / 10..steps / 2);
    let half = encode(Keeper::Model, simulation.state(), "long").expect("bytes");
    endured.grown = first + watched(&mut simulation, steps / 2..steps);
    endured.residual[1] = worst;
    let mut other = make();
    other.restore(decode(Keeper::Model, &half, "long").expect("a state"));
    for k in steps / 2..steps {
        advance(&mut other, k % 100 == 99);
    }
    // A restored model searches again at once: the one thing that it counts and an uninterrupted one does not.
    let bits = |simulation: &Simulation| {
        let mut state: State = simulation.state().clone();
        state.counters.searches = 0;
        encode(Keeper::Model, &state, "long").expect("bytes")
    };
    endured.same_bits = bits(&simulation) == bits(&other);
    endured
}

/// A million steps each with `ENMM_LONG=1`, a hundredth of them otherwise. What is left of the residual, 2.2e-4, comes
/// from the stress of turning rock, which is not linear, and falls with the step.
#[test]
fn long_a_million_steps_lose_neither_energy_nor_memory_nor_bits() {
    let steps = by_extent([1_000, 10_000, 1_000_000]);
    for (name, make) in [("bounces", bouncing as fn() -> Simulation), ("rests", resting)] {
        let clock = std::time::Instant::now();
        let endured = endure(make, steps);
        println!("{name}, {steps} steps in {:.1} s: {endured:?}", clock.elapsed().as_secs_f64());
        assert!(endured.residual[1] < 5e-4, "{name}: {endured:?}");
        assert!(endured.grown < 1_000_000, "{name}: {endured:?}");
        assert!(endured.same_bits, "{name}");
    }
}
