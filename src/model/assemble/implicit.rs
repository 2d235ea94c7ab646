//! Options of the implicit integrator from a case, and refusal of features that it does not support.

use crate::cover::Covers;
use crate::geometry::polygon;
use crate::mechanics::{self, Elasticity};
use crate::model::case::{Case, Integrator, Invalid, JointLawKind, Newmark};
use crate::state::{Implicit, Rule};

/// Explicit steps in the default implicit one.
pub const STEPS: f64 = 20.0;

/// Refuses what the implicit integrator does not know.
pub fn know(case: &Case) -> Result<(), Invalid> {
    if case.solver.integrator == Integrator::Explicit {
        return Ok(());
    }
    match unknown(case) {
        None => Ok(()),
        Some(what) => Err(Invalid {
            key: "solver.integrator".into(),
            message: format!("implicit does not know {what}; remove it or use \"explicit\""),
        }),
    }
}

fn unknown(case: &Case) -> Option<String> {
    let table = |name: &str, present: bool| present.then(|| format!("[[{name}]]"));
    let yields = case.rocks.iter().find(|(_, rock)| rock.friction_deg.is_some() || rock.cohesion.is_some());
    let closing = case.joint_laws.iter().find(|(_, law)| law.kind == JointLawKind::BartonBandis);
    table("quiet", !case.quiets.is_empty())
        .or_else(|| table("free_field", !case.free_fields.is_empty()))
        .or_else(|| table("bolt", !case.bolts.is_empty()))
        .or_else(|| yields.map(|(name, _)| format!("rock that yields (rock.{name}: friction_deg, cohesion)")))
        .or_else(|| closing.map(|(name, _)| format!("Barton–Bandis joints (joint_law.{name}.kind)")))
}

/// Choices and consistent masses, when the case selects the implicit integrator.
pub fn implicit(case: &Case, covers: &Covers, rocks: &[Elasticity], element_rock: &[u16]) -> Option<Implicit> {
    let solver = &case.solver;
    if solver.integrator == Integrator::Explicit {
        return None;
    }
    let (low, high) = polygon::bounds(&covers.polygon_points);
    let ratio = solver.displacement_ratio * 0.5 * (high - low).y;
    let element_mass = covers.elements().map(|e| {
        let centroid = covers.element_centroid[e];
        let moments = polygon::Moments::of(covers.polygon(e), centroid);
        let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
        let density = rocks[element_rock[e] as usize].density;
        mechanics::element_mass(density, covers.weights(e, centroid), gradients, &moments)
    });
    Some(Implicit {
        rule: match solver.newmark {
            Newmark::Constant => Rule::Constant,
            Newmark::Trapezoidal => Rule::Trapezoidal,
        },
        iterations_max: solver.iterations_max,
        displacement_max: ratio.min(DISPLACEMENT_RATIO * covers.mesh.size),
        element_mass: element_mass.collect(),
    })
}

/// Displacement in a sub-step, relative to the mesh size, within which near pairs and normals hold.
const DISPLACEMENT_RATIO: f64 = 0.1;
