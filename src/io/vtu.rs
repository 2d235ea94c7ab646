//! Frames for ParaView: VTK unstructured grids and the collection that puts them on a time axis.
//!
//! Every array is inline base64 (`format="binary"`, uncompressed, little-endian, 64-bit header): the one encoding that
//! VTK, ParaView and meshio all read. Displacement jumps across joints, so elements share no points.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use resvg::usvg::roxmltree;

use super::files::{at_path, write_atomic};
use crate::contact::ContactState;
use crate::geometry::Vector;
use crate::model::Snapshot;
use crate::model::snapshot::JointPoint;

/// Cell types of VTK.
const VERTEX: u8 = 1;
const POLY_VERTEX: u8 = 2;
const POLYGON: u8 = 7;

/// Writes the elements of a snapshot: one polygon each, with its own points at their current place.
///
/// Point data: `displacement` (m), `velocity` (m/s), three components each. Cell data: `stress_xx`, `stress_yy`,
/// `stress_xy` (Pa, tension positive), `mean_stress` = (xx + yy)/2, `max_shear` = √(((xx − yy)/2)² + xy²) (both Pa, in
/// the plane), `block`, `rock`, and `plastic_strain` = √(⅔ εp:εp) where rock can yield. Field data: `TimeValue` (s).
///
/// # Errors
/// `InvalidInput` if a field does not have one entry per point or element; else what the file system refuses.
pub fn write_vtu(snapshot: &Snapshot, path: &Path) -> io::Result<()> {
    let elements = &snapshot.elements;
    let mean_stress = |[xx, yy, _]: [f64; 3]| 0.5 * (xx + yy);
    let max_shear = |[xx, yy, xy]: [f64; 3]| (0.5 * (xx - yy)).hypot(xy);
    let of_stress =
        |name, part: &dyn Fn([f64; 3]) -> f64| Array::numbers(name, snapshot.stress.iter().map(|&s| part(s)));
    let yielding = !snapshot.plastic_strain.is_empty();
    let plastic = yielding.then(|| Array::numbers("plastic_strain", snapshot.plastic_strain.iter().copied()));
    let mut grid = Grid {
        time: snapshot.time,
        points: Array::vectors("Points", &elements.points),
        cell_type: POLYGON,
        offsets: elements.start.iter().skip(1).map(|&end| i64::from(end)).collect(),
        point_data: vec![
            Array::vectors("displacement", &snapshot.displacement),
            Array::vectors("velocity", &snapshot.velocity),
        ],
        cell_data: vec![
            of_stress("stress_xx", &|stress| stress[0]),
            of_stress("stress_yy", &|stress| stress[1]),
            of_stress("stress_xy", &|stress| stress[2]),
            of_stress("mean_stress", &mean_stress),
            of_stress("max_shear", &max_shear),
            Array::ids("block", snapshot.block.iter().copied()),
            Array::ids("rock", snapshot.rock.iter().copied()),
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
        offsets: (1..=joints.len() as i64).collect(),
        point_data: vec![
            of_joint("normal_stress", |joint| joint.normal_stress),
            of_joint("shear_stress", |joint| joint.shear_stress),
            of_joint("length", |joint| joint.length),
            Array::vectors("normal", joints.iter().map(|joint| &joint.normal)),
            Array::bytes("state", joints.iter().map(|joint| state_code(joint.state))),
            Array::ids("law", joints.iter().map(|joint| joint.law)),
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
struct Grid {
    time: f64,
    points: Array,
    cell_type: u8,
    /// End of each cell in the points.
    offsets: Vec<i64>,
    point_data: Vec<Array>,
    cell_data: Vec<Array>,
}

impl Grid {
    fn write(&self, path: &Path) -> io::Result<()> {
        self.check().map_err(at_path(path))?;
        write_atomic(path, self.xml().as_bytes())
    }

    /// Whether every array has an entry per point or per cell: VTK would read past the end of a shorter one.
    fn check(&self) -> io::Result<()> {
        let last = self.offsets.last().copied().unwrap_or(0);
        let of_points = self.point_data.iter().map(|array| (array, self.points.len()));
        let of_cells = self.cell_data.iter().map(|array| (array, self.offsets.len()));
        let wrong = of_points.chain(of_cells).find(|(array, expected)| array.len() != *expected);
        let message = match wrong {
            _ if last != self.points.len() as i64 => format!("{} points, cells use {last}", self.points.len()),
            Some((array, expected)) => format!("{} entries of {}, expected {expected}", array.len(), array.name),
            None => return Ok(()),
        };
        Err(io::Error::new(ErrorKind::InvalidInput, message))
    }

    fn xml(&self) -> String {
        let mut xml = String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" ");
        xml.push_str("byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n");
        let time = Array::numbers("TimeValue", [self.time].into_iter());
        section(&mut xml, "FieldData", &[time]);
        let (offsets, types) = self.cells();
        let (points, cells) = (self.points.len(), types.len());
        // Writing to a string cannot fail.
        let _ = writeln!(xml, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">");
        section(&mut xml, "Points", std::slice::from_ref(&self.points));
        let connectivity = Array::integers("connectivity", 0..points as i64);
        let offsets = Array::integers("offsets", offsets.into_iter());
        section(&mut xml, "Cells", &[connectivity, offsets, Array::bytes("types", types.into_iter())]);
        section(&mut xml, "PointData", &self.point_data);
        section(&mut xml, "CellData", if self.offsets.is_empty() { &[] } else { &self.cell_data });
        xml.push_str("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
        xml
    }

    /// Offsets and types of the cells; an empty grid gets one cell without points, for meshio rejects a file without
    /// cells.
    fn cells(&self) -> (Vec<i64>, Vec<u8>) {
        if self.offsets.is_empty() {
            return (vec![0], vec![POLY_VERTEX]);
        }
        (self.offsets.clone(), vec![self.cell_type; self.offsets.len()])
    }
}

fn section(xml: &mut String, name: &str, arrays: &[Array]) {
    let _ = writeln!(xml, "<{name}>");
    for array in arrays {
        array.push_xml(xml);
    }
    let _ = writeln!(xml, "</{name}>");
}

/// A named array of VTK, its values as little-endian bytes.
struct Array {
    name: &'static str,
    kind: &'static str,
    size: usize,
    components: usize,
    bytes: Vec<u8>,
}

impl Array {
    fn new<const N: usize>(name: &'static str, kind: &'static str, values: impl Iterator<Item = [u8; N]>) -> Self {
        Self { name, kind, size: N, components: 1, bytes: values.flatten().collect() }
    }

    fn numbers(name: &'static str, values: impl Iterator<Item = f64>) -> Self {
        Self::new(name, "Float64", values.map(f64::to_le_bytes))
    }

    fn integers(name: &'static str, values: impl Iterator<Item = i64>) -> Self {
        Self::new(name, "Int64", values.map(i64::to_le_bytes))
    }

    fn ids(name: &'static str, values: impl Iterator<Item = u32>) -> Self {
        Self::integers(name, values.map(i64::from))
    }

    fn bytes(name: &'static str, values: impl Iterator<Item = u8>) -> Self {
        Self::new(name, "UInt8", values.map(|value| [value]))
    }

    /// Vectors of the plane; the third component is zero.
    fn vectors<'a>(name: &'static str, values: impl IntoIterator<Item = &'a Vector>) -> Self {
        let parts = values.into_iter().flat_map(|vector| [vector.x, vector.y, 0.0]);
        Self { components: 3, ..Self::numbers(name, parts) }
    }

    /// Number of entries.
    fn len(&self) -> usize {
        self.bytes.len() / (self.size * self.components)
    }

    fn push_xml(&self, xml: &mut String) {
        let _ = write!(xml, "<DataArray type=\"{}\" Name=\"{}\"", self.kind, self.name);
        if self.components > 1 {
            let _ = write!(xml, " NumberOfComponents=\"{}\"", self.components);
        }
        let _ = write!(xml, " NumberOfTuples=\"{}\" format=\"binary\">", self.len());
        let header = (self.bytes.len() as u64).to_le_bytes();
        push_base64(xml, header.iter().chain(&self.bytes).copied());
        xml.push_str("</DataArray>\n");
    }
}

/// Appends bytes in base64 (RFC 4648, padded).
fn push_base64(text: &mut String, bytes: impl Iterator<Item = u8>) {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = bytes.peekable();
    while bytes.peek().is_some() {
        let group = [bytes.next(), bytes.next(), bytes.next()];
        let bits = group.iter().fold(0, |bits, byte| bits << 8 | u32::from(byte.unwrap_or(0)));
        let digits = 1 + group.iter().flatten().count();
        for digit in 0..4 {
            let value = bits >> (18 - 6 * digit) & 63;
            text.push(if digit < digits { DIGITS[value as usize] as char } else { '=' });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4648, section 10.
    #[test]
    fn base64_matches_the_vectors_of_the_standard() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")]
        {
            let mut text = String::new();
            push_base64(&mut text, plain.bytes());
            assert_eq!(text, coded);
        }
    }
}
