//! Points of the entities of a DXF drawing that are lines or curves.

use super::curve::{Arc, CHORDS_MAX, Spline};
use super::fit::FitSpline;
use super::groups::{Group, Groups};
use super::records::{Record, find};
use crate::case_error::CaseError;
use crate::geometry_file::affine::Affine;
use crate::geometry_file::upright::Plane;
use enmm::model::case::PointList;

/// Points of an entity.
#[derive(Debug, Default)]
pub struct Shape {
    /// The points (m).
    pub points: PointList,
    /// Line of each point, counted from 1.
    pub lines: Vec<usize>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// How many points have a height, which is not used.
    pub high: usize,
    /// How many arcs and splines have become polylines.
    pub curves: usize,
    /// How many of these go through points to be fitted.
    pub fitted: usize,
}

/// Content of an entity.
#[derive(Debug)]
pub enum Content {
    /// A line, perhaps closed.
    Line(Shape),
    /// Words, signs and pictures, which are no geometry of the section.
    Remark,
    /// A type that is not read.
    Other,
}

/// Types that explain a drawing and have no geometry of the section.
const REMARKS: [&str; 31] = [
    "ACAD_PROXY_ENTITY",
    "ACAD_TABLE",
    "ARC_DIMENSION",
    "ATTDEF",
    "ATTRIB",
    "DIMENSION",
    "GEOPOSITIONMARKER",
    "HATCH",
    "IMAGE",
    "LARGE_RADIAL_DIMENSION",
    "LEADER",
    "LIGHT",
    "MPOLYGON",
    "MTEXT",
    "MULTILEADER",
    "OLE2FRAME",
    "OLEFRAME",
    "PDFUNDERLAY",
    "DGNUNDERLAY",
    "DWFUNDERLAY",
    "POINT",
    "RTEXT",
    "SECTION",
    "SHAPE",
    "SOLID",
    "SUN",
    "TEXT",
    "TOLERANCE",
    "TRACE",
    "VIEWPORT",
    "WIPEOUT",
];

/// Flags of a POLYLINE and of its vertices.
pub const POLYLINE_3D: i64 = 8;
const MESH: i64 = 16;
const FACES: i64 = 64;
const CONTROL_POINT: i64 = 16;
/// Codes of coordinates: of points and starts, of ends.
pub const POINT: [i32; 3] = [10, 20, 30];
pub const END: [i32; 3] = [11, 21, 31];
/// Codes of the directions in which a spline through points to be fitted begins and ends.
const TANGENTS: [[i32; 3]; 2] = [[12, 22, 32], [13, 23, 33]];
/// Code of the height of all points of an LWPOLYLINE, and of bulges.
pub const ELEVATION: i32 = 38;
const BULGE: i32 = 42;
/// Greatest slope of an extrusion direction that still counts as upright.
const UPRIGHT: f64 = 1e-6;
/// Greatest degree of a spline.
const DEGREE_MAX: usize = 25;

/// A reader of the points of one entity.
pub struct Tracer<'a> {
    /// The file.
    pub groups: &'a Groups<'a>,
    /// From the coordinates that the entity has to the section.
    pub map: Affine,
    /// Plane of the drawing that is the section.
    pub plane: Plane,
    /// Distance (m) within which curves become polylines.
    pub tolerance: f64,
}

impl Tracer<'_> {
    /// Returns the content of an entity.
    ///
    /// # Errors
    /// A coordinate is missing or no number, a curve is flat or out of the plane, or needs too many chords.
    pub fn content(&self, record: &Record) -> Result<Content, CaseError> {
        let groups = self.groups;
        let flags = record.whole(groups, 70)?;
        let mut shape = Shape { closed: flags & 1 != 0, ..Shape::default() };
        match record.kind {
            "LINE" => {
                shape.closed = false;
                for codes in [POINT, END] {
                    let point = self.position(record, record.groups, codes, &mut shape)?;
                    shape.push(self.map.point(point), line_of(record, record.groups, codes[0]));
                }
            }
            "LWPOLYLINE" => self.light_polyline(record, &mut shape)?,
            "POLYLINE" if flags & (MESH | FACES) == 0 => self.polyline(record, flags, &mut shape)?,
            "ARC" | "CIRCLE" => {
                let centre = self.coordinates(record, record.groups, POINT, &mut shape)?;
                let radius = self.positive(record, 40)?;
                let span = match record.kind {
                    "ARC" => [record.number(groups, 50)?, record.number(groups, 51)?],
                    _ => [0.0, 360.0],
                };
                let arc = Arc::circular(centre, radius, span);
                self.arc(record, &arc, &self.facing(record)?, &mut shape)?;
            }
            "ELLIPSE" => self.ellipse(record, &mut shape)?,
            "SPLINE" => self.spline(record, flags, &mut shape)?,
            kind if REMARKS.contains(&kind) => return Ok(Content::Remark),
            _ => return Ok(Content::Other),
        }
        if self.plane != Plane::Flat {
            shape.high = 0;
        }
        Ok(Content::Line(shape))
    }

    fn light_polyline(&self, record: &Record, shape: &mut Shape) -> Result<(), CaseError> {
        let first = record.groups.iter().position(|group| group.code == POINT[0]).unwrap_or(record.groups.len());
        let vertices: Vec<&[Group]> = record.groups[first..].chunk_by(|_, next| next.code != POINT[0]).collect();
        self.corners(record, &vertices, Some(&self.facing(record)?), shape)?;
        if record.number_or(self.groups, ELEVATION, 0.0)? != 0.0 {
            shape.high = vertices.len();
        }
        Ok(())
    }

    /// Vertices of a frame that has been fitted with a curve are no points of the line.
    fn polyline(&self, record: &Record, flags: i64, shape: &mut Shape) -> Result<(), CaseError> {
        let mut vertices = Vec::new();
        for vertex in &record.vertices {
            if self.groups.whole(vertex, 70)? & CONTROL_POINT == 0 {
                vertices.push(*vertex);
            }
        }
        let own = if flags & POLYLINE_3D != 0 { None } else { Some(self.facing(record)?) };
        self.corners(record, &vertices, own.as_ref(), shape)
    }

    /// Adds vertices and the arcs between them, in space or in a plane of the entity's own with its map.
    fn corners(
        &self,
        record: &Record,
        vertices: &[&[Group]],
        own: Option<&Affine>,
        shape: &mut Shape,
    ) -> Result<(), CaseError> {
        let map = own.unwrap_or(&self.map);
        let mut corners = Vec::with_capacity(vertices.len());
        for vertex in vertices {
            let point = match own {
                Some(_) => self.coordinates(record, vertex, POINT, shape)?,
                None => self.position(record, vertex, POINT, shape)?,
            };
            let bulge = find(vertex, BULGE).map_or(Ok(0.0), |group| self.groups.number(group))?;
            if !bulge.is_finite() {
                let message = format!("{} has the bulge {bulge}, must be a finite number; correct it", record.kind);
                return self.groups.syntax(line_of(record, vertex, BULGE), message);
            }
            corners.push((point, bulge, line_of(record, vertex, POINT[0])));
        }
        for (k, &(point, bulge, line)) in corners.iter().enumerate() {
            shape.push(map.point(point), line);
            let next = corners.get(k + 1).or_else(|| corners.first().filter(|_| shape.closed));
            if let Some(&(end, ..)) = next.filter(|next| bulge != 0.0 && next.0 != point) {
                let inner = self.chords(record, Arc::bulging(point, end, bulge).points(map, self.tolerance))?;
                inner[1..inner.len() - 1].iter().for_each(|&corner| shape.push(corner, line));
                shape.curves += 1;
            }
        }
        Ok(())
    }

    fn ellipse(&self, record: &Record, shape: &mut Shape) -> Result<(), CaseError> {
        let centre = self.position(record, record.groups, POINT, shape)?;
        let u = self.position(record, record.groups, END, &mut Shape::default())?;
        let ratio = self.positive(record, 40)? * self.side(record)?;
        let span = [record.number_or(self.groups, 41, 0.0)?, record.number_or(self.groups, 42, std::f64::consts::TAU)?];
        let turn = (span[1] - span[0]).rem_euclid(std::f64::consts::TAU);
        let turn = if turn < 1e-9 { std::f64::consts::TAU } else { turn };
        let arc = Arc { centre, u, v: [-u[1] * ratio, u[0] * ratio], span: [span[0], span[0] + turn] };
        self.arc(record, &arc, &self.map, shape)
    }

    fn arc(&self, record: &Record, arc: &Arc, map: &Affine, shape: &mut Shape) -> Result<(), CaseError> {
        let mut points = self.chords(record, arc.points(map, self.tolerance))?;
        shape.closed = arc.is_whole();
        if shape.closed {
            points.pop();
        }
        shape.curves = 1;
        points.into_iter().for_each(|point| shape.push(point, record.line));
        Ok(())
    }

    fn spline(&self, record: &Record, flags: i64, shape: &mut Shape) -> Result<(), CaseError> {
        let corners = match self.fit_points(record, shape)? {
            fit if fit.points.is_empty() => self.spline_of(record, shape)?.corners(&self.map, self.tolerance),
            fit => {
                shape.fitted = 1;
                FitSpline { closed: flags & 1 != 0, ..fit }.corners(&self.map, self.tolerance)
            }
        };
        let points = self.chords(record, corners)?;
        shape.curves = 1;
        points.into_iter().for_each(|point| shape.push(point, record.line));
        // A closed spline ends where it begins, but for rounding; one that only looks closed stays open.
        let tolerance = self.tolerance.min(1e-3);
        let (first, last) = (shape.points[0], shape.points[shape.points.len() - 1]);
        let meets = libm::hypot(first[0] - last[0], first[1] - last[1]) <= tolerance;
        shape.closed = flags & 1 != 0 || (meets && shape.points.len() > 3);
        if shape.closed && meets {
            shape.points.pop();
            shape.lines.pop();
        }
        Ok(())
    }

    /// Points to be fitted, where a spline has no control points.
    fn fit_points(&self, record: &Record, shape: &mut Shape) -> Result<FitSpline, CaseError> {
        let mut fit = FitSpline::default();
        if record.find(POINT[0]).is_some() {
            return Ok(fit);
        }
        let starts = record.groups.iter().enumerate().filter(|(_, group)| group.code == END[0]).map(|(k, _)| k);
        for start in starts {
            let point = self.position(record, &record.groups[start..], END, shape)?;
            if fit.points.last() != Some(&point) {
                fit.points.push(point);
            }
        }
        for (tangent, codes) in fit.tangents.iter_mut().zip(TANGENTS) {
            if record.find(codes[0]).is_some() {
                *tangent = Some(self.position(record, record.groups, codes, &mut Shape::default())?);
            }
        }
        if fit.points.len() < 2 {
            fit.points.clear();
        }
        Ok(fit)
    }

    fn spline_of(&self, record: &Record, shape: &mut Shape) -> Result<Spline, CaseError> {
        let mut spline =
            Spline { degree: usize::try_from(record.whole(self.groups, 71)?).unwrap_or(0), ..Spline::default() };
        let numbers = |code: i32| -> Result<Vec<f64>, CaseError> {
            record.groups.iter().filter(|group| group.code == code).map(|group| self.groups.number(group)).collect()
        };
        (spline.knots, spline.weights) = (numbers(40)?, numbers(41)?);
        let starts = record.groups.iter().enumerate().filter(|(_, group)| group.code == POINT[0]).map(|(k, _)| k);
        for start in starts {
            spline.points.push(self.position(record, &record.groups[start..], POINT, shape)?);
        }
        if spline.weights.is_empty() {
            spline.weights = vec![1.0; spline.points.len()];
        }
        let (count, p) = (spline.points.len(), spline.degree);
        let sorted = spline.knots.windows(2).all(|pair| pair[0] <= pair[1]);
        let finite = spline.knots.iter().all(|knot| knot.is_finite()) && sorted;
        let problem = if count == 0 {
            "has neither control points nor two points to be fitted".to_string()
        } else if !(1..=DEGREE_MAX).contains(&p) || count <= p {
            format!("has {count} control points and the degree {p}, must be more than the degree, 1 to {DEGREE_MAX}")
        } else if spline.knots.len() != count + p + 1 || !finite || spline.knots[p] >= spline.knots[count] {
            format!("has {} knots, must be {} in ascending order", spline.knots.len(), count + p + 1)
        } else if spline.weights.len() != count || !spline.weights.iter().all(|w| *w > 0.0 && w.is_finite()) {
            format!("has {} weights, must be {count} that are above 0", spline.weights.len())
        } else {
            return Ok(spline);
        };
        self.groups.syntax(record.line, format!("SPLINE {problem}; save the drawing again"))
    }

    /// The corners of a curve.
    fn chords(&self, record: &Record, points: Option<Vec<[f64; 2]>>) -> Result<Vec<[f64; 2]>, CaseError> {
        points.map_or_else(
            || {
                let message = format!(
                    "{} needs more than {CHORDS_MAX} chords to stay within {} m; correct it or raise \
                     `domain.curve_tolerance`",
                    record.kind, self.tolerance
                );
                self.groups.syntax(record.line, message)
            },
            Ok,
        )
    }

    /// Reads a point in space, as one of the section.
    fn position(
        &self,
        record: &Record,
        pairs: &[Group],
        codes: [i32; 3],
        shape: &mut Shape,
    ) -> Result<[f64; 2], CaseError> {
        let [x, y] = self.coordinates(record, pairs, codes, shape)?;
        let z = find(pairs, codes[2]).map_or(Ok(0.0), |height| self.groups.number(height))?;
        Ok(self.plane.point([x, y, z]))
    }

    /// Reads x and y, and counts a height.
    fn coordinates(
        &self,
        record: &Record,
        pairs: &[Group],
        [x, y, z]: [i32; 3],
        shape: &mut Shape,
    ) -> Result<[f64; 2], CaseError> {
        let coordinate = |code| match find(pairs, code) {
            Some(group) => self.groups.number(group),
            None => {
                let line = pairs.first().map_or(record.line, |group| group.line);
                let message = format!("{} has no coordinate {code}; the file is damaged, save it again", record.kind);
                self.groups.syntax(line, message)
            }
        };
        let point = [coordinate(x)?, coordinate(y)?];
        if let Some(height) = find(pairs, z) {
            shape.high += usize::from(self.groups.number(height)? != 0.0);
        }
        Ok(point)
    }

    fn positive(&self, record: &Record, code: i32) -> Result<f64, CaseError> {
        let value = record.number(self.groups, code)?;
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        let line = record.find(code).map_or(record.line, |group| group.line);
        self.groups.syntax(line, format!("{} has {value} in group {code}, must be above 0; correct it", record.kind))
    }

    /// From the plane of the entity to the section: seen from below, its x points to the left.
    pub fn facing(&self, record: &Record) -> Result<Affine, CaseError> {
        let side = self.side(record)?;
        Ok(if side < 0.0 { self.map.after(&Affine::scaling([-1.0, 1.0])) } else { self.map })
    }

    /// 1 if the entity is drawn as the section is seen, -1 from behind.
    fn side(&self, record: &Record) -> Result<f64, CaseError> {
        let normal = normal(|code| record.find(code).map(|group| self.groups.number(group)).transpose())?;
        let (axis, towards) = self.plane.towards();
        let off = (0..3).filter(|k| *k != axis).all(|k| normal[k].abs() <= UPRIGHT);
        if off && normal[axis] != 0.0 {
            return Ok(towards * normal[axis].signum());
        }
        let [a, b, c] = normal;
        let line = EXTRUSION.iter().find_map(|&code| record.find(code)).map_or(record.line, |group| group.line);
        let plane = if self.plane == Plane::Flat { "x-y plane" } else { "upright plane of the others" };
        let message = format!("{} is not in the {plane} (extrusion {a}, {b}, {c})", record.kind);
        self.groups.syntax(line, message + "; draw it seen from above, or turn the drawing into the x-y plane")
    }
}

/// Codes of the extrusion direction of an entity, and what it is without.
const EXTRUSION: [i32; 3] = [210, 220, 230];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// The extrusion direction of an entity, by a reader of numbers.
///
/// # Errors
/// Those of the reader.
pub fn normal<E>(mut number: impl FnMut(i32) -> Result<Option<f64>, E>) -> Result<[f64; 3], E> {
    let mut normal = UP;
    for (value, code) in normal.iter_mut().zip(EXTRUSION) {
        *value = number(code)?.unwrap_or(*value);
    }
    Ok(normal)
}

/// Line of the pair with a code, else of the entity.
fn line_of(record: &Record, pairs: &[Group], code: i32) -> usize {
    find(pairs, code).map_or(record.line, |group| group.line)
}

impl Shape {
    fn push(&mut self, point: [f64; 2], line: usize) {
        self.points.push(point);
        self.lines.push(line);
    }
}
