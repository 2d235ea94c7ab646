//! Free-field columns move as closed forms of layers say.

use enmm::geometry::Vector;
use enmm::internals::mechanics::{Column, ColumnDrive, ColumnState, Elasticity, Foot};
use enmm::model::tables::BlockId;

fn column(foot: Foot) -> Column {
    let rock = Elasticity { lambda: 2.0, mu: 1.0, density: 1.0 };
    Column { foot_height: 1.0, spacing: 0.5, rocks: vec![rock; 40], blocks: vec![BlockId::default(); 41], foot }
}

/// Runs a column of c_s = 1 and c_p = 2 m/s, 20 m high.
fn run(column: &Column, drive: impl Fn(f64) -> ColumnDrive, seconds: f64) -> ColumnState {
    let mut state = ColumnState::at_rest(column.node_count());
    let mut after = state.velocity.clone();
    let dt = 0.2;
    for step in 0..(seconds / dt) as u32 {
        let drive = ColumnDrive { kick: if step == 0 { 0.5 * dt } else { dt }, ..drive(f64::from(step) * dt) };
        column.kick(&state, &drive, |_| 1.0, &mut after);
        state.velocity.copy_from_slice(&after);
        state.displacement.iter_mut().zip(&after).for_each(|(u, v)| *u += v * dt);
    }
    state
}

/// A velocity of 1 m/s enters and has reached 15 m by shear and all of the column, doubled at its head, by
/// pressure.
#[test]
fn a_wave_enters_through_a_quiet_foot_and_doubles_at_the_head() {
    let wave = |_| ColumnDrive { acceleration: Vector::zeros(), wave: Vector::new(1.0, 1.0), kick: 0.0 };
    let state = run(&column(Foot::Quiet(0)), wave, 15.0);
    let mean = |range: std::ops::Range<usize>, axis: usize| {
        let count = range.len() as f64;
        state.velocity[range].iter().map(|v| v[axis]).sum::<f64>() / count
    };
    assert!((mean(2..20, 0) - 1.0).abs() < 0.02 && mean(36..41, 0).abs() < 0.02, "{:?}", state.velocity);
    assert!((mean(32..41, 1) - 2.0).abs() < 0.05 && (mean(2..14, 1) - 1.0).abs() < 0.05, "{:?}", state.velocity);
}

/// Under a constant acceleration the head of a rigid-footed column swings to twice a·ρH²/2μ at half its period
/// 4H/c.
#[test]
fn a_rigid_foot_holds_the_column() {
    let push = |_| ColumnDrive { acceleration: Vector::new(0.1, 0.0), wave: Vector::zeros(), kick: 0.0 };
    let state = run(&column(Foot::Rigid), push, 40.0);
    assert_eq!(state.displacement[0], Vector::zeros());
    assert!((state.displacement[40].x - 40.0).abs() < 0.4, "{}", state.displacement[40]);
}

#[test]
fn places_lie_in_their_cells() {
    let column = column(Foot::Rigid);
    let field: Vec<Vector> = (0..41).map(|k| Vector::new(f64::from(k), 0.0)).collect();
    for (y, expected) in [(1.0, 0.0), (1.2, 0.4), (21.0, 40.0), (30.0, 40.0)] {
        assert!((column.position(y).sample(&field).x - expected).abs() < 1e-12);
    }
}
