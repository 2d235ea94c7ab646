//! Sets of poles: k-means of axes on the sphere, and how many sets there are.
//!
//! Each pole belongs to the centre with which it has the greatest |cosine|, and each centre is the principal axis of
//! its poles, so that the sum of the weighted squares of sines falls until nothing changes. It begins at the pole with
//! the densest surroundings, then at that with the greatest density times the squared sine from the centres before: the
//! same table has the same sets. The number of sets, unless given, is the one with the least integrated completed
//! likelihood criterion −2·ln L + (4·k − 1)·ln n (C. Biernacki, G. Celeux and G. Govaert, 2000), where each set has a
//! Fisher distribution and its share of the poles: a set in halves gains less by its smaller scatter than it loses by
//! their shares.

use crate::axis::{Axis, cosine, principal};
use crate::density::density;
use crate::error::FieldError;
use crate::fisher::Fisher;

/// Most sets that are tried.
pub const SETS_MAX: usize = 8;
/// Least poles of a set whose scatter is measured.
const POLES_MIN: usize = 4;
/// Rounds of k-means at most; a table of thousands of poles settles in some ten.
const ROUNDS: usize = 200;
/// Most poles whose densities are found for the start; beyond, every so many-th one is looked at.
const STARTS_MAX: usize = 2000;

/// Sets of poles.
#[derive(Debug, Clone, PartialEq)]
pub struct Sets {
    /// Set of each pole, by its place in `means`.
    pub of: Vec<usize>,
    /// Mean and scatter of each set, the heaviest first.
    pub means: Vec<Fisher>,
    /// The criterion for each number of sets that was tried, from 1; none where a set had too few poles.
    pub criteria: Vec<Option<f64>>,
}

/// Divides weighted poles into sets, of a given number or of the one with the least criterion.
///
/// # Errors
/// There are too few poles for the number of sets.
pub fn find_sets(poles: &[(Axis, f64)], number: Option<usize>) -> Result<Sets, FieldError> {
    let most = poles.len() / POLES_MIN;
    if let Some(number) = number {
        if number == 0 || number > SETS_MAX || number > most {
            return Err(FieldError::Whole(format!(
                "{number} sets of {} poles, must be from 1 to {}: at most {SETS_MAX}, of {POLES_MIN} poles each at \
                 least; ask for another number",
                poles.len(),
                most.min(SETS_MAX)
            )));
        }
        return Ok(sorted(poles, &divide(poles, number), vec![]));
    }
    if most == 0 {
        let message = format!("{} poles, must be {POLES_MIN} or more; add measurements", poles.len());
        return Err(FieldError::Whole(message));
    }
    let tried: Vec<(Vec<usize>, Option<f64>)> = (1..=most.min(SETS_MAX))
        .map(|number| {
            let of = divide(poles, number);
            let criterion = criterion(poles, &of, number);
            (of, criterion)
        })
        .collect();
    let criteria: Vec<Option<f64>> = tried.iter().map(|(_, criterion)| *criterion).collect();
    let least = tried.iter().filter(|(_, criterion)| criterion.is_some());
    let least = least.min_by(|(_, a), (_, b)| a.unwrap_or(f64::MAX).total_cmp(&b.unwrap_or(f64::MAX)));
    let of = least.map_or_else(|| vec![0; poles.len()], |(of, _)| of.clone());
    Ok(sorted(poles, &of, criteria))
}

/// Sets that the table names, the heaviest first, and their names; poles without a set are in none.
pub fn given_sets(poles: &[(Axis, f64)], names: &[Option<String>]) -> Vec<(String, Fisher, Vec<usize>)> {
    let mut sets: Vec<(String, Vec<usize>)> = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let Some(name) = name else { continue };
        match sets.iter_mut().find(|(known, _)| known == name) {
            Some((_, members)) => members.push(k),
            None => sets.push((name.clone(), vec![k])),
        }
    }
    let of = |members: &[usize]| Fisher::of(&members.iter().map(|&k| poles[k]).collect::<Vec<_>>());
    let mut found: Vec<(String, Fisher, Vec<usize>)> =
        sets.into_iter().filter_map(|(name, members)| Some((name, of(&members)?, members))).collect();
    found.sort_by(|a, b| b.1.weight.total_cmp(&a.1.weight));
    found
}

/// The set of each pole.
fn divide(poles: &[(Axis, f64)], number: usize) -> Vec<usize> {
    let mut centres = starts(poles, number);
    let mut of = vec![usize::MAX; poles.len()];
    for _ in 0..ROUNDS {
        let nearest = |pole: &Axis| {
            let near = |centre: &Axis| cosine(pole, centre).abs();
            (0..number).max_by(|a, b| near(&centres[*a]).total_cmp(&near(&centres[*b]))).unwrap_or_default()
        };
        let next: Vec<usize> = poles.iter().map(|(pole, _)| nearest(pole)).collect();
        if next == of {
            break;
        }
        of = next;
        for (set, centre) in centres.iter_mut().enumerate() {
            let own = || poles.iter().zip(&of).filter(|(_, of)| **of == set).map(|((pole, weight), _)| (pole, *weight));
            if own().next().is_some() {
                *centre = principal(own());
            }
        }
    }
    of
}

/// Centres to begin with.
fn starts(poles: &[(Axis, f64)], number: usize) -> Vec<Axis> {
    let every = poles.len().div_ceil(STARTS_MAX).max(1);
    let seen: Vec<(Axis, f64)> = poles.iter().step_by(every).map(|(pole, _)| (*pole, density(poles, pole))).collect();
    let mut centres: Vec<Axis> = Vec::new();
    for _ in 0..number {
        let away = |pole: &Axis| {
            let near = centres.iter().map(|centre| cosine(pole, centre).powi(2)).fold(0.0, f64::max);
            1.0 - near
        };
        let value = |(pole, density): &(Axis, f64)| density * away(pole);
        let best = seen.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        centres.extend(best.map(|(pole, _)| *pole));
    }
    centres
}

/// The criterion of sets: −2·ln L + (4·k − 1)·ln n; none where one has too few poles.
fn criterion(poles: &[(Axis, f64)], of: &[usize], number: usize) -> Option<f64> {
    let all: f64 = poles.iter().map(|(_, weight)| weight).sum();
    let count = poles.len() as f64;
    let mut likelihood = 0.0;
    for set in 0..number {
        let own: Vec<(Axis, f64)> = poles.iter().zip(of).filter(|(_, of)| **of == set).map(|(pole, _)| *pole).collect();
        let mean = Fisher::of(&own).filter(|mean| mean.count >= POLES_MIN)?;
        let share = libm::log(mean.weight / all);
        // Weights stand for numbers of poles that sum to their count.
        let one = |(pole, weight): &(Axis, f64)| weight * (share + mean.log_density(cosine(pole, &mean.mean)));
        likelihood += own.iter().map(one).sum::<f64>() * count / all;
    }
    Some((4 * number - 1) as f64 * libm::log(count) - 2.0 * likelihood)
}

/// Sets by their weights, the heaviest first; those without a pole are left out.
fn sorted(poles: &[(Axis, f64)], of: &[usize], criteria: Vec<Option<f64>>) -> Sets {
    let number = of.iter().max().map_or(0, |most| most + 1);
    let members = |set: usize| poles.iter().zip(of).filter(move |(_, of)| **of == set).map(|(pole, _)| *pole);
    let mean = |set: usize| Some((set, Fisher::of(&members(set).collect::<Vec<_>>())?));
    let mut means: Vec<(usize, Fisher)> = (0..number).filter_map(mean).collect();
    means.sort_by(|(_, a), (_, b)| b.weight.total_cmp(&a.weight));
    let place = |set: &usize| means.iter().position(|(known, _)| known == set).unwrap_or_default();
    Sets { of: of.iter().map(place).collect(), means: means.iter().map(|(_, mean)| *mean).collect(), criteria }
}
