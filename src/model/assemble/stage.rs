//! The parts of a build, reported as they begin.

/// A part of a build.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuildStage {
    /// Reading loops and generating joint sets.
    Joints,
    /// Cutting outlines, joints and mesh by each other.
    Arrangement,
    /// Elements, physical covers and blocks.
    Covers,
    /// Rocks, masses, supports.
    Masses,
    /// Boundary of the blocks, loads and ports.
    Boundary,
    /// State at the start.
    Start,
}

impl BuildStage {
    /// Name, as a user reads it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Joints => "joints",
            Self::Arrangement => "arrangement",
            Self::Covers => "elements and covers",
            Self::Masses => "masses and supports",
            Self::Boundary => "boundary and loads",
            Self::Start => "state at the start",
        }
    }

    /// Share of the time of a build, about, that is over when this part begins.
    pub fn share(self) -> f64 {
        match self {
            Self::Joints => 0.0,
            Self::Arrangement => 0.01,
            Self::Covers => 0.35,
            Self::Masses => 0.95,
            Self::Boundary => 0.96,
            Self::Start => 0.98,
        }
    }
}
