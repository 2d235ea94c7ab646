//! Dilation: how high its asperities lift a joint that slips, and the work that takes (Eq. 21).

use super::JointLaw;

/// A contact at the end of a step that it slipped in.
#[derive(Debug, Clone, Copy)]
pub struct LiftLoad {
    /// Normal force (N/m).
    pub normal: f64,
    /// Normal spring (N/m per metre).
    pub spring: f64,
    /// Closure (m) at the start of the step, and at its end without lift.
    pub closed: [f64; 2],
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
    /// How far (m) a slip (m) lifts the joint from a way (m) up or down its asperities; negative on the way down.
    #[inline(always)]
    pub fn rise(&self, way: f64, slip: f64) -> f64 {
        (self.way_after(way, slip).abs() - way.abs()) * self.dilation
    }

    #[inline(always)]
    fn way_after(&self, way: f64, slip: f64) -> f64 {
        (way + slip).clamp(-self.dilation_slip, self.dilation_slip)
    }

    /// How a joint that slips by `slip` (m) climbs its asperities from a way (m) up or down along them: no higher than
    /// the heat of friction (J/m) and what the spring gave up in the step can lift it.
    #[inline(always)]
    pub fn dilate(&self, way: f64, slip: f64, heat: f64, load: &LiftLoad) -> Lifted {
        let after = self.way_after(way, slip);
        if self.dilation == 0.0 {
            return Lifted { way: after, raised: 0.0, work: 0.0 };
        }
        let rise = self.rise(way, slip);
        if rise <= 0.0 {
            return Lifted { way: after, raised: rise, work: load.returned(rise) };
        }
        let raised = rise.min(load.highest(heat));
        Lifted { way: way + (after - way) * (raised / rise), raised, work: (load.normal * raised).min(heat) }
    }
}

impl LiftLoad {
    /// How high (m) it can be lifted: its spring then stores no more than at the start of the step, and what the blocks
    /// and the heat of friction (J/m) put in.
    #[inline(always)]
    fn highest(&self, heat: f64) -> f64 {
        let [before, after] = self.closed;
        let put_in = heat + self.normal * (after - before);
        let square = before.max(0.0).powi(2) + 2.0 * put_in / self.spring;
        (square.max(0.0).sqrt() - after).max(0.0)
    }

    /// Work (J/m) of lowering it by −`raised` (m), which is negative: no more comes back than its spring holds.
    #[inline(always)]
    fn returned(&self, raised: f64) -> f64 {
        let raised = raised.max(-self.normal / self.spring);
        raised * (self.normal + 0.5 * self.spring * raised)
    }
}
