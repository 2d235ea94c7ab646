//! Cuts: lines that become joints in the middle of a run, where a stage cuts the rock or a section of it breaks.

use crate::contact::LawId;
use crate::geometry::{NodingReport, Point};
use crate::model::case::{Case, Invalid, StageCut};
use crate::state;

use super::rock::crack_law;
use super::{law_of, points};

/// A line along which the rock is cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Its key: `stage[1].cut[0]`, or of the rock that has broken.
    pub key: String,
    /// Its points (m).
    pub points: Vec<Point>,
    /// Its joint law.
    pub law: LawId,
    /// Whether it is a section that has broken.
    pub is_crack: bool,
}

impl Cut {
    /// The cuts of all stages up to one and of sections that have broken, in the order of time.
    pub fn up_to(case: &Case, stage: usize, broken: &[state::Cut]) -> Vec<Self> {
        let mut cuts = Vec::new();
        for (number, of) in case.stages.iter().take(stage + 1).enumerate() {
            cuts.extend(of.cuts.iter().enumerate().map(|(k, cut)| Self::of_stage(case, (number, k), cut)));
            let then = broken.iter().filter(|cut| cut.stage as usize == number);
            cuts.extend(then.map(|cut| Self::of_rock(case, cut)));
        }
        cuts
    }

    fn of_stage(case: &Case, (stage, k): (usize, usize), cut: &StageCut) -> Self {
        Self {
            key: format!("stage[{stage}].cut[{k}]"),
            points: points(&cut.points),
            law: law_of(case, &cut.law).unwrap_or_default(),
            is_crack: false,
        }
    }

    fn of_rock(case: &Case, cut: &state::Cut) -> Self {
        let name = case.rocks.keys().nth(usize::from(cut.rock)).map_or("", String::as_str);
        Self {
            key: format!("rock.{name}.fracture"),
            points: cut.ends.to_vec(),
            law: crack_law(case, usize::from(cut.rock)),
            is_crack: true,
        }
    }

    /// Refuses cuts of which nothing cuts rock; their traces begin with `first`.
    pub(super) fn check(cuts: &[Self], noding: &NodingReport, first: usize) -> Result<(), Invalid> {
        let lost = cuts.iter().zip(&noding.traces[first..]).find(|(_, trace)| trace.in_rock == 0.0);
        lost.map_or(Ok(()), |(cut, _)| {
            let [from, to] = [cut.points.first(), cut.points.last()].map(|p| p.copied().unwrap_or_default());
            let message = format!(
                "from ({}, {}) to ({}, {}) m cuts no rock: it lies outside the outline, on another joint, or ends \
                 within one triangle of the mesh; lead it through rock, or remove it",
                from.x, from.y, to.x, to.y
            );
            Err(Invalid { key: cut.key.clone(), message })
        })
    }
}
