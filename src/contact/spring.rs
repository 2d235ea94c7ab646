//! Springs of a contact in an explicit step: a normal or shear spring, and its linear response to a velocity (Eq. 14).

use enmm_lanes::{Arithmetic, Values};

/// β of the centred spring of a joint's own stiffness: the least that is stable at any step.
const CENTRED: f64 = 0.25;

/// Implicit response of a spring: `rest` − `rate`·v + `kept`·(its force so far), where v is the velocity by all
/// impulses so far. For a linear spring this is the force times 1 + `kept`; for a curved one it is the closure (m) that
/// determines the force.
#[doc(alias = "soft constraint")]
#[doc(alias = "penalty")]
#[derive(Debug, Clone, Copy, Default)]
pub struct SoftSpring<T = f64> {
    /// Force (N/m), or closure (m).
    pub rest: T,
    /// The same per velocity (N·s/m², or s).
    pub rate: T,
    /// The same per force (1, or m²/N).
    pub kept: T,
}

/// Normal or shear springs with their velocities and time constants in a step: one, or one of each lane.
#[doc(alias = "penalty")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring<T = f64> {
    /// Stiffness (N/m per metre).
    pub stiffness: T,
    /// Inverse effective mass of the contact (m/kg).
    pub compliance: T,
    /// Predicted relative velocity without contact forces (m/s).
    pub approach: T,
    /// Forward weight of the motion in the step: θ, or that of a joint's own spring.
    pub forward: T,
    /// Motion (m) that is added: minus a share of that of the last step.
    pub lag: T,
    /// Time (s) for which positions move.
    pub dt: T,
    /// Time (s) for which forces act.
    pub kick: T,
}

impl<T: Arithmetic> Spring<T> {
    /// Centres a stiffness that is a property of the joint (Eqs. 52, 53).
    ///
    /// The force belongs to the time at which it acts, so that a spring that the step resolves keeps its energy; a
    /// stiffer one gets a dashpot that grows towards that of θ. The motion in the last step was `last` (m), and
    /// `damping` is 2ξ·√M of the two blocks against each other (kg½/m½): it damps their bouncing.
    #[inline(always)]
    #[must_use]
    pub fn centred<L: Values<F = T>>(self, lanes: L, last: T, damping: T) -> Self {
        let (centred, one) = (lanes.splat(CENTRED), lanes.splat(1.0));
        let stiff = self.stiffness * self.compliance * self.dt * self.kick;
        let dashpot = lanes.keep_above(self.forward * (one - one / stiff), stiff, one);
        let forward = centred + dashpot + damping / (lanes.sqrt(self.stiffness) * self.dt);
        Self { forward, lag: -(centred * last), ..self }
    }

    /// Response with the force `stored` (N/m) at the start of the step; of a curved spring with the closure (m), whose
    /// `stiffness` is then 1.
    #[inline(always)]
    pub fn response(&self, stored: T) -> SoftSpring<T> {
        let a = self.stiffness * self.forward * self.dt;
        let aw = a * self.compliance * self.kick;
        SoftSpring { rest: stored - self.stiffness * self.lag - a * self.approach, rate: a, kept: aw }
    }
}
