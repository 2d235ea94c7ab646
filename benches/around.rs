//! What stands around the steps: the build of a model, a search, one element by itself, a saved state, a report, a
//! frame.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

use enmm::contact::{NeighbourList, SearchGrid, SearchView};
use enmm::cover::ElementId;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::state::bytes::encode;
use enmm_bench::Model;

const MODEL: Model = Model::Slope(500, 16);

fn moving() -> Simulation {
    let mut simulation = MODEL.build().unwrap_or_else(|e| panic!("{e}"));
    MODEL.warm(&mut simulation).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

fn build(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("build");
    group.sample_size(10).measurement_time(Duration::from_secs(4));
    for model in [MODEL, Model::Continuum(10_000)] {
        group.bench_function(model.to_string(), |bencher| bencher.iter(|| black_box(model.build().is_ok())));
    }
}

/// Near pairs found anew by nodes that stay where they are.
fn search(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("search");
    group.sample_size(20);
    for model in [MODEL, Model::Slope(10_000, 4)] {
        let mut simulation = model.build().unwrap_or_else(|e| panic!("{e}"));
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let (slope, workspace) = (simulation.model(), simulation.workspace());
        let view = SearchView {
            boundary: &slope.boundary,
            frames: &workspace.frames,
            cutoff: 0.25 * slope.covers.mesh.size,
            removed: &simulation.state().removed,
            fixed: &workspace.mass_matrix.fixed,
            serial: true,
        };
        let (mut grid, mut neighbours) = (SearchGrid::default(), NeighbourList::default());
        group.throughput(Throughput::Elements(slope.boundary.len() as u64));
        group.bench_function(model.to_string(), |bencher| bencher.iter(|| grid.search(&view, &mut neighbours)));
    }
}

/// Internal forces of all elements one after the other, by the formula that the step's kernels must agree with.
fn elements(criterion: &mut Criterion) {
    let simulation = moving();
    let (slope, state) = (simulation.model(), simulation.state());
    let covers = &slope.covers;
    let forces = |e: ElementId| -> Vector {
        let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
        let at = slope.deformation(e, &state.displacement);
        at.forces(gradients, covers.element_area[e], slope.rock_of(e), &slope.pre_stress_of(e))[0]
    };
    let mut group = criterion.benchmark_group("elements");
    group.throughput(Throughput::Elements(covers.element_count() as u64));
    group.bench_function("one by one", |bencher| {
        bencher.iter(|| covers.elements().map(forces).sum::<Vector>());
    });
}

fn outputs(criterion: &mut Criterion) {
    let mut simulation = moving();
    let mut group = criterion.benchmark_group("outputs");
    group.sample_size(20);
    let start = simulation.state().clone();
    group.bench_function("saved state", |bencher| bencher.iter(|| black_box(simulation.state().clone())));
    let mut copy = start.clone();
    group.bench_function("state copied into another", |bencher| bencher.iter(|| copy.copy_from(black_box(&start))));
    group.bench_function("checkpoint", |bencher| bencher.iter(|| encode(simulation.state(), "").map(|b| b.len())));
    group.bench_function("snapshot", |bencher| bencher.iter(|| black_box(simulation.snapshot())));
    group.bench_function("energies", |bencher| bencher.iter(|| black_box(simulation.report())));
    group.bench_function("restore", |bencher| bencher.iter(|| simulation.restore(start.clone())));
}

criterion_group!(benches, build, search, elements, outputs);
criterion_main!(benches);
