//! Acceleration of a fixed point by its last rounds (D. G. Anderson, Iterative procedures for nonlinear integral
//! equations, 1965).

/// Differences of rounds that count.
pub const DEPTH: usize = 4;
/// Share of what is asked for that a round takes where no other tells more.
const FACTOR: f64 = 0.5;
/// Length of a difference, over what is left of it beside the newer ones, from which it tells nothing new.
const NEW: f64 = 1e-8;

/// The next values of unknowns: the last ones of `rounds`, the oldest round first, each with its values and with what
/// was asked for less these, moved to where what is asked for is least by the last differences. Only unknowns that
/// `counts` names decide; sums are taken in their order.
pub fn accelerate(rounds: &[(&[f64], &[f64])], counts: &[bool]) -> Vec<f64> {
    accelerate_by(FACTOR, NEW, rounds, counts)
}

/// The same with other constants.
fn accelerate_by(factor: f64, new: f64, rounds: &[(&[f64], &[f64])], counts: &[bool]) -> Vec<f64> {
    let Some((&(values, asked), _)) = rounds.split_last() else { return Vec::new() };
    let dot = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).zip(counts).filter(|(_, counts)| **counts).fold(0.0, |sum, ((a, b), _)| sum + a * b)
    };
    let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
    // Orthogonal differences of what was asked for, the newest first, each with the same sum of differences of values.
    let mut basis: Vec<(Vec<f64>, Vec<f64>, f64)> = Vec::new();
    let mut left = asked.to_vec();
    let mut next: Vec<f64> = values.to_vec();
    for pair in rounds.windows(2).rev().take(DEPTH) {
        let [(x0, f0), (x1, f1)] = [pair[0], pair[1]];
        let (mut dx, mut df) = (less(x1, x0), less(f1, f0));
        let whole = dot(&df, &df);
        for (bx, bf, square) in &basis {
            let share = dot(&df, bf) / square;
            df.iter_mut().zip(bf).for_each(|(d, b)| *d -= share * b);
            dx.iter_mut().zip(bx).for_each(|(d, b)| *d -= share * b);
        }
        let square = dot(&df, &df);
        if square <= new * new * whole || square <= 0.0 {
            continue;
        }
        let share = dot(&left, &df) / square;
        left.iter_mut().zip(&df).for_each(|(l, d)| *l -= share * d);
        next.iter_mut().zip(&dx).for_each(|(n, d)| *n -= share * d);
        basis.push((dx, df, square));
    }
    next.iter_mut().zip(&left).for_each(|(next, left)| *next += factor * left);
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear map of two unknowns, one of which plain rounds would throw about: its fixed point is found as soon as
    /// two differences are known. A third unknown does not count, and follows. It is found whatever the constants are.
    #[test]
    fn the_fixed_point_of_a_linear_map_is_found_by_its_differences() {
        let constants = [(1.0, 1.0), (0.5, 1.0), (2.0, 1.0), (1.0, 0.5), (1.0, 2.0)];
        let map = |x: &[f64]| [1.0 - 2.5 * x[0] + 0.3 * x[1], 0.4 + 0.2 * x[0] - 0.5 * x[1], x[0]];
        let determinant = 3.5 * 1.5 - 0.3 * 0.2;
        let exact = [(1.5 + 0.3 * 0.4) / determinant, (3.5 * 0.4 + 0.2) / determinant];
        for (of_factor, of_new) in constants {
            let mut rounds: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
            let mut x = vec![0.0; 3];
            for _ in 0..4 {
                let asked = map(&x).iter().zip(&x).map(|(to, from)| to - from).collect();
                rounds.push((x, asked));
                let seen: Vec<(&[f64], &[f64])> = rounds.iter().map(|(x, f)| (&x[..], &f[..])).collect();
                x = accelerate_by(of_factor * FACTOR, of_new * NEW, &seen, &[true, true, false]);
            }
            assert!((0..2).all(|k| (x[k] - exact[k]).abs() < 1e-12), "{x:?} {exact:?}");
        }
    }

    /// The aperture of a joint that water opens, e = 1 + 2p(e), beside one that stays: the number of rounds down to
    /// 1e-3 is the same, or one more or less, by half and by twice each constant.
    #[test]
    fn half_and_twice_each_constant_take_the_same_rounds() {
        let asked = |logs: &[f64]| {
            let conducts = libm::exp(3.0 * logs[0]);
            let pressure = conducts / (1.0 + conducts);
            vec![libm::log(1.0 + 2.0 * pressure) - logs[0]]
        };
        let rounds_with = |factor: f64, new: f64| {
            let mut rounds: Vec<(Vec<f64>, Vec<f64>)> = vec![(vec![0.0], asked(&[0.0]))];
            while rounds.last().is_some_and(|(_, f)| f[0].abs() > 1e-3) {
                let seen: Vec<(&[f64], &[f64])> = rounds.iter().map(|(x, f)| (&x[..], &f[..])).collect();
                let next = accelerate_by(factor, new, &seen, &[true]);
                rounds.push((next.clone(), asked(&next)));
            }
            rounds.len()
        };
        let usual = rounds_with(FACTOR, NEW);
        assert!((3..=8).contains(&usual), "{usual}");
        for (factor, new) in [(0.5 * FACTOR, NEW), (2.0 * FACTOR, NEW), (FACTOR, 0.5 * NEW), (FACTOR, 2.0 * NEW)] {
            let rounds = rounds_with(factor, new);
            assert!(rounds.abs_diff(usual) <= 1, "{factor} {new}: {rounds} and not {usual}");
        }
    }

    #[test]
    fn the_first_round_goes_half_the_way_and_repeated_ones_tell_nothing() {
        let first = (&[1.0, 2.0][..], &[0.5, -0.5][..]);
        assert_eq!(accelerate(&[first], &[true; 2]), [1.25, 1.75]);
        assert_eq!(accelerate(&[first, first], &[true; 2]), [1.25, 1.75]);
        assert!(accelerate(&[], &[]).is_empty());
    }
}
