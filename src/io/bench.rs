//! Throughput on standard models: a continuum without contact, and a fractured slope that slides.

use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use super::case_error::CaseError;
use super::case_file::parse_case;
use super::summary::WallSeconds;
use crate::model::Simulation;
use crate::model::case::Invalid;
use crate::step::StepError;

/// Steps before the clock runs.
const WARM_STEPS: u64 = 50;
/// Steps between looks at the clock.
const BATCH: u64 = 10;

/// A block of some ten thousand elements that shakes without any contact.
const CONTINUUM: &str = r#"
title = "continuum"
[domain]
outline = [[0, 0], [10, 0], [10, 10], [0, 10]]
[mesh]
size = 0.152
angle_deg = 7
[rock.rock]
density = 2600
young = 5e9
poisson = 0.25
[[fix]]
edge = [[0, 0], [10, 0]]
[[stage]]
name = "shake"
kind = "dynamic"
duration = 1e6
"#;

/// A slope of some four hundred blocks on a weak base joint.
const FRACTURED: &str = r#"
title = "fractured slope"
[domain]
outline = [[0, 0], [230, 0], [230, 120], [120, 120], [60, 20], [0, 20]]
joint_law = "joint"
[mesh]
size = 2.0
angle_deg = 7
[[joint]]
points = [[55, 15], [215, 125]]
[[joint_set]]
dip_deg = 36
dip_sd_deg = 1.5
spacing = 3.2
spacing_sd = 0.5
seed = 11
region = [[58, 18], [122, 122], [200, 122]]
[[joint_set]]
dip_deg = 118
dip_sd_deg = 3
spacing = 3.4
spacing_sd = 0.6
seed = 12
region = [[58, 18], [122, 122], [200, 122]]
[rock.gneiss]
density = 2650
young = 5e9
poisson = 0.25
[joint_law.joint]
friction_deg = 20
[[fix]]
edge = [[0, 0], [230, 0]]
[[stage]]
name = "slide"
kind = "dynamic"
duration = 1e6
"#;

/// Why a benchmark did not run.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// The model cannot be read.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The model cannot be built.
    #[error("{}: {}", .0.key, .0.message)]
    Build(Invalid),
    /// The model failed.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// Throughput of one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Throughput {
    /// Name of the model.
    pub model: String,
    /// Threads that it could use.
    pub threads: usize,
    /// Blocks.
    pub blocks: usize,
    /// Manifold elements.
    pub elements: usize,
    /// Contacts of the last step.
    pub contacts: usize,
    /// Steps timed.
    pub steps: u64,
    /// Wall time (s).
    pub seconds: f64,
    /// Steps per second.
    pub steps_per_second: f64,
    /// Elements times steps per second of the whole step.
    pub element_updates_per_second: f64,
    /// Contacts judged per second of sweeping; null without contact.
    pub contacts_per_second: Option<f64>,
    /// Mean sweeps of a step.
    pub sweeps_mean: f64,
    /// Share of each part in the wall time.
    pub shares: Shares,
}

/// Shares of the wall time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shares {
    /// Elements and kick.
    pub elements: f64,
    /// Search for near edges.
    pub search: f64,
    /// Vertex rule and contact geometry.
    pub entrance: f64,
    /// Open–close iteration.
    pub sweep: f64,
    /// Velocities, positions, ledger.
    pub commit: f64,
    /// What no part claims.
    pub rest: f64,
}

/// Times the standard models for some `seconds` each.
///
/// # Errors
/// A standard model that cannot be built or fails, which is a defect.
pub fn bench(seconds: f64) -> Result<Vec<Throughput>, BenchError> {
    [("continuum", CONTINUUM), ("fractured slope", FRACTURED)]
        .map(|(name, text)| time(name, text, seconds))
        .into_iter()
        .collect()
}

fn time(name: &str, text: &str, seconds: f64) -> Result<Throughput, BenchError> {
    let loaded = parse_case(text, name, Path::new(""))?;
    let mut simulation = Simulation::new(loaded.case).map_err(BenchError::Build)?;
    for _ in 0..WARM_STEPS {
        simulation.advance(false)?;
    }
    let parts_before = WallSeconds::default().plus(&simulation.scratch().seconds, 0.0);
    let before = simulation.state().counters;
    let clock = Instant::now();
    let mut steps = 0;
    while steps == 0 || clock.elapsed().as_secs_f64() < seconds {
        for _ in 0..BATCH {
            simulation.advance(false)?;
        }
        steps += BATCH;
    }
    let elapsed = clock.elapsed().as_secs_f64();
    let after = simulation.state().counters;
    let parts = WallSeconds::default().plus(&simulation.scratch().seconds, 0.0);
    let shares = shares(&parts_before, &parts, elapsed);
    let judged = (after.judged - before.judged) as f64;
    let elements = simulation.slope().covers.element_count();
    Ok(Throughput {
        model: name.to_owned(),
        threads: rayon::current_num_threads(),
        blocks: simulation.slope().covers.block_count(),
        elements,
        contacts: simulation.state().contacts.len(),
        steps,
        seconds: elapsed,
        steps_per_second: steps as f64 / elapsed,
        element_updates_per_second: steps as f64 * elements as f64 / elapsed,
        contacts_per_second: (judged > 0.0).then(|| judged / (shares.sweep * elapsed)),
        sweeps_mean: (after.sweeps - before.sweeps) as f64 / (after.substeps - before.substeps) as f64,
        shares,
    })
}

fn shares(before: &WallSeconds, after: &WallSeconds, elapsed: f64) -> Shares {
    let share = |part: fn(&WallSeconds) -> f64| (part(after) - part(before)) / elapsed;
    let shares = Shares {
        elements: share(|w| w.elements),
        search: share(|w| w.search),
        entrance: share(|w| w.entrance),
        sweep: share(|w| w.sweep),
        commit: share(|w| w.commit),
        rest: 0.0,
    };
    let claimed = shares.elements + shares.search + shares.entrance + shares.sweep + shares.commit;
    Shares { rest: 1.0 - claimed, ..shares }
}
