//! Runs of cases and what they leave: histories, tables of blocks, frames, pictures, summaries, factors of safety.
#![forbid(unsafe_code)]

mod bound;
pub mod check;
pub mod drainage;
mod ensemble;
pub mod fos;
mod found;
mod mechanism_page;
mod meshes;
mod model_page;
pub mod rock_mass;
mod run;
mod seismic;
mod sets;
mod stereonet;
mod sweep;

pub use bound::{BoundFailure, bound, bound_record, bracket, bracket_record, write_bound};
pub use check::{check, count_of_notes};
pub use enmm_picture::Projection;
pub use enmm_record::results::draw_checked;
pub use enmm_record::{
    Folder, RunStatus, STORE, Summary, blocks, changes, check_output, check_owner, history, input_record, is_result,
    make_place, motion, summary, verdict, vtu,
};
pub use ensemble::{
    Answer, Ask, EnsembleError, EnsembleOptions, EnsembleProgress, EnsembleResult, SampleOutput, SearchOptions, answer,
    columns, ensemble,
};
pub use fos::{FosError, FosOptions, fos};
pub use mechanism_page::{write_bound_page, write_bracket_page};
pub use meshes::{Meshes, OnMesh};
pub use model_page::write_model_page;
pub use run::{Observer, RunError, RunOptions, RunProgress, run};
pub use seismic::{NewmarkBlock, RunMotion, Seismic};
pub use sets::{FoundSet, FoundSets, SetOptions, sets};
pub use stereonet::{NetOptions, apparent, stereonet};
pub use sweep::{Change, Crossing, Effect, Sweep, SweepKind, SweepResult, sweep};
