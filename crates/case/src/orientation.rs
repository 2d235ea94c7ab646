//! Planes of joints and faces in space, for pictures and checks that look at more than the section.

use super::{Case, JointSet, Section, Side};

/// A joint set or a joint as a plane in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Orientation {
    /// Name of the set, or its key.
    pub name: String,
    /// Dip below the horizontal (degrees).
    pub dip: f64,
    /// Azimuth (degrees) towards which it dips.
    pub direction: f64,
    /// Whether the case gives the dip direction; else the plane is taken normal to the section.
    pub in_space: bool,
    /// Angle of the trace in the section (degrees), counter-clockwise from the x axis, -90 to 90.
    pub trace: f64,
    /// Friction angle of its law (degrees).
    pub friction: f64,
}

/// Planes of a case, before dips become angles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Orientations {
    /// Azimuth of the x axis (degrees), if the case has a section.
    pub azimuth: Option<f64>,
    /// Joint sets, and straight joints of which the case lists few.
    pub planes: Vec<Orientation>,
    /// Number of joints that are left out: too many, or not straight.
    pub left_out: usize,
}

/// Azimuth of the x axis (degrees) of a case that has no section.
pub const AZIMUTH: f64 = 90.0;
/// Most joints of a case that count as planes one by one.
const JOINTS_MAX: usize = 12;

impl Orientations {
    /// Azimuth of the x axis (degrees), that of a case without a section included.
    pub fn x_axis(&self) -> f64 {
        self.azimuth.unwrap_or(AZIMUTH)
    }

    /// Dip and dip direction (degrees) of a plane normal to the section whose trace has an angle from the x axis.
    pub fn normal_to_section(&self, angle: f64) -> [f64; 2] {
        let trace = folded(angle);
        let direction = if trace > 0.0 { self.x_axis() + 180.0 } else { self.x_axis() };
        [trace.abs(), direction.rem_euclid(360.0)]
    }
}

impl Case {
    /// Planes of the joint sets and joints of a case that is not expanded yet; sets without a direction are left out.
    pub fn orientations(&self) -> Orientations {
        let azimuth = self.section.map(|Section { azimuth_deg }| azimuth_deg);
        let mut found = Orientations { azimuth, ..Orientations::default() };
        for (k, set) in self.joint_sets.iter().enumerate() {
            let name = self.joint_set_name(k);
            let friction = self.friction_of(set.law.as_deref());
            found.planes.extend(orientation(&found, set, name, friction));
        }
        if self.joints.len() > JOINTS_MAX {
            found.left_out = self.joints.len();
            return found;
        }
        for (k, joint) in self.joints.iter().enumerate() {
            let [a, b] = joint.points[..] else {
                found.left_out += 1;
                continue;
            };
            let trace = folded(libm::atan2(b[1] - a[1], b[0] - a[0]).to_degrees());
            let [dip, direction] = found.normal_to_section(trace);
            let friction = self.friction_of(joint.law.as_deref());
            let name = joint.law.clone().map_or_else(|| format!("joint[{k}]"), |law| format!("{law} (joint[{k}])"));
            found.planes.push(Orientation { name, dip, direction, in_space: false, trace, friction });
        }
        found
    }

    fn friction_of(&self, law: Option<&str>) -> f64 {
        let law = law.or(self.default_joint_law()).and_then(|name| self.joint_laws.get(name));
        law.map_or(0.0, |law| law.friction_deg)
    }
}

fn orientation(of: &Orientations, set: &JointSet, name: String, friction: f64) -> Option<Orientation> {
    let section = of.x_axis();
    let flat = |trace: f64| {
        let [dip, direction] = of.normal_to_section(trace);
        Orientation { name: name.clone(), dip, direction, in_space: false, trace: folded(trace), friction }
    };
    match (set.angle_deg, set.dip_deg, set.dips, set.dip_direction_deg) {
        (Some(angle), ..) => Some(flat(angle)),
        (None, Some(dip), Some(side), _) => Some(flat(if side == Side::Left { dip } else { -dip })),
        (None, Some(dip), None, Some(direction)) => {
            let trace = trace_angle(dip, direction - section);
            Some(Orientation { name, dip, direction: direction.rem_euclid(360.0), in_space: true, trace, friction })
        }
        _ => None,
    }
}

/// Angle (degrees), counter-clockwise from an axis, of the trace of a plane in the upright section along that axis: it
/// dips by `dip` (degrees) towards `off` (degrees), clockwise from the axis on a map. tan(apparent dip) =
/// tan(dip)·cos(off).
pub fn trace_angle(dip: f64, off: f64) -> f64 {
    let (sin, cos) = libm::sincos(dip.to_radians());
    -libm::atan2(sin * libm::cos(off.to_radians()), cos).to_degrees()
}

/// Dip (degrees) of a line in the section at an angle (degrees) from the x axis, and the side towards which it goes
/// down; none where it is level or upright to a tenth of a degree.
pub fn dip_in_section(angle: f64) -> (f64, Option<Side>) {
    let angle = folded(angle);
    let side = if angle > 0.0 { Side::Left } else { Side::Right };
    (angle.abs(), Some(side).filter(|_| (0.05..89.95).contains(&angle.abs())))
}

/// An angle of a line, which has no sense: between -90 and 90 degrees.
fn folded(angle: f64) -> f64 {
    angle - 180.0 * (angle / 180.0).round()
}
