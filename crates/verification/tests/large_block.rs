//! A large block, cut into parts of tiles whose elements stand in rows: every element is where it belongs, and the
//! forces are those of the elements one by one.

use crate::common::simulation;
use enmm::geometry::Vector;
use enmm::internals::step::{Regime, advance, prepare};
use enmm::model::tables::{CoverId, Model, Workspace};
use enmm::model::{State, Wanted};
use enmm_verification::bench::continuum_case;

/// Height (m) below which nothing is displaced, so that what holds the base plays no part.
const STILL: f64 = 10.0;

#[test]
fn every_part_has_the_elements_of_its_covers_once() {
    let simulation = simulation(&continuum_case(12_000));
    let slope = simulation.model();
    let (covers, chunks) = (&slope.covers, &slope.chunks);
    let (mut in_rows, mut all) = (0, 0);
    for chunk in chunks.iter() {
        let ids: Vec<CoverId> =
            CoverId::range(chunk.covers.clone()).chain(chunks.halo(chunk).iter().copied()).collect();
        let is_own = |i: &CoverId| chunk.covers.contains(&i.index());
        let wanted = covers.element_covers.iter().filter(|c| c.iter().any(is_own)).count();
        let mut found = Vec::new();
        for batch in chunks.batches(chunk) {
            for (e, slots) in chunks.elements(batch) {
                assert_eq!(slots.map(|slot| ids[slot.index()]), covers.element_covers[e]);
                assert_eq!(covers.element_triangle[e].set, batch.set);
                found.push(e);
            }
            in_rows +=
                chunks.rows(batch).list.iter().map(|row| row.area.iter().filter(|a| **a > 0.0).count()).sum::<usize>();
        }
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), wanted);
        all += wanted;
    }
    assert!(chunks.len() > 4 && 10 * in_rows > 7 * all, "{in_rows} of {all} in rows");
}

/// Velocities after one step from displacements at rest.
fn kicked(slope: &Model, start: &State, displacement: impl Fn(usize) -> Vector) -> (Vec<Vector>, State) {
    let mut state = start.clone();
    (0..state.displacement.len()).for_each(|i| state.displacement[i] = displacement(i));
    let before = state.clone();
    let mut workspace = Workspace::default();
    prepare(slope, &state, &mut workspace);
    advance(slope, Regime::Dynamic { damping: 0.0 }, &mut state, &mut workspace, Wanted::Nothing).expect("a step");
    (state.velocity, before)
}

#[test]
fn forces_are_those_of_the_elements_one_by_one() {
    let simulation = simulation(&continuum_case(12_000));
    let slope = simulation.model();
    let place = |i: usize| slope.covers.star_position[i];
    let moved = |i: usize| {
        let p = place(i);
        let share = 1e-3 * (p.y - STILL).max(0.0);
        Vector::new((0.3 * p.x).sin() * (0.2 * p.y).cos(), (0.25 * p.x + 0.1 * p.y).cos()) * share
    };
    let (still, _) = kicked(slope, simulation.state(), |_| Vector::zeros());
    let (bent, state) = kicked(slope, simulation.state(), moved);
    let mut force = vec![Vector::zeros(); still.len()];
    for (e, covers) in slope.covers.elements().zip(&slope.covers.element_covers) {
        let g = &slope.covers.gradients[slope.covers.element_triangle[e].set as usize];
        let deformation = slope.deformation(e, &state.displacement);
        let forces = deformation.forces(g, slope.covers.element_area[e], slope.rock_of(e), &[0.0; 3]);
        covers.iter().zip(forces).for_each(|(&i, f)| force[i] += f);
    }
    let kick = 0.5 * slope.dt;
    let largest = force.iter().map(Vector::norm).fold(0.0, f64::max);
    assert!(largest > 0.0);
    for i in (0..force.len()).filter(|&i| place(i).y > STILL) {
        let found = (bent[i] - still[i]) * (slope.mass_matrix.mass[i] / kick);
        assert!((found - force[i]).norm() < 1e-9 * largest, "{found} instead of {} at {}", force[i], place(i));
    }
}
