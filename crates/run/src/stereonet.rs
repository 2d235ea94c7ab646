//! The stereonet of a case: its joint sets and face in space.

use enmm::model::case::{Orientation, Orientations, Side, dip_in_section};
use enmm_io::LoadedCase;
use enmm_picture::{Projection, Stereonet};
use enmm_stability::kinematics::{Joints, Limits, Plane};

/// Choices of a stereonet.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NetOptions {
    /// The face; default: that of the outline, where it has one.
    pub face: Option<Plane>,
    /// Limits of the checks.
    pub limits: Limits,
    /// Projection.
    pub projection: Projection,
}

/// Least dip (degrees) of an edge of the outline that counts as a face.
const FACE_DIP_MIN: f64 = 20.0;
/// Share of the longest such edge below which another one is no part of the face.
const FACE_SHARE: f64 = 0.1;
/// Greatest difference of dip (degrees) within one face.
const FACE_SPREAD: f64 = 2.0;
/// Edges that a message names.
const FACES_NAMED: usize = 4;
/// Share of the size of the outline within which an edge lies on its box.
const ON_BOX: f64 = 1e-6;

/// Gathers the stereonet of a case.
///
/// # Errors
/// The outline has no face or several, and the options give none.
pub fn stereonet(loaded: &LoadedCase, options: &NetOptions) -> Result<Stereonet, String> {
    let Orientations { azimuth, planes, left_out } = &loaded.orientations;
    let mut notes = Vec::new();
    if azimuth.is_none() {
        let axis = loaded.orientations.x_axis();
        notes.push(format!("no [section]: the x axis is taken to point to azimuth {axis:.0}°"));
    }
    if planes.iter().any(|plane| !plane.in_space) {
        notes.push("⊥: known in the section alone, taken normal to it".to_owned());
    }
    if *left_out > 0 {
        notes.push(format!("{left_out} joints of the case are not drawn: curved, bent, or too many"));
    }
    let Limits { sliding, toppling } = options.limits;
    notes.push(format!("plane: within {sliding:.0}° of the face, flatter than it, steeper than φ"));
    notes.push("wedge: the line flatter than the face, steeper than the lesser φ".to_owned());
    notes.push(format!("toppling: strike within {toppling:.0}°, (90° − dip) + φ ≤ dip of the face"));
    notes.push("kinematics alone: cohesion, water and size are not looked at".to_owned());
    let face = match options.face {
        Some(face) => face,
        None => face_of(loaded)?,
    };
    let joints = |plane: &Orientation| Joints {
        name: plane.name.clone(),
        plane: Plane { dip: plane.dip, direction: plane.direction },
        friction: plane.friction,
    };
    Ok(Stereonet {
        title: loaded.case.title.clone(),
        face,
        sets: planes.iter().map(joints).collect(),
        remarks: planes.iter().map(apparent).collect(),
        limits: options.limits,
        projection: options.projection,
        notes,
    })
}

/// The trace of a plane in words: `in the section 24° down to the right`.
pub fn apparent(plane: &Orientation) -> String {
    let sign = if plane.in_space { "" } else { "⊥ " };
    match dip_in_section(plane.trace) {
        (dip, Some(Side::Left)) => format!("{sign}in the section {dip:.1}° down to the left"),
        (dip, Some(Side::Right)) => format!("{sign}in the section {dip:.1}° down to the right"),
        (dip, None) if dip < 45.0 => format!("{sign}level in the section"),
        (_, None) => format!("{sign}upright in the section"),
    }
}

/// An edge of the outline that may be the face.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FaceEdge {
    /// Its length (m).
    length: f64,
    /// As a plane normal to the section.
    plane: Plane,
}

/// The face of the outline, where all edges that may be one agree.
///
/// # Errors
/// There is none, or there are several; with the remedy.
fn face_of(loaded: &LoadedCase) -> Result<Plane, String> {
    let mut edges = face_edges(loaded);
    edges.sort_by(|a, b| b.length.total_cmp(&a.length));
    let Some(&longest) = edges.first() else {
        return Err(format!(
            "the outline has no edge that dips by {FACE_DIP_MIN}° or more off its sides; give the face by --face \
             DIP/DIRECTION"
        ));
    };
    edges.retain(|edge| edge.length >= FACE_SHARE * longest.length);
    let is_alike = |edge: &FaceEdge| {
        edge.plane.direction == longest.plane.direction && (edge.plane.dip - longest.plane.dip).abs() <= FACE_SPREAD
    };
    if edges.iter().all(is_alike) {
        return Ok(longest.plane);
    }
    let name = |edge: &FaceEdge| format!("{:.1}/{:.0} ({:.1} m)", edge.plane.dip, edge.plane.direction, edge.length);
    let named = edges.iter().take(FACES_NAMED).map(name).collect::<Vec<_>>().join(", ");
    let more = edges.len().saturating_sub(FACES_NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    Err(format!(
        "the outline has edges that dip differently, {named}{more}, so that its face is not clear; give the face by \
         --face DIP/DIRECTION"
    ))
}

/// The edges of the outline that dip by 20° at least and have their rock below, off the sides of the model.
fn face_edges(loaded: &LoadedCase) -> Vec<FaceEdge> {
    let ring = &loaded.case.domain.outline;
    let next = || ring.iter().cycle().skip(1);
    let turn: f64 = ring.iter().zip(next()).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
    let ends = |axis: usize| {
        let all = ring.iter().map(|point| point[axis]);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (x, y) = (ends(0), ends(1));
    let free = ON_BOX * (x.1 - x.0).max(y.1 - y.0);
    let edge = |(a, b): (&[f64; 2], &[f64; 2])| {
        let side = |at: f64| (a[0] - at).abs() <= free && (b[0] - at).abs() <= free;
        let along = [(b[0] - a[0]) * turn.signum(), (b[1] - a[1]) * turn.signum()];
        // With the rock to the left of the edge, its normal out of the rock is (dy, -dx).
        let [out_x, out_y] = [along[1], -along[0]];
        let dip = libm::atan2(along[1].abs(), along[0].abs()).to_degrees();
        let off = if out_x < 0.0 { 180.0 } else { 0.0 };
        let direction = (loaded.orientations.x_axis() + off).rem_euclid(360.0);
        let is_free = out_y >= -free && out_x != 0.0 && dip >= FACE_DIP_MIN && !side(x.0) && !side(x.1);
        is_free.then(|| FaceEdge { length: libm::hypot(along[0], along[1]), plane: Plane { dip, direction } })
    };
    ring.iter().zip(next()).filter_map(edge).collect()
}
