//! The slope before it moves: a picture for the page and an icon.

use std::io;

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm_observe::{Boundary, Snapshot};
use enmm_picture::{model_annotations, model_picture};
use tiny_skia::{Color, FillRule, LineJoin, Paint, PathBuilder, Pixmap, Shader, Stroke, Transform};

/// Side of the icon (px).
const ICON: f64 = 512.0;
/// Free edge around the slope in the icon (px).
const EDGE: f64 = 16.0;
/// Colours of free blocks: red, green, blue.
const COLOURS: [[u8; 3]; 6] = [
    [0x9e, 0xc5, 0xe3],
    [0xf0, 0xcf, 0x9f],
    [0xb3, 0xd9, 0xa6],
    [0xe3, 0xb0, 0xb8],
    [0xc7, 0xb5, 0xe0],
    [0xe9, 0xdf, 0x9d],
];
/// Colour of held blocks.
const HELD: [u8; 3] = [0x8a, 0x92, 0x99];
/// Colour of the outlines.
const INK: [u8; 3] = [0x22, 0x30, 0x3c];

/// The slope as a PNG: blocks, joints by law, supports, monitors and ports.
pub fn slope(simulation: &Simulation) -> io::Result<Vec<u8>> {
    model_picture(&Snapshot::of(simulation), &model_annotations(simulation)).png()
}

/// The blocks alone, filled, on a clear square, as a PNG.
pub fn icon(simulation: &Simulation) -> io::Result<Vec<u8>> {
    let mut pixels =
        Pixmap::new(ICON as u32, ICON as u32).ok_or_else(|| io::Error::other("there is no room for the icon"))?;
    draw_blocks(&Snapshot::of(simulation).boundaries, &mut pixels);
    pixels.encode_png().map_err(io::Error::other)
}

fn draw_blocks(blocks: &[Boundary], pixels: &mut Pixmap) {
    let points = || blocks.iter().flat_map(|block| &block.loops.points);
    let range = |get: fn(&Point) -> f64| {
        let wider = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
        points().map(get).fold((f64::INFINITY, f64::NEG_INFINITY), wider)
    };
    let [(left, right), (low, high)] = [range(|p| p.x), range(|p| p.y)];
    let scale = (ICON - 2.0 * EDGE) / (right - left).max(high - low).max(f64::MIN_POSITIVE);
    let pixel = |p: &Point| {
        let from_middle = [p.x - 0.5 * (left + right), 0.5 * (low + high) - p.y];
        from_middle.map(|distance| (0.5 * ICON + scale * distance) as f32)
    };
    let width = if blocks.len() > 300 { 0.6 } else { 2.5 };
    let line = Stroke { width, line_join: LineJoin::Round, ..Stroke::default() };
    let paint = |[red, green, blue]: [u8; 3]| {
        let colour = Color::from_rgba8(red, green, blue, 255);
        Paint { shader: Shader::SolidColor(colour), ..Paint::default() }
    };
    for block in blocks {
        let mut pen = PathBuilder::new();
        for ring in (0..block.loops.len()).map(|k| block.loops.get(k)) {
            for (k, [x, y]) in ring.iter().map(pixel).enumerate() {
                if k == 0 { pen.move_to(x, y) } else { pen.line_to(x, y) }
            }
            pen.close();
        }
        let Some(outline) = pen.finish() else { continue };
        let colour = if block.fixed { HELD } else { COLOURS[block.block as usize % COLOURS.len()] };
        pixels.fill_path(&outline, &paint(colour), FillRule::EvenOdd, Transform::identity(), None);
        pixels.stroke_path(&outline, &paint(INK), &line, Transform::identity(), None);
    }
}
