//! Water of a case.

use crate::key::{Check, Key};
use crate::keys::shared::{HEIGHT, PLACE};
use crate::keys::unit::DENSITY;
use crate::keys::{Range, Rule, keys};
use crate::{Case, PointList};

/// Heights of a level surface.
const LEVEL: Rule = HEIGHT.hint("the height y of the water surface");

keys! {
    /// Water with a level or a sloping surface: hydrostatic pressure on the faces that it reaches, at their current
    /// places.
    pub default struct Water {
        /// Height y of the surface at the start (m); hosts may move it. This or `table`.
        pub level: Option<f64> => LEVEL.label("Level"),
        /// Surface as points (m) from left to right, level beyond both ends; hosts shift it by what they move the
        /// level, which starts as the height of its highest point.
        pub table: Option<PointList> => PLACE,
        /// Height (m) by which all surfaces are higher than they are written or drawn, those of stages too, lower where
        /// it is negative; a `[[head]]` stays where it is. For `enmm sweep`; default: 0.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub shift: Option<f64> => HEIGHT.hint("0 leaves the surfaces where they are drawn"),
        /// Density (kg/m³).
        pub density: f64 = 1000.0 =>
            Range::above(0.0).to(1e5).of(DENSITY).usual([800.0, 1500.0], "water has 1000 kg/m³").label("Density"),
        /// Whether joints below the level are full: pressure on both of their faces.
        pub joints: bool = true,
        /// Whether rock below the level that yields with friction has pore pressure, so that its effective stress
        /// decides.
        pub rock: bool = true,
        /// Segments (m) of the outer boundary that the water reaches; default: all that no `[[fix]]` edge holds.
        pub faces: Option<Vec<[[f64; 2]; 2]>> => PLACE,
    }
}

keys! {
    /// A surface of the water that a stage brings.
    pub default struct WaterSurface {
        /// Height y of the surface (m). This or `table`.
        pub level: Option<f64> => LEVEL,
        /// Surface as points (m) from left to right, level beyond both ends.
        pub table: Option<PointList> => PLACE,
    }
}

impl Case {
    /// Moves all surfaces of the water to where `shift` has them.
    ///
    /// # Errors
    /// A shift that is out of its range.
    pub(crate) fn shift_water(&mut self) -> Check {
        let Some(water) = self.water.as_mut().filter(|water| water.shift.is_some()) else { return Ok(()) };
        water.check(&Key::root().field("water"))?;
        let shift = water.shift.take().unwrap_or_default();
        let own = self.water.iter_mut().map(|water| (&mut water.level, &mut water.table));
        let of_stages = self.stages.iter_mut().filter_map(|stage| stage.water.as_mut());
        for (level, table) in own.chain(of_stages.map(|surface| (&mut surface.level, &mut surface.table))) {
            level.iter_mut().for_each(|level| *level += shift);
            table.iter_mut().flatten().for_each(|point| point[1] += shift);
        }
        Ok(())
    }
}

impl WaterSurface {
    /// Height of its highest point (m).
    pub fn highest(&self) -> f64 {
        let highest = || self.table.iter().flatten().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
        self.level.unwrap_or_else(highest)
    }
}

impl Water {
    /// Water without a surface yet, all else as a case has it that names nothing.
    pub fn still() -> Self {
        Self::default()
    }

    /// The surface at the start.
    pub fn surface(&self) -> WaterSurface {
        WaterSurface { level: self.level, table: self.table.clone() }
    }

    /// Height of the surface at the start (m): `level`, or the highest point of `table`.
    pub fn start_level(&self) -> f64 {
        self.surface().highest()
    }
}
