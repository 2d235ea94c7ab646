//! Tables of measurements, such as DIPS and FracMan write: CSV with commas, semicolons or tabs, lines that begin with
//! `#` or `*` left out, and a line of heads in any letter case, perhaps with a unit (`Dip [deg]`):
//!
//! - `dip` and `dip direction` (or `dipdir`, `dip azimuth`, `azimuth`), or `strike` (dip to its right), or `trend` and
//!   `plunge` of the pole;
//! - `set`, `quantity` (how many such joints the row stands for), `traverse` and `distance` along it (m), if there are
//!   any.
//!
//! Lines before the heads are passed over, as those of a DIPS file; other columns are not used.

use std::collections::BTreeSet;

use crate::axis::{Axis, line_of, plane_of, pole_of};
use crate::error::FieldError;
use crate::scanline::Scanline;

/// Names of columns, without spaces and underscores.
const DIP: &[&str] = &["dip", "dipangle", "dipamount", "dipdeg", "inclination"];
const DIRECTION: &[&str] =
    &["dipdirection", "dipdir", "dipazimuth", "direction", "azimuth", "dipdirectiondeg", "dipdirdeg", "ddr"];
const STRIKE: &[&str] = &["strike", "strikeright", "strikerhr", "strikedeg"];
const TREND: &[&str] = &["trend", "poletrend", "trenddeg"];
const PLUNGE: &[&str] = &["plunge", "poleplunge", "plungedeg"];
const QUANTITY: &[&str] = &["quantity", "count", "weight"];
const SET: &[&str] = &["set", "setname", "setid", "jointset"];
const TRAVERSE: &[&str] = &["traverse", "traverseid", "scanline", "borehole", "hole"];
const DISTANCE: &[&str] = &["distance", "depth", "position", "chainage"];
/// Lines that are looked at for the heads.
const HEADS_WITHIN: usize = 200;
/// Columns of the heads that a message names.
const NAMED: usize = 20;

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// Line of the file, from 1.
    pub line: usize,
    /// Pole of the plane, downwards.
    pub pole: Axis,
    /// Number of joints that it stands for.
    pub quantity: f64,
    /// Set that the table names.
    pub set: Option<String>,
    /// Line along which it was measured.
    pub traverse: Option<String>,
    /// Distance along it (m).
    pub distance: Option<f64>,
}

impl Measurement {
    /// Dip and dip direction (degrees).
    pub fn plane(&self) -> [f64; 2] {
        plane_of(&self.pole)
    }
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    file: String,
    /// All rows.
    pub rows: Vec<Measurement>,
    /// Remarks: columns that are not used, lines before the heads.
    pub notes: Vec<String>,
}

/// Columns by their places.
#[derive(Debug, Clone, Copy)]
struct Columns {
    /// Two that give the plane, and how.
    plane: (usize, usize, Form),
    quantity: Option<usize>,
    set: Option<usize>,
    traverse: Option<usize>,
    distance: Option<usize>,
}

/// How two columns give a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    DipDirection,
    DipStrike,
    PlungeTrend,
}

impl Form {
    /// Names of both columns in messages.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::DipDirection => ["dip", "dip direction"],
            Self::DipStrike => ["dip", "strike"],
            Self::PlungeTrend => ["plunge of the pole", "trend of the pole"],
        }
    }
}

impl Table {
    /// Reads a table; `file` is its name in messages.
    ///
    /// # Errors
    /// There are no heads of ours or no rows; or the first row that cannot be used, with its line.
    pub fn parse(file: &str, text: &str) -> Result<Self, FieldError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let (head, columns, mark) = heads(file, text)?;
        let mut notes = Vec::new();
        if head > 1 {
            notes.push(format!("{} lines before the heads of the columns are passed over", head - 1));
        }
        let mut rows = Vec::new();
        let mut unused = Vec::new();
        for (k, line) in text.lines().enumerate().skip(head - 1) {
            let cells = cells(line, mark);
            let at = |message: String| FieldError::Line { file: file.to_owned(), line: k + 1, message };
            if k + 1 == head {
                unused = columns.unused(&cells);
            } else if !is_remark(line) && cells.iter().any(|cell| !cell.is_empty()) {
                rows.push(columns.row(k + 1, &cells, mark).map_err(at)?);
            }
        }
        if rows.is_empty() {
            let message = format!("{file}: has no row below the heads of line {head}; write a measurement a line");
            return Err(FieldError::Whole(message));
        }
        if !unused.is_empty() {
            notes.push(format!("columns not used: {}", unused.join(", ")));
        }
        Ok(Self { file: file.to_owned(), rows, notes })
    }

    /// Poles with their weights, by lines along which they were measured, and the number of poles in the blind zone.
    ///
    /// # Errors
    /// A row is on a line that is not given, or a line is given that no row is on.
    pub fn weighted(&self, lines: &[Scanline]) -> Result<(Vec<(Axis, f64)>, usize), FieldError> {
        let is_twice = |(k, line): &(usize, &Scanline)| lines[..*k].iter().any(|other| other.name == line.name);
        if let Some((_, line)) = lines.iter().enumerate().find(is_twice) {
            let name = line.name.as_deref().map_or("all rows".to_owned(), |name| format!("{name:?}"));
            let message =
                format!("two traverses are given for {name}, must be one; name the others, as T1=TREND/PLUNGE");
            return Err(FieldError::Whole(message));
        }
        let mut blind = 0;
        let mut poles = Vec::new();
        for row in &self.rows {
            let factor = match line_along(lines, row) {
                Some(line) => {
                    let (weight, is_blind) = line.weight(&row.pole);
                    blind += usize::from(is_blind);
                    weight
                }
                None if lines.is_empty() => 1.0,
                None => {
                    let name = row.traverse.as_deref().unwrap_or("none");
                    let message = format!(
                        "traverse {name:?} is none of those given; add --traverse {name}=TREND/PLUNGE, or one without \
                         a name for all rows"
                    );
                    return Err(FieldError::Line { file: self.file.clone(), line: row.line, message });
                }
            };
            poles.push((row.pole, factor * row.quantity));
        }
        let is_used = |line: &Scanline| line.name.is_none() || self.rows.iter().any(|row| row.traverse == line.name);
        match lines.iter().find(|line| !is_used(line)) {
            None => Ok((poles, blind)),
            Some(line) => {
                let name = line.name.as_deref().unwrap_or_default();
                let message = format!("{}: no row is on a traverse {name:?}; check its column `traverse`", self.file);
                Err(FieldError::Whole(message))
            }
        }
    }

    /// Mean distance (m) normal to the planes of a mean pole between neighbours among some rows, from their distances
    /// along traverses: (last − first)/(n − 1) of each traverse, times the cosine between its line and the pole. None
    /// where no traverse has two of them with distances.
    pub fn spacing(&self, lines: &[Scanline], mean: &Axis, members: &[usize]) -> Option<f64> {
        let rows = || members.iter().filter_map(|&k| self.rows.get(k));
        let traverses: BTreeSet<&Option<String>> = rows().map(|row| &row.traverse).collect();
        let (mut length, mut gaps) = (0.0, 0);
        for traverse in traverses {
            let own = || rows().filter(|row| row.traverse == *traverse);
            let distances: Vec<f64> = own().filter_map(|row| row.distance).collect();
            let Some(line) = own().next().and_then(|row| line_along(lines, row)) else { continue };
            let ends = distances
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &at| [low.min(at), high.max(at)]);
            if distances.len() > 1 {
                length += (ends[1] - ends[0]) * line.across(mean);
                gaps += distances.len() - 1;
            }
        }
        (gaps > 0 && length > 0.0).then(|| length / gaps as f64)
    }
}

/// The line along which a row was measured: that of its name, or else the one for all rows.
fn line_along<'a>(lines: &'a [Scanline], row: &Measurement) -> Option<&'a Scanline> {
    let named = lines.iter().find(|line| line.name.is_some() && line.name == row.traverse);
    named.or_else(|| lines.iter().find(|line| line.name.is_none()))
}

impl Columns {
    fn of(heads: &[String]) -> Option<Self> {
        let find = |names: &[&str]| heads.iter().position(|head| names.contains(&head.as_str()));
        let plane = match (find(DIP), find(DIRECTION), find(STRIKE), find(PLUNGE), find(TREND)) {
            (Some(dip), Some(direction), ..) => (dip, direction, Form::DipDirection),
            (Some(dip), None, Some(strike), ..) => (dip, strike, Form::DipStrike),
            (_, _, _, Some(plunge), Some(trend)) => (plunge, trend, Form::PlungeTrend),
            _ => return None,
        };
        let [quantity, set, traverse, distance] = [QUANTITY, SET, TRAVERSE, DISTANCE].map(find);
        Some(Self { plane, quantity, set, traverse, distance })
    }

    /// Heads of columns that are not used.
    fn unused(&self, heads: &[String]) -> Vec<String> {
        let (a, b, _) = self.plane;
        let used = [Some(a), Some(b), self.quantity, self.set, self.traverse, self.distance];
        let rest = heads.iter().enumerate().filter(|(k, head)| !used.contains(&Some(*k)) && !head.is_empty());
        rest.map(|(_, head)| head.clone()).collect()
    }

    fn row(&self, line: usize, cells: &[String], mark: char) -> Result<Measurement, String> {
        let (a, b, form) = self.plane;
        let [first, second] = form.names();
        let text = |column: Option<usize>| {
            column.and_then(|column| cells.get(column)).filter(|text| !text.is_empty()).cloned()
        };
        let number = |column: usize, name: &str| {
            let text = cells.get(column).map(String::as_str).unwrap_or_default();
            number(text, mark).map_err(|message| format!("{name}: {message}"))
        };
        let (steep, round) = (number(a, first)?, number(b, second)?);
        if !(0.0..=90.0).contains(&steep) {
            let turned = if form == Form::DipDirection && (0.0..=360.0).contains(&steep) && round <= 90.0 {
                "the columns may be the other way round"
            } else {
                "an angle below the horizontal is meant"
            };
            return Err(format!("{first} is {steep}°, must be from 0 to 90; {turned}, correct the row or the heads"));
        }
        if !(-360.0..=360.0).contains(&round) {
            return Err(format!("{second} is {round}°, must be from -360 to 360; correct it"));
        }
        let pole = match form {
            Form::DipDirection => pole_of(steep, round),
            Form::DipStrike => pole_of(steep, round + 90.0),
            Form::PlungeTrend => line_of(steep, round),
        };
        let quantity = match self.quantity.filter(|&column| text(Some(column)).is_some()) {
            None => 1.0,
            Some(column) => number(column, "quantity")?,
        };
        if quantity.is_nan() || quantity <= 0.0 {
            return Err(format!("quantity is {quantity}, must be above 0; remove the row if no joint is meant"));
        }
        let distance = match self.distance.filter(|&column| text(Some(column)).is_some()) {
            None => None,
            Some(column) => Some(number(column, "distance")?),
        };
        Ok(Measurement { line, pole, quantity, set: text(self.set), traverse: text(self.traverse), distance })
    }
}

/// The line of the heads, from 1, its columns, and the sign between columns.
fn heads(file: &str, text: &str) -> Result<(usize, Columns, char), FieldError> {
    let mut first = None;
    for (k, line) in text.lines().enumerate().take(HEADS_WITHIN).filter(|(_, line)| !is_remark(line)) {
        let mark = [';', '\t'].into_iter().find(|mark| line.contains(*mark)).unwrap_or(',');
        let heads: Vec<String> = cells(line, mark).iter().map(|head| bare(head)).collect();
        if let Some(columns) = Columns::of(&heads) {
            return Ok((k + 1, columns, mark));
        }
        let known = [DIP, DIRECTION, STRIKE, TREND, PLUNGE];
        let is_near = heads.iter().any(|head| known.iter().any(|names| names.contains(&head.as_str())));
        if is_near && first.is_none() {
            first = Some((k + 1, heads));
        }
    }
    let wanted = "must be `dip` and `dip direction`, or `dip` and `strike` (dip to its right), or `trend` and `plunge` \
                  of the pole; name them in a line above the rows";
    match first {
        Some((line, heads)) => {
            let named = heads.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
            let message = format!("a column is missing: the columns are {named}, {wanted}");
            Err(FieldError::Line { file: file.to_owned(), line, message })
        }
        None => Err(FieldError::Whole(format!("{file}: has no line with heads of columns: they {wanted}"))),
    }
}

fn is_remark(line: &str) -> bool {
    line.trim().is_empty() || line.starts_with(['#', '*'])
}

/// Cells of a line without spaces around them.
fn cells(line: &str, mark: char) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new();
    let reader = reader.has_headers(false).delimiter(mark as u8).trim(csv::Trim::All).flexible(true);
    let record = reader.from_reader(line.as_bytes()).records().next().and_then(Result::ok).unwrap_or_default();
    record.iter().map(str::to_owned).collect()
}

/// A head in small letters without its unit, spaces and underscores.
fn bare(head: &str) -> String {
    let name = head.split(['[', '(', '°']).next().unwrap_or_default();
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

fn number(text: &str, mark: char) -> Result<f64, String> {
    let value = text.trim_end_matches('°').trim().parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| match text {
        "" => "is missing; write it, or remove the row".to_owned(),
        _ if mark != ',' && text.contains(',') => format!("{text:?} is no number; write a decimal point"),
        _ => {
            let begin: String = text.chars().take(20).collect();
            format!("{begin:?} is no number; correct it")
        }
    })
}
