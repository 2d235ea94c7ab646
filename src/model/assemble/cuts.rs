//! Cuts of stages: lines that become joints in the middle of a run.

use crate::contact::LawId;
use crate::geometry::{NodingReport, Point};
use crate::model::case::{Case, Invalid};

use super::{law_of, points};

/// A line along which a stage cuts the rock.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Its key: `stage[1].cut[0]`.
    pub key: String,
    /// Its points (m).
    pub points: Vec<Point>,
    /// Its joint law.
    pub law: LawId,
}

impl Cut {
    /// The cuts of all stages up to one, in their order.
    pub fn up_to(case: &Case, stage: usize) -> Vec<Self> {
        let stages = case.stages.iter().take(stage + 1).enumerate();
        let cuts = stages.flat_map(|(stage, of)| of.cuts.iter().enumerate().map(move |(k, cut)| (stage, k, cut)));
        let of = |(stage, k, cut): (usize, usize, &crate::model::case::StageCut)| Self {
            key: format!("stage[{stage}].cut[{k}]"),
            points: points(&cut.points),
            law: law_of(case, &cut.law).unwrap_or_default(),
        };
        cuts.map(of).collect()
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
