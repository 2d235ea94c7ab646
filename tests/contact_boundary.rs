//! Claim: corners, nodes and sides of the boundary are those of the drawing, whatever the constants that find them.

use enmm::model::tables::{Boundary, DetectionRule};
use enmm::model::{Simulation, assemble::outlines};

use crate::common::{case, example};

/// Half or twice any of them: on example cases the same boundary points end sides, and as many are nodes. They are the
/// same ones, but `node_snap` moves those between corners by as much as it says.
#[test]
fn no_angle_decides_what_a_corner_is() {
    type Constant = fn(&mut DetectionRule) -> &mut f64;
    let constants: [(&str, Constant); 4] = [
        ("corner_angle", |rule| &mut rule.corner_angle),
        ("kink_angle", |rule| &mut rule.kink_angle),
        ("side_turn", |rule| &mut rule.side_turn),
        ("node_snap", |rule| &mut rule.node_snap),
    ];
    for name in ["block_on_incline", "goodman_bray", "masonry_wall", "plane_slide", "road_cut", "toppling"] {
        let case = case(&example(name));
        let outlines = outlines(&case).unwrap_or_else(|e| panic!("{e}"));
        let simulation = Simulation::new(case).unwrap_or_else(|e| panic!("{e}"));
        let covers = &simulation.model().covers;
        let usual = Boundary::new(covers, &outlines, &DetectionRule::default());
        assert_eq!(usual.nodes.point, simulation.model().boundary.nodes.point, "{name}");
        for (constant, of) in constants {
            for factor in [0.5, 2.0] {
                let mut rule = DetectionRule::default();
                *of(&mut rule) *= factor;
                let other = Boundary::new(covers, &outlines, &rule);
                assert_eq!(other.sides.previous, usual.sides.previous, "{name}: sides with {factor} {constant}");
                assert_eq!(other.node_count(), usual.node_count(), "{name}: nodes with {factor} {constant}");
                let place = |boundary: &Boundary, node: usize| boundary.reference[boundary.nodes.point[node]];
                let moved = (0..usual.node_count()).map(|k| (place(&other, k) - place(&usual, k)).norm());
                let most = if constant == "node_snap" { rule.node_snap.max(0.1) * covers.mesh.size } else { 0.0 };
                assert!(moved.fold(0.0, f64::max) <= most, "{name}: nodes with {factor} {constant}");
            }
        }
    }
}
