//! scratch
mod common;
#[test]
fn track() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let blk: u32 = std::env::var("BLK").unwrap().parse().unwrap();
    let skip: u64 = std::env::var("SKIP").ok().map_or(0, |v| v.parse().unwrap());
    common::run_stage(&mut s);
    s.next_stage().unwrap();
    let c = &s.slope().covers;
    println!("block {blk} area {:.4e} centroid {:?} covers {} elements {} mass {:.3e} J {:.3e} JD {:.3e}", c.block_area(blk as usize), c.block_centroid(blk as usize).as_slice(), c.covers_of(blk as usize).len(), c.elements_of(blk as usize).len(), s.slope().metric.total[blk as usize], s.slope().metric.polar[blk as usize], s.slope().metric.polar_lumped[blk as usize]);
    for k in 0..14 + skip {
        let r = s.advance(true);
        if k < skip { continue; }
        println!("t {:.5} dt_last {:.2e} {:?}", s.time(), s.state().dt_last, r.map(|r| (r.unbalanced, r.speed_max)));
        let bd = &s.slope().boundary;
        print!("     block {blk}:"); for k in (0..bd.node_count()).filter(|&k| bd.block[bd.node_point[k] as usize] == blk) { let q = s.scratch().place[bd.node_point[k] as usize]; print!(" {}:({:.5},{:.5})s{}", k, q.x, q.y, bd.side[bd.node_point[k] as usize]); } println!();
        for i in s.slope().covers.covers_of(blk as usize) { print!(" v {:?}", s.state().velocity[i].as_slice()); } println!();
        for q in s.scratch().contacts.iter().filter(|q| q.blocks.contains(&blk)) { println!("    node {} {:?} side {} N {:.3e} T {:.3e} stored {:.3e} gap {:.3e} l {:.3e} kWdt2 {:.3e} app {:.3e},{:.3e} {:?} n ({:.3},{:.3}) off {:.2e} fresh {}", q.history.node, q.blocks, q.history.side, q.history.normal_force, q.history.shear_force, q.history.shear_stored, q.gap, q.length, q.compliance[0]*q.stiffness[0]*s.slope().dt.powi(2), q.approach[0], q.approach[1], q.history.state, q.normal.x, q.normal.y, q.history.offset, q.fresh); }
    }
}
