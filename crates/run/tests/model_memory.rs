//! Large models fit into memory: bytes per element are bounded, and 100 000 blocks run from case to pictures.

#[path = "../../../tests/common/extent.rs"]
mod extent;

use std::fmt::Write as _;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Instant;

use enmm::geometry::polygon;
use enmm::model::{BuildStage, Simulation};
use enmm_io::parse_case;
use enmm_run::{Observer, RunOptions, RunProgress};
use extent::by_extent;

/// A slope 100 m high, all of it cut by two joint sets of this spacing (m), or by none, that rests for a while (s).
fn slope(spacing: Option<f64>, mesh: f64, duration: f64) -> String {
    let mut text = format!(
        "title = \"Large slope\"\n[domain]\noutline = [[0, 0], [230, 0], [230, 120], [120, 120], [60, 20], [0, 20]]\n\
         [mesh]\nsize = {mesh}\nangle_deg = 7.0\n[solver]\nmemory_limit = 16000000000\n\
         [rock.gneiss]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n\
         [[fix]]\nedge = [[0, 0], [230, 0]]\n[[fix]]\nedge = [[230, 0], [230, 120]]\naxes = \"x\"\n\
         [[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration = {duration}\n[output]\nframe_interval = 1.0\n"
    );
    for (dip, seed) in [(36, 11), (118, 12)] {
        let Some(spacing) = spacing else { break };
        let (sd, dip_sd) = (0.15 * spacing, 0.4);
        let _ = write!(
            text,
            "[[joint_set]]\nangle_deg = {dip}\ndip_sd_deg = {dip_sd}\nspacing = {spacing}\nspacing_sd = {sd}\n\
             seed = {seed}\n"
        );
    }
    if spacing.is_some() {
        text.push_str("[joint_law.joint]\nfriction_deg = 45\n");
    }
    text
}

fn built(text: &str) -> Simulation {
    let clock = Instant::now();
    let mut tell = |stage: BuildStage| println!("{:8.3} s  {}", clock.elapsed().as_secs_f64(), stage.name());
    let simulation =
        Simulation::build(parse_case(text, "large.toml", Path::new(".")).unwrap().case, &mut tell).unwrap();
    println!("{:8.3} s  built", clock.elapsed().as_secs_f64());
    simulation
}

/// Time on a processor of this thread (s) where the system reports it, else on the clock: for reading, not for claims.
fn seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |time| 1e-9 * time)
}

/// Bytes of model, state and buffers.
fn bytes(simulation: &Simulation) -> [usize; 3] {
    let (slope, state, workspace) = (simulation.model(), simulation.state(), simulation.workspace());
    let elements = slope.covers.element_count();
    println!("{} blocks, {elements} elements, {} covers", slope.covers.block_count(), slope.covers.cover_count());
    for (heap, parts) in [("model", slope.memory()), ("state", state.memory()), ("buffers", workspace.memory())] {
        for (part, bytes) in parts.into_iter().filter(|part| part.1 > 0) {
            println!("{heap:<8} {part:<22} {:7.1} B an element", bytes as f64 / elements as f64);
        }
    }
    [slope.bytes(), state.bytes(), workspace.bytes()]
}

/// Ten elements, sixteen boundary edges and as many contacts a block: the limits are 15 % above what was counted when
/// they were set (352, 397, and 1252 on one thread; more threads have more runs of near pairs in hand).
#[test]
fn a_jointed_model_stays_within_its_bytes_per_element() {
    let mut simulation = built(&slope(Some(3.1), 2.38, 1.0));
    simulation.set_serial(true);
    simulation.advance(false).unwrap();
    let elements = simulation.model().covers.element_count();
    assert!((15_000..30_000).contains(&elements), "{elements}");
    for (bytes, limit) in bytes(&simulation).into_iter().zip([410, 456, 1440]) {
        assert!(bytes <= limit * elements, "{} bytes an element, limit {limit}", bytes / elements);
    }
}

#[test]
fn elements_are_found_by_place() {
    let simulation = built(&slope(Some(4.0), 3.0, 1.0));
    let covers = &simulation.model().covers;
    for e in covers.elements() {
        let centroid = covers.element_centroid[e];
        if polygon::contains(covers.polygon(e), centroid) {
            assert_eq!(covers.element_at(centroid), Some(e));
        }
        let corner = covers.polygon(e)[0];
        let lowest = covers.elements().find(|&e| polygon::contains(covers.polygon(e), corner));
        assert_eq!(covers.element_at(corner), lowest);
        let outside = corner + (corner - centroid) * 1e-6;
        assert!(covers.element_near(outside, 1e-5).is_some());
    }
    assert_eq!(covers.element_near([-5.0, 10.0].into(), 4.0), None);
    assert!(covers.element_near([-5.0, 10.0].into(), 5.001).is_some());
}

/// Largest resident memory of this process so far (bytes), where the system reports it.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}

/// Reports when a part of the build begins and when steps are taken.
struct Clock;

impl Observer for Clock {
    fn build(&mut self, stage: BuildStage) {
        println!("{:8.2} s  {}", seconds(), stage.name());
    }

    fn step(&mut self, progress: &RunProgress) {
        println!("{:8.2} s  step {}", seconds(), progress.step);
    }
}

/// Builds a model, runs its first steps and writes all outputs.
fn run(text: &str) {
    let loaded = parse_case(text, "large.toml", Path::new(".")).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let options = RunOptions { directory: directory.path().to_owned(), ..RunOptions::default() };
    let summary = enmm_run::run(&loaded, &options, &mut Clock).unwrap();
    println!("{:8.2} s  {:?}", seconds(), summary.wall_seconds);
    for entry in directory.path().read_dir().unwrap().chain(directory.path().join("frames").read_dir().unwrap()) {
        let entry = entry.unwrap();
        println!("{:9.2} MB  {}", entry.metadata().unwrap().len() as f64 / 1e6, entry.file_name().display());
    }
}

/// A hundred thousand blocks, then a million elements in one, with `ENMM_LONG=1`; a hundredth of both otherwise. The
/// peak was 2.25 GB before the iteration had rows of its own, which add 0.7 GB; the aim is 2 GB.
#[test]
fn long_a_hundred_thousand_blocks_run_from_case_to_pictures() {
    let large = by_extent([false, false, true]);
    let share = if large { 1.0 } else { 10.0 };
    let jointed = slope(Some(0.436 * share), 0.335 * share, 3e-4 * share);
    let whole = slope(None, 0.207 * share, 5e-4 * share);
    for text in [jointed, whole] {
        run(&text);
        println!("{:.2} GB peak so far", peak().unwrap_or_default() as f64 / 1e9);
    }
    assert!(!large || peak().is_none_or(|peak| peak < 3_300_000_000));
}
