//! Free surfaces: the discharge of Charny, films, rain that runs off, a mound under rain.

use crate::parts::{Joints, capacity, grid, held, line};
use enmm_seepage::{Condition, Flow, law};

/// A dam of a net of joints, 10 m long, between waters 10 and 2 m deep.
fn dam(spacing: f64) -> (Joints, [usize; 2]) {
    let (mut joints, [columns, rows]) = grid([10.0, 12.0], spacing, 1e-4);
    for row in 0..rows {
        let (left, right) = (row * columns, row * columns + columns - 1);
        if joints.places[left][1] <= 10.0 {
            joints.conditions[left] = held(10.0);
        }
        joints.conditions[right] = held(2.0);
    }
    (joints, [columns, rows])
}

#[test]
fn a_dam_of_a_net_has_the_discharge_of_charny() {
    let exact = capacity(1e-4) / 0.5 * (100.0 - 4.0) / 20.0;
    for (spacing, seepage) in [(1.0, 5.0), (0.5, 4.5), (0.25, 4.25)] {
        let (joints, [columns, rows]) = dam(spacing);
        let flow = joints.steady();
        let of_column = |column: usize| (0..rows).map(move |row| row * columns + column);
        let inflow: f64 = of_column(0).map(|node| flow.inflow[node]).sum();
        let outflow: f64 = of_column(columns - 1).map(|node| flow.inflow[node]).sum();
        assert!(
            (inflow / exact - 1.0).abs() < 1e-10 && (outflow / exact + 1.0).abs() < 1e-10,
            "{inflow:e} {outflow:e}"
        );
        let seeps = of_column(columns - 1).filter(|&node| flow.inflow[node] < -1e-18);
        let top = seeps.map(|node| joints.places[node][1]).fold(0.0, f64::max);
        assert!((top - seepage).abs() < 1e-9, "water seeps out up to {top}");
        assert!(flow.solves <= 15, "{} solves", flow.solves);
    }
}

#[test]
fn rain_falls_through_a_joint_as_a_film_and_runs_off_above_its_capacity() {
    let capacity = capacity(1e-4);
    for share in [0.3, 1.0, 2.5] {
        let mut joints = line(10, [0.0, 10.0], [0.0, 0.0], [1e-4; 2]);
        joints.conditions[0] = Condition::Rain { rate: share * capacity };
        joints.conditions[10] = Condition::Air;
        let flow: Flow = joints.steady();
        let enters = f64::min(share, 1.0);
        assert!((law::filling(flow.u[5]) - enters).abs() < 1e-12 && law::pressure_head(flow.u[5]) < 1e-12, "{flow:?}");
        assert!((flow.inflow[10] / capacity + enters).abs() < 1e-12, "{flow:?}");
        assert!((flow.inflow[0] / capacity - enters).abs() < 1e-12, "{flow:?}");
        assert!((flow.run_off[0] / capacity - (share - enters)).abs() < 1e-12, "{flow:?}");
    }
}

#[test]
fn water_wells_up_where_rain_falls_on_a_full_joint() {
    let mut joints = line(10, [0.0, 0.0], [10.0, 0.0], [1e-4; 2]);
    joints.conditions[0] = held(5.0);
    joints.conditions[10] = Condition::Rain { rate: 1e-7 };
    let flow = joints.steady();
    let through = capacity(1e-4) * 0.5;
    assert!((flow.inflow[10] + through).abs() < 1e-12 * through, "{flow:?}");
    assert!((flow.run_off[10] - through - 1e-7).abs() < 1e-12 * through, "{flow:?}");
}

#[test]
fn a_mound_under_rain_is_that_of_dupuit() {
    for spacing in [1.0, 0.5, 0.25] {
        let (mut joints, [columns, rows]) = grid([20.0, 8.0], spacing, 1e-4);
        let rate = capacity(1e-4) / 0.5 * (36.0 - 16.0) / 400.0;
        let top = (rows - 1) * columns;
        for column in 0..columns {
            let share = if column == 0 || column == columns - 1 { 0.5 } else { 1.0 };
            joints.conditions[top + column] = Condition::Rain { rate: rate * spacing * share };
        }
        (0..rows - 1).for_each(|row| joints.conditions[row * columns + columns - 1] = held(4.0));
        let flow = joints.steady();
        let (far, middle) = (flow.u[0], flow.u[columns / 2]);
        assert!((far / 6.0 - 1.0).abs() < 0.02 && (middle / 31.0_f64.sqrt() - 1.0).abs() < 0.02, "{far} {middle}");
        let sum: f64 = flow.inflow.iter().sum();
        assert!(sum.abs() < 1e-12 * flow.through_flow, "{sum:e} of {:e}", flow.through_flow);
        assert!(flow.run_off.iter().all(|&run_off| run_off <= 1e-12 * rate), "all enters");
    }
}
