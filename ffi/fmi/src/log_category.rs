//! Names of the log categories: both model descriptions declare exactly these, and the entry points use no other.

/// What happens inside a step: blocks that detach, joints that slip, blocks that fail.
pub const EVENTS: &str = "logEvents";
/// Warnings.
pub const WARNING: &str = "logStatusWarning";
/// Calls that were refused and changed nothing.
pub const DISCARD: &str = "logStatusDiscard";
/// Errors.
pub const ERROR: &str = "logStatusError";
/// Errors after which the instance is lost.
pub const FATAL: &str = "logStatusFatal";
/// All messages; a host that turns this on turns all on.
pub const ALL: &str = "logAll";

/// Every category with its description, in the order of the model description.
pub const CATEGORIES: [(&str, &str); 6] = [
    (EVENTS, "Blocks that detach or fail, joints that slip"),
    (WARNING, "Warnings"),
    (DISCARD, "Calls that were refused and changed nothing"),
    (ERROR, "Errors"),
    (FATAL, "Errors after which the instance is lost"),
    (ALL, "All messages"),
];
