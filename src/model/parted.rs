//! Joints that have parted in a dynamic stage, so that the water in them pushes no more.

use crate::flow::{FlowPiece, Wet, wet};
use crate::geometry::Point;
use crate::state::{Model, State};
use crate::step::Regime;

use super::Simulation;

/// Wet pieces of joint that have parted.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Parted {
    /// Their length (m), before they deform.
    pub length: f64,
    /// Their number.
    pub pieces: u32,
    /// The middle (m), before joints deform, of the one with the greatest pressure head.
    pub place: Option<Point>,
}

/// Whether the faces of a piece have parted, by the places of its blocks in a dynamic stage.
pub(super) fn has_parted(model: &Model, state: &State, piece: &FlowPiece) -> bool {
    let (boundary, stars) = (&model.boundary, &model.covers.star_position);
    let place = |point| boundary.sample(point, stars) + boundary.sample(point, &state.displacement);
    let ends = || piece.edges.map(|edge| [edge, boundary.after(edge)].map(place));
    let parting = model.flow.as_ref().and_then(|net| net.parting);
    parting.is_some_and(|parting| parting.has_come(piece.faces(ends())))
}

impl Simulation {
    /// Pieces of joint with the parts of them that are wet, and whether they have parted, so that their water pushes no
    /// more; none where no water flows. In static stages none has parted.
    pub fn wet_pieces(&self) -> impl Iterator<Item = (&FlowPiece, Wet, bool)> {
        let (model, state) = (self.model(), self.state());
        let is_dynamic = matches!(self.regime, Regime::Dynamic { .. });
        model.flow.iter().zip(&state.seepage).flat_map(move |(net, seepage)| {
            let open = net.pieces.iter().zip(&seepage.conducts).filter(|(_, conducts)| **conducts);
            open.filter_map(move |(piece, _)| {
                let unknowns = piece.nodes.map(|node| seepage.unknowns[node as usize]);
                let part = wet(unknowns, piece.nodes.map(|node| net.places[node as usize].y))?;
                Some((piece, part, is_dynamic && has_parted(model, state, piece)))
            })
        })
    }

    /// Wet joints whose faces have slipped or opened so far, in a dynamic stage, that their water pushes no more.
    pub fn parted(&self) -> Parted {
        let Some(net) = &self.model().flow else { return Parted::default() };
        let boundary = &self.model().boundary;
        let there = |piece: &FlowPiece| piece.edges.iter().all(|&edge| !self.state().removed[boundary.block[edge]]);
        let (mut parted, mut most) = (Parted::default(), f64::NEG_INFINITY);
        for (piece, part, _) in self.wet_pieces().filter(|(piece, _, has_parted)| *has_parted && there(piece)) {
            parted.length += piece.length;
            parted.pieces += 1;
            let head = part.heads[0].max(part.heads[1]);
            if head > most {
                let [a, b] = piece.nodes.map(|node| net.places[node as usize]);
                (most, parted.place) = (head, Some(a + (b - a) * 0.5));
            }
        }
        parted
    }

    /// A doubt about the dynamic stage in progress: joints have parted, and the water in them pushes no more.
    pub fn parted_joints(&self) -> Option<String> {
        let Parted { length, pieces, place } = self.parted();
        let (place, parting) = (place?, self.model().flow.as_ref()?.parting?);
        let joints = if pieces == 1 { "piece of joint has" } else { "pieces of joint have" };
        Some(format!(
            "{pieces} wet {joints} parted, {length:.4} m in all, the one with most pressure near ({:.6}, {:.6}) m: \
             where faces slip by more than {:.4} m (half of mesh.size) or open by more than {:.4} m (flow.part), their \
             water pushes no more; blocks that have come so far move by their weight alone",
            place.x, place.y, parting.slip, parting.opening
        ))
    }
}
