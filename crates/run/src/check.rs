//! Report of `enmm check` on a model that has been built and not run.

use std::collections::BTreeMap;

use serde::Serialize;

use enmm::geometry::Point;
use enmm::model::assemble::{Breaking, Bridge, ignored_traces};
use enmm::model::case::GroundMotion;
use enmm::model::tables::Workspace;
use enmm::model::{FlowSurvey, Simulation, State};
use enmm_observe::flow_doubts;
use enmm_stability::corners::weak_corners;

use crate::drainage::{LawDrainage, SetConductivity, conductivities, drain_times};
use crate::rock_mass::{RockMass, rock_masses};
use enmm_record::changes::{CrumbRecord, TraceEndRecord};

/// Share of a full cover's mass below which a cover counts as small.
const SMALL_COVER: f64 = 1e-3;
/// Share of a lattice triangle's area below which a block counts as tiny.
const TINY_BLOCK: f64 = 1e-3;

/// Counts, areas, masses and warnings of a built model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Geometry file with the unit of its coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<String>,
    /// Number of blocks.
    pub blocks: usize,
    /// Areas of the blocks (m²), ascending.
    pub block_areas: Vec<f64>,
    /// Area of all rock (m²).
    pub total_area: f64,
    /// Number of manifold elements.
    pub elements: usize,
    /// Number of physical covers.
    pub physical_covers: usize,
    /// Number of stars that have a physical cover.
    pub stars: usize,
    /// Number of stars by their number of physical covers.
    pub stars_by_cover_count: BTreeMap<u32, usize>,
    /// Row-sum masses of the covers (kg/m), ascending.
    pub cover_masses: Vec<f64>,
    /// Number of distinct corners of the elements.
    pub vertices: usize,
    /// Number of pieces of the block boundaries, both sides of a joint counted.
    pub boundary_edges: usize,
    /// Contacts of the untouched model.
    pub initial_contacts: usize,
    /// Stability limit of the step (s).
    pub critical_dt: f64,
    /// Delay of friction in a dynamic stage that begins with the untouched model (s).
    pub friction_delay: f64,
    /// Normal stiffness (Pa/m) of joints whose law gives none, on every mesh; none where every law gives one.
    pub default_stiffness: Option<f64>,
    /// Covers with less than a thousandth of a full cover's mass, which only equal thirds keep from ruling the step.
    pub small_covers_treated: usize,
    /// Blocks with less than a thousandth of a lattice triangle's area.
    pub tiny_blocks: usize,
    /// Ends and vertices that were merged within the snap tolerance.
    pub merged_vertices: usize,
    /// Joint traces that cut no rock.
    pub ignored_joints: usize,
    /// Memory that the model needs while it runs (bytes): itself, its state twice, buffers; outputs come on top.
    pub memory_bytes: u64,
    /// That memory by part; the state counts once.
    pub memory: Vec<MemoryPart>,
    /// Distance (m) within which ends of joints were joined to a line, `domain.extend_ends`, and that within which they
    /// are listed, `domain.near_ends`.
    pub extend_ends: f64,
    /// See `extend_ends`.
    pub near_ends: f64,
    /// Ends of joints near the outline or another joint.
    pub trace_ends: Vec<TraceEndRecord>,
    /// Blocks below the least area.
    pub crumbs: Vec<CrumbRecord>,
    /// Rock that yields by Hoek–Brown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rock_masses: Vec<RockMass>,
    /// Ground motions, with where they come from and when they act.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<GroundMotion>,
    /// Rock bridges that can break.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bridges: Vec<BridgeRecord>,
    /// Joints in which water flows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowSurvey>,
    /// Conductivity along the joints of each set in which water flows.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub conductivities: Vec<SetConductivity>,
    /// Time in which joints of each law drain.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drain_times: Vec<LawDrainage>,
    /// What the build has changed in the drawing.
    pub notes: Vec<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Looks at a built model; `warnings` are those of reading its case.
pub fn check(simulation: &Simulation, warnings: &[String]) -> Check {
    let (model, built) = (simulation.model(), simulation.built());
    let covers = &model.covers;
    let block_areas = sorted(covers.blocks().map(|b| covers.block_area(b)).collect());
    let mut stars_by_cover_count = BTreeMap::new();
    for (_, count) in covers.covers_by_star() {
        *stars_by_cover_count.entry(count).or_default() += 1;
    }
    let (state, workspace) = simulation.look_ahead();
    let triangle = 0.75f64.sqrt() / 2.0 * covers.mesh.size.powi(2);
    Check {
        drawing: simulation.case().drawing_unit.clone(),
        blocks: covers.block_count(),
        total_area: covers.element_area.iter().sum(),
        elements: covers.element_count(),
        physical_covers: covers.cover_count(),
        stars: stars_by_cover_count.values().sum(),
        stars_by_cover_count,
        cover_masses: sorted(model.mass_matrix.row_sum.to_vec()),
        vertices: distinct(&covers.polygons.points),
        boundary_edges: built.boundary_pieces,
        initial_contacts: workspace.contacts.len(),
        critical_dt: model.critical_dt,
        friction_delay: simulation.friction_delay(&workspace),
        default_stiffness: default_stiffness(simulation),
        small_covers_treated: small_covers(simulation, 2.0 * triangle),
        tiny_blocks: block_areas.iter().filter(|area| **area < TINY_BLOCK * triangle).count(),
        block_areas,
        merged_vertices: built.noding.merged_vertices,
        ignored_joints: ignored_traces(&built.noding).len(),
        memory_bytes: (model.bytes() + 2 * state.bytes() + workspace.bytes()) as u64,
        memory: memory(simulation, &state, &workspace),
        extend_ends: built.end_distances.join,
        near_ends: built.end_distances.list,
        trace_ends: TraceEndRecord::all(built),
        crumbs: CrumbRecord::all(built),
        rock_masses: rock_masses(simulation.case()),
        records: simulation.case().ground_motions(),
        bridges: built.bridges.iter().map(BridgeRecord::of).collect(),
        flow: simulation.flow_survey(),
        conductivities: conductivities(simulation),
        drain_times: drain_times(simulation),
        notes: built.notes.iter().cloned().chain(corner_note(simulation)).collect(),
        warnings: warnings.iter().chain(&built.warnings).cloned().chain(flow_doubts(simulation)).collect(),
    }
}

/// How many notes of the drawing and of the build there are, for commands that do not repeat them.
pub fn count_of_notes(count: usize) -> Option<String> {
    let notes = if count == 1 { "note" } else { "notes" };
    (count > 0).then(|| format!("{count} {notes} on the drawing and the build, see `enmm check`"))
}

/// Corners of the last stage that meet rock ahead of them: they may carry the slope.
fn corner_note(simulation: &Simulation) -> Option<String> {
    let digs = simulation.case().stages.iter().any(|s| !s.excavate.is_empty() || s.excavate_region.is_some());
    let corners = if digs {
        let mut last = simulation.clone();
        while last.next_stage().is_ok_and(|goes_on| goes_on) {}
        weak_corners(&last)
    } else {
        weak_corners(simulation)
    };
    let places: Vec<String> = corners.iter().map(|c| format!("{} {}", c.text(), c.over())).collect();
    (!places.is_empty()).then(|| {
        format!(
            "corners meet rock ahead of them: {}; rock crushes there before it holds a slope, and `enmm fos` and \
             `enmm bound` give the factor without them where they carry it",
            places.join(", ")
        )
    })
}

fn default_stiffness(simulation: &Simulation) -> Option<f64> {
    let mut laws = simulation.case().joint_laws.values().zip(&simulation.model().laws);
    laws.find(|(law, _)| law.normal_stiffness.is_none()).map(|(_, law)| law.normal_stiffness)
}

/// A rock bridge between two blocks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BridgeRecord {
    /// Number of its trace.
    pub joint: usize,
    /// Its middle (m).
    pub place: [f64; 2],
    /// Its length (m).
    pub length: f64,
    /// Characteristic length of its rock (m); 0 where that is brittle.
    pub characteristic_length: f64,
    /// Strength in bending over tensile strength.
    pub bending: f64,
    /// `by section` or `by node`.
    pub breaks: &'static str,
    /// Why by node; none by section, and where the law says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub because: Option<&'static str>,
}

impl BridgeRecord {
    fn of(bridge: &Bridge) -> Self {
        let Bridge { trace, place, length, characteristic, bending, breaking } = *bridge;
        let because = match breaking {
            Breaking::BySection | Breaking::Asked => None,
            Breaking::WithoutTension => Some("it has no tensile strength"),
            Breaking::Soft => Some("its characteristic length is more than four times its length"),
            Breaking::Shallow => Some("rock beside it is less than half as deep as it is long"),
            Breaking::TurnsBack => Some("its line turns back"),
        };
        Self {
            joint: trace,
            place: place.into(),
            length,
            characteristic_length: characteristic,
            bending,
            breaks: if breaking == Breaking::BySection { "by section" } else { "by node" },
            because,
        }
    }
}

/// A part of the memory that a model needs while it runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MemoryPart {
    /// `model`, `state` or `buffers`.
    pub heap: &'static str,
    /// Its content.
    pub part: &'static str,
    /// Its size (bytes).
    pub bytes: usize,
}

/// Memory of a model with this state and these buffers.
fn memory(simulation: &Simulation, state: &State, workspace: &Workspace) -> Vec<MemoryPart> {
    let heaps = [("model", simulation.model().memory()), ("state", state.memory()), ("buffers", workspace.memory())];
    let part = |heap| move |(part, bytes)| MemoryPart { heap, part, bytes };
    heaps.into_iter().flat_map(|(heap, parts)| parts.into_iter().map(part(heap))).collect()
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values
}

fn distinct(points: &[Point]) -> usize {
    let bits = |x: f64| u128::from((x + 0.0).to_bits());
    let mut keys: Vec<u128> = points.iter().map(|p| bits(p.x) << 64 | bits(p.y)).collect();
    keys.sort_unstable();
    keys.dedup();
    keys.len()
}

/// Covers with less than the share of a full cover's mass; `third` is a third of the cover's hexagon (m²).
fn small_covers(simulation: &Simulation, third: f64) -> usize {
    let model = simulation.model();
    let covers = &model.covers;
    let mut density = vec![0.0f64; covers.cover_count()];
    for (e, ids) in covers.element_covers.iter().enumerate() {
        let of_element = model.rocks[model.element_rock[e] as usize].density;
        ids.iter().for_each(|&i| density[i] = density[i].max(of_element));
    }
    let masses = model.mass_matrix.row_sum.iter().zip(density);
    masses.filter(|(mass, density)| **mass < SMALL_COVER * third * density).count()
}
