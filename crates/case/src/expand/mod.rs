//! Expansion of the words of the field in a case into the plain data that the engine builds: dips become angles,
//! bolt patterns and skins bolts, construction joints joints with a law, K0 a stress, records accelerations of the base
//! and velocities of waves, and shifted surfaces of water are where they are. This is the only place that does so.

mod bolts;
mod cells;
mod cuts;
mod in_situ;
mod joint_sets;
pub mod motions;
mod skins;
mod tessellation;
mod weakness;

pub use cuts::LAW as CUT_LAW;

use crate::keys::Plain;
use std::collections::BTreeMap;

use super::key::{Check, Invalid, Key, fail};
use super::plausible;
use super::{Case, InSitu, JointSet, StageKind};

/// Notes of an expansion, and where its results come from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Expanded {
    /// Old names that the case uses.
    pub notes: Vec<String>,
    /// Keys that the user wrote, by those that came of them: `bolt_pattern[0]` by `bolt[3]`.
    pub origins: BTreeMap<String, String>,
}

impl Case {
    /// Turns what is written for short into plain data; what is plain already stays as it is, to the bit.
    ///
    /// # Errors
    /// The first value from which nothing can be made, or keys that contradict each other.
    pub fn expand(&mut self) -> Result<Expanded, Invalid> {
        let mut told = Expanded::default();
        self.expand_durations(&Key::root().field("stage"), &mut told)?;
        joint_sets::expand(self, &mut told)?;
        tessellation::expand(self, &mut told)?;
        cuts::expand(self, &mut told)?;
        weakness::expand(self)?;
        in_situ::expand(self)?;
        bolts::expand(self, &mut told)?;
        skins::expand(self, &mut told)?;
        motions::expand(self)?;
        self.shift_water()?;
        Ok(told)
    }

    /// Warnings about values that are unusual, and about bolts whose heads lie where nobody drew them.
    pub fn doubts(&self) -> Vec<String> {
        plausible::doubts(self).into_iter().chain(bolts::far_heads(self)).collect()
    }

    /// `duration_max` becomes the duration of a static stage.
    fn expand_durations(&mut self, key: &Key, told: &mut Expanded) -> Check {
        for (k, stage) in self.stages.iter_mut().enumerate() {
            let Some(most) = stage.duration_max else { continue };
            let (old, key) = (key.index(k).field("duration"), key.index(k).field("duration_max"));
            if stage.kind == StageKind::Dynamic {
                let message =
                    format!("is {} s, but a dynamic stage takes its whole `duration`; rename it", Plain(most));
                return fail(&key, message);
            }
            if stage.duration != 0.0 {
                let message =
                    format!("is {} s, and `duration` is {} s; keep one of them", Plain(most), Plain(stage.duration));
                return fail(&key, message);
            }
            told.origins.insert(old.to_string(), key.to_string());
            (stage.duration, stage.duration_max) = (most, None);
        }
        Ok(())
    }

    /// Refuses what is written for short and has not been expanded.
    pub(crate) fn must_be_expanded(&self) -> Check {
        let unfinished = |set: &JointSet| {
            let plain = set.angle_deg.is_some() && set.dip_deg.is_none() && set.dips.is_none();
            !plain || set.dip_direction_deg.is_some() || set.persistence.is_some() || set.angle_sd_deg.is_some()
        };
        let stress = |s: &InSitu| s.k0.is_some() || s.sxx.is_none() || s.syy.is_none() || s.y_reference.is_none();
        let short = [
            ("stage", self.stages.iter().any(|stage| stage.duration_max.is_some())),
            ("rock", self.rocks.values().any(|rock| rock.plane_of_weakness.as_ref().is_some_and(weakness::is_short))),
            ("joint_set", self.joint_sets.iter().any(unfinished)),
            ("tessellation", !self.tessellations.is_empty()),
            ("cut", !self.cuts.is_empty()),
            ("in_situ", self.in_situ.as_ref().is_some_and(stress)),
            ("bolt_pattern", !self.bolt_patterns.is_empty()),
            ("skin", !self.skins.is_empty()),
            ("base_motion", self.base_motions.iter().any(motions::is_short_base)),
            ("quiet", self.quiets.iter().any(motions::is_short_wave)),
            ("water", self.water.as_ref().is_some_and(|water| water.shift.is_some())),
        ];
        short.iter().find(|(_, is)| *is).map_or(Ok(()), |(name, _)| {
            let message = "is not expanded; load the case through `enmm_io`, or call `Case::expand`";
            fail(&Key::root().field(name), message)
        })
    }
}
