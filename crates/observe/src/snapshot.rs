//! One instant of a slope as outputs see it: polygons with fields, without covers, weights or time stepping.

use std::ops::Range;

use enmm::geometry::{Point, Vector, polygon};
use enmm::model::Simulation;
use enmm::model::case::Plane;
use enmm::model::tables::{BlockId, ElementId};

use crate::loops::loops;

/// Polygons stored end to end: polygon `k` has the points `start[k]..start[k + 1]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polygons {
    /// First point of each polygon, and the number of points at the end.
    pub start: Vec<u32>,
    /// Corner points (m), counter-clockwise; a hole is joined to its outer loop by a bridge.
    pub points: Vec<Point>,
}

impl Polygons {
    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Whether there is no polygon.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Range of the points of polygon `k`.
    pub fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.start[k] as usize..self.start[k + 1] as usize
    }

    /// Points of polygon `k`.
    pub fn get(&self, k: usize) -> &[Point] {
        &self.points[self.range(k)]
    }
}

/// One instant, current positions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// Simulated time (s).
    pub time: f64,
    /// Manifold elements at their current position.
    pub elements: Polygons,
    /// Displacement (m) of each point of `elements`, from the end of the stage `output.since` on if the case names one.
    pub displacement: Vec<Vector>,
    /// Velocity (m/s) of each point of `elements`.
    pub velocity: Vec<Vector>,
    /// Cauchy stress xx, yy, xy (Pa, tension positive) of each element.
    pub stress: Vec<[f64; 3]>,
    /// Stress out of the plane (Pa, tension positive) of each element: 0 in plane stress.
    pub stress_zz: Vec<f64>,
    /// Plastic strain √(⅔ εp:εp) of each element; empty when no rock yields.
    pub plastic_strain: Vec<f64>,
    /// Share of its strength that the worst section of its block has, of each element; empty when no rock breaks.
    pub strength_share: Vec<f64>,
    /// Block of each element.
    pub block: Vec<u32>,
    /// Rock of each element.
    pub rock: Vec<u32>,
    /// Outline of each block at its current position: all its boundary loops, outer first.
    pub boundaries: Vec<Boundary>,
    /// Names of the joint laws.
    pub joint_laws: Vec<String>,
    /// Names of the rocks.
    pub rocks: Vec<String>,
}

/// Boundary loops of one block.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Boundary {
    /// Block id.
    pub block: u32,
    /// Whether the block is held.
    pub fixed: bool,
    /// Centroid displacement (m).
    pub displacement: Vector,
    /// Loops (outer counter-clockwise, holes clockwise).
    pub loops: Polygons,
    /// Where each point of `loops` was before the block moved (m).
    pub reference: Vec<Point>,
}

impl Snapshot {
    /// The model now, without excavated blocks.
    pub fn of(simulation: &Simulation) -> Self {
        let (model, state) = (simulation.model(), simulation.state());
        let covers = &model.covers;
        let mut snapshot = Self {
            time: simulation.time(),
            joint_laws: simulation.case().joint_laws.keys().cloned().collect(),
            rocks: simulation.case().rocks.keys().cloned().collect(),
            ..Self::default()
        };
        snapshot.elements.start.push(0);
        let patches = model.patch_means(state, 0..covers.element_count());
        for e in elements_there(simulation) {
            for &p in covers.polygon(e) {
                let displacement = model.sample(e, p, &state.displacement);
                snapshot.elements.points.push(p + displacement);
                let before = state.counted_from().map(|from| model.sample(e, p, from));
                snapshot.displacement.push(before.map_or(displacement, |before| displacement - before));
                snapshot.velocity.push(model.sample(e, p, &state.velocity));
            }
            snapshot.elements.start.push(snapshot.elements.points.len() as u32);
            let stress = model.stress_under(state, e, &patches);
            snapshot.stress.push(stress);
            snapshot.stress_zz.push(stress_out_of_plane(simulation, e, stress));
            if !state.plastic.is_empty() {
                snapshot.plastic_strain.push(model.plastic_strain_under(state, e, &patches));
            }
            if model.breaking.is_some() {
                snapshot.strength_share.push(simulation.strength_share(covers.element_block[e]));
            }
            snapshot.block.push(model.labels[covers.element_block[e]]);
            snapshot.rock.push(u32::from(model.element_rock[e]));
        }
        snapshot.boundaries = boundaries(simulation);
        snapshot
    }
}

/// Elements of the blocks that are there, in the order of a snapshot.
pub fn elements_there(simulation: &Simulation) -> impl Iterator<Item = ElementId> {
    let (covers, removed) = (&simulation.model().covers, &simulation.state().removed);
    covers.elements().filter(|&e| !removed[covers.element_block[e]])
}

/// Each point of the elements of a snapshot before it moved (m).
pub fn references(simulation: &Simulation) -> Vec<Point> {
    elements_there(simulation).flat_map(|e| simulation.model().covers.polygon(e).iter().copied()).collect()
}

/// Displacement (m) of each point of the elements of a snapshot since the covers had the displacements `started` (m).
pub fn moved_since(simulation: &Simulation, started: &[Vector]) -> Vec<Vector> {
    let model = simulation.model();
    let now = &simulation.state().displacement;
    let moved = |e, p| model.sample(e, p, now) - model.sample(e, p, started);
    elements_there(simulation).flat_map(|e| model.covers.polygon(e).iter().map(move |&p| moved(e, p))).collect()
}

/// Stress (Pa) out of the plane of an element with a stress xx, yy, xy: ν(xx + yy) − E·εp_zz in plane strain, and what
/// an in-situ stress has beyond that.
fn stress_out_of_plane(simulation: &Simulation, element: ElementId, [xx, yy, _]: [f64; 3]) -> f64 {
    let model = simulation.model();
    let rock = simulation.case().rocks.values().nth(usize::from(model.element_rock[element]));
    let Some(rock) = rock.filter(|rock| rock.plane == Plane::Strain) else { return 0.0 };
    let plastic = simulation.state().plastic.get(element.index()).map_or(0.0, |strain| strain[3]);
    let beyond = if model.pre_stress_out.is_empty() {
        0.0
    } else {
        let [xx, yy, _, zz] = model.pre_stress_and_out(element);
        zz - rock.poisson * (xx + yy)
    };
    rock.poisson * (xx + yy) - rock.young * plastic + beyond
}

/// Loops of all blocks that are there, at their places now.
fn boundaries(simulation: &Simulation) -> Vec<Boundary> {
    let positions = simulation.positions();
    let mut by_block: Vec<(BlockId, Vec<Range<usize>>)> = Vec::new();
    for (block, points) in loops(simulation) {
        match by_block.last_mut() {
            Some((last, loops)) if *last == block => loops.push(points),
            _ => by_block.push((block, vec![points])),
        }
    }
    let there = by_block.into_iter().filter(|(block, _)| !simulation.state().removed[*block]);
    let boundary = |(block, mut loops): (BlockId, Vec<Range<usize>>)| {
        let area = |points: &Range<usize>| polygon::area(&positions[points.clone()]);
        loops.sort_by(|a, b| area(b).total_cmp(&area(a)));
        Boundary {
            block: simulation.model().labels[block],
            fixed: simulation.workspace().mass_matrix.fixed[block],
            displacement: simulation.displacement_of(block),
            loops: polygons(&loops, &positions),
            reference: loops
                .into_iter()
                .flat_map(|points| &simulation.model().boundary.reference[points])
                .copied()
                .collect(),
        }
    };
    there.map(boundary).collect()
}

fn polygons(loops: &[Range<usize>], points: &[Point]) -> Polygons {
    let mut polygons = Polygons { start: vec![0], points: Vec::new() };
    for range in loops {
        polygons.points.extend_from_slice(&points[range.clone()]);
        polygons.start.push(polygons.points.len() as u32);
    }
    polygons
}
