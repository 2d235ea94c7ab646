/*
 * enmm: explicit numerical manifold method for jointed rock. Made by `cargo xtask header`: do not edit.
 *
 * Units are SI: m, s, kg, N, Pa, rad, per metre of thickness; x to the right, y upwards, angles and moments
 * counter-clockwise, stresses positive in tension.
 *
 * Status. Every function that can fail returns enmm_status, 0 for done; when it is not 0 nothing has changed, and
 * enmm_last_error() returns the reason. ENMM_DEAD_HANDLE, ENMM_BUSY and ENMM_PANIC can come from every function with
 * a model. No exception and no panic leaves the library.
 *
 * Handles of models and states are numbers in a table of the process, and never dereferenced: a NULL or dead handle is
 * an error. Every other pointer must point to the data that the function describes. NULL is an error, except where a
 * function allows it.
 *
 * Threads. Models share nothing: any number can be used at the same time. One thread at a time may use a model, until
 * its messages have been delivered; any other gets ENMM_BUSY. enmm_interrupt alone can be called beside a call, to end
 * it. A state may be used by many.
 *
 * Processes. A forked process has models and states of its own, as they were at the fork, and may use them; one that
 * another thread was using at the fork stays ENMM_BUSY there. No call waits for a thread that the new process does not
 * have. See enmm_set_threads for models with threads.
 *
 * Structures begin with struct_size, which the caller sets to sizeof the structure. The library writes no more than
 * that, so that structures can grow and programs built with an older header still work. Members that the library does
 * not know keep their values.
 *
 * Texts are UTF-8 and end with a zero byte.
 */

#ifndef ENMM_H
#define ENMM_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && !defined(__cplusplus) && (!defined(__STDC_VERSION__) || __STDC_VERSION__ < 201112L)
#define ENMM_UNION __extension__ union
#else
#define ENMM_UNION union
#endif

/**
 * Version of the binary interface: changes when a program that was built before would no longer work.
 */
#define ENMM_ABI_VERSION 1

/**
 * Flag of a block: no part of it can move.
 */
#define ENMM_BLOCK_FIXED 1

/**
 * Flag of a block: it can move, and no contact on it carries force now.
 */
#define ENMM_BLOCK_DETACHED 2

/**
 * Flag of a block: it has moved beyond the failure displacement of the case; this stays.
 */
#define ENMM_BLOCK_FAILED 4

/**
 * Flag of a block: it has been excavated; its other values are those of when it was there.
 */
#define ENMM_BLOCK_REMOVED 8

/**
 * Subject of a slip event of a contact that lies on no joint trace of the case.
 */
#define ENMM_NO_JOINT UINT32_MAX

/**
 * Other block of events that are no overlap.
 */
#define ENMM_NO_BLOCK UINT32_MAX

/**
 * Flag of enmm_state_restore_with and enmm_state_deserialize_with: the model keeps the parameters that it has.
 */
#define ENMM_KEEP_PARAMETERS 1

/**
 * Result of a call. When it is not ENMM_OK, the call has changed nothing, and enmm_last_error() returns the fault, the
 * limit and the remedy.
 */
enum enmm_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Done.
   */
  ENMM_OK = 0,
  /**
   * A pointer or handle is NULL but must not be.
   */
  ENMM_NULL_ARGUMENT = 1,
  /**
   * The handle was destroyed, or never was one of this kind.
   */
  ENMM_DEAD_HANDLE = 2,
  /**
   * Another thread is using the model.
   */
  ENMM_BUSY = 3,
  /**
   * A value is not finite or out of range, names something that does not exist, or is a text that is not UTF-8.
   */
  ENMM_INVALID_ARGUMENT = 4,
  /**
   * The case cannot be used; the message has file, line and key.
   */
  ENMM_INVALID_CASE = 5,
  /**
   * A file cannot be read or written.
   */
  ENMM_FILE_ERROR = 6,
  /**
   * A communication step does not begin at the time of the model.
   */
  ENMM_WRONG_TIME = 7,
  /**
   * The step failed numerically; the model is as it was before the call.
   */
  ENMM_NUMERICAL_FAILURE = 8,
  /**
   * The buffer is too small: nothing was written to it, and `*written` is the capacity that is needed.
   */
  ENMM_BUFFER_TOO_SMALL = 9,
  /**
   * There is no such port, or no rock at this position.
   */
  ENMM_NOT_FOUND = 10,
  /**
   * The state is of another case or version, or its bytes are damaged.
   */
  ENMM_WRONG_STATE = 11,
  /**
   * An internal error. The model that was in use can only be destroyed; all others are unharmed.
   */
  ENMM_PANIC = 12,
  /**
   * The host ended the call, by enmm_interrupt or by its progress callback; the model is as it was before the call.
   */
  ENMM_INTERRUPTED = 13,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_status enmm_status;
#else
typedef int32_t enmm_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Weight of a message.
 */
enum enmm_log_level
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A step failed.
   */
  ENMM_LOG_ERROR = 0,
  /**
   * Something is unusual: warnings of the case, a start that is not at rest, contact forces that did not settle,
   * blocks that overlap (see ENMM_EVENT_OVERLAPPED), and a motion that is worthless since energy came from nowhere
   * (residual over largest term of the ledger at least 0.9), which is looked at after the initial equilibrium, four
   * internal steps, and whenever their number has doubled.
   */
  ENMM_LOG_WARNING = 1,
  /**
   * Other events, and the end of the search for the initial equilibrium.
   */
  ENMM_LOG_INFO = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_log_level enmm_log_level;
#else
typedef int32_t enmm_log_level;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * State of a contact.
 */
enum enmm_contact_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * It carries no force.
   */
  ENMM_CONTACT_OPEN = 0,
  /**
   * Its shear force is at the limit.
   */
  ENMM_CONTACT_SLIP = 1,
  /**
   * Its shear force is below the limit.
   */
  ENMM_CONTACT_LOCK = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_contact_state enmm_contact_state;
#else
typedef int32_t enmm_contact_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Kind of an event. Each happens once to a block, joint or pair of blocks; the first three only in dynamic stages.
 */
enum enmm_event_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A block that touched others lost its last contact.
   */
  ENMM_EVENT_DETACHED = 0,
  /**
   * A joint slipped.
   */
  ENMM_EVENT_SLIPPED = 1,
  /**
   * A block moved beyond the failure displacement.
   */
  ENMM_EVENT_FAILED = 2,
  /**
   * Two blocks overlap by more than 1 % of the mesh size, or deeper than the contacts between them explain: results
   * about them are wrong from here on. Every 50 internal steps the polygons of near blocks are compared, in the
   * initial equilibrium, too, whose times are below 0.
   */
  ENMM_EVENT_OVERLAPPED = 3,
  /**
   * The last bond of a rock bridge broke, or of a joint with an energy of fracture; in the initial equilibrium, too.
   */
  ENMM_EVENT_BROKEN = 4,
  /**
   * A block broke in two: `subject` goes on, `other` is the number of the new part.
   */
  ENMM_EVENT_CUT = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_event_kind enmm_event_kind;
#else
typedef int32_t enmm_event_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How a section of rock broke.
 */
enum enmm_section_failure
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Its outermost fibre had the tensile strength, by tension more than by bending.
   */
  ENMM_SECTION_OPENED = 0,
  /**
   * It had its strength in shear.
   */
  ENMM_SECTION_SLID = 1,
  /**
   * Its outermost fibre had the tensile strength, by bending more than by tension.
   */
  ENMM_SECTION_BENT = 2,
  /**
   * A core of its block had the tensile strength.
   */
  ENMM_SECTION_SPLIT = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_section_failure enmm_section_failure;
#else
typedef int32_t enmm_section_failure;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Kind of a port.
 */
enum enmm_port_type
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A block: takes force and moment (enmm_set_block_force with the id of enmm_port_block).
   */
  ENMM_PORT_BLOCK = 0,
  /**
   * A part of the outer boundary: takes traction and pressure.
   */
  ENMM_PORT_BOUNDARY = 1,
  /**
   * Faces of joints: takes fluid pressure.
   */
  ENMM_PORT_JOINT = 2,
  /**
   * A quiet boundary: takes the particle velocity of the wave that comes in (enmm_set_port_velocity).
   */
  ENMM_PORT_QUIET = 3,
  /**
   * A held point or edge: takes the velocity or the displacement with which it is moved.
   */
  ENMM_PORT_FIX = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_port_type enmm_port_type;
#else
typedef int32_t enmm_port_type;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How inputs go through a communication step.
 */
enum enmm_interpolation
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A value that was set acts from the start of the next step on (as at the creation of a model).
   */
  ENMM_INTERPOLATION_HOLD = 0,
  /**
   * A value that was set is reached at the end of the next step, linearly from the one before.
   */
  ENMM_INTERPOLATION_LINEAR = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_interpolation enmm_interpolation;
#else
typedef int32_t enmm_interpolation;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * An input, for enmm_set_input_interpolation.
 */
enum enmm_input
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Gravity.
   */
  ENMM_INPUT_GRAVITY = 0,
  /**
   * Acceleration of the base.
   */
  ENMM_INPUT_BASE_ACCELERATION = 1,
  /**
   * Height of the water.
   */
  ENMM_INPUT_WATER_LEVEL = 2,
  /**
   * Factor on the strength of joints.
   */
  ENMM_INPUT_STRENGTH_FACTOR = 3,
  /**
   * Force and moment of the block that the index names.
   */
  ENMM_INPUT_BLOCK = 4,
  /**
   * Inputs of the port that the index names.
   */
  ENMM_INPUT_PORT = 5,
  /**
   * Level of the head that the index names.
   */
  ENMM_INPUT_HEAD = 6,
  /**
   * Rate of the rain that the index names.
   */
  ENMM_INPUT_RAIN = 7,
  /**
   * Whether the drain acts that the index names; it is a switch in either way.
   */
  ENMM_INPUT_DRAIN = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_input enmm_input;
#else
typedef int32_t enmm_input;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Kinds of things that have a number and a name.
 */
enum enmm_name_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A joint trace, which events name by its number.
   */
  ENMM_NAME_JOINT = 0,
  /**
   * A joint law, which contacts name by its number.
   */
  ENMM_NAME_LAW = 1,
  /**
   * A rock, in the alphabetical order of their names.
   */
  ENMM_NAME_ROCK = 2,
  /**
   * A stage, in the order of the case.
   */
  ENMM_NAME_STAGE = 3,
  /**
   * A block.
   */
  ENMM_NAME_BLOCK = 4,
  /**
   * A place that the case names by `[[monitor]]`, in its order.
   */
  ENMM_NAME_MONITOR = 5,
  /**
   * A port, in the order of the case.
   */
  ENMM_NAME_PORT = 6,
  /**
   * A head of water in joints, in the order of the case.
   */
  ENMM_NAME_HEAD = 7,
  /**
   * Rain on joints, in the order of the case.
   */
  ENMM_NAME_RAIN = 8,
  /**
   * A drain, in the order of the case.
   */
  ENMM_NAME_DRAIN = 9,
  /**
   * A place on a joint that the case names by `[[joint_monitor]]`, in its order.
   */
  ENMM_NAME_JOINT_MONITOR = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum enmm_name_kind enmm_name_kind;
#else
typedef int32_t enmm_name_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A model. The handle is a number that is never dereferenced: a NULL or dead handle is an error and never a crash.
 */
typedef struct enmm_model enmm_model;

/**
 * A saved state of a model; it may outlive the model. The handle is as safe as that of a model.
 */
typedef struct enmm_state enmm_state;

/**
 * How the search for the initial equilibrium ended.
 */
typedef struct enmm_start_info {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * 1 when it has been sought, by a start or by the first step; else 0, as all that follows.
   */
  uint32_t started;
  /**
   * 1 when the model came to rest. When it did not, the slope moves, or its static stage needs a longer duration:
   * the model slides from time 0 on.
   */
  uint32_t settled;
  /**
   * 1 when the slope had failed at the end of the last search of this model.
   */
  uint32_t failed;
  /**
   * 0.
   */
  uint32_t reserved;
  /**
   * Internal steps that the search took.
   */
  uint64_t steps;
  /**
   * Net over applied force at its end when the model did not come to rest; 0 when it did.
   */
  double unbalanced;
} enmm_start_info;

/**
 * Outcome of a communication step.
 */
typedef struct enmm_step_info {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Time that the model has reached (s): t + h.
   */
  double time;
  /**
   * Internal steps, parts of one included.
   */
  uint64_t steps;
  /**
   * Largest internal step (s), at most the critical one.
   */
  double dt;
  /**
   * Events of this step.
   */
  size_t event_count;
  /**
   * Index of the first of them (enmm_get_events takes it).
   */
  size_t first_event;
  /**
   * Internal steps that were redone in halves.
   */
  uint64_t halved;
  /**
   * Sub-steps whose contact forces did not settle; 0 in a sound run.
   */
  uint64_t unsettled;
} enmm_step_info;

/**
 * Takes the messages of a model. It is called on the thread of a call to the model, when that call is otherwise done,
 * so that it may call any function: it may step the model, set another callback, or destroy the model, after which no
 * further message comes. Until it returns, the model is this thread's, and other threads get ENMM_BUSY. `message` is
 * valid during the call. It must return: no longjmp, no exception.
 */
typedef void (*enmm_log_callback)(void *user, enmm_log_level level, const char *message);

/**
 * How far a call has come.
 */
typedef struct enmm_progress {
  /**
   * Size of this structure (bytes), set by the library.
   */
  size_t struct_size;
  /**
   * Time reached (s): that of the model or, in the initial equilibrium, since its start.
   */
  double time;
  /**
   * End of the communication step (s), or the most time that the initial equilibrium may take; it ends when the
   * model is at rest.
   */
  double end;
  /**
   * In the initial equilibrium the last net over applied force that is known; -1 for none.
   */
  double unbalanced;
  /**
   * 1 while a call seeks the initial equilibrium, else 0.
   */
  uint32_t is_equilibrium;
  /**
   * 0.
   */
  uint32_t reserved;
} enmm_progress;

/**
 * Sees the progress of enmm_start and enmm_do_step. It is called on the thread of the call, between internal steps, at
 * most every 50 ms. A result other than 0 ends the call with ENMM_INTERRUPTED. The call is working on the model
 * meanwhile: other calls with it get ENMM_BUSY, but for enmm_interrupt and enmm_destroy. `progress` is valid during
 * the call. It must return: no longjmp, no exception.
 */
typedef int32_t (*enmm_progress_callback)(const struct enmm_progress *progress, void *user);

/**
 * Water at a head, in rain or at a drain, as the flow was found last.
 */
typedef struct enmm_inlet_state {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Water that enters joints there, less what leaves them (m2/s).
   */
  double inflow;
  /**
   * Water that leaves joints there, less what enters them (m2/s).
   */
  double outflow;
  /**
   * Rain that joints do not take, 0 at heads and drains (m2/s).
   */
  double run_off;
} enmm_inlet_state;

/**
 * A monitor now. Its velocity is that of half an internal step ago.
 */
typedef struct enmm_monitor_state {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Displacement, x (m).
   */
  double displacement_x;
  /**
   * Displacement, y up (m).
   */
  double displacement_y;
  /**
   * Velocity, x (m/s).
   */
  double velocity_x;
  /**
   * Velocity, y up (m/s).
   */
  double velocity_y;
} enmm_monitor_state;

/**
 * Stress at a monitor now, of the plane through the stresses of the elements about it.
 */
typedef struct enmm_monitor_stress {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Stress xx, tension positive (Pa).
   */
  double stress_xx;
  /**
   * Stress yy, tension positive (Pa).
   */
  double stress_yy;
  /**
   * Stress xy (Pa).
   */
  double stress_xy;
  /**
   * Greatest principal stress in the plane (Pa).
   */
  double principal_max;
  /**
   * Least principal stress in the plane: the greatest compression (Pa).
   */
  double principal_min;
  /**
   * Direction of the greatest compression from the x axis, counter-clockwise (rad).
   */
  double principal_angle;
} enmm_monitor_stress;

/**
 * A monitor of a joint now. Slip and shear stress are positive where the far side goes, or is pushed, to the right.
 */
typedef struct enmm_joint_monitor_state {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Opening at the place, apart positive (m).
   */
  double opening;
  /**
   * Slip along the joint, far side to the right positive (m).
   */
  double slip;
  /**
   * Normal stress between the faces, tension positive (Pa).
   */
  double normal_stress;
  /**
   * Shear stress between the faces, as the slip (Pa).
   */
  double shear_stress;
} enmm_joint_monitor_state;

/**
 * A block now. Velocities are those of half an internal step ago, as the method has them.
 */
typedef struct enmm_block_state {
  /**
   * Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
   */
  size_t struct_size;
  /**
   * Block id: 0, 1, ...
   */
  uint32_t id;
  /**
   * Sum of ENMM_BLOCK_FIXED, ENMM_BLOCK_DETACHED, ENMM_BLOCK_FAILED, ENMM_BLOCK_REMOVED.
   */
  uint32_t flags;
  /**
   * Mass centroid now, x (m).
   */
  double centroid_x;
  /**
   * Mass centroid now, y up (m).
   */
  double centroid_y;
  /**
   * Displacement of the mass centroid, x (m).
   */
  double displacement_x;
  /**
   * Displacement of the mass centroid, y up (m).
   */
  double displacement_y;
  /**
   * Rotation, counter-clockwise, within -pi and pi (rad).
   */
  double rotation;
  /**
   * Velocity of the mass centroid, x (m/s).
   */
  double velocity_x;
  /**
   * Velocity of the mass centroid, y up (m/s).
   */
  double velocity_y;
  /**
   * Angular velocity, counter-clockwise (rad/s).
   */
  double angular_velocity;
  /**
   * Area mean of the stress xx, tension positive (Pa).
   */
  double mean_stress_xx;
  /**
   * Area mean of the stress yy, tension positive (Pa).
   */
  double mean_stress_yy;
  /**
   * Area mean of the stress xy (Pa).
   */
  double mean_stress_xy;
  /**
   * Area in the reference configuration (m2).
   */
  double area;
  /**
   * Mass (kg/m).
   */
  double mass;
  /**
   * Kinetic energy (J/m).
   */
  double kinetic_energy;
  /**
   * Strain energy (J/m).
   */
  double strain_energy;
  /**
   * Contacts on the block that carry force.
   */
  ENMM_UNION { uint32_t contacts; uint32_t contact_count; };
  /**
   * 0.
   */
  uint32_t reserved;
  /**
   * Largest penetration (m).
   */
  ENMM_UNION { double penetration_max; double largest_penetration; };
  /**
   * Speed of the centroid (m/s).
   */
  double speed;
} enmm_block_state;

/**
 * Energies and works half an internal step ago, as velocities are, per metre of thickness; what contacts, supports and
 * bolts store is that of the start of the last internal step. kinetic + strain + potential + damping + yielding
 * equals contact_work + support_work + bolt_work + radiation + external_work + baseline + residual.
 */
typedef struct enmm_energies {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Kinetic energy (J/m).
   */
  double kinetic;
  /**
   * Strain energy (J/m).
   */
  double strain;
  /**
   * Potential energy of gravity, from the undeformed state on (J/m).
   */
  double potential;
  /**
   * Energy in contact and support springs (J/m).
   */
  double stored;
  /**
   * Energy turned into heat by slip (J/m).
   */
  double friction;
  /**
   * Work of contact forces on the blocks (J/m).
   */
  double contact_work;
  /**
   * Work of supports on the blocks (J/m).
   */
  double support_work;
  /**
   * Energy taken by damping (J/m).
   */
  double damping;
  /**
   * Work of loads and inputs, and of gravity while it grows or changes (J/m).
   */
  double external_work;
  /**
   * Energy of the start, less what left with excavated blocks (J/m).
   */
  double baseline;
  /**
   * Energy that contacts and supports lost in other ways than slip (J/m).
   */
  double contact_dissipation;
  /**
   * Energy that appeared from nowhere: the error of the time steps (J/m).
   */
  double residual;
  /**
   * Energy taken by yielding rock (J/m).
   */
  double yielding;
  /**
   * Work of bolts on the blocks (J/m).
   */
  double bolt_work;
  /**
   * Work of quiet boundaries and free-field columns: less what waves carry away (J/m).
   */
  double radiation;
  /**
   * Energy in bolts (J/m).
   */
  double bolt_stored;
  /**
   * Energy that bolts were installed with by their pretension (J/m).
   */
  double bolt_installed;
  /**
   * Energy that bolts lost by yielding and rupture: installed less work and stored (J/m).
   */
  double bolt_dissipation;
  /**
   * Energy of fracture of joints that soften (J/m).
   */
  double fracture;
} enmm_energies;

/**
 * Sums and extremes over the model.
 */
typedef struct enmm_totals {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Largest displacement of a cover (m).
   */
  double displacement_max;
  /**
   * Largest velocity of a cover (m/s).
   */
  double velocity_max;
  /**
   * Largest penetration so far (m).
   */
  double penetration_max;
  /**
   * Net over applied force, near 0 at rest; where nothing is applied 1, or 0 when all is balanced.
   */
  double unbalanced;
  /**
   * Stability limit of the internal step (s).
   */
  double critical_dt;
  /**
   * Contacts without force.
   */
  uint32_t open_contacts;
  /**
   * Contacts at their shear limit.
   */
  uint32_t slipping_contacts;
  /**
   * Contacts below their shear limit.
   */
  uint32_t locked_contacts;
  /**
   * Blocks that have lost their last contact at least once.
   */
  uint32_t detached_blocks;
  /**
   * Joints that have slipped.
   */
  uint32_t slipped_joints;
  /**
   * Blocks that have failed.
   */
  uint32_t failed_blocks;
  /**
   * Greatest depth of overlaps of blocks so far, 0 for none (m).
   */
  double overlap_max;
  /**
   * Pairs of blocks that have overlapped.
   */
  uint64_t overlapping_pairs;
  /**
   * Bonded length of rock bridges and joints that has broken (m).
   */
  double broken_length;
  /**
   * Joints whose last bond has broken.
   */
  uint64_t broken_joints;
  /**
   * Water that has entered joints in dynamic stages, m3 per metre (m2).
   */
  double water_entered;
  /**
   * Water that has left joints in dynamic stages, m3 per metre (m2).
   */
  double water_left;
  /**
   * Largest imbalance of the flow at a node of the joints (m2/s).
   */
  double flow_residual;
  /**
   * Height of the highest outcrop from which water seeps, of the lowest joint where none does (m).
   */
  double seepage_height;
  /**
   * Water that joints have taken in dynamic stages, m3 per metre (m2).
   */
  double water_stored;
  /**
   * Length of wet joints that have parted, whose water pushes no more (m).
   */
  double flow_parted;
  /**
   * Pieces of wet joints that have parted.
   */
  uint64_t flow_parted_pieces;
} enmm_totals;

/**
 * A contact between a boundary node of one block and an edge of another.
 */
typedef struct enmm_contact {
  /**
   * Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
   */
  size_t struct_size;
  /**
   * Open, slip or lock.
   */
  enmm_contact_state state;
  /**
   * Joint law: its place among the names of the laws of the case in alphabetical order, from 0; see enmm_name.
   */
  uint32_t law;
  /**
   * Block of the node.
   */
  uint32_t node_block;
  /**
   * Block of the edge.
   */
  uint32_t edge_block;
  /**
   * Node now, x (m).
   */
  double position_x;
  /**
   * Node now, y (m).
   */
  double position_y;
  /**
   * Outward unit normal of the edge, x.
   */
  double normal_x;
  /**
   * Outward unit normal of the edge, y.
   */
  double normal_y;
  /**
   * Length of boundary that the node stands for (m).
   */
  double length;
  /**
   * Normal stress (Pa, tension positive).
   */
  double normal_stress;
  /**
   * Shear stress (Pa), on the node, positive along the normal turned by 90 degrees counter-clockwise.
   */
  double shear_stress;
} enmm_contact;

/**
 * Something that happened for the first time.
 */
typedef struct enmm_event {
  /**
   * Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
   */
  size_t struct_size;
  /**
   * Kind of the event.
   */
  enmm_event_kind kind;
  /**
   * Block id; for a slip or a broken bond the number of the joint trace, or ENMM_NO_JOINT; of two blocks that
   * overlap the lower id. enmm_name has the names.
   */
  uint32_t subject;
  /**
   * End of the internal step in which it happened (s), as enmm_get_time counts.
   */
  double time;
  /**
   * Higher block id of two blocks that overlap; ENMM_NO_BLOCK for events of other kinds.
   */
  uint32_t other;
  /**
   * 0.
   */
  uint32_t reserved;
  /**
   * Depth of an overlap when it was found (m); 0 for events of other kinds.
   */
  double depth;
} enmm_event;

/**
 * A section of rock that has broken and is a joint since then.
 */
typedef struct enmm_cut {
  /**
   * Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
   */
  size_t struct_size;
  /**
   * Block that broke; its part with the point of a port, or else with its reference point, keeps the id.
   */
  uint32_t block;
  /**
   * Id of the part that is new.
   */
  uint32_t part;
  /**
   * How it broke.
   */
  enmm_section_failure failure;
  /**
   * 0.
   */
  uint32_t reserved;
  /**
   * End of the internal step in which it broke (s), as enmm_get_time counts.
   */
  double time;
  /**
   * First end in the reference configuration, x (m).
   */
  double first_x;
  /**
   * First end, y up (m).
   */
  double first_y;
  /**
   * Second end, x (m).
   */
  double second_x;
  /**
   * Second end, y up (m).
   */
  double second_y;
  /**
   * Share of its strength that it carried, 1 or a little more.
   */
  double share;
  /**
   * Normal force that it carried (N/m, tension positive).
   */
  double normal_force;
  /**
   * Shear force that it carried (N/m).
   */
  double shear_force;
  /**
   * Bending moment about its middle that it carried (N*m/m).
   */
  double moment;
} enmm_cut;

/**
 * A port now. A block fills all from its displacement to its stress; a boundary displacement, velocity and stress;
 * joints normal_force, shear_force, slip and, in a case with `[flow]`, the water in them; a quiet boundary
 * displacement, velocity and traction; a fixity displacement, velocity and reaction. What is not filled is 0. Motions
 * of a block are those of its mass centroid, of a boundary the mean along it.
 */
typedef struct enmm_port_state {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Displacement, x (m).
   */
  double displacement_x;
  /**
   * Displacement, y up (m).
   */
  double displacement_y;
  /**
   * Velocity, x (m/s).
   */
  double velocity_x;
  /**
   * Velocity, y up (m/s).
   */
  double velocity_y;
  /**
   * Rotation, counter-clockwise (rad).
   */
  double rotation;
  /**
   * Angular velocity, counter-clockwise (rad/s).
   */
  double angular_velocity;
  /**
   * Sum of the contact forces on the block per metre, x (N/m).
   */
  double contact_force_x;
  /**
   * Sum of the contact forces on the block per metre, y (N/m).
   */
  double contact_force_y;
  /**
   * Mean stress xx, tension positive (Pa).
   */
  double stress_xx;
  /**
   * Mean stress yy, tension positive (Pa).
   */
  double stress_yy;
  /**
   * Mean stress xy (Pa).
   */
  double stress_xy;
  /**
   * Sum of the normal forces across the joints, compression positive (N/m).
   */
  double normal_force;
  /**
   * Sum of the magnitudes of the shear forces along the joints (N/m).
   */
  double shear_force;
  /**
   * Largest accumulated slip along the joints (m).
   */
  double slip;
  /**
   * Mean traction of the quiet boundary on the rock, x (Pa).
   */
  double traction_x;
  /**
   * Mean traction of the quiet boundary on the rock, y (Pa).
   */
  double traction_y;
  /**
   * Force of the moved supports on the rock per metre, x (N/m).
   */
  double reaction_x;
  /**
   * Force of the moved supports on the rock per metre, y (N/m).
   */
  double reaction_y;
  /**
   * Mean pressure of the water that flows in the joints (Pa).
   */
  double water_pressure;
  /**
   * Largest pressure of the water that flows in the joints (Pa).
   */
  double water_pressure_max;
  /**
   * Force of the water that flows in the joints on each of their faces, which pushes them apart (N/m).
   */
  double uplift;
} enmm_port_state;

/**
 * Samples of enmm_rollout.
 */
typedef struct enmm_rollout_plan {
  /**
   * Size of this structure (bytes), set by the caller.
   */
  size_t struct_size;
  /**
   * Number of samples.
   */
  size_t samples;
  /**
   * States from which the samples go on: one for all, or one for each.
   */
  struct enmm_state *const *states;
  /**
   * Number of states: 1, or that of the samples.
   */
  size_t state_count;
  /**
   * Parameters that are set in each sample (enmm_find_parameter); may be NULL when there are none.
   */
  const uint32_t *parameters;
  /**
   * Number of parameters.
   */
  size_t parameter_count;
  /**
   * Their values: samples * parameter_count numbers, those of one sample after those of another.
   */
  const double *values;
  /**
   * Communication step (s).
   */
  double step;
  /**
   * Number of communication steps of each sample.
   */
  size_t steps;
  /**
   * Port of each output.
   */
  const uint32_t *ports;
  /**
   * Quantity of each output: its place among the members of enmm_port_state behind struct_size, from 0.
   */
  const uint32_t *quantities;
  /**
   * Number of outputs.
   */
  size_t output_count;
  /**
   * Number of threads, 1 to 1024; the bits do not depend on it.
   */
  size_t threads;
} enmm_rollout_plan;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Version of the library, such as "0.1.0". The text is never freed.
 */
const char *enmm_version(void);

/**
 * Version of the binary interface of the library; a program can use the library when this equals ENMM_ABI_VERSION of
 * the header it was compiled with.
 */
uint32_t enmm_abi_version(void);

/**
 * Message of the last call that failed on the calling thread: fault, value, limit and remedy. It is empty when none
 * has failed.
 *
 * The address is the same for all calls of a thread and valid until the thread ends; the next call that fails there
 * replaces the text. A message of more than 4095 bytes ends with "...".
 */
const char *enmm_last_error(void);

/**
 * Name of a status, such as "ENMM_BUSY"; "unknown status" for a number that is none. The text is never freed.
 */
const char *enmm_status_name(int32_t status);

/**
 * Builds the model of a case file. Nothing moves yet.
 *
 * `case_path` is a path in UTF-8; files that the case names are relative to its directory. `*out` gets the handle,
 * which enmm_destroy frees, or NULL on failure.
 *
 * Errors: ENMM_FILE_ERROR, ENMM_INVALID_CASE with file, line and key, ENMM_INVALID_ARGUMENT, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_create_from_file(const char *case_path, struct enmm_model **out);

/**
 * Builds the model of a case that is given as text in TOML.
 *
 * `base_dir` is the directory of the files that the case names; NULL stands for the current one. `*out` gets the
 * handle, which enmm_destroy frees, or NULL on failure.
 *
 * Errors: as enmm_create_from_file; the text is called "case" in messages.
 */
enmm_status enmm_create_from_string(const char *toml, const char *base_dir, struct enmm_model **out);

/**
 * Checks a case that is given as text in TOML: its keys, the type and range of every value, the names that it uses,
 * and the files that it names. No model is built, so a fault of the geometry as a whole appears only when one is.
 *
 * `base_dir` is the directory of the files that the case names; NULL stands for the current one.
 *
 * Errors: as enmm_create_from_string.
 */
enmm_status enmm_check_case(const char *toml, const char *base_dir);

/**
 * Ends a model and frees its memory; ends its recording, if there is one. NULL and dead handles do nothing. When
 * another thread is in a call with the model, that call ends normally; later ones return ENMM_DEAD_HANDLE.
 *
 * It never waits. After it returns, the log callback gets no further message on the calling thread. When another
 * thread is in a call with the model, the callback may still run or start there, and its `user` must not be freed
 * until that call has returned.
 */
void enmm_destroy(struct enmm_model *model);

/**
 * Computes the initial equilibrium with the inputs that have been set: runs the static stages before the first dynamic
 * one. Without this call the first enmm_do_step does so. A second call does nothing. Time 0 is the end of the
 * equilibrium. enmm_get_start_info says whether the model came to rest.
 *
 * Errors: ENMM_NUMERICAL_FAILURE; ENMM_INVALID_CASE when a stage does not fit the model; ENMM_INTERRUPTED.
 */
enmm_status enmm_start(struct enmm_model *model);

/**
 * Writes how the search for the initial equilibrium ended. `info->struct_size` must be set.
 *
 * A model that did not come to rest is no error: enmm_start and enmm_do_step return ENMM_OK, and the log warns.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_start_info(struct enmm_model *model, struct enmm_start_info *info);

/**
 * Advances the model from `t` to exactly `t + h` (s), or not at all.
 *
 * `t` must be the time of the model. Internal steps, not longer than the critical one, cover the interval. The
 * division of a time into communication steps does not change results when they are multiples of the internal step.
 * Inputs that were set before act from `t` on, or are reached at `t + h` (see enmm_set_interpolation). After its end
 * the last stage of the case continues. `info` may be NULL; otherwise its `struct_size` must be set.
 *
 * Errors: ENMM_WRONG_TIME; ENMM_INVALID_ARGUMENT when `h` is not greater than 0 and finite; ENMM_NUMERICAL_FAILURE
 * with block, position and cause; ENMM_INTERRUPTED. The model is then the same as before, to the bit. Without
 * enmm_start the first step also computes the initial equilibrium, and discards it when the step fails.
 */
enmm_status enmm_do_step(struct enmm_model *model, double t, double h, struct enmm_step_info *info);

/**
 * Returns the time of the model (s): 0 at the start of the first dynamic stage.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_time(struct enmm_model *model, double *time);

/**
 * Returns the internal step (s), an integer fraction of a tenth of the communication step.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_internal_step(struct enmm_model *model, double *step);

/**
 * Returns the communication step (s) that the case suggests; hosts may use any other.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_communication_step(struct enmm_model *model, double *step);

/**
 * Returns the time (s) at which the stages of the case end; hosts may continue.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_stop_time(struct enmm_model *model, double *time);

/**
 * Sets the number of threads that steps use, 1 to 1024; 1, the thread of the call, at the creation. Results do not
 * depend on it, not even in the last bit. Acts from the next step on. A process that is forked from this one has
 * none of the threads: a model that it uses starts the same number again at its next step.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another number, or more than the system grants; in a forked process enmm_do_step
 * and enmm_start can return it as well.
 */
enmm_status enmm_set_threads(struct enmm_model *model, size_t threads);

/**
 * Sets the callback for messages of this model; NULL (as at creation) discards them. The first callback gets the
 * warnings of the case at once; later messages are delivered at the end of the calls that they belong to.
 *
 * `user` is passed to the callback unchanged. After this function has replaced the callback, `user` is no longer
 * used, except by a message that is just being delivered. That happens only when a callback replaces itself: while
 * another thread delivers, this function returns ENMM_BUSY. Messages that have not been delivered yet go to the new
 * callback. For the end of the model see enmm_destroy.
 *
 * Errors: ENMM_BUSY when another thread is in a call with the model, messages of the call included.
 */
enmm_status enmm_set_log_callback(struct enmm_model *model, enmm_log_callback callback, void *user);

/**
 * Ends the call of enmm_start or enmm_do_step that is in progress with this model, in any thread: it returns
 * ENMM_INTERRUPTED before its next internal step, and the model is as it was before the call, to the bit.
 *
 * It never waits and needs no turn at the model. Without a call in progress it does nothing: a call forgets what came
 * before it, so that an interrupt just before a call begins has no effect, and a host that cannot know repeats it
 * until the call has returned. A call that has taken its last internal step ends as if nothing had come. It locks a
 * table for an instant and so must not be called in a signal handler: set a flag there, and return it from the
 * progress callback.
 *
 * Errors: ENMM_NULL_ARGUMENT, ENMM_DEAD_HANDLE.
 */
enmm_status enmm_interrupt(struct enmm_model *model);

/**
 * Sets the callback that sees the progress of calls with this model and may end them; NULL (as at creation) for none.
 *
 * `user` is passed to the callback unchanged, and no longer used after this function has replaced the callback.
 *
 * Errors: ENMM_BUSY when a call is in progress, as in the callback itself.
 */
enmm_status enmm_set_progress_callback(struct enmm_model *model, enmm_progress_callback callback, void *user);

/**
 * Writes the fingerprint of the case: 16 hexadecimal digits, equal for equal models, and part of every serialised
 * state.
 *
 * `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
 * that number.
 *
 * Errors: ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_case_hash(struct enmm_model *model, char *out, size_t capacity, size_t *written);

/**
 * Sets gravity (m/s2, x to the right, y upwards; on Earth 0 and -9.81).
 *
 * Acts from the start of the next step on, or is reached at its end (enmm_set_interpolation), and holds until it is
 * set again; so do all inputs. In the initial equilibrium it grows from 0.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a value that is not finite or beyond 1e4 m/s2; the old value then stays in force.
 */
enmm_status enmm_set_gravity(struct enmm_model *model, double gx, double gy);

/**
 * Sets force (N per metre of thickness, x to the right, y upwards) through the mass centroid of a block, and moment
 * about it (N*m per metre, counter-clockwise). They replace those that were set before, or that a port of the case has
 * at the start; loads of the case stay.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a block that does not exist, or a value that is not finite or beyond 1e15.
 */
enmm_status enmm_set_block_force(struct enmm_model *model, uint32_t block, double fx, double fy, double moment);

/**
 * Sets force and moment of `n` blocks at once: all, or none when one value is refused.
 *
 * `ids`, `fx`, `fy` and `m` hold `n` values each, with the units of enmm_set_block_force. If a block is named twice,
 * its last values count. Blocks that are not named keep their force.
 *
 * Errors: as enmm_set_block_force, for the first block that is refused; ENMM_NULL_ARGUMENT when `n` is not 0.
 */
enmm_status enmm_set_block_forces(struct enmm_model *model,
                                  const uint32_t *ids,
                                  size_t n,
                                  const double *fx,
                                  const double *fy,
                                  const double *m);

/**
 * Sets the acceleration of the base (m/s2, x to the right, y upwards). Displacements and velocities are relative to
 * the base; all rock feels the opposite acceleration. It does not act on the initial equilibrium and begins at time 0.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a value that is not finite or beyond 1e4 m/s2.
 */
enmm_status enmm_set_base_acceleration(struct enmm_model *model, double ax, double ay);

/**
 * Sets the height y of the water surface (m, upwards, in the coordinates of the case). The case must have `[water]`.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a case without water, or a value that is not finite or beyond 1e9 m.
 */
enmm_status enmm_set_water_level(struct enmm_model *model, double y);

/**
 * Sets traction (Pa, global axes, per length before deformation) on a boundary port; positive pushes to the right and
 * upwards.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is not a boundary, or a value that is not finite or
 * beyond 1e15 Pa.
 */
enmm_status enmm_set_boundary_traction(struct enmm_model *model, uint32_t port, double tx, double ty);

/**
 * Sets fluid pressure (Pa) on a boundary port; positive pushes into the rock, normal to its current surface.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: as enmm_set_boundary_traction.
 */
enmm_status enmm_set_boundary_pressure(struct enmm_model *model, uint32_t port, double p);

/**
 * Sets fluid pressure (Pa) in the joints of a joint port; positive pushes both faces into their rock, apart.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is not one of joints, or a value that is not finite
 * or beyond 1e15 Pa.
 */
enmm_status enmm_set_joint_pressure(struct enmm_model *model, uint32_t port, double p);

/**
 * Sets the factor by which cohesion, tan(friction angle) and tensile strength of all joints and of rock that yields or
 * breaks are multiplied; 1 is the strength of the case.
 *
 * Acts at the same times as enmm_set_gravity.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a value that is not at least 0 and at most 1e6.
 */
enmm_status enmm_set_strength_factor(struct enmm_model *model, double f);

/**
 * Sets the particle velocity (m/s, x to the right, y upwards) of the wave that comes in through a quiet boundary, or
 * the velocity with which the supports of a held point or edge move. It acts in dynamic stages, beside what the case
 * says.
 *
 * Acts at the same times as enmm_set_gravity; a linear way is taken exactly, its bends included.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is of another kind, or a value that is not finite or
 * beyond 1e4 m/s.
 */
enmm_status enmm_set_port_velocity(struct enmm_model *model, uint32_t port, double vx, double vy);

/**
 * Sets the displacement (m) that the supports of a held point or edge have reached at the end of the next step,
 * counted from their place before a host has moved them. They go there at a steady velocity and stay, unless it is set
 * again.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or is of another kind, or a value that is not finite or
 * beyond 1e9 m.
 */
enmm_status enmm_set_port_displacement(struct enmm_model *model, uint32_t port, double ux, double uy);

/**
 * Sets the level (m, upwards, in the coordinates of the case) of a `[[head]]`, by its place in the case, from 0;
 * enmm_find_name finds it by name.
 *
 * Acts where the flow in joints is found: at the start of static stages, and in dynamic stages with `flow = "steady"`
 * or `flow = "transient"` on the grid of internal steps; else at the same times as enmm_set_gravity. A stage that
 * names the head ends it.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a head that does not exist, a value that is not finite or beyond 1e9 m, or a
 * model whose flow is held from now on.
 */
enmm_status enmm_set_head(struct enmm_model *model, uint32_t head, double level);

/**
 * Sets the rate (m/s, that is m3/s on each m2 in plan) of a `[[rain]]`, by its place in the case, from 0.
 *
 * Acts as enmm_set_head.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a rain that does not exist, a value that is not at least 0 and at most 1e-3, or a
 * model whose flow is held from now on.
 */
enmm_status enmm_set_rain(struct enmm_model *model, uint32_t rain, double rate);

/**
 * Lets a `[[drain]]` act, or not where `is_active` is 0, by its place in the case, from 0. It is a switch: it acts as
 * enmm_set_head, but never linearly.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a drain that does not exist, or a model whose flow is held from now on.
 */
enmm_status enmm_set_drain(struct enmm_model *model, uint32_t drain, int32_t is_active);

/**
 * Makes all inputs that have been set since the last step act at once from the start of the next one, even where
 * inputs vary linearly: an anchor is lost. Inputs that are set after this call go their way from there.
 */
enmm_status enmm_jump(struct enmm_model *model);

/**
 * Sets how one input varies within a communication step: `input` is a value of enmm_input, `index` the block, port,
 * head, rain or drain where it has one, `mode` a value of enmm_interpolation. Acts from the next step on, and is part
 * of saved states. enmm_set_interpolation sets that of all inputs.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another number, or an index that does not exist.
 */
enmm_status enmm_set_input_interpolation(struct enmm_model *model, int32_t input, uint32_t index, int32_t mode);

/**
 * Returns the inputs that are set now: gravity (m/s2, two numbers), acceleration of the base (m/s2, two numbers),
 * height of the water (m; 0 without water), factor on the strength of joints. Pointers may be NULL where the value is
 * of no interest.
 */
enmm_status enmm_get_inputs(struct enmm_model *model,
                            double *gravity,
                            double *base_acceleration,
                            double *water_level,
                            double *strength_factor);

/**
 * Returns the force (N/m, two numbers) and the moment (N*m/m) that are set on a block now. Pointers may be NULL where
 * the value is of no interest.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a block that does not exist.
 */
enmm_status enmm_get_block_force(struct enmm_model *model, uint32_t block, double *force, double *moment);

/**
 * Returns what is set on a port now: traction (Pa, two numbers), pressure (Pa) and velocity (m/s, two numbers); 0
 * where its kind takes no such input. For a block see enmm_get_block_force. Pointers may be NULL where the value is of
 * no interest.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist.
 */
enmm_status enmm_get_port_inputs(struct enmm_model *model,
                                 uint32_t port,
                                 double *traction,
                                 double *pressure,
                                 double *velocity);

/**
 * Returns what is set at a head (level, m), in rain (rate, m/s) or at a drain (1 where it acts, else 0): `kind` is
 * ENMM_NAME_HEAD, ENMM_NAME_RAIN or ENMM_NAME_DRAIN, `index` its place in the case.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another kind or a place that does not exist, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_inlet_input(struct enmm_model *model, int32_t kind, uint32_t index, double *value);

/**
 * Sets how inputs vary within a communication step: a value of enmm_interpolation. Acts from the next step on, and is
 * part of saved states.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another number.
 */
enmm_status enmm_set_interpolation(struct enmm_model *model, int32_t mode);

/**
 * Returns how inputs vary within a communication step: a value of enmm_interpolation.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_interpolation(struct enmm_model *model, int32_t *mode);

/**
 * Returns the number of parameters: properties of the case that have a name and can be set. It never changes.
 *
 * Names are such as "joint_law.weak.friction", "rock.granite.young", "damping", "water.density" and
 * "bolt.anchor.active". Values are in SI units, angles in radians. enmm_parameter_range returns which of them may
 * change after the start.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_parameter_count(struct enmm_model *model, size_t *count);

/**
 * Returns the index of the parameter of this name.
 *
 * Errors: ENMM_NOT_FOUND, with the names that there are; ENMM_INVALID_ARGUMENT for a text that is not UTF-8,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_find_parameter(struct enmm_model *model, const char *name, uint32_t *parameter);

/**
 * Writes the name of a parameter in UTF-8.
 *
 * `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
 * that number.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_parameter_name(struct enmm_model *model,
                                uint32_t parameter,
                                char *out,
                                size_t capacity,
                                size_t *written);

/**
 * Writes the SI unit of a parameter, such as "Pa" or "rad"; an empty text for a number without one.
 *
 * Buffer and errors as enmm_parameter_name.
 */
enmm_status enmm_parameter_unit(struct enmm_model *model,
                                uint32_t parameter,
                                char *out,
                                size_t capacity,
                                size_t *written);

/**
 * Writes what a parameter means, in words.
 *
 * Buffer and errors as enmm_parameter_name.
 */
enmm_status enmm_parameter_description(struct enmm_model *model,
                                       uint32_t parameter,
                                       char *out,
                                       size_t capacity,
                                       size_t *written);

/**
 * Returns the least and the greatest value of a parameter, and whether it is tunable: 1 for one that may change at any
 * time, 0 for one that is fixed after the start. Pointers may be NULL where the value is of no interest.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist.
 */
enmm_status enmm_parameter_range(struct enmm_model *model,
                                 uint32_t parameter,
                                 double *low,
                                 double *high,
                                 int32_t *tunable);

/**
 * Returns the value of a parameter now. Strengths are those at time 0 until then, and after it those that hold.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_parameter(struct enmm_model *model, uint32_t parameter, double *value);

/**
 * Sets a parameter.
 *
 * Before the start the model is rebuilt with the value, and inputs stay; the initial equilibrium is then that of
 * the value. After the start a tunable parameter acts from the next step on, until a stage of the case changes it.
 * Values are part of saved states. Friction angle and cohesion are peak and residual ones alike. A bolt that is made
 * active is installed at its length of now with its pretension.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a parameter that does not exist, a value out of its range, or one that is fixed
 * after the start; ENMM_INVALID_CASE when no model can be built with the value. Nothing has changed then.
 */
enmm_status enmm_set_parameter(struct enmm_model *model, uint32_t parameter, double value);

/**
 * Sets `n` parameters at once: all, or none when one value is refused. Before the start they cost one build.
 *
 * Errors: as enmm_set_parameter, for the first one that is refused; ENMM_NULL_ARGUMENT when `n` is not 0.
 */
enmm_status enmm_set_parameters(struct enmm_model *model, const uint32_t *parameters, size_t n, const double *values);

/**
 * Returns the number of things of a kind, a value of enmm_name_kind. It never changes.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another number, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_name_count(struct enmm_model *model, int32_t kind, size_t *count);

/**
 * Writes the name of a thing by its kind, a value of enmm_name_kind, and its number, from 0, in UTF-8.
 *
 * Things without a name in the case get one: `joint[2]` is a joint of the case by its place there, "bedding trace 4"
 * (or `joint_set[1] trace 4`) a trace of a joint set, "rock bridge 7" a rock bridge, "trace 9" any other joint trace,
 * which a region of another law has parted or which surrounds an island, and "block 3" a block. `*written` gets the
 * number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only that number.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a kind or a number that does not exist, ENMM_BUFFER_TOO_SMALL,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_name(struct enmm_model *model,
                      int32_t kind,
                      uint32_t index,
                      char *out,
                      size_t capacity,
                      size_t *written);

/**
 * Returns the number of the thing of a kind, a value of enmm_name_kind, that has a name: the first one of several.
 *
 * Errors: ENMM_NOT_FOUND, ENMM_INVALID_ARGUMENT for another kind, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_find_name(struct enmm_model *model, int32_t kind, const char *name, uint32_t *index);

/**
 * Writes the water that enters and leaves joints at a head, in rain or at a drain: `kind` is ENMM_NAME_HEAD,
 * ENMM_NAME_RAIN or ENMM_NAME_DRAIN, `index` its place in the case. It is that of the flow that was found last.
 * `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for another kind, a place that does not exist or a struct_size that no version had,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_inlet_state(struct enmm_model *model, int32_t kind, uint32_t index, struct enmm_inlet_state *out);

/**
 * Writes the state of a monitor, by its place among the `[[monitor]]`s of the case. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or a struct_size that no version had,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_monitor_state(struct enmm_model *model, uint32_t monitor, struct enmm_monitor_state *out);

/**
 * Writes the stress at a monitor with `stress = true`, by its place among the `[[monitor]]`s of the case; NaN where
 * the rock has been excavated. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or reads no stress, or a struct_size that no version
 * had, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_monitor_stress(struct enmm_model *model, uint32_t monitor, struct enmm_monitor_stress *out);

/**
 * Writes the state of a monitor of a joint, by its place among the `[[joint_monitor]]`s of the case; NaN where a side
 * of the joint has been excavated. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a monitor that does not exist or a struct_size that no version had,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_joint_monitor_state(struct enmm_model *model,
                                         uint32_t monitor,
                                         struct enmm_joint_monitor_state *out);

/**
 * Returns the number of blocks, excavated ones included. It grows when rock breaks and when a stage parts blocks, and
 * falls only with a return to an earlier state; without `fracture` and cuts in the case it never changes. Blocks keep
 * their ids.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_block_count(struct enmm_model *model, size_t *count);

/**
 * Writes the state of every block, by id.
 *
 * `out` holds `capacity` structures; `out[0].struct_size` must be set and is the distance from one to the next.
 * `*written` gets their number. With `out` NULL and `capacity` 0 the call returns only that number.
 *
 * Errors: ENMM_BUFFER_TOO_SMALL, ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_block_states(struct enmm_model *model,
                                  struct enmm_block_state *out,
                                  size_t capacity,
                                  size_t *written);

/**
 * Returns the states of all blocks, by id, in the memory of the model: nothing is copied.
 *
 * `*first` gets the address of the first one, `*stride` the distance (bytes) from one to the next, which is
 * sizeof(enmm_block_state) of the library and so may be more than that of the header, and `*count` their number. The
 * values are worked out at the first look after a step. They may be read until the next call with the model, by
 * whatever thread, and must not be changed.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_view_block_states(struct enmm_model *model,
                                   const struct enmm_block_state **first,
                                   size_t *stride,
                                   size_t *count);

/**
 * Writes energies and works. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_energies(struct enmm_model *model, struct enmm_energies *out);

/**
 * Writes sums and extremes over the model. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a struct_size that no version had, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_totals(struct enmm_model *model, struct enmm_totals *out);

/**
 * Writes the contacts of the last internal step with its forces, at their places now, those without force included.
 * Before the first step of a stage they are those that this step will find, without forces.
 *
 * Buffer and errors as enmm_get_block_states.
 */
enmm_status enmm_get_contacts(struct enmm_model *model, struct enmm_contact *out, size_t capacity, size_t *written);

/**
 * Writes the events from index `first` on (0: all since the start), in the order of time. A return to a saved state
 * restores its events. An event does not change between reads, its time included.
 *
 * Buffer and errors as enmm_get_block_states.
 */
enmm_status enmm_get_events(struct enmm_model *model,
                            size_t first,
                            struct enmm_event *out,
                            size_t capacity,
                            size_t *written);

/**
 * Returns the most blocks that the model can have: those of its last stage, and fracture.parts_max more where rock can
 * break.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_blocks_max(struct enmm_model *model, size_t *count);

/**
 * Writes the sections of rock that have broken, in order. A return to a saved state restores its own.
 *
 * Buffer and errors as enmm_get_block_states.
 */
enmm_status enmm_get_cuts(struct enmm_model *model, struct enmm_cut *out, size_t capacity, size_t *written);

/**
 * Writes the current outer outline of a block, counter-clockwise, as x, y, x, y, ... (m).
 *
 * `xy` holds `capacity` points, that is twice as many numbers; `*written` gets the number of points. With `xy` NULL
 * and `capacity` 0 the call returns only that number. Cracks that end in the block are part of its outline. For holes
 * see enmm_get_block_hole.
 *
 * Errors: ENMM_BUFFER_TOO_SMALL; ENMM_INVALID_ARGUMENT for a block that does not exist; ENMM_NOT_FOUND for one that
 * has been excavated; ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_block_polygon(struct enmm_model *model,
                                   uint32_t block,
                                   double *xy,
                                   size_t capacity,
                                   size_t *written);

/**
 * Returns the number of holes of a block.
 *
 * Errors: as enmm_get_block_polygon.
 */
enmm_status enmm_block_hole_count(struct enmm_model *model, uint32_t block, size_t *count);

/**
 * Writes the current outline of hole `hole` (from 0) of a block, clockwise; buffer as enmm_get_block_polygon.
 *
 * Errors: as enmm_get_block_polygon; ENMM_INVALID_ARGUMENT for a hole that does not exist.
 */
enmm_status enmm_get_block_hole(struct enmm_model *model,
                                uint32_t block,
                                uint32_t hole,
                                double *xy,
                                size_t capacity,
                                size_t *written);

/**
 * Returns the block at a position (m) now; the lowest id where blocks meet.
 *
 * Errors: ENMM_NOT_FOUND where there is no rock; ENMM_INVALID_ARGUMENT for values that are not finite;
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_find_block_at(struct enmm_model *model, double x, double y, uint32_t *block);

/**
 * Returns the number of ports that the case names by `[[port]]`.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_port_count(struct enmm_model *model, size_t *count);

/**
 * Returns the port with a name.
 *
 * Errors: ENMM_NOT_FOUND, ENMM_INVALID_ARGUMENT, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_find_port(struct enmm_model *model, const char *name, uint32_t *port);

/**
 * Writes the name of a port in UTF-8.
 *
 * `*written` gets the number of bytes with the closing zero. With `out` NULL and `capacity` 0 the call returns only
 * that number.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_BUFFER_TOO_SMALL, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_port_name(struct enmm_model *model, uint32_t port, char *out, size_t capacity, size_t *written);

/**
 * Returns the kind of a port.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_port_kind(struct enmm_model *model, uint32_t port, enmm_port_type *kind);

/**
 * Returns the block of a port: its own, or that of the first edge of a boundary or joint.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_port_block(struct enmm_model *model, uint32_t port, uint32_t *block);

/**
 * Writes the state of a port. `out->struct_size` must be set.
 *
 * Errors: ENMM_INVALID_ARGUMENT for a port that does not exist or a struct_size that no version had,
 * ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_get_port_state(struct enmm_model *model, uint32_t port, struct enmm_port_state *out);

/**
 * Saves all data that the model needs to continue from here with the same bits: motion, contacts, stage, time, events,
 * inputs.
 *
 * `*out` gets the handle, which enmm_state_free frees, or NULL on failure. The state may outlive the
 * model.
 *
 * Errors: ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_state_save(struct enmm_model *model, struct enmm_state **out);

/**
 * Returns the model to a saved state of its own or of another model of the same case. The state can be used again.
 *
 * Errors: ENMM_WRONG_STATE for a state of another case, ENMM_DEAD_HANDLE; the model then stays as it is.
 */
enmm_status enmm_state_restore(struct enmm_model *model, struct enmm_state *state);

/**
 * Returns the model to a saved state in a way that `flags` choose: 0 as enmm_state_restore does, ENMM_KEEP_PARAMETERS
 * for a state of a model that may differ in values of parameters (see enmm_parameter_count), while this one keeps its
 * own.
 *
 * Errors: as enmm_state_restore; ENMM_INVALID_ARGUMENT for other flags, or when the parameters have made the internal
 * step another one.
 */
enmm_status enmm_state_restore_with(struct enmm_model *model, struct enmm_state *state, uint32_t flags);

/**
 * Frees a state. NULL does nothing.
 *
 * Errors: ENMM_DEAD_HANDLE.
 */
enmm_status enmm_state_free(struct enmm_state *state);

/**
 * Writes a state as bytes for a file or another process; they contain version, hash of the case and checksum.
 *
 * `model` is a model of the same case as the state. `*written` gets the number of bytes. With `buffer` NULL and
 * `capacity` 0 the call returns only that number.
 *
 * Errors: ENMM_BUFFER_TOO_SMALL, ENMM_WRONG_STATE for a state of another case, ENMM_DEAD_HANDLE, ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_state_serialize(struct enmm_model *model,
                                 struct enmm_state *state,
                                 uint8_t *buffer,
                                 size_t capacity,
                                 size_t *written);

/**
 * Makes a state from bytes that enmm_state_serialize wrote, in this process or another, or from those of a
 * `checkpoint.enmm` of `enmm run` on the same case.
 *
 * `*out` gets the handle, which enmm_state_free frees, or NULL on failure.
 *
 * Errors: ENMM_WRONG_STATE for bytes that are damaged, of another case or version, or with an invalid value (a number
 * that is not finite or out of range, an index or a length), which the message names; ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_state_deserialize(struct enmm_model *model,
                                   const uint8_t *bytes,
                                   size_t size,
                                   struct enmm_state **out);

/**
 * Makes a state from bytes in a way that `flags` choose: 0 as enmm_state_deserialize does, ENMM_KEEP_PARAMETERS for
 * bytes of a model that may differ in values of parameters; the state has those of this model.
 *
 * Errors: as enmm_state_deserialize and enmm_state_restore_with.
 */
enmm_status enmm_state_deserialize_with(struct enmm_model *model,
                                        const uint8_t *bytes,
                                        size_t size,
                                        uint32_t flags,
                                        struct enmm_state **out);

/**
 * Records the results of the model into a folder from now on: the files of `enmm run`, among them `history.csv`, the
 * film, frames for ParaView where the case asks for them, and at the end pictures, `checkpoint.enmm`, `report.html`
 * and `summary.json`, of which `enmm report` makes a report.
 *
 * `folder` is a path in UTF-8, relative to the current directory; it is made if it is not there, and results of an
 * earlier run in it are replaced. Call it before enmm_start to have the initial equilibrium. Rows and frames are due
 * at the times of the case, which count all stages as in `enmm run`. What a step brings is written when the next one
 * begins, so that a step that is repeated from a saved state leaves nothing twice; a return to an earlier state
 * removes what is later. Recording changes no result. When a file cannot be written later, steps go on: the log gets
 * the error, and enmm_end_record returns it.
 *
 * Errors: ENMM_FILE_ERROR when the folder cannot be written, another process writes there, or a result would replace
 * an input of the case; ENMM_INVALID_ARGUMENT when the model is recorded already; ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_record(struct enmm_model *model, const char *folder);

/**
 * Writes a row of the history, a frame of the film and frames for ParaView of this instant at once, the latter also
 * when the case asks for none. A host that repeats steps calls it when a step stands.
 *
 * Errors: ENMM_INVALID_ARGUMENT when the model is not recorded; ENMM_FILE_ERROR.
 */
enmm_status enmm_write_frame(struct enmm_model *model);

/**
 * Ends the recording with pictures, checkpoint, page and summary. enmm_destroy does so too, but cannot return an
 * error.
 *
 * Errors: ENMM_INVALID_ARGUMENT when the model is not recorded; ENMM_FILE_ERROR when a file could not be written,
 * now or since enmm_record. The recording has ended in any case.
 */
enmm_status enmm_end_record(struct enmm_model *model);

/**
 * Advances `n` models by `h` (s) each from the time at which it stands, on `threads` threads; the bits are those of
 * enmm_do_step. `statuses` gets the status of each, and may be NULL; a model that fails is as before, others go on.
 * Messages go out on the threads that step the models.
 *
 * Errors: the first status of a model that is not ENMM_OK, whose message enmm_last_error returns;
 * ENMM_INVALID_ARGUMENT for a number of threads that is not 1 to 1024; ENMM_NULL_ARGUMENT.
 */
enmm_status enmm_batch_step(struct enmm_model *const *models, size_t n, double h, size_t threads, int32_t *statuses);

/**
 * Takes samples of one model on from saved states, each with parameters of its own, and writes outputs of ports after
 * every communication step. The model stays as it is; the bits are those of the same calls one by one.
 *
 * `out` holds `capacity` numbers, samples * steps * outputs of the plan: those of one step after those of another,
 * sample by sample. Behind the failure of a sample they are not a number. `statuses` gets the status of each sample,
 * and may be NULL. enmm_interrupt ends all samples.
 *
 * Errors: ENMM_BUFFER_TOO_SMALL; ENMM_INVALID_ARGUMENT for a plan whose numbers do not fit, ENMM_DEAD_HANDLE for a
 * state that is not there, ENMM_NULL_ARGUMENT. The failure of a sample is in its status alone.
 *
 * # Safety
 * Every pointer is as the head of the header states, those of the plan as it states.
 */
enmm_status enmm_rollout(struct enmm_model *model,
                         const struct enmm_rollout_plan *plan,
                         double *out,
                         size_t capacity,
                         int32_t *statuses);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* ENMM_H */
