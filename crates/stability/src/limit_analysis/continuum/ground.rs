//! Triangles with their strength and weight, edges with their law and load: what both programs are made of. Lengths
//! and stresses are in units of the model.

use enmm::geometry::{Point, Vector};

use super::conic::{Conic, Strong, Sum};

/// Unknown 0: the cohesion that is missing for equilibrium.
pub const MISSING: usize = 0;
/// Most cohesion, in the unit of stress, that strength may exceed its need by; beyond, it is not looked for.
const SPARE: f64 = 1.0;

/// Mohr–Coulomb strength of rock or of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strength {
    /// tan φ.
    pub friction: f64,
    /// Cohesion.
    pub cohesion: f64,
    /// Tensile strength; none for that of the apex.
    pub tension: Option<f64>,
}

/// Neighbour of a triangle along an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edge {
    /// The same rock or another without a joint: triangle, and the edge there.
    Rock(usize, usize),
    /// A joint with the triangle and the edge behind it, and fluid pressure at both ends.
    Joint(usize, usize, Strength, [f64; 2]),
    /// Air, water or a fixity: tractions at both ends, and axes that are held.
    Outside([Vector; 2], [bool; 2]),
}

/// A triangle, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Corners.
    pub corners: [Point; 3],
    /// Strengths that all hold, by the kind of rock in [`Rock::kinds`].
    pub kind: usize,
    /// Pressure in the pores at the corners.
    pub pores: [f64; 3],
    /// Weight and inertia over the area.
    pub body: Vector,
    /// Whether it is held altogether.
    pub is_held: bool,
    /// Neighbours along the edges from each corner to the next.
    pub edges: [Edge; 3],
}

/// A bolt's free length, which pulls its ends towards each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Triangles of both ends, with the shares of their corners in the position.
    pub ends: [(usize, [f64; 3]); 2],
    /// Unit vector from the first end to the second.
    pub direction: Vector,
    /// Force at which it yields; infinite for never.
    pub most: f64,
}

/// Triangles and bolts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rock {
    /// Strengths of each kind of rock, all of which hold: one of Mohr–Coulomb, several lines along an envelope, none
    /// where it never yields.
    pub kinds: Vec<Vec<Strength>>,
    /// Triangles.
    pub patches: Vec<Patch>,
    /// Bolts.
    pub bars: Vec<Bar>,
}

impl Patch {
    /// Shares of the corners in a position.
    pub fn shares(&self, p: Point) -> [f64; 3] {
        [0, 1, 2].map(|i| 1.0 + self.gradient(i).dot(&(p - self.corners[i])))
    }

    /// Area.
    pub fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).perp(&(c - a))
    }

    /// Gradient of the linear function that is 1 at corner `i` and 0 at the others.
    pub fn gradient(&self, i: usize) -> Vector {
        let along = self.corners[(i + 2) % 3] - self.corners[(i + 1) % 3];
        Vector::new(-along.y, along.x) / (2.0 * self.area())
    }

    /// Length of edge `k` and its outward normal.
    pub fn edge(&self, k: usize) -> (f64, Vector) {
        let along = self.corners[(k + 1) % 3] - self.corners[k];
        let length = along.norm();
        (length, Vector::new(along.y, -along.x) / length)
    }
}

/// The first unknown of the stress xx, yy, xy at a corner of a triangle.
pub fn stress(triangle: usize, corner: usize) -> usize {
    1 + 9 * triangle + 3 * corner
}

/// A program with the stresses and their limits, and the force of each bolt.
pub fn begin(rock: &Rock, strength: f64) -> (Conic, Vec<Sum>) {
    let mut program = Conic::new(stress(rock.patches.len(), 0));
    yields(&mut program, rock, strength);
    let pulls = rock.bars.iter().map(|bar| pull(&mut program, bar)).collect();
    (program, pulls)
}

/// The force of a bolt, from nothing to its yield force, which strength reduction leaves as it is.
fn pull(program: &mut Conic, bar: &Bar) -> Sum {
    let force = Sum { terms: vec![(program.unknown(), 1.0)], constant: 0.0 };
    program.is_positive(force.clone().into());
    if bar.most.is_finite() {
        program.is_positive(Sum::constant(bar.most).plus(&force, -1.0).into());
    }
    force
}

/// Traction along x and along y of the stress at a corner on a plane with this normal.
pub fn traction(triangle: usize, corner: usize, normal: Vector) -> [Sum; 2] {
    let s = stress(triangle, corner);
    let sum = |terms: [(usize, f64); 2]| Sum { terms: terms.to_vec(), constant: 0.0 };
    [sum([(s, normal.x), (s + 2, normal.y)]), sum([(s + 2, normal.x), (s + 1, normal.y)])]
}

/// Parts of a vector along a normal and along its tangent, the normal turned by +90°.
pub fn turned([x, y]: [Sum; 2], normal: Vector) -> [Sum; 2] {
    let along = |v: Vector| Sum::default().plus(&x, v.x).plus(&y, v.y);
    [along(normal), along(Vector::new(-normal.y, normal.x))]
}

/// Limits of all stresses (Eqs. 88, 89), and of the search for the missing cohesion.
fn yields(program: &mut Conic, rock: &Rock, strength: f64) {
    program.is_positive(Sum { terms: vec![(MISSING, 1.0)], constant: SPARE }.into());
    for (t, patch) in rock.patches.iter().enumerate().filter(|(_, patch)| !patch.is_held) {
        for corner in 0..3 {
            let s = stress(t, corner);
            let lines = rock.kinds[patch.kind].iter();
            let pore = patch.pores[corner];
            yields_at(program, s, lines.flat_map(|&line| limits((s, pore), line, strength)).collect());
        }
    }
}

/// A limit of the diameter of Mohr's circle: the room for it, over a factor that changes with the strength.
struct Limit {
    room: Strong,
    factor: f64,
    change: f64,
}

/// Limits of the stress whose first unknown is `s`, with a pressure in the pores: by friction and cohesion, and by the
/// tensile strength.
fn limits((s, pore): (usize, f64), rock: Strength, x: f64) -> impl Iterator<Item = Limit> {
    let sum = |terms: Vec<(usize, f64)>, constant: f64| Sum { terms, constant };
    let (friction, cohesion) = (rock.friction * x, rock.cohesion - pore * rock.friction);
    let secant = (1.0 + friction * friction).sqrt();
    let shear = Limit {
        room: Strong {
            now: sum(vec![(MISSING, 2.0), (s, -friction), (s + 1, -friction)], 2.0 * cohesion * x),
            change: sum(vec![(s, -rock.friction), (s + 1, -rock.friction)], 2.0 * cohesion),
        },
        factor: secant,
        change: rock.friction * friction / secant,
    };
    let cut_off = rock.tension.filter(|tension| tension * rock.friction * x < rock.cohesion).map(|tension| Limit {
        room: Strong {
            now: sum(vec![(MISSING, 2.0), (s, -1.0), (s + 1, -1.0)], 2.0 * (tension * x - pore)),
            change: Sum::constant(2.0 * tension),
        },
        factor: 1.0,
        change: 0.0,
    });
    std::iter::once(shear).chain(cut_off)
}

/// Keeps the diameter of Mohr's circle within all limits. One is a cone; several are straight lines in a diameter that
/// has the cone.
fn yields_at(program: &mut Conic, s: usize, limits: Vec<Limit>) {
    let circle = |by: f64| {
        let sum = |terms| Sum { terms, constant: 0.0 };
        [sum(vec![(s, by), (s + 1, -by)]), sum(vec![(s + 2, 2.0 * by)])]
    };
    let diameter = (limits.len() > 1).then(|| {
        let diameter = Sum { terms: vec![(program.unknown(), 1.0)], constant: 0.0 };
        let [across, along] = circle(1.0);
        program.is_cone([diameter.clone().into(), across.into(), along.into()]);
        diameter
    });
    for Limit { room: Strong { now, change: slope }, factor, change } in limits {
        match &diameter {
            Some(diameter) => {
                program.is_positive(Strong { now: now.plus(diameter, -factor), change: slope.plus(diameter, -change) })
            }
            None => {
                let [[across, along], [across_change, along_change]] = [factor, change].map(circle);
                let across = Strong { now: across, change: across_change };
                program.is_cone([Strong { now, change: slope }, across, Strong { now: along, change: along_change }]);
            }
        }
    }
}

/// Limits of a joint's traction (Eq. 90), given along its normal, tension positive, and along its tangent.
pub fn slips(program: &mut Conic, [normal, shear]: [Sum; 2], joint: Strength, x: f64) {
    let tension = joint.tension.unwrap_or_default();
    let missing = Sum { terms: vec![(MISSING, 1.0)], constant: 0.0 };
    let pull = missing.clone().plus(&normal, -1.0).plus(&Sum::constant(tension * x), 1.0);
    program.is_positive(Strong { now: pull, change: Sum::constant(tension) });
    // Where the tensile strength reaches beyond the apex of the cone, the cone grows to hold it (Eq. 78).
    let apex = tension * joint.friction * x;
    let (cohesion, change) =
        if apex > joint.cohesion { (apex * x, 2.0 * apex) } else { (joint.cohesion * x, joint.cohesion) };
    for sign in [1.0, -1.0] {
        let room = missing.clone().plus(&normal, -joint.friction * x).plus(&shear, sign);
        let change = Sum::constant(change).plus(&normal, -joint.friction);
        program.is_positive(Strong { now: room.plus(&Sum::constant(cohesion), 1.0), change });
    }
}
