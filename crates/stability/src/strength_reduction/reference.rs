//! The slope at rest before its strength is reduced.

use super::slip::slide;
use super::{HELD, ReductionError, ReductionOptions};
use crate::{left_out_stages, with_support_forces};
use enmm::model::Simulation;
use enmm::model::assemble::{TraceEnd, locked_ends};
use enmm::model::case::{Case, Invalid, Stage, StageKind};
use enmm::model::settle::REST_STEPS;

/// Name of the stage of the trials.
const TRIAL: &str = "strength reduction";
/// Damping ratio of the deformation of blocks in trials: none of it acts on rigid motion. With less, columns that are
/// near their limit flutter: friction is no force of a potential, and a block that hops slips for less.
const DAMPING: f64 = 1.0;
/// The same where rock yields, so that a failure by deformation is not held up.
const DAMPING_YIELDING: f64 = 0.01;

/// Greatest stiffness of whole rock that yields, over the weight γH of the model: the limit does not depend on it, but
/// on a mesh the factor of stiffer rock is too high, and its trials take longer (theory, section 16).
const STIFFEST: f64 = 500.0;

/// A slope at rest in a dynamic stage of no end.
pub struct Rest {
    /// At the start of the trials' stage.
    pub simulation: Simulation,
    /// Time (s) and steps that it took.
    pub effort: (f64, u64),
    /// Warnings about what was left out.
    pub warnings: Vec<String>,
}

/// Remedy for a slope that does not come to rest.
fn remedy(case: &Case) -> &'static str {
    let weightless = [case.gravity.x, case.gravity.y] == [0.0; 2];
    if weightless && case.loads.is_empty() && case.in_situ.is_none() {
        "neither gravity nor a load acts, so that all forces are round-off; give one of them"
    } else {
        "lengthen the stage's duration, or hold or excavate the blocks that are loose"
    }
}

/// Runs the static stages that the case begins with, with joints and rock that hold: so all trials start from one
/// state, whatever the strength of the case.
///
/// # Errors
/// No static stage, a case that cannot be built, or no rest.
pub fn settle(case: &Case, options: &ReductionOptions) -> Result<Rest, ReductionError> {
    let (case, mut warnings) = trial_case(case)?;
    let mut simulation = Simulation::with_integrators(case, options.integrators, &mut |_| ())?;
    refuse_locked(&simulation)?;
    let drive = simulation.drive();
    (drive.from.strength_factor, drive.to.strength_factor) = (HELD, HELD);
    while simulation.stage().kind == StageKind::Static {
        let outcome = simulation.run_stage_with(REST_STEPS, options.interrupt).map_err(ReductionError::Failed)?;
        let report = outcome.ok_or(ReductionError::Interrupted)?;
        if !simulation.at_rest(&report) {
            let (stage, time) = (simulation.stage().name.clone(), simulation.time());
            let (unbalanced, remedy) = (report.unbalanced, remedy(simulation.case()));
            return Err(ReductionError::NotAtRest { stage, time, unbalanced, remedy });
        }
        let name = &simulation.stage().name;
        warnings.extend(simulation.unsettled_apertures().map(|doubt| format!("stage {name:?}: {doubt}")));
        simulation.next_stage()?;
    }
    warnings.extend(slide(&simulation).map(|slip| {
        format!(
            "the static stages make joints slip by {slip:.3} m whatever their strength, so blocks have gaps or loads \
             that move them first: the factor is that of the slope after this slip"
        )
    }));
    warnings.extend(simulation.built().warnings.iter().cloned());
    let effort = (simulation.time(), simulation.state().step);
    Ok(Rest { simulation, effort, warnings })
}

/// Ends of joints that the refusal names.
const NAMED: usize = 5;

/// Refuses rock that yields and locks: at an end of a joint, too short for the mesh.
fn refuse_locked(simulation: &Simulation) -> Result<(), Invalid> {
    let size = simulation.case().mesh.size;
    let ends = locked_ends(simulation.case(), simulation.built())?;
    let Some(least) = ends.iter().map(|end| end.gap).min_by(f64::total_cmp) else { return Ok(()) };
    let tell = |TraceEnd { name, place, gap, line, meets, .. }: &TraceEnd| {
        format!(
            "{gap:.3} m from the end of {name} at [{:.6}, {:.6}] to {line} at [{:.6}, {:.6}]",
            place.x, place.y, meets.x, meets.y
        )
    };
    let named: Vec<String> = ends.iter().take(NAMED).map(tell).collect();
    let more = ends.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let message = format!(
        "is {size} m, so that fewer than two elements of rock that yields lie between the end of a joint and \
         another one, which cannot shear through and hold too much: {}{more}; give a `[[bridge]]` between these \
         points whose law has the strength of the rock (or `domain.bridge_law` for all that are shorter than \
         `domain.near_ends`, `bridge_law` of a joint set for its gaps), or a mesh of {:.6} m or finer",
        named.join(", "),
        0.5 * least
    );
    Err(Invalid { key: "mesh.size".to_owned(), message })
}

/// The case without its dynamic stages, and with a stage for the trials at its end.
fn trial_case(case: &Case) -> Result<(Case, Vec<String>), Invalid> {
    let mut case = with_support_forces(case);
    let mut warnings = Vec::new();
    let count = case.stages.iter().take_while(|stage| stage.kind == StageKind::Static).count();
    if count == 0 {
        return Err(Invalid {
            key: "stage[0].kind".into(),
            message: "is \"dynamic\", but a slope must be at rest before its strength is reduced: begin with a stage \
                      of kind \"static\""
                .into(),
        });
    }
    warnings.extend(left_out_stages(&case));
    case.keep_stages(count);
    if !case.base_motions.is_empty() || case.quiets.iter().any(|quiet| quiet.wave.is_some()) {
        warnings.push("base motion and waves are left out: give a seismic coefficient as a load of kind body".into());
        case.base_motions.clear();
    }
    case.hold_quiet_edges();
    if case.loads.iter().any(|load| load.table.is_some()) {
        warnings.push("loads with time tables go on changing during the trials".into());
    }
    // A slide that has begun must not be caught by the water that it leaves behind.
    case.flow.iter_mut().for_each(|flow| flow.part = Some(0.0));
    // Rock that yields and that no joint cuts has the stiffness of its trials; the ratios between rocks stay.
    let least = case.least_stiffness().filter(|least| case.is_whole() && *least > STIFFEST);
    let share = least.map_or(1.0, |least| STIFFEST / least);
    case.rocks.values_mut().for_each(|rock| rock.young *= share);
    // Delayed friction holds toppling columns at 2.5 % less than their limit.
    case.solver.friction_delay.get_or_insert(0.0);
    let damping = Some(if case.yields() { DAMPING_YIELDING } else { DAMPING });
    case.stages.push(Stage { damping, ..Stage::plain(&case.stages, TRIAL, StageKind::Dynamic, 1e9) });
    Ok((case, warnings))
}
