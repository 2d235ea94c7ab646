//! Stages of a step, each timed by the step itself, on standard models; `cargo bench --bench stages -- sweep` picks.

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};

use enmm::model::Simulation;
use enmm::state::{Seconds, State};
use enmm_bench::Model;

/// Models whose stages are timed.
const MODELS: [Model; 3] = [Model::Continuum(10_000), Model::Slope(500, 4), Model::Slope(500, 16)];
/// A stage: name and time so far (s).
type Stage = (&'static str, fn(&Seconds) -> f64);
const STAGES: [Stage; 5] = [
    ("search", |s| s.search),
    ("elements", |s| s.elements),
    ("entrance", |s| s.entrance),
    ("sweep", |s| s.sweep),
    ("commit", |s| s.commit),
];
/// Steps after which a model goes back to where it started, so that all samples do the same work.
const STEPS: u64 = 50;

fn stages(criterion: &mut Criterion) {
    for model in MODELS {
        let mut simulation = model.build().unwrap_or_else(|e| panic!("{model}: {e}"));
        model.warm(&mut simulation).unwrap_or_else(|e| panic!("{model}: {e}"));
        let start = simulation.state().clone();
        let contacts = !start.contacts.is_empty();
        let mut group = criterion.benchmark_group(model.to_string());
        group.sample_size(10).measurement_time(Duration::from_secs(2));
        for (name, part) in STAGES.into_iter().filter(|(name, _)| contacts || ["elements", "commit"].contains(name)) {
            group.bench_function(name, |bencher| {
                bencher.iter_custom(|steps| Duration::from_secs_f64(run(&mut simulation, &start, steps, part)));
            });
        }
    }
}

/// Time (s) that a part of so many steps took.
fn run(simulation: &mut Simulation, start: &State, steps: u64, part: fn(&Seconds) -> f64) -> f64 {
    let before = part(&simulation.workspace().seconds);
    for step in 0..steps {
        if step % STEPS == 0 {
            simulation.restore(start.clone());
        }
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    }
    part(&simulation.workspace().seconds) - before
}

criterion_group!(benches, stages);
criterion_main!(benches);
