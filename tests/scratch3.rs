//! scratch
mod common;
#[test]
fn deep() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    common::run_stage(&mut s);
    s.next_stage().unwrap();
    let mut found = 0;
    for _ in 0..4000 {
        let prev = s.scratch().contacts.clone();
        let places = s.scratch().place.clone();
        if let Err(e) = s.advance(false) { println!("{e}"); break; }
        let b = &s.slope().boundary;
        for c in s.scratch().contacts.iter().filter(|c| c.fresh && c.history.offset > 0.0) {
            found += 1;
            let pt = b.node_point[c.history.node as usize] as usize;
            let p = s.scratch().place[pt];
            println!("t {:.4} node {} at ({:.4},{:.4}) moved ({:.4},{:.4}) block {} -> block {} side {} edge {} offset {:.3e} n ({:.3},{:.3}) l {:.3}", s.time(), c.history.node, p.x, p.y, p.x-places[pt].x, p.y-places[pt].y, c.blocks[0], c.blocks[1], c.history.side, c.history.edge, c.history.offset, c.normal.x, c.normal.y, c.length);
            for q in prev.iter().filter(|q| q.blocks == c.blocks || (q.blocks[0]==c.blocks[1] && q.blocks[1]==c.blocks[0])) { println!("     before: node {} {:?} side {} N {:.3e} T {:.3e} gap {:.3e} {:?} n ({:.3},{:.3})", q.history.node, q.blocks, q.history.side, q.history.normal_force, q.history.shear_force, q.gap, q.history.state, q.normal.x, q.normal.y); }
            for (nm, pl) in [("prev", &places), ("now", &s.scratch().place)] { for bl in [c.blocks[0], c.blocks[1]] { print!("     {nm} block {bl}:"); for k in (0..b.node_count()).filter(|&k| b.block[b.node_point[k] as usize] == bl) { let q = pl[b.node_point[k] as usize]; print!(" {}:({:.3},{:.3})s{}", k, q.x, q.y, b.side[b.node_point[k] as usize]); } println!(); } }
        }
        if found > 12 { break; }
    }
}
