//! The fractured slope that both methods solve, and what it does.

use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::model::tables::BlockId;

use crate::Trouble;

/// A slope of 100 m under two sets of joints at a spacing (m); it settles under a friction of 50°; under 45°
/// one of 3.2 m does not.
pub fn slope_text(spacing: f64, seconds: f64) -> String {
    let set = |dip: f64, seed: u32, ratio: f64| {
        format!(
            "[[joint_set]]\nangle_deg = {dip:?}\nangle_sd_deg = 1.0\nspacing = {:e}\nspacing_sd = {:e}\nseed = {seed}\n\
             region = [[58, 18], [122, 122], [200, 122]]\n",
            spacing * ratio,
            0.16 * spacing
        )
    };
    let failure = format!(
        "[[stage]]\nname = \"failure\"\nkind = \"dynamic\"\nduration = {seconds:e}\ndamping = 0.1\n[[stage.law]]\n\
         law = \"joint\"\nfriction_deg = 28.0\n"
    );
    format!(
        "title = \"Fractured slope\"\n[domain]\n\
         outline = [[0, 0], [230, 0], [230, 120], [120, 120], [60, 20], [0, 20]]\nextend_ends = 0\n\
         [mesh]\nleast_block = 0\nsize = {:e}\n\
         angle_deg = 7.0\n{}{}[rock.gneiss]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 50\n[[fix]]\nedge = [[0, 0], [230, 0]]\n[[fix]]\nedge = [[0, 0], [0, 20]]\n\
         axes = \"x\"\n[[fix]]\nedge = [[230, 0], [230, 120]]\naxes = \"x\"\n[[stage]]\nname = \"gravity\"\n\
         kind = \"static\"\nduration = 12.0\n{}",
        0.65 * spacing,
        set(36.0, 11, 1.0),
        set(118.0, 12, 1.06),
        if seconds > 0.0 { failure } else { String::new() },
    )
}

/// Motion of a slope since it began to fail. Single blocks go their own ways; these sums hardly depend on them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// Potential energy set free (J/m).
    pub released: f64,
    /// Kinetic energy (J/m).
    pub kinetic: f64,
    /// Heat of slip (J/m).
    pub friction: f64,
    /// Mean displacement of all rock (m).
    pub displacement: f64,
}

impl Totals {
    /// Names with units, in the order of [`Totals::values`].
    pub const NAMES: [(&str, &str); 4] = [
        ("potential energy released", "J/m"),
        ("kinetic energy", "J/m"),
        ("heat of slip", "J/m"),
        ("mean displacement of all rock", "m"),
    ];

    /// The totals in the order of their names.
    pub fn values(&self) -> [f64; 4] {
        [self.released, self.kinetic, self.friction, self.displacement]
    }

    fn now(simulation: &Simulation, places: &[Vector]) -> Self {
        let ledger = simulation.energies();
        let moved = block_displacements(simulation);
        let mass = &simulation.model().mass_matrix.total;
        let way: f64 = moved.iter().zip(places).zip(mass).map(|((now, then), mass)| mass * (now - then).norm()).sum();
        Self {
            released: -ledger.potential,
            kinetic: ledger.kinetic,
            friction: ledger.friction,
            displacement: way / mass.iter().sum::<f64>(),
        }
    }

    /// These beside those of the start, and `share` of the way to `next`.
    fn since(&self, start: &Self, next: &Self, share: f64) -> Self {
        let between = |of: fn(&Self) -> f64| of(self) + share * (of(next) - of(self)) - of(start);
        Self {
            released: between(|t| t.released),
            kinetic: between(|t| t.kinetic),
            friction: between(|t| t.friction),
            displacement: between(|t| t.displacement),
        }
    }
}

/// Begins the failure of a slope at rest; its totals after exactly so many seconds, between the two steps about them.
pub(crate) fn fail(simulation: &mut Simulation, seconds: f64) -> Result<Totals, Trouble> {
    let places = block_displacements(simulation);
    let first = Totals::now(simulation, &places);
    simulation.next_stage()?;
    let steps = seconds / simulation.model().dt;
    for _ in 0..steps as u64 {
        simulation.advance(false)?;
    }
    let before = Totals::now(simulation, &places);
    simulation.advance(false)?;
    Ok(before.since(&first, &Totals::now(simulation, &places), steps.fract()))
}

/// Mean displacement of every block (m).
pub(crate) fn block_displacements(simulation: &Simulation) -> Vec<Vector> {
    let slope = simulation.model();
    let of = |b: BlockId| {
        let covers = slope.covers.covers_of(b);
        let sum: Vector = covers.map(|i| simulation.state().displacement[i] * slope.mass_matrix.row_sum[i]).sum();
        sum / slope.mass_matrix.total[b]
    };
    slope.covers.blocks().map(of).collect()
}

/// Root mean square of the difference of two displacement fields over that of the second.
pub(crate) fn difference(a: &[Vector], b: &[Vector]) -> f64 {
    let square = |v: f64| v.max(f64::MIN_POSITIVE);
    let apart: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum();
    (apart / square(b.iter().map(Vector::norm_squared).sum())).sqrt()
}
