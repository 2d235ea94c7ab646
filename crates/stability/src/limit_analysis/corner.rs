//! Positions where blocks meet in a point: corners in notches and on faces, and corners that face each other at
//! crossings.

use std::f64::consts::PI;

use enmm::geometry::{Point, TraceId, Vector};
use enmm::model::tables::{BlockId, Outlines};

use super::contact::{Contact, outward};
use super::model::Strengths;

/// Angle (rad) within which a corner counts as straight.
const STRAIGHT: f64 = 1e-5;

/// Two corners that face each other: the second must stay outside one facet or the other (Eq. 80).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Both facets as point contacts of the same two blocks.
    pub facets: [Contact; 2],
}

/// The rock of one block about a point, between two of its faces.
#[derive(Debug, Clone, Copy)]
struct Sector {
    at: Point,
    block: BlockId,
    /// Ends of the face that leaves the point and of the one that comes to it, rock on their left.
    far: [Point; 2],
    /// Joint traces of both.
    traces: [Option<TraceId>; 2],
    /// Angle of the rock (rad).
    angle: f64,
}

/// Point contacts that act in any case, and pairs of facing corners of which one facet acts.
pub fn corners(outlines: &Outlines, element_block: &[BlockId], strengths: &Strengths) -> (Vec<Contact>, Vec<Corner>) {
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let sectors = sectors(outlines, element_block, strengths);
    // Two sectors about a point press on each other there if they leave a gap between them.
    let meet = |group: &&[Sector]| group.len() > 2 || group.len() == 2 && group[0].shared(&group[1]) < 2;
    for group in sectors.chunk_by(|a, b| a.at == b.at).filter(meet) {
        let group = merged(group);
        for (k, a) in group.iter().enumerate() {
            for b in group[k + 1..].iter().filter(|b| b.block != a.block && strengths.can_act([a.block, b.block])) {
                match a.meeting(b, strengths) {
                    Meeting::Points(found) => points.extend(found),
                    Meeting::Facing(corner) => corners.push(corner),
                }
            }
        }
    }
    (points, corners)
}

/// All sectors of blocks that are there, those about the same point one after the other.
fn sectors(outlines: &Outlines, element_block: &[BlockId], strengths: &Strengths) -> Vec<Sector> {
    let mut sectors = Vec::new();
    for k in 0..outlines.len() {
        let pieces = outlines.of_loop(k);
        for (before, after) in pieces.iter().cycle().skip(pieces.len() - 1).zip(pieces) {
            let block = element_block[after.element];
            if strengths.is_gone(block) {
                continue;
            }
            let far = [after.b, before.a];
            let angle = angle(after.b - after.a, before.a - after.a);
            sectors.push(Sector { at: after.a, block, far, traces: [after.trace, before.trace], angle });
        }
    }
    let key = |s: &Sector| (s.at.x.to_bits(), s.at.y.to_bits(), s.block);
    sectors.sort_by_key(key);
    sectors
}

/// Angle (rad) from one direction counter-clockwise to another, a full turn when they are the same.
fn angle(from: Vector, to: Vector) -> f64 {
    let angle = libm::atan2(from.perp(&to), from.dot(&to));
    if angle <= 0.0 { angle + 2.0 * PI } else { angle }
}

/// Sectors with those of one block joined that only a crack parts.
fn merged(group: &[Sector]) -> Vec<Sector> {
    let mut sectors = group.to_vec();
    let pair = |sectors: &[Sector]| {
        let next = |a: &Sector| sectors.iter().position(|b| b.block == a.block && b.far[0] == a.far[1]);
        sectors.iter().enumerate().find_map(|(k, a)| next(a).filter(|&j| j != k).map(|j| (k, j)))
    };
    while let Some((k, j)) = pair(&sectors) {
        let (a, b) = (sectors[k], sectors[j]);
        let far = [a.far[0], b.far[1]];
        sectors[k] = Sector { far, traces: [a.traces[0], b.traces[1]], angle: a.angle + b.angle, ..a };
        sectors.remove(j);
    }
    sectors
}

/// How two sectors about one point press on each other besides the interfaces that they share.
enum Meeting {
    Points(Vec<Contact>),
    Facing(Corner),
}

impl Sector {
    /// Directions of both faces, away from the point.
    fn rays(&self) -> [Vector; 2] {
        self.far.map(|far| (far - self.at).normalize())
    }

    /// Number of faces that two sectors share.
    fn shared(&self, other: &Self) -> usize {
        usize::from(self.far[0] == other.far[1]) + usize::from(self.far[1] == other.far[0])
    }

    /// Its faces as point contacts that press on another block, those left out that the other shares.
    fn faces(&self, other: &Self, strengths: &Strengths) -> Vec<Contact> {
        let face = |k: usize| {
            let normal = outward(self.rays()[k]) * [1.0, -1.0][k];
            strengths.point([self.block, other.block], self.at, normal, self.traces[k])
        };
        (0..2).filter(|&k| self.far[k] != other.far[1 - k]).map(face).collect()
    }

    fn meeting(&self, other: &Self, strengths: &Strengths) -> Meeting {
        let (wide, narrow) = if self.angle >= other.angle { (self, other) } else { (other, self) };
        let is_straight = (wide.angle - PI).abs() <= STRAIGHT;
        match wide.shared(narrow) {
            2 => Meeting::Points(Vec::new()),
            1 if wide.angle <= PI + STRAIGHT => Meeting::Points(Vec::new()),
            0 if is_straight => Meeting::Points(wide.faces(narrow, strengths).into_iter().take(1).collect()),
            0 if wide.angle < PI => self.facing(other, strengths),
            _ => Meeting::Points(wide.faces(narrow, strengths)),
        }
    }

    /// The two facets of the cone of motions by which the other sector would enter this one (Eq. 80).
    fn facing(&self, other: &Self, strengths: &Strengths) -> Meeting {
        let (own, across) = (self.rays(), other.rays().map(|ray| -ray));
        // The facet on the side from which angles are counted, and the one at their end.
        let pick = |k: usize, sign: f64| {
            if sign * own[k].perp(&across[k]) > 0.0 { (own[k], self.traces[k]) } else { (across[k], other.traces[k]) }
        };
        let facet = |(ray, trace): (Vector, Option<TraceId>), side: f64| {
            strengths.point([self.block, other.block], self.at, outward(ray) * side, trace)
        };
        let facets = [facet(pick(0, 1.0), 1.0), facet(pick(1, -1.0), -1.0)];
        if facets[0].normal.dot(&facets[1].normal) > 1.0 - STRAIGHT * STRAIGHT {
            Meeting::Points(vec![facets[0]])
        } else {
            Meeting::Facing(Corner { facets })
        }
    }
}
