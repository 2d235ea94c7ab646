//! In what setting a trial is made: the geometry that joints feel, and the corners that hold.

use enmm::model::Simulation;
use enmm::model::tables::{BlockId, SideId};

/// The geometry in which a slope is to rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Geometry {
    /// As it is drawn: displacements change forces, but not the contacts (Eq. 62a). Beyond its limit it starts to move.
    #[default]
    Drawn,
    /// As its blocks come to lie. Beyond its limit the slope is lost.
    Real,
}

impl Geometry {
    /// `drawn` or `real`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "drawn",
            Self::Real => "real",
        }
    }
}

/// The setting of a trial.
#[derive(Debug, Clone, Default)]
pub struct Setting {
    /// Geometry in which the slope is to rest.
    pub geometry: Geometry,
    /// Contacts that carry nothing: nodes of a block with a side.
    pub left_out: Vec<(BlockId, SideId)>,
}

impl Setting {
    /// Puts a model into the setting, for as long as its stage lasts.
    pub fn act(&self, simulation: &mut Simulation) {
        if !self.left_out.is_empty() {
            simulation.leave_out(self.left_out.clone());
        }
        if self.geometry == Geometry::Drawn {
            simulation.assume_small_displacements();
        }
    }
}
