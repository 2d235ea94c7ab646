//! probe
use super::parts::{points, rectangle};
use super::rigid::World;
use enmm_patch::{Hardening, Rule, Vector};
#[test]
fn probe() {
    for corner in [0.0, 0.5] {
        for dip in [20.0f64, 36.0, 60.0, 90.0, 120.0, 150.0] {
            let mut line = String::new();
            for x in [-0.06, -0.02, -0.01, -0.001, 0.001, 0.01, 0.02, 0.06] {
                let mut e = vec![];
                for crack in [false, true] {
                    let mut world = World::new(1.0, 0.0, 2e-4, 0.0);
                    world.rule = Rule { reach: 0.2, beside: 0.2, ledge: 1e-3, corner, ..Rule::default() };
                    world.hardening = Hardening { depth: 0.003 };
                    if crack {
                        let foot = -4.0 / dip.to_radians().tan();
                        world.add(&points(&[[-18.0, -4.0], [foot, -4.0], [0.0, 0.0], [-18.0, 0.0]]), 2650.0, true);
                        world.add(&points(&[[foot, -4.0], [16.0, -4.0], [16.0, 0.0], [0.0, 0.0]]), 2650.0, true);
                    } else {
                        world.add(&rectangle([-18.0, -4.0], [16.0, 0.0]), 2650.0, true);
                    }
                    let half = 2f64.sqrt();
                    let square =
                        points(&[[x, -0.02], [x + half, half - 0.02], [x, 2.0 * half - 0.02], [x - half, half - 0.02]]);
                    let b = world.add(&square, 2650.0, false);
                    world.find(0.0);
                    let f = world.contacts.rows.iter().fold(Vector::default(), |sum, row| {
                        sum + row.normal * (if row.key.viewer == b { 1.0 } else { -1.0 } * row.weight * row.closure)
                    });
                    e.push((world.contacts.energy, f));
                }
                line += &format!(
                    " {x}: E {:.4} Fx {:.4} Fy {:.4};",
                    e[1].0 / e[0].0,
                    e[1].1.x / e[0].1.y,
                    e[1].1.y / e[0].1.y
                );
            }
            println!("corner {corner} dip {dip}:{line}");
        }
    }
}
