//! Entities in space: whether a drawing stands upright.

use super::entity::{ELEVATION, END, POINT, POLYLINE_3D, normal};
use super::groups::Group;
use super::inserts::Placed;
use super::records::{Record, find};
use crate::geometry_file::upright::Plane;

/// A point in space; none of a coordinate that is no number.
type Place = [Option<f64>; 3];

/// The plane of the lines of a drawing on the layers that are used; blocks at other places lie flat.
pub fn plane(placed: &[Placed], is_used: impl Fn(&str) -> bool) -> Plane {
    if placed.windows(2).any(|pair| pair[0].map != pair[1].map) {
        return Plane::Flat;
    }
    Plane::of(placed.iter().filter(|entity| is_used(entity.layer)).flat_map(|entity| places(entity.record)))
}

/// Points of an entity; of an arc those at both ends of its half axes.
fn places(record: &Record) -> Vec<Place> {
    let in_space = |code: i32| {
        let starts = (0..record.groups.len()).filter(|&k| record.groups[k].code == code);
        starts.map(|k| place(&record.groups[k..], [code, code + 10, code + 20])).collect::<Vec<_>>()
    };
    match record.kind {
        "LINE" => [POINT, END].map(|codes| place(record.groups, codes)).to_vec(),
        "SPLINE" => [in_space(POINT[0]), in_space(END[0])].concat(),
        "ELLIPSE" => vec![place(record.groups, POINT)],
        "POLYLINE" => {
            let flags = find(record.groups, 70).and_then(|group| group.value.parse::<i64>().ok()).unwrap_or(0);
            let points = record.vertices.iter().map(|vertex| place(vertex, POINT));
            if flags & POLYLINE_3D != 0 { points.collect() } else { out_of_plane(record, points) }
        }
        "LWPOLYLINE" => {
            let height = number(record.groups, ELEVATION);
            out_of_plane(record, in_space(POINT[0]).into_iter().map(|[x, y, _]| [x, y, height]))
        }
        "ARC" | "CIRCLE" => {
            let ([x, y, z], radius) = (place(record.groups, POINT), number(record.groups, 40));
            let moved = |value: Option<f64>| Some(value? + radius?);
            out_of_plane(record, [[x, y, z], [moved(x), y, z], [x, moved(y), z]].into_iter())
        }
        _ => Vec::new(),
    }
}

fn number(pairs: &[Group], code: i32) -> Option<f64> {
    find(pairs, code).map_or(Some(0.0), |group| group.value.parse().ok())
}

fn place(pairs: &[Group], codes: [i32; 3]) -> Place {
    codes.map(|code| number(pairs, code))
}

/// Points of a plane of an entity's own, in space: its axes follow from its extrusion direction N. The x axis is Y × N
/// where N is near ±Z (both other components below 1/64), else Z × N (arbitrary axis algorithm of the DXF reference).
fn out_of_plane(record: &Record, points: impl Iterator<Item = Place>) -> Vec<Place> {
    let direction = normal(|code| record.find(code).map(|group| group.value.parse::<f64>()).transpose());
    let Ok(n) = direction else { return vec![[None; 3]] };
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|value| value * value).sum::<f64>().sqrt();
        a.map(|value| value / length)
    };
    let n = unit(n);
    let is_up = n[0].abs() < 1.0 / 64.0 && n[1].abs() < 1.0 / 64.0;
    let u = unit(cross(if is_up { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] }, n));
    let v = cross(n, u);
    let in_space = |[x, y, z]: Place| [0, 1, 2].map(|k| Some(x? * u[k] + y? * v[k] + z? * n[k]));
    points.map(in_space).collect()
}
