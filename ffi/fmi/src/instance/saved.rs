//! Saved states of an instance. The importer holds numbers, so that one that is freed or foreign is recognised.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use enmm::cosimulation::Saved;
use enmm::model::bytes::{self, Keeper};
use serde::{Deserialize, Serialize};

use crate::log::{Category, Status};
use crate::phase::{Call, Phase};

use super::ramps::Rate;
use super::{Experiment, Failure, Instance, same_bits};

/// All that an instance needs to go on with the same bits, in this process or another.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Whole {
    model: Saved,
    phase: u16,
    start: f64,
    stop: Option<f64>,
    time: f64,
    values: Vec<f64>,
    /// Parameters of the model that `model` is a state of.
    built: Vec<f64>,
    rates: Vec<Rate>,
}

#[derive(Debug)]
struct Entry {
    state: Whole,
    /// Its bytes, from the question for their number on.
    bytes: Option<Vec<u8>>,
}

/// Saved states by number.
#[derive(Debug, Default)]
pub(super) struct SavedStates {
    entries: BTreeMap<usize, Entry>,
}

/// Numbers are unique in the process, so that a state of one instance is foreign to all others.
static NEXT: AtomicUsize = AtomicUsize::new(1);

impl SavedStates {
    fn put(&mut self, number: Option<usize>, state: Whole) -> Result<usize, Failure> {
        let number = match number {
            Some(number) => self.entry(number).map(|_| number)?,
            None => NEXT.fetch_add(1, Ordering::Relaxed),
        };
        self.entries.insert(number, Entry { state, bytes: None });
        Ok(number)
    }

    fn entry(&mut self, number: usize) -> Result<&mut Entry, Failure> {
        self.entries.get_mut(&number).ok_or_else(|| {
            "the saved state is no state of this instance, or has been freed: get or deserialize one".to_owned()
        })
    }
}

impl Instance {
    /// getFMUState: saves the state under a new number, or over the state that has the `number`.
    ///
    /// # Errors
    /// The status of the call; the instance is as before.
    pub fn save_state(&mut self, number: Option<usize>) -> Result<usize, Status> {
        let legal = self.allow(Call::State);
        let outcome = legal.and_then(|()| {
            let state = self.whole();
            self.states.put(number, state)
        });
        outcome.map_err(|failure| self.complain(failure))
    }

    fn whole(&self) -> Whole {
        Whole {
            phase: self.phase as u16,
            start: self.experiment.start,
            stop: self.experiment.stop,
            time: self.time,
            values: self.values.all.clone(),
            built: self.built.clone(),
            rates: self.rates.clone(),
            model: self.model.save(),
        }
    }

    /// setFMUState.
    pub fn restore_state(&mut self, number: usize) -> Status {
        let legal = self.allow(Call::State);
        let outcome = legal.and_then(|()| {
            let entries = std::mem::take(&mut self.states.entries);
            let mut saved = SavedStates { entries };
            let taken = saved.entry(number).and_then(|entry| self.take_whole(&entry.state));
            self.states = saved;
            taken
        });
        match outcome {
            Ok(()) => Status::Ok,
            Err(failure) => self.complain(failure),
        }
    }

    /// Everything that can fail comes before the first change of values or model; threads change no result.
    fn take_whole(&mut self, state: &Whole) -> Result<(), Failure> {
        let phase = self.check_whole(state)?;
        let values = self.values.with(&state.values);
        let rests = matches!(phase, Phase::Instantiated | Phase::Initialization);
        let threads = if rests { self.threads } else { values.threads(&self.table) };
        if same_bits(&state.built, &self.built) {
            self.use_threads(threads)?;
            self.model.restore(&state.model).map_err(|error| error.to_string())?;
        } else {
            let (case, mut model) = self.model_of(&state.built)?;
            model.set_threads(threads).map_err(|error| error.to_string())?;
            model.restore(&state.model).map_err(|error| error.to_string())?;
            if let Err(failure) = self.end_record() {
                self.log(Status::Warning, Category::Warning, failure);
            }
            self.take_model(case, model, state.built.clone());
            self.threads = threads;
        }
        self.cache.clear();
        self.values = values;
        self.rates.clone_from(&state.rates);
        self.phase = phase;
        self.time = state.time;
        self.experiment = Experiment { start: state.start, stop: state.stop };
        Ok(())
    }

    /// Whether all that a state from outside holds can be of this FMU.
    fn check_all(&self, state: &mut Whole) -> Result<(), Failure> {
        self.check_whole(state)?;
        let times =
            [("start time", state.start), ("stop time", state.stop.unwrap_or(state.start)), ("time", state.time)];
        for (what, time) in times {
            if !time.is_finite() {
                return Err(format!("the {what} of the saved state is {time} s, must be finite: use another one"));
            }
        }
        self.values.with(&state.values).check(&self.table).map_err(|problem| format!("the saved state: {problem}"))?;
        self.check_rates(&state.rates).map_err(|problem| format!("the saved state: {problem}"))?;
        let other = if same_bits(&state.built, &self.built) { None } else { Some(self.model_of(&state.built)?.1) };
        other.as_ref().unwrap_or(&self.model).check(&mut state.model).map_err(|error| error.to_string())
    }

    fn check_whole(&self, state: &Whole) -> Result<Phase, Failure> {
        let fits = state.values.len() == self.values.all.len() && state.built.len() == self.built.len();
        let phase =
            Phase::of(state.phase).filter(|phase| fits && !matches!(phase, Phase::Intermediate | Phase::Stepping));
        phase.ok_or_else(|| "the saved state is of another FMU: use one of this".to_owned())
    }

    /// freeFMUState.
    pub fn free_state(&mut self, number: usize) -> Status {
        let legal = self.allow(Call::State);
        match legal.and_then(|()| self.states.entry(number).map(|_| ())) {
            Ok(()) => {
                self.states.entries.remove(&number);
                Status::Ok
            }
            Err(failure) => self.complain(failure),
        }
    }

    /// Bytes of a saved state: the container of [`bytes`] with the token of the FMU for a fingerprint.
    ///
    /// # Errors
    /// The status of the call; the instance is as before.
    pub fn serialize_state(&mut self, number: usize) -> Result<&[u8], Status> {
        if let Err(failure) = self.allow(Call::State).and_then(|()| self.encode(number)) {
            return Err(self.complain(failure));
        }
        let bytes = self.states.entries.get(&number).and_then(|entry| entry.bytes.as_deref());
        Ok(bytes.unwrap_or_default())
    }

    fn encode(&mut self, number: usize) -> Result<(), Failure> {
        let token = &self.table.token;
        let entry = self.states.entry(number)?;
        if entry.bytes.is_none() {
            entry.bytes = Some(bytes::encode(Keeper::Fmu, &entry.state, token).map_err(|error| error.to_string())?);
        }
        Ok(())
    }

    /// Makes a saved state of bytes, under a new number or over the state that has the `number`.
    ///
    /// # Errors
    /// The status of the call; the instance is as before.
    pub fn deserialize_state(&mut self, bytes: &[u8], number: Option<usize>) -> Result<usize, Status> {
        let legal = self.allow(Call::State);
        let outcome = legal.and_then(|()| {
            let decoded = bytes::decode(Keeper::Fmu, bytes, &self.table.token);
            let mut state: Whole = decoded.map_err(|error| format!("these bytes are no state of this FMU: {error}"))?;
            self.check_all(&mut state)?;
            self.states.put(number, state)
        });
        outcome.map_err(|failure| self.complain(failure))
    }

    /// Fails a call about saved states for a reason that the entry point has found; the instance is as before.
    pub fn refuse_state(&mut self, reason: &str) -> Status {
        self.complain(reason.to_owned())
    }
}
