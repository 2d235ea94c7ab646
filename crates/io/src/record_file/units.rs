//! Units of records, and how heads write them.

use enmm::model::case::record::{BaseMotionKind, STANDARD_GRAVITY, TimeUnit};

use super::wanted::{Fault, Wanted};

/// Relative difference up to which the factor of a case is that of a unit: 9.81 and 9.8 are g.
const SAME_FACTOR: f64 = 2e-3;

/// A unit of a ground motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    pub name: &'static str,
    pub kind: BaseMotionKind,
    /// SI units in it.
    pub factor: f64,
}

use BaseMotionKind::{Acceleration, Displacement, Velocity};

/// Units with the ways to write them, once [`plain`]. A gal is 1 cm/s² and a kine 1 cm/s.
const UNITS: [(Unit, &[&str]); 14] = [
    (Unit { name: "g", kind: Acceleration, factor: STANDARD_GRAVITY }, &["g", "gs", "g's"]),
    (Unit { name: "%g", kind: Acceleration, factor: 0.01 * STANDARD_GRAVITY }, &["%g"]),
    (Unit { name: "m/s²", kind: Acceleration, factor: 1.0 }, &["m/s2", "m/s/s", "ms-2", "m/(s2)"]),
    (Unit { name: "cm/s²", kind: Acceleration, factor: 0.01 }, &["cm/s2", "cm/s/s", "cms-2", "cm/(s2)"]),
    (Unit { name: "gal", kind: Acceleration, factor: 0.01 }, &["gal", "gals"]),
    (Unit { name: "mm/s²", kind: Acceleration, factor: 1e-3 }, &["mm/s2", "mm/s/s", "mms-2"]),
    (Unit { name: "ft/s²", kind: Acceleration, factor: 0.3048 }, &["ft/s2", "ft/s/s"]),
    (Unit { name: "in/s²", kind: Acceleration, factor: 0.0254 }, &["in/s2", "in/s/s"]),
    (Unit { name: "m/s", kind: Velocity, factor: 1.0 }, &["m/s", "ms-1"]),
    (Unit { name: "cm/s", kind: Velocity, factor: 0.01 }, &["cm/s", "cms-1", "kine", "kines"]),
    (Unit { name: "mm/s", kind: Velocity, factor: 1e-3 }, &["mm/s", "mms-1"]),
    (Unit { name: "m", kind: Displacement, factor: 1.0 }, &["m"]),
    (Unit { name: "cm", kind: Displacement, factor: 0.01 }, &["cm"]),
    (Unit { name: "mm", kind: Displacement, factor: 1e-3 }, &["mm"]),
];

/// A text in small letters without signs that are written or left out at will.
fn plain(text: &str) -> String {
    let text = text.trim().to_lowercase().replace('²', "2").replace('−', "-");
    let text = text.replace("seconds", "s").replace("second", "s").replace("sec", "s");
    text.replace(['^', '*', '·', ' ', '.', '_'], "")
}

/// The unit that a text is.
pub fn known(text: &str) -> Option<Unit> {
    let text = plain(text);
    UNITS.iter().find(|(_, spellings)| spellings.contains(&text.as_str())).map(|(unit, _)| *unit)
}

/// The unit of time that a text is.
pub fn known_time(text: &str) -> Option<TimeUnit> {
    match plain(text).as_str() {
        "s" => Some(TimeUnit::Second),
        "ms" | "mss" | "millis" | "millisecond" => Some(TimeUnit::Millisecond),
        _ => None,
    }
}

/// A text that stands for a unit in the name of a column: what brackets hold, or the end behind `_`, blank or comma.
pub fn ends_of(name: &str) -> Vec<String> {
    let name = name.trim();
    if let Some((_, rest)) = name.rsplit_once(['(', '[', '{']) {
        let inner = rest.trim_end_matches([')', ']', '}', ' ']);
        return vec![inner.to_owned()];
    }
    let cuts = name.char_indices().filter(|(_, c)| matches!(c, '_' | ' ' | ','));
    // `acc_cm_s2` ends with `cm/s2`.
    let ends = cuts.flat_map(|(k, _)| {
        let end = name[k + 1..].trim_start_matches("in ");
        [end.to_owned(), end.replace('_', "/")]
    });
    ends.collect()
}

/// Whether a text is written as a unit that is none of ours: raw counts, volts, or a fraction.
pub fn is_foreign(text: &str) -> bool {
    let text = plain(text);
    let raw = ["counts", "count", "cnt", "digit", "digits", "v", "mv", "volt", "volts"];
    raw.contains(&text.as_str()) || text.contains("/s") || text.contains("s-")
}

/// Factor to SI units, and words about the unit: head, `record.unit` and `scale` must not contradict each other.
/// `is_open` for files in which `scale` may have converted the unit before heads were read.
pub fn factor(head: Option<Unit>, wanted: &Wanted, is_open: bool) -> Result<(f64, String), Fault> {
    let key = match &wanted.reading.unit {
        Some(text) => Some(known(text).ok_or_else(|| Fault::Key("record.unit", unknown(text)))?),
        None => None,
    };
    let kind = wanted.kind.unwrap_or(Velocity);
    if let Some(unit) = key.filter(|unit| unit.kind != kind) {
        let message = format!(
            "is {}, a unit of {}, and the record is one of {}; correct one",
            unit.name,
            unit.kind.name(),
            kind.name()
        );
        return Err(Fault::Key("record.unit", message));
    }
    if let Some(unit) = head.filter(|unit| unit.kind != kind) {
        let (name, other) = (unit.name, unit.kind.name());
        let message = format!(
            "is in {name} by its head, a unit of {other}, and {} is asked for; name it by `{other} = \"…\"`, or \
             choose another of its `columns`",
            kind.name()
        );
        return Err(Fault::File(message));
    }
    match (head, key) {
        (Some(head), Some(key)) if head.factor != key.factor => Err(Fault::Key(
            "record.unit",
            format!("is {}, and the head of the file says {}; remove it or correct the head", key.name, head.name),
        )),
        (_, Some(unit)) => Ok((unit.factor, format!("in {} as `record.unit` says", unit.name))),
        (Some(unit), None) => of_head(unit, wanted, is_open),
        (None, None) if wanted.kind.is_none() => Ok((1.0, "as factors on `wave`".to_owned())),
        (None, None) => Ok((1.0, format!("in {} as no unit is named", kind.unit()))),
    }
}

fn of_head(unit: Unit, wanted: &Wanted, is_open: bool) -> Result<(f64, String), Fault> {
    let Unit { name, factor, .. } = unit;
    if factor == 1.0 || wanted.scale == 1.0 && wanted.kind.is_some() {
        return Ok((factor, format!("in {name} as its head says")));
    }
    if wanted.kind.is_none() {
        let message = format!(
            "is in {name} by its head, and a `file` of a wave has factors on `wave`; name it by `{} = \"…\"`",
            unit.kind.name()
        );
        return Err(Fault::File(message));
    }
    if (wanted.scale.abs() / factor - 1.0).abs() <= SAME_FACTOR {
        return Ok((1.0, format!("in {name} as its head says, converted by `scale`")));
    }
    if !is_open {
        return Ok((factor, format!("in {name} as its head says")));
    }
    let message = format!(
        "is {}, and the head of the file names {name}: does it convert? With `record = {{ unit = {name:?} }}` it is a \
         factor on values that are converted, and {:.4} instead if it has converted them so far",
        wanted.scale,
        wanted.scale / factor
    );
    Err(Fault::Key("scale", message))
}

fn unknown(text: &str) -> String {
    let names: Vec<&str> = UNITS.iter().map(|(unit, _)| unit.name).collect();
    format!("{text:?} is no unit that is known, must be one of {}", names.join(", "))
}
