//! Limit analysis from case file to record.

use std::io;

use serde_json::{Value, json};

use enmm_io::CaseError;
use enmm_io::LoadedCase;
use enmm_stability::limit_analysis::{self, Bound, BoundError, Collapse, Factor};

/// Why there is no bound.
#[derive(Debug, thiserror::Error)]
pub enum BoundFailure {
    /// The case cannot be built, or holds what limit analysis cannot treat.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The directory cannot take the page.
    #[error("cannot write the page ({0}): choose another directory with -o")]
    Directory(io::Error),
    /// The solver gave up.
    #[error("{0}")]
    Unsolved(BoundError),
}

/// Finds the bounds of a case file.
///
/// # Errors
/// When the case cannot be built or treated, with file and line, or was not solved.
pub fn bound(loaded: &LoadedCase) -> Result<Bound, BoundFailure> {
    let mut bound = limit_analysis::bound(&loaded.case).map_err(|error| match error {
        BoundError::Case(invalid) => BoundFailure::Case(loaded.source.locate(&invalid.key, &invalid.message)),
        unsolved @ BoundError::Unsolved { .. } => BoundFailure::Unsolved(unsolved),
    })?;
    bound.warnings.splice(0..0, loaded.warnings.iter().cloned());
    Ok(bound)
}

/// A bound as JSON: factors that are none are null, with a word on the way in which they are.
pub fn bound_record(bound: &Bound) -> Value {
    json!({
        "associated": collapse(&bound.associated),
        "level_tops": collapse(&bound.level_tops),
        "level_tops_least": bound.least.value(),
        "catching": collapse(&bound.catching),
        "blocks": bound.blocks[0],
        "free_blocks": bound.blocks[1],
        "interfaces": bound.interfaces,
        "points": bound.points,
        "corners": bound.corners,
        "programs": bound.programs,
        "notes": bound.notes,
        "warnings": bound.warnings,
    })
}

fn collapse(collapse: &Collapse) -> Value {
    let (factor, end, limit) = match collapse.factor {
        Factor::Found(factor) => (Some(factor), "found", factor),
        Factor::AtLeast(least) => (None, "at_least", least),
        Factor::AtMost(most) => (None, "at_most", most),
    };
    let block = |b: &limit_analysis::MovingBlock| {
        json!({
            "block": b.block,
            "x": b.position.x,
            "y": b.position.y,
            "vx": b.velocity.x,
            "vy": b.velocity.y,
            "spin": b.spin,
            "speed": b.speed,
            "area": b.area,
            "mass": b.mass,
        })
    };
    let mechanism: Vec<Value> = collapse.mechanism.iter().map(block).collect();
    json!({ "factor": factor, "end": end, "limit": limit, "mechanism": mechanism })
}
