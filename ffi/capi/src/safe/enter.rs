//! The frame of every entry point: no panic leaves it, failures are remembered, messages go out when the model is free.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::failure::{Failure, Outcome, remember};
use super::model::{MODELS, Model};
use crate::types::enmm_status;

/// Runs `act` and turns what comes of it into a status.
pub fn guard(act: impl FnOnce() -> Outcome) -> enmm_status {
    // Data behind a panic is not used again: a model is then poisoned, all else is written whole.
    let outcome = catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|payload| Err(Failure::panic(&*payload)));
    match outcome {
        Ok(()) => enmm_status::ENMM_OK,
        Err(failure) => {
            remember(&failure);
            failure.status
        }
    }
}

/// Runs `act` on the model of a handle, alone.
pub fn with_model(handle: usize, act: impl FnOnce(&mut Model) -> Outcome) -> enmm_status {
    guard(|| {
        let shared = MODELS.find(handle)?;
        let _turn = shared.enter()?;
        let mut model = shared.lock()?;
        let outcome = act(&mut model);
        let pending_messages = model.take_mail();
        drop(model);
        pending_messages.deliver(handle, &shared);
        outcome
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::safe::model::create_from_file;

    const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/cases/block_on_incline.toml");

    #[test]
    fn a_panic_is_a_status_and_breaks_only_its_model() {
        assert_eq!(guard(|| panic!("by intention")), enmm_status::ENMM_PANIC);
        let [broken, whole] = [(); 2].map(|()| create_from_file(CASE).expect("a case that can be used"));
        assert_eq!(with_model(broken, |_| panic!("by intention")), enmm_status::ENMM_PANIC);
        assert_eq!(with_model(broken, |_| Ok(())), enmm_status::ENMM_PANIC);
        assert_eq!(with_model(whole, |_| Ok(())), enmm_status::ENMM_OK);
        MODELS.remove(broken).expect("a broken model can be destroyed");
        assert_eq!(with_model(broken, |_| Ok(())), enmm_status::ENMM_DEAD_HANDLE);
    }

    #[test]
    fn one_call_at_a_time_uses_a_model() {
        let handle = create_from_file(CASE).expect("a case that can be used");
        let mut inner = enmm_status::ENMM_OK;
        let outer = with_model(handle, |_| {
            inner = with_model(handle, |_| Ok(()));
            MODELS.remove(handle)
        });
        assert_eq!((outer, inner), (enmm_status::ENMM_OK, enmm_status::ENMM_BUSY));
        assert_eq!(with_model(handle, |_| Ok(())), enmm_status::ENMM_DEAD_HANDLE);
    }
}
