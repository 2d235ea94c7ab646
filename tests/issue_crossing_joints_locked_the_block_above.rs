//! Where joints cross, the corner of the block above once caught on the side of the block below and locked: it moved by
//! 1e-5 m where ½·g·(sin 30° − cos 30°·tan 20°)·t² is 0.2266 m. So it was above the mouth of a joint that ends below.

mod common;

use common::{run_stage, simulation};

/// Two blocks on a plane that dips by 30°, the joint between them going on below the plane to `end`.
fn case(end: [f64; 2]) -> String {
    format!(
        "title = \"crossing\"\n[domain]\noutline = [[-1.6160254038, -0.7990381057], [4.4461524227, -4.2990381057], \
         [5.1961524227, -3.0], [1.7320508076, -1.0], [2.2320508076, -0.1339745962], [0.5, 0.8660254038], [0.0, 0.0], \
         [-0.8660254038, 0.5]]\n[mesh]\nsize = 0.5\norigin = [0.031, 0.017]\n[[joint]]\npoints = [[0.0, 0.0], \
         [1.7320508076, -1.0]]\n[[joint]]\npoints = [[1.3660254038, 0.3660254038], {end:?}]\n[joint_law.joint]\n\
         friction_deg = 35.0\n[rock.rock]\ndensity = 2650.0\nyoung = 10e9\npoisson = 0.25\n[[fix]]\nedge = \
         [[-1.6160254038, -0.7990381057], [4.4461524227, -4.2990381057]]\n[[monitor]]\nname = \"low\"\npoint = \
         [1.5490381057, -0.3169872981]\n[[monitor]]\nname = \"high\"\npoint = [0.6830127019, 0.1830127019]\n\
         [[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\nconvergence = 1e-6\n[[stage]]\nname = \
         \"slide\"\nkind = \"dynamic\"\nduration = 0.5\ndamping = 0.1\n[[stage.law]]\nlaw = \"joint\"\nfriction_deg = \
         20.0\n"
    )
}

/// Both blocks slide as one; 1 % for the bending of the joint's lips at the crossing, which takes up some shear.
#[test]
fn blocks_slide_over_crossings_and_mouths_of_joints() {
    let [sin, cos, tan] = [0.5, 0.75f64.sqrt(), 20f64.to_radians().tan()];
    for end in [[0.4660254038, -1.192820323], [0.0, -2.0]] {
        let mut simulation = simulation(&case(end));
        run_stage(&mut simulation);
        assert!(simulation.next_stage().expect("a stage"));
        let before = [0, 1].map(|k| simulation.monitor(k).0);
        let start = simulation.time();
        run_stage(&mut simulation);
        let time = simulation.time() - start;
        let exact = 0.5 * 9.81 * (sin - cos * tan) * time * time;
        for k in 0..2 {
            let moved = (simulation.monitor(k).0 - before[k]).norm();
            assert!((moved / exact - 1.0).abs() < 0.01, "block {k}, joint to {end:?}: {moved} beside {exact}");
        }
    }
}
