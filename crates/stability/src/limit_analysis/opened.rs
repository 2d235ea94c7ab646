//! Cohesion and tensile strength that mechanisms count of joints which they open (theory, section 19).

use super::contact::Contact;
use super::program::{Motion, Program, Unsolved};
use super::search::{Limit, STILL, Search};

/// A limit without cohesion and tensile strength of the contacts that open in its mechanism.
pub struct Opened {
    /// The limit.
    pub limit: Limit,
    /// The blocks, with those contacts bare.
    pub program: Program,
    /// Share of the work of cohesion and tensile strength, in the mechanism that counts all, that such contacts do.
    pub share: f64,
    /// How many they are.
    pub contacts: usize,
}

/// Bares contacts that open in the mechanism of a limit, until none that opens has any cohesion or tensile strength.
///
/// # Errors
/// A program that is not solved.
pub fn opened(search: &mut Search, limit: &Limit) -> Result<Opened, Unsolved> {
    let mut found = Opened { limit: limit.clone(), program: search.program.clone(), share: 0.0, contacts: 0 };
    while let (Some(solution), Some(strength)) = (&found.limit.mechanism, found.limit.low) {
        let opening = opening(&found.program, &solution.motions, |_, contact| strength * contact.friction);
        if opening.is_empty() {
            break;
        }
        if found.contacts == 0 {
            found.share = share(&found.program, &solution.motions, strength, &opening);
        }
        found.contacts += opening.len();
        found.program.bare(&opening);
        let mut again = Search { program: &found.program, programs: 0 };
        found.limit = again.limit_near(&[], Some(&found.limit))?;
        search.programs += again.programs;
    }
    Ok(found)
}

/// Contacts with cohesion or tensile strength of which one end opens faster than slip dilates.
pub fn opening(program: &Program, motions: &[Motion], dilation: impl Fn(usize, &Contact) -> f64) -> Vec<usize> {
    let still = STILL * program.fastest(motions);
    let opens = |(k, contact): &(usize, &Contact)| {
        let beyond = contact.opening(&program.partings(motions, contact), dilation(*k, contact)).1;
        contact.cohesion.max(contact.tension) > 0.0 && beyond.into_iter().any(|speed| speed > still)
    };
    program.contacts.iter().enumerate().filter(opens).map(|(k, _)| k).collect()
}

/// Share of the work of cohesion and tensile strength that some contacts do.
fn share(program: &Program, motions: &[Motion], strength: f64, some: &[usize]) -> f64 {
    let work = |contact: &Contact| {
        let (slip, beyond) = contact.opening(&program.partings(motions, contact), strength * contact.friction);
        let opens = beyond.iter().map(|speed| speed.max(0.0)).sum::<f64>() / beyond.len() as f64;
        contact.cohesion.max(strength * contact.tension * contact.friction) * slip + contact.tension * opens
    };
    let all: f64 = program.contacts.iter().map(work).sum();
    some.iter().map(|&k| work(&program.contacts[k])).sum::<f64>() / all.max(f64::MIN_POSITIVE)
}
