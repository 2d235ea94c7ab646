//! What both FMI exports do with pointers of the importer: read and write through them, and hand out saved states.
#![deny(unsafe_op_in_unsafe_fn)]

pub mod raw;
pub mod states;
