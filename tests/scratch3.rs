//! scratch
mod common;
#[test]
fn deep() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let mut found = 0;
    let n: u64 = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(600);
    for _ in 0..n {
        let prev = s.scratch().contacts.clone();
        if let Err(e) = s.advance(false) { println!("{e}"); break; }
        let b = &s.slope().boundary;
        for c in s.scratch().contacts.iter().filter(|c| c.fresh && c.history.offset > 0.0) {
            found += 1;
            let p = s.scratch().place[b.node_point[c.history.node as usize] as usize];
            println!("t {:.4} node {} at ({:.4},{:.4}) block {} -> block {} side {} edge {} offset {:.3e} n ({:.3},{:.3}) l {:.3}", s.time(), c.history.node, p.x, p.y, c.blocks[0], c.blocks[1], c.history.side, c.history.edge, c.history.offset, c.normal.x, c.normal.y, c.length);
            for q in prev.iter().filter(|q| q.history.node == c.history.node) { println!("     before: block {} side {} N {:.3e} T {:.3e} gap {:.3e} {:?} n ({:.3},{:.3})", q.blocks[1], q.history.side, q.history.normal_force, q.history.shear_force, q.gap, q.history.state, q.normal.x, q.normal.y); }
            for q in s.scratch().contacts.iter().filter(|q| q.history.node == c.history.node) { println!("     now: block {} side {} N {:.3e} T {:.3e} gap {:.3e} {:?} n ({:.3},{:.3})", q.blocks[1], q.history.side, q.history.normal_force, q.history.shear_force, q.gap, q.history.state, q.normal.x, q.normal.y); }
            for bl in [c.blocks[0], c.blocks[1]] { print!("     block {bl}:"); for k in (0..b.node_count()).filter(|&k| b.block[b.node_point[k] as usize] == bl) { let q = s.scratch().place[b.node_point[k] as usize]; print!(" {}:({:.3},{:.3})s{}", k, q.x, q.y, b.side[b.node_point[k] as usize]); } println!(); }
        }
        if found > 8 { break; }
    }
}
