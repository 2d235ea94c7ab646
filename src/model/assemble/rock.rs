//! Which rock each element is made of, and the strength of rock.

use crate::contact::LawId;
use crate::cover::{BlockId, Covers, ElementId};
use crate::geometry::polygon;
use crate::mechanics::{
    Averaging, Criterion, Elasticity, HoekBrown, MohrCoulomb, PlasticStrain, RockStrength, Weakness, YieldingRock,
};
use crate::model::case::{self, Case, Invalid, Plane, PlaneOfWeakness, Rock};
use crate::state::{Breaking, BreakingRock, Model};

use super::locator::Locator;
use super::points;

/// Elastic constants of a rock of the case.
fn elasticity(rock: &Rock) -> Elasticity {
    match rock.plane {
        Plane::Strain => Elasticity::plane_strain(rock.young, rock.poisson, rock.density),
        Plane::Stress => Elasticity::plane_stress(rock.young, rock.poisson, rock.density),
    }
}

/// Elastic constants and strength of a rock of the case; none when it never yields.
pub(super) fn yielding(rock: &Rock) -> Option<YieldingRock> {
    let plane_stress = rock.plane == Plane::Stress;
    let (elasticity, criterion, is_porous) = (elasticity(rock), criterion(rock), rock.is_porous());
    let weakness = rock.plane_of_weakness.as_ref().map(weakness);
    rock.yields().then_some(YieldingRock { elasticity, plane_stress, is_porous, criterion, weakness })
}

fn weakness(plane: &PlaneOfWeakness) -> Weakness {
    let tangent = |degrees: f64| libm::tan(degrees.to_radians());
    let (sin, cos) = libm::sincos(plane.angle_deg.unwrap_or_default().to_radians());
    Weakness {
        direction: [cos, sin],
        friction: tangent(plane.friction_deg),
        cohesion: plane.cohesion,
        dilation: tangent(plane.dilation_deg),
        tension: plane.tension,
    }
}

fn criterion(rock: &Rock) -> Criterion {
    let tangent = |degrees: f64| libm::tan(degrees.to_radians());
    let dilation = rock.dilation_deg.unwrap_or(0.0);
    match &rock.hoek_brown {
        Some(mass) => {
            let dilation = if mass.associated { f64::INFINITY } else { tangent(dilation) };
            Criterion::HoekBrown(HoekBrown::new(mass.envelope(), dilation, rock.tension))
        }
        None => Criterion::MohrCoulomb(MohrCoulomb {
            friction: tangent(rock.friction_deg.unwrap_or(0.0)),
            cohesion: rock.cohesion.unwrap_or(0.0),
            dilation: tangent(dilation),
            tension: rock.tension,
        }),
    }
}

/// How rock breaks; none of a case whose rock does not.
pub(super) fn breaking(case: &Case) -> Option<Breaking> {
    let of = |(k, rock): (usize, &Rock)| {
        let fracture = rock.fracture.as_ref()?;
        let strength = RockStrength {
            tension: fracture.tension,
            cohesion: fracture.cohesion,
            friction: libm::tan(fracture.friction_deg.to_radians()),
            characteristic: fracture
                .tension_energy
                .map_or(0.0, |energy| elasticity(rock).plane_modulus() * energy / fracture.tension.powi(2)),
        };
        Some(BreakingRock { strength, law: crack_law(case, k), cores: fracture.cores })
    };
    let case::Fracture { every, longest, least_part, parts_max, cuts_max } = case.fracture.clone().unwrap_or_default();
    case.breaks().then(|| Breaking {
        rocks: case.rocks.values().enumerate().map(of).collect(),
        every: u64::from(every),
        longest: longest.unwrap_or(f64::INFINITY),
        least_part: least_part.unwrap_or_else(|| case.mesh.least_block().max(3f64.sqrt() * case.mesh.size.powi(2))),
        parts_max: parts_max as usize,
        cuts_max: cuts_max as usize,
    })
}

/// How many blocks can break, and a warning where none can.
pub(super) fn breakable(model: &Model) -> (Option<String>, Option<String>) {
    let Some(breaking) = &model.breaking else { return (None, None) };
    let least = breaking.least_part;
    let is_large = |&block: &BlockId| model.covers.block_area(block) >= 2.0 * least;
    let (large, all) = (model.covers.blocks().filter(is_large).count(), model.covers.block_count());
    if large == 0 {
        let text = format!(
            "no block can break: all are smaller than two parts of {least:.3e} m²; refine mesh.size, or lower \
             fracture.least_part"
        );
        return (None, Some(text));
    }
    let note = format!("{large} of {all} blocks are large enough to break into parts of at least {least:.3e} m²");
    (Some(note), None)
}

/// The law of the cracks of a rock, by its place in the case: those of all rocks that break come after all others.
pub(super) fn crack_law(case: &Case, rock: usize) -> LawId {
    let before = case.rocks.values().take(rock).filter(|rock| rock.fracture.is_some()).count();
    LawId::new(case.joint_laws.len().max(1) + before)
}

/// Joint laws of the cracks of all rocks that break, in the order of the rocks.
pub(super) fn crack_laws(case: &Case) -> impl Iterator<Item = case::JointLaw> {
    let broken = case.rocks.values().filter_map(|rock| rock.fracture.as_ref());
    broken.map(|fracture| case::JointLaw {
        cohesion: fracture.cohesion,
        tension: fracture.tension,
        residual_friction_deg: fracture.residual_friction_deg,
        residual_cohesion: Some(0.0),
        tension_energy: fracture.tension_energy,
        ..case::JointLaw::frictional(fracture.friction_deg)
    })
}

/// All rocks, that of each element, and the patches of those that can yield.
pub(super) fn of_elements(case: &Case, positions: &Locator) -> Result<(Vec<Elasticity>, Vec<u16>, Averaging), Invalid> {
    let rocks = case.rocks.values().map(elasticity).collect();
    let rock = assign(case, positions)?;
    let yields = case.rocks.values().map(Rock::yields).collect();
    let averaging = Averaging::new(positions.covers, &rock, yields);
    Ok((rocks, rock, averaging))
}

/// No plastic strain in any element; empty when no rock yields.
pub(super) fn plastic(model: &Model) -> Vec<PlasticStrain> {
    let yields = model.strengths.iter().any(Option::is_some);
    vec![[0.0; 4]; if yields { model.covers.element_count() } else { 0 }]
}

/// In-situ stress out of the plane of each element (Pa); empty when there is none or no rock yields.
pub(super) fn pre_stresses_out(case: &Case, covers: &Covers, element_rock: &[u16]) -> Vec<f64> {
    let Some(field) = case.in_situ.as_ref().filter(|_| case.yields()) else {
        return Vec::new();
    };
    let rocks: Vec<&Rock> = case.rocks.values().collect();
    let sum = field.sxx.unwrap_or_default() + field.syy.unwrap_or_default();
    let reference = field.y_reference.unwrap_or_default();
    let of_element = |e: ElementId| {
        let (rock, height) = (rocks[element_rock[e] as usize], covers.element_centroid[e].y - reference);
        let in_plane = sum + (field.gradient[0] + field.gradient[1]) * height;
        match rock.plane {
            Plane::Stress => 0.0,
            Plane::Strain => field.szz.map_or(rock.poisson * in_plane, |szz| szz + field.szz_gradient * height),
        }
    };
    covers.elements().map(of_element).collect()
}

/// A warning where the in-situ stress is beyond the strength of the rock: how many elements, where, and by how much.
pub(super) fn overstressed(case: &Case, model: &Model) -> Option<String> {
    case.in_situ.as_ref()?;
    let excess = |e: ElementId| {
        let strength = model.strength_of(e)?;
        let stress = model.pre_stress_and_out(e);
        let size = stress.iter().fold(strength.least_stress(1.0), |a, s| a.max(s.abs()));
        let excess = strength.surface(1.0).excess(stress);
        (excess > 1e-9 * size).then_some((e, excess))
    };
    let beyond: Vec<(ElementId, f64)> = model.covers.elements().filter_map(excess).collect();
    let &(worst, most) = beyond.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let position = model.covers.element_centroid[worst];
    let name = case.rocks.keys().nth(model.element_rock[worst] as usize).map_or("", String::as_str);
    Some(format!(
        "the in-situ stress is beyond the strength of the rock in {} of {} elements, most at ({:.6}, {:.6}) m in \
         `{name}`, by {most:.3e} Pa; they yield in the first step: lower the stress, set `in_situ.szz`, or raise the \
         strength",
        beyond.len(),
        model.covers.element_count(),
        position.x,
        position.y
    ))
}

/// By how much (%) a slope in rock that yields is too strong on a mesh of a tenth of its height: where the rock keeps
/// its volume, and where it dilates (theory, section 15). It goes with the square of the mesh size.
const TOO_STRONG: [f64; 2] = [1.0, 2.8];
/// How much (%) each tenfold stiffness adds to that, above [`SOFT`].
const STIFFER: f64 = 1.3;
/// Young's modulus over the weight γH of the slope for which that holds.
const SOFT: f64 = 500.0;
/// Most (%) that goes without a warning, and the aim of the mesh that it proposes.
const UNSEEN: [f64; 2] = [3.0, 2.0];

/// By how much (%) factors of safety of a rock come out too high with elements of a tenth of a height (m).
fn too_strong(case: &Case, rock: &Rock, height: f64) -> f64 {
    let weight = rock.density * libm::hypot(case.gravity.x, case.gravity.y) * height;
    // Trials of whole rock are made with a stiffness for which nothing is added.
    let stiffer = if case.is_whole() { 0.0 } else { libm::log10(rock.young / weight / SOFT).max(0.0) };
    TOO_STRONG[usize::from(rock.dilates())] + STIFFER * stiffer
}

/// Warns that factors of safety of rock that yields come out too high on a coarse mesh (theory, section 15).
pub(super) fn coarse(case: &Case) -> Option<String> {
    let (low, high) = polygon::bounds(&points(&case.domain.outline));
    let (size, height) = (case.mesh.size, (high - low).y);
    let is_slope = case.gravity.x != 0.0 || case.gravity.y != 0.0;
    let rocks = case.rocks.values().filter(|rock| is_slope && rock.yields());
    let most = rocks.map(|rock| too_strong(case, rock, height)).fold(0.0, f64::max);
    let percent = most * (10.0 * size / height).powi(2);
    (percent > UNSEEN[0]).then(|| {
        format!(
            "rock yields on a mesh of {size:.6} m, {:.1} elements over the height of the model ({height:.6} m): \
             factors of safety of slopes in soil came out about {percent:.0} % too high on such a mesh in rock of this \
             stiffness: set `mesh.size` to {:.6} m or less for {} %",
            height / size,
            0.1 * height * (UNSEEN[1] / most).sqrt(),
            UNSEEN[1]
        )
    })
}

/// Rock of each element: by block, else by region, else the rock that names neither.
fn assign(case: &Case, positions: &Locator) -> Result<Vec<u16>, Invalid> {
    let background = case.rocks.values().position(|r| r.region.is_none() && r.blocks.is_empty());
    let mut owner: Vec<Option<usize>> = vec![None; positions.covers.element_count()];
    for (k, (name, rock)) in case.rocks.iter().enumerate() {
        let Some(region) = &rock.region else { continue };
        let region = points(region);
        let inside = |e: &ElementId| polygon::contains(&region, positions.covers.element_centroid[*e]);
        for e in positions.covers.elements().filter(inside) {
            claim(&mut owner, e, k, case, &format!("rock.{name}.region"), positions)?;
        }
    }
    let mut by_block: Vec<Option<usize>> = vec![None; owner.len()];
    for (k, (name, rock)) in case.rocks.iter().enumerate() {
        for (n, &point) in rock.blocks.iter().enumerate() {
            let key = format!("rock.{name}.blocks[{n}]");
            for e in ElementId::range(positions.covers.elements_of(positions.block(&key, point)?)) {
                claim(&mut by_block, e, k, case, &key, positions)?;
            }
        }
    }
    positions
        .covers
        .elements()
        .map(|e| {
            let rock = by_block[e].or(owner[e]).or(background).ok_or_else(|| unassigned(positions, e))?;
            Ok(rock as u16)
        })
        .collect()
}

fn claim(
    owner: &mut [Option<usize>],
    element: ElementId,
    rock: usize,
    case: &Case,
    key: &str,
    positions: &Locator,
) -> Result<(), Invalid> {
    if let Some(other) = owner[element].filter(|&other| other != rock) {
        let at = positions.covers.element_centroid[element];
        let name = case.rocks.keys().nth(other).map_or("", String::as_str);
        return Err(Invalid {
            key: key.into(),
            message: format!(
                "the rock at ({:.6}, {:.6}) belongs to `{name}` already: let them not overlap",
                at.x, at.y
            ),
        });
    }
    owner[element] = Some(rock);
    Ok(())
}

fn unassigned(positions: &Locator, element: ElementId) -> Invalid {
    let at = positions.covers.element_centroid[element];
    Invalid {
        key: "rock".into(),
        message: format!(
            "no rock is assigned at ({:.6}, {:.6}): enlarge a region, or let one rock have neither region nor blocks",
            at.x, at.y
        ),
    }
}
