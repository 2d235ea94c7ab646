//! Heads of records in columns: comments, names of columns, units.

use enmm::model::case::record::{BaseMotionKind, RecordReading, TimeUnit};

use super::numbers::{leading, number};
use super::units::{Unit, ends_of, is_foreign, known, known_time};
use super::wanted::{Fault, Wanted};

/// Words for a time.
const TIMES: [&str; 8] = ["t", "time", "times", "s", "sec", "seconds", "ms", "msec"];
/// Words for a number of a row.
const INDICES: [&str; 15] =
    ["#", "i", "j", "k", "n", "no", "nr", "num", "number", "idx", "index", "step", "sample", "point", "row"];
/// Units of time that are not read.
const OTHER_TIMES: [&str; 7] = ["min", "minutes", "h", "hours", "us", "µs", "μs"];

/// Name of a column.
pub struct Name(String);

/// The head before the rows.
#[derive(Default)]
pub struct Head {
    /// Names of the columns, if there are any.
    pub names: Vec<Name>,
    /// Units on a line of their own.
    units: Vec<String>,
    /// All lines without the signs of comments.
    texts: Vec<String>,
    /// Time between values that a comment gives, and its line (counted from 1).
    pub step: Option<(f64, usize)>,
    /// That a line is taken for names, if it has none that is known.
    pub note: String,
    /// Number of lines.
    pub lines: usize,
}

/// The text of a comment.
pub fn comment(line: &str) -> Option<&str> {
    line.starts_with(['#', '%', '!']).then(|| line.trim_start_matches(['#', '%', '!', ' ', '\t']))
}

/// Fields of a row.
pub fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', '\t', ' ']).map(str::trim).filter(|field| !field.is_empty())
}

/// Names on a line; blanks part them where nothing else does, but not in front of brackets.
fn names(line: &str) -> Vec<String> {
    if let Some(sign) = [';', '\t', ','].into_iter().find(|sign| line.contains(*sign)) {
        return line.split(sign).map(|name| name.trim().trim_matches('"').to_owned()).collect();
    }
    let mut found: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match found.last_mut().filter(|last| word.starts_with(['(', '[']) || last.contains('(') && !last.contains(')'))
        {
            Some(last) => *last += &format!(" {word}"),
            None => found.push(word.to_owned()),
        }
    }
    found
}

/// Refuses a line of names that begins like a number, or has one behind its first name: a row with a slip.
fn no_row(line: &str, k: usize) -> Result<(), Fault> {
    let mut fields = fields(line);
    let Some(first) = fields.next() else { return Ok(()) };
    let is_digit = |sign: char| sign.is_ascii_digit();
    let begins = first.trim_start_matches(['+', '-', '.']).starts_with(is_digit);
    if begins || fields.next().is_some_and(|second| second.parse::<f64>().is_ok()) {
        let message = number(first).err().unwrap_or_default();
        return Err(Fault::Line(k, format!("{message}; correct the row, or begin a heading with `#`")));
    }
    Ok(())
}

impl Head {
    /// Reads what stands before the first row, which is the line (as an index) that is returned.
    ///
    /// # Errors
    /// A second line of names, or one that looks like a row with a slip.
    pub fn read(lines: &[&str]) -> Result<(Self, usize), Fault> {
        let mut head = Self::default();
        let (mut line_of_names, mut last_comment) = (None, None);
        for (k, line) in lines.iter().map(|line| line.trim()).enumerate() {
            let is_comment = comment(line);
            let text = is_comment.unwrap_or(line);
            let is_sign = k == 0 && line.to_lowercase().starts_with("sep=");
            let first = fields(line).next();
            match (is_comment, first) {
                (Some(text), _) => last_comment = Some(text),
                (None, None) => continue,
                _ if is_sign => continue,
                (None, Some(first)) if first.parse::<f64>().is_ok() => {
                    let width = fields(line).count();
                    let heading = line_of_names.map(|(_, line)| line).or(last_comment);
                    let mut named = heading.map(names).unwrap_or_default();
                    while named.last().is_some_and(String::is_empty) {
                        named.pop();
                    }
                    if named.len() == width {
                        head.names = named.into_iter().map(Name).collect();
                    }
                    if let Some((line, _)) = line_of_names.filter(|_| !head.names.iter().any(Name::is_known)) {
                        head.note = format!(", line {line} is taken for a heading");
                    }
                    head.lines = k;
                    return Ok((head, k));
                }
                _ if line_of_names.is_none() => {
                    no_row(line, k + 1)?;
                    line_of_names = Some((k + 1, line));
                }
                _ => head.second_line(line, k)?,
            }
            head.step = head.step.or_else(|| step_of(text).map(|dt| (dt, k + 1)));
            head.texts.push(text.to_owned());
        }
        Ok((head, lines.len()))
    }

    /// A second line before the rows has units, one for each column.
    fn second_line(&mut self, line: &str, k: usize) -> Result<(), Fault> {
        let units: Vec<String> =
            names(line).iter().map(|name| name.trim_matches(['(', ')', '[', ']']).to_owned()).collect();
        let is_unit =
            |text: &String| known(text).is_some() || known_time(text).is_some() || text.is_empty() || text == "-";
        if !self.units.is_empty() || !units.iter().all(is_unit) {
            let first = fields(line).next().unwrap_or_default();
            let message = number(first).err().unwrap_or_default().replace("a value", "a column");
            return Err(Fault::Line(
                k + 1,
                format!("{message}; each line holds time (s) and value, as in `0.02, 1.5`"),
            ));
        }
        self.units = units;
        Ok(())
    }

    /// The unit of the times.
    ///
    /// # Errors
    /// The head names one that is not read, and the case gives none.
    pub fn time_unit(&self, column: Option<usize>, reading: &RecordReading) -> Result<Option<TimeUnit>, Fault> {
        let Some(column) = column else { return Ok(None) };
        let name = self.names.get(column).filter(|name| name.is_time() || self.names.len() > 1);
        let of_row = self.units.get(column).and_then(|text| known_time(text));
        let found = of_row.or_else(|| name.and_then(Name::time_unit));
        let is_other =
            |name: &Name| ends_of(&name.0).iter().any(|end| OTHER_TIMES.contains(&end.to_lowercase().as_str()));
        if found.is_none() && reading.time_unit.is_none() && name.is_some_and(is_other) {
            let message = "has times in a unit that is not read, by its head: must be s or ms; convert them";
            return Err(Fault::File(message.to_owned()));
        }
        Ok(found)
    }

    /// Quantity and unit of the values in a column, by its name, its unit, or a comment.
    ///
    /// # Errors
    /// The head names several units, or one that is not known, and the case gives none.
    pub fn quantity(&self, column: usize, wanted: &Wanted) -> Result<(Option<BaseMotionKind>, Option<Unit>), Fault> {
        let name = self.names.get(column);
        let of_row = self.units.get(column).and_then(|text| known(text));
        if let Some(unit) = of_row.or_else(|| name.and_then(Name::unit)) {
            return Ok((None, Some(unit)));
        }
        let kind = name.and_then(Name::kind);
        if wanted.reading.unit.is_some() {
            return Ok((kind, None));
        }
        if name.is_some_and(|name| ends_of(&name.0).iter().any(|end| is_foreign(end))) {
            let message = "has values in a unit that is not known, by its head; state the right one, such as \
                           `record = { unit = \"cm/s2\" }`, or convert them";
            return Err(Fault::File(message.to_owned()));
        }
        let Some(asked) = wanted.kind else { return Ok((kind, None)) };
        let mut told: Vec<Unit> = Vec::new();
        for unit in self.texts.iter().flat_map(|text| mentioned(text)).filter(|unit| unit.kind == asked) {
            if !told.iter().any(|known| known.factor == unit.factor) {
                told.push(unit);
            }
        }
        match told.as_slice() {
            [] => Ok((kind, None)),
            [unit] => Ok((kind, Some(*unit))),
            several => {
                let names: Vec<&str> = several.iter().map(|unit| unit.name).collect();
                let message = format!(
                    "names {} in its head; state which the values have, such as `record = {{ unit = {:?} }}`",
                    names.join(" and "),
                    names[0]
                );
                Err(Fault::File(message))
            }
        }
    }
}

/// Units that a text mentions: in brackets, behind `unit` or `units`, or behind `in`. Lengths are not among them, which
/// texts have of other things.
fn mentioned(text: &str) -> Vec<Unit> {
    let lower = text.to_lowercase();
    let inner = lower.split(['(', '[']).skip(1).filter_map(|rest| rest.split([')', ']']).next());
    let words: Vec<&str> = lower.split([' ', ',', ';', ':', '=']).filter(|word| !word.is_empty()).collect();
    let behind = words.windows(3).filter_map(|three| match three {
        ["unit" | "units", "of" | "in" | "is" | "are", word] => Some(*word),
        _ => None,
    });
    let next = words.windows(2).filter_map(|two| match two {
        ["unit" | "units" | "in", word] => Some(*word),
        _ => None,
    });
    inner.chain(behind).chain(next).filter_map(known).filter(|unit| unit.kind != BaseMotionKind::Displacement).collect()
}

/// The time (s) between values that a comment gives as `dt = 0.01 s`.
fn step_of(text: &str) -> Option<f64> {
    let text = text.to_lowercase().replace(' ', "");
    let (before, behind) = text.split_once("dt=").or_else(|| text.split_once("dt:"))?;
    if before.ends_with(|c: char| c.is_alphanumeric()) {
        return None;
    }
    let dt = leading(behind)?;
    let rest = behind.trim_start_matches(|c: char| c.is_ascii_digit() || ".+-".contains(c));
    let is_milli = known_time(rest.split([',', ';', ')']).next().unwrap_or_default()) == Some(TimeUnit::Millisecond);
    Some(if is_milli { 1e-3 * dt } else { dt })
}

impl Name {
    fn words(&self) -> Vec<String> {
        let stem = self.0.split(['(', '[', '{']).next().unwrap_or_default().to_lowercase();
        stem.split(['_', ' ', ',', '.', '-', '/']).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    }

    /// Whether it is that of a time.
    pub fn is_time(&self) -> bool {
        let words = self.words();
        words.first().is_some_and(|word| TIMES.contains(&word.as_str())) || words.iter().any(|word| word == "time")
    }

    /// Whether it says what its column is.
    fn is_known(&self) -> bool {
        self.is_time() || self.is_index() || self.kind().is_some()
    }

    /// Whether it is that of numbers of rows.
    pub fn is_index(&self) -> bool {
        !self.is_time() && self.words().first().is_some_and(|word| INDICES.contains(&word.as_str()))
    }

    /// The unit of time in it.
    pub fn time_unit(&self) -> Option<TimeUnit> {
        let whole = known_time(&self.0);
        whole.or_else(|| ends_of(&self.0).iter().find_map(|end| known_time(end)))
    }

    /// The unit of motion in it.
    fn unit(&self) -> Option<Unit> {
        let whole = known(&self.0).filter(|unit| unit.kind != BaseMotionKind::Displacement);
        whole.or_else(|| ends_of(&self.0).iter().find_map(|end| known(end)))
    }

    /// The quantity that its unit or its words stand for.
    pub fn kind(&self) -> Option<BaseMotionKind> {
        let kinds = [
            ("acc", BaseMotionKind::Acceleration),
            ("vel", BaseMotionKind::Velocity),
            ("dis", BaseMotionKind::Displacement),
        ];
        let words = self.words();
        let of =
            |(start, kind): (&str, BaseMotionKind)| words.iter().any(|word| word.starts_with(start)).then_some(kind);
        self.unit().map(|unit| unit.kind).or_else(|| kinds.into_iter().find_map(of))
    }
}
