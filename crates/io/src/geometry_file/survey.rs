//! A look at a geometry file whose lines have no meaning yet: what `enmm import` starts from.

use std::collections::BTreeMap;

use super::names::Laws;
use super::unit::Unit;
use super::{Affine, Format, Geometry, Located, read};
use crate::case_error::CaseError;
use enmm::model::case::PointList;

/// Lines of a geometry file by their layers, or by the laws that they name.
#[derive(Debug, Default)]
pub struct Survey {
    /// Layers in the order of their names.
    pub layers: Vec<LayerSurvey>,
    /// Whether a case says what the layers are; else the file itself does.
    pub is_drawing: bool,
    /// Unit of the file.
    pub unit: String,
    /// Conversions, and parts that are not used.
    pub notes: Vec<String>,
}

/// One layer, or the lines of one law.
#[derive(Debug, Default)]
pub struct LayerSurvey {
    /// Name as the file writes it first.
    pub name: String,
    /// Number of entities by type.
    pub counts: BTreeMap<String, usize>,
    /// Closed lines (m).
    pub loops: Vec<PointList>,
    /// Open lines (m).
    pub lines: Vec<PointList>,
    /// Why entities cannot be read, the first of each type.
    pub problems: BTreeMap<String, String>,
}

/// Looks at a file that is no drawing.
///
/// # Errors
/// The file is none of its format.
pub fn survey(format: Format, file: &str, text: &str) -> Result<Survey, CaseError> {
    let mut geometry = read(format, file, text, &Laws::Any)?;
    let unit = Unit::of(geometry.declared.as_ref(), None, file)?;
    geometry.map(&Affine::of_case(None, unit.metres));
    let notes = [geometry.notes.clone(), geometry.warnings.clone()].concat();
    Ok(Survey { layers: layers(geometry), is_drawing: false, unit: unit.text, notes })
}

/// Name of the law of joints that name none.
pub const DEFAULT_LAW: &str = "joints";

fn layers(geometry: Geometry) -> Vec<LayerSurvey> {
    let Geometry { outline, holes, islands, traces, .. } = geometry;
    let rings = |name: &str, rings: Vec<PointList>| LayerSurvey {
        name: name.to_owned(),
        counts: BTreeMap::from([("loop".to_owned(), rings.len())]),
        loops: rings,
        ..LayerSurvey::default()
    };
    let points = |located: Vec<Located>| -> Vec<PointList> { located.into_iter().map(|(points, _)| points).collect() };
    let loops =
        [("outline", points(outline.into_iter().collect())), ("hole", points(holes)), ("island", points(islands))];
    let loops = loops.into_iter().filter(|(_, loops)| !loops.is_empty()).map(|(name, loops)| rings(name, loops));
    let mut joints: BTreeMap<String, LayerSurvey> = BTreeMap::new();
    for trace in traces {
        let name = trace.law.map_or_else(|| DEFAULT_LAW.to_owned(), |(law, _)| law);
        let layer = joints.entry(name.clone()).or_insert_with(|| LayerSurvey { name, ..LayerSurvey::default() });
        *layer.counts.entry("line".to_owned()).or_default() += 1;
        layer.lines.push(trace.points.0);
    }
    loops.chain(joints.into_values()).collect()
}
