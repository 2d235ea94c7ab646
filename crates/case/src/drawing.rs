//! How a drawing becomes a section: what its layers are, and how its coordinates become metres.

use serde::{Deserialize, Serialize};

use super::{Bolt, Case, PointList};

/// A layer of a DXF drawing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Part of the section that the lines of the layer are.
    #[serde(rename = "use")]
    pub role: LayerUse,
    /// Joint law by name, of a layer of joints; default `domain.joint_law`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// Name of the `[[bolt]]` without `points` that the lines of a layer of bolts are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bolt: Option<String>,
}

/// Part of a section that a layer holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LayerUse {
    /// Outer loop of the rock.
    Outline,
    /// Loops cut out of the outline.
    Hole,
    /// Loops of rock inside holes or beside the outline.
    Island,
    /// Joint traces.
    Joint,
    /// Water table, one line from left to right.
    Water,
    /// Bolts, each a straight line from its head to its far end.
    Bolt,
    /// Nothing: its entities are counted in a note.
    Ignore,
}

/// How the coordinates of a geometry file become those of the section: times `scale`, mirrored, then shifted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Transform {
    /// Metres in a unit of the drawing; default: what `$INSUNITS` of a DXF drawing says, else 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(example = 0.001))]
    pub scale: Option<f64>,
    /// Coordinates whose sign changes, before the shift.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flip: Option<Flip>,
    /// Added to x and y (m), last.
    #[serde(default)]
    pub shift: [f64; 2],
}

/// Coordinates whose sign changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Flip {
    /// x: the section is seen from its other side.
    X,
    /// y: the drawing has y down.
    Y,
    /// Both.
    Xy,
}

/// Share of the mesh size within which curves of a drawing become polylines.
pub const CURVE_TOLERANCE: f64 = 0.02;

impl Case {
    /// Gives the bolt without `points` of this name those of lines of a drawing, and stages that install it all of
    /// them; returns the place of each among the bolts.
    pub fn put_bolts(&mut self, name: &str, lines: &[[[f64; 2]; 2]]) -> Vec<usize> {
        let is_open = |bolt: &Bolt| bolt.name.as_deref() == Some(name) && bolt.has_no_points();
        let Some(place) = self.bolts.iter().position(is_open) else { return Vec::new() };
        let open = self.bolts.remove(place);
        let first = self.bolts.len();
        let named = |k: usize| format!("{name}_{}", k + 1);
        let bolt = |(k, points): (usize, &_)| Bolt { name: Some(named(k)), points: *points, ..open.clone() };
        self.bolts.extend(lines.iter().enumerate().map(bolt));
        for stage in &mut self.stages {
            if let Some(at) = stage.install.iter().position(|installed| installed == name) {
                stage.install.splice(at..=at, (0..lines.len()).map(named));
            }
        }
        (first..self.bolts.len()).collect()
    }

    /// Sets the water table that a drawing holds.
    pub fn put_water_table(&mut self, points: PointList) {
        self.water.get_or_insert_with(super::Water::still).table = Some(points);
    }
}
