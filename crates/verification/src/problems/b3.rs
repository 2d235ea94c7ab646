//! B3: a confined column under its weight.

use enmm::model::Simulation;

use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "B3",
    title: "Gravity column",
    source: "σy = −γ(H − y), σx = ν/(1 − ν)·σy, settlement γH²/2Ec with Ec = E(1 − ν)/(1 + ν)(1 − 2ν). Catches wrong \
             weight, wrong confinement, and static stages that stop early",
    parameters: &[
        Parameter::new("height", "m", 10.0, [2.0, 50.0], "height"),
        Parameter::new("gamma", "N/m³", 25e3, [1e3, 1e5], "unit weight"),
        Parameter::new("young", "Pa", 1e9, [1e8, 1e11], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.45], "Poisson's ratio"),
        Parameter::new("rows", "", 40.0, [10.0, 80.0], "rows of the finest mesh"),
    ],
    quick: true,
    implicit: true,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [height, gamma, young, poisson] = ["height", "gamma", "young", "poisson"].map(|name| setup.get(name));
    let confined = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let exact = gamma * height * height / (2.0 * confined);
    let finest = if setup.quick { 20.0 } else { setup.get("rows") };
    let mut outcome = Outcome::default();
    let mut curve: Vec<[f64; 2]> = Vec::new();
    for rows in [0.25 * finest, 0.5 * finest, finest] {
        let size = height / rows;
        let mut simulation = setup.simulation(&format!("b3_{rows}_rows"), text(setup, size))?;
        let report = simulation.run_stage()?;
        if !simulation.at_rest(&report) {
            return Err(Trouble(format!("b3, {rows} rows: the column has not come to rest in its time")));
        }
        let settlement = -simulation.monitor(0).0.y;
        curve.push([size, (settlement / exact - 1.0).abs()]);
        if rows < finest {
            continue;
        }
        let stress = stresses(&simulation);
        let [sx, sy] = base_stress(&simulation, &stress);
        let soft = "supports of 50·Ec/h give γHh/50Ec; stress is uniform in an element: a fraction of ½γh";
        let share = 0.1 / rows + 5e-4;
        let ratio = curve[curve.len() - 1][1] / curve[curve.len() - 2][1];
        let rows_of = [
            Row::new("settlement of the top", "m", settlement, exact).relative(
                share,
                "h² of the elements, h/25H of the supports of the base and as much of those of the sides",
            ),
            Row::new("error of the settlement over that with twice the mesh size", "", ratio, 0.5).absolute(
                0.1,
                "the error of the supports, which are springs of 50·Ec/h, is as h; that of the elements as h²",
            ),
            Row::new("vertical stress at the base", "Pa", sy, -gamma * height).relative(0.16 / rows + 1e-3, soft),
            Row::new("horizontal stress at the base", "Pa", sx, -gamma * height * poisson / (1.0 - poisson))
                .absolute((0.3 / rows + 2e-3) * gamma * height * (poisson + 0.1), soft),
            Row::ledger(&report),
        ];
        outcome.rows.extend(rows_of);
        outcome.plots.push(profile(setup, &simulation, &stress));
    }
    let plot = Plot::new("B3: error of the settlement over the mesh size", ["mesh size h [m]", "relative error [-]"]);
    outcome.plots.push(plot.line("computed", curve).logarithmic([true; 2]));
    Ok(outcome)
}

fn text(setup: &Setup, size: f64) -> String {
    let (h, w) = (setup.get("height"), 0.2 * setup.get("height"));
    format!(
        "title = \"Gravity column\"\n[domain]\noutline = [[0.0, 0.0], [{w:e}, 0.0], [{w:e}, {h:e}], [0.0, {h:e}]]\n\
         [mesh]\nsize = {size:e}\norigin = [{:e}, {:e}]\n[rock.rock]\ndensity = {:e}\nyoung = {:e}\npoisson = {:e}\n\
         [[fix]]\nedge = [[0.0, 0.0], [{w:e}, 0.0]]\naxes = \"y\"\n[[fix]]\nedge = [[0.0, 0.0], [0.0, {h:e}]]\n\
         axes = \"x\"\n[[fix]]\nedge = [[{w:e}, 0.0], [{w:e}, {h:e}]]\naxes = \"x\"\n[[monitor]]\nname = \"top\"\n\
         point = [{:e}, {h:e}]\n[[stage]]\nname = \"weight\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n",
        0.1 * w,
        0.05 * w,
        setup.get("gamma") / 9.81,
        setup.get("young"),
        setup.get("poisson"),
        0.5 * w,
    )
}

/// Stress xx and yy (Pa) of every element.
fn stresses(simulation: &Simulation) -> Vec<[f64; 2]> {
    let slope = simulation.model();
    let of = |e| {
        let stress =
            slope.deformation(e, &simulation.state().displacement).stress(&slope.rock_of(e).constants(), &[0.0; 3]);
        [stress[0], stress[1]]
    };
    slope.covers.elements().map(of).collect()
}

/// Stress xx and yy (Pa) at y = 0 by an area-weighted straight line through all elements.
fn base_stress(simulation: &Simulation, stress: &[[f64; 2]]) -> [f64; 2] {
    let covers = &simulation.model().covers;
    [0, 1].map(|k| {
        let (mut w, mut y, mut s, mut yy, mut ys) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (e, stress) in stress.iter().enumerate() {
            let (area, height) = (covers.element_area[e], covers.element_centroid[e].y);
            w += area;
            y += area * height;
            s += area * stress[k];
            yy += area * height * height;
            ys += area * height * stress[k];
        }
        let slope = (w * ys - y * s) / (w * yy - y * y);
        (s - slope * y) / w
    })
}

fn profile(setup: &Setup, simulation: &Simulation, stress: &[[f64; 2]]) -> Plot {
    let covers = &simulation.model().covers;
    let [height, gamma, poisson] = ["height", "gamma", "poisson"].map(|name| setup.get(name));
    let computed =
        |k: usize| -> Vec<[f64; 2]> { stress.iter().zip(&covers.element_centroid).map(|(s, p)| [s[k], p.y]).collect() };
    let exact = |share: f64| vec![[-gamma * height * share, 0.0], [0.0, height]];
    Plot::new("B3: stress over height", ["stress [Pa]", "height [m]"])
        .marks("σy computed", computed(1))
        .line("σy exact", exact(1.0))
        .marks("σx computed", computed(0))
        .line("σx exact", exact(poisson / (1.0 - poisson)))
}
