//! Frames for ParaView: VTK unstructured grids and the collection that puts them on a time axis.
//!
//! Every array is inline base64 (`format="binary"`, uncompressed, little-endian, 64-bit header): the one encoding that
//! VTK, ParaView and meshio all read. Displacement jumps across joints, so elements share no points.

use std::fs;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use base64::prelude::BASE64_STANDARD;
use base64::write::EncoderWriter;
use enmm::contact::ContactState;
use enmm::geometry::Vector;
use enmm::model::Snapshot;
use enmm::model::snapshot::JointPoint;
use enmm_io::files::{at_path, write_atomic, write_atomic_by};

/// Bytes that become text together.
const PIECE: usize = 1 << 13;
/// Cell types of VTK.
const VERTEX: u8 = 1;
const POLY_VERTEX: u8 = 2;
const POLYGON: u8 = 7;

/// Writes the elements of a snapshot: one polygon each, with its own points at their current position.
///
/// Point data: `displacement` (m), `velocity` (m/s), three components each. Cell data: `stress_xx`, `stress_yy`,
/// `stress_xy` (Pa, tension positive), `mean_stress` = (xx + yy)/2, `max_shear` = √(((xx − yy)/2)² + xy²) (both Pa, in
/// the plane), `block`, `rock`, and `plastic_strain` = √(⅔ εp:εp) where rock can yield. Field data: `TimeValue` (s).
///
/// # Errors
/// `InvalidInput` if a field does not have one entry per point or element; else what the file system refuses.
pub fn write_vtu(snapshot: &Snapshot, path: &Path) -> io::Result<()> {
    let elements = &snapshot.elements;
    let of_stress =
        |name, part: fn([f64; 3]) -> f64| Array::numbers(name, snapshot.stress.iter().map(move |&s| part(s)));
    let yielding = !snapshot.plastic_strain.is_empty();
    let plastic = yielding.then(|| Array::numbers("plastic_strain", snapshot.plastic_strain.iter().copied()));
    let mut grid = Grid {
        time: snapshot.time,
        points: Array::vectors("Points", elements.points.iter()),
        cell_type: POLYGON,
        offsets: Array::ids("offsets", elements.start.get(1..).unwrap_or_default()),
        used: elements.start.last().map_or(0, |&end| end as usize),
        point_data: vec![
            Array::vectors("displacement", snapshot.displacement.iter()),
            Array::vectors("velocity", snapshot.velocity.iter()),
        ],
        cell_data: vec![
            of_stress("stress_xx", |[xx, _, _]| xx),
            of_stress("stress_yy", |[_, yy, _]| yy),
            of_stress("stress_xy", |[_, _, xy]| xy),
            of_stress("mean_stress", |[xx, yy, _]| 0.5 * (xx + yy)),
            of_stress("max_shear", |[xx, yy, xy]| (0.5 * (xx - yy)).hypot(xy)),
            Array::ids("block", &snapshot.block),
            Array::ids("rock", &snapshot.rock),
        ],
    };
    grid.cell_data.extend(plastic);
    grid.write(path)
}

/// Writes the joint points of a snapshot: one vertex each.
///
/// Point data: `normal_stress` (Pa, tension positive), `shear_stress` (Pa), `length` (m), `normal` (three components),
/// `state` (0 open, 1 slip, 2 lock), `law` (index of the joint law). Field data: `TimeValue` (s).
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_joints_vtu(snapshot: &Snapshot, path: &Path) -> io::Result<()> {
    let joints = &snapshot.joints;
    let of_joint = |name, part: fn(&JointPoint) -> f64| Array::numbers(name, joints.iter().map(part));
    let grid = Grid {
        time: snapshot.time,
        points: Array::vectors("Points", joints.iter().map(|joint| &joint.position)),
        cell_type: VERTEX,
        offsets: Array::integers("offsets", 1..joints.len() + 1),
        used: joints.len(),
        point_data: vec![
            of_joint("normal_stress", |joint| joint.normal_stress),
            of_joint("shear_stress", |joint| joint.shear_stress),
            of_joint("length", |joint| joint.length),
            Array::vectors("normal", joints.iter().map(|joint| &joint.normal)),
            Array::bytes("state", joints.iter().map(|joint| state_code(joint.state))),
            Array::integers("law", joints.iter().map(|joint| joint.law as usize)),
        ],
        cell_data: Vec::new(),
    };
    grid.write(path)
}

fn state_code(state: ContactState) -> u8 {
    match state {
        ContactState::Open => 0,
        ContactState::Slip => 1,
        ContactState::Lock => 2,
    }
}

/// Writes `run.pvd` and the frames that it lists into the directory of a run.
///
/// The collection is replaced in one move after each frame, so a killed run leaves a valid one.
#[derive(Debug)]
pub struct PvdWriter {
    directory: PathBuf,
    frames: Vec<Frame>,
}

/// A frame of the collection: its time (s) and its number in the file names.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    time: f64,
    number: usize,
}

impl PvdWriter {
    /// Starts the collection `directory/run.pvd` with no frame.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn new(directory: &Path) -> io::Result<Self> {
        let writer = Self { directory: directory.to_owned(), frames: Vec::new() };
        writer.write_collection()?;
        Ok(writer)
    }

    /// Continues the collection of an interrupted run: frames later than `keep_until_time` (s) leave the list, and
    /// their files are written over. A missing collection is started anew.
    ///
    /// # Errors
    /// `InvalidData` if `run.pvd` is not a collection that this type wrote; else what the file system refuses.
    pub fn open_for_append(directory: &Path, keep_until_time: f64) -> io::Result<Self> {
        let path = directory.join("run.pvd");
        let text = match fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Self::new(directory),
            read => read.map_err(at_path(&path))?,
        };
        let mut frames = listed_frames(&text).map_err(at_path(&path))?;
        frames.retain(|frame| frame.time <= keep_until_time);
        let writer = Self { directory: directory.to_owned(), frames };
        writer.write_collection()?;
        Ok(writer)
    }

    /// Writes `frames/elements_NNNN.vtu` and `frames/joints_NNNN.vtu` and lists them at the time of the snapshot.
    ///
    /// # Errors
    /// As [`write_vtu`] and [`write_joints_vtu`]; the collection then stays as it was.
    pub fn push(&mut self, snapshot: &Snapshot) -> io::Result<()> {
        let number = self.frames.last().map_or(0, |last| last.number + 1);
        let frame = Frame { time: snapshot.time, number };
        write_vtu(snapshot, &self.directory.join(frame.elements()))?;
        write_joints_vtu(snapshot, &self.directory.join(frame.joints()))?;
        self.frames.push(frame);
        self.write_collection()
    }

    fn write_collection(&self) -> io::Result<()> {
        let mut xml = String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" ");
        xml.push_str("byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <Collection>\n");
        for frame in &self.frames {
            for (part, file) in [frame.elements(), frame.joints()].iter().enumerate() {
                let time = frame.time;
                let line = format!("    <DataSet timestep=\"{time:?}\" group=\"\" part=\"{part}\" file=\"{file}\"/>\n");
                xml.push_str(&line);
            }
        }
        xml.push_str("  </Collection>\n</VTKFile>\n");
        write_atomic(&self.directory.join("run.pvd"), xml.as_bytes())
    }
}

impl Frame {
    fn elements(self) -> String {
        format!("frames/elements_{:04}.vtu", self.number)
    }

    fn joints(self) -> String {
        format!("frames/joints_{:04}.vtu", self.number)
    }

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
        writeln!(file, "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>")?;
        section(file, "FieldData", &[&Array::numbers("TimeValue", std::iter::once(self.time))])?;
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

/// Hands the values of an array over, as little-endian bytes.
type Values<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// A named array of VTK; its values are read when they are written, for a copy of all of them would be larger than the
/// model.
struct Array<'a> {
    name: &'static str,
    kind: &'static str,
    components: usize,
    /// Number of entries.
    count: usize,
    /// Size of an entry (bytes).
    size: usize,
    values: Values<'a>,
}

impl<'a> Array<'a> {
    fn new<const N: usize>(
        name: &'static str,
        kind: &'static str,
        values: impl ExactSizeIterator<Item = [u8; N]> + Clone + 'a,
    ) -> Self {
        let count = values.len();
        let each = move |text: &mut dyn Write| values.clone().try_for_each(|value| text.write_all(&value));
        Self { name, kind, components: 1, count, size: N, values: Box::new(each) }
    }

    fn numbers(name: &'static str, values: impl ExactSizeIterator<Item = f64> + Clone + 'a) -> Self {
        Self::new(name, "Float64", values.map(f64::to_le_bytes))
    }

    /// Counts and indices.
    fn integers(name: &'static str, values: impl ExactSizeIterator<Item = usize> + Clone + 'a) -> Self {
        Self::new(name, "Int64", values.map(|value| (value as i64).to_le_bytes()))
    }

    fn ids(name: &'static str, values: &'a [u32]) -> Self {
        Self::integers(name, values.iter().map(|&id| id as usize))
    }

    fn bytes(name: &'static str, values: impl ExactSizeIterator<Item = u8> + Clone + 'a) -> Self {
        Self::new(name, "UInt8", values.map(|value| [value]))
    }

    /// Vectors of the plane; the third component is zero.
    fn vectors(name: &'static str, values: impl ExactSizeIterator<Item = &'a Vector> + Clone + 'a) -> Self {
        let bytes = |vector: &Vector| {
            let mut bytes = [0; 24];
            bytes[..8].copy_from_slice(&vector.x.to_le_bytes());
            bytes[8..16].copy_from_slice(&vector.y.to_le_bytes());
            bytes
        };
        Self { components: 3, ..Self::new(name, "Float64", values.map(bytes)) }
    }

    fn xml(&self, file: &mut dyn Write) -> io::Result<()> {
        write!(file, "<DataArray type=\"{}\" Name=\"{}\"", self.kind, self.name)?;
        if self.components > 1 {
            write!(file, " NumberOfComponents=\"{}\"", self.components)?;
        }
        write!(file, " NumberOfTuples=\"{}\" format=\"binary\">", self.count)?;
        let mut text = BufWriter::with_capacity(PIECE, EncoderWriter::new(&mut *file, &BASE64_STANDARD));
        text.write_all(&((self.count * self.size) as u64).to_le_bytes())?;
        (self.values)(&mut text)?;
        text.into_inner()?.finish()?;
        writeln!(file, "</DataArray>")
    }
}
