//! Drains of a case.

use crate::flow::{self, FlowNet};
use crate::geometry::Point;
use crate::model::case::{self, Case, Invalid};

/// Lines of the drains of a case.
pub(super) fn lines(case: &Case) -> Vec<Vec<Point>> {
    case.drains.iter().map(|drain| drain.points.iter().map(|&point| Point::from(point)).collect()).collect()
}

/// Drains with the nodes on their lines, and the stages in which they act.
pub(super) fn drains(
    case: &Case,
    net: &FlowNet,
    lines: &[Vec<Point>],
    tolerance: f64,
) -> Result<Vec<flow::Drain>, Invalid> {
    let mut owner: Vec<Option<usize>> = vec![None; net.places.len()];
    let mut drains = Vec::new();
    for (k, (drain, line)) in case.drains.iter().zip(lines).enumerate() {
        let case::Drain { name, active, pump, .. } = drain;
        let key = format!("drain[{k}].points");
        let on = |node: &u32| flow::is_on(line, net.places[*node as usize], tolerance);
        let nodes: Vec<u32> = (0..net.places.len() as u32).filter(on).collect();
        if nodes.is_empty() {
            let message = "crosses no joint, so that it drains nothing: lead it through joints that conduct water";
            return Err(Invalid { key, message: message.to_owned() });
        }
        for &node in &nodes {
            if let Some(other) = owner[node as usize].replace(k) {
                let at = net.places[node as usize];
                let message = format!(
                    "crosses the joint at ({:.6}, {:.6}) m where drain {:?} does too; move one of both",
                    at.x, at.y, case.drains[other].name
                );
                return Err(Invalid { key, message });
            }
        }
        let mut acts = *active;
        let of_stage = |stage: &case::Stage| {
            acts |= stage.drain.contains(name);
            acts
        };
        let active = case.stages.iter().map(of_stage).collect();
        drains.push(flow::Drain { name: name.clone(), nodes, mouth: line[0].y, pump: *pump, active });
    }
    Ok(drains)
}
