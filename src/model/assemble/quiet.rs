//! Base motions, quiet boundaries and free-field columns of a case.

use crate::contact::{Resistance, Support};
use crate::geometry::{Point, Vector, segment};
use crate::mechanics::{Column, Elasticity, Foot, Record};
use crate::model::case::{self, Axes, Axis, BaseMotionKind, Case, Invalid};
use crate::state::{BaseMotion, Fixity, FreeFieldPoint, Model, MotionKind, QuietBoundary, TimedRecord};

use super::locator::{Locator, OuterPiece};
use super::{EDGE_RATIO, in_situ, port_of, stiffness_over};

/// Height of a lattice row over the mesh size: cells of columns are about as high, so that waves in both travel alike.
const ROW: f64 = 0.866_025_403_784_438_6;
/// Distance from the side's line, relative to the mesh size, at which the rock of a column is looked up.
const INSIDE: f64 = 1e-3;

/// Inputs from which the quiet boundaries of a case are made.
pub(super) struct Ground<'a> {
    pub case: &'a Case,
    pub positions: &'a Locator<'a>,
    pub rocks: &'a [Elasticity],
    pub element_rock: &'a [u16],
}

impl Ground<'_> {
    /// Stiffness (Pa/m) that those of supports are measured by.
    pub fn stiffness(&self) -> f64 {
        stiffness_over(self.positions.covers.mesh.size, self.case, self.rocks)
    }
}

/// Quiet boundaries and columns as built.
#[derive(Default)]
pub(super) struct Quiets {
    pub quiets: Vec<QuietBoundary>,
    pub columns: Vec<Column>,
    pub free_field: Vec<FreeFieldPoint>,
}

/// Motions of the base.
pub(super) fn base_motions(case: &Case) -> Vec<BaseMotion> {
    let of = |base: &case::BaseMotion| {
        let kind = match base.kind {
            BaseMotionKind::Acceleration => MotionKind::Acceleration,
            BaseMotionKind::Velocity | BaseMotionKind::Displacement => MotionKind::Velocity, // by `Case::expand`
        };
        let axis = match base.axis {
            Axis::X => Vector::x(),
            Axis::Y => Vector::y(),
        };
        BaseMotion { kind, motion: timed(case, &base.table, axis * base.scale, base.stage.as_deref()) }
    };
    case.base_motions.iter().map(of).collect()
}

fn timed(case: &Case, table: &Option<case::TimeTable>, amplitude: Vector, stage: Option<&str>) -> TimedRecord {
    let record = Record(table.clone().unwrap_or_default());
    TimedRecord { record, amplitude, stage: case.motion_stage(stage).unwrap_or(0) as u32 }
}

impl Ground<'_> {
    /// Quiet boundaries and free-field sides with their columns; their fixities and supports are appended.
    pub fn quiets(&self, fixities: &mut Vec<Fixity>, supports: &mut Vec<Support>) -> Result<Quiets, Invalid> {
        let mut made = Quiets::default();
        for (k, quiet) in self.case.quiets.iter().enumerate() {
            let pieces = self.positions.boundary(&format!("quiet[{k}].edge"), quiet.edge)?;
            let wave = quiet
                .wave
                .map(|wave| timed(self.case, &quiet.table, Vector::from(wave) * quiet.scale, quiet.stage.as_deref()));
            let number = made.quiets.len() as u32;
            let port = port_of(self.case, |port| port.quiet.and_then(|edge| self.case.quiet_of(edge)) == Some(k));
            made.quiets.push(QuietBoundary { springs: 0, dashpots: 0, wave, port, column: None });
            self.hold(&mut made.quiets[number as usize], quiet.axes, &pieces, fixities, supports);
            let fix = made.quiets[number as usize].dashpots;
            supports.extend(pieces.iter().flat_map(|piece| self.dashpots(piece, number, fix)));
        }
        for (k, side) in self.case.free_fields.iter().enumerate() {
            let key = format!("free_field[{k}].edge");
            let pieces = self.positions.boundary(&key, side.edge)?;
            let number = made.quiets.len() as u32;
            let column = self.column(&key, side.edge)?;
            let own = Some(made.columns.len() as u32);
            made.quiets.push(QuietBoundary { springs: 0, dashpots: 0, wave: None, port: None, column: own });
            self.hold(&mut made.quiets[number as usize], side.axes, &pieces, fixities, supports);
            for piece in &pieces {
                let first = supports.len() as u32;
                supports.extend(self.dashpots(piece, number, made.quiets[number as usize].dashpots));
                let added = &supports[first as usize..];
                made.free_field.extend(self.beside(&column, piece, first, added));
            }
            made.columns.push(column);
        }
        Ok(made)
    }

    /// The springs of a quiet boundary, preloaded by the in-situ stress like those of a fixity.
    fn hold(
        &self,
        quiet: &mut QuietBoundary,
        axes: Axes,
        pieces: &[OuterPiece],
        fixities: &mut Vec<Fixity>,
        supports: &mut Vec<Support>,
    ) {
        quiet.springs = fixities.len() as u32;
        quiet.dashpots = quiet.springs + 1;
        fixities.push(Fixity { active: true, ..Fixity::default() });
        fixities.push(Fixity::default());
        let stress = |p: Point| in_situ(self.case).map_or([0.0; 3], |field| field.at(p));
        let held = [axes != Axes::Y, axes != Axes::X];
        for (axis, direction) in [Vector::x(), Vector::y()].into_iter().enumerate().filter(|(axis, _)| held[*axis]) {
            supports.extend(pieces.iter().map(|piece| {
                let hold = piece.support(EDGE_RATIO * self.stiffness(), &stress);
                Support {
                    fix: quiet.springs,
                    block: hold.block,
                    covers: hold.covers,
                    weights: hold.weights,
                    direction,
                    resistance: Resistance::Spring,
                    stiffness: hold.stiffness,
                    preload: hold.preload[axis],
                }
            }));
        }
    }

    /// Dashpots ρ·cp along the normal and ρ·cs along the tangent of a piece, in its middle (Eq. 46). At the ends of the
    /// piece they would be twice as many, and give back 7 % more of a wave that comes in under 30°.
    fn dashpots(&self, piece: &OuterPiece, quiet: u32, fix: u32) -> [Support; 2] {
        let along = (piece.piece.b - piece.piece.a) / piece.length();
        let impedance = self.rocks[self.element_rock[piece.piece.element] as usize].impedances();
        let directions = [Vector::new(along.y, -along.x), along];
        [0, 1].map(|kind| Support {
            fix,
            block: piece.block,
            covers: piece.covers,
            weights: piece.middle(),
            direction: directions[kind],
            resistance: Resistance::Dashpot(quiet),
            stiffness: impedance[kind] * piece.length(),
            preload: 0.0,
        })
    }

    /// The column beside a vertical side.
    fn column(&self, key: &str, edge: [[f64; 2]; 2]) -> Result<Column, Invalid> {
        let [a, b] = edge.map(Point::from);
        let (foot, head) = if a.y < b.y { (a, b) } else { (b, a) };
        let (height, size) = (head.y - foot.y, self.positions.covers.mesh.size);
        let cells = (height / (ROW * size) + 1e-9).floor().max(1.0) as usize;
        let spacing = height / cells as f64;
        let beside = |y: f64| {
            let inside = [INSIDE, -INSIDE].map(|share| Point::new(foot.x + share * size, y));
            let found = inside.iter().find_map(|p| self.positions.covers.element_near(*p, self.positions.tolerance));
            found.ok_or_else(|| Invalid {
                key: key.into(),
                message: format!(
                    "there is no rock beside the side at ({}, {y:.6}): let the segment be as long as the side",
                    foot.x
                ),
            })
        };
        let mut rocks = Vec::new();
        let mut blocks = Vec::new();
        for cell in 0..cells {
            let element = beside(foot.y + (cell as f64 + 0.5) * spacing)?;
            rocks.push(self.rocks[self.element_rock[element] as usize]);
            blocks.push(self.positions.covers.element_block[element]);
        }
        blocks.push(blocks[cells - 1]);
        Ok(Column { foot_height: foot.y, spacing, rocks, blocks, foot: self.foot(foot) })
    }

    /// The quiet boundary that reaches the foot of a column, or else the base.
    fn foot(&self, position: Point) -> Foot {
        let tolerance = self.positions.tolerance;
        let reaches = |quiet: &case::Quiet| {
            let [a, b] = quiet.edge.map(Point::from);
            segment::distance(position, a, b) <= tolerance && a.x != b.x
        };
        self.case.quiets.iter().position(reaches).map_or(Foot::Rigid, |k| Foot::Quiet(k as u32))
    }

    /// Action of a column on the dashpots of a piece of side: its velocity, and its stress on the piece (Eq. 51).
    fn beside(&self, column: &Column, piece: &OuterPiece, first: u32, dashpots: &[Support]) -> Vec<FreeFieldPoint> {
        let rock = &self.rocks[self.element_rock[piece.piece.element] as usize];
        let (a, b) = (piece.piece.a, piece.piece.b);
        let ends = [column.position(a.y), column.position(b.y)];
        // Outward normal (dy, −dx)/l: a side that is walked upwards has the free field at its right.
        let of = |(k, support): (usize, &Support)| FreeFieldPoint {
            support: first + k as u32,
            at: column.position(0.5 * (a.y + b.y)),
            ends,
            stiffness: Vector::new(rock.mu * support.direction.y, rock.lambda * support.direction.x),
        };
        dashpots.iter().enumerate().map(of).collect()
    }
}

/// Quiet boundaries that carry no weight when motion begins: they hold in static stages only.
pub(super) fn warning(case: &Case) -> Option<String> {
    let has_some = !case.quiets.is_empty() || !case.free_fields.is_empty();
    let begins_dynamic = case.stages.first().is_some_and(|stage| stage.kind == case::StageKind::Dynamic);
    let has_weight = [case.gravity.x, case.gravity.y] != [0.0; 2] && case.in_situ.is_none();
    (has_some && begins_dynamic && has_weight).then(|| {
        "the first stage is dynamic, and quiet boundaries bear in it only what they bore before, which is nothing: \
         put a static stage before it, give in-situ stress, or let gravity be 0"
            .into()
    })
}

/// A base motion over edges that are held: they return the waves of sliding blocks.
pub(super) fn ringing(case: &Case) -> Option<String> {
    let is_quiet = !case.quiets.is_empty();
    let has_edges = case.fixes.iter().any(|fix| fix.edge.is_some());
    (!case.base_motions.is_empty() && has_edges && !is_quiet).then(|| {
        "a base motion acts over edges that `[[fix]]` holds: they return the waves that blocks send down, and blocks \
         that slide go up to 3 % too far; let the wave come up through a `[[quiet]]` edge instead"
            .into()
    })
}

/// Whether the columns are stable at the step of the model.
pub(super) fn check_columns(model: &Model) -> Result<(), Invalid> {
    for (k, column) in model.columns.iter().enumerate() {
        let most = column.critical_dt();
        if model.dt > most {
            return Err(Invalid {
                key: format!("free_field[{k}].edge"),
                message: format!(
                    "its column has cells of {:.6} m, which a wave crosses in {most:.3e} s, below the internal step of \
                     {:.3e} s: set solver.dt_max to {:.3e} or less",
                    column.spacing,
                    model.dt,
                    0.9 * most
                ),
            });
        }
    }
    Ok(())
}
