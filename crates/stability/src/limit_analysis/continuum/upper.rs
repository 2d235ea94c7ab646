//! The upper bound: velocities quadratic in each triangle and apart at joints, as the forces that balance their control
//! points (Eqs. 88–90, 92–94).

use enmm::geometry::Vector;

use super::conic::{Conic, Sum};
use super::ground::{Bar, Edge, Patch, Rock, begin, slips, traction, turned};

/// Control points of the velocities of all triangles: corner `i`, and the middle one of the edge from corner `i` on.
#[derive(Debug, Clone)]
pub struct Controls {
    /// Control points of each triangle: its three corners and its three edges.
    pub of: Vec<[usize; 6]>,
    /// Number of control points.
    pub count: usize,
    /// Axes along which each of them is held.
    pub held: Vec<[bool; 2]>,
}

impl Controls {
    /// Control points are shared across edges within rock, and not across joints.
    pub fn new(patches: &[Patch]) -> Self {
        let mut parent: Vec<usize> = (0..6 * patches.len()).collect();
        for (t, patch) in patches.iter().enumerate() {
            for k in 0..3 {
                if let Edge::Rock(other, edge) = patch.edges[k] {
                    let pairs = [[k, (edge + 1) % 3], [(k + 1) % 3, edge], [3 + k, 3 + edge]];
                    pairs.into_iter().for_each(|[a, b]| join(&mut parent, 6 * t + a, 6 * other + b));
                }
            }
        }
        let mut number = vec![None; parent.len()];
        let mut count = 0;
        let mut of = vec![[0; 6]; patches.len()];
        for (t, own) in of.iter_mut().enumerate() {
            for (k, own) in own.iter_mut().enumerate() {
                *own = *number[root(&mut parent, 6 * t + k)].get_or_insert_with(|| {
                    count += 1;
                    count - 1
                });
            }
        }
        let mut controls = Self { of, count, held: vec![[false; 2]; count] };
        controls.hold(patches);
        controls
    }

    fn hold(&mut self, patches: &[Patch]) {
        for (patch, of) in patches.iter().zip(&self.of) {
            if patch.is_held {
                of.iter().for_each(|&c| self.held[c] = [true; 2]);
            }
            for k in 0..3 {
                if let Edge::Outside(_, held) = patch.edges[k] {
                    for c in on_edge(of, k) {
                        (0..2).for_each(|axis| self.held[c][axis] |= held[axis]);
                    }
                }
            }
        }
    }
}

impl Controls {
    /// Velocities of all control points from the multipliers of a program.
    pub fn velocities(&self, multipliers: &[f64]) -> Vec<Vector> {
        let mut next = multipliers.iter();
        let mut part = |is_held: bool| if is_held { 0.0 } else { *next.next().unwrap_or(&0.0) };
        self.held.iter().map(|held| Vector::new(part(held[0]), part(held[1]))).collect()
    }

    /// Greatest shear strain rate of a triangle: of the three at its corners.
    pub fn shear(&self, patch: &Patch, t: usize, velocities: &[Vector]) -> f64 {
        let of = &self.of[t];
        let at = |corner: usize| {
            let mut rate = [[0.0; 2]; 2];
            for toward in 0..3 {
                let (v, g) = (velocities[control(of, corner, toward)], patch.gradient(toward) * 2.0);
                for a in 0..2 {
                    (0..2).for_each(|b| rate[a][b] += v[a] * g[b]);
                }
            }
            libm::hypot(rate[0][0] - rate[1][1], rate[0][1] + rate[1][0])
        };
        (0..3).map(at).fold(0.0, f64::max)
    }
}

/// Control point of the velocity from a corner toward another, or at the corner itself.
fn control(of: &[usize; 6], corner: usize, toward: usize) -> usize {
    match (corner, toward) {
        (i, j) if i == j => of[i],
        (i, j) if (i + 1) % 3 == j => of[3 + i],
        (_, j) => of[3 + j],
    }
}

/// Control points along edge `k`.
fn on_edge(of: &[usize; 6], k: usize) -> [usize; 3] {
    [of[k], of[3 + k], of[(k + 1) % 3]]
}

fn root(parent: &mut [usize], k: usize) -> usize {
    let mut at = k;
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}

fn join(parent: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b)] = a.min(b);
}

/// The program of one strength; its multipliers are the velocities of the control points along the axes along which
/// they are free, in their order.
pub fn program(rock: &Rock, controls: &Controls, strength: f64) -> Conic {
    let patches = &rock.patches;
    let (program, pulls) = begin(rock, strength);
    let forces = vec![[Sum::default(), Sum::default()]; controls.count];
    let mut balance = Balance { patches, controls, strength, program, forces };
    for t in (0..patches.len()).filter(|&t| !patches[t].is_held) {
        balance.inside(t);
        (0..3).for_each(|k| balance.edge(t, k));
    }
    for (bar, pull) in rock.bars.iter().zip(&pulls) {
        balance.bar(bar, pull);
    }
    balance.close()
}

/// A program whose control points are being loaded.
struct Balance<'a> {
    patches: &'a [Patch],
    controls: &'a Controls,
    strength: f64,
    program: Conic,
    /// Forces on the control points along x and y.
    forces: Vec<[Sum; 2]>,
}

impl Balance<'_> {
    /// Weight of a triangle, and its stresses, each of which stands for a third of it.
    fn inside(&mut self, t: usize) {
        let (patch, of) = (&self.patches[t], &self.controls.of[t]);
        let area = patch.area();
        for &c in of {
            self.push(c, patch.body * (area / 6.0));
        }
        for corner in 0..3 {
            for toward in 0..3 {
                let part = traction(t, corner, patch.gradient(toward));
                let force = &mut self.forces[control(of, corner, toward)];
                (0..2).for_each(|axis| force[axis].add(&part[axis], -2.0 * area / 3.0));
            }
        }
    }

    fn push(&mut self, control: usize, force: Vector) {
        (0..2).for_each(|axis| self.forces[control][axis].constant += force[axis]);
    }

    fn edge(&mut self, t: usize, k: usize) {
        match self.patches[t].edges[k] {
            Edge::Joint(other, edge, ..) if t < other || self.patches[other].is_held => {
                self.joint([t, other], [k, edge]);
            }
            Edge::Outside(loads, _) => {
                let (length, _) = self.patches[t].edge(k);
                for (c, force) in on_edge(&self.controls.of[t], k).into_iter().zip(moments(loads)) {
                    self.push(c, force * length);
                }
            }
            _ => {}
        }
    }

    /// Forces of a joint at its three control points, each of which stands for a third of its length.
    fn joint(&mut self, [t, other]: [usize; 2], [k, edge]: [usize; 2]) {
        let Edge::Joint(_, _, law, pressure) = self.patches[t].edges[k] else { return };
        let (length, normal) = self.patches[t].edge(k);
        let fluid = moments(pressure.map(|p| normal * (-p * length)));
        let (own, across) = (on_edge(&self.controls.of[t], k), on_edge(&self.controls.of[other], edge));
        for i in 0..3 {
            let force = [(); 2].map(|()| Sum { terms: vec![(self.program.unknown(), 1.0)], constant: 0.0 });
            for (control, sign) in [(own[i], 1.0), (across[2 - i], -1.0)] {
                self.push(control, fluid[i] * sign);
                (0..2).for_each(|axis| self.forces[control][axis].add(&force[axis], sign * length / 3.0));
            }
            slips(&mut self.program, turned(force, normal), law, self.strength);
        }
    }

    /// A bolt pulls at positions inside of triangles, whose control points move them by their shares.
    fn bar(&mut self, bar: &Bar, pull: &Sum) {
        for ((t, shares), sign) in bar.ends.into_iter().zip([1.0, -1.0]) {
            for i in 0..3 {
                for j in 0..3 {
                    let force = bar.direction * (sign * shares[i] * shares[j]);
                    let control = control(&self.controls.of[t], i, j);
                    (0..2).for_each(|axis| self.forces[control][axis].add(pull, force[axis]));
                }
            }
        }
    }

    /// The forces on all control points are in balance along the axes along which nothing holds them.
    fn close(mut self) -> Conic {
        for (force, held) in self.forces.into_iter().zip(&self.controls.held) {
            force.into_iter().zip(held).filter(|(_, held)| !**held).for_each(|(sum, _)| self.program.is_zero(sum));
        }
        self.program
    }
}

/// Shares of an edge's three control points in a traction that is linear along it, over its length.
fn moments([a, b]: [Vector; 2]) -> [Vector; 3] {
    [a / 4.0 + b / 12.0, (a + b) / 6.0, a / 12.0 + b / 4.0]
}
