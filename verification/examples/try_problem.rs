use enmm_verification::{Setup, Values, problems::ALL};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    if a[1] == "compare" {
        let c = enmm_verification::comparison::compare(a[2] == "quick").unwrap();
        println!("{}", c.markdown(&[]));
        return;
    }
    let p = ALL.iter().find(|p| p.id == a[1]).unwrap();
    let mut values = Values::of(p);
    for s in &a[4..] { let (k, v) = s.split_once('=').unwrap(); values.set(p, k, v.parse().unwrap()).unwrap(); }
    let integrator = if a[2] == "implicit" { enmm::model::case::Integrator::Implicit } else { Default::default() };
    let mut setup = Setup { values, integrator, quick: a[3] == "quick", cases: vec![] };
    let t = std::time::Instant::now();
    match (p.run)(&mut setup) {
        Ok(o) => for r in &o.rows { println!("{} {:70} {:.6e} exact {:.6e} err {:.2e} {:?}", if r.passes() {"ok  "} else {"MISS"}, r.quantity, r.computed, r.exact, r.error(), r.tolerance); },
        Err(e) => println!("ERR {}", e.0),
    }
    println!("{} {} {} {:.2} s", a[1], a[2], a[3], t.elapsed().as_secs_f64());
}
