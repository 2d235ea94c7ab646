//! Dilation: how high its asperities lift a joint that slips, and the work that takes (Eq. 21).

use super::JointLaw;

/// Load on a contact that is lifted. The force is that of the end of the step. A spring that opens in the step held
/// more before, and the step has lost that energy: lifting as far again takes the work of the force alone.
#[derive(Debug, Clone, Copy)]
pub struct LiftLoad {
    /// Normal force (N/m).
    pub normal: f64,
    /// Normal spring (N/m per metre).
    pub spring: f64,
    /// How far (m) the step opens the contact while it stays closed.
    pub opened: f64,
}

/// Lift of a joint by a slip.
#[derive(Debug, Clone, Copy)]
pub struct Lifted {
    /// Way (m) up or down the asperities after it.
    pub way: f64,
    /// Opening (m).
    pub raised: f64,
    /// Work (J/m) that the opening takes from friction.
    pub work: f64,
}

impl JointLaw {
    /// How a joint that slips by `slip` (m) climbs its asperities, from a way (m) up or down along them: no higher than
    /// the heat of friction (J/m) can lift it.
    #[inline(always)]
    pub fn dilate(&self, way: f64, slip: f64, heat: f64, load: &LiftLoad) -> Lifted {
        let after = (way + slip).clamp(-self.dilation_slip, self.dilation_slip);
        if self.dilation == 0.0 {
            return Lifted { way: after, raised: 0.0, work: 0.0 };
        }
        let rise = |after: f64| (after.abs() - way.abs()) * self.dilation;
        let highest = load.highest(heat);
        let share = if rise(after) > highest { highest / rise(after) } else { 1.0 };
        let way_after = way + (after - way) * share;
        let raised = rise(way_after);
        Lifted { way: way_after, raised, work: load.work(raised) }
    }
}

impl LiftLoad {
    /// How high (m) the heat of friction (J/m) can lift it.
    #[inline(always)]
    fn highest(&self, heat: f64) -> f64 {
        let Self { normal, spring, opened } = *self;
        if heat < normal * opened {
            return heat / normal;
        }
        let twice = 2.0 * heat + spring * opened * opened;
        let root = (normal * normal + spring * twice).sqrt();
        if twice > 0.0 { twice / (normal + root) } else { 0.0 }
    }

    /// Work (J/m) of lifting it by `raised` (m). One that comes down gives no more than its spring holds.
    #[inline(always)]
    fn work(&self, raised: f64) -> f64 {
        let Self { normal, spring, opened } = *self;
        if raised > 0.0 {
            return raised * normal + 0.5 * spring * (raised * raised - opened * opened).max(0.0);
        }
        let raised = raised.max(-normal / spring);
        raised * (normal + 0.5 * spring * raised)
    }
}
