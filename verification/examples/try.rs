//! Throw-away runner: try ID [quick] [name=value …].
use enmm_verification::*;
fn main() {
    let mut args = std::env::args().skip(1);
    let id = args.next().unwrap();
    let problem = problems::ALL.iter().find(|p| p.id == id).unwrap();
    let mut values = Values::of(problem);
    let mut quick = false;
    for a in args {
        if a == "quick" {
            quick = true;
            continue;
        }
        let (n, v) = a.split_once('=').unwrap();
        values.set(problem, n, v.parse().unwrap()).unwrap_or_else(|e| panic!("{e:?}"));
    }
    let mut setup = Setup { values, integrator: Default::default(), quick, cases: vec![] };
    let clock = std::time::Instant::now();
    let outcome = (problem.run)(&mut setup).unwrap_or_else(|e| panic!("{e:?}"));
    for r in &outcome.rows {
        println!(
            "{} {:70} {:>13.6e} {:>13.6e} err {:+.2e} {:?}",
            if r.passes() { "ok  " } else { "FAIL" },
            r.quantity,
            r.computed,
            r.exact,
            r.error(),
            r.tolerance
        );
    }
    println!("{:.1} s, plots {}", clock.elapsed().as_secs_f64(), outcome.plots.len());
}
