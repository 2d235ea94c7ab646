//! Pressure of water that flows in joints: on both faces of each wet piece, and of the reservoir where it fills what
//! has been dug out.

use crate::contact::EdgeId;
use crate::flow::{FlowNet, FlowPiece, Parting, Wet, wet};
use crate::geometry::{Point, Vector};
use crate::mechanics::{Forces, pressure};
use crate::state::{Seepage, Water};

use super::faces::Faces;

/// Water in joints while a sub-step acts.
pub(super) struct JointWater<'a> {
    pub net: &'a FlowNet,
    pub seepage: &'a Seepage,
    /// The reservoir and its level (m), if there is one.
    pub reservoir: Option<(&'a Water, f64)>,
    /// Unit weight of the water (N/m³), as far as it acts.
    pub weight: f64,
    /// Motion from which pieces push no more; none in static stages.
    pub parting: Option<Parting>,
}

impl JointWater<'_> {
    /// Pushes the faces of all pieces that bound water.
    pub fn push(&self, faces: &Faces, force: &mut (impl Forces + ?Sized)) {
        for (piece, conducts) in self.net.pieces.iter().zip(&self.seepage.conducts) {
            match piece.edges.map(|edge| faces.is_gone(edge)) {
                [false, false] if *conducts => self.push_piece(faces, piece, force),
                [true, false] => self.push_bare(faces, piece, 1, force),
                [false, true] => self.push_bare(faces, piece, 0, force),
                _ => {}
            }
        }
    }

    /// Pushes both faces of a piece as far as it is wet (Eq. 99), unless they have parted.
    fn push_piece(&self, faces: &Faces, piece: &FlowPiece, force: &mut (impl Forces + ?Sized)) {
        let unknowns = piece.nodes.map(|node| self.seepage.unknowns[node as usize]);
        let heights = piece.nodes.map(|node| self.net.places[node as usize].y);
        let Some(wet) = wet(unknowns, heights) else { return };
        let ends = piece.edges.map(|edge| faces.ends(edge));
        if self.parting.is_some_and(|parting| parting.has_come(piece.faces(ends))) {
            return;
        }
        for side in [0, 1] {
            self.push_part(faces, (piece.edges[side], ends[side]), piece.spans[side], wet, force);
        }
    }

    /// Pushes a face that bounds a block which has been dug out, where the reservoir stands.
    fn push_bare(&self, faces: &Faces, piece: &FlowPiece, side: usize, force: &mut (impl Forces + ?Sized)) {
        let Some((water, level)) = self.reservoir else { return };
        if !self.seepage.flooded[faces.block(piece.edges[1 - side]).index()] {
            return;
        }
        let (edge, span) = (piece.edges[side], piece.spans[side]);
        let ends @ [a, b] = faces.ends(edge);
        let surface = &water.surfaces[faces.state.stage as usize];
        let depth = span.map(|share| surface.depth(level, a + (b - a) * share));
        let crossing = depth[0] / (depth[0] - depth[1]);
        let part = match depth.map(|d| d > 0.0) {
            [false, false] => return,
            [true, true] => Wet { span: [0.0, 1.0], heads: depth },
            [true, false] => Wet { span: [0.0, crossing], heads: [depth[0], 0.0] },
            [false, true] => Wet { span: [crossing, 1.0], heads: [0.0, depth[1]] },
        };
        self.push_part(faces, (edge, ends), span, part, force);
    }

    /// Pushes the wet part of a piece that covers a span, which may run back, of an edge with these ends (m).
    fn push_part(
        &self,
        faces: &Faces,
        (edge, [a, b]): (EdgeId, [Point; 2]),
        span: [f64; 2],
        wet: Wet,
        force: &mut (impl Forces + ?Sized),
    ) {
        let share = wet.span.map(|share| span[0] + (span[1] - span[0]) * share);
        let pressures = wet.heads.map(|head| self.weight * head);
        let inward = pressure::inward(a, b);
        let forces: [Vector; 2] = if share[0] <= share[1] {
            pressure::part(inward, share, pressures)
        } else {
            pressure::part(inward, [share[1], share[0]], [pressures[1], pressures[0]])
        };
        faces.spread(edge, faces.porous_sliver(edge), forces, force);
    }
}
