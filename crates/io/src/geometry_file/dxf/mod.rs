//! ASCII DXF: lines, polylines, arcs, ellipses and splines of a drawing, also those of inserted blocks. Their layer
//! says what they are: by `layers` of the case, or else loops on `outline`, `hole` and `island`, and joints on all
//! others, whose law is the one with the name of the layer. Words and signs are counted in notes; other types are
//! errors unless their layer is ignored.
//!
//! The crates that read DXF do not keep the line of an entity, which every message here has.

mod chain;
mod curve;
mod entity;
mod fit;
mod groups;
mod inserts;
mod layers;
mod records;
mod space;
mod survey;
mod units;

use std::collections::BTreeMap;

use self::chain::{Dangling, Piece};
use self::entity::{Content, Shape, Tracer};
use self::groups::Groups;
use self::inserts::{Inserter, Placed};
use self::layers::{Layers, Target};
use super::affine::Affine;
use super::names::Ring;
use super::unit::Unit;
use super::upright::Plane;
use super::{Fault, Geometry, Trace, lawless};
use crate::case_error::CaseError;
use enmm::model::Case;
use enmm::model::case::key::Key;
use enmm::model::case::{CURVE_TOLERANCE, PointList, Transform};

pub use self::survey::survey;

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
    let plane = space::plane(&sheet.placed, |layer| !matches!(layers.target(layer), Ok(Target::Ignore)));
    let notes = sheet.notes.into_iter().chain(plane.note()).collect();
    let mut reader = Reader {
        groups: &groups,
        layers,
        plane,
        tolerance,
        geometry: Geometry { notes, unit: sheet.unit.text, ..Geometry::default() },
        notes: BTreeMap::new(),
        lawless: BTreeMap::new(),
        closed: BTreeMap::new(),
        open: [const { Vec::new() }; 3],
        snap_tolerance: case.domain.snap_tolerance,
        curves: 0,
        fitted: 0,
    };
    for (i, placed) in sheet.placed.iter().enumerate() {
        reader.entity(&Key::root().field(ENTITY).index(i), placed)?;
    }
    reader.join()?;
    if reader.geometry.outline.is_none() && case.domain.outline.is_empty() {
        return Err(reader.layers.no_outline(&reader.closed));
    }
    Ok(reader.finish())
}

/// All entities of model space at their places.
struct Sheet<'a> {
    placed: Vec<Placed<'a>>,
    unit: Unit,
    notes: Vec<String>,
}

fn sheet<'a>(
    groups: &'a Groups<'a>,
    blocks: &'a records::Blocks<'a>,
    entities: &'a [records::Record<'a>],
    transform: Option<&Transform>,
) -> Result<Sheet<'a>, CaseError> {
    let unit = units::unit(groups, transform.and_then(|transform| transform.scale))?;
    let mut inserter = Inserter::new(groups, blocks);
    inserter.place(entities, &Affine::of_case(transform, unit.metres), None)?;
    let paper = inserter.paper;
    let paper = (paper > 0).then(|| format!("{paper} entities on paper space are not used"));
    let notes = unit.note.clone().into_iter().chain(paper).collect();
    Ok(Sheet { placed: inserter.finish(), unit, notes })
}

/// Reader with what was found so far.
struct Reader<'a> {
    groups: &'a Groups<'a>,
    layers: Layers<'a>,
    plane: Plane,
    tolerance: f64,
    geometry: Geometry,
    /// Things that were not used or changed, with counts.
    notes: BTreeMap<String, usize>,
    /// Traces without a law of their own, by layer.
    lawless: BTreeMap<String, usize>,
    /// Closed lines by their layers.
    closed: BTreeMap<String, usize>,
    /// Open lines of each kind of loop.
    open: [Vec<Piece>; 3],
    snap_tolerance: Option<f64>,
    curves: usize,
    fitted: usize,
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
        let tracer = Tracer { groups: self.groups, map: placed.map, plane: self.plane, tolerance: self.tolerance };
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
        self.fitted += shape.fitted;
        if shape.closed {
            *self.closed.entry(layer.to_string()).or_default() += 1;
        }
        match target {
            Target::Loop(which) => Ok(self.ring(which, key, placed, shape)?),
            Target::Joint { law, is_known } => {
                if !is_known {
                    *self.lawless.entry(layer.to_owned()).or_default() += 1;
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

    fn ring(&mut self, which: Ring, key: &Key, placed: &Placed, mut shape: Shape) -> Result<(), CaseError> {
        let (kind, line) = (placed.record.kind, placed.record.line);
        let meets = shape.points.len() > 1 && shape.points.first() == shape.points.last();
        if !shape.closed && !meets {
            let kind = format!("{kind} on layer {:?}", placed.layer);
            self.open[which as usize].push(Piece { points: shape.points, key: key.to_string(), line, kind });
            return Ok(());
        }
        if meets {
            shape.points.pop();
        }
        self.put_ring(which, key.as_str(), line, shape.points)
    }

    /// Joins the open lines of each kind of loop.
    fn join(&mut self) -> Result<(), CaseError> {
        for which in Ring::ALL {
            let pieces = std::mem::take(&mut self.open[which as usize]);
            let Some(Piece { key, line, kind, .. }) = pieces.get(chain::PIECES_MAX) else {
                self.join_pieces(which, pieces)?;
                continue;
            };
            let message = format!("{kind} is open, as {} lines before it; join them", chain::PIECES_MAX);
            return Err(CaseError::at(self.groups.file, *line, key, message));
        }
        Ok(())
    }

    fn join_pieces(&mut self, which: Ring, pieces: Vec<Piece>) -> Result<(), CaseError> {
        let points = || pieces.iter().flat_map(|piece| &piece.points);
        let size = points().flatten().fold(0.0f64, |most, value| most.max(value.abs()));
        let tolerance = self.snap_tolerance.unwrap_or(1e-6 * size);
        let loops = chain::loops(pieces, tolerance).map_err(|dangling| {
            let Dangling { piece, end: [x, y], gap } = *dangling;
            let gap = gap.map_or(String::new(), |gap| {
                format!("; its end at ({x:.6}, {y:.6}) is {gap:.3e} m from the next line of this use")
            });
            let message = format!("{} is open, a loop must be closed; close it{gap}", piece.kind);
            CaseError::at(self.groups.file, piece.line, &piece.key, message)
        })?;
        for (points, first) in loops {
            self.note("loops joined of open lines that meet".to_string(), 1);
            self.put_ring(which, &first.key, first.line, points)?;
        }
        Ok(())
    }

    fn put_ring(&mut self, which: Ring, key: &str, line: usize, points: PointList) -> Result<(), CaseError> {
        let put = self.geometry.put_ring(which, (points, key.to_string()), self.layers.remedy_of_second_outline());
        put.map_err(|message| CaseError::at(self.groups.file, line, key, message))
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
        let Self { mut geometry, notes, lawless: layers, curves, fitted, tolerance, .. } = self;
        if curves > 0 {
            let note = format!(
                "{curves} arcs and splines are polylines within {tolerance} m of them (`domain.curve_tolerance`)"
            );
            geometry.notes.push(note);
        }
        if fitted > 0 {
            geometry.notes.push(format!(
                "{fitted} splines have points to be fitted alone; they are drawn as cubics through these, by chord \
                 length"
            ));
        }
        geometry.notes.extend(notes.iter().map(|(text, count)| format!("{count} {text}")));
        geometry.warnings.extend(layers.iter().map(|(layer, count)| lawless(layer, *count)));
        geometry
    }
}
