//! Status and message of what failed, and the last message of every thread.

use engine::cosimulation::CosimulationError;
use enmm_io::CaseError;
use std::cell::RefCell;

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
            CosimulationError::Interrupted => enmm_status::ENMM_INTERRUPTED,
            CosimulationError::Value { .. } | CosimulationError::Parameter(_) => enmm_status::ENMM_INVALID_ARGUMENT,
            CosimulationError::Time { .. } | CosimulationError::Stale => enmm_status::ENMM_WRONG_TIME,
            CosimulationError::Step(_) => enmm_status::ENMM_NUMERICAL_FAILURE,
            CosimulationError::State(_) => enmm_status::ENMM_WRONG_STATE,
        };
        Self::new(status, error.to_string())
    }
}

/// Takes each status by its name.
macro_rules! statuses {
    ($($name:ident)*) => {
        /// Name of a status with a closing zero.
        pub fn status_name(status: i32) -> &'static str {
            // Does not compile when a status is not listed.
            let _ = |status| match status { $(enmm_status::$name => {})* };
            match status {
                $(number if number == enmm_status::$name as i32 => concat!(stringify!($name), "\0"),)*
                _ => "unknown status\0",
            }
        }
    };
}

statuses! {
    ENMM_OK ENMM_NULL_ARGUMENT ENMM_DEAD_HANDLE ENMM_BUSY ENMM_INVALID_ARGUMENT ENMM_INVALID_CASE ENMM_FILE_ERROR
    ENMM_WRONG_TIME ENMM_NUMERICAL_FAILURE ENMM_BUFFER_TOO_SMALL ENMM_NOT_FOUND ENMM_WRONG_STATE ENMM_PANIC
    ENMM_INTERRUPTED
}

/// Room for a message with its closing zero (bytes).
const ROOM: usize = 4096;
/// End of a message that has no room.
const CUT: &str = "...";

thread_local! {
    /// Last message of this thread, which ends with a zero. Its address does not change.
    static LAST: RefCell<[u8; ROOM]> = const { RefCell::new([0; ROOM]) };
}

/// Keeps the message of a failure as the last one of this thread.
pub fn remember(failure: &Failure) {
    LAST.with_borrow_mut(|last| write(&failure.message, last));
}

/// Writes a text with a closing zero, cut where it has no room.
fn write(text: &str, room: &mut [u8; ROOM]) {
    let (kept, end) = match text.len() < ROOM {
        true => (text, ""),
        false => (upto(text, ROOM - 1 - CUT.len()), CUT),
    };
    let bytes = kept.bytes().map(|byte| if byte == 0 { b'?' } else { byte }).chain(end.bytes()).chain([0]);
    room.iter_mut().zip(bytes).for_each(|(place, byte)| *place = byte);
}

/// The letters within the first bytes of a text.
fn upto(text: &str, bytes: usize) -> &str {
    let end = (0..=bytes).rev().find(|&end| text.is_char_boundary(end));
    &text[..end.unwrap_or(0)]
}

/// Address of the last message of this thread, which is empty before the first failure.
pub fn last_message() -> *const libc::c_char {
    LAST.with(|last| last.as_ptr().cast_const().cast())
}

/// The last message of this thread.
pub fn last_text() -> String {
    LAST.with_borrow(|last| {
        let text = last.split(|byte| *byte == 0).next().unwrap_or_default();
        String::from_utf8_lossy(text).into_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> String {
        let mut room = [b'x'; ROOM];
        write(text, &mut room);
        let end = room.iter().position(|byte| *byte == 0).expect("a closing zero");
        String::from_utf8(room[..end].to_vec()).expect("UTF-8")
    }

    #[test]
    fn long_messages_are_cut_between_letters() {
        assert_eq!(written(""), "");
        assert_eq!(written("a\0b"), "a?b");
        let fits = "x".repeat(ROOM - 1);
        assert_eq!(written(&fits), fits);
        assert_eq!(written(&"x".repeat(ROOM)), "x".repeat(ROOM - 4) + "...");
        for before in 0..4 {
            let long = "x".repeat(before) + &"€".repeat(ROOM);
            let own = written(&long);
            assert!(own.len() > ROOM - 8 && long.starts_with(own.strip_suffix("...").expect("cut")), "{before}");
        }
    }

    #[test]
    fn the_address_of_the_last_message_does_not_change() {
        let before = last_message();
        remember(&Failure::invalid("first"));
        remember(&Failure::invalid("second, and longer"));
        assert_eq!(last_message(), before);
        assert_ne!(std::thread::spawn(|| last_message().addr()).join().expect("a thread"), before.addr());
    }

    #[test]
    fn statuses_have_the_names_of_the_header() {
        let name = |status: enmm_status| status_name(status as i32).trim_end_matches('\0').to_owned();
        for status in [enmm_status::ENMM_OK, enmm_status::ENMM_BUSY, enmm_status::ENMM_PANIC] {
            assert_eq!(name(status), format!("{status:?}"));
        }
        assert_eq!([status_name(-1), status_name(99)], ["unknown status\0"; 2]);
    }

    #[test]
    fn panics_tell_their_message() {
        let of = |payload: Box<dyn std::any::Any + Send>| Failure::panic(&*payload).message;
        assert!(of(Box::new("static")).contains("(static)"));
        assert!(of(Box::new(String::from("owned"))).contains("(owned)"));
        assert!(of(Box::new(1)).contains("(unknown cause)"));
    }
}
