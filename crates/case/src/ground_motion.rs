//! The action of each ground motion of a case, and doubts about it.

use serde::Serialize;

use super::expand::motions::{ends, peak};
use super::plausible::usual_peaks;
use super::record::{BaseMotionKind, Baseline, RecordOrigin, STANDARD_GRAVITY};
use super::{Case, StageKind, TimeTable};

/// Share of the duration of a record by which stages may end before it.
const END: f64 = 1e-6;
/// Milliseconds in a second.
const MILLI: f64 = 1e-3;

/// A record of ground motion as it acts on the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroundMotion {
    /// Its place in the case, such as `base_motion[0]`.
    pub key: String,
    /// The file of its rows; none where the case has them.
    pub file: Option<String>,
    /// Format of the file, and what of it was read.
    pub format: String,
    /// Quantity of the rows as they were read.
    pub kind: BaseMotionKind,
    /// Unit of the values in the file, and who says so: `in g as its head says`.
    pub unit: String,
    /// Number of rows.
    pub rows: usize,
    /// First and last time (s) since the start of the stage.
    pub times: [f64; 2],
    /// Factor of the case on the values.
    pub scale: f64,
    /// Largest magnitude of `kind` (SI), with the factor of the case and before an outcrop is halved.
    pub peak: f64,
    /// Whether the motion is halved, as that of an outcrop.
    pub halved: bool,
    /// Largest velocity (m/s) of a wave that has been made of another quantity.
    pub velocity_peak: Option<f64>,
    /// Correction of the baseline, with final velocity (m/s) and displacement (m) before it.
    pub baseline: Option<(Baseline, [f64; 2])>,
    /// Final velocity (m/s) and displacement (m).
    pub ends: [f64; 2],
    /// Stages in which it acts, with times (s) since their starts.
    pub acts: Vec<(String, [f64; 2])>,
    /// Doubts about it.
    pub warnings: Vec<String>,
}

impl Case {
    /// The ground motions of a case that has been expanded and checked.
    pub fn ground_motions(&self) -> Vec<GroundMotion> {
        let base = |(k, base): (usize, &super::BaseMotion)| {
            let of = Source { key: format!("base_motion[{k}]"), kind: base.kind, scale: base.scale };
            self.ground_motion(of, base.table.as_ref()?, &base.origin, base.stage.as_deref())
        };
        let wave = |(k, quiet): (usize, &super::Quiet)| {
            let [x, y] = quiet.wave?;
            let scale = quiet.scale * libm::hypot(x, y);
            let of = Source { key: format!("quiet[{k}]"), kind: BaseMotionKind::Velocity, scale };
            self.ground_motion(of, quiet.table.as_ref()?, &quiet.origin, quiet.stage.as_deref())
        };
        let bases = self.base_motions.iter().enumerate().filter_map(base);
        bases.chain(self.quiets.iter().enumerate().filter_map(wave)).collect()
    }

    fn ground_motion(
        &self,
        of: Source,
        rows: &TimeTable,
        origin: &RecordOrigin,
        stage: Option<&str>,
    ) -> Option<GroundMotion> {
        let [first, last] = [rows.first()?[0], rows.last()?[0]];
        let (acts, end) = self.acting([first, last], self.motion_stage(stage)?);
        let (kind, size) = origin.read.unwrap_or_else(|| (of.kind, peak(rows)));
        let scaled = |values: [f64; 2]| values.map(|value| cleaned(of.scale * value));
        let mut motion = GroundMotion {
            key: of.key,
            file: origin.file.clone(),
            format: origin.format.clone(),
            kind,
            unit: origin.unit.clone(),
            rows: rows.len(),
            times: [first, last],
            scale: of.scale,
            peak: (of.scale * size).abs(),
            halved: origin.halved,
            velocity_peak: (kind != of.kind).then(|| (of.scale * peak(rows)).abs()),
            baseline: origin.corrected.map(|(baseline, ends)| (baseline, scaled(ends))),
            ends: scaled(ends(of.kind, rows)),
            acts,
            warnings: Vec::new(),
        };
        let moves = |row: &[f64; 2]| row[1] != 0.0;
        let is_cut =
            |end: &f64| last > end + END * (last - first) && rows.iter().any(|row| row[0] > *end && moves(row));
        let late = end.filter(is_cut).map(|end| motion.cut(end, origin));
        let named = |doubt: String| format!("{}: {doubt}", motion.key);
        motion.warnings = origin.warnings.iter().cloned().chain(motion.doubts()).chain(late).map(named).collect();
        Some(motion)
    }

    /// The stages in which a record acts, and when the last of them ends (s since the start of the first one); none
    /// where it goes on after a static stage, whose time nobody knows.
    fn acting(&self, [first, last]: [f64; 2], stage: usize) -> (Vec<(String, [f64; 2])>, Option<f64>) {
        let (mut acts, mut start) = (Vec::new(), 0.0);
        let stages = &self.stages[stage..];
        let dynamic = stages.iter().take_while(|stage| stage.kind == StageKind::Dynamic).count();
        for stage in &stages[..dynamic] {
            let span = [(first - start).max(0.0), (last - start).min(stage.duration)];
            if span[1] > span[0] {
                acts.push((stage.name.clone(), span));
            }
            start += stage.duration;
        }
        let goes_on = stages[dynamic..].iter().any(|stage| stage.kind == StageKind::Dynamic);
        (acts, (!goes_on).then_some(start))
    }
}

/// A ground motion of the case.
struct Source {
    key: String,
    kind: BaseMotionKind,
    scale: f64,
}

impl GroundMotion {
    /// The motion in a line.
    pub fn text(&self) -> String {
        let Self { key, kind, unit, rows, times: [first, last], .. } = self;
        let file = self.file.as_ref().map_or_else(|| "table".to_owned(), |file| format!("{file} ({})", self.format));
        let unit = if unit.is_empty() { format!("in {}", kind.unit()) } else { unit.clone() };
        let acts: Vec<String> = self.acts.iter().map(|(name, [from, to])| span(name, *from, *to)).collect();
        let acts = if acts.is_empty() { "acts in no stage".to_owned() } else { format!("acts {}", acts.join(", ")) };
        let mut parts = vec![
            format!("{key}: {file}, {} {unit}", kind.name()),
            if self.scale == 1.0 { format!("{rows} rows") } else { format!("{rows} rows times {}", short(self.scale)) },
            format!("{} to {} s", time(*first), time(*last)),
            format!("peak {}", self.size()),
            acts,
        ];
        if let Some(peak) = self.velocity_peak {
            parts.push(format!("made a velocity with peak {} m/s", short(peak)));
        }
        if self.halved {
            parts.push("halved as the motion of an outcrop".to_owned());
        }
        let [velocity, displacement] = self.ends.map(short);
        let ends = format!("final velocity {velocity} m/s, final displacement {displacement} m");
        parts.push(match &self.baseline {
            Some((baseline, before)) => {
                let [v, d] = before.map(short);
                let name = format!("{baseline:?}").to_lowercase();
                format!("baseline {name}: {ends} (before {v} m/s, {d} m)")
            }
            None => ends,
        });
        parts.join(", ")
    }

    fn size(&self) -> String {
        let peak = format!("{} {}", short(self.peak), self.kind.unit());
        let is_acceleration = self.kind == BaseMotionKind::Acceleration;
        if is_acceleration { format!("{peak} ({} g)", short(self.peak / STANDARD_GRAVITY)) } else { peak }
    }

    /// Peaks that no record of an earthquake has.
    fn doubts(&self) -> Vec<String> {
        let ([least, most], largest) = usual_peaks(self.kind);
        let limit = |value: f64| match self.kind {
            BaseMotionKind::Acceleration => format!("{} g", short(value / STANDARD_GRAVITY)),
            kind => format!("{} {}", short(value), kind.unit()),
        };
        let named = self.file.as_ref().map_or_else(|| "the table".to_owned(), |file| format!("{file:?}"));
        let unit = match (&self.file, self.unit.is_empty()) {
            (Some(_), false) => format!("it is read {}; state another `record = {{ unit = … }}` or ", self.unit),
            _ => String::new(),
        };
        let remedy = format!("{unit}change `scale` if that is wrong");
        let mut doubts = Vec::new();
        if self.peak == 0.0 {
            doubts.push(format!("{named} has no motion: all values times `scale` are 0"));
        } else if self.peak < least {
            doubts.push(format!("the peak of {named} is {}, below {}: {remedy}", self.size(), limit(least)));
        } else if self.peak > most {
            doubts.push(format!(
                "the peak of {named} is {}, above {}, and {largest}: {remedy}",
                self.size(),
                limit(most)
            ));
        }
        let ([_, fastest], _) = usual_peaks(BaseMotionKind::Velocity);
        if let Some(peak) = self.velocity_peak.filter(|peak| *peak > fastest && self.peak <= most) {
            doubts.push(format!(
                "{named} gives a velocity of {} m/s, above {fastest} m/s: it drifts unless its baseline is corrected, \
                 such as by `baseline = \"linear\"`",
                short(peak)
            ));
        }
        doubts.extend(self.drift(&named, most));
        doubts
    }

    /// An acceleration of the base that goes on moving it when it is over.
    fn drift(&self, named: &str, most: f64) -> Option<String> {
        let ([_, fastest], _) = usual_peaks(BaseMotionKind::Velocity);
        let is_direct = self.kind == BaseMotionKind::Acceleration && self.velocity_peak.is_none();
        let drifts = is_direct && self.peak <= most && self.ends[0].abs() > fastest;
        drifts.then(|| {
            format!(
                "{named} ends with a velocity of {} m/s: correct its baseline, such as by `baseline = \"linear\"`",
                short(self.ends[0])
            )
        })
    }

    /// A record of which stages that end at `end` (s) leave something out.
    fn cut(&self, end: f64, origin: &RecordOrigin) -> String {
        let [first, last] = self.times.map(time);
        let [end_text, key] = [time(end), self.key.clone()];
        let is_milli = !origin.time_is_stated && origin.file.is_some() && MILLI * self.times[1] <= end;
        let remedy = match is_milli {
            true => "state `record = { time_unit = \"ms\" }` if its times are in milliseconds, else lengthen the stage",
            false => "lengthen the stage, or leave these rows out",
        };
        match self.acts.is_empty() {
            true => format!(
                "the record begins at {first} s, and its dynamic stages end after {end_text} s: it moves nothing; give \
                 times since the start of `{key}.stage`, or {remedy}"
            ),
            false => format!(
                "the record lasts to {last} s, and its dynamic stages end after {end_text} s: what comes later does \
                 not act; {remedy}"
            ),
        }
    }
}

fn span(name: &str, from: f64, to: f64) -> String {
    format!("in {name} from {} to {} s", time(from), time(to))
}

/// Rounding residues as 0.
fn cleaned(value: f64) -> f64 {
    if value.abs() < 1e-9 { 0.0 } else { value }
}

/// A number in three significant digits.
fn short(value: f64) -> String {
    let rounded = format!("{value:.2e}").parse::<f64>().unwrap_or(value) + 0.0;
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// A time in microseconds.
fn time(value: f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}
