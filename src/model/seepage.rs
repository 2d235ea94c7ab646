//! Flow in the joints at the start of a static stage, and what is known of it.

use enmm_seepage::{Condition, Failure, Unsolved};
use serde::Serialize;

use crate::contact::{EdgeId, JointLaw};
use crate::cover::BlockId;
use crate::flow::{Drain, FlowNet, FlowPiece, Inlet, Outcrop, Outside, is_open};
use crate::geometry::{Point, Vector};
use crate::state::{FlowBalance, Model, Seepage, State};

use super::Simulation;
use super::bonds::{BondState, bond_states};
use super::case::Invalid;

impl Simulation {
    /// Finds the flow in the joints as they are at the start of a stage, if water flows in them: the steady one, or
    /// that at the end of the time which the stage gives it. `level_before` (m) is that of the reservoir at the end of
    /// the stage before.
    ///
    /// # Errors
    /// No flow has been found.
    pub(super) fn find_flow(&mut self, stage: usize, start: f64, level_before: f64) -> Result<(), Invalid> {
        let (model, state) = (&self.built.model, &self.state);
        let Some(net) = &model.flow else { return Ok(()) };
        let seen = Seen { model, state, net, stage, start, level_before };
        let found = match (self.case.stages[stage].flow_time(), &state.seepage) {
            (Some(time), Some(before)) => seen.over(time, before),
            _ => seen.steady(),
        };
        self.state.seepage = Some(found.map_err(|failure| told(net, &self.case.stages[stage].name, &failure))?);
        Ok(())
    }
}

/// Share of its flow below which a pump runs dry: the rest is the round-off of flows.
const DRY: f64 = 1.0 - 1e-9;

/// Size of the net of joints in which water flows, and what of it water reaches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlowSurvey {
    /// Nodes: ends and crossings of pieces of joint.
    pub nodes: usize,
    /// Pieces of joint that conduct.
    pub pieces: usize,
    /// Nodes that have a head, that of the reservoir included.
    pub heads: usize,
    /// Nodes that are open to the air, those in rain and of drains included.
    pub outcrops: usize,
    /// Nodes within the rock at which a single piece ends.
    pub dead_ends: usize,
    /// Length of all pieces that conduct (m).
    pub length: f64,
    /// Length of those that no head and no outcrop reaches (m): they are dry.
    pub isolated: f64,
    /// Least and greatest transmissivity (m²/s) of pieces that conduct.
    pub transmissivity: [f64; 2],
}

impl Simulation {
    /// Doubts about the drains of the flow that was found at the start of the stage: pumps that take less than they
    /// should, and drains from which water flows into joints.
    pub fn dry_drains(&self) -> Vec<String> {
        let (Some(net), Some(seepage)) = (&self.built.model.flow, &self.state.seepage) else { return Vec::new() };
        let stage = self.state.stage as usize;
        let Some(balance) = seepage.balances.last().filter(|balance| balance.stage as usize == stage) else {
            return Vec::new();
        };
        let active = net.drains.iter().enumerate().filter(|(_, drain)| drain.active[stage]);
        let doubt = |(k, drain): (usize, &Drain)| {
            let [enters, leaves, _] = balance.sums[net.heads.len() + net.rains.len() + k];
            let name = &drain.name;
            match drain.pump {
                Some(pump) if leaves < DRY * pump => Some(format!(
                    "the pump of drain {name:?} runs dry: it takes {leaves:.3e} m²/s of {pump:.3e} m²/s, which is all \
                     that arrives; let it take less, or lead it deeper"
                )),
                None if enters > (1.0 - DRY) * leaves => Some(format!(
                    "drain {name:?} brings {enters:.3e} m²/s of water into joints that are below its mouth: lay its \
                     mouth lower, or give it a `pump`"
                )),
                _ => None,
            }
        };
        active.filter_map(doubt).collect()
    }

    /// The net of joints now, if water flows in them.
    pub fn flow_survey(&self) -> Option<FlowSurvey> {
        let (model, state) = (&self.built.model, &self.state);
        let net = model.flow.as_ref()?;
        let (stage, start) = (state.stage as usize, self.time());
        let level_before = state.drive.water_level(state.drive.share(start));
        Some(Seen { model, state, net, stage, start, level_before }.survey())
    }
}

fn told(net: &FlowNet, stage: &str, failure: &Failure) -> Invalid {
    let place = match failure {
        Failure::Unsolved(Unsolved { node, .. }) => net.places.get(*node),
        Failure::Refused(_) => None,
    };
    let at = place.map_or(String::new(), |p| format!(" near ({:.6}, {:.6}) m", p.x, p.y));
    let message = format!(
        "in stage {stage:?}{at}: {failure}; let apertures differ less, or close joints to water there by `aperture = 0`"
    );
    Invalid { key: "flow".to_owned(), message }
}

/// A model at the start of a stage, whose changes have been made.
pub(super) struct Seen<'a> {
    model: &'a Model,
    state: &'a State,
    pub(super) net: &'a FlowNet,
    pub(super) stage: usize,
    start: f64,
    /// Level (m) of the reservoir at the end of the stage before.
    level_before: f64,
}

impl Seen<'_> {
    fn steady(&self) -> Result<Seepage, Failure> {
        let conductance = self.conductance();
        let flooded = self.flooded(1.0);
        let conditions = self.conditions(&flooded, &conductance, 1.0);
        let at_nodes: Vec<_> = conditions.iter().map(|condition| condition.0).collect();
        let flow = self.net.net.steady(&conductance, &at_nodes)?;
        let (stage, sums) = (self.stage as u32, self.net.sums(&conditions, &flow));
        let mut balances = self.state.seepage.as_ref().map_or_else(Vec::new, |seepage| seepage.balances.clone());
        balances.push(FlowBalance { stage, sums, residual: flow.residual, water: None });
        let conducts = conductance.iter().map(|g| *g > 0.0).collect();
        let time = self.state.seepage.as_ref().map_or(0.0, |seepage| seepage.time);
        Ok(Seepage { unknowns: flow.u, conducts, flooded, balances, time })
    }

    fn survey(&self) -> FlowSurvey {
        let conductance = self.conductance();
        let conditions = self.conditions(&self.flooded(1.0), &conductance, 1.0);
        let labels = self.net.net.pieces(&conductance);
        let (mut ends, mut fed) = (vec![0_u32; labels.len()], vec![false; labels.len()]);
        let open = || self.net.pieces.iter().zip(&conductance).filter(|(_, g)| **g > 0.0);
        open().for_each(|(piece, _)| piece.nodes.iter().for_each(|&node| ends[node as usize] += 1));
        for (label, _) in labels.iter().zip(&conditions).filter(|(_, condition)| is_open(&condition.0)) {
            fed[*label as usize] = true;
        }
        let nodes = || conditions.iter().zip(&ends).filter(|(_, ends)| **ends > 0);
        let count = |is: fn(&Condition) -> bool| nodes().filter(|(condition, _)| is(&condition.0)).count();
        let lengths = |all: bool| {
            let is_isolated = |piece: &FlowPiece| !fed[labels[piece.nodes[0] as usize] as usize];
            let these = open().filter(|(piece, _)| all || is_isolated(piece));
            these.map(|(piece, _)| piece.length).fold(0.0, |sum, length| sum + length)
        };
        let each = || open().map(|(piece, g)| g * piece.length);
        FlowSurvey {
            nodes: nodes().count(),
            pieces: open().count(),
            heads: count(|condition| matches!(condition, Condition::Held { .. })),
            outcrops: count(|condition| matches!(condition, Condition::Air | Condition::Rain { .. })),
            dead_ends: nodes().filter(|(condition, ends)| **ends == 1 && condition.1.is_none()).count(),
            length: lengths(true),
            isolated: lengths(false),
            transmissivity: [each().fold(f64::INFINITY, f64::min), each().fold(0.0, f64::max)],
        }
    }

    /// Conductance (m²/s per m of head) of each piece; 0 where blocks are gone, bonds hold or the law is closed.
    pub(super) fn conductance(&self) -> Vec<f64> {
        let weight = self.unit_weight();
        let bonds = bond_states(self.model, self.state);
        let conducts = |piece: &FlowPiece| {
            let holds = piece.edges.iter().any(|edge| bonds[edge.index()] == BondState::Holds);
            let is_there = piece.edges.iter().all(|&edge| !self.is_gone(edge));
            !holds && is_there && self.net.apertures[self.state.law_switch[piece.law].index()] > 0.0
        };
        let of_piece = |piece: &FlowPiece| match conducts(piece) {
            true => self.net.conductance(piece, self.apertures(piece), weight),
            false => 0.0,
        };
        self.net.pieces.iter().map(of_piece).collect()
    }

    /// Unit weight (N/m³) of the water.
    pub(super) fn unit_weight(&self) -> f64 {
        let drive = &self.state.drive;
        self.state.water_density * drive.gravity(drive.share(self.start)).norm()
    }

    /// Condition at each node, and which inlet it is, at a share of the way from the stage before to this one.
    pub(super) fn conditions(&self, flooded: &[bool], conductance: &[f64], share: f64) -> Vec<(Condition, Option<Inlet>)> {
        let dug = self.dug(flooded);
        let depths: Vec<f64> = self.net.places.iter().map(|&place| self.depth(place, share)).collect();
        let conducts = self.net.conducting(conductance);
        self.net.conditions(Outside { stage: self.stage, share, dug: &dug, depths: &depths, conducts: &conducts })
    }

    /// Law of a piece as it is now.
    pub(super) fn law_of(&self, piece: &FlowPiece) -> &JointLaw {
        &self.state.laws[self.state.law_switch[piece.law]]
    }

    fn block(&self, edge: EdgeId) -> BlockId {
        self.model.boundary.block[edge]
    }

    fn is_gone(&self, edge: EdgeId) -> bool {
        self.state.removed[self.block(edge)]
    }

    /// Apertures (m) at both ends of a piece, by what it has opened since the start.
    pub(super) fn apertures(&self, piece: &FlowPiece) -> [f64; 2] {
        let (boundary, law) = (&self.model.boundary, self.state.law_switch[piece.law]);
        let stars = &self.model.covers.star_position;
        let moved = |point: EdgeId| boundary.sample(point, &self.state.displacement);
        let place = |point: EdgeId| boundary.sample(point, stars) + moved(point);
        let [a, b] = [piece.edges[0], boundary.after(piece.edges[0])].map(place);
        let along = (b - a) / (b - a).norm().max(f64::MIN_POSITIVE);
        let outward = Vector::new(along.y, -along.x);
        let moved_at = |side: usize, end: usize| {
            let (edge, share) = (piece.edges[side], piece.spans[side][end]);
            moved(edge) * (1.0 - share) + moved(boundary.after(edge)) * share
        };
        let closes = !self.model.laws[law].penalty[0];
        [0, 1].map(|end| self.net.aperture(law, (moved_at(1, end) - moved_at(0, end)).dot(&outward), closes))
    }

    /// Depth (m) of a position below the surface of the reservoir, at a share of the way from the stage before;
    /// negative where there is none.
    fn depth(&self, at: Point, share: f64) -> f64 {
        let drive = &self.state.drive;
        let level = drive.water_level(drive.share(self.start));
        let Some(water) = &self.model.water else { return -1.0 };
        let depth = water.surfaces[self.stage].depth(level, at);
        if share >= 1.0 || self.stage == 0 {
            return depth;
        }
        let before = water.surfaces[self.stage - 1].depth(self.level_before, at);
        before + (depth - before) * share
    }

    /// Blocks that have been dug out and filled by the reservoir at a share of the way from the stage before: those
    /// with a face in it, and those beside them.
    pub(super) fn flooded(&self, share: f64) -> Vec<bool> {
        let (boundary, removed) = (&self.model.boundary, &self.state.removed);
        let mut flooded = vec![false; removed.len()];
        let at = |&point: &EdgeId| self.depth(boundary.reference[point], share) > 0.0;
        let deep = |edge: EdgeId| [edge, boundary.after(edge)].iter().any(at);
        let of_water = self.model.water.iter().flat_map(|water| &water.edges);
        of_water.filter(|&&edge| self.is_gone(edge) && deep(edge)).for_each(|&edge| flooded[self.block(edge)] = true);
        let both_gone = |piece: &&FlowPiece| piece.edges.iter().all(|&edge| self.is_gone(edge));
        loop {
            let mut spreads = false;
            for piece in self.net.pieces.iter().filter(both_gone) {
                let [a, b] = piece.edges.map(|edge| self.block(edge));
                if flooded[a] != flooded[b] {
                    (flooded[a], flooded[b], spreads) = (true, true, true);
                }
            }
            if !spreads {
                return flooded;
            }
        }
    }

    /// Air or water that has come to each node in the place of blocks that have been dug out.
    fn dug(&self, flooded: &[bool]) -> Vec<Outcrop> {
        let mut dug = vec![Outcrop::None; self.net.places.len()];
        for piece in &self.net.pieces {
            for block in piece.edges.map(|edge| self.block(edge)).into_iter().filter(|&b| self.state.removed[b]) {
                let here = if flooded[block.index()] { Outcrop::Reservoir } else { Outcrop::Air };
                for node in piece.nodes {
                    dug[node as usize] = dug[node as usize].max(here);
                }
            }
        }
        dug
    }
}
