//! Elements and joints of a film as bytes. `format.md` has the layout and the errors.
//!
//! Stress is noise to a compressor, and there are many elements. So their numbers are whole quanta: of what the rigid
//! motion and the mean stress of their block leave, and of that what has changed since the elements before.

use crate::chunk::packed_length;
use crate::data::{Elements, Outline};
use crate::error::{FilmError, expect, finite};
use crate::number::push_integer;

/// Bytes that the elements of a frame take for each of them, unless they would be coarser than the coarsest.
const ROOM: f64 = 1.5;
/// The same of all elements together, where they are few.
const ROOM_LEAST: usize = 4096;
/// Halvings of the usual greatest number down to the quantum, from the finest to the coarsest.
const HALVINGS: [i32; 2] = [10, 3];
/// Steps of the quantum of velocities and displacements above that of stresses, in halvings.
const COARSER: i32 = 1;
/// Numbers of a frame of which one is greater than what counts as usual.
const FEW: usize = 200;
/// Least quantum over the greatest number, so that a number fits into an integer.
const QUANTUM_LEAST: f64 = 1.0 / 1_048_576.0;
/// Greatest quantum of displacements over the size of the model.
const QUANTUM_OF_SIZE: f64 = 1.0 / 16_384.0;
/// Quanta of places over the size of the model.
const PLACES: f64 = 65_536.0;
/// Steps in which openings and slips double.
const STEPS: f64 = 16.0;
/// Opening or slip over the size of the model above which a step is a share of it, and below which it is a length.
const SMALL: f64 = 1.0 / 262_144.0;
/// Names of the numbers of blocks from which those of elements count.
const FROM: [&str; 6] =
    ["velocity_x", "velocity_y", "angular_velocity", "mean_stress_xx", "mean_stress_yy", "mean_stress_xy"];

/// The elements of outlines as a reader of the film has them, and their numbers of the frame before.
#[derive(Debug)]
pub struct Meshes {
    size: f64,
    /// Places of [`FROM`] in the numbers of a block.
    from: [usize; 6],
    /// Block of each point that is no corner, and its arm from the centroid of the block (m).
    points: Vec<(usize, [f64; 2])>,
    /// The same of the middle of each element.
    middles: Vec<(usize, [f64; 2])>,
    /// Edges of joints.
    joints: usize,
    before: Before,
}

/// Parts of the bytes of elements.
#[derive(Debug, Default)]
struct Planes {
    /// Quantum of places (m).
    unit: f64,
    /// Ways from each point to the next, in quanta.
    ways: [Vec<u8>; 2],
    /// Place of the last point in quanta.
    last: [i64; 2],
    sides: Vec<u8>,
    rings: Vec<u8>,
    faces: Vec<u8>,
}

impl Planes {
    /// Appends a place (m, from the origin); returns it as a reader has it.
    fn push_place(&mut self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let at = (place[axis] / self.unit).round() as i64;
            push_integer(at - self.last[axis], &mut self.ways[axis]);
            self.last[axis] = at;
            at as f64 * self.unit
        })
    }
}

/// Numbers of elements and joints of a frame, as a reader has them; none where the next stand for themselves.
pub type Before = Option<[Series; 4]>;

/// Numbers in quanta, part by part.
#[derive(Debug, Clone)]
pub struct Series {
    quantum: f64,
    parts: Vec<Vec<i32>>,
}

impl Meshes {
    /// Bytes of the elements of outlines around an origin with a size (m), and what frames need to know of them; none
    /// where no outline has elements. `numbers` are the names of the numbers of blocks.
    ///
    /// # Errors
    /// A place that is not finite, elements of points that are not there, or a film without the numbers of blocks from
    /// which those of elements count.
    pub fn of(
        outlines: &[Outline],
        numbers: &[String],
        origin: [f64; 2],
        size: f64,
    ) -> Result<Option<(Vec<u8>, Self)>, FilmError> {
        if outlines.iter().all(|block| block.mesh.elements.is_empty()) {
            return Ok(None);
        }
        let places = FROM.map(|name| numbers.iter().position(|number| number == name));
        expect("numbers of blocks for elements", places.iter().flatten().count(), FROM.len())?;
        let from = places.map(Option::unwrap_or_default);
        let mut meshes = Self { size, from, points: Vec::new(), middles: Vec::new(), joints: 0, before: None };
        let mut planes = Planes { unit: size / PLACES, ..Planes::default() };
        for (k, block) in outlines.iter().enumerate() {
            meshes.add(k, block, origin, &mut planes)?;
        }
        let mut bytes = Vec::new();
        let counts = outlines.iter().flat_map(|block| [block.mesh.elements.len(), block.mesh.points.len()]);
        [meshes.middles.len(), meshes.points.len()].iter().for_each(|&n| bytes.extend((n as u32).to_le_bytes()));
        bytes.extend(planes.unit.to_le_bytes());
        counts.for_each(|count| bytes.extend((count as u32).to_le_bytes()));
        let Planes { ways: [x, y], sides, rings, faces, .. } = planes;
        [x, y, sides, rings, faces].iter().for_each(|part| bytes.extend_from_slice(part));
        Ok(Some((bytes, meshes)))
    }

    /// Adds the elements of block `k`.
    fn add(&mut self, k: usize, block: &Outline, origin: [f64; 2], planes: &mut Planes) -> Result<(), FilmError> {
        let from_origin = |place: [f64; 2]| [0, 1].map(|axis| f64::from((place[axis] - origin[axis]) as f32));
        let centroid = from_origin(block.centroid);
        let arm = |place: [f64; 2]| (k, [0, 1].map(|axis| place[axis] - centroid[axis]));
        let mut places: Vec<[f64; 2]> = block.loops.iter().flatten().map(|&corner| from_origin(corner)).collect();
        expect("edges of a block that may be joints", block.mesh.faces.len(), places.len())?;
        for point in &block.mesh.points {
            point.iter().try_for_each(|&part| {
                finite(part, 0.0, || format!("a point of an element of block {}", block.id)).map(|_| ())
            })?;
            let place = planes.push_place([0, 1].map(|axis| point[axis] - origin[axis]));
            self.points.push(arm(place));
            places.push(place);
        }
        let mut before = 0;
        for ring in &block.mesh.elements {
            let there = ring.iter().filter(|&&at| (at as usize) < places.len()).count();
            expect("points of an element", there, ring.len().max(3))?;
            push_integer(ring.len() as i64, &mut planes.sides);
            for &at in ring {
                push_integer(i64::from(at) - before, &mut planes.rings);
                before = i64::from(at);
            }
            let mean = |axis: usize| ring.iter().map(|&at| places[at as usize][axis]).sum::<f64>() / ring.len() as f64;
            self.middles.push(arm([0, 1].map(mean)));
        }
        planes.faces.extend(block.mesh.faces.iter().map(|&faces| u8::from(faces)));
        self.joints += block.mesh.faces.iter().filter(|&&faces| faces).count();
        Ok(())
    }

    /// The numbers of the frame before, as [`Self::recall`] takes them.
    pub fn remembered(&self) -> Before {
        self.before.clone()
    }

    /// Takes the numbers of the frame before; without them the next ones stand for themselves.
    pub fn recall(&mut self, before: Before) {
        self.before = before;
    }

    /// Bytes of the numbers of elements and joints at a time (s), where blocks have the `numbers` that a reader has.
    ///
    /// # Errors
    /// A list of the wrong length, or the first number that is not finite.
    pub fn frame(&mut self, time: f64, elements: &Elements, numbers: &[Vec<f32>]) -> Result<Vec<u8>, FilmError> {
        self.check(time, elements)?;
        let (motion, velocity) =
            (self.motion_left(elements.points, numbers), self.velocity_left(elements.velocity, numbers));
        let (stress, joints) = (self.stress_left(elements.stress, numbers), self.joint_steps(elements.joints));
        let left = [&motion[..], &velocity, &stress, &joints];
        let scales = [usual(elements.points), usual(elements.velocity), usual(elements.stress)];
        let room = ((ROOM * self.middles.len() as f64) as usize).max(ROOM_LEAST);
        let [finest, coarsest] = HALVINGS;
        let mut halvings = finest;
        loop {
            let quanta = self.quanta(scales, halvings);
            let before = |k: usize| self.before.as_ref().map(|all| &all[k]);
            let made = [0, 1, 2, 3].map(|k| Series::next(before(k), left[k], quanta[k]));
            let bytes = body(&made, self.before.is_some());
            if halvings == coarsest || packed_length(&bytes) <= room {
                self.before = Some(made.map(|(series, _)| series));
                return Ok(bytes);
            }
            halvings -= 1;
        }
    }

    /// Quanta of displacements (m), velocities (m/s) and stresses (Pa), so many halvings below their usual greatest
    /// number, and that of the steps of joints.
    fn quanta(&self, scales: [[f64; 2]; 3], halvings: i32) -> [f64; 4] {
        let below = |k: usize, halvings: i32| {
            let [usual, least] = scales[k];
            (usual * libm::exp2(-f64::from(halvings))).max(least)
        };
        let coarser = halvings - COARSER;
        [below(0, coarser).min(self.size * QUANTUM_OF_SIZE), below(1, coarser), below(2, halvings), 1.0]
    }

    fn check(&self, time: f64, elements: &Elements) -> Result<(), FilmError> {
        expect("points of elements of a frame", elements.points.len(), self.points.len())?;
        expect("velocities of elements of a frame", elements.velocity.len(), self.middles.len())?;
        expect("stresses of elements of a frame", elements.stress.len(), self.middles.len())?;
        expect("joints of a frame", elements.joints.len(), self.joints)?;
        let moved = elements.points.iter().chain(elements.velocity).chain(elements.joints).flatten();
        for &value in moved.chain(elements.stress.iter().flatten()) {
            finite(value, time, || "displacement, velocity or stress of an element, or opening or slip".to_owned())?;
        }
        Ok(())
    }

    /// The part of the displacement of each point (m) that the rigid motion of its block leaves, axis by axis.
    fn motion_left(&self, points: &[[f64; 2]], numbers: &[Vec<f32>]) -> [Vec<f64>; 2] {
        let left = |(&(block, [a, b]), moved): (&(usize, [f64; 2]), &[f64; 2])| {
            let [x, y, turn] = [0, 1, 2].map(|k| f64::from(numbers[k][block]));
            let (sine, cosine) = libm::sincos(turn);
            [moved[0] - x - a * (cosine - 1.0) + b * sine, moved[1] - y - a * sine - b * (cosine - 1.0)]
        };
        split(self.points.iter().zip(points).map(left))
    }

    /// The same of the velocity of each element (m/s).
    fn velocity_left(&self, velocity: &[[f64; 2]], numbers: &[Vec<f32>]) -> [Vec<f64>; 2] {
        let left = |(&(block, [a, b]), moves): (&(usize, [f64; 2]), &[f64; 2])| {
            let of = |k: usize| f64::from(numbers[k][block]);
            let (sine, cosine) = libm::sincos(of(2));
            let [x, y, spin] = [0, 1, 2].map(|k| of(self.from[k]));
            [moves[0] - x + spin * (a * sine + b * cosine), moves[1] - y - spin * (a * cosine - b * sine)]
        };
        split(self.middles.iter().zip(velocity).map(left))
    }

    /// The part of the stress of each element (Pa) that the mean stress of its block leaves.
    fn stress_left(&self, stress: &[[f64; 3]], numbers: &[Vec<f32>]) -> [Vec<f64>; 3] {
        let left = |(&(block, _), stress): (&(usize, [f64; 2]), &[f64; 3])| {
            [0, 1, 2].map(|k| stress[k] - f64::from(numbers[self.from[3 + k]][block]))
        };
        split(self.middles.iter().zip(stress).map(left))
    }

    /// Openings and slips in steps that are shares of them, and lengths where they are small.
    fn joint_steps(&self, joints: &[[f64; 2]]) -> [Vec<f64>; 2] {
        let small = self.size * SMALL;
        let steps = |value: f64| (STEPS * libm::log2(1.0 + value.abs() / small)).copysign(value);
        split(joints.iter().map(|joint| joint.map(steps)))
    }
}

/// Parts of numbers, each by itself.
fn split<const N: usize>(numbers: impl Iterator<Item = [f64; N]>) -> [Vec<f64>; N] {
    let mut parts = std::array::from_fn(|_| Vec::with_capacity(numbers.size_hint().0));
    numbers.for_each(|number| parts.iter_mut().zip(number).for_each(|(part, value)| part.push(value)));
    parts
}

/// The magnitude that few of all numbers exceed, and the least quantum of them.
fn usual<const N: usize>(numbers: &[[f64; N]]) -> [f64; 2] {
    let mut sizes: Vec<f64> = numbers.iter().flatten().map(|value| value.abs()).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    if most == 0.0 {
        return [1.0, 1.0];
    }
    let place = sizes.len() - 1 - sizes.len() / FEW;
    let (_, usual, _) = sizes.select_nth_unstable_by(place, f64::total_cmp);
    [*usual, (most * QUANTUM_LEAST).max(f64::MIN_POSITIVE)]
}

impl Series {
    /// Numbers in quanta that are a power of two, at most `quantum`, and their bytes. A number that is within a quantum
    /// of what it was stays.
    fn next(before: Option<&Self>, wanted: &[Vec<f64>], quantum: f64) -> (Self, Vec<u8>) {
        let ideal = libm::exp2(libm::log2(quantum).floor());
        let kept = before.map(|before| before.quantum).filter(|kept| [ideal, 0.5 * ideal].contains(kept));
        let quantum = kept.unwrap_or(ideal);
        let mut bytes = quantum.to_le_bytes().to_vec();
        let part = |(k, numbers): (usize, &Vec<f64>)| {
            let then = before.map(|before| (&before.parts[k], before.quantum / quantum));
            let number = |(at, number): (usize, &f64)| {
                let known = then.map_or(0, |(parts, ratio)| (f64::from(parts[at]) * ratio + 0.5).floor() as i64);
                let wanted = number / quantum;
                let now = if (wanted - known as f64).abs() <= 1.0 { known } else { (wanted + 0.5).floor() as i64 };
                push_integer(now - known, &mut bytes);
                now as i32
            };
            numbers.iter().enumerate().map(number).collect()
        };
        let parts = wanted.iter().enumerate().map(part).collect();
        (Self { quantum, parts }, bytes)
    }
}

/// Series one after the other, behind a word that says whether they are changes.
fn body(made: &[(Series, Vec<u8>)], are_changes: bool) -> Vec<u8> {
    let mut bytes = vec![u8::from(are_changes)];
    made.iter().for_each(|(_, series)| bytes.extend_from_slice(series));
    bytes
}
