//! Result of a search for a factor of safety.

use crate::meshes::Meshes;
use crate::seismic::Seismic;
use enmm_stability::strength_reduction::{End, MechanismOptions, Reduction};

/// Results: one search for each mechanism, in their order.
#[derive(Debug)]
pub struct Found {
    /// Searches; none is left out, also where too little rock fails to count.
    pub searches: Vec<Reduction>,
    /// Which of them count.
    pub which: MechanismOptions,
    /// The factor on finer meshes, where it was asked for.
    pub meshes: Option<Meshes>,
    /// The yield acceleration, where it was asked for.
    pub seismic: Option<Seismic>,
}

impl Found {
    /// The first search that counts, else the last.
    pub fn main(&self) -> &Reduction {
        &self.searches[self.place_of_main()]
    }

    /// Searches before it whose mechanisms are too small to count.
    pub fn chips(&self) -> impl Iterator<Item = &Reduction> {
        self.searches.iter().take(self.place_of_main()).filter(|search| !self.which.counts(search))
    }

    /// Its place among the searches.
    pub fn place_of_main(&self) -> usize {
        let counts = self.searches.iter().position(|search| self.which.counts(search));
        counts.unwrap_or(self.searches.len() - 1)
    }
}

/// Remedy for a search that found no factor; none when it did.
pub fn remedy(reduction: &Reduction) -> Option<String> {
    let edge = |pick: fn(f64, f64) -> f64, start: f64| reduction.trials.iter().map(|t| t.factor).fold(start, pick);
    match &reduction.end {
        End::Found => None,
        End::StableThroughout => Some(format!(
            "the slope bears even F = {:.4}, the greatest that was tried: raise --high to go on; where no joint on \
             which it could fail daylights there is no end",
            edge(f64::max, 0.0)
        )),
        End::UnstableThroughout => Some(format!(
            "the slope fails even at F = {:.4}: lower --low, or hold or excavate the blocks that fail by their weight \
             alone",
            edge(f64::min, f64::INFINITY)
        )),
        End::Interrupted => Some("interrupted; the trials so far are kept".to_owned()),
        End::Failed(error) => Some(format!(
            "a trial failed numerically, {error}: a finer mesh, a smaller solver.dt_safety or a stiffer contact help"
        )),
    }
}
