//! The open–close iteration as `docs/theory.md` §5 has it. **This is the file in which to read the method.**
//!
//! Plain Gauss–Seidel: contact after contact, in the order of the list, until no force changes any more. There are no
//! eight lanes, no groups and no threads, no contact is skipped, and each equation stands once. No step calls it, but
//! [`OpenClose`](super::OpenClose), which solves the same equations fast, and which `tests/contact_reference.rs` holds
//! to this. Supports and bolts, which answer between its sweeps, are not repeated here.

use enmm_lanes::First;

use crate::contact::{Closure, ContactSetting, Hold, Pair, Slide, SoftSpring, Spring, VertexEdge};
use crate::cover;
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;

use super::{Approach, BlockImpulse, LIGHT, SolverOptions, SolverReport};

/// Linear response of a contact in a step, beside the data of [`VertexEdge`].
#[derive(Debug, Clone)]
struct Equation {
    /// The node and the position on the edge that it faces.
    pair: Pair,
    /// Arms from the centroids of the blocks to the node (m).
    arms: [Vector; 2],
    /// z = Σwμ/m of both blocks.
    z: [f64; 2],
    /// Responses of the normal and of the shear spring.
    answers: [SoftSpring; 2],
    /// Curve of the normal spring.
    closure: Closure,
    /// Bond that softens.
    bond: Option<Hold>,
    /// The slide before a lift, at the velocity along the edge without contact forces, but for forces of a sweep.
    slide: Slide,
}

impl Equation {
    fn new(contact: &VertexEdge, masses: &MassMatrix, options: &SolverOptions, approach: &Approach) -> Self {
        let setting = &approach.setting;
        let (pair, axes) = (contact.pair(setting.boundary), [contact.normal, contact.tangent()]);
        let point = setting.frames.position(contact.point);
        let arms = pair.blocks.map(|block| point - approach.motion[block].centre);
        let compliance = axes.map(|axis| pair.compliance(masses, &arms, axis));
        let speed = contact.relative(setting.boundary, approach.predicted);
        let last = contact.relative(setting.boundary, approach.velocity).map(|v| v * approach.dt_last);
        let inverse: f64 = pair.blocks.map(|block| masses.inverse_total[block]).iter().sum();
        let penalty = setting.laws[contact.law].penalty;
        let bond = contact.bond(setting);
        let spring = |axis: usize| {
            let (stiffness, compliance, speed) = (contact.stiffness[axis], compliance[axis], speed[axis]);
            let SolverOptions { dt, kick, .. } = *options;
            let own = Spring { stiffness, compliance, approach: speed, forward: approach.forward, lag: 0.0, dt, kick };
            if bond.is_some() {
                return Spring { forward: 1.0, ..own };
            }
            let is_centred = approach.damping.is_some() && !penalty[axis];
            if is_centred { own.centred(First, last[axis], approach.bouncing(First, inverse)) } else { own }
        };
        let normal = spring(0);
        let closure = contact.closure(setting);
        let closing = if closure.is_curved() || bond.is_some() {
            Spring { stiffness: 1.0, ..normal }.response(-contact.gap)
        } else {
            normal.response(-contact.stiffness[0] * contact.gap)
        };
        let answers = [closing, spring(1).response(contact.shear_stored())];
        let z = [0, 1].map(|k| pair.z(k, masses));
        let eased = compliance[1] * options.kick;
        let slide = Slide { speed: speed[1], eased, dt: options.dt, ..Slide::default() };
        Self { pair, arms, z, answers, closure, bond, slide }
    }
}

/// Effect of the impulses of all contacts so far on covers and blocks.
#[derive(Debug, Clone)]
pub struct Impulses<'a> {
    mass_matrix: &'a MassMatrix,
    /// p/m of each cover (m/s), 0 along an axis that is held.
    pub increment: Vec<Vector>,
    /// P, Z and L of each block, 0 of a held one.
    pub block_impulse: Vec<BlockImpulse>,
}

impl<'a> Impulses<'a> {
    /// Nothing has pushed.
    fn none(mass_matrix: &'a MassMatrix) -> Self {
        Self {
            mass_matrix,
            increment: vec![Vector::zeros(); mass_matrix.mass.len()],
            block_impulse: vec![BlockImpulse::default(); mass_matrix.total.len()],
        }
    }

    /// Velocity (m/s) that they give to point `k` of a contact: all of Eq. 17 but v* of the start, which springs know.
    fn velocity(&self, k: usize, equation: &Equation) -> Vector {
        let pair = &equation.pair;
        let own = cover::sample(&pair.covers[k], &pair.weights[k], &self.increment);
        let (block, masses) = (pair.blocks[k], self.mass_matrix);
        if !masses.is_free(block) {
            return own;
        }
        let BlockImpulse { impulse, weighted, moment } = self.block_impulse[block];
        let (mass, square) = (masses.total[block], masses.square[block]);
        let shift = impulse / mass - impulse * (equation.z[k] / mass) - (weighted - impulse * (square / mass)) / mass;
        own + shift + turned(equation.arms[k]) * (masses.spin[block] * moment)
    }

    /// Point `k` of a contact takes an impulse (N·s/m).
    fn push(&mut self, k: usize, equation: &Equation, impulse: Vector) {
        let pair = &equation.pair;
        for (&i, weight) in pair.covers[k].iter().zip(pair.weights[k]) {
            self.increment[i] += self.mass_matrix.inverse[i].component_mul(&impulse) * weight;
        }
        let block = pair.blocks[k];
        if self.mass_matrix.is_free(block) {
            let sums = &mut self.block_impulse[block];
            sums.impulse += impulse;
            sums.weighted += impulse * equation.z[k];
            sums.moment += equation.arms[k].perp(&impulse);
        }
    }

    /// Both bodies of a contact take the impulses of forces (N/m) normal and shear that act for `kick` (s).
    fn push_both(&mut self, contact: &VertexEdge, equation: &Equation, [normal, shear]: [f64; 2], kick: f64) {
        let impulse = (contact.normal * normal + contact.tangent() * shear) * kick;
        self.push(0, equation, impulse);
        self.push(1, equation, -impulse);
    }
}

/// Sweeps over contacts until their forces settle (Eq. 16), from those that are expected; leaves forces and states in
/// the contacts.
pub fn solve<'a>(
    mass_matrix: &'a MassMatrix,
    options: &SolverOptions,
    approach: &Approach,
    contacts: &mut [VertexEdge],
) -> (Impulses<'a>, SolverReport) {
    let mut impulses = Impulses::none(mass_matrix);
    let equation = |contact: &VertexEdge| Equation::new(contact, mass_matrix, options, approach);
    let equations: Vec<Equation> = contacts.iter().map(equation).collect();
    for (contact, equation) in contacts.iter_mut().zip(&equations) {
        let expected = contact.expected(&contact.limits(&approach.setting));
        [contact.history.normal_force, contact.history.shear_force] = expected;
        impulses.push_both(contact, equation, expected, options.kick);
    }
    let mut report = SolverReport::default();
    let mut changes = vec![0.0; contacts.len()];
    while report.sweeps < options.sweeps_max {
        for ((contact, equation), change) in contacts.iter_mut().zip(&equations).zip(&mut changes) {
            *change = solve_contact(contact, equation, &approach.setting, &mut impulses, options.kick);
        }
        report.sweeps += 1;
        report.contacts_solved += contacts.len() as u64;
        report.unsettled = unsettled(contacts, &changes);
        if report.unsettled <= options.tolerance {
            break;
        }
    }
    (impulses, report)
}

/// One contact takes its new forces: open, slip or lock; returns the larger of their changes (N/m).
fn solve_contact(
    contact: &mut VertexEdge,
    equation: &Equation,
    setting: &ContactSetting,
    impulses: &mut Impulses,
    kick: f64,
) -> f64 {
    let velocity = impulses.velocity(0, equation) - impulses.velocity(1, equation);
    let before = forces(contact);
    let [normal, shear] = asked(contact, equation, setting, velocity);
    contact.decide(normal, shear, setting);
    let after = forces(contact);
    let change = [after[0] - before[0], after[1] - before[1]];
    impulses.push_both(contact, equation, change, kick);
    change[0].abs().max(change[1].abs())
}

/// Forces (N/m) of the springs at the end of the step, before any limit (Eqs. 14, 15), where all impulses so
/// far have given the points the relative velocity u (m/s).
///
/// Of each spring [`SoftSpring`] holds what no sweep changes: `rest` = −k(g + θΔt·u*), or T_hist − kθΔt·u* along the
/// edge, u* being the velocity without contact forces; `rate` = kθΔt; `kept` = kθΔt·W times the kick.
fn asked(contact: &VertexEdge, equation: &Equation, setting: &ContactSetting, u: Vector) -> [f64; 2] {
    let along = [u.dot(&contact.normal), u.dot(&contact.tangent())];
    let force = forces(contact);
    let [normal, shear] = [0, 1].map(|axis| {
        let SoftSpring { rest, rate, kept } = equation.answers[axis];
        rest - rate * along[axis] + kept * force[axis]
    });
    let [kept_normal, kept_shear] = [equation.answers[0].kept, equation.answers[1].kept];
    if let Some(bond) = equation.bond {
        let pull = bond.normal(normal, kept_normal);
        let trial = shear / (1.0 + kept_shear);
        let ease = (1.0 + kept_shear) / contact.stiffness[1];
        let limit = bond.shear(pull, trial.abs(), ease, kept_normal * pull - normal);
        return [pull, trial.clamp(-limit, limit)];
    }
    // Of a joint that closes on a curve the sum above is the closure from which the force follows (Eq. 35).
    let curve = equation.closure;
    let share = if curve.is_curved() { 1.0 } else { 1.0 / (1.0 + kept_normal) };
    let stick = shear / (1.0 + kept_shear);
    let slide = Slide {
        normal: normal * share,
        rate: equation.answers[0].rate * share,
        stick,
        shear: force[1],
        speed: equation.slide.speed + along[1],
        ..equation.slide
    };
    let climbs = contact.dilates(setting);
    let answer = if climbs { contact.climb(&slide, &contact.limits(setting), setting) } else { slide.normal };
    [curve.force(answer, kept_normal), stick]
}

/// Largest change of a force over the force of its contact, or over a share of the largest one of all (Eq. 16).
fn unsettled(contacts: &[VertexEdge], changes: &[f64]) -> f64 {
    let normal = |contact: &VertexEdge| contact.history.normal_force;
    let floor = LIGHT * contacts.iter().map(normal).fold(f64::MIN_POSITIVE, f64::max);
    contacts.iter().zip(changes).map(|(contact, change)| change / normal(contact).max(floor)).fold(0.0, f64::max)
}

fn forces(contact: &VertexEdge) -> [f64; 2] {
    [contact.history.normal_force, contact.history.shear_force]
}

/// An arm turned by 90°: the velocity of its end at a spin of 1 rad/s.
fn turned(arm: Vector) -> Vector {
    Vector::new(-arm.y, arm.x)
}
