//! The mesh does not change the geology: the same ends are joined and the same blocks cut on every mesh.

use std::fmt::Write;
use std::path::Path;

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::case::Case;
use enmm_io::parse_case;

use crate::common::extent::by_extent;
use crate::common::random::Random;
use crate::common::root;

const REST: &str = "[rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
                    [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 2\n";

fn read(text: &str, folder: &Path) -> Case {
    parse_case(text, "case.toml", folder).unwrap_or_else(|e| panic!("{e}")).case
}

/// The model of a case on a mesh of some size (m), with one least area (m²) of a block for all meshes.
fn on_mesh(case: &Case, size: f64, least_block: f64) -> Simulation {
    let mut case = case.clone();
    (case.mesh.size, case.mesh.least_block) = (size, Some(least_block));
    Simulation::new(case).unwrap_or_else(|e| panic!("{size} m: {}: {}", e.key, e.message))
}

/// Asserts that all blocks above twice the least area are as many, and the same ends joined, on three meshes (m).
fn assert_alike(what: &str, case: &Case, sizes: [f64; 3], least: f64) {
    let [first, others @ ..] = sizes.map(|size| on_mesh(case, size, least));
    let count =
        |s: &Simulation| s.model().covers.blocks().filter(|&b| s.model().covers.block_area(b) > 2.0 * least).count();
    for (other, size) in others.iter().zip(&sizes[1..]) {
        assert_eq!(count(other), count(&first), "{what}: blocks on {size} m and on {} m", sizes[0]);
        assert_eq!(other.built().ends, first.built().ends, "{what}: ends on {size} m and on {} m", sizes[0]);
    }
    assert!(first.built().traces.iter().flat_map(|(points, _)| points).all(|p| p.iter().all(|x| x.is_finite())));
}

/// A map of wavy traces of 7 points in a square (m), some of which end near others.
fn map(side: f64, traces: usize, length: f64, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = format!(
        "title = \"map\"\n[domain]\noutline = [[0, 0], [{side}, 0], [{side}, {side}], [0, {side}]]\njoint_law = \"j\"\n\
         [mesh]\nsize = 1\n{REST}"
    );
    for k in 0..traces {
        let mut angle = [0.3, 1.4, 2.5][k % 3] + random.between(-0.2, 0.2);
        let step = length * random.between(0.1, 1.0) / 6.0;
        let mut at = Point::new(random.between(0.0, side), random.between(0.0, side));
        let mut points = vec![[at.x, at.y]];
        for _ in 0..6 {
            angle += random.between(-0.2, 0.2);
            at += Point::new(angle.cos(), angle.sin()) * step;
            points.push([at.x, at.y]);
        }
        writeln!(text, "[[joint]]\npoints = {points:?}").expect("text");
    }
    text
}

/// A map as large as real ones was refused at 18 m, "lines lie so close together", and a real one at 2 m as not finite.
#[test]
fn a_map_of_5000_traces_builds_on_meshes_of_any_size() {
    let case = read(&map(400.0, 5000, 16.0, 1), Path::new(""));
    let sizes = by_extent([[8.0, 18.0, 50.0], [4.0, 18.0, 50.0], [2.0, 18.0, 60.0]]);
    let models = sizes.map(|size| on_mesh(&case, size, 0.16));
    let ends = models.each_ref().map(|model| model.built().ends.len());
    assert!(ends[0] > 1000 && ends == [ends[0]; 3], "{ends:?}");
}

/// Two short traces whose ends were joined to each other until a stretch between two ends had no length.
#[test]
fn ends_of_two_short_traces_that_are_joined_to_each_other_build() {
    let joints = "[[joint]]\npoints = [[0.19, 0.26], [0.27, 0.31]]\n[[joint]]\n\
                  points = [[0.137, 0.19], [0.219, 0.187], [0.285, 0.19], [0.312, 0.164]]\n";
    let outline = "[[-20, -10], [20, -10], [20, 20], [-20, 20]]";
    for (extend, size) in [(0.0, 2.0), (0.05, 2.0), (0.2, 2.0), (0.2, 30.0), (1.0, 0.7)] {
        let text = format!(
            "title = \"t\"\n[domain]\noutline = {outline}\njoint_law = \"j\"\nextend_ends = {extend}\n[mesh]\n\
             size = {size}\n{REST}{joints}"
        );
        let case = read(&text, Path::new(""));
        let model = on_mesh(&case, size, 0.01);
        assert_eq!(model.model().covers.block_count(), 1, "{extend} m");
    }
}

/// Short traces in a heap, whose ends lie near each other, on each other and on nodes, at every length.
#[test]
fn heaps_of_short_traces_build_alike() {
    for seed in 0..by_extent([6, 30, 200]) {
        let side = 4.0;
        let mut text = map(side, 60, 0.5, seed);
        let mut random = Random::new(1000 + seed);
        let (mut at, mut node) = (Point::new(2.0, 2.0), |step: f64| random.between(-step, step));
        // A chain of stretches, doubled points, stretches that lie on others and ends on nodes of the drawing.
        for k in 0..20 {
            let to = at + Point::new(node(0.3), node(0.3));
            let [near, beyond] = [at + Point::new(node(0.02), node(0.02)), at + (to - at) * 1.5];
            let points = [[at, at, to], [at, to, to], [near, to, beyond], [at, to, near], [to, beyond, at]][k % 5];
            writeln!(text, "[[joint]]\npoints = {:?}", points.map(|p| [p.x, p.y])).expect("text");
            at = if k % 7 == 6 { Point::new(1.0 + 0.1 * k as f64, 2.0) } else { to };
        }
        let mut case = read(&text, Path::new(""));
        for extend in [None, Some(0.03), Some(0.3), Some(5.0)] {
            case.domain.extend_ends = extend;
            assert_alike(&format!("seed {seed}, {extend:?}"), &case, [0.3, 1.0, 7.0], 4e-4);
        }
    }
}

/// The template of `enmm new slope` with the seeds of its sets changed.
fn template(seed: u64) -> Case {
    let path = root().join("crates/cli/templates/slope.toml");
    let mut case = read(&std::fs::read_to_string(path).expect("a template"), Path::new(""));
    for (k, set) in case.joint_sets.iter_mut().enumerate() {
        set.seed = 100 * seed + k as u64;
    }
    case
}

#[test]
fn slopes_have_the_same_blocks_on_every_mesh() {
    for seed in 0..by_extent([4, 12, 40]) {
        assert_alike(&format!("seed {seed}"), &template(seed), [1.0, 1.5, 3.0], 0.0056);
    }
}
