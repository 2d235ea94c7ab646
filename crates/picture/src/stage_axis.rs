//! The axis of histories: dynamic stages by their true time, static stages as bands of equal width.

use super::axes::{LABEL_SIZE, Ticks};
use super::colour::GREY;
use super::sheet::{Sheet, Style, TextStyle, fitted, text_width};

/// Values beyond this are taken for numerical failures and left out.
pub const FARTHEST: f64 = 1e300;
/// Height (px) of a row of names above the first frame.
pub const NAME_ROW: f64 = 24.0;
/// Rows of names at most.
const NAME_ROWS: usize = 4;
/// Width (px) of a name at most.
const NAME_WIDTH: f64 = 320.0;
/// Share of the axis of a static stage beside dynamic ones, and of all static ones, at most.
const STATIC_SHARES: [f64; 2] = [0.12, 0.45];
/// Share of a dynamic stage at least, before all are brought to the width of the axis.
const LEAST_SHARE: f64 = 0.04;
/// Distance (px) of numbers of time that is aimed at.
const TICK_DISTANCE: f64 = 110.0;

/// Where a stage begins on the time axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StageStart {
    /// Name of the stage.
    pub name: String,
    /// Its first time (s).
    pub time: f64,
    /// Whether its time is a path to equilibrium and no physics.
    pub is_static: bool,
}

/// Stages side by side.
#[derive(Debug)]
pub struct StageAxis {
    parts: Vec<Part>,
    has_stages: bool,
}

/// One stage on the axis.
#[derive(Debug)]
struct Part {
    /// First and last time (s) of the histories.
    times: [f64; 2],
    /// True time (s) at its start.
    true_start: f64,
    /// Left edge and width (px).
    place: [f64; 2],
    is_static: bool,
    name: String,
    /// Row of its name, from below.
    row: usize,
}

impl StageAxis {
    /// Stages between the first and the last time (s) from `left` on, `width` px together.
    pub fn new([first, last]: [f64; 2], stages: &[StageStart], left: f64, width: f64) -> Self {
        let fits = stages.iter().all(|stage| stage.time.abs() < FARTHEST)
            && stages.windows(2).all(|pair| pair[0].time <= pair[1].time);
        let known: Vec<StageStart> = if fits { stages.to_vec() } else { Vec::new() };
        let whole = [StageStart { name: String::new(), time: first, is_static: false }];
        let shown = if known.is_empty() { &whole[..] } else { &known[..] };
        let end = |k: usize| shown.get(k + 1).map_or(last, |next| next.time);
        let times: Vec<[f64; 2]> = shown.iter().enumerate().map(|(k, stage)| [stage.time, end(k)]).collect();
        let shares = shares(shown, &times);
        let (mut parts, mut x, mut true_time) = (Vec::new(), left, 0.0);
        for ((stage, times), share) in shown.iter().zip(times).zip(shares) {
            let place = [x, share * width];
            x += share * width;
            let true_start = if known.is_empty() { times[0] } else { true_time };
            parts.push(Part { times, true_start, place, is_static: stage.is_static, name: stage.name.clone(), row: 0 });
            if !stage.is_static {
                true_time += times[1] - times[0];
            }
        }
        let mut axis = Self { parts, has_stages: !known.is_empty() };
        axis.place_names(left + width);
        axis
    }

    /// Gives each name the lowest row in which it keeps off the names before it.
    fn place_names(&mut self, right: f64) {
        let mut ends = [f64::NEG_INFINITY; NAME_ROWS];
        for part in &mut self.parts {
            part.name = fitted(&part.name, LABEL_SIZE, NAME_WIDTH.min(right - part.place[0] + 250.0));
            part.row = ends.iter().position(|end| *end < part.place[0]).unwrap_or(NAME_ROWS - 1);
            ends[part.row] = part.place[0] + text_width(&part.name, LABEL_SIZE) + 14.0;
        }
    }

    /// Where a time of the histories appears (px).
    pub fn x(&self, time: f64) -> f64 {
        let part = self.parts.iter().rev().find(|part| part.times[0] <= time).unwrap_or(&self.parts[0]);
        let [start, end] = part.times;
        let share = if end > start { (time - start) / (end - start) } else { 0.0 };
        part.place[0] + share * part.place[1]
    }

    /// Left edges and widths (px) of static stages.
    pub fn bands(&self) -> impl Iterator<Item = [f64; 2]> {
        self.parts.iter().filter(|part| part.is_static).map(|part| part.place)
    }

    /// Where stages after the first begin (px).
    pub fn borders(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().skip(1).map(|part| part.place[0])
    }

    /// Places (px) and labels of round true times.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let dynamic = self.parts.iter().filter(|part| !part.is_static);
        let of = |part: &Part| {
            let [start, end] = part.times;
            let ticks =
                Ticks::new(part.true_start, part.true_start + end - start, (part.place[1] / TICK_DISTANCE).max(1.0));
            let place = |time: f64| part.place[0] + (time - part.true_start) / (end - start) * part.place[1];
            ticks.values.iter().map(|&time| (place(time), ticks.label(time))).collect::<Vec<_>>()
        };
        dynamic.flat_map(of).collect()
    }

    /// Title of the axis.
    pub fn title(&self) -> &'static str {
        match (self.has_stages, self.parts.iter().any(|part| !part.is_static), self.bands().next().is_some()) {
            (true, true, true) => "time in dynamic stages [s]; static stages have no time scale",
            (true, false, _) => "static stages, which have no time scale",
            _ => "time [s]",
        }
    }

    /// Rows of names; none for a single stage.
    pub fn name_rows(&self) -> usize {
        let rows = self.parts.iter().map(|part| part.row + 1).max().unwrap_or(0);
        if self.parts.len() > 1 { rows } else { 0 }
    }

    /// Names of the stages above the first frame, with lines down to it.
    pub fn draw_names(&self, sheet: &mut Sheet, top: f64) {
        for part in self.parts.iter().filter(|_| self.parts.len() > 1) {
            let y = top - 7.0 - NAME_ROW * part.row as f64;
            sheet.line([part.place[0], top], [part.place[0], y - 12.0], Style::line(GREY, 1.2));
            sheet.text([part.place[0] + 5.0, y], &part.name, TextStyle::new(LABEL_SIZE).colour(GREY));
        }
    }
}

/// Shares of the axis of the stages; their sum is 1.
fn shares(stages: &[StageStart], times: &[[f64; 2]]) -> Vec<f64> {
    let statics = stages.iter().filter(|stage| stage.is_static).count() as f64;
    if statics == stages.len() as f64 {
        return vec![1.0 / statics; stages.len()];
    }
    let of_static = if statics > 0.0 { STATIC_SHARES[0].min(STATIC_SHARES[1] / statics) } else { 0.0 };
    let lasts = |k: usize| times[k][1] - times[k][0];
    let total: f64 = (0..stages.len()).filter(|&k| !stages[k].is_static).map(lasts).sum();
    let share = |k: usize| if total > 0.0 { (lasts(k) / total).max(LEAST_SHARE) } else { 1.0 };
    let sum: f64 = (0..stages.len()).filter(|&k| !stages[k].is_static).map(share).sum();
    let of_dynamic = (1.0 - of_static * statics) / sum;
    (0..stages.len()).map(|k| if stages[k].is_static { of_static } else { share(k) * of_dynamic }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage(name: &str, time: f64, is_static: bool) -> StageStart {
        StageStart { name: name.to_owned(), time, is_static }
    }

    /// A static stage of 200 s before a quake of 10 s once took 95 % of the axis.
    #[test]
    fn dynamic_stages_have_most_of_the_axis_and_their_own_time() {
        let stages = [stage("in situ", 0.0, true), stage("quake", 200.0, false), stage("rest", 210.0, true)];
        let axis = StageAxis::new([0.0, 230.0], &stages, 100.0, 1000.0);
        assert!((axis.x(210.0) - axis.x(200.0) - 760.0).abs() < 1e-9);
        assert!((axis.x(100.0) - 160.0).abs() < 1e-9, "half of the static stage is in the middle of its band");
        let ticks = axis.ticks();
        assert!(ticks.iter().all(|(x, _)| (219.9..980.1).contains(x)), "{ticks:?}");
        assert_eq!([&ticks[0].1, &ticks[ticks.len() - 1].1], ["0", "10"]);
        assert!(axis.title().contains("dynamic stages"));
    }

    #[test]
    fn names_that_would_overlap_stand_in_rows() {
        let stages: Vec<_> = (0..6).map(|k| stage("a name of a stage", f64::from(k), true)).collect();
        let axis = StageAxis::new([0.0, 6.0], &stages, 0.0, 600.0);
        assert!(axis.name_rows() > 1);
        let places: Vec<_> = axis.parts.iter().map(|p| (p.row, p.place[0], text_width(&p.name, LABEL_SIZE))).collect();
        for (k, a) in places.iter().enumerate() {
            for b in places[k + 1..].iter().filter(|b| b.0 == a.0) {
                assert!(a.1 + a.2 < b.1, "{places:?}");
            }
        }
    }

    #[test]
    fn without_stages_and_with_broken_ones_all_time_is_true() {
        for stages in [vec![], vec![stage("bad", f64::NAN, true), stage("worse", 1.0, false)]] {
            let axis = StageAxis::new([1.0, 3.0], &stages, 0.0, 100.0);
            assert_eq!(axis.title(), "time [s]");
            assert_eq!(axis.x(2.0), 50.0);
        }
    }
}
