//! scratch
mod common;
use common::*;

#[test]
fn incline() {
    for (young, phi, h) in [
        ("50e6", 20.0, 0.5),
        ("1e9", 25.0, 0.3),
        ("10e9", 25.0, 0.3),
        ("10e9", 10.0, 0.3),
        ("10e9", 25.0, 0.5),
        ("1e9", 25.0, 1.0),
        ("10e9", 25.0, 1.0),
    ] {
        let w = 2500.0 * 9.81 * 2.0 * 1.0;
        let a = 30f64.to_radians();
        let fh = w * (a.sin() - a.cos() * (phi as f64).to_radians().tan());
        let _ = fh;
        let at = |u: f64, v: f64| (u * a.cos() - v * a.sin(), u * a.sin() + v * a.cos());
        let ytop = 20.0 * a.tan();
        let ((x4, y4), (x1, y1), (x2, y2), (x3, y3)) = (at(8.0, 0.0), at(10.0, 0.0), at(10.0, 1.0), at(8.0, 1.0));
        let text = format!(
            r#"
title = "incline"
[domain]
outline = [[0,0],[20,0],[20,{ytop}],[{x1},{y1}],[{x2},{y2}],[{x3},{y3}],[{x4},{y4}]]
joint_law = "j"
[[joint]]
points = [[0,0],[20,{ytop}]]
[mesh]
size = {h}
angle_deg = 0
[rock.r]
density = 2500
young = {young}
poisson = 0.25
[joint_law.j]
friction_deg = 45
[[fix]]
block = [18, 1]
[[stage]]
name = "settle"
kind = "static"

duration = 1.0
[[stage]]
name = "slide"
kind = "dynamic"
duration = 1.0
[[stage.law]]
law = "j"
friction_deg = {phi}
[[monitor]]
name = "m"
point = [7.7, 5.0]
"#
        );
        let mut s = simulation(&text);
        println!(
            "blocks {} elements {} covers {} dt {}",
            s.slope().covers.block_count(),
            s.slope().covers.element_count(),
            s.slope().covers.cover_count(),
            s.slope().dt
        );
        let r = run_stage(&mut s);
        println!(
            "settled at t={} unb {:.2e} kin {:.2e} pot {:.3e} pen {:.2e} contacts {}",
            r.time,
            r.unbalanced,
            r.ledger.kinetic,
            r.ledger.potential,
            r.penetration_max,
            s.state().contacts.len()
        );
        for c in s.scratch().contacts.iter() {
            println!(
                "  node {} side {} N {:.1} T {:.1} l {:.4} gap {:.2e} {:?}",
                c.history.node,
                c.history.side,
                c.history.normal_force,
                c.history.shear_force,
                c.length,
                c.gap,
                c.history.state
            );
        }
        let (u0, _) = s.monitor(0);
        s.next_stage().unwrap();
        let t0 = s.time();
        let a = 30f64.to_radians();
        let f: f64 = phi;
        let acc = 9.81 * (a.sin() - a.cos() * f.to_radians().tan());
        for k in 1..=10 {
            while s.time() - t0 < 0.1 * k as f64 - 1e-9 {
                s.advance(false).unwrap();
            }
            let (u1, v1) = s.monitor(0);
            let t = s.time() - t0;
            let fall: f64 = s.scratch().contacts.iter().map(|c| c.history.normal_force).sum();
            println!(
                "  t {:.3} err {:.3e} verr {:.3e} N {:.4}",
                t,
                (u1 - u0).norm() - 0.5 * acc * t * t,
                v1.norm() - acc * (t - 0.5 * s.slope().dt),
                fall
            );
        }
        let r = s.advance(true).unwrap();
        let (u1, _) = s.monitor(0);
        let t = s.time() - t0;
        let exact = 0.5 * acc * t * t;
        println!(
            "slid {:.8} exact {:.8} rel {:.2e}  residual {:.2e} of {:.2e} fric {:.3e} sweeps {} / {} unsettled {} halved {}",
            (u1 - u0).norm(),
            exact,
            (u1 - u0).norm() / exact - 1.0,
            r.ledger.residual(),
            r.ledger.largest(),
            r.ledger.friction,
            s.state().counters.sweeps,
            s.state().counters.substeps,
            s.state().counters.unsettled,
            s.state().counters.halved
        );
        println!("{:?}", r.ledger);
    }
}
