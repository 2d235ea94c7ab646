//! The unit of the coordinates of a file that is no drawing: by its coordinate reference system, by the heads of its
//! columns, or by a key.

use super::epsg::{CrsUnit, unit};
use crate::case_error::CaseError;

/// Metres in an international foot and in that of US surveys.
const FOOT: f64 = 0.3048;
const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// The unit of a file: metres in it, and how a message speaks of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Metres in a unit, by which coordinates are taken times.
    pub metres: f64,
    /// The unit in the file and the factor it gets: `millimetres ($INSUNITS is 4), taken times 0.001`.
    pub text: String,
    /// A note where that is not sure or contradicted.
    pub note: Option<String>,
}

/// The unit by the head of a file.
#[derive(Debug, Clone, Default)]
pub struct Declared {
    /// The text: `EPSG:2227`, `urn:ogc:def:crs:OGC:1.3:CRS84`, `mm`.
    pub text: String,
    /// Its key in the file, perhaps empty.
    pub key: String,
    /// Its line in the file.
    pub line: usize,
}

enum Meaning {
    Metres,
    Length(f64, &'static str),
    Degrees,
    /// A unit that is not read.
    Other,
    Unknown,
}

/// Names of units, with the metres in each and how messages name it.
const NAMES: [(&[&str], f64, &str); 7] = [
    (&["m", "metre", "metres", "meter", "meters"], 1.0, "metres"),
    (&["mm", "millimetre", "millimetres", "millimeter", "millimeters"], 1e-3, "millimetres"),
    (&["cm", "centimetre", "centimetres", "centimeter", "centimeters"], 1e-2, "centimetres"),
    (&["km", "kilometre", "kilometres", "kilometer", "kilometers"], 1e3, "kilometres"),
    (&["ft", "foot", "feet", "'"], FOOT, "feet"),
    (&["in", "inch", "inches", "\""], 0.0254, "inches"),
    (&["ftus", "us-ft", "usft", "us survey feet", "us survey foot"], SURVEY_FOOT, "US survey feet"),
];
const DEGREES: [&str; 5] = ["deg", "degree", "degrees", "°", "decimal degrees"];

/// Whether a text in brackets behind a name is a unit.
pub fn is_unit(text: &str) -> bool {
    !matches!(meaning(text), Meaning::Unknown)
}

fn meaning(text: &str) -> Meaning {
    let small = text.trim().to_lowercase();
    if let Some((_, metres, name)) = NAMES.iter().find(|(names, ..)| names.contains(&small.as_str())) {
        return if *metres == 1.0 { Meaning::Metres } else { Meaning::Length(*metres, name) };
    }
    if DEGREES.contains(&small.as_str()) || small.contains("crs84") || ["wgs84", "wgs 84"].contains(&small.as_str()) {
        return Meaning::Degrees;
    }
    // `EPSG:2227`, `urn:ogc:def:crs:EPSG::2227`, `http://www.opengis.net/def/crs/EPSG/0/2227`.
    let digits = small.rsplit(|c: char| !c.is_ascii_digit()).next().unwrap_or_default();
    let Some(code) = digits.parse().ok().filter(|_| small.contains("epsg")) else { return Meaning::Unknown };
    match unit(code) {
        CrsUnit::Metres => Meaning::Metres,
        CrsUnit::Degrees => Meaning::Degrees,
        CrsUnit::Feet => Meaning::Length(FOOT, "feet"),
        CrsUnit::SurveyFeet => Meaning::Length(SURVEY_FOOT, "US survey feet"),
        CrsUnit::Other => Meaning::Other,
    }
}

impl Unit {
    /// The unit of a file that says nothing of it, or what it declares; `scale` is that of the case.
    ///
    /// # Errors
    /// The coordinates are degrees, or in a unit that is not read.
    pub fn of(declared: Option<&Declared>, scale: Option<f64>, file: &str) -> Result<Self, CaseError> {
        let times = |metres: f64| scale.map_or(format!("times {metres}"), |s| format!("times {s} (`transform.scale`)"));
        let plain = |name: &str| match scale {
            Some(_) => format!("{name}, taken {}", times(1.0)),
            None => name.to_owned(),
        };
        let Some(Declared { text, key, line }) = declared else {
            return Ok(Self { metres: 1.0, text: plain("metres"), note: None });
        };
        let fail = |message: String| Err(CaseError::at(file, *line, key, message));
        match meaning(text) {
            Meaning::Metres => Ok(Self { metres: 1.0, text: plain(&format!("metres ({text})")), note: None }),
            Meaning::Length(metres, name) => {
                let note = scale.filter(|scale| (scale - metres).abs() > 1e-9 * metres).map(|scale| {
                    format!(
                        "{text:?} is in {name}, but coordinates are taken times {scale} (`transform.scale`), not \
                         {metres}"
                    )
                });
                Ok(Self { metres, text: format!("{name} ({text}), taken {}", times(metres)), note })
            }
            Meaning::Degrees => fail(format!(
                "is {text:?}, whose coordinates are degrees, and a section is in metres; project the lines to metres \
                 (as by `ogr2ogr -t_srs`), or remove what says so where they are metres"
            )),
            Meaning::Other if scale.is_none() => {
                fail(format!("is {text:?}, whose unit is neither metres nor feet; give `transform.scale`, its metres"))
            }
            Meaning::Other | Meaning::Unknown => {
                Ok(Self { metres: 1.0, text: plain(&format!("metres as far as is known ({text})")), note: None })
            }
        }
    }
}
