//! Inputs of hosts.

use engine::cosimulation::PortKind;
use engine::geometry::Vector;

use super::pointers;
use crate::safe::enter::with_model;
use crate::types::{enmm_model, enmm_status};

/// Sets gravity (m/s2, x to the right, y upwards; on Earth 0 and -9.81).
///
/// Acts from the start of the next step on, or is reached at its end (enmm_set_interpolation), and holds until it is
/// set again; so do all inputs. In the initial equilibrium it grows from 0.
///
/// Errors: ENMM_INVALID_ARGUMENT for a value that is not finite or beyond 1e4 m/s2; the old value then stays in force.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_gravity(model: *mut enmm_model, gx: f64, gy: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_gravity(Vector::new(gx, gy))?))
}

/// Sets force (N per metre of thickness, x to the right, y upwards) through the mass centroid of a block, and moment
/// about it (N*m per metre, counter-clockwise). They replace those that were set before, or that a port of the case has
/// at the start; loads of the case stay.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a block that does not exist, or a value that is not finite or beyond 1e15.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_block_force(
    model: *mut enmm_model,
    block: u32,
    fx: f64,
    fy: f64,
    moment: f64,
) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_block_force(block, Vector::new(fx, fy), moment)?))
}

/// Sets force and moment of `n` blocks at once: all, or none when one value is refused.
///
/// `ids`, `fx`, `fy` and `m` hold `n` values each, with the units of enmm_set_block_force. If a block is named twice,
/// its last values count. Blocks that are not named keep their force.
///
/// Errors: as enmm_set_block_force, for the first block that is refused; ENMM_NULL_ARGUMENT when `n` is not 0.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_set_block_forces(
    model: *mut enmm_model,
    ids: *const u32,
    n: usize,
    fx: *const f64,
    fy: *const f64,
    m: *const f64,
) -> enmm_status {
    with_model(model.addr(), |model| {
        // SAFETY: promised by the host.
        unsafe {
            let ids = pointers::slice("ids", ids, n)?;
            let loads = [pointers::slice("fx", fx, n)?, pointers::slice("fy", fy, n)?, pointers::slice("m", m, n)?];
            model.set_block_forces(ids, loads)
        }
    })
}

/// Sets the acceleration of the base (m/s2, x to the right, y upwards). Displacements and velocities are relative to
/// the base; all rock feels the opposite acceleration. It does not act on the initial equilibrium and begins at time 0.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a value that is not finite or beyond 1e4 m/s2.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_base_acceleration(model: *mut enmm_model, ax: f64, ay: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_base_acceleration(Vector::new(ax, ay))?))
}

/// Sets the height y of the water surface (m, upwards, in the coordinates of the case). The case must have `[water]`.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a case without water, or a value that is not finite or beyond 1e9 m.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_water_level(model: *mut enmm_model, y: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_water_level(y)?))
}

/// Sets traction (Pa, global axes, per length before deformation) on a boundary port; positive pushes to the right and
/// upwards.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is not a boundary, or a value that is not finite or
/// beyond 1e15 Pa.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_boundary_traction(model: *mut enmm_model, port: u32, tx: f64, ty: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_boundary_traction(port as usize, Vector::new(tx, ty))?))
}

/// Sets fluid pressure (Pa) on a boundary port; positive pushes into the rock, normal to its current surface.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: as enmm_set_boundary_traction.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_boundary_pressure(model: *mut enmm_model, port: u32, p: f64) -> enmm_status {
    with_model(model.addr(), |model| model.set_pressure(port, PortKind::Boundary, p))
}

/// Sets fluid pressure (Pa) in the joints of a joint port; positive pushes both faces into their rock, apart.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is not one of joints, or a value that is not finite
/// or beyond 1e15 Pa.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_joint_pressure(model: *mut enmm_model, port: u32, p: f64) -> enmm_status {
    with_model(model.addr(), |model| model.set_pressure(port, PortKind::Joint, p))
}

/// Sets the factor by which cohesion, tan(friction angle) and tensile strength of all joints and of rock that yields or
/// breaks are multiplied; 1 is the strength of the case.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a value that is not at least 0 and at most 1e6.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_strength_factor(model: *mut enmm_model, f: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_strength_factor(f)?))
}

/// Sets the particle velocity (m/s, x to the right, y upwards) of the wave that comes in through a quiet boundary, or
/// the velocity with which the supports of a held point or edge move. It acts in dynamic stages, beside what the case
/// says.
///
/// Acts at the same times as enmm_set_gravity; a linear way is taken exactly, its bends included.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is of another kind, or a value that is not finite or
/// beyond 1e4 m/s.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_port_velocity(model: *mut enmm_model, port: u32, vx: f64, vy: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_port_velocity(port as usize, Vector::new(vx, vy))?))
}

/// Sets the displacement (m) that the supports of a held point or edge have reached at the end of the next step,
/// counted from their place before a host has moved them. They go there at a steady velocity and stay, unless it is set
/// again.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is of another kind, or a value that is not finite or
/// beyond 1e9 m.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_port_displacement(model: *mut enmm_model, port: u32, ux: f64, uy: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_port_displacement(port as usize, Vector::new(ux, uy))?))
}

/// Sets the level (m, upwards, in the coordinates of the case) of a `[[head]]`, by its place in the case, from 0;
/// enmm_find_name finds it by name.
///
/// Acts where the flow in joints is found: at the start of static stages, and in dynamic stages with `flow = "steady"`
/// or `flow = "transient"` on the grid of internal steps; else at the same times as enmm_set_gravity. A stage that
/// names the head ends it.
///
/// Errors: ENMM_INVALID_ARGUMENT for a head that does not exist, a value that is not finite or beyond 1e9 m, or a
/// model whose flow is held from now on.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_head(model: *mut enmm_model, head: u32, level: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_head(head as usize, level)?))
}

/// Sets the rate (m/s, that is m3/s on each m2 in plan) of a `[[rain]]`, by its place in the case, from 0.
///
/// Acts as enmm_set_head.
///
/// Errors: ENMM_INVALID_ARGUMENT for a rain that does not exist, a value that is not at least 0 and at most 1e-3, or a
/// model whose flow is held from now on.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_rain(model: *mut enmm_model, rain: u32, rate: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_rain(rain as usize, rate)?))
}

/// Lets a `[[drain]]` act, or not where `is_active` is 0, by its place in the case, from 0. It is a switch: it acts as
/// enmm_set_head, but never linearly.
///
/// Errors: ENMM_INVALID_ARGUMENT for a drain that does not exist, or a model whose flow is held from now on.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_drain(model: *mut enmm_model, drain: u32, is_active: i32) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_drain(drain as usize, is_active != 0)?))
}

/// Makes all inputs that have been set since the last step act at once from the start of the next one, even where
/// inputs vary linearly: an anchor is lost. Inputs that are set after this call go their way from there.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_jump(model: *mut enmm_model) -> enmm_status {
    with_model(model.addr(), |model| {
        model.inner.jump();
        Ok(())
    })
}

/// Sets how one input varies within a communication step: `input` is a value of enmm_input, `index` the block, port,
/// head, rain or drain where it has one, `mode` a value of enmm_interpolation. Acts from the next step on, and is part
/// of saved states. enmm_set_interpolation sets that of all inputs.
///
/// Errors: ENMM_INVALID_ARGUMENT for another number, or an index that does not exist.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_input_interpolation(
    model: *mut enmm_model,
    input: i32,
    index: u32,
    mode: i32,
) -> enmm_status {
    with_model(model.addr(), |model| model.set_interpolation_of(input, index, mode))
}

/// Returns the inputs that are set now: gravity (m/s2, two numbers), acceleration of the base (m/s2, two numbers),
/// height of the water (m; 0 without water), factor on the strength of joints. Pointers may be NULL where the value is
/// of no interest.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_inputs(
    model: *mut enmm_model,
    gravity: *mut f64,
    base_acceleration: *mut f64,
    water_level: *mut f64,
    strength_factor: *mut f64,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let inputs = model.inner.inputs();
        let base = inputs.base_acceleration;
        // SAFETY: promised by the host: the first two point to two numbers each.
        unsafe {
            pointers::write_if_wanted(gravity.cast(), [inputs.gravity.x, inputs.gravity.y])?;
            pointers::write_if_wanted(base_acceleration.cast(), [base.x, base.y])?;
            pointers::write_if_wanted(water_level, inputs.water_level)?;
            pointers::write_if_wanted(strength_factor, inputs.strength_factor)
        }
    })
}

/// Returns the force (N/m, two numbers) and the moment (N*m/m) that are set on a block now. Pointers may be NULL where
/// the value is of no interest.
///
/// Errors: ENMM_INVALID_ARGUMENT for a block that does not exist.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_block_force(
    model: *mut enmm_model,
    block: u32,
    force: *mut f64,
    moment: *mut f64,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let (own, own_moment) = model.block_force(block)?;
        // SAFETY: promised by the host: the first points to two numbers.
        unsafe {
            pointers::write_if_wanted(force.cast(), own)?;
            pointers::write_if_wanted(moment, own_moment)
        }
    })
}

/// Returns what is set on a port now: traction (Pa, two numbers), pressure (Pa) and velocity (m/s, two numbers); 0
/// where its kind takes no such input. For a block see enmm_get_block_force. Pointers may be NULL where the value is of
/// no interest.
///
/// Errors: ENMM_INVALID_ARGUMENT for a port that does not exist.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_port_inputs(
    model: *mut enmm_model,
    port: u32,
    traction: *mut f64,
    pressure: *mut f64,
    velocity: *mut f64,
) -> enmm_status {
    with_model(model.addr(), |model| {
        let (own_traction, own_pressure, own_velocity) = model.port_inputs(port)?;
        // SAFETY: promised by the host: two of them point to two numbers each.
        unsafe {
            pointers::write_if_wanted(traction.cast(), own_traction)?;
            pointers::write_if_wanted(pressure, own_pressure)?;
            pointers::write_if_wanted(velocity.cast(), own_velocity)
        }
    })
}

/// Returns what is set at a head (level, m), in rain (rate, m/s) or at a drain (1 where it acts, else 0): `kind` is
/// ENMM_NAME_HEAD, ENMM_NAME_RAIN or ENMM_NAME_DRAIN, `index` its place in the case.
///
/// Errors: ENMM_INVALID_ARGUMENT for another kind or a place that does not exist, ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_inlet_input(
    model: *mut enmm_model,
    kind: i32,
    index: u32,
    value: *mut f64,
) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("value", value, model.inlet_input(kind, index)?) })
}

/// Sets how inputs vary within a communication step: a value of enmm_interpolation. Acts from the next step on, and is
/// part of saved states.
///
/// Errors: ENMM_INVALID_ARGUMENT for another number.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_interpolation(model: *mut enmm_model, mode: i32) -> enmm_status {
    with_model(model.addr(), |model| model.set_interpolation(mode))
}

/// Returns how inputs vary within a communication step: a value of enmm_interpolation.
///
/// Errors: ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_get_interpolation(model: *mut enmm_model, mode: *mut i32) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| unsafe { pointers::write("mode", mode, model.interpolation()) })
}
