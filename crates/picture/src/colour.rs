//! Colours: categories for blocks, laws and covers, and a uniform scale for fields.

/// Red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Colours by their hexadecimal numbers.
const fn colours<const N: usize>(numbers: [u32; N]) -> [Colour; N] {
    let mut colours = [WHITE; N];
    let mut k = 0;
    while k < N {
        let [_, red, green, blue] = numbers[k].to_be_bytes();
        colours[k] = Colour(red, green, blue);
        k += 1;
    }
    colours
}

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
pub const BLOCKS: [Colour; 8] =
    colours([0xcde0f0, 0xf6e0c4, 0xd5e8cf, 0xefd4d8, 0xe1d8ee, 0xf4eec6, 0xcdeae7, 0xe5dcd0]);

/// Soft fills of rocks; neighbours in the list differ in grey too.
pub const ROCKS: [Colour; 8] =
    colours([0xf0e6d0, 0xb4c4ce, 0xe0ceb2, 0xa8b8a0, 0xece2ee, 0xc0aca0, 0xd6e2ce, 0xa6a6b8]);

/// Dark lines: joint laws and series.
pub const LINES: [Colour; 8] =
    colours([0x1f57a0, 0xc43e1c, 0x1b7a4b, 0x7a3f9d, 0xa67600, 0x008094, 0xb02060, 0x5a5a5a]);

/// Stars with 1, 2, 3 and with 4 or more covers.
pub const COVERS: [Colour; 4] =
    [Colour(128, 136, 144), Colour(31, 119, 180), Colour(240, 135, 20), Colour(200, 24, 40)];

/// Number of steps of [`scale`] that differ.
pub const SCALE_STEPS: usize = 64;

/// Viridis at equal steps (S. van der Walt and N. Smith, matplotlib, CC0).
const VIRIDIS: [Colour; 17] = colours([
    0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c, 0x1fa088, 0x28ae80,
    0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725,
]);

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
