//! Checks of monitors, lines and outputs.

use super::checks::{Names, each, segment, unique};
use crate::Case;
use crate::key::{Check, Key, fail};

/// Checks monitors of points and of joints, lines, and from when their displacements count.
///
/// # Errors
/// The first value that is not allowed.
pub fn validate_monitors(root: &Key, case: &Case) -> Check {
    let key = root.field("monitor");
    each(&key, &case.monitors, |key, monitor| monitor.check(key))?;
    unique(&key, "monitor", case.monitors.iter().map(|monitor| Some(monitor.name.as_str())))?;
    let key = root.field("joint_monitor");
    each(&key, &case.joint_monitors, |key, monitor| {
        monitor.check(key)?;
        monitor.joint.as_ref().map_or(Ok(()), |joint| names_joint(&key.field("joint"), case, joint))
    })?;
    unique(&key, "monitor of a joint", case.joint_monitors.iter().map(|monitor| Some(monitor.name.as_str())))?;
    let key = root.field("line");
    each(&key, &case.lines, |key, line| {
        line.check(key)?;
        segment(&key.field("to"), &[line.from, line.to])
    })?;
    unique(&key, "line", case.lines.iter().map(|line| Some(line.name.as_str())))?;
    let key = root.field("output");
    case.output.check(&key)?;
    let since = case.output.since.as_ref();
    since.map_or(Ok(()), |since| Names::of_followed_stages(case).must_hold(&key.field("since"), since))
}

/// Checks that a name is that of a joint set, or of a joint by its place.
fn names_joint(key: &Key, case: &Case, name: &str) -> Check {
    if case.joint_by_name(name).is_some() {
        return Ok(());
    }
    let sets = (0..case.joint_sets.len()).map(|set| case.joint_set_name(set));
    let joints = match case.joints.len() {
        0 => None,
        1 => Some("joint[0]".to_owned()),
        count => Some(format!("joint[0] to joint[{}]", count - 1)),
    };
    let known: Vec<String> = sets.chain(joints).collect();
    let remedy = "name one of them, or leave it out for the nearest joint";
    fail(key, format!("no joint is named {name:?}, the case has: {}; {remedy}", known.join(", ")))
}
