//! Nets whose flow has a formula give it to round-off: joints under pressure, dams, pumps, pieces apart.

use crate::parts::{FREE, Joints, UNIT_WEIGHT, capacity, held, line};
use enmm_seepage::{Condition, DELTA, Net};

/// Whether two numbers are equal to a share of 1e-12.
fn assert_same(found: f64, exact: f64) {
    assert!((found - exact).abs() <= 1e-12 * exact.abs(), "{found:e} instead of {exact:e}");
}

#[test]
fn a_joint_of_one_aperture_has_a_linear_pressure() {
    let mut joints = line(8, [0.0, 0.0], [10.0, 0.0], [1e-4; 2]);
    let head = 1e5 / UNIT_WEIGHT;
    (joints.conditions[0], joints.conditions[8]) = (held(head), held(0.0));
    let flow = joints.steady();
    flow.flow.iter().for_each(|&q| assert_same(q, 1e5 * 1e-12 / (12.0 * 1e-3 * 10.0)));
    flow.u.iter().enumerate().for_each(|(k, &u)| assert!((u - head * (1.0 - k as f64 / 8.0)).abs() < 1e-11));
    assert_same(flow.inflow[0], flow.through_flow);
    assert_same(flow.inflow[8], -flow.through_flow);
}

#[test]
fn a_tapered_joint_conducts_by_the_mean_of_inverse_cubes() {
    let mut joints = line(8, [0.0, 0.0], [10.0, 0.0], [2e-4, 1e-4]);
    (joints.conditions[0], joints.conditions[8]) = (held(1e5 / UNIT_WEIGHT), held(0.0));
    let flow = joints.steady();
    let exact = 1e5 / (12.0 * 1e-3 * 10.0) * 2.0 * 4e-8 * 1e-8 / 3e-4;
    flow.flow.iter().for_each(|&q| assert_same(q, exact));
    // From the middle, 1.5e-4, on: (1/1e-8 - 1/2.25e-8) of (1/1e-8 - 1/4e-8).
    assert_same(flow.u[4] * UNIT_WEIGHT / 1e5, (1.0 - 1.0 / 2.25) / 0.75);
}

#[test]
fn joints_in_series_and_at_a_crossing_follow_kirchhoff() {
    let places = vec![[0.0, 0.0], [4.0, 0.0], [10.0, 0.0]];
    let mut joints = Joints::new(places, vec![[0, 1], [2, 1]], vec![[1e-4; 2], [2e-4; 2]]);
    (joints.conditions[0], joints.conditions[2]) = (held(7.0), held(1.0));
    let flow = joints.steady();
    let resistance = 4.0 / capacity(1e-4) + 6.0 / capacity(2e-4);
    assert_same(flow.flow[0], 6.0 / resistance);
    assert_same(flow.flow[1], -6.0 / resistance);

    let places = vec![[0.0, 0.0], [-3.0, 4.0], [6.0, 8.0], [0.0, -2.0]];
    let mut joints = Joints::new(places, vec![[0, 1], [2, 0], [0, 3]], vec![[1e-4; 2], [2e-4; 2], [3e-4; 2]]);
    let heads = [30.0, 20.0, 5.0];
    (0..3).for_each(|k| joints.conditions[k + 1] = held(heads[k]));
    let flow = joints.steady();
    let conductance = joints.conductance();
    let sum: f64 = conductance.iter().sum();
    let head: f64 = conductance.iter().zip(heads).map(|(g, h)| g * h).sum::<f64>() / sum;
    assert_same(flow.u[0], head);
    assert_same(flow.flow[0], conductance[0] * (head - 30.0));
    assert_same(flow.flow[1], conductance[1] * (20.0 - head));
    assert_same(flow.flow[2], conductance[2] * (head - 5.0));
}

#[test]
fn the_base_of_a_dam_has_the_uplift_of_a_triangle_and_a_drain_cuts_it() {
    let mut joints = line(40, [0.0, 0.0], [40.0, 0.0], [1e-4; 2]);
    (joints.conditions[0], joints.conditions[40]) = (held(50.0), held(0.0));
    assert_same(joints.uplift(&joints.steady()), 0.5 * UNIT_WEIGHT * 50.0 * 40.0);
    joints.conditions[5] = Condition::Air;
    let flow = joints.steady();
    assert_same(joints.uplift(&flow), 0.5 * UNIT_WEIGHT * 50.0 * 5.0);
    assert_same(flow.inflow[5], -capacity(1e-4) * 50.0 / 5.0);
}

#[test]
fn a_pump_lowers_the_head_until_its_well_is_dry() {
    let mut joints = line(20, [0.0, 0.0], [20.0, 0.0], [1e-4; 2]);
    let capacity = capacity(1e-4);
    (joints.conditions[0], joints.conditions[20]) = (held(10.0), held(10.0));
    joints.conditions[10] = Condition::Free { source: -0.5 * capacity };
    let flow = joints.steady();
    assert_same(flow.u[10], 7.5);
    assert_eq!(flow.inflow[10], -0.5 * capacity);
    // Both sides give one tenth of the head each, and the pump would take three times that.
    joints.conditions[10] = Condition::Free { source: -6.0 * capacity };
    let flow = joints.steady();
    assert_eq!(flow.u[10], -DELTA);
    assert_same(flow.inflow[10], -2.0 * capacity);
    assert_same(flow.through_flow, 2.0 * capacity);
}

#[test]
fn a_source_raises_the_head_above_all_others() {
    let mut joints = line(20, [0.0, 0.0], [20.0, 0.0], [1e-4; 2]);
    (joints.conditions[0], joints.conditions[20]) = (held(10.0), held(10.0));
    joints.conditions[10] = Condition::Free { source: 0.5 * capacity(1e-4) };
    let flow = joints.steady();
    assert_same(flow.u[10], 12.5);
    assert_eq!(flow.inflow[10], 0.5 * capacity(1e-4));
}

#[test]
fn water_flows_up_from_a_dip() {
    // Down to -5 m and up to an outlet at 2 m, from a head of 8 m; all of it is full.
    let mut joints = line(8, [0.0, 5.0], [10.0, -5.0], [1e-4; 2]);
    let rise = line(8, [10.0, -5.0], [20.0, 2.0], [1e-4; 2]);
    joints.places.extend(&rise.places[1..]);
    joints.pipes.extend((8..16).map(|k| [k, k + 1]));
    joints.apertures.extend(&rise.apertures);
    joints.conditions.resize(17, FREE);
    (joints.conditions[0], joints.conditions[16]) = (held(8.0), Condition::Air);
    let flow = joints.steady();
    let length: f64 = joints.lengths().iter().sum();
    flow.flow.iter().for_each(|&q| assert_same(q, capacity(1e-4) * 6.0 / length));
}

#[test]
fn pieces_apart_are_dry_and_dead_ends_have_still_water() {
    let heights = [0.0, 0.0, 5.0, 5.0, 0.0, -3.0];
    let pipes = [[0, 4], [4, 1], [2, 3], [4, 5]];
    let net = Net::new(&heights, &pipes).unwrap();
    let mut conditions = [FREE; 6];
    (conditions[0], conditions[1]) = (held(4.0), held(0.0));
    conditions[3] = Condition::Free { source: -1e-6 };
    let flow = net.steady(&[1e-7; 4], &conditions).unwrap();
    assert_eq!((flow.u[2], flow.u[3], flow.flow[2], flow.inflow[3]), (-DELTA, -DELTA, 0.0, 0.0));
    assert!((flow.u[4] - 2.0).abs() < 1e-12 && (flow.u[5] - 5.0).abs() < 1e-12, "{flow:?}");
    assert_eq!(net.pieces(&[1e-7; 4]), [0, 0, 2, 2, 0, 0]);
    assert_eq!(net.pieces(&[1e-7, 0.0, 0.0, 1e-7]), [0, 1, 2, 3, 0, 0]);
}
