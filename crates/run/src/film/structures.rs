//! Bolts, supports and water of a model as its film has them.

use enmm_report::{BoltFrame, BoltPlace, Structures, SupportFrame};

use enmm::cover::BlockId;
use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm_picture::structures::{BoltLine, SupportKind, bolts, supports, water_surface};

/// What acts on the rock at one instant beside its joints.
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
        let (lines, segments) = (bolts(simulation), &simulation.model().bolts);
        let ends = lines.iter().zip(segments).map(|(line, segment)| [0, 1].map(|k| line.ends[k] - segment.points[k]));
        Self::with(simulation, &lines, ends)
    }

    /// With ends of bolts that are displaced (m) as a reference position (m) of a block is.
    pub fn moved(simulation: &Simulation, displacement: impl Fn(Point, BlockId) -> Vector) -> Self {
        let segments = simulation.model().bolts.iter();
        let ends = segments.map(|segment| [0, 1].map(|k| displacement(segment.points[k], segment.blocks[k])));
        Self::with(simulation, &bolts(simulation), ends)
    }

    /// With displacements (m) of both ends of each bolt.
    fn with(simulation: &Simulation, lines: &[BoltLine], ends: impl Iterator<Item = [Vector; 2]>) -> Self {
        let bolt = |(line, ends): (&BoltLine, [Vector; 2])| BoltFrame {
            condition: line.condition.number(),
            displacement: ends.map(|end| [end.x, end.y]),
            force: line.force,
        };
        let (model, state) = (simulation.model(), simulation.state());
        let gravity = state.drive.gravity(state.drive.share(simulation.time())).norm();
        Self {
            bolts: lines.iter().zip(ends).map(bolt).collect(),
            supports: support_frames(simulation),
            water_weight: model.water.as_ref().map_or(0.0, |water| water.density * gravity),
            water_surface: water_surface(simulation).iter().map(|point| [point.x, point.y]).collect(),
        }
    }

    /// What a frame takes, without wet edges.
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
    let bolts = &simulation.case().bolts;
    let place = |segment: &enmm::model::BoltSegment| {
        let bolt = segment.bolt as usize;
        let name = bolts.get(bolt).and_then(|bolt| bolt.name.clone());
        BoltPlace {
            name: name.unwrap_or_else(|| format!("bolt {bolt}")),
            ends: segment.points.map(|point| [point.x, point.y]),
        }
    };
    simulation.model().bolts.iter().map(place).collect()
}
