//! The net of joints of a model as it was built: a function of the case alone.

use enmm_seepage::{Net, Refused, law};

use crate::contact::{Boundary, EdgeId, Facing, Facings, LawId};
use crate::geometry::Point;

use super::drains::Drain;
use super::nodes::Nodes;
use super::parting::Parting;

/// Place outside of the rock at a node of the net.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcrop {
    /// Nothing that water reaches: the node lies within the rock, or where no water goes through.
    #[default]
    None,
    /// Air.
    Air,
    /// The reservoir where its surface is above the node, else air.
    Reservoir,
}

/// A head that is held at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldHead {
    /// Name.
    pub name: String,
    /// Its nodes, in their order.
    pub nodes: Vec<u32>,
    /// Level (m) at the start of each stage.
    pub levels: Vec<f64>,
}

/// Rain that is offered to outcrops.
#[derive(Debug, Clone, PartialEq)]
pub struct FallingRain {
    /// Name.
    pub name: String,
    /// Its outcrops, and the length in plan (m) of the ground that drains to each.
    pub outcrops: Vec<(u32, f64)>,
    /// Rate (m/s) at the start of each stage.
    pub rates: Vec<f64>,
}

/// A piece of joint as a pipe between two nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowPiece {
    /// Edges of the boundary that face each other.
    pub edges: [EdgeId; 2],
    /// Shares of the way along each edge at the first and at the second node.
    pub spans: [[f64; 2]; 2],
    /// Nodes at its ends.
    pub nodes: [u32; 2],
    /// Law of the case, before stages switch it.
    pub law: LawId,
    /// Length (m).
    pub length: f64,
}

/// Joints that conduct water.
#[derive(Debug, Clone)]
pub struct FlowNet {
    /// Pieces of joint, which are the pipes of the net.
    pub pieces: Vec<FlowPiece>,
    /// Places of the nodes (m).
    pub places: Vec<Point>,
    /// Place outside of the rock at each node.
    pub outcrops: Vec<Outcrop>,
    /// Heads that are held.
    pub heads: Vec<HeldHead>,
    /// Rain that falls on outcrops.
    pub rains: Vec<FallingRain>,
    /// Drains.
    pub drains: Vec<Drain>,
    /// Aperture (m) at the start by law; 0 for joints that do not conduct.
    pub apertures: Vec<f64>,
    /// Mechanical aperture (m) at the start by law, and the hydraulic one over its square (1/m); none of smooth ones.
    pub mechanical: Vec<Option<[f64; 2]>>,
    /// Least and greatest aperture (m) of joints that conduct.
    pub range: [f64; 2],
    /// Dynamic viscosity (Pa s).
    pub viscosity: f64,
    /// Density of the water at the start (kg/m³).
    pub density: f64,
    /// Whether apertures follow openings in the course of static stages.
    pub coupled: bool,
    /// Water (m) that the rock beside joints gives as they drain, for each m² of joint.
    pub storage: f64,
    /// Motion in dynamic stages beyond which a piece has parted, keeps the greatest aperture and pushes no more; none
    /// where pieces push wherever their faces go.
    pub parting: Option<Parting>,
    /// Nodes and pipes, with the order in which systems are solved.
    pub net: Net,
}

impl FlowPiece {
    /// Ends (m) of both faces where the ends of its edges are at these places (m).
    pub fn faces(&self, edges: [[Point; 2]; 2]) -> [[Point; 2]; 2] {
        [0, 1].map(|k| self.spans[k].map(|share| edges[k][0] + (edges[k][1] - edges[k][0]) * share))
    }
}

impl FlowNet {
    /// Finds nodes and pieces; `law` gives the law of an edge, `outside` the place that an edge of the outline meets.
    /// Apertures, heads, rain and drains are still to be
    /// filled in.
    ///
    /// # Errors
    /// More pieces than a net can have.
    pub fn new(
        boundary: &Boundary,
        facings: &Facings,
        law: impl Fn(EdgeId) -> LawId,
        outside: impl Fn(EdgeId) -> Outcrop,
    ) -> Result<Self, Refused> {
        let nodes = Nodes::of(facings.pieces.iter().flat_map(|piece| piece.ends), &facings.same);
        let piece = |facing: &Facing| {
            let [a, b] = facing.ends.map(|end| nodes.at(end));
            let nodes = [a?, b?];
            let Facing { edges, spans, ends, .. } = *facing;
            // Both ends are one where the piece is as short as round-off.
            let length = (ends[1] - ends[0]).norm();
            (nodes[0] != nodes[1]).then_some(FlowPiece { edges, spans, nodes, law: law(edges[0]), length })
        };
        let pieces: Vec<FlowPiece> = facings.pieces.iter().filter_map(piece).collect();
        let mut outcrops = vec![Outcrop::None; nodes.places.len()];
        for edge in boundary.edges().filter(|&edge| boundary.trace[edge].is_none()) {
            let found = [edge, boundary.after(edge)].map(|point| nodes.at(boundary.reference[point]));
            for node in found.into_iter().flatten() {
                let outcrop = &mut outcrops[node as usize];
                *outcrop = (*outcrop).max(outside(edge));
            }
        }
        let heights: Vec<f64> = nodes.places.iter().map(|place| place.y).collect();
        let pipes: Vec<[u32; 2]> = pieces.iter().map(|piece| piece.nodes).collect();
        let net = Net::new(&heights, &pipes)?;
        let places = nodes.places;
        Ok(Self {
            pieces,
            places,
            outcrops,
            heads: Vec::new(),
            rains: Vec::new(),
            drains: Vec::new(),
            apertures: Vec::new(),
            mechanical: Vec::new(),
            range: [0.0; 2],
            viscosity: 1.0,
            density: 0.0,
            coupled: false,
            storage: 0.0,
            parting: None,
            net,
        })
    }

    /// Aperture (m) of a joint of a law that has opened by `opening` (m) since the start; 0 for one that does not
    /// conduct (Eqs. 96, 103). Closure that is the solver's own does not count.
    pub fn aperture(&self, law: LawId, opening: f64, closes: bool) -> f64 {
        let start = self.apertures[law.index()];
        let opening = if closes { opening } else { opening.max(0.0) };
        let aperture = match self.mechanical[law.index()] {
            Some([mechanical, smoothness]) => {
                let mechanical = (mechanical + opening).max(0.0);
                mechanical.min(smoothness * mechanical * mechanical)
            }
            None => start + opening,
        };
        if start > 0.0 { aperture.clamp(self.range[0], self.range[1]) } else { 0.0 }
    }

    /// Whether a piece conducts at each node.
    pub fn conducting(&self, conductance: &[f64]) -> Vec<bool> {
        let mut conducts = vec![false; self.places.len()];
        for (piece, _) in self.pieces.iter().zip(conductance).filter(|(_, g)| **g > 0.0) {
            piece.nodes.iter().for_each(|&node| conducts[node as usize] = true);
        }
        conducts
    }

    /// Conductance (m²/s per m of head) of a piece with these apertures (m) at its ends, in water of a unit weight
    /// (N/m³; Eq. 95).
    pub fn conductance(&self, piece: &FlowPiece, [e0, e1]: [f64; 2], unit_weight: f64) -> f64 {
        law::conductance(e0, e1, piece.length, unit_weight, self.viscosity)
    }
}
