//! Frames are well-formed XML with a polygon per element and a line per piece of joint, and the collection lists them.
//!
//! `python_tests/test_vtu.py` opens the run that is left in `$CARGO_TARGET_TMPDIR/run` with VTK and meshio.

use std::fs;
use std::path::{Path, PathBuf};

use crate::sample::{Sample, sample};
use enmm::geometry::{Point, Vector};
use enmm_observe::{
    BoltCondition, BoltLine, BondState, FlowLine, JointPiece, Snapshot, SupportKind, SupportPoint, WetEdge,
};
use enmm_record::vtu::{
    Part, PvdWriter, Structures, write_bolts_vtu, write_flow_vtu, write_joints_vtu, write_supports_vtu, write_vtu,
    write_water_vtu,
};
use roxmltree::{Document, Node};

fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// Parts of a run without bolts, supports and water.
const PARTS: [Part; 2] = [Part::Elements, Part::Joints];

fn beside(slope: &Sample) -> Structures {
    Structures { joints: slope.joints(), ..Structures::default() }
}

fn small() -> Sample {
    let slope = sample(12.0, 6.0);
    assert!(!slope.stars.is_empty());
    slope
}

fn array<'a>(document: &'a Document, name: &str) -> Node<'a, 'a> {
    document.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap()
}

fn count(document: &Document, name: &str) -> usize {
    let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
    piece.attribute(name).unwrap().parse().unwrap()
}

/// The bytes of an array: a header in base64, then the blocks that it counts, compressed by zlib.
fn bytes(document: &Document, name: &str) -> Vec<u8> {
    let coded = array(document, name).text().unwrap();
    let word = |bytes: &[u8], k: usize| u64::from_le_bytes(bytes[8 * k..8 * (k + 1)].try_into().unwrap()) as usize;
    let count = word(&decoded(&coded[..12]), 0);
    let letters = (8 * (3 + count)).div_ceil(3) * 4;
    let (header, packed) = (decoded(&coded[..letters]), decoded(&coded[letters..]));
    let (mut plain, mut at) = (Vec::new(), 0);
    for k in 0..count {
        let end = at + word(&header, 3 + k);
        let block = miniz_oxide::inflate::decompress_to_vec_zlib(&packed[at..end]).unwrap();
        let last = word(&header, 2);
        assert_eq!(block.len(), if k + 1 == count && last > 0 { last } else { word(&header, 1) }, "{name}");
        plain.extend(block);
        at = end;
    }
    assert_eq!(at, packed.len(), "{name}");
    plain
}

fn decoded(coded: &str) -> Vec<u8> {
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
    plain
}

/// Names of the components of an array.
fn components(document: &Document, name: &str) -> Vec<String> {
    let array = array(document, name);
    (0..).map_while(|k| array.attribute(format!("ComponentName{k}").as_str())).map(str::to_owned).collect()
}

fn numbers(document: &Document, name: &str) -> Vec<f64> {
    bytes(document, name).chunks(8).map(|value| f64::from_le_bytes(value.try_into().unwrap())).collect()
}

fn integers(document: &Document, name: &str) -> Vec<i64> {
    bytes(document, name).chunks(8).map(|value| i64::from_le_bytes(value.try_into().unwrap())).collect()
}

#[test]
fn elements_come_back_as_they_were() {
    let path = directory("vtu_elements").join("elements.vtu");
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
    assert!(integers(&document, "offsets").into_iter().eq(elements.start[1..].iter().map(|&end| i64::from(end))));
    assert!(bytes(&document, "types").iter().all(|&kind| kind == 7));
    assert!(integers(&document, "block").iter().zip(&snapshot.block).all(|(a, b)| *a == i64::from(*b)));
    let [xx, yy, xy] = ["stress_xx", "stress_yy", "stress_xy"].map(|name| numbers(&document, name));
    for (k, stress) in snapshot.stress.iter().enumerate() {
        assert_eq!([xx[k], yy[k], xy[k]], *stress);
    }
}

/// Stress (2, −4, 4) Pa: mean −1 Pa, radius of Mohr's circle √(3² + 4²) = 5 Pa, principal stresses −1 ± 5 Pa.
#[test]
fn stress_is_a_tensor_with_its_principal_values_and_invariants() {
    let path = directory("vtu_tensor").join("elements.vtu");
    let mut snapshot = small().reference;
    snapshot.stress.fill([2.0, -4.0, 4.0]);
    snapshot.stress_zz.fill(-1.0);
    write_vtu(&snapshot, &path).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let document = Document::parse(&text).unwrap();
    assert_eq!(components(&document, "stress"), ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]);
    let tensors = numbers(&document, "stress");
    assert_eq!(tensors.len(), 6 * snapshot.stress.len());
    assert!(tensors.chunks(6).all(|tensor| tensor == [2.0, -4.0, -1.0, 4.0, 0.0, 0.0]));
    assert!(numbers(&document, "mean_stress").iter().all(|&mean| mean == -1.0));
    assert!(numbers(&document, "max_shear").iter().all(|&shear| shear == 5.0));
    assert!(numbers(&document, "principal_max").iter().all(|&value| value == 4.0));
    assert!(numbers(&document, "principal_min").iter().all(|&value| value == -6.0));
    assert_eq!(components(&document, "rock_names"), snapshot.rocks);
}

#[test]
fn joints_come_back_as_they_were() {
    let path = directory("vtu_joints").join("joints.vtu");
    let slope = small();
    let mut joints = slope.joints();
    (joints[0].bond, joints[1].bond) = (BondState::Broken, BondState::Holds);
    let laws = ["bed & \"cross\" <1>".to_owned(), "weak".to_owned()];
    write_joints_vtu(&joints, &laws, 0.3, &path).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let document = Document::parse(&text).unwrap();
    assert_eq!(count(&document, "NumberOfCells"), joints.len());
    assert_eq!(count(&document, "NumberOfPoints"), 2 * joints.len());
    assert!(bytes(&document, "types").iter().all(|&kind| kind == 3));
    assert!(integers(&document, "offsets").into_iter().eq((1..=joints.len() as i64).map(|cell| 2 * cell)));
    assert_eq!(bytes(&document, "state")[..3], [0, 1, 2]);
    assert_eq!(bytes(&document, "bond")[..3], [1, 2, 0]);
    assert_eq!(components(&document, "bond_names"), ["none", "broken", "holds"]);
    let of = |part: fn(&JointPiece) -> f64| joints.iter().map(part).collect::<Vec<_>>();
    assert_eq!(numbers(&document, "normal_stress"), of(|joint| joint.normal_stress));
    assert_eq!(numbers(&document, "shear_stress"), of(|joint| joint.shear_stress));
    assert_eq!(numbers(&document, "opening"), of(|joint| joint.opening));
    assert_eq!(numbers(&document, "slip"), of(|joint| joint.slip));
    assert!(numbers(&document, "force").chunks(3).zip(&joints).all(|(f, j)| f == [j.force.x, j.force.y, 0.0]));
    for (k, name) in ["block_1", "block_2"].into_iter().enumerate() {
        assert!(integers(&document, name).iter().zip(&joints).all(|(b, joint)| *b == i64::from(joint.blocks[k])));
    }
    assert_eq!(components(&document, "law_names"), laws);
    assert_eq!(integers(&document, "law_names"), [0, 1]);
    assert_eq!(components(&document, "state_names"), ["open", "slip", "lock"]);
}

#[test]
fn bolts_supports_and_water_come_back_as_they_were() {
    let directory = directory("vtu_structures");
    let ends = [Point::new(1.0, 2.0), Point::new(3.0, 4.0)];
    let conditions = [BoltCondition::Absent, BoltCondition::Elastic, BoltCondition::Yielded, BoltCondition::Broken];
    let bolts = conditions.map(|condition| BoltLine { ends, bolt: 1, force: 2.5e5, condition, ..BoltLine::default() });
    let supports = [SupportKind::Fixity, SupportKind::Spring, SupportKind::Dashpot].map(|kind| SupportPoint {
        position: ends[1],
        reaction: Vector::new(-3.0, 5.0),
        kind,
        ..SupportPoint::default()
    });
    let water = [WetEdge { ends, block: 7, pressure: [0.0, 1e4] }];
    let flow = [FlowLine { ends, reference: ends, block: 7, heads: [5.0, 4.5], flow: -1e-6, ..FlowLine::default() }];
    write_flow_vtu(&flow, 1.0, &directory.join("flow.vtu")).unwrap();
    let names = ["row 1".to_owned(), "row 2".to_owned()];
    write_bolts_vtu(&bolts, &names, 1.0, &directory.join("bolts.vtu")).unwrap();
    write_supports_vtu(&supports, &names, 1.0, &directory.join("supports.vtu")).unwrap();
    write_water_vtu(&water, 1.0, &directory.join("water.vtu")).unwrap();
    let read = |name: &str| fs::read_to_string(directory.join(name)).unwrap();
    let text = read("bolts.vtu");
    let document = Document::parse(&text).unwrap();
    assert_eq!(numbers(&document, "force"), [2.5e5; 4]);
    assert_eq!(bytes(&document, "state"), [0, 1, 2, 3]);
    assert_eq!(components(&document, "bolt_names"), names);
    let text = read("supports.vtu");
    let document = Document::parse(&text).unwrap();
    assert_eq!(numbers(&document, "reaction"), [-3.0, 5.0, 0.0].repeat(3));
    assert_eq!(bytes(&document, "kind"), [0, 1, 2]);
    let text = read("water.vtu");
    let document = Document::parse(&text).unwrap();
    assert_eq!(numbers(&document, "water_pressure"), [0.0, 1e4]);
    assert_eq!(integers(&document, "block"), [7]);
    assert_eq!(numbers(&document, "Points"), [1.0, 2.0, 0.0, 3.0, 4.0, 0.0]);
    let text = read("flow.vtu");
    let document = Document::parse(&text).unwrap();
    assert_eq!(numbers(&document, "pressure_head"), [3.0, 0.5]);
    assert_eq!((numbers(&document, "head"), numbers(&document, "flow")), (vec![4.75], vec![-1e-6]));
    assert_eq!(integers(&document, "block"), [7]);
}

/// meshio rejects a file without cells, so an empty grid has one cell that has no points.
#[test]
fn a_snapshot_without_content_is_written() {
    let directory = directory("vtu_empty");
    write_vtu(&Snapshot::default(), &directory.join("elements.vtu")).unwrap();
    write_joints_vtu(&[], &[], 0.0, &directory.join("joints.vtu")).unwrap();
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
    let mut run = PvdWriter::new(&directory, PARTS.to_vec()).unwrap();
    run.push(&slope.reference, &beside(&slope)).unwrap();
    for k in 1..4 {
        run.push(&slope.moved(f64::from(k) * 0.1, f64::from(k)), &beside(&slope)).unwrap();
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
    let mut run = PvdWriter::open_for_append(&directory, PARTS.to_vec(), 0.0).unwrap();
    for time in [0.0, 0.1, 0.2] {
        run.push(&slope.moved(time, 1.0), &beside(&slope)).unwrap();
    }
    let mut resumed = PvdWriter::open_for_append(&directory, PARTS.to_vec(), 0.1).unwrap();
    assert_eq!(listed(&directory), listing(&[0.0, 0.1]));
    resumed.push(&slope.moved(0.25, 1.0), &beside(&slope)).unwrap();
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
        let error = PvdWriter::open_for_append(&directory, PARTS.to_vec(), 1.0).unwrap_err();
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
    let entries = entries.inspect(|node| {
        let begins = format!("frames/{}_", of(*node, "name"));
        assert!(of(*node, "file").starts_with(&begins), "{node:?}");
    });
    entries.map(|node| (of(node, "timestep").parse().unwrap(), of(node, "part"), of(node, "file"))).collect()
}

fn listing(times: &[f64]) -> Vec<(f64, String, String)> {
    let parts = |(k, &time): (usize, &f64)| {
        let entry = move |part: usize, name: &str| (time, part.to_string(), format!("frames/{name}_{k:04}.vtu"));
        [entry(0, "elements"), entry(1, "joints")]
    };
    times.iter().enumerate().flat_map(parts).collect()
}
