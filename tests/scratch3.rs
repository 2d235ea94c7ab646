//! scratch
mod common;
use enmm::geometry::{Point, polygon};
#[test]
fn deep() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    common::run_stage(&mut s);
    s.next_stage().unwrap();
    let mut found = 0;
    let mut hist: std::collections::VecDeque<enmm::state::State> = Default::default();
    for _ in 0..4000 {
        hist.push_back(s.state().clone());
        if hist.len() > 60 { hist.pop_front(); }
        if let Err(e) = s.advance(false) { println!("{e}"); break; }
        let fresh: Vec<_> = s.scratch().contacts.iter().filter(|c| c.fresh && c.history.offset > 0.05).copied().collect();
        for c in fresh {
            found += 1;
            let now = s.state().clone();
            let t = s.time();
            let b = s.slope().boundary.clone();
            println!("=== t {:.4} node {} blocks {:?} side {} edge {} offset {:.3e} n ({:.3},{:.3}) l {:.3}", t, c.history.node, c.blocks, c.history.side, c.history.edge, c.history.offset, c.normal.x, c.normal.y, c.length);
            let pt = b.node_point[c.history.node as usize] as usize;
            let mut shown = 0;
            for st in hist.iter().step_by(12).chain(hist.iter().rev().take(2)) {
                s.restore(st.clone());
                if s.advance(false).is_err() { continue; }
                let sc = s.scratch();
                let p = sc.place[pt];
                let poly = |bl: u32| -> Vec<Point> { (0..b.len()).filter(|&k| b.block[k] == bl).map(|k| sc.place[k]).collect() };
                let small = c.blocks.iter().all(|&bl| poly(bl).len() < 60);
                let d = if small { polygon::overlap_depth(&poly(c.blocks[0]), &poly(c.blocks[1])) } else { -1.0 };
                println!("  t {:.4} p ({:.4},{:.4}) overlap {d:.2e}", s.time(), p.x, p.y);
                for q in sc.contacts.iter().filter(|q| (q.blocks == c.blocks) || (q.blocks[0]==c.blocks[1] && q.blocks[1]==c.blocks[0])) { println!("     node {} {:?} side {} N {:.2e} gap {:.2e} l {:.2e} {:?} n ({:.2},{:.2})", q.history.node, q.blocks, q.history.side, q.history.normal_force, q.gap, q.length, q.history.state, q.normal.x, q.normal.y); }
                shown += 1;
                if shown == 1 || shown > 4 { for bl in c.blocks { print!("     block {bl}:"); for k in (0..b.len()).filter(|&k| b.block[k] == bl) { let q = sc.place[k]; if (q-p).norm() < 1.2 { print!(" {}:({:.4},{:.4})s{}", k, q.x, q.y, b.side[k]); } } println!(); } }
            }
            s.restore(now);
        }
        if found > 1 { break; }
    }
}
