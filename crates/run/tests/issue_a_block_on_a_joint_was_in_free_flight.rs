//! Runs looked for the joint of a block that cannot rest after outputs had given back the buffers with the contacts.

use std::path::Path;

use enmm_io::parse_case;
use enmm_run::RunOptions;

/// A chip on a slope slides on its joint for as long as the stage goes on.
const CHIP: &str = r#"
title = "A chip that slides"
domain.outline = [[0, 0], [40, 0], [40, 0.5], [39, 0.5], [0, 20]]
domain.islands = [[[10, 15], [10.4, 14.8], [10.4, 15.2]]]
joint = [{ points = [[0, 0.3], [40, 0.3]] }]
mesh.size = 2
rock.granite = { density = 2650, young = 5e9, poisson = 0.25 }
joint_law.joints.friction_deg = 5
fix = [{ edge = [[0, 0], [40, 0]] }]
stage = [{ name = "rest", kind = "static", duration_max = 2 }]
output.pictures = false
"#;

#[test]
fn the_law_of_a_block_that_cannot_rest_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let loaded = parse_case(CHIP, "chip.toml", Path::new(".")).unwrap_or_else(|error| panic!("{error}"));
    let options = RunOptions { directory: directory.path().to_owned(), ..RunOptions::default() };
    let summary = enmm_run::run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    let named = summary.warnings.iter().find(|warning| warning.contains("is at rest but for block"));
    assert!(named.is_some_and(|warning| warning.contains("on a joint of law \"joints\"")), "{:?}", summary.warnings);
}
