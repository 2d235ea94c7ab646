//! A block pressed its corner on the mouth of a crack of a millimetre, whose tip then lay behind the block's face. The
//! tip held that face while the block slid away, in a slope until it was 9 cm behind the face and pressed with 25 MN/m.

use crate::common::{simulation, step_to};

/// Largest penetration (m) while a tilted square of 2 m slides to the left on its lower corner at 4 m/s, pressed by
/// gravity (m/s²) on a floor with a crack that is parallel to its left face. The crack is half a millimetre deep, since
/// the part that dead-ends within a triangle cuts nothing.
fn penetration(tilt_deg: f64, gravity: f64) -> f64 {
    let (sine, cosine) = tilt_deg.to_radians().sin_cos();
    let mouth = -0.05 + 5e-4 * (1.0 / 3f64.sqrt() - sine / cosine);
    let corner = |x: f64, y: f64| [x * cosine - y * sine, 0.0005 + x * sine + y * cosine];
    let mut simulation = simulation(&format!(
        "title = \"tip\"\n[domain]\njoint_law = \"joint\"\nextend_ends = 0\n\
         outline = [[-8, -4], [6, -4], [6, 0], [-8, 0]]\nislands = [{:?}]\n\
         [mesh]\nsize = 1.0\norigin = [{:?}, 0.3]\n[[joint]]\npoints = [[{mouth:?}, 0], [{:?}, {:?}]]\n\
         [rock.rock]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 28\n\
         [gravity]\ny = -{gravity:?}\n[[fix]]\nedge = [[-8, -4], [6, -4]]\n\
         [[initial_velocity]]\nblock = [0.0, 1.0]\nvelocity = [-4.0, 0.0]\n\
         [[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = 0.2\ndamping = 0.1\n",
        [corner(0.0, 0.0), corner(2.0, 0.0), corner(2.0, 2.0), corner(0.0, 2.0)],
        -0.05 - 0.1 * 3f64.sqrt(),
        mouth + 0.01 * sine,
        -0.01 * cosine,
    ));
    let boundary = &simulation.model().boundary;
    assert!(boundary.partial.contains(&true), "no crack");
    step_to(&mut simulation, 0.15);
    simulation.state().counters.penetration_max
}

#[test]
fn a_crack_tip_holds_no_block_that_slides_away() {
    for (tilt_deg, gravity) in [(0.3, 200.0), (1.0, 500.0), (2.0, 500.0), (4.0, 500.0)] {
        let penetration = penetration(tilt_deg, gravity);
        assert!(penetration < 0.004, "{tilt_deg}°, {gravity} m/s²: {penetration} m");
    }
}
