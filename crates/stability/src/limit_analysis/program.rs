//! Programs of rigid blocks: the least share of its weight by which some block is out of balance at one strength
//! (Eq. 79), the least strength with equilibrium where shear strengths are given (Eq. 79a), and the forces that joints
//! take up as springs.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolution, SolverStatus, SupportedConeT};

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
    /// Normal force (N/m) of every contact, compression positive.
    pub normals: Vec<f64>,
}

/// The least strength with equilibrium where shear strengths are given.
#[derive(Debug, Clone)]
pub struct Held {
    /// The strength, over that of the case.
    pub strength: f64,
    /// Motion of every block in the mechanism.
    pub motions: Vec<Motion>,
    /// Slip (m/s) of every contact in the mechanism.
    pub slips: Vec<f64>,
}

/// Shear strength of a contact that does not follow its normal force.
#[derive(Debug, Clone, Copy)]
pub struct Given {
    /// Normal force (N/m, compression positive) that gives it.
    pub normal: f64,
    /// Its change with the normal force all the same: tan ψ, with which its slip dilates.
    pub dilation: f64,
}

/// The status with which the solver gave up.
pub type Unsolved = SolverStatus;

impl Program {
    /// Solves for joints whose strength is multiplied by `strength`, with `more` contacts.
    ///
    /// # Errors
    /// The solver finds no solution, though there always is one.
    pub fn solve(&self, strength: f64, more: &[Contact]) -> Result<Solution, Unsolved> {
        let mut rows = Rows::new(self, Balance::Share);
        for contact in self.contacts.iter().chain(more) {
            rows.contact(&self.bodies, contact, strength);
        }
        let solution = rows.least()?;
        let change = |&(row, column, by): &(usize, usize, f64)| {
            solution.z[row] * by * if column == CONSTANT { 1.0 } else { solution.x[column] }
        };
        Ok(Solution {
            unbalanced: solution.x[0],
            slope: rows.strength.iter().map(change).sum(),
            motions: self.motions(&rows, &solution.z),
            normals: rows.normals(&solution.x),
        })
    }

    /// Finds the least strength, not below `least`, with equilibrium where shear strengths are given.
    ///
    /// # Errors
    /// There is no equilibrium, or the solver finds no solution.
    pub fn hold(&self, given: &[Given], least: f64) -> Result<Held, Unsolved> {
        let mut rows = Rows::new(self, Balance::Exact);
        let row = rows.limit(-least);
        rows.set(row, 0, -1.0);
        let shears = rows.given(self, given, None);
        let solution = rows.least()?;
        Ok(Held {
            strength: solution.x[0],
            motions: self.motions(&rows, &solution.z),
            slips: shears.into_iter().map(|row| (solution.z[row] + solution.z[row + 1]) / rows.unit).collect(),
        })
    }

    /// Finds the normal forces (N/m) in equilibrium at a strength, where shear strengths are given, with the least
    /// energy in the springs of the joints.
    ///
    /// # Errors
    /// There is no equilibrium, or the solver finds no solution.
    pub fn settle(&self, given: &[Given], strength: f64) -> Result<Vec<f64>, Unsolved> {
        let mut rows = Rows::new(self, Balance::Exact);
        rows.given(self, given, Some(strength));
        let solution = rows.least_energy(&self.contacts)?;
        Ok(rows.normals(&solution.x))
    }

    /// Motions of the blocks from the multipliers of their equilibrium.
    fn motions(&self, rows: &Rows, multipliers: &[f64]) -> Vec<Motion> {
        let motion = |(body, first): (&Body, &Option<usize>)| {
            let Some(first) = *first else { return (Vector::zeros(), 0.0) };
            let [x, y, turn] = [0, 1, 2].map(|k| match rows.balance {
                Balance::Share => multipliers[first + 2 * k] - multipliers[first + 2 * k + 1],
                Balance::Exact => multipliers[first + k],
            });
            (Vector::new(x, y) / body.weight, turn / (body.weight * body.radius))
        };
        self.bodies.iter().zip(&rows.first).map(motion).collect()
    }

    /// Takes cohesion and tensile strength from contacts.
    pub fn bare(&mut self, contacts: &[usize]) {
        contacts.iter().for_each(|&k| self.contacts[k] = self.contacts[k].bare());
    }

    /// Speed of the fastest block, its turning at its own radius included.
    pub fn fastest(&self, motions: &[Motion]) -> f64 {
        let speed = |(body, (velocity, spin)): (&Body, &Motion)| libm::hypot(velocity.norm(), spin * body.radius);
        self.bodies.iter().zip(motions).map(speed).fold(0.0, f64::max)
    }

    /// Velocity of the second block of a contact relative to the first, at each of its ends.
    pub fn partings(&self, motions: &[Motion], contact: &Contact) -> Vec<Vector> {
        let at = |b: BlockId, end: Point| {
            let (velocity, spin) = motions[b];
            let arm: Vector = end - self.bodies[b].centre;
            velocity + Vector::new(-arm.y, arm.x) * spin
        };
        let parting = |&end: &Point| at(contact.blocks[1], end) - at(contact.blocks[0], end);
        contact.ends().iter().map(parting).collect()
    }
}

/// Stands for the column of constants.
const CONSTANT: usize = usize::MAX;

/// How far blocks may be out of balance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Balance {
    /// By a share of their weight, unknown 0: two inequalities for each balance.
    Share,
    /// Not at all.
    Exact,
}

/// The rows of a program: row · x ≤ right, or = right for exact balances, which come first. Forces are in units of the
/// mean weight of a block.
struct Rows {
    balance: Balance,
    row: Vec<usize>,
    column: Vec<usize>,
    value: Vec<f64>,
    right: Vec<f64>,
    columns: usize,
    /// First row of each block that can move.
    first: Vec<Option<usize>>,
    /// Unknown normal forces and shear force of each contact.
    forces: Vec<(Vec<usize>, usize)>,
    /// Entries that depend on the strength: row, column, change of the left side.
    strength: Vec<(usize, usize, f64)>,
    unit: f64,
}

impl Rows {
    /// Balances of the blocks, with what holds them and their bolts.
    fn new(program: &Program, balance: Balance) -> Self {
        let free: Vec<&Body> = program.bodies.iter().filter(|b| b.is_free()).collect();
        let unit = free.iter().map(|b| b.weight).sum::<f64>() / free.len().max(1) as f64;
        let mut rows = Self {
            balance,
            row: Vec::new(),
            column: Vec::new(),
            value: Vec::new(),
            right: Vec::new(),
            columns: 1,
            first: Vec::new(),
            forces: Vec::new(),
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
        rows
    }

    /// The matrix of the rows, and the cones of what is left of their right sides.
    fn cones(&self) -> (CscMatrix<f64>, Vec<SupportedConeT<f64>>) {
        let (m, n) = (self.right.len(), self.columns);
        let (row, column, value) = (self.row.clone(), self.column.clone(), self.value.clone());
        let a = CscMatrix::new_from_triplets(m, n, row, column, value);
        let exact = match self.balance {
            Balance::Share => 0,
            Balance::Exact => 3 * self.first.iter().flatten().count(),
        };
        let cones = [SupportedConeT::ZeroConeT(exact), SupportedConeT::NonnegativeConeT(m - exact)];
        (a, cones[usize::from(exact == 0)..].to_vec())
    }

    /// The least of unknown 0.
    fn least(&self) -> Result<DefaultSolution<f64>, Unsolved> {
        let (a, cones) = self.cones();
        ACCURACY.least(None, &a, &self.right, &cones)
    }

    /// The least energy in the springs of all contacts, of which each end bears half.
    fn least_energy(&self, contacts: &[Contact]) -> Result<DefaultSolution<f64>, Unsolved> {
        let mean = contacts.iter().map(|c| c.stiffness[0]).sum::<f64>() / contacts.len().max(1) as f64;
        let mut factors = vec![0.0; self.columns];
        for ((normals, shear), contact) in self.forces.iter().zip(contacts) {
            let [normal, along] = contact.stiffness.map(|stiffness| mean / stiffness);
            normals.iter().for_each(|&k| factors[k] = normal * normals.len() as f64);
            factors[*shear] = along;
        }
        let (a, cones) = self.cones();
        ACCURACY.least(Some(factors), &a, &self.right, &cones)
    }

    /// Normal forces (N/m) of the contacts.
    fn normals(&self, unknowns: &[f64]) -> Vec<f64> {
        self.forces.iter().map(|(normals, _)| normals.iter().map(|&k| unknowns[k]).sum::<f64>() * self.unit).collect()
    }

    /// The three balances of each block: force/weight within the share, in both senses, or zero.
    fn balances(&mut self, bodies: &[Body]) {
        for body in bodies {
            self.first.push(body.is_free().then_some(self.right.len()));
            if body.is_free() {
                for load in [body.force.x, body.force.y, body.moment / body.radius] {
                    match self.balance {
                        Balance::Exact => _ = self.limit(-load / body.weight),
                        Balance::Share => {
                            for sign in [1.0, -1.0] {
                                let row = self.limit(-sign * load / body.weight);
                                self.set(row, 0, -1.0);
                            }
                        }
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
            match self.balance {
                Balance::Exact => self.set(first + k, column, share * scale),
                Balance::Share => {
                    self.set(first + 2 * k, column, share * scale);
                    self.set(first + 2 * k + 1, column, -share * scale);
                }
            }
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

    /// The unknown normal forces of a contact, one at each end, and its shear force.
    fn press(&mut self, bodies: &[Body], contact: &Contact) -> (Vec<usize>, usize) {
        let ends = contact.ends();
        let normals: Vec<usize> =
            ends.iter().map(|&end| self.pair(bodies, contact.blocks, [end; 2], contact.normal)).collect();
        let shear = self.pair(bodies, contact.blocks, [contact.ends[0]; 2], contact.tangent());
        self.forces.push((normals.clone(), shear));
        (normals, shear)
    }

    /// A normal force at each end that pulls no more than the tensile strength, and a shear force within friction and
    /// cohesion (Eqs. 77, 78).
    fn contact(&mut self, bodies: &[Body], contact: &Contact, strength: f64) {
        let (normals, shear) = self.press(bodies, contact);
        let pull = contact.tension / self.unit / normals.len() as f64;
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

    /// All contacts with given shear strengths, times the strength, which is unknown 0 where none is given (Eq. 79a).
    /// Returns the first row of each that limits its shear force.
    fn given(&mut self, program: &Program, given: &[Given], strength: Option<f64>) -> Vec<usize> {
        let mut shears = Vec::new();
        for (contact, given) in program.contacts.iter().zip(given) {
            let (normals, shear) = self.press(&program.bodies, contact);
            let pull = contact.tension / self.unit / normals.len() as f64;
            for &normal in &normals {
                let row = self.within(pull, 0.0, strength);
                self.set(row, normal, -1.0);
            }
            shears.push(self.right.len());
            let bears = contact.shear_strength(given.normal) / self.unit;
            for sign in [1.0, -1.0] {
                let row = self.within(bears, -given.dilation * given.normal / self.unit, strength);
                self.set(row, shear, sign);
                normals.iter().for_each(|&normal| self.set(row, normal, -given.dilation));
            }
        }
        shears
    }

    /// A new row whose right side is `bears` times the strength and a constant.
    fn within(&mut self, bears: f64, constant: f64, strength: Option<f64>) -> usize {
        let row = self.limit(strength.unwrap_or(0.0) * bears + constant);
        if strength.is_none() && bears != 0.0 {
            self.set(row, 0, -bears);
        }
        row
    }
}
