//! scratch
mod common;
#[test]
fn chatter() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let n: u64 = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(4000);
    for _ in 0..n { s.advance(false).unwrap(); }
    for _ in 0..12 {
        let prev = s.scratch().contacts.clone();
        s.advance(false).unwrap();
        let mut lines = vec![];
        for q in s.scratch().contacts.iter() {
            let old = prev.iter().find(|p| p.history.node == q.history.node && p.history.side == q.history.side);
            let o = old.map_or(0.0, |o| o.history.normal_force);
            let d = (q.history.normal_force - o).abs();
            lines.push((d, format!("    d {d:.2e} node {} {:?} side {} edge {} N {o:.3e} -> {:.3e} T {:.3e} gap {:.3e} <- {:.3e} l {:.3e} <- {:.3e} kWdt2 {:.3e} app {:.2e} {:?} n ({:.3},{:.3}) fresh {}", q.history.node, q.blocks, q.history.side, q.history.edge, q.history.normal_force, q.history.shear_force, q.gap, old.map_or(9.0, |o| o.gap), q.length, old.map_or(0.0,|o|o.length), q.compliance[0]*q.stiffness[0]*s.slope().dt.powi(2), q.approach[0], q.history.state, q.normal.x, q.normal.y, q.fresh)));
        }
        for p in prev.iter().filter(|p| !s.scratch().contacts.iter().any(|q| p.history.node == q.history.node && p.history.side == q.history.side)) { lines.push((p.history.normal_force.abs(), format!("    gone node {} {:?} side {} N {:.3e} gap {:.3e} l {:.2e}", p.history.node, p.blocks, p.history.side, p.history.normal_force, p.gap, p.length))); }
        lines.sort_by(|a,b| b.0.total_cmp(&a.0));
        println!("t {:.4}", s.time());
        for l in &lines[..4] { println!("{}", l.1); }
    }
}
