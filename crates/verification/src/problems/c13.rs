//! C13: strength reduction of a slope in soil.

use super::block::G;
use super::incline::{ledger_row, trial_plot};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble, Values};
use enmm_stability::strength_reduction::{Reduction, ReductionOptions, factor_of_safety};

pub const PROBLEM: Problem = Problem {
    id: "C13",
    title: "Slope in soil, and how little its factor depends on mesh and stiffness",
    source: "D. V. Griffiths and P. A. Lane, Géotechnique 49 (1999), example 1: 1.38 to 1.40 for a slope of 2:1 above \
             a firm base; here beside Bishop's simplified method, least over circles above the base. Catches strength \
             of rock that is not divided by the factor, and triangles that lock where rock flows: they would hold 4 % \
             more on the coarse mesh, and 10 % more on the fine one in rock that is ten times as stiff",
    parameters: &[
        Parameter::new("height", "m", 10.0, [1.0, 100.0], "height H of the slope"),
        Parameter::new("slope", "", 2.0, [1.0, 4.0], "cot of the face"),
        Parameter::new("phi_deg", "°", 20.0, [5.0, 40.0], "friction of the soil"),
        Parameter::new("psi_deg", "°", 0.0, [0.0, 40.0], "its dilation, at most phi"),
        Parameter::new("cohesion", "", 0.05, [0.01, 0.5], "its cohesion over γH"),
        Parameter::new("gamma", "N/m³", 20e3, [1e4, 3e4], "its unit weight γ"),
        Parameter::new("young", "", 500.0, [100.0, 1e4], "Young's modulus over γH"),
        Parameter::new("poisson", "", 0.3, [0.0, 0.4], "Poisson's ratio"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// A slope above a firm base at the level of its toe, in units of its height and of γH.
#[derive(Debug, Clone, Copy)]
struct Soil {
    /// Cotangent of the face.
    run: f64,
    /// tan φ.
    tangent: f64,
    cohesion: f64,
}

/// Slices of a slide.
const SLICES: u32 = 50;
/// Rounds and corrections of the search for the least circle and of the factor of a circle.
const ROUNDS: [u32; 2] = [20, 12];

impl Soil {
    /// Bishop's simplified factor of the circle whose middle lies `x` behind the toe, that reaches down to `low` and
    /// leaves the face `exit` behind the toe: F = Σ (cb + W·tan φ)/(cos α + sin α·tan φ/F) / Σ W·sin α.
    fn circle(&self, [x, exit, low]: [f64; 3]) -> Option<f64> {
        let top = |x: f64| (x / self.run).clamp(0.0, 1.0);
        let low = if x > exit { low.max(0.0) } else { low };
        let rise = top(exit) - low;
        let radius = ((x - exit).powi(2) + rise * rise) / (2.0 * rise);
        let (y, head) = (low + radius, radius * radius - (low + radius - 1.0).powi(2));
        if exit < 0.0 || rise < 1e-9 || y < 1.0 || head < 0.0 || x + head.sqrt() < self.run {
            return None;
        }
        let width = (x + head.sqrt() - exit) / f64::from(SLICES);
        let slice = |k: u32| {
            let place = exit + (f64::from(k) + 0.5) * width;
            let sine = (place - x) / radius;
            let cosine = (1.0 - sine * sine).sqrt();
            [sine, cosine, (top(place) - y + radius * cosine) * width]
        };
        let slices: Vec<[f64; 3]> = (0..SLICES).map(slice).collect();
        let drive: f64 = slices.iter().map(|[sine, _, weight]| weight * sine).sum();
        if drive <= 0.0 || slices.iter().any(|s| s[2] < 0.0) {
            return None;
        }
        let held = |factor: f64| -> f64 {
            let of = |[sine, cosine, weight]: &[f64; 3]| {
                (self.cohesion * width + weight * self.tangent) / (cosine + sine * self.tangent / factor)
            };
            slices.iter().map(of).sum()
        };
        Some((0..ROUNDS[1]).fold(1.0, |factor, _| held(factor) / drive))
    }

    /// The least factor over circles.
    fn factor(&self) -> f64 {
        let (mut best, mut at, mut reach) = (f64::INFINITY, [0.25 * self.run, 0.1, 0.0], 0.5);
        for _ in 0..ROUNDS[0] {
            let middle = at;
            for k in 0..9 * 7 * 7 {
                let step = [k % 9 - 4, k / 9 % 7 - 3, k / 63 - 3].map(|n| 0.25 * reach * f64::from(n));
                let tried = [middle[0] + step[0], (middle[1] + step[1]).max(0.0), middle[2] + 0.5 * step[2]];
                if let Some(factor) = self.circle(tried).filter(|factor| *factor < best) {
                    (best, at) = (factor, tried);
                }
            }
            reach *= 0.75;
        }
        best
    }
}

fn text(setup: &Setup, elements: f64, stiffer: f64) -> String {
    let [height, gamma] = ["height", "gamma"].map(|name| setup.get(name));
    let (crest, far) = (1.2 * height, (1.2 + setup.get("slope")) * height);
    format!(
        "title = \"Slope in soil\"\n[domain]\noutline = [[0.0, 0.0], [{far:?}, 0.0], [{crest:?}, {height:?}], [0.0, \
         {height:?}]]\n[mesh]\nsize = {:e}\n[rock.soil]\ndensity = {:e}\nyoung = {:e}\npoisson = {:?}\n\
         friction_deg = {:?}\ndilation_deg = {:?}\ncohesion = {:e}\n[[fix]]\nedge = [[0.0, 0.0], [{far:?}, 0.0]]\n\
         [[fix]]\nedge = [[0.0, 0.0], [0.0, {height:?}]]\naxes = \"x\"\n[[stage]]\nname = \"settle\"\n\
         kind = \"static\"\nduration = 60.0\n",
        height / elements,
        gamma / G,
        stiffer * setup.get("young") * gamma * height,
        setup.get("poisson"),
        setup.get("phi_deg"),
        setup.get("psi_deg"),
        setup.get("cohesion") * gamma * height,
    )
}

/// Width of the bracket.
const BRACKET: f64 = 0.01;

/// The factor of safety on a mesh of so many elements over the height, looked for within limits.
fn reduce(setup: &mut Setup, elements: f64, stiffer: f64, [low, high]: [Option<f64>; 2]) -> Result<Reduction, Trouble> {
    let text = text(setup, elements, stiffer);
    let case = setup.simulation(&format!("height_over_{elements}_stiffness_{stiffer}"), text)?.case().clone();
    let options =
        ReductionOptions { low, high, tolerance: BRACKET, integrators: &enmm_implicit::Both, ..Default::default() };
    Ok(factor_of_safety(&case, &options, &mut |_, _| {})?)
}

/// Why factors may differ, and by how much.
const REASON: &str = "1 % for Bishop's method beside exact ones, half of a bracket of 1 %, and 2 % for the mesh: \
                      coarse triangles hold a little more than rock, and bands of its width a little less";
const TOLERANCE: Tolerance = Tolerance::Relative(0.01 + 0.5 * BRACKET + 0.02);
/// Elements over the height from which on rock that does not dilate fails in bands of the mesh: no factor to compare.
const BANDS: f64 = 40.0;

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    if setup.get("psi_deg") > setup.get("phi_deg") {
        return Err(Trouble("soil that dilates by more than its friction makes energy: choose psi_deg below".into()));
    }
    let tangent = setup.get("phi_deg").to_radians().tan();
    let exact = Soil { run: setup.get("slope"), tangent, cohesion: setup.get("cohesion") }.factor();
    let meshes: &[f64] = if setup.quick { &[10.0] } else { &[10.0, 20.0, 40.0] };
    let (mut outcome, mut points) = (Outcome::default(), Vec::new());
    // A finer mesh gives less: what a coarser one gave ends the search.
    let [low, mut high] = [Some(0.95 * exact), None];
    let bishop = Origin::Numerical("Bishop's simplified method");
    for &elements in meshes {
        let reduction = reduce(setup, elements, 1.0, [low, high])?;
        let factor = reduction.factor().unwrap_or(f64::NAN);
        high = Some(1.02 * factor);
        let row = Row::new(format!("factor of safety, mesh size H/{elements}"), "", factor, exact).from(bishop);
        outcome.rows.push(if elements < BANDS { row.within(TOLERANCE, REASON) } else { row });
        if elements < BANDS && setup.values == Values::of(&PROBLEM) {
            let row = Row::new("the same, published", "", factor, 1.39);
            outcome.rows.push(row.within(TOLERANCE, REASON).from(Origin::Published("Griffiths and Lane 1999")));
        }
        points.push([elements.recip(), factor]);
        if Some(&elements) == meshes.last() {
            outcome.rows.push(ledger_row(&[&reduction]));
            outcome.plots.push(trial_plot(&format!("Trials, mesh size H/{elements}"), &reduction, exact));
        }
    }
    if !setup.quick {
        let factor = reduce(setup, 20.0, 10.0, [low, None])?.factor().unwrap_or(f64::NAN);
        let row = Row::new("factor of safety, mesh size H/20, ten times stiffer", "", factor, exact).from(bishop);
        outcome.rows.push(row.within(TOLERANCE, REASON));
        let plot = Plot::new("Factor of safety over mesh size", ["mesh size over height", "factor of safety"]);
        outcome.plots.push(plot.beside("Bishop's simplified method", |_| exact, points));
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::Soil;

    /// A. W. Bishop and N. R. Morgenstern (1960): 1.380; D. W. Taylor's chart: c/(γHF) = 0.0625 at F = 1 for 45°, 20°.
    #[test]
    fn the_method_gives_the_published_numbers() {
        let soil = |run, degrees: f64, cohesion| Soil { run, tangent: degrees.to_radians().tan(), cohesion };
        assert!((soil(2.0, 20.0, 0.05).factor() - 1.380).abs() < 5e-3);
        assert!((soil(1.0, 20.0, 0.0625).factor() - 1.0).abs() < 2e-2);
    }
}
