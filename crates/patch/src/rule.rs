//! Constants of the geometry of contact by faces.

/// Constants of contact by faces: lengths in metres, directions as cosines.
///
/// The engine will take lengths as parts of its mesh size and angles from its own rule of detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Depth down to which cells reach: deeper, the pressure does not grow.
    pub reach: f64,
    /// Height of a ledge up to which the faces of two bodies are level, and gap up to which one covers the other.
    pub ledge: f64,
    /// Distance from a corner within which a body that comes in through a face may be pressed out of it.
    pub beside: f64,
    /// Cosine of the angle up to which two faces lie along each other.
    pub flush: f64,
    /// Cosine of the angle up to which a face goes on level beyond a corner.
    pub level: f64,
    /// Sines of the angles between which a level corner stops to act.
    pub fade: [f64; 2],
    /// Share of a view in which the body with the lower number is the one that is viewed.
    pub view: f64,
    /// Length (m) for which a corner counts, of which the stiffness is that of the faces; 0 for no corner springs.
    pub corner: f64,
    /// Turn (as a sine) from which a point of an outline is a corner.
    pub corner_turn: f64,
}

impl Default for Rule {
    fn default() -> Self {
        Self {
            reach: 0.1,
            ledge: 1e-3,
            beside: 0.1,
            flush: 0.985,
            level: 0.966,
            fade: [0.09, 0.34],
            view: 0.5,
            corner: 0.25,
            corner_turn: 0.05,
        }
    }
}
