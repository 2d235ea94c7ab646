//! Properties of a case that a host may change before the model is built.
//!
//! Strengths are those at time 0: when a stage up to the first dynamic one changes a law, the parameter is that change.

use crate::model::case::{Case, JointLaw, JointLawKind, LawChange, Rock, StageKind};

use super::{Cosimulation, initial_stages};

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
    place: Place,
}

/// Where in the case the value of a parameter stands.
#[derive(Debug, Clone, PartialEq)]
enum Place {
    Rock(String, RockKey),
    Law(String, LawKey),
    Damping,
    ContactTolerance,
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
#[error("{name}: is {value}, must be {limit}; the value of the case still holds")]
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
    list
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
    Parameter { name, unit, description, start, low, high, place }
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
    if !(parameter.low..=parameter.high).contains(&value) {
        let limit = format!("at least {} and at most {} {}", parameter.low, parameter.high, parameter.unit);
        return Err(ParameterError { name: parameter.name.clone(), value: value.to_string(), limit });
    }
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

impl Cosimulation {
    /// Parameters of the case.
    pub fn parameters(&self) -> Vec<Parameter> {
        parameters(self.case())
    }
}
