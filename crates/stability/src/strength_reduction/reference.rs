//! The slope at rest before its strength is reduced.

use super::slip::slide;
use super::{FACTOR_RANGE, ReductionError, ReductionOptions};
use crate::left_out_stages;
use enmm::model::Simulation;
use enmm::model::case::{Case, Invalid, Stage, StageKind};
use enmm::model::settle::REST_STEPS;
use enmm::step::StepError;

/// Name of the stage of the trials.
const TRIAL: &str = "strength reduction";
/// Damping ratio of the deformation of blocks in trials: none of it acts on rigid motion. With less, columns that are
/// near their limit flutter: friction is no force of a potential, and a block that hops slips for less.
const DAMPING: f64 = 1.0;
/// The same where rock yields, so that a failure by deformation is not held up.
const DAMPING_YIELDING: f64 = 0.01;

/// A slope at rest in a dynamic stage of no end.
pub struct Rest {
    /// At the start of the trials' stage.
    pub simulation: Simulation,
    /// Factor on the strength under which it came to rest.
    pub factor: f64,
    /// Time (s) and steps that it took.
    pub effort: (f64, u64),
    /// Warnings about what was left out.
    pub warnings: Vec<String>,
}

/// How the static stages went.
enum Settled {
    AtRest(Box<Simulation>),
    /// At rest, but by a slip (m) that is a failure: blocks slid until others caught them.
    Caught(Box<Simulation>, f64),
    NotAtRest {
        stage: String,
        time: f64,
        unbalanced: f64,
        failure: Option<StepError>,
    },
}

/// Runs the static stages that the case begins with; when they do not come to rest, or only after a failure, with ever
/// more strength.
///
/// # Errors
/// No static stage, a case that cannot be built, or no rest.
pub fn settle(case: &Case, options: &ReductionOptions) -> Result<Rest, ReductionError> {
    let (case, mut warnings) = trial_case(case)?;
    let mut factor = 1.0;
    let mut first_caught = None;
    loop {
        let is_last = 2.0 * factor * FACTOR_RANGE[0] > 1.0;
        match settle_with(&case, factor, options)? {
            Settled::AtRest(simulation) => {
                if let Some((_, _, slip)) = first_caught {
                    warnings.push(caught_at_rest(slip, factor));
                } else if factor > 1.0 {
                    warnings.push(format!(
                        "the slope does not come to rest with its own strength, only with {factor} times as much"
                    ));
                }
                return Ok(rest(*simulation, factor, warnings));
            }
            Settled::Caught(simulation, slip) => {
                let (simulation, least, slip) = first_caught.take().unwrap_or((simulation, factor, slip));
                if is_last {
                    warnings.push(slips_anyhow(slip));
                    return Ok(rest(*simulation, least, warnings));
                }
                first_caught = Some((simulation, least, slip));
                factor *= 2.0;
            }
            Settled::NotAtRest { stage, time, unbalanced, failure } if is_last => {
                return Err(match failure {
                    Some(error) => ReductionError::Failed(error),
                    None => ReductionError::NotAtRest { stage, time, factor, unbalanced },
                });
            }
            Settled::NotAtRest { .. } => factor *= 2.0,
        }
    }
}

/// The rest from which trials start; the warnings of the model follow its own.
fn rest(simulation: Simulation, factor: f64, mut warnings: Vec<String>) -> Rest {
    warnings.extend(simulation.built().warnings.iter().cloned());
    let effort = (simulation.time(), simulation.state().step);
    Rest { simulation, factor, effort, warnings }
}

fn caught_at_rest(slip: f64, factor: f64) -> String {
    format!(
        "with its own strength the slope rests only after a slip of {slip:.3} m, which is a failure that other rock \
         stopped: trials start from the slope at rest with {factor} times its strength"
    )
}

fn slips_anyhow(slip: f64) -> String {
    format!(
        "the static stages make joints slip by {slip:.3} m whatever their strength, so blocks have gaps or loads that \
         move them first: the factor is that of the slope after this slip"
    )
}

/// The case without its dynamic stages, and with a stage for the trials at its end.
fn trial_case(case: &Case) -> Result<(Case, Vec<String>), Invalid> {
    let mut case = case.clone();
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
    case.stages.truncate(count);
    if !case.base_motions.is_empty() || case.quiets.iter().any(|quiet| quiet.wave.is_some()) {
        warnings.push("base motion and waves are left out: give a seismic coefficient as a load of kind body".into());
        case.base_motions.clear();
        case.quiets.iter_mut().for_each(|quiet| (quiet.wave, quiet.table, quiet.file) = (None, None, None));
    }
    case.quiets.iter_mut().for_each(|quiet| quiet.stage = None);
    if case.loads.iter().any(|load| load.table.is_some()) {
        warnings.push("loads with time tables go on changing during the trials".into());
    }
    let damping = Some(if case.yields() { DAMPING_YIELDING } else { DAMPING });
    case.stages.push(Stage { damping, ..Stage::plain(&case.stages, TRIAL, StageKind::Dynamic, 1e9) });
    Ok((case, warnings))
}

/// Runs all static stages with a factor on the strength.
fn settle_with(case: &Case, factor: f64, options: &ReductionOptions) -> Result<Settled, ReductionError> {
    let mut simulation = Simulation::with_integrators(case.clone(), options.integrators, &mut |_| ())?;
    let drive = simulation.drive();
    (drive.from.strength_factor, drive.to.strength_factor) = (factor, factor);
    let mut caught: Option<f64> = None;
    while simulation.stage().kind == StageKind::Static {
        let outcome = simulation.run_stage_with(REST_STEPS, options.interrupt);
        let (time, stage) = (simulation.time(), simulation.stage().name.clone());
        match outcome {
            Ok(None) => return Err(ReductionError::Interrupted),
            Ok(Some(report)) if simulation.at_rest(&report) => {}
            Ok(Some(report)) => {
                return Ok(Settled::NotAtRest { stage, time, unbalanced: report.unbalanced, failure: None });
            }
            Err(error) => return Ok(Settled::NotAtRest { stage, time, unbalanced: f64::NAN, failure: Some(error) }),
        }
        // A later stage may install bolts across a joint that has slipped before.
        caught = slide(&simulation).map(|slip| slip.max(caught.unwrap_or(slip))).or(caught);
        simulation.next_stage()?;
    }
    let simulation = Box::new(simulation);
    Ok(match caught {
        Some(slip) => Settled::Caught(simulation, slip),
        None => Settled::AtRest(simulation),
    })
}
