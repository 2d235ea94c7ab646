//! Claim: problems pass with other values of their parameters, too: other shapes, planes, rocks and time steps.

use crate::common::extent::by_extent;
use enmm_verification::problems::ALL;
use enmm_verification::{Outcome, Request, Trouble, choose};

/// Solves a problem with values as `--set` takes them, with spaces between them.
fn solve(id: &str, quick: bool, values: &str) -> Result<Outcome, Trouble> {
    let set = values.split_whitespace().map(str::to_owned).collect();
    let request = Request { only: vec![id.to_owned()], set, quick, ..Request::default() };
    enmm_verification::solve(choose(ALL, &request)?.remove(0)).outcome
}

fn assert_passes(id: &str, quick: bool, values: &str) {
    let outcome = solve(id, quick, values).unwrap_or_else(|e| panic!("{id} {values}: {e}"));
    let failing: Vec<_> = outcome.rows.iter().filter(|row| !row.passes()).collect();
    assert!(failing.is_empty(), "{id} {values}: {failing:#?}");
}

/// Solves a problem with sets of values; its quick form takes two of them.
fn assert_all(id: &str, sets: &[&str]) {
    sets.iter().take(by_extent([2, usize::MAX, usize::MAX])).for_each(|set| assert_passes(id, true, set));
}

/// A block as high as long slides upright up to 45° of friction, and tips over beyond: C1 offers no such friction, and
/// C2 no block that topples.
#[test]
fn long_c1_and_c2_offer_no_block_that_topples() {
    assert_all("C1", &["phi_brake_deg=40", "a_deg=42 phi_deg=40 phi_rest_deg=60"]);
    let told = |id: &str, values: &str| solve(id, true, values).expect_err("it is refused").0;
    assert!(told("C1", "phi_brake_deg=45").contains("must be from 5 to 40"), "{}", told("C1", "phi_brake_deg=45"));
    assert!(told("C2", "height=7").contains("below length/tan a"), "{}", told("C2", "height=7"));
}

#[test]
fn long_a1_meshes_and_turns() {
    assert_all(
        "A1",
        &[
            "seed=21 mesh=1.4 mesh_angle_deg=47 mesh_x=4.1 mesh_y=-3.3 turn_deg=-75",
            "seed=41 mesh=0.6 mesh_angle_deg=8 traces=2.5 turn_deg=179 joints=4",
        ],
    );
}

#[test]
fn a2_gravity_and_damping() {
    let sideways = "g=3.5355 direction_deg=-61.26 mesh_angle_deg=31";
    assert_all("A2", &["mesh=1 mesh_angle_deg=0", "damping=0", sideways]);
}

/// A block that is no convex polygon, one of about a mesh size, and one with a joint that ends inside it.
#[test]
fn long_a3_shapes() {
    assert_all("A3", &["seed=3 corners=9", "corners=3 size=0.6 mesh=1.6 w0=2", "corners=4 size=1.7 mesh=0.27 crack=1"]);
}

#[test]
fn long_a4_friction_damping_and_steps() {
    assert_all("A4", &["seed=3 friction_deg=60 damping=0.5 dt_max=1e-4", "seed=4 friction_deg=20 dt_max=2e-4"]);
}

/// A frictionless collision without damping, which the full form takes to its end.
#[test]
fn a4_without_damping() {
    assert_passes("A4", false, "seed=2 friction_deg=0 damping=0 young=1e11 dt_max=2.5e-6 steps=36000");
}

#[test]
fn long_b1_and_b3_rocks() {
    assert_all("B1", &["poisson=0.1"]);
    assert_all("B3", &["young=5e9 poisson=0.35 gamma=22e3"]);
}

/// Friction just below the dip, steep planes, a level one, and rock so soft that a block takes up shear for long.
#[test]
fn long_c1_planes_and_rocks() {
    assert_all(
        "C1",
        &[
            "a_deg=23.7 phi_deg=11.3 a_steep_deg=52 phi_steep_deg=18",
            "phi_deg=29 a_rest_deg=45 phi_rest_deg=46 young_rest=5e7 mesh=1",
            "a_deg=37 phi_deg=24 a_rest_deg=20 phi_rest_deg=20.5",
            "phi_deg=10 a_brake_deg=10 phi_brake_deg=25 v0=1.5",
            "a_brake_deg=0 phi_brake_deg=20 v0=2.5 phi_rest_deg=35 young_rest=1e9",
        ],
    );
}

#[test]
fn long_c2_blocks() {
    assert_all(
        "C2",
        &[
            "length=3.7 height=1.3 a_deg=22 phi_c_deg=18 cohesion=11e3",
            "height=1 a_deg=41 phi_c_deg=0 cohesion=30e3 mesh=0.9",
        ],
    );
}

#[test]
fn long_c3_two_blocks() {
    assert_all(
        "C3",
        &[
            "",
            "phi_lower_deg=30",
            "phi_lower_deg=25 phi_upper_deg=5",
            "a_deg=22 phi_lower_deg=27 phi_upper_deg=5 mesh=0.4",
            "phi_lower_deg=10 phi_upper_deg=25",
        ],
    );
}

/// The angular acceleration of other blocks; one limit each.
#[test]
fn c6_toppling_blocks() {
    for (k, a_deg) in [(0.2, 30.0), (0.4, 30.0), (0.25, 20.0)] {
        let most = 0.34f64.max(k);
        assert_passes("C6", true, &format!("k_count=1 k={k} k_low={k} k_high={most} a_deg={a_deg}"));
    }
}

#[test]
fn c9_wedge() {
    assert_all("C9", &["height=55 crack=9.5 face_deg=57 plane_deg=31 water_half=3.1 water_full=6.2"]);
}

#[test]
fn long_c12_bolts() {
    assert_all("C12", &["", "a_deg=35 phi_deg=20 weight=750 spacing=2"]);
}

#[test]
fn long_d3_direct_shear() {
    assert_all(
        "D3",
        &["", "sn=3e6 phi_deg=38 c=0.2e6 ks=4e10 jrc=6", "sn=2e5 c=0 phi_residual_deg=20 ks=1e9 kn=5e9 jrc=15 jcs=5e7"],
    );
}

#[test]
fn long_d5_drop_of_less_on_a_softer_spring() {
    assert_all("D5", &["m=2000 k=4e8 H=0.2"]);
}

/// Sixty seconds; the wall of 20 × 20 bricks with `ENMM_LONG=1`, one of 5 × 5 otherwise.
#[test]
fn long_e2_a_wall_rests_for_a_minute() {
    let (side, seconds) = by_extent([(5.0, 6.0), (5.0, 60.0), (20.0, 60.0)]);
    assert_passes("E2", false, &format!("columns={side} courses={side} seconds={seconds}"));
}

#[test]
fn long_d6_roof_wedge() {
    assert_all("D6", &["", "rows=14", "a_deg=30 phi_deg=35 ratio=5", "a_deg=12 phi_deg=50 ratio=0.5 height=5 ks=2e8"]);
}

/// Flows, heads and uplift are those of their closed forms for other lengths, heads, apertures and places.
#[test]
fn water_in_joints() {
    assert_all("W1", &["length=37 left=6 right=9.3 ratio=0.4 meets=0.71", "aperture=8e-4 below=12 ratio=5"]);
    assert_all("W3", &["width=7 head=3 drain=0.8 aperture=5e-4", "width=120 head=90 drain=0.07"]);
    assert_all("W4", &["length=13 upper=6 lower=0 spacing=2 conductivity=1e-4", "upper=12 lower=7 length=9.5"]);
    assert_all("W5", &["aperture=4e-4 share=1 storm=40", "length=30 river=6 mound=8"]);
    assert_all("W8", &["water=2 clogged=0.6 plane_deg=40", "height=80 crack=20 water=15 clogged=0.4"]);
    assert_all("W9", &["level=0.3 dip_deg=12", "level=1.2 height=30 dip_deg=40"]);
    assert_all("W13", &["length=50 head=4 well=0.8 share=0.9", "aperture=6e-4 well=0.1 greedy=20"]);
}
