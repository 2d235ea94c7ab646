//! Factors of safety for problems on inclined planes.

use enmm_stability::strength_reduction::{Reduction, ReductionOptions, factor_of_safety};

pub use super::block::G;
use crate::{Plot, Row, Setup, Trouble};

/// Finds the factor of safety of a case; the bracket is 0.2 % wide, or 0.5 % when quick.
///
/// # Errors
/// A case that cannot be built or does not come to rest, or a search without end.
pub fn reduce(setup: &mut Setup, name: &str, text: String) -> Result<Reduction, Trouble> {
    let case = setup.simulation(name, text)?.case().clone();
    let tolerance = if setup.quick { 5e-3 } else { 2e-3 };
    let reduction = factor_of_safety(
        &case,
        &ReductionOptions { tolerance, integrators: &enmm_implicit::Both, ..Default::default() },
        &mut |_, _| {},
    )?;
    match reduction.factor() {
        Some(_) => Ok(reduction),
        None => Err(Trouble(format!("{name}: no factor of safety was found: {:?}", reduction.end))),
    }
}

/// A factor of safety beside its closed form, within 1.5 %.
pub fn factor_row(quantity: &str, reduction: &Reduction, exact: f64, reason: &str) -> Row {
    Row::new(quantity, "", reduction.factor().unwrap_or(f64::NAN), exact).relative(0.015, reason)
}

/// The worst energy ledger of the trials.
pub fn ledger_row(reductions: &[&Reduction]) -> Row {
    let shares = reductions.iter().map(|reduction| reduction.ledger_residual());
    let reason = "claim A4: the leapfrog's own error is ½(ω dt)² of a mode's energy";
    Row::new("energy ledger of the worst trial, residual over largest term", "", shares.fold(0.0, f64::max), 0.0)
        .at_most(1e-3, reason)
}

/// Displacement of each trial against F, and the exact factor as an upright line.
pub fn trial_plot(title: &str, reduction: &Reduction, exact: f64) -> Plot {
    let points: Vec<[f64; 2]> = reduction.trials.iter().map(|t| [t.factor, t.displacement.max(1e-9)]).collect();
    let ends = |pick: fn(f64, f64) -> f64, start: f64| points.iter().map(|p| p[1]).fold(start, pick);
    let exact = vec![[exact, ends(f64::min, f64::INFINITY)], [exact, ends(f64::max, 0.0)]];
    Plot::new(title, ["F", "largest displacement at the end of the trial (m)"])
        .marks("trials", points)
        .line("exact factor of safety", exact)
        .logarithmic([false, true])
}
