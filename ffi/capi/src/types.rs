//! Types of the boundary; what is written here is the documentation of `include/enmm.h`.

use libc::{c_char, c_void};

/// Version of the binary interface: changes when a program that was built before would no longer work.
pub const ENMM_ABI_VERSION: u32 = 1;

/// Flag of a block: no part of it can move.
pub const ENMM_BLOCK_FIXED: u32 = 1;
/// Flag of a block: it can move, and no contact on it carries force now.
pub const ENMM_BLOCK_DETACHED: u32 = 2;
/// Flag of a block: it has moved beyond the failure displacement of the case; this stays.
pub const ENMM_BLOCK_FAILED: u32 = 4;
/// Flag of a block: it has been excavated; its other values are those of when it was there.
pub const ENMM_BLOCK_REMOVED: u32 = 8;

/// Subject of a slip event of a contact that lies on no joint trace of the case.
pub const ENMM_NO_JOINT: u32 = u32::MAX;
/// Other block of events that are no overlap.
pub const ENMM_NO_BLOCK: u32 = u32::MAX;

/// Flag of enmm_state_restore_with and enmm_state_deserialize_with: the model keeps the parameters that it has.
pub const ENMM_KEEP_PARAMETERS: u32 = 1;

/// A model. The handle is a number that is never dereferenced: a NULL or dead handle is an error and never a crash.
pub struct enmm_model(());

/// A saved state of a model; it may outlive the model. The handle is as safe as that of a model.
pub struct enmm_state(());

/// Result of a call. When it is not ENMM_OK, the call has changed nothing, and enmm_last_error() returns the fault, the
/// limit and the remedy.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum enmm_status {
    /// Done.
    ENMM_OK = 0,
    /// A pointer or handle is NULL but must not be.
    ENMM_NULL_ARGUMENT = 1,
    /// The handle was destroyed, or never was one of this kind.
    ENMM_DEAD_HANDLE = 2,
    /// Another thread is using the model.
    ENMM_BUSY = 3,
    /// A value is not finite or out of range, names something that does not exist, or is a text that is not UTF-8.
    ENMM_INVALID_ARGUMENT = 4,
    /// The case cannot be used; the message has file, line and key.
    ENMM_INVALID_CASE = 5,
    /// A file cannot be read or written.
    ENMM_FILE_ERROR = 6,
    /// A communication step does not begin at the time of the model.
    ENMM_WRONG_TIME = 7,
    /// The step failed numerically; the model is as it was before the call.
    ENMM_NUMERICAL_FAILURE = 8,
    /// The buffer is too small: nothing was written to it, and `*written` is the capacity that is needed.
    ENMM_BUFFER_TOO_SMALL = 9,
    /// There is no such port, or no rock at this position.
    ENMM_NOT_FOUND = 10,
    /// The state is of another case or version, or its bytes are damaged.
    ENMM_WRONG_STATE = 11,
    /// An internal error. The model that was in use can only be destroyed; all others are unharmed.
    ENMM_PANIC = 12,
    /// The host ended the call, by enmm_interrupt or by its progress callback; the model is as it was before the call.
    ENMM_INTERRUPTED = 13,
}

/// How inputs go through a communication step.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_interpolation {
    /// A value that was set acts from the start of the next step on (as at the creation of a model).
    ENMM_INTERPOLATION_HOLD = 0,
    /// A value that was set is reached at the end of the next step, linearly from the one before.
    ENMM_INTERPOLATION_LINEAR = 1,
}

/// Kind of a port.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_port_type {
    /// A block: takes force and moment (enmm_set_block_force with the id of enmm_port_block).
    ENMM_PORT_BLOCK = 0,
    /// A part of the outer boundary: takes traction and pressure.
    ENMM_PORT_BOUNDARY = 1,
    /// Faces of joints: takes fluid pressure.
    ENMM_PORT_JOINT = 2,
    /// A quiet boundary: takes the particle velocity of the wave that comes in (enmm_set_port_velocity).
    ENMM_PORT_QUIET = 3,
    /// A held point or edge: takes the velocity or the displacement with which it is moved.
    ENMM_PORT_FIX = 4,
}

/// An input, for enmm_set_input_interpolation.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_input {
    /// Gravity.
    ENMM_INPUT_GRAVITY = 0,
    /// Acceleration of the base.
    ENMM_INPUT_BASE_ACCELERATION = 1,
    /// Height of the water.
    ENMM_INPUT_WATER_LEVEL = 2,
    /// Factor on the strength of joints.
    ENMM_INPUT_STRENGTH_FACTOR = 3,
    /// Force and moment of the block that the index names.
    ENMM_INPUT_BLOCK = 4,
    /// Inputs of the port that the index names.
    ENMM_INPUT_PORT = 5,
    /// Level of the head that the index names.
    ENMM_INPUT_HEAD = 6,
    /// Rate of the rain that the index names.
    ENMM_INPUT_RAIN = 7,
    /// Whether the drain acts that the index names; it is a switch in either way.
    ENMM_INPUT_DRAIN = 8,
}

/// Kinds of things that have a number and a name.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_name_kind {
    /// A joint trace, which events name by its number.
    ENMM_NAME_JOINT = 0,
    /// A joint law, which contacts name by its number.
    ENMM_NAME_LAW = 1,
    /// A rock, in the alphabetical order of their names.
    ENMM_NAME_ROCK = 2,
    /// A stage, in the order of the case.
    ENMM_NAME_STAGE = 3,
    /// A block.
    ENMM_NAME_BLOCK = 4,
    /// A place that the case names by `[[monitor]]`, in its order.
    ENMM_NAME_MONITOR = 5,
    /// A port, in the order of the case.
    ENMM_NAME_PORT = 6,
    /// A head of water in joints, in the order of the case.
    ENMM_NAME_HEAD = 7,
    /// Rain on joints, in the order of the case.
    ENMM_NAME_RAIN = 8,
    /// A drain, in the order of the case.
    ENMM_NAME_DRAIN = 9,
    /// A place on a joint that the case names by `[[joint_monitor]]`, in its order.
    ENMM_NAME_JOINT_MONITOR = 10,
}

/// State of a contact.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_contact_state {
    /// It carries no force.
    ENMM_CONTACT_OPEN = 0,
    /// Its shear force is at the limit.
    ENMM_CONTACT_SLIP = 1,
    /// Its shear force is below the limit.
    ENMM_CONTACT_LOCK = 2,
}

/// Kind of an event. Each happens once to a block, joint or pair of blocks; the first three only in dynamic stages.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_event_kind {
    /// A block that touched others lost its last contact.
    ENMM_EVENT_DETACHED = 0,
    /// A joint slipped.
    ENMM_EVENT_SLIPPED = 1,
    /// A block moved beyond the failure displacement.
    ENMM_EVENT_FAILED = 2,
    /// Two blocks overlap by more than 1 % of the mesh size, or deeper than the contacts between them explain: results
    /// about them are wrong from here on. Every 50 internal steps the polygons of near blocks are compared, in the
    /// initial equilibrium, too, whose times are below 0.
    ENMM_EVENT_OVERLAPPED = 3,
    /// The last bond of a rock bridge broke, or of a joint with an energy of fracture; in the initial equilibrium, too.
    ENMM_EVENT_BROKEN = 4,
    /// A block broke in two: `subject` goes on, `other` is the number of the new part.
    ENMM_EVENT_CUT = 5,
}

/// How a section of rock broke.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_section_failure {
    /// Its outermost fibre had the tensile strength, by tension more than by bending.
    ENMM_SECTION_OPENED = 0,
    /// It had its strength in shear.
    ENMM_SECTION_SLID = 1,
    /// Its outermost fibre had the tensile strength, by bending more than by tension.
    ENMM_SECTION_BENT = 2,
    /// A core of its block had the tensile strength.
    ENMM_SECTION_SPLIT = 3,
}

/// Weight of a message.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum enmm_log_level {
    /// A step failed.
    ENMM_LOG_ERROR = 0,
    /// Something is unusual: warnings of the case, a start that is not at rest, contact forces that did not settle,
    /// blocks that overlap (see ENMM_EVENT_OVERLAPPED), and a motion that is worthless since energy came from nowhere
    /// (residual over largest term of the ledger at least 0.9), which is looked at after the initial equilibrium, four
    /// internal steps, and whenever their number has doubled.
    ENMM_LOG_WARNING = 1,
    /// Other events, and the end of the search for the initial equilibrium.
    ENMM_LOG_INFO = 2,
}

/// Takes the messages of a model. It is called on the thread of a call to the model, when that call is otherwise done,
/// so that it may call any function: it may step the model, set another callback, or destroy the model, after which no
/// further message comes. Until it returns, the model is this thread's, and other threads get ENMM_BUSY. `message` is
/// valid during the call. It must return: no longjmp, no exception.
pub type enmm_log_callback =
    Option<unsafe extern "C" fn(user: *mut c_void, level: enmm_log_level, message: *const c_char)>;

/// How the search for the initial equilibrium ended.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_start_info {
    /// Size of this structure (bytes), set by the caller.
    pub struct_size: usize,
    /// 1 when it has been sought, by a start or by the first step; else 0, as all that follows.
    pub started: u32,
    /// 1 when the model came to rest. When it did not, the slope moves, or its static stage needs a longer duration:
    /// the model slides from time 0 on.
    pub settled: u32,
    /// 1 when the slope had failed at the end of the last search of this model.
    pub failed: u32,
    /// 0.
    pub reserved: u32,
    /// Internal steps that the search took.
    pub steps: u64,
    /// Net over applied force at its end when the model did not come to rest; 0 when it did.
    pub unbalanced: f64,
}

/// How far a call has come.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_progress {
    /// Size of this structure (bytes), set by the library.
    pub struct_size: usize,
    /// Time reached (s): that of the model or, in the initial equilibrium, since its start.
    pub time: f64,
    /// End of the communication step (s), or the most time that the initial equilibrium may take; it ends when the
    /// model is at rest.
    pub end: f64,
    /// In the initial equilibrium the last net over applied force that is known; -1 for none.
    pub unbalanced: f64,
    /// 1 while a call seeks the initial equilibrium, else 0.
    pub is_equilibrium: u32,
    /// 0.
    pub reserved: u32,
}

/// Sees the progress of enmm_start and enmm_do_step. It is called on the thread of the call, between internal steps, at
/// most every 50 ms. A result other than 0 ends the call with ENMM_INTERRUPTED. The call is working on the model
/// meanwhile: other calls with it get ENMM_BUSY, but for enmm_interrupt and enmm_destroy. `progress` is valid during
/// the call. It must return: no longjmp, no exception.
pub type enmm_progress_callback =
    Option<unsafe extern "C" fn(progress: *const enmm_progress, user: *mut c_void) -> i32>;

/// Outcome of a communication step.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_step_info {
    /// Size of this structure (bytes), set by the caller.
    pub struct_size: usize,
    /// Time that the model has reached (s): t + h.
    pub time: f64,
    /// Internal steps, parts of one included.
    pub steps: u64,
    /// Largest internal step (s), at most the critical one.
    pub dt: f64,
    /// Events of this step.
    pub event_count: usize,
    /// Index of the first of them (enmm_get_events takes it).
    pub first_event: usize,
    /// Internal steps that were redone in halves.
    pub halved: u64,
    /// Sub-steps whose contact forces did not settle; 0 in a sound run.
    pub unsettled: u64,
}

/// A contact between a boundary node of one block and an edge of another.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_contact {
    /// Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
    pub struct_size: usize,
    /// Open, slip or lock.
    pub state: enmm_contact_state,
    /// Joint law: its place among the names of the laws of the case in alphabetical order, from 0; see enmm_name.
    pub law: u32,
    /// Block of the node.
    pub node_block: u32,
    /// Block of the edge.
    pub edge_block: u32,
    /// Node now, x (m).
    pub position_x: f64,
    /// Node now, y (m).
    pub position_y: f64,
    /// Outward unit normal of the edge, x.
    pub normal_x: f64,
    /// Outward unit normal of the edge, y.
    pub normal_y: f64,
    /// Length of boundary that the node stands for (m).
    pub length: f64,
    /// Normal stress (Pa, tension positive).
    pub normal_stress: f64,
    /// Shear stress (Pa), on the node, positive along the normal turned by 90 degrees counter-clockwise.
    pub shear_stress: f64,
}

/// Something that happened for the first time.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_event {
    /// Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
    pub struct_size: usize,
    /// Kind of the event.
    pub kind: enmm_event_kind,
    /// Block id; for a slip or a broken bond the number of the joint trace, or ENMM_NO_JOINT; of two blocks that
    /// overlap the lower id. enmm_name has the names.
    pub subject: u32,
    /// End of the internal step in which it happened (s), as enmm_get_time counts.
    pub time: f64,
    /// Higher block id of two blocks that overlap; ENMM_NO_BLOCK for events of other kinds.
    pub other: u32,
    /// 0.
    pub reserved: u32,
    /// Depth of an overlap when it was found (m); 0 for events of other kinds.
    pub depth: f64,
}

/// A section of rock that has broken and is a joint since then.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_cut {
    /// Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
    pub struct_size: usize,
    /// Block that broke; its part with the point of a port, or else with its reference point, keeps the id.
    pub block: u32,
    /// Id of the part that is new.
    pub part: u32,
    /// How it broke.
    pub failure: enmm_section_failure,
    /// 0.
    pub reserved: u32,
    /// End of the internal step in which it broke (s), as enmm_get_time counts.
    pub time: f64,
    /// First end in the reference configuration, x (m).
    pub first_x: f64,
    /// First end, y up (m).
    pub first_y: f64,
    /// Second end, x (m).
    pub second_x: f64,
    /// Second end, y up (m).
    pub second_y: f64,
    /// Share of its strength that it carried, 1 or a little more.
    pub share: f64,
    /// Normal force that it carried (N/m, tension positive).
    pub normal_force: f64,
    /// Shear force that it carried (N/m).
    pub shear_force: f64,
    /// Bending moment about its middle that it carried (N*m/m).
    pub moment: f64,
}

/// Samples of enmm_rollout.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct enmm_rollout_plan {
    /// Size of this structure (bytes), set by the caller.
    pub struct_size: usize,
    /// Number of samples.
    pub samples: usize,
    /// States from which the samples go on: one for all, or one for each.
    pub states: *const *mut enmm_state,
    /// Number of states: 1, or that of the samples.
    pub state_count: usize,
    /// Parameters that are set in each sample (enmm_find_parameter); may be NULL when there are none.
    pub parameters: *const u32,
    /// Number of parameters.
    pub parameter_count: usize,
    /// Their values: samples * parameter_count numbers, those of one sample after those of another.
    pub values: *const f64,
    /// Communication step (s).
    pub step: f64,
    /// Number of communication steps of each sample.
    pub steps: usize,
    /// Port of each output.
    pub ports: *const u32,
    /// Quantity of each output: its place among the members of enmm_port_state behind struct_size, from 0.
    pub quantities: *const u32,
    /// Number of outputs.
    pub output_count: usize,
    /// Number of threads, 1 to 1024; the bits do not depend on it.
    pub threads: usize,
}

sized! {
    enmm_step_info 64 {
        struct_size time steps dt event_count first_event halved unsettled
    }
    enmm_start_info 40 {
        struct_size started settled failed reserved steps unbalanced
    }
    enmm_progress 40 {
        struct_size time end unbalanced is_equilibrium reserved
    }
    enmm_contact 80 {
        struct_size state law node_block edge_block position_x position_y normal_x normal_y length normal_stress
        shear_stress
    }
    enmm_cut 96 {
        struct_size block part failure reserved time first_x first_y second_x second_y share normal_force shear_force
        moment
    }
    enmm_rollout_plan 104 {
        struct_size samples states state_count parameters parameter_count values step steps ports quantities
        output_count threads
    }
    enmm_event 24 {
        struct_size kind subject time other reserved depth
    }
}
