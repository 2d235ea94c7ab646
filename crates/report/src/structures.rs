//! Bolts, supports and water of a frame as bytes. `format.md` has the layout.

use crate::data::{BoltFrame, Structures, SupportFrame};
use crate::error::{FilmError, finite};
use crate::number::{Width, push_planes};

/// Bits of the sign of a support: held along x, along y, part of a boundary that lets waves out.
const SUPPORT: [u8; 3] = [1, 2, 4];

/// Appends what acts on the rock at a time (s), places as seen from an origin (m); the supports when they are `wanted`.
///
/// # Errors
/// The first number that is not finite.
pub fn push_structures(
    structures: &Structures,
    time: f64,
    origin: [f64; 2],
    wanted: bool,
    bytes: &mut Vec<u8>,
) -> Result<(), FilmError> {
    push_bolts(structures.bolts, time, bytes)?;
    if wanted {
        push_supports(structures.supports, time, origin, bytes)?;
    }
    finite(structures.water_weight, time, || "the weight of the water".to_owned())?;
    bytes.extend(structures.water_weight.to_le_bytes());
    bytes.extend((structures.water_surface.len() as u32).to_le_bytes());
    push_places(structures.water_surface, Width::Full, "point of the water table", time, origin, bytes)
}

fn push_supports(supports: &[SupportFrame], time: f64, origin: [f64; 2], bytes: &mut Vec<u8>) -> Result<(), FilmError> {
    bytes.extend((supports.len() as u32).to_le_bytes());
    let sign = |support: &SupportFrame| {
        let bits = [support.axes[0], support.axes[1], support.absorbs].into_iter().zip(SUPPORT);
        bits.map(|(is, bit)| if is { bit } else { 0 }).sum::<u8>()
    };
    bytes.extend(supports.iter().map(sign));
    let places: Vec<[f64; 2]> = supports.iter().map(|support| support.place).collect();
    push_places(&places, Width::Short, "support", time, origin, bytes)
}

fn push_bolts(bolts: &[BoltFrame], time: f64, bytes: &mut Vec<u8>) -> Result<(), FilmError> {
    bytes.extend(bolts.iter().map(|bolt| bolt.condition));
    type Getter = fn(&BoltFrame) -> f64;
    let quantities: [(Width, Getter); 5] = [
        (Width::Full, |bolt| bolt.displacement[0][0]),
        (Width::Full, |bolt| bolt.displacement[0][1]),
        (Width::Full, |bolt| bolt.displacement[1][0]),
        (Width::Full, |bolt| bolt.displacement[1][1]),
        (Width::Short, |bolt| bolt.force),
    ];
    for (width, get) in quantities {
        let number = |(k, bolt)| finite(get(bolt), time, || format!("displacement or force of bolt {k}"));
        let numbers: Vec<f32> = bolts.iter().enumerate().map(number).collect::<Result<_, _>>()?;
        push_planes(&numbers, width, bytes);
    }
    Ok(())
}

fn push_places(
    places: &[[f64; 2]],
    width: Width,
    what: &str,
    time: f64,
    origin: [f64; 2],
    bytes: &mut Vec<u8>,
) -> Result<(), FilmError> {
    for axis in [0, 1] {
        let number = |(k, place): (usize, &[f64; 2])| {
            finite(place[axis] - origin[axis], time, || format!("place of {what} {k}"))
        };
        let numbers: Vec<f32> = places.iter().enumerate().map(number).collect::<Result<_, _>>()?;
        push_planes(&numbers, width, bytes);
    }
    Ok(())
}
