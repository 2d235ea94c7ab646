//! Box2D on a slope of `enmm bench`: every block a rigid convex polygon.
//!
//! Density and friction are those of the case; there is no elasticity. Steps, iterations and contact softness are those
//! that Box2D recommends: 60 steps a second, each of 4 substeps. Bodies do not fall asleep, since enmm's do not either.
//! Box2D counts lengths in 4-byte numbers and takes no polygon below half a centimetre: it leaves such blocks out.

/// The clock that enmm is timed with.
#[path = "../../../../../crates/verification/src/bench/clock.rs"]
#[expect(dead_code, reason = "memory is not compared")]
mod clock;
#[path = "../../scene.rs"]
#[expect(dead_code, reason = "rigid blocks need neither elasticity nor triangles")]
mod scene;

use std::error::Error;

use boxdd::shapes::{Polygon, SurfaceMaterial};
use boxdd::{BodyBuilder, BodyId, BodyType, ShapeDef, Vec2, World, WorldDef};
use scene::{Answer, Scene};

const STEPS_PER_SECOND: f64 = 60.0;
const SUBSTEPS: i32 = 4;

/// A block in the world: its body and its corners in the body's axes.
type Placed = Option<(BodyId, Vec<Vec2>)>;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = scene::read()?;
    let gravity = scene.gravity.map(|g| g as f32);
    let mut world = World::new(WorldDef::builder().gravity(gravity).enable_sleep(false).build())?;
    insert(&mut world, &scene, &scene.base, BodyType::Static).ok_or("Box2D does not take the slab")?;
    let blocks = scene.blocks.iter().map(|block| &block.points[..block.points.len() - 1]);
    let placed: Vec<Placed> = blocks.map(|corners| insert(&mut world, &scene, corners, BodyType::Dynamic)).collect();
    let steps = (scene.duration * STEPS_PER_SECOND).round() as usize;
    let step = (1.0 / STEPS_PER_SECOND) as f32;
    let ((), seconds) = clock::timed(|| (0..steps).for_each(|_| world.step(step, SUBSTEPS)));
    let now = |placed: &Placed| {
        let (body, corners) = placed.as_ref()?;
        let place = world.body_transform(*body);
        let corner = |&corner: &Vec2| place.transform_point(corner);
        Some(corners.iter().map(corner).map(|p| [f64::from(p.x), f64::from(p.y)]).collect())
    };
    let version = boxdd::version();
    scene::tell(&Answer {
        program: format!("Box2D {}.{}.{}", version.major, version.minor, version.revision),
        settings: format!(
            "rigid blocks, {STEPS_PER_SECOND} steps a second of {SUBSTEPS} substeps, AVX2, 4-byte numbers"
        ),
        seconds: seconds / scene.duration,
        elements: None,
        steps: Some(STEPS_PER_SECOND * f64::from(SUBSTEPS)),
        contacts: usize::try_from(world.counters().contact_count).ok(),
        blocks: placed.iter().map(now).collect(),
    })
}

/// Adds a body whose origin is the mean of its corners; none when Box2D takes no such polygon.
fn insert(world: &mut World, scene: &Scene, corners: &[[f64; 2]], kind: BodyType) -> Placed {
    let mean = [0, 1].map(|k| corners.iter().map(|corner| corner[k]).sum::<f64>() / corners.len() as f64);
    let local: Vec<Vec2> =
        corners.iter().map(|corner| Vec2::from([0, 1].map(|k| (corner[k] - mean[k]) as f32))).collect();
    let polygon = Polygon::from_points(local.iter().copied(), 0.0)?;
    let body = BodyBuilder::new().body_type(kind).position(mean.map(|x| x as f32)).build();
    let material = SurfaceMaterial::default().with_friction(scene.friction as f32).with_restitution(0.0);
    let shape = ShapeDef::builder().density(scene.density as f32).material(material).build();
    let id = world.create_body_id(body);
    world.create_polygon_shape_for(id, &shape, &polygon);
    Some((id, local))
}
