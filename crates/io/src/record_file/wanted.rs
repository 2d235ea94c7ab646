//! The request of a case for a record, and why it cannot be met.

use enmm::model::case::record::{BaseMotionKind, RecordReading};

/// The request of a case for a record.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    /// Quantity; none for factors on the velocity of a wave.
    pub kind: Option<BaseMotionKind>,
    /// How the file is read, where it does not say so itself.
    pub reading: &'a RecordReading,
    /// Factor of the case on the values.
    pub scale: f64,
}

/// Why a record cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// A line, counted from 1.
    Line(usize, String),
    /// A key of the ground motion, such as `record.unit`.
    Key(&'static str, String),
    /// The file as a whole, for what the case asks of it.
    File(String),
}
