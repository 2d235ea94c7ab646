//! Results of a model over time: histories, tables of blocks, frames, pictures, the page, the summary.
//!
//! [`Recorder`] writes them for `enmm run`, [`Recording`] for a model that a host drives.
#![forbid(unsafe_code)]

pub mod along;
pub mod blocks;
mod breaks;
pub mod changes;
pub mod earthquake;
pub mod film;
mod flow;
mod folder;
pub mod history;
mod input;
mod lines;
mod monitors;
pub mod motion;
mod progress;
mod recorder;
mod recording;
pub mod results;
mod rows;
pub mod summary;
pub mod verdict;
pub mod vtu;
mod warnings;

pub use folder::{Folder, STORE, check_output, check_owner, is_result, make_place};
pub use input::input_record;
pub use progress::{CHECKPOINT, Progress, Saved, load_checkpoint};
pub use recorder::{Closing, Recorder, Setting};
pub use recording::{Recording, RecordingError};
pub use summary::{RunStatus, Summary};
