//! Choices of the implicit integrator from a case, and what of a case it does not know.

use enmm::geometry::polygon;
use enmm::internals::cover::Covers;
use enmm::internals::mechanics::Elasticity;
use enmm::model::case::{Case, Invalid, Newmark};

use super::consistent::element_mass;

/// Newmark's rule: velocities and positions from the accelerations at both ends of a step (Eq. 67).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// β = ½, γ = 1: the acceleration of the end holds throughout; damps fast motion.
    Constant,
    /// β = ¼, γ = ½: the mean of both; keeps energy.
    Trapezoidal,
}

/// Choices and masses of the implicit integrator.
#[derive(Debug, Clone, PartialEq)]
pub struct Implicit {
    /// Newmark's rule.
    pub rule: Rule,
    /// Most open–close iterations before a sub-step is cut.
    pub iterations_max: u32,
    /// Largest displacement (m) in a sub-step.
    pub displacement_max: f64,
    /// ∫ρ w_a w_b (kg/m) of each element for the pairs of its covers (Eq. 68).
    pub element_mass: Vec<[f64; 6]>,
}

/// Refuses what the implicit integrator does not know.
pub fn refusal(case: &Case) -> Option<Invalid> {
    unknown(case).map(|what| Invalid {
        key: "solver.integrator".into(),
        message: format!("implicit does not know {what}; remove it or use \"explicit\""),
    })
}

fn unknown(case: &Case) -> Option<String> {
    let table = |name: &str, present: bool| present.then(|| format!("[[{name}]]"));
    let yields = case.rocks.iter().find(|(_, rock)| rock.yields());
    let closing = case.joint_laws.iter().find(|(_, law)| law.is_curved());
    table("quiet", !case.quiets.is_empty())
        .or_else(|| table("free_field", !case.free_fields.is_empty()))
        .or_else(|| table("bolt", !case.bolts.is_empty()))
        .or_else(|| {
            yields.map(|(name, _)| format!("rock that yields (rock.{name}: friction_deg, cohesion, hoek_brown)"))
        })
        .or_else(|| closing.map(|(name, _)| format!("Barton–Bandis joints (joint_law.{name}.kind)")))
}

impl Implicit {
    /// The choices of a case, and the consistent masses of its elements.
    pub fn new(case: &Case, covers: &Covers, rocks: &[Elasticity], element_rock: &[u16]) -> Self {
        let solver = &case.solver;
        let (low, high) = polygon::bounds(&covers.polygons.points);
        let ratio = solver.displacement_ratio * 0.5 * (high - low).y;
        let mass = covers.elements().map(|e| {
            let centroid = covers.element_centroid[e];
            let moments = polygon::Moments::of(covers.polygon(e), centroid);
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            let density = rocks[element_rock[e] as usize].density;
            element_mass(density, covers.weights(e, centroid), gradients, &moments)
        });
        Self {
            rule: match solver.newmark {
                Newmark::Constant => Rule::Constant,
                Newmark::Trapezoidal => Rule::Trapezoidal,
            },
            iterations_max: solver.iterations_max,
            displacement_max: ratio.min(DISPLACEMENT_RATIO * covers.mesh.size),
            element_mass: mass.collect(),
        }
    }
}

/// Displacement in a sub-step, relative to the mesh size, within which near pairs and normals hold.
const DISPLACEMENT_RATIO: f64 = 0.1;
