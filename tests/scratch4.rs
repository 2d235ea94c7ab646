//! scratch
mod common;
#[test]
fn track() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let blk: u32 = std::env::var("BLK").unwrap().parse().unwrap();
    let oth: u32 = std::env::var("OTH").unwrap().parse().unwrap();
    let every: u64 = std::env::var("EVERY").unwrap().parse().unwrap();
    let n: u64 = std::env::var("N").unwrap().parse().unwrap();
    common::run_stage(&mut s);
    s.next_stage().unwrap();
    for k in 0..n {
        s.advance(false).unwrap();
        let bd = &s.slope().boundary;
        let poly = |b: u32| -> Vec<enmm::geometry::Point> { (0..bd.len()).filter(|&k| bd.block[k] == b).map(|k| s.scratch().place[k]).collect() };
        let depth = enmm::geometry::polygon::overlap_depth(&poly(blk), &poly(oth));
        if k % every != 0 { continue; }
        println!("t {:.5} overlap {depth:.3e}", s.time());
        if std::env::var("NEAR").is_ok() { let c = s.scratch().place[bd.node_point[(0..bd.node_count()).find(|&k| bd.block[bd.node_point[k] as usize] == blk).unwrap()] as usize]; for k in (0..bd.len()).filter(|&k| bd.block[k] == oth && (s.scratch().place[k]-c).norm() < 3.5) { let q = s.scratch().place[k]; println!("      edge {k} side {} ({:.4},{:.4}) corner {:?} partial {} node_before {}", bd.side[k], q.x, q.y, bd.side_corner[bd.side[k] as usize], bd.partial[k], bd.node_before[k]); } }
        for b in [blk, oth] { print!("     block {b}:"); for k in (0..bd.node_count()).filter(|&k| bd.block[bd.node_point[k] as usize] == b) { let q = s.scratch().place[bd.node_point[k] as usize]; print!(" {}:({:.5},{:.5})s{}", k, q.x, q.y, bd.side[bd.node_point[k] as usize]); } println!(); }
        for q in s.scratch().contacts.iter().filter(|q| q.blocks.contains(&blk)) { println!("    node {} {:?} side {} N {:.3e} T {:.3e} gap {:.3e} l {:.3e} {:?} n ({:.3},{:.3}) off {:.2e} fresh {}", q.history.node, q.blocks, q.history.side, q.history.normal_force, q.history.shear_force, q.gap, q.length, q.history.state, q.normal.x, q.normal.y, q.history.offset, q.fresh); }
    }
}
