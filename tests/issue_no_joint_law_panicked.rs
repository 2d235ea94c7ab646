//! Claim: a case without any joint law, which only a continuum may be, runs. Its first step used to panic.

#[test]
fn a_continuum_without_joint_laws_runs() {
    let text = r#"
title = "continuum"
domain.outline = [[0, 0], [4, 0], [4, 1], [0, 1]]
mesh.size = 0.5
rock.any = { density = 2600, young = 1e8, poisson = 0.25 }
fix = [{ edge = [[0, 0], [4, 0]] }]
stage = [{ name = "fall", kind = "dynamic", duration = 0.1 }]
"#;
    let mut simulation = crate::common::simulation(text);
    crate::common::run_all(&mut simulation);
    let blocks = simulation.block_states();
    assert!(blocks.len() == 1 && blocks[0].detached, "{blocks:?}");
}
