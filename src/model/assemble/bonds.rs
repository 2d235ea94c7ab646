//! Bonds: which laws have them, and what the user should know of their lengths and of the mesh that they break in
//! (theory §7).

use crate::contact::{JointLaw, LawId, Softening};
use crate::mechanics::Elasticity;
use crate::model::case::{Case, Integrator, Invalid, Stage};
use crate::state::Model;

use super::joints::Joints;
use super::law_of;

/// E/(1 − ν²) (Pa) of the stiffest rock.
fn plane_modulus(model: &Model) -> f64 {
    model.rocks.iter().map(Elasticity::plane_modulus).fold(0.0, f64::max)
}

/// Makes the laws of rock bridges bonds, so that a bridge is as long as it is drawn on any mesh, and its failure an
/// event. Without an energy of fracture a bond loses its strength at once.
///
/// # Errors
/// A stage switches such a law, which bonds keep until they break.
pub(super) fn of_bridges(case: &Case, joints: &Joints, laws: &mut [JointLaw]) -> Result<(), Invalid> {
    if case.solver.integrator == Integrator::Implicit {
        return Ok(());
    }
    for law in joints.bridge_laws() {
        let law = &mut laws[law.index()];
        if law.softening.is_none() && law.breaks() {
            law.softening = Some(Softening::AT_ONCE);
        }
    }
    let is_bond = |name: &String| law_of(case, name).is_some_and(|law| laws[law.index()].softening.is_some());
    let switches = |(k, stage): (usize, &Stage)| {
        let switch = stage.law_switches.iter().position(|switch| is_bond(&switch.from))?;
        Some((k, switch, stage.law_switches[switch].from.clone()))
    };
    let Some((stage, switch, name)) = case.stages.iter().enumerate().find_map(switches) else { return Ok(()) };
    Err(Invalid {
        key: format!("stage[{stage}].switch_law[{switch}].from"),
        message: format!(
            "is {name:?}, the law of rock bridges, which hold until they break; let them break, give them a law of \
             their own, or remove this"
        ),
    })
}

/// How many rock bridges there are, and how long they are in all.
pub(super) fn note(joints: &Joints) -> Option<String> {
    let lines = joints.bridges.iter().map(|&bridge| &joints.traces[bridge].0);
    let length: f64 = lines.flat_map(|line| line.windows(2)).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let count = joints.bridges.len();
    let bridges = if count == 1 { "rock bridge" } else { "rock bridges" };
    (count > 0).then(|| format!("{count} {bridges} of {length:.3} m can break; rock beside them is elastic"))
}

/// Laws whose energy of fracture springs or mesh cannot follow, so that a bond breaks at once at its strength.
pub(super) fn warnings(case: &Case, model: &Model, joints: &Joints) -> Vec<String> {
    let used = |k: usize| joints.traces.iter().any(|(_, law)| *law == LawId::new(k));
    let laws = case.joint_laws.keys().zip(&model.laws).enumerate();
    let mut warnings: Vec<String> =
        laws.clone().filter(|(k, _)| used(*k)).flat_map(|(_, (name, law))| of_law(name, law, model)).collect();
    let is_of_bridge = |k: usize| joints.bridge_laws().any(|law| law == LawId::new(k));
    let keeps = laws.filter(|(k, (_, law))| is_of_bridge(*k) && law.cohesion > 0.0 && law.keeps_cohesion());
    warnings.extend(keeps.map(|(_, (name, law))| {
        format!(
            "joint_law.{name}: rock bridges keep their cohesion of {:.3e} Pa when they fail, along the whole side of \
             an element; give a `residual_cohesion` below it",
            law.cohesion
        )
    }));
    warnings
}

fn of_law(name: &str, law: &JointLaw, model: &Model) -> Vec<String> {
    let Some(softening) = law.softening else { return Vec::new() };
    let mut warnings = Vec::new();
    let (strength, energy) = (law.tension, 0.5 * law.tension * softening.opening);
    if energy > 0.0 {
        let stiff = 0.5 * strength * strength / energy;
        let (modulus, size) = (plane_modulus(model), model.covers.mesh.size);
        let longest = modulus / stiff - modulus / law.normal_stiffness;
        if law.normal_stiffness <= stiff {
            warnings.push(format!(
                "joint_law.{name}.tension_energy: snap-back: the joint's own stiffness of {:.3e} Pa/m gives back more \
                 energy than {energy} J/m², so that it breaks at once at its strength; this ends at a \
                 `normal_stiffness` above {stiff:.3e} Pa/m",
                law.normal_stiffness
            ));
        } else if size > longest {
            warnings.push(format!(
                "joint_law.{name}.tension_energy: snap-back: rock of the length of an element, {size} m, gives back \
                 more energy than {energy} J/m², so that the joint breaks at once at its strength; this ends at a \
                 length of {longest:.3e} m, or above {:.3e} J/m²",
                0.5 * strength * strength * (size / modulus + 1.0 / law.normal_stiffness)
            ));
        }
    }
    let drop = law.cohesion - law.residual_cohesion;
    if softening.shear_energy > 0.0 && drop > 0.0 {
        let stiff = 0.5 * drop * drop / softening.shear_energy;
        if law.shear_stiffness <= stiff {
            warnings.push(format!(
                "joint_law.{name}.shear_energy: snap-back: the joint's own stiffness of {:.3e} Pa/m gives back more \
                 energy than {} J/m², so that it loses its cohesion at once; this ends at a `shear_stiffness` above \
                 {stiff:.3e} Pa/m",
                law.shear_stiffness, softening.shear_energy
            ));
        }
    }
    warnings
}
