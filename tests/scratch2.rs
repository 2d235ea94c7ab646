//! scratch
mod common;
#[test]
fn slope() {
    let path = std::env::var("CASE").unwrap_or("examples/cases/fractured_slope.toml".into());
    let loaded = enmm::io::load_case(std::path::Path::new(&path)).unwrap_or_else(|e| panic!("{e}"));
    let t0 = std::time::Instant::now();
    let mut s = enmm::model::Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    println!(
        "built {:.2}s blocks {} elements {} covers {} nodes {} edges {} dt {:.3e} critical {:.3e} warnings {:?}",
        t0.elapsed().as_secs_f64(),
        s.slope().covers.block_count(),
        s.slope().covers.element_count(),
        s.slope().covers.cover_count(),
        s.slope().boundary.node_count(),
        s.slope().boundary.len(),
        s.slope().dt,
        s.slope().critical_dt,
        s.built().warnings
    );
    let every: u64 = std::env::var("EVERY").ok().and_then(|v| v.parse().ok()).unwrap_or(500);
    loop {
        println!("stage {}", s.stage().name);
        let mut last = None;
        let mut k = 0;
        while !s.stage_is_over(last.as_ref()) {
            match s.advance(k % 20 == 0 || k % every == 0) {
                Ok(r) => {
                    if k % every == 0 {
                        println!(
                            "t {:.4} unb {:.2e} kin {:.3e} pot {:.3e} strain {:.3e} pen {:.2e} lock {} slip {} vmax {:.3} res {:.2e}/{:.2e} contacts {} cand {} sub {} sweeps/sub {:.2} unsettled {} halved {} deep {} ({:.2e})",
                            r.time,
                            r.unbalanced,
                            r.ledger.kinetic,
                            r.ledger.potential,
                            r.ledger.strain,
                            r.penetration_max,
                            r.locked,
                            r.slipping,
                            r.speed_max,
                            r.ledger.residual(),
                            r.ledger.largest(),
                            s.state().contacts.len(),
                            s.scratch().search.candidates.len(),
                            s.state().counters.substeps,
                            s.state().counters.sweeps as f64 / s.state().counters.substeps as f64,
                            s.state().counters.unsettled,
                            s.state().counters.halved,
                            s.state().counters.deep_contacts,
                            s.state().counters.deepest_contact
                        );
                        if s.stage().kind == enmm::model::case::StageKind::Dynamic {
                            let l = r.ledger;
                            println!(
                                "    fric {:.3e} contact diss {:.3e} damp {:.3e} ext {:.3e}",
                                l.friction,
                                l.contact_dissipation(),
                                l.damping,
                                l.external_work
                            );
                        }
                    }
                    if r.dt > 0.0 {
                        last = Some(r);
                    }
                }
                Err(e) => {
                    println!("FAILED {e}");
                    for c in s.scratch().contacts.iter().filter(|c| c.penetration > 0.5 * s.slope().penetration_limit) {
                        println!("{c:?}");
                    }
                    return;
                }
            }
            k += 1;
        }
        println!(
            "end t {:.4} wall {:.1} seconds {:?} judged {:.3e} M/s {:.1} searches {}",
            s.time(),
            t0.elapsed().as_secs_f64(),
            s.scratch().seconds,
            s.state().counters.judged as f64,
            s.state().counters.judged as f64 / s.scratch().seconds.sweep / 1e6,
            s.state().counters.searches
        );
        if let Some(r) = last {
            println!(
                "  unb {:.2e} kin {:.2e} pot {:.3e} stored {:.3e} pen {:.2e} counters {:?}",
                r.unbalanced,
                r.ledger.kinetic,
                r.ledger.potential,
                r.ledger.stored,
                r.penetration_max,
                s.state().counters
            );
        }
        if !s.next_stage().unwrap() {
            break;
        }
    }
}
