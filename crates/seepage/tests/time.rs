//! Steps in time: a falling head, a column that drains, a drawdown that ends in the steady flow; water is kept.

use crate::parts::{Joints, Random, capacity, grid, held, line};
use enmm_seepage::{Condition, DELTA, Flow, Net, Storage, law};

/// Steps in time, with what they need.
struct Clock {
    net: Net,
    conductance: Vec<f64>,
    volume: Vec<f64>,
    compliance: Vec<f64>,
    conditions: Vec<Condition>,
    u: Vec<f64>,
}

impl Clock {
    fn new(joints: &Joints, u: Vec<f64>) -> Self {
        let lengths = joints.lengths();
        let volume = lengths.iter().zip(&joints.apertures).map(|(&length, e)| law::volume(e[0], e[1], length, 0.0));
        let (volume, compliance) = (volume.collect(), vec![0.0; lengths.len()]);
        let (net, conductance) = (joints.net(), joints.conductance());
        Self { net, conductance, volume, compliance, conditions: joints.conditions.clone(), u }
    }

    fn stored(&self) -> f64 {
        let storage = Storage { volume: &self.volume, compliance: &self.compliance };
        self.net.stored(storage, &self.u).unwrap().iter().sum()
    }

    /// Goes on by a step, and checks that the water in the net is what has entered more.
    fn step(&mut self, time: f64) -> Flow {
        let before = self.stored();
        let storage = Storage { volume: &self.volume, compliance: &self.compliance };
        let flow = self.net.advance(&self.conductance, &self.conditions, storage, &self.u, time).unwrap();
        self.u.clone_from(&flow.u);
        let entered = flow.inflow.iter().sum::<f64>() * time;
        let balance = self.stored() - before - entered;
        assert!(balance.abs() <= 1e-9 * before.max(flow.through_flow * time), "{balance:e} of {before:e}");
        flow
    }
}

#[test]
fn the_head_in_a_crack_falls_as_steps_let_it() {
    // An open crack, 5 mm wide and 20 m high, which a joint drains at its foot.
    let (crack, aperture, length, pieces) = (5e-3, 1e-4, 10.0, 40_usize);
    let mut joints = line(pieces, [0.0, 0.0], [0.0, 20.0], [crack; 2]);
    joints.places.push([length, 0.0]);
    joints.pipes.push([0, pieces as u32 + 1]);
    joints.apertures.push([aperture; 2]);
    joints.conditions.push(held(0.0));
    let u = joints.places.iter().map(|place| if place[1] < 16.0 { 16.0 - place[1] } else { -DELTA });
    let mut u: Vec<f64> = u.collect();
    u[pieces + 1] = 0.0;
    let tau = crack * length / capacity(aperture);
    for steps in [20, 80] {
        let mut clock = Clock::new(&joints, u.clone());
        (0..steps).for_each(|_| _ = clock.step(tau / f64::from(steps)));
        let exact = (1.0 + 1.0 / f64::from(steps)).powi(-steps);
        assert!((clock.u[0] / 16.0 - exact).abs() < 1e-4, "{} {exact}", clock.u[0] / 16.0);
    }
}

#[test]
fn half_of_a_column_with_an_open_foot_drains_in_half_its_time() {
    for pieces in [20, 80] {
        let mut joints = line(pieces, [0.0, 10.0], [0.0, 0.0], [1e-4; 2]);
        joints.conditions[pieces] = Condition::Air;
        let u = joints.places.iter().map(|place| (10.0 - place[1]).max(0.0)).collect();
        let mut clock = Clock::new(&joints, u);
        let speed = capacity(1e-4) / 1e-4;
        let mut outflow = 0.0;
        for step in 0..2 * pieces {
            let flow = clock.step(5.0 / speed / (2 * pieces) as f64);
            if step == pieces {
                outflow = -flow.inflow[pieces];
            }
        }
        assert!((clock.stored() / 1e-3 - 0.5).abs() < 1e-3, "{}", clock.stored());
        assert!((outflow / capacity(1e-4) - 1.0).abs() < 1e-4, "{outflow:e}");
    }
}

#[test]
fn a_drawdown_of_a_random_net_ends_in_the_steady_flow() {
    for seed in 0..3 {
        let (mut joints, [columns, rows]) = grid([20.0, 12.0], 1.0, 1e-4);
        let mut random = Random::new(seed);
        joints.apertures.iter_mut().for_each(|e| *e = [1e-4 * (0.7 * random.normal()).exp(); 2]);
        (0..rows).for_each(|row| joints.conditions[row * columns] = held(10.0));
        let levels = |joints: &mut Joints, level| {
            (0..rows).for_each(|row| joints.conditions[row * columns + columns - 1] = held(level));
        };
        levels(&mut joints, 10.0);
        let start = joints.steady();
        levels(&mut joints, 4.0);
        let steady = joints.steady();
        let mut clock = Clock::new(&joints, start.u);
        clock.compliance.fill(1e-9);
        let (mut last, mut solves) = (0.0, 0);
        for step in 0..30 {
            let flow = clock.step(10.0 * 1.6_f64.powi(step));
            last = flow.through_flow;
            solves += flow.solves;
        }
        println!("{seed}: {solves} solves in 30 steps, {last:e} at last, steady {:e}", steady.through_flow);
        assert!((last / steady.through_flow - 1.0).abs() < 1e-3, "{last:e} {:e}", steady.through_flow);
    }
}

#[test]
fn bits_of_steps_are_equal_and_wrong_times_are_refused() {
    let mut joints = line(10, [0.0, 10.0], [0.0, 0.0], [1e-4; 2]);
    joints.conditions[10] = Condition::Air;
    let run = || {
        let mut clock = Clock::new(&joints, joints.places.iter().map(|place| 10.0 - place[1]).collect());
        (0..10).for_each(|_| _ = clock.step(1.0));
        clock.u.iter().map(|u| u.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
    let clock = Clock::new(&joints, vec![0.0; 11]);
    let storage = Storage { volume: &clock.volume, compliance: &clock.compliance };
    let of = |storage, u: &[f64], time| {
        clock.net.advance(&clock.conductance, &clock.conditions, storage, u, time).map_err(|error| error.to_string())
    };
    assert_eq!(of(storage, &clock.u, 0.0), Err("`time` of 0 is 0".to_owned()));
    assert_eq!(of(storage, &[0.0], 1.0), Err("`unknowns` has 1 values, and the net needs 11".to_owned()));
    let short = Storage { volume: &[1.0], ..storage };
    assert_eq!(of(short, &clock.u, 1.0), Err("`volume` has 1 values, and the net needs 10".to_owned()));
}

#[test]
fn drawdowns_of_slopes_keep_their_water() {
    let (mut solves, mut steps) = (0, 0);
    for seed in 0..12 {
        let scatter = [0.0, 1.0, 2.0][seed as usize % 3];
        let before = crate::slopes::slope_at(seed, scatter, 1.0, [22.0, 25.0]);
        let start = before.steady();
        let mut clock = Clock::new(&before, start.u);
        for step in 1..=24 {
            let level = 22.0 - 14.0 * f64::from(step.min(8)) / 8.0;
            clock.conditions = crate::slopes::slope_at(seed, scatter, 1.0, [level, 25.0]).conditions;
            solves += clock.step(3600.0 / 24.0).solves;
            steps += 1;
        }
        let end = crate::slopes::slope_at(seed, scatter, 1.0, [8.0, 25.0]);
        let steady = end.steady().through_flow;
        for step in 0..8 {
            solves += clock.step(3600.0 * 8.0_f64.powi(step)).solves;
            steps += 1;
        }
        let last = clock.step(1e12).through_flow;
        assert!((last / steady - 1.0).abs() < 1e-6, "{last:e} {steady:e} at seed {seed}");
    }
    println!("{solves} solves in {steps} steps");
}
