//! Joints that lie closer than any memory can hold are refused before they are cut, by key, value, limit and remedy;
//! copies of a joint cost nothing. Floods of joints once took all memory of the process and of its host with it.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use crate::common::random::Random;
use enmm::geometry::{Label, Point, Segment, TraceId, arrange, arrange_within};
use enmm::model::{BuildStage, Simulation};
use enmm_io::parse_case;

/// A square of 10 m with some joints, and a limit of memory (bytes).
fn case(joints: &str, memory: u64) -> String {
    format!(
        "title = \"t\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 10], [0, 10]]\n[mesh]\nsize = 1.0\n\
         [solver]\nmemory_limit = {memory}\n{joints}\n[joint_law.j]\nfriction_deg = 30\n\
         [rock.r]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n[[fix]]\nedge = [[0, 0], [10, 0]]\n\
         [[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 0.5\n"
    )
}

/// Parallel joints at a distance (m).
fn parallel(count: usize, distance: f64) -> String {
    (0..count).fold(String::new(), |mut text, k| {
        let y = k as f64 * distance;
        let _ = writeln!(text, "[[joint]]\npoints = [[-1, {:?}], [11, {:?}]]", 4.0 + y, 4.5 + y);
        text
    })
}

/// Asserts that a case is refused, with these parts in the message.
fn refused(text: &str, parts: &[&str]) {
    let loaded = parse_case(text, "case.toml", Path::new("")).expect("reads");
    let error = Simulation::new(loaded.case).expect_err("too large").to_string();
    for part in parts.iter().chain(&["limit", "memory_limit"]) {
        assert!(error.contains(part), "{part:?} is not in {error}");
    }
}

#[test]
fn a_joint_set_of_a_tenth_of_a_millimetre_is_refused_before_it_is_made() {
    let clock = Instant::now();
    let set = |dip: f64| format!("[[joint_set]]\nangle_deg = {dip}\nspacing = 1e-4\n");
    refused(&case(&set(30.0), 8 << 30), &["joint_set[0].spacing: 1e-4 m", "raise the spacing"]);
    let many: String = (0..1700).map(|k| set(0.1 * f64::from(k))).collect();
    refused(&case(&many, 8 << 30), &["joint_set[", "spacing"]);
    assert!(clock.elapsed().as_secs_f64() < 5.0, "{:?}", clock.elapsed());
}

#[test]
fn thousands_of_joints_within_a_millimetre_are_refused_before_they_are_cut() {
    let clock = Instant::now();
    refused(&case(&parallel(20_000, 1e-5), 8 << 30), &["mesh.size: 1 m", "fewer joints"]);
    assert!(clock.elapsed().as_secs_f64() < 10.0, "{:?}", clock.elapsed());
}

/// Joints between random places.
fn random(count: usize) -> String {
    let mut random = Random::from_word(1);
    let mut next = || (random.word() >> 54) as f64 / 102.4;
    (0..count).fold(String::new(), |mut text, _| {
        let _ = writeln!(text, "[[joint]]\npoints = [[{}, {}], [{}, {}]]", next(), next(), next(), next());
        text
    })
}

#[test]
fn thousands_of_joints_across_each_other_are_refused_before_they_are_cut() {
    // They took more than two seconds, most of them for some million edges that no memory could hold then.
    let loaded = parse_case(&case(&random(2_800), 8 << 30), "case.toml", Path::new("")).expect("reads");
    let mut told = Vec::new();
    let error = Simulation::build(loaded.case, &mut |stage| told.push(stage)).expect_err("too large").to_string();
    assert!(error.contains("mesh.size: 1 m") && error.contains("fewer joints"), "{error}");
    assert!(!told.contains(&BuildStage::Arrangement), "{told:?}");
}

#[test]
fn joints_that_are_one_within_the_snap_tolerance_cross_nowhere() {
    let near = |k: usize| {
        format!("[[joint]]\npoints = [[-1, {:e}], [11, {:e}]]\n", 4.0 + 1e-9 * k as f64, 4.5 - 1e-9 * k as f64)
    };
    let loaded = parse_case(&case(&(0..600).map(near).collect::<String>(), 100 << 20), "case.toml", Path::new(""));
    let built = Simulation::new(loaded.expect("reads").case).expect("one joint");
    assert_eq!(built.model().covers.block_count(), 2);
}

#[test]
fn crossings_are_counted_while_they_are_made() {
    // 300 joints one way and 300 another cross 90 000 times: 180 600 edges.
    let line = |k: u32, a: [f64; 2], b: [f64; 2]| Segment {
        a: Point::from(a),
        b: Point::from(b),
        label: Label::trace(TraceId::new(k as usize)),
    };
    let along = |k: u32| line(k, [0.0, f64::from(k) * 0.1], [30.0, f64::from(k) * 0.1]);
    let across = |k: u32| line(300 + k, [f64::from(k) * 0.1, -1.0], [f64::from(k) * 0.1, 31.0]);
    let segments: Vec<Segment> = (0..300).map(along).chain((0..300).map(across)).collect();
    let error = arrange_within(&segments, 1e-6, 100_000).expect_err("too many").to_string();
    assert!(error.contains("more than 100000 pieces"), "{error}");
    assert!(arrange_within(&segments, 1e-6, 200_000).is_ok());
}

#[test]
fn copies_of_a_joint_are_reported_and_cost_nothing() {
    let clock = Instant::now();
    let segment = |a: [f64; 2], b: [f64; 2], label| Segment { a: Point::from(a), b: Point::from(b), label };
    let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    let outline = |k: usize| segment(corners[k], corners[(k + 1) % 4], Label::OUTLINE);
    let joints = |copies: usize| -> Vec<Segment> {
        let joint = |k| segment([-1.0, 4.0], [11.0, 4.5], Label::trace(TraceId::new(k)));
        let other = segment([3.0, -1.0], [4.0, 11.0], Label::trace(TraceId::new(copies)));
        (0..4).map(outline).chain((0..copies).map(joint)).chain([other]).collect()
    };
    let [one, many] = [1, 20_000].map(|copies| arrange(&joints(copies), 1e-6).expect("arranges"));
    assert_eq!((&one.points, &one.next, &one.face), (&many.points, &many.next, &many.face));
    let report = &many.report;
    assert!(report.traces[..20_000].iter().all(|&length| length == one.report.traces[0]));
    assert_eq!(report.traces[20_000], one.report.traces[1]);
    let pairs: Vec<[TraceId; 2]> = (1..20_000).map(|copy| [0, copy].map(TraceId::new)).collect();
    assert_eq!(report.overlapping_traces, pairs);
    assert!(clock.elapsed().as_secs_f64() < 5.0, "{:?}", clock.elapsed());
}

#[test]
fn a_long_strip_across_the_lattice_is_cut_where_it_is() {
    let strip = |length: f64| {
        let outline = format!("outline = [[0, 0], [{length}, 0], [{length}, 10], [0, 10]]");
        let text = case("", 8 << 30).replace("outline = [[0, 0], [10, 0], [10, 10], [0, 10]]", &outline);
        text.replace("edge = [[0, 0], [10, 0]]", &format!("edge = [[0, 0], [{length}, 0]]"))
    };
    let build = |text: String| {
        let loaded = parse_case(&text, "case.toml", Path::new("")).expect("reads");
        Simulation::new(loaded.case)
    };
    let clock = Instant::now();
    let turned = |length| strip(length).replace("size = 1.0", "size = 1.0\nangle_deg = 30");
    assert_eq!(build(turned(10_000.0)).expect("fits").model().covers.block_count(), 1);
    assert!(clock.elapsed().as_secs_f64() < 10.0, "{:?}", clock.elapsed());
    let error = build(turned(100_000.0)).expect_err("no numbers").to_string();
    assert!(error.contains("mesh.angle_deg: 30°") && error.contains("at most"), "{error}");
    let away =
        strip(10.0).replace("size = 1.0", "size = 1e-3\norigin = [1e8, 0]").replace("8589934592", "1000000000000");
    let error = build(away).expect_err("no numbers").to_string();
    assert!(error.contains("mesh.origin: (100000000, 0) m"), "{error}");
}
