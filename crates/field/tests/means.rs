//! Claim: means, concentrations and cones of confidence are those of the draws, weights those of the hand.

use enmm_field::{Fisher, Scanline, density, plane_of, pole_of, rosette};

use crate::drawn::{Dice, angle, down, fisher, pole};

/// Poles of one set as a compass reads them.
fn drawn(mean: [f64; 3], kappa: f64, count: usize, seed: u64) -> Vec<([f64; 3], f64)> {
    let mut dice = Dice::new(seed);
    (0..count).map(|_| (down(fisher(mean, kappa, &mut dice)), 1.0)).collect()
}

/// 2·(n − R)·κ has the distribution of χ² with 2·(n − 1) degrees (G. S. Watson, 1956), near normal for many poles: 95 %
/// of the estimates of κ from 1000 poles are within 1.96/√1000 = 6.2 % of it. 95 % of the cones hold the true mean. Of
/// 200 draws, 95 % ± 3·√(0.95·0.05/200) = 90.4 % to 99.6 % must be within.
#[test]
fn concentration_and_mean_are_within_their_confidence_as_often_as_they_say() {
    // Level poles turn up on both sides of the net.
    for (trend, plunge) in [(30.0, 40.0), (250.0, 0.0), (0.0, 90.0), (120.0, 2.0)] {
        for kappa in [10.0, 50.0, 400.0] {
            let mean = pole(trend, plunge);
            let mut within = [0; 2];
            for seed in 0..200 {
                let found = Fisher::of(&drawn(mean, kappa, 1000, seed + 1)).expect("poles");
                within[0] += u32::from((kappa / found.kappa - 1.0).abs() < 1.96 / 1000f64.sqrt());
                within[1] += u32::from(angle(found.mean, mean) < found.cone_deg);
            }
            for share in within {
                assert!((181..=199).contains(&share), "{within:?} of 200: {trend}/{plunge}, κ {kappa}");
            }
        }
    }
}

#[test]
fn numbers_of_few_poles_are_those_of_the_hand() {
    // Two poles 60° apart: R = 2·cos 30°, κ = 1/(2 − R), cos α = 1 − (2 − R)/R·(20 − 1).
    let found = Fisher::of(&[(pole(60.0, 0.0), 1.0), (down(pole(120.0, 0.0)), 1.0)]).expect("poles");
    let r = 2.0 * 30f64.to_radians().cos();
    assert!((found.kappa - 1.0 / (2.0 - r)).abs() < 1e-12 && angle(found.mean, pole(90.0, 0.0)) < 1e-6);
    // Here that is below −1: two such poles have no cone. Of two poles 2° apart, R = 2·cos 1°.
    assert_eq!(found.cone_deg, 180.0);
    let near = Fisher::of(&[(pole(0.0, 0.0), 1.0), (pole(2.0, 0.0), 1.0)]).expect("poles");
    let r = 2.0 * 1f64.to_radians().cos();
    assert!((near.cone_deg.to_radians().cos() - (1.0 - (2.0 - r) / r * 19.0)).abs() < 1e-12, "{near:?}");
    // Three poles whose one has weight 2 are four poles but for the number of them.
    let (a, b, c) = (pole(0.0, 50.0), pole(10.0, 60.0), pole(20.0, 45.0));
    let weighted = Fisher::of(&[(a, 2.0), (b, 1.0), (c, 1.0)]).expect("poles");
    let repeated = Fisher::of(&[(a, 1.0), (a, 1.0), (b, 1.0), (c, 1.0)]).expect("poles");
    assert!(angle(weighted.mean, repeated.mean) < 1e-6);
    assert!((weighted.kappa / repeated.kappa - (2.0 / 3.0) / (3.0 / 4.0)).abs() < 1e-9);
    assert_eq!(Fisher::of(&[]), None);
    let parallel = Fisher::of(&[(a, 1.0), (a, 1.0)]).expect("poles");
    assert!(parallel.kappa > 1e5 && parallel.cone_deg < 1e-3, "{parallel:?}");
}

/// Share 1 − e^(−κ·(1 − cos θ)) within θ, but for e^(−2κ).
#[test]
fn the_cone_of_a_share_is_that_of_the_distribution() {
    let set = Fisher { mean: pole(0.0, 90.0), count: 9, weight: 9.0, kappa: 30.0, cone_deg: 0.0 };
    let angle = set.cone_of(0.5).to_radians();
    assert!((1.0 - (-30.0 * (1.0 - angle.cos())).exp() - 0.5).abs() < 1e-12);
}

#[test]
fn planes_and_poles_belong_to_each_other() {
    for (dip, direction) in [(30.0, 120.0), (90.0, 359.0), (0.5, 0.0), (89.9, 270.0)] {
        let found = plane_of(&pole_of(dip, direction));
        assert!((found[0] - dip).abs() < 1e-9 && (found[1] - direction).abs() < 1e-9, "{found:?}");
        // The pole plunges by 90° less the dip, away from the dip direction.
        assert!(angle(pole_of(dip, direction), pole(direction + 180.0, 90.0 - dip)) < 1e-6);
    }
    assert_eq!(plane_of(&[0.0, 0.0, 1.0]), [0.0, 0.0]);
}

#[test]
fn weights_are_those_of_terzaghi() {
    // A level line to the north: a plane that dips north by 60° has its pole 60° from it on the other side, 30° above.
    let line = Scanline::parse("0/0").expect("a line");
    let (weight, is_blind) = line.weight(&pole_of(60.0, 0.0));
    assert!((weight - 1.0 / 60f64.to_radians().sin()).abs() < 1e-12 && !is_blind);
    // A plane along the line is in the blind zone.
    let (weight, is_blind) = line.weight(&pole_of(90.0, 90.0));
    assert!((weight - 1.0 / 15f64.to_radians().sin()).abs() < 1e-12 && is_blind);
    for wrong in ["120", "120/95", "a/b", "T1=500/0"] {
        assert!(Scanline::parse(wrong).expect_err(wrong).contains("120/5"), "{wrong}");
    }
}

/// One pole has 100 % at its place; far poles have none; the mean over the hemisphere is 1 % by the integral of the
/// influence, 2π·(1 − e^(−100))/100 of 2π.
#[test]
fn densities_are_shares_of_a_hundredth_of_the_hemisphere() {
    let one = [(pole(40.0, 30.0), 3.0)];
    assert!((density(&one, &pole(40.0, 30.0)) - 100.0).abs() < 1e-9);
    assert!(density(&one, &pole(130.0, 0.0)) < 1e-9);
    // Level poles count on both sides of the net.
    let level = [(pole(0.0, 0.0), 1.0)];
    assert!((density(&level, &pole(180.0, 0.0)) - 100.0).abs() < 1e-9);
    let (mut sum, rings) = (0.0, 400);
    for k in 0..rings {
        let down = (f64::from(k) + 0.5) / f64::from(rings);
        let plunge = down.asin().to_degrees();
        sum += (0..720).map(|turn| density(&one, &pole(f64::from(turn) / 2.0, plunge))).sum::<f64>() / 720.0;
    }
    assert!((sum / f64::from(rings) - 1.0).abs() < 1e-3, "{}", sum / f64::from(rings));
}

#[test]
fn strikes_lie_a_right_angle_from_dip_directions() {
    // Dip directions 135° and 315°: strike 45°; 95°: strike 5°; a level plane has none.
    let poles = [(pole_of(40.0, 135.0), 1.0), (pole_of(80.0, 315.0), 2.0), (pole_of(60.0, 95.0), 1.0)];
    let shares = rosette(&[&poles[..], &[(pole_of(0.0, 0.0), 9.0)]].concat(), 18);
    assert_eq!((shares[4], shares[0]), (0.75, 0.25));
    assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
}
