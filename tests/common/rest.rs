//! A block on a base, for tests of what is shown of it.

/// A block of 1 m × 1 m on a held base of 6 m × 1 m, with the keys of a stage and more tables.
pub fn rest(stage: &str, more: &str) -> String {
    format!(
        r#"
title = "rest"
domain.outline = [[0, 0], [6, 0], [6, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]]
domain.joint_law = "plane"
mesh = {{ size = 0.3, origin = [0.07, 0.03] }}
joint = [{{ points = [[1, 1], [2, 1]] }}]
rock.granite = {{ density = 2600, young = 1e9, poisson = 0.25 }}
joint_law.plane.friction_deg = 20
fix = [{{ block = [3, 0.5] }}]
{more}
[[stage]]
name = "one"
{stage}
"#
    )
}

/// Tables by which the block flies off and spins, without gravity.
pub const FLIGHT: &str = r#"
initial_velocity = [{ block = [1.5, 1.5], velocity = [0.5, 2.0], angular_velocity = 1.5 }]
gravity.y = 0
"#;
