//! Claim: rock yields at its Mohr–Coulomb or Hoek–Brown strength along any strain path, flows at its dilation
//! angle, and does both in every element of a cut mesh and in any rotated frame.

use crate::common::simulation;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::model::tables::ElementId;

const COHESION: f64 = 1e6;

/// A held square cut by two joints and a turned mesh: displacements are given, and stay.
fn held(strength: &str) -> Simulation {
    simulation(&format!(
        "title = \"path\"\n[domain]\noutline = [[0, 0], [2, 0], [2, 2], [0, 2]]\n[mesh]\nsize = 0.6\nangle_deg = 13\n\
         [[joint]]\npoints = [[-1, 0.4], [3, 1.3]]\n[[joint]]\npoints = [[0.7, -1], [1.1, 3]]\n[gravity]\ny = 0\n\
         [rock.rock]\ndensity = 2500\nyoung = 2e9\npoisson = 0.3\n{strength}\n[joint_law.joint]\n\
         friction_deg = 30\n[[fix]]\nbox = [-2, -2, 4, 4]\n[[stage]]\nname = \"hold\"\nkind = \"dynamic\"\n\
         duration = 10\n"
    ))
}

/// Gives the rock a uniform strain xx, yy turned by `angle` (rad) as a whole, lets it yield, and returns the stress
/// of
/// its elements turned back, which must be the same in all.
fn strained(simulation: &mut Simulation, [xx, yy]: [f64; 2], angle: f64) -> [f64; 3] {
    sheared(simulation, [xx, yy, 0.0], angle)
}

/// The same for a strain xx, yy, xy.
fn sheared(simulation: &mut Simulation, [xx, yy, xy]: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    let mut state = simulation.state().clone();
    let place = |x: &Vector| {
        let y = Vector::new(x.x * (1.0 + xx) + x.y * xy, x.x * xy + x.y * (1.0 + yy));
        Vector::new(c * y.x - s * y.y, s * y.x + c * y.y) - x
    };
    state.displacement = simulation.model().covers.star_position.iter().map(place).collect();
    simulation.restore(state);
    simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    let (slope, state) = (simulation.model(), simulation.state());
    let back = |[xx, yy, xy]: [f64; 3]| {
        let both = 2.0 * s * c * xy;
        [c * c * xx + s * s * yy + both, s * s * xx + c * c * yy - both, s * c * (yy - xx) + (c * c - s * s) * xy]
    };
    let first = back(slope.stress(state, ElementId::new(0)));
    for e in slope.covers.elements() {
        let other = back(slope.stress(state, e));
        // Rounding of displacements of 1 m over cut elements of a mesh of 0.6 m: 1e-15·E, and of greater stresses.
        let size = first.iter().fold(COHESION, |most, stress| most.max(stress.abs()));
        assert!((0..3).all(|k| (other[k] - first[k]).abs() < 1e-9 * size), "{e}: {other:?} {first:?}");
    }
    first
}

/// Shortens the rock along y in steps while the stress along x stays `lateral` (Pa): secant steps on a copy. Returns
/// the last stress and the strains xx, yy of the last two steps.
fn biaxial(simulation: &mut Simulation, lateral: f64, step: f64, count: i32) -> ([f64; 3], [[f64; 2]; 2]) {
    let (mut across, mut path, mut stress) = (0.0, [[0.0; 2]; 2], [0.0; 3]);
    for k in 1..=count {
        let yy = step * f64::from(k);
        let angle = 0.01 * f64::from(k);
        let start = simulation.state().clone();
        let mut at = |xx: f64| {
            simulation.restore(start.clone());
            strained(simulation, [xx, yy], angle)
        };
        let (mut a, mut b) = (across, across - 0.5 * step);
        let (mut low, mut high) = (at(a)[0] - lateral, at(b)[0] - lateral);
        for _ in 0..60 {
            if (high - low).abs() < 1e-9 * COHESION || low.abs() < 1e-9 * COHESION {
                break;
            }
            let next = a - low * (b - a) / (high - low);
            (b, high) = (a, low);
            (a, low) = (next, at(next)[0] - lateral);
        }
        stress = at(a);
        across = a;
        path = [path[1], [a, yy]];
    }
    (stress, path)
}

/// At failure σyy = −(Kp·p + 2c·√Kp) with Kp = (1 + sin φ)/(1 − sin φ), and then dεxx/dεyy = −(1 + sin ψ)/(1 − sin
/// ψ), for
/// stresses no longer change and so all strain is plastic. The stress out of the plane stays the middle one.
/// Rounding of
/// strains of 1e-2 is 1e-16·E/c = 1e-13; the search for the lateral strain stops at 1e-9.
#[test]
fn biaxial_compression_has_strength_and_dilation() {
    for (phi, psi, lateral) in [(30.0f64, 0.0f64, -2e6), (40.0, 12.0, -5e5), (25.0, 25.0, -1e6), (0.0, 0.0, -1e6)] {
        let mut simulation = held(&format!("cohesion = {COHESION:e}\nfriction_deg = {phi}\ndilation_deg = {psi}"));
        let (stress, [before, after]) = biaxial(&mut simulation, lateral, -5e-4, 24);
        let ratio = |degrees: f64| (1.0 + degrees.to_radians().sin()) / (1.0 - degrees.to_radians().sin());
        let exact = ratio(phi) * lateral - 2.0 * COHESION * ratio(phi).sqrt();
        assert!((stress[1] / exact - 1.0).abs() < 1e-8, "φ = {phi}: {} against {exact}", stress[1]);
        let slope = (after[0] - before[0]) / (after[1] - before[1]);
        assert!((slope + ratio(psi)).abs() < 1e-5 * ratio(psi), "ψ = {psi}: {slope} against {}", -ratio(psi));
    }
}

/// Hoek–Brown rock under lateral pressure fails at σ₁ = σ₃ + σci·(mb·σ₃/σci + s)^a, by a formula of its own here, to
/// one part in a million, and flows without dilation, at an angle, or at that of the tangent of σ₁(σ₃).
#[test]
fn biaxial_compression_has_the_strength_of_hoek_and_brown() {
    let (sigma_ci, mi, gsi, d): (f64, f64, f64, f64) = (30e6, 8.0, 35.0, 0.4);
    let mb = mi * ((gsi - 100.0) / (28.0 - 14.0 * d)).exp();
    let s = ((gsi - 100.0) / (9.0 - 3.0 * d)).exp();
    let a = 0.5 + ((-gsi / 15.0).exp() - (-20.0f64 / 3.0).exp()) / 6.0;
    for lateral in [0.0, -2e5, -2e6] {
        let base = -mb * lateral / sigma_ci + s;
        let exact = lateral - sigma_ci * base.powf(a);
        let slope = 1.0 + a * mb * base.powf(a - 1.0);
        for (flow, expected) in [("", 1.0), ("\ndilation_deg = 8", 0.0), ("associated", slope)] {
            let associated = flow == "associated";
            let more = if associated { "" } else { flow };
            let mut simulation = held(&format!(
                "hoek_brown = {{ sigma_ci = {sigma_ci}, mi = {mi}, gsi = {gsi}, d = {d}, associated = {associated} \
                 }}{more}"
            ));
            let (stress, [before, after]) = biaxial(&mut simulation, lateral, -5e-4, 24);
            assert!((stress[1] / exact - 1.0).abs() < 1e-6, "{lateral}: {} against {exact}", stress[1]);
            let ratio = -(after[0] - before[0]) / (after[1] - before[1]);
            let sine = 8f64.to_radians().sin();
            let expected = if expected == 0.0 { (1.0 + sine) / (1.0 - sine) } else { expected };
            assert!((ratio / expected - 1.0).abs() < 1e-4, "{lateral} {flow}: {ratio} against {expected}");
        }
    }
}

/// In plane stress the strength is that of uniaxial compression, 2c·√Kp, though two stresses are zero; pulled, the
/// rock gives way at its tensile strength; the elements have yielded, which outputs show.
#[test]
fn plane_stress_and_tension_cut_off() {
    let mut simulation = held(&format!("cohesion = {COHESION:e}\nfriction_deg = 35\nplane = \"stress\""));
    let (stress, _) = biaxial(&mut simulation, 0.0, -5e-4, 16);
    let sine = 35f64.to_radians().sin();
    let exact = -2.0 * COHESION * ((1.0 + sine) / (1.0 - sine)).sqrt();
    assert!((stress[1] / exact - 1.0).abs() < 1e-8, "{} against {exact}", stress[1]);
    for plane in ["strain", "stress"] {
        let mut pulled =
            held(&format!("cohesion = {COHESION:e}\nfriction_deg = 35\ntension = 2e5\nplane = \"{plane}\""));
        assert_eq!(pulled.yielded_elements(), 0);
        let (stress, _) = biaxial(&mut pulled, 0.0, 2e-5, 16);
        assert!((stress[1] - 2e5).abs() < 1e-3, "{plane}: {}", stress[1]);
        assert_eq!(pulled.yielded_elements(), pulled.model().covers.element_count());
        let (model, state) = (pulled.model(), pulled.state());
        assert!(model.covers.elements().all(|e| model.plastic_strain(state, e) > 1e-5), "outputs show it");
        let stresses = model.covers.elements().map(|e| model.stress(state, e));
        let shown = stresses.map(|s| s[0] + s[1]).fold(0.0f64, f64::max);
        assert!((shown - 2e5).abs() < 1.0, "outputs show true stress: {shown}");
    }
}

/// Shortens the rock along y in steps between smooth plates: the stress along x stays `lateral` (Pa) and there is no
/// shear stress, by Newton's method on copies. Returns the last stress.
fn between_plates(simulation: &mut Simulation, lateral: f64, step: f64, count: i32) -> [f64; 3] {
    let (mut free, mut stress) = ([0.0; 2], [0.0; 3]);
    for k in 1..=count {
        let (yy, angle) = (step * f64::from(k), 0.01 * f64::from(k));
        let start = simulation.state().clone();
        let mut at = |[xx, xy]: [f64; 2]| {
            simulation.restore(start.clone());
            let stress = sheared(simulation, [xx, yy, xy], angle);
            ([stress[0] - lateral, stress[2]], stress)
        };
        for _ in 0..40 {
            let ([a, b], _) = at(free);
            if a.abs().max(b.abs()) < 1e-6 * COHESION {
                break;
            }
            let small = 1e-7;
            let [by_xx, by_xy] = [at([free[0] + small, free[1]]).0, at([free[0], free[1] + small]).0];
            let [p, q] = [(by_xx[0] - a) / small, (by_xy[0] - a) / small];
            let [r, s] = [(by_xx[1] - b) / small, (by_xy[1] - b) / small];
            let whole = p * s - q * r;
            let change = [(s * a - q * b) / whole, (p * b - r * a) / whole];
            // A round of the size of a step at most, so that it stays on the path.
            let share = (step.abs() / change[0].abs().max(change[1].abs())).min(1.0);
            free = [free[0] - share * change[0], free[1] - share * change[1]];
        }
        stress = at(free).1;
    }
    stress
}

/// Rock with planes of weakness at any dip fails at σ₁ = σ₃ + 2(c + σ₃·tan φ)/((1 − tan φ·cot β)·sin 2β) (J. C. Jaeger
/// 1960), or at the strength of the rock between them where that is less, on a turned mesh and in turned rock. Rounding
/// as above; Newton's method stops at 1e-6 of the cohesion.
#[test]
fn planes_of_weakness_have_the_strength_of_jaeger() {
    let (phi, along, held_by, lateral): (f64, f64, f64, f64) = (40.0, 25.0, 2e5, -5e5);
    let kp = (1.0 + phi.to_radians().sin()) / (1.0 - phi.to_radians().sin());
    let whole = -lateral * kp + 2.0 * COHESION * kp.sqrt();
    let mut weaker = 0;
    for k in 0..=12 {
        let dip = 7.5 * f64::from(k);
        let mut simulation = held(&format!(
            "cohesion = {COHESION:e}\nfriction_deg = {phi}\n[rock.rock.plane_of_weakness]\nangle_deg = {dip}\n\
             friction_deg = {along}\ncohesion = {held_by:e}\n"
        ));
        let stress = between_plates(&mut simulation, lateral, -3e-4, 40);
        let (tan, beta) = (along.to_radians().tan(), dip.to_radians());
        let slips = dip > along && dip < 90.0;
        let jaeger = -lateral + 2.0 * (held_by - lateral * tan) / ((1.0 - tan / beta.tan()) * (2.0 * beta).sin());
        let exact = if slips { whole.min(jaeger) } else { whole };
        weaker += u32::from(exact < whole);
        assert!((-stress[1] / exact - 1.0).abs() < 1e-5, "{dip}°: {} against {exact}", stress[1]);
    }
    assert!(weaker >= 6, "{weaker} dips are weaker than the rock");
}
