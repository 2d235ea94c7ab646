//! The film of a slope, and the page that shows it.
//!
//! A run appends each frame to a film while it goes on ([`FilmWriter`]). [`write_page`] makes `report.html` of a film:
//! one file that needs no network and no other file. `serve` shows a film that still grows. Neither knows the engine:
//! whoever writes a film fills in plain data ([`Head`], [`Outline`], [`Frame`], [`Note`]). [`paper`] is the report of
//! results on paper.
//!
//! `format.md` beside this crate's sources describes every byte of a film and how accurate it is.
#![forbid(unsafe_code)]

mod block;
mod chunk;
mod data;
mod elements;
mod error;
mod number;
mod page;
pub mod paper;
mod serve;
mod structures;
mod writer;

pub use block::{MOTION, QUANTUM};
pub use data::{
    Axis, BlockFrame, BlockNumber, BoltFrame, BoltPlace, Break, Column, EdgeState, Elements, Fact, Frame, Head, Marked,
    Mesh, MonitorFrame, MonitorPlace, Note, Outline, Structures, SupportFrame, Trial, TrialTable, Water, WaterDrain,
    WaterInlet,
};
pub use error::FilmError;
pub use page::{edit_page, live_page, write_page};
pub use serve::{Answer, Server, Source};
pub use writer::FilmWriter;

/// Name of the film in the directory of a run.
pub const FILM: &str = "film.bin";
/// Name of the page in the directory of a run.
pub const PAGE: &str = "report.html";
