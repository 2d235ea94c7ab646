//! The stereonet of a case: its joint sets and face in space.

use enmm::model::case::{Orientation, Orientations, Side, dip_in_section};
use enmm_io::LoadedCase;
use enmm_picture::{Projection, Stereonet};
use enmm_stability::kinematics::{Joints, Limits, Plane};

/// Choices of a stereonet.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NetOptions {
    /// The face; default: that of the outline.
    pub face: Option<Plane>,
    /// Limits of the checks.
    pub limits: Limits,
    /// Projection.
    pub projection: Projection,
}

/// Least dip (degrees) of an edge of the outline that counts as a face.
const FACE_DIP_MIN: f64 = 20.0;
/// Share of the size of the outline within which an edge lies on its box.
const ON_BOX: f64 = 1e-6;

/// Gathers the stereonet of a case.
///
/// # Errors
/// The outline has no face, and the options give none.
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

/// The longest edge of the outline that dips by 20° at least and has its rock below, off the sides of the model.
fn face_of(loaded: &LoadedCase) -> Result<Plane, String> {
    let ring = &loaded.case.domain.outline;
    let next = || ring.iter().cycle().skip(1);
    let turn: f64 = ring.iter().zip(next()).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
    let ends = |axis: usize| {
        let all = ring.iter().map(|point| point[axis]);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (x, y) = (ends(0), ends(1));
    let free = ON_BOX * (x.1 - x.0).max(y.1 - y.0);
    let mut best: Option<(f64, [f64; 2])> = None;
    for (a, b) in ring.iter().zip(next()) {
        let side = |at: f64| (a[0] - at).abs() <= free && (b[0] - at).abs() <= free;
        let along = [(b[0] - a[0]) * turn.signum(), (b[1] - a[1]) * turn.signum()];
        let length = libm::hypot(along[0], along[1]);
        // With the rock to the left of the edge, its normal out of the rock is (dy, -dx).
        let [out_x, out_y] = [along[1], -along[0]];
        let dip = libm::atan2(along[1].abs(), along[0].abs()).to_degrees();
        let longest = best.is_none_or(|(most, _)| length > most);
        if out_y >= -free && out_x != 0.0 && dip >= FACE_DIP_MIN && !side(x.0) && !side(x.1) && longest {
            best = Some((length, [dip, if out_x < 0.0 { 180.0 } else { 0.0 }]));
        }
    }
    let Some((_, [dip, off])) = best else {
        return Err(format!(
            "the outline has no edge that dips by {FACE_DIP_MIN}° or more off its sides; give the face by --face \
             DIP/DIRECTION"
        ));
    };
    Ok(Plane { dip, direction: (loaded.orientations.x_axis() + off).rem_euclid(360.0) })
}
