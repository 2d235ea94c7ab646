//! Tries one trial.
use enmm::model::Simulation;
use enmm_verification::run_stage;
fn main() {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let (f, ramp, end): (f64, f64, f64) = (a[1].parse().unwrap(), a[2].parse().unwrap(), a[3].parse().unwrap());
    let text = std::fs::read_to_string(&a[0]).unwrap()
        + "[[stage]]\nname=\"x\"\nkind=\"dynamic\"\nduration=100.0\ndamping=DAMP\n";
    let text = text.replace("DAMP", &a[4]);
    let case = enmm::io::parse_case(&text, "x", std::path::Path::new(".")).unwrap().case;
    let mut s = Simulation::new(case).unwrap();
    run_stage(&mut s).unwrap();
    s.next_stage().unwrap();
    let start = s.time();
    let begin = s.state().displacement.clone();
    let d = s.drive();
    d.from.copy_from(&d.to);
    d.to.strength_factor = 1.0 / f;
    (d.since, d.until) = (start, start + ramp);
    if ramp == 0.0 {
        d.from.strength_factor = 1.0 / f;
    }
    let n = s.steps_in(0.1);
    while s.time() - start < end {
        let mut r = Default::default();
        for k in 1..=n {
            r = s.advance(k == n).unwrap();
        }
        let c = &s.slope().covers;
        let best = (0..c.cover_count())
            .max_by(|&i, &j| {
                (s.state().displacement[i] - begin[i]).norm().total_cmp(&(s.state().displacement[j] - begin[j]).norm())
            })
            .unwrap();
        println!(
            "t {:.2} K {:.3e} umax {:.3e} block {} at {:?} slip {} lock {} pen {:.1e} deep {} unsettled {} halved {}",
            s.time() - start,
            r.ledger.kinetic,
            (s.state().displacement[best] - begin[best]).norm(),
            c.cover_block[best],
            c.block_centroid(c.cover_block[best] as usize),
            r.slipping,
            r.locked,
            r.penetration_max,
            s.state().counters.deep_contacts,
            s.state().counters.unsettled,
            s.state().counters.halved
        );
    }
}
