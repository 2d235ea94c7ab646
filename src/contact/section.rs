//! Sections of rock bridges, which break by the forces that all their contacts carry together (theory §7).

use crate::geometry::{Point, Vector, id};

use super::{Bond, EdgeId, JointLaw, LawId, SectionBond};

id! {
    /// A section of a rock bridge.
    SectionId: optional
}

/// The section of a rock bridge between two blocks: the straight line between its ends.
#[doc(alias = "ligament")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Boundary points at its ends, of the block that lies to the left of the way from one to the other.
    pub ends: [EdgeId; 2],
    /// Length (m).
    pub length: f64,
    /// Its law.
    pub law: LawId,
    /// Strength in bending over tensile strength (Eq. 22g).
    pub bending: f64,
    /// Time (s) that a crack takes across it (Eq. 22h).
    pub crack_time: f64,
}

/// Sections of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sections {
    /// The sections.
    pub list: Vec<Section>,
    /// Section of each boundary edge; empty in a model without sections.
    pub of_edge: Vec<Option<SectionId>>,
}

impl Sections {
    /// The section of a boundary edge.
    pub fn of(&self, edge: EdgeId) -> Option<SectionId> {
        self.of_edge.get(edge.index()).copied().flatten()
    }
}

/// A section that has broken and lets go, while a crack crosses it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Release {
    /// Shares of tension and of shear beyond the residual one that its bonds carried at most when it broke.
    pub carried: [f64; 2],
    /// Share of that which they may still carry.
    pub left: f64,
}

impl Release {
    /// Shares of tension and of shear beyond the residual one that bonds of a section may carry.
    pub fn shares(release: &Option<Self>) -> [f64; 2] {
        release.map_or([f64::INFINITY; 2], |Self { carried, left }| carried.map(|share| share * left))
    }
}

/// How a section fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// Its outermost fibre has the tensile strength.
    Opens,
    /// It has its strength in shear.
    Slides,
}

/// What the contacts of a section carry together in a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct SectionForces {
    middle: Point,
    /// Unit vector from the first end to the second one.
    along: Vector,
    /// Force (N/m) on the block to the left, and its moment (N) about the middle.
    force: Vector,
    moment: f64,
    /// Σ N tan φ of its contacts (N/m, compression positive).
    friction: f64,
    /// Greatest shares of tension and of shear beyond the residual one that a bond carries.
    pub carried: [f64; 2],
    /// Widest crack (m) of a bond.
    pub crack: f64,
}

impl SectionForces {
    /// No forces on a section whose ends are there (m).
    pub fn none([from, to]: [Point; 2]) -> Self {
        Self { middle: from + (to - from) * 0.5, along: (to - from).normalize(), ..Self::default() }
    }

    /// Unit vector to the left.
    fn across(&self) -> Vector {
        Vector::new(-self.along.y, self.along.x)
    }

    /// Adds a contact: where it is (m), the outward normal of its edge, its force on the node (N/m), and tan φ times
    /// its normal force (N/m).
    pub fn add(&mut self, at: Point, normal: Vector, on_node: Vector, friction: f64) {
        let force = if normal.dot(&self.across()) > 0.0 { on_node } else { -on_node };
        self.force += force;
        self.moment += (at - self.middle).perp(&force);
        self.friction += friction;
    }

    /// Notes how much of its strength a bond carries with forces (N/m) normal and shear, and how wide (m) its crack is.
    pub fn note(&mut self, bond: &SectionBond, opening: f64, forces: [f64; 2]) {
        let used = bond.used(forces);
        self.carried = [0, 1].map(|k| self.carried[k].max(used[k]));
        self.crack = self.crack.max(bond.crack(opening));
    }

    /// Tension and shear force (N/m) and bending moment (N) of the section (Eq. 22e).
    pub fn resultants(&self) -> [f64; 3] {
        [-self.force.dot(&self.across()), self.force.dot(&self.along), self.moment]
    }

    /// How the section fails under these forces, if it does, where the strength of all joints is multiplied by a factor
    /// (Eq. 22f).
    pub fn failure(&self, section: &Section, law: &JointLaw, strength: f64) -> Option<Failure> {
        let [normal, shear, moment] = self.resultants();
        let (length, tension) = (section.length, law.tension * strength);
        if normal / length + 6.0 * moment.abs() / (section.bending * length * length) >= tension {
            return Some(Failure::Opens);
        }
        let of_pressure = if normal <= 0.0 { self.friction.max(0.0) } else { -normal * law.cohesion / law.tension };
        (shear.abs() > law.cohesion * strength * length + of_pressure).then_some(Failure::Slides)
    }
}

/// The bond of a contact: it softens by itself, or breaks with its section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// It softens by its own opening and slip.
    Alone(Bond),
    /// Its section decides.
    InSection(SectionId, SectionBond),
}

impl Hold {
    /// As [`Bond::normal`].
    pub fn normal(&self, b: f64, c: f64) -> f64 {
        match self {
            Self::Alone(bond) => bond.normal(b, c),
            Self::InSection(_, bond) => bond.normal(b, c),
        }
    }

    /// Greatest shear force (N/m), as [`Bond::shear`], in a step that leaves the joint open by `opening` (m).
    pub fn shear(&self, normal: f64, asked: f64, ease: f64, opening: f64) -> f64 {
        match self {
            Self::Alone(bond) => bond.shear(normal, asked, ease, bond.damage_at(opening)),
            Self::InSection(_, bond) => bond.shear_limit(normal),
        }
    }

    /// Energy (J/m) stored in the normal spring at an opening (m).
    pub fn stored(&self, opening: f64) -> f64 {
        match self {
            Self::Alone(bond) => bond.stored(opening),
            Self::InSection(_, bond) => bond.stored(opening),
        }
    }
}
