//! The slope before it moves: a picture for the page and an icon.

use std::fmt::Write as _;
use std::io;

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::snapshot::Boundary;
use enmm_picture::{model_annotations, model_picture};
use resvg::{tiny_skia, usvg};

/// Side of the icon (px).
const ICON: f64 = 512.0;
/// Free edge around the slope in the icon (px).
const EDGE: f64 = 16.0;
/// Colours of free blocks.
const COLOURS: [&str; 6] = ["#9ec5e3", "#f0cf9f", "#b3d9a6", "#e3b0b8", "#c7b5e0", "#e9df9d"];
/// Colour of held blocks.
const HELD: &str = "#8a9299";

/// The slope as a PNG: blocks, joints by law, supports, monitors and ports.
pub fn slope(simulation: &Simulation) -> io::Result<Vec<u8>> {
    model_picture(&simulation.snapshot(), &model_annotations(simulation)).png()
}

/// The blocks alone, filled, on a clear square, as a PNG.
pub fn icon(simulation: &Simulation) -> io::Result<Vec<u8>> {
    let svg = icon_svg(&simulation.snapshot().boundaries);
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).map_err(io::Error::other)?;
    let mut pixels = tiny_skia::Pixmap::new(ICON as u32, ICON as u32)
        .ok_or_else(|| io::Error::other("there is no room for the icon"))?;
    resvg::render(&tree, tiny_skia::Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(io::Error::other)
}

fn icon_svg(blocks: &[Boundary]) -> String {
    let points = || blocks.iter().flat_map(|block| &block.loops.points);
    let range = |get: fn(&Point) -> f64| {
        let wider = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
        points().map(get).fold((f64::INFINITY, f64::NEG_INFINITY), wider)
    };
    let [(left, right), (low, high)] = [range(|p| p.x), range(|p| p.y)];
    let scale = (ICON - 2.0 * EDGE) / (right - left).max(high - low).max(f64::MIN_POSITIVE);
    let pixel = |p: &Point| {
        let from_middle = [p.x - 0.5 * (left + right), 0.5 * (low + high) - p.y];
        from_middle.map(|distance| 0.5 * ICON + scale * distance)
    };
    let width = if blocks.len() > 300 { 0.6 } else { 2.5 };
    let mut svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{ICON}\" height=\"{ICON}\">");
    for block in blocks {
        let colour = if block.fixed { HELD } else { COLOURS[block.block as usize % COLOURS.len()] };
        let mut path = String::new();
        for ring in (0..block.loops.len()).map(|k| block.loops.get(k)) {
            for (k, [x, y]) in ring.iter().map(pixel).enumerate() {
                // A write into a string does not fail.
                let _ = write!(path, "{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
            }
            path.push('Z');
        }
        let look = "fill-rule=\"evenodd\" stroke=\"#22303c\" stroke-linejoin=\"round\"";
        let _ = write!(svg, "<path d=\"{path}\" fill=\"{colour}\" stroke-width=\"{width}\" {look}/>");
    }
    svg + "</svg>"
}
