//! Which pictures a run draws.

use std::fmt;

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::keys::words;

words! {
    /// A picture, or a kind of picture drawn at the end of every stage.
    pub enum PictureKind {
        /// `model.png`: blocks, joints, supports, loads, water and bolts before the run.
        Model = "model",
        /// `deformed.png`: displacement at the end of the run.
        Deformed = "deformed",
        /// `history.png`: monitors, bolts and the motion of the base over the stages.
        History = "history",
        /// `energy.png`: energies over the stages.
        Energy = "energy",
        /// `stage1_displacement.png` and so on: displacement since the start of the stage.
        Displacement = "displacement",
        /// `stage1_joints.png`: joints that are open, slip or lock, and forces of bolts.
        Joints = "joints",
        /// `stage1_normal_stress.png` and `stage1_shear_stress.png`: stress on joints, averaged over their faces.
        JointStress = "joint_stress",
        /// `stage1_stress.png`: principal stresses.
        Stress = "stress",
        /// `stage1_velocity.png`: velocity.
        Velocity = "velocity",
        /// `covers.png`: physical covers of the stars of the mesh.
        Covers = "covers",
        /// `stage1_displacement_contours.png`: contours of the displacement since the start of the stage.
        DisplacementContours = "displacement_contours",
        /// `stage1_mean_stress_contours.png`: contours of the mean stress in the plane, smoothed within blocks.
        MeanStressContours = "mean_stress_contours",
        /// `stage1_strength.png`: share of strength of the worst section of each block, of rock that can break.
        Strength = "strength",
        /// `stage1_flow.png`: pressure head, flow and tables of the water that flows in joints, outcrops that seep, and
        /// drains.
        Flow = "flow",
        /// `stage1_lines.png`: displacement across and along lines at the ends of the stages so far.
        Lines = "lines",
        /// `record.png` and `spectra.png`, of cases with ground motions: acceleration of the records over time, and
        /// response spectra of records and monitors.
        Spectra = "spectra",
    }
}

/// Which pictures to draw: `true` for the usual ones, `false` for none, or a list of kinds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Pictures {
    /// The usual ones, or none.
    Usual(bool),
    /// These alone.
    These(Vec<PictureKind>),
}

/// Pictures of a run that names none.
const USUAL: [PictureKind; 10] = [
    PictureKind::Model,
    PictureKind::Deformed,
    PictureKind::History,
    PictureKind::DisplacementContours,
    PictureKind::Joints,
    PictureKind::MeanStressContours,
    PictureKind::Strength,
    PictureKind::Flow,
    PictureKind::Lines,
    PictureKind::Spectra,
];

impl Pictures {
    /// Whether a kind is to be drawn.
    pub fn include(&self, kind: PictureKind) -> bool {
        match self {
            Self::Usual(draw) => *draw && USUAL.contains(&kind),
            Self::These(kinds) => kinds.contains(&kind),
        }
    }
}

impl<'de> Deserialize<'de> for Pictures {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Pictures;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("true, false or a list of pictures such as [\"model\", \"displacement\"]")
            }

            fn visit_bool<E>(self, draw: bool) -> Result<Pictures, E> {
                Ok(Pictures::Usual(draw))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Pictures, A::Error> {
                let mut kinds = Vec::new();
                while let Some(kind) = list.next_element()? {
                    kinds.push(kind);
                }
                Ok(Pictures::These(kinds))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}
