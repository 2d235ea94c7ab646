//! Outlines and frames as bytes. `format.md` has the layout and the errors.
//!
//! A stiff block hardly deforms, so a frame holds the rigid motion of every block, in single precision, and of each
//! corner only what the rigid motion leaves, in whole quanta: mostly zeros, which take no room.

use crate::data::{Frame, Head, Outline};
use crate::elements::Meshes;
use crate::error::{FilmError, expect, finite};
use crate::number::{Width, push_integer, push_planes};
use crate::structures::push_structures;

/// Largest quantum over the size of the model: a corner is drawn at most half of it away from where it is.
pub const QUANTUM: f64 = 1.0 / 131_072.0;
/// Largest quantum over the largest displacement of a corner in the frame.
const QUANTUM_OF_MOTION: f64 = 1.0 / 512.0;
/// Bit of the state of an edge on which the water presses.
const WET: u8 = 8;
/// The first numbers of a block: its rigid motion.
pub const MOTION: [&str; 3] = ["displacement_x", "displacement_y", "rotation"];
/// Numbers of a block, the first ones, with all four bytes: the displacement.
const FULL: usize = 2;
/// Smallest quantum over the size of the model: below, single precision of the reference ends.
const QUANTUM_LEAST: f64 = 1e-12;

/// Corners and centroids of all blocks as a reader of the film has them.
#[derive(Debug)]
pub struct Shape {
    /// Middle of the box round all corners (m).
    origin: [f64; 2],
    /// Greater side of that box (m).
    size: f64,
    /// Corner behind the last of each block.
    ends: Vec<usize>,
    /// Arm from the centroid of its block to each corner (m).
    arms: Vec<[f64; 2]>,
    /// Names of the numbers of a block.
    numbers: Vec<String>,
    /// Elements of the blocks, if the film has them.
    pub mesh: Option<Meshes>,
}

/// Bytes of a frame, and the numbers of all blocks as a reader will have them.
pub type Framed = (Vec<u8>, Vec<Vec<f32>>);

/// Bytes of outlines, and of the elements in them if there are any.
#[derive(Debug)]
pub struct Outlined {
    /// Those of the blocks.
    pub blocks: Vec<u8>,
    /// Those of the elements.
    pub mesh: Option<Vec<u8>>,
}

/// Bytes of the outlines, and what frames need to know of them.
///
/// # Errors
/// The first number that is not finite, with its block.
pub fn outlines(head: &Head, outlines: &[Outline]) -> Result<(Outlined, Shape), FilmError> {
    let numbers: Vec<String> = head.block_numbers.iter().map(|number| number.name.clone()).collect();
    expect(
        "numbers of the motion of a block",
        numbers.iter().zip(MOTION).filter(|(a, b)| a == b).count(),
        MOTION.len(),
    )?;
    shape_of(numbers, outlines)
}

/// The same of a film whose blocks have these numbers.
fn shape_of(numbers: Vec<String>, outlines: &[Outline]) -> Result<(Outlined, Shape), FilmError> {
    let points = || outlines.iter().flat_map(|block| block.loops.iter().flatten());
    for block in outlines {
        let numbers = [block.area, block.mass].into_iter().chain(block.centroid);
        let all = numbers.chain(block.loops.iter().flatten().copied().flatten());
        for value in all {
            finite(value, 0.0, || format!("area, mass, centroid or corner of block {}", block.id))?;
        }
    }
    let (low, high) = bounds(points());
    let origin = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    let mut bytes = Vec::new();
    [outlines.len(), points().count()].iter().for_each(|&n| bytes.extend((n as u32).to_le_bytes()));
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    [origin[0], origin[1], size].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    for block in outlines {
        bytes.extend(block.id.to_le_bytes());
        bytes.extend([u8::from(block.fixed), 0]);
        bytes.extend(block.rock.to_le_bytes());
        [block.area, block.mass].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend((block.loops.len() as u32).to_le_bytes());
        block.loops.iter().for_each(|points| bytes.extend((points.len() as u32).to_le_bytes()));
    }
    let (mesh, mesh_bytes) =
        Meshes::of(outlines, &numbers, origin, size)?.map_or((None, None), |(a, b)| (Some(b), Some(a)));
    let mut shape = Shape { origin, size, ends: Vec::new(), arms: Vec::new(), numbers, mesh };
    shape.push_places(outlines, &mut bytes);
    Ok((Outlined { blocks: bytes, mesh: mesh_bytes }, shape))
}

fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> ([f64; 2], [f64; 2]) {
    let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let (low, high) = points
        .fold(start, |(low, high), p| ([low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]));
    if low[0] <= high[0] { (low, high) } else { ([0.0; 2], [0.0; 2]) }
}

impl Shape {
    /// Bytes and shape of other outlines of the same film.
    ///
    /// # Errors
    /// As [`outlines`].
    pub fn changed(&self, outlines: &[Outline]) -> Result<(Outlined, Self), FilmError> {
        shape_of(self.numbers.clone(), outlines)
    }

    /// Appends centroids and corners relative to the origin in single precision.
    fn push_places(&mut self, outlines: &[Outline], bytes: &mut Vec<u8>) {
        let origin = self.origin;
        let near = |place: [f64; 2]| [(place[0] - origin[0]) as f32, (place[1] - origin[1]) as f32];
        let (mut centroids, mut corners) = (Vec::new(), Vec::new());
        for block in outlines {
            let centroid = near(block.centroid);
            centroids.push(centroid);
            for corner in block.loops.iter().flatten().map(|&corner| near(corner)) {
                corners.push(corner);
                self.arms.push([0, 1].map(|axis| f64::from(corner[axis]) - f64::from(centroid[axis])));
            }
            self.ends.push(self.arms.len());
        }
        for places in [centroids, corners] {
            for axis in [0, 1] {
                let numbers: Vec<f32> = places.iter().map(|place| place[axis]).collect();
                push_planes(&numbers, Width::Full, bytes);
            }
        }
    }

    /// Bytes of a frame of a film with so many monitors and bolts; with its supports when they are `wanted`.
    ///
    /// # Errors
    /// A list of the wrong length, or the first number that is not finite, with its block and the time.
    pub fn frame(&self, frame: &Frame, [monitors, bolts]: [usize; 2], wanted: bool) -> Result<Framed, FilmError> {
        let corners = self.arms.len();
        expect("blocks of a frame", frame.blocks.len(), self.ends.len())?;
        expect("corners of a frame", frame.corners.len(), corners)?;
        expect("edges of a frame", frame.edges.len(), if frame.edges.is_empty() { 0 } else { corners })?;
        expect("monitors of a frame", frame.monitors.len(), monitors)?;
        expect("bolts of a frame", frame.structures.bolts.len(), bolts)?;
        let wet = frame.structures.wet;
        expect("wet edges of a frame", wet.len(), if wet.is_empty() { 0 } else { frame.edges.len() })?;
        finite(frame.time, frame.time, || "the time of a frame".to_owned())?;
        let quantum = self.quantum(frame)?;
        let mut bytes = Vec::with_capacity(32 * frame.blocks.len() + 3 * corners);
        bytes.extend(frame.stage.to_le_bytes());
        bytes.extend([u8::from(!frame.edges.is_empty()), u8::from(wanted), 0, 0]);
        bytes.extend(quantum.to_le_bytes());
        bytes.extend(frame.blocks.iter().map(|block| u8::from(block.removed)));
        let is_wet = |corner: usize| wet.get(corner).copied().unwrap_or_default();
        let edges = frame.edges.iter().enumerate();
        bytes.extend(edges.map(|(corner, &state)| state as u8 | if is_wet(corner) { WET } else { 0 }));
        let numbers = self.push_numbers(frame, &mut bytes)?;
        push_monitors(frame, &mut bytes)?;
        self.push_corners(frame, &numbers, quantum, &mut bytes);
        push_structures(&frame.structures, frame.time, self.origin, wanted, &mut bytes)?;
        Ok((bytes, numbers))
    }

    /// The largest power of two that is fine enough for the model and for the motion (m).
    fn quantum(&self, frame: &Frame) -> Result<f64, FilmError> {
        let mut most = 0.0_f64;
        for (corner, displacement) in frame.corners.iter().enumerate() {
            for &part in displacement {
                let block = || self.ends.partition_point(|&end| end <= corner);
                finite(part, frame.time, || format!("displacement of corner {corner}, in block {}", block()))?;
                most = most.max(part.abs());
            }
        }
        let wanted = if most > 0.0 { most * QUANTUM_OF_MOTION } else { f64::INFINITY };
        let least = (self.size * QUANTUM_LEAST).max(f64::MIN_POSITIVE);
        Ok(libm::exp2(libm::log2(wanted.min(self.size * QUANTUM).max(least)).floor()))
    }

    /// Appends the numbers of all blocks; returns each as a reader will have it.
    fn push_numbers(&self, frame: &Frame, bytes: &mut Vec<u8>) -> Result<Vec<Vec<f32>>, FilmError> {
        for block in frame.blocks {
            expect("numbers of a block", block.numbers.len(), self.numbers.len())?;
        }
        let mut kept = Vec::with_capacity(self.numbers.len());
        for (k, name) in self.numbers.iter().enumerate() {
            let width = if k < FULL { Width::Full } else { Width::Short };
            let mut numbers = Vec::with_capacity(frame.blocks.len());
            for (id, block) in frame.blocks.iter().enumerate() {
                numbers.push(finite(block.numbers[k], frame.time, || format!("{name} of block {id}"))?);
            }
            push_planes(&numbers, width, bytes);
            kept.push(numbers.into_iter().map(|number| width.kept(number)).collect());
        }
        Ok(kept)
    }

    /// Appends what the rigid motion of its block leaves of each corner's displacement, in quanta.
    fn push_corners(&self, frame: &Frame, numbers: &[Vec<f32>], quantum: f64, bytes: &mut Vec<u8>) {
        let mut rest: [Vec<u8>; 2] = [Vec::new(), Vec::new()];
        let mut corner = 0;
        for (block, &end) in self.ends.iter().enumerate() {
            let [x, y, turn] = [0, 1, 2].map(|k| numbers[k][block]);
            let (sine, cosine) = libm::sincos(f64::from(turn));
            while corner < end {
                let [a, b] = self.arms[corner];
                let rigid =
                    [f64::from(x) + a * (cosine - 1.0) - b * sine, f64::from(y) + a * sine + b * (cosine - 1.0)];
                for axis in [0, 1] {
                    let left = frame.corners[corner][axis] - rigid[axis];
                    push_integer((left / quantum).round() as i64, &mut rest[axis]);
                }
                corner += 1;
            }
        }
        rest.iter().for_each(|numbers| bytes.extend(numbers));
    }
}

fn push_monitors(frame: &Frame, bytes: &mut Vec<u8>) -> Result<(), FilmError> {
    for (k, monitor) in frame.monitors.iter().enumerate() {
        for value in monitor.displacement.into_iter().chain(monitor.velocity) {
            let number = finite(value, frame.time, || format!("displacement or velocity of monitor {k}"))?;
            bytes.extend(number.to_le_bytes());
        }
    }
    Ok(())
}
