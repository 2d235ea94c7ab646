//! Many models, or many states of one model, in one call.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use engine::cosimulation::limits::THREADS_MAX;
use engine::cosimulation::{Rollout, Saved};

use super::enter::with_model;
use super::failure::{Failure, Outcome, last_text};
use super::model::Model;
use super::state::{Kept, STATES};
use crate::types::enmm_status;

/// Status of an outcome.
pub fn status_of(outcome: &Outcome) -> enmm_status {
    match outcome {
        Ok(()) => enmm_status::ENMM_OK,
        Err(failure) => failure.status,
    }
}

/// Advances every model by `h` (s) on some threads.
///
/// # Errors
/// No thread, or too many; what happens to a model is in its outcome.
pub fn step_all(handles: &[usize], h: f64, threads: usize) -> Result<Vec<Outcome>, Failure> {
    if !(1..=THREADS_MAX).contains(&threads) {
        return Err(Failure::invalid(format!("threads: is {threads}, must be at least 1 and at most {THREADS_MAX}")));
    }
    let outcomes: Mutex<Vec<Outcome>> = Mutex::new(handles.iter().map(|_| Ok(())).collect());
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some((k, handle)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, handles.get(k)?)))
        {
            let outcome = step(*handle, h);
            if let Ok(mut outcomes) = outcomes.lock() {
                outcomes[k] = outcome;
            }
        }
    };
    match threads.min(handles.len()) {
        0 | 1 => work(),
        threads => std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(work))),
    }
    Ok(outcomes.into_inner().unwrap_or_default())
}

/// Advances a model from where it stands.
fn step(handle: usize, h: f64) -> Outcome {
    let status = with_model(handle, |model| model.do_step(model.inner.time(), h).map(|_| ()));
    if status == enmm_status::ENMM_OK { Ok(()) } else { Err(Failure::new(status, last_text())) }
}

/// Samples as a host gives them.
pub struct Plan<'a> {
    /// Number of samples.
    pub samples: usize,
    /// Handles of states.
    pub states: Vec<usize>,
    /// Parameters.
    pub parameters: Vec<u32>,
    /// Their values, sample by sample.
    pub values: &'a [f64],
    /// Communication step (s).
    pub step: f64,
    /// Number of steps.
    pub steps: usize,
    /// Port of each output.
    pub ports: &'a [u32],
    /// Quantity of each output.
    pub quantities: &'a [u32],
    /// Number of threads.
    pub threads: usize,
}

impl Plan<'_> {
    /// Number of all outputs, at most the largest number that there is.
    pub fn output_count(&self) -> usize {
        self.samples.saturating_mul(self.steps).saturating_mul(self.ports.len())
    }
}

/// Outputs and outcomes of samples.
pub struct Made {
    /// Outputs, sample by sample.
    pub outputs: Vec<f64>,
    /// Outcome of each sample.
    pub failures: Vec<Outcome>,
}

impl Model {
    /// Takes samples on from their states.
    ///
    /// # Errors
    /// A dead state, or numbers that do not fit.
    pub fn roll_out(&self, plan: &Plan) -> Result<Made, Failure> {
        self.interrupt.clear();
        let kept: Vec<Arc<Kept>> = plan.states.iter().map(|handle| STATES.find(*handle)).collect::<Result<_, _>>()?;
        let states: Vec<&Saved> = kept.iter().map(|kept| kept.saved()).collect();
        let parameters: Vec<usize> = plan.parameters.iter().map(|k| *k as usize).collect();
        let outputs: Vec<(usize, usize)> =
            plan.ports.iter().zip(plan.quantities).map(|(port, place)| (*port as usize, *place as usize)).collect();
        let Plan { samples, values, step, steps, threads, .. } = *plan;
        let plan = Rollout {
            samples,
            states: &states,
            parameters: &parameters,
            values,
            step,
            steps,
            outputs: &outputs,
            threads,
        };
        let made = self.inner.roll_out(&plan, &|| Some(self.interrupt.watch(None)))?;
        let failures = made.failures.into_iter().map(|failure| failure.map_or(Ok(()), |error| Err(error.into())));
        Ok(Made { outputs: made.outputs, failures: failures.collect() })
    }
}
