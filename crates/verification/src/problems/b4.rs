//! B4: stresses about a round hole in an elastic plate.

use enmm::geometry::Point;
use enmm::model::{Simulation, StepReport};

use super::continuum::{QuarterPlate, cartesian, order, polar, stress_at, stress_error};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble, run_all};

pub const PROBLEM: Problem = Problem {
    id: "B4",
    title: "Round hole under in-situ stress (Kirsch)",
    source: "G. Kirsch (1898): stresses about a round hole in an infinite elastic plate under p vertically and K0·p \
             horizontally; catches wrong in-situ stress, wrong free surfaces and wrong stress of cut elements",
    parameters: &[
        Parameter::new("p", "Pa", 10e6, [1e3, 1e8], "vertical stress, compression"),
        Parameter::new("k0", "", 0.5, [0.0, 3.0], "horizontal over vertical stress"),
        Parameter::new("radius", "m", 1.0, [0.1, 20.0], "radius of the hole"),
        Parameter::new("domain", "", 10.0, [4.0, 12.0], "half domain over radius"),
        Parameter::new("mesh", "", 0.1, [0.07, 0.2], "mesh size over radius"),
        Parameter::new("young", "Pa", 5e10, [1e9, 1e12], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.4], "Poisson's ratio"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Radii over that of the hole at which stresses are compared.
const RADII: [f64; 4] = [1.0, 1.5, 2.0, 3.0];
/// Radii over that of the hole within which the error of the elements is measured.
const NEAR: f64 = 3.0;

/// Radial, hoop and shear stress (Pa, compression positive) about a hole of radius 1 under 1 vertically and `k0`
/// horizontally, at radius `r` and `angle` from the horizontal (rad).
fn kirsch(k0: f64, r: f64, angle: f64) -> [f64; 3] {
    let a = 1.0 / (r * r);
    let (s, c) = (2.0 * angle).sin_cos();
    [
        0.5 * ((1.0 + k0) * (1.0 - a) - (1.0 - k0) * (1.0 - 4.0 * a + 3.0 * a * a) * c),
        0.5 * ((1.0 + k0) * (1.0 + a) + (1.0 - k0) * (1.0 + 3.0 * a * a) * c),
        0.5 * (1.0 - k0) * (1.0 + 2.0 * a - 3.0 * a * a) * s,
    ]
}

/// One stress field and mesh.
struct Model {
    p: f64,
    k0: f64,
    plate: QuarterPlate,
}

impl Model {
    fn new(setup: &Setup, k0: f64, mesh: f64) -> Self {
        let (radius, domain) = (setup.get("radius"), setup.get("domain"));
        let half = if setup.quick { domain.min(5.0) } else { domain } * radius;
        Self { p: setup.get("p"), k0, plate: QuarterPlate { radius, half, mesh: mesh * radius } }
    }

    /// Exact stress xx, yy, xy (Pa, tension positive).
    fn exact(&self, at: Point) -> [f64; 3] {
        let stress = kirsch(self.k0, at.norm() / self.plate.radius, at.y.atan2(at.x)).map(|s| -self.p * s);
        cartesian(at, stress)
    }

    /// Exact stress, which has no traction on the chords of the wall either.
    fn after(&self, at: Point) -> [f64; 3] {
        if at.norm() < self.plate.radius * 1.001 { [0.0; 3] } else { self.exact(at) }
    }

    fn run(&self, setup: &mut Setup, name: &str) -> Result<(Simulation, StepReport), Trouble> {
        let speed = (setup.get("young") / 2650.0).sqrt();
        let text = format!(
            "title = \"Round hole, K0 = {}\"\n{}[rock.rock]\ndensity = 2650.0\nyoung = {:e}\npoisson = {:e}\n\
             [in_situ]\nsxx = {:e}\nsyy = {:e}\n{}",
            self.k0,
            self.plate.text(),
            setup.get("young"),
            setup.get("poisson"),
            -self.k0 * self.p,
            -self.p,
            self.plate.opened(&|_| [-self.k0 * self.p, -self.p, 0.0], &|at| self.after(at), speed),
        );
        let mut simulation = setup.simulation(name, text)?;
        let reports = run_all(&mut simulation)?;
        Ok((simulation, reports[1]))
    }

    /// Radial and hoop stress (Pa, compression positive) found and exact, at a multiple of the radius and an angle.
    fn compare(&self, simulation: &Simulation, r: f64, angle: f64) -> [[f64; 2]; 2] {
        let at = Point::new(angle.cos(), angle.sin()) * (r * self.plate.radius);
        let [rr, tt, _] = polar(at, stress_at(simulation, at));
        let exact = kirsch(self.k0, r, angle);
        [[-rr, self.p * exact[0]], [-tt, self.p * exact[1]]]
    }

    /// Rows along the side (angle 0) and at the crown.
    fn rows(&self, simulation: &Simulation) -> Vec<Row> {
        let h = self.plate.mesh / self.plate.radius;
        let most = |r: f64, angle: f64| {
            let slope = (kirsch(self.k0, r + 1e-4, angle)[1] - kirsch(self.k0, r, angle)[1]) / 1e-4;
            self.p * (0.25 * h * slope.abs() + h * h * (1.0 + self.k0))
        };
        let reason = "a parabola fitted to element stresses over 3.5 h: second order, (h/R)²(1 + K0)p, and a quarter \
                      of the change of the hoop stress over one h, for elements at the wall are cut anyhow";
        let mut rows = Vec::new();
        let mut add = |what: String, [found, exact]: [f64; 2], most: f64| {
            rows.push(Row::new(what, "Pa", found, exact).absolute(most, reason));
        };
        let k0 = self.k0;
        for r in RADII {
            let [radial, hoop] = self.compare(simulation, r, 0.0);
            add(format!("K0 = {k0}: radial stress beside the hole, r = {r} R"), radial, most(r, 0.0));
            add(format!("K0 = {k0}: hoop stress beside the hole, r = {r} R"), hoop, most(r, 0.0));
        }
        let top = std::f64::consts::FRAC_PI_2;
        let [_, crown] = self.compare(simulation, 1.0, top);
        add(format!("K0 = {k0}: hoop stress at the crown"), crown, most(1.0, top));
        rows
    }

    /// Root mean square over the rock within 3 R of the change of stress (p) per R: what an element cannot follow.
    fn gradient(&self) -> f64 {
        let (mut sum, mut weight) = (0.0, 0.0);
        let step = 1e-5 * self.plate.radius;
        for (n, m) in (0..200).flat_map(|n| (0..24).map(move |m| (n, m))) {
            let r = 1.0 + (NEAR - 1.0) * (f64::from(n) + 0.5) / 200.0;
            let angle = std::f64::consts::FRAC_PI_2 * (f64::from(m) + 0.5) / 24.0;
            let at = Point::new(angle.cos(), angle.sin()) * (r * self.plate.radius);
            for shift in [Point::new(step, 0.0), Point::new(0.0, step)] {
                let (a, b) = (self.exact(at - shift), self.exact(at + shift));
                sum += r * (0..3).map(|k| ((b[k] - a[k]) / (2e-5 * self.p)).powi(2)).sum::<f64>();
            }
            weight += r;
        }
        (sum / weight).sqrt()
    }

    fn plot(&self, simulation: &Simulation) -> Plot {
        let steps = |count: usize| (0..=count).map(move |k| 1.0 + 3.0 * k as f64 / count as f64);
        let mut plot = Plot::new(format!("Stress beside a round hole, K0 = {}", self.k0), ["r/R", "stress over p"]);
        for (which, name) in [(0, "radial"), (1, "hoop")] {
            let exact = steps(60).map(|r| [r, kirsch(self.k0, r, 0.0)[which]]).collect();
            let found = steps(15).map(|r| [r, self.compare(simulation, r, 0.0)[which][0] / self.p]).collect();
            plot = plot.line(format!("{name}, exact"), exact).marks(format!("{name}, computed"), found);
        }
        plot
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let mesh = if setup.quick { setup.get("mesh").max(0.2) } else { setup.get("mesh") };
    let mut outcome = Outcome::default();
    let mut fields = vec![1.0, setup.get("k0")];
    fields.dedup();
    for k0 in fields {
        let model = Model::new(setup, k0, mesh);
        let (simulation, report) = model.run(setup, &format!("b4_k{k0}"))?;
        outcome.rows.extend(model.rows(&simulation));
        outcome.rows.push(Row::ledger(&report));
        outcome.plots.push(model.plot(&simulation));
        let coarse = Model::new(setup, k0, 2.0 * mesh);
        let (rough, _) = coarse.run(setup, &format!("b4_k{k0}_coarse"))?;
        let reach = NEAR * model.plate.radius;
        let errors = [&rough, &simulation].map(|s| stress_error(s, reach, &|at| model.exact(at)) / model.p);
        let row = Row::new(format!("K0 = {k0}: rms error of element stresses within 3 R"), "p", errors[1], 0.0);
        let nu = setup.get("poisson");
        let (gradient, stiff) = (model.gradient(), (1.0 - nu) / (1.0 - 2.0 * nu));
        outcome.rows.push(row.at_most(
            0.4 * mesh * gradient * stiff,
            format!(
                "constant strain per element: 0.4 h times the rms stress gradient there, {gradient:.3} p/R, times \
                 (1 − ν)/(1 − 2ν), the confined modulus over 2G"
            ),
        ));
        let rate = order(errors[0], errors[1], 2.0);
        let row = Row::new(format!("K0 = {k0}: order of that error in h"), "", rate, 1.0);
        outcome.rows.push(row.absolute(0.3, "linear covers have stresses of first order"));
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::kirsch;

    /// Numbers of verification.md: p = 10, K0 = 1 and K0 = 0.5.
    #[test]
    fn the_formula_gives_the_published_numbers() {
        let published = [(1.0, 0.0, 20.0), (1.5, 5.5556, 14.4444), (2.0, 7.5, 12.5), (3.0, 8.8889, 11.1111)];
        for (r, radial, hoop) in published {
            let [rr, tt, _] = kirsch(1.0, r, 0.3);
            assert!((10.0 * rr - radial).abs() < 5e-5 && (10.0 * tt - hoop).abs() < 5e-5, "{rr} {tt}");
        }
        let crown = kirsch(0.5, 1.0, std::f64::consts::FRAC_PI_2)[1];
        assert!((10.0 * kirsch(0.5, 1.0, 0.0)[1] - 25.0).abs() < 1e-12 && (10.0 * crown - 5.0).abs() < 1e-12);
    }
}
