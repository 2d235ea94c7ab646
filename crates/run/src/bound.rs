//! Limit analysis from case file to record.

use std::io;
use std::path::Path;

use serde_json::{Value, json};

use enmm::engine_version;
use enmm::model::Case;
use enmm_io::CaseError;
use enmm_io::LoadedCase;
use enmm_io::files::{at_path, write_atomic};
use enmm_stability::limit_analysis::continuum::{Bracket, Motion, bracket as bracket_of};
use enmm_stability::limit_analysis::{self, Bound, BoundError, Collapse, Factor};

use enmm_record::input_record;

/// Why there is no bound.
#[derive(Debug, thiserror::Error)]
pub enum BoundFailure {
    /// The case cannot be built, or holds what limit analysis cannot treat.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// An option cannot be used.
    #[error("{0}")]
    Options(String),
    /// The directory holds results of another case.
    #[error("{0}")]
    Owned(io::Error),
    /// The directory cannot take the page.
    #[error("cannot write the page ({0}): choose another directory with -o")]
    Directory(io::Error),
    /// The solver gave up.
    #[error("{0}")]
    Unsolved(BoundError),
}

/// Finds the bounds of a case file with what stands beside them.
///
/// # Errors
/// When the case cannot be built or treated, with file and line, or was not solved.
pub fn bound(loaded: &LoadedCase) -> Result<Bound, BoundFailure> {
    told(loaded, limit_analysis::bound)
}

/// The bounds alone, for samples.
///
/// # Errors
/// As [`bound`].
pub fn bounds(loaded: &LoadedCase) -> Result<Bound, BoundFailure> {
    told(loaded, limit_analysis::bounds)
}

fn told(loaded: &LoadedCase, find: fn(&Case) -> Result<Bound, BoundError>) -> Result<Bound, BoundFailure> {
    let mut bound = find(&loaded.case).map_err(|error| failure(loaded, error))?;
    bound.warnings.splice(0..0, loaded.warnings.iter().cloned());
    Ok(bound)
}

/// Finds the bracket of a case file whose rock yields, with meshes of at most so many triangles.
///
/// # Errors
/// As [`bound`].
pub fn bracket(loaded: &LoadedCase, triangles: usize) -> Result<Bracket, BoundFailure> {
    let mut bracket = bracket_of(&loaded.case, triangles).map_err(|error| failure(loaded, error))?;
    bracket.warnings.splice(0..0, loaded.warnings.iter().cloned());
    Ok(bracket)
}

fn failure(loaded: &LoadedCase, error: BoundError) -> BoundFailure {
    match error {
        BoundError::Case(invalid) | BoundError::Held { invalid, .. } => {
            BoundFailure::Case(loaded.source.locate(&invalid.key, &invalid.message))
        }
        unsolved => BoundFailure::Unsolved(unsolved),
    }
}

/// Writes `bound.json`: a record of a limit analysis with case, version, input, and the stage after which it is where
/// one was named.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_bound(directory: &Path, loaded: &LoadedCase, stage: Option<&str>, bound: &Value) -> io::Result<()> {
    let path = directory.join("bound.json");
    let mut record = json!({
        "title": loaded.case.title,
        "version": engine_version(),
        "case_file": loaded.source.file(),
        "case_hash": loaded.hash,
        "settings": loaded.settings,
        "bound": bound,
        "input": input_record(loaded),
    });
    if let Some(stage) = stage {
        record["stage"] = json!(stage);
    }
    let text = serde_json::to_vec_pretty(&record).map_err(io::Error::from).map_err(at_path(&path))?;
    write_atomic(&path, &text)
}

/// A bracket as JSON, its factors as those of a bound.
pub fn bracket_record(bracket: &Bracket) -> Value {
    let motion = |m: &Motion| {
        json!({
            "block": m.block,
            "x": m.position.x,
            "y": m.position.y,
            "vx": m.velocity.x,
            "vy": m.velocity.y,
            "area": m.area,
            "mass": m.mass,
        })
    };
    let mut upper = factor(bracket.upper);
    upper["mechanism"] = bracket.moving().map(motion).collect();
    json!({
        "lower": factor(bracket.lower),
        "upper": upper,
        "triangles": { "lower": bracket.triangles[0], "upper": bracket.triangles[1] },
        "programs": bracket.programs,
        "notes": bracket.notes,
        "warnings": bracket.warnings,
    })
}

/// A bound as JSON: factors that are none are null, with a word on the way in which they are.
pub fn bound_record(bound: &Bound) -> Value {
    let mut record = json!({
        "level_tops_least": bound.least.value(),
        "bare_share": bound.bare.as_ref().map(|bare| bare.share),
        "bare_interfaces": bound.bare.as_ref().map(|bare| bare.interfaces),
        "estimate": null,
        "factor_ends_drawn": bound.ends.as_ref().map(|ends| factor(ends.drawn)),
        "factor_ends_joined": bound.ends.as_ref().map(|ends| factor(ends.joined)),
        "blocks": bound.blocks[0],
        "free_blocks": bound.blocks[1],
        "interfaces": bound.interfaces,
        "points": bound.points,
        "corners": bound.corners,
        "programs": bound.programs,
        "joint_water": bound.joint_water,
        "notes": bound.notes,
        "warnings": bound.warnings,
    });
    for row in bound.rows() {
        record[row.key] = collapse(row.collapse);
        record[row.key]["meaning"] = json!(row.meaning);
        record[row.key]["way"] = json!(row.way());
    }
    record
}

/// A factor with a word on the way in which it is or is not one.
pub(super) fn factor(factor: Factor) -> Value {
    let (factor, end, limit) = match factor {
        Factor::Found(factor) => (Some(factor), "found", factor),
        Factor::AtLeast(least) => (None, "at_least", least),
        Factor::AtMost(most) => (None, "at_most", most),
    };
    json!({ "factor": factor, "end": end, "limit": limit })
}

fn collapse(collapse: &Collapse) -> Value {
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
    let mut record = factor(collapse.factor);
    record["mechanism"] = collapse.mechanism.iter().map(block).collect();
    record
}
