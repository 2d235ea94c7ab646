//! Loads on the sides of the rock: tractions, pressures and water, in the stage that a model has reached.

use std::collections::BTreeMap;

use enmm::geometry::{Point, TraceId, Vector, segment};
use enmm::model::Simulation;
use enmm::model::case::LoadKind;
use enmm::model::tables::BoundaryPiece;

use super::marks::Marks;

/// A load on sides of the rock.
#[derive(Debug, Clone)]
enum Push {
    /// Traction (Pa) in global axes.
    Traction(Vector),
    /// Pressure (Pa) into the rock.
    Pressure(f64),
    /// Fluid pressure (Pa) in joints along a segment, at both of its ends.
    Joint([Point; 2], [f64; 2]),
}

/// Still water below a level or a table.
#[derive(Debug, Clone)]
struct Water {
    /// Unit weight (N/m³).
    weight: f64,
    /// Whether it stands in the pores of rock, too.
    in_rock: bool,
    /// Surface (m) from left to right, level beyond its ends.
    surface: Vec<Point>,
    /// Edges of the boundary that it reaches, by the trace that made them.
    reached: BTreeMap<Option<TraceId>, Vec<[Point; 2]>>,
}

/// All loads of a model in the stage that it has reached.
#[derive(Debug, Clone)]
pub struct Loads {
    /// By their place in the case; none for those that act on all rock.
    pushes: Vec<Option<(Push, [[f64; 2]; 2])>>,
    water: Option<Water>,
    /// Acceleration (m/s²) of all rock.
    pub acceleration: Vector,
}

impl Loads {
    /// Reads the loads; factors of time tables are constant.
    pub fn new(simulation: &Simulation) -> Self {
        let time = simulation.time();
        let model = simulation.model();
        let push = |(k, load): (usize, &enmm::model::case::Load)| {
            let factor = model.loads[k].table.at(time);
            let pressure = factor * load.pressure.unwrap_or_default();
            let edge = load.edge?;
            let push = match load.kind {
                LoadKind::Traction => Push::Traction(Vector::from(load.traction.unwrap_or_default()) * factor),
                LoadKind::Pressure => Push::Pressure(pressure),
                LoadKind::Joint => {
                    let end = load.pressure_end.map_or(pressure, |end| factor * end);
                    Push::Joint(edge.map(Point::from), [pressure, end])
                }
                LoadKind::Point | LoadKind::Body | LoadKind::Block => return None,
            };
            Some((push, edge))
        };
        let pushes = simulation.case().loads.iter().enumerate().map(push).collect();
        Self { pushes, water: water(simulation), acceleration: simulation.acceleration() }
    }

    /// Loads on a piece of boundary.
    pub fn on(&self, piece: &BoundaryPiece, lies_on: impl Fn([[f64; 2]; 2]) -> bool) -> Vec<usize> {
        let acts = |(push, edge): &(Push, [[f64; 2]; 2])| {
            let fits = match push {
                Push::Joint(..) => piece.trace.is_some(),
                _ => piece.opposite.is_none(),
            };
            fits && lies_on(*edge)
        };
        (0..self.pushes.len()).filter(|&k| self.pushes[k].as_ref().is_some_and(acts)).collect()
    }

    /// Whether water reaches a piece of boundary: its middle lies, within a tolerance (m), on an edge that it reaches.
    pub fn reach(&self, piece: &BoundaryPiece, tolerance: f64) -> bool {
        let edges = self.water.as_ref().and_then(|water| water.reached.get(&piece.trace));
        let middle = (piece.a + piece.b) / 2.0;
        let on = |[a, b]: &[Point; 2]| segment::distance(middle, *a, *b) <= tolerance;
        edges.is_some_and(|edges| edges.iter().any(on))
    }

    /// Shares of the way along a segment where the pressure of the water bends, in order.
    pub fn kinks(&self, a: Point, b: Point) -> Vec<f64> {
        let Some(water) = &self.water else { return Vec::new() };
        let run = b - a;
        let mut kinks: Vec<f64> = Vec::new();
        kinks.extend(water.surface.iter().filter(|_| run.x != 0.0).map(|p| (p.x - a.x) / run.x));
        let mut stops = kinks.clone();
        stops.extend([0.0, 1.0]);
        stops.retain(|s| (0.0..=1.0).contains(s));
        stops.sort_by(f64::total_cmp);
        for pair in stops.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|s| water.depth(a + run * s));
            if p * q < 0.0 {
                kinks.push(pair[0] + (pair[1] - pair[0]) * p / (p - q));
            }
        }
        kinks.retain(|s| *s > 0.0 && *s < 1.0);
        kinks.sort_by(f64::total_cmp);
        kinks
    }

    /// Tractions (Pa) in global axes at both ends of a part of a side, on the rock on its left; linear between.
    pub fn tractions(&self, marks: &Marks, ends: [Point; 2]) -> [Vector; 2] {
        let along = (ends[1] - ends[0]).normalize();
        let inward = Vector::new(-along.y, along.x);
        let dead: Vector = self.dead(marks);
        self.pressures(marks, ends).map(|p| inward * p + dead)
    }

    fn dead(&self, marks: &Marks) -> Vector {
        let of = |k: &usize| match &self.pushes[*k] {
            Some((Push::Traction(t), _)) => *t,
            _ => Vector::zeros(),
        };
        marks.loads.iter().map(of).sum()
    }

    /// Pressures (Pa) at both ends of a part of a side: of loads, and of water in the half of it that is wet.
    pub fn pressures(&self, marks: &Marks, ends: [Point; 2]) -> [f64; 2] {
        let of = |k: &usize, p: Point| match &self.pushes[*k] {
            Some((Push::Pressure(pressure), _)) => *pressure,
            Some((Push::Joint(edge, pressure), _)) => {
                let along = edge[1] - edge[0];
                let s = (p - edge[0]).dot(&along) / along.norm_squared();
                pressure[0] + (pressure[1] - pressure[0]) * s
            }
            _ => 0.0,
        };
        let water = self.water.as_ref().filter(|_| marks.is_wet);
        ends.map(|p| {
            let wet = water.map_or(0.0, |water| water.weight * water.depth(p).max(0.0));
            wet + marks.loads.iter().map(|k| of(k, p)).sum::<f64>()
        })
    }

    /// Pressure (Pa) in the pores at a position.
    pub fn pore_pressure(&self, at: Point) -> f64 {
        let water = self.water.as_ref().filter(|water| water.in_rock);
        water.map_or(0.0, |water| water.weight * water.depth(at).max(0.0))
    }

    /// Greatest pressure or traction (Pa).
    pub fn greatest(&self) -> f64 {
        let of = |push: &Push| match push {
            Push::Traction(t) => t.norm(),
            Push::Pressure(p) => p.abs(),
            Push::Joint(_, p) => p[0].abs().max(p[1].abs()),
        };
        self.pushes.iter().flatten().map(|(push, _)| of(push)).fold(0.0, f64::max)
    }
}

impl Water {
    /// Depth (m) of a position below the surface.
    fn depth(&self, p: Point) -> f64 {
        let after = self.surface.partition_point(|q| q.x <= p.x);
        let height = match (after.checked_sub(1).map(|k| self.surface[k]), self.surface.get(after)) {
            (Some(a), Some(b)) => a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x),
            (Some(a), None) => a.y,
            (None, Some(b)) => b.y,
            (None, None) => f64::NEG_INFINITY,
        };
        height - p.y
    }
}

fn water(simulation: &Simulation) -> Option<Water> {
    let (model, state) = (simulation.model(), simulation.state());
    let water = model.water.as_ref()?;
    let share = state.drive.share(simulation.time());
    let surface = water.surfaces[state.stage as usize].moved_to(state.drive.water_level(share));
    let boundary = &model.boundary;
    let mut reached = BTreeMap::<_, Vec<[Point; 2]>>::new();
    for &edge in &water.edges {
        let ends = [boundary.reference[edge], boundary.reference[boundary.next[edge]]];
        reached.entry(boundary.trace[edge]).or_default().push(ends);
    }
    Some(Water {
        weight: state.water_density * state.drive.gravity(share).norm(),
        in_rock: water.in_rock,
        surface,
        reached,
    })
}
