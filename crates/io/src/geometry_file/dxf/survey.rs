//! A look at a drawing whose layers have no meaning yet: what `enmm import` starts from.

use std::collections::BTreeMap;

use super::entity::{Content, Tracer};
use super::groups::Groups;
use super::{records, sheet, space};
use crate::case_error::CaseError;
use crate::geometry_file::survey::{LayerSurvey, Survey};

/// Looks at a drawing; curves are within `tolerance` (m).
///
/// # Errors
/// The file is no drawing, or a block cannot be placed; an entity that cannot be read is a problem of its layer.
pub fn survey(file: &str, text: &str, tolerance: f64) -> Result<Survey, CaseError> {
    let groups = Groups::parse(file, text)?;
    let blocks = records::blocks(&groups)?;
    let entities = records::entities(&groups)?;
    let sheet = sheet(&groups, &blocks, &entities, None)?;
    let plane = space::plane(&sheet.placed, |_| true);
    let mut layers: BTreeMap<String, LayerSurvey> = BTreeMap::new();
    for placed in &sheet.placed {
        let layer = layers.entry(placed.layer.to_lowercase()).or_default();
        if layer.name.is_empty() {
            layer.name = placed.layer.to_string();
        }
        let kind = placed.record.kind.to_string();
        *layer.counts.entry(kind.clone()).or_default() += 1;
        let tracer = Tracer { groups: &groups, map: placed.map, plane, tolerance };
        let content = match tracer.content(placed.record) {
            Ok(content) => content,
            Err(error) => {
                layer.problems.entry(kind).or_insert_with(|| error.to_string());
                continue;
            }
        };
        match content {
            Content::Line(mut shape) => {
                let meets = shape.points.len() > 2 && shape.points.first() == shape.points.last();
                if meets {
                    shape.points.pop();
                }
                if meets || shape.closed { layer.loops.push(shape.points) } else { layer.lines.push(shape.points) }
            }
            Content::Remark => {}
            Content::Other => {
                let problem = format!("{kind} is of a type that is not read; explode it in the drawing");
                layer.problems.entry(kind).or_insert(problem);
            }
        }
    }
    let notes = sheet.notes.into_iter().chain(plane.note()).collect();
    Ok(Survey { layers: layers.into_values().collect(), is_drawing: true, unit: sheet.unit.text, notes })
}
