//! What a picture of a model shows beside its blocks.

use enmm::contact::EdgeId;
use enmm::cover::CoverId;
use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::case::Port;

use crate::ModelAnnotations;

/// Title, stars, supports, monitors, ports, joints and counts of a model.
pub fn model_annotations(simulation: &Simulation) -> ModelAnnotations {
    let (model, case) = (simulation.model(), simulation.case());
    let covers = &model.covers;
    let supports = model.supports.iter().map(|support| {
        let position = |(&i, w): (&CoverId, f64)| covers.star_position[i] * w;
        support.covers.iter().zip(support.weights).map(position).sum()
    });
    let mut fixed: Vec<Point> = supports.collect();
    fixed.dedup();
    let boundary = &model.boundary;
    let ends = |k: EdgeId| [boundary.reference[k], boundary.reference[boundary.after(k)]];
    let joints = boundary.edges().filter_map(|k| Some((ends(k), model.trace_law[boundary.trace[k]?].number())));
    let monitors = case.monitors.iter().map(|monitor| (monitor.name.clone(), Point::from(monitor.point)));
    let ports = case.ports.iter().filter_map(|port| Some((port.name.clone(), place_of(port)?)));
    ModelAnnotations {
        title: case.title.clone(),
        stars: covers.covers_by_star().into_iter().map(|(star, count)| (covers.mesh.node(star), count)).collect(),
        fixed,
        monitors: monitors.chain(ports).collect(),
        counts: vec![
            format!("{} blocks", covers.block_count()),
            format!("{} elements", covers.element_count()),
            format!("{} physical covers", covers.cover_count()),
            format!("mesh size {} m", covers.mesh.size),
        ],
        bolts: case.bolts.iter().map(|bolt| bolt.points.map(Point::from)).collect(),
        trace_segments: joints.collect(),
    }
}

/// Where a port is marked: at its point or half way along its segment.
fn place_of(port: &Port) -> Option<Point> {
    let middle = |[a, b]: [[f64; 2]; 2]| Point::from([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    port.block.map(Point::from).or_else(|| port.boundary.or(port.joint).map(middle))
}
