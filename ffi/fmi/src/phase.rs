//! Which call is legal in which state of an instance, for each version of the standard.

use crate::table::Version;

/// State of an instance; each has a bit of its own for the masks below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u16)]
pub enum Phase {
    /// After instantiate or reset.
    Instantiated = 1,
    /// Initialization mode.
    Initialization = 2,
    /// FMI 2 step complete, FMI 3 step mode.
    Step = 4,
    /// FMI 2 step failed: the last step was discarded and the model stands where it began.
    StepFailed = 8,
    /// FMI 3 intermediate update mode, within a step.
    Intermediate = 16,
    /// After terminate.
    Terminated = 32,
    /// After an error.
    Error = 64,
    /// Within doStep, outside of intermediate update mode.
    Stepping = 128,
    /// FMI 3 event mode.
    Event = 256,
}

const I: u16 = Phase::Instantiated as u16;
const N: u16 = Phase::Initialization as u16;
const S: u16 = Phase::Step as u16;
const F: u16 = Phase::StepFailed as u16;
const U: u16 = Phase::Intermediate as u16;
const T: u16 = Phase::Terminated as u16;
const E: u16 = Phase::Error as u16;
const P: u16 = Phase::Stepping as u16;
const V: u16 = Phase::Event as u16;

impl Phase {
    /// The phase with this bit.
    pub fn of(bit: u16) -> Option<Self> {
        let all = [
            Self::Instantiated,
            Self::Initialization,
            Self::Step,
            Self::StepFailed,
            Self::Intermediate,
            Self::Terminated,
            Self::Error,
            Self::Stepping,
            Self::Event,
        ];
        all.into_iter().find(|&phase| phase as u16 == bit)
    }

    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::Step => "step mode",
            Self::StepFailed => "step failed",
            Self::Intermediate => "intermediate update mode",
            Self::Terminated => "terminated",
            Self::Error => "error",
            Self::Stepping => "within a step",
            Self::Event => "event mode",
        }
    }
}

/// Kinds of calls that share a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// setDebugLogging.
    Logging,
    /// freeInstance.
    Free,
    /// setupExperiment.
    Setup,
    /// enterInitializationMode.
    EnterInitialization,
    /// exitInitializationMode.
    ExitInitialization,
    /// terminate.
    Terminate,
    /// reset.
    Reset,
    /// Every getter of values.
    Get,
    /// Every setter of values.
    Set,
    /// A parameter among the values that are set.
    SetParameter,
    /// Output derivatives.
    GetDerivative,
    /// doStep.
    DoStep,
    /// enterEventMode.
    EnterEvent,
    /// enterStepMode and updateDiscreteStates.
    Event,
    /// getStatus and its typed sisters.
    Status,
    /// Everything about saved states.
    State,
}

/// All but those within a step.
const AT_REST: u16 = I | N | S | F | T | E | V;

/// Rows: call, mask of FMI 2, mask of FMI 3.
///
/// FMI 2 leaves a failed step by a saved state. Here the step is a transaction and the model stands at its begin, so
/// that a shorter step, or other inputs, are also welcome without one. FMI 3 knows no such state: a discarded step
/// leaves the instance in step mode. Start values may be read in FMI 3 as soon as the instance exists; outputs and
/// time, which have none, only from initialization mode on. Within a step, for a logger that calls back or another
/// thread, there is nothing but logging.
const TABLE: [(Call, u16, u16); 16] = [
    (Call::Logging, AT_REST | P, AT_REST | P | U),
    (Call::Free, AT_REST, AT_REST),
    (Call::Setup, I, 0),
    (Call::EnterInitialization, I, I),
    (Call::ExitInitialization, N, N),
    (Call::Terminate, S | F, S | V),
    (Call::Reset, AT_REST, AT_REST),
    (Call::Get, N | S | F | T | E, I | N | S | U | T | E | V),
    (Call::Set, I | N | S | F, I | N | S | V),
    (Call::SetParameter, I | N, I | N),
    (Call::GetDerivative, S | F | T | E, S | U | T | E | V),
    (Call::DoStep, S | F, S),
    (Call::EnterEvent, 0, S),
    (Call::Event, 0, V),
    (Call::Status, S | F | T, 0),
    (Call::State, AT_REST, AT_REST),
];

/// Whether a call is legal in a phase.
pub fn is_legal(version: Version, call: Call, phase: Phase) -> bool {
    let row = TABLE.iter().find(|row| row.0 == call);
    row.is_some_and(|&(_, two, three)| (if version == Version::Two { two } else { three }) & phase as u16 != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_call_has_one_row_and_phases_one_bit() {
        for (k, row) in TABLE.iter().enumerate() {
            assert_eq!(row.0 as usize, k);
        }
        for bit in 0..16 {
            assert_eq!(Phase::of(1 << bit).map(|phase| phase as u16), (bit < 9).then_some(1 << bit));
        }
    }

    #[test]
    fn after_an_error_only_the_calls_of_the_standard_are_left() {
        let left = [Call::Logging, Call::Free, Call::Reset, Call::Get, Call::GetDerivative, Call::State];
        for version in [Version::Two, Version::Three] {
            for row in TABLE {
                assert_eq!(is_legal(version, row.0, Phase::Error), left.contains(&row.0), "{row:?}");
            }
            assert!(!is_legal(version, Call::DoStep, Phase::Initialization));
            assert!(!is_legal(version, Call::SetParameter, Phase::Step));
        }
        assert!(!is_legal(Version::Two, Call::Get, Phase::Instantiated));
        assert!(is_legal(Version::Three, Call::Get, Phase::Instantiated));
        assert!(!is_legal(Version::Three, Call::Free, Phase::Intermediate));
    }

    #[test]
    fn within_a_step_only_logging_is_left() {
        for version in [Version::Two, Version::Three] {
            for row in TABLE {
                assert_eq!(is_legal(version, row.0, Phase::Stepping), row.0 == Call::Logging, "{row:?}");
            }
        }
    }
}
