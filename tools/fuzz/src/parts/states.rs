//! Damaged states whose checksum is good, through the C ABI and both FMUs: refused, or harmless; nothing that is read
//! or stepped afterwards is infinite, and the model can always go back to a good state, to the bit.

use std::ffi::c_void;
use std::ptr::null_mut;

use engine::model::bytes::checksum;
use enmm_fmi::log::Status;
use enmm_fmi::table::{Type, Version};

use crate::parts::calls::{CASE, Host};
use crate::parts::{Act, Outcome, finite};
use crate::random::Random;
use crate::trace::Trace;
use enmm_fuzz::abi::{model as life, observe, state};
use enmm_fuzz::buffer::Buffer;
use enmm_fuzz::fmu::{Fmu, Instance};
use enmm_fuzz::numbers::{enmm_block_state, enmm_energies, enmm_port_state};
use enmm_fuzz::types::{enmm_model, enmm_status};

/// Internal steps before the good state.
const MOVED: f64 = 100.5;
const OK: enmm_status = enmm_status::ENMM_OK;

/// Somebody whose states are damaged.
enum Subject {
    C(Box<Host>, *mut enmm_model),
    Fmu(Box<Fmu>, Instance),
}

/// A subject with a good state.
struct Patient {
    subject: Subject,
    dt: f64,
    good: Vec<u8>,
    saved: *mut c_void,
    payload: usize,
}

/// Starts a model in each way.
pub fn make() -> Result<Act, String> {
    let mut patients = [Patient::of_c()?, Patient::of_fmu(Version::Two)?, Patient::of_fmu(Version::Three)?];
    Ok(Box::new(move |random, trace| {
        let k = random.below(patients.len());
        trace.say(|| ["C ABI", "FMI 2", "FMI 3"][k].to_owned());
        patients[k].attempt(random, trace)
    }))
}

impl Patient {
    fn of_c() -> Result<Self, String> {
        let (mut host, mut model, mut dt) = (Box::new(Host::default()), null_mut(), 0.0);
        let text = std::ffi::CString::new(CASE).map_err(|error| error.to_string())?;
        // SAFETY: a text, and room for a handle, a number and another handle.
        let (statuses, saved) = unsafe {
            let mut saved = null_mut();
            let made = life::enmm_create_from_string(text.as_ptr(), std::ptr::null(), &raw mut model);
            let step = life::enmm_get_internal_step(model, &raw mut dt);
            let moved = life::enmm_do_step(model, 0.0, MOVED * dt, null_mut());
            ([made, step, moved, state::enmm_state_save(model, &raw mut saved)], saved)
        };
        let good = host.bytes(model)?.unwrap_or_default();
        if statuses != [OK; 4] {
            return Err(format!("no model: {statuses:?}"));
        }
        let payload = payload_of(&good)?;
        Ok(Self { subject: Subject::C(host, model), dt, good, saved: saved.cast(), payload })
    }

    fn of_fmu(version: Version) -> Result<Self, String> {
        let fmu = Box::new(Fmu::new(CASE, version)?);
        let (instance, dt, mut saved) = (fmu.instance()?, fmu.dt, null_mut());
        let begun =
            [instance.set_up(0.0, None), instance.enter(0.0), instance.exit(), instance.step(0.0, MOVED * dt).0];
        let good = match (begun, instance.save(&mut saved)) {
            ([Status::Ok, Status::Ok, Status::Ok, Status::Ok], Status::Ok) => instance.bytes(saved),
            _ => Err(Status::Error),
        };
        let good = good.map_err(|status| format!("no state: {begun:?} {status:?}"))?;
        let payload = payload_of(&good)?;
        Ok(Self { subject: Subject::Fmu(fmu, instance), dt, good, saved, payload })
    }

    fn attempt(&mut self, random: &mut Random, trace: &mut Trace) -> Result<Outcome, String> {
        let forged = self.forged(random, trace);
        let Some(read) = self.unpack(&forged)? else {
            return self.back().map(|()| Outcome::Done(2));
        };
        trace.say(|| "it is read".to_owned());
        self.restore(read).map_err(|why| format!("a state that was read cannot be restored: {why}"))?;
        finite("outputs after a damaged state", &self.outputs()?)?;
        trace.say(|| "its outputs are finite".to_owned());
        if self.step() {
            finite("outputs a step after a damaged state", &self.outputs()?)?;
        }
        self.forget(read)?;
        self.back().map(|()| Outcome::Done(12))
    }

    /// The good bytes with some changed, length and checksum made good.
    fn forged(&self, random: &mut Random, trace: &mut Trace) -> Vec<u8> {
        let mut payload = self.good[self.payload..].to_vec();
        for _ in 0..=random.below(3) {
            let (at, n) = (random.below(payload.len()), payload.len());
            let kind = random.below(8);
            match kind {
                0 => payload[at] = random.pick(&[0, 1, 2, 0x7f, 0x80, 0xff]),
                1 => payload[at] ^= 1 << random.below(8),
                2 if random.chance(30) => payload.truncate(at.max(1)),
                3 if random.chance(30) => drop(payload.remove(at)),
                4 if random.chance(30) => payload.insert(at, random.word() as u8),
                5 if n > 16 => {
                    let (from, to) = (random.below(n - 8), random.below(n - 8));
                    payload.copy_within(from..from + 8, to);
                }
                _ if n > 16 => {
                    let to = random.below(n - 8);
                    payload[to..to + 8].copy_from_slice(&random.wild().to_le_bytes());
                }
                _ => (),
            }
            trace.say(|| format!("damage {kind} at {at} of {n}"));
        }
        let mut forged = self.good[..self.payload - 12].to_vec();
        let checksum = checksum(&forged, &payload);
        forged.extend((payload.len() as u64).to_le_bytes());
        forged.extend(checksum.to_le_bytes());
        forged.extend(payload);
        forged
    }

    fn unpack(&mut self, bytes: &[u8]) -> Result<Option<*mut c_void>, String> {
        match &self.subject {
            Subject::C(_, model) => {
                let mut made = null_mut();
                // SAFETY: so many bytes, and room for a handle.
                let status =
                    unsafe { state::enmm_state_deserialize(*model, bytes.as_ptr(), bytes.len(), &raw mut made) };
                match status {
                    OK => Ok(Some(made.cast())),
                    enmm_status::ENMM_WRONG_STATE if made.is_null() => Ok(None),
                    other => Err(format!("damaged bytes gave {other:?}")),
                }
            }
            Subject::Fmu(_, instance) => match instance.unpack(bytes) {
                (Status::Ok, made) => Ok(Some(made)),
                (Status::Error, made) if made.is_null() => Ok(None),
                (other, _) => Err(format!("damaged bytes gave {other:?}")),
            },
        }
    }

    fn restore(&mut self, saved: *mut c_void) -> Result<(), String> {
        match &self.subject {
            Subject::C(_, model) => match state::enmm_state_restore(*model, saved.cast()) {
                OK => Ok(()),
                status => Err(format!("{status:?}")),
            },
            Subject::Fmu(_, instance) => match instance.restore(saved) {
                Status::Ok => Ok(()),
                status => Err(format!("{status:?}")),
            },
        }
    }

    fn forget(&mut self, mut saved: *mut c_void) -> Result<(), String> {
        let good = match &self.subject {
            Subject::C(..) => state::enmm_state_free(saved.cast()) == OK,
            Subject::Fmu(_, instance) => instance.free_state(&mut saved) == Status::Ok,
        };
        if good { Ok(()) } else { Err("a state cannot be freed".to_owned()) }
    }

    /// Three steps and a half; false when they fail, as they may.
    fn step(&mut self) -> bool {
        match &self.subject {
            Subject::C(_, model) => {
                let mut time = 0.0;
                // SAFETY: room for a number; no structure is asked for.
                unsafe {
                    life::enmm_get_time(*model, &raw mut time) == OK
                        && life::enmm_do_step(*model, time, 3.5 * self.dt, null_mut()) == OK
                }
            }
            Subject::Fmu(fmu, instance) => {
                let time = fmu.time(*instance).unwrap_or(f64::NAN);
                instance.step(time, 3.5 * self.dt).0 == Status::Ok
            }
        }
    }

    /// All that a host can read.
    fn outputs(&mut self) -> Result<Vec<f64>, String> {
        match &self.subject {
            Subject::C(_, model) => read_c(*model),
            Subject::Fmu(fmu, instance) => {
                let list = fmu.outputs();
                let size = list.iter().map(|(_, size)| size).sum();
                let references: Vec<u32> = list.iter().map(|(reference, _)| *reference).collect();
                let mut buffer = Buffer::new(size);
                match instance.get(Type::Real, &references, &mut buffer, size) {
                    Status::Ok => Ok(buffer.numbers(size)),
                    // In the mode that the state tells, outputs may have no values yet.
                    Status::Error => Ok(Vec::new()),
                    status => Err(format!("outputs after a damaged state: {status:?}")),
                }
            }
        }
    }

    /// Goes back to the good state, whose bytes must be the same.
    fn back(&mut self) -> Result<(), String> {
        self.restore(self.saved).map_err(|why| format!("the good state cannot be restored: {why}"))?;
        let bytes = match &mut self.subject {
            Subject::C(host, model) => host.bytes(*model)?.unwrap_or_default(),
            Subject::Fmu(_, instance) => instance.bytes(self.saved).map_err(|status| format!("{status:?}"))?,
        };
        if bytes == self.good { Ok(()) } else { Err("the good state has other bytes than before".to_owned()) }
    }
}

/// Where the payload begins: behind its checksum.
fn payload_of(bytes: &[u8]) -> Result<usize, String> {
    let is_start = |&k: &usize| bytes[k - 4..k] == checksum(&bytes[..k - 12], &bytes[k..]).to_le_bytes();
    (12..bytes.len()).find(is_start).ok_or_else(|| "no payload".to_owned())
}

/// Blocks, energies and ports.
fn read_c(model: *mut enmm_model) -> Result<Vec<f64>, String> {
    let (mut blocks, mut written) = (Buffer::new(2 * size_of::<enmm_block_state>() / 8), 0);
    let (mut energies, mut port) =
        (Buffer::new(size_of::<enmm_energies>() / 8), Buffer::new(size_of::<enmm_port_state>() / 8));
    blocks.set(0, size_of::<enmm_block_state>() as u64);
    energies.set(0, size_of::<enmm_energies>() as u64);
    port.set(0, size_of::<enmm_port_state>() as u64);
    // SAFETY: two blocks, energies and a port, each with its size.
    let statuses = unsafe {
        [
            observe::enmm_get_block_states(model, blocks.pointer(), 2, &raw mut written),
            observe::enmm_get_energies(model, energies.pointer()),
            observe::enmm_get_port_state(model, 0, port.pointer()),
        ]
    };
    if statuses != [OK; 3] {
        return Err(format!("outputs after a damaged state: {statuses:?}"));
    }
    let [blocks, energies, port] = [blocks.numbers(17), energies.numbers(16), port.numbers(15)];
    Ok(blocks[2..].iter().chain(&energies[1..]).chain(&port[1..]).copied().collect())
}
