//! K-NET and KiK-net ASCII: 17 lines of names and values, then counts of the recorder, eight on a line.
//!
//! The format is described in <http://www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html>: a count times the scale
//! factor, such as `3920(gal)/6182761`, is an acceleration; counts have an offset, which the maximum in the head leaves
//! out.

use enmm::model::case::record::BaseMotionKind;

use super::numbers::{Layout, leading};
use super::series::{Section, Series, channel, same_step};
use super::units::known;
use super::wanted::{Fault, Wanted};

/// Whether these lines are of such a file.
pub fn is(lines: &[&str]) -> bool {
    lines.first().is_some_and(|line| line.starts_with("Origin Time")) && find(lines, "Scale Factor").is_some()
}

/// The text behind a name at the beginning of a line, and its line as an index.
fn find<'a>(lines: &[&'a str], name: &str) -> Option<(usize, &'a str)> {
    lines.iter().take(30).enumerate().find_map(|(k, line)| Some((k, line.strip_prefix(name)?.trim())))
}

/// Reads the lines of a file.
///
/// # Errors
/// Its head or its values cannot be used.
pub fn read(lines: &[&str], wanted: &Wanted) -> Result<Series, Fault> {
    let missing =
        |name: &str| Fault::Line(1, format!("the head has no line {name:?} with a number; download the file again"));
    let (at, scale) = find(lines, "Scale Factor").ok_or_else(|| missing("Scale Factor"))?;
    let factor = scale_factor(scale).ok_or_else(|| {
        Fault::Line(at + 1, "the scale factor must be as in `3920(gal)/6182761`; download the file again".to_owned())
    })?;
    let (line, frequency) = find(lines, "Sampling Freq(Hz)").ok_or_else(|| missing("Sampling Freq(Hz)"))?;
    let frequency = leading(frequency).filter(|hertz| *hertz > 0.0).ok_or_else(|| {
        Fault::Line(line + 1, "the sampling frequency must be above 0 Hz, as in `100Hz`; correct the head".to_owned())
    })?;
    let seconds = find(lines, "Duration Time(s)").and_then(|(_, text)| leading(text));
    let points = seconds.map(|seconds| (seconds * frequency).round()).filter(|points| (1.0..1e12).contains(points));
    let (memo, _) = find(lines, "Memo.").ok_or_else(|| missing("Memo."))?;
    channel(wanted.reading.channel, 1, "motion")?;
    let count = points.map(|points| (points as usize, "duration times frequency"));
    let dt = 1.0 / frequency;
    let section = Section { lines, from: memo + 1, count, dt: (dt, line + 1), layout: Layout { width: 9 } };
    let mut series = section.read(|_| false)?;
    same_step(wanted.reading.dt, dt)?;
    series.values.iter_mut().for_each(|count| *count *= factor);
    (series.kind, series.unit) = (Some(BaseMotionKind::Acceleration), known("gal"));
    Ok(series)
}

/// Gal per count.
fn scale_factor(text: &str) -> Option<f64> {
    let (gal, counts) = text.split_once("(gal)/")?;
    let factor = leading(gal)? / leading(counts)?;
    (factor.is_finite() && factor != 0.0).then_some(factor)
}
