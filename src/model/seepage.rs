//! Flow in the joints at the start of a static stage and in the course of a dynamic one, and what is known of it.

use enmm_seepage::{Condition, Failure, Refused, Unsolved};
use serde::Serialize;

use crate::contact::EdgeId;
use crate::cover::BlockId;
use crate::flow::{Drain, FlowNet, FlowPiece, Inlet, Outcrop, Outside, is_open};
use crate::geometry::{Point, Vector};
use crate::state::{FlowBalance, Model, Seepage, State, Surroundings};
use crate::step::{self, Regime, StepError};

use super::Simulation;
use super::bonds::{BondState, bond_states};
use super::case::{Invalid, Stage, StageKind};
use super::parted::has_parted;

impl Simulation {
    /// Finds the flow in the joints as they are at the start of a stage, if water flows in them: the steady one, or
    /// that at the end of the time which the stage gives it.
    ///
    /// # Errors
    /// No flow has been found.
    pub(super) fn find_flow(&mut self, stage: usize, start: f64) -> Result<(), Invalid> {
        let (model, state) = (&self.built.model, &self.state);
        let Some(net) = &model.flow else { return Ok(()) };
        let seen = Seen { model, state, net, stage, start, way: None };
        let found = match (self.case.stages[stage].flow_time(), &state.seepage) {
            (Some(time), Some(before)) => seen.over(time, before),
            _ => seen.steady(seen.opened(), None),
        };
        self.state.seepage = Some(found.map_err(|failure| told(net, &self.case.stages[stage].name, &failure))?);
        Ok(())
    }

    /// Finds the flow again before an internal step where it is due: before the first step of a static stage, whose
    /// inputs a host may have set, and on the grid of a dynamic stage that follows them. The steady one is found if
    /// something around the net has changed; one that goes on in time does so up to the next such step, with what is
    /// around it now. The apertures are those of the start of the last static stage, but the greatest one where faces
    /// have parted.
    ///
    /// # Errors
    /// No flow has been found.
    pub(super) fn follow_flow(&mut self) -> Result<(), StepError> {
        let (model, state) = (&self.built.model, &self.state);
        let (Some(net), Some(seepage)) = (&model.flow, &state.seepage) else { return Ok(()) };
        let stage = &self.case.stages[state.stage as usize];
        let is_due = match stage.flow_steps() {
            Some(every) => state.stage_step.is_multiple_of(every),
            None if stage.flow_time().is_some() => false,
            None => state.stage_step == 0 && (stage.kind == StageKind::Static || state.stage == 0),
        };
        if !is_due || state.part != 0.0 {
            return Ok(());
        }
        let seen = Seen { model, state, net, stage: state.stage as usize, start: self.time(), way: None };
        let steps = stage.flow_steps().filter(|_| stage.is_transient());
        let span = steps.map(|every| every as f64 * model.dt * self.case.pace());
        let found = seen.again(seepage, stage.flow_steps().is_some(), span).map_err(|failure| seen.failed(failure))?;
        found.into_iter().for_each(|found| self.state.seepage = Some(found));
        Ok(())
    }

    /// Lets water flow for a time (s) of a dynamic stage, if its flow is not one that goes on in steps of its own.
    pub(super) fn pass_water(&mut self, dt: f64) {
        let passes = matches!(self.regime, Regime::Dynamic { .. }) && !self.stage().is_transient();
        self.state.seepage.iter_mut().filter(|_| passes).for_each(|seepage| seepage.pass(dt));
    }

    /// Whether what hosts set of heads, rain and drains has an effect now or in a later stage.
    pub fn follows_flow(&self) -> bool {
        let (now, begun) = (self.state.stage as usize, self.state.stage_step > 0);
        let finds = |stage: &Stage| stage.flow_steps().is_some() || stage.kind == StageKind::Static;
        let (own, later) = (&self.case.stages[now], &self.case.stages[now + 1..]);
        own.flow_steps().is_some() || !begun && (finds(own) || now == 0) || later.iter().any(finds)
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
        let acting = &seepage.surroundings.drains;
        let active = net.drains.iter().enumerate().filter(|(k, _)| acting[*k]);
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
        Some(Seen { model, state, net, stage, start, way: None }.survey())
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
#[derive(Clone, Copy)]
pub(super) struct Seen<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub net: &'a FlowNet,
    pub stage: usize,
    pub start: f64,
    /// The flow of before, and the share of the way from its levels, heads and rain to those of the stage; none at
    /// those of the stage.
    pub way: Option<(&'a Seepage, f64)>,
}

impl Seen<'_> {
    /// Steady flow through pieces with apertures (m) at their nodes, from unknowns (m) of before or from a full net.
    pub fn steady(&self, apertures: Vec<[f64; 2]>, start: Option<&[f64]>) -> Result<Seepage, Failure> {
        let conductance = self.conductance(&apertures);
        let flooded = self.flooded();
        let conditions = self.conditions(&flooded, &conductance);
        let at_nodes: Vec<_> = conditions.iter().map(|condition| condition.0).collect();
        let net = &self.net.net;
        let full = || net.steady(&conductance, &at_nodes);
        let flow = start.map_or_else(full, |u| net.steady_from(&conductance, &at_nodes, u).or_else(|_| full()))?;
        let (stage, residual) = (self.stage as u32, flow.residual);
        let (sums, seeps) = (self.net.sums(&conditions, &flow), self.net.seeps(&conditions, &flow));
        let before = self.state.seepage.as_ref();
        let earlier = before.iter().flat_map(|seepage| &seepage.balances).filter(|balance| balance.stage != stage);
        let own = FlowBalance { stage, sums, residual, seeps, water: None, rounds: None };
        Ok(Seepage {
            unknowns: flow.u,
            conducts: conductance.iter().map(|g| *g > 0.0).collect(),
            apertures,
            flooded,
            surroundings: self.surroundings(),
            balances: earlier.cloned().chain([own]).collect(),
            passed: before.map_or([0.0; 2], |seepage| seepage.passed),
            stored: before.map_or(0.0, |seepage| seepage.stored),
            time: before.map_or(0.0, |seepage| seepage.time),
            rounds: Vec::new(),
        })
    }

    /// Flow that follows one of before: that which has gone on for a span of time (s), or the steady one; none if that
    /// of before still is. In a stage that `follows` flow the steady one is looked for from unknowns of before, and
    /// pieces that have parted since are as wide as they can be. What hosts set before the first step of all belongs to
    /// the flow at its start.
    fn again(&self, before: &Seepage, follows: bool, span: Option<f64>) -> Result<Option<Seepage>, Failure> {
        let is_found = before.balances.last().is_some_and(|balance| balance.stage == self.state.stage);
        let steady = || {
            let start = follows.then_some(&before.unknowns[..]);
            let apertures = if follows { self.kept(before) } else { before.apertures.clone() };
            self.steady(apertures, start).map(Some)
        };
        let has_widened = || follows && self.newly_parted(before).next().is_some();
        let is_new = !is_found || !self.are_as(&before.surroundings) || has_widened();
        let is_first = self.state.stage == 0 && self.state.stage_step == 0;
        let Some(span) = span else { return if is_new { steady() } else { Ok(None) } };
        let start = if is_first && is_new { steady()? } else { None };
        self.further(span, start.as_ref().unwrap_or(before)).map(Some)
    }

    /// Pieces whose faces have parted in a dynamic stage, and which have not the greatest aperture yet.
    fn newly_parted(&self, before: &Seepage) -> impl Iterator<Item = usize> {
        let widest = self.net.range[1];
        let pieces = self.net.pieces.iter().zip(&before.apertures).enumerate();
        let narrower = pieces.filter(move |(_, (_, own))| own[0] > 0.0 && **own != [widest; 2]);
        narrower.filter(|(_, (piece, _))| has_parted(self.model, self.state, piece)).map(|(k, _)| k)
    }

    /// Apertures (m) of before as a dynamic stage keeps them: the greatest one where faces have parted.
    pub fn kept(&self, before: &Seepage) -> Vec<[f64; 2]> {
        let mut apertures = before.apertures.clone();
        self.newly_parted(before).for_each(|k| apertures[k] = [self.net.range[1]; 2]);
        apertures
    }

    /// Unit weight of the water (N/m³).
    pub fn weight(&self) -> f64 {
        let drive = &self.state.drive;
        self.state.water_density * drive.gravity(drive.share(self.start)).norm()
    }

    /// Level of the reservoir (m).
    fn level(&self) -> f64 {
        self.state.drive.water_level(self.state.drive.share(self.start))
    }

    /// A value of the stage, or one on the way to it from that of before.
    fn on_way(&self, to: f64, from: impl Fn(&Seepage) -> f64) -> f64 {
        match self.way {
            Some((before, share)) if share < 1.0 => {
                let from = from(before);
                from + (to - from) * share
            }
            _ => to,
        }
    }

    fn heads(&self) -> impl Iterator<Item = f64> {
        let (drive, share) = (&self.state.drive, self.state.drive.share(self.start));
        let on_way = |head: usize, to: f64| self.on_way(to, |before| before.surroundings.heads[head]);
        (0..self.net.heads.len()).map(move |head| on_way(head, drive.head(head, share)))
    }

    fn rains(&self) -> impl Iterator<Item = f64> {
        let (drive, share) = (&self.state.drive, self.state.drive.share(self.start));
        let on_way = |rain: usize, to: f64| self.on_way(to, |before| before.surroundings.rains[rain]);
        (0..self.net.rains.len()).map(move |rain| on_way(rain, drive.rain(rain, share)))
    }

    pub fn surroundings(&self) -> Surroundings {
        let (heads, rains) = (self.heads().collect(), self.rains().collect());
        let drains = self.state.drive.to.drain.clone();
        Surroundings { level: self.level(), weight: self.weight(), heads, rains, drains }
    }

    /// Whether the surroundings are still these; looks without allocating.
    fn are_as(&self, Surroundings { level, weight, heads, rains, drains }: &Surroundings) -> bool {
        (self.level(), self.weight()) == (*level, *weight)
            && self.heads().eq(heads.iter().copied())
            && self.rains().eq(rains.iter().copied())
            && self.state.drive.to.drain == *drains
    }

    /// A flow that has not been found, with its place.
    pub fn failed(&self, failure: Failure) -> StepError {
        let node = match failure {
            Failure::Unsolved(Unsolved { node, .. }) | Failure::Refused(Refused::Value { index: node, .. }) => node,
            Failure::Refused(_) => 0,
        };
        let piece = self.net.pieces.iter().find(|piece| piece.nodes.contains(&(node as u32)));
        let block = piece.map_or(0, |piece| self.model.labels[self.block(piece.edges[0])]);
        let position = self.net.places.get(node).copied().unwrap_or_default();
        StepError { block, position, time: self.start, failure: step::Failure::Flow(failure) }
    }

    fn survey(&self) -> FlowSurvey {
        let conductance = self.conductance(&self.opened());
        let conditions = self.conditions(&self.flooded(), &conductance);
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

    /// Conductance (m²/s per m of head) of each piece with apertures (m) at its nodes; 0 where blocks are gone.
    pub fn conductance(&self, apertures: &[[f64; 2]]) -> Vec<f64> {
        let weight = self.weight();
        let of_piece = |(piece, own): (&FlowPiece, &[f64; 2])| match own[0] > 0.0 && self.is_there(piece) {
            true => self.net.conductance(piece, *own, weight),
            false => 0.0,
        };
        self.net.pieces.iter().zip(apertures).map(of_piece).collect()
    }

    /// Apertures (m) at the nodes of each piece now; 0 where blocks are gone, bonds hold or the law is closed.
    pub fn opened(&self) -> Vec<[f64; 2]> {
        let bonds = bond_states(self.model, self.state);
        let conducts = |piece: &FlowPiece| {
            let holds = piece.edges.iter().any(|edge| bonds[edge.index()] == BondState::Holds);
            !holds && self.is_there(piece) && self.net.apertures[self.state.law_switch[piece.law].index()] > 0.0
        };
        let of_piece = |piece: &FlowPiece| if conducts(piece) { self.apertures(piece) } else { [0.0; 2] };
        self.net.pieces.iter().map(of_piece).collect()
    }

    /// Whether both blocks of a piece are there.
    pub fn is_there(&self, piece: &FlowPiece) -> bool {
        piece.edges.iter().all(|&edge| !self.is_gone(edge))
    }

    /// Condition at each node, and which inlet it is.
    pub fn conditions(&self, flooded: &[bool], conductance: &[f64]) -> Vec<(Condition, Option<Inlet>)> {
        let (dug, depths) = (self.dug(flooded), self.net.places.iter().map(|&p| self.depth(p)).collect::<Vec<_>>());
        let conducts = self.net.conducting(conductance);
        let (heads, rains): (Vec<f64>, Vec<f64>) = (self.heads().collect(), self.rains().collect());
        self.net.conditions(Outside {
            heads: &heads,
            rains: &rains,
            drains: &self.state.drive.to.drain,
            dug: &dug,
            depths: &depths,
            conducts: &conducts,
        })
    }

    fn block(&self, edge: EdgeId) -> BlockId {
        self.model.boundary.block[edge]
    }

    fn is_gone(&self, edge: EdgeId) -> bool {
        self.state.removed[self.block(edge)]
    }

    /// Apertures (m) at both ends of a piece, by what it has opened since the start.
    pub fn apertures(&self, piece: &FlowPiece) -> [f64; 2] {
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

    /// Depth (m) of a position below the surface of the reservoir; negative where there is none.
    fn depth(&self, at: Point) -> f64 {
        let Some(water) = &self.model.water else { return -1.0 };
        let of_stage = |before: &Seepage| before.balances.last().map_or(0, |balance| balance.stage as usize);
        let was = |before: &Seepage| water.surfaces[of_stage(before)].depth(before.surroundings.level, at);
        self.on_way(water.surfaces[self.stage].depth(self.level(), at), was)
    }

    /// Blocks that have been dug out and filled by the reservoir: those with a face in it, and those beside them.
    pub fn flooded(&self) -> Vec<bool> {
        let (boundary, removed) = (&self.model.boundary, &self.state.removed);
        let mut flooded = vec![false; removed.len()];
        let deep = |edge: EdgeId| [edge, boundary.after(edge)].iter().any(|&k| self.depth(boundary.reference[k]) > 0.0);
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
