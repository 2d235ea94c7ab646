//! Claim: a drawing and features show the slope of a film: blocks where they are, free faces, bolts, supports, water.

use std::path::Path;

use enmm_export::{Instant, Scene, drawing, features};
use enmm_report::{
    Axis, BlockFrame, BlockNumber, BoltFrame, BoltPlace, FilmWriter, Frame, Head, Mesh, Outline, Structures,
    SupportFrame,
};
use serde_json::Value;

const NUMBERS: [&str; 8] = [
    "displacement_x",
    "displacement_y",
    "rotation",
    "velocity_x",
    "velocity_y",
    "mean_stress_xx",
    "mean_stress_yy",
    "mean_stress_xy",
];

fn head() -> Head {
    let number =
        |name: &str| BlockNumber { name: name.to_owned(), unit: "m".to_owned(), meaning: name.to_owned(), range: None };
    Head {
        title: "Three blocks".to_owned(),
        command: "run".to_owned(),
        version: "0".to_owned(),
        case_file: "case.toml".to_owned(),
        case_text: String::new(),
        axis: Axis::time(),
        block_numbers: NUMBERS.map(number).into(),
        columns: Vec::new(),
        monitors: Vec::new(),
        bolts: vec![BoltPlace { name: "row".to_owned(), ends: [[1.0, 5.0], [2.0, 1.0]] }],
        rocks: vec!["gneiss".to_owned(), "marl & clay".to_owned()],
    }
}

fn outline(id: u32, rock: u16, loops: Vec<Vec<[f64; 2]>>) -> Outline {
    let points = &loops[0];
    let middle = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64);
    Outline {
        id,
        fixed: id == 0,
        rock,
        area: 1.0 + f64::from(id),
        mass: 2e3,
        centroid: middle,
        loops,
        mesh: Mesh::default(),
    }
}

/// A floor of 8 m × 2 m with a hole, a block of 4 m × 3 m on its left half, and one on its right half that is
/// excavated; no corner of the floor is where the two meet.
fn outlines() -> Vec<Outline> {
    let rect = |x: [f64; 2], y: [f64; 2]| vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    let mut hole = rect([3.0, 5.0], [0.5, 1.5]);
    hole.reverse();
    vec![
        outline(0, 0, vec![rect([0.0, 8.0], [0.0, 2.0]), hole]),
        outline(1, 1, vec![rect([0.0, 4.0], [2.0, 5.0])]),
        outline(2, 0, vec![rect([4.0, 8.0], [2.0, 5.0])]),
    ]
}

/// Two frames: at rest, then the block on the left has moved by (−0.25, 0.5) m.
fn film(folder: &Path) {
    let mut film = FilmWriter::create(&folder.join("film.bin"), &head(), &outlines()).expect("a film");
    for (time, [x, y]) in [(0.0, [0.0, 0.0]), (1.5, [-0.25, 0.5])] {
        let still = BlockFrame { removed: false, numbers: vec![0.0; NUMBERS.len()] };
        let moved = BlockFrame { removed: false, numbers: vec![x, y, 0.0, 3.0, 4.0, -1e6, -3e6, 0.0] };
        let blocks = [still.clone(), moved, BlockFrame { removed: true, ..still }];
        let mut corners = vec![[0.0; 2]; 16];
        corners[8..12].fill([x, y]);
        let structures = Structures {
            bolts: &[BoltFrame { condition: 2, displacement: [[x, y], [0.0, 0.0]], force: 5e4 }],
            supports: &[SupportFrame { place: [1.0, 0.0], axes: [false, true], absorbs: false }],
            water_weight: 9810.0,
            water_surface: &[[2.0, 1.0], [5.0, 1.25]],
            wet: &[],
        };
        let frame = Frame { time, stage: 0, blocks: &blocks, corners: &corners, edges: &[], monitors: &[], structures };
        film.frame(&frame).expect("a frame");
    }
    film.flush().expect("written");
}

fn scene(instant: Instant) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    film(folder.path());
    Scene::read(folder.path(), instant).expect("a slope")
}

/// Polylines of a layer in a drawing, closed or not, by the groups of the file.
fn polylines(text: &str, layer: &str) -> Vec<(bool, Vec<[f64; 2]>)> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let groups: Vec<(&str, &str)> = lines.chunks_exact(2).map(|group| (group[0], group[1])).collect();
    let mut found: Vec<(bool, Vec<[f64; 2]>)> = Vec::new();
    let mut entity = ("", "");
    for (code, value) in groups {
        let place = |value: &str| value.parse::<f64>().expect("a number");
        match code {
            "0" => entity = (value, ""),
            "8" => {
                entity.1 = value;
                if entity == ("POLYLINE", layer) {
                    found.push((false, Vec::new()));
                }
                if entity == ("VERTEX", layer) {
                    found.last_mut().expect("a polyline").1.push([0.0; 2]);
                }
            }
            "70" if entity == ("POLYLINE", layer) => found.last_mut().expect("a polyline").0 = value == "1",
            "10" | "20" if entity == ("VERTEX", layer) => {
                let points = &mut found.last_mut().expect("a polyline").1;
                points.last_mut().expect("a vertex")[usize::from(code == "20")] = place(value);
            }
            _ => {}
        }
    }
    found
}

#[test]
fn a_drawing_has_the_blocks_and_the_free_faces_where_they_are() {
    let scene = scene(Instant::End);
    assert!(scene.notes.iter().any(|note| note.contains("1 blocks have been excavated")), "{:?}", scene.notes);
    let text = drawing(&scene);
    let moved = [[-0.25, 2.5], [3.75, 2.5], [3.75, 5.5], [-0.25, 5.5]];
    assert_eq!(polylines(&text, "rock_marl___clay"), [(true, moved.to_vec())]);
    assert_eq!(polylines(&text, "rock_gneiss").len(), 2, "the floor with its hole");
    assert_eq!(polylines(&text, "hole"), [(true, vec![[3.0, 1.5], [5.0, 1.5], [5.0, 0.5], [3.0, 0.5]])]);
    // The floor is free but for its left half above; the block but for its lower side, also where the third one was.
    let floor = vec![[0.0, 2.0], [0.0, 0.0], [8.0, 0.0], [8.0, 2.0], [4.0, 2.0]];
    let block = vec![[3.75, 2.5], [3.75, 5.5], [-0.25, 5.5], [-0.25, 2.5]];
    assert_eq!(polylines(&text, "outline"), [(false, floor), (false, block)]);
    // Level to both ends of the slope.
    assert_eq!(polylines(&text, "water"), [(false, vec![[-0.25, 1.0], [2.0, 1.0], [5.0, 1.25], [8.0, 1.25]])]);
    // The displacement of 0.559 m is more than 5 % of 8.25 m: it is not enlarged.
    assert!(text.contains("displacement x 1, largest 5.590e-1 m"));
    assert!(!text.lines().any(|line| line.chars().count() > 255));
}

#[test]
fn features_have_the_numbers_of_the_film() {
    let collection: Value = serde_json::from_str(&features(&scene(Instant::End))).expect("JSON");
    assert_eq!(collection["enmm"]["at"]["value"], 1.5);
    let all = collection["features"].as_array().expect("features");
    let of = |kind: &str| all.iter().filter(|one| one["properties"]["kind"] == kind).collect::<Vec<_>>();
    assert_eq!((of("block").len(), of("joint").len(), of("support").len()), (2, 0, 1));
    let block = &of("block")[1]["properties"];
    assert_eq!((&block["rock"], &block["speed"]), (&"marl & clay".into(), &5.0.into()));
    // (xx + yy)/2 and √(((xx − yy)/2)² + xy²), within the four digits of a film.
    let near = |name: &str, wanted: f64| (block[name].as_f64().expect("a number") / wanted - 1.0).abs() < 1e-4;
    assert!(near("mean_stress", -2e6) && near("max_shear", 1e6), "{block}");
    let bolt = of("bolt")[0];
    assert_eq!(bolt["properties"]["state"], "yielded");
    assert_eq!(bolt["geometry"]["coordinates"], serde_json::json!([[0.75, 5.5], [2.0, 1.0]]));
    let rings = of("block")[0]["geometry"]["coordinates"].as_array().expect("rings").len();
    assert_eq!(rings, 2);
}

#[test]
fn an_earlier_frame_has_the_supports_of_its_stage() {
    let first = scene(Instant::Frame(0));
    assert_eq!((first.axis.2, first.supports.len()), (0.0, 1));
    assert_eq!(scene(Instant::Time(1.4)).axis.2, 1.5);
    // The supports stand in the first frame of a stage alone.
    assert_eq!(scene(Instant::End).supports.len(), 1);
    assert!(!drawing(&first).contains("largest"), "nothing has moved");
}

#[test]
fn a_film_cut_at_any_byte_is_read_as_far_as_it_goes_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    film(folder.path());
    let path = folder.path().join("film.bin");
    let bytes = std::fs::read(&path).expect("a film");
    let mut read = 0;
    for end in (0..bytes.len()).step_by(7) {
        std::fs::write(&path, &bytes[..end]).expect("written");
        match Scene::read(folder.path(), Instant::End) {
            Ok(scene) => {
                assert_eq!(scene.axis.2, 0.0, "the second frame is torn");
                read += 1;
            }
            Err(error) => assert!(error.to_string().contains("film.bin"), "{error}"),
        }
    }
    assert!(read > 0);
}
