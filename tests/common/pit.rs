//! A pit in which neighbours clamp small blocks by many times their weight.

/// A pit in jointed rock, 70 m deep, with blocks of 0.24 and 0.17 m² between faces of the pits to come.
pub const PIT: &str = r#"
title = "Open pit before its excavation"
domain = { outline = [[-80, -70], [80, -70], [80, 0], [-80, 0]], joint_law = "joints" }
mesh.size = 3
cut = [
    { points = [[-30, 0], [-25, -15], [-17, -15], [-12, -30], [-4, -30], [1, -45], [80, -45]] },
    { points = [[-17, -15], [80, -15]] },
    { points = [[-4, -30], [80, -30]] },
]
joint_set = [
    { name = "F", dip_deg = 48, dips = "right", spacing = 8, seed = 1, region = [
        [-60, 0], [10, 0], [10, -55], [-60, -55],
    ] },
    { name = "K", dip_deg = 70, dips = "left", spacing = 10, seed = 2, region = [
        [-60, 0], [10, 0], [10, -55], [-60, -55],
    ] },
]
rock.diorite = { density = 2700, young = 40e9, poisson = 0.25 }
joint_law.joints = { friction_deg = 40, cohesion = 150e3 }
in_situ.k0 = 1.2
quiet = [{ edge = [[-80, -70], [80, -70]] }]
free_field = [
    { edge = [[-80, -70], [-80, 0]] },
    { edge = [[80, -70], [80, 0]] },
]
stage = [{ name = "in situ", kind = "static", duration_max = 2 }]
"#;
