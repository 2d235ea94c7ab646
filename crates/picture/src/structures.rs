//! What acts on rock beside its joints at one instant: bolts, supports and water.

use enmm::contact::{EdgeId, Resistance};
use enmm::geometry::{Point, Vector};
use enmm::model::{BoltCondition, BoltSegment, BoltState, Simulation};

/// A free length of a bolt between two material points now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BoltLine {
    /// Both ends (m), the end at the head first.
    pub ends: [Point; 2],
    /// Index of the bolt in the case.
    pub bolt: u32,
    /// Tension (N per metre of depth).
    pub force: f64,
    /// Its condition.
    pub condition: BoltCondition,
}

/// What a support is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SupportKind {
    /// Part of a fixity.
    #[default]
    Fixity,
    /// Spring of a quiet boundary or of a side along a free field.
    Spring,
    /// Dashpot of a quiet boundary or of a side along a free field.
    Dashpot,
}

/// A supported material point now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SupportPoint {
    /// Where (m).
    pub position: Point,
    /// Force (N/m) on the rock.
    pub reaction: Vector,
    /// What supports it.
    pub kind: SupportKind,
    /// Index of the fixity of the case, or of the boundary behind them: quiet boundaries first, then free-field sides.
    pub index: u32,
    /// Which axes are held.
    pub axes: [bool; 2],
}

/// A wet edge of the boundary now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WetEdge {
    /// Both ends (m), rock on the left.
    pub ends: [Point; 2],
    /// Number of its block.
    pub block: u32,
    /// Pressure of the water (Pa) at both ends.
    pub pressure: [f64; 2],
}

/// All bolts.
pub fn bolts(simulation: &Simulation) -> Vec<BoltLine> {
    let (model, state) = (simulation.model(), simulation.state());
    let stars = &model.covers.star_position;
    let line = |(segment, now): (&BoltSegment, &BoltState)| {
        let end = |k: usize| {
            let sample = |field: &[Vector]| -> Vector {
                segment.covers[k].iter().zip(segment.weights[k]).map(|(&i, w)| field[i] * w).sum()
            };
            sample(stars) + sample(&state.displacement)
        };
        BoltLine { ends: [end(0), end(1)], bolt: segment.bolt, force: now.force, condition: now.condition() }
    };
    model.bolts.iter().zip(&state.bolts).map(line).collect()
}

/// All supports that hold, those of one point together.
pub fn supports(simulation: &Simulation) -> Vec<SupportPoint> {
    let (model, state) = (simulation.model(), simulation.state());
    let stars = &model.covers.star_position;
    let mut points: Vec<SupportPoint> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for (k, support) in model.supports.iter().enumerate() {
        if !state.fix_active[support.fix as usize] || state.removed[support.block] {
            continue;
        }
        let key = (support.fix, support.covers, support.weights.map(f64::to_bits));
        let place = *places.entry(key).or_insert_with(|| {
            let sample = |field: &[Vector]| -> Vector {
                support.covers.iter().zip(support.weights).map(|(&i, w)| field[i] * w).sum()
            };
            let quiet = model.quiets.iter().position(|q| [q.springs, q.dashpots].contains(&support.fix));
            let kind = match support.resistance {
                _ if quiet.is_none() => SupportKind::Fixity,
                Resistance::Spring => SupportKind::Spring,
                Resistance::Dashpot(_) => SupportKind::Dashpot,
            };
            points.push(SupportPoint {
                position: sample(stars) + sample(&state.displacement),
                kind,
                index: quiet.map_or(support.fix, |k| k as u32),
                ..SupportPoint::default()
            });
            points.len() - 1
        });
        points[place].reaction += support.direction * state.support_force[k];
        let along = support.direction.abs();
        points[place].axes[usize::from(along.y > along.x)] = true;
    }
    points
}

/// All edges of the boundary that the water reaches at its level now.
pub fn wet_edges(simulation: &Simulation) -> Vec<WetEdge> {
    let (model, state) = (simulation.model(), simulation.state());
    let Some(water) = &model.water else { return Vec::new() };
    let share = state.drive.share(simulation.time());
    let weight = water.density * state.drive.gravity(share).norm();
    let surface = water_surface(simulation);
    let positions = simulation.positions();
    let pressure = |p: Point| weight * (height_at(&surface, p.x) - p.y).max(0.0);
    let wet = |&edge: &EdgeId| {
        let ends = [edge, model.boundary.after(edge)].map(|k| positions[k]);
        WetEdge { ends, block: model.boundary.block[edge].number(), pressure: ends.map(pressure) }
    };
    let there = |edge: &&EdgeId| !state.removed[model.boundary.block[**edge]];
    let edges = water.edges.iter().filter(there).map(wet);
    edges.filter(|edge| edge.pressure.iter().any(|&p| p > 0.0)).collect()
}

/// The surface of the water now, from left to right (m), level beyond both ends; empty without water.
pub fn water_surface(simulation: &Simulation) -> Vec<Point> {
    let Some(water) = &simulation.model().water else { return Vec::new() };
    let drive = &simulation.state().drive;
    let level = drive.water_level(drive.share(simulation.time()));
    if water.table.is_empty() {
        return vec![Point::new(0.0, level)];
    }
    let rise = Vector::new(0.0, level - water.level);
    water.table.iter().map(|point| point + rise).collect()
}

/// Height (m) of a broken line from left to right at `x` (m), level beyond its ends.
pub fn height_at(line: &[Point], x: f64) -> f64 {
    let after = line.partition_point(|p| p.x <= x);
    match (after.checked_sub(1).map(|k| line[k]), line.get(after)) {
        (Some(p), Some(q)) => p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x),
        (Some(p), None) => p.y,
        (None, Some(q)) => q.y,
        (None, None) => f64::NEG_INFINITY,
    }
}
