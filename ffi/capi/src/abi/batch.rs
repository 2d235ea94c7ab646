//! Many models, or many states of one model, in one call.

use super::pointers;
use crate::safe::batch;
use crate::safe::enter::{guard, with_model};
use crate::types::{enmm_model, enmm_rollout_plan, enmm_status};

/// Advances `n` models by `h` (s) each from the time at which it stands, on `threads` threads; the bits are those of
/// enmm_do_step. `statuses` gets the status of each, and may be NULL; a model that fails is as before, others go on.
/// Messages go out on the threads that step the models.
///
/// Errors: the first status of a model that is not ENMM_OK, whose message enmm_last_error returns;
/// ENMM_INVALID_ARGUMENT for a number of threads that is not 1 to 1024; ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_batch_step(
    models: *const *mut enmm_model,
    n: usize,
    h: f64,
    threads: usize,
    statuses: *mut i32,
) -> enmm_status {
    guard(|| {
        // SAFETY: promised by the host.
        let handles: Vec<usize> = unsafe { pointers::slice("models", models, n)? }.iter().map(|m| m.addr()).collect();
        let outcomes = batch::step_all(&handles, h, threads)?;
        if !statuses.is_null() {
            for (k, outcome) in outcomes.iter().enumerate() {
                // SAFETY: promised by the host: as many numbers as models.
                unsafe { pointers::write("statuses", statuses.add(k), batch::status_of(outcome) as i32)? };
            }
        }
        outcomes.into_iter().collect()
    })
}

/// Takes samples of one model on from saved states, each with parameters of its own, and writes outputs of ports after
/// every communication step. The model stays as it is; the bits are those of the same calls one by one.
///
/// `out` holds `capacity` numbers, samples * steps * outputs of the plan: those of one step after those of another,
/// sample by sample. Behind the failure of a sample they are not a number. `statuses` gets the status of each sample,
/// and may be NULL. enmm_interrupt ends all samples.
///
/// Errors: ENMM_BUFFER_TOO_SMALL; ENMM_INVALID_ARGUMENT for a plan whose numbers do not fit, ENMM_DEAD_HANDLE for a
/// state that is not there, ENMM_NULL_ARGUMENT. The failure of a sample is in its status alone.
///
/// # Safety
/// Every pointer is as the head of the header states, those of the plan as it states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_rollout(
    model: *mut enmm_model,
    plan: *const enmm_rollout_plan,
    out: *mut f64,
    capacity: usize,
    statuses: *mut i32,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        let plan = unsafe { pointers::read_struct(plan)? };
        // SAFETY: promised by the host.
        let plan = unsafe {
            batch::Plan {
                samples: plan.samples,
                states: pointers::slice("states", plan.states, plan.state_count)?.iter().map(|s| s.addr()).collect(),
                parameters: pointers::slice("parameters", plan.parameters, plan.parameter_count)?.to_vec(),
                values: pointers::slice("values", plan.values, plan.samples.saturating_mul(plan.parameter_count))?,
                step: plan.step,
                steps: plan.steps,
                ports: pointers::slice("ports", plan.ports, plan.output_count)?,
                quantities: pointers::slice("quantities", plan.quantities, plan.output_count)?,
                threads: plan.threads,
            }
        };
        pointers::check_capacity(plan.output_count(), capacity)?;
        let made = model.roll_out(&plan)?;
        // SAFETY: promised by the host: as many numbers as samples.
        unsafe {
            if !statuses.is_null() {
                for (k, failure) in made.failures.iter().enumerate() {
                    pointers::write("statuses", statuses.add(k), batch::status_of(failure) as i32)?;
                }
            }
            let mut written = 0;
            pointers::fill(&made.outputs, out, capacity, &raw mut written)
        }
    })
}
