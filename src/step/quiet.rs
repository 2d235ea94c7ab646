//! Quiet boundaries: springs that freeze, dashpots that take over, and what supports answer to.

use crate::contact::{Resistance, Support, SupportRow};
use crate::geometry::Vector;
use crate::mechanics::ColumnState;
use crate::state::{Model, MotionBuffers, State};

use super::{Regime, Substep, records};

/// Supports of quiet boundaries whose springs are frozen: each keeps its last force.
pub fn frozen<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = (usize, &'a Support)> {
    let first = model.fixed_supports as usize;
    let is_frozen = |support: &Support| {
        !support.is_dashpot() && !state.fix_active[support.fix as usize] && !state.removed[support.block]
    };
    model.supports.iter().enumerate().skip(first).filter(move |(_, support)| is_frozen(support))
}

/// Lets dashpots take over from springs in a dynamic stage, and springs from dashpots, where they are, in a static one.
pub fn begin_stage(model: &Model, regime: Regime, state: &mut State) {
    let is_dynamic = matches!(regime, Regime::Dynamic { .. });
    for quiet in &model.quiets {
        let [springs, dashpots] = [quiet.springs, quiet.dashpots].map(|fix| fix as usize);
        if state.fix_active[dashpots] == is_dynamic {
            continue;
        }
        (state.fix_active[springs], state.fix_active[dashpots]) = (!is_dynamic, is_dynamic);
        let own = |(_, s): &(usize, &Support)| s.fix == quiet.springs || s.fix == quiet.dashpots;
        for (k, support) in model.supports.iter().enumerate().filter(own) {
            if support.is_dashpot() {
                state.support_force[k] = 0.0;
            } else if !is_dynamic {
                let bent = (support.preload - state.support_force[k]) / support.stiffness;
                state.support_rest[k] = support.sample(&state.displacement) - bent;
            }
        }
        if let Some(column) = quiet.column {
            let column = column as usize;
            state.columns[column] = ColumnState::at_rest(model.columns[column].node_count());
        }
    }
}

/// Moves the supports of fixities to where they are at the end of a sub-step.
pub fn move_supports(model: &Model, state: &mut State, step: &Substep) {
    for (k, fixity) in model.fixities.iter().enumerate().filter(|(_, fixity)| fixity.is_moved()) {
        let fix = k as u32;
        let way = records::fixity_velocity(model, step.regime, state, [step.time, step.dt], fix) * step.dt;
        if way == Vector::zeros() {
            continue;
        }
        let own = model.supports.iter().zip(&mut state.support_rest).filter(|(support, _)| support.fix == fix);
        own.for_each(|(support, rest)| *rest += way.dot(&support.direction));
        if let Some(port) = fixity.port {
            state.drive.moved[port as usize] += way;
        }
    }
}

/// Sets the supports for a sub-step: springs act by the position at its end (Eq. 23), dashpots by the mean of the
/// velocities before and after it (Eqs. 46, 47).
pub fn load_supports(model: &Model, state: &State, step: &Substep, motion: &MotionBuffers, rows: &mut [SupportRow]) {
    let (theta, dt) = (model.theta_in(step.dt), step.dt);
    let mut wave = (u32::MAX, Vector::zeros());
    let mut beside = model.free_field.iter().peekable();
    for row in rows {
        let k = row.support as usize;
        let support = &model.supports[k];
        row.displacement = support.sample(&state.displacement) - state.support_rest[k];
        row.approach = support.sample(&motion.predicted);
        row.force = state.support_force[k];
        let quiet = match support.resistance {
            Resistance::Spring => {
                row.target = support.preload - support.stiffness * row.displacement;
                row.viscosity = support.stiffness * theta * dt;
                if model.fixities[support.fix as usize].is_moved() {
                    let velocity = records::fixity_velocity(model, step.regime, state, [step.time, dt], support.fix);
                    row.target += row.viscosity * velocity.dot(&support.direction);
                }
                continue;
            }
            Resistance::Dashpot(quiet) => quiet,
        };
        if wave.0 != quiet {
            wave = (quiet, records::wave(model, step.regime, state, step.window, quiet));
        }
        row.viscosity = 0.5 * support.stiffness;
        row.target =
            2.0 * support.stiffness * wave.1.dot(&support.direction) - row.viscosity * support.sample(&state.velocity);
        while beside.next_if(|point| point.support < row.support).is_some() {}
        if let (Some(point), Some(column)) =
            (beside.next_if(|point| point.support == row.support), model.quiets[quiet as usize].column)
        {
            let (own, after) = (&state.columns[column as usize], &motion.columns[column as usize]);
            let velocity = point.at.sample(&own.velocity) + point.at.sample(after);
            let [a, b] = point.ends.map(|end| end.sample(&own.displacement));
            row.target += row.viscosity * velocity.dot(&support.direction) + (b - a).dot(&point.stiffness);
        }
    }
}
