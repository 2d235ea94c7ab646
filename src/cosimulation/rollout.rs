//! Many ways on from saved states of one model, each with parameters of its own: outputs of ports over time, on several
//! threads and with the same bits on any number of them.

use std::sync::Mutex;

use super::{Cosimulation, CosimulationError, PORT_QUANTITIES, PortState, Saved, Watch, limits};

/// Most outputs of one call: 8 GiB.
const OUTPUTS_MAX: usize = 1 << 30;

/// Samples that go on from saved states.
#[derive(Debug, Clone, Copy)]
pub struct Rollout<'a> {
    /// Number of samples.
    pub samples: usize,
    /// State from which each sample goes on, or one for all of them.
    pub states: &'a [&'a Saved],
    /// Parameters that are set in each sample, by their indices.
    pub parameters: &'a [usize],
    /// Their values, those of one sample after those of another.
    pub values: &'a [f64],
    /// Communication step (s).
    pub step: f64,
    /// Number of communication steps.
    pub steps: usize,
    /// Outputs that are read after each of them: a port, and a place in [`PORT_QUANTITIES`].
    pub outputs: &'a [(usize, usize)],
    /// Number of threads.
    pub threads: usize,
}

impl Rollout<'_> {
    /// Number of all outputs; none when they could not be counted.
    pub fn output_count(&self) -> Option<usize> {
        self.samples.checked_mul(self.steps)?.checked_mul(self.outputs.len())
    }
}

/// Outputs of samples.
#[derive(Debug)]
pub struct RolledOut {
    /// Outputs, those of one step after those of another, sample by sample; not a number behind a failure.
    pub outputs: Vec<f64>,
    /// Failure of each sample, if it has failed.
    pub failures: Vec<Option<CosimulationError>>,
}

impl Cosimulation {
    /// Takes every sample on from its state, with its parameters; this model stays as it is. `watch` makes what looks
    /// at the steps of a thread and may end them.
    ///
    /// # Errors
    /// Numbers that do not fit each other, or a port, a parameter or an output that does not exist. A sample that fails
    /// has its failure in the result.
    pub fn roll_out(
        &self,
        plan: &Rollout,
        watch: &(dyn Fn() -> Option<Watch> + Sync),
    ) -> Result<RolledOut, CosimulationError> {
        self.check_plan(plan)?;
        let size = plan.steps * plan.outputs.len();
        let mut result = RolledOut { outputs: vec![f64::NAN; plan.samples * size], failures: Vec::new() };
        result.failures.resize_with(plan.samples, || None);
        let rooms = result.outputs.chunks_mut(size.max(1)).zip(&mut result.failures).enumerate();
        let rooms = Mutex::new(rooms);
        let next = || rooms.lock().map_or(None, |mut rooms| rooms.next());
        let work = || {
            let copy = || {
                let mut copy = self.clone();
                copy.set_watch(watch());
                copy
            };
            let mut model = copy();
            while let Some((sample, (out, failure))) = next() {
                // Parameters of a model that has not started are those of another build.
                if model.hash != self.hash {
                    model = copy();
                }
                *failure = model.go_on(plan, sample, out).err();
            }
        };
        match plan.threads.min(plan.samples) {
            0 => {}
            1 => work(),
            threads => std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(work))),
        }
        Ok(result)
    }

    /// Goes through one sample; behind a failure its outputs stay as they are.
    fn go_on(&mut self, plan: &Rollout, sample: usize, out: &mut [f64]) -> Result<(), CosimulationError> {
        self.restore(plan.states[sample.min(plan.states.len() - 1)])?;
        let count = plan.parameters.len();
        let values = &plan.values[sample * count..(sample + 1) * count];
        let parameters: Vec<(usize, f64)> = plan.parameters.iter().copied().zip(values.iter().copied()).collect();
        self.set_parameters(&parameters)?;
        for row in out.chunks_mut(plan.outputs.len().max(1)) {
            self.do_step(self.time(), plan.step)?;
            self.read_row(plan.outputs, row);
        }
        Ok(())
    }

    /// Reads outputs; a port that has several is looked at once where they follow one another.
    fn read_row(&self, outputs: &[(usize, usize)], row: &mut [f64]) {
        let mut seen: Option<(usize, bool, PortState)> = None;
        for (value, &(port, place)) in row.iter_mut().zip(outputs) {
            let quantity = &PORT_QUANTITIES[place];
            let with_stress = quantity.name.starts_with("stress");
            let state = match seen {
                Some((of, has_stress, state)) if of == port && (has_stress || !with_stress) => state,
                _ if with_stress => self.port_state(port),
                _ => self.port_motion(port),
            };
            seen = Some((port, with_stress || seen.is_some_and(|(of, has, _)| of == port && has), state));
            *value = (quantity.get)(&state);
        }
    }

    fn check_plan(&self, plan: &Rollout) -> Result<(), CosimulationError> {
        let refuse = |name: &str, value: usize, limit: String, remedy| {
            Err(CosimulationError::value(name, value, &limit, remedy))
        };
        if plan.states.len() != 1 && plan.states.len() != plan.samples {
            let limit = format!("1 or the number of samples, {}", plan.samples);
            return refuse("states", plan.states.len(), limit, "give one for all samples or one for each");
        }
        if Some(plan.values.len()) != plan.samples.checked_mul(plan.parameters.len()) {
            let limit = format!("{} samples times {} parameters", plan.samples, plan.parameters.len());
            return refuse("values", plan.values.len(), limit, "give each sample a value of each parameter");
        }
        if plan.output_count().is_none_or(|count| count > OUTPUTS_MAX) {
            let limit = format!("at most {OUTPUTS_MAX} outputs of all samples and steps");
            return refuse("samples", plan.samples, limit, "take fewer samples or steps at a time");
        }
        if plan.threads == 0 || plan.threads > limits::THREADS_MAX {
            let limit = format!("at least 1 and at most {}", limits::THREADS_MAX);
            return refuse("threads", plan.threads, limit, "as many as processors suit");
        }
        for &(port, place) in plan.outputs {
            self.port(port)?;
            if place >= PORT_QUANTITIES.len() {
                let limit = format!("less than the number of quantities of ports, {}", PORT_QUANTITIES.len());
                return refuse("quantity", place, limit, "count the members of the state of a port from 0");
            }
        }
        Ok(())
    }
}
