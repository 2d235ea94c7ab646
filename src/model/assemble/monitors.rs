//! Places of monitors and lines in a model.

use crate::geometry::{Point, TraceId};
use crate::model::case::{self, Case, Invalid, Monitor, NamedJoint};
use crate::monitor::{Faces, JointMonitor, JointPlace, LinePlace, Monitors, StressFit};
use crate::state::Model;

use super::joints::Joints;
use super::locator::Locator;

/// The monitors of a case in a model with so many cuts.
///
/// # Errors
/// The first place without rock, or far from the joint that it is meant to be on.
pub(super) fn place(
    case: &Case,
    model: &Model,
    positions: &Locator,
    (joints, cuts): (&Joints, usize),
) -> Result<Monitors, Invalid> {
    let element = |key: &str, point| Ok((positions.element(key, point)?, Point::from(point)));
    let fit = |element, point| StressFit::new(&model.covers, &model.element_rock, element, point);
    let named = case.monitors.iter().enumerate();
    let points: Vec<_> = named
        .map(|(k, monitor)| element(&format!("monitor[{k}].point"), monitor.point))
        .collect::<Result<_, Invalid>>()?;
    let of_point = |(monitor, &(element, point)): (&Monitor, &_)| monitor.stress.then(|| fit(element, point));
    let stresses = case.monitors.iter().zip(&points).map(of_point).collect();
    let line = |k: usize| {
        let points = case.lines[k].points();
        let at = |(i, point): (usize, &[f64; 2])| {
            let (element, point) = element(&format!("line[{k}]"), *point).map_err(|Invalid { key, message }| {
                let message = format!("point {} of {}: {message}; or move `from` or `to`", i + 1, points.len());
                Invalid { key, message }
            })?;
            Ok(LinePlace { element, point, stress: fit(element, point) })
        };
        points.iter().enumerate().map(at).collect::<Result<Vec<_>, Invalid>>()
    };
    let lines = (0..case.lines.len()).map(line).collect::<Result<_, Invalid>>()?;
    let has_gauges = !case.joint_monitors.is_empty();
    let faces = if has_gauges { Faces::of(&model.boundary, &joints.traces) } else { Faces::default() };
    let search = Search { case, model, faces: &faces, joints, uncut: joints.traces.len() - cuts };
    let of_joint = |(k, monitor)| search.monitor(&format!("joint_monitor[{k}]"), monitor);
    let joints = case.joint_monitors.iter().enumerate().map(of_joint).collect::<Result<_, Invalid>>()?;
    Ok(Monitors { points, stresses, joints, faces, lines })
}

/// Finds the places of monitors of joints.
struct Search<'a> {
    case: &'a Case,
    model: &'a Model,
    faces: &'a Faces,
    joints: &'a Joints,
    /// Traces that are there from the start: cuts, which come last, take no monitor from them.
    uncut: usize,
}

impl Search<'_> {
    fn monitor(&self, key: &str, monitor: &case::JointMonitor) -> Result<JointMonitor, Invalid> {
        let point = Point::from(monitor.point);
        let named = monitor.joint.as_ref().and_then(|name| self.case.joint_by_name(name));
        let is_meant = |trace: TraceId| match named {
            None => trace.index() < self.uncut,
            Some(NamedJoint::One(joint)) => trace.index() == joint,
            Some(NamedJoint::Set(set)) => {
                (self.joints.set_start[set]..self.joints.set_start[set + 1]).contains(&trace.index())
            }
        };
        let (boundary, size) = (&self.model.boundary, self.model.covers.mesh.size);
        let what = monitor.joint.as_ref().map_or("joint".to_owned(), |name| format!("piece of {name:?}"));
        let invalid = |message| Err(Invalid { key: format!("{key}.point"), message });
        match JointPlace::nearest(boundary, self.faces, point, &is_meant) {
            Some(place) if place.distance <= size => Ok(JointMonitor::new(boundary, self.faces, place, monitor.length)),
            Some(JointPlace { place, distance, .. }) => invalid(format!(
                "no {what} between two blocks is near ({}, {}): the nearest is {distance:.3} m off at ({:.6}, {:.6}), \
                 at most one mesh size, {size} m, is allowed; choose a point on the joint",
                point.x, point.y, place.x, place.y
            )),
            None => invalid(format!("the model has no {what} with rock on both sides: leave the monitor out")),
        }
    }
}
