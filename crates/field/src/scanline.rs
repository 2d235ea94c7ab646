//! Weights by Terzaghi: a line meets the fewer joints of a set the more it runs along them (R. D. Terzaghi, Sources of
//! error in joint surveys, 1965).

use crate::axis::{Axis, cosine, line_of};

/// Least angle (degrees) between a line and a plane: below, weights stay those of this angle.
pub const BLIND_DEG: f64 = 15.0;

/// A line along which joints were measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Scanline {
    /// Name in the column `traverse` of the table; none for all rows.
    pub name: Option<String>,
    /// Its direction.
    axis: Axis,
}

impl Scanline {
    /// Reads a line, such as `120/5` or `T1=120/5`: trend and plunge (degrees).
    ///
    /// # Errors
    /// The form of a line, where the text has another one.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (name, line) = text.rsplit_once('=').map_or((None, text), |(name, line)| (Some(name), line));
        let parts = line.split_once('/').and_then(|(trend, plunge)| Some((trend.parse().ok()?, plunge.parse().ok()?)));
        match parts {
            Some((trend, plunge)) if (-360.0..=360.0).contains(&trend) && (-90.0..=90.0).contains(&plunge) => {
                let name = name.map(|name| name.trim().to_owned());
                Ok(Self { name, axis: line_of(plunge, trend) })
            }
            _ => Err(format!(
                "{text:?} is no line: write its trend of -360 to 360 and its plunge of -90 to 90 (degrees), such as \
                 120/5, or T1=120/5 for rows whose column `traverse` has T1"
            )),
        }
    }

    /// Weight of a pole, 1/|cos δ| for an angle δ to the line, and whether the plane is nearer to the line than
    /// [`BLIND_DEG`], where the weight stays 1/sin 15° = 3.86.
    pub fn weight(&self, pole: &Axis) -> (f64, bool) {
        let across = cosine(pole, &self.axis).abs();
        let least = libm::sin(BLIND_DEG.to_radians());
        (1.0 / across.max(least), across < least)
    }

    /// Distance normal to planes of this mean pole of a distance along the line.
    pub fn across(&self, pole: &Axis) -> f64 {
        cosine(pole, &self.axis).abs()
    }
}
