//! A slope as features (GeoJSON, RFC 7946): blocks, joints, bolts, supports, water. Coordinates are those of the
//! section in metres, x to the right and y up, not longitude and latitude.

use serde_json::{Map, Value, json};

use crate::scene::{Block, Scene};
use crate::vtu::Lines;

/// Numbers of joints, and of joints in which water flows, with units.
const JOINT_NUMBERS: [(&str, &str); 4] =
    [("opening", "m"), ("slip", "m"), ("normal_stress", "Pa"), ("shear_stress", "Pa")];
const FLOW_NUMBERS: [(&str, &str); 5] =
    [("head", "m"), ("pressure", "Pa"), ("flow", "m2/s"), ("aperture", "m"), ("filling", "")];
/// Numbers of blocks that follow from others.
const STRESSES: [(&str, &str); 2] = [("mean_stress", "Pa"), ("max_shear", "Pa")];

/// The features of a slope, as text.
pub fn features(scene: &Scene) -> String {
    let lines = |kind: &'static str, lines: &Lines, numbers: &[(&str, &str)]| -> Vec<Value> {
        let line =
            |k: usize| feature(json!("LineString"), json!(lines.ends[k]), line_properties(kind, lines, numbers, k));
        (0..lines.ends.len()).map(line).collect()
    };
    let mut features: Vec<Value> = scene.blocks.iter().map(|block| block_feature(scene, block)).collect();
    features.extend(lines("joint", &scene.joints, &JOINT_NUMBERS));
    features.extend(scene.bolts.iter().map(|bolt| {
        let properties = json!({ "kind": "bolt", "name": bolt.name, "force": bolt.force, "state": bolt.state });
        feature(json!("LineString"), json!(bolt.ends), properties)
    }));
    features.extend(scene.supports.iter().map(|support| {
        let [x, y] = support.axes;
        feature(json!("Point"), json!(support.place), json!({ "kind": "support", "held_x": x, "held_y": y }))
    }));
    let water = scene.water_line();
    if water.len() > 1 {
        features.push(feature(json!("LineString"), json!(water), json!({ "kind": "water" })));
    }
    features.extend(lines("flow", &scene.flow, &FLOW_NUMBERS));
    let (axis, unit, at) = &scene.axis;
    let collection = json!({
        "type": "FeatureCollection",
        "enmm": {
            "title": scene.title,
            "at": { "name": axis, "unit": unit, "value": at },
            "coordinates": "metres in the section, x to the right, y up; tension positive",
            "units": units(scene),
        },
        "features": features,
    });
    collection.to_string()
}

fn feature(kind: Value, coordinates: Value, properties: Value) -> Value {
    json!({
        "type": "Feature",
        "geometry": { "type": kind, "coordinates": coordinates },
        "properties": properties,
    })
}

/// Units of all numbers that have one.
fn units(scene: &Scene) -> Value {
    let of_blocks = scene.numbers.iter().map(|[name, unit]| (name.as_str(), unit.as_str()));
    let others = [("area", "m2"), ("mass", "kg/m"), ("speed", "m/s"), ("force", "N/m")];
    let all = of_blocks.chain(others).chain(STRESSES).chain(JOINT_NUMBERS).chain(FLOW_NUMBERS);
    let named = all.filter(|(_, unit)| !unit.is_empty()).map(|(name, unit)| (name.to_owned(), json!(unit)));
    Value::Object(named.collect())
}

fn block_feature(scene: &Scene, block: &Block) -> Value {
    // Rings are closed; the outer one goes round to the left, and holes to the right.
    let ring = |(k, points): (usize, &Vec<[f64; 2]>)| {
        let mut ring = points.clone();
        if (turn(&ring) > 0.0) != (k == 0) {
            ring.reverse();
        }
        ring.extend(ring.first().copied());
        ring
    };
    let rings: Vec<Vec<[f64; 2]>> = block.loops.iter().enumerate().map(ring).collect();
    let mut properties = Map::new();
    let mut put = |name: &str, value: Value| properties.insert(name.to_owned(), value);
    put("kind", json!("block"));
    put("block", json!(block.outline.id));
    put("rock", json!(block.rock));
    put("fixed", json!(block.outline.fixed));
    put("area", json!(block.outline.size[0]));
    put("mass", json!(block.outline.size[1]));
    for ([name, _], number) in scene.numbers.iter().zip(&block.numbers) {
        put(name, json!(number));
    }
    let number = |name: &str| scene.number(block, name);
    if let (Some(x), Some(y)) = (number("velocity_x"), number("velocity_y")) {
        put("speed", json!(libm::hypot(x, y)));
    }
    let stress = ["mean_stress_xx", "mean_stress_yy", "mean_stress_xy"].map(number);
    if let [Some(xx), Some(yy), Some(xy)] = stress {
        let [mean, shear] = [0.5 * (xx + yy), libm::hypot(0.5 * (xx - yy), xy)];
        STRESSES.iter().zip([mean, shear]).for_each(|((name, _), value)| drop(put(name, json!(value))));
    }
    feature(json!("Polygon"), json!(rings), Value::Object(properties))
}

/// Twice the area of a ring (m²), positive when it goes round to the left.
fn turn(ring: &[[f64; 2]]) -> f64 {
    let Some(&[x, y]) = ring.first() else { return 0.0 };
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y)).sum()
}

fn line_properties(kind: &str, lines: &Lines, numbers: &[(&str, &str)], k: usize) -> Value {
    let mut properties = Map::new();
    properties.insert("kind".to_owned(), json!(kind));
    for name in ["block", "block_1", "block_2"] {
        properties.extend(lines.number(name, k).map(|number| (name.to_owned(), json!(number as u64))));
    }
    for name in ["law", "state", "bond"] {
        properties.extend(lines.name(name, k).map(|text| (name.to_owned(), json!(text))));
    }
    properties.extend(lines.number("is_joint", k).map(|flag| ("is_joint".to_owned(), json!(flag > 0.0))));
    for (name, _) in numbers {
        properties.extend(lines.number(name, k).map(|number| ((*name).to_owned(), json!(number))));
    }
    Value::Object(properties)
}
