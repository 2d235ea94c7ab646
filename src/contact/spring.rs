//! Springs of a contact in an explicit step: a normal or shear spring, and its linear response to a velocity (Eq. 14).

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

/// A normal or shear spring with its velocity and time constants in a step.
#[doc(alias = "penalty")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Stiffness (N/m per metre).
    pub stiffness: f64,
    /// Inverse effective mass of the contact (m/kg).
    pub compliance: f64,
    /// Predicted relative velocity without contact forces (m/s).
    pub approach: f64,
    /// Forward weight of the motion in the step: θ, or that of a joint's own spring.
    pub forward: f64,
    /// Motion (m) that is added: minus a share of that of the last step.
    pub lag: f64,
    /// Time (s) for which positions move.
    pub dt: f64,
    /// Time (s) for which forces act.
    pub kick: f64,
}

impl Spring {
    /// Centres a stiffness that is a property of the joint (Eqs. 52, 53).
    ///
    /// The force belongs to the time at which it acts, so that a spring that the step resolves keeps its energy; a
    /// stiffer one gets a dashpot that grows towards that of θ. The motion in the last step was `last` (m), and
    /// `damping` is 2ξ·√M of the two blocks against each other (kg½/m½): it damps their bouncing.
    #[must_use]
    pub fn centred(self, last: f64, damping: f64) -> Self {
        let stiff = self.stiffness * self.compliance * self.dt * self.kick;
        let dashpot = if stiff > 1.0 { self.forward * (1.0 - 1.0 / stiff) } else { 0.0 };
        let forward = CENTRED + dashpot + damping / (self.stiffness.sqrt() * self.dt);
        Self { forward, lag: -CENTRED * last, ..self }
    }

    /// Response of a linear spring with the force `stored` (N/m) at the start of the step.
    #[inline(always)]
    pub fn linear(&self, stored: f64) -> SoftSpring {
        let a = self.stiffness * self.forward * self.dt;
        let aw = a * self.compliance * self.kick;
        SoftSpring { rest: stored - self.stiffness * self.lag - a * self.approach, rate: a, kept: aw }
    }

    /// Response of a curved spring with the closure `closure` (m) at the start of the step.
    #[inline(always)]
    pub fn curved(&self, closure: f64) -> SoftSpring {
        let reach = self.forward * self.dt;
        let rest = closure - self.lag - reach * self.approach;
        SoftSpring { rest, rate: reach, kept: reach * self.compliance * self.kick }
    }
}
