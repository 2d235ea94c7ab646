//! Laws of one pipe: its conductance, its flow, the water in it.

/// Scale of the unknown of a node below 0 (m): at `-DELTA` the pipes that lead down from it are dry. Results do not
/// depend on it, since there is no pressure in films.
pub const DELTA: f64 = 1.0;

/// Drop (m) below which a pipe fills as a level one: a free surface would run along it at once.
pub const LEVEL: f64 = 1e-3;

/// Conductance (m²/s per m of head) of a joint between parallel faces whose aperture goes linearly from `e0` to `e1`
/// (m) over a `length` (m): the cubic law γ/(12 μ L) · 2 e0² e1²/(e0 + e1), exact for pipes in series.
///
/// `unit_weight` is that of water (N/m³), `viscosity` the dynamic one (Pa s). 0 where an aperture is 0.
pub fn conductance(e0: f64, e1: f64, length: f64, unit_weight: f64, viscosity: f64) -> f64 {
    if e0 <= 0.0 || e1 <= 0.0 {
        return 0.0;
    }
    let cube = 2.0 * (e0 * e0) * (e1 * e1) / (e0 + e1);
    unit_weight / (12.0 * viscosity * length) * cube
}

/// Pressure head (m) at a node with the unknown `u` (m).
pub fn pressure_head(u: f64) -> f64 {
    if u > 0.0 { u } else { 0.0 }
}

/// Share of its capacity with which a film leaves a node with the unknown `u` (m): 0 where it is dry, 1 where it is
/// wet.
pub fn filling(u: f64) -> f64 {
    (1.0 + u / DELTA).clamp(0.0, 1.0)
}

/// Share of the length of a pipe, from its lower end, that is below a free surface in still water: min(1, π/D) with
/// the pressure head `lower` (m) at that end and the drop `drop` (m) of the pipe; of a level pipe 1 where it is wet.
/// It is for pipes whose upper end has no pressure; others are wet over all their length.
pub fn wet_share(lower: f64, drop: f64) -> f64 {
    if lower <= 0.0 {
        0.0
    } else if lower >= drop {
        1.0
    } else {
        lower / drop
    }
}

/// Volume (m²) of a joint whose aperture goes linearly from `e0` to `e1` (m) over a `length` (m), with a `storage` (m)
/// of water that the rock beside it gives and takes per m² of joint.
pub fn volume(e0: f64, e1: f64, length: f64, storage: f64) -> f64 {
    length * (0.5 * (e0 + e1) + storage)
}

/// Water (m²) in a pipe with a `volume` (m²), a `compliance` (m² per m) and a `drop` (m), of the unknowns of its upper
/// and lower node (m): it is full below a free surface, and has the film of its upper node above. A pipe that drops by
/// less than [`LEVEL`] has half of its volume at each end, filled as films from there are.
pub fn stored(volume: f64, compliance: f64, drop: f64, [upper, lower]: [f64; 2]) -> f64 {
    let film = filling(upper);
    let share = if drop < LEVEL {
        0.5 * (film + filling(lower))
    } else {
        let full = wet_share(pressure_head(lower), drop);
        full * (1.0 - film) + film
    };
    volume * share + 0.5 * compliance * (pressure_head(upper) + pressure_head(lower))
}

/// Flow (m²/s) down a pipe with a `conductance` (m²/s per m) and a `drop` (m) from its upper node with the unknown
/// `upper` (m) to its lower one with `lower` (m); negative where it flows up.
///
/// Full, it is the conductance times the difference of heads. Where a free surface lies in it, all that falls to the
/// surface as a film goes on. Dry, a film falls with a unit gradient.
pub fn flow(conductance: f64, drop: f64, upper: f64, lower: f64) -> f64 {
    flow_of(conductance, drop, (pressure_head(upper), filling(upper)), pressure_head(lower))
}

/// Flow (m²/s) as [`flow`] gives it, of pressure head (m) and filling of the upper node and pressure head (m) of the
/// lower.
pub(crate) fn flow_of(conductance: f64, drop: f64, (pressure, filling): (f64, f64), lower: f64) -> f64 {
    conductance * (pressure + (filling * drop).min(drop - lower))
}
