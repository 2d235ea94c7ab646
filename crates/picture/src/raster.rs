//! The marks of a sheet as pixels.

use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Mask, Paint, PathBuilder, Pattern, Pixmap, PixmapPaint, Shader,
    SpreadMode, Stroke, StrokeDash, Transform,
};

use super::colour::{Colour, WHITE};
use super::font;
use super::sheet::{Anchor, Mark, Path, PathStep, Pixel, Rect, Style, TextStyle};

/// Width (px) of the white rim of a text; half of it lies outside the letters.
const HALO: f32 = 4.0;
/// Distance and width (px) of the slanting lines across a shape.
const HATCH: [f32; 2] = [9.0, 1.4];
/// Lengths (px) of the pieces and of the gaps of a broken line.
const DASHES: [f32; 2] = [9.0, 6.0];

/// The picture of the given width and height (px) on white; none if it is too large.
pub fn pixels([width, height]: [f64; 2], marks: &[Mark]) -> Option<Pixmap> {
    let mut pixels = Pixmap::new(width as u32, height as u32)?;
    pixels.fill(Color::WHITE);
    draw(&mut pixels, marks)?;
    Some(pixels)
}

fn draw(pixels: &mut Pixmap, marks: &[Mark]) -> Option<()> {
    for mark in marks {
        match mark {
            Mark::Rect(area, style) => draw_shape(pixels, rectangle(area), *style),
            Mark::Circle([x, y], radius, style) => {
                draw_shape(pixels, PathBuilder::from_circle(rounded(*x), rounded(*y), *radius as f32), *style);
            }
            Mark::Path(path, style) => draw_shape(pixels, outline(path), *style),
            Mark::Hatched(path, colour) => draw_hatched(pixels, outline(path), *colour)?,
            Mark::Text(at, text, style) => draw_text(pixels, *at, text, *style),
            Mark::Clipped(area, inside) => draw_clipped(pixels, area, inside)?,
        }
    }
    Some(())
}

fn draw_shape(pixels: &mut Pixmap, path: Option<tiny_skia::Path>, style: Style) {
    let Some(path) = path else { return };
    let paint = |colour| paint(colour, style.opacity.unwrap_or(1.0), !style.crisp);
    // A line has no area.
    if let Some(colour) = style.fill.filter(|_| path.bounds().width() > 0.0 && path.bounds().height() > 0.0) {
        pixels.fill_path(&path, &paint(colour), FillRule::Winding, Transform::identity(), None);
    }
    if let Some((colour, width)) = style.stroke {
        let dash = if style.dashed { StrokeDash::new(DASHES.to_vec(), 0.0) } else { None };
        pixels.stroke_path(&path, &paint(colour), &pen(width as f32, dash), Transform::identity(), None);
    }
}

/// Fills a shape with slanting lines, two neighbours of which a tile of pixels holds.
fn draw_hatched(pixels: &mut Pixmap, path: Option<tiny_skia::Path>, colour: Colour) -> Option<()> {
    let Some(path) = path else { return Some(()) };
    let [distance, width] = HATCH;
    let mut tile = Pixmap::new(distance as u32, distance as u32)?;
    let line = tiny_skia::Rect::from_xywh(0.0, 0.0, width, distance)?;
    let ink = paint(colour, 1.0, true);
    tile.fill_path(&PathBuilder::from_rect(line), &ink, FillRule::Winding, Transform::identity(), None);
    let slant = Transform::from_rotate(45.0);
    let shader = Pattern::new(tile.as_ref(), SpreadMode::Repeat, FilterQuality::Bicubic, 1.0, slant);
    let lines = Paint { shader, ..Paint::default() };
    pixels.fill_path(&path, &lines, FillRule::EvenOdd, Transform::identity(), None);
    Some(())
}

fn draw_text(pixels: &mut Pixmap, [x, y]: Pixel, text: &str, style: TextStyle) {
    let line = font::line(text);
    let scale = style.size as f32 / font::UNITS;
    let start = match style.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * line.width,
        Anchor::End => -line.width,
    };
    let turn = Transform::from_rotate(if style.upward { -90.0 } else { 0.0 });
    let place = Transform::from_translate(rounded(x), rounded(y))
        .pre_concat(turn)
        .pre_scale(scale, -scale)
        .pre_translate(start, 0.0);
    let Some(letters) = line.outline.finish().and_then(|outline| outline.transform(place)) else { return };
    if style.halo {
        let white = paint(WHITE, 1.0, true);
        pixels.stroke_path(&letters, &white, &pen(HALO, None), Transform::identity(), None);
    }
    let ink = paint(style.colour, 1.0, true);
    pixels.fill_path(&letters, &ink, FillRule::Winding, Transform::identity(), None);
}

/// Draws on a clear sheet, and of that sheet only the part inside `area`.
fn draw_clipped(pixels: &mut Pixmap, area: &Rect, inside: &[Mark]) -> Option<()> {
    let mut sheet = Pixmap::new(pixels.width(), pixels.height())?;
    draw(&mut sheet, inside)?;
    let mut mask = Mask::new(pixels.width(), pixels.height())?;
    if let Some(area) = rectangle(area) {
        mask.fill_path(&area, FillRule::Winding, true, Transform::identity());
    }
    sheet.apply_mask(&mask);
    pixels.draw_pixmap(0, 0, sheet.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
    Some(())
}

fn paint(colour: Colour, opacity: f64, smooth: bool) -> Paint<'static> {
    let Colour(red, green, blue) = colour;
    let solid = Color::from_rgba8(red, green, blue, (255.0 * opacity).round() as u8);
    Paint { shader: Shader::SolidColor(solid), anti_alias: smooth, ..Paint::default() }
}

fn pen(width: f32, dash: Option<StrokeDash>) -> Stroke {
    Stroke { width, dash, line_cap: LineCap::Butt, line_join: LineJoin::Round, ..Stroke::default() }
}

/// None without an area.
fn rectangle(area: &Rect) -> Option<tiny_skia::Path> {
    let Rect { left, top, width, height } = *area;
    let [left, top, width, height] = [left, top, width, height].map(rounded);
    let has_area = width > 0.0 && height > 0.0;
    tiny_skia::Rect::from_xywh(left, top, width, height).filter(|_| has_area).map(PathBuilder::from_rect)
}

fn outline(path: &Path) -> Option<tiny_skia::Path> {
    let mut pen = PathBuilder::new();
    let pixel = |at: &[i32; 2]| at.map(|hundredths| (f64::from(hundredths) / 100.0) as f32);
    for step in path.steps() {
        match step {
            PathStep::Move(at) => {
                let [x, y] = pixel(at);
                pen.move_to(x, y);
            }
            PathStep::Line(at) => {
                let [x, y] = pixel(at);
                pen.line_to(x, y);
            }
            PathStep::Close => pen.close(),
        }
    }
    pen.finish()
}

/// A coordinate or a length (px) to hundredths, as SVG text has it.
fn rounded(value: f64) -> f32 {
    ((100.0 * value).round() / 100.0) as f32
}
