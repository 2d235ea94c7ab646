//! The marks of a sheet as SVG text.

use std::fmt::{self, Write as _};

use super::colour::{Colour, WHITE};
use super::sheet::{Anchor, Mark, Path, PathStep, Pixel, Rect, Style, TextStyle};

/// The whole picture of the given width and height (px).
pub fn svg_text([width, height]: [f64; 2], marks: &[Mark]) -> String {
    let mut writer = Writer::default();
    writer.marks(marks);
    let mut svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"");
    let _ = writeln!(svg, " viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Verdana, sans-serif\">");
    let paper = format!("<rect width=\"{width}\" height=\"{height}\"{}/>", Style::fill(WHITE));
    let Writer { definitions, body, .. } = writer;
    let _ = write!(svg, "<defs>\n{definitions}</defs>\n{paper}\n{body}</svg>\n");
    svg
}

/// Both parts of the text. Writing to a string cannot fail.
#[derive(Debug, Default)]
struct Writer {
    definitions: String,
    body: String,
    ids: usize,
}

impl Writer {
    fn marks(&mut self, marks: &[Mark]) {
        for mark in marks {
            match mark {
                Mark::Rect(Rect { left, top, width, height }, style) => {
                    let _ = write!(self.body, "<rect x=\"{left:.2}\" y=\"{top:.2}\"");
                    let _ = writeln!(self.body, " width=\"{width:.2}\" height=\"{height:.2}\"{style}/>");
                }
                Mark::Circle([x, y], radius, style) => {
                    let _ = writeln!(self.body, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\"{style}/>");
                }
                Mark::Path(path, style) => {
                    let _ = writeln!(self.body, "<path d=\"{path}\"{style}/>");
                }
                Mark::Hatched(path, colour) => self.hatched(path, *colour),
                Mark::Text(at, text, style) => self.text(*at, text, *style),
                Mark::Clipped(area, inside) => self.clipped(area, inside),
            }
        }
    }

    fn hatched(&mut self, path: &Path, colour: Colour) {
        let id = self.next_id();
        let _ = write!(self.definitions, "<pattern id=\"id{id}\" width=\"9\" height=\"9\"");
        let _ = write!(self.definitions, " patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">");
        let _ = writeln!(self.definitions, "<rect width=\"1.4\" height=\"9\" fill=\"{colour}\"/></pattern>");
        let _ = writeln!(self.body, "<path d=\"{path}\" fill=\"url(#id{id})\" fill-rule=\"evenodd\"/>");
    }

    fn text(&mut self, [x, y]: Pixel, text: &str, style: TextStyle) {
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let halo = if style.halo {
            " stroke=\"#ffffff\" stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\""
        } else {
            ""
        };
        let turn = if style.upward { format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"") } else { String::new() };
        let (size, colour) = (style.size, style.colour);
        let _ = write!(self.body, "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\"");
        let _ = write!(self.body, " fill=\"{colour}\"{halo}{turn}>");
        self.body.push_str(&quick_xml::escape::partial_escape(text));
        self.body.push_str("</text>\n");
    }

    fn clipped(&mut self, area: &Rect, inside: &[Mark]) {
        let Rect { left, top, width, height } = area;
        let id = self.next_id();
        let _ = write!(self.definitions, "<clipPath id=\"id{id}\"><rect x=\"{left:.2}\" y=\"{top:.2}\"");
        let _ = writeln!(self.definitions, " width=\"{width:.2}\" height=\"{height:.2}\"/></clipPath>");
        let _ = writeln!(self.body, "<g clip-path=\"url(#id{id})\">");
        self.marks(inside);
        self.body.push_str("</g>\n");
    }

    fn next_id(&mut self) -> usize {
        self.ids += 1;
        self.ids
    }
}

impl fmt::Display for Style {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self.fill {
            Some(colour) => write!(out, " fill=\"{colour}\"")?,
            None => out.write_str(" fill=\"none\"")?,
        }
        if let Some((colour, width)) = self.stroke {
            write!(out, " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"")?;
        }
        if let Some(opacity) = self.opacity {
            write!(out, " opacity=\"{opacity}\"")?;
        }
        if self.dashed {
            out.write_str(" stroke-dasharray=\"9 6\"")?;
        }
        if self.crisp {
            out.write_str(" shape-rendering=\"crispEdges\"")?;
        }
        Ok(())
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

impl fmt::Display for Path {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        for step in self.steps() {
            let (letter, [x, y]) = match step {
                PathStep::Move(at) => ('M', at),
                PathStep::Line(at) => ('L', at),
                PathStep::Close => {
                    out.write_char('Z')?;
                    continue;
                }
            };
            write!(out, "{letter}{} {}", Hundredths(*x), Hundredths(*y))?;
        }
        Ok(())
    }
}

/// A coordinate in hundredths of a pixel.
struct Hundredths(i32);

impl fmt::Display for Hundredths {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match (self.0 / 100, self.0 % 100) {
            (whole, 0) => write!(out, "{whole}"),
            (whole, part) => {
                let sign = if self.0 < 0 { "-" } else { "" };
                write!(out, "{sign}{}.{:02}", whole.abs(), part.abs())
            }
        }
    }
}
