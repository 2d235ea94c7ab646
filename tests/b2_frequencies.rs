//! Claim B2: beams and bars swing with their closed-form frequencies; the error falls with h².

mod common;

use std::f64::consts::PI;

use common::simulation;
use enmm::geometry::Vector;
use enmm::model::Simulation;

const DENSITY: f64 = 2500.0;
const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.25;

/// A beam of 10 m × 1 m about the x axis without gravity or damping.
fn beam(plane: &str, size: f64, fixes: &str) -> Simulation {
    simulation(&format!(
        "title = \"beam\"\n[domain]\noutline = [[0.0, -0.5], [10.0, -0.5], [10.0, 0.5], [0.0, 0.5]]\n[mesh]\n\
        size = {size}\n\
         origin = [0.013, -0.007]\n[rock.rock]\ndensity = {DENSITY}\nyoung = {YOUNG:e}\npoisson = {POISSON}\n\
         plane = \"{plane}\"\n[gravity]\ny = 0.0\n{fixes}[[monitor]]\nname = \"middle\"\npoint = [5.0, 0.0]\n\
         [[monitor]]\nname = \"end\"\npoint = [10.0, 0.0]\n[[stage]]\nname = \"swing\"\nkind = \"dynamic\"\n\
         duration = 100.0\ndamping = 0.0\n"
    ))
}

/// Gives the covers a velocity field and measures the frequency of `signal` by its zero crossings over some swings.
fn frequency(
    mut simulation: Simulation,
    field: impl Fn(Vector) -> Vector,
    signal: impl Fn(&Simulation) -> f64,
    swings: usize,
) -> f64 {
    let mut state = simulation.state().clone();
    state.velocity = simulation.model().covers.star_position.iter().map(|x| field(*x) * 1e-3).collect();
    simulation.restore(state);
    let dt = simulation.model().dt;
    let (mut before, mut crossings) = (0.0, Vec::new());
    for step in 1..10_000_000u64 {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let now = signal(&simulation);
        if before < 0.0 && now >= 0.0 {
            crossings.push((step as f64 - now / (now - before)) * dt);
            if crossings.len() > swings {
                break;
            }
        }
        before = now;
    }
    swings as f64 / (crossings[swings] - crossings[0])
}

/// Frequencies on three meshes, with the rate and the extrapolated value against `exact`.
///
/// Linear covers are too stiff in bending by a share of h²: 2.3 % with 8 rows (half that of the deflection, method §6).
/// Richardson's rule leaves the square of it. Leapfrog adds (ω dt)²/24 < 1e-5 (theory Eq. 27).
fn assert_converges(name: &str, f: [f64; 3], exact: f64, tolerance: f64) -> f64 {
    let errors = f.map(|f| f / exact - 1.0);
    let rate = ((f[0] - f[1]) / (f[1] - f[2])).log2();
    let limit = f[2] + (f[2] - f[1]) / 3.0;
    println!("{name}: {f:?} Hz, errors {errors:?}, rate {rate}, limit {:e}", limit / exact - 1.0);
    assert!((1.5..2.5).contains(&rate), "{name}: rate {rate}");
    assert!((limit / exact - 1.0).abs() < tolerance, "{name}: {limit} of {exact} Hz");
    limit
}

/// Root of the antisymmetric Rayleigh–Lamb equation tan(qd)/tan(pd) = −4k²pq/(q² − k²)², d half the depth, for the
/// wavelength 2L: the exact plane problem of a beam whose ends slide along x (there u_y = 0 and σ_xx = 0). Below both
/// wave speeds p and q are imaginary: tanh(ad)/tanh(bd)·4k²ab·… = (b² + k²)², by bisection in ω.
fn rayleigh_lamb(plane: &str) -> f64 {
    let mu = YOUNG / (2.0 * (1.0 + POISSON));
    let lambda = match plane {
        "stress" => YOUNG * POISSON / (1.0 - POISSON * POISSON),
        _ => YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)),
    };
    let (k, d) = (PI / 10.0, 0.5f64);
    let equation = |f: f64| {
        let w = 2.0 * PI * f;
        let a = (k * k - w * w * DENSITY / (lambda + 2.0 * mu)).sqrt();
        let b = (k * k - w * w * DENSITY / mu).sqrt();
        (b * b + k * k).powi(2) * (a * d).tanh() - 4.0 * k * k * a * b * (b * d).tanh()
    };
    let (mut low, mut high) = (0.5, 6.0);
    assert!(equation(low) * equation(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if equation(low) * equation(middle) <= 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Simply supported: 2.867869 Hz for a slender beam of plane stress; shear and rotary inertia of this one take
/// ½(π/L)²/12·(1 + 2.4(1 + ν)) = 1.6 %, which the exact plane problem holds.
#[test]
fn a_simply_supported_beam_swings() {
    let slender = 0.5 * PI * (YOUNG / (12.0 * DENSITY)).sqrt() / 100.0;
    assert!((slender - 2.867869).abs() < 1e-6);
    for plane in ["stress", "strain"] {
        let fixes = "[[fix]]\nedge = [[0.0, -0.5], [0.0, 0.5]]\naxes = \"y\"\n[[fix]]\n\
                     edge = [[10.0, -0.5], [10.0, 0.5]]\naxes = \"y\"\n";
        let k = PI / 10.0;
        let mode = |x: Vector| Vector::new(-k * x.y * (k * x.x).cos(), (k * x.x).sin());
        let f = [0.25, 0.125, 0.0625].map(|size| {
            frequency(beam(plane, size, fixes), mode, |s| s.monitor(0).0.y, if size < 0.1 { 2 } else { 5 })
        });
        let limit = assert_converges(&format!("simply supported, {plane}"), f, rayleigh_lamb(plane), 5e-4);
        let factor = if plane == "stress" { 1.0 } else { 1.0 / (1.0 - POISSON * POISSON).sqrt() };
        assert!((0.975..0.99).contains(&(limit / slender / factor)), "{limit} against the slender {slender}");
    }
}

/// Cantilever: 1.8751²/2π·√(EI/ρA)/L² = 1.021669 Hz when slender. By Rayleigh's quotient shear takes half of
/// 3.6EI/GAL² = 0.75 % (the share of a load at the end) and rotary inertia half of 4.65·I/AL² = 0.39 % of the
/// frequency; plane strain is higher by 1/√(1 − ν²) = 1.0328. The corners of the clamp are singular: the limit is
/// right to 0.3 %.
#[test]
fn a_cantilever_swings() {
    let slender = 1.875104f64.powi(2) / (2.0 * PI) * (YOUNG / (12.0 * DENSITY)).sqrt() / 100.0;
    assert!((slender - 1.021669).abs() < 1e-6);
    let fixes = "[[fix]]\nedge = [[0.0, -0.5], [0.0, 0.5]]\n";
    // Shape of the first mode, with the turn of the sections.
    let (b, r) = (0.1875104, 0.734096);
    let shape = |x: f64| (b * x).cosh() - (b * x).cos() - r * ((b * x).sinh() - (b * x).sin());
    let slope = |x: f64| b * ((b * x).sinh() + (b * x).sin() - r * ((b * x).cosh() - (b * x).cos()));
    let mode = |x: Vector| Vector::new(-x.y * slope(x.x), shape(x.x));
    let limits = ["stress", "strain"].map(|plane| {
        let factor = if plane == "stress" { 1.0 } else { 1.0 / (1.0 - POISSON * POISSON).sqrt() };
        let f = [0.5, 0.25, 0.125].map(|size| frequency(beam(plane, size, fixes), mode, |s| s.monitor(1).0.y, 3));
        assert_converges(&format!("cantilever, {plane}"), f, 0.9943 * slender * factor, 3e-3)
    });
    assert!((limits[1] / limits[0] / 1.0328 - 1.0).abs() < 5e-3, "{limits:?}");
}

/// Free-free bar in plane stress: √(E/ρ)/2L = 31.6228 Hz, less ½(νk)²I/A = 2.6e-4 by its lateral inertia. The block is
/// free: its rigid-exact mass takes part. Axial strain is nearly uniform in an element: the error is small on any mesh.
#[test]
fn a_free_bar_rings() {
    let slender = (YOUNG / DENSITY).sqrt() / 20.0;
    assert!((slender - 31.6228).abs() < 1e-4);
    let k = PI / 10.0;
    let exact = slender * (1.0 - 0.5 * (POISSON * k).powi(2) / 12.0);
    let mode = |x: Vector| Vector::new((k * x.x).cos(), POISSON * k * x.y * (k * x.x).sin());
    for (size, tolerance) in [(0.5, 4e-3), (0.25, 1.5e-3), (0.125, 7e-4)] {
        let f = frequency(beam("stress", size, ""), mode, |s| s.monitor(1).0.x, 10);
        println!("bar, h = {size}: {f} Hz, {:e}", f / exact - 1.0);
        assert!((f / exact - 1.0).abs() < tolerance, "h = {size}: {f} of {exact} Hz");
    }
}
