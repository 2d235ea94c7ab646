//! The bound without the corner contacts that carry a slope (theory, sections 16 and 19).

use enmm::geometry::Point;

use crate::corners::CornerContact;

use super::RANGE;
use super::contact::Contact;
use super::corner::Corner;
use super::program::{Program, Unsolved};
use super::search::{Limit, Search};

/// A limit without corner contacts that would carry more than the rock over their length bears.
pub struct Released {
    /// The limit.
    pub limit: Limit,
    /// The corner contacts.
    pub corners: Vec<CornerContact>,
}

/// Releases corner contacts; none where there are none that carry too much. `level_tops` is the limit in which they
/// hold, `facing` are the corners that face each other.
///
/// # Errors
/// A program that is not solved.
pub fn released(
    search: &mut Search,
    corners: Vec<CornerContact>,
    facing: &[Corner],
    level_tops: &Limit,
) -> Result<Option<Released>, Unsolved> {
    let program = search.program;
    let normals = match &level_tops.mechanism {
        Some(solution) => solution.normals.clone(),
        None if corners.iter().all(|corner| corner.length() == 0.0) => Vec::new(),
        None => search.solve(1.0 / RANGE[1], &[])?.normals,
    };
    let force = |corner: &CornerContact| -> f64 {
        let of_corner = program.contacts.iter().zip(&normals).filter(|(contact, _)| is_at(contact, corner));
        of_corner.map(|(_, normal)| normal.max(0.0)).sum()
    };
    let crushed = |corner: &CornerContact| corner.length() == 0.0 || force(corner) >= corner.capacity();
    let corners: Vec<CornerContact> = corners.into_iter().filter(crushed).collect();
    if corners.is_empty() {
        return Ok(None);
    }
    let holds = |contact: &Contact| !corners.iter().any(|corner| is_at(contact, corner));
    let contacts = program.contacts.iter().copied().filter(holds).collect();
    let facing: Vec<Corner> = facing.iter().filter(|pair| pair.facets.iter().all(holds)).copied().collect();
    let without = Program { contacts, bodies: program.bodies.clone(), bars: program.bars.clone() };
    let mut again = Search { program: &without, programs: 0 };
    let associated = again.limit_near(&[], Some(level_tops))?;
    let limit = again.facets(&facing, associated)?.limit;
    search.programs += again.programs;
    Ok(Some(Released { limit, corners }))
}

/// Whether a contact is one of a corner contact: a point of it, or a piece of the length over which faces meet.
fn is_at(contact: &Contact, corner: &CornerContact) -> bool {
    let others = || corner.contacts.iter().map(|(block, _)| *block);
    let [a, b] = contact.blocks;
    let is_of_both = (a == corner.block && others().any(|o| o == b)) || (b == corner.block && others().any(|o| o == a));
    is_of_both && contact.is_point() == (corner.length() == 0.0) && contact.ends.iter().all(|&end| lies_on(end, corner))
}

/// Whether a place lies on the length of a corner contact.
fn lies_on(place: Point, corner: &CornerContact) -> bool {
    let [a, b] = corner.ends;
    let round_off = 1e-9 * (1.0 + place.norm());
    (place - a).norm() + (b - place).norm() <= corner.length() + round_off
}
