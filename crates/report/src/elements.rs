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
    before: Option<[Series; 4]>,
}

/// Numbers in quanta, part by part.
#[derive(Debug, Clone)]
struct Series {
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
        let unit = size / PLACES;
        let mut bytes = Vec::new();
        let count = |of: fn(&Outline) -> usize| outlines.iter().map(of).sum::<usize>() as u32;
        bytes.extend(count(|block| block.mesh.elements.len()).to_le_bytes());
        bytes.extend(count(|block| block.mesh.points.len()).to_le_bytes());
        bytes.extend(unit.to_le_bytes());
        for block in outlines {
            [block.mesh.elements.len(), block.mesh.points.len()]
                .iter()
                .for_each(|&count| bytes.extend((count as u32).to_le_bytes()));
        }
        let mut ways: [Vec<u8>; 2] = Default::default();
        let mut last = [0_i64; 2];
        let (mut sides, mut rings, mut faces) = (Vec::new(), Vec::new(), Vec::new());
        for (k, block) in outlines.iter().enumerate() {
            let centroid = [0, 1].map(|axis| f64::from((block.centroid[axis] - origin[axis]) as f32));
            let corners = block.loops.iter().flatten();
            let mut own: Vec<[f64; 2]> =
                corners.map(|corner| [0, 1].map(|axis| f64::from((corner[axis] - origin[axis]) as f32))).collect();
            expect("edges of a block that may be joints", block.mesh.faces.len(), own.len())?;
            for point in &block.mesh.points {
                let mut place = [0.0; 2];
                for axis in [0, 1] {
                    finite(point[axis], 0.0, || format!("a point of an element of block {}", block.id))?;
                    let at = ((point[axis] - origin[axis]) / unit).round() as i64;
                    push_integer(at - last[axis], &mut ways[axis]);
                    last[axis] = at;
                    place[axis] = at as f64 * unit;
                }
                meshes.points.push((k, [0, 1].map(|axis| place[axis] - centroid[axis])));
                own.push(place);
            }
            let mut before = 0;
            for ring in &block.mesh.elements {
                expect(
                    "points of an element that its block has",
                    ring.iter().filter(|&&at| (at as usize) < own.len()).count(),
                    ring.len().max(3),
                )?;
                expect("points of an element", ring.len().min(255), ring.len())?;
                sides.push(ring.len() as u8);
                for &at in ring {
                    push_integer(i64::from(at) - before, &mut rings);
                    before = i64::from(at);
                }
                let mean = |axis: usize| ring.iter().map(|&at| own[at as usize][axis]).sum::<f64>() / ring.len() as f64;
                meshes.middles.push((k, [0, 1].map(|axis| mean(axis) - centroid[axis])));
            }
            faces.extend(block.mesh.faces.iter().map(|&faces| u8::from(faces)));
        }
        meshes.joints = faces.iter().filter(|&&faces| faces == 1).count();
        [&ways[0], &ways[1], &sides, &rings, &faces].iter().for_each(|part| bytes.extend_from_slice(part));
        Ok(Some((bytes, meshes)))
    }

    /// Forgets the numbers before: the next ones stand for themselves.
    pub fn forget(&mut self) {
        self.before = None;
    }

    /// Bytes of the numbers of elements and joints at a time (s), where blocks have the `numbers` that a reader has.
    ///
    /// # Errors
    /// A list of the wrong length, or the first number that is not finite.
    pub fn frame(&mut self, time: f64, elements: &Elements, numbers: &[Vec<f32>]) -> Result<Vec<u8>, FilmError> {
        expect("points of elements of a frame", elements.points.len(), self.points.len())?;
        expect("velocities of elements of a frame", elements.velocity.len(), self.middles.len())?;
        expect("stresses of elements of a frame", elements.stress.len(), self.middles.len())?;
        expect("joints of a frame", elements.joints.len(), self.joints)?;
        let all = elements.points.iter().chain(elements.velocity).chain(elements.joints).flatten();
        for &value in all.chain(elements.stress.iter().flatten()) {
            finite(value, time, || "displacement, velocity, stress, opening or slip of an element".to_owned())?;
        }
        let motion = self.motion_left(elements.points, numbers);
        let velocity = self.velocity_left(elements.velocity, numbers);
        let stress = self.stress_left(elements.stress, numbers);
        let scale = [usual(elements.points), usual(elements.velocity), usual(elements.stress)];
        let joints = self.joint_steps(elements.joints);
        let room = ((ROOM * self.middles.len() as f64) as usize).max(ROOM_LEAST);
        let [finest, coarsest] = HALVINGS;
        let (mut halvings, mut made) = (finest, Vec::new());
        while halvings >= coarsest {
            let below = |scale: f64, halvings: i32| scale * libm::exp2(-f64::from(halvings));
            let quanta = [
                below(scale[0][0], halvings - COARSER).min(self.size * QUANTUM_OF_SIZE).max(scale[0][1]),
                below(scale[1][0], halvings - COARSER).max(scale[1][1]),
                below(scale[2][0], halvings).max(scale[2][1]),
                1.0,
            ];
            let wanted = [&motion[..], &velocity, &stress, &joints];
            made =
                (0..4).map(|k| Series::next(self.before.as_ref().map(|all| &all[k]), wanted[k], quanta[k])).collect();
            if packed_length(&body(&made, self.before.is_some())) <= room {
                break;
            }
            halvings -= 1;
        }
        let bytes = body(&made, self.before.is_some());
        self.before = made.into_iter().map(|(series, _)| series).collect::<Vec<_>>().try_into().ok();
        Ok(bytes)
    }

    /// What the rigid motion of its block leaves of the displacement of each point (m), axis by axis.
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

    /// What the mean stress of its block leaves of the stress of each element (Pa).
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
    /// Numbers in quanta that are a power of two, at most `quantum` unless those before have such ones, and their bytes.
    /// A number that is within a quantum of what it was stays.
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
