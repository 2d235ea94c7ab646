//! Rapier's soft bodies on a slope of `enmm bench`: every block a deformable body of constant-strain triangles.
//!
//! Young's modulus, Poisson's ratio, density and friction are those of the case. Each block is cut into triangles
//! between its sides and its centroid, about as many as the mesh of enmm cuts it into, and carries its mass lumped at
//! their corners. Elasticity is corotational, and implicit (`SoftBodySolver::Fem`) or, with the word `constraints`
//! before the file, swept with the contacts. Steps, iterations and contact softness are Rapier's defaults: 60 steps a
//! second, each of 4 substeps. The slab is a fixed convex collider. Bodies do not fall asleep, since enmm's do not
//! either.
//!
//! Rapier rests soft bodies against each other at the distance of their skins. Every block is therefore smaller by its
//! skin all round, so that blocks which touch in the case do so here: with full size they begin with an overlap of
//! their skins, which throws them apart. Its mass stays that of the whole block, and the answer has the corners of the
//! whole block. Grains thinner than two skins are left out.

/// The clock that enmm is timed with.
#[path = "../../../../../crates/verification/src/bench/clock.rs"]
#[expect(dead_code, reason = "memory is not compared")]
mod clock;
#[path = "../../scene.rs"]
mod scene;

use std::error::Error;

use rapier2d_f64::prelude::*;
use scene::{Answer, Block, Scene};

/// Thickness of the skins by which Rapier keeps soft bodies apart, in parts of the mesh size. With a quarter of it or
/// five times as much, 500 blocks take 15 % more or less time and slide as far within 5 %.
const SKIN: f64 = 2e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scene::read()?;
    let mut world = PhysicsWorld::new();
    world.gravity = vector(scene.gravity);
    let base = scene.base.iter().copied().map(vector).collect();
    let base = ColliderBuilder::convex_polyline(base).ok_or("the slab is not convex")?;
    world.insert(RigidBodyBuilder::fixed(), base.friction(scene.friction));
    let skin = SKIN * scene.size;
    let by_constraints = std::env::args().any(|word| word == "constraints");
    let (solver, elasticity) = match by_constraints {
        true => (SoftBodySolver::Constraints, "by constraints"),
        false => (SoftBodySolver::Fem, "by implicit elements"),
    };
    let handles: Vec<Option<SoftBodyHandle>> = scene
        .blocks
        .iter()
        .map(|block| soft_body(&scene, block, solver, skin).map(|body| world.insert_soft_body(body)))
        .collect();
    let steps = (scene.duration / world.integration_parameters.dt).round() as usize;
    let ((), seconds) = clock::timed(|| (0..steps).for_each(|_| world.step()));
    let (mut blocks, mut elements, mut contacts) = (Vec::new(), 0, 0);
    for (handle, block) in handles.iter().zip(&scene.blocks) {
        let Some(handle) = handle else {
            blocks.push(None);
            continue;
        };
        let body = world.soft_bodies.get(*handle).ok_or("a body was lost")?;
        elements += body.cells().len();
        contacts += body.edge_contact_segments(&world.soft_bodies).count();
        contacts += body.vertex_contact_segments(&world.soft_bodies).count();
        let corners: Vec<[f64; 2]> =
            body.particle_positions().take(block.points.len() - 1).map(|p| [p.x, p.y]).collect();
        blocks.push(Some(moved_in(&corners, -skin)));
    }
    let parameters = &world.integration_parameters;
    scene::tell(&Answer {
        program: format!("Rapier {}, soft bodies {elasticity}", rapier2d_f64::VERSION),
        settings: format!(
            "deformable blocks, corotational, {:.0} steps a second of {} substeps, skins \
             of {SKIN} of the mesh size, 8-byte numbers",
            1.0 / parameters.dt,
            parameters.num_solver_iterations
        ),
        seconds: seconds / scene.duration,
        elements: Some(elements),
        steps: Some(parameters.num_solver_iterations as f64 / parameters.dt),
        contacts: Some(contacts),
        blocks,
    })
}

/// A block smaller by its skin; none when nothing is left of a side or of the block.
fn soft_body(scene: &Scene, block: &Block, solver: SoftBodySolver, skin: f64) -> Option<SoftBodyBuilder> {
    let (centre, corners) = block.points.split_last()?;
    let mut points = moved_in(corners, skin);
    points.push(*centre);
    if block.triangles.iter().any(|triangle| area(triangle.map(|k| points[k as usize])) <= 0.0) {
        return None;
    }
    let material =
        SoftBodyMaterial { young_modulus: scene.young, poisson_ratio: scene.poisson, ..SoftBodyMaterial::default() };
    let body = SoftBodyBuilder::new(points.into_iter().map(vector).collect())
        .cells(block.triangles.clone())
        .masses(masses(scene, block))
        .material(material)
        .cell_model(SoftBodyCellModel::Corotational)
        .solver(solver)
        .particle_radius(skin)
        .surface_collider(ColliderBuilder::ball(1.0).friction(scene.friction))
        .can_sleep(false);
    Some(body)
}

/// The corners of a convex polygon with every side moved inwards (m).
fn moved_in(corners: &[[f64; 2]], way: f64) -> Vec<[f64; 2]> {
    let n = corners.len();
    let along = |k: usize| (vector(corners[(k + 1) % n]) - vector(corners[k])).normalize();
    let corner = |k: usize| {
        let (before, after) = (along((k + n - 1) % n), along(k));
        let sine = before.x * after.y - before.y * after.x;
        let moved = vector(corners[k]) + (after - before) * (way / sine);
        [moved.x, moved.y]
    };
    (0..n).map(corner).collect()
}

/// A third of the mass of each triangle at each of its corners (kg/m).
fn masses(scene: &Scene, block: &Block) -> Vec<f64> {
    let mut masses = vec![0.0; block.points.len()];
    for triangle in &block.triangles {
        let mass = scene.density * area(triangle.map(|k| block.points[k as usize]));
        triangle.iter().for_each(|&k| masses[k as usize] += mass / 3.0);
    }
    masses
}

fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x, y)
}
