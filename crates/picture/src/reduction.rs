//! Pictures of a strength reduction: trials against F, and the slope with the blocks that fail.

use super::Picture;
use super::annotations::counted;
use super::axes::{Bounds, LABEL_SIZE, TICK_SIZE, Ticks, View, draw_grid_line, draw_left_number, superscript};
use super::colour::{ACCENT, Colour, GREY, INK, LINES, PALE};
use super::sheet::{Anchor, Pixel, Rect, Sheet, Style, TextStyle};
use super::slope::{
    BELOW_FRAME, LEFT, LINE_HEIGHT, MARGIN, TOP, WIDTH, draw_absence, draw_block_outlines, draw_filled, draw_title,
};
use enmm_observe::Snapshot;
use enmm_stability::strength_reduction::{Reduction, Trial, Verdict};

/// Name of a quantity of a trial, and its value.
type Quantity = (&'static str, fn(&Trial) -> f64);

/// Height (px) of each of the two frames of trials.
const FRAME: f64 = 380.0;
/// Distance (px) of the frames.
const BETWEEN: f64 = 30.0;
/// Height (px) of the picture of the slope at most.
const HEIGHT_MAX: f64 = 820.0;
/// Rock that stands.
const STANDS: Colour = Colour(205, 224, 240);
/// Decades below the largest value that a frame shows at most.
const DECADES_MAX: f64 = 12.0;

/// Draws displacement and kinetic energy at the end of each trial against F, with the bracket.
pub fn trials_picture(title: &str, reduction: &Reduction) -> Picture {
    let mut sheet = Sheet::new(WIDTH, TOP + 2.0 * FRAME + BETWEEN + BELOW_FRAME + LINE_HEIGHT + MARGIN);
    draw_title(&mut sheet, title, &caption(reduction));
    let quantities: [Quantity; 2] =
        [("largest displacement [m]", |t| t.displacement), ("kinetic energy [J/m]", |t| t.kinetic)];
    for (k, (name, of)) in quantities.into_iter().enumerate() {
        let top = TOP + k as f64 * (FRAME + BETWEEN);
        let frame = Rect { left: LEFT, top, width: WIDTH - LEFT - MARGIN, height: FRAME };
        Chart::new(frame, reduction, of).draw(&mut sheet, reduction, name, of);
    }
    let bottom = TOP + 2.0 * FRAME + BETWEEN;
    let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    sheet.text([0.5 * WIDTH, bottom + 45.0], "F: strength is divided by it", style);
    draw_legend(&mut sheet, bottom + BELOW_FRAME + LINE_HEIGHT);
    sheet.finish()
}

fn caption(reduction: &Reduction) -> String {
    match (reduction.factor(), reduction.low, reduction.high) {
        (Some(factor), Some(low), Some(high)) => {
            let bound = match &reduction.bound {
                Ok(bound) => format!("; limit analysis {}", bound.level_tops.factor),
                Err(_) => String::new(),
            };
            format!("factor of safety {factor:.4}: stable at {low:.4}, not at {high:.4}{bound}")
        }
        (_, low, high) => {
            let text = |f: Option<f64>| f.map_or("none".to_owned(), |f| format!("{f:.4}"));
            format!("no factor of safety; greatest stable F {}, least other F {}", text(low), text(high))
        }
    }
}

fn verdict_colour(verdict: Verdict) -> Colour {
    match verdict {
        Verdict::Stable => LINES[2],
        Verdict::Caught => LINES[1],
        Verdict::Unstable => ACCENT,
    }
}

fn draw_legend(sheet: &mut Sheet, y: f64) {
    let entries = [
        (Some(verdict_colour(Verdict::Stable)), "stable"),
        (Some(verdict_colour(Verdict::Caught)), "caught"),
        (Some(verdict_colour(Verdict::Unstable)), "unstable"),
        (None, "bracket"),
    ];
    for (k, (colour, text)) in entries.into_iter().enumerate() {
        let x = LEFT + 180.0 * k as f64;
        match colour {
            Some(colour) => sheet.circle([x + 8.0, y - 5.0], 7.0, Style::fill(colour)),
            None => sheet.rect(&Rect { left: x, top: y - 13.0, width: 18.0, height: 16.0 }, Style::fill(PALE)),
        }
        sheet.text([x + 28.0, y], text, TextStyle::new(LABEL_SIZE));
    }
}

/// A frame with F along it and a logarithm up it.
struct Chart {
    frame: Rect,
    factors: [f64; 2],
    decades: [f64; 2],
}

impl Chart {
    fn new(frame: Rect, reduction: &Reduction, of: fn(&Trial) -> f64) -> Self {
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let [low, high] = range(&mut reduction.trials.iter().map(|t| t.factor));
        let margin = 0.05 * (high - low).max(0.02 * high);
        let [least, most] = range(&mut reduction.trials.iter().map(of).filter(|v| *v > 0.0 && v.is_finite()));
        let (least, most) = if least <= most { (least, most) } else { (0.1, 1.0) };
        let top = libm::log10(most) + 0.3;
        let factors = if low <= high { [low - margin, high + margin] } else { [0.0, 1.0] };
        Self { frame, factors, decades: [(libm::log10(least) - 0.3).max(top - DECADES_MAX), top] }
    }

    fn x(&self, factor: f64) -> f64 {
        let [low, high] = self.factors;
        self.frame.left + (factor - low) / (high - low) * self.frame.width
    }

    fn y(&self, value: f64) -> f64 {
        let [low, high] = self.decades;
        let decade = if value > 0.0 { libm::log10(value).clamp(low, high) } else { low };
        self.frame.bottom() - (decade - low) / (high - low) * self.frame.height
    }

    fn draw(&self, sheet: &mut Sheet, reduction: &Reduction, name: &str, of: fn(&Trial) -> f64) {
        if let (Some(low), Some(high)) = (reduction.low, reduction.high) {
            let (left, right) = (self.x(low), self.x(high));
            sheet.rect(&Rect { left, width: (right - left).max(2.0), ..self.frame }, Style::fill(PALE));
        }
        self.draw_ticks(sheet);
        for trial in reduction.trials.iter().filter(|trial| of(trial).is_finite()) {
            let position: Pixel = [self.x(trial.factor), self.y(of(trial))];
            sheet.circle(position, 7.0, Style::fill(verdict_colour(trial.verdict)));
        }
        sheet.rect(&self.frame, Style::line(INK, 1.2));
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward();
        sheet.text([LEFT - 76.0, self.frame.top + 0.5 * self.frame.height], name, style);
    }

    fn draw_ticks(&self, sheet: &mut Sheet) {
        let (top, bottom) = (self.frame.top, self.frame.bottom());
        let ticks = Ticks::new(self.factors[0], self.factors[1], 10.0);
        for &factor in &ticks.values {
            draw_grid_line(sheet, [self.x(factor), top], [self.x(factor), bottom]);
            let style = TextStyle::new(TICK_SIZE).anchor(Anchor::Middle);
            sheet.text([self.x(factor), bottom + 4.0 + TICK_SIZE], &ticks.label(factor), style);
        }
        for decade in self.decades[0].ceil() as i32..=self.decades[1].floor() as i32 {
            let y = self.y(10f64.powi(decade));
            draw_grid_line(sheet, [self.frame.left, y], [self.frame.right(), y]);
            draw_left_number(sheet, [self.frame.left, y], &format!("10{}", superscript(decade)));
        }
    }
}

/// Verb for the motion of the blocks of a trial.
fn verb(trial: &Trial) -> &'static str {
    match (trial.verdict == Verdict::Caught, trial.failing.len() == 1) {
        (true, true) => "slides and is caught",
        (true, false) => "slide and are caught",
        (false, true) => "fails",
        (false, false) => "fail",
    }
}

/// Draws the slope at the end of the least unstable trial, with the blocks that fail; at rest when there was none.
pub fn failure_picture(title: &str, reduction: &Reduction) -> Picture {
    let snapshot = Snapshot::of(&reduction.simulation);
    let trial = reduction.first_unstable();
    let mut fails = vec![false; reduction.simulation.model().covers.block_count()];
    trial.iter().flat_map(|t| &t.failing).for_each(|block| fails[block.block as usize] = true);
    let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - MARGIN, height: HEIGHT_MAX };
    let view = View::fit(Bounds::of(&snapshot.elements.points), area);
    let mut sheet = Sheet::new(WIDTH, view.area.bottom() + BELOW_FRAME + LINE_HEIGHT + MARGIN);
    let caption = match trial {
        Some(trial) => format!(
            "{} {} at F = {:.4}: {:.4} m², {:.1} % of the free rock",
            counted(trial.failing.len(), "block"),
            verb(trial),
            trial.factor,
            trial.failing_area(),
            100.0 * trial.failing_area() / reduction.free_area
        ),
        None => "no trial failed".to_owned(),
    };
    draw_title(&mut sheet, title, &caption);
    sheet.clipped(&view.area, |sheet| {
        let of_element = |k: usize| snapshot.block.get(k).is_some_and(|&b| fails[b as usize]);
        draw_filled(sheet, &snapshot.elements, &view, &[STANDS, LINES[1]], |k| usize::from(of_element(k)));
        draw_block_outlines(sheet, &snapshot, &view);
        draw_absence(sheet, &view, &snapshot.elements);
    });
    view.draw_axes(&mut sheet);
    let y = view.area.bottom() + BELOW_FRAME + LINE_HEIGHT;
    for (k, (colour, text)) in [(LINES[1], "fails"), (STANDS, "stands")].into_iter().enumerate() {
        let x = LEFT + 180.0 * k as f64;
        sheet.rect(&Rect { left: x, top: y - 13.0, width: 18.0, height: 16.0 }, Style::fill(colour).edged(INK, 0.9));
        sheet.text([x + 28.0, y], text, TextStyle::new(LABEL_SIZE));
    }
    sheet.finish()
}
