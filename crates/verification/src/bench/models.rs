//! The models that are timed, by name, and how each comes to the state from which its clock runs.

use std::fmt;

use super::BenchError;
use super::slope::{continuum_case, slope_case};
use enmm::model::Simulation;
use enmm_io::parse_case;

/// The example that rests under strong joints and then fails: a copy, since packages hold no files of other folders.
const FRACTURED: &str = include_str!("fractured_slope.toml");
/// Simulated time (s) after the loss of strength at which the failing slope is timed.
const FAILING_FOR: f64 = 0.4;
/// Steps before the clock runs of models that need no state of their own.
const WARM_STEPS: u64 = 100;
/// Element updates before the clock runs that are not exceeded by much: large models start after fewer steps.
const WARM_UPDATES: u64 = 4_000_000;
/// Fewest steps before the clock runs.
const WARM_STEPS_MIN: u64 = 10;
/// Steps between reports while a slope comes to rest.
const REPORT_STEPS: u64 = 50;

/// A model that can be timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// One block of so many elements that shakes on a held base.
    Continuum(usize),
    /// The example `fractured_slope`, at rest under gravity.
    Resting,
    /// The same in motion after it lost its friction.
    Failing,
    /// A slope of so many blocks with so many elements each, sliding.
    Slope(usize, usize),
}

/// Models that are timed when none is named.
pub const STANDARD: [Model; 9] = [
    Model::Continuum(10_000),
    Model::Continuum(100_000),
    Model::Resting,
    Model::Failing,
    Model::Slope(500, 4),
    Model::Slope(500, 16),
    Model::Slope(2_000, 4),
    Model::Slope(2_000, 16),
    Model::Slope(10_000, 4),
];

/// Models that `all` adds: they take minutes, or more than a gigabyte.
pub const LARGE: [Model; 4] =
    [Model::Continuum(1_000_000), Model::Slope(10_000, 16), Model::Slope(100_000, 4), Model::Slope(100_000, 16)];

impl Model {
    /// Reads a name: `continuum_N` with N elements, `fractured_resting`, `fractured_failing`, or `slope_NxM` with N
    /// blocks of M elements.
    pub fn parse(name: &str) -> Option<Self> {
        let positive = |text: &str| text.parse().ok().filter(|&number| number > 1);
        match name {
            "fractured_resting" => Some(Self::Resting),
            "fractured_failing" => Some(Self::Failing),
            _ => match name.strip_prefix("continuum_") {
                Some(elements) => positive(elements).map(Self::Continuum),
                None => {
                    let (blocks, elements) = name.strip_prefix("slope_")?.split_once('x')?;
                    Some(Self::Slope(positive(blocks)?, positive(elements)?))
                }
            },
        }
    }

    /// Text of the case.
    pub fn text(&self) -> String {
        match *self {
            Self::Continuum(elements) => continuum_case(elements),
            Self::Slope(blocks, elements) => slope_case(blocks, elements),
            Self::Resting | Self::Failing => FRACTURED.to_owned(),
        }
    }

    /// Builds the model as its case says.
    ///
    /// # Errors
    /// A model that cannot be built.
    pub fn build(&self) -> Result<Simulation, BenchError> {
        let loaded = parse_case(&self.text(), &self.to_string(), std::path::Path::new(""))?;
        Simulation::new(loaded.case).map_err(BenchError::Build)
    }

    /// Brings a model as built to the state from which its clock runs.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn warm(&self, simulation: &mut Simulation) -> Result<(), BenchError> {
        if matches!(self, Self::Continuum(_) | Self::Slope(..)) {
            let elements = simulation.model().covers.element_count() as u64;
            return advance(simulation, (WARM_UPDATES / elements).clamp(WARM_STEPS_MIN, WARM_STEPS));
        }
        simulation.run_stage_with(REPORT_STEPS, None)?;
        if *self == Self::Failing {
            simulation.next_stage().map_err(BenchError::Build)?;
            advance(simulation, simulation.steps_in(FAILING_FOR))?;
        }
        Ok(())
    }
}

/// Advances so many steps.
pub fn advance(simulation: &mut Simulation, steps: u64) -> Result<(), BenchError> {
    (0..steps).try_for_each(|_| simulation.advance(false).map(|_| ()).map_err(BenchError::Step))
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Continuum(elements) => write!(f, "continuum_{elements}"),
            Self::Resting => f.write_str("fractured_resting"),
            Self::Failing => f.write_str("fractured_failing"),
            Self::Slope(blocks, elements) => write!(f, "slope_{blocks}x{elements}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_failing_slope_is_that_of_the_examples() {
        assert_eq!(FRACTURED, include_str!("../../../../examples/cases/fractured_slope.toml"));
    }

    #[test]
    fn names_are_read_back() {
        for model in STANDARD.iter().chain(&LARGE) {
            assert_eq!(Model::parse(&model.to_string()), Some(*model));
        }
        for name in ["", "slope", "slope_4", "slope_0x4", "slope_4x", "continuum_", "continuum_-3", "fractured"] {
            assert_eq!(Model::parse(name), None, "{name}");
        }
    }
}
