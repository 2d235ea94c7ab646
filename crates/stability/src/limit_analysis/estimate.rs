//! An estimate of the factor of joints that dilate as the case says, and not by their friction angle: shear strengths
//! under the normal forces of the last round, until these agree (theory, section 19).

use super::RANGE;
use super::contact::Contact;
use super::opened::{Opened, opening};
use super::program::{Given, Held, Program, Unsolved};
use super::search::Limit;

/// Share of the work of friction and cohesion by which that under the forces of a round may differ from what the round
/// assumed, and the rounds one after the other in which it must not.
const AGREES: f64 = 1e-3;
const TWICE: usize = 2;
/// Rounds after which there is no estimate.
const ROUNDS: usize = 60;
/// Part of the change of the normal forces that the first round takes over, the least part, and how the part falls
/// where forces disagree more than in the last round, and grows where less.
const PART: f64 = 0.5;
const LEAST_PART: f64 = 0.1;
const FALL: f64 = 0.5;
const GROWTH: f64 = 1.5;
/// Strength beyond the least one, relative to it, at which springs take up the forces.
const SPARE: f64 = 1e-6;

/// Normal forces that give shear strengths, and how they change from round to round.
struct Rounds {
    program: Program,
    /// Strength that was found last.
    strength: f64,
    /// Normal force (N/m) of each contact.
    normals: Vec<f64>,
    part: f64,
    /// How far forces disagreed in the last round.
    last: f64,
    /// Rounds up to the last in which work agreed.
    agreed: usize,
}

/// Estimates the limit, from the one of joints that dilate by their friction angle; none where rounds do not agree.
/// Contacts that open are bare.
pub fn estimate(opened: &Opened) -> (Option<Limit>, usize) {
    let (Some(solution), Some(strength)) = (&opened.limit.mechanism, opened.limit.low) else {
        return (Some(opened.limit.clone()), 0);
    };
    let (program, normals) = (opened.program.clone(), solution.normals.clone());
    let mut rounds = Rounds { program, strength, normals, part: PART, last: f64::INFINITY, agreed: 0 };
    for count in 1..=ROUNDS {
        match rounds.next() {
            Ok(Some(held)) => return (Some(limit(&opened.limit, held)), count),
            Ok(None) => {}
            Err(_) => return (None, count),
        }
    }
    (None, ROUNDS)
}

impl Rounds {
    /// One round more; the mechanism once forces agree and no contact that opens in it has cohesion.
    fn next(&mut self) -> Result<Option<Held>, Unsolved> {
        let given: Vec<Given> = (self.program.contacts.iter().zip(&self.normals))
            .map(|(contact, &normal)| Given { normal, dilation: self.dilation(contact) })
            .collect();
        let held = self.program.hold(&given, 1.0 / RANGE[1])?;
        let normals = self.program.settle(&given, held.strength * (1.0 + SPARE))?;
        self.strength = held.strength;
        let (work, differs) = self.difference(&held, &normals);
        self.agreed = if work < AGREES { self.agreed + 1 } else { 0 };
        if self.agreed >= TWICE {
            let opening = opening(&self.program, &held.motions, |k, _| given[k].dilation);
            if opening.is_empty() {
                return Ok(Some(held));
            }
            self.program.bare(&opening);
            self.agreed = 0;
        }
        let is_better = differs < self.last;
        self.part = if is_better { (GROWTH * self.part).min(1.0) } else { (FALL * self.part).max(LEAST_PART) };
        self.last = differs;
        self.normals.iter_mut().zip(&normals).for_each(|(old, new)| *old += self.part * (new - *old));
        Ok(None)
    }

    /// tan ψ of a contact, as the law has it and no more than friction.
    fn dilation(&self, contact: &Contact) -> f64 {
        contact.dilation.min(self.strength * contact.friction)
    }

    /// Difference of the work of friction and cohesion under these forces from what was assumed, relative to it: of
    /// all contacts together, and with those counted apart that gain and lose.
    fn difference(&self, held: &Held, normals: &[f64]) -> (f64, f64) {
        let (mut gained, mut lost, mut all) = (0.0, 0.0, 0.0);
        for (k, contact) in self.program.contacts.iter().enumerate() {
            let [old, new] = [self.normals[k], normals[k]].map(|force| held.slips[k] * contact.shear_strength(force));
            gained += f64::max(new - old, 0.0);
            lost += f64::max(old - new, 0.0);
            all += old;
        }
        let all = f64::max(all, f64::MIN_POSITIVE);
        ((gained - lost).abs() / all, (gained + lost) / all)
    }
}

/// The limit of a round; no more than that of joints that dilate by their friction angle, to which its forces belong.
fn limit(associated: &Limit, held: Held) -> Limit {
    let mut limit = associated.clone();
    let strength = associated.factor().strength().max(held.strength);
    (limit.low, limit.high) = (Some(strength), Some(strength));
    if let Some(solution) = &mut limit.mechanism {
        // The slope is that of another program.
        (solution.motions, solution.slope) = (held.motions, 0.0);
    }
    limit
}
