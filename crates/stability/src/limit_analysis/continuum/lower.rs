//! The lower bound: stresses linear in each triangle, in equilibrium everywhere and within the strength everywhere
//! (Eqs. 88–91).

use super::conic::{Conic, Sum};
use super::ground::{Edge, Patch, Rock, begin, slips, traction, turned};

/// The program of one strength.
pub fn program(rock: &Rock, strength: f64) -> Conic {
    let patches = &rock.patches;
    let (mut program, pulls) = begin(rock, strength);
    let mut bodies: Vec<[Sum; 2]> = patches.iter().map(|p| [p.body.x, p.body.y].map(Sum::constant)).collect();
    for (bar, pull) in rock.bars.iter().zip(&pulls) {
        // The force of an anchor is spread over the triangle that holds it.
        for ((t, _), sign) in bar.ends.into_iter().zip([1.0, -1.0]) {
            let force = bar.direction * (sign / patches[t].area());
            (0..2).for_each(|axis| bodies[t][axis].add(pull, force[axis]));
        }
    }
    for (t, body) in bodies.into_iter().enumerate().filter(|(t, _)| !patches[*t].is_held) {
        balance(&mut program, t, &patches[t], body);
        (0..3).for_each(|k| edge(&mut program, patches, t, k, strength));
    }
    program
}

/// Conditions on the stress along the edge of a triangle, once for both of its sides.
fn edge(program: &mut Conic, patches: &[Patch], t: usize, k: usize, strength: f64) {
    let (_, normal) = patches[t].edge(k);
    match patches[t].edges[k] {
        Edge::Rock(other, edge) if t < other => passes(program, patches, [t, other], [k, edge]),
        Edge::Joint(other, edge, law, pressure) => {
            if t < other && !patches[other].is_held {
                passes(program, patches, [t, other], [k, edge]);
            }
            if t < other || patches[other].is_held {
                // The law of the joint at both of its ends; fluid in it takes its share of the pressure.
                for (end, pressure) in pressure.into_iter().enumerate() {
                    let [pull, shear] = turned(traction(t, (k + end) % 3, normal), normal);
                    slips(program, [pull.plus(&Sum::constant(pressure), 1.0), shear], law, strength);
                }
            }
        }
        Edge::Outside(loads, held) => {
            for (end, load) in loads.into_iter().enumerate() {
                let sums = traction(t, (k + end) % 3, normal).into_iter().enumerate();
                for (axis, sum) in sums.filter(|(axis, _)| !held[*axis]) {
                    program.is_zero(sum.plus(&Sum::constant(-load[axis]), 1.0));
                }
            }
        }
        Edge::Rock(..) => {}
    }
}

/// Equilibrium inside of a triangle, whose stress has one gradient.
fn balance(program: &mut Conic, t: usize, patch: &Patch, body: [Sum; 2]) {
    let size = patch.area().sqrt();
    let mut sums = body.map(|body| Sum::default().plus(&body, size));
    for corner in 0..3 {
        let part = traction(t, corner, patch.gradient(corner) * size);
        (0..2).for_each(|axis| sums[axis].add(&part[axis], 1.0));
    }
    sums.into_iter().for_each(|sum| program.is_zero(sum));
}

/// The same traction on both sides at both ends of an edge.
fn passes(program: &mut Conic, patches: &[Patch], [t, other]: [usize; 2], [k, edge]: [usize; 2]) {
    let (_, normal) = patches[t].edge(k);
    for end in 0..2 {
        let own = traction(t, (k + end) % 3, normal);
        let across = traction(other, (edge + 1 - end) % 3, normal);
        own.into_iter().zip(&across).for_each(|(own, across)| program.is_zero(own.plus(across, -1.0)));
    }
}
