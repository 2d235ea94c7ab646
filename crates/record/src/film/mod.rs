//! Blocks and frames of a model for the film of the page `report.html`.

mod elements;
mod structures;
mod water;

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use enmm_report::{
    Axis, BlockFrame, BlockNumber, Column, EdgeState, FilmError, FilmWriter, Frame, Head, Mesh, MonitorFrame,
    MonitorPlace, Note, Outline, PAGE, Structures, write_page,
};

use crate::breaks::BreakRecord;
use elements::Meshes;
use enmm::geometry::{Point, Vector, polygon};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, EdgeId};
use enmm_io::LoadedCase;
use enmm_observe::{
    BLOCK_QUANTITIES, BlockState, BondState, ContactState, Quantity, STRENGTH_QUANTITIES, bond_states, node_loops,
};
use structures::{Beside, bolt_places};

/// Numbers of blocks that the film of a model that moves leaves out: they never change, or follow from others of it.
const LEFT_OUT: [&str; 8] =
    ["centroid_x", "centroid_y", "area", "mass", "kinetic_energy", "strain_energy", "contacts", "speed"];

/// Frames of the film from one with the numbers of elements to the next.
const ELEMENTS_EVERY: u32 = 3;

/// Ranges of the colours of numbers: a share of strength of 1 breaks.
const RANGES: [(&str, [u32; 2]); 1] = [("strength_share", [0, 1])];

/// Numbers of blocks in the film of a model that moves, by their names in `blocks.csv`.
pub fn numbers(simulation: &Simulation) -> Vec<&'static str> {
    simulation.block_quantities().map(|quantity| quantity.name).filter(is_shown).collect()
}

fn is_shown(name: &&str) -> bool {
    !LEFT_OUT.contains(name)
}

/// A film of a model.
#[derive(Debug)]
pub struct Film {
    writer: FilmWriter,
    path: PathBuf,
    page: PathBuf,
    /// Getters of the numbers of blocks in frames.
    numbers: Vec<fn(&BlockState) -> f64>,
    /// Boundary point of each corner, blocks in order, the outer loop of each first.
    corners: Vec<EdgeId>,
    /// Sections of rock that had broken when the outlines were written; none when they are to be written anew.
    breaks: Option<usize>,
    /// Sections of rock whose break has been noted.
    noted: usize,
    /// Unknowns of the flow in joints that was noted last.
    flow: Vec<f64>,
    /// Elements, in a film that shows them.
    meshes: Option<Meshes>,
    /// Frames since the last one with the numbers of elements, and its stage.
    since: Option<(u32, u32)>,
    /// The same where what is kept back begins.
    since_held: Option<(u32, u32)>,
}

/// Opening of a film beside the case and its model.
#[derive(Debug)]
pub struct Opening<'a> {
    /// The command, such as `run`.
    pub command: &'static str,
    /// The film.
    pub film: PathBuf,
    /// Axis of the slider.
    pub axis: Axis,
    /// Numbers of blocks in frames, by name.
    pub numbers: Vec<&'static str>,
    /// Whether it shows elements; velocity, spin and mean stress are among the numbers of blocks then.
    pub elements: bool,
    /// Names and units of the columns of the histories, the time first.
    pub columns: &'a [(String, &'static str)],
}

impl Film {
    /// Begins a film whose page goes to a directory, or continues it behind a time (s).
    ///
    /// # Errors
    /// A number that cannot be shown, or what the file system refuses.
    pub fn open(
        directory: &Path,
        loaded: &LoadedCase,
        simulation: &Simulation,
        opening: Opening,
        until: Option<f64>,
    ) -> io::Result<Self> {
        let simulation = &*simulation.cut_ahead();
        let (mut outlines, corners) = outlines(simulation);
        let meshes = opening.elements.then(|| Meshes::of(simulation, &mut outlines, &corners));
        let path = opening.film.clone();
        let shown: Vec<&Quantity<BlockState>> = opening.numbers.iter().filter_map(|name| number(name)).collect();
        let numbers = shown.iter().map(|quantity| quantity.get).collect();
        let head = head(loaded, simulation, opening, &shown);
        let writer = match until {
            Some(until) => FilmWriter::resume(&path, &head, &outlines, until),
            None => FilmWriter::create(&path, &head, &outlines),
        };
        // A film that goes on may end with frames from before the last break.
        let can_have_older = until.is_some() && simulation.model().breaking.is_some();
        let breaks = (!can_have_older).then(|| simulation.cuts().len());
        let (writer, page) = (writer.map_err(refused)?, directory.join(PAGE));
        let (flow, since, since_held) = (Vec::new(), None, None);
        Ok(Self { writer, path, page, numbers, corners, breaks, noted: 0, flow, meshes, since, since_held })
    }

    /// Appends the model as it is now.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn frame(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (simulation, time) = (&*simulation.cut_ahead(), simulation.time());
        let stage = simulation.state().stage;
        self.since = self.since.filter(|&(since, before)| since < ELEMENTS_EVERY && before == stage);
        self.since = self.since.map(|(since, stage)| (since + 1, stage));
        self.blocks_at(simulation, time)?;
        // Also where blocks have broken since the last frame.
        if self.since.is_none() { self.elements_at(simulation, time) } else { Ok(()) }
    }

    /// Appends the model as it is now, with its elements, at a place of the slider.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn frame_at(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        let simulation = &*simulation.cut_ahead();
        self.blocks_at(simulation, time)?;
        self.elements_at(simulation, time)
    }

    /// Appends the elements of a model whose blocks the last frame has.
    fn elements_at(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        self.since = Some((1, simulation.state().stage));
        let Some(meshes) = &self.meshes else { return Ok(()) };
        meshes.write(simulation, time, &mut self.writer).map_err(refused)
    }

    /// Appends the blocks of a model.
    fn blocks_at(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        self.follow_breaks(simulation, time)?;
        self.note_flow(simulation, time)?;
        let displacement = |&point: &EdgeId| {
            let sample = simulation.model().boundary.sample(point, &simulation.state().displacement);
            [sample.x, sample.y]
        };
        let monitor = |k| {
            // Where it is, from the start on.
            let ((element, point), v) = (simulation.built().monitors.points[k], simulation.monitor(k).1);
            let u = simulation.model().sample(element, point, &simulation.state().displacement);
            MonitorFrame { displacement: [u.x, u.y], velocity: [v.x, v.y] }
        };
        let states = edge_states(simulation);
        let beside = Beside::now(simulation);
        let wet = self.wet_corners(simulation);
        self.writer
            .frame(&Frame {
                time,
                stage: simulation.state().stage,
                blocks: &simulation.block_states().iter().map(|block| self.block_frame(block)).collect::<Vec<_>>(),
                corners: &self.corners.iter().map(displacement).collect::<Vec<_>>(),
                edges: &self.corners.iter().map(|&point| states[point]).collect::<Vec<_>>(),
                monitors: &(0..simulation.case().monitors.len()).map(monitor).collect::<Vec<_>>(),
                structures: Structures { wet: &wet, ..beside.structures() },
            })
            .map_err(refused)
    }

    /// Appends the outlines of the blocks when some have broken since the last ones.
    fn follow_breaks(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        let breaks = Some(simulation.cuts().len());
        if self.breaks != breaks {
            let (mut outlines, corners) = outlines(simulation);
            self.meshes = self.meshes.take().map(|_| Meshes::of(simulation, &mut outlines, &corners));
            self.since = None;
            self.writer.outlines(time, &outlines).map_err(refused)?;
            (self.corners, self.breaks) = (corners, breaks);
        }
        self.note_breaks(simulation, time)
    }

    /// Notes the blocks that have broken since the last note. A film that goes on has all again.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn note_breaks(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        for broken in BreakRecord::all(simulation).into_iter().skip(self.noted) {
            self.note(time, &Note::Break(broken.note()))?;
            self.noted += 1;
        }
        Ok(())
    }

    /// Notes the flow in joints when it is another than that of the last note.
    fn note_flow(&mut self, simulation: &Simulation, time: f64) -> io::Result<()> {
        let Some(seepage) = &simulation.state().seepage else { return Ok(()) };
        if self.flow == seepage.unknowns {
            return Ok(());
        }
        self.flow.clone_from(&seepage.unknowns);
        water::water(simulation).map_or(Ok(()), |water| self.note(time, &Note::Water(water)))
    }

    /// Appends a frame in which every block has a rigid motion: displacement of its centroid (m) and rotation (rad).
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn rigid_frame(
        &mut self,
        simulation: &Simulation,
        time: f64,
        motion: impl Fn(usize) -> (Vector, f64),
    ) -> io::Result<()> {
        self.note_flow(simulation, time)?;
        let boundary = &simulation.model().boundary;
        let states = simulation.block_states();
        let blocks: Vec<BlockFrame> = states
            .iter()
            .enumerate()
            .map(|(k, state)| {
                let (displacement, rotation) = motion(k);
                let mut numbers = vec![displacement.x, displacement.y, rotation];
                numbers.resize(self.numbers.len(), 0.0);
                BlockFrame { removed: state.removed, numbers }
            })
            .collect();
        let moved = |place: Point, block: BlockId| {
            let block = block.index();
            let (displacement, rotation) = motion(block);
            let arm = place - (states[block].centroid - states[block].displacement);
            let (sine, less) = (libm::sin(rotation), libm::cos(rotation) - 1.0);
            displacement + Vector::new(arm.x * less - arm.y * sine, arm.x * sine + arm.y * less)
        };
        let corner = |&point: &EdgeId| {
            let displacement = moved(boundary.reference[point], boundary.block[point]);
            [displacement.x, displacement.y]
        };
        let beside = Beside::moved(simulation, moved);
        self.writer
            .frame(&Frame {
                time,
                stage: simulation.state().stage,
                blocks: &blocks,
                corners: &self.corners.iter().map(corner).collect::<Vec<_>>(),
                edges: &[],
                monitors: &vec![MonitorFrame::default(); simulation.case().monitors.len()],
                structures: beside.structures(),
            })
            .map_err(refused)
    }

    fn block_frame(&self, state: &BlockState) -> BlockFrame {
        BlockFrame { removed: state.removed, numbers: self.numbers.iter().map(|get| get(state)).collect() }
    }

    /// Whether the water presses on the edge behind each corner; empty without water.
    fn wet_corners(&self, simulation: &Simulation) -> Vec<bool> {
        let Some(water) = &simulation.model().water else { return Vec::new() };
        let wet: BTreeSet<EdgeId> = water.edges.iter().copied().collect();
        self.corners.iter().map(|point| wet.contains(point)).collect()
    }

    /// Takes a row of the histories.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn row(&mut self, row: &[f64]) -> io::Result<()> {
        self.writer.row(row).map_err(refused)
    }

    /// Appends a note at a time (s).
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn note(&mut self, time: f64, note: &Note) -> io::Result<()> {
        self.writer.note(time, note).map_err(refused)
    }

    /// Keeps back what follows until it is released or discarded.
    pub fn hold(&mut self) {
        self.since_held = self.since;
        self.writer.hold();
    }

    /// Bytes that are kept back.
    pub fn held(&self) -> usize {
        self.writer.held()
    }

    /// Writes what has been kept back.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn release(&mut self) -> io::Result<()> {
        self.writer.release().map_err(refused)
    }

    /// Forgets what has been kept back.
    pub fn discard(&mut self) {
        self.forget_breaks();
        self.flow.clear();
        self.since = self.since_held;
        self.writer.discard();
    }

    /// Removes frames, rows and notes later than a time (s).
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn cut(&mut self, until: f64) -> io::Result<()> {
        self.forget_breaks();
        self.flow.clear();
        self.since = None;
        self.writer.cut(until).map_err(refused)
    }

    /// Outlines after a break may be gone, and are written again.
    fn forget_breaks(&mut self) {
        if self.breaks != Some(0) {
            self.breaks = None;
            self.noted = 0;
        }
    }

    /// Ends the film and writes its page.
    ///
    /// # Errors
    /// As [`Film::open`].
    pub fn close(&mut self, time: f64, status: String) -> io::Result<()> {
        self.note(time, &Note::End { status })?;
        write_page(&self.path, &self.page).map_err(refused)
    }
}

fn refused(error: FilmError) -> io::Error {
    io::Error::other(error)
}

/// The quantity of blocks of that name.
fn number(name: &str) -> Option<&'static Quantity<BlockState>> {
    BLOCK_QUANTITIES.iter().chain(&STRENGTH_QUANTITIES).find(|quantity| quantity.name == name)
}

fn head(loaded: &LoadedCase, simulation: &Simulation, opening: Opening, shown: &[&Quantity<BlockState>]) -> Head {
    let case = simulation.case();
    let monitors =
        case.monitors.iter().map(|monitor| MonitorPlace { name: monitor.name.clone(), place: monitor.point });
    let column = |(name, unit): &(String, &'static str)| Column {
        name: name.clone(),
        quantity: quantity(name, unit).to_owned(),
        unit: (*unit).to_owned(),
        gaps: has_gaps(name),
    };
    let number = |quantity: &&Quantity<BlockState>| BlockNumber {
        name: quantity.name.to_owned(),
        unit: quantity.unit.to_owned(),
        meaning: quantity.text.to_owned(),
        range: RANGES.iter().find(|(name, _)| *name == quantity.name).map(|(_, range)| *range),
    };
    Head {
        title: case.title.clone(),
        command: opening.command.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case_file: loaded.source.file().to_owned(),
        case_text: loaded.source.text().to_owned(),
        axis: opening.axis,
        block_numbers: shown.iter().map(number).collect(),
        columns: opening.columns.iter().map(column).collect(),
        monitors: monitors.collect(),
        bolts: bolt_places(simulation),
        rocks: case.rocks.keys().cloned().collect(),
    }
}

/// Ends of the names of columns of stress and joints, which have no value where rock has been excavated, and the
/// quantities by which they are charted.
const READINGS: [(&str, &str); 10] = [
    ("_opening", "Opening of joints"),
    ("_slip", "Slip of joints"),
    ("_normal_stress", "Normal stress on joints"),
    ("_shear_stress", "Shear stress on joints"),
    ("_stress_xx", "Stress"),
    ("_stress_yy", "Stress"),
    ("_stress_xy", "Stress"),
    ("_principal_max", "Principal stress"),
    ("_principal_min", "Principal stress"),
    ("_principal_angle", "Direction of the greatest compression"),
];

/// Whether a column may be without values.
fn has_gaps(name: &str) -> bool {
    READINGS.iter().any(|(end, _)| name.ends_with(end))
}

/// The quantity by which a column of the histories is charted.
fn quantity<'a>(name: &'a str, unit: &str) -> &'a str {
    if let Some((_, quantity)) = READINGS.iter().find(|(end, _)| name.ends_with(end)) {
        return quantity;
    }
    match (name, unit) {
        (_, "m/s") => "Velocity",
        (_, "J/m") => "Energy",
        (_, "N") => "Tension of a bar",
        ("penetration_max", _) => "Largest penetration",
        (_, "m") => "Displacement",
        ("locked" | "slipping", _) => "Contacts",
        ("unbalanced_ratio", _) => "Unbalanced ratio",
        ("sweeps_mean", _) => "Open–close sweeps per step",
        ("stage", _) => "Stage",
        _ => name,
    }
}

/// Blocks in the reference configuration, and the boundary point of each corner: those of the nodes.
fn outlines(simulation: &Simulation) -> (Vec<Outline>, Vec<EdgeId>) {
    let model = simulation.model();
    let boundary = &model.boundary;
    let mut loops = node_loops(simulation);
    let place = |&point: &EdgeId| boundary.reference[point];
    let area = |points: &Vec<EdgeId>| polygon::area(&points.iter().map(place).collect::<Vec<Point>>());
    let states = simulation.block_states();
    let outline = |(block, (loops, state)): (BlockId, (&mut Vec<Vec<EdgeId>>, &BlockState))| {
        loops.sort_by(|a, b| area(b).total_cmp(&area(a)));
        let centroid = state.centroid - state.displacement;
        let rock = model.covers.elements_of(block).next().map_or(0, |e| model.element_rock[e]);
        let corners = |points: &Vec<EdgeId>| points.iter().map(|p| [place(p).x, place(p).y]).collect();
        Outline {
            id: state.id,
            fixed: state.fixed,
            rock,
            area: state.area,
            mass: state.mass,
            centroid: [centroid.x, centroid.y],
            loops: loops.iter().map(corners).collect(),
            mesh: Mesh::default(),
        }
    };
    let outlines = model.covers.blocks().zip(loops.iter_mut().zip(&states)).map(outline).collect();
    (outlines, loops.into_iter().flatten().flatten().collect())
}

/// State of each edge of the boundary.
fn edge_states(simulation: &Simulation) -> Vec<EdgeState> {
    let shown = |state| match state {
        None => EdgeState::Free,
        Some(ContactState::Open) => EdgeState::Open,
        Some(ContactState::Slip) => EdgeState::Slip,
        Some(ContactState::Lock) => EdgeState::Lock,
    };
    let with_bond = |(state, bond)| match bond {
        BondState::None => shown(state),
        BondState::Holds => EdgeState::Bridge,
        BondState::Broken => EdgeState::Broken,
    };
    enmm_observe::edge_states(simulation).into_iter().zip(bond_states(simulation)).map(with_bond).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_film_is_in_the_table_of_blocks_and_the_motion_comes_first() {
        assert!(LEFT_OUT.iter().chain(RANGES.iter().map(|(name, _)| name)).all(|name| number(name).is_some()));
        let shown: Vec<&str> = BLOCK_QUANTITIES.iter().map(|quantity| quantity.name).filter(is_shown).collect();
        assert!(shown.starts_with(&enmm_report::MOTION));
    }
}
