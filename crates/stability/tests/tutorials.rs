//! The cases of the tutorials run and show what their comments and the pages in `docs/book` say.

use std::f64::consts::PI;
use std::path::PathBuf;

use crate::common::extent::{Extent, extent};
use crate::common::{case, example, examples, run_all, run_stage, simulation};
use crate::support::{factor, without};
use enmm_stability::limit_analysis::bound;
use enmm_stability::up_to_stage;

/// Factor by `enmm bound` for joints that dilate by their friction angle.
fn limit(text: &str) -> f64 {
    bound(&case(text)).unwrap_or_else(|e| panic!("{e}")).associated.factor.value()
}

/// Factor of the wedge of `road_cut.toml` as one rigid body by the formula of Hoek and Bray, which shares no code with
/// the engine, with `crack_water` (m) in the tension crack and the force of the bolts `bolts` (N/m).
fn hoek_and_bray(crack_water: f64, bolts: f64) -> f64 {
    let (toe, foot, crest) = ([0.8, 2.0], [16.0, 11.49801], [8.0, 20.0]);
    let polygon = [toe, foot, [foot[0], crest[1]], crest];
    let twice = |k: usize| polygon[k][0] * polygon[(k + 1) % 4][1] - polygon[(k + 1) % 4][0] * polygon[k][1];
    let area = (0..4).map(twice).sum::<f64>() / 2.0;
    let (run, rise): (f64, f64) = (foot[0] - toe[0], foot[1] - toe[1]);
    let (dip, below) = (rise.atan2(run), 10.0 * PI / 180.0);
    let weight = 2650.0 * 9.81 * area;
    let uplift = 1000.0 * 9.81 * crack_water * run.hypot(rise) / 2.0;
    let thrust = 1000.0 * 9.81 * crack_water * crack_water / 2.0;
    let normal = weight * dip.cos() - uplift - thrust * dip.sin() + bolts * (dip + below).sin();
    let driving = weight * dip.sin() + thrust * dip.cos() - bolts * (dip + below).cos();
    normal * 36f64.to_radians().tan() / driving
}

/// Asserts that the comment of a case has the row `name` with these numbers.
fn assert_row(text: &str, name: &str, numbers: [f64; 2]) {
    let row = text.lines().find(|line| line.starts_with(&format!("# {name} "))).expect(name);
    let [formula, found] = numbers.map(|number| format!("{number:.4}"));
    assert!(row.contains(&format!("  {formula}    {found}")), "{numbers:?} instead of {row}");
}

/// Text and formula of the road cut with water, and dry, both without bolts.
fn without_bolts(all: &str) -> [(String, f64); 2] {
    let wet = without(all, "[[stage]]\nname = \"bolts\"", "[[monitor]]");
    let dry = without(&wet, "\n[water]", "# The base is held");
    [(wet, hoek_and_bray(3.0, 0.0)), (dry, hoek_and_bray(0.0, 0.0))]
}

/// Strength reduction agrees with the formula within 0.5 %, the width of its bracket: the fault is plane and without
/// cohesion, so that joints in the wedge change nothing. The comment of the case has both.
fn wedge_as_its_comment_says(all: &str, name: &str, text: &str, exact: f64) -> f64 {
    let found = factor(text);
    assert!((found / exact - 1.0).abs() < 5e-3, "{name}: {found} instead of {exact}");
    assert_row(all, name, [exact, found]);
    found
}

/// Limit analysis agrees with the formula within the rounding of the coordinates. Trials close to the factor creep for
/// half a minute of computing: the quick form leaves strength reduction out.
#[test]
fn long_the_road_cut_has_the_factors_of_hoek_and_bray() {
    let all = example("road_cut");
    let [(wet, wet_exact), (dry, dry_exact)] = without_bolts(&all);
    let bolted = hoek_and_bray(3.0, 3.0 * 250e3 / 2.0);
    let rows =
        [("water and bolts", &all, bolted), ("water, no bolts", &wet, wet_exact), ("dry, no bolts", &dry, dry_exact)];
    for (name, text, exact) in rows {
        let limit = limit(text);
        assert!((limit / exact - 1.0).abs() < 3e-4, "{name}: bound {limit} instead of {exact}");
        if extent() >= Extent::Full {
            wedge_as_its_comment_says(&all, name, text, exact);
        }
    }
}

/// Joints in the wedge change nothing, except that chips may fall earlier: no network of joints may hold the slope. A
/// crumb at the toe that joined the rock below the fault did: five of these networks had bounds of 4.6 to 7.3.
#[test]
fn no_network_of_joints_holds_the_road_cut() {
    let all = example("road_cut");
    let exact = hoek_and_bray(3.0, 3.0 * 250e3 / 2.0);
    let (mut slides, seeds) = (0, [1, 20, 106, 107, 185, 331, 447, 602, 792].into_iter().chain(2..8));
    let networks = seeds.map(|seed| {
        let text = all.replace("seed = 1\n", &format!("seed = {seed}\n"));
        (seed, text.replace("seed = 2\n", &format!("seed = {}\n", seed + 1)))
    });
    for (seed, text) in networks {
        let found = limit(&text);
        assert!(found < exact * (1.0 + 3e-4), "seed {seed}: {found} is above {exact}");
        slides += usize::from(found > exact * (1.0 - 3e-4));
    }
    assert!(slides > 10, "{slides} of 15 networks slide as a whole");
}

/// Both static stages end at rest, and the bolts move the crest by less than a millimetre.
#[test]
fn the_road_cut_rests_before_and_after_bolting() {
    let mut simulation = simulation(&example("road_cut"));
    let reports = run_all(&mut simulation);
    assert_eq!(reports.len(), 2);
    assert!(reports.iter().all(|report| report.unbalanced < 1e-5), "{reports:?}");
    assert!(simulation.monitor(0).0.norm() < 1e-3, "{:?}", simulation.monitor(0));
}

/// The column at the crest moves out of the slope (to the left) by more than a metre, and by more than it falls; the
/// rock behind stays.
#[test]
fn the_columns_of_the_drawing_topple() {
    let mut simulation = simulation(&example("toppling"));
    run_stage(&mut simulation);
    assert!(simulation.monitor(0).0.norm() < 0.01, "the fresh slope rests: {:?}", simulation.monitor(0));
    assert!(simulation.next_stage().expect("a stage"));
    run_stage(&mut simulation);
    let [crest, behind] = [0, 1].map(|k| simulation.monitor(k).0);
    assert!(crest.x < -1.0 && crest.x.abs() > crest.y.abs() && behind.norm() < 0.01, "{crest:?} {behind:?}");
}

/// Fresh columns without dilation are weaker than limit analysis allows, which lets joints dilate.
#[test]
fn the_fresh_columns_bear_less_than_limit_analysis_allows() {
    let text = example("toppling");
    let (found, limit) = (factor(&text), limit(&text));
    assert!(found > 1.0 && found < limit, "{found} {limit}");
    assert!(text.contains(&format!("{found:.4}")) && text.contains(&format!("{limit:.4}")), "{found} {limit}");
}

/// No stage of the pit fails, and the floor rises with each stage as rock is taken off.
#[test]
fn the_pit_is_dug_in_three_stages() {
    let mut simulation = simulation(&example("pit"));
    run_stage(&mut simulation);
    let mut rises = vec![simulation.monitor(2).0.y];
    assert!(rises[0].abs() < 5e-5, "nothing moves before the pit: {rises:?}");
    while simulation.next_stage().expect("a stage") {
        run_stage(&mut simulation);
        rises.push(simulation.monitor(2).0.y);
    }
    assert_eq!(rises.len(), 4);
    assert!(rises.windows(2).all(|pair| pair[1] > pair[0] + 1e-4), "{rises:?}");
    assert!(simulation.monitor(0).0.norm() < 1e-3, "{:?}", simulation.monitor(0));
}

/// The wedge on the fault of the finished pit has the factor tan φ / tan ψ of a body on a plane without cohesion.
#[test]
fn long_the_finished_pit_has_the_factor_of_its_wedge() {
    let text = example("pit");
    let exact = 44f64.to_radians().tan() / (15.5 / 19.0);
    let limit = limit(&text);
    assert!((limit / exact - 1.0).abs() < 3e-4, "bound {limit} instead of {exact}");
    if extent() >= Extent::Full {
        let found = factor(&text);
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} instead of {exact}");
        assert!(text.contains(&format!("{exact:.4}. enmm fos: {found:.4}")), "{exact} {found}");
    }
}

/// The first line of every example leads editors to the schema.
#[test]
fn every_example_names_its_schema() {
    let files = std::fs::read_dir(examples()).expect("a folder").map(|entry| entry.expect("an entry").path());
    let cases: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    assert!(cases.len() >= 11, "{cases:?}");
    for path in cases {
        let text = std::fs::read_to_string(&path).expect("a case");
        let schema = text.lines().next().and_then(|line| line.strip_prefix("#:schema "));
        let schema = schema.unwrap_or_else(|| panic!("{}: begins without `#:schema`", path.display()));
        assert!(examples().join(schema).is_file(), "{}: {schema}", path.display());
    }
}

/// Bridges of the step path: the more brittle, the less they hold together; the rain breaks all of them.
#[test]
fn long_the_step_path_has_the_factors_of_its_page_and_breaks_in_the_rain() {
    let ductile = example("step_path");
    let brittle = ductile.replace("tension_energy = 20\n", "").replace("shear_energy = 500", "shear_energy = 1");
    assert!((limit(&ductile) - 1.87).abs() < 0.01, "{}", limit(&ductile));
    if extent() >= Extent::Full {
        let [soft, hard] = [&ductile, &brittle].map(|text| factor(text));
        assert!((soft - 1.40).abs() < 0.01 && (hard - 0.92).abs() < 0.01, "{soft} and brittle {hard}");
    }
    let mut simulation = simulation(&ductile);
    run_all(&mut simulation);
    let broken = simulation.state().counters.broken;
    assert!((broken - 2.79).abs() < 0.01, "{broken} m broken");
}

/// Wedge between a plane from the origin to `FOOT`, a crack from there to a height of 30 m and a face.
struct Wedge<'a> {
    face: &'a [[f64; 2]],
    cohesion: f64,
}

/// Foot of the crack (m).
const FOOT: [f64; 2] = [32.8474042, 23.0];

impl Wedge<'_> {
    /// Length of the plane (m).
    fn length() -> f64 {
        FOOT[0].hypot(FOOT[1])
    }

    /// Factor of Hoek and Bray for 35° of friction with an uplift (N/m) and a depth of water in the crack (m).
    fn factor(&self, uplift: f64, water: f64) -> f64 {
        let mut polygon = vec![[0.0, 0.0], FOOT, [FOOT[0], 30.0]];
        polygon.extend(self.face);
        let next = |k: usize| polygon[(k + 1) % polygon.len()];
        let twice = |k: usize| polygon[k][0] * next(k)[1] - next(k)[0] * polygon[k][1];
        let weight = 2650.0 * 9.81 * (0..polygon.len()).map(twice).sum::<f64>() / 2.0;
        let (s, c) = (FOOT[1] / Self::length(), FOOT[0] / Self::length());
        let push = 0.5 * 9810.0 * water * water;
        let normal = weight * c - uplift - push * s;
        (self.cohesion * Self::length() + normal * 35f64.to_radians().tan()) / (weight * s + push * c)
    }
}

/// Transmissivity (m²/s) of a joint of an aperture (m): γe³/12μ.
fn transmissivity(aperture: f64) -> f64 {
    9810.0 * aperture.powi(3) / 12e-3
}

/// A case with a value in place of another.
fn with(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

fn page(name: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/book").join(name);
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Asserts that a page, or a comment, has a row of these words with any number of spaces between them.
fn assert_has(text: &str, row: &str) {
    let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(squeezed(text).contains(&squeezed(row)), "no {row}");
}

/// 2e-4 are the rounding of coordinates and the tolerance of the program.
fn assert_near(found: f64, exact: f64) {
    assert!((found / exact - 1.0).abs() < 3e-4, "{found} instead of {exact}");
}

#[test]
fn the_row_of_drains_has_the_factors_of_its_page() {
    let text = example("../flow/drained_bench");
    let page = page("drained_bench.md");
    let wedge = Wedge { face: &[[21.3205081, 30.0], [10.9282032, 12.0], [6.9282032, 12.0]], cohesion: 30e3 };
    let (mouth, dip) = ([10.9282032, 12.0], FOOT[1] / FOOT[0]);
    let none = wedge.factor(0.5 * 9810.0 * 6.0 * Wedge::length(), 6.0);
    let found = limit(&with(&text, "drain = [\"row\"]", "drain = []"));
    assert_near(found, none);
    assert_has(&page, &format!("| none | 0.0 | 1.180 | {none:.4} | {found:.4} | 0.000 |"));
    assert_has(&text, &format!("# none 1.180 {none:.4} {found:.4}"));
    for (angle, end) in
        [(5.0, "[19.5, 12.75]"), (15.0, "[22.0, 14.97]"), (20.0, "[24.8, 17.05]"), (25.0, "[30.4, 21.08]")]
    {
        let slope = f64::to_radians(angle).tan();
        let run = (mouth[1] - dip * mouth[0]) / (dip - slope);
        let left = Wedge::length() - (mouth[0] + run).hypot(mouth[1] + run * slope);
        let (uplift, long) = (0.5 * 9810.0 * 6.0 * left, run.hypot(run * slope));
        let flow = transmissivity(1e-4) * (6.0 + left * FOOT[1] / Wedge::length()) / left * 6e4;
        let exact = wedge.factor(uplift, 6.0);
        let found = limit(&with(&text, "[19.5, 12.75]]\nactive", &format!("{end}]\nactive")));
        assert_near(found, exact);
        let numbers = format!("{long:.1} | {:.3} | {exact:.4} | {found:.4} | {flow:.3} |", uplift / 1e6);
        assert_has(&page, &format!("| {angle}° upwards | {numbers}"));
        assert_has(&text, &format!("{end} {long:.1} m {:.3} {exact:.4} {found:.4}", uplift / 1e6));
    }
    // A table of still water knows no drain.
    let still = "[water]\ntable = [[0.0, 0.0], [32.8474042, 29.0]]\n\n[[fix]]\nedge = [[-16.7320508, -10.0], [36.0";
    let dry = without(&text, "[flow]", "[[fix]]").replace("aperture = 1e-4\n", "").replace("aperture = 1e-3\n", "");
    let dry = with(&dry, "drain = [\"row\"]", "");
    let table = limit(&with(&dry, "[[fix]]\nedge = [[-16.7320508, -10.0], [36.0", still));
    assert_near(table, none);
    assert_has(&page, &format!("It gives {table:.4}, the same as the flow without drains"));
}

#[test]
fn the_storm_has_the_factors_of_its_page() {
    let text = example("../flow/storm");
    let page = page("storm.md");
    let wedge = Wedge { face: &[[17.3205081, 30.0]], cohesion: 25e3 };
    let (t, length) = (transmissivity(0.5e-3), Wedge::length());
    let ground = 60.0 - FOOT[0];
    for rain in [5.0_f64, 8.0, 9.0, 10.0, 20.0] {
        let flow = rain / 3.6e6 * ground;
        let water = (flow * length / t - FOOT[1]).clamp(0.0, 7.0);
        let off = (flow - t * 30.0 / length).max(0.0) / ground * 3.6e6;
        let exact = wedge.factor(0.5 * 9810.0 * water * length, water);
        let rate = rain / 3.6e6;
        let found = limit(&with(&text, "plateau = 2.5e-6", &format!("plateau = {rate:.8e}")));
        assert_near(found, exact);
        assert_has(&page, &format!("| {rain} | {water:.2} | {exact:.4} | {found:.4} | {off:.2} |"));
        assert_has(&text, &format!("# {rain} {water:.2} m {off:.2} {exact:.4} {found:.4}"));
    }
    for water in [1.0_f64, 3.0, 5.0, 7.0] {
        let exact = wedge.factor(0.5 * 9810.0 * water * length, water);
        assert_has(&page, &format!("| {water} | {exact:.4} |"));
    }
}

/// Factor of the wedge of `drawdown.toml` with a level (m) of the reservoir and a head (m) in the crack: the reservoir
/// holds the face, which dips by 60°.
fn drawn_down(level: f64, head: f64) -> f64 {
    let (length, cohesion) = (Wedge::length(), 45e3);
    let (s, c) = (FOOT[1] / length, FOOT[0] / length);
    let polygon = [[0.0, 0.0], FOOT, [FOOT[0], 30.0], [17.3205081, 30.0]];
    let twice = |k: usize| polygon[k][0] * polygon[(k + 1) % 4][1] - polygon[(k + 1) % 4][0] * polygon[k][1];
    let weight = 2650.0 * 9.81 * (0..4).map(twice).sum::<f64>() / 2.0;
    let water = (head - FOOT[1]).max(0.0);
    let uplift = match water > 0.0 {
        true => 0.5 * 9810.0 * length * (level + water),
        false => 0.5 * 9810.0 * level * level / s,
    };
    let (face_s, face_c) = f64::to_radians(60.0).sin_cos();
    let hold = 0.5 * 9810.0 * level * level / face_s;
    let [x, y] = [hold * face_s - 0.5 * 9810.0 * water * water, -hold * face_c - weight];
    let normal = x * s - y * c - uplift;
    (cohesion * length + normal * 35f64.to_radians().tan()) / (-x * c - y * s)
}

/// Steps of a quarter of an hour lag behind the exponential of 3.36 days by a thousandth of it, and the plane holds
/// some water too.
#[test]
fn the_drawdown_has_the_factors_of_its_page() {
    let text = example("../flow/drawdown");
    let page = page("drawdown.md");
    let day = 86400.0;
    let (rate, tau) = (21.0 / day, 20e-3 * Wedge::length() / transmissivity(1.5e-4));
    let over = |time: f64| rate * tau * (1.0 - (-time / tau).exp());
    let mut least = (f64::INFINITY, "");
    for (name, hours) in
        [("full", 0.0), ("6 h", 6.0), ("12 h", 12.0), ("18 h", 18.0), ("24 h", 24.0), ("36 h", 36.0), ("48 h", 48.0)]
    {
        let time: f64 = 3600.0 * hours;
        let level = (29.0 - rate * time).max(8.0);
        let head = if time <= day { level + over(time) } else { level + over(day) * (-(time - day) / tau).exp() };
        let exact = drawn_down(level, head);
        let case = up_to_stage(&case(&text), Some(name)).expect("a stage");
        let found = bound(&case).unwrap_or_else(|e| panic!("{e}")).associated.factor.value();
        println!("{name}: {level:.2} {head:.2} {exact:.4} {found:.4}");
        assert!((found / exact - 1.0).abs() < 2e-3, "{name}: {found} instead of {exact}");
        let head = if head > FOOT[1] { format!("{head:.2}") } else { "empty".to_owned() };
        assert_has(&page, &format!("| {name} | {level:.2} | {head} | {exact:.4} | {found:.4} |"));
        assert_has(&text, &format!("# {name} {level:.2} {head} {exact:.4} {found:.4}"));
        least = if found < least.0 { (found, name) } else { least };
    }
    assert_eq!(least.1, "18 h");
    for exact in [drawn_down(8.0, 8.0), drawn_down(8.0, 29.0)] {
        assert_has(&page, &format!("{exact:.4}"));
    }
}
