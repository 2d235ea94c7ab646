//! Frames of the film of a run, by what `crates/report/format.md` says of its bytes.

use std::path::{Path, PathBuf};

use enmm_io::files::open_result;
use miniz_oxide::inflate::decompress_to_vec_zlib;
use serde_json::Value;

use crate::bytes::Bytes;
use crate::error::ExportError;

/// First bytes of a film of this version, and bytes before the body of a chunk.
const MAGIC: [u8; 8] = *b"enmmfil6";
const HEADER: usize = 16;
/// Numbers of a block: the first have all four bytes, and the first three are its rigid motion.
const FULL: usize = 2;
const MOTION: usize = 3;
/// Bits of a support: held along x, along y.
const ALONG: [u8; 2] = [1, 2];

/// A block in the reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Number that the user sees.
    pub id: u32,
    /// Whether it is held.
    pub fixed: bool,
    /// Index of its rock.
    pub rock: usize,
    /// Area (m²) and mass (kg/m).
    pub size: [f64; 2],
    /// Centroid (m).
    pub centroid: [f64; 2],
    /// Corners of each loop (m), the outer one first.
    pub loops: Vec<Vec<[f64; 2]>>,
}

/// A block of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Moved {
    /// Whether it has been excavated.
    pub removed: bool,
    /// Its numbers, displacement and rotation first.
    pub numbers: Vec<f64>,
    /// Corners of each loop now (m).
    pub loops: Vec<Vec<[f64; 2]>>,
}

/// A free length of a bolt in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bolt {
    /// 0 not there, 1 holds, 2 has yielded, 3 broken.
    pub condition: u8,
    /// Displacement of both ends (m).
    pub displacement: [[f64; 2]; 2],
    /// Tension (N per metre of depth).
    pub force: f64,
}

/// A supported point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Where (m).
    pub place: [f64; 2],
    /// Whether it is held along x and along y.
    pub axes: [bool; 2],
}

/// A frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number of the stage, from 0.
    pub stage: u32,
    /// All blocks, as the outlines.
    pub blocks: Vec<Moved>,
    /// All free lengths of bolts.
    pub bolts: Vec<Bolt>,
    /// Supports, in the first frame of a stage.
    pub supports: Option<Vec<Support>>,
    /// Surface of the water from left to right (m), level beyond.
    pub water: Vec<[f64; 2]>,
}

/// Blocks before they move, and the origin of places (m).
#[derive(Debug)]
pub struct Outlines {
    /// All blocks.
    pub blocks: Vec<Outline>,
    origin: [f64; 2],
    /// Corners of all blocks.
    corners: usize,
}

/// A film.
#[derive(Debug)]
pub struct Film {
    path: PathBuf,
    /// Its head: title, rocks, bolts, names of numbers.
    pub head: Value,
    outlines: Vec<Outlines>,
    /// Place on the axis, number of the outlines, packed bytes.
    frames: Vec<(f64, usize, Vec<u8>)>,
    /// Names of the numbers of blocks.
    numbers: usize,
}

impl Film {
    /// Reads a film; what a killed program leaves of a last chunk is passed over.
    ///
    /// # Errors
    /// It is no film of this version, or damaged, or what the file system refuses.
    pub fn read(path: &Path) -> Result<Self, ExportError> {
        let unreadable = |message: String| ExportError::unreadable(path, message);
        let mut all = Vec::new();
        let read = open_result(path).and_then(|mut file| std::io::Read::read_to_end(&mut file, &mut all));
        read.map_err(|error| unreadable(error.to_string()))?;
        let mut rest = all.strip_prefix(&MAGIC[..]).ok_or_else(|| unreadable(NO_FILM.to_owned()))?;
        let mut film =
            Self { path: path.to_owned(), head: Value::Null, outlines: Vec::new(), frames: Vec::new(), numbers: 0 };
        while let Some((kind, time, body)) = chunk(&mut rest) {
            film.take(kind, time, body).ok_or_else(|| unreadable(DAMAGED.to_owned()))?;
        }
        if film.frames.is_empty() {
            return Err(unreadable("the film has no frame".to_owned()));
        }
        Ok(film)
    }

    fn take(&mut self, kind: &[u8], time: f64, body: &[u8]) -> Option<()> {
        match kind {
            b"HEAD" => {
                self.head = serde_json::from_slice(&decompress_to_vec_zlib(body).ok()?).ok()?;
                self.numbers = self.head["block_numbers"].as_array()?.len();
            }
            b"OUTL" => self.outlines.push(outlines(&decompress_to_vec_zlib(body).ok()?)?),
            b"FRAM" => self.frames.push((time, self.outlines.len().checked_sub(1)?, body.to_owned())),
            b"MESH" | b"ELEM" | b"ROWS" | b"NOTE" => {}
            _ => return None,
        }
        Some(())
    }

    /// Places of the frames on the axis of the film: times (s) of a run.
    pub fn times(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.frames.iter().map(|(time, ..)| *time)
    }

    /// Names and units of the numbers of blocks.
    pub fn numbers(&self) -> Vec<[String; 2]> {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let all = self.head["block_numbers"].as_array().into_iter().flatten();
        all.map(|number| [text(&number["name"]), text(&number["unit"])]).collect()
    }

    /// Blocks of a frame before they moved.
    pub fn outlines(&self, frame: usize) -> &[Outline] {
        self.frames.get(frame).map_or(&[], |(_, outlines, _)| &self.outlines[*outlines].blocks)
    }

    /// A frame, with the supports of its stage.
    ///
    /// # Errors
    /// The film is damaged.
    pub fn frame(&self, number: usize) -> Result<Frame, ExportError> {
        let damaged = || ExportError::unreadable(&self.path, DAMAGED);
        let mut frame = self.decode(number).ok_or_else(damaged)?;
        let mut before = number;
        while frame.supports.is_none() && before > 0 {
            before -= 1;
            frame.supports = self.decode(before).ok_or_else(damaged)?.supports;
        }
        Ok(frame)
    }

    fn decode(&self, number: usize) -> Option<Frame> {
        let (_, outlines, body) = self.frames.get(number)?;
        let outlines = self.outlines.get(*outlines)?;
        let body = decompress_to_vec_zlib(body).ok()?;
        let mut bytes = Bytes(&body);
        let stage = bytes.u32()?;
        let [has_edges, has_supports, ..] = *bytes.take(4)? else { return None };
        let quantum = bytes.f64()?;
        let removed = bytes.take(outlines.blocks.len())?;
        bytes.take(if has_edges > 0 { outlines.corners } else { 0 })?;
        let width = |k: usize| if k < FULL { 4 } else { 3 };
        let planes = (0..self.numbers).map(|k| bytes.planes(outlines.blocks.len(), width(k)));
        let numbers = planes.collect::<Option<Vec<_>>>()?;
        let monitors = self.head["monitors"].as_array().map_or(0, Vec::len);
        bytes.take(16 * monitors)?;
        let mut rest = [Vec::new(), Vec::new()];
        for axis in &mut rest {
            *axis = (0..outlines.corners).map(|_| bytes.integer()).collect::<Option<_>>()?;
        }
        let rest = rest.map(|axis| axis.into_iter().map(|quanta| quanta as f64 * quantum).collect::<Vec<f64>>());
        let bolts = bolts(&mut bytes, self.head["bolts"].as_array().map_or(0, Vec::len))?;
        let supports = if has_supports > 0 { Some(supports(&mut bytes, outlines.origin)?) } else { None };
        bytes.f64()?;
        let points = bytes.u32()? as usize;
        let water = bytes.places(points, 4, outlines.origin)?;
        let blocks = moved(outlines, removed, &numbers, &rest)?;
        Some(Frame { stage, blocks, bolts, supports, water })
    }
}

const NO_FILM: &str = "is no film of this version of enmm";
const DAMAGED: &str = "the film is damaged";

/// The next whole chunk: kind, time and body.
fn chunk<'a>(rest: &mut &'a [u8]) -> Option<(&'a [u8], f64, &'a [u8])> {
    let mut bytes = Bytes(rest);
    let (kind, length, time) = (bytes.take(4)?, bytes.u32()? as usize, bytes.f64()?);
    let body = bytes.take(length)?;
    *rest = rest.get(HEADER + length..)?;
    Some((kind, time, body))
}

fn outlines(body: &[u8]) -> Option<Outlines> {
    let mut bytes = Bytes(body);
    let (blocks, corners) = (bytes.u32()? as usize, bytes.u32()? as usize);
    let origin = [bytes.f64()?, bytes.f64()?];
    bytes.f64()?;
    let mut found = Vec::new();
    let mut counts = Vec::new();
    for _ in 0..blocks {
        let id = bytes.u32()?;
        let [fixed, _] = *bytes.take(2)? else { return None };
        let rock = u16::from_le_bytes(bytes.take(2)?.try_into().ok()?).into();
        let size = [bytes.f64()?, bytes.f64()?];
        let loops = bytes.u32()?;
        counts.push((0..loops).map(|_| bytes.u32()).collect::<Option<Vec<u32>>>()?);
        found.push(Outline { id, fixed: fixed > 0, rock, size, centroid: [0.0; 2], loops: Vec::new() });
    }
    let centroids = bytes.places(blocks, 4, origin)?;
    let mut places = bytes.places(corners, 4, origin)?.into_iter();
    for ((block, counts), centroid) in found.iter_mut().zip(counts).zip(centroids) {
        block.centroid = centroid;
        block.loops = counts.iter().map(|&count| places.by_ref().take(count as usize).collect()).collect();
    }
    Some(Outlines { blocks: found, origin, corners })
}

/// Blocks with their numbers and corners now.
fn moved(outlines: &Outlines, removed: &[u8], numbers: &[Vec<f64>], rest: &[Vec<f64>; 2]) -> Option<Vec<Moved>> {
    if numbers.len() < MOTION {
        return None;
    }
    let mut corner = 0;
    let block = |(k, block): (usize, &Outline)| {
        let (turn, shift) = (numbers[2][k], [numbers[0][k], numbers[1][k]]);
        let (sine, less) = (libm::sin(turn), libm::cos(turn) - 1.0);
        let mut place = |at: &[f64; 2]| {
            let [a, b] = [0, 1].map(|axis| at[axis] - block.centroid[axis]);
            let rigid = [shift[0] + a * less - b * sine, shift[1] + a * sine + b * less];
            corner += 1;
            [0, 1].map(|axis| at[axis] + rigid[axis] + rest[axis][corner - 1])
        };
        let loops = block.loops.iter().map(|points| points.iter().map(&mut place).collect()).collect();
        Moved { removed: removed[k] > 0, numbers: numbers.iter().map(|all| all[k]).collect(), loops }
    };
    Some(outlines.blocks.iter().enumerate().map(block).collect())
}

fn bolts(bytes: &mut Bytes, count: usize) -> Option<Vec<Bolt>> {
    let conditions = bytes.take(count)?;
    let ends = [(); 4].map(|()| bytes.planes(count, 4));
    let [Some(head_x), Some(head_y), Some(end_x), Some(end_y)] = ends else { return None };
    let force = bytes.planes(count, 3)?;
    let bolt = |k: usize| Bolt {
        condition: conditions[k],
        displacement: [[head_x[k], head_y[k]], [end_x[k], end_y[k]]],
        force: force[k],
    };
    Some((0..count).map(bolt).collect())
}

fn supports(bytes: &mut Bytes, origin: [f64; 2]) -> Option<Vec<Support>> {
    let count = bytes.u32()? as usize;
    let bits = bytes.take(count)?;
    let places = bytes.places(count, 3, origin)?;
    let support = |(&bits, place): (&u8, [f64; 2])| Support { place, axes: ALONG.map(|bit| bits & bit > 0) };
    Some(bits.iter().zip(places).map(support).collect())
}
