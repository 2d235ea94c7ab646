//! Energies, momenta and what a step reports.

use crate::contact::{BoltSegment, BoltState, Support};
use crate::cover::BlockId;
use crate::geometry::{Point, Vector};
use crate::mechanics::{self, BlockCovers, MassMatrix};
use crate::state::{Ledger, Model, State, Workspace};

use super::{integrator_of, quiet};

/// Share of the mass without supports that may go on moving in a slope at rest.
const FEW: f64 = 1e-3;

/// Mass (kg/m) of blocks that are too few to decide about a slope: a thousandth of all free rock that no support holds,
/// or of all free rock where supports hold each block.
pub fn mass_of_few(model: &Model, mass_matrix: &MassMatrix) -> f64 {
    let mut held = vec![false; model.covers.block_count()];
    model.supports.iter().for_each(|support| held[support.block.index()] = true);
    let mass = |is_in: &dyn Fn(BlockId) -> bool| -> f64 {
        let blocks = model.covers.blocks().filter(|&b| mass_matrix.is_free(b) && is_in(b));
        blocks.map(|b| mass_matrix.total[b]).sum()
    };
    let loose = mass(&|b| !held[b.index()]);
    FEW * if loose > 0.0 { loose } else { mass(&|_| true) }
}

/// A step as seen from outside; energies hold at the step's start.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StepReport {
    /// Time at the start of the step (s).
    pub time: f64,
    /// Sub-step (s).
    pub dt: f64,
    /// Energies.
    pub ledger: Ledger,
    /// Net over applied force; 1, or 0 in balance, where nothing is applied.
    pub unbalanced: f64,
    /// Kinetic energy (J/m) of all blocks but the few that have most of it (see `mass_of_few`).
    pub kinetic_of_most: f64,
    /// Contacts below their shear limit.
    pub locked: u32,
    /// Contacts at their shear limit.
    pub slipping: u32,
    /// Largest penetration (m).
    pub penetration_max: f64,
    /// Largest speed of rock (m/s).
    pub speed_max: f64,
}

/// Net over applied force, or their squares (Eq. 19). Where nothing is applied it is 1, all being out of balance, or 0
/// when nothing is; so it is finite.
pub fn unbalanced(net: f64, applied: f64) -> f64 {
    if applied > 0.0 { (net / applied).min(f64::MAX) } else { f64::from(net > 0.0) }
}

/// Largest speed (m/s) of rock: of the corners of its blocks. Covers may be faster, since their stars lie outside small
/// blocks.
pub fn speed_max(model: &Model, state: &State) -> f64 {
    let boundary = &model.boundary;
    boundary.edges().map(|k| boundary.sample(k, &state.velocity).norm_squared()).fold(0.0, f64::max).sqrt()
}

/// Kinetic energy (J/m) by lumped masses of all blocks that can move.
pub(super) fn kinetic(model: &Model, mass_matrix: &MassMatrix, displacement: &[Vector], velocity: &[Vector]) -> f64 {
    let free = model.covers.blocks().filter(|&b| !mass_matrix.fixed[b]);
    free.map(|b| kinetic_of(model, mass_matrix, displacement, velocity, b)).sum()
}

/// Kinetic energy (J/m) of one block by lumped masses.
pub(super) fn kinetic_of(
    model: &Model,
    mass_matrix: &MassMatrix,
    displacement: &[Vector],
    velocity: &[Vector],
    block: BlockId,
) -> f64 {
    mechanics::kinetic_energy(&block_covers(model, mass_matrix, displacement, velocity, block))
}

/// Kinetic energy (J/m) of all blocks but the few that have most of it (see [`mass_of_few`]): the mean of those before
/// and `after` the kick, as in the ledger.
pub(super) fn kinetic_of_most(model: &Model, mass_matrix: &MassMatrix, state: &State, after: &[Vector]) -> f64 {
    let mut room = mass_of_few(model, mass_matrix);
    let free = model.covers.blocks().filter(|&b| !mass_matrix.fixed[b]);
    let with = |velocity, b| kinetic_of(model, mass_matrix, &state.displacement, velocity, b);
    let kinetic = |b| 0.5 * (with(&state.velocity, b) + with(after, b));
    let mut blocks: Vec<(f64, BlockId)> = free.map(|b| (kinetic(b), b)).collect();
    blocks.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut most = 0.0;
    for (kinetic, block) in blocks {
        let mass = mass_matrix.total[block];
        if mass <= room { room -= mass } else { most += kinetic }
    }
    most
}

/// Strain energy (J/m) of all blocks that are there (Eqs. 8, 58).
pub fn strain(model: &Model, state: &State) -> f64 {
    strain_at(model, state, &state.displacement)
}

/// The same at other displacements (m).
fn strain_at(model: &Model, state: &State, displacement: &[Vector]) -> f64 {
    let covers = &model.covers;
    let mut strain = 0.0;
    model.each_stressed(state, displacement, 0..covers.element_count(), |e, _, energy| {
        if !state.removed[covers.element_block[e]] {
            strain += covers.element_area[e] * energy;
        }
    });
    strain
}

/// Potential energy (J/m) of gravity relative to the reference configuration.
pub fn potential(model: &Model, state: &State) -> f64 {
    potential_at(model, state, &state.displacement)
}

/// The same at other displacements (m).
fn potential_at(model: &Model, state: &State, displacement: &[Vector]) -> f64 {
    let covers = &model.covers;
    (0..covers.cover_count())
        .filter(|&i| !state.removed[covers.cover_block[i]])
        .map(|i| -model.mass_matrix.row_sum[i] * model.gravity.dot(&displacement[i]))
        .sum()
}

/// Energy (J/m) stored in the springs of contacts and of supports that do not move.
pub fn stored(model: &Model, state: &State, workspace: &Workspace) -> f64 {
    let support = |row: &crate::contact::SupportRow| {
        let support = &model.supports[row.support as usize];
        if support.is_dashpot() || model.fixities[support.fix as usize].is_moved() {
            return 0.0;
        }
        0.5 * (support.preload - support.stiffness * row.displacement).powi(2) / support.stiffness
    };
    let setting = workspace.setting(model, state);
    let contacts = workspace.contacts.iter().map(|contact| contact.stored_energy(&setting)).sum::<f64>();
    let supports = workspace.supports.rows.iter().map(support).sum::<f64>();
    let kept = |(k, s): (usize, &Support)| 0.5 * state.support_force[k].powi(2) / s.stiffness;
    contacts + supports + quiet::frozen(model, state).map(kept).sum::<f64>()
}

/// Energy (J/m) stored in bolts.
pub(super) fn bolt_stored(model: &Model, state: &State) -> f64 {
    let star = &model.covers.star_position;
    let of = |(segment, bolt): (&BoltSegment, &BoltState)| {
        segment.energy(bolt, segment.span(star, &state.displacement).norm())
    };
    model.bolts.iter().zip(&state.bolts).map(of).sum()
}

/// Energies (J/m) of a state at rest or in motion, without works: kinetic, strain, potential.
pub fn energies(model: &Model, state: &State, mass_matrix: &MassMatrix) -> Ledger {
    energies_at(model, state, &state.displacement, mass_matrix)
}

/// The same half an internal step ago, at the time of the velocities: the works of all steps so far belong to it.
pub fn energies_at_velocities(model: &Model, state: &State, mass_matrix: &MassMatrix) -> Ledger {
    let half = -0.5 * state.dt_last;
    let displacement: Vec<Vector> = state.displacement.iter().zip(&state.velocity).map(|(u, v)| u + v * half).collect();
    energies_at(model, state, &displacement, mass_matrix)
}

fn energies_at(model: &Model, state: &State, displacement: &[Vector], mass_matrix: &MassMatrix) -> Ledger {
    Ledger {
        kinetic: integrator_of(model).kinetic(model, mass_matrix, displacement, &state.velocity),
        strain: strain_at(model, state, displacement),
        potential: potential_at(model, state, displacement),
        ..state.ledger
    }
}

/// Linear (kg·m/s per metre) and angular momentum (kg·m²/s per metre) about the origin of all free blocks.
pub fn momentum(model: &Model, state: &State, mass_matrix: &MassMatrix) -> (Vector, f64) {
    let (mut linear, mut angular) = (Vector::zeros(), 0.0);
    for block in model.covers.blocks().filter(|&b| mass_matrix.is_free(b)) {
        let covers = block_covers(model, mass_matrix, &state.displacement, &state.velocity, block);
        let (centre, velocity, spin): (Point, Vector, f64) = mechanics::rigid_motion(&covers);
        linear += velocity * mass_matrix.total[block];
        angular += mass_matrix.total[block] * centre.perp(&velocity) + mass_matrix.polar[block] * spin;
    }
    (linear, angular)
}

/// Rigid motion of one block: centroid (m), its velocity (m/s), spin (rad/s), and the kinetic energy (J/m).
pub fn block_motion(
    model: &Model,
    state: &State,
    mass_matrix: &MassMatrix,
    block: BlockId,
) -> (Point, Vector, f64, f64) {
    let covers = block_covers(model, mass_matrix, &state.displacement, &state.velocity, block);
    let (motion, kinetic) = mechanics::motion_with_energy(&covers);
    let (centre, velocity, spin) = motion;
    (centre, velocity, spin, if mass_matrix.fixed[block] { 0.0 } else { kinetic })
}

/// One block's slices: for its energy, momentum and damping.
pub(super) fn block_covers<'a>(
    model: &'a Model,
    mass_matrix: &'a MassMatrix,
    displacement: &'a [Vector],
    velocity: &'a [Vector],
    block: BlockId,
) -> BlockCovers<'a> {
    let range = model.covers.covers_of(block);
    BlockCovers { mass_matrix, block, range, star: &model.covers.star_position, displacement, velocity }
}
