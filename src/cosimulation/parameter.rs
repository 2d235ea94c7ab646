//! Properties of a case that a host may change by name: all of them before the start, those that are tunable at any
//! time.
//!
//! Strengths are those at time 0: when a stage up to the first dynamic one changes a law, the parameter is that change.

use crate::contact::LawId;
use crate::model::Tunable;
use crate::model::assemble::law_of;
use crate::model::case::{Case, JointLaw, JointLawKind, LawChange, Rock, StageKind};

use super::initial_stages;

/// A property with its value in the case.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name, such as `rock.granite.young` or `joint_law.master.friction`.
    pub name: String,
    /// SI unit; empty for a number.
    pub unit: &'static str,
    /// Description.
    pub description: String,
    /// Value in the case; angles in radians.
    pub start: f64,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Whether it may change after the start.
    pub is_tunable: bool,
    place: Place,
}

/// Where in the case the value of a parameter stands.
#[derive(Debug, Clone, PartialEq)]
enum Place {
    Rock(String, RockKey),
    Law(String, LawKey),
    Damping,
    ContactTolerance,
    WaterDensity,
    /// Bolts of this name.
    Bolt(String),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum RockKey {
    Density,
    Young,
    Poisson,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum LawKey {
    Friction,
    Cohesion,
    Tension,
    NormalStiffness,
    ShearStiffness,
    Jrc,
    Jcs,
}

/// Why a parameter cannot be set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{name}: is {value}, must be {limit}; the old value still holds")]
pub struct ParameterError {
    name: String,
    value: String,
    limit: String,
}

/// All parameters of a case, rocks first, by name.
pub fn parameters(case: &Case) -> Vec<Parameter> {
    let mut list = Vec::new();
    for (name, rock) in &case.rocks {
        list.extend(rock_parameters(name, rock));
    }
    for (name, law) in &case.joint_laws {
        list.extend(law_parameters(case, name, law));
    }
    let damping = case.stages.iter().find(|stage| stage.kind == StageKind::Dynamic);
    if let Some(stage) = damping {
        let what = "Damping ratio of the deformation of blocks in dynamic stages";
        let start = stage.damping_ratio();
        list.push(parameter("damping".into(), "", what.into(), start, (0.0, 1.0), Place::Damping));
    }
    let what = "Relative change of contact forces at which the open-close iteration has settled";
    let start = case.solver.contact_tolerance;
    list.push(parameter("contact_tolerance".into(), "", what.into(), start, (1e-12, 1.0), Place::ContactTolerance));
    if let Some(water) = &case.water {
        let (name, what) = ("water.density".to_owned(), "Density of water".to_owned());
        list.push(parameter(name, "kg/m3", what, water.density, (1e-3, 1e5), Place::WaterDensity));
    }
    list.extend(bolt_parameters(case));
    list
}

/// One parameter for all bolts of a name, in the order of the case.
fn bolt_parameters(case: &Case) -> Vec<Parameter> {
    let mut names: Vec<&String> = Vec::new();
    for name in case.bolts.iter().filter_map(|bolt| bolt.name.as_ref()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of = |name: &String| {
        let what = format!("Whether bolt {name} is installed: 1, or 0");
        let start = f64::from(u8::from(is_installed(case, name)));
        parameter(format!("bolt.{name}.active"), "", what, start, (0.0, 1.0), Place::Bolt(name.clone()))
    };
    names.into_iter().map(of).collect()
}

/// Whether bolts of a name are there at time 0.
fn is_installed(case: &Case, name: &String) -> bool {
    let from_start = case.bolts.iter().any(|bolt| bolt.active && bolt.name.as_ref() == Some(name));
    from_start || case.stages[..=initial_stages(case)].iter().any(|stage| stage.install.contains(name))
}

/// Installs bolts of a name before the start, or leaves them out.
fn set_bolt(case: &mut Case, name: &String, is_active: bool) {
    case.bolts.iter_mut().filter(|bolt| bolt.name.as_ref() == Some(name)).for_each(|bolt| bolt.active = is_active);
    let initial = initial_stages(case);
    case.stages[..=initial].iter_mut().for_each(|stage| stage.install.retain(|wanted| wanted != name));
}

fn rock_parameters(name: &str, rock: &Rock) -> [Parameter; 3] {
    let of = |key, word: &str, unit, what: &str, start, limits| {
        let place = Place::Rock(name.to_owned(), key);
        parameter(format!("rock.{name}.{word}"), unit, format!("{what} of rock {name}"), start, limits, place)
    };
    [
        of(RockKey::Density, "density", "kg/m3", "Density", rock.density, (1e-3, 1e6)),
        of(RockKey::Young, "young", "Pa", "Young's modulus", rock.young, (1.0, 1e15)),
        of(RockKey::Poisson, "poisson", "", "Poisson's ratio", rock.poisson, (-0.999, 0.4999)),
    ]
}

fn law_parameters(case: &Case, name: &str, law: &JointLaw) -> Vec<Parameter> {
    let of = |key, word: &str, unit, what: &str, start, limits| {
        let place = Place::Law(name.to_owned(), key);
        parameter(format!("joint_law.{name}.{word}"), unit, format!("{what} of joint law {name}"), start, limits, place)
    };
    let changed = |get: fn(&LawChange) -> Option<f64>| change_of(case, name, get).map(|(_, value)| value);
    let friction = changed(|c| c.friction_deg).unwrap_or(law.friction_deg).to_radians();
    let cohesion = changed(|c| c.cohesion).unwrap_or(law.cohesion);
    let tension = changed(|c| c.tension).unwrap_or(law.tension);
    let mut list = match law.kind {
        JointLawKind::MohrCoulomb => vec![
            of(LawKey::Friction, "friction", "rad", "Friction angle", friction, (0.0, 1.57)),
            of(LawKey::Cohesion, "cohesion", "Pa", "Cohesion", cohesion, (0.0, 1e12)),
            of(LawKey::Tension, "tension", "Pa", "Tensile strength", tension, (0.0, 1e12)),
        ],
        JointLawKind::BartonBandis => {
            let [jrc, jcs] = [law.jrc, law.jcs].map(Option::unwrap_or_default);
            vec![
                of(LawKey::Friction, "friction", "rad", "Residual friction angle", friction, (0.0, 1.22)),
                of(LawKey::Jrc, "jrc", "", "Joint roughness coefficient", jrc, (0.0, 30.0)),
                of(LawKey::Jcs, "jcs", "Pa", "Joint wall compressive strength", jcs, (1e-3, 1e12)),
            ]
        }
    };
    let stiffness = (1e-3, 1e18);
    if let Some(value) = law.normal_stiffness {
        list.push(of(LawKey::NormalStiffness, "normal_stiffness", "Pa/m", "Normal stiffness", value, stiffness));
    }
    if let Some(value) = law.shear_stiffness {
        list.push(of(LawKey::ShearStiffness, "shear_stiffness", "Pa/m", "Shear stiffness", value, stiffness));
    }
    list
}

fn parameter(
    name: String,
    unit: &'static str,
    description: String,
    start: f64,
    (low, high): (f64, f64),
    place: Place,
) -> Parameter {
    let is_tunable = match &place {
        Place::Rock(..) | Place::ContactTolerance => false,
        Place::Law(_, key) => !matches!(key, LawKey::NormalStiffness | LawKey::ShearStiffness),
        Place::Damping | Place::WaterDensity | Place::Bolt(_) => true,
    };
    Parameter { name, unit, description, start, low, high, is_tunable, place }
}

impl Parameter {
    /// Checks a value that is to be set; that of the case itself is always allowed.
    ///
    /// # Errors
    /// It is not finite, out of range, or neither 0 nor 1 for a bolt.
    pub fn check(&self, value: f64) -> Result<(), ParameterError> {
        let is_switch = self.is_switch();
        let is_allowed = (self.low..=self.high).contains(&value) && (!is_switch || value == 0.0 || value == 1.0);
        if value.to_bits() == self.start.to_bits() || is_allowed {
            return Ok(());
        }
        let limit = if is_switch {
            "0 or 1".to_owned()
        } else {
            format!("at least {} and at most {} {}", self.low, self.high, self.unit).trim_end().to_owned()
        };
        Err(ParameterError { name: self.name.clone(), value: value.to_string(), limit })
    }

    /// Whether it is 0 or 1.
    pub(super) fn is_switch(&self) -> bool {
        matches!(self.place, Place::Bolt(_))
    }

    /// Parts of a running model that it changes; none of a fixed one.
    pub(super) fn tunables(&self, case: &Case) -> Vec<Tunable> {
        match &self.place {
            Place::Law(name, key) => law_of(case, name).and_then(|law| key.tunable(law)).into_iter().collect(),
            Place::Damping => vec![Tunable::Damping],
            Place::WaterDensity => vec![Tunable::WaterDensity],
            Place::Bolt(name) => {
                let own = case.bolts.iter().enumerate().filter(|(_, bolt)| bolt.name.as_ref() == Some(name));
                own.map(|(k, _)| Tunable::Bolt(k as u32)).collect()
            }
            Place::Rock(..) | Place::ContactTolerance => Vec::new(),
        }
    }

    /// The value that a stage of the case gives it, if it gives one.
    pub(super) fn in_stage(&self, case: &Case, stage: usize) -> Option<f64> {
        let stage = &case.stages[stage];
        match &self.place {
            Place::Law(name, key) => {
                let changes = stage.law_changes.iter().filter(|change| change.law == *name);
                changes.filter_map(|change| key.in_change(change)).next_back()
            }
            Place::Damping if stage.kind == StageKind::Dynamic => Some(stage.damping_ratio()),
            Place::Bolt(name) => stage.install.contains(name).then_some(1.0),
            _ => None,
        }
    }
}

impl LawKey {
    fn tunable(self, law: LawId) -> Option<Tunable> {
        match self {
            Self::Friction => Some(Tunable::Friction(law)),
            Self::Cohesion => Some(Tunable::Cohesion(law)),
            Self::Tension => Some(Tunable::Tension(law)),
            Self::Jrc => Some(Tunable::Roughness(law)),
            Self::Jcs => Some(Tunable::WallStrength(law)),
            Self::NormalStiffness | Self::ShearStiffness => None,
        }
    }

    /// Its value in a change of the law; angles in radians.
    fn in_change(self, change: &LawChange) -> Option<f64> {
        match self {
            Self::Friction => change.friction_deg.map(f64::to_radians),
            Self::Cohesion => change.cohesion,
            Self::Tension => change.tension,
            Self::NormalStiffness | Self::ShearStiffness | Self::Jrc | Self::Jcs => None,
        }
    }
}

/// Index of the last stage up to the first dynamic one that changes a value of a law, and the value.
fn change_of(case: &Case, law: &str, get: fn(&LawChange) -> Option<f64>) -> Option<(usize, f64)> {
    let stages = &case.stages[..=initial_stages(case)];
    let of_stage = |stage: &crate::model::case::Stage| {
        stage.law_changes.iter().filter(|change| change.law == law).filter_map(get).next_back()
    };
    stages.iter().enumerate().rev().find_map(|(k, stage)| Some((k, of_stage(stage)?)))
}

/// Sets a parameter in a case; the value of the case itself changes nothing.
///
/// # Errors
/// A value that is not finite or out of range.
pub fn apply(case: &mut Case, parameter: &Parameter, value: f64) -> Result<(), ParameterError> {
    if value.to_bits() == parameter.start.to_bits() {
        return Ok(());
    }
    parameter.check(value)?;
    match &parameter.place {
        Place::Rock(name, key) => {
            if let Some(rock) = case.rocks.get_mut(name) {
                set_rock(rock, *key, value);
            }
        }
        Place::Law(name, key) => set_law(case, name, *key, value),
        Place::Damping => {
            let dynamic = |stage: &&mut crate::model::case::Stage| stage.kind == StageKind::Dynamic;
            case.stages.iter_mut().filter(dynamic).for_each(|stage| stage.damping = Some(value));
        }
        Place::ContactTolerance => case.solver.contact_tolerance = value,
        Place::WaterDensity => case.water.iter_mut().for_each(|water| water.density = value),
        Place::Bolt(name) => set_bolt(case, name, value != 0.0),
    }
    Ok(())
}

fn set_rock(rock: &mut Rock, key: RockKey, value: f64) {
    match key {
        RockKey::Density => rock.density = value,
        RockKey::Young => rock.young = value,
        RockKey::Poisson => rock.poisson = value,
    }
}

fn set_law(case: &mut Case, name: &str, key: LawKey, value: f64) {
    let (get, value): (fn(&LawChange) -> Option<f64>, f64) = match key {
        LawKey::Friction => (|c| c.friction_deg, value.to_degrees()),
        LawKey::Cohesion => (|c| c.cohesion, value),
        LawKey::Tension => (|c| c.tension, value),
        LawKey::NormalStiffness | LawKey::ShearStiffness | LawKey::Jrc | LawKey::Jcs => (|_| None, value),
    };
    if let Some((stage, _)) = change_of(case, name, get) {
        let changes = case.stages[stage].law_changes.iter_mut();
        for change in changes.filter(|change| change.law == name && get(change).is_some()) {
            match key {
                LawKey::Friction => change.friction_deg = Some(value),
                LawKey::Cohesion => change.cohesion = Some(value),
                _ => change.tension = Some(value),
            }
        }
        return;
    }
    let Some(law) = case.joint_laws.get_mut(name) else { return };
    match key {
        LawKey::Friction => law.friction_deg = value,
        LawKey::Cohesion => law.cohesion = value,
        LawKey::Tension => law.tension = value,
        LawKey::NormalStiffness => law.normal_stiffness = Some(value),
        LawKey::ShearStiffness => law.shear_stiffness = Some(value),
        LawKey::Jrc => law.jrc = Some(value),
        LawKey::Jcs => law.jcs = Some(value),
    }
}
