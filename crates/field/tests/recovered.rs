//! Claim: sets that were mixed are found again, with their number; one set is not divided.

use enmm_field::{find_sets, given_sets};

use crate::drawn::{Dice, angle, down, fisher, pole};

/// Means, concentrations and numbers of poles of three sets, one of them of level poles.
const MIXED: [([f64; 2], f64, usize); 3] =
    [([300.0, 25.0], 40.0, 400), ([75.0, 0.0], 60.0, 300), ([180.0, 80.0], 30.0, 200)];

fn mixed(seed: u64) -> (Vec<([f64; 3], f64)>, Vec<usize>) {
    let mut dice = Dice::new(seed);
    let (mut poles, mut of) = (Vec::new(), Vec::new());
    for (set, ([trend, plunge], kappa, count)) in MIXED.into_iter().enumerate() {
        for _ in 0..count {
            poles.push((down(fisher(pole(trend, plunge), kappa, &mut dice)), 1.0));
            of.push(set);
        }
    }
    (poles, of)
}

#[test]
fn three_mixed_sets_are_found_with_their_number_their_poles_and_their_means() {
    for seed in 1..=20 {
        let (poles, of) = mixed(seed);
        let found = find_sets(&poles, None).expect("sets");
        assert_eq!(found.means.len(), 3, "seed {seed}: {:?}", found.criteria);
        let right = found.of.iter().zip(&of).filter(|(found, of)| found == of).count();
        assert!(right as f64 > 0.98 * poles.len() as f64, "seed {seed}: {right} of {}", poles.len());
        for (mean, ([trend, plunge], kappa, count)) in found.means.iter().zip(MIXED) {
            let root = (count as f64).sqrt();
            // Four times the 63 % cone of a mean, 81°/√(κ·n), and six standard errors of κ, for poles change sets.
            assert!(angle(mean.mean, pole(trend, plunge)) < 4.0 * 81.0 / (kappa.sqrt() * root), "seed {seed}");
            assert!((mean.kappa / kappa - 1.0).abs() < 6.0 / root, "seed {seed}: {} beside {kappa}", mean.kappa);
        }
        assert_eq!(find_sets(&poles, Some(3)).expect("sets").of, found.of);
    }
}

#[test]
fn one_set_and_poles_without_any_stay_one() {
    for seed in 1..=20 {
        for kappa in [8.0, 60.0] {
            let mut dice = Dice::new(seed);
            let poles: Vec<_> = (0..500).map(|_| (down(fisher(pole(10.0, 1.0), kappa, &mut dice)), 1.0)).collect();
            let found = find_sets(&poles, None).expect("sets");
            assert_eq!(found.means.len(), 1, "seed {seed}, κ {kappa}: {:?}", found.criteria);
        }
    }
}

#[test]
fn the_order_of_the_rows_does_not_decide() {
    let (poles, _) = mixed(5);
    let turned: Vec<_> = poles.iter().rev().copied().collect();
    let (first, second) = (find_sets(&poles, None).expect("sets"), find_sets(&turned, None).expect("sets"));
    let back: Vec<usize> = second.of.iter().rev().copied().collect();
    assert_eq!(first.of, back);
}

#[test]
fn too_few_poles_are_refused_and_named_sets_kept() {
    let (poles, _) = mixed(1);
    for (count, number) in [(3, None), (7, Some(2)), (900, Some(9)), (900, Some(0))] {
        let message = find_sets(&poles[..count], number).expect_err("refused").to_string();
        assert!(message.contains("must be"), "{message}");
    }
    let names: Vec<Option<String>> =
        (0..900).map(|k| (k < 800).then(|| if k < 300 { "J1" } else { "J2" }.to_owned())).collect();
    let given = given_sets(&poles, &names);
    let shown: Vec<(&str, usize)> = given.iter().map(|(name, mean, _)| (name.as_str(), mean.count)).collect();
    assert_eq!(shown, [("J2", 500), ("J1", 300)]);
}
