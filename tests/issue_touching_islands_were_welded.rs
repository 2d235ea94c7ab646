//! An island that stands on the outline is a block of its own: the face that they share is a joint.

#[test]
fn a_block_on_a_base_stays_apart() {
    let simulation = crate::common::simulation(
        "title = \"touching\"\n[domain]\noutline = [[0, -1], [2, -1], [2, 0], [0, 0]]\n\
         islands = [[[0.5, 0], [1.5, 0], [1.5, 1], [0.5, 1]]]\n[mesh]\nsize = 0.6\n[rock.rock]\ndensity = 2500\n\
         young = 1e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 30\n[[fix]]\nedge = [[0, -1], [2, -1]]\n\
         [[stage]]\nname = \"rest\"\nkind = \"dynamic\"\nduration = 1\n",
    );
    assert_eq!(simulation.model().covers.block_count(), 2);
    assert!(simulation.built().warnings.is_empty(), "{:?}", simulation.built().warnings);
}
