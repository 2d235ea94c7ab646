//! Sequences of calls of the C ABI, right ones and wrong ones: a failed call changes no byte of its model and no byte
//! of a buffer, no call writes outside one, what is told is finite, and going back repeats the bits.

use std::ffi::{CStr, CString, c_char};
use std::ptr::{null, null_mut};

use crate::parts::{Act, Outcome, finite};
use crate::random::Random;
use crate::trace::Trace;
use enmm_fuzz::abi::{inputs, library, model as life, names, observe, state};
use enmm_fuzz::buffer::Buffer;
use enmm_fuzz::numbers::{
    enmm_block_state, enmm_energies, enmm_inlet_state, enmm_monitor_state, enmm_port_state, enmm_totals,
};
use enmm_fuzz::types::{enmm_contact, enmm_event, enmm_model, enmm_state, enmm_status, enmm_step_info};

/// A block on a slab with a port of every kind.
pub const CASE: &str = include_str!("../../../../ffi/capi/tests/cases/small.toml");
/// A block on an incline.
const INCLINE: &str = include_str!("../../../../examples/cases/block_on_incline.toml");
/// Calls of an input.
const CALLS: u64 = 80;
/// Calls of an input that is a burst.
const BURST: u64 = 20_000;
/// Calls of a burst for one look at the bytes of the state before and after.
const LOOK: usize = 200;
const MODELS_MAX: usize = 3;
const OK: enmm_status = enmm_status::ENMM_OK;

type Model = *mut enmm_model;
type Call = Result<(&'static str, enmm_status), String>;

/// Nothing is in common.
pub fn make() -> Result<Act, String> {
    Ok(calls(CALLS, false))
}

/// Bursts: many cheap calls of the same models, with short steps, where a campaign shall have many calls.
pub fn bursts() -> Result<Act, String> {
    Ok(calls(BURST, true))
}

fn calls(count: u64, is_burst: bool) -> Act {
    Box::new(move |random, trace| {
        let mut host = Host { is_burst, ..Host::default() };
        let done = (0..count).try_for_each(|_| host.act(random, trace));
        host.close();
        done.map(|()| Outcome::Done(host.calls))
    })
}

/// A host with models and states, live and dead.
#[derive(Default)]
pub struct Host {
    is_burst: bool,
    models: Vec<Model>,
    states: Vec<*mut enmm_state>,
    dead: Vec<usize>,
    /// Calls so far.
    pub calls: u64,
}

impl Host {
    /// One call, and a look at what it left.
    fn act(&mut self, random: &mut Random, trace: &mut Trace) -> Result<(), String> {
        let model = if self.models.is_empty() { null_mut() } else { self.model(random) };
        let looks = !self.is_burst || random.below(LOOK) == 0;
        let before = if looks { self.bytes(model)? } else { None };
        trace.say(|| format!("model {:x}", model.addr()));
        let kind = match self.is_burst {
            _ if self.models.is_empty() => 0,
            false => random.below(20),
            true => match random.below(10_000) {
                0 => 0,
                1 => 1,
                2..=7 => 2,
                8 => 16,
                9..=108 => 17,
                109..=2999 => 6,
                3000..=4999 => 10,
                5000..=5099 => 13,
                _ => 14,
            },
        };
        let (name, status) = match kind {
            0 => self.create(random, trace),
            1 => Ok(self.end(model, random, trace)),
            2..=5 => self.step(model, random, trace),
            6..=9 => self.set(model, random, trace),
            10..=12 => self.list(model, random, trace),
            13 => self.one(model, random, trace),
            14 | 15 => self.number(model, random, trace),
            16 => self.again(model, trace),
            _ => self.keep(model, random, trace),
        }?;
        trace.say(|| format!("{name}: {status:?}"));
        self.calls += 1;
        if status == enmm_status::ENMM_PANIC {
            return Err(format!("{name} panicked"));
        }
        if status != OK && message().len() < 10 {
            return Err(format!("{name} gave {status:?} with the message {:?}", message()));
        }
        match before {
            Some(before) if status != OK && self.bytes(model)?.as_ref() != Some(&before) => {
                Err(format!("{name} gave {status:?} and changed the model"))
            }
            _ => Ok(()),
        }
    }

    /// Most often a live handle.
    fn model(&mut self, random: &mut Random) -> Model {
        let wrong = match random.below(60) {
            0 => 0,
            1 => random.word() as usize,
            2 => self.dead.get(random.below(self.dead.len())).copied().unwrap_or(1),
            3 => self.states.first().map_or(2, |state| state.addr()),
            _ => return random.pick(&self.models),
        };
        std::ptr::without_provenance_mut(wrong)
    }

    fn state(&mut self, random: &mut Random) -> *mut enmm_state {
        if self.states.is_empty() || random.chance(10) {
            let wrong = self.dead.get(random.below(self.dead.len())).copied().unwrap_or_default();
            return std::ptr::without_provenance_mut(wrong);
        }
        random.pick(&self.states)
    }

    /// The state of a model in bytes; none of one that is dead.
    pub fn bytes(&mut self, model: Model) -> Result<Option<Vec<u8>>, String> {
        let mut saved = null_mut();
        // SAFETY: room for a handle is there.
        if unsafe { state::enmm_state_save(model, &raw mut saved) } != OK {
            return Ok(None);
        }
        let mut size = 0;
        // SAFETY: without a buffer its size is told.
        let asked = unsafe { state::enmm_state_serialize(model, saved, null_mut(), 0, &raw mut size) };
        let mut bytes = vec![0; size];
        // SAFETY: the buffer is as large as told.
        let told = unsafe { state::enmm_state_serialize(model, saved, bytes.as_mut_ptr(), size, &raw mut size) };
        let freed = state::enmm_state_free(saved);
        self.calls += 4;
        if [asked, told, freed] == [OK; 3] { Ok(Some(bytes)) } else { Err(format!("no bytes: {asked:?} {told:?}")) }
    }

    /// A model of a good text, a good one, or an error.
    pub fn create(&mut self, random: &mut Random, trace: &mut Trace) -> Call {
        let mut text = random.pick(&[CASE, INCLINE]).as_bytes().to_vec();
        if !self.models.is_empty() && random.chance(50) {
            let at = random.below(text.len());
            text[at] = random.pick(b"\xff#9]=\"");
        }
        trace.say(|| format!("create from {:?}", String::from_utf8_lossy(&text)));
        let text = CString::new(text).map_err(|error| error.to_string())?;
        let mut model: Model = std::ptr::without_provenance_mut(1);
        // SAFETY: a text, and room for a handle.
        let status = unsafe { life::enmm_create_from_string(text.as_ptr(), null(), &raw mut model) };
        if (status == OK) == model.is_null() {
            return Err(format!("create gave {status:?} and the handle {model:?}"));
        }
        if status == OK && self.models.len() < MODELS_MAX {
            self.models.push(model);
        } else if status == OK {
            life::enmm_destroy(model);
            self.dead.push(model.addr());
        }
        Ok(("enmm_create_from_string", status))
    }

    /// Sometimes the end of a model, else its start or its threads.
    fn end(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> (&'static str, enmm_status) {
        if random.chance(60) {
            return ("enmm_start", life::enmm_start(model));
        }
        if random.chance(30) {
            let threads = random.pick(&[0, 1, 2, 1025, usize::MAX]);
            trace.say(|| format!("{threads} threads"));
            return ("enmm_set_threads", life::enmm_set_threads(model, threads));
        }
        life::enmm_destroy(model);
        if let Some(k) = self.models.iter().position(|&live| live == model) {
            self.dead.push(self.models.swap_remove(k).addr());
        }
        ("enmm_destroy", OK)
    }

    fn step(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let (mut time, mut dt) = (0.0, 0.0);
        // SAFETY: room for two numbers, which stay 0 for a handle that is dead.
        unsafe {
            let _ = life::enmm_get_time(model, &raw mut time);
            let _ = life::enmm_get_internal_step(model, &raw mut dt);
        }
        let h = match random.below(10) {
            0 => random.pick(&[0.0, -dt, f64::NAN, f64::INFINITY, 1e300, 5e-324, 1e-3 * dt, 1e-9 * dt]),
            1 => random.between(0.0, 2.0) * dt,
            2 => dt,
            _ => random.between(0.0, if self.is_burst { 2.0 } else { 40.0 }) * dt,
        };
        let t = if random.chance(8) { random.wild() } else { time };
        trace.say(|| format!("do_step({t:?}, {h:?})"));
        let (mut buffer, known) = sized(size_of::<enmm_step_info>(), 1, random);
        let out = if random.chance(3) { null_mut() } else { buffer.pointer() };
        // SAFETY: a structure that tells its size.
        let status = unsafe { life::enmm_do_step(model, t, h, out) };
        buffer.check("enmm_do_step", status != OK)?;
        if status == OK && known && !out.is_null() {
            let words = buffer.words();
            finite("enmm_do_step: time and step", &[f64::from_bits(words[1]), f64::from_bits(words[3])])?;
        }
        Ok(("enmm_do_step", status))
    }

    fn set(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let [a, b, c] = [0; 3].map(|_| if random.chance(20) { random.wild() } else { random.between(-100.0, 100.0) });
        let k = random.pick(&[0, 0, 1, 1, 2, 3, u32::MAX]);
        let which = random.below(14);
        trace.say(|| format!("set {which}: {k} {a:?} {b:?} {c:?}"));
        Ok(match which {
            0 => ("enmm_set_gravity", inputs::enmm_set_gravity(model, a, b)),
            1 => ("enmm_set_block_force", inputs::enmm_set_block_force(model, k, a, b, c)),
            2 => ("enmm_set_base_acceleration", inputs::enmm_set_base_acceleration(model, a, b)),
            3 => ("enmm_set_water_level", inputs::enmm_set_water_level(model, a)),
            4 => ("enmm_set_boundary_traction", inputs::enmm_set_boundary_traction(model, k, a, b)),
            5 => ("enmm_set_boundary_pressure", inputs::enmm_set_boundary_pressure(model, k, a)),
            6 => ("enmm_set_joint_pressure", inputs::enmm_set_joint_pressure(model, k, a)),
            7 => ("enmm_set_strength_factor", inputs::enmm_set_strength_factor(model, a)),
            8 => {
                let mode = random.pick(&[0, 1, 1, 2, -1, i32::MAX]);
                ("enmm_set_interpolation", inputs::enmm_set_interpolation(model, mode))
            }
            9 => ("enmm_set_head", inputs::enmm_set_head(model, k, a)),
            10 => ("enmm_set_rain", inputs::enmm_set_rain(model, k, 1e-9 * a)),
            11 => ("enmm_set_drain", inputs::enmm_set_drain(model, k, (a > 0.0).into())),
            _ => {
                let (ids, values) = ([0, 1, k], [a, b, c]);
                let n = random.pick(&[0, 1, 2, 3]);
                let fx = if random.chance(10) { null() } else { values.as_ptr() };
                let (ids, fy) = (ids.as_ptr(), values.as_ptr());
                // SAFETY: three values each; only NULL is wrong.
                ("enmm_set_block_forces", unsafe { inputs::enmm_set_block_forces(model, ids, n, fx, fy, fy) })
            }
        })
    }

    /// Lists of structures, points and letters into buffers of right and wrong capacity.
    fn list(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let which = random.below(8);
        let words =
            [size_of::<enmm_block_state>(), size_of::<enmm_contact>(), size_of::<enmm_event>(), 16, 16, 1, 1, 1];
        let capacity = random.pick(&[0, 1, 2, 5, 200]);
        let (mut buffer, known) = match which {
            0..=2 => sized(words[which], capacity, random),
            _ => (Buffer::new(2 * capacity), true),
        };
        let (mut written, k) = (usize::MAX, random.pick(&[0, 1, 2, 7, u32::MAX]));
        let is_null = random.chance(20);
        let capacity = if is_null && random.chance(80) { 0 } else { capacity };
        let count = if random.chance(4) { null_mut() } else { &raw mut written };
        trace.say(|| format!("list {which} of {k}: capacity {capacity}, null {is_null}, sized {known}"));
        let at = |buffer: &mut Buffer| if is_null { null_mut() } else { buffer.pointer::<u64>() };
        let out = at(&mut buffer);
        // SAFETY: as much room as told, or NULL.
        let (name, status) = unsafe {
            match which {
                0 => ("block states", observe::enmm_get_block_states(model, out.cast(), capacity, count)),
                1 => ("contacts", observe::enmm_get_contacts(model, out.cast(), capacity, count)),
                2 => ("events", observe::enmm_get_events(model, k as usize, out.cast(), capacity, count)),
                3 => ("polygon", observe::enmm_get_block_polygon(model, k, out.cast(), capacity, count)),
                4 => ("hole", observe::enmm_get_block_hole(model, k, 0, out.cast(), capacity, count)),
                5 => ("port name", observe::enmm_port_name(model, k, out.cast(), capacity, count)),
                6 => ("name", names::enmm_name(model, k.cast_signed(), k, out.cast(), capacity, count)),
                _ => ("case hash", life::enmm_case_hash(model, out.cast(), capacity, count)),
            }
        };
        buffer.check(name, status != OK)?;
        if status == OK && !out.is_null() && known && written > 0 && written <= capacity {
            match which {
                0 => finite(name, &buffer.numbers(17)[2..])?,
                1 => finite(name, &buffer.numbers(10)[3..])?,
                3 | 4 => finite(name, &buffer.numbers(2 * written))?,
                _ => (),
            }
        }
        Ok((name, status))
    }

    /// Structures one by one.
    fn one(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let which = random.below(5);
        let sizes = [
            size_of::<enmm_energies>(),
            size_of::<enmm_totals>(),
            size_of::<enmm_port_state>(),
            size_of::<enmm_monitor_state>(),
            size_of::<enmm_inlet_state>(),
        ];
        let (mut buffer, known) = sized(sizes[which], 1, random);
        let (k, is_null) = (random.pick(&[0, 1, 2, 3, u32::MAX]), random.chance(5));
        trace.say(|| format!("one {which} of {k}: null {is_null}, sized {known}"));
        let out = if is_null { null_mut() } else { buffer.pointer::<u64>() };
        // SAFETY: a structure that tells its size, or NULL.
        let (name, status) = unsafe {
            match which {
                0 => ("energies", observe::enmm_get_energies(model, out.cast())),
                1 => ("totals", observe::enmm_get_totals(model, out.cast())),
                2 => ("port state", observe::enmm_get_port_state(model, k, out.cast())),
                3 => ("monitor state", names::enmm_get_monitor_state(model, k, out.cast())),
                _ => ("inlet state", names::enmm_get_inlet_state(model, 7 + (k % 4).cast_signed(), k, out.cast())),
            }
        };
        buffer.check(name, status != OK)?;
        if status == OK && known {
            finite(name, &buffer.numbers([16, 6, 15, 5, 4][which])[1..])?;
        }
        Ok((name, status))
    }

    fn number(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let (which, mut buffer) = (random.below(13), Buffer::new(1));
        let k = random.pick(&[0, 1, 2, 3, u32::MAX]);
        let name = random.pick(&[c"block", c"side", c"bed", c"", c"x"]);
        let [x, y] = [0; 2].map(|_| if random.chance(20) { random.wild() } else { random.between(-1.0, 3.0) });
        trace.say(|| format!("number {which} of {k} {name:?} ({x:?}, {y:?})"));
        let out: *mut f64 = if random.chance(5) { null_mut() } else { buffer.pointer() };
        // SAFETY: room for a value of any of these types, or NULL.
        let (name, status) = unsafe {
            match which {
                0 => ("time", life::enmm_get_time(model, out)),
                1 => ("internal step", life::enmm_get_internal_step(model, out)),
                2 => ("communication step", life::enmm_get_communication_step(model, out)),
                3 => ("stop time", life::enmm_get_stop_time(model, out)),
                4 => ("interpolation", inputs::enmm_get_interpolation(model, out.cast())),
                5 => ("block count", observe::enmm_block_count(model, out.cast())),
                6 => ("hole count", observe::enmm_block_hole_count(model, k, out.cast())),
                7 => ("block at", observe::enmm_find_block_at(model, x, y, out.cast())),
                8 => ("port count", observe::enmm_port_count(model, out.cast())),
                9 => ("find port", observe::enmm_find_port(model, name.as_ptr(), out.cast())),
                10 => ("port kind", observe::enmm_port_kind(model, k, out.cast())),
                11 => ("name count", names::enmm_name_count(model, k.cast_signed(), out.cast())),
                _ => ("port block", observe::enmm_port_block(model, k, out.cast())),
            }
        };
        buffer.check(name, status != OK)?;
        if status == OK && which < 4 {
            finite(name, &buffer.numbers(1))?;
        }
        Ok((name, status))
    }

    /// Goes back and does the same again: the same bits.
    fn again(&mut self, model: Model, trace: &mut Trace) -> Call {
        let (mut saved, mut time, mut dt) = (null_mut(), 0.0, 0.0);
        // SAFETY: room for a handle and two numbers.
        unsafe {
            if state::enmm_state_save(model, &raw mut saved) != OK {
                return Ok(("enmm_version", OK));
            }
            let _ = life::enmm_get_time(model, &raw mut time);
            let _ = life::enmm_get_internal_step(model, &raw mut dt);
        }
        let mut way = |part: f64| {
            // SAFETY: no structure is asked for.
            let status = unsafe { life::enmm_do_step(model, time, part * dt, null_mut()) };
            self.bytes(model).map(|bytes| (status, bytes))
        };
        trace.say(|| "again".to_owned());
        let first = way(3.25)?;
        let back = state::enmm_state_restore(model, saved);
        let second = way(3.25)?;
        let last = [back, state::enmm_state_restore(model, saved), state::enmm_state_free(saved)];
        self.calls += 6;
        if first != second || last != [OK; 3] {
            return Err(format!("a step repeated gave {:?} and other bits ({last:?})", second.0));
        }
        Ok(("again", OK))
    }

    /// States: saved, restored, freed, written, read.
    fn keep(&mut self, model: Model, random: &mut Random, trace: &mut Trace) -> Call {
        let (saved, which) = (self.state(random), random.below(5));
        trace.say(|| format!("state {which} {:x}", saved.addr()));
        match which {
            0 if self.states.len() < 5 => {
                let mut made = null_mut();
                // SAFETY: room for a handle.
                let status = unsafe { state::enmm_state_save(model, &raw mut made) };
                if status == OK {
                    self.states.push(made);
                }
                Ok(("enmm_state_save", status))
            }
            1 => {
                let status = state::enmm_state_free(saved);
                if let Some(k) = self.states.iter().position(|&live| live == saved) {
                    self.dead.push(self.states.swap_remove(k).addr());
                }
                Ok(("enmm_state_free", status))
            }
            2 => {
                let (capacity, mut written) = (random.pick(&[0, 8, 4096, 1 << 17]), 0);
                let mut buffer = Buffer::new(capacity / 8);
                let out = buffer.pointer();
                // SAFETY: as much room as told.
                let status = unsafe { state::enmm_state_serialize(model, saved, out, capacity, &raw mut written) };
                buffer.check("enmm_state_serialize", status != OK)?;
                Ok(("enmm_state_serialize", status))
            }
            3 => {
                let (bytes, mut made) = (self.bytes(model)?.unwrap_or_default(), null_mut());
                let size = if random.chance(50) { bytes.len() } else { random.below(bytes.len() + 1) };
                // SAFETY: as many bytes as told, and room for a handle.
                let status = unsafe { state::enmm_state_deserialize(model, bytes.as_ptr(), size, &raw mut made) };
                if status == OK && self.states.len() < 5 {
                    self.states.push(made);
                } else if status == OK {
                    return Ok(("enmm_state_free", state::enmm_state_free(made)));
                }
                Ok(("enmm_state_deserialize", status))
            }
            _ => Ok(("enmm_state_restore", state::enmm_state_restore(model, saved))),
        }
    }

    /// Gives all back.
    fn close(&mut self) {
        self.models.drain(..).for_each(|model| life::enmm_destroy(model));
        for saved in self.states.drain(..) {
            // It was live, and what comes of it is not asked any more.
            let _ = state::enmm_state_free(saved);
        }
    }
}

/// Room for structures, the first of which tells a size; and whether a structure has that size or more.
fn sized(size: usize, count: usize, random: &mut Random) -> (Buffer, bool) {
    let told = match random.below(8) {
        0 => random.pick(&[0, 3, 8, 16, 24, 32, size - 8, size + 1, 1 << 20, usize::MAX]),
        1 => size + 8 * random.below(9),
        _ => size,
    };
    let mut buffer = Buffer::new(count * (told.min(size + 64).max(size) / 8));
    buffer.set(0, told as u64);
    (buffer, told >= size && told <= size + 64)
}

/// Message of the last failed call of this thread.
fn message() -> String {
    let text: *const c_char = library::enmm_last_error();
    // SAFETY: a text that stays until the next call.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
