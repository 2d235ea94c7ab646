//! The linear program of one strength: the least share of its weight by which some block is out of balance (Eq. 79).

use clarabel::algebra::CscMatrix;
use clarabel::solver::{SolverStatus, SupportedConeT};

use enmm::geometry::{Point, Vector};
use enmm::model::tables::BlockId;

use super::contact::Contact;
use super::model::{Bar, Body};
use super::solver::Accuracy;

/// Rigid blocks and what acts between them.
#[derive(Debug, Clone)]
pub struct Program {
    /// All blocks of the model.
    pub bodies: Vec<Body>,
    /// Interfaces and points that press on each other in any case.
    pub contacts: Vec<Contact>,
    /// Bolts.
    pub bars: Vec<Bar>,
}

/// Accuracy of a solution, relative to the weight of a block.
const ACCURACY: Accuracy =
    Accuracy { full: 1e-10, reduced: 1e-8, given_up: 5e-8, regularizations: &[1e-8, 1e-6, 1e-10] };

/// Velocity (m/s) of a block's centroid and its angular velocity (rad/s), as large as one likes.
pub type Motion = (Vector, f64);

/// Solution of a program at one strength.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Least share of its weight by which the worst block is out of balance; 0 when there is equilibrium.
    pub unbalanced: f64,
    /// Its change with the strength.
    pub slope: f64,
    /// Motion of every block in the mechanism that does most work for its weight.
    pub motions: Vec<Motion>,
}

/// The solver gave up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unsolved {
    /// Status of the solver.
    pub status: SolverStatus,
}

impl Program {
    /// Solves for joints whose strength is multiplied by `strength`, with `more` contacts.
    ///
    /// # Errors
    /// The solver finds no solution, though there always is one.
    pub fn solve(&self, strength: f64, more: &[Contact]) -> Result<Solution, Unsolved> {
        let contacts: Vec<&Contact> = self.contacts.iter().chain(more).collect();
        let rows = Rows::new(self, &contacts, strength);
        let (m, n) = (rows.right.len(), rows.columns);
        let a = CscMatrix::new_from_triplets(m, n, rows.row, rows.column, rows.value);
        let solution = ACCURACY.least(&a, &rows.right, &[SupportedConeT::NonnegativeConeT(m)]);
        let solution = solution.map_err(|status| Unsolved { status })?;
        let change = |&(row, column, by): &(usize, usize, f64)| {
            solution.z[row] * by * if column == CONSTANT { 1.0 } else { solution.x[column] }
        };
        let slope = rows.strength.iter().map(change).sum();
        Ok(Solution { unbalanced: solution.x[0], slope, motions: self.motions(&solution.z) })
    }

    /// Motions of the blocks from the multipliers of their equilibrium.
    fn motions(&self, multipliers: &[f64]) -> Vec<Motion> {
        let mut row = 0;
        let mut motion = |body: &Body| {
            if !body.is_free() {
                return (Vector::zeros(), 0.0);
            }
            let [x, y, turn] = [0, 1, 2].map(|k| multipliers[row + 2 * k] - multipliers[row + 2 * k + 1]);
            row += 6;
            (Vector::new(x, y) / body.weight, turn / (body.weight * body.radius))
        };
        self.bodies.iter().map(&mut motion).collect()
    }

    /// Velocity of the second block relative to the first at a position.
    pub fn parting(&self, motions: &[Motion], contact: &Contact) -> Vector {
        let at = |b: BlockId| {
            let (velocity, spin) = motions[b];
            let arm: Vector = contact.ends[0] - self.bodies[b].centre;
            velocity + Vector::new(-arm.y, arm.x) * spin
        };
        at(contact.blocks[1]) - at(contact.blocks[0])
    }
}

/// Stands for the column of constants.
const CONSTANT: usize = usize::MAX;

/// The inequalities of a program, all of the form row · x ≤ right. Column 0 is the unbalanced share; forces are in
/// units of the mean weight of a block.
struct Rows {
    row: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
    right: Vec<f64>,
    columns: usize,
    /// First row of each block that can move.
    first: Vec<Option<usize>>,
    /// Entries that depend on the strength: row, column, change of the left side.
    strength: Vec<(usize, usize, f64)>,
    unit: f64,
}

impl Rows {
    fn new(program: &Program, contacts: &[&Contact], strength: f64) -> Self {
        let free: Vec<&Body> = program.bodies.iter().filter(|b| b.is_free()).collect();
        let unit = free.iter().map(|b| b.weight).sum::<f64>() / free.len().max(1) as f64;
        let mut rows = Self {
            row: Vec::new(),
            column: Vec::new(),
            value: Vec::new(),
            right: Vec::new(),
            columns: 1,
            first: Vec::new(),
            strength: Vec::new(),
            unit,
        };
        rows.balances(&program.bodies);
        for (b, body) in BlockId::all(program.bodies.len()).zip(&program.bodies).filter(|(_, body)| body.is_free()) {
            for hold in &body.holds {
                let column = rows.unknown();
                rows.push(&program.bodies, b, *hold, column);
            }
        }
        program.bars.iter().for_each(|bar| rows.bar(&program.bodies, bar));
        contacts.iter().for_each(|contact| rows.contact(&program.bodies, contact, strength));
        rows
    }

    /// Two rows for each of the three balances of a block: force/weight − share ≤ 0 in both senses.
    fn balances(&mut self, bodies: &[Body]) {
        for body in bodies {
            self.first.push(body.is_free().then_some(self.right.len()));
            if body.is_free() {
                for load in [body.force.x, body.force.y, body.moment / body.radius] {
                    for sign in [1.0, -1.0] {
                        let row = self.limit(-sign * load / body.weight);
                        self.set(row, 0, -1.0);
                    }
                }
            }
        }
    }

    fn unknown(&mut self) -> usize {
        self.columns += 1;
        self.columns - 1
    }

    /// A new row with its right side.
    fn limit(&mut self, right: f64) -> usize {
        self.right.push(right);
        self.right.len() - 1
    }

    fn set(&mut self, row: usize, column: usize, value: f64) {
        self.row.push(row);
        self.column.push(column);
        self.value.push(value);
    }

    /// An unknown force acts on a block by these shares.
    fn push(&mut self, bodies: &[Body], block: BlockId, shares: [f64; 3], column: usize) {
        let Some(first) = self.first[block] else { return };
        let scale = self.unit / bodies[block].weight;
        for (k, share) in shares.into_iter().enumerate().filter(|(_, share)| *share != 0.0) {
            self.set(first + 2 * k, column, share * scale);
            self.set(first + 2 * k + 1, column, -share * scale);
        }
    }

    /// An unknown force acts on the second block along `direction`, and against it on the first.
    fn pair(&mut self, bodies: &[Body], blocks: [BlockId; 2], at: [Point; 2], direction: Vector) -> usize {
        let column = self.unknown();
        for (k, sign) in [(0, -1.0), (1, 1.0)] {
            let b = blocks[k];
            self.push(bodies, b, bodies[b].share(at[k], direction * sign), column);
        }
        column
    }

    fn bar(&mut self, bodies: &[Body], bar: &Bar) {
        let direction = (bar.ends[0] - bar.ends[1]).normalize();
        let column = self.pair(bodies, bar.blocks, bar.ends, direction);
        let row = self.limit(0.0);
        self.set(row, column, -1.0);
        if bar.yield_force.is_finite() {
            let row = self.limit(bar.yield_force / self.unit);
            self.set(row, column, 1.0);
        }
    }

    /// A normal force at each end that pulls no more than the tensile strength, and a shear force within friction and
    /// cohesion (Eqs. 77, 78).
    fn contact(&mut self, bodies: &[Body], contact: &Contact, strength: f64) {
        let ends = if contact.is_point() { &contact.ends[..1] } else { &contact.ends[..] };
        let normals: Vec<usize> =
            ends.iter().map(|&end| self.pair(bodies, contact.blocks, [end; 2], contact.normal)).collect();
        let shear = self.pair(bodies, contact.blocks, [contact.ends[0]; 2], contact.tangent());
        let pull = contact.tension / self.unit / ends.len() as f64;
        for &normal in &normals {
            let row = self.limit(strength * pull);
            self.set(row, normal, -1.0);
            self.strength.push((row, CONSTANT, -pull));
        }
        let apex = contact.tension / self.unit * contact.friction;
        let cohesion = contact.cohesion / self.unit;
        // Where the tensile strength reaches beyond the apex of the cone, the cone grows to hold it.
        let is_wider = strength * apex > cohesion;
        let bears = strength * cohesion.max(strength * apex);
        let change = if is_wider { 2.0 * strength * apex } else { cohesion };
        for sign in [1.0, -1.0] {
            let row = self.limit(bears);
            self.set(row, shear, sign);
            self.strength.push((row, CONSTANT, -change));
            for &normal in &normals {
                self.set(row, normal, -strength * contact.friction);
                self.strength.push((row, normal, -contact.friction));
            }
        }
    }
}
