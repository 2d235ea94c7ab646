//! Doubts about a factor of safety that follow from its trials.

use super::corners::CornersHold;
use super::{FailingBlock, Reason, Reduction, Trial, Verdict};
use crate::limit_analysis::{Bound, NearEnds, staged};
use enmm::model::case::{Case, Rock};

/// Part of the largest term of the ledger that may stay unexplained.
const RESIDUAL: f64 = 1e-3;
/// A stable F over the bound of limit analysis from which something other than strength must hold the slope, and what
/// flow leaves of a bound over an F that was not stable from which something other than strength must fail.
const ABOVE: f64 = 1.02;
/// Weight of the rock over its height, over Young's modulus, from which blocks deform so much that the factor of rigid
/// ones is exceeded: on the slide of a wedge by 0.2 % here, 1 % at 0.015 and 4 % at 0.06.
const SOFT: f64 = 3e-3;
/// Share by which the pressure of water in joints may differ between trials and limit analysis.
const WATER_APART: f64 = 0.02;
/// Blocks that a warning names.
const NAMED: usize = 3;

impl Reduction {
    /// The upper bound of limit analysis, when a trial above it was stable: the factor of safety is at most that,
    /// whatever the trials say. Its mechanism holds more than the few blocks that do not count in trials.
    pub fn at_most(&self) -> Option<f64> {
        let (limit, moving): (_, f64) = match (&self.bracket, &self.bound) {
            (Some(bracket), _) => (bracket.upper.value(), bracket.moving().map(|motion| motion.mass).sum()),
            (None, Ok(Bound { level_tops, .. })) => {
                (level_tops.factor.value(), level_tops.mechanism.iter().map(|block| block.mass).sum())
            }
            (None, Err(_)) => return None,
        };
        if moving <= self.simulation.mass_of_few() {
            return None;
        }
        self.low.filter(|stable| *stable > ABOVE * limit).map(|_| limit)
    }

    /// Why the factor is in doubt: it is above the bound of limit analysis, or far below it. The text is among the
    /// warnings, too.
    pub fn doubt(&self) -> Option<String> {
        self.held().or_else(|| self.below())
    }

    /// The factor of rock that yields is farther below its lower bound than flow without dilation explains.
    fn below(&self) -> Option<String> {
        let (bracket, failed) = (self.bracket.as_ref()?, self.high?);
        far_below(failed, bracket.lower.value(), least_kept(self.simulation.case(), failed))
    }

    /// The factor is above the bound.
    fn held(&self) -> Option<String> {
        let (limit, stable) = (self.at_most()?, self.low?);
        let over = 100.0 * (stable / limit - 1.0);
        let above = format!("F = {stable:.4} was stable, {over:.1} % above");
        Some(if self.bracket.is_some() {
            format!(
                "{above} the upper bound of limit analysis ({limit:.4}): the mesh is too coarse for rock that yields; \
                 set a smaller `mesh.size`"
            )
        } else {
            format!(
                "{above} what limit analysis of rigid blocks allows ({limit:.4}): something other than strength \
                 holds a block; look at those that `enmm bound` names, and try a finer mesh"
            )
        })
    }
}

/// Share of the strength divided by a factor that flow at a dilation angle leaves (degrees; E. H. Davis 1968; Eq. 65a).
fn kept(friction_deg: f64, dilation_deg: f64, factor: f64) -> f64 {
    let friction = libm::atan(libm::tan(friction_deg.to_radians()) / factor);
    let dilation = dilation_deg.to_radians().min(friction);
    let [(sin, cos), (sin_of, cos_of)] = [friction, dilation].map(libm::sincos);
    cos * cos_of / (1.0 - sin * sin_of)
}

/// The least of these shares of the rocks that yield, of their planes of weakness and of the joints.
fn least_kept(case: &Case, factor: f64) -> f64 {
    let of_rock = |rock: &Rock| {
        let dilation = rock.dilation_deg.unwrap_or_default();
        match &rock.hoek_brown {
            Some(mass) if mass.associated => 1.0,
            Some(mass) => kept(libm::atan(mass.envelope().unconfined().friction).to_degrees(), dilation, factor),
            None => kept(rock.friction_deg.unwrap_or_default(), dilation, factor),
        }
    };
    let rocks = case.rocks.values().filter(|rock| rock.yields()).map(of_rock);
    let planes = case.rocks.values().filter_map(|rock| rock.plane_of_weakness.as_ref());
    let planes = planes.map(|plane| kept(plane.friction_deg, plane.dilation_deg, factor));
    let joints = case.joint_laws.values().map(|law| kept(law.friction_deg, law.dilation_deg, factor));
    rocks.chain(planes).chain(joints).fold(1.0, f64::min)
}

/// What to say of an F that was not stable, with the lower bound and the share of the strength that flow leaves.
fn far_below(failed: f64, lower: f64, kept: f64) -> Option<String> {
    (ABOVE * failed < kept * lower).then(|| {
        format!(
            "F = {failed:.4} was not stable, {:.1} % below the lower bound of limit analysis ({lower:.4}); flow that \
             dilates by less than its friction explains {:.1} % (E. H. Davis 1968): unless columns topple, a part of \
             the model fails that strength would hold; look at the blocks that fail, and try another `mesh.size`",
            100.0 * (1.0 - failed / lower),
            100.0 * (1.0 - kept)
        )
    })
}

/// Reasons not to take the result as it is.
pub fn doubts(reduction: &Reduction, case: &Case) -> Vec<String> {
    let trials = &reduction.trials;
    let mut doubts = Vec::new();
    doubts.extend(not_monotone(trials));
    doubts.extend(slid(trials, |t| t.verdict == Verdict::Caught, "were caught: that does not count as stable"));
    doubts.extend(reduction.corners.as_ref().map(CornersHold::doubt));
    doubts.extend(reduction.ends.as_ref().map(NearEnds::warning));
    doubts.extend(far(trials));
    doubts.extend(reduction.doubt());
    doubts.extend(undecided(trials));
    doubts.extend(loose(reduction));
    doubts.extend(soft(case));
    doubts.extend(other_water(reduction, case));
    let rubbing = case.joint_laws.values().any(|law| law.friction_deg > 0.0);
    if !rubbing && !case.joint_laws.is_empty() {
        doubts.push("no joint has friction: the factor is one on cohesion and tensile strength alone".to_owned());
    }
    let worst = reduction.ledger_residual();
    if worst > RESIDUAL {
        doubts.push(format!(
            "the energy ledger of a trial is open by {worst:.1e} of its largest term (limit {RESIDUAL})"
        ));
    }
    doubts
}

/// Water in joints that presses otherwise in the trials than in limit analysis, which knows no openings.
fn other_water(reduction: &Reduction, case: &Case) -> Option<String> {
    let in_trials = reduction.simulation.pressure_in_joints()?;
    let at_start = staged(case).ok()?.0.pressure_in_joints()?;
    let apart = (in_trials - at_start).abs() / in_trials.max(at_start);
    (apart > WATER_APART).then(|| {
        format!(
            "water presses on the joints with {in_trials:.4e} N/m in the trials, whose joints have opened and closed \
             as at rest, and with {at_start:.4e} N/m in limit analysis, whose joints are as at the start: {:.1} % \
             apart; F and its bound are of other water: compare with equal aperture_min and aperture_max in [flow], \
             which keep apertures as they are",
            100.0 * apart
        )
    })
}

/// Blocks so soft that they hold more by deforming; rock that yields is compared with bounds of its own.
fn soft(case: &Case) -> Option<String> {
    let heights = case.domain.outline.iter().map(|point| point[1]);
    let [low, high] = heights.fold([f64::MAX, f64::MIN], |[low, high], y| [low.min(y), high.max(y)]);
    let weight = |rock: &Rock| rock.density * libm::hypot(case.gravity.x, case.gravity.y) * (high - low) / rock.young;
    let softest = case.rocks.iter().max_by(|a, b| weight(a.1).total_cmp(&weight(b.1)))?;
    let share = weight(softest.1);
    (!case.yields() && share > SOFT).then(|| {
        format!(
            "rock.{}.young: the weight of {:.1} m of this rock is {share:.1e} of it, so that blocks deform and hold \
             more than rigid ones: F of a slide is some 1 % too high at 1.5e-2 and 4 % at 6e-2; compare it with the \
             bound of limit analysis, or give the modulus of intact rock",
            softest.0,
            high - low
        )
    })
}

impl CornersHold {
    /// That corners hold the slope.
    fn doubt(&self) -> String {
        format!(
            "corners that meet rock ahead of them carry the slope: {}, which is more than rock of {:.0} MPa bears \
             there; the factor is that without them, {} with them; solver.corner_contacts = \"hold\" counts them",
            self.places(),
            self.corners.iter().map(|corner| corner.corner.strength).fold(f64::INFINITY, f64::min) / 1e6,
            self.series.text()
        )
    }
}

/// Stable trials in which blocks moved far before they rested.
fn far(trials: &[Trial]) -> Option<String> {
    let far = |t: &&Trial| t.verdict == Verdict::Stable && t.is_far;
    let first = trials.iter().find(far)?;
    let last = trials.iter().rfind(far)?;
    Some(format!(
        "from F = {:.4} on the slope rests only after its blocks have moved, by {:.2} m at F = {:.4}",
        first.factor, last.displacement, last.factor
    ))
}

fn not_monotone(trials: &[Trial]) -> Option<String> {
    let of = |stable: bool| trials.iter().filter(move |t| (t.verdict == Verdict::Stable) == stable).map(|t| t.factor);
    let (stable, other) = (of(true).fold(0.0, f64::max), of(false).fold(f64::INFINITY, f64::min));
    (other < stable).then(|| {
        format!(
            "F = {stable:.4} was stable, but F = {other:.4} was not: the verdict is not monotone, look at both trials"
        )
    })
}

/// Blocks that slid off or fell in trials at which the slope is stable.
fn loose(reduction: &Reduction) -> Option<String> {
    let stable = reduction.trials.iter().filter(|t| t.verdict == Verdict::Stable);
    let first = stable.clone().find(|t| !t.loose.is_empty())?;
    let block =
        |b: &FailingBlock| format!("{} of {:.3} m² at ({:.3}, {:.3}) m", b.block, b.area, b.position.x, b.position.y);
    let named: Vec<String> = first.loose.iter().take(NAMED).map(block).collect();
    let blocks = if first.loose.len() == 1 { "block" } else { "blocks" };
    Some(format!(
        "from F = {:.4} on {blocks} {} slid off or fell; they have less than a thousandth of the free mass, and do not \
         count as a failure of the slope",
        first.factor,
        named.join(", ")
    ))
}

/// Trials whose time was over before motion had died or grown.
fn undecided(trials: &[Trial]) -> Option<String> {
    let trend = trials.iter().filter(|t| t.reason == Reason::Trend);
    let told: Vec<String> = trend.map(|t| format!("{:.4} ({})", t.factor, t.verdict.name())).collect();
    let trials = if told.len() == 1 { "trial F =" } else { "trials F =" };
    (!told.is_empty()).then(|| format!("judged by their trend when their time was over: {trials} {}", told.join(", ")))
}

/// Trials in which blocks slid and stopped, and how that counts.
fn slid(trials: &[Trial], counts: impl Fn(&&Trial) -> bool, fate: &str) -> Option<String> {
    let slid: Vec<&Trial> = trials.iter().filter(counts).collect();
    let (first, last) = (slid.first()?, slid.last()?);
    let far = slid.iter().map(|t| t.displacement).fold(0.0, f64::max);
    let range = if slid.len() == 1 {
        format!("F = {:.4}", first.factor)
    } else {
        format!("F = {:.4} to {:.4}", first.factor, last.factor)
    };
    Some(format!(
        "at {range} joints slipped or rock flowed by up to {far:.3} m, farther than elasticity explains, and {fate}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_soft_by_their_weight_and_height() {
        let text = r#"
title = "slide"
domain = { outline = [[0, 0], [20, 0], [20, 4], [8, 12], [0, 12]] }
mesh = { size = 2 }
rock.rock = { density = 2600, young = 110e6, poisson = 0.25 }
stage = [{ name = "rest", kind = "static", duration = 1 }]
"#;
        let mut case = enmm_io::parse_case(text, "case.toml", std::path::Path::new("")).expect("a case").case;
        assert_eq!(soft(&case), None, "306 kPa of 110 MPa");
        case.rocks.get_mut("rock").expect("a rock").young = 20e6;
        assert!(soft(&case).is_some_and(|told| told.contains("rock.rock.young") && told.contains("1.5e-2")));
        case.gravity.y = 0.0;
        assert_eq!(soft(&case), None);
    }

    /// Associated flow leaves all strength; without dilation cos φ of it is left, at the friction that a factor leaves.
    #[test]
    fn flow_that_does_not_dilate_leaves_a_share_of_the_strength() {
        for (phi, psi, factor, expected) in [
            (40.0, 40.0, 1.0, 1.0),
            (40.0, 0.0, 1.0, 0.766_044_443),
            (45.0, 0.0, 0.5, 0.447_213_595),
            (30.0, 30.0, 3.0, 1.0),
            (30.0, 10.0, 1.0, 0.933_958_640),
            (0.0, 0.0, 1.0, 1.0),
        ] {
            let found = kept(phi, psi, factor);
            assert!((found - expected).abs() < 1e-8, "{phi} {psi} {factor}: {found}");
        }
    }

    /// A plane slide with 0.62 for 1.396 is in doubt, a slope of soil 5 % below its bound is not.
    #[test]
    fn a_factor_far_below_its_bound_is_in_doubt() {
        let doubt = far_below(0.6265, 1.396, kept(43.0, 0.0, 0.6265)).unwrap_or_default();
        assert!(doubt.contains("55.1 % below") && doubt.contains("explains 44.2 %"), "{doubt}");
        assert_eq!(far_below(1.31, 1.38, kept(20.0, 0.0, 1.31)), None);
        assert!(far_below(1.31, 1.38, 1.0).is_some());
    }
}
