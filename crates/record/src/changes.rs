//! What the build of a model has changed in the drawing: ends that met a line, blocks that joined a neighbour.

use std::io;

use serde::Serialize;

use enmm::geometry::ends::EndChange;
use enmm::model::Simulation;
use enmm::model::assemble::Built;
use enmm_report::{Fact, Note};

use crate::film::Film;

/// Rows of a table of changes on the page; `summary.json` has them all.
const ROWS: usize = 50;

/// An end of a joint near the outline or another joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TraceEndRecord {
    /// The joint.
    pub joint: String,
    /// Where it was drawn to end (m).
    pub place: [f64; 2],
    /// Distance to the line (mm).
    pub gap_mm: f64,
    /// The outline or the other joint.
    pub line: String,
    /// `extended` or `trimmed` to the line, or `kept` in the rock.
    pub change: &'static str,
}

impl TraceEndRecord {
    /// Those of a model.
    pub fn all(built: &Built) -> Vec<Self> {
        let record = |end: &enmm::model::assemble::TraceEnd| Self {
            joint: end.name.clone(),
            place: end.place.into(),
            gap_mm: 1e3 * end.gap,
            line: end.line.clone(),
            change: match end.change {
                EndChange::Extended => "extended",
                EndChange::Trimmed => "trimmed",
                EndChange::Kept => "kept",
                EndChange::Bridged => "bridged",
            },
        };
        built.ends.iter().map(record).collect()
    }
}

/// A block below the least area.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrumbRecord {
    /// Its area (m²).
    pub area: f64,
    /// Its centroid (m).
    pub place: [f64; 2],
    /// Whether it has joined a neighbour; one that touches no other rock cannot.
    pub joined: bool,
}

impl CrumbRecord {
    /// Those of a model.
    pub fn all(built: &Built) -> Vec<Self> {
        built.crumbs.iter().map(|c| Self { area: c.area, place: c.place.into(), joined: c.joined }).collect()
    }
}

impl Film {
    /// Notes tables of ends and blocks that the build has changed.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn note_changes(&mut self, simulation: &Simulation) -> io::Result<()> {
        let built = simulation.built();
        let ends = TraceEndRecord::all(built).into_iter().map(|end| {
            let TraceEndRecord { joint, place: [x, y], gap_mm, line, change } = end;
            (format!("{joint} at ({x:.3}, {y:.3}) m"), format!("{gap_mm:.3} mm from {line}: {change}"))
        });
        self.table("Ends of joints near a line", ends)?;
        let crumbs = CrumbRecord::all(built).into_iter().map(|CrumbRecord { area, place: [x, y], joined }| {
            let joined = if joined { "joined a neighbour" } else { "alone, kept" };
            (format!("block at ({x:.3}, {y:.3}) m"), format!("{area:.2e} m²: {joined}"))
        });
        self.table("Blocks below the least area", crumbs)
    }

    fn table(&mut self, title: &str, rows: impl Iterator<Item = (String, String)>) -> io::Result<()> {
        let mut rows: Vec<Fact> = rows.map(|(name, value)| Fact { name, value }).collect();
        let count = rows.len();
        rows.truncate(ROWS);
        if rows.is_empty() { Ok(()) } else { self.note(0.0, &Note::Changes { title: title.to_owned(), rows, count }) }
    }
}
