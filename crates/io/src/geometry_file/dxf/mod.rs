//! ASCII DXF: lines, polylines, arcs, ellipses and splines of a drawing, also those of inserted blocks. Their layer says
//! what they are: by `layers` of the case, or else loops on `outline`, `hole` and `island`, and joints on all others,
//! whose law is the one with the name of the layer. Words and signs are counted in notes; other types are errors unless
//! their layer is ignored.
//!
//! The crates that read DXF do not keep the line of an entity, which every message here has.

mod curve;
mod entity;
mod groups;
mod inserts;
mod layers;
mod records;
mod survey;
mod units;

use std::collections::BTreeMap;

use self::entity::{Content, Shape, Tracer};
use self::groups::Groups;
use self::inserts::{Inserter, Placed};
use self::layers::{Layers, Target};
use super::affine::Affine;
use super::{Fault, Geometry, Trace};
use crate::case_error::CaseError;
use enmm::model::Case;
use enmm::model::case::key::Key;
use enmm::model::case::{CURVE_TOLERANCE, Transform};

pub use self::survey::{LayerSurvey, Survey, survey};

/// Names of the loops, which are also their layers where a case names none, in any letter case.
const LOOPS: [&str; 3] = ["outline", "hole", "island"];

/// Name of entities in keys.
const ENTITY: &str = "entity";

/// Reads the format.
///
/// # Errors
/// The first thing that cannot be used.
pub fn parse(file: &str, text: &str, case: &Case) -> Result<Geometry, Fault> {
    let groups = Groups::parse(file, text)?;
    let blocks = records::blocks(&groups)?;
    let entities = records::entities(&groups)?;
    let sheet = sheet(&groups, &blocks, &entities, case.transform.as_ref())?;
    let layers = Layers::new(case, &sheet.placed)?;
    let tolerance = case.domain.curve_tolerance.unwrap_or(CURVE_TOLERANCE * case.mesh.size);
    let mut reader = Reader {
        groups: &groups,
        layers,
        tolerance,
        geometry: Geometry { notes: sheet.notes, ..Geometry::default() },
        notes: BTreeMap::new(),
        lawless: BTreeMap::new(),
        closed: BTreeMap::new(),
        curves: 0,
    };
    for (i, placed) in sheet.placed.iter().enumerate() {
        reader.entity(&Key::root().field(ENTITY).index(i), placed)?;
    }
    if reader.geometry.outline.is_none() && case.domain.outline.is_empty() {
        return Err(reader.layers.no_outline(&reader.closed));
    }
    Ok(reader.finish())
}

/// All entities of model space at their places.
struct Sheet<'a> {
    placed: Vec<Placed<'a>>,
    notes: Vec<String>,
}

fn sheet<'a>(
    groups: &'a Groups<'a>,
    blocks: &'a records::Blocks<'a>,
    entities: &'a [records::Record<'a>],
    transform: Option<&Transform>,
) -> Result<Sheet<'a>, CaseError> {
    let (unit, note) = units::metres(groups, transform.and_then(|transform| transform.scale))?;
    let mut inserter = Inserter::new(groups, blocks);
    inserter.place(entities, &Affine::of_case(transform, unit), None)?;
    let paper = inserter.paper;
    let paper = (paper > 0).then(|| format!("{paper} entities on paper space are not used"));
    Ok(Sheet { placed: inserter.finish(), notes: note.into_iter().chain(paper).collect() })
}

/// Reader with what was found so far.
struct Reader<'a> {
    groups: &'a Groups<'a>,
    layers: Layers<'a>,
    tolerance: f64,
    geometry: Geometry,
    /// Things that were not used or changed, with counts.
    notes: BTreeMap<String, usize>,
    /// Traces without a law of their own, by what to say of them.
    lawless: BTreeMap<String, usize>,
    /// Closed lines by their layers.
    closed: BTreeMap<String, usize>,
    curves: usize,
}

impl Reader<'_> {
    fn entity(&mut self, key: &Key, placed: &Placed) -> Result<(), Fault> {
        let (record, layer) = (placed.record, placed.layer);
        let target = self.layers.target(layer)?;
        if matches!(target, Target::Ignore) {
            self.geometry.lines.push(ENTITY, record.line, &[]);
            self.note(format!("{} on layer {layer:?}, which is ignored", record.kind), 1);
            return Ok(());
        }
        let tracer = Tracer { groups: self.groups, map: placed.map, tolerance: self.tolerance };
        let shape = match tracer.content(record)? {
            Content::Line(shape) => shape,
            Content::Remark => {
                self.geometry.lines.push(ENTITY, record.line, &[]);
                self.note(format!("{} on layer {layer:?} not used: no line", record.kind), 1);
                return Ok(());
            }
            Content::Other => {
                let message = format!(
                    "{} on layer {layer:?} is of a type that is not read; explode it, or write `[layers.{layer:?}]` \
                     with `use = \"ignore\"`",
                    record.kind
                );
                return Ok(self.groups.fail(record.line, key, message)?);
            }
        };
        self.geometry.lines.push(ENTITY, record.line, &shape.lines);
        self.note("points whose height is not used".to_string(), shape.high);
        self.curves += shape.curves;
        if shape.closed {
            *self.closed.entry(layer.to_string()).or_default() += 1;
        }
        match target {
            Target::Loop(which) => Ok(self.ring(which, key, placed, shape)?),
            Target::Joint { law, is_known } => {
                if !is_known {
                    let warning = format!("traces on layer {layer:?}, which is no joint law, take the default law");
                    *self.lawless.entry(warning).or_default() += 1;
                }
                self.trace(key, shape, law);
                Ok(())
            }
            Target::Water => Ok(self.water(key, placed, shape)?),
            Target::Bolt(name) => Ok(self.bolt(key, placed, &shape, name)?),
            Target::Ignore => Ok(()),
        }
    }

    fn note(&mut self, text: String, count: usize) {
        if count > 0 {
            *self.notes.entry(text).or_default() += count;
        }
    }

    fn ring(&mut self, which: usize, key: &Key, placed: &Placed, mut shape: Shape) -> Result<(), CaseError> {
        let (kind, line) = (placed.record.kind, placed.record.line);
        let meets = shape.points.len() > 1 && shape.points.first() == shape.points.last();
        if !shape.closed && !meets {
            let message = format!("{kind} on layer {:?} is open, a loop must be closed; close it", placed.layer);
            return self.groups.fail(line, key, message);
        }
        if meets {
            shape.points.pop();
        }
        let located = (shape.points, key.to_string());
        match which {
            0 if self.geometry.outline.is_some() => {
                let remedy = self.layers.remedy_of_second_outline();
                return self.groups.fail(line, key, format!("is a second outline, there can be 1; {remedy}"));
            }
            0 => self.geometry.outline = Some(located),
            1 => self.geometry.holes.push(located),
            _ => self.geometry.islands.push(located),
        }
        Ok(())
    }

    fn trace(&mut self, key: &Key, mut shape: Shape, law: Option<String>) {
        if let Some(first) = shape.points.first().copied().filter(|_| shape.closed) {
            shape.points.push(first);
        }
        let law = law.map(|name| (name, key.to_string()));
        self.geometry.traces.push(Trace { points: (shape.points, key.to_string()), law });
    }

    fn water(&mut self, key: &Key, placed: &Placed, mut shape: Shape) -> Result<(), CaseError> {
        let (kind, line) = (placed.record.kind, placed.record.line);
        if shape.closed {
            let message = format!("{kind} on layer {:?} is closed, a water table is a line; open it", placed.layer);
            return self.groups.fail(line, key, message);
        }
        if self.geometry.water.is_some() {
            let message = "is a second water table, there can be 1; join both lines or move this one to another layer";
            return self.groups.fail(line, key, message.to_string());
        }
        if shape.points.first().map(|p| p[0]) > shape.points.last().map(|p| p[0]) {
            shape.points.reverse();
        }
        self.geometry.water = Some((shape.points, key.to_string()));
        Ok(())
    }

    fn bolt(&mut self, key: &Key, placed: &Placed, shape: &Shape, name: &str) -> Result<(), CaseError> {
        let [head, end] = shape.points[..] else {
            let message = format!(
                "{} on layer {:?} has {} points, a bolt has 2; draw it as one line",
                placed.record.kind,
                placed.layer,
                shape.points.len()
            );
            return self.groups.fail(placed.record.line, key, message);
        };
        self.geometry.bolts.entry(name.to_string()).or_default().push(([head, end], key.to_string()));
        Ok(())
    }

    fn finish(self) -> Geometry {
        let Self { mut geometry, notes, lawless, curves, tolerance, .. } = self;
        if curves > 0 {
            let note = format!(
                "{curves} arcs and splines are polylines within {tolerance} m of them (`domain.curve_tolerance`)"
            );
            geometry.notes.push(note);
        }
        geometry.notes.extend(notes.iter().map(|(text, count)| format!("{count} {text}")));
        geometry.warnings.extend(lawless.iter().map(|(text, count)| format!("{count} {text}")));
        geometry
    }
}
