//! Claim: lengths of the contacts of two faces add up to the length that the faces share, however their nodes lie: what
//! cohesion and a joint's own stiffness act on.

use crate::common::parts::rock;
use crate::common::{run_stage, simulation};

/// A block of 1 m that has settled on a base from `left` to `right`: the sum of the lengths of its contacts (m).
fn length(left: f64, right: f64, size: f64) -> f64 {
    let mut simulation = simulation(&format!(
        "title = \"contact\"\n[domain]\noutline = [[{left:?}, -1.0], [{right:?}, -1.0], [{right:?}, 0.0], \
        [{left:?}, 0.0]]\n\
         islands = [[[0.0, 0.0001], [1.0, 0.0001], [1.0, 1.0001], [0.0, 1.0001]]]\n[mesh]\nsize = {size}\n\
         origin = [0.03, 0.02]\n[joint_law.joint]\nfriction_deg = 0.0\nnormal_stiffness = 1e9\n[[fix]]\n\
         block = [{:?}, -0.9]\n{}[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 10.0\nconvergence \
         = 1e-6\n",
        left + 0.01,
        rock(5e9, 2500.0)
    ));
    run_stage(&mut simulation);
    simulation.workspace().contacts.iter().map(|c| c.length).sum()
}

/// The lengths of theory Eq. (13) add up exactly, also where corners meet nodes of the other face and where a corner is
/// hardly beyond one. A least length of 1e-3 of a node segment is left to each contact: 2e-3 for the two corners, and
/// the faces bend by 1e-5.
#[test]
fn contact_lengths_add_up() {
    let bases = [(-1.0, 2.0), (-1.03, 2.07), (-0.5, 1.5), (0.0, 1.0), (-1.0, 2.000001), (-1.000001, 2.0), (-0.96, 2.0)];
    for (left, right) in bases {
        for size in [1.1, 0.5, 0.3] {
            let found = length(left, right, size);
            assert!((found - 1.0).abs() < 2e-3, "base {left} to {right}, h = {size}: {found} m of contact");
        }
    }
}
