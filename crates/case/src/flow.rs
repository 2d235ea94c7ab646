//! Water of a case that flows in its joints.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::keys::shared::{HEIGHT, PLACE};
use crate::keys::unit::{FLOW, METRE, NUMBER, RAIN, SECOND, VISCOSITY};
use crate::keys::{Range, Rule, keys, words};
use crate::limits::RAIN_MAX;
use crate::{CUT_LAW, Case, JointLaw, PointList, Stage, StageKind};

/// Hydraulic apertures of joints.
pub(crate) const APERTURE: Rule = Range::above(0.0).to(1.0).of(METRE).usual([1e-6, 2e-2], "joints have 1e-5 to 1e-3 m");
/// The same of a law, whose joints may be closed to water.
pub(crate) const LAW_APERTURE: Rule = APERTURE
    .in_range(Range::from(0.0).to(1.0))
    .hint("0 for joints that do not conduct; leave it out for flow.aperture");
/// Heads.
pub(crate) const HEAD: Rule = HEIGHT.hint("the height y to which the water would rise");

/// Rain: the greatest that was ever measured, over a minute, is 31 mm.
pub(crate) const RATE: Rule = Range::from(0.0)
    .to(RAIN_MAX)
    .of(RAIN)
    .usual([1e-10, 1e-4], "10 mm in an hour are 2.8e-6 m/s, 1000 mm in a year 3.2e-8 m/s")
    .hint("10 mm in an hour are 2.8e-6 m/s, and 0 is none");

/// Pumps.
const PUMP: Rule = Range::above(0.0)
    .to(1.0)
    .of(FLOW)
    .usual([1e-9, 1e-2], "1 litre per minute from each metre of depth is 1.7e-5 m²/s")
    .hint("leave it out for water that flows out freely");

/// Internal steps between two flows of a dynamic stage.
pub(crate) const EVERY: Rule = Range::from(1.0).to(1e6).of(NUMBER).hint("1 finds the flow in every internal step");
/// The same where a case names none.
const EVERY_DEFAULT: u32 = 10;

/// Seconds of flow in a second of motion.
const PACE: Rule = Range::above(0.0)
    .to(1e12)
    .of(NUMBER)
    .usual([1.0, 1e8], "a day in 10 s of motion is 8640")
    .hint("a day in 10 s of motion is 8640; leave it out for flow in the time of the motion");

/// Opening and slip from which pieces of joint have parted, over the mesh size.
const PART: Rule = Range::from(0.0)
    .to(1e3)
    .of(METRE)
    .usual([1e-3, 1.0], "0.05 times mesh.size is the default")
    .hint("0 for pieces that never part; leave it out for 0.05 times mesh.size");
const PARTS_BY_OPENING: f64 = 0.05;
const PARTS_BY_SLIP: f64 = 0.5;

/// Least and greatest aperture over those of the laws, where a case names none.
const NARROWEST: f64 = 0.1;
const WIDEST: f64 = 20.0;

keys! {
    /// Water that flows in the joints, by the cubic law: static stages find the steady flow with its free surface at
    /// their start. Pieces of joint that no bond and no excavation closes are pipes between the crossings of joints,
    /// the rock between them is tight. Outcrops below the surface of `[water]` have its head, others are open to the
    /// air, and no water goes through edges of `[[fix]]`, `[[quiet]]` and `[[free_field]]`, unless a `[[head]]` lies
    /// there.
    pub default struct Flow {
        /// Hydraulic aperture (m) at the start of joints whose law names none; default: none, so that each law needs
        /// its own.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture: Option<f64> => APERTURE.hint("leave it out where each law has its own").label("Aperture"),
        /// Least aperture (m) to which joints close between the start and a later stage; default: a tenth of the least
        /// one.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture_min: Option<f64> => APERTURE.hint("leave it out for a tenth of the least aperture"),
        /// Greatest aperture (m) to which joints open between the start and a later stage; default: 20 times the
        /// greatest one.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture_max: Option<f64> => APERTURE.hint("leave it out for 20 times the greatest aperture"),
        /// Dynamic viscosity (Pa s) of the water: flows go with its inverse, pressures do not depend on it.
        pub viscosity: f64 = 1e-3 =>
            Range::above(0.0).to(1e3).of(VISCOSITY).usual([1e-4, 1e-1], "water has 1e-3 Pa s").label("Viscosity"),
        /// Whether apertures follow openings in static stages whose flow is steady: each time the rock has come to
        /// rest, joints have the apertures of their openings, the flow is found again, and the rock relaxes on, until
        /// both agree. If not, the apertures of a stage are those of its start.
        pub coupled: bool = false,
        /// Water (m³ for each m² of joint, hence m) that the rock beside joints gives as they drain and takes as they
        /// fill, in flow that takes time: its porosity times half the spacing of joints. The joints themselves
        /// hold their aperture; default: 0.
        pub storage: f64 = 0.0 =>
            Range::from(0.0).to(10.0).of(METRE).hint("the porosity of the rock times half the spacing of its joints")
                .usual([1e-6, 0.3], "rock with a porosity of 0.5 % and joints 1 m apart has 2.5e-3 m").label("Storage")
                .none_at_zero(),
        /// Seconds of flow in a second of motion, in dynamic stages with `flow = "transient"`: the drawdown of a day
        /// takes 10 s of motion with 8640; default: 1.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub pace: Option<f64> => PACE,
        /// Opening (m) from which a wet piece of joint has parted in a dynamic stage, as it has by a slip of half of
        /// `mesh.size`: it keeps the greatest aperture, and its water pushes no more, so that blocks which have left
        /// their place move by their weight alone. Faces that come back hold water again. 0 for pieces that push
        /// wherever their blocks go, as in static stages and in the trials of `enmm fos`; default: 0.05 times
        /// `mesh.size`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub part: Option<f64> => PART,
    }
}

keys! {
    /// A head that is held where joints lie on a segment: the water level behind a slope, or in a crack.
    pub struct Head {
        /// Name, for stages and results.
        pub name: String,
        /// Segment (m) of the outline or along joints: the ends and crossings of joints there have the head. Outcrops
        /// above it are open to the air, and on crossings above it within the rock it does not act.
        pub edge: [[f64; 2]; 2] => PLACE,
        /// Height y (m) to which the water would rise there at the start.
        pub level: f64 => HEAD.label("Head"),
    }
}

keys! {
    /// Rain on a part of the surface, of which joints that crop out there take what they can; the rest runs off. Each
    /// outcrop is offered what falls on the ground that is nearer to it than to the others on the segment.
    pub struct Rain {
        /// Name, for stages and results.
        pub name: String,
        /// Segment (m) of the surface on which it falls, at least in part level: its length in plan counts. Outcrops
        /// below the reservoir, or with a `[[head]]` above them, have that head.
        pub edge: [[f64; 2]; 2] => PLACE,
        /// Rain (m/s, that is m³/s on each m² in plan) at the start that flows over the ground.
        pub rate: f64 => RATE.label("Rain"),
    }
}

keys! {
    /// A bore hole or a gallery that drains the joints which it crosses, or a well from which a pump takes water. It
    /// acts over all the depth of the section, as a row of close bore holes does.
    pub struct Drain {
        /// Name, for stages and results.
        pub name: String,
        /// At least two points (m), its mouth first. Joints that it crosses have the head of their own height there,
        /// or that of the mouth where it is higher.
        pub points: PointList => PLACE,
        /// Whether it acts from the start on; if not, a stage puts it in place with `drain`.
        #[serde(default = "crate::keys::yes")]
        pub active: bool,
        /// Flow (m²/s, that is m³/s from each metre of depth) that a pump takes, the same from each joint that it
        /// crosses, and less where a joint runs dry; default: none, so that the water flows out freely.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub pump: Option<f64> => PUMP.label("Pump"),
    }
}

keys! {
    #[derive(Copy)]
    /// Time in which the flow of a static stage goes on from that of the stage before.
    pub struct FlowTime {
        /// Time (s) of the flow, whatever the simulated time of the rock: levels, heads and rain go in it from those of
        /// the stage before to those of this stage, evenly.
        pub time: f64 =>
            Range::above(0.0).to(1e12).of(SECOND).hint("an hour has 3600 s, a day 86400 s")
                .usual([1.0, 1e10], "flow in joints takes minutes to years"),
        /// Implicit steps in this time.
        pub steps: u32 => Range::from(1.0).to(1e5).of(NUMBER).hint("24 are usual"),
    }
}

words! {
    /// Water in joints while a dynamic stage goes on.
    #[derive(Default)]
    pub enum FlowInMotion {
        /// The pressures of before stay as they are.
        #[default]
        Hold = "hold",
        /// The steady flow is found again and again, through the apertures of before.
        Steady = "steady",
        /// The flow goes on in time, through the apertures of before, while joints and the rock beside them drain and
        /// fill.
        Transient = "transient",
    }
}

/// Water in joints while a stage goes on, in one of the forms of its key.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum StageFlow {
    /// In a dynamic stage.
    InMotion(FlowInMotion),
    /// In a static stage: on from the stage before, in a time.
    Over(FlowTime),
}

impl<'de> Deserialize<'de> for StageFlow {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = StageFlow;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "\"hold\", \"steady\", \"transient\" or a time of flow such as { time = 86400.0, steps = 24 }",
                )
            }

            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<StageFlow, E> {
                FlowInMotion::deserialize(word.into_deserializer()).map(StageFlow::InMotion)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<StageFlow, A::Error> {
                FlowTime::deserialize(MapAccessDeserializer::new(map)).map(StageFlow::Over)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl Stage {
    /// Time of the flow in joints, of a static stage in which it is not steady.
    pub fn flow_time(&self) -> Option<&FlowTime> {
        let Some(StageFlow::Over(time)) = &self.flow else { return None };
        Some(time)
    }

    /// Internal steps after which a dynamic stage finds the flow again; none in stages that hold it.
    pub fn flow_steps(&self) -> Option<u64> {
        let follows = self.is_in_motion(FlowInMotion::Steady) || self.is_transient();
        follows.then(|| self.flow_every.unwrap_or(EVERY_DEFAULT).into())
    }

    /// Whether flow goes on in time as a dynamic stage does.
    pub fn is_transient(&self) -> bool {
        self.is_in_motion(FlowInMotion::Transient)
    }

    fn is_in_motion(&self, flow: FlowInMotion) -> bool {
        self.kind == StageKind::Dynamic && self.flow == Some(StageFlow::InMotion(flow))
    }
}

impl Case {
    /// Seconds of flow in a second of motion.
    pub fn pace(&self) -> f64 {
        self.flow.as_ref().and_then(|flow| flow.pace).unwrap_or(1.0)
    }

    /// Slip and opening (m) from which pieces of joint have parted in dynamic stages; none where they never do.
    pub fn parting(&self) -> Option<[f64; 2]> {
        let (size, part) = (self.mesh.size, self.flow.as_ref()?.part);
        let opening = part.unwrap_or(PARTS_BY_OPENING * size);
        (opening > 0.0).then_some([PARTS_BY_SLIP * size, opening])
    }

    /// Keeps the first stages, and of the keys of flow in motion those that have an effect in them.
    pub fn keep_stages(&mut self, count: usize) {
        self.stages.truncate(count);
        if self.stages.iter().all(|stage| stage.kind == StageKind::Static) {
            self.flow.iter_mut().for_each(|flow| flow.part = None);
        }
        if !self.stages.iter().any(Stage::is_transient) {
            self.flow.iter_mut().for_each(|flow| flow.pace = None);
        }
    }

    /// Hydraulic aperture (m) at the start of the joints of a law, by its name; 0 for one that does not conduct, none
    /// where neither the law nor `[flow]` says so. Construction joints are closed.
    pub fn aperture(&self, name: &str, law: &JointLaw) -> Option<f64> {
        let shared = self.flow.as_ref().and_then(|flow| flow.aperture);
        let rough = law.mechanical().map(|mechanical| mechanical.min(law.smoothness() * mechanical * mechanical));
        law.aperture.or(rough).or(if name == CUT_LAW { Some(0.0) } else { shared })
    }

    /// Least and greatest aperture (m) that openings may lead to; none where no joint conducts.
    pub fn aperture_range(&self) -> Option<[f64; 2]> {
        let flow = self.flow.as_ref()?;
        let of_laws = self.joint_laws.iter().filter_map(|(name, law)| self.aperture(name, law));
        let [low, high] =
            of_laws.filter(|aperture| *aperture > 0.0).fold(None, |range: Option<[f64; 2]>, aperture| {
                let [low, high] = range.unwrap_or([aperture; 2]);
                Some([low.min(aperture), high.max(aperture)])
            })?;
        Some([flow.aperture_min.unwrap_or(NARROWEST * low), flow.aperture_max.unwrap_or(WIDEST * high)])
    }
}
