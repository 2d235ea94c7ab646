//! Tries one problem.
use enmm_verification::{Setup, Values, problems};
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let problem = problems::ALL.iter().find(|p| p.id == arguments[0]).unwrap();
    let mut values = Values::of(problem);
    let mut quick = false;
    for a in &arguments[1..] {
        if a == "quick" {
            quick = true;
            continue;
        }
        let (n, v) = a.split_once('=').unwrap();
        values.set(problem, n, v.parse().unwrap()).unwrap();
    }
    let mut setup = Setup { values, integrator: Default::default(), quick, cases: Vec::new() };
    let clock = std::time::Instant::now();
    match (problem.run)(&mut setup) {
        Ok(o) => {
            for r in &o.rows {
                println!(
                    "{} {:60} {:>14.6} {:>14.6} {:>10.2e} {:?}",
                    if r.passes() { "ok  " } else { "MISS" },
                    r.quantity,
                    r.computed,
                    r.exact,
                    r.error(),
                    r.tolerance
                );
            }
            if std::env::var("CURVE").is_ok() {
                for p in &o.plots {
                    for s in &p.series {
                        println!("{} {}", p.title, s.name);
                        for q in s.points.iter().step_by(8) {
                            println!("  {:?}", q);
                        }
                    }
                }
            }
        }
        Err(e) => println!("{e:?}"),
    }
    println!("{:.1} s", clock.elapsed().as_secs_f64());
    if std::env::var("CASES").is_ok() {
        for (n, t) in &setup.cases {
            std::fs::write(format!("/tmp/fos_{n}.toml"), t).unwrap();
        }
    }
}
