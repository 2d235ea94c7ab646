//! ASCII DXF: `LINE`, `LWPOLYLINE` and `POLYLINE` entities are joint traces; their layer is the joint law if one has
//! this name. Closed polylines on the layers `OUTLINE`, `HOLE` and `ISLAND` are loops. Arcs are errors, other entities
//! are counted in warnings. Coordinates are metres.

mod entity;
mod groups;

use std::collections::BTreeMap;

use self::entity::{Entity, Shape};
use self::groups::Groups;
use super::{Geometry, Trace};
use crate::case_error::CaseError;
use enmm::model::Case;
use enmm::model::case::key::Key;

/// Layers of loops, in any letter case.
const LOOP_LAYERS: [&str; 3] = ["OUTLINE", "HOLE", "ISLAND"];

/// Name of entities in keys.
const ENTITY: &str = "entity";

/// Reads the format.
///
/// # Errors
/// The first thing that cannot be used.
pub fn parse(file: &str, text: &str, case: &Case) -> Result<Geometry, CaseError> {
    let groups = Groups::parse(file, text)?;
    let mut reader = Reader { groups: &groups, case, geometry: Geometry::default(), unused: BTreeMap::new() };
    reader.units();
    for (i, entity) in entity::entities(&groups)?.into_iter().enumerate() {
        reader.entity(&Key::root().field(ENTITY).index(i), &entity)?;
    }
    Ok(reader.finish())
}

/// Reader with the entities found so far.
struct Reader<'a> {
    groups: &'a Groups<'a>,
    case: &'a Case,
    geometry: Geometry,
    unused: BTreeMap<String, usize>,
}

impl Reader<'_> {
    /// Warns if the drawing says that its units are not metres (code 6; 0 is none).
    fn units(&mut self) {
        let header = self.groups.all.iter().skip_while(|group| group.value != "$INSUNITS");
        if let Some(unit) =
            header.skip(1).find(|group| group.code == 70).filter(|group| !["0", "6"].contains(&group.value))
        {
            let warning = format!("$INSUNITS is {}, not 6 (metres); coordinates are taken as metres", unit.value);
            self.geometry.warnings.push(warning);
        }
    }

    fn entity(&mut self, key: &Key, entity: &Entity) -> Result<(), CaseError> {
        let shape = match entity.shape(self.groups)? {
            Some(shape) => {
                self.geometry.lines.push(ENTITY, entity.line, &shape.lines);
                shape
            }
            None => {
                self.geometry.lines.push(ENTITY, entity.line, &[]);
                *self.unused.entry(format!("{} entities not used", entity.kind)).or_default() += 1;
                return Ok(());
            }
        };
        if shape.high > 0 {
            *self.unused.entry("points whose height is not used".to_string()).or_default() += shape.high;
        }
        match LOOP_LAYERS.iter().position(|layer| entity.layer.eq_ignore_ascii_case(layer)) {
            Some(layer) => self.ring(layer, key, entity, shape),
            None => {
                self.trace(key, entity, shape);
                Ok(())
            }
        }
    }

    fn ring(&mut self, layer: usize, key: &Key, entity: &Entity, mut shape: Shape) -> Result<(), CaseError> {
        let meets = shape.points.len() > 1 && shape.points.first() == shape.points.last();
        if !shape.closed && !meets {
            let message =
                format!("{} on layer {:?} is open, a loop must be closed; close it", entity.kind, entity.layer);
            return self.groups.fail(entity.line, key, message);
        }
        if meets {
            shape.points.pop();
        }
        let located = (shape.points, key.to_string());
        match layer {
            0 if self.geometry.outline.is_some() => {
                let message = format!("is a second outline, there can be 1; move it to layer {:?}", LOOP_LAYERS[2]);
                return self.groups.fail(entity.line, key, message);
            }
            0 => self.geometry.outline = Some(located),
            1 => self.geometry.holes.push(located),
            _ => self.geometry.islands.push(located),
        }
        Ok(())
    }

    fn trace(&mut self, key: &Key, entity: &Entity, mut shape: Shape) {
        if let Some(first) = shape.points.first().copied().filter(|_| shape.closed) {
            shape.points.push(first);
        }
        let law = self.case.joint_laws.get_key_value(entity.layer).map(|(name, _)| (name.clone(), key.to_string()));
        if law.is_none() {
            let what = format!("traces on layer {:?}, which is no joint law, take the default law", entity.layer);
            *self.unused.entry(what).or_default() += 1;
        }
        self.geometry.traces.push(Trace { points: (shape.points, key.to_string()), law });
    }

    fn finish(self) -> Geometry {
        let Self { mut geometry, unused, .. } = self;
        geometry.warnings.extend(unused.iter().map(|(what, count)| format!("{count} {what}")));
        geometry
    }
}
