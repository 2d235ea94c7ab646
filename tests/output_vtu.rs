//! Frames are well-formed XML with a polygon per element and a vertex per joint point, and the collection lists them.
//!
//! `python_tests/test_vtu.py` opens the run that is left in `$CARGO_TARGET_TMPDIR/run` with VTK and meshio.

mod output_sample;

use std::fs;
use std::path::{Path, PathBuf};

use enmm::model::Snapshot;
use enmm_run::vtu::{PvdWriter, write_joints_vtu, write_vtu};
use output_sample::{Sample, sample};
use resvg::usvg::roxmltree::{Document, Node};

fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    directory
}

fn small() -> Sample {
    sample(12.0, 6.0)
}

fn array<'a>(document: &'a Document, name: &str) -> Node<'a, 'a> {
    document.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap()
}

fn count(document: &Document, name: &str) -> usize {
    let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
    piece.attribute(name).unwrap().parse().unwrap()
}

/// The bytes of an array after its length, which is checked.
fn bytes(document: &Document, name: &str) -> Vec<u8> {
    let coded = array(document, name).text().unwrap();
    let value = |digit: u8| match digit {
        b'A'..=b'Z' => u32::from(digit - b'A'),
        b'a'..=b'z' => u32::from(digit - b'a') + 26,
        b'0'..=b'9' => u32::from(digit - b'0') + 52,
        b'+' => 62,
        b'/' => 63,
        _ => panic!("{digit} is no digit of base64"),
    };
    let mut plain = Vec::new();
    for group in coded.as_bytes().chunks(4) {
        let digits: Vec<u32> = group.iter().filter(|&&digit| digit != b'=').map(|&digit| value(digit)).collect();
        let bits = digits.iter().enumerate().fold(0, |bits, (k, digit)| bits | digit << (18 - 6 * k));
        plain.extend_from_slice(&bits.to_be_bytes()[1..digits.len()]);
    }
    let length = u64::from_le_bytes(plain[..8].try_into().unwrap());
    assert_eq!(length as usize, plain.len() - 8, "{name}");
    plain.split_off(8)
}

fn numbers(document: &Document, name: &str) -> Vec<f64> {
    bytes(document, name).chunks(8).map(|value| f64::from_le_bytes(value.try_into().unwrap())).collect()
}

fn integers(document: &Document, name: &str) -> Vec<i64> {
    bytes(document, name).chunks(8).map(|value| i64::from_le_bytes(value.try_into().unwrap())).collect()
}

#[test]
fn elements_come_back_as_they_were() {
    let path = directory("vtu_elements").join("deep/elements.vtu");
    let snapshot = small().moved(0.3, 1.0);
    write_vtu(&snapshot, &path).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let document = Document::parse(&text).unwrap();
    let elements = &snapshot.elements;
    assert_eq!(count(&document, "NumberOfPoints"), elements.points.len());
    assert_eq!(count(&document, "NumberOfCells"), elements.len());
    assert_eq!(numbers(&document, "TimeValue"), [0.3]);
    let flat = |vectors: &[enmm::geometry::Vector]| vectors.iter().flat_map(|v| [v.x, v.y, 0.0]).collect::<Vec<_>>();
    assert_eq!(numbers(&document, "Points"), flat(&elements.points));
    assert_eq!(numbers(&document, "displacement"), flat(&snapshot.displacement));
    assert_eq!(numbers(&document, "velocity"), flat(&snapshot.velocity));
    assert_eq!(array(&document, "velocity").attribute("NumberOfComponents"), Some("3"));
    assert_eq!(integers(&document, "connectivity").len(), elements.points.len());
    assert!(
        integers(&document, "offsets").iter().eq(elements.start[1..]
            .iter()
            .map(|&end| i64::from(end))
            .collect::<Vec<_>>()
            .iter())
    );
    assert!(bytes(&document, "types").iter().all(|&kind| kind == 7));
    assert!(integers(&document, "block").iter().zip(&snapshot.block).all(|(a, b)| *a == i64::from(*b)));
    let [xx, yy, xy] = ["stress_xx", "stress_yy", "stress_xy"].map(|name| numbers(&document, name));
    for (k, stress) in snapshot.stress.iter().enumerate() {
        assert_eq!([xx[k], yy[k], xy[k]], *stress);
    }
}

/// Stress (2, −4, 4) Pa: mean −1 Pa, radius of the circle √(3² + 4²) = 5 Pa.
#[test]
fn invariants_are_those_of_mohr_s_circle() {
    let path = directory("vtu_mohr").join("elements.vtu");
    let mut snapshot = small().reference;
    snapshot.stress.fill([2.0, -4.0, 4.0]);
    write_vtu(&snapshot, &path).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let document = Document::parse(&text).unwrap();
    assert!(numbers(&document, "mean_stress").iter().all(|&mean| mean == -1.0));
    assert!(numbers(&document, "max_shear").iter().all(|&shear| shear == 5.0));
}

#[test]
fn joints_come_back_as_they_were() {
    let path = directory("vtu_joints").join("joints.vtu");
    let snapshot = small().moved(0.3, 1.0);
    write_joints_vtu(&snapshot, &path).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let document = Document::parse(&text).unwrap();
    assert_eq!(count(&document, "NumberOfCells"), snapshot.joints.len());
    assert!(bytes(&document, "types").iter().all(|&kind| kind == 1));
    assert_eq!(bytes(&document, "state")[..3], [0, 1, 2]);
    let stresses = snapshot.joints.iter().map(|joint| joint.normal_stress);
    assert!(numbers(&document, "normal_stress").into_iter().eq(stresses));
    assert_eq!(numbers(&document, "normal").len(), 3 * snapshot.joints.len());
}

/// meshio rejects a file without cells, so an empty grid has one cell that has no points.
#[test]
fn a_snapshot_without_content_is_written() {
    let directory = directory("vtu_empty");
    write_vtu(&Snapshot::default(), &directory.join("elements.vtu")).unwrap();
    write_joints_vtu(&Snapshot::default(), &directory.join("joints.vtu")).unwrap();
    for name in ["elements.vtu", "joints.vtu"] {
        let text = fs::read_to_string(directory.join(name)).unwrap();
        let document = Document::parse(&text).unwrap();
        assert_eq!(count(&document, "NumberOfPoints"), 0);
        assert_eq!(integers(&document, "offsets"), [0]);
    }
}

#[test]
fn a_field_of_the_wrong_length_is_refused() {
    let path = directory("vtu_short").join("elements.vtu");
    let mut snapshot = small().reference;
    snapshot.velocity.pop();
    let error = write_vtu(&snapshot, &path).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput);
    assert!(error.to_string().contains("elements.vtu") && error.to_string().contains("velocity"), "{error}");
    assert!(!path.exists());
}

#[test]
fn the_collection_lists_every_frame_and_nothing_is_left_over() {
    let directory = directory("run");
    let slope = small();
    let mut run = PvdWriter::new(&directory).unwrap();
    run.push(&slope.reference).unwrap();
    for k in 1..4 {
        run.push(&slope.moved(f64::from(k) * 0.1, f64::from(k))).unwrap();
    }
    assert_eq!(listed(&directory), listing(&[0.0, 0.1, 0.2, 0.30000000000000004]));
    let mut files: Vec<_> =
        fs::read_dir(directory.join("frames")).unwrap().map(|file| file.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files.len(), 8);
    assert_eq!(files[0], "elements_0000.vtu");
    assert_eq!(files[7], "joints_0003.vtu");
}

#[test]
fn a_resumed_run_drops_the_frames_after_its_checkpoint() {
    let directory = directory("vtu_resumed");
    let slope = small();
    let mut run = PvdWriter::open_for_append(&directory, 0.0).unwrap();
    for time in [0.0, 0.1, 0.2] {
        run.push(&slope.moved(time, 1.0)).unwrap();
    }
    let mut resumed = PvdWriter::open_for_append(&directory, 0.1).unwrap();
    assert_eq!(listed(&directory), listing(&[0.0, 0.1]));
    resumed.push(&slope.moved(0.25, 1.0)).unwrap();
    assert_eq!(listed(&directory), listing(&[0.0, 0.1, 0.25]));
}

#[test]
fn a_collection_of_another_program_is_refused() {
    let directory = directory("vtu_foreign");
    fs::create_dir_all(&directory).unwrap();
    for text in
        ["no xml", "<VTKFile><Collection><DataSet part=\"0\" file=\"a.vtu\" timestep=\"1\"/></Collection></VTKFile>"]
    {
        fs::write(directory.join("run.pvd"), text).unwrap();
        let error = PvdWriter::open_for_append(&directory, 1.0).unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidData);
        assert!(error.to_string().contains("run.pvd"), "{error}");
    }
}

/// Time, part and file of each entry.
fn listed(directory: &Path) -> Vec<(f64, String, String)> {
    let text = fs::read_to_string(directory.join("run.pvd")).unwrap();
    let document = Document::parse(&text).unwrap();
    let of = |node: Node, name: &str| node.attribute(name).unwrap().to_owned();
    let entries = document.descendants().filter(|node| node.has_tag_name("DataSet"));
    entries.map(|node| (of(node, "timestep").parse().unwrap(), of(node, "part"), of(node, "file"))).collect()
}

fn listing(times: &[f64]) -> Vec<(f64, String, String)> {
    let parts = |(k, &time): (usize, &f64)| {
        let entry = move |part: usize, name: &str| (time, part.to_string(), format!("frames/{name}_{k:04}.vtu"));
        [entry(0, "elements"), entry(1, "joints")]
    };
    times.iter().enumerate().flat_map(parts).collect()
}
