//! A film gives back what was put in, within the errors that it claims, and is small.

use std::path::Path;

use crate::support::{BOLT, Chunk, MONITOR, Moment, Reader, SURFACE, Slope, chunks, head};
use enmm_report::{Break, EdgeState, FilmError, FilmWriter, Note, QUANTUM, write_page};
use tempfile::tempdir;

/// Single precision and five digits (the last byte is left out).
const FULL: f64 = 1.0 / (1 << 24) as f64;
const SHORT: f64 = 1.0 / (1 << 16) as f64;

/// Numbers of a frame as a reader has them.
struct Decoded {
    quantum: f64,
    numbers: Vec<Vec<f32>>,
    corners: Vec<[f64; 2]>,
    edges: Vec<u8>,
    monitor: [f32; 4],
    structures: Structures,
}

/// Bolts, supports and water of a frame as a reader has them.
struct Structures {
    bolt: (u8, Vec<f32>),
    /// Signs, and places from the origin (m), when they follow.
    supports: Option<(Vec<u8>, [Vec<f32>; 2])>,
    water: (f64, [Vec<f32>; 2]),
}

fn structures(reader: &mut Reader, with_supports: bool) -> Structures {
    let state = reader.take(1)[0];
    let bolt = [4, 4, 4, 4, 3].into_iter().flat_map(|width| reader.planes(1, width)).collect();
    let supports = with_supports.then(|| {
        let count = reader.u32() as usize;
        (reader.take(count).to_vec(), [0, 1].map(|_| reader.planes(count, 3)))
    });
    let weight = reader.f64();
    let points = reader.u32() as usize;
    Structures { bolt: (state, bolt), supports, water: (weight, [0, 1].map(|_| reader.planes(points, 4))) }
}

/// Arms of all corners about their centroids, from the outlines.
fn arms(body: &[u8]) -> Vec<(usize, [f64; 2])> {
    let mut reader = Reader(body);
    let [blocks, corners] = [reader.u32() as usize, reader.u32() as usize];
    reader.take(24);
    let mut owner = Vec::new();
    for block in 0..blocks {
        reader.take(24);
        let loops = reader.u32();
        let points: u32 = (0..loops).map(|_| reader.u32()).sum();
        owner.extend(std::iter::repeat_n(block, points as usize));
    }
    let [cx, cy] = [reader.planes(blocks, 4), reader.planes(blocks, 4)];
    let [x, y] = [reader.planes(corners, 4), reader.planes(corners, 4)];
    let arm = |(k, block): (usize, usize)| {
        let about = |place: f32, centre: f32| f64::from(place) - f64::from(centre);
        (block, [about(x[k], cx[block]), about(y[k], cy[block])])
    };
    owner.into_iter().enumerate().map(arm).collect()
}

fn decoded(body: &[u8], arms: &[(usize, [f64; 2])], blocks: usize) -> Decoded {
    let mut reader = Reader(body);
    let with_supports = reader.take(8)[5] == 1;
    let quantum = reader.f64();
    reader.take(blocks);
    let edges = reader.take(arms.len()).to_vec();
    let numbers: Vec<Vec<f32>> =
        [4, 4, 3, 3, 3, 3, 3, 3, 3].iter().map(|&width| reader.planes(blocks, width)).collect();
    let monitor = std::array::from_fn(|_| reader.f32());
    let rest: [Vec<f64>; 2] = std::array::from_fn(|_| arms.iter().map(|_| reader.integer() as f64 * quantum).collect());
    let structures = structures(&mut reader, with_supports);
    assert!(reader.0.is_empty());
    let corner = |(k, &(block, [a, b])): (usize, &(usize, [f64; 2]))| {
        let [x, y, turn] = [0, 1, 2].map(|n| f64::from(numbers[n][block]));
        let (sine, less) = (turn.sin(), turn.cos() - 1.0);
        [x + a * less - b * sine + rest[0][k], y + a * sine + b * less + rest[1][k]]
    };
    let corners = arms.iter().enumerate().map(corner).collect();
    Decoded { quantum, numbers, corners, edges, monitor, structures }
}

fn compare(found: &Decoded, put: &Moment) {
    for (corner, wanted) in found.corners.iter().zip(&put.corners) {
        for axis in [0, 1] {
            let error = (corner[axis] - wanted[axis]).abs();
            assert!(error <= 0.5000001 * found.quantum, "{error} of {}", found.quantum);
        }
    }
    for (k, block) in put.blocks.iter().enumerate() {
        for (n, wanted) in block.numbers.iter().enumerate() {
            let error = (f64::from(found.numbers[n][k]) - wanted).abs();
            assert!(error <= wanted.abs() * if n < 2 { FULL } else { SHORT }, "number {n} of block {k}");
        }
    }
    let edge = |(&state, &wet): (&EdgeState, &bool)| state as u8 + if wet { 8 } else { 0 };
    assert_eq!(found.edges, put.edges.iter().zip(&put.wet).map(edge).collect::<Vec<_>>());
    let [x, y] = MONITOR.displacement;
    let [vx, vy] = MONITOR.velocity;
    assert_eq!(found.monitor.map(f64::from), [x, y, vx, vy]);
}

/// `origin` (m) is that of the film.
fn compare_structures(found: &Structures, put: &Moment, origin: [f64; 2]) {
    let near = |found: f32, wanted: f64, error: f64| (f64::from(found) - wanted).abs() <= error * wanted.abs();
    let [[ax, ay], [bx, by]] = BOLT.displacement;
    assert_eq!(found.bolt.0, 2, "it yields");
    for (k, wanted) in [ax, ay, bx, by, BOLT.force].into_iter().enumerate() {
        assert!(near(found.bolt.1[k], wanted, if k < 4 { FULL } else { SHORT }), "number {k} of the bolt");
    }
    assert_eq!(found.supports.is_some(), put.time == 0.0, "supports stand in the first frame of the stage");
    if let Some((signs, places)) = &found.supports {
        assert_eq!(signs.len(), put.supports.len());
        for (k, support) in put.supports.iter().enumerate() {
            let sign = u8::from(support.axes[0]) + 2 * u8::from(support.axes[1]) + 4 * u8::from(support.absorbs);
            assert_eq!(signs[k], sign);
            for axis in [0, 1] {
                assert!(near(places[axis][k], support.place[axis] - origin[axis], SHORT), "place of support {k}");
            }
        }
    }
    assert_eq!(found.water.0, 9810.0);
    for (k, point) in SURFACE.iter().enumerate() {
        for axis in [0, 1] {
            assert!(near(found.water.1[axis][k], point[axis] - origin[axis], FULL), "point {k} of the water table");
        }
    }
}

#[test]
fn a_film_gives_back_frames_within_its_errors() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(8, 5));
    let path = folder.path().join("film.bin");
    let moments = slope.film(&path, 5);
    let chunks = chunks(&std::fs::read(&path).unwrap());
    let arms = arms(&chunks[1].2);
    let mut outlines = Reader(&chunks[1].2[8..]);
    let origin = [outlines.f64(), outlines.f64()];
    assert_eq!(arms.len(), slope.corners());
    let frames: Vec<_> = chunks.iter().filter(|(kind, ..)| kind == "FRAM").collect();
    assert_eq!(frames.len(), 5);
    for ((_, time, body), moment) in frames.into_iter().zip(&moments) {
        assert_eq!(*time, moment.time);
        let found = decoded(body, &arms, slope.outlines.len());
        let size = 8.4 * 3.0;
        assert!(found.quantum <= size * QUANTUM);
        let most = moment.corners.iter().flatten().fold(0.0_f64, |most, part| most.max(part.abs()));
        assert!(found.quantum <= most / 512.0);
        compare(&found, moment);
        compare_structures(&found.structures, moment, origin);
    }
}

#[test]
fn rows_and_notes_stand_where_they_were_put() {
    let folder = tempdir().unwrap();
    let (path, slope) = (folder.path().join("film.bin"), Slope::new(2, 2));
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    film.row(&[0.0, 0.5]).unwrap();
    film.row(&[0.25, -1.5]).unwrap();
    film.note(0.25, &Note::Warning { text: "loose".to_owned() }).unwrap();
    let chunks = chunks(&std::fs::read(&path).unwrap());
    let kinds: Vec<&str> = chunks.iter().map(|(kind, ..)| kind.as_str()).collect();
    assert_eq!(kinds, ["HEAD", "OUTL", "ROWS", "NOTE"]);
    let mut rows = Reader(&chunks[2].2);
    assert_eq!([rows.u32(), rows.u32()], [2, 2]);
    assert_eq!([rows.f64(), rows.f64()], [0.0, 0.25]);
    assert_eq!(rows.planes(2, 4), [0.5, -1.5]);
    let note: serde_json::Value = serde_json::from_slice(&chunks[3].2).unwrap();
    assert_eq!(note, serde_json::json!({ "note": "warning", "text": "loose" }));
}

/// Outlines of a film and the moment of each frame behind them, read back.
fn read_back(path: &Path, slopes: &[(&Slope, &[f64])]) {
    let chunks = chunks(&std::fs::read(path).unwrap());
    let kinds: String = chunks.iter().filter(|(kind, ..)| kind != "NOTE").map(|(kind, ..)| &kind[..1]).collect();
    let wanted: String = slopes.iter().map(|(_, times)| "O".to_owned() + &"F".repeat(times.len())).collect();
    assert_eq!(kinds, "H".to_owned() + &wanted);
    let mut chunks = chunks.into_iter().filter(|(kind, ..)| ["OUTL", "FRAM"].contains(&kind.as_str()));
    for (slope, times) in slopes {
        let (_, _, outlines) = chunks.next().unwrap();
        let arms = arms(&outlines);
        assert_eq!(arms.len(), slope.corners());
        let mut head = Reader(&outlines[8..]);
        let origin = [head.f64(), head.f64()];
        assert!(head.f64() > 0.0, "its size");
        assert_eq!(head.u32(), slope.outlines[0].id);
        for &time in *times {
            let (_, at, body) = chunks.next().unwrap();
            assert_eq!(at, time);
            let (found, moment) = (decoded(&body, &arms, slope.outlines.len()), slope.at(time));
            compare(&found, &moment);
            compare_structures(&found.structures, &moment, origin);
        }
    }
}

#[test]
fn frames_after_a_break_have_the_blocks_of_their_own_outlines() {
    let (folder, whole) = (tempdir().unwrap(), Slope::new(3, 2));
    let path = folder.path().join("film.bin");
    let (once, twice) = (whole.broken(2), whole.broken(2).broken(6));
    assert_eq!([&whole, &once, &twice].map(|slope| slope.outlines.len()), [6, 7, 8]);
    let mut film = FilmWriter::create(&path, &head(), &whole.outlines).unwrap();
    let frame = |film: &mut FilmWriter, slope: &Slope, time| film.frame(&slope.at(time).frame());
    [0.0, 0.1].into_iter().for_each(|time| frame(&mut film, &whole, time).unwrap());
    film.outlines(0.2, &once.outlines).unwrap();
    let refused = frame(&mut film, &whole, 0.2).unwrap_err().to_string();
    assert_eq!(refused, "6 blocks of a frame were given, the film has 7");
    [0.2, 0.3].into_iter().for_each(|time| frame(&mut film, &once, time).unwrap());
    film.outlines(0.4, &twice.outlines).unwrap();
    frame(&mut film, &twice, 0.4).unwrap();
    read_back(&path, &[(&whole, &[0.0, 0.1]), (&once, &[0.2, 0.3]), (&twice, &[0.4])]);
    // A run that goes on from before the second break, and breaks later now.
    let mut film = FilmWriter::resume(&path, &head(), &once.outlines, 0.35).unwrap();
    frame(&mut film, &once, 0.4).unwrap();
    film.outlines(0.5, &twice.outlines).unwrap();
    frame(&mut film, &twice, 0.5).unwrap();
    read_back(&path, &[(&whole, &[0.0, 0.1]), (&once, &[0.2, 0.3, 0.4]), (&twice, &[0.5])]);
    // From before the first one: the outlines of the start stay.
    drop(FilmWriter::resume(&path, &head(), &whole.outlines, 0.15).unwrap());
    read_back(&path, &[(&whole, &[0.0, 0.1])]);
}

/// The script of breaks comes with films that have one, and no other page grows by it.
#[test]
fn a_page_lists_breaks_where_its_film_tells_of_some() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(2, 2));
    let [film, page] = ["film.bin", "report.html"].map(|name| folder.path().join(name));
    let mut writer = FilmWriter::create(&film, &head(), &slope.outlines).unwrap();
    writer.note(0.0, &Note::Warning { text: "{\"note\":\"break\"".to_owned() }).unwrap();
    let text = || {
        write_page(&film, &page).unwrap();
        std::fs::read_to_string(&page).unwrap()
    };
    assert!(!text().contains("function breaksSection"));
    let broken = Break {
        at: 0.25,
        block: 3,
        part: 4,
        failure: "by bending".to_owned(),
        ends: [[0.0, 1.0], [2.0, 1.0]],
        share: 1.0625,
        normal: -5e3,
        shear: 2e4,
        moment: 1e5,
    };
    writer.note(0.3, &Note::Break(broken)).unwrap();
    assert!(text().contains("function breaksSection") && enmm_report::live_page().contains("function breaksSection"));
    let note = chunks(&std::fs::read(&film).unwrap()).pop().unwrap();
    let shown = serde_json::json!({
        "note": "break", "at": 0.25, "block": 3, "part": 4, "failure": "by bending",
        "ends": [[0.0, 1.0], [2.0, 1.0]], "share": 1.0625, "normal": -5e3, "shear": 2e4, "moment": 1e5,
    });
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&note.2).unwrap(), shown);
}

/// Size of a page with so many blocks and frames (bytes).
fn page_size(across: usize, up: usize, blocks: usize, frames: usize) -> u64 {
    let folder = tempdir().unwrap();
    let mut slope = Slope::new(across, up);
    slope.outlines.truncate(blocks);
    let [film, page] = ["film.bin", "report.html"].map(|name| folder.path().join(name));
    slope.film(&film, frames);
    write_page(&film, &page).unwrap();
    std::fs::metadata(page).unwrap().len()
}

#[test]
fn hundreds_of_blocks_go_by_mail() {
    let size = page_size(29, 15, 435, 100);
    assert!(size <= 2_000_000, "{size} bytes");
}

#[test]
fn ten_thousand_blocks_open() {
    let size = page_size(125, 80, 10_000, 60);
    assert!(size <= 25_000_000, "{size} bytes");
}

#[test]
fn a_torn_film_still_makes_a_page() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(3, 3));
    let [film, page] = ["film.bin", "report.html"].map(|name| folder.path().join(name));
    slope.film(&film, 4);
    write_page(&film, &page).unwrap();
    let whole = std::fs::read(&page).unwrap();
    let mut bytes = std::fs::read(&film).unwrap();
    bytes.extend(b"FRAM\x40\x00\x00\x00torn");
    std::fs::write(&film, bytes).unwrap();
    write_page(&film, &page).unwrap();
    assert!(std::fs::read(&page).unwrap() == whole);
}

/// Frames, and all rows of the histories, of a film.
fn frames_and_rows(path: &Path) -> (Vec<Chunk>, Vec<(f64, f32)>) {
    let (frames, others): (Vec<_>, Vec<_>) =
        chunks(&std::fs::read(path).unwrap()).into_iter().partition(|(kind, ..)| kind == "FRAM");
    let mut rows = Vec::new();
    for (_, _, body) in others.into_iter().filter(|(kind, ..)| kind == "ROWS") {
        let mut reader = Reader(&body);
        let count = reader.u32() as usize;
        assert_eq!(reader.u32(), 2);
        let times: Vec<f64> = (0..count).map(|_| reader.f64()).collect();
        rows.extend(times.into_iter().zip(reader.planes(count, 4)));
    }
    (frames, rows)
}

/// Frames lie 0.1 s apart and rows 0.02 s, so the film is cut in the middle of a chunk of rows.
#[test]
fn a_resumed_film_has_the_frames_and_rows_of_the_uninterrupted_one() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(4, 3));
    let [whole, resumed] = ["whole.bin", "resumed.bin"].map(|name| folder.path().join(name));
    let fill = |film: &mut FilmWriter, steps: std::ops::RangeInclusive<usize>| {
        for step in steps {
            let time = 0.02 * step as f64;
            film.row(&[time, time.sin()]).unwrap();
            if step % 5 == 0 {
                film.frame(&slope.at(time).frame()).unwrap();
            }
        }
        film.flush().unwrap();
    };
    fill(&mut FilmWriter::create(&whole, &head(), &slope.outlines).unwrap(), 0..=30);
    fill(&mut FilmWriter::create(&resumed, &head(), &slope.outlines).unwrap(), 0..=24);
    fill(&mut FilmWriter::resume(&resumed, &head(), &slope.outlines, 0.37).unwrap(), 19..=30);
    let (frames, rows) = frames_and_rows(&whole);
    assert_eq!([frames.len(), rows.len()], [7, 31]);
    assert!((frames, rows) == frames_and_rows(&resumed));
}

#[test]
fn what_cannot_be_shown_is_refused_with_its_place() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(2, 2));
    let path = folder.path().join("film.bin");
    let mut film = FilmWriter::create(&path, &head(), &slope.outlines).unwrap();
    let text = |error: FilmError| error.to_string();
    let mut moment = slope.at(0.5);
    moment.blocks[2].numbers[4] = f64::NAN;
    assert!(text(film.frame(&moment.frame()).unwrap_err()).starts_with("velocity_y of block 2 is NaN at t = 0.5 s"));
    let mut moment = slope.at(0.5);
    moment.corners[13][0] = f64::INFINITY;
    assert!(text(film.frame(&moment.frame()).unwrap_err()).starts_with("displacement of corner 13, in block 1 is inf"));
    let mut moment = slope.at(0.5);
    moment.blocks[0].numbers[6] = 1e39;
    assert!(text(film.frame(&moment.frame()).unwrap_err()).contains("is 1e39"));
    let mut moment = slope.at(0.5);
    moment.edges = vec![EdgeState::Open];
    moment.wet.clear();
    assert_eq!(text(film.frame(&moment.frame()).unwrap_err()), "1 edges of a frame were given, the film has 48");
    assert!(text(film.row(&[0.0, f64::NAN]).unwrap_err()).starts_with("wave of a row is NaN"));
    let mut moment = slope.at(0.5);
    moment.supports[3].place[1] = f64::NAN;
    assert!(text(film.frame(&moment.frame()).unwrap_err()).starts_with("place of support 3 is NaN"), "the first frame");
    let size = std::fs::metadata(&path).unwrap().len();
    film.frame(&slope.at(0.5).frame()).unwrap();
    assert!(std::fs::metadata(&path).unwrap().len() > size, "a refused frame leaves the film as it was");
}

/// A gauge whose rock is gone has no value: NaN, which comes back as such; what is infinite is a failure there too.
#[test]
fn columns_with_gaps_may_be_without_values() {
    let (folder, slope) = (tempdir().unwrap(), Slope::new(2, 2));
    let path = folder.path().join("film.bin");
    let mut with_gaps = head();
    with_gaps.columns[1].gaps = true;
    let mut film = FilmWriter::create(&path, &with_gaps, &slope.outlines).unwrap();
    film.row(&[0.0, 1.5]).unwrap();
    film.row(&[0.1, f64::NAN]).unwrap();
    assert!(film.row(&[0.2, f64::INFINITY]).unwrap_err().to_string().starts_with("wave of a row is inf"));
    film.flush().unwrap();
    let (_, rows) = frames_and_rows(&path);
    assert_eq!(rows.len(), 2);
    assert!(rows[0] == (0.0, 1.5) && rows[1].1.is_nan(), "{rows:?}");
}

#[test]
fn another_file_is_no_film() {
    let folder = tempdir().unwrap();
    let [film, page] = ["film.bin", "report.html"].map(|name| folder.path().join(name));
    std::fs::write(&film, "title = \"a case\"").unwrap();
    let error = write_page(&film, &page).unwrap_err().to_string();
    assert!(error.contains("is no film"), "{error}");
    assert!(!page.exists());
}
