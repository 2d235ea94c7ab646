//! scratch
mod common;
#[test]
fn chatter() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let n: u64 = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(4000);
    for _ in 0..n { s.advance(false).unwrap(); }
    for _ in 0..5 {
        s.advance(false).unwrap();
        let c = &s.slope().covers;
        let mut sp: Vec<(f64, usize)> = (0..c.block_count()).map(|b| (c.covers_of(b).map(|i| s.state().velocity[i].norm()).fold(0.0, f64::max), b)).collect();
        sp.sort_by(|a,b| b.0.total_cmp(&a.0));
        println!("t {:.4} top {:?}", s.time(), &sp[..5]);
        let b = sp[0].1;
        println!("  block {b} area {:.4} centroid {:?} covers {} elements {}", c.block_area(b), c.block_centroid(b).as_slice(), c.covers_of(b).len(), c.elements_of(b).len());
        for q in s.scratch().contacts.iter().filter(|q| q.blocks.contains(&(b as u32))).take(40) { println!("    node {} {:?} side {} N {:.3e} T {:.3e} stored {:.3e} gap {:.3e} l {:.3e} kWdt2 {:.3e} app {:.3e},{:.3e} {:?} n ({:.3},{:.3}) fresh {}", q.history.node, q.blocks, q.history.side, q.history.normal_force, q.history.shear_force, q.history.shear_stored, q.gap, q.length, q.compliance[0]*q.stiffness[0]*s.slope().dt.powi(2), q.approach[0],q.approach[1], q.history.state, q.normal.x, q.normal.y, q.fresh); }
        let bd = &s.slope().boundary;
        print!("     block {b}:"); for k in (0..bd.node_count()).filter(|&k| bd.block[bd.node_point[k] as usize] == b as u32).take(30) { let q = s.scratch().place[bd.node_point[k] as usize]; print!(" {}:({:.4},{:.4})s{}", k, q.x, q.y, bd.side[bd.node_point[k] as usize]); } println!();
    }
}
