//! Claim: `fos` reduces the strength of rock that breaks with that of the joints, and a slope that a stage has cut has
//! the factor of the same slope with the joint drawn.

use crate::common::case;
use crate::support::factor;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

const G: f64 = 9.81;
/// Stress (Pa) at the root of a bar of 2 m by 1 m under its own weight.
const FIBRE: f64 = 6.0 * 2.0 * 2600.0 * G;
const REST: &str = "[[stage]]\nname = \"weight\"\nkind = \"static\"\nduration = 5\n";

fn rock(tension: f64) -> String {
    format!(
        "[rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0.25\n[rock.rock.fracture]\ntension = {tension:?}\n\
         cohesion = 50e6\nfriction_deg = 45\n[fracture]\nleast_part = 0.5\n"
    )
}

/// A bar that grows from a wall, by beam theory.
#[test]
fn an_overhang_breaks_at_its_strength_over_its_stress() {
    let fine = std::env::var("ENMM_FULL").map(|_| [(0.5, 40.0, 2.0), (0.25, 5.0, 1.3)]);
    let cases = [(1.0, 15.0, 2.0), (1.0, 40.0, 1.3)].into_iter().chain(fine.into_iter().flatten());
    for (size, angle, share) in cases {
        let text = format!(
            "title = \"overhang\"\n[domain]\noutline = [[-3, -2], [0, -2], [0, 0], [2, 0], [2, 1], [0, 1], [0, 3], \
             [-3, 3]]\n[mesh]\nsize = {size}\nangle_deg = {angle}\norigin = [0.0137, 0.0071]\n{}[[fix]]\n\
             box = [-9, -9, {:?}, 9]\n{REST}",
            rock(share * FIBRE),
            -1.001 * size
        );
        let found = factor_of_safety(&case(&text), &ReductionOptions::default(), &mut |_, _| {});
        let found = found.unwrap_or_else(|e| panic!("{e}"));
        let [low, high] = [found.low, found.high].map(|limit| limit.unwrap_or(f64::NAN));
        println!("h {size}, {angle}°: {low:.4} to {high:.4} of {share}; {:?}", found.warnings);
        assert!(0.995 * share <= low && low <= high && high <= 1.005 * share, "{low} {high}");
        let failing = &found.first_unstable().expect("a failure").failing;
        assert!((failing.iter().map(|block| block.area).sum::<f64>() / 2.0 - 1.0).abs() < 0.1, "{failing:?}");
        assert!(found.bound.is_err_and(|why| why.contains("cannot follow blocks that break")));
    }
}

const WEDGE: &str = "title = \"wedge\"\n[domain]\noutline = [[0, 0], [16, 0], [16, 2], [12, 2], [8, 8], [0, 8]]\n\
                     [mesh]\nsize = 1.0\norigin = [0.0137, 0.0071]\n[rock.rock]\ndensity = 2600\nyoung = 10e9\n\
                     poisson = 0.25\n[joint_law.plane]\nfriction_deg = 35\n[[fix]]\nedge = [[0, 0], [16, 0]]\n";

/// A wedge on a plane, drawn from the start or cut by a stage.
#[test]
fn a_plane_that_a_stage_cuts_has_the_factor_of_a_joint() {
    let line = "points = [[12, 2], [5, 8]]\nlaw = \"plane\"";
    let drawn = format!("{WEDGE}[[joint]]\n{line}\n{REST}");
    let held = "[joint_law.held]\nfriction_deg = 35\n";
    let cut = format!(
        "{WEDGE}{held}{REST}[[stage]]\nname = \"cut\"\nkind = \"static\"\nduration = 5\ncut = [{{ {} }}]\n",
        "points = [[12.4, 1.6571428571428571], [4.6, 8.342857142857143]], law = \"plane\""
    );
    let exact = 35f64.to_radians().tan() / (6.0 / 7.0);
    let factors = [factor(&drawn), factor(&cut)];
    println!("{factors:?} of {exact}");
    assert!(factors.iter().all(|factor| (factor / exact - 1.0).abs() < 0.005), "{factors:?}");
}

/// The weaker of the two decides: the joint below a block, or the rock of its overhang.
#[test]
fn the_weaker_of_joint_and_rock_decides() {
    let text = |tension: f64| {
        format!(
            "title = \"ledge\"\n[domain]\noutline = [[-4, -1], [8, -1], [8, 0], [0, 0], [0, 1], [2, 1], [2, 2], \
             [-3, 2], [-3, 0], [-4, 0]]\n[mesh]\nsize = 0.5\norigin = [0.0137, 0.0071]\n[gravity]\nx = {:?}\n\
             y = {:?}\n{}[joint_law.base]\nfriction_deg = 30\n[[joint]]\npoints = [[-3, 0], [0, 0]]\nlaw = \"base\"\n\
             [[fix]]\nedge = [[-4, -1], [8, -1]]\n{REST}",
            0.2 * G,
            -G,
            rock(tension)
        )
    };
    let friction = 30f64.to_radians().tan() / 0.2;
    let strong = factor(&text(20.0 * FIBRE));
    println!("{strong} of {friction}");
    assert!((strong / friction - 1.0).abs() < 0.006, "{strong}");
    let weak = factor(&text(1.5 * FIBRE));
    // Its own weight bends the overhang, and pulls it along.
    let pull = 0.2 * 2600.0 * G * 2.0;
    let exact = 1.5 * FIBRE / (FIBRE + pull);
    println!("{weak} of {exact}");
    assert!((weak / exact - 1.0).abs() < 0.006, "{weak}");
}
