//! Pictures show what they should where they should, and are PNG files of the promised size for every input, also one
//! that makes no sense.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use crate::sample::{PROFILE, Sample, sample};
use enmm::geometry::{Point, Vector};
use enmm::model::ContactState;
use enmm_observe::{BondState, Boundary, DrainFlow, FlowLine, Polygons, Seep, Snapshot, WaterInJoints};
use enmm_picture::{
    ModelAnnotations, Picture, Series, StageEnd, StageStart, covers_picture, displacement_contours,
    displacement_picture, flow_picture, history_picture, joint_stress_pictures, joints_picture, mean_stress_contours,
    model_picture, stage_displacement_picture, stress_picture, velocity_picture,
};
use quick_xml::events::Event;
use quick_xml::reader::Reader;
use tiny_skia::Pixmap;

/// Where a person can look at the pictures.
fn shown(name: &str) -> std::path::PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

/// Rasterises, checks the frame of the PNG and keeps it.
fn check(picture: &Picture, name: &str) {
    picture.write_png(&shown(name)).unwrap();
    let pixels = Pixmap::load_png(shown(name)).unwrap();
    assert_eq!(pixels.width(), 1600);
    assert!((300..=1400).contains(&pixels.height()), "{name} is {} px high", pixels.height());
    let inked = pixels.pixels().iter().filter(|pixel| pixel.red() < 250).count();
    assert!(inked > 1000, "{name} is blank");
}

/// Outline of the slope.
fn profile() -> Polygons {
    Polygons { start: vec![0, PROFILE.len() as u32], points: PROFILE.map(Point::from).to_vec() }
}

fn series(name: &str, unit: &str, value: impl Fn(f64) -> f64) -> Series {
    let points = (0..=2000).map(|k| f64::from(k) * 1e-3).map(|time| (time, value(time))).collect();
    Series { name: name.to_owned(), quantity: "amount".to_owned(), unit: unit.to_owned(), points }
}

/// Shapes and texts of SVG text: the name of the tag, attributes and text.
struct Drawn {
    tag: String,
    attributes: BTreeMap<String, String>,
    text: String,
}

impl Drawn {
    fn all(svg: &str) -> Vec<Self> {
        let mut reader = Reader::from_str(svg);
        let mut drawn: Vec<Self> = Vec::new();
        loop {
            match reader.read_event().unwrap() {
                Event::Start(tag) | Event::Empty(tag) => drawn.push(Self {
                    tag: tag.name().0.to_owned(),
                    attributes: tag
                        .attributes()
                        .map(|attribute| attribute.unwrap())
                        .map(|attribute| (attribute.key.0.to_owned(), attribute.value.into_owned()))
                        .collect(),
                    text: String::new(),
                }),
                Event::Text(text) => drawn.iter_mut().rev().take(1).for_each(|last| last.text.push_str(&text)),
                Event::Eof => return drawn,
                _ => {}
            }
        }
    }

    fn is(&self, key: &str, value: &str) -> bool {
        self.attributes.get(key).is_some_and(|own| own == value)
    }

    fn number(&self, key: &str) -> f64 {
        self.attributes[key].parse().unwrap()
    }

    /// The mean of the corners of the first outline (px).
    fn middle(&self) -> [f64; 2] {
        Self::middle_of(self.attributes["d"].split(['M', 'Z']).find(|outline| !outline.is_empty()).unwrap())
    }

    /// The mean of the corners of the last outline (px).
    fn last_middle(&self) -> [f64; 2] {
        Self::middle_of(self.attributes["d"].split(['M', 'Z']).rfind(|outline| !outline.is_empty()).unwrap())
    }

    fn middle_of(outline: &str) -> [f64; 2] {
        let corners: Vec<[f64; 2]> = outline
            .split('L')
            .map(|corner| corner.split_once(' ').unwrap())
            .map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()])
            .collect();
        [0, 1].map(|k| corners.iter().map(|corner| corner[k]).sum::<f64>() / corners.len() as f64)
    }
}

fn pixels(picture: &Picture) -> Pixmap {
    Pixmap::decode_png(&picture.png().unwrap()).unwrap()
}

fn colour_at(pixels: &Pixmap, [x, y]: [f64; 2]) -> String {
    let pixel = pixels.pixel(x as u32, y as u32).unwrap();
    format!("#{:02x}{:02x}{:02x}", pixel.red(), pixel.green(), pixel.blue())
}

/// Left, right, top and bottom of what is dark in a box of pixels.
fn ink(pixels: &Pixmap, [left, right, top, bottom]: [f64; 4]) -> [f64; 4] {
    let places = (top as u32..bottom as u32).flat_map(|y| (left as u32..right as u32).map(move |x| (x, y)));
    let dark = places.filter(|&(x, y)| pixels.pixel(x, y).unwrap().red() < 140);
    dark.fold([f64::INFINITY, 0.0, f64::INFINITY, 0.0], |[left, right, top, bottom], (x, y)| {
        let [x, y] = [f64::from(x), f64::from(y)];
        [left.min(x), right.max(x + 1.0), top.min(y), bottom.max(y + 1.0)]
    })
}

/// A free and a held block with a joint between them.
fn two_blocks() -> Picture {
    let square = |left: f64| [[left, 0.0], [left + 10.0, 0.0], [left + 10.0, 10.0], [left, 10.0]].map(Point::from);
    let both = Polygons { start: vec![0, 4, 8], points: [square(0.0), square(10.0)].concat() };
    let boundary = |block: u32| Boundary {
        block,
        fixed: block == 1,
        loops: Polygons { start: vec![0, 4], points: square(10.0 * f64::from(block)).to_vec() },
        ..Boundary::default()
    };
    let snapshot = Snapshot {
        elements: both,
        block: vec![0, 1],
        boundaries: vec![boundary(0), boundary(1)],
        joint_laws: vec!["bedding".to_owned()],
        ..Snapshot::default()
    };
    let joint = [Point::new(10.0, 0.0), Point::new(10.0, 10.0)];
    let title = "Two blocks".to_owned();
    model_picture(&snapshot, &ModelAnnotations { title, trace_segments: vec![(joint, 0)], ..Default::default() })
}

#[test]
fn blocks_and_joints_have_their_colours_where_the_svg_has_them() {
    let picture = two_blocks();
    let (drawn, pixels) = (Drawn::all(&picture.svg()), pixels(&picture));
    // Both blocks are of one rock, and one shape.
    let rock = drawn.iter().find(|shape| shape.is("fill", "#f0e6d0")).unwrap();
    let [free, held] = [rock.middle(), rock.last_middle()];
    assert_eq!(colour_at(&pixels, free), "#f0e6d0");
    // Slanting lines, 1.4 px wide every 9 px, cross the held block.
    let near = (0..8100).map(|k| [held[0] + f64::from(k % 90), held[1] + f64::from(k / 90)]);
    let plain = near.filter(|at| colour_at(&pixels, *at) == "#f0e6d0").count();
    assert!((4000..8100).contains(&plain), "{plain}");
    // On the joint, and in the legend.
    let joints: Vec<_> = drawn.iter().filter(|shape| shape.is("stroke", "#1f57a0")).map(Drawn::middle).collect();
    assert_eq!(joints.len(), 2);
    for [x, y] in joints {
        let near = (0..9).map(|k| [x + f64::from(k % 3) - 1.0, y + f64::from(k / 3) - 1.0]);
        assert!(near.map(|at| colour_at(&pixels, at)).any(|colour| colour == "#1f57a0"), "{x} {y}");
    }
}

#[test]
fn texts_stand_where_the_svg_has_them() {
    let picture = two_blocks();
    let (drawn, pixels) = (Drawn::all(&picture.svg()), pixels(&picture));
    let find = |text: &str| drawn.iter().find(|shape| shape.tag == "text" && shape.text.trim_end() == text).unwrap();
    let place = |text: &str| ["x", "y", "font-size"].map(|key| find(text).number(key));
    let [x, y, size] = place("Two blocks");
    let [left, right, top, bottom] = ink(&pixels, [x - 50.0, x + 300.0, y - size, y + 0.4 * size]);
    // 5.3 times as wide as the font is large, letters 0.76 times as high, no letter below the base line.
    assert!((left - x).abs() < 2.0 && (right - x - 5.3 * size).abs() < 4.0, "{left} to {right}");
    assert!((y - top - 0.76 * size).abs() < 2.0 && (bottom - y).abs() < 2.0, "{top} to {bottom}");
    let [x, y, size] = place("x [m]");
    let [left, right, ..] = ink(&pixels, [x - 100.0, x + 100.0, y - size, y]);
    assert!((0.5 * (left + right) - x).abs() < 2.0 && right - left > 2.0 * size, "{left} to {right}");
    let [x, y, size] = place("y [m]");
    let [.., top, bottom] = ink(&pixels, [x - size, x, y - 100.0, y + 100.0]);
    assert!((0.5 * (top + bottom) - y).abs() < 2.0 && bottom - top > 2.0 * size, "{top} to {bottom}");
}

#[test]
fn the_colours_of_a_bar_are_those_of_the_svg() {
    let picture = displacement_picture(&sample(12.0, 6.0).moved(1.0, 2.0), "slide", &profile());
    let (drawn, pixels) = (Drawn::all(&picture.svg()), pixels(&picture));
    let steps: Vec<_> = drawn.iter().filter(|shape| shape.tag == "rect" && shape.is("width", "26.00")).collect();
    let filled: Vec<_> = steps.iter().filter(|step| !step.is("fill", "none")).collect();
    assert_eq!(filled.len(), 64);
    for step in filled {
        let [left, top, width, height] = ["x", "y", "width", "height"].map(|key| step.number(key));
        assert!(step.is("fill", &colour_at(&pixels, [left + 0.5 * width, top + 0.5 * height])));
    }
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
    assert!(!picture.svg().contains("bridge"));
}

#[test]
fn rock_bridges_show_which_hold_and_which_have_broken() {
    let slope = sample(12.0, 6.0);
    let stage = StageEnd { title: "", caption: String::new(), snapshot: &slope.reference, bolts: &[], water: &[] };
    let mut joints = slope.joints();
    let length = |k: usize| (joints[k].ends[1] - joints[k].ends[0]).norm();
    let broken = length(0) + length(3);
    (joints[0].bond, joints[3].bond, joints[1].bond) = (BondState::Broken, BondState::Broken, BondState::Holds);
    let picture = joints_picture(&stage, &joints);
    check(&picture, "stage_joints_bridges.png");
    let said = |name: &str| {
        let text = picture.svg();
        text.split(name)
            .nth(1)
            .and_then(|text| text.split(" m").next())
            .and_then(|number| number.trim().parse::<f64>().ok())
            .unwrap_or_default()
    };
    assert!((said("broken bridge: ") / broken - 1.0).abs() < 0.01, "{} of {broken} m", said("broken bridge: "));
    assert!(said("bridge that holds: ") > 0.0);
}

/// A full joint, one with a water table in it, and a dry one; the first carries a thousand times as much as the second.
#[test]
fn water_in_joints_shows_heads_flows_tables_outcrops_and_drains() {
    let slope = sample(12.0, 6.0);
    let stage = StageEnd { title: "", caption: String::new(), snapshot: &slope.reference, bolts: &[], water: &[] };
    let line = |[from, to]: [[f64; 2]; 2], [a, b]: [f64; 2], wet: [f64; 2], flow: f64| {
        let reference = [from, to].map(Point::from);
        let heads = [from[1] + a, to[1] + b];
        FlowLine { ends: reference, reference, heads, wet, flow, ..FlowLine::default() }
    };
    let flow = WaterInJoints {
        lines: vec![
            line([[40.0, 5.0], [90.0, 5.0]], [20.0, 20.0], [0.0, 1.0], -1e-5),
            line([[60.0, 10.0], [60.0, 30.0]], [5.0, 0.0], [0.0, 0.25], 1.5e-8),
            line([[70.0, 20.0], [90.0, 40.0]], [0.0, 0.0], [0.0, 0.0], 0.0),
        ],
        seeps: vec![Seep { place: Point::new(40.0, 30.0), flow: 2e-6 }],
        drains: vec![DrainFlow {
            name: "row".to_owned(),
            points: vec![Point::new(45.0, 20.0), Point::new(60.0, 22.0)],
            flow: 5e-6,
        }],
    };
    assert_eq!(flow.lines[1].table(), Some(Point::new(60.0, 15.0)));
    assert!(flow.lines[0].table().is_none() && flow.lines[2].is_dry());
    let picture = flow_picture(&stage, &flow);
    check(&picture, "stage_flow.png");
    let svg = picture.svg();
    for text in ["row 0.300 L/min per m", "greatest 0.600 L/min per m", "seeping outcrop, all 0.120 L/min per m"] {
        assert!(svg.contains(&format!(">{text}<")), "{text}");
    }
    for text in ["under pressure: 70.0 m", "without pressure: 28.3 m", "water table", "pressure head [m]"] {
        assert!(svg.contains(&format!(">{text}<")), "{text}");
    }
    // The deepest colour of the scale at its greatest width, and the table at a quarter of the second joint.
    let drawn = Drawn::all(&svg);
    let deep = drawn.iter().find(|shape| shape.is("stroke-width", "6") && shape.is("stroke", "#fdeb4c"));
    let deep = deep.expect("the full joint").middle();
    assert_eq!(colour_at(&pixels(&picture), [deep[0] + 100.0, deep[1]]), "#fdeb4c");
    assert!(drawn.iter().any(|shape| shape.is("stroke-width", "1.8")), "little flow is thin");
    let dry = WaterInJoints { lines: flow.lines[2..].to_vec(), ..WaterInJoints::default() };
    let dry = flow_picture(&stage, &dry);
    assert!(!dry.svg().contains("NaN") && !dry.svg().contains("inf") && !dry.svg().contains("water table"));
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
    let stages = [("gravity", 0.0, true), ("failure", 0.7, false)];
    let stages = stages.map(|(name, time, is_static)| StageStart { name: name.to_owned(), time, is_static });
    let picture = history_picture("Monitors of the rock slope", &all, &stages);
    check(&picture, "history.png");
    for text in ["amount [m]", "amount [MJ]", ">gravity<", ">failure<", ">static<", "time in dynamic stages"] {
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
    for name in names.iter().chain(&more).chain(&["38°, every 3.4 m", "10 kPa"]) {
        assert!(picture.svg().contains(&format!(">{name}<")), "{name}");
    }
    assert!(picture.svg().contains(">10 m<"), "a length bar");
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
        let stage = StageStart { name: "bad".to_owned(), time: bad, is_static: true };
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
    let drawn = Drawn::all(&picture.svg());
    assert!(drawn.iter().all(|shape| shape.tag != "script"));
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
