//! Supports at one instant.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::tables::Resistance;

/// Kind of a support.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SupportKind {
    /// Part of a fixity.
    #[default]
    Fixity,
    /// Spring of a quiet boundary or of a side along a free field.
    Spring,
    /// Dashpot of a quiet boundary or of a side along a free field.
    Dashpot,
}

/// A supported material point now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SupportPoint {
    /// Where (m).
    pub position: Point,
    /// Force (N/m) on the rock.
    pub reaction: Vector,
    /// Kind of support.
    pub kind: SupportKind,
    /// Index of the fixity of the case, or of the boundary behind them: quiet boundaries first, then free-field sides.
    pub index: u32,
    /// Which axes are held.
    pub axes: [bool; 2],
}

/// All supports that hold, those of one point together.
pub fn supports(simulation: &Simulation) -> Vec<SupportPoint> {
    let (model, state) = (simulation.model(), simulation.state());
    let stars = &model.covers.star_position;
    let mut points: Vec<SupportPoint> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for (k, support) in model.supports.iter().enumerate() {
        if !state.fix_active[support.fix as usize] || state.removed[support.block] {
            continue;
        }
        let key = (support.fix, support.covers, support.weights.map(f64::to_bits));
        let place = *places.entry(key).or_insert_with(|| {
            let sample = |field: &[Vector]| -> Vector {
                support.covers.iter().zip(support.weights).map(|(&i, w)| field[i] * w).sum()
            };
            let quiet = model.quiets.iter().position(|q| [q.springs, q.dashpots].contains(&support.fix));
            let kind = match support.resistance {
                _ if quiet.is_none() => SupportKind::Fixity,
                Resistance::Spring => SupportKind::Spring,
                Resistance::Dashpot(_) => SupportKind::Dashpot,
            };
            points.push(SupportPoint {
                position: sample(stars) + sample(&state.displacement),
                kind,
                index: quiet.map_or(support.fix, |k| k as u32),
                ..SupportPoint::default()
            });
            points.len() - 1
        });
        points[place].reaction += support.direction * state.support_force[k];
        let along = support.direction.abs();
        points[place].axes[usize::from(along.y > along.x)] = true;
    }
    points
}
