//! Pictures of the model, of the deformed slope and of histories, as PNG and as SVG.
//!
//! Knows snapshots and series only. The same input gives the same bytes on every machine: the font is embedded, and no
//! font of the system is looked at. Coordinates that are not finite are left out.
#![forbid(unsafe_code)]

mod annotations;
mod axes;
mod bar;
mod chart;
mod colour;
mod contours;
mod covers;
mod displacement;
#[cfg(feature = "searches")]
mod field;
mod flow;
mod font;
mod histogram;
mod history;
mod legend;
mod lines;
mod model;
mod raster;
#[cfg(feature = "searches")]
mod reduction;
mod sheet;
mod signs;
mod slope;
mod stage;
mod stage_axis;
#[cfg(feature = "searches")]
mod stereonet;
mod strength;
mod svg;
#[cfg(feature = "searches")]
mod sweep;

use std::io;
use std::path::Path;

use enmm_io::files::{at_path, write_atomic};

pub use annotations::{bolt_marks, counted, model_annotations, stars};
pub use axes::{number_text, si_text, three_digits};
pub use chart::{Chart, ChartSeries, chart_picture};
pub use contours::{displacement_contours, mean_stress_contours};
pub use covers::covers_picture;
pub use displacement::displacement_picture;
#[cfg(feature = "searches")]
pub use field::{FieldNet, FieldSet};
pub use flow::flow_picture;
pub use histogram::{Fit, histogram_picture};
pub use history::{Series, history_picture};
pub use lines::{LineProfile, ProfileCurve, lines_picture};
pub use model::{BoltMark, HeldRow, LoadMark, ModelAnnotations, PortMark, PortPlace, SetMark, model_picture};
#[cfg(feature = "searches")]
pub use reduction::{failure_picture, trials_picture};
pub use signs::Held;
pub use stage::{
    StageEnd, joint_stress_pictures, joints_picture, stage_displacement_picture, stress_picture, velocity_picture,
};
pub use stage_axis::StageStart;
#[cfg(feature = "searches")]
pub use stereonet::{Projection, Stereonet};
pub use strength::strength_picture;
#[cfg(feature = "searches")]
pub use sweep::{Bars, Curve, Grid, bars_picture, curve_picture, grid_picture};

/// A finished picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height (px).
    size: [f64; 2],
    marks: Vec<sheet::Mark>,
}

impl Picture {
    /// The picture as SVG text.
    pub fn svg(&self) -> String {
        svg::svg_text(self.size, &self.marks)
    }

    /// The picture as the bytes of a PNG file, one pixel per SVG unit.
    ///
    /// # Errors
    /// `Other` if the picture is too large.
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let pixels = raster::pixels(self.size, &self.marks);
        let pixels = pixels.ok_or_else(|| io::Error::other("the picture is too large to rasterise"))?;
        pixels.encode_png().map_err(io::Error::other)
    }

    /// Writes the picture into a directory, as PNG and as SVG of a name without ending.
    ///
    /// # Errors
    /// As [`Picture::write_png`].
    pub fn write(&self, directory: &Path, name: &str) -> io::Result<()> {
        write_atomic(&directory.join(format!("{name}.svg")), self.svg().as_bytes())?;
        self.write_png(&directory.join(format!("{name}.png")))
    }

    /// Writes the picture as PNG to `path`, whole or not at all.
    ///
    /// # Errors
    /// As [`Picture::png`], and whatever the file system refuses; the path is in the message.
    pub fn write_png(&self, path: &Path) -> io::Result<()> {
        let png = self.png().map_err(at_path(path))?;
        write_atomic(path, &png)
    }
}
