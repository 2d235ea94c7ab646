//! Drains of a case.

use crate::flow::{self, FlowNet};
use crate::geometry::Point;
use crate::model::case::{self, Case, Invalid};

use super::rain::Owners;

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
    let mut owners = Owners::new(net);
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
        owners.give(&key, nodes.iter().copied(), k, |at, other| {
            format!("crosses the joint at {at} where drain {:?} does too; move one of both", case.drains[other].name)
        })?;
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
