//! Whether a state that comes from outside can be one of this model: lengths, indices and numbers. What passes makes no
//! index go astray and no square of a number overflow; the error names the first value that does not fit.

use enmm_case::keys::Plain;
use std::fmt::Display;
use std::sync::Arc;

use enmm_seepage::DELTA;

use crate::contact::{
    BoltState, BondHistory, ContactHistory, FoundContact, FoundContacts, JointLaw, Meeting, NeighbourList, Release,
    Roughness, Unloaded,
};
use crate::geometry::{Point, Vector};
use crate::mechanics::Resultants;
use crate::state::{
    Counters, Course, Drive, Event, EventKind, Events, FlowBalance, FrictionDelay, Inputs, Ledger, Model, MostRest,
    Round, Rounds, Seepage, StageWater, State, Surroundings, WorstSection,
};

use crate::flow::DEPTH;
use crate::step::has_bonds;

use super::openings::ROUNDS_MAX;

use super::Simulation;
use super::assemble::Built;
use super::case::StageKind;
use super::case::limits::{FACTOR_MAX, RAIN_MAX};

/// Value of a state that the model cannot have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} is {value}, must be {limit}")]
pub struct Unfit {
    /// Where.
    pub what: String,
    /// Value found.
    pub value: String,
    /// Values that are allowed.
    pub limit: String,
}

/// Outcome of a check.
pub type Fit = Result<(), Unfit>;

/// Greatest magnitude of positions and lengths (m).
pub const LENGTH: f64 = 1e12;
/// Greatest magnitude of times (s).
pub const TIME: f64 = 1e12;
/// Greatest magnitude of velocities (m/s), accelerations (m/s²) and numbers without a unit.
pub const RATE: f64 = 1e30;
/// Greatest magnitude of forces, stresses, stiffnesses and energies (SI units).
pub const FORCE: f64 = 1e60;
/// Greatest count, beyond which a double no longer counts.
const COUNT: u64 = 1 << 53;

/// Checks a number by its magnitude.
///
/// # Errors
/// It is not finite or greater.
pub fn number(what: impl Display, value: f64, most: f64) -> Fit {
    if value.is_finite() && value.abs() <= most {
        return Ok(());
    }
    unfit(what, Plain(value), format!("a finite number of at most {most:e} in magnitude"))
}

/// Checks a number that lies between two others.
///
/// # Errors
/// It is not a number, or outside.
pub fn between(what: impl Display, value: f64, low: f64, high: f64) -> Fit {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        unfit(what, Plain(value), format!("at least {low:e} and at most {high:e}"))
    }
}

/// Checks a count of steps and the like.
///
/// # Errors
/// It is greater than `most`.
pub fn at_most(what: impl Display, value: u64, most: u64) -> Fit {
    if value <= most { Ok(()) } else { unfit(what, value, format!("at most {most}")) }
}

/// Checks the length of a list.
///
/// # Errors
/// It is another.
pub fn length(what: impl Display, found: usize, own: usize) -> Fit {
    if found == own { Ok(()) } else { unfit(format!("the length of {what}"), found, format!("{own} in this model")) }
}

fn unfit(what: impl Display, value: impl Display, limit: String) -> Fit {
    Err(Unfit { what: what.to_string(), value: value.to_string(), limit })
}

fn index(what: impl Display, value: u32, count: usize) -> Fit {
    if (value as usize) < count { Ok(()) } else { unfit(what, value, format!("less than {count} in this model")) }
}

fn numbers(what: &str, list: &[f64], most: f64) -> Fit {
    list.iter().enumerate().try_for_each(|(k, value)| number(format_args!("{what}[{k}]"), *value, most))
}

fn vector(what: impl Display, value: Vector, most: f64) -> Fit {
    number(format_args!("{what}.x"), value.x, most)?;
    number(format_args!("{what}.y"), value.y, most)
}

fn vectors(what: &str, list: &[Vector], most: f64) -> Fit {
    list.iter().enumerate().try_for_each(|(k, value)| vector(format_args!("{what}[{k}]"), *value, most))
}

/// Checks a list that follows from the case.
fn same<T: PartialEq>(what: &str, found: &[T], own: &[T]) -> Fit {
    length(what, found.len(), own.len())?;
    let other = found.iter().zip(own).position(|(found, own)| found != own);
    other.map_or(Ok(()), |k| unfit(format!("{what}[{k}]"), "another", "what the case says of this stage".to_owned()))
}

fn in_order(what: &str, order: &str, is_sorted: bool) -> Fit {
    if is_sorted { Ok(()) } else { unfit(format!("the order of {what}"), "broken", order.to_owned()) }
}

impl Simulation {
    /// Whether a state can be one of this model.
    ///
    /// # Errors
    /// The first length, index or number that cannot.
    pub fn check(&self, state: &State) -> Fit {
        // By name, so that a new field does not compile before it has a check.
        let State {
            stage: _,
            stage_start: _,
            stage_starts: _,
            most_rest: _,
            stage_step: _,
            step: _,
            part: _,
            dt_last: _,
            static_stretch: _,
            displacement: _,
            velocity: _,
            since: _,
            stage_displacement: _,
            stage_force: _,
            acceleration: _,
            plastic: _,
            columns: _,
            contacts,
            bonds,
            sections,
            found,
            friction_delay,
            neighbours,
            support_force: _,
            support_rest: _,
            worst_sections: _,
            cuts: _,
            fix_active: _,
            removed: _,
            laws,
            law_switch: _,
            damping: _,
            water_density: _,
            seepage: _,
            bolts: _,
            drive,
            events,
            ledger,
            counters,
        } = state;
        self.check_clock(state)?;
        let built = self.check_breaking(state)?;
        let model = &built.model;
        self.check_motion(model, state)?;
        check_contacts(model, contacts)?;
        check_bonds(model, (bonds, has_bonds(model, state).then_some(contacts.len())), laws, sections)?;
        if let Some(FrictionDelay { time, hop }) = *friction_delay {
            between("friction_delay.time", time, 0.0, TIME)?;
            between("friction_delay.hop", hop, 0.0, LENGTH)?;
        }
        check_neighbours(model, neighbours)?;
        check_found(model, found, contacts, neighbours)?;
        self.check_stages(model, state)?;
        check_drive(model, drive)?;
        check_events(model, events)?;
        check_ledger(ledger).and_then(|()| check_counters(counters))
    }

    /// Checks sections that have broken, builds the model with them, and checks its worst sections.
    fn check_breaking(&self, state: &State) -> Result<Arc<Built>, Unfit> {
        let State { stage, cuts, .. } = state;
        if let Some(breaking) = &self.model().breaking {
            at_most("the number of cuts", cuts.len() as u64, breaking.cuts_max.min(breaking.parts_max) as u64)?;
        } else {
            length("cuts", cuts.len(), 0)?;
        }
        for (k, cut) in cuts.iter().enumerate() {
            index(format_args!("cuts[{k}].rock"), cut.rock.into(), self.case().rocks.len())?;
            if self.case().rocks.values().nth(cut.rock.into()).is_none_or(|rock| rock.fracture.is_none()) {
                unfit(format!("cuts[{k}].rock"), cut.rock, "a rock that breaks".to_owned())?;
            }
            at_most(format_args!("cuts[{k}].stage"), cut.stage.into(), (*stage).into())?;
            at_most(format_args!("cuts[{k}].step"), cut.step, COUNT)?;
            between(format_args!("cuts[{k}].time"), cut.time, 0.0, TIME)?;
            check_section(&format!("cuts[{k}]"), cut.share, (cut.ends, &cut.carried))?;
        }
        in_order("cuts", "by step", cuts.is_sorted_by_key(|cut| (cut.stage, cut.step)))?;
        let ground = self.ground(*stage as usize, cuts).map_err(|error| Unfit {
            what: "the model with its cuts".to_owned(),
            value: error.to_string(),
            limit: "one that can be built".to_owned(),
        })?;
        check_worst(&ground.built.model, &state.worst_sections)?;
        Ok(ground.built)
    }

    fn check_clock(&self, state: &State) -> Fit {
        let dt = self.model().dt;
        index("stage", state.stage, self.case().stages.len())?;
        length("stage_starts", state.stage_starts.len(), state.stage as usize + 1)?;
        for (k, &start) in state.stage_starts.iter().enumerate() {
            between(format_args!("stage_starts[{k}]"), start, 0.0, TIME)?;
        }
        between("stage_start", state.stage_start, 0.0, TIME)?;
        if let Some(MostRest { since, kinetic }) = state.most_rest {
            between("most_rest.since", since, 0.0, TIME)?;
            kinetic.into_iter().try_for_each(|sum| between("most_rest.kinetic", sum, 0.0, FORCE))?;
        }
        at_most("step", state.step, COUNT)?;
        at_most("stage_step", state.stage_step, state.step)?;
        if state.part >= dt {
            unfit("part", state.part, format!("less than the internal step, {dt:e} s"))?;
        }
        between("part", state.part, 0.0, dt)?;
        between("dt_last", state.dt_last, 0.0, (1.0 + 1e-9) * dt)?;
        between("static_stretch", state.static_stretch, 0.0, RATE)
    }

    fn check_motion(&self, model: &Model, state: &State) -> Fit {
        let covers = model.covers.cover_count();
        let is_static = self.case().stages[state.stage as usize].kind == StageKind::Static;
        let of_static = if is_static { covers } else { 0 };
        let is_since = self.case().since_stage().is_some_and(|since| since <= state.stage as usize);
        let of_since = if is_since { covers } else { 0 };
        let of_implicit = if state.acceleration.is_empty() { 0 } else { covers };
        for (what, list, own, most) in [
            ("displacement", &state.displacement, covers, LENGTH),
            ("velocity", &state.velocity, covers, RATE),
            ("since", &state.since, of_since, LENGTH),
            ("stage_displacement", &state.stage_displacement, of_static, LENGTH),
            ("stage_force", &state.stage_force, of_static, FORCE),
            ("acceleration", &state.acceleration, of_implicit, RATE),
        ] {
            length(what, list.len(), own)?;
            vectors(what, list, most)?;
        }
        let of_yielding = if model.strengths.iter().any(Option::is_some) { model.covers.element_count() } else { 0 };
        length("plastic", state.plastic.len(), of_yielding)?;
        numbers("plastic", state.plastic.as_flattened(), RATE)?;
        length("columns", state.columns.len(), model.columns.len())?;
        for (k, (column, own)) in state.columns.iter().zip(&model.columns).enumerate() {
            let names = ["displacement", "velocity"].map(|field| format!("columns[{k}].{field}"));
            for (what, list, most) in [(&names[0], &column.displacement, LENGTH), (&names[1], &column.velocity, RATE)] {
                length(what, list.len(), own.node_count())?;
                vectors(what, list, most)?;
            }
        }
        Ok(())
    }

    /// Checks what stages change: supports, fixities, blocks that are gone, laws and bolts.
    fn check_stages(&self, model: &Model, state: &State) -> Fit {
        length("support_force", state.support_force.len(), model.supports.len())?;
        length("support_rest", state.support_rest.len(), model.supports.len())?;
        length("fix_active", state.fix_active.len(), model.fixities.len())?;
        length("removed", state.removed.len(), model.covers.block_count())?;
        length("bolts", state.bolts.len(), model.bolts.len())?;
        numbers("support_force", &state.support_force, FORCE)?;
        numbers("support_rest", &state.support_rest, LENGTH)?;
        let (laws, switch) = self.laws_in(state.stage);
        check_laws(&state.laws, laws)?;
        if let Some(damping) = state.damping {
            between("damping", damping, 0.0, 1.0)?;
        }
        between("water_density", state.water_density, 0.0, RATE)?;
        check_seepage(model, state.seepage.as_ref(), state.stage)?;
        same("law_switch", &state.law_switch, &switch)?;
        for (k, bolt) in state.bolts.iter().enumerate() {
            let BoltState { active: _, broken: _, rest, natural, force, slip: [a, b], slid: [c, d] } = *bolt;
            number(format_args!("bolts[{k}].rest"), rest, LENGTH)?;
            number(format_args!("bolts[{k}].natural"), natural, LENGTH)?;
            number(format_args!("bolts[{k}].force"), force, FORCE)?;
            for slip in [a, b, c, d] {
                number(format_args!("bolts[{k}].slip"), slip, LENGTH)?;
            }
        }
        Ok(())
    }
}

fn check_worst(model: &Model, sections: &[WorstSection]) -> Fit {
    length("worst_sections", sections.len(), model.breaking.as_ref().map_or(0, |_| model.covers.block_count()))?;
    let check = |(k, of): (usize, &WorstSection)| {
        check_section(&format!("worst_sections[{k}]"), of.share, (of.ends, &of.carries))
    };
    sections.iter().enumerate().try_for_each(check)
}

fn check_section(what: &str, share: f64, (ends, carries): ([Point; 2], &Resultants)) -> Fit {
    number(format_args!("{what}.share"), share, FORCE)?;
    ends.into_iter().try_for_each(|end| vector(format_args!("{what}.ends"), end, LENGTH))?;
    let Resultants { normal, shear, moment } = *carries;
    let of = [("normal", normal), ("shear", shear), ("moment", moment)];
    of.into_iter().try_for_each(|(field, value)| number(format_args!("{what}.{field}"), value, FORCE))
}

fn check_seepage(model: &Model, seepage: Option<&Seepage>, stage: u32) -> Fit {
    let (net, seepage) = match (&model.flow, seepage) {
        (Some(net), Some(seepage)) => (net, seepage),
        (None, None) => return Ok(()),
        (None, Some(_)) => return unfit("seepage", "given", "none in this model".to_owned()),
        (Some(_), None) => return unfit("seepage", "missing", "that of this model".to_owned()),
    };
    let Seepage { unknowns, conducts, apertures, flooded, surroundings, balances, passed, stored, time, rounds } =
        seepage;
    let Surroundings { level, weight, heads, rains, drains } = surroundings;
    check_sources(model, "seepage.surroundings", (heads, rains, drains))?;
    number("seepage.surroundings.level", *level, LENGTH)?;
    between("seepage.surroundings.weight", *weight, 0.0, FORCE)?;
    passed.iter().try_for_each(|volume| between("seepage.passed", *volume, 0.0, FORCE))?;
    number("seepage.stored", *stored, FORCE)?;
    length("seepage.apertures", apertures.len(), net.pieces.len())?;
    let within = |aperture: f64| aperture == 0.0 || (net.range[0]..=net.range[1]).contains(&aperture);
    for (k, own) in apertures.iter().enumerate() {
        if !own.iter().all(|aperture| within(*aperture)) || (own[0] > 0.0) != (own[1] > 0.0) {
            let limit = format!("two of 0 or two within {:?} m", net.range);
            return unfit(format!("seepage.apertures[{k}]"), format!("{own:?}"), limit);
        }
    }
    length("seepage.unknowns", unknowns.len(), net.places.len())?;
    length("seepage.conducts", conducts.len(), net.pieces.len())?;
    length("seepage.flooded", flooded.len(), model.covers.block_count())?;
    for (k, unknown) in unknowns.iter().enumerate() {
        between(format_args!("seepage.unknowns[{k}]"), *unknown, -DELTA, LENGTH)?;
    }
    between("seepage.time", *time, 0.0, f64::MAX)?;
    check_rounds(rounds, apertures)?;
    in_order("seepage.balances", "by stage", balances.is_sorted_by(|a, b| a.stage < b.stage))?;
    for (k, FlowBalance { stage: of, sums, residual, seeps, water, rounds }) in balances.iter().enumerate() {
        at_most(format_args!("seepage.balances[{k}].stage"), (*of).into(), stage.into())?;
        length("seepage.balances.sums", sums.len(), net.inlet_count())?;
        numbers("seepage.balances.sums", sums.as_flattened(), RATE)?;
        number("seepage.balances.residual", *residual, RATE)?;
        seeps.map_or(Ok(()), |height| number("seepage.balances.seeps", height, LENGTH))?;
        if let Some(Rounds { count, asked, piece, is_over: _, agree: _ }) = rounds {
            at_most("seepage.balances.rounds.count", (*count).into(), ROUNDS_MAX.into())?;
            at_most("seepage.balances.rounds.piece", (*piece).into(), net.pieces.len() as u64 - 1)?;
            between("seepage.balances.rounds.asked", *asked, 0.0, LENGTH)?;
        }
        check_stage_water(water.as_ref(), net.inlet_count())?;
    }
    Ok(())
}

/// Checks the rounds of a stage whose apertures follow openings.
fn check_rounds(rounds: &[Round], apertures: &[[f64; 2]]) -> Fit {
    at_most("the number of seepage.rounds", rounds.len() as u64, DEPTH as u64 + 1)?;
    for Round { logs, asked } in rounds {
        for (what, list) in [("seepage.rounds.logs", logs), ("seepage.rounds.asked", asked)] {
            length(what, list.len(), apertures.len())?;
            list.as_flattened().iter().try_for_each(|value| between(what, *value, -100.0, 100.0))?;
        }
    }
    Ok(())
}

fn check_stage_water(water: Option<&StageWater>, inlets: usize) -> Fit {
    let Some(StageWater { time, sums, stored, drains }) = water else { return Ok(()) };
    between("seepage.balances.water.time", *time, 0.0, f64::MAX)?;
    length("seepage.balances.water.sums", sums.len(), inlets)?;
    numbers("seepage.balances.water.sums", sums.as_flattened(), f64::MAX)?;
    number("seepage.balances.water.stored", *stored, f64::MAX)?;
    number("seepage.balances.water.drains", *drains, RATE)
}

fn check_drive(model: &Model, drive: &Drive) -> Fit {
    let Drive { from, to, since, until, before: Course { end, rate }, moved } = drive;
    check_inputs(model, "drive.from", from)?;
    check_inputs(model, "drive.to", to)?;
    number("drive.since", *since, TIME)?;
    number("drive.until", *until, TIME)?;
    number("drive.before.end", *end, TIME)?;
    for (what, list) in [("drive.before.rate", rate), ("drive.moved", moved)] {
        length(what, list.len(), model.ports.len())?;
        vectors(what, list, RATE)?;
    }
    Ok(())
}

fn check_contacts(model: &Model, contacts: &[ContactHistory]) -> Fit {
    let boundary = &model.boundary;
    for (k, contact) in contacts.iter().enumerate() {
        let &ContactHistory {
            node,
            side,
            edge,
            meeting: Meeting { age, kept_stiffness },
            normal_force,
            shear_force,
            filtered_normal,
            trend,
            sheared,
            unloaded: Unloaded { offset, rest },
            slip,
            way,
            share,
            state: _,
            intact: _,
        } = contact;
        index(format_args!("contacts[{k}].node"), node.number(), boundary.node_count())?;
        index(format_args!("contacts[{k}].side"), side.number(), boundary.sides.ends.len())?;
        index(format_args!("contacts[{k}].edge"), edge.number(), boundary.len())?;
        between(format_args!("contacts[{k}].age"), age.into(), 0.0, f64::INFINITY)?;
        between(format_args!("contacts[{k}].kept_stiffness"), kept_stiffness.into(), 0.0, FORCE)?;
        for (field, value, most) in [
            ("normal_force", normal_force, FORCE),
            ("shear_force", shear_force, FORCE),
            ("filtered_normal", filtered_normal, FORCE),
            ("trend[0]", trend[0], FORCE),
            ("trend[1]", trend[1], FORCE),
            ("sheared", sheared, LENGTH),
            ("offset", offset, LENGTH),
            ("rest", rest, LENGTH),
            ("slip", slip, LENGTH),
            ("way", way, LENGTH),
            ("share", share, RATE),
        ] {
            number(format_args!("contacts[{k}].{field}"), value, most)?;
        }
    }
    in_order("contacts", "by node and side", contacts.is_sorted_by_key(|contact| (contact.node, contact.side)))
}

fn check_neighbours(model: &Model, neighbours: &NeighbourList) -> Fit {
    let boundary = &model.boundary;
    for (k, pair) in neighbours.pairs.iter().enumerate() {
        index(format_args!("neighbours.pairs[{k}].node"), pair.node.number(), boundary.node_count())?;
        index(format_args!("neighbours.pairs[{k}].side"), pair.side.number(), boundary.sides.ends.len())?;
        index(format_args!("neighbours.pairs[{k}].edge"), pair.edge.number(), boundary.len())?;
    }
    in_order("neighbours.pairs", "by node and side", neighbours.pairs.is_sorted())?;
    let found_at = neighbours.found_at();
    length("neighbours.found_at", found_at.len(), if found_at.is_empty() { 0 } else { boundary.node_count() })?;
    vectors("neighbours.found_at", found_at, LENGTH)
}

/// Checks contacts as they were found, which are near sides of the last search.
fn check_found(model: &Model, found: &FoundContacts, contacts: &[ContactHistory], neighbours: &NeighbourList) -> Fit {
    let nodes = model.boundary.node_count();
    if found.contacts.is_empty() {
        return Ok(());
    }
    length("found.contacts", found.contacts.len(), contacts.len())?;
    length("found.found_at", found.found_at().len(), nodes)?;
    vectors("found.found_at", found.found_at(), LENGTH)?;
    let near_sides = neighbours.pairs.chunk_by(|a, b| (a.node, a.side) == (b.node, b.side));
    let near_sides: Vec<_> = near_sides.map(|pairs| (pairs[0].node, pairs[0].side)).collect();
    for (k, (found, contact)) in found.contacts.iter().zip(contacts).enumerate() {
        let &FoundContact { near_side, length, bonded, penalty, share, keeps: _ } = found;
        if near_sides.get(near_side as usize) != Some(&(contact.node, contact.side)) {
            unfit(format_args!("found.contacts[{k}].near_side"), near_side, "that of the contact".to_owned())?;
        }
        for (field, value) in [("length", length), ("bonded", bonded), ("penalty", penalty), ("share", share)] {
            between(format_args!("found.contacts[{k}].{field}"), value, 0.0, LENGTH)?;
        }
    }
    Ok(())
}

fn check_inputs(model: &Model, of: &str, inputs: &Inputs) -> Fit {
    let (blocks, ports) = (model.covers.block_count(), model.ports.len());
    let Inputs {
        gravity,
        base_acceleration,
        water_level,
        strength_factor,
        block_force,
        block_moment,
        port_traction,
        port_pressure,
        port_velocity,
        head,
        rain,
        drain,
    } = inputs;
    check_sources(model, of, (head, rain, drain))?;
    length(format_args!("{of}.port_velocity"), port_velocity.len(), ports)?;
    vectors(&format!("{of}.port_velocity"), port_velocity, RATE)?;
    vector(format_args!("{of}.gravity"), *gravity, RATE)?;
    vector(format_args!("{of}.base_acceleration"), *base_acceleration, RATE)?;
    number(format_args!("{of}.water_level"), *water_level, LENGTH)?;
    between(format_args!("{of}.strength_factor"), *strength_factor, 0.0, FACTOR_MAX)?;
    for (field, list, own) in [("block_force", block_force, blocks), ("port_traction", port_traction, ports)] {
        length(format_args!("{of}.{field}"), list.len(), own)?;
        vectors(&format!("{of}.{field}"), list, FORCE)?;
    }
    for (field, list, own) in [("block_moment", block_moment, blocks), ("port_pressure", port_pressure, ports)] {
        length(format_args!("{of}.{field}"), list.len(), own)?;
        numbers(&format!("{of}.{field}"), list, FORCE)?;
    }
    Ok(())
}

/// Checks levels of heads, rates of rain, and how many drains there are.
fn check_sources(model: &Model, of: &str, (heads, rains, drains): (&[f64], &[f64], &[bool])) -> Fit {
    let own = model.flow.as_ref().map_or([0; 3], |net| [net.heads.len(), net.rains.len(), net.drains.len()]);
    length(format_args!("{of}.head"), heads.len(), own[0])?;
    length(format_args!("{of}.rain"), rains.len(), own[1])?;
    length(format_args!("{of}.drain"), drains.len(), own[2])?;
    numbers(&format!("{of}.head"), heads, LENGTH)?;
    rains.iter().try_for_each(|rate| between(format_args!("{of}.rain"), *rate, 0.0, RAIN_MAX))
}

fn check_events(model: &Model, events: &Events) -> Fit {
    let (blocks, traces) = (model.covers.block_count(), model.trace_law.len());
    let Events { list, touching, detached, slipped, failed, bonded, overlapped, overlap_max, port_slip } = events;
    length("events.touching", touching.len(), blocks)?;
    length("events.detached", detached.len(), blocks)?;
    length("events.slipped", slipped.len(), traces + 1)?;
    length("events.failed", failed.len(), blocks)?;
    length("events.bonded", bonded.len(), if bonded.is_empty() { 0 } else { traces })?;
    between("events.overlap_max", *overlap_max, 0.0, LENGTH)?;
    length("events.port_slip", port_slip.len(), model.ports.len())?;
    port_slip.iter().try_for_each(|slip| between("events.port_slip", *slip, 0.0, LENGTH))?;
    for (k, pair) in overlapped.iter().enumerate() {
        pair.iter().try_for_each(|b| index(format_args!("events.overlapped[{k}]"), b.number(), blocks))?;
    }
    in_order("events.overlapped", "by block", overlapped.is_sorted_by(|a, b| a < b))?;
    for (k, Event { kind, subject, time, other, depth }) in list.iter().enumerate() {
        number(format_args!("events.list[{k}].time"), *time, TIME)?;
        between(format_args!("events.list[{k}].depth"), *depth, 0.0, LENGTH)?;
        if matches!(kind, EventKind::Overlapped | EventKind::Cut) {
            index(format_args!("events.list[{k}].other"), *other, blocks)?;
        }
        match kind {
            EventKind::Slipped if *subject == u32::MAX => Ok(()),
            EventKind::Slipped | EventKind::Broken => index(format_args!("events.list[{k}].subject"), *subject, traces),
            EventKind::Detached | EventKind::Failed | EventKind::Overlapped | EventKind::Cut => {
                index(format_args!("events.list[{k}].subject"), *subject, blocks)
            }
        }?;
    }
    Ok(())
}

/// Checks joint laws, which are those of the stage but for what a host may change.
fn check_laws(found: &[JointLaw], mut own: Vec<JointLaw>) -> Fit {
    length("laws", found.len(), own.len())?;
    for (k, (found, own)) in found.iter().zip(&mut own).enumerate() {
        let JointLaw { friction, cohesion, tension, residual_friction, residual_cohesion, .. } = *found;
        for (field, value) in [
            ("friction", friction),
            ("cohesion", cohesion),
            ("tension", tension),
            ("residual_friction", residual_friction),
            ("residual_cohesion", residual_cohesion),
        ] {
            between(format_args!("laws[{k}].{field}"), value, 0.0, FORCE)?;
        }
        (own.friction, own.cohesion, own.tension) = (friction, cohesion, tension);
        (own.residual_friction, own.residual_cohesion) = (residual_friction, residual_cohesion);
        if let (Some(found), Some(own)) = (found.roughness, &mut own.roughness) {
            let Roughness { angle, jrc, jcs } = found;
            between(format_args!("laws[{k}].roughness.angle"), angle, 0.0, RATE)?;
            between(format_args!("laws[{k}].roughness.jrc"), jrc, 0.0, RATE)?;
            between(format_args!("laws[{k}].roughness.jcs"), jcs, 0.0, FORCE)?;
            *own = found;
        }
    }
    same("laws", found, &own)
}

fn check_bonds(
    model: &Model,
    (bonds, count): (&[BondHistory], Option<usize>),
    laws: &[JointLaw],
    sections: &[Option<Release>],
) -> Fit {
    length("bonds", bonds.len(), count.unwrap_or(0))?;
    length("sections", sections.len(), model.sections.list.len())?;
    for (k, &Release { carried, left }) in sections.iter().enumerate().filter_map(|(k, s)| Some((k, s.as_ref()?))) {
        between(format_args!("sections[{k}].left"), left, 0.0, 1.0)?;
        carried.iter().try_for_each(|&s| between(format_args!("sections[{k}].carried"), s, 0.0, FORCE))?;
    }
    for (k, &BondHistory { damage, lengths, law, section }) in bonds.iter().enumerate() {
        between(format_args!("bonds[{k}].damage"), damage, 0.0, 1.0)?;
        index(format_args!("bonds[{k}].law"), law.number(), laws.len())?;
        if let Some(section) = section {
            index(format_args!("bonds[{k}].section"), section.number(), sections.len())?;
        }
        lengths.iter().try_for_each(|&length| between(format_args!("bonds[{k}].lengths"), length, 0.0, LENGTH))?;
    }
    Ok(())
}

/// Checks every energy and work of a ledger.
///
/// # Errors
/// The first that is not finite or too great.
pub fn check_ledger(ledger: &Ledger) -> Fit {
    let &Ledger {
        kinetic,
        strain,
        potential,
        stored,
        friction,
        fracture,
        contact_work,
        support_work,
        damping,
        yielding,
        bolts,
        radiation,
        external_work,
        baseline,
    } = ledger;
    let works =
        [contact_work, support_work, bolts.work, radiation, external_work, damping, yielding, friction, fracture];
    let energies = [kinetic, strain, potential, stored, bolts.stored, bolts.installed, baseline];
    numbers("ledger: energies", &energies, FORCE)?;
    numbers("ledger: works", &works, FORCE)
}

fn check_counters(counters: &Counters) -> Fit {
    let &Counters {
        sweeps,
        sweeps_max: _,
        substeps,
        halved,
        unsettled,
        deep_contacts,
        deepest_contact,
        crushing,
        broken,
        penetration_max,
        dt_min,
        dt_max,
        searches,
        contacts_solved,
        factorisations,
    } = counters;
    for (field, value) in [
        ("sweeps", sweeps),
        ("substeps", substeps),
        ("halved", halved),
        ("unsettled", unsettled),
        ("deep_contacts", deep_contacts),
        ("crushing.times", crushing.times),
        ("searches", searches),
        ("contacts_solved", contacts_solved),
        ("factorisations", factorisations),
    ] {
        at_most(format_args!("counters.{field}"), value, COUNT)?;
    }
    number("counters.deepest_contact", deepest_contact, LENGTH)?;
    number("counters.crushing.energy", crushing.energy, FORCE)?;
    between("counters.broken", broken, 0.0, LENGTH)?;
    number("counters.penetration_max", penetration_max, LENGTH)?;
    number("counters.dt_min", dt_min, TIME)?;
    number("counters.dt_max", dt_max, TIME)
}
