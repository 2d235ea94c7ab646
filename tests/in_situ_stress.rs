//! Claim: rock under in-situ stress that its supports and joints balance stays where it is; excavation lets it move.

use crate::common::{run_stage, simulation};

/// A square cut by two crossing joints, held all round, under stress that does not vary; then one block goes.
fn case(stress: [f64; 3]) -> String {
    let [sxx, syy, sxy] = stress;
    let edges = ["[[0, 0], [4, 0]]", "[[4, 0], [4, 4]]", "[[4, 4], [0, 4]]", "[[0, 4], [0, 0]]"];
    let fixes: String = edges.iter().map(|e| format!("[[fix]]\nedge = {e}\n")).collect();
    format!(
        "title = \"in situ\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 4], [0, 4]]\n[mesh]\nsize = 0.7\nangle_deg = 9\n\
         [[joint]]\npoints = [[-1, 1.3], [5, 2.1]]\n[[joint]]\npoints = [[1.7, -1], [2.2, 5]]\n[rock.rock]\n\
         density = 2600\nyoung = 1e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 35\n[gravity]\ny = 0\n\
         [in_situ]\nsxx = {sxx:e}\nsyy = {syy:e}\nsxy = {sxy:e}\n{fixes}[[stage]]\nname = \"before\"\n\
         kind = \"dynamic\"\nduration = 0.05\n[[stage]]\nname = \"excavation\"\nkind = \"static\"\nduration = 1.0\n\
         excavate = [[3.5, 3.5]]\n[[monitor]]\nname = \"wall\"\npoint = [1.9, 3.0]\n"
    )
}

/// The traction of a uniform stress is balanced at every support, and at every joint up to the quadrature: contacts act
/// at nodes, while the rock's forces belong to pieces between mesh lines. 2 % of σh/E, the closure of one mesh size, is
/// allowed for that. Then the wall moves towards the opening, by some σL/E ≈ 4e-3 m.
#[test]
fn balanced_stress_is_at_rest_until_a_block_is_excavated() {
    for stress in [[-1e6, -2e6, 0.0], [-1.5e6, -1e6, 2e5]] {
        let mut simulation = simulation(&case(stress));
        run_stage(&mut simulation);
        let still = simulation.monitor(0).0.norm();
        assert!(still < 0.02 * 2e6 * 0.7 / 1e9, "{still} m before");
        assert!(simulation.next_stage().unwrap_or_else(|e| panic!("{e}")));
        let report = run_stage(&mut simulation);
        let moved = simulation.monitor(0).0;
        println!("{stress:?}: {moved} {report:?}");
        assert!(moved.x > 2e-4 && moved.x < 1e-2, "{moved}");
        assert!(simulation.at_rest(&report), "{report:?}");
    }
}
