//! Water that flows in joints at one instant.

use enmm::geometry::Point;
use enmm::model::tables::{FlowNet, Inlet, wet};
use enmm::model::{Flowing, FlowingInlet, FlowingPiece, Quantity, Simulation};

use crate::water::water_weight;

/// A piece of joint that conducts water.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FlowLine {
    /// Ends (m) now, on the face of its first block.
    pub ends: [Point; 2],
    /// Ends (m) in the reference configuration.
    pub reference: [Point; 2],
    /// Nodes of the net at its ends.
    pub nodes: [u32; 2],
    /// Number of its first block.
    pub block: u32,
    /// Heads (m): the heights to which water would rise from both ends; the heights of the ends where they are dry.
    pub heads: [f64; 2],
    /// Shares of its length between which water stands under pressure; equal where it is dry.
    pub wet: [f64; 2],
    /// Pressure (Pa) at both ends.
    pub pressure: [f64; 2],
    /// Share of the film that runs down in it, where it has no pressure: 0 dry, 1 full.
    pub filling: f64,
    /// Flow (m²/s) from its first to its second end.
    pub flow: f64,
    /// Hydraulic aperture (m), the mean of both ends.
    pub aperture: f64,
}

/// Numbers of a piece of joint that conducts water, as outputs show them.
pub const FLOW_QUANTITIES: [Quantity<FlowLine>; 5] = [
    Quantity::plain("head", "m", "Head, mean of both ends", |line| mean(line.heads)),
    Quantity::plain("pressure", "Pa", "Pressure of the water, mean of both ends", |line| mean(line.pressure)),
    Quantity::plain("flow", "m2/s", "Flow of water from the first to the second end", |line| line.flow),
    Quantity::plain("aperture", "m", "Hydraulic aperture, mean of both ends", |line| line.aperture),
    Quantity::plain("filling", "", "Share of its capacity of a film without pressure", |line| line.filling),
];

fn mean(values: [f64; 2]) -> f64 {
    0.5 * (values[0] + values[1])
}

impl FlowLine {
    /// Pressure heads (m) at both ends.
    pub fn pressure_heads(&self) -> [f64; 2] {
        [0, 1].map(|k| self.heads[k] - self.reference[k].y)
    }

    /// Whether no water stands under pressure in it.
    pub fn is_dry(&self) -> bool {
        self.wet[1] <= self.wet[0]
    }

    /// The place (m) of the water table within it, if that lies between its ends.
    pub fn table(&self) -> Option<Point> {
        let inside = |share: &f64| !self.is_dry() && *share > 0.0 && *share < 1.0;
        let share = self.wet.into_iter().find(inside)?;
        Some(self.ends[0] + (self.ends[1] - self.ends[0]) * share)
    }
}

/// An outcrop through which water leaves the joints into the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seep {
    /// Where (m), in the reference configuration.
    pub place: Point,
    /// Flow (m²/s).
    pub flow: f64,
}

/// A drain that acts.
#[derive(Debug, Clone, PartialEq)]
pub struct DrainFlow {
    /// Name.
    pub name: String,
    /// Its points (m), the mouth first.
    pub points: Vec<Point>,
    /// Flow (m²/s) that it takes; negative where it gives water.
    pub flow: f64,
}

/// Water in the joints of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WaterInJoints {
    /// Joints that conduct.
    pub lines: Vec<FlowLine>,
    /// Outcrops that seep.
    pub seeps: Vec<Seep>,
    /// Drains that act.
    pub drains: Vec<DrainFlow>,
}

/// Share of the greatest flow below which an outcrop does not seep: the rest is the round-off of flows.
const SEEPS: f64 = 1e-9;

impl WaterInJoints {
    /// The flow now, as it was found last; none where water does not flow in joints.
    pub fn of(simulation: &Simulation) -> Option<Self> {
        let net = simulation.model().flow.as_ref()?;
        let Flowing { pieces, inlets, drains: acting } = simulation.flowing()?;
        let positions = simulation.positions();
        let weight = water_weight(simulation);
        let lines: Vec<FlowLine> =
            pieces.iter().map(|piece| line(simulation, net, piece, &positions, weight)).collect();
        let most = lines.iter().map(|line| line.flow.abs()).fold(0.0, f64::max);
        let seeps = |inlet: &&FlowingInlet| {
            inlet.is_open && !matches!(inlet.inlet, Inlet::Drain(_)) && -inlet.inflow > SEEPS * most
        };
        let seep = |inlet: &FlowingInlet| Seep { place: net.places[inlet.node as usize], flow: -inlet.inflow };
        let seeps = inlets.iter().filter(seeps).map(seep).collect();
        Some(Self { lines, seeps, drains: drains(simulation, &acting, &inlets) })
    }
}

fn line(simulation: &Simulation, net: &FlowNet, piece: &FlowingPiece, positions: &[Point], weight: f64) -> FlowLine {
    let model = simulation.model();
    let boundary = &model.boundary;
    let FlowingPiece { piece, apertures, unknowns, filling, flow } = *piece;
    let (edge, span) = (piece.edges[0], piece.spans[0]);
    let [a, b] = [edge, boundary.after(edge)].map(|point| positions[point]);
    let reference = piece.nodes.map(|node| net.places[node as usize]);
    let heights = reference.map(|place| place.y);
    let pressure_heads = unknowns.map(|u| u.max(0.0));
    FlowLine {
        ends: span.map(|share| a + (b - a) * share),
        reference,
        nodes: piece.nodes,
        block: model.labels[boundary.block[edge]],
        heads: [0, 1].map(|k| heights[k] + pressure_heads[k]),
        wet: wet(unknowns, heights)
            .map_or([0.0; 2], |wet| [wet.span[0].min(wet.span[1]), wet.span[0].max(wet.span[1])]),
        pressure: pressure_heads.map(|head| weight * head),
        filling,
        flow,
        aperture: mean(apertures),
    }
}

/// Drains that act, with the water that they take.
fn drains(simulation: &Simulation, acting: &[bool], inlets: &[FlowingInlet]) -> Vec<DrainFlow> {
    let taken = |k: usize| {
        let own = inlets.iter().filter(|inlet| inlet.inlet == Inlet::Drain(k as u32));
        own.map(|inlet| -inlet.inflow).fold(0.0, |sum, flow| sum + flow)
    };
    let acting = (0..acting.len()).filter(|&k| acting[k]);
    let drain = |k: usize| {
        let of_case = &simulation.case().drains[k];
        let points = of_case.points.iter().map(|point| Point::from(*point)).collect();
        DrainFlow { name: of_case.name.clone(), points, flow: taken(k) }
    };
    acting.map(drain).collect()
}
