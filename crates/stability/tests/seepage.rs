//! Claim: water that flows along the plane of a slide has the uplift of the closed form, whatever its apertures, and
//! both limit analysis and strength reduction give the factor of Hoek and Bray with it.

use crate::common::{case, example};
use enmm::model::Simulation;
use enmm::model::tables::{FlowPiece, wet};
use enmm_stability::limit_analysis::{BoundError, bound, continuum::bracket};
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// Toe at the origin, foot of the crack (m), and height (m) of the water in it.
const FOOT: [f64; 2] = [32.8474042, 23.0];
const WATER: f64 = 28.0;

/// The plane slide of the examples without bolts, its plane as joints with these apertures (m) from the toe to the
/// crack, in which the water stands.
fn slide(apertures: &[f64]) -> String {
    let text = example("plane_slide");
    let part = |from: &str, to: &str| {
        let (a, b) = (text.find(from).expect(from), text.find(to).expect(to));
        text[a..b].to_owned()
    };
    let (mut joints, count) = (String::new(), apertures.len() as f64);
    for (k, aperture) in apertures.iter().enumerate() {
        let [a, b] = [k, k + 1].map(|k| FOOT.map(|x| x * k as f64 / count));
        joints += &format!(
            "[[joint]]\npoints = [{a:?}, {b:?}]\nlaw = \"plane_{k}\"\n[joint_law.plane_{k}]\nfriction_deg = 35.0\n\
             cohesion = 25e3\naperture = {aperture:e}\n"
        );
    }
    let [x, y] = FOOT;
    format!(
        "{}{joints}[[joint]]\npoints = [[{x}, {y}], [{x}, 30.0]]\nlaw = \"crack\"\n{}[joint_law.crack]\n\
         friction_deg = 0.0\naperture = 1e-2\n[flow]\naperture_min = 1e-6\n[[head]]\nname = \"crack\"\n\
         edge = [[{x}, {y}], [{x}, {WATER}]]\nlevel = {WATER}\n{}{}",
        part("title", "# The plane daylights"),
        part("[rock.gneiss]", "[joint_law.plane]"),
        part("[[fix]]", "[[bolt]]"),
        part("[[stage]]\nname = \"gravity\"", "[[stage]]\nname = \"bolts\""),
    )
}

/// The factor of Hoek and Bray with an uplift (N/m) on the plane, by its length (m).
fn factor(uplift: impl Fn(f64) -> f64) -> f64 {
    factor_at(WATER, uplift)
}

/// The same with water in the crack up to a height (m).
fn factor_at(water: f64, uplift: impl Fn(f64) -> f64) -> f64 {
    let length = FOOT[0].hypot(FOOT[1]);
    let (s, c) = (FOOT[1] / length, FOOT[0] / length);
    let crest = 17.3205081;
    let area = 0.5 * (FOOT[0] * 30.0 - FOOT[1] * FOOT[0] + 30.0 * (FOOT[0] - crest));
    let (weight, push) = (2650.0 * 9.81 * area, 0.5 * 9810.0 * (water - FOOT[1]).powi(2));
    let normal = weight * c - uplift(length) - push * s;
    (25e3 * length + normal * 35f64.to_radians().tan()) / (weight * s + push * c)
}

/// Uplift (N/m) of pressures that are linear between the ends of joints with these apertures: the greatest flow in
/// series that leaves no pressure negative. Below where it is 0 for the first time, water runs as a film.
fn uplift(apertures: &[f64], length: f64) -> f64 {
    let count = apertures.len();
    let (step, fall) = (length / count as f64, FOOT[1] / count as f64);
    // From the crack down, per unit of flow.
    let mut resistance = vec![0.0];
    apertures.iter().rev().for_each(|e| resistance.push(resistance[resistance.len() - 1] + 1.0 / e.powi(3)));
    let head = |k: usize| WATER - FOOT[1] + k as f64 * fall;
    let (flow, last) =
        (1..=count).map(|k| (head(k) / resistance[k], k)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("one");
    let pressure = |k: usize| if k < last { 9810.0 * (head(k) - flow * resistance[k]) } else { 0.0 };
    (0..count).map(|k| 0.5 * (pressure(k) + pressure(k + 1)) * step).sum()
}

/// Sixteen joints with the resistances of an aperture that goes linearly from the toe to the crack.
fn tapered(toe: f64, crack: f64) -> Vec<f64> {
    let at = |k: usize| toe + (crack - toe) * k as f64 / 16.0;
    let pair = |k: usize| (2.0 * at(k).powi(2) * at(k + 1).powi(2) / (at(k) + at(k + 1))).cbrt();
    (0..16).map(pair).collect()
}

/// Tolerance of the solver of linear programs: 1e-4.
#[test]
fn limit_analysis_has_the_uplift_of_water_that_flows() {
    let even = vec![1e-4; 16];
    for (apertures, quoted) in
        [(vec![1e-4], 1.03105), (even, 1.03105), (tapered(5e-5, 2e-4), 0.5964), (tapered(2e-4, 5e-5), 1.1457)]
    {
        let exact = factor(|length| uplift(&apertures, length));
        assert!((exact / quoted - 1.0).abs() < 2e-4, "{exact} {quoted}");
        let found = bound(&case(&slide(&apertures))).expect("a bound").associated.factor.value();
        println!("{} joints: {found:.5} of {exact:.5}", apertures.len());
        assert!((found / exact - 1.0).abs() < 1e-4, "{found} instead of {exact}");
    }
}

/// 0.5 % is the width of the bracket, as for the same slide without water that flows.
#[test]
fn strength_reduction_keeps_the_pressures_of_the_slope_at_rest() {
    let exact = factor(|length| uplift(&[1e-4], length));
    let found = factor_of_safety(&case(&slide(&[1e-4])), &ReductionOptions::default(), &mut |_, _| {});
    let factor = found.unwrap_or_else(|e| panic!("{e}")).factor().expect("a factor");
    println!("{factor:.4} of {exact:.4}");
    assert!((factor / exact - 1.0).abs() < 5e-3, "{factor} instead of {exact}");
}

/// Uplift (N/m) of the water in the plane now.
fn uplift_of(simulation: &Simulation) -> f64 {
    let net = simulation.model().flow.as_ref().expect("a net");
    let unknowns = &simulation.state().seepage.as_ref().expect("water that flows").unknowns;
    let of = |piece: &FlowPiece| {
        let [a, b] = piece.nodes.map(|node| net.places[node as usize]);
        let part = wet(piece.nodes.map(|node| unknowns[node as usize]), [a.y, b.y]).filter(|_| a.x != b.x);
        part.map_or(0.0, |part| {
            0.5 * (part.heads[0] + part.heads[1]) * (part.span[1] - part.span[0]).abs() * piece.length
        })
    };
    9810.0 * net.pieces.iter().map(of).sum::<f64>()
}

/// The crack has drained by 3 m in 500 s, and the plane, whose faces close as its pressure falls, lags behind.
#[test]
fn strength_reduction_has_the_pressures_at_the_end_of_a_time() {
    let stage = "[[stage]]\nname = \"later\"\nkind = \"static\"\nduration = 60.0\nheads = { crack = 25.0 }\n";
    let text = slide(&[1e-4])
        .replace("aperture_min = 1e-6", "aperture_min = 1e-4\naperture_max = 1e-2")
        .replace("cohesion = 25e3", "cohesion = 25e3\nnormal_stiffness = 1e9\nshear_stiffness = 1e9");
    let steady = format!("{text}{stage}");
    let later = format!("{text}{stage}flow = {{ time = 500.0, steps = 10 }}\n");
    let begun = |text: &str| {
        let mut simulation = Simulation::new(case(text)).expect("a model");
        let before = uplift_of(&simulation);
        assert!(simulation.next_stage().expect("a stage"));
        (before, uplift_of(&simulation))
    };
    let ((before, end), (_, lags)) = (begun(&steady), begun(&later));
    println!("U {before:.4e}, {lags:.4e} after 500 s, {end:.4e} at last");
    assert!(lags < 0.95 * before && lags > 1.1 * end);
    let exact = factor_at(25.0, |_| lags);
    let found = factor_of_safety(&case(&later), &ReductionOptions::default(), &mut |_, _| {});
    let factor = found.unwrap_or_else(|e| panic!("{e}")).factor().expect("a factor");
    println!("{factor:.4} of {exact:.4}, {:.4} at last", factor_at(25.0, |_| end));
    assert!((factor / exact - 1.0).abs() < 5e-3, "{factor} instead of {exact}");
    assert!((factor_at(25.0, |_| end) / exact - 1.0).abs() > 1e-2, "the lag shows");
}

#[test]
fn rock_that_yields_has_no_bracket_with_water_that_flows() {
    let text = slide(&[1e-4]).replace("young = 20e9", "young = 20e9\nfriction_deg = 40\ncohesion = 1e6");
    match bracket(&case(&text), 200) {
        Err(BoundError::Case(invalid)) => assert!(invalid.key == "flow" && invalid.message.contains("bracket")),
        other => panic!("{other:?}"),
    }
}

/// With stiff joints apertures stay as they were; with soft ones the weight has closed them before the second stage,
/// more at depth, and the trials have other water than limit analysis, which knows no openings.
#[test]
fn other_water_in_trials_than_in_limit_analysis_is_told() {
    let text = slide(&[1e-4; 4]);
    let again = text.split("[[stage]]").nth(1).expect("a stage").replace("gravity", "again");
    let told = |stiffness: f64| {
        let law = format!("friction_deg = 35.0\nnormal_stiffness = {stiffness:e}\nshear_stiffness = {stiffness:e}\n");
        let text = text.replace("friction_deg = 35.0\n", &law) + "[[stage]]" + &again;
        let options = ReductionOptions { tolerance: 0.5, ..ReductionOptions::default() };
        let found = factor_of_safety(&case(&text), &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
        found.warnings.iter().find(|warning| warning.starts_with("water presses on the joints")).cloned()
    };
    assert_eq!(told(1e12), None);
    let warning = told(1e10).expect("a warning");
    assert!(warning.contains("aperture_min"), "{warning}");
}

/// In trials no piece parts, however little `part` lets it open: a slide that has begun is not caught.
#[test]
fn no_joint_parts_in_trials() {
    let shaken = "[[stage]]\nname = \"after\"\nkind = \"dynamic\"\nduration = 1.0\n";
    let found = |part: &str| {
        let text = slide(&[1e-4]).replace("[flow]\n", &format!("[flow]\n{part}")) + shaken;
        let options = ReductionOptions { tolerance: 0.1, ..ReductionOptions::default() };
        let found = factor_of_safety(&case(&text), &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(found.simulation.parted().pieces, 0);
        found.trials.iter().map(|trial| (trial.factor, trial.verdict, trial.displacement)).collect::<Vec<_>>()
    };
    let usual = found("");
    assert!(usual.iter().any(|trial| trial.2 > 1e-4), "{usual:?}");
    assert_eq!(found("part = 1e-6\n"), usual);
}
