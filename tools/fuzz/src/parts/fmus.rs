//! Sequences of calls of both FMUs, in and out of order: no write outside a buffer or into that of a failed call,
//! finite values, a fatal status never, and a dead instance refused.

use std::ffi::c_void;
use std::ptr::null_mut;

use enmm_fmi::log::Status;
use enmm_fmi::table::{Causality, Type, Version};

use crate::parts::calls::CASE;
use crate::parts::{Act, Outcome, finite};
use crate::random::Random;
use crate::trace::Trace;
use enmm_fuzz::buffer::Buffer;
use enmm_fuzz::fmu::{Fmu, Instance};

/// Calls of an input.
const CALLS: u64 = 80;
const STATES_MAX: usize = 4;

/// Makes an FMU of each version.
pub fn make() -> Result<Act, String> {
    let fmus = [Fmu::new(CASE, Version::Two)?, Fmu::new(CASE, Version::Three)?];
    Ok(Box::new(move |random, trace| {
        let fmu = &fmus[random.below(2)];
        trace.say(|| format!("FMI {:?}", fmu.version));
        let mut importer =
            Importer { fmu, instance: fmu.instance_with(random.chance(50))?, time: 0.0, states: Vec::new() };
        let done = (0..CALLS).try_for_each(|_| importer.act(random, trace));
        importer.instance.free();
        if importer.instance.reset() != Status::Error {
            return Err("an instance lives after its end".to_owned());
        }
        done.map(|()| Outcome::Done(CALLS))
    }))
}

/// An importer with one instance and its states, dead ones among them.
struct Importer<'a> {
    fmu: &'a Fmu,
    instance: Instance,
    time: f64,
    states: Vec<*mut c_void>,
}

impl Importer<'_> {
    fn act(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(), String> {
        let (name, status) = match random.below(20) {
            0 => self.life(random, trace)?,
            1 | 2 => self.begin(random, trace),
            3..=7 => self.step(random, trace)?,
            8..=10 => self.get(random, trace)?,
            11 => self.events(random, trace),
            12..=15 => self.set(random, trace),
            _ => self.state(random, trace)?,
        };
        trace.say(|| format!("{name}: {status:?}"));
        if status == Status::Fatal { Err(format!("{name} was fatal")) } else { Ok(()) }
    }

    /// Ends, begins anew, or takes another instance.
    fn life(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(&'static str, Status), String> {
        let which = random.below(8);
        trace.say(|| format!("life {which}"));
        Ok(match which {
            0 => ("terminate", self.instance.terminate()),
            1 => {
                let dead = self.instance;
                dead.free();
                self.instance = self.fmu.instance_with(random.chance(50))?;
                self.time = 0.0;
                if dead.enter(0.0) != Status::Error {
                    return Err("a dead instance is not refused".to_owned());
                }
                ("free", Status::Ok)
            }
            _ => {
                let status = self.instance.reset();
                self.time = if status == Status::Ok { 0.0 } else { self.time };
                ("reset", status)
            }
        })
    }

    /// One of the calls that lead to the first step, or all of them.
    fn begin(&mut self, random: &mut Random, trace: &mut Trace) -> (&'static str, Status) {
        let start = if random.chance(10) { random.wild() } else { 0.0 };
        let stop = random.chance(20).then(|| random.wild());
        let which = random.below(8);
        trace.say(|| format!("begin {which} at {start:?} to {stop:?}"));
        match which {
            0 => ("set up", self.instance.set_up(start, stop)),
            1 => ("enter", self.instance.enter(start)),
            2 => ("exit", self.instance.exit()),
            _ => {
                let _ = (self.instance.set_up(0.0, None), self.instance.enter(0.0));
                ("exit", self.instance.exit())
            }
        }
    }

    fn step(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(&'static str, Status), String> {
        let dt = self.fmu.dt;
        let h = match random.below(8) {
            0 => random.pick(&[0.0, -dt, f64::NAN, f64::INFINITY, 1e300, 5e-324, 1e-3 * dt, 1e-9 * dt]),
            _ => random.between(0.0, 20.0) * dt,
        };
        let t = if random.chance(5) { random.wild() } else { self.time };
        trace.say(|| format!("step({t:?}, {h:?})"));
        let (status, last) = self.instance.step(t, h);
        if status == Status::Ok {
            finite("time after a step", &[last])?;
            self.time = last;
        }
        Ok(("step", status))
    }

    /// References of a type, now and then a wrong one; and how many values they have.
    fn references(&self, kind: Type, causality: Option<Causality>, random: &mut Random) -> (Vec<u32>, usize) {
        let list = self.fmu.table.variables.iter();
        let list = list.filter(|v| v.kind == kind && causality.is_none_or(|wanted| v.causality == wanted));
        let list: Vec<(u32, usize)> = list.map(|v| (v.reference, v.size())).collect();
        let chosen: Vec<(u32, usize)> = (0..random.below(5))
            .map(|_| match random.below(25) {
                0 => (random.pick(&[0, 1, 5, 500, u32::MAX]), 1),
                _ if list.is_empty() => (0, 1),
                _ => random.pick(&list),
            })
            .collect();
        (chosen.iter().map(|(reference, _)| *reference).collect(), chosen.iter().map(|(_, size)| size).sum())
    }

    fn get(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(&'static str, Status), String> {
        let kinds = [Type::Real, Type::Real, Type::Real, Type::Integer, Type::Boolean, Type::String, Type::Binary];
        let kind = random.pick(&kinds);
        let three = self.fmu.version == Version::Three;
        let kind = if kind == Type::Binary && !three { Type::Real } else { kind };
        let (references, size) = self.references(kind, random.pick(&[None, Some(Causality::Output)]), random);
        let size = match self.fmu.version {
            Version::Two => references.len(),
            Version::Three if random.chance(10) => random.below(20),
            Version::Three => size,
        };
        let mut buffer = Buffer::new(size);
        if random.chance(10) && (!three || size == references.len()) {
            let order = random.pick(&[1, 1, 0, 2, -1, i32::MAX]);
            trace.say(|| format!("derivatives {order} of {references:?}"));
            let status = self.instance.derivatives(&references, order, &mut buffer);
            buffer.check("derivatives", status != Status::Ok)?;
            return Ok(("derivatives", status));
        }
        trace.say(|| format!("get {kind:?} {references:?}, {size} values"));
        let status = self.instance.get(kind, &references, &mut buffer, size);
        buffer.check("get", status != Status::Ok)?;
        let finite_ones = self.fmu.outputs();
        let are_finite = references.iter().all(|wanted| finite_ones.iter().any(|(reference, _)| reference == wanted));
        if status == Status::Ok && kind == Type::Real && are_finite {
            finite("outputs", &buffer.numbers(size))?;
        }
        Ok(("get", status))
    }

    fn set(&mut self, random: &mut Random, trace: &mut Trace) -> (&'static str, Status) {
        let kind = random.pick(&[Type::Real, Type::Real, Type::Real, Type::Integer, Type::Boolean]);
        let causality = random.pick(&[Causality::Input, Causality::Input, Causality::Parameter, Causality::Output]);
        let (references, size) = self.references(kind, Some(causality), random);
        let start = references.first().and_then(|&reference| self.fmu.table.get(reference)?.start).unwrap_or_default();
        let parameter = causality == Causality::Parameter;
        // Parameters far from their start values, though legal, make models that take hours to come to rest.
        let value = |random: &mut Random| match random.below(8) {
            0 if parameter => random.pick(&[f64::NAN, f64::INFINITY, -1.0, -0.0]),
            0 => random.wild(),
            _ if parameter => start * random.between(0.8, 1.25),
            _ => random.between(-10.0, 10.0),
        };
        let size = match self.fmu.version {
            Version::Two => references.len(),
            Version::Three if random.chance(10) => random.below(20),
            Version::Three => size,
        };
        let values: Vec<f64> = (0..size).map(|_| value(random)).collect();
        trace.say(|| format!("set {kind:?} {causality:?} {references:?} to {values:?}"));
        ("set", self.instance.set(kind, &references, &values))
    }

    /// Ramps of FMI 2, modes of FMI 3.
    fn events(&mut self, random: &mut Random, trace: &mut Trace) -> (&'static str, Status) {
        if self.fmu.version == Version::Three {
            let is_event = random.chance(30);
            trace.say(|| format!("event mode {is_event}"));
            return ("mode", self.instance.enter_mode(is_event));
        }
        let causality = random.pick(&[Causality::Input, Causality::Input, Causality::Output]);
        let (references, _) = self.references(Type::Real, Some(causality), random);
        let rates: Vec<f64> = references
            .iter()
            .map(|_| if random.chance(10) { random.wild() } else { random.between(-10.0, 10.0) })
            .collect();
        let order = if random.chance(90) { 1 } else { random.pick(&[0, 2, -1]) };
        trace.say(|| format!("rates {order} of {references:?}: {rates:?}"));
        ("rates", self.instance.set_rates(&references, order, &rates))
    }

    fn state(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(&'static str, Status), String> {
        let (which, k) = (random.below(5), random.below(self.states.len()));
        let mut state = if random.chance(8) {
            std::ptr::without_provenance_mut(random.pick(&[0, 1, 77, usize::MAX]))
        } else {
            self.states.get(k).copied().unwrap_or(null_mut())
        };
        trace.say(|| format!("state {which}: {:x}", state.addr()));
        Ok(match which {
            0 => {
                let mut state = if random.chance(80) { null_mut() } else { state };
                let status = self.instance.save(&mut state);
                if status == Status::Ok && self.states.len() < STATES_MAX {
                    self.states.push(state);
                }
                ("save", status)
            }
            1 => ("free state", self.instance.free_state(&mut state)),
            2 | 3 => {
                let status = self.instance.restore(state);
                if status == Status::Ok {
                    self.time = self.fmu.time(self.instance).unwrap_or(self.time);
                }
                ("restore", status)
            }
            _ => match self.instance.bytes(state) {
                Err(status) => ("serialize", status),
                Ok(mut bytes) => {
                    let spoilt = random.chance(50);
                    if spoilt {
                        let at = random.below(bytes.len());
                        bytes[at] ^= 1 << random.below(8);
                    }
                    let (status, made) = self.instance.unpack(&bytes);
                    if (status == Status::Ok) == spoilt || (status == Status::Ok) == made.is_null() {
                        return Err(format!("bytes (spoilt: {spoilt}) gave {status:?} and the state {made:?}"));
                    }
                    ("deserialize", status)
                }
            },
        })
    }
}
