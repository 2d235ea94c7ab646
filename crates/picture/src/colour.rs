//! Colours: categories for blocks, laws and covers, and a uniform scale for fields.

/// Red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Paper.
pub const WHITE: Colour = Colour(255, 255, 255);
/// Text and axes.
pub const INK: Colour = Colour(34, 38, 43);
/// Captions and notes.
pub const GREY: Colour = Colour(92, 99, 107);
/// Grid lines and frames.
pub const PALE: Colour = Colour(214, 218, 222);
/// Marks that must be found at once.
pub const ACCENT: Colour = Colour(190, 18, 90);

/// Parts of a chart that have no scale.
pub const BAND: Colour = Colour(243, 244, 246);

/// Water.
pub const WATER: Colour = Colour(0, 158, 224);
/// Water outside the rock.
pub const POND: Colour = Colour(214, 234, 246);
/// Rock behind other marks.
pub const ROCK: Colour = Colour(238, 233, 222);
/// Joints that lock; that slip (vermilion and blue of M. Okabe and K. Ito, told apart by all kinds of sight).
pub const LOCK: Colour = Colour(0, 90, 150);
/// Joints that slip, and tension.
pub const SLIP: Colour = Colour(213, 94, 0);

/// Rock bridges that hold (bluish green of Okabe and Ito).
pub const BRIDGE: Colour = Colour(0, 158, 115);
/// Broken rock bridges (yellow of Okabe and Ito), edged with ink.
pub const BROKEN: Colour = Colour(240, 228, 66);

/// Soft fills of blocks.
pub const BLOCKS: [Colour; 8] = [
    Colour(205, 224, 240),
    Colour(246, 224, 196),
    Colour(213, 232, 207),
    Colour(239, 212, 216),
    Colour(225, 216, 238),
    Colour(244, 238, 198),
    Colour(205, 234, 231),
    Colour(229, 220, 208),
];

/// Soft fills of rocks; neighbours in the list differ in grey too.
pub const ROCKS: [Colour; 8] = [
    Colour(240, 230, 208),
    Colour(180, 196, 206),
    Colour(224, 206, 178),
    Colour(168, 184, 160),
    Colour(236, 226, 238),
    Colour(192, 172, 160),
    Colour(214, 226, 206),
    Colour(166, 166, 184),
];

/// Dark lines: joint laws and series.
pub const LINES: [Colour; 8] = [
    Colour(31, 87, 160),
    Colour(196, 62, 28),
    Colour(27, 122, 75),
    Colour(122, 63, 157),
    Colour(166, 118, 0),
    Colour(0, 128, 148),
    Colour(176, 32, 96),
    Colour(90, 90, 90),
];

/// Stars with 1, 2, 3 and with 4 or more covers.
pub const COVERS: [Colour; 4] =
    [Colour(128, 136, 144), Colour(31, 119, 180), Colour(240, 135, 20), Colour(200, 24, 40)];

/// Number of steps of [`scale`] that differ.
pub const SCALE_STEPS: usize = 64;

/// Viridis at equal steps (S. van der Walt and N. Smith, matplotlib, CC0).
const VIRIDIS: [Colour; 17] = [
    Colour(68, 1, 84),
    Colour(72, 24, 106),
    Colour(71, 45, 123),
    Colour(66, 64, 134),
    Colour(59, 82, 139),
    Colour(51, 99, 141),
    Colour(44, 114, 142),
    Colour(38, 130, 142),
    Colour(33, 145, 140),
    Colour(31, 160, 136),
    Colour(40, 174, 128),
    Colour(63, 188, 115),
    Colour(94, 201, 98),
    Colour(132, 212, 75),
    Colour(173, 220, 48),
    Colour(216, 226, 25),
    Colour(253, 231, 37),
];

/// Part of white in the scale, so that dark lines stay visible on its dark end.
const LIGHTENING: f64 = 0.18;

/// The step of the scale for a fraction of its length.
pub fn scale_step(fraction: f64) -> usize {
    // A fraction that is no number falls on step 0.
    ((fraction * SCALE_STEPS as f64) as usize).min(SCALE_STEPS - 1)
}

/// Colour of a step of the scale.
pub fn scale(step: usize) -> Colour {
    let position = step as f64 / (SCALE_STEPS - 1) as f64 * (VIRIDIS.len() - 1) as f64;
    let below = (position as usize).min(VIRIDIS.len() - 2);
    mix(mix(VIRIDIS[below], VIRIDIS[below + 1], position - below as f64), WHITE, LIGHTENING)
}

/// `from` at 0, `to` at 1.
fn mix(from: Colour, to: Colour, fraction: f64) -> Colour {
    let channel = |from: u8, to: u8| (f64::from(from) + (f64::from(to) - f64::from(from)) * fraction).round() as u8;
    Colour(channel(from.0, to.0), channel(from.1, to.1), channel(from.2, to.2))
}
