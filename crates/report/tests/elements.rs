//! Elements and joints of a film come back within the errors that it claims, and in the room that it has.

use std::path::Path;

use crate::support::{Dice, Moment, Reader, Slope, chunks, head};
use enmm_report::{Elements, FilmError, FilmWriter, Mesh};
use tempfile::tempdir;

/// Corners of a block of the synthetic slope.
const CORNERS: usize = 12;

/// Each block as a fan of triangles about its centroid; its first three edges are faces of joints.
fn fans(across: usize, up: usize) -> Slope {
    let mut slope = Slope::new(across, up);
    for block in &mut slope.outlines {
        let corners = CORNERS as u32;
        block.mesh = Mesh {
            points: vec![block.centroid],
            elements: (0..corners).map(|k| vec![k, (k + 1) % corners, corners]).collect(),
            faces: (0..CORNERS).map(|k| k < 3).collect(),
        };
    }
    slope
}

/// Numbers of elements, owned.
#[derive(Clone)]
struct Numbers {
    points: Vec<[f64; 2]>,
    velocity: Vec<[f64; 2]>,
    stress: Vec<[f64; 3]>,
    joints: Vec<[f64; 2]>,
}

impl Numbers {
    /// Those of the blocks of a moment, with noise of a share of them.
    fn of(moment: &Moment, dice: &mut Dice, noise: f64) -> Self {
        let mut made = Self { points: Vec::new(), velocity: Vec::new(), stress: Vec::new(), joints: Vec::new() };
        for (k, block) in moment.blocks.iter().enumerate() {
            let n = &block.numbers;
            made.points.push([n[0] + 1e-3 * noise * dice.roll(), n[1]]);
            for _ in 0..CORNERS {
                made.velocity.push([n[3] + noise * dice.roll(), n[4] + noise * dice.roll()]);
                made.stress.push([6, 7, 8].map(|part| n[part] + 1e6 * noise * dice.roll()));
            }
            made.joints.extend((0..3).map(|j| [-1e-4 * j as f64, 0.01 * k as f64 * moment.time]));
        }
        made
    }

    fn write(&self, time: f64, film: &mut FilmWriter) -> Result<(), FilmError> {
        let Self { points, velocity, stress, joints } = self;
        film.elements(time, &Elements { points, velocity, stress, joints })
    }
}

/// Series of a chunk in quanta, those before added where it holds changes: quantum, and its parts.
type Series = Vec<(f64, Vec<Vec<f64>>)>;

fn decoded(body: &[u8], counts: [usize; 4], before: Option<&Series>) -> Series {
    let mut reader = Reader(body);
    let changes = reader.take(1)[0] == 1;
    let read = |(k, (count, parts)): (usize, (usize, usize))| {
        let quantum = reader.f64();
        let part = |part: usize, reader: &mut Reader| {
            let number = |at: usize| {
                let change = reader.integer() as f64;
                let known = before
                    .filter(|_| changes)
                    .map_or(0.0, |all| (all[k].1[part][at] * all[k].0 / quantum + 0.5).floor());
                known + change
            };
            (0..count).map(number).collect()
        };
        (quantum, (0..parts).map(|k| part(k, &mut reader)).collect())
    };
    let found = counts.into_iter().zip([2, 2, 3, 2]).enumerate().map(read).collect();
    assert!(reader.0.is_empty());
    found
}

/// The bodies of the chunks of elements of a film.
fn bodies(path: &Path) -> Vec<Vec<u8>> {
    let all = chunks(&std::fs::read(path).unwrap()).into_iter();
    all.filter(|(kind, ..)| kind == "ELEM").map(|(.., body)| body).collect()
}

#[test]
fn numbers_of_elements_come_back_within_a_quantum() {
    let (folder, slope) = (tempdir().unwrap(), fans(8, 5));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let mut dice = Dice::new(3);
    let put: Vec<(Moment, Numbers)> = (0..6)
        .map(|k| {
            let moment = slope.at(0.1 * k as f64);
            // Noise that grows, stays and ends: changes of quanta in both directions.
            let numbers = Numbers::of(&moment, &mut dice, [0.0, 0.2, 0.02, 0.02, 1.0, 0.0][k]);
            film.frame(&moment.frame()).unwrap();
            numbers.write(moment.time, &mut film).unwrap();
            (moment, numbers)
        })
        .collect();
    let blocks = slope.outlines.len();
    let mut before = None;
    for (body, (moment, numbers)) in bodies(&path).iter().zip(&put) {
        let found = decoded(body, [blocks, CORNERS * blocks, CORNERS * blocks, 3 * blocks], before.as_ref());
        for (k, block) in moment.blocks.iter().enumerate() {
            let [near, stress] = [&found[0], &found[2]];
            for axis in [0, 1] {
                // The arm of the centroid is a quantum of places long at most: 25 m / 65 536.
                let left = numbers.points[k][axis] - block.numbers[axis];
                assert!((near.1[axis][k] * near.0 - left).abs() <= near.0 + 1e-3, "point {k}");
            }
            for e in CORNERS * k..CORNERS * (k + 1) {
                for part in 0..3 {
                    // The film keeps 2⁻¹⁶ of the number of the block.
                    let wanted = numbers.stress[e][part] - block.numbers[6 + part];
                    let error = (stress.1[part][e] * stress.0 - wanted).abs();
                    let slack = block.numbers[6 + part].abs() / 65_536.0;
                    assert!(error <= stress.0 + slack, "stress {part} of element {e}: {error} of {}", stress.0);
                }
            }
            for (j, joint) in numbers.joints.iter().enumerate().skip(3 * k).take(3) {
                for part in [0, 1] {
                    let steps = found[3].1[part][j];
                    let small = 8.4 * 3.0 / 262_144.0;
                    let value = steps.signum() * small * ((steps.abs() / 16.0).exp2() - 1.0);
                    let error = (value - joint[part]).abs();
                    assert!(error <= 0.05 * joint[part].abs() + small / 16.0, "{value} is not {}", joint[part]);
                }
            }
        }
        before = Some(found);
    }
    assert!(before.is_some());
}

/// Speeds of elements of a block that turns follow from its spin: nothing is left of them.
#[test]
fn rigid_motion_leaves_nothing() {
    let (folder, slope) = (tempdir().unwrap(), fans(3, 2));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let mut moment = slope.at(0.0);
    let mut numbers = Numbers::of(&moment, &mut Dice::new(1), 0.0);
    for (k, block) in moment.blocks.iter_mut().enumerate() {
        // A quarter turn: an arm (a, b) lies along (−b, a), and a spin of 2 rad/s moves it by 2 · (−a, −b).
        block.numbers[2] = std::f64::consts::FRAC_PI_2;
        block.numbers[3..6].copy_from_slice(&[1.0, 0.5, 2.0]);
        let outline = &slope.outlines[k];
        let corners = &outline.loops[0];
        for e in 0..CORNERS {
            let [a, b] = [0, 1].map(|axis| {
                let sum = corners[e][axis] + corners[(e + 1) % CORNERS][axis] + outline.centroid[axis];
                sum / 3.0 - outline.centroid[axis]
            });
            numbers.velocity[CORNERS * k + e] = [1.0 - 2.0 * a, 0.5 - 2.0 * b];
        }
    }
    film.frame(&moment.frame()).unwrap();
    numbers.write(0.0, &mut film).unwrap();
    let blocks = slope.outlines.len();
    let found = decoded(&bodies(&path)[0], [blocks, CORNERS * blocks, CORNERS * blocks, 3 * blocks], None);
    let most = found[1].1.iter().flatten().fold(0.0_f64, |most, left| most.max(left.abs() * found[1].0));
    assert!(most < 2e-3, "{most} m/s of 2 m/s is left");
}

#[test]
fn noise_stays_within_its_room_and_calm_takes_none() {
    let (folder, slope) = (tempdir().unwrap(), fans(60, 40));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let mut dice = Dice::new(5);
    let moment = slope.at(0.1);
    let elements = CORNERS * slope.outlines.len();
    let mut length = std::fs::metadata(&path).unwrap().len();
    let mut grown = |film: &mut FilmWriter, numbers: &Numbers| {
        film.frame(&moment.frame()).unwrap();
        let before = std::fs::metadata(&path).unwrap().len();
        numbers.write(moment.time, film).unwrap();
        length = std::fs::metadata(&path).unwrap().len();
        (length - before) as usize
    };
    let noise = Numbers::of(&moment, &mut dice, 0.05);
    let room = (1.5 * elements as f64) as usize + 16;
    assert!(grown(&mut film, &noise) <= room);
    let other = Numbers::of(&moment, &mut dice, 0.05);
    let again = grown(&mut film, &other);
    assert!(again <= room && again > room / 4, "{again} of {room}");
    // Calm makes numbers finer, up to the finest; then nothing is left to say.
    let calm: Vec<usize> = (0..8).map(|_| grown(&mut film, &other)).collect();
    assert!(calm.iter().all(|&bytes| bytes <= room) && calm[7] < room / 50, "{calm:?} of {room}");
}

#[test]
fn elements_after_a_cut_or_what_was_forgotten_stand_for_themselves() {
    let (folder, slope) = (tempdir().unwrap(), fans(4, 3));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let mut dice = Dice::new(9);
    let mut push = |film: &mut FilmWriter, time: f64| {
        let moment = slope.at(time);
        film.frame(&moment.frame()).unwrap();
        Numbers::of(&moment, &mut dice, 0.1).write(time, film).unwrap();
    };
    push(&mut film, 0.1);
    push(&mut film, 0.2);
    film.hold();
    push(&mut film, 0.3);
    film.discard();
    push(&mut film, 0.3);
    film.cut(0.25).unwrap();
    push(&mut film, 0.4);
    let mut film = FilmWriter::resume(&path, &head(), &slope.outlines, 0.4).unwrap();
    push(&mut film, 0.5);
    let kinds: Vec<u8> = bodies(&path).iter().map(|body| body[0]).collect();
    assert_eq!(kinds, [0, 1, 0, 0]);
    let names: Vec<String> = chunks(&std::fs::read(&path).unwrap()).into_iter().map(|(kind, ..)| kind).collect();
    assert_eq!(names.iter().filter(|kind| *kind == "MESH").count(), 1);
}

#[test]
fn elements_that_do_not_fit_are_refused() {
    let (folder, slope) = (tempdir().unwrap(), fans(2, 2));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let moment = slope.at(0.1);
    let numbers = Numbers::of(&moment, &mut Dice::new(2), 0.1);
    let refused = |error: Result<(), FilmError>, word: &str| {
        let error = error.unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    };
    refused(numbers.write(0.1, &mut film), "frames before elements");
    film.frame(&moment.frame()).unwrap();
    let fewer = Numbers { stress: numbers.stress[1..].to_vec(), ..numbers.clone() };
    refused(fewer.write(0.1, &mut film), "stresses of elements");
    let mut endless = numbers.clone();
    endless.velocity[3][1] = f64::INFINITY;
    refused(endless.write(0.1, &mut film), "inf");
    let mut wrong = fans(2, 2).outlines;
    wrong[1].mesh.elements[0][2] = 13;
    refused(FilmWriter::create(&path, &head(), &wrong).map(|_| ()), "points of an element");
    let mut poor = head();
    poor.block_numbers.truncate(5);
    refused(FilmWriter::create(&path, &poor, &slope.outlines).map(|_| ()), "numbers of blocks for elements");
    let without = Slope::new(2, 2);
    let mut film = FilmWriter::create(&path, &head(), &without.outlines).unwrap();
    film.frame(&without.at(0.1).frame()).unwrap();
    refused(numbers.write(0.1, &mut film), "meshes of elements");
}
