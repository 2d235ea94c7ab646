//! Runs of cases and what they leave: histories, tables of blocks, frames, pictures, summaries, factors of safety.
#![forbid(unsafe_code)]

pub mod blocks;
mod bound;
pub mod changes;
pub mod check;
mod ensemble;
mod film;
mod folder;
pub mod fos;
mod found;
pub mod history;
mod input;
mod mechanism_page;
mod model_page;
pub mod motion;
pub mod rock_mass;
mod run;
mod stereonet;
pub mod summary;
pub mod verdict;
pub mod vtu;

pub use bound::{BoundFailure, bound, bound_record, bracket, bracket_record, write_bound};
pub use check::{check, count_of_notes};
pub use enmm_picture::Projection;
pub use ensemble::{
    Answer, Ask, EnsembleError, EnsembleOptions, EnsembleProgress, EnsembleResult, SearchOptions, answer, columns,
    ensemble,
};
pub use folder::{Folder, STORE, check_output, check_owner, is_result, make_place};
pub use fos::{FosError, FosOptions, fos};
pub use input::input_record;
pub use mechanism_page::{write_bound_page, write_bracket_page};
pub use model_page::write_model_page;
pub use run::{Observer, RunError, RunOptions, RunProgress, draw_checked, run};
pub use stereonet::{NetOptions, apparent, stereonet};
pub use summary::{RunStatus, Summary};
