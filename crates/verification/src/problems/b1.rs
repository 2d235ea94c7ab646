//! B1: a simply supported beam under a uniform load and under a force in its middle.

use enmm::model::Simulation;

use super::beam::{Beam, Plane};
use super::block::G;
use crate::{Outcome, Parameter, Plot, Problem, Row, Series, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "B1",
    title: "Simply supported beam",
    source: "Timoshenko and Goodier, uniform load and own weight (exact plane problems); force in the middle by \
             bending and shear. \
             Catches wrong elasticity, plane stress taken for plane strain, and locking of linear covers",
    parameters: &[
        Parameter::new("length", "m", 10.0, [4.0, 20.0], "span"),
        Parameter::new("depth", "m", 1.0, [0.5, 1.25], "depth of the beam"),
        Parameter::new("young", "Pa", 1e9, [1e8, 1e11], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.4], "Poisson's ratio"),
        Parameter::new("q", "Pa", 1e4, [10.0, 1e5], "uniform load on the top"),
        Parameter::new("force", "N/m", 1e5, [10.0, 1e6], "force in the middle"),
        Parameter::new("rows", "", 16.0, [8.0, 24.0], "rows of the finest mesh"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Loads of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Load {
    Uniform,
    Weight,
    Point,
}

impl Load {
    fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform load",
            Self::Weight => "own weight",
            Self::Point => "mid point load",
        }
    }

    /// Load (Pa) along the beam.
    fn along(self, setup: &Setup, beam: &Beam) -> f64 {
        match self {
            Self::Uniform => setup.get("q"),
            Self::Weight => beam.density * G * beam.depth,
            Self::Point => 0.0,
        }
    }
}

/// Result of one mesh.
#[derive(Debug, Clone, Copy)]
struct Result {
    /// Deflection (m) of the middle over the supports, and below the mean of the points L/10 inside.
    sag: [f64; 2],
    /// Root mean square of the error of stress xx over the middle half, relative to the greatest stress.
    stress: f64,
}

fn run(setup: &mut Setup) -> std::result::Result<Outcome, Trouble> {
    let finest = if setup.quick { 8.0 } else { setup.get("rows") };
    let rows = [0.25 * finest, 0.5 * finest, finest];
    let mut outcome = Outcome::default();
    let mut curves = Vec::new();
    let cases = [
        (Plane::Stress, Load::Uniform),
        (Plane::Strain, Load::Uniform),
        (Plane::Strain, Load::Weight),
        (Plane::Stress, Load::Point),
    ];
    let count = if setup.quick { 3 } else { 4 };
    for (plane, load) in cases.into_iter().take(count) {
        let beam = beam(setup, plane);
        let name = format!("{}, plane {}", load.name(), plane.name());
        let mut results = Vec::new();
        for n in rows {
            let (result, ledger) = solve(setup, &beam, load, n)?;
            results.push(result);
            if n == finest {
                outcome.rows.push(Row { quantity: format!("{name}: {}", ledger.quantity), ..ledger });
            }
        }
        judge(&mut outcome, setup, &beam, load, &name, &results, finest);
        curves.push((name, results));
    }
    outcome.plots = plots(setup, &curves, rows);
    Ok(outcome)
}

fn beam(setup: &Setup, plane: Plane) -> Beam {
    let [length, depth, young, poisson] = ["length", "depth", "young", "poisson"].map(|name| setup.get(name));
    Beam { length, depth, young, poisson, density: 2500.0, plane }
}

/// Exact deflection over the supports and below the points L/10 inside.
fn exact(setup: &Setup, beam: &Beam, load: Load) -> [f64; 2] {
    let l = beam.length;
    match load {
        Load::Uniform | Load::Weight => {
            let axis = if load == Load::Uniform { Beam::uniform } else { Beam::weight };
            let at = |x: f64| axis(beam, load.along(setup, beam), x);
            [at(0.0), at(0.0) - at(0.4 * l)]
        }
        Load::Point => {
            let at = |x: f64| beam.point(setup.get("force"), x);
            [at(0.5 * l), at(0.5 * l) - at(0.1 * l)]
        }
    }
}

fn solve(setup: &mut Setup, beam: &Beam, load: Load, rows: f64) -> std::result::Result<(Result, Row), Trouble> {
    let (l, c) = (beam.length, 0.5 * beam.depth);
    let loading = match load {
        Load::Weight => String::new(),
        Load::Uniform => format!(
            "[[load]]\nkind = \"traction\"\nedge = [[0.0, {c:e}], [{l:e}, {c:e}]]\ntraction = [0.0, {:e}]\n",
            -setup.get("q")
        ),
        Load::Point => {
            format!(
                "[[load]]\nkind = \"point\"\npoint = [{:e}, {c:e}]\nforce = [0.0, {:e}]\n",
                0.5 * l,
                -setup.get("force")
            )
        }
    };
    let monitors: String =
        [0.1, 0.5, 0.9].iter().map(|s| format!("[[monitor]]\nname = \"x{s}\"\npoint = [{:e}, 0.0]\n", s * l)).collect();
    let text = format!(
        "{}[[fix]]\npoint = [0.0, 0.0]\n[[fix]]\npoint = [{l:e}, 0.0]\naxes = \"y\"\n{loading}{monitors}\
         [[stage]]\nname = \"load\"\nkind = \"static\"\nduration = 60.0\nramp = {:?}\nconvergence = 1e-5\n",
        beam.text(rows, if load == Load::Weight { G } else { 0.0 }),
        // The weight must not come at once: the beam would swing by as much as it sags.
        if load == Load::Weight { 0.2 } else { 0.0 },
    );
    let name = format!("b1_{}_{load:?}_{rows}_rows", beam.plane.name()).to_lowercase();
    let mut simulation = setup.simulation(&name, text)?;
    let report = simulation.run_stage()?;
    if !simulation.at_rest(&report) {
        return Err(Trouble(format!("{name}: the beam has not come to rest in its time")));
    }
    let [left, middle, right] = [0, 1, 2].map(|k| -simulation.monitor(k).0.y);
    let stress = stress_error(&simulation, beam, load.along(setup, beam));
    Ok((Result { sag: [middle, middle - 0.5 * (left + right)], stress }, Row::ledger(&report)))
}

/// Root mean square, by area, of the error of stress xx in the middle half of the beam over the greatest stress.
fn stress_error(simulation: &Simulation, beam: &Beam, q: f64) -> f64 {
    let slope = simulation.model();
    let covers = &slope.covers;
    let (mut sum, mut area) = (0.0, 0.0);
    for e in covers.elements() {
        let p = covers.element_centroid[e];
        let x = p.x - 0.5 * beam.length;
        if x.abs() > 0.25 * beam.length {
            continue;
        }
        let deformation = slope.deformation(e, &simulation.state().displacement);
        let computed = deformation.stress(&slope.rock_of(e).constants(), &[0.0; 3])[0];
        sum += covers.element_area[e] * (computed - beam.uniform_stress(q, x, p.y)).powi(2);
        area += covers.element_area[e];
    }
    (sum / area).sqrt() / beam.uniform_stress(q, 0.0, -0.5 * beam.depth).abs()
}

fn judge(outcome: &mut Outcome, setup: &Setup, beam: &Beam, load: Load, name: &str, results: &[Result], finest: f64) {
    let exact = exact(setup, beam, load);
    let sag = |k: usize| results[k].sag[1];
    let bending = 2.0 / (finest * finest);
    // The dent of a force is of the order P/E, the sag P/E·(L/D)³/4: 0.4 % of a beam of L/D = 10, as
    // the cube otherwise.
    let local = if load == Load::Point { 4e-3 * (10.0 * beam.depth / beam.length).powi(3) } else { 0.0 };
    let last = results.len() - 1;
    let row = Row::new(format!("{name}: deflection over the supports"), "m", results[last].sag[0], exact[0]);
    outcome.rows.push(row.relative(bending + 6e-3 + local, "below 2/rows² of linear covers; the supports' dents"));
    outcome.rows.push(
        Row::new(format!("{name}: sag between points L/10 inside"), "m", sag(last), exact[1])
            .relative(bending + local, "linear covers bend like constant-strain triangles: below 2/rows²"),
    );
    let limit = sag(last) + (sag(last) - sag(last - 1)) / 3.0;
    let left = 1e-3 + local + 4.0 * (2.1 / (finest * finest)).powi(2);
    let row = Row::new(format!("{name}: sag, extrapolated"), "m", limit, exact[1]);
    outcome.rows.push(row.relative(left.max(2e-3), "Richardson's rule leaves the square of the finest error"));
    let order = ((sag(last - 1) / exact[1] - 1.0) / (sag(last) / exact[1] - 1.0)).log2();
    let width = if load == Load::Point { 0.7 } else { 0.4 };
    let row = Row::new(format!("{name}: order of the sag in h"), "", order, 2.0);
    outcome.rows.push(row.absolute(width, "h²; the mesh does not fit the beam; a force is a singular load"));
    if load != Load::Point {
        let softer = (0..results.len()).filter(|k| sag(*k) > exact[1]).count();
        let reason = "covers allow fewer displacements than the rock has, which makes a beam stiffer";
        let row = Row::new(format!("{name}: meshes of 3 that sag by more than the rock"), "", softer as f64, 0.0);
        outcome.rows.push(row.at_most(0.0, reason));
        let order = (results[last - 1].stress / results[last].stress).log2();
        let row = Row::new(format!("{name}: order of stress in h"), "", order, 1.0);
        outcome.rows.push(row.absolute(0.35, "stress is uniform in an element: error h"));
    }
}

fn plots(setup: &Setup, curves: &[(String, Vec<Result>)], rows: [f64; 3]) -> Vec<Plot> {
    let plane = |name: &str| if name.ends_with("strain") { Plane::Strain } else { Plane::Stress };
    let error = |name: &str, result: &Result| {
        let of_name = |load: &Load| name.starts_with(load.name());
        let load = [Load::Uniform, Load::Weight].into_iter().find(of_name).unwrap_or(Load::Point);
        (result.sag[1] / exact(setup, &beam(setup, plane(name)), load)[1] - 1.0).abs()
    };
    let size = |k: usize| setup.get("depth") / rows[k];
    let line = |label: String, value: &dyn Fn(usize) -> f64| {
        Series::line(label, (0..3).map(|k| [size(k), value(k)]).collect())
    };
    let mut series: Vec<Series> =
        curves.iter().map(|(name, results)| line(name.clone(), &|k| error(name, &results[k]))).collect();
    series.push(line("h²".into(), &|k| 2.1 * (size(k) / setup.get("depth")).powi(2)));
    let stress = curves.iter().filter(|(name, _)| !name.starts_with(Load::Point.name()));
    let mut stresses: Vec<Series> = stress.map(|(name, results)| line(name.clone(), &|k| results[k].stress)).collect();
    stresses.push(line("h".into(), &|k| size(k) / setup.get("depth")));
    let plot = |title: &str, axis: &str| Plot::new(title, ["mesh size h [m]", axis]).logarithmic([true; 2]);
    vec![
        plot("B1: error of the sag over the mesh size", "relative error [-]").with(series),
        plot("B1: error of stress xx over the mesh size", "rms error / greatest stress [-]").with(stresses),
    ]
}
