//! Blocks that have broken, and those that are nearest to it, for summaries.

use enmm_picture::si_text;
use enmm_report::{Break, Fact, Note};
use serde::Serialize;

use enmm::model::Simulation;
use enmm::model::tables::{Cut, Resultants, SectionFailure, WorstSection};

/// Blocks that a summary names.
const NAMED: usize = 5;

/// A section of rock at its strength, or near it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SectionRecord {
    /// Block.
    pub block: u32,
    /// Its ends in the reference configuration (m).
    pub ends: [[f64; 2]; 2],
    /// Its length (m).
    pub length: f64,
    /// Share of its strength.
    pub share: f64,
    /// How it fails: `bends`, `opens` (by tension), `slides` (by shear) or `splits` (from a core).
    pub failure: &'static str,
    /// Normal force (N/m), tension positive.
    pub normal: f64,
    /// Shear force (N/m).
    pub shear: f64,
    /// Bending moment (N).
    pub moment: f64,
    /// Whether the block could not be cut there, and is not any more.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub barred: bool,
}

/// A block that broke in two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BreakRecord {
    /// Simulated time (s).
    pub time: f64,
    /// Stage.
    pub stage: u32,
    /// Number of the part that is new.
    pub part: u32,
    /// The section.
    #[serde(flatten)]
    pub section: SectionRecord,
}

impl SectionRecord {
    fn new(block: u32, share: f64, ends: [[f64; 2]; 2], (failure, of): (SectionFailure, &Resultants)) -> Self {
        let [a, b] = ends;
        let length = ((b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)).sqrt();
        let failure = match failure {
            SectionFailure::Opens => "opens",
            SectionFailure::Slides => "slides",
            SectionFailure::Bends => "bends",
            SectionFailure::Splits => "splits",
        };
        let Resultants { normal, shear, moment } = *of;
        Self { block, ends, length, share, failure, normal, shear, moment, barred: false }
    }

    fn of(block: u32, worst: &WorstSection) -> Self {
        let ends = worst.ends.map(|end| [end.x, end.y]);
        let record = Self::new(block, worst.share, ends, (worst.failure, &worst.carries));
        Self { barred: worst.barred, ..record }
    }

    /// For the page: which block it is, how it would fail, where, and what it carries.
    pub(crate) fn note(&self) -> Note {
        let [[x0, y0], [x1, y1]] = self.ends;
        let rows = [
            ("Block", self.block.to_string()),
            ("Share of strength", format!("{:.2}", self.share)),
            ("How", self.how().to_owned()),
            ("From", format!("({x0:.2}, {y0:.2}) m")),
            ("To", format!("({x1:.2}, {y1:.2}) m")),
            ("Normal force, tension positive", si_text(self.normal, "N/m")),
            ("Shear force", si_text(self.shear, "N/m")),
            ("Bending moment", si_text(self.moment, "N")),
        ];
        let rows = rows.into_iter().map(|(name, value)| Fact { name: name.to_owned(), value });
        Note::Facts { title: "Nearest to breaking".to_owned(), rows: rows.collect() }
    }

    /// How it fails in words.
    pub fn how(&self) -> &'static str {
        match self.failure {
            "bends" => "by bending",
            "slides" => "by shear",
            "splits" => "from its core",
            _ => "by tension",
        }
    }

    /// Those of the blocks nearest to breaking, the worst first.
    pub(crate) fn worst(simulation: &Simulation) -> Vec<Self> {
        let labels = &simulation.model().labels;
        let sections = &simulation.state().worst_sections;
        // Of blocks far from it there is a bound alone.
        let there = labels.iter().zip(sections).zip(&simulation.state().removed).filter(|(_, removed)| !**removed);
        let known = there.filter(|((_, worst), _)| worst.ends[0] != worst.ends[1]);
        let mut records: Vec<Self> = known.map(|((&label, worst), _)| Self::of(label, worst)).collect();
        records.sort_by(|a, b| b.share.total_cmp(&a.share).then(a.block.cmp(&b.block)));
        records.truncate(NAMED);
        records
    }
}

impl BreakRecord {
    /// For the page.
    pub(crate) fn note(&self) -> Break {
        let SectionRecord { block, ends, share, normal, shear, moment, .. } = self.section;
        let failure = self.section.how().to_owned();
        Break { at: self.time, block, part: self.part, failure, ends, share, normal, shear, moment }
    }

    /// All of a run so far.
    pub(crate) fn all(simulation: &Simulation) -> Vec<Self> {
        let of = |cut: &Cut| {
            let ends = cut.ends.map(|end| [end.x, end.y]);
            let section = SectionRecord::new(cut.block, cut.share, ends, (cut.failure, &cut.carried));
            Self { time: cut.time, stage: cut.stage, part: cut.part, section }
        };
        simulation.cuts().iter().map(of).collect()
    }
}
