//! Rain that falls on outcrops of joints.

use crate::flow::{FallingRain, FlowNet, Outcrop};
use crate::geometry::{Point, segment};
use crate::model::case::{Case, Invalid, Rain, Stage};

/// Rain with its outcrops, the ground that drains to each and its rates in each stage.
pub(super) fn rains(case: &Case, net: &FlowNet, tolerance: f64) -> Result<Vec<FallingRain>, Invalid> {
    let mut owner: Vec<Option<usize>> = vec![None; net.places.len()];
    let mut rains = Vec::new();
    for (k, Rain { name, edge, rate }) in case.rains.iter().enumerate() {
        let key = format!("rain[{k}].edge");
        let outcrops = shares(net, edge.map(Point::from), tolerance);
        let [[x0, y0], [x1, y1]] = edge;
        if outcrops.is_empty() {
            let message = format!(
                "no joint crops out on the segment ({x0}, {y0})–({x1}, {y1}), so that all rain runs off: give two \
                 points of one straight side of the outline that joints meet and that no support holds"
            );
            return Err(Invalid { key, message });
        }
        for (node, _) in &outcrops {
            if let Some(other) = owner[*node as usize].replace(k) {
                let at = net.places[*node as usize];
                let message = format!(
                    "meets the outcrop at ({:.6}, {:.6}) m on which rain {:?} falls too: shorten one of both segments",
                    at.x, at.y, case.rains[other].name
                );
                return Err(Invalid { key, message });
            }
        }
        let rates = by_stage(case, *rate, |stage| stage.rain.get(name));
        rains.push(FallingRain { name: name.clone(), outcrops, rates });
    }
    Ok(rains)
}

/// Outcrops on a segment, in order along it, and the length in plan (m) of the part of it that is nearer to each than
/// to the others.
fn shares(net: &FlowNet, [a, b]: [Point; 2], tolerance: f64) -> Vec<(u32, f64)> {
    let along = |node: u32| (net.places[node as usize] - a).dot(&(b - a)) / (b - a).norm_squared();
    let is_on = |node: &u32| {
        let place = *node as usize;
        net.outcrops[place] != Outcrop::None && segment::distance(net.places[place], a, b) <= tolerance
    };
    let mut nodes: Vec<(f64, u32)> =
        (0..net.places.len() as u32).filter(is_on).map(|node| (along(node), node)).collect();
    nodes.sort_by(|(s, i), (t, j)| s.total_cmp(t).then(i.cmp(j)));
    let borders: Vec<f64> = nodes.windows(2).map(|pair| 0.5 * (pair[0].0 + pair[1].0)).collect();
    let plan = (b - a).x.abs();
    let share = |(k, (_, node)): (usize, &(f64, u32))| {
        let from = if k == 0 { 0.0 } else { borders[k - 1] };
        (*node, (borders.get(k).copied().unwrap_or(1.0) - from) * plan)
    };
    nodes.iter().enumerate().map(share).collect()
}

/// A number at the start of each stage, which goes on until a stage gives another.
pub(super) fn by_stage<'a>(case: &'a Case, start: f64, of: impl Fn(&'a Stage) -> Option<&'a f64>) -> Vec<f64> {
    let mut now = start;
    let in_stage = |stage: &'a Stage| {
        now = of(stage).copied().unwrap_or(now);
        now
    };
    case.stages.iter().map(in_stage).collect()
}
