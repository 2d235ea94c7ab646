//! Entities of a DXF drawing and the points of those that are lines.

use super::groups::{Group, Groups};
use crate::case_error::CaseError;
use enmm::model::case::PointList;

/// One entity; a polyline comprises its vertices.
pub struct Entity<'a> {
    /// Type, such as `LINE`.
    pub kind: &'a str,
    /// Layer; `0` if none is given.
    pub layer: &'a str,
    /// Line of the type, counted from 1.
    pub line: usize,
    groups: &'a [Group<'a>],
    vertices: Vec<&'a [Group<'a>]>,
    ended: bool,
}

/// Points of an entity.
#[derive(Debug, Default)]
pub struct Shape {
    /// The points.
    pub points: PointList,
    /// Line of each point, counted from 1.
    pub lines: Vec<usize>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
    /// How many points have a height, which is not used.
    pub high: usize,
}

/// Returns the entities of the section `ENTITIES`.
///
/// # Errors
/// The file has no such section, or a polyline does not end.
pub fn entities<'a>(groups: &'a Groups<'a>) -> Result<Vec<Entity<'a>>, CaseError> {
    let named = |pair: &[Group]| (pair[0].code, pair[0].value, pair[1].value) == (0, "SECTION", "ENTITIES");
    let Some(start) = groups.all.windows(2).position(named) else {
        return groups
            .syntax(1, "no section ENTITIES, which holds the lines; save the drawing as ASCII DXF".to_string());
    };
    let body = &groups.all[start + 2..];
    let end = body.iter().position(|group| group.code == 0 && group.value == "ENDSEC").unwrap_or(body.len());
    let mut entities: Vec<Entity> = Vec::new();
    for record in body[..end].chunk_by(|_, next| next.code != 0) {
        let (kind, line) = (record[0].value, record[0].line);
        match (kind, entities.last_mut().filter(|last| last.kind == "POLYLINE" && !last.ended)) {
            ("VERTEX", Some(polyline)) => polyline.vertices.push(record),
            ("SEQEND", Some(polyline)) => polyline.ended = true,
            (_, Some(polyline)) => return groups.syntax(polyline.line, UNENDED.to_string()),
            _ => {
                let layer = find(record, 8).map_or("0", |group| group.value);
                entities.push(Entity { kind, layer, line, groups: record, vertices: Vec::new(), ended: false });
            }
        }
    }
    match entities.last().filter(|last| last.kind == "POLYLINE" && !last.ended) {
        Some(polyline) => groups.syntax(polyline.line, UNENDED.to_string()),
        None => Ok(entities),
    }
}

const UNENDED: &str = "POLYLINE without SEQEND after its vertices; the file is damaged, save it again";

impl Entity<'_> {
    /// Returns the points, or none if the entity is of a type that is not read.
    ///
    /// # Errors
    /// The entity is an arc or mirrored, or a coordinate is missing or no number.
    pub fn shape(&self, groups: &Groups) -> Result<Option<Shape>, CaseError> {
        let flags = whole(groups, self.groups, 70)?;
        let in_paper_space = whole(groups, self.groups, 67)? == 1;
        let mut shape = Shape { closed: flags & 1 != 0, ..Shape::default() };
        match self.kind {
            _ if in_paper_space => return Ok(None),
            "LINE" => {
                shape.closed = false;
                shape.push(groups, self, self.groups, [10, 20, 30])?;
                shape.push(groups, self, self.groups, [11, 21, 31])?;
            }
            "LWPOLYLINE" => {
                let first = self.groups.iter().position(|group| group.code == 10).unwrap_or(self.groups.len());
                for vertex in self.groups[first..].chunk_by(|_, next| next.code != 10) {
                    shape.push(groups, self, vertex, [10, 20, 30])?;
                }
                if let Some(height) = find(self.groups, ELEVATION) {
                    shape.high = shape.points.len() * usize::from(number(groups, height)? != 0.0);
                }
            }
            "POLYLINE" if flags & (MESH | FACES) == 0 => {
                if flags & (CURVE | SPLINE) != 0 {
                    let message =
                        "POLYLINE fitted with a curve, only straight lines are read; explode it or straighten it";
                    return groups.syntax(self.line, message.to_string());
                }
                for vertex in &self.vertices {
                    shape.push(groups, self, vertex, [10, 20, 30])?;
                }
            }
            _ => return Ok(None),
        }
        self.must_face_up(groups)?;
        Ok(Some(shape))
    }

    /// Refuses an entity whose extrusion direction is not the z axis, as its x and y would not be those of the drawing.
    fn must_face_up(&self, groups: &Groups) -> Result<(), CaseError> {
        match find(self.groups, 230) {
            Some(group) if number(groups, group)? != 1.0 => {
                let message = format!("{} is not in the x-y plane (extrusion {})", self.kind, group.value);
                groups.syntax(group.line, message + "; draw it seen from above")
            }
            _ => Ok(()),
        }
    }
}

/// Code of the height of all points of a LWPOLYLINE.
const ELEVATION: i32 = 38;
/// Flags of a POLYLINE.
const CURVE: i64 = 2;
const SPLINE: i64 = 4;
const MESH: i64 = 16;
const FACES: i64 = 64;

impl Shape {
    /// Adds the point of `record` under three codes.
    fn push(
        &mut self,
        groups: &Groups,
        entity: &Entity,
        record: &[Group],
        [x, y, z]: [i32; 3],
    ) -> Result<(), CaseError> {
        let coordinate = |code| match find(record, code) {
            Some(group) => number(groups, group),
            None => {
                let line = record.first().map_or(entity.line, |group| group.line);
                groups.syntax(
                    line,
                    format!("{} has no coordinate {code}; the file is damaged, save it again", entity.kind),
                )
            }
        };
        self.points.push([coordinate(x)?, coordinate(y)?]);
        self.lines.push(find(record, x).map_or(entity.line, |group| group.line));
        if let Some(bulge) = find(record, 42).filter(|_| entity.kind != "LINE")
            && number(groups, bulge)? != 0.0
        {
            let message = format!("{} has an arc (bulge {}), only straight lines are read", entity.kind, bulge.value);
            return groups.syntax(bulge.line, message + "; replace arcs by short lines");
        }
        if let Some(height) = find(record, z) {
            self.high += usize::from(number(groups, height)? != 0.0);
        }
        Ok(())
    }
}

fn find<'a, 'g>(record: &'g [Group<'a>], code: i32) -> Option<&'g Group<'a>> {
    record.iter().find(|group| group.code == code)
}

fn number(groups: &Groups, group: &Group) -> Result<f64, CaseError> {
    let bad =
        |_| groups.syntax(group.line, format!("{:?} of group {} is no number; correct it", group.value, group.code));
    group.value.parse().or_else(bad)
}

/// Returns a whole number, 0 if it is not given.
fn whole(groups: &Groups, record: &[Group], code: i32) -> Result<i64, CaseError> {
    let Some(group) = find(record, code) else { return Ok(0) };
    let bad =
        |_| groups.syntax(group.line, format!("{:?} of group {code} is no whole number; correct it", group.value));
    group.value.parse().or_else(bad)
}
