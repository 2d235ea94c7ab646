//! Which rock each element is made of.

use crate::geometry::polygon;
use crate::mechanics::Elasticity;
use crate::model::case::{Case, Invalid, Plane, Rock};

use super::geometry::points;
use super::place::Places;

/// Elastic constants of a rock of the case.
pub(super) fn elasticity(rock: &Rock) -> Elasticity {
    match rock.plane {
        Plane::Strain => Elasticity::plane_strain(rock.young, rock.poisson, rock.density),
        Plane::Stress => Elasticity::plane_stress(rock.young, rock.poisson, rock.density),
    }
}

/// Rock of each element: by block, else by region, else the rock that names neither.
pub(super) fn assign(case: &Case, places: &Places) -> Result<Vec<u16>, Invalid> {
    let background = case.rocks.values().position(|r| r.region.is_none() && r.blocks.is_empty());
    let mut owner: Vec<Option<usize>> = vec![None; places.covers.element_count()];
    for (k, (name, rock)) in case.rocks.iter().enumerate() {
        let Some(region) = &rock.region else { continue };
        let region = points(region);
        let inside = |e: &usize| polygon::contains(&region, places.covers.element_centroid[*e]);
        for e in (0..owner.len()).filter(inside) {
            claim(&mut owner, e, k, case, &format!("rock.{name}.region"), places)?;
        }
    }
    let mut by_block: Vec<Option<usize>> = vec![None; owner.len()];
    for (k, (name, rock)) in case.rocks.iter().enumerate() {
        for (n, &point) in rock.blocks.iter().enumerate() {
            let key = format!("rock.{name}.blocks[{n}]");
            for e in places.covers.elements_of(places.block(&key, point)?) {
                claim(&mut by_block, e, k, case, &key, places)?;
            }
        }
    }
    (0..owner.len())
        .map(|e| {
            let rock = by_block[e].or(owner[e]).or(background).ok_or_else(|| unassigned(places, e))?;
            Ok(rock as u16)
        })
        .collect()
}

fn claim(
    owner: &mut [Option<usize>],
    element: usize,
    rock: usize,
    case: &Case,
    key: &str,
    places: &Places,
) -> Result<(), Invalid> {
    if let Some(other) = owner[element].filter(|&other| other != rock) {
        let at = places.covers.element_centroid[element];
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

fn unassigned(places: &Places, element: usize) -> Invalid {
    let at = places.covers.element_centroid[element];
    Invalid {
        key: "rock".into(),
        message: format!(
            "no rock is assigned at ({:.6}, {:.6}): enlarge a region, or let one rock have neither region nor blocks",
            at.x, at.y
        ),
    }
}
