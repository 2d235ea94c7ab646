//! Slopes with two sets of random joints are solved whatever the scatter of their apertures, from full and from dry;
//! a net of ten thousand joints takes a second.

use crate::parts::{FREE, Joints, Random, held};
use enmm_seepage::{Condition, DELTA, Flow, law};
use std::time::Instant;

/// Outline of the slope (m), at scale 1.
const OUTLINE: [[f64; 2]; 6] = [[0.0, 0.0], [60.0, 0.0], [60.0, 30.0], [35.0, 30.0], [20.0, 5.0], [0.0, 5.0]];
/// Angle (°) and mean aperture (m) of each set.
const SETS: [(f64, f64); 2] = [(-35.0, 1e-4), (60.0, 6e-5)];
/// Mean spacing, length and gap of joints (m).
const SPACING: f64 = 2.0;
const LENGTH: f64 = 12.0;
const GAP: f64 = 1.5;
/// Water in front of the slope and behind it (m), at scale 1.
const LEVELS: [f64; 2] = [8.0, 25.0];

/// A part of a joint within the outline, with the edges of the outline on which it ends.
struct Part {
    ends: [[f64; 2]; 2],
    edges: [Option<usize>; 2],
    aperture: f64,
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn between(ends: [[f64; 2]; 2], t: f64) -> [f64; 2] {
    [0, 1].map(|k| ends[0][k] + (ends[1][k] - ends[0][k]) * t)
}

/// Shares of two segments at which they cross.
fn crossing(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let (along, other, gap) = (minus(a[1], a[0]), minus(b[1], b[0]), minus(b[0], a[0]));
    let area = cross(along, other);
    let shares = [cross(gap, other) / area, cross(gap, along) / area];
    shares.iter().all(|share| (0.0..=1.0).contains(share)).then_some(shares)
}

fn is_inside(place: [f64; 2], outline: &[[f64; 2]]) -> bool {
    let mut inside = false;
    for (k, &a) in outline.iter().enumerate() {
        let b = outline[(k + 1) % outline.len()];
        if (a[1] > place[1]) != (b[1] > place[1]) {
            inside ^= place[0] < a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        }
    }
    inside
}

/// Parts of a joint within an outline.
fn clip(ends: [[f64; 2]; 2], aperture: f64, outline: &[[f64; 2]], parts: &mut Vec<Part>) {
    let mut cuts = vec![(0.0, None), (1.0, None)];
    for (k, &a) in outline.iter().enumerate() {
        if let Some([share, _]) = crossing(ends, [a, outline[(k + 1) % outline.len()]]) {
            cuts.push((share, Some(k)));
        }
    }
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in cuts.windows(2) {
        let [from, to] = [pair[0].0, pair[1].0];
        if to - from > 1e-9 && is_inside(between(ends, 0.5 * (from + to)), outline) {
            let ends = [between(ends, from), between(ends, to)];
            parts.push(Part { ends, edges: [pair[0].1, pair[1].1], aperture });
        }
    }
}

/// Rows of joints of all sets, across the outline.
fn parts(random: &mut Random, scatter: f64, outline: &[[f64; 2]]) -> Vec<Part> {
    let (width, height) = (outline[1][0], outline[2][1]);
    let radius = 0.5 * (width * width + height * height).sqrt();
    let mut parts = Vec::new();
    for (angle, mean) in SETS {
        let mut offset = -radius;
        while offset < radius {
            let mut along = -radius - random.between(0.0, LENGTH);
            while along < radius {
                let length = LENGTH * random.between(0.6, 1.4);
                let turned = (angle.to_radians() + 0.03 * random.normal()).sin_cos();
                let (sin, cos) = angle.to_radians().sin_cos();
                let across = offset + 0.1 * SPACING * random.normal();
                let middle = along + 0.5 * length;
                let [x, y] = [0.5 * width + middle * cos - across * sin, 0.5 * height + middle * sin + across * cos];
                let [dx, dy] = [0.5 * length * turned.1, 0.5 * length * turned.0];
                let aperture = (mean * (scatter * random.normal()).exp()).clamp(1e-6, 2e-3);
                clip([[x - dx, y - dy], [x + dx, y + dy]], aperture, outline, &mut parts);
                along += length + GAP * random.between(0.5, 1.5);
            }
            offset += SPACING * random.between(0.6, 1.4);
        }
    }
    parts
}

/// Condition of a node on an edge of the outline.
fn condition(edge: usize, height: f64, levels: [f64; 2]) -> Condition {
    match edge {
        0 | 5 => FREE,
        1 if height <= levels[1] => held(levels[1]),
        1 => FREE,
        _ if height <= levels[0] => held(levels[0]),
        _ => Condition::Air,
    }
}

/// A slope of a size over that of the outline.
fn slope(seed: u64, scatter: f64, scale: f64) -> Joints {
    slope_at(seed, scatter, scale, LEVELS)
}

/// A slope between waters of other levels (m, at scale 1).
pub fn slope_at(seed: u64, scatter: f64, scale: f64, levels: [f64; 2]) -> Joints {
    let levels = levels.map(|level| level * scale);
    let outline = OUTLINE.map(|place| place.map(|x| x * scale));
    let mut parts = parts(&mut Random::new(seed), scatter, &outline);
    let low = |part: &Part| f64::min(part.ends[0][0], part.ends[1][0]);
    let high = |part: &Part| f64::max(part.ends[0][0], part.ends[1][0]);
    parts.sort_by(|a, b| low(a).total_cmp(&low(b)));
    let (mut places, mut conditions): (Vec<[f64; 2]>, Vec<Condition>) = (Vec::new(), Vec::new());
    let mut on: Vec<Vec<(f64, u32)>> = Vec::new();
    for part in &parts {
        let mut ends = Vec::new();
        for (k, share) in [(0, 0.0), (1, 1.0)] {
            let condition = part.edges[k].map(|edge| condition(edge, part.ends[k][1], levels));
            ends.push((share, places.len() as u32));
            places.push(part.ends[k]);
            conditions.push(condition.unwrap_or(FREE));
        }
        on.push(ends);
    }
    for (i, part) in parts.iter().enumerate() {
        let reached = parts[i + 1..].iter().take_while(|other| low(other) <= high(part)).count();
        for j in i + 1..=i + reached {
            if let Some([own, other]) = crossing(part.ends, parts[j].ends) {
                on[i].push((own, places.len() as u32));
                on[j].push((other, places.len() as u32));
                places.push(between(part.ends, own));
                conditions.push(FREE);
            }
        }
    }
    let (mut pipes, mut apertures) = (Vec::new(), Vec::new());
    for (part, nodes) in parts.iter().zip(&mut on) {
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in nodes.windows(2) {
            pipes.push([pair[0].1, pair[1].1]);
            apertures.push([part.aperture; 2]);
        }
    }
    let mut joints = Joints::new(places, pipes, apertures);
    joints.conditions = conditions;
    joints
}

#[test]
fn slopes_are_solved_whatever_the_scatter() {
    for (scatter, allowed) in [(0.0, 1e-11), (1.0, 3e-10), (2.0, 4e-9), (4.0, 1e-6)] {
        let (mut solves, mut most, mut worst) = (0, 0, 0.0_f64);
        for seed in 0..40 {
            let joints = slope(seed, scatter, 1.0);
            let flow = joints.steady();
            solves += flow.solves;
            most = most.max(flow.solves);
            worst = worst.max(flow.inflow.iter().sum::<f64>().abs() / flow.through_flow);
        }
        println!("scatter {scatter}: {solves} solves, {most} at most, balance {worst:.1e}");
        assert!(most < 200 && worst < allowed, "balance {worst:e} at scatter {scatter}");
    }
}

#[test]
fn the_flow_does_not_depend_on_where_it_starts() {
    for seed in 0..20 {
        let joints = slope(seed, 1.0, 1.0);
        let full = joints.steady();
        let dry = vec![-DELTA; full.u.len()];
        let other: Flow = joints.net().steady_from(&joints.conductance(), &joints.conditions, &dry).unwrap();
        let least = 1e-9 * full.flow.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
        for (pipe, _) in joints.pipes.iter().zip(&full.flow).filter(|(_, q)| q.abs() > least) {
            let heads = pipe.map(|node| [&full, &other].map(|flow| law::pressure_head(flow.u[node as usize])));
            assert!(heads.iter().all(|[a, b]| (a - b).abs() < 1e-6), "{heads:?} at seed {seed}");
        }
        let ratio = other.through_flow / full.through_flow - 1.0;
        assert!(ratio.abs() < 1e-8, "{ratio:e} at seed {seed}");
    }
}

#[test]
fn ten_thousand_joints_are_solved_in_a_second() {
    for scatter in [0.0, 1.0] {
        let joints = slope(1, scatter, 10.6);
        let start = Instant::now();
        let net = joints.net();
        let built = start.elapsed();
        let flow = net.steady(&joints.conductance(), &joints.conditions).unwrap();
        let (nodes, pipes, time) = (net.heights().len(), net.pipes().len(), start.elapsed());
        println!("{nodes} nodes, {pipes} pipes: built in {built:?}, all {time:?}, {} solves", flow.solves);
        assert!(nodes > 40_000 && flow.solves < 60 && time.as_secs_f64() < 20.0);
    }
}

#[test]
fn slopes_with_rain_and_pumps_are_solved() {
    let (mut solves, mut most, mut dry) = (0, 0, 0);
    for seed in 0..60 {
        let mut joints = slope(seed, [0.0, 1.0, 2.0][seed as usize % 3], 1.0);
        let mut random = Random::new(seed + 1000);
        for (place, condition) in joints.places.iter().zip(&mut joints.conditions) {
            match condition {
                Condition::Air if place[1] > 29.0 => {
                    *condition = Condition::Rain { rate: 10.0_f64.powf(random.between(-9.0, -5.0)) };
                }
                Condition::Free { .. } if random.between(0.0, 1.0) < 0.02 => {
                    *condition = Condition::Free { source: -10.0_f64.powf(random.between(-9.0, -5.0)) };
                }
                _ => {}
            }
        }
        let flow = joints.steady();
        solves += flow.solves;
        most = most.max(flow.solves);
        assert!(flow.inflow.iter().sum::<f64>().abs() < 1e-8 * flow.through_flow, "balance at seed {seed}");
        for (node, condition) in joints.conditions.iter().enumerate() {
            match *condition {
                Condition::Rain { rate } => {
                    assert!((flow.inflow[node] + flow.run_off[node] - rate).abs() <= 1e-12 * rate);
                    assert!(flow.u[node] <= 0.0 && flow.run_off[node] >= 0.0);
                }
                Condition::Free { source } if source < 0.0 => {
                    assert!((source..=0.0).contains(&flow.inflow[node]), "a pump gives or takes more");
                    dry += u32::from(flow.inflow[node] > source);
                }
                _ => {}
            }
        }
    }
    println!("{solves} solves, {most} at most, {dry} pumps are dry");
    assert!(most < 200 && dry > 60);
}
