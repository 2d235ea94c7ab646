//! Kinematic checks of a rock face: which joint sets let plane, wedge and toppling failures move, whatever their size.
//!
//! A plane slides if it dips out of the face (its dip is less than that of the face, both in the direction of the
//! plane), more steeply than its friction angle, within a lateral limit. A wedge slides if the line in which two planes
//! meet does so, without a lateral limit. Layers topple if their strike is near that of the face and the plane
//! normal to them dips less than the face by their friction angle at least: (90° − dip) + φ ≤ dip of the face
//! (E. Hoek and J. Bray, Rock slope engineering, 1981; R. E. Goodman, Introduction to rock mechanics, 1989;
//! D. C. Wyllie and C. W. Mah, Rock slope engineering, 2004).

use enmm::model::case::trace_angle;

/// A plane in space by its dip and the azimuth towards which it dips (degrees).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Dip below the horizontal, 0 to 90.
    pub dip: f64,
    /// Dip direction, clockwise from north.
    pub direction: f64,
}

/// A line in space by its plunge and the azimuth towards which it plunges (degrees).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Plunge below the horizontal, 0 to 90.
    pub plunge: f64,
    /// Trend, clockwise from north.
    pub trend: f64,
}

/// Joints of one set.
#[derive(Debug, Clone, PartialEq)]
pub struct Joints {
    /// Name.
    pub name: String,
    /// Mean plane.
    pub plane: Plane,
    /// Friction angle (degrees).
    pub friction: f64,
}

/// Limits of the checks (degrees).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Greatest angle between the dip directions of a plane that slides and of the face.
    pub sliding: f64,
    /// Greatest angle between the strikes of layers that topple and of the face.
    pub toppling: f64,
}

impl Default for Limits {
    /// 20° and 30°, as Hoek and Bray, and Goodman.
    fn default() -> Self {
        Self { sliding: 20.0, toppling: 30.0 }
    }
}

/// Sets by their places in the list that was checked.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Failures {
    /// Sets on which planes slide.
    pub planes: Vec<usize>,
    /// Pairs of sets whose wedges slide, with the line in which they meet.
    pub wedges: Vec<(usize, usize, Line)>,
    /// Sets whose layers topple.
    pub toppling: Vec<usize>,
}

/// East, north and down.
type Direction = [f64; 3];

impl Plane {
    /// The line normal to the plane that points down.
    pub fn pole(&self) -> Line {
        Line { plunge: 90.0 - self.dip, trend: azimuth(self.direction + 180.0) }
    }

    /// The steepest line of the plane.
    pub fn dip_line(&self) -> Line {
        Line { plunge: self.dip, trend: azimuth(self.direction) }
    }

    /// Lines of the plane from one end of its strike to the other.
    pub fn lines(&self, count: u32) -> Vec<Line> {
        let (strike, dip) = (Line { plunge: 0.0, trend: self.direction - 90.0 }.unit(), self.dip_line().unit());
        let line = |k: u32| {
            let (sin, cos) = libm::sincos(f64::from(k) / f64::from(count) * std::f64::consts::PI);
            Line::of([0, 1, 2].map(|axis| strike[axis] * cos + dip[axis] * sin))
        };
        (0..=count).map(line).collect()
    }

    /// Dip (degrees) of the trace of the plane in a vertical section towards an azimuth, negative if it rises.
    pub fn apparent_dip(&self, towards: f64) -> f64 {
        -trace_angle(self.dip, self.direction - towards)
    }

    /// The line in which two planes meet, if they are not parallel.
    pub fn meets(&self, other: &Self) -> Option<Line> {
        let [a, b] = [self.pole().unit(), other.pole().unit()];
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let length = cross.iter().map(|part| part * part).sum::<f64>().sqrt();
        (length > 1e-6).then(|| Line::of(cross.map(|part| part / length)))
    }
}

impl Line {
    /// The line along a unit vector, read downwards.
    fn of(unit: Direction) -> Self {
        let [east, north, down] = if unit[2] < 0.0 { unit.map(|part| -part) } else { unit };
        let plunge = libm::asin(down.min(1.0)).to_degrees();
        Self { plunge, trend: azimuth(libm::atan2(east, north).to_degrees()) }
    }

    fn unit(&self) -> Direction {
        let (plunge, trend) = (libm::sincos(self.plunge.to_radians()), libm::sincos(self.trend.to_radians()));
        [plunge.1 * trend.0, plunge.1 * trend.1, plunge.0]
    }
}

/// Checks all sets against a face.
pub fn failures(face: &Plane, sets: &[Joints], limits: Limits) -> Failures {
    let mut found = Failures::default();
    for (k, set) in sets.iter().enumerate() {
        let out = between(set.plane.direction, face.direction);
        if out <= limits.sliding && slides(&set.plane.dip_line(), face, set.friction) {
            found.planes.push(k);
        }
        let slips = 90.0 - set.plane.dip + set.friction <= face.dip;
        if 180.0 - out <= limits.toppling && slips {
            found.toppling.push(k);
        }
        for (j, other) in sets.iter().enumerate().skip(k + 1) {
            let friction = set.friction.min(other.friction);
            if let Some(line) = set.plane.meets(&other.plane).filter(|line| slides(line, face, friction)) {
                found.wedges.push((k, j, line));
            }
        }
    }
    found
}

/// Whether rock slides along a line: it leaves the face, more steeply than the friction angle.
fn slides(line: &Line, face: &Plane, friction: f64) -> bool {
    let comes_out = between(line.trend, face.direction) < 90.0 && line.plunge < face.apparent_dip(line.trend);
    comes_out && line.plunge > friction
}

/// Angle between two azimuths (degrees), 0 to 180.
fn between(a: f64, b: f64) -> f64 {
    let off = azimuth(a - b);
    off.min(360.0 - off)
}

/// An azimuth from 0 to below 360.
pub fn azimuth(degrees: f64) -> f64 {
    let turned = degrees.rem_euclid(360.0);
    if turned >= 360.0 { 0.0 } else { turned }
}
