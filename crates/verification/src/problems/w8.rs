//! W8: uplift of water that flows along the plane of a slide, and its factor of safety.

use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

use super::joint_flow::{WEIGHT, push_on};
use super::limit::{bound_of, factor_rows};
use super::plane_slide::PlaneSlide;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W8",
    title: "Plane slide over water that flows",
    source: "between the crack, with the head h over the toe, and the toe an aperture that goes linearly from e_c to \
             e_t has the uplift γA(h·e_c/(e_c + e_t) − y/2), y the height of the foot of the crack; with it the \
             formula of E. Hoek and J. W. Bray. Catches heads of another place, films that press, and factors with \
             other water",
    parameters: &[
        Parameter::new("height", "m", 30.0, [5.0, 500.0], "height of the slope"),
        Parameter::new("crack", "m", 7.0, [0.1, 200.0], "depth of the tension crack"),
        Parameter::new("water", "m", 5.0, [0.1, 200.0], "depth of the water in it"),
        Parameter::new("face_deg", "°", 60.0, [20.0, 80.0], "dip of the face"),
        Parameter::new("plane_deg", "°", 35.0, [10.0, 70.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [1.0, 70.0], "friction of the plane"),
        Parameter::new("cohesion", "Pa", 25e3, [0.0, 1e7], "cohesion of the plane"),
        Parameter::new("gamma", "N/m³", 26e3, [1e4, 4e4], "unit weight"),
        Parameter::new("clogged", "", 0.25, [0.1, 1.0], "aperture at the toe over that at the crack"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Aperture at the crack (m): only ratios count.
const APERTURE: f64 = 2e-4;

/// The plane of a slide in parts, with water that flows along it.
struct Flowing {
    slide: PlaneSlide,
    /// Depth of the water in the crack (m).
    water: f64,
    /// Aperture at the toe over that at the crack.
    clogged: f64,
    parts: u32,
}

impl Flowing {
    /// Foot of the crack (m).
    fn foot(&self) -> [f64; 2] {
        let y = self.slide.height - self.slide.crack;
        [y / self.slide.plane.tan(), y]
    }

    /// Uplift (N/m) on the plane.
    fn uplift(&self) -> f64 {
        let y = self.foot()[1];
        WEIGHT * self.slide.length() * ((y + self.water) / (1.0 + self.clogged) - 0.5 * y)
    }

    /// Factor of Hoek and Bray with it.
    fn factor(&self) -> f64 {
        let slide = &self.slide;
        let ((s, c), weight) = (slide.plane.sin_cos(), slide.weight());
        let push = 0.5 * WEIGHT * self.water.powi(2);
        let normal = weight * c - self.uplift() - push * s;
        (slide.cohesion * slide.length() + normal * slide.friction.tan()) / (weight * s + push * c)
    }

    /// Apertures (m) of parts, each with the flow of one that goes linearly.
    fn apertures(&self) -> impl Iterator<Item = f64> {
        let (clogged, parts) = (self.clogged, f64::from(self.parts));
        let at = move |k: u32| APERTURE * (clogged + (1.0 - clogged) * f64::from(k) / parts);
        let pair = move |k: u32| (2.0 * at(k).powi(2) * at(k + 1).powi(2) / (at(k) + at(k + 1))).cbrt();
        (0..self.parts).map(pair)
    }

    fn text(&self, title: &str) -> String {
        let [x, y] = self.foot();
        let text = self.slide.text(title);
        let whole = format!("[[joint]]\npoints = {:?}\n", [[0.0, 0.0], [x, y]]);
        let (mut joints, count) = (String::new(), f64::from(self.parts));
        for (k, aperture) in self.apertures().enumerate() {
            let ends = [k, k + 1].map(|k| [x, y].map(|length| length * k as f64 / count));
            joints += &format!(
                "[[joint]]\npoints = {ends:?}\nlaw = \"p{k}\"\n[joint_law.p{k}]\nfriction_deg = {:?}\ncohesion = \
                 {:e}\naperture = {aperture:e}\n",
                self.slide.friction.to_degrees(),
                self.slide.cohesion
            );
        }
        let level = y + self.water;
        let flow = format!(
            "[flow]\naperture = {APERTURE:e}\n[[head]]\nname = \"crack\"\nedge = {:?}\nlevel = {level:?}\n[[stage]]",
            [[x, y], [x, level.max(y + 1e-3 * self.slide.crack)]],
        );
        text.replacen(&whole, &joints, 1).replacen("[[stage]]", &flow, 1)
    }
}

fn flowing(setup: &Setup, water: f64, clogged: f64, parts: u32) -> Flowing {
    let slide = PlaneSlide::of(setup, setup.get("plane_deg"), setup.get("gamma"));
    Flowing { slide: PlaneSlide { crack: setup.get("crack"), ..slide }, water, clogged, parts }
}

/// Uplift of a model: what the water pushes the wedge normal to its plane, without the push of the crack.
fn uplift_of(setup: &mut Setup, flowing: &Flowing, name: &str) -> Result<f64, Trouble> {
    let found = setup.simulation(name, flowing.text("Plane slide over water that flows"))?;
    let ([x, y], slide) = (flowing.foot(), &flowing.slide);
    let crest = slide.height / slide.face.tan();
    let force = push_on(&found, [(2.0 * x + crest) / 4.0, (y + 2.0 * slide.height) / 4.0])?;
    let (s, c) = slide.plane.sin_cos();
    Ok(c * force.y - s * (force.x + 0.5 * WEIGHT * flowing.water.powi(2)))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [water, clogged] = ["water", "clogged"].map(|name| setup.get(name));
    let mut outcome = Outcome::default();
    let even = flowing(setup, water, 1.0, 1);
    if !even.slide.is_sound() || water > even.slide.crack {
        return Err(Trouble("the plane must daylight and the crack hold the water: steepen the face".to_owned()));
    }
    let round_off = "round-off of sums over some dozen pieces";
    let found = uplift_of(setup, &even, "even")?;
    outcome.rows.push(Row::new("uplift, even aperture", "N/m", found, even.uplift()).relative(1e-9, round_off));
    let mut marks = Vec::new();
    for parts in [16, 32, 64] {
        let tapered = flowing(setup, water, clogged, parts);
        let (found, exact) = (uplift_of(setup, &tapered, &format!("clogged_in_{parts}"))?, tapered.uplift());
        let reason = "pressures are linear in each part of the plane; the error falls with the square of its length";
        let share = 0.01 * (16.0 / f64::from(parts)).powi(2);
        let row = Row::new(format!("uplift, clogged toe, {parts} parts"), "N/m", found, exact);
        outcome.rows.push(row.relative(share, reason));
        marks.push([f64::from(parts), (found / exact - 1.0).abs()]);
    }
    let dry = flowing(setup, 0.0, 1.0, 1);
    let fine = flowing(setup, water, clogged, 64);
    for (name, flowing) in [("dry crack", &dry), ("even aperture", &even), ("clogged toe", &fine)] {
        let text = flowing.text("Plane slide over water that flows");
        let bound = bound_of(setup, &format!("bound_{}", name.replace(' ', "_")), text)?;
        let [first, _] = factor_rows(&format!(", {name}"), &bound, flowing.factor());
        let clogs = flowing.parts > 1;
        let reason = "the uplift of its parts, as above, and the tolerance of the linear program";
        outcome.rows.push(if clogs { first.relative(2e-3, reason) } else { first });
    }
    if !setup.quick {
        let text = even.text("Plane slide over water that flows");
        let case = setup.simulation("reduction", text)?.case().clone();
        let found = factor_of_safety(&case, &ReductionOptions::default(), &mut |_, _| {})?;
        let row = Row::new("strength reduction, even aperture", "", found.factor().unwrap_or(f64::NAN), even.factor());
        outcome.rows.push(row.relative(5e-3, "the width of the bracket"));
    }
    let plot = Plot::new("Error of the uplift, clogged toe", ["parts of the plane", "error"]).logarithmic([true; 2]);
    outcome.plots.push(plot.marks("computed", marks));
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plane slide of the examples, as a prototype in another language had it: 1.03105 and 0.59347.
    #[test]
    fn the_formula_gives_known_numbers() {
        let mut setup = Setup::of(&PROBLEM, true);
        setup.values.set(&PROBLEM, "gamma", 2650.0 * 9.81).expect("a value");
        let factor = |clogged: f64| flowing(&setup, 5.0, clogged, 16).factor();
        assert!((factor(1.0) - 1.03105).abs() < 1e-5, "{}", factor(1.0));
        assert!((factor(0.25) - 0.59347).abs() < 1e-5, "{}", factor(0.25));
    }
}
