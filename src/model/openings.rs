//! Apertures that follow openings in the course of a static stage: rounds of flow and rest.

use enmm_seepage::Failure;

use crate::flow::{DEPTH, FlowPiece, accelerate, wet};
use crate::state::{Round, Rounds, Seepage};
use crate::step::{StepError, StepReport};

use super::Simulation;
use super::case::StageKind;
use super::seepage::Seen;

/// Rounds after which apertures stay as they are.
pub(super) const ROUNDS_MAX: u32 = 20;
/// Change of ln e in wet joints that openings may ask for when rounds end: joints in series change their flow by three
/// times that, and the pressure between them by one and a half times that of the greatest.
const ASKED: f64 = 1e-3;

impl Simulation {
    /// Whether apertures of the stage in progress follow openings and have not come to terms with them.
    pub(super) fn awaits_openings(&self) -> bool {
        let is_coupled = self.model().flow.as_ref().is_some_and(|net| net.coupled);
        let stage = self.stage();
        if !is_coupled || stage.kind != StageKind::Static || stage.flow_time().is_some() {
            return false;
        }
        let balance = self.state().seepage.as_ref().and_then(|seepage| seepage.balances.last());
        balance.is_some_and(|balance| balance.rounds.is_none_or(|rounds| !rounds.is_over))
    }

    /// A round, when the rock is at rest by a report: joints have the apertures of their openings, or those that the
    /// last rounds promise, and the flow is found again, unless both agree.
    ///
    /// # Errors
    /// No flow has been found.
    pub(super) fn follow_openings(&mut self, report: &StepReport) -> Result<(), StepError> {
        if !self.awaits_openings() || !self.rock_rests(report) {
            return Ok(());
        }
        let (model, state) = (&self.built.model, &self.state);
        let (Some(net), Some(seepage)) = (&model.flow, &state.seepage) else { return Ok(()) };
        let (stage, start) = (state.stage as usize, self.time());
        let seen = Seen { model, state, net, stage, start, way: None };
        match seen.round(seepage).map_err(|failure| seen.failed(failure))? {
            Outcome::Goes(found) => (self.state.seepage, self.state.most_rest) = (Some(*found), None),
            Outcome::Over(rounds) => {
                let seepage = self.state.seepage.iter_mut();
                seepage.for_each(|seepage| {
                    seepage.rounds.clear();
                    seepage.balances.last_mut().into_iter().for_each(|balance| balance.rounds = Some(rounds));
                });
            }
        }
        Ok(())
    }

    /// A doubt about the stage in progress: its apertures and openings do not agree.
    pub fn unsettled_apertures(&self) -> Option<String> {
        let (net, seepage) = (self.model().flow.as_ref()?, self.state().seepage.as_ref()?);
        let balance = seepage.balances.last().filter(|balance| balance.stage == self.state().stage)?;
        let Some(Rounds { count, asked, piece, agree, .. }) = balance.rounds else {
            return self.awaits_openings().then(|| {
                "the rock has not come to rest, so that apertures have not followed openings: let the stage last longer"
                    .to_owned()
            });
        };
        let [a, b] = net.pieces[piece as usize].nodes.map(|node| net.places[node as usize]);
        let place = a + (b - a) * 0.5;
        (!agree).then(|| {
            format!(
                "apertures and openings do not agree after {count} rounds: near ({:.6}, {:.6}) m openings ask for \
                 {:.1} % more or less; let the stage last longer, give stiffer joints, a greater flow.aperture_min or \
                 a lesser flow.aperture_max, or write `coupled = false` in [flow]",
                place.x,
                place.y,
                100.0 * libm::expm1(asked)
            )
        })
    }
}

/// Outcome of a round.
enum Outcome {
    /// Apertures stay as they are.
    Over(Rounds),
    /// The flow with other apertures.
    Goes(Box<Seepage>),
}

impl Seen<'_> {
    /// The flow with the apertures of the next round, unless rounds are over.
    fn round(&self, seepage: &Seepage) -> Result<Outcome, Failure> {
        let logs: Vec<[f64; 2]> = seepage.apertures.iter().map(|own| own.map(log)).collect();
        let opened = self.asked_for(seepage);
        let less = |(to, from): (&[f64; 2], &[f64; 2])| [log(to[0]) - from[0], log(to[1]) - from[1]];
        let asked: Vec<[f64; 2]> = opened.iter().zip(&logs).map(less).collect();
        let pieces = self.net.pieces.iter().zip(&seepage.conducts);
        let is_wet: Vec<bool> =
            pieces.map(|(piece, conducts)| *conducts && self.is_wet(piece, &seepage.unknowns)).collect();
        let (mut most, mut piece) = (0.0, 0);
        for (k, asked) in asked.iter().enumerate().filter(|(k, _)| is_wet[*k]) {
            let own = asked[0].abs().max(asked[1].abs());
            if own > most {
                (most, piece) = (own, k as u32);
            }
        }
        let before = seepage.balances.last().and_then(|balance| balance.rounds);
        let count = before.map_or(0, |rounds| rounds.count);
        let agree = most <= ASKED;
        if agree || count == ROUNDS_MAX {
            return Ok(Outcome::Over(Rounds { count, asked: most, piece, is_over: true, agree }));
        }
        let kept = seepage.rounds.len().saturating_sub(DEPTH);
        let past: Vec<Round> = seepage.rounds[kept..].iter().cloned().chain([Round { logs, asked }]).collect();
        let mut found = self.steady(self.next(&past, &opened, &is_wet), None)?;
        found.rounds = past;
        let rounds = Rounds { count: count + 1, asked: most, piece, is_over: false, agree };
        found.balances.last_mut().into_iter().for_each(|balance| balance.rounds = Some(rounds));
        Ok(Outcome::Goes(Box::new(found)))
    }

    /// Apertures (m) that openings ask for now of pieces that conduct.
    fn asked_for(&self, seepage: &Seepage) -> Vec<[f64; 2]> {
        let of = |(piece, own): (&FlowPiece, &[f64; 2])| if own[0] > 0.0 { self.apertures(piece) } else { [0.0; 2] };
        self.net.pieces.iter().zip(&seepage.apertures).map(of).collect()
    }

    fn is_wet(&self, piece: &FlowPiece, unknowns: &[f64]) -> bool {
        let heights = piece.nodes.map(|node| self.net.places[node as usize].y);
        wet(piece.nodes.map(|node| unknowns[node as usize]), heights).is_some()
    }

    /// Apertures (m) of the next round: those that the last rounds promise in wet joints, those of openings in others.
    fn next(&self, past: &[Round], opened: &[[f64; 2]], is_wet: &[bool]) -> Vec<[f64; 2]> {
        let rounds: Vec<(&[f64], &[f64])> =
            past.iter().map(|round| (round.logs.as_flattened(), round.asked.as_flattened())).collect();
        let counts: Vec<bool> = is_wet.iter().flat_map(|wet| [*wet; 2]).collect();
        let logs = accelerate(&rounds, &counts);
        let [least, most] = self.net.range;
        let aperture = |k: usize, side: usize| match opened[k][side] {
            0.0 => 0.0,
            direct if !is_wet[k] => direct,
            _ => libm::exp(logs[2 * k + side]).clamp(least, most),
        };
        (0..opened.len()).map(|k| [aperture(k, 0), aperture(k, 1)]).collect()
    }
}

/// Logarithm of an aperture (m); 0 of a closed one.
fn log(aperture: f64) -> f64 {
    if aperture > 0.0 { libm::log(aperture) } else { 0.0 }
}
