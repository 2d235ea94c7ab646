//! scratch
mod common;
#[test]
fn chatter() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let n: u64 = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(5000);
    for _ in 0..n {
        s.advance(false).unwrap();
    }
    for _ in 0..6 {
        s.advance(false).unwrap();
        let c = &s.slope().covers;
        let mut sp: Vec<(f64, usize)> = (0..c.block_count())
            .map(|b| (c.covers_of(b).map(|i| s.state().velocity[i].norm()).fold(0.0, f64::max), b))
            .collect();
        sp.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("t {:.4} top {:?}", s.time(), &sp[..5]);
        let mut cs: Vec<(f64, usize)> = s.state().velocity.iter().map(|v| v.norm()).zip(0..).collect();
        cs.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (v, i) in &cs[..4] {
            if *v > 1e-3 {
                println!(
                    "   cover {i} {v:.4} vel {:?} at {:?} mass {:.3e} rowsum {:.3e} sup {:?} con {:?}",
                    s.state().velocity[*i].as_slice(),
                    s.slope().covers.star_position[*i].as_slice(),
                    s.slope().metric.mass[*i],
                    s.slope().metric.row_sum[*i],
                    s.scratch()
                        .rows
                        .iter()
                        .filter(|r| s.slope().supports[r.support as usize].covers.contains(&(*i as u32)))
                        .map(|r| (r.support, r.force, r.displacement))
                        .collect::<Vec<_>>(),
                    s.scratch()
                        .contacts
                        .iter()
                        .filter(|c| c.covers.iter().flatten().any(|x| *x == *i as u32))
                        .map(|c| (
                            c.history.node,
                            c.blocks,
                            c.history.normal_force,
                            c.history.shear_force,
                            c.gap,
                            c.history.state
                        ))
                        .collect::<Vec<_>>()
                );
            }
        }
    }
}
