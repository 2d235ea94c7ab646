//! Claim: a bond takes its energy of fracture, whatever the steps (theory §7, Bonds that soften).

use enmm::internals::contact::Bond;

/// A metre of bond of A1: σt 5 MPa, G_I 50 J/m², so that it is broken at 20 µm.
fn bond() -> Bond {
    Bond {
        stiffness: [1e13, 1e12],
        tension: 5e6,
        opening: 20e-6,
        shear_energy: 500.0,
        shear: [[0.7, 0.5e6], [0.5, 0.0]],
        damage: 0.0,
        slip: 0.0,
    }
}

/// Opens a bond from `start` to `end` (m) by equal steps; returns work and energy of fracture (J/m).
fn open(bond: &mut Bond, steps: u32, [start, end]: [f64; 2]) -> [f64; 2] {
    let (mut work, mut loss, mut last) = (0.0, 0.0, start);
    for k in 1..=steps {
        let opening = start + (end - start) * f64::from(k) / f64::from(steps);
        let force = bond.normal(-opening, 0.0);
        work -= force * (opening - last);
        let after = bond.after(opening, 0.0, [force, 0.0]);
        (bond.damage, loss, last) = (after.damage, loss + after.loss, opening);
    }
    [work, loss]
}

/// A1: 50 J/m², whether the bond softens in many steps or in two.
#[test]
fn opening_takes_the_energy_of_fracture_at_any_step() {
    for steps in [1000, 50, 3] {
        // From the peak on, so that no step cuts the elastic branch.
        let peak = 0.5e-6;
        let elastic = 0.5 * 5e6 * peak;
        let [work, loss] = open(&mut bond(), steps, [peak, peak + 30e-6]);
        assert!((loss - 50.0).abs() < 1e-9, "{loss}");
        assert!((elastic + work - 50.0).abs() < 1e-7, "{steps} steps: {work} J/m² beyond the peak");
    }
}

#[test]
fn it_unloads_to_the_origin_and_remembers() {
    let mut bond = bond();
    let [work, loss] = open(&mut bond, 2000, [0.0, 10e-6]);
    assert!(bond.damage > 0.48 && bond.damage < 0.49, "{}", bond.damage);
    assert!((loss - 50.0 * bond.damage).abs() < 1e-9);
    assert!((work - loss - bond.stored(10e-6)).abs() < 0.05, "{work} {loss}");
    let half = bond.normal(-5e-6, 0.0);
    assert!((half / bond.normal(-10e-6, 0.0) - 0.5).abs() < 1e-12);
    assert_eq!(bond.damage_at(5e-6), bond.damage);
    assert_eq!(bond.normal(1e-9, 0.0), 1e4);
}

/// A2: τp = 0.5 + tan 35° MPa, τr = tan 30° MPa under 1 MPa, residual at 1.605504 mm.
#[test]
fn slip_takes_the_energy_of_fracture_beyond_residual_friction() {
    let tan = |degrees: f64| degrees.to_radians().tan();
    let mut bond = Bond { shear: [[tan(35.0), 0.5e6], [tan(30.0), 0.0]], ..bond() };
    let strengths = bond.strengths(1e6);
    assert!((strengths[0] - 1.200208e6).abs() < 1.0 && (strengths[1] - 0.577350e6).abs() < 1.0);
    assert!((bond.slip_at_end(strengths) - 1.605504e-3).abs() < 1e-9);
    for steps in [7, 1000] {
        (bond.damage, bond.slip) = (0.0, 0.0);
        let (mut stored, mut loss) = (strengths[0], 0.0);
        for _ in 0..steps {
            let asked = stored + bond.stiffness[1] * 2e-3 / f64::from(steps);
            let limit = bond.shear(1e6, asked, 1.0 / bond.stiffness[1], bond.damage);
            let slipped = (asked - limit) / bond.stiffness[1];
            let after = bond.after(0.0, slipped, [1e6, limit]);
            (bond.damage, bond.slip, stored) = (after.damage, bond.slip + slipped, limit);
            loss += after.loss;
        }
        assert_eq!(bond.damage, 1.0);
        assert!((loss - 500.0).abs() < 1e-6, "{loss} J/m² in {steps} steps");
    }
}

#[test]
fn a_bond_whose_spring_gives_back_more_than_it_takes_breaks_at_its_peak() {
    let brittle = Bond { stiffness: [1e11, 1e11], ..bond() };
    assert!(brittle.range().is_none());
    assert_eq!(brittle.normal(-49e-6, 0.0), -4.9e6);
    assert_eq!(brittle.normal(-51e-6, 0.0), 0.0);
    assert_eq!([brittle.damage_at(49e-6), brittle.damage_at(51e-6)], [0.0, 1.0]);
    let none = Bond { tension: 0.0, opening: 0.0, ..bond() };
    assert_eq!([none.normal(-1e-9, 0.0), none.damage_at(1e-9)], [0.0, 1.0]);
}

/// The force meets its own equation: it is that of the opening which it leaves.
#[test]
fn the_force_is_that_of_the_opening_which_it_leaves() {
    for c in [1e-14, 1e-12, 3e-12] {
        for b in [-0.2e-6, -0.6e-6, -5e-6, -15e-6] {
            let bond = bond();
            let force = bond.normal(b, c);
            let opening = c * force - b;
            assert!((bond.normal(-opening, 0.0) / force - 1.0).abs() < 1e-9, "{b} {c}: {force}");
        }
    }
}
