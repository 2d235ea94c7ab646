//! How a drawing becomes a section: what its layers are, and how its coordinates become metres.

use super::{Bolt, Case, PointList};
use crate::keys::shared::HEIGHT;
use crate::keys::unit::NUMBER;
use crate::keys::{Range, keys, words};

keys! {
    /// A layer of a DXF drawing.
    #[derive(Eq)]
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
}

words! {
    /// Part of a section that a layer holds.
    pub enum LayerUse {
        /// Outer loop of the rock.
        Outline = "outline",
        /// Loops cut out of the outline.
        Hole = "hole",
        /// Loops of rock inside holes or beside the outline.
        Island = "island",
        /// Joint traces.
        Joint = "joint",
        /// Water table, one line from left to right.
        Water = "water",
        /// Bolts, each a straight line from its head to its far end.
        Bolt = "bolt",
        /// Nothing: its entities are counted in a note.
        Ignore = "ignore",
    }
}

keys! {
    /// How the coordinates of a geometry file become those of the section: times `scale`, mirrored, then shifted.
    pub default struct Transform {
        /// Metres in a unit of the drawing; default: what `$INSUNITS` of a DXF drawing says, else 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub scale: Option<f64> =>
            Range::from(1e-6).to(1e6).of(NUMBER).hint("metres in a unit of the drawing: 0.001 for mm").example(0.001),
        /// Coordinates whose sign changes, before the shift.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub flip: Option<Flip>,
        /// Added to x and y (m), last.
        pub shift: [f64; 2] => HEIGHT.hint("what moves the drawing to its place"),
    }
}

words! {
    /// Coordinates whose sign changes.
    pub enum Flip {
        /// x: the section is seen from its other side.
        X = "x",
        /// y: the drawing has y down.
        Y = "y",
        /// Both.
        Xy = "xy",
    }
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
