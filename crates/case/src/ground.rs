//! Ground motion and boundaries for waves: base motion, quiet boundaries, free-field columns.

use std::path::PathBuf;

use super::record::{BaseMotionKind, Baseline, RecordOrigin, RecordReading, WaveMotion};
use super::{Axes, Case, Fix, StageKind, TimeTable};
use crate::keys::shared::{FACTOR, PLACE, ROWS};
use crate::keys::unit::SPEED;
use crate::keys::{Range, keys, words};
use crate::limits::VELOCITY_MAX;

words! {
    /// One direction of the plane.
    #[derive(Default)]
    pub enum Axis {
        /// Horizontal.
        #[default]
        X = "x",
        /// Vertical.
        Y = "y",
    }
}

keys! {
    /// Motion of the base that carries the model; the model lives in the frame of the base, so that its rock feels the
    /// opposite acceleration.
    pub default struct BaseMotion {
        /// Quantity in the rows.
        pub kind: BaseMotionKind,
        /// Direction.
        pub axis: Axis,
        /// Rows of time (s) since the start of the stage and value; linear between. Outside them the acceleration is
        /// zero: a velocity must start at 0 and keeps its last value. This or `file`.
        pub table: Option<TimeTable> => ROWS,
        /// File of a record of this kind, relative to the case file: columns of time (s) and value, or a format of the
        /// agencies.
        pub file: Option<PathBuf>,
        /// File of a record of acceleration, in place of `kind` and `file`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub acceleration: Option<PathBuf>,
        /// File of a record of velocity, in place of `kind` and `file`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub velocity: Option<PathBuf>,
        /// File of a record of displacement, in place of `kind` and `file`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub displacement: Option<PathBuf>,
        /// How the file is read, where it does not say so itself.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub record: Option<RecordReading>,
        /// Correction of a record that does not end at rest; default: none.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub baseline: Option<Baseline>,
        /// Factor on the values, such as 9.81 for a record in g whose file does not say so.
        pub scale: f64 = 1.0 => FACTOR,
        /// Dynamic stage at whose start the table begins; default: the first one. It acts in dynamic stages from there
        /// on.
        pub stage: Option<String>,
        /// Where the rows come from.
        #[serde(skip)]
        pub origin: RecordOrigin,
    }
}

keys! {
    /// A boundary that lets waves leave (viscous, after Lysmer and Kuhlemeyer) and may send one in. In static stages it
    /// holds like a fixity; in dynamic stages its static reactions stay as constant forces.
    #[derive(Default)]
    pub struct Quiet {
        /// The parts of the rock boundary on this segment (m).
        pub edge: [[f64; 2]; 2] => PLACE,
        /// Directions that it holds in static stages.
        #[serde(default)]
        pub axes: Axes,
        /// Direction and amplitude (m/s, global axes) of the incident wave's particle velocity; with `kind` its
        /// direction times a factor, [1.0, 0.0] by default.
        pub wave: Option<[f64; 2]> =>
            Range::within(VELOCITY_MAX).of(SPEED).hint("the particle velocity of the incident wave"),
        /// Quantity in the rows along `wave`; default: factors on `wave`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub kind: Option<BaseMotionKind>,
        /// Rows of time (s) since the start of the stage and factor on `wave`, or value of `kind`; linear between, zero
        /// outside. This or `file`.
        pub table: Option<TimeTable> => ROWS,
        /// File of a record of such rows, relative to the case file: columns of time (s) and value, or a format of the
        /// agencies.
        pub file: Option<PathBuf>,
        /// File of a record of acceleration, in place of `kind` and `file`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub acceleration: Option<PathBuf>,
        /// File of a record of velocity, in place of `kind` and `file`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub velocity: Option<PathBuf>,
        /// File of a record of displacement, in place of `kind` and `file`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub displacement: Option<PathBuf>,
        /// How the file is read, where it does not say so itself.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub record: Option<RecordReading>,
        /// Part of the wave that the record shows; default: the incident wave. The motion of an outcrop is halved.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub motion: Option<WaveMotion>,
        /// Correction of a record that does not end at rest; default: none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub baseline: Option<Baseline>,
        /// Factor on the values.
        #[serde(default = "crate::keys::one")]
        pub scale: f64 => FACTOR,
        /// Dynamic stage at whose start the table begins; default: the first one. It acts in dynamic stages from there
        /// on.
        pub stage: Option<String>,
        /// Where the rows come from.
        #[serde(skip)]
        pub origin: RecordOrigin,
    }
}

keys! {
    /// A column of rock beside a vertical side of the model that moves as the free field does; the side is coupled to
    /// it by a quiet boundary. Its foot moves as the boundary below it: with the base, or as a quiet boundary with its
    /// wave.
    #[derive(Default)]
    pub struct FreeField {
        /// The vertical side (m).
        pub edge: [[f64; 2]; 2] => PLACE,
        /// Directions that the side holds in static stages.
        #[serde(default = "horizontal")]
        pub axes: Axes,
    }
}

/// The keys of a ground motion that name its record and say how it is read.
pub struct RecordKeys<'a> {
    /// Keys that name a file, with the quantity that each stands for.
    pub files: [(&'static str, Option<BaseMotionKind>, &'a mut Option<PathBuf>); 4],
    /// Its rows.
    pub table: &'a mut Option<TimeTable>,
    /// How the file is read.
    pub reading: &'a mut Option<RecordReading>,
    /// Factor on the values.
    pub scale: f64,
    /// Where the rows come from.
    pub origin: &'a mut RecordOrigin,
}

macro_rules! record_keys {
    ($motion:expr) => {
        RecordKeys {
            files: [
                ("file", None, &mut $motion.file),
                ("acceleration", Some(BaseMotionKind::Acceleration), &mut $motion.acceleration),
                ("velocity", Some(BaseMotionKind::Velocity), &mut $motion.velocity),
                ("displacement", Some(BaseMotionKind::Displacement), &mut $motion.displacement),
            ],
            table: &mut $motion.table,
            reading: &mut $motion.record,
            scale: $motion.scale,
            origin: &mut $motion.origin,
        }
    };
}

impl BaseMotion {
    /// The keys of its record.
    pub fn record_keys(&mut self) -> RecordKeys<'_> {
        record_keys!(self)
    }
}

impl Quiet {
    /// The keys of its record.
    pub fn record_keys(&mut self) -> RecordKeys<'_> {
        record_keys!(self)
    }
}

impl Case {
    /// Lets fixities hold what quiet boundaries and free fields hold in static stages, in their place, for a search
    /// that knows no waves; ports of quiet boundaries go with them.
    pub fn hold_quiet_edges(&mut self) {
        let quiets = self.quiets.drain(..).map(|quiet| (quiet.edge, quiet.axes));
        let sides = self.free_fields.drain(..).map(|side| (side.edge, side.axes));
        let held = quiets.chain(sides).map(|(edge, axes)| Fix { edge: Some(edge), axes, ..Fix::default() });
        self.fixes.extend(held);
        self.ports.retain(|port| port.quiet.is_none());
    }
}

impl Case {
    /// The stage at whose start a ground motion begins: the named one, or the first dynamic one.
    pub fn motion_stage(&self, name: Option<&str>) -> Option<usize> {
        match name {
            Some(name) => self.stages.iter().position(|stage| stage.name == name),
            None => self.stages.iter().position(|stage| stage.kind == StageKind::Dynamic),
        }
    }

    /// Whether a ground motion acts in a stage, by its index.
    pub fn is_shaken(&self, stage: usize) -> bool {
        let motions = self.base_motions.iter().map(|motion| &motion.stage);
        let waves = self.quiets.iter().filter(|quiet| quiet.wave.is_some()).map(|quiet| &quiet.stage);
        let has_begun = |name: &Option<String>| self.motion_stage(name.as_deref()).is_some_and(|first| first <= stage);
        self.stages[stage].kind == StageKind::Dynamic && motions.chain(waves).any(has_begun)
    }
}

fn horizontal() -> Axes {
    Axes::X
}
