//! Frames for ParaView: VTK unstructured grids and the collection that puts them on a time axis.
//!
//! Every array is inline base64 (`format="binary"`, zlib blocks, little-endian, 64-bit header), which VTK, ParaView and
//! meshio all read. Displacement jumps across joints, so elements share no points. Names (of laws, rocks, bolts,
//! fixities, states) are the component names of arrays of the field data, whose values are the numbers that stand for
//! them: arrays of texts stop meshio.

mod array;

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use array::Array;
use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm_io::files::{at_path, open_result, write_atomic, write_atomic_by};
use enmm_observe::{
    BOLT_QUANTITIES, BoltCondition, BoltLine, BondState, ContactState, FLOW_QUANTITIES, FlowLine, JOINT_QUANTITIES,
    JointPiece, Joints, Quantity, STRESS_QUANTITIES, Snapshot, SupportKind, SupportPoint, WaterInJoints, WetEdge,
    bolts, supports, wet_edges,
};

use crate::folder::make_frames;

/// Cell types of VTK.
const VERTEX: u8 = 1;
const POLY_VERTEX: u8 = 2;
const LINE: u8 = 3;
const POLYGON: u8 = 7;

/// Writes the elements of a snapshot: one polygon each, with its own points at their current position.
///
/// Point data: `displacement` (m), `velocity` (m/s), three components each. Cell data: `stress` (Pa, tension positive;
/// XX, YY, ZZ, XY, YZ, XZ, of which YZ and XZ are zero), its parts `stress_xx`, `stress_yy`,
/// `stress_xy`, the principal stresses in the plane `principal_max` and `principal_min` (so that the greatest
/// compression is `principal_min`), `mean_stress` = (xx + yy)/2, `max_shear` = √(((xx − yy)/2)² + xy²) (all Pa),
/// `block`, `rock`, `plastic_strain` = √(⅔ εp:εp) where rock can yield, and `strength_share` of the worst section of
/// the block where rock can break. Field data: `TimeValue` (s), `rock_names`.
///
/// # Errors
/// `InvalidInput` if a field does not have one entry per point or element; else what the file system refuses.
pub fn write_vtu(snapshot: &Snapshot, path: &Path) -> io::Result<()> {
    let elements = &snapshot.elements;
    let yielding = !snapshot.plastic_strain.is_empty();
    let plastic = yielding.then(|| Array::numbers("plastic_strain", snapshot.plastic_strain.iter().copied()));
    let breaking = !snapshot.strength_share.is_empty();
    let shares = breaking.then(|| Array::numbers("strength_share", snapshot.strength_share.iter().copied()));
    let mut grid = Grid {
        time: snapshot.time,
        names: vec![Array::names("rock_names", &snapshot.rocks)],
        points: Array::vectors("Points", elements.points.iter().copied()),
        cell_type: POLYGON,
        offsets: Array::ids("offsets", elements.start.get(1..).unwrap_or_default()),
        used: elements.start.last().map_or(0, |&end| end as usize),
        point_data: vec![
            Array::vectors("displacement", snapshot.displacement.iter().copied()),
            Array::vectors("velocity", snapshot.velocity.iter().copied()),
        ],
        cell_data: vec![Array::tensors("stress", &snapshot.stress, &snapshot.stress_zz)],
    };
    grid.cell_data.extend(numbers(&STRESS_QUANTITIES, &snapshot.stress));
    grid.cell_data.extend([Array::ids("block", &snapshot.block), Array::ids("rock", &snapshot.rock)]);
    grid.cell_data.extend(plastic.into_iter().chain(shares));
    grid.write(path)
}

/// Writes joints: one line for each piece of a joint, on the face of its first block, and for each piece of boundary
/// that another block has come to touch.
///
/// Cell data: `block_1`, `block_2` (equal where a joint ends inside a block), `opening` (m, apart positive), `slip` (m,
/// along the joint), both since the start, of what lay face to face then; `force` (N/m, three components) on the first
/// block, which sums over the pieces of a face to the force on it; `normal_stress` (Pa, tension positive) and
/// `shear_stress` (Pa), the force on the face over the length of it that is closed; `state` (0 open, 1 slip, 2 lock),
/// `bond` (0 none, 1 broken, 2 holds, of joints that soften), `law` (index of the joint law), `is_joint` (0 for a
/// touched boundary, whose opening and slip are zero), `normal` (three components, out of the first block). Field
/// data: `TimeValue` (s), `law_names`, `state_names`, `bond_names`.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_joints_vtu(joints: &[JointPiece], laws: &[String], time: f64, path: &Path) -> io::Result<()> {
    let [opening, slip, normal_stress, shear_stress] = numbers(&JOINT_QUANTITIES, joints);
    let block = |name, k: usize| Array::integers(name, joints.iter().map(move |joint| joint.blocks[k] as usize));
    let cell_data = vec![
        block("block_1", 0),
        block("block_2", 1),
        opening,
        slip,
        Array::vectors("force", joints.iter().map(|joint| joint.force)),
        normal_stress,
        shear_stress,
        Array::bytes("state", joints.iter().map(|joint| state_code(joint.state))),
        Array::bytes("bond", joints.iter().map(|joint| joint.bond.number())),
        Array::integers("law", joints.iter().map(|joint| joint.law as usize)),
        Array::bytes("is_joint", joints.iter().map(|joint| u8::from(joint.is_joint))),
        Array::vectors("normal", joints.iter().map(|joint| joint.normal)),
    ];
    let names = vec![
        Array::names("law_names", laws),
        Array::names("state_names", &["open", "slip", "lock"]),
        Array::names("bond_names", &BondState::NAMES),
    ];
    let ends: Vec<Point> = joints.iter().flat_map(|joint| joint.ends).collect();
    lines(time, names, &ends, Vec::new(), cell_data).write(path)
}

/// Writes bolts: one line for each free length of a bar.
///
/// Cell data: `force` (N per metre of depth, tension), `bolt` (index in the case), `state` (0 absent, 1 whole,
/// 2 yielded, 3 broken). Field data: `TimeValue` (s), `bolt_names`, `state_names`.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_bolts_vtu(bolts: &[BoltLine], names: &[String], time: f64, path: &Path) -> io::Result<()> {
    let [force] = numbers(&BOLT_QUANTITIES, bolts);
    let cell_data = vec![
        force,
        Array::integers("bolt", bolts.iter().map(|bolt| bolt.bolt as usize)),
        Array::bytes("state", bolts.iter().map(|bolt| bolt.condition.number())),
    ];
    let states = Array::names("state_names", &BoltCondition::NAMES);
    let ends: Vec<Point> = bolts.iter().flat_map(|bolt| bolt.ends).collect();
    lines(time, vec![Array::names("bolt_names", names), states], &ends, Vec::new(), cell_data).write(path)
}

/// Writes supported points that hold: one vertex each.
///
/// Point data: `reaction` (N/m, three components) on the rock, `kind` (0 fixity, 1 spring and 2 dashpot of a quiet
/// boundary or a free-field side), `fix` (index of the fixity in the case, or of the boundary: quiet ones first). Field
/// data: `TimeValue` (s), `fix_names`, `kind_names`.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_supports_vtu(supports: &[SupportPoint], names: &[String], time: f64, path: &Path) -> io::Result<()> {
    let code = |kind| match kind {
        SupportKind::Fixity => 0,
        SupportKind::Spring => 1,
        SupportKind::Dashpot => 2,
    };
    let grid = Grid {
        time,
        names: vec![Array::names("fix_names", names), Array::names("kind_names", &["fixity", "spring", "dashpot"])],
        points: Array::vectors("Points", supports.iter().map(|support| support.position)),
        cell_type: VERTEX,
        offsets: Array::integers("offsets", 1..supports.len() + 1),
        used: supports.len(),
        point_data: vec![
            Array::vectors("reaction", supports.iter().map(|support| support.reaction)),
            Array::bytes("kind", supports.iter().map(move |support| code(support.kind))),
            Array::integers("fix", supports.iter().map(|support| support.index as usize)),
        ],
        cell_data: Vec::new(),
    };
    grid.write(path)
}

/// Writes the wet edges of the boundary: one line each, rock on its left.
///
/// Point data: `water_pressure` (Pa) of the water of the case. Cell data: `block`. Field data: `TimeValue` (s).
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_water_vtu(edges: &[WetEdge], time: f64, path: &Path) -> io::Result<()> {
    let ends: Vec<Point> = edges.iter().flat_map(|edge| edge.ends).collect();
    let pressure: Vec<f64> = edges.iter().flat_map(|edge| edge.pressure).collect();
    let pressure = Array::numbers("water_pressure", pressure.iter().copied());
    let block = Array::integers("block", edges.iter().map(|edge| edge.block as usize));
    lines(time, Vec::new(), &ends, vec![pressure], vec![block]).write(path)
}

/// Writes joints in which water flows: one line for each piece that conducts, on the face of its first block.
///
/// Point data: `pressure_head` (m). Cell data: `head` (m), `pressure` (Pa), `flow` (m²/s, along the line), `aperture`
/// (m), `filling` (0 to 1), `block`. Field data: `TimeValue` (s).
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_flow_vtu(lines_of: &[FlowLine], time: f64, path: &Path) -> io::Result<()> {
    let ends: Vec<Point> = lines_of.iter().flat_map(|line| line.ends).collect();
    let heads: Vec<f64> = lines_of.iter().flat_map(FlowLine::pressure_heads).collect();
    let heads = Array::numbers("pressure_head", heads.iter().copied());
    let mut cell_data = Vec::from(numbers(&FLOW_QUANTITIES, lines_of));
    cell_data.push(Array::integers("block", lines_of.iter().map(|line| line.block as usize)));
    lines(time, Vec::new(), &ends, vec![heads], cell_data).write(path)
}

/// Arrays of the quantities of a table.
fn numbers<'a, T, const N: usize>(quantities: &[Quantity<T>; N], values: &'a [T]) -> [Array<'a>; N] {
    let array = |quantity: &Quantity<T>| Array::numbers(quantity.name, values.iter().map(quantity.get));
    quantities.each_ref().map(array)
}

/// A grid of lines, two points each.
fn lines<'a>(
    time: f64,
    names: Vec<Array<'a>>,
    ends: &'a [Point],
    point_data: Vec<Array<'a>>,
    cell_data: Vec<Array<'a>>,
) -> Grid<'a> {
    Grid {
        time,
        names,
        points: Array::vectors("Points", ends.iter().copied()),
        cell_type: LINE,
        offsets: Array::integers("offsets", (1..ends.len() / 2 + 1).map(|cell| 2 * cell)),
        used: ends.len(),
        point_data,
        cell_data,
    }
}

fn state_code(state: ContactState) -> u8 {
    match state {
        ContactState::Open => 0,
        ContactState::Slip => 1,
        ContactState::Lock => 2,
    }
}

/// Structures that a frame shows beside the elements.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Structures {
    /// Joints.
    pub joints: Vec<JointPiece>,
    /// Bolts.
    pub bolts: Vec<BoltLine>,
    /// Supported points.
    pub supports: Vec<SupportPoint>,
    /// Wet edges of the boundary.
    pub water: Vec<WetEdge>,
    /// Joints in which water flows.
    pub flow: Vec<FlowLine>,
    /// Names of the bolts of the case.
    pub bolt_names: Vec<String>,
    /// Names of the fixities of the case.
    pub fix_names: Vec<String>,
}

impl Structures {
    /// Those of a model now.
    pub fn of(simulation: &Simulation, joints: &Joints) -> Self {
        let case = simulation.case();
        let named = |kind: &str, k: usize, name: &Option<String>| name.clone().unwrap_or(format!("{kind} {}", k + 1));
        Self {
            joints: joints.now(simulation),
            bolts: bolts(simulation),
            supports: supports(simulation),
            water: wet_edges(simulation),
            flow: WaterInJoints::of(simulation).map_or_else(Vec::new, |water| water.lines),
            bolt_names: case.bolts.iter().enumerate().map(|(k, bolt)| named("bolt", k, &bolt.name)).collect(),
            fix_names: case.fixes.iter().enumerate().map(|(k, fix)| named("fix", k, &fix.name)).collect(),
        }
    }
}

/// A part of a frame, in a file of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The elements.
    Elements,
    /// The joints.
    Joints,
    /// The bolts.
    Bolts,
    /// The supports.
    Supports,
    /// The wet boundary.
    Water,
    /// Joints in which water flows.
    Flow,
}

/// All parts.
pub const PARTS: [Part; 6] = [Part::Elements, Part::Joints, Part::Bolts, Part::Supports, Part::Water, Part::Flow];

impl Part {
    /// The parts that frames of a model have.
    pub fn of(simulation: &Simulation) -> Vec<Self> {
        let model = simulation.model();
        let all = [
            (true, Self::Elements),
            (true, Self::Joints),
            (!model.bolts.is_empty(), Self::Bolts),
            (!model.supports.is_empty(), Self::Supports),
            (model.water.is_some() || model.flow.is_some(), Self::Water),
            (model.flow.is_some(), Self::Flow),
        ];
        all.into_iter().filter(|(has, _)| *has).map(|(_, part)| part).collect()
    }

    /// Its name, with which its files begin.
    pub fn name(self) -> &'static str {
        ["elements", "joints", "bolts", "supports", "water", "flow"][self as usize]
    }

    /// Its file in a frame of this number, in the directory of the run.
    fn file(self, number: usize) -> String {
        format!("frames/{}_{number:04}.vtu", self.name())
    }

    fn write(self, snapshot: &Snapshot, beside: &Structures, path: &Path) -> io::Result<()> {
        let time = snapshot.time;
        match self {
            Self::Elements => write_vtu(snapshot, path),
            Self::Joints => write_joints_vtu(&beside.joints, &snapshot.joint_laws, time, path),
            Self::Bolts => write_bolts_vtu(&beside.bolts, &beside.bolt_names, time, path),
            Self::Supports => write_supports_vtu(&beside.supports, &beside.fix_names, time, path),
            Self::Water => write_water_vtu(&beside.water, time, path),
            Self::Flow => write_flow_vtu(&beside.flow, time, path),
        }
    }
}

/// Writes `run.pvd` and the frames that it lists into the directory of a run.
///
/// The collection is replaced in one move after each frame, so a killed run leaves a valid one.
#[derive(Debug)]
pub struct PvdWriter {
    directory: PathBuf,
    parts: Vec<Part>,
    frames: Vec<Frame>,
    /// Frames in the list before those that are kept back.
    held_from: Option<usize>,
}

/// A frame of the collection: its time (s) and its number in the file names.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    time: f64,
    number: usize,
}

impl PvdWriter {
    /// Starts the collection `directory/run.pvd` of frames with these parts, with no frame.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn new(directory: &Path, parts: Vec<Part>) -> io::Result<Self> {
        make_frames(directory)?;
        let writer = Self { directory: directory.to_owned(), parts, frames: Vec::new(), held_from: None };
        writer.write_collection()?;
        Ok(writer)
    }

    /// Continues the collection of an interrupted run: frames later than `keep_until_time` (s) leave the list, and
    /// their files are written over. A missing collection is started again.
    ///
    /// # Errors
    /// `InvalidData` if `run.pvd` is not a collection that this type wrote; else what the file system refuses.
    pub fn open_for_append(directory: &Path, parts: Vec<Part>, keep_until_time: f64) -> io::Result<Self> {
        let path = directory.join("run.pvd");
        let text = match open_result(&path).and_then(io::read_to_string) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Self::new(directory, parts),
            read => read.map_err(at_path(&path))?,
        };
        make_frames(directory)?;
        let mut frames = listed_frames(&text).map_err(at_path(&path))?;
        frames.retain(|frame| frame.time <= keep_until_time);
        let writer = Self { directory: directory.to_owned(), parts, frames, held_from: None };
        writer.write_collection()?;
        Ok(writer)
    }

    /// Writes a file for each part, such as `frames/joints_NNNN.vtu`, and lists them at the time of the snapshot.
    ///
    /// # Errors
    /// As [`write_vtu`] and its like; the collection then stays as it was.
    pub fn push(&mut self, snapshot: &Snapshot, beside: &Structures) -> io::Result<()> {
        let number = self.frames.last().map_or(0, |last| last.number + 1);
        for part in &self.parts {
            part.write(snapshot, beside, &self.directory.join(part.file(number)))?;
        }
        self.frames.push(Frame { time: snapshot.time, number });
        if self.held_from.is_some() { Ok(()) } else { self.write_collection() }
    }

    /// Keeps the frames that follow out of the collection until they are released or discarded.
    pub fn hold(&mut self) {
        self.held_from = Some(self.frames.len());
    }

    /// Lists the frames that have been kept back; those that follow are no longer kept back.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn release(&mut self) -> io::Result<()> {
        match self.held_from.take() {
            Some(listed) if listed < self.frames.len() => self.write_collection(),
            _ => Ok(()),
        }
    }

    /// Forgets the frames that have been kept back, whose files are written over; those that follow are no longer kept
    /// back.
    pub fn discard(&mut self) {
        if let Some(listed) = self.held_from.take() {
            self.frames.truncate(listed);
        }
    }

    /// Takes frames later than `keep_until_time` (s) out of the collection.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn cut(&mut self, keep_until_time: f64) -> io::Result<()> {
        self.held_from = None;
        self.frames.retain(|frame| frame.time <= keep_until_time);
        self.write_collection()
    }

    fn write_collection(&self) -> io::Result<()> {
        let mut xml = String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" ");
        xml.push_str("byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <Collection>\n");
        for Frame { time, number } in &self.frames {
            for part in &self.parts {
                let (index, name, file) = (*part as usize, part.name(), part.file(*number));
                let place = format!("group=\"\" part=\"{index}\" name=\"{name}\" file=\"{file}\"");
                xml.push_str(&format!("    <DataSet timestep=\"{time:?}\" {place}/>\n"));
            }
        }
        xml.push_str("  </Collection>\n</VTKFile>\n");
        write_atomic(&self.directory.join("run.pvd"), xml.as_bytes())
    }
}

impl Frame {
    fn from_entry(entry: roxmltree::Node) -> Option<Self> {
        let number = entry.attribute("file")?.strip_prefix("frames/elements_")?.strip_suffix(".vtu")?;
        Some(Self { time: entry.attribute("timestep")?.parse().ok()?, number: number.parse().ok()? })
    }
}

/// The frames that a collection lists, by their elements.
fn listed_frames(text: &str) -> io::Result<Vec<Frame>> {
    let invalid = |message| io::Error::new(ErrorKind::InvalidData, message);
    let document = roxmltree::Document::parse(text).map_err(|error| invalid(error.to_string()))?;
    let is_elements = |node: &roxmltree::Node| node.has_tag_name("DataSet") && node.attribute("part") == Some("0");
    let frame = |node| Frame::from_entry(node).ok_or_else(|| invalid("an entry is not a frame of this run".to_owned()));
    document.descendants().filter(is_elements).map(frame).collect()
}

/// An unstructured grid whose cells have their own points, stored in the order of the cells.
struct Grid<'a> {
    time: f64,
    /// Meanings of numbers.
    names: Vec<Array<'a>>,
    points: Array<'a>,
    cell_type: u8,
    /// End of each cell in the points.
    offsets: Array<'a>,
    /// Number of points that the cells use.
    used: usize,
    point_data: Vec<Array<'a>>,
    cell_data: Vec<Array<'a>>,
}

impl Grid<'_> {
    fn write(&self, path: &Path) -> io::Result<()> {
        self.check().map_err(at_path(path))?;
        write_atomic_by(path, |file| self.xml(file))
    }

    /// Whether every array has an entry per point or per cell: VTK would read past the end of a shorter one.
    fn check(&self) -> io::Result<()> {
        let of_points = self.point_data.iter().map(|array| (array, self.points.count));
        let of_cells = self.cell_data.iter().map(|array| (array, self.offsets.count));
        let wrong = of_points.chain(of_cells).find(|(array, expected)| array.count != *expected);
        let message = match wrong {
            _ if self.used != self.points.count => format!("{} points, cells use {}", self.points.count, self.used),
            Some((array, expected)) => format!("{} entries of {}, expected {expected}", array.count, array.name),
            None => return Ok(()),
        };
        Err(io::Error::new(ErrorKind::InvalidInput, message))
    }

    fn xml(&self, file: &mut dyn Write) -> io::Result<()> {
        write!(file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" ")?;
        writeln!(file, "byte_order=\"LittleEndian\" header_type=\"UInt64\" ")?;
        writeln!(file, "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>")?;
        let time = Array::numbers("TimeValue", std::iter::once(self.time));
        section(file, "FieldData", &std::iter::once(&time).chain(&self.names).collect::<Vec<_>>())?;
        // An empty grid gets one cell without points, for meshio rejects a file without cells.
        let (points, is_empty) = (self.points.count, self.offsets.count == 0);
        let (cells, cell_type) = if is_empty { (1, POLY_VERTEX) } else { (self.offsets.count, self.cell_type) };
        writeln!(file, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">")?;
        section(file, "Points", &[&self.points])?;
        let connectivity = Array::integers("connectivity", 0..points);
        let no_offset = Array::integers("offsets", 0..1);
        let types = Array::bytes("types", std::iter::repeat_n(cell_type, cells));
        section(file, "Cells", &[&connectivity, if is_empty { &no_offset } else { &self.offsets }, &types])?;
        section(file, "PointData", &self.point_data.iter().collect::<Vec<_>>())?;
        let cell_data = self.cell_data.iter().filter(|_| !is_empty);
        section(file, "CellData", &cell_data.collect::<Vec<_>>())?;
        writeln!(file, "</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }
}

fn section(file: &mut dyn Write, name: &str, arrays: &[&Array]) -> io::Result<()> {
    writeln!(file, "<{name}>")?;
    arrays.iter().try_for_each(|array| array.xml(file))?;
    writeln!(file, "</{name}>")
}
