//! Stages of a case.

use std::collections::BTreeMap;

use crate::flow::{EVERY, HEAD, RATE};
use crate::joint_law::{COHESION, FRICTION, TENSION};
use crate::keys::shared::{PLACE, TIME};
use crate::keys::unit::{NUMBER, SECOND};
use crate::keys::{Range, Rule, keys, words};
use crate::{PointList, StageFlow, WaterSurface};

words! {
    /// How a stage treats time.
    #[derive(Default)]
    pub enum StageKind {
        /// Damped to equilibrium; time is a path, not physics.
        #[default]
        Static = "static",
        /// True motion.
        Dynamic = "dynamic",
    }
}

/// Simulated times of stages.
const DURATION: Rule =
    TIME.hint("give the simulated time of the stage").usual([0.05, 2e3], "slopes rest or fail within 1 to 60 s");

keys! {
    /// One stage: changes at its start, then motion.
    #[derive(Default)]
    pub struct Stage {
        /// Name.
        pub name: String,
        /// Static or dynamic.
        pub kind: StageKind,
        /// Simulated time (s); for a static stage the most that it may take. A static stage may give `duration_max`
        /// instead.
        #[serde(default)]
        pub duration: f64 => DURATION,
        /// Static: the most simulated time (s) that the stage may take; it ends as soon as the rock is at rest.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub duration_max: Option<f64> => DURATION,
        /// Static: unbalanced ratio at which the stage ends.
        pub convergence: Option<f64> => Range::above(0.0).below(1.0).of(NUMBER).hint("1e-3 to 1e-5 is usual"),
        /// Static: time (s) over which gravity and body loads grow from nothing; default: from the model's height and
        /// wave speed in the first stage, 0 in later stages.
        pub ramp: Option<f64> => Range::from(0.0).to(1e9).of(SECOND).hint("it ends within the stage's duration"),
        /// Dynamic: damping ratio ξ of the deformation of each block and of bouncing on joints; default 0.1. Waves that
        /// are to keep their height want 0.
        pub damping: Option<f64> => Range::from(0.0).to(1.0).of(NUMBER).hint("0 to 0.1 is usual"),
        /// Points (m): the blocks that hold them are removed.
        #[serde(default)]
        pub excavate: PointList => PLACE,
        /// Polygon (m): the blocks whose reference centroid lies inside are removed.
        pub excavate_region: Option<PointList> => PLACE,
        /// Lines along which the rock is cut at its start: joints, or the borders of what it excavates. They need not
        /// be drawn before, and carry the stress of the rock until their law gives way.
        #[serde(default, rename = "cut", skip_serializing_if = "Vec::is_empty")]
        pub cuts: Vec<StageCut>,
        /// Values of joint laws that change.
        #[serde(default, rename = "law")]
        pub law_changes: Vec<LawChange>,
        /// Joints of one law that take another.
        #[serde(default, rename = "switch_law")]
        pub law_switches: Vec<LawSwitch>,
        /// Bolts and bolt patterns by name that are installed.
        #[serde(default)]
        pub install: Vec<String>,
        /// Fixities by name that begin to hold.
        #[serde(default)]
        pub fix: Vec<String>,
        /// Fixities by name that let go.
        #[serde(default)]
        pub free: Vec<String>,
        /// Surface of the water from the start of this stage on, as after a drawdown; not in the first stage, which has
        /// that of `[water]`. What hosts have moved the level by ends with it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub water: Option<WaterSurface>,
        /// With `[flow]`. Static: time of the flow, as `{ time = 86400.0, steps = 24 }`, in which it goes on from that
        /// of the stage before; default: the steady flow; not in the first stage, before which there is none. Dynamic:
        /// `"hold"` (default) keeps the pressures of water in joints as the last static stage
        /// found them, `"steady"` finds the steady flow again and again, through the apertures that it had there, as
        /// levels, heads, rain and drains follow a host or this stage.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub flow: Option<StageFlow>,
        /// Dynamic, with `flow = "steady"`: the flow is found at the start of the stage and after every so many
        /// internal steps; default: 10.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub flow_every: Option<u32> => EVERY,
        /// Levels (m) of heads by the name of their `[[head]]`, from the start of this stage on; not in the first
        /// stage, which has those of `[[head]]`, and not in dynamic ones that hold the flow. Levels that hosts have set
        /// end with it.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        pub heads: BTreeMap<String, f64> => HEAD,
        /// Rates (m/s) of rain by the name of its `[[rain]]`, from the start of this stage on; not in the first stage,
        /// which has those of `[[rain]]`, and not in dynamic ones that hold the flow. Rates that hosts have set end
        /// with it.
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        pub rain: BTreeMap<String, f64> => RATE,
        /// Drains by name that act from the start of this stage on; not in dynamic stages that hold the flow.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub drain: Vec<String>,
    }
}

impl Stage {
    /// A stage that changes nothing, to be put after `others`: its name is `name`, with a prime for each that has it.
    pub fn plain(others: &[Self], name: &str, kind: StageKind, duration: f64) -> Self {
        let mut name = name.to_owned();
        while others.iter().any(|stage| stage.name == name) {
            name.push('\'');
        }
        Self { name, kind, duration, ..Self::default() }
    }

    /// Damping ratio of a dynamic stage: 0.1 when it names none.
    pub fn damping_ratio(&self) -> f64 {
        self.damping.unwrap_or(0.1)
    }
}

keys! {
    /// A line along which a stage cuts the rock: a joint from then on.
    pub struct StageCut {
        /// At least two points (m).
        pub points: PointList => PLACE,
        /// Joint law by name.
        pub law: String,
    }
}

keys! {
    /// New values of one joint law; what is not given stays.
    pub struct LawChange {
        /// Joint law by name.
        pub law: String,
        /// Friction angle (degrees), peak and residual.
        pub friction_deg: Option<f64> => FRICTION,
        /// Cohesion (Pa), peak and residual.
        pub cohesion: Option<f64> => COHESION,
        /// Tensile strength (Pa), peak.
        pub tension: Option<f64> => TENSION,
    }
}

keys! {
    /// Joints of law `from` take law `to`.
    pub struct LawSwitch {
        /// Law to replace, by name.
        pub from: String,
        /// Law that takes its place, by name.
        pub to: String,
    }
}
