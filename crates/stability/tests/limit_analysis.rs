//! Limit analysis gives known factors, keeps its bounds in order, follows the stages of a case, and refuses by name
//! what it cannot treat. Closed forms of single mechanisms are the verification problems F1 to F7.

use crate::columns::{THREE, TWO, columns, toppling};
use crate::common::{case, example, simulation};
use crate::support::assert_refused;
use enmm::model::Mechanism;
use enmm_stability::limit_analysis::{Bound, BoundError, Factor, bound};

fn of_text(text: &str) -> Result<Bound, BoundError> {
    bound(simulation(text).case())
}

fn of_example(name: &str) -> Bound {
    bound(&case(&example(name))).expect("a bound")
}

fn near(factor: Factor, exact: f64) {
    assert!((factor.value() / exact - 1.0).abs() < 3e-4, "{factor:?} instead of {exact}");
}

/// A slope 20 m high with two joint sets, mirrored or not, of friction tan φ = `tangent`.
fn jointed(tangent: f64, mirror: f64, more: &str) -> String {
    let place = |points: &[[f64; 2]]| format!("{:?}", points.iter().map(|p| [mirror * p[0], p[1]]).collect::<Vec<_>>());
    let outline = place(&[[0.0, -10.0], [60.0, -10.0], [60.0, 20.0], [20.2, 20.0], [10.0, 0.0], [0.0, 0.0]]);
    let mut joints = String::new();
    for k in 0..5 {
        let up = 4.0 * f64::from(k);
        joints += &format!("[[joint]]\npoints = {}\n", place(&[[9.0, up - 1.0], [49.0, up + 26.0]]));
        joints += &format!("[[joint]]\npoints = {}\n", place(&[[12.0 + up, 2.1], [5.5 + up, 24.3]]));
    }
    let [bottom, side] = [[[0.0, -10.0], [60.0, -10.0]], [[60.0, -10.0], [60.0, 20.0]]].map(|edge| place(&edge));
    format!(
        "title = \"jointed\"\n[domain]\noutline = {outline}\n[mesh]\nsize = 2.0\norigin = [0.31, 0.17]\n{joints}\
         [rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = {:?}\n\
         [[fix]]\nedge = {bottom}\n[[fix]]\nedge = {side}\naxes = \"x\"\n{more}\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\n",
        tangent.atan().to_degrees()
    )
}

/// 2.626 is what a linear program that was written apart from this one found for these columns.
#[test]
fn columns_of_goodman_and_bray_bear_2_626_when_joints_dilate() {
    let found = of_example("goodman_bray");
    near(found.associated.factor, 2.626);
    near(found.level_tops.factor, 2.626);
    assert!(found.associated.mechanism.len() > 8, "{:?}", found.associated.mechanism);
}

/// With water and bolts 1.2501 by the formula of Hoek and Bray that the case quotes.
#[test]
fn the_plane_slide_of_the_examples_bears_what_its_formula_gives() {
    let found = of_example("plane_slide");
    near(found.associated.factor, 1.2501);
    assert_eq!((found.blocks, found.associated.mechanism.len()), ([2, 1], 1));
}

/// Joints that dilate by their friction need 42.75° there, so that 50° gives tan 50°/tan 42.75°; ±0.05° are 0.2 %.
#[test]
fn long_the_fractured_slope_needs_42_75_degrees() {
    if crate::common::extent::extent() >= crate::common::extent::Extent::Full {
        let found = of_example("fractured_slope");
        let expected = 50f64.to_radians().tan() / 42.75f64.to_radians().tan();
        assert!((found.associated.factor.value() / expected - 1.0).abs() < 2e-3, "{found:?}");
        assert!(found.least.value() <= found.level_tops.factor.value());
    } else {
        near(of_example("block_on_incline").associated.factor, 35f64.to_radians().tan() / 30f64.to_radians().tan());
    }
}

#[test]
fn bounds_are_in_order_and_repeat_to_the_bit() {
    let found = of_text(&jointed(0.9, 1.0, "")).expect("a bound");
    let [free, least, level, catching] =
        [found.associated.factor, found.least, found.level_tops.factor, found.catching.factor].map(|f| f.value());
    assert!(found.corners > 10 && free.is_finite(), "{found:?}");
    assert!(free <= least * (1.0 + 1e-6) && least <= level && level <= catching * (1.0 + 1e-6), "{found:?}");
    let fastest = &found.level_tops.mechanism[0];
    assert!((fastest.speed - 1.0).abs() < 1e-12 && fastest.velocity.x < 0.0 && fastest.mass > 0.0, "{fastest:?}");
    assert_eq!(of_text(&jointed(0.9, 1.0, "")).expect("a bound"), found);
}

/// Without cohesion F divides tan φ alone.
#[test]
fn a_factor_is_proportional_to_friction_and_the_same_in_a_mirror() {
    let found = of_text(&jointed(0.9, 1.0, "")).expect("a bound");
    let double = of_text(&jointed(1.8, 1.0, "")).expect("a bound");
    let mirrored = of_text(&jointed(0.9, -1.0, "")).expect("a bound");
    let pairs = [(double.associated, 2.0), (mirrored.associated, 1.0), (double.catching, 2.0)];
    let own = [&found.associated, &found.associated, &found.catching];
    for ((other, by), own) in pairs.into_iter().zip(own) {
        assert!((other.factor.value() / (by * own.factor.value()) - 1.0).abs() < 5e-5, "{other:?} {own:?}");
    }
}

/// A block W = 2 m · 0.8 m · 25 kN/m³ hangs on its joint by σt·L; with or without cohesion the factor is σt·L/W.
#[test]
fn tensile_strength_holds_a_block_below_a_roof() {
    for cohesion in [0.0, 1e5] {
        let text = format!(
            "title = \"roof\"\n[domain]\noutline = [[-1, 0], [3, 0], [3, 1], [-1, 1]]\nislands = [[[0, -0.8], [2, \
             -0.8], [2, 0], [0, 0]]]\n[mesh]\nsize = 0.5\norigin = [0.031, 0.017]\n[joint_law.joint]\nfriction_deg = \
             30.0\ntension = 5e4\ncohesion = {cohesion:e}\n[rock.rock]\ndensity = 2500\nyoung = 2e10\npoisson = 0.2\n\
             [[fix]]\nblock = [-0.5, 0.5]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\n"
        );
        near(of_text(&text).expect("a bound").associated.factor, 5e4 * 2.0 / (1.6 * 2500.0 * 9.81));
    }
}

/// Estimates agree with their friction within 10⁻³, and so does the power that gives F.
#[test]
fn columns_without_dilation_topple_at_their_closed_form() {
    assert!((toppling(&TWO) - 1.8273).abs() < 1e-4 && (toppling(&THREE) - 2.0724).abs() < 1e-4);
    for (sizes, side) in [(&TWO[..], ""), (&THREE, ""), (&TWO, "cohesion = 2e3")] {
        let found = of_text(&columns(sizes, side)).expect("a bound");
        let estimate = found.estimate.as_ref().expect("an estimate");
        let ratio = estimate.factor.value() / toppling(sizes);
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio} {side} {found:?}");
        assert!(found.associated.factor.value() > 1.2 * estimate.factor.value(), "{found:?}");
        let way = estimate.way.expect("a way");
        assert_eq!((way.mechanism, way.is_one), (Mechanism::Topples, false));
        assert!(way.words().contains("1.5 times too high"), "{}", way.words());
    }
}

/// The sides of columns that turn open, so that their cohesion adds nothing.
#[test]
fn cohesion_of_sides_that_open_is_told_and_left_out() {
    let [plain, sticky] = ["", "cohesion = 2e3"].map(|side| of_text(&columns(&TWO, side)).expect("a bound"));
    let bare = sticky.bare.as_ref().expect("a bare bound");
    near(bare.collapse.factor, plain.associated.factor.value());
    assert!(sticky.associated.factor.value() > 1.04 * bare.collapse.factor.value() && bare.share > 0.99, "{sticky:?}");
    assert!(sticky.warnings.iter().any(|warning| warning.contains("interfaces that open")), "{:?}", sticky.warnings);
    assert!(plain.warnings.is_empty() && plain.bare.is_some_and(|bare| bare.interfaces == 0));
}

#[test]
fn joints_that_dilate_by_their_friction_angle_have_the_associated_factor() {
    let dilating = columns(&TWO, "dilation_deg = 40.0\ndilation_slip = 1e3")
        .replace("friction_deg = 60.0", "friction_deg = 60.0\ndilation_deg = 60.0\ndilation_slip = 1e3");
    let found = of_text(&dilating).expect("a bound");
    let ratio = found.estimate.expect("an estimate").factor.value() / found.associated.factor.value();
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
}

/// A wedge on a plane of 30° whose back, a joint of 60°, opens as it leaves: with tan φ = .75 on the plane the factor
/// is .75/tan 30°, whatever the cohesion of the back, which slips as well where the plane dilates.
#[test]
fn a_wedge_that_slides_is_left_by_its_back_and_needs_no_dilation() {
    let (dip, foot) = (30f64.to_radians().tan(), [3.0, 1.0]);
    let on = |x: f64| [x, foot[1] + (x - foot[0]) * dip];
    let text = |cohesion: f64| {
        format!(
            "title = \"wedge\"\n[domain]\noutline = [[0, -4], [20, -4], [20, 8], [10, 8], [2, 0], [0, 0]]\n[mesh]\n\
             size = 1.5\norigin = [0.31, 0.17]\n[[joint]]\npoints = {:?}\nlaw = \"plane\"\n[[joint]]\npoints = {:?}\n\
             law = \"back\"\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n[joint_law.plane]\n\
             friction_deg = {:?}\n[joint_law.back]\nfriction_deg = 35.0\ncohesion = {cohesion:e}\n[[fix]]\nedge = \
             [[0, -4], [20, -4]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\n",
            [on(2.0), on(11.0)],
            [on(11.0), [13.0, on(11.0)[1] + 2.0 * 60f64.to_radians().tan()]],
            0.75f64.atan().to_degrees()
        )
    };
    let [dry, sticky] = [0.0, 2e4].map(|cohesion| of_text(&text(cohesion)).expect("a bound"));
    for found in [&dry, &sticky] {
        let exact = 0.75 / dip;
        near(found.bare.as_ref().expect("a bare bound").collapse.factor, exact);
        near(found.estimate.as_ref().expect("an estimate").factor, exact);
        let way = found.level_tops.way.expect("a way");
        assert_eq!((way.mechanism, way.is_one), (Mechanism::Slides, true));
    }
    near(dry.associated.factor, 0.75 / dip);
    assert!(sticky.associated.factor.value() > 1.03 * dry.associated.factor.value(), "{sticky:?}");
}

/// A change of law in a later static stage counts; stages from the first dynamic one on do not, and are named.
#[test]
fn the_last_static_stage_counts() {
    let weaker = "[[stage]]\nname = \"weaker\"\nkind = \"static\"\nduration = 1.0\n[[stage.law]]\nlaw = \"joint\"\n\
                  friction_deg = 30.0\n";
    let shaken = "[[stage]]\nname = \"after\"\nkind = \"dynamic\"\nduration = 1.0\n[[stage.law]]\nlaw = \"joint\"\n\
                  friction_deg = 10.0\n";
    let own = of_text(&jointed(30f64.to_radians().tan(), 1.0, "")).expect("a bound");
    let found = of_text(&(jointed(0.9, 1.0, "") + weaker + shaken)).expect("a bound");
    assert!((found.associated.factor.value() / own.associated.factor.value() - 1.0).abs() < 5e-5);
    assert!(found.warnings.iter().any(|warning| warning.contains("after")), "{:?}", found.warnings);
}

/// A base moves in dynamic stages only, which are left out: the factor is that of the slope at rest.
#[test]
fn a_motion_of_the_base_is_left_out_with_a_warning() {
    let shaken = jointed(0.9, 1.0, "[[base_motion]]\ntable = [[0, 0], [1, 1]]\n")
        + "[[stage]]\nname = \"shaken\"\nkind = \"dynamic\"\nduration = 1.0\n";
    let [still, shaken] = [jointed(0.9, 1.0, ""), shaken].map(|text| of_text(&text).expect("a bound"));
    assert_eq!(shaken.associated.factor, still.associated.factor);
    assert!(
        shaken.warnings.iter().any(|warning| warning.contains("base motion and waves are left out")),
        "{:?}",
        shaken.warnings
    );
}

/// A static stage that cuts the rock.
const CUT: &str = "kind = \"static\"\ncut = [{ points = [[0, -5], [1, -5]], law = \"joint\" }]";

#[test]
fn what_cannot_be_treated_is_refused_by_its_key() {
    let plain = jointed(0.9, 1.0, "");
    let refusals = [
        (plain.replace("poisson = 0.25", "poisson = 0.25\ncohesion = 1e6"), "rock.rock.cohesion"),
        (
            plain.replace("[joint_law.joint]", "[joint_law.joint]\nkind = \"barton_bandis\"\njrc = 8\njcs = 1e8"),
            "joint_law.joint.kind",
        ),
        (
            jointed(0.9, 1.0, "[[load]]\nkind = \"body\"\nacceleration = [0.1, 0]\ntable = [[0, 0], [1, 1]]\n"),
            "load[0].table",
        ),
        (plain.replace("kind = \"static\"", "kind = \"dynamic\""), "stage[0].kind"),
        (plain.replace("kind = \"static\"", CUT), "stage[0].cut[0]"),
    ];
    for (text, key) in refusals {
        assert_refused(bound(&case(&text)), key);
    }
}
