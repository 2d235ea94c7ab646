//! `check` gives the default stiffness of joints, the same on all meshes, unless every law has its own.

use std::path::Path;

use enmm::model::Simulation;
use enmm_io::parse_case;

/// What `check` says of two blocks on a mesh of some size (m), with further keys of their joint law.
fn default_stiffness(size: f64, more: &str) -> Option<f64> {
    let case = format!(
        "title = \"column\"\n[domain]\noutline = [[0, 0], [8, 0], [8, 8], [0, 8]]\n[mesh]\nsize = {size}\n\
         [[joint]]\npoints = [[0, 4], [8, 4]]\n[rock.rock]\ndensity = 2500\nyoung = 1e9\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 35\n{more}\n[[fix]]\nedge = [[0, 0], [8, 0]]\n\
         [[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 1.0\n"
    );
    let loaded = parse_case(&case, "column.toml", Path::new(".")).unwrap_or_else(|error| panic!("{error}"));
    let simulation = Simulation::new(loaded.case).unwrap_or_else(|error| panic!("{error:?}"));
    enmm_run::check(&simulation, &[]).default_stiffness
}

#[test]
fn a_check_gives_the_default_stiffness_of_joints() {
    // 0.6 (λ + 2μ) per metre.
    for size in [0.5, 1.0, 4.0] {
        for more in ["", "dilation_deg = 5"] {
            let found = default_stiffness(size, more).expect("a default");
            assert!((found / (0.6 * 1.2e9) - 1.0).abs() < 1e-12, "{size}: {more}");
        }
    }
    assert_eq!(default_stiffness(4.0, "normal_stiffness = 1e9"), None);
}
