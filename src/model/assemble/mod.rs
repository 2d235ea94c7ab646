//! From the case to the model: arrangement, covers, masses, boundary, fixities, loads.

mod bolts;
mod bonds;
mod cuts;
mod drains;
mod ends;
mod flow;
mod geometry;
mod integrators;
mod joints;
mod locator;
mod locked;
mod memory;
mod monitors;
mod ports;
mod quiet;
mod rain;
mod rock;
mod sections;
mod slips;
mod stage;
mod warnings;

use crate::contact::{
    BoltState, Boundary, DetectionRule, FoundContacts, JointLaw, LawId, Resistance, Roughness, Sections, Softening,
    Support,
};
use crate::cover::{self, BlockId, CoverId, Covers, Crumb, Outlines};
use crate::flow::FlowNet;
use crate::geometry::ends::EndDistances;
use crate::geometry::{NodingReport, Point, Vector, polygon};
use crate::mechanics::{
    Chunks, ColumnState, Elasticity, Load, LoadAction, MassMatrix, PreStress, StressField, TimeTable, critical_dt,
};
use crate::model::case::{self, Case, Invalid, LoadKind};
use crate::monitor::Monitors;
use crate::recut::keep_nodes;
use crate::state::{
    Drive, Events, Fixity, Inputs, Model, OtherIntegrator, Port, QuietBoundary, State, Water, WorstSection,
};

use joints::Joints;
use locator::Locator;

pub use cuts::Cut;
pub use ends::TraceEnd;
pub use integrators::{ExplicitAlone, Integrators};
pub use locked::locked_ends;
pub use sections::{Breaking, Bridge};
pub use stage::BuildStage;
pub use warnings::ignored_traces;

/// A model as built: what is fixed, and the report of the build. A pure function of the case and of the cuts that
/// stages have made.
#[derive(Debug, Clone)]
pub struct Built {
    /// Fixed part.
    pub model: Model,
    /// Monitors and lines.
    pub monitors: Monitors,
    /// Report of the noder.
    pub noding: NodingReport,
    /// Pieces of block boundaries inside single elements, both sides of a joint counted.
    pub boundary_pieces: usize,
    /// Joint traces after the generation of sets: points and law.
    pub traces: Vec<(Vec<Point>, LawId)>,
    /// First of these traces of each joint set, and one past the last.
    pub set_start: Vec<usize>,
    /// Ends of joints near the outline or another joint: those joined to it, and those that rock holds.
    pub ends: Vec<TraceEnd>,
    /// Distances within which they were joined and listed.
    pub end_distances: EndDistances,
    /// Rock bridges that can break, and whether each breaks as a whole.
    pub bridges: Vec<Bridge>,
    /// Blocks below the least area.
    pub crumbs: Vec<Crumb>,
    /// What the build changed in the drawing, for the user to know.
    pub notes: Vec<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Builds the model of a case as cuts leave it, and its state at the start; the boundary before the last of the cuts
/// keeps its nodes. `tell` is called with every part of the build as it begins.
///
/// # Errors
/// The first key of the case that does not fit the model: integrator, geometry, references to positions without rock,
/// memory.
pub fn build(
    case: &Case,
    (cuts, before): (&[Cut], Option<&Boundary>),
    integrators: &dyn Integrators,
    tell: &mut dyn FnMut(BuildStage),
) -> Result<(Built, State), Invalid> {
    enmm_lanes::requested().map_err(|message| Invalid { key: enmm_lanes::VARIABLE.to_owned(), message })?;
    case.validate()?;
    integrators.refusal(case).map_or(Ok(()), Err)?;
    let geometry::Plane { mesh, mut arrangement, joints, ends, distances, crumbs } =
        geometry::arrange_case(case, cuts, tell)?;
    let noding = std::mem::take(&mut arrangement.report);
    let mut warnings = warnings::of_geometry(&noding, case, &joints);
    let mut notes = [case.reader_notes.clone(), warnings::notes(&noding, (&ends, &distances), &crumbs)].concat();
    notes.extend(bonds::note(&joints));
    tell(BuildStage::Covers);
    let (covers, outlines) = cover::cut(mesh, arrangement);
    let tolerance = places_tolerance(&noding);
    tell(BuildStage::Masses);
    let (mut model, bolt_warnings) = model(case, &joints, (covers, &outlines, before, tolerance), tell)?;
    model.integrator =
        integrators.other(case, &model.covers, &model.rocks, &model.element_rock).map(OtherIntegrator::new);
    let bridges = sections::of_bridges(case, &joints, &mut model);
    tell(BuildStage::Start);
    quiet::check_columns(&model)?;
    warnings::check_stages(case, &model)?;
    let positions = Locator { covers: &model.covers, outlines: &outlines, tolerance };
    let monitors = monitors::place(case, &model, &positions, (&joints, cuts.len()))?;
    let state = initial_state(case, &model, &positions)?;
    warnings.extend(rock::overstressed(case, &model));
    warnings.extend(rock::coarse(case));
    let (note, warning) = rock::breakable(&model);
    notes.extend(note);
    warnings.extend(warning);
    warnings.extend(bolt_warnings);
    warnings.extend(bonds::warnings(case, &model, &joints));
    warnings.extend(quiet::warning(case));
    warnings.extend(flow::warnings(case, &model));
    warnings.extend(quiet::ringing(case));
    warnings.extend(warnings::of_values(case, &model, &positions));
    let (low, high) = polygon::bounds(&model.covers.polygons.points);
    warnings.extend(slips::of_values(case, low.y, high.y));
    let built = Built {
        model,
        monitors,
        noding,
        boundary_pieces: outlines.pieces.len(),
        traces: joints.traces,
        set_start: joints.set_start,
        ends,
        end_distances: distances,
        bridges,
        crumbs,
        notes,
        warnings,
    };
    Ok((built, state))
}

/// The boundary loops of a case's blocks, cut again: a model keeps them only as contact sees them.
///
/// # Errors
/// As [`build`].
pub fn outlines(case: &Case) -> Result<Outlines, Invalid> {
    let geometry::Plane { mesh, arrangement, .. } = geometry::arrange_case(case, &[], &mut |_| ())?;
    Ok(cover::cut(mesh, arrangement).1)
}

/// The fixed part of the model, and the warnings about its bolts.
fn model(
    case: &Case,
    joints: &Joints,
    (covers, outlines, before, tolerance): (Covers, &Outlines, Option<&Boundary>, f64),
    tell: &mut dyn FnMut(BuildStage),
) -> Result<(Model, Vec<String>), Invalid> {
    let positions = Locator { covers: &covers, outlines, tolerance };
    let (rocks, element_rock, averaging) = rock::of_elements(case, &positions)?;
    let (fixities, supports, fixed_supports, quiets) = held(case, &positions, &rocks, &element_rock)?;
    tell(BuildStage::Boundary);
    let boundary = Boundary::new(&covers, &keep_nodes(outlines, before, tolerance), &DetectionRule::default());
    let (bolts, bolt_warnings) = bolts::bolts(case, &positions)?;
    let OnFaces { loads, ports, water, flow } = on_faces(case, joints, &positions, &boundary, &quiets.quiets)?;
    let model = Model {
        chunks: Chunks::new(&covers, &element_rock, &pre_stresses(case, &covers), &averaging),
        averaging,
        integrator: None,
        block_frequency: block_frequencies(&covers, &rocks, &element_rock),
        pre_stress: pre_stresses(case, &covers),
        pre_stress_out: rock::pre_stresses_out(case, &covers, &element_rock),
        labels: covers.blocks().map(BlockId::number).collect(),
        strengths: case.rocks.values().map(rock::yielding).collect(),
        boundary,
        mass_matrix: MassMatrix::free(&covers, &rocks, &element_rock),
        laws: joint_laws(case, joints, &rocks)?,
        trace_law: joints.traces.iter().map(|t| t.1).collect(),
        default_law: joints.default_law,
        sections: Sections::default(),
        breaking: rock::breaking(case),
        fixities,
        supports,
        fixed_supports,
        base_motions: quiet::base_motions(case),
        quiets: quiets.quiets,
        columns: quiets.columns,
        free_field: quiets.free_field,
        bolts,
        loads,
        ports,
        water,
        flow,
        gravity: Vector::new(case.gravity.x, case.gravity.y),
        in_situ: in_situ(case),
        dt: internal_step(case, shortest_critical_dt(&covers, &rocks)),
        theta_step: step_below(case::Solver::default().dt_safety * shortest_critical_dt(&covers, &rocks), case),
        critical_dt: shortest_critical_dt(&covers, &rocks),
        theta: case.solver.contact_theta,
        mass_scaling: case.solver.mass_scaling,
        tolerance: case.solver.contact_tolerance,
        detection: DetectionRule::default(),
        friction_delay: case.solver.friction_delay,
        sweeps_max: case.solver.sweeps_max,
        penetration_limit: case.solver.penetration_limit * covers.mesh.size,
        failure_displacement: case.solver.failure_displacement.unwrap_or(covers.mesh.size),
        rocks,
        element_rock,
        covers,
    };
    bolts::check_step(case, &model).map(|()| (model, bolt_warnings))
}

/// Fixities and supports, how many of these are of fixities of the case, and the quiet boundaries.
fn held(
    case: &Case,
    positions: &Locator,
    rocks: &[Elasticity],
    element_rock: &[u16],
) -> Result<(Vec<Fixity>, Vec<Support>, u32, quiet::Quiets), Invalid> {
    let ground = quiet::Ground { case, positions, rocks, element_rock };
    let (mut fixities, mut supports) = fixities(case, positions, ground.stiffness())?;
    let of_case = supports.len() as u32;
    let quiets = ground.quiets(&mut fixities, &mut supports)?;
    Ok((fixities, supports, of_case, quiets))
}

/// Loads, ports and water on faces of the rock and between them.
struct OnFaces {
    loads: Vec<Load>,
    ports: Vec<Port>,
    water: Option<Water>,
    flow: Option<FlowNet>,
}

fn on_faces(
    case: &Case,
    joints: &Joints,
    positions: &Locator,
    boundary: &Boundary,
    quiets: &[QuietBoundary],
) -> Result<OnFaces, Invalid> {
    let faces = ports::Faces { boundary, tolerance: positions.tolerance };
    let (loads, water) = (loads(case, positions, &faces)?, ports::water(case, &faces)?);
    let ports = ports::ports(case, positions, &faces, quiets)?;
    let flow = flow::net(case, joints, &faces, water.as_ref())?;
    Ok(OnFaces { loads, ports, water, flow })
}

/// Shortest stable step (s) of all rocks.
fn shortest_critical_dt(covers: &Covers, rocks: &[Elasticity]) -> f64 {
    rocks.iter().map(|r| critical_dt(covers.mesh.size, r)).fold(f64::INFINITY, f64::min)
}

/// Distance (m) within which a position of the case counts as on the rock.
fn places_tolerance(noding: &NodingReport) -> f64 {
    2.0 * noding.tolerance
}

/// Stiffness (Pa/m) of joints or supports that are as stiff as some length (m) of the stiffest rock.
fn stiffness_over(length: f64, case: &Case, rocks: &[Elasticity]) -> f64 {
    case.solver.contact_stiffness * rocks.iter().map(Elasticity::confined_modulus).fold(0.0, f64::max) / length
}

/// Length over the mesh size of rock that is as soft as a crack: springs that take over what rock has carried store
/// energy that it had not.
const CRACK_LENGTH: f64 = 0.1;

/// Explicit steps in the default implicit one.
const IMPLICIT_STEPS: f64 = 20.0;

/// The internal step: an integer fraction of a tenth of the communication step, within the stability limit.
fn internal_step(case: &Case, critical: f64) -> f64 {
    let solver = &case.solver;
    let stable = match solver.integrator {
        case::Integrator::Explicit => solver.dt_safety * critical,
        case::Integrator::Implicit => solver.implicit_step.unwrap_or(IMPLICIT_STEPS * solver.dt_safety * critical),
    };
    step_below(stable.min(solver.dt_max.unwrap_or(f64::INFINITY)), case)
}

/// The largest integer fraction of a tenth of the communication step that is not above a limit (s).
fn step_below(limit: f64, case: &Case) -> f64 {
    let solver = &case.solver;
    let rounded = || if limit == solver.implicit_step.unwrap_or(0.0) { limit } else { two_digits_below(limit) };
    let tenth = solver.communication_step.map_or_else(rounded, |step| step / 10.0);
    tenth / (tenth / limit - 1e-9).ceil().max(1.0)
}

/// The largest number of two decimal digits that is not above `value`.
fn two_digits_below(value: f64) -> f64 {
    let power = libm::log10(value).floor() as i32 - 1;
    let digits = (value / 10f64.powi(power) + 1e-9).floor();
    if power < 0 { digits / 10f64.powi(-power) } else { digits * 10f64.powi(power) }
}

/// The laws of the case by name; a continuum, which needs none, has one without strength.
fn joint_laws(case: &Case, joints: &Joints, rocks: &[Elasticity]) -> Result<Vec<JointLaw>, Invalid> {
    let stiffness = stiffness_over(1.0, case, rocks);
    let without = case.joint_laws.is_empty().then(|| case::JointLaw::frictional(0.0));
    let laws = case.joint_laws.values().chain(&without);
    let mut laws: Vec<JointLaw> = laws.map(|law| joint_law(law, stiffness, case.solver.shear_ratio)).collect();
    bonds::of_bridges(case, joints, &mut laws)?;
    let of_cracks = stiffness_over(CRACK_LENGTH * case.mesh.size, case, rocks);
    laws.extend(rock::crack_laws(case).map(|law| {
        let law = joint_law(&law, of_cracks, case.solver.shear_ratio);
        JointLaw { softening: law.softening.or(Some(Softening::AT_ONCE)), ..law }
    }));
    Ok(laws)
}

fn joint_law(law: &case::JointLaw, stiffness: f64, shear_ratio: f64) -> JointLaw {
    let tangent = |degrees: f64| libm::tan(degrees.to_radians());
    let normal_stiffness = law.normal_stiffness.unwrap_or(stiffness);
    let opening = law.tension_energy.map_or(0.0, |energy| 2.0 * energy / law.tension);
    JointLaw {
        normal_stiffness,
        shear_stiffness: law.shear_stiffness.unwrap_or(stiffness * shear_ratio),
        penalty: [law.normal_stiffness.is_none(), law.shear_stiffness.is_none()],
        friction: tangent(law.friction_deg),
        cohesion: law.cohesion,
        tension: law.tension,
        residual_friction: tangent(law.residual_friction_deg.unwrap_or(law.friction_deg)),
        residual_cohesion: law.residual_cohesion.unwrap_or(law.cohesion),
        residual_tension: law.residual_tension,
        dilation: tangent(law.dilation_deg),
        dilation_slip: law.dilation_slip.unwrap_or(case::DILATION_SLIP),
        closure_max: law.closure_max.unwrap_or(f64::INFINITY),
        crush: law.crush.or(law.jcs).unwrap_or(f64::INFINITY),
        roughness: match law.kind {
            case::JointLawKind::MohrCoulomb => None,
            case::JointLawKind::BartonBandis => Some(Roughness {
                angle: law.friction_deg.to_radians(),
                jrc: law.jrc.unwrap_or_default(),
                jcs: law.jcs.unwrap_or_default(),
            }),
        },
        softening: law.softens().then(|| Softening { opening, shear_energy: law.shear_energy.unwrap_or_default() }),
    }
}

/// Angular frequency of each block's deformation (Eq. 11); a block smaller than an element deforms like one.
fn block_frequencies(covers: &Covers, rocks: &[Elasticity], element_rock: &[u16]) -> Vec<f64> {
    let of_block = |b: BlockId| {
        let speed =
            covers.elements_of(b).map(|e| rocks[element_rock[e] as usize].shear_wave_speed()).fold(0.0, f64::max);
        2.0 * std::f64::consts::PI * speed / covers.block_area(b).sqrt().max(covers.mesh.size)
    };
    covers.blocks().map(of_block).collect()
}

fn pre_stresses(case: &Case, covers: &Covers) -> Vec<PreStress> {
    in_situ(case).map_or_else(Vec::new, |field| covers.element_centroid.iter().map(|p| field.at(*p)).collect())
}

fn fixities(case: &Case, positions: &Locator, stiffness: f64) -> Result<(Vec<Fixity>, Vec<Support>), Invalid> {
    let (mut fixities, mut supports) = (Vec::new(), Vec::new());
    for (k, fix) in case.fixes.iter().enumerate() {
        let key = format!("fix[{k}]");
        let axes = [fix.axes != case::Axes::Y, fix.axes != case::Axes::X];
        let mut fixity = Fixity {
            name: fix.name.clone(),
            covers: Vec::new(),
            active: fix.active,
            velocity: Vector::from(fix.velocity.unwrap_or_default()),
            port: port_of(case, |port| port.fix.is_some() && port.fix == fix.name),
        };
        let mut held = Vec::new();
        if let Some(point) = fix.point {
            let stiff = fix.stiffness.unwrap_or(POINT_RATIO * stiffness * positions.covers.mesh.size);
            held.push(positions.point(&format!("{key}.point"), point)?.support(stiff));
        } else if let Some(edge) = fix.edge {
            let stiff = fix.stiffness.unwrap_or(EDGE_RATIO * stiffness);
            let stress = |p: Point| in_situ(case).map_or([0.0; 3], |field| field.at(p));
            held.extend(positions.boundary(&format!("{key}.edge"), edge)?.iter().map(|p| p.support(stiff, &stress)));
        } else if let Some(region) = fix.region {
            let covers = positions.covers_in(&format!("{key}.box"), region)?;
            fixity.covers.extend(covers.into_iter().map(|i| (i, axes)));
        } else if let Some(point) = fix.block {
            let block = positions.block(&format!("{key}.block"), point)?;
            fixity.covers.extend(CoverId::range(positions.covers.covers_of(block)).map(|i| (i, axes)));
        }
        for (axis, direction) in [Vector::x(), Vector::y()].into_iter().enumerate().filter(|(axis, _)| axes[*axis]) {
            supports.extend(held.iter().map(|h: &locator::Hold| Support {
                fix: k as u32,
                block: h.block,
                covers: h.covers,
                weights: h.weights,
                direction,
                resistance: Resistance::Spring,
                stiffness: h.stiffness,
                preload: h.preload[axis],
            }));
        }
        fixities.push(fixity);
    }
    Ok((fixities, supports))
}

/// The port of a kind.
fn port_of(case: &Case, is_own: impl Fn(&case::Port) -> bool) -> Option<u32> {
    case.ports.iter().position(is_own).map(|port| port as u32)
}

/// Stiffness of supported edges over that of contacts.
pub(super) const EDGE_RATIO: f64 = 100.0;
/// Stiffness of supported points over that of contacts of the length of a mesh size.
const POINT_RATIO: f64 = 1000.0;

pub(super) fn in_situ(case: &Case) -> Option<StressField> {
    let field = |s: &case::InSitu| StressField {
        value: [s.sxx.unwrap_or_default(), s.syy.unwrap_or_default(), s.sxy],
        gradient: s.gradient,
        y_reference: s.y_reference.unwrap_or_default(),
    };
    case.in_situ.as_ref().map(field)
}

fn loads(case: &Case, positions: &Locator, faces: &ports::Faces) -> Result<Vec<Load>, Invalid> {
    let vector = |v: Option<[f64; 2]>| Vector::from(v.unwrap_or_default());
    let mut loads = Vec::new();
    for (k, load) in case.loads.iter().enumerate() {
        let key = format!("load[{k}]");
        let point = || (format!("{key}.point"), load.point.unwrap_or_default());
        let edge = || positions.boundary(&format!("{key}.edge"), load.edge.unwrap_or_default());
        let action = match load.kind {
            LoadKind::Point => {
                let at = positions.point(&point().0, point().1)?;
                LoadAction::Forces(vec![(at.covers, at.weights, vector(load.force))])
            }
            LoadKind::Traction => LoadAction::Tractions(
                edge()?.iter().map(|p| (p.covers, p.weights, vector(load.traction) * p.length())).collect(),
            ),
            LoadKind::Pressure => LoadAction::Pressure(
                edge()?.iter().map(|p| (p.covers, p.weights)).collect(),
                load.pressure.unwrap_or_default(),
            ),
            LoadKind::Body => LoadAction::Body(vector(load.acceleration)),
            LoadKind::Joint => LoadAction::Faces(faces.loaded(&key, load)?),
            LoadKind::Block => {
                let block = positions.block(&point().0, point().1)?;
                LoadAction::Block(block, vector(load.force), load.moment.unwrap_or_default())
            }
        };
        loads.push(Load { action, table: TimeTable(load.table.clone().unwrap_or_default()) });
    }
    Ok(loads)
}

/// Velocities (m/s) of the covers at the start.
fn initial_velocity(case: &Case, model: &Model, positions: &Locator) -> Result<Vec<Vector>, Invalid> {
    let mut velocity = vec![Vector::zeros(); model.covers.cover_count()];
    for (k, start) in case.initial_velocities.iter().enumerate() {
        let blocks = match start.block {
            Some(point) => {
                let block = positions.block(&format!("initial_velocity[{k}].block"), point)?;
                block.index()..block.index() + 1
            }
            None => 0..model.covers.block_count(),
        };
        for block in BlockId::range(blocks) {
            let centre = model.covers.block_centroid(block);
            for i in model.covers.covers_of(block) {
                let arm = model.covers.star_position[i] - centre;
                velocity[i] = Vector::from(start.velocity) + Vector::new(-arm.y, arm.x) * start.angular_velocity;
            }
        }
    }
    Ok(velocity)
}

fn initial_state(case: &Case, model: &Model, positions: &Locator) -> Result<State, Invalid> {
    let covers = model.covers.cover_count();
    let velocity = initial_velocity(case, model, positions)?;
    Ok(State {
        stage: 0,
        stage_start: 0.0,
        stage_starts: Vec::new(),
        most_rest: None,
        friction_delay: None,
        stage_step: 0,
        step: 0,
        part: 0.0,
        dt_last: 0.0,
        displacement: vec![Vector::zeros(); covers],
        velocity,
        contacts: Vec::new(),
        bonds: Vec::new(),
        sections: vec![None; model.sections.list.len()],
        found: FoundContacts::default(),
        neighbours: Default::default(),
        support_force: model.supports.iter().map(|s| s.preload).collect(),
        support_rest: vec![0.0; model.supports.len()],
        worst_sections: vec![
            WorstSection::default();
            model.breaking.as_ref().map_or(0, |_| model.covers.block_count())
        ],
        cuts: Vec::new(),
        fix_active: model.fixities.iter().map(|f| f.active).collect(),
        removed: vec![false; model.covers.block_count()],
        laws: model.laws.clone(),
        law_switch: LawId::all(model.laws.len()).collect(),
        damping: None,
        water_density: model.water_density(),
        seepage: None,
        since: Vec::new(),
        stage_displacement: Vec::new(),
        stage_force: Vec::new(),
        drive: Drive::hold(Inputs::of(model)),
        bolts: vec![BoltState::default(); model.bolts.len()],
        plastic: rock::plastic(model),
        columns: model.columns.iter().map(|c| ColumnState::at_rest(c.node_count())).collect(),
        acceleration: Vec::new(),
        static_stretch: 0.0,
        events: Events::none(model.covers.block_count(), model.trace_law.len(), model.ports.len()),
        ledger: Default::default(),
        counters: Default::default(),
    })
}

/// The joint law of a name: laws have the order of the case's table.
pub fn law_of(case: &Case, name: &str) -> Option<LawId> {
    case.joint_laws.keys().position(|k| k == name).map(LawId::new)
}

/// Points of a list of pairs.
fn points(list: &[[f64; 2]]) -> Vec<Point> {
    list.iter().map(|p| Point::from(*p)).collect()
}
