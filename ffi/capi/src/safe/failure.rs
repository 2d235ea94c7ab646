//! Status and message of what failed, and the last message of every thread.

use std::cell::RefCell;
use std::ffi::CString;

use engine::cosimulation::CosimulationError;
use enmm_io::CaseError;

use crate::types::enmm_status;

/// Why an entry point did nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Status that the host gets.
    pub status: enmm_status,
    /// What, the value, the limit, the remedy.
    pub message: String,
}

/// Outcome of an entry point.
pub type Outcome = Result<(), Failure>;

impl Failure {
    /// A failure of the given status.
    pub fn new(status: enmm_status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// A pointer that must not be NULL.
    pub fn null(name: &str) -> Self {
        Self::new(enmm_status::ENMM_NULL_ARGUMENT, format!("{name}: is NULL, must point to a value; pass its address"))
    }

    /// An argument that cannot be used.
    pub fn invalid(message: impl Into<String>) -> Self {
        Self::new(enmm_status::ENMM_INVALID_ARGUMENT, message)
    }

    /// The failure of a panic.
    pub fn panic(payload: &(dyn std::any::Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("unknown cause");
        let message = format!("internal error of enmm ({text}); destroy the model that was in use, and report this");
        Self::new(enmm_status::ENMM_PANIC, message)
    }
}

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        let status = match error {
            CaseError::Unreadable { .. } => enmm_status::ENMM_FILE_ERROR,
            _ => enmm_status::ENMM_INVALID_CASE,
        };
        Self::new(status, error.to_string())
    }
}

impl From<CosimulationError> for Failure {
    fn from(error: CosimulationError) -> Self {
        let status = match error {
            CosimulationError::Stage(_) => enmm_status::ENMM_INVALID_CASE,
            CosimulationError::NoPort { .. } => enmm_status::ENMM_NOT_FOUND,
            CosimulationError::Value { .. } => enmm_status::ENMM_INVALID_ARGUMENT,
            CosimulationError::Time { .. } | CosimulationError::Stale => enmm_status::ENMM_WRONG_TIME,
            CosimulationError::Step(_) => enmm_status::ENMM_NUMERICAL_FAILURE,
            CosimulationError::State(_) => enmm_status::ENMM_WRONG_STATE,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// Keeps the message of a failure as the last one of this thread.
pub fn remember(failure: &Failure) {
    let text = CString::new(failure.message.replace('\0', "?")).unwrap_or_default();
    // A thread that is being torn down has no message any more.
    let _ = LAST.try_with(|last| last.replace(text));
}

/// Address of the last message of this thread, or of an empty text.
pub fn last_message() -> *const libc::c_char {
    LAST.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_tell_their_message() {
        let of = |payload: Box<dyn std::any::Any + Send>| Failure::panic(&*payload).message;
        assert!(of(Box::new("static")).contains("(static)"));
        assert!(of(Box::new(String::from("owned"))).contains("(owned)"));
        assert!(of(Box::new(1)).contains("(unknown cause)"));
    }
}
