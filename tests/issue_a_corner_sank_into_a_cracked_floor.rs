//! A corner that slid fast over the mouth of a crack in the floor lost its contact there, and sank into the floor: for
//! the side behind the crack it was a new contact, as deep as the spring that it brought from the side before.

use crate::common::simulation;

/// Least height (m) of a square of 2 m that stands on a corner at x = 0 and slides to the left at 10 m/s, pressed by
/// gravity (m/s²) on a floor at height 0, over a crack that dips to the left from its mouth at `mouth` (m).
fn lowest(dip_deg: f64, mouth: f64, gravity: f64) -> f64 {
    let corner = 2f64.sqrt();
    let (sine, cosine) = dip_deg.to_radians().sin_cos();
    let mut simulation = simulation(&format!(
        "title = \"crack\"\n[domain]\njoint_law = \"joint\"\noutline = [[-8, -4], [6, -4], [6, 0], [-8, 0]]\n\
         islands = [[[0, 0.001], [{corner:?}, {middle:?}], [0, {top:?}], [{left:?}, {middle:?}]]]\n\
         [mesh]\nsize = 1.0\nangle_deg = 7\n[[joint]]\npoints = [[{mouth:?}, 0], [{x:?}, {y:?}]]\n\
         [rock.rock]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 5\n\
         [gravity]\ny = -{gravity:?}\n[[fix]]\nedge = [[-8, -4], [6, -4]]\n\
         [[initial_velocity]]\nblock = [0.0, 1.0]\nvelocity = [-10.0, 0.0]\n\
         [[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = 0.06\ndamping = 0.1\n",
        middle = corner + 0.001,
        top = 2.0 * corner + 0.001,
        left = -corner,
        x = mouth - 1.5 * cosine,
        y = -1.5 * sine,
    ));
    let block = simulation.block_states().iter().position(|state| state.centroid.y > 0.0).expect("a block");
    let mut lowest = f64::INFINITY;
    while simulation.time() < 0.06 {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let (boundary, positions) = (&simulation.model().boundary, simulation.positions());
        let own = boundary.edges().filter(|&edge| boundary.block[edge].index() == block);
        lowest = own.map(|edge| positions[edge].y).fold(lowest, f64::min);
    }
    lowest
}

/// Springs and floor give by up to 4 cm under such loads; the corners sank by 0.2 to 1 m.
#[test]
fn a_corner_slides_over_the_mouth_of_a_crack() {
    for (gravity, mouths) in
        [(500.0, [(20.0, -0.1), (36.0, -0.2), (60.0, -0.2)]), (2000.0, [20.0, 36.0, 60.0].map(|dip| (dip, -0.05)))]
    {
        for (dip, mouth) in mouths {
            let lowest = lowest(dip, mouth, gravity);
            assert!(lowest > -0.045, "{dip}°, mouth at {mouth} m, {gravity} m/s²: {lowest} m");
        }
    }
}
