//! Pictures are PNG files of the promised size for every input, also one that makes no sense.

mod output_sample;

use std::path::Path;
use std::time::Instant;

use enmm::geometry::{Point, Vector};
use enmm::model::Snapshot;
use enmm::model::snapshot::{Boundary, Polygons};
use enmm_picture::{ModelAnnotations, Picture, Series, displacement_picture, history_picture, model_picture};
use output_sample::{profile, sample};

/// Where a person can look at the pictures.
fn shown(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures").join(name)
}

/// Rasterises, checks the frame of the PNG and keeps it.
fn check(picture: &Picture, name: &str) {
    picture.write_png(&shown(name)).unwrap();
    let pixels = resvg::tiny_skia::Pixmap::load_png(shown(name)).unwrap();
    assert_eq!(pixels.width(), 1600);
    assert!((300..=1400).contains(&pixels.height()), "{name} is {} px high", pixels.height());
    let inked = pixels.pixels().iter().filter(|pixel| pixel.red() < 250).count();
    assert!(inked > 1000, "{name} is blank");
}

fn series(name: &str, unit: &str, value: impl Fn(f64) -> f64) -> Series {
    let points = (0..=2000).map(|k| f64::from(k) * 1e-3).map(|time| (time, value(time))).collect();
    Series { name: name.to_owned(), unit: unit.to_owned(), points }
}

#[test]
fn a_jointed_slope_is_drawn() {
    let slope = sample(3.4, 1.8);
    check(&model_picture(&slope.reference, &slope.annotations), "model.png");
    let title = "Rock slope with two joint sets";
    check(&displacement_picture(&slope.moved(2.5, 2.0), title, &profile()), "displacement.png");
    check(&displacement_picture(&slope.moved(0.05, 2e-3), title, &profile()), "displacement_small.png");
}

#[test]
fn histories_are_drawn_by_unit() {
    let all = [
        series("crest horizontal", "m", |t| -0.02 * t * t),
        series("crest vertical", "m", |t| -0.012 * t * t + 5e-4 * (40.0 * t).sin()),
        series("kinetic energy", "J", |t| 4e6 * t * t * (-t).exp()),
        series("strain energy", "J", |t| 2.5e6 + 1e5 * (30.0 * t).sin()),
        series("friction", "J", |t| 3e6 * t),
        series("sliding contacts", "", |t| (120.0 * t).floor()),
        series("unbalanced ratio", "", |_| 0.5),
        series("crest velocity", "m/s", |t| -0.04 * t),
    ];
    check(&history_picture("Monitors of the rock slope", &all), "history.png");
}

#[test]
fn input_without_content_is_drawn() {
    let empty = Snapshot::default();
    check(&model_picture(&empty, &ModelAnnotations::default()), "empty_model.png");
    check(&displacement_picture(&empty, "", &Polygons::default()), "empty_displacement.png");
    check(&history_picture("nothing", &[]), "empty_history.png");
    check(&history_picture("no points", &[Series { unit: "m".into(), ..Series::default() }]), "no_points.png");
    check(&history_picture("constant", &[series("zero", "m", |_| 0.0), series("five", "J", |_| 5.0)]), "constant.png");
    check(&history_picture("one point", &[Series { points: vec![(1.0, 2.0)], ..Series::default() }]), "one_point.png");
}

#[test]
fn one_element_is_drawn() {
    let triangle = Polygons {
        start: vec![0, 3],
        points: vec![Point::new(5e5, 5e6), Point::new(5e5 + 1.0, 5e6), Point::new(5e5, 5e6 + 1.0)],
    };
    let one = Snapshot { elements: triangle, displacement: vec![Vector::zeros(); 3], ..Snapshot::default() };
    check(&model_picture(&one, &ModelAnnotations::default()), "one_model.png");
    check(&displacement_picture(&one, "one element at rest", &one.elements), "one_displacement.png");
}

#[test]
fn numbers_that_are_not_finite_are_left_out() {
    let slope = sample(12.0, 6.0);
    let mut broken = slope.moved(f64::NAN, 1.0);
    let mut annotations = slope.annotations;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, f64::MIN_POSITIVE] {
        let k = broken.displacement.len() / 2;
        broken.displacement[k] = Vector::repeat(bad);
        broken.elements.points[k] = Vector::new(bad, 1.0);
        broken.boundaries[3].loops.points[0].x = bad;
        annotations.stars[0].0.x = bad;
        annotations.fixed[0].y = bad;
        annotations.monitors[0].1.x = bad;
        annotations.trace_segments[0].0[1].y = bad;
        check(&model_picture(&broken, &annotations), "broken_model.png");
        check(&displacement_picture(&broken, "broken", &profile()), "broken_displacement.png");
        let spike = series("spike", "m", |t| if t == 1.0 { bad } else { t });
        check(&history_picture("spike", &[spike, series("only", "J", |_| bad)]), "broken_history.png");
    }
}

#[test]
fn fields_of_wrong_length_are_drawn_as_far_as_they_go() {
    let slope = sample(12.0, 6.0);
    let mut short = slope.reference.clone();
    short.block.clear();
    short.displacement.truncate(5);
    short.elements.start.push(u32::MAX);
    short
        .boundaries
        .push(Boundary { loops: Polygons { start: vec![7, 2], points: Vec::new() }, ..Boundary::default() });
    check(&model_picture(&short, &slope.annotations), "short_model.png");
    check(&displacement_picture(&short, "short", &profile()), "short_displacement.png");
}

#[test]
fn names_with_markup_stay_text() {
    let mut slope = sample(20.0, 10.0);
    slope.annotations.title = "a < b & \"c\" > d \u{1} \u{0}".to_owned();
    slope.annotations.monitors[0].0 = "</text><script>".to_owned();
    slope.annotations.monitors[1].0 = "岩盤 \u{1f3d4}".to_owned();
    let picture = model_picture(&slope.reference, &slope.annotations);
    check(&picture, "markup.png");
    resvg::usvg::roxmltree::Document::parse(picture.svg()).unwrap();
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let slope = sample(12.0, 6.0);
    let draw = || displacement_picture(&slope.moved(1.0, 1e-3), "twice", &profile()).png().unwrap();
    assert_eq!(draw(), draw());
}

/// 50 000 elements in release take less than 3 s; the limit here leaves room for an unoptimised or busy machine.
#[test]
fn a_large_slope_is_drawn_in_time() {
    let slope = sample(1.6, 0.75);
    assert!(slope.reference.elements.len() > 20_000);
    let moved = slope.moved(2.5, 2.0);
    let start = Instant::now();
    check(&displacement_picture(&moved, "large", &profile()), "large_displacement.png");
    check(&model_picture(&slope.reference, &slope.annotations), "large_model.png");
    println!("{} elements in {:?}", slope.reference.elements.len(), start.elapsed());
    assert!(start.elapsed().as_secs() < 60);
}
