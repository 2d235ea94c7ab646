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

/// Sets the factor by which cohesion, tan(friction angle) and tensile strength of all joints are multiplied; 1 is the
/// strength of the case.
///
/// Acts at the same times as enmm_set_gravity.
///
/// Errors: ENMM_INVALID_ARGUMENT for a value that is not at least 0 and at most 1e6.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_set_strength_factor(model: *mut enmm_model, f: f64) -> enmm_status {
    with_model(model.addr(), |model| Ok(model.inner.set_strength_factor(f)?))
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
