//! Pictures are PNG files of the promised size for every input, also one that makes no sense.

use std::path::Path;
use std::time::Instant;

use crate::sample::{Sample, profile, sample};
use enmm::contact::ContactState;
use enmm::geometry::{Point, Vector};
use enmm::model::Snapshot;
use enmm::model::snapshot::{Boundary, Polygons};
use enmm_picture::{
    ModelAnnotations, Picture, Series, StageEnd, StageStart, covers_picture, displacement_contours,
    displacement_picture, history_picture, joint_stress_pictures, joints_picture, mean_stress_contours, model_picture,
    stage_displacement_picture, stress_picture, velocity_picture,
};

/// Where a person can look at the pictures.
fn shown(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures").join(name)
}

/// Rasterises, checks the frame of the PNG and keeps it.
fn check(picture: &Picture, name: &str) {
    picture.write_png(&shown(name)).unwrap();
    let pixels = tiny_skia::Pixmap::load_png(shown(name)).unwrap();
    assert_eq!(pixels.width(), 1600);
    assert!((300..=1400).contains(&pixels.height()), "{name} is {} px high", pixels.height());
    let inked = pixels.pixels().iter().filter(|pixel| pixel.red() < 250).count();
    assert!(inked > 1000, "{name} is blank");
}

fn series(name: &str, unit: &str, value: impl Fn(f64) -> f64) -> Series {
    let points = (0..=2000).map(|k| f64::from(k) * 1e-3).map(|time| (time, value(time))).collect();
    Series { name: name.to_owned(), quantity: "amount".to_owned(), unit: unit.to_owned(), points }
}

#[test]
fn a_jointed_slope_is_drawn() {
    let slope = sample(3.4, 1.8);
    check(&model_picture(&slope.reference, &slope.annotations), "model.png");
    check(&covers_picture(&slope.reference, &slope.annotations, &slope.stars), "covers.png");
    let title = "Rock slope with two joint sets";
    check(&displacement_picture(&slope.moved(2.5, 2.0), title, &profile()), "displacement.png");
    check(&displacement_picture(&slope.moved(0.05, 2e-3), title, &profile()), "displacement_small.png");
}

/// Draws all pictures of the end of a stage.
fn check_stage(slope: &Sample, snapshot: &Snapshot, prefix: &str) {
    let stage = StageEnd {
        title: "Rock slope with two joint sets",
        caption: "stage 2, failure, t = 3 s".to_owned(),
        snapshot,
        bolts: &slope.annotations.bolts,
        water: &slope.annotations.water,
    };
    let [normal, shear] = joint_stress_pictures(&stage, &slope.joints());
    let pictures = [
        ("displacement", stage_displacement_picture(&stage, &snapshot.displacement)),
        ("velocity", velocity_picture(&stage)),
        ("stress", stress_picture(&stage)),
        ("displacement_contours", displacement_contours(&stage, &snapshot.displacement)),
        ("mean_stress_contours", mean_stress_contours(&stage, &slope.reference.elements.points)),
        ("joints", joints_picture(&stage, &slope.joints())),
        ("normal_stress", normal),
        ("shear_stress", shear),
    ];
    for (name, picture) in &pictures {
        check(picture, &format!("{prefix}_{name}.png"));
        assert!(!picture.svg().contains("NaN") && !picture.svg().contains("inf"), "{prefix} {name}");
    }
}

#[test]
fn the_end_of_a_stage_is_drawn() {
    let slope = sample(6.0, 2.0);
    check_stage(&slope, &slope.moved(3.0, 2.0), "stage");
    check_stage(&slope, &slope.reference, "still");
    let nothing = Sample { annotations: ModelAnnotations::default(), ..sample(20.0, 10.0) };
    check_stage(&nothing, &Snapshot::default(), "nothing");
}

/// Open and slipping joints must differ by more than their colour.
#[test]
fn states_of_joints_differ_by_the_shape_of_their_lines() {
    let slope = sample(12.0, 6.0);
    let stage = StageEnd { title: "", caption: String::new(), snapshot: &slope.reference, bolts: &[], water: &[] };
    let picture = joints_picture(&stage, &slope.joints());
    let widths = ["1.8", "3.6", "5"].map(|width| format!("stroke-width=\"{width}\""));
    assert!(widths.iter().all(|width| picture.svg().contains(width)));
    let lock = slope.joints().iter().filter(|joint| joint.state == ContactState::Lock).count();
    assert!(lock > 0 && picture.svg().contains("lock: "));
}

#[test]
fn histories_are_drawn_by_quantity() {
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
    let stages = [("gravity", 0.0), ("failure", 0.7)].map(|(name, time)| StageStart { name: name.to_owned(), time });
    let picture = history_picture("Monitors of the rock slope", &all, &stages);
    check(&picture, "history.png");
    for text in ["amount [m]", "amount [10⁶ J]", ">gravity<", ">failure<"] {
        assert!(picture.svg().contains(text), "{text}");
    }
}

/// The water, a load and a support each have their sign, and the legend names it.
#[test]
fn the_model_names_what_acts_on_it() {
    let slope = sample(12.0, 6.0);
    let picture = model_picture(&slope.reference, &slope.annotations);
    let names = ["held along x and y", "held along one axis", "quiet boundary", "free field", "box held", "block held"];
    let more =
        ["water table", "load", "pressure in joints", "bolt", "bolt installed later", "monitor", "port in joints"];
    for name in names.iter().chain(&more).chain(&["set 1: 38°, every 3.4 m", "10 kPa"]) {
        assert!(picture.svg().contains(&format!(">{name}<")), "{name}");
    }
    // A monitor and a port of one name and place have one label.
    assert_eq!(picture.svg().matches(">crest<").count(), 1);
    assert!(!picture.svg().contains("cover"));
    let bare = model_picture(&slope.reference, &ModelAnnotations::default());
    assert!(names.iter().chain(&more).filter(|name| **name != "block held").all(|name| !bare.svg().contains(*name)));
}

#[test]
fn input_without_content_is_drawn() {
    let empty = Snapshot::default();
    check(&model_picture(&empty, &ModelAnnotations::default()), "empty_model.png");
    check(&displacement_picture(&empty, "", &Polygons::default()), "empty_displacement.png");
    check(&history_picture("nothing", &[], &[]), "empty_history.png");
    check(&history_picture("no points", &[Series { unit: "m".into(), ..Series::default() }], &[]), "no_points.png");
    let constant = [series("zero", "m", |_| 0.0), series("five", "J", |_| 5.0)];
    check(&history_picture("constant", &constant, &[]), "constant.png");
    let one = [Series { points: vec![(1.0, 2.0)], ..Series::default() }];
    check(&history_picture("one point", &one, &[StageStart::default(), StageStart::default()]), "one_point.png");
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
    let (mut annotations, mut stars) = (slope.annotations, slope.stars);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, f64::MIN_POSITIVE] {
        let k = broken.displacement.len() / 2;
        broken.displacement[k] = Vector::repeat(bad);
        broken.elements.points[k] = Vector::new(bad, 1.0);
        broken.boundaries[3].loops.points[0].x = bad;
        stars[0].0.x = bad;
        annotations.held[0].points[0].y = bad;
        annotations.bolts[0].ends[0].x = bad;
        annotations.water[0].y = bad;
        annotations.sets[0].place = Some(Point::new(bad, 1.0));
        annotations.monitors[0].1.x = bad;
        annotations.trace_segments[0].0[1].y = bad;
        check(&model_picture(&broken, &annotations), "broken_model.png");
        check(&covers_picture(&broken, &annotations, &stars), "broken_covers.png");
        check(&displacement_picture(&broken, "broken", &profile()), "broken_displacement.png");
        let spike = series("spike", "m", |t| if t == 1.0 { bad } else { t });
        let stage = StageStart { name: "bad".to_owned(), time: bad };
        let series = [spike, series("only", "J", |_| bad)];
        check(&history_picture("spike", &series, &[stage.clone(), stage]), "broken_history.png");
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
    let svg = picture.svg();
    let mut reader = quick_xml::Reader::from_str(&svg);
    let mut titles = 0;
    while let event = reader.read_event().unwrap()
        && event != quick_xml::events::Event::Eof
    {
        titles += usize::from(matches!(&event, quick_xml::events::Event::Start(tag) if tag.name().0 == "script"));
    }
    assert_eq!(titles, 0);
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
