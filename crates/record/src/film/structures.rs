//! Bolts, supports and water of a model as its film has them.

use enmm_report::{BoltFrame, BoltPlace, Structures, SupportFrame};

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::tables::BlockId;
use enmm_observe::{BoltLine, SupportKind, bolts, supports, water_surface, water_weight};

/// Actions on the rock at one instant beside its joints.
#[derive(Debug)]
pub struct Beside {
    bolts: Vec<BoltFrame>,
    supports: Vec<SupportFrame>,
    water_weight: f64,
    water_surface: Vec<[f64; 2]>,
}

impl Beside {
    /// As the model is now.
    pub fn now(simulation: &Simulation) -> Self {
        let lines = bolts(simulation);
        let ends = lines.iter().map(|line| [0, 1].map(|k| line.ends[k] - line.reference[k]));
        Self::with(simulation, &lines, ends)
    }

    /// With ends of bolts that are displaced (m) as a reference position (m) of a block is.
    pub fn moved(simulation: &Simulation, displacement: impl Fn(Point, BlockId) -> Vector) -> Self {
        let lines = bolts(simulation);
        let block = |line: &BoltLine, k: usize| simulation.block_labelled(line.blocks[k]).unwrap_or_default();
        let ends = lines.iter().map(|line| [0, 1].map(|k| displacement(line.reference[k], block(line, k))));
        Self::with(simulation, &lines, ends)
    }

    /// With displacements (m) of both ends of each bolt.
    fn with(simulation: &Simulation, lines: &[BoltLine], ends: impl Iterator<Item = [Vector; 2]>) -> Self {
        let bolt = |(line, ends): (&BoltLine, [Vector; 2])| BoltFrame {
            condition: line.condition.number(),
            displacement: ends.map(|end| [end.x, end.y]),
            force: line.force,
        };
        Self {
            bolts: lines.iter().zip(ends).map(bolt).collect(),
            supports: support_frames(simulation),
            water_weight: water_weight(simulation),
            water_surface: water_surface(simulation).iter().map(|point| [point.x, point.y]).collect(),
        }
    }

    /// Structures of a frame, without wet edges.
    pub fn structures(&self) -> Structures<'_> {
        Structures {
            bolts: &self.bolts,
            supports: &self.supports,
            water_weight: self.water_weight,
            water_surface: &self.water_surface,
            wet: &[],
        }
    }
}

/// The supports that hold; of a quiet boundary the dashpots, which are at each of its points.
fn support_frames(simulation: &Simulation) -> Vec<SupportFrame> {
    let there = supports(simulation).into_iter().filter(|support| support.kind != SupportKind::Spring);
    let frame = there.map(|support| SupportFrame {
        place: [support.position.x, support.position.y],
        axes: support.axes,
        absorbs: support.kind == SupportKind::Dashpot,
    });
    frame.collect()
}

/// Free lengths of the bolts of a model, in the order of frames.
pub fn bolt_places(simulation: &Simulation) -> Vec<BoltPlace> {
    let place = |line: &BoltLine| {
        let bolt = line.bolt as usize;
        BoltPlace { name: simulation.case().bolt_name(bolt), ends: line.reference.map(|point| [point.x, point.y]) }
    };
    bolts(simulation).iter().map(place).collect()
}
