//! Pictures of a strength reduction: trials against F, and the slope with the blocks that fail.

use super::Picture;
use super::annotations::{bolt_marks, counted};
use super::axes::{Bounds, LABEL_SIZE, Ticks, View, draw_level, draw_upright, is_drawable, number_text, three_digits};
use super::colour::{ACCENT, Colour, GREY, INK, LINES, PALE, WHITE};
use super::displacement::draw_length;
use super::model::{draw_tensions, draw_water};
use super::sheet::{Anchor, Path, Pixel, Rect, Sheet, Style, TextStyle, text_width};
use super::signs::{draw_bolt, push_arrow};
use super::slope::{
    BELOW_FRAME, LEFT, LINE_HEIGHT, MARGIN, TOP, WIDTH, draw_absence, draw_block_outlines, draw_filled, draw_title,
};
use enmm::geometry::Vector;
use enmm_observe::{Snapshot, water_surface};
use enmm_stability::limit_analysis::Factor;
use enmm_stability::strength_reduction::{FailingBlock, Reduction, Trial, Verdict};

/// Height (px) of the frame of the trials.
const FRAME: f64 = 560.0;
/// Room (px) above the frame of the trials for the names of its lines.
const NAMES: f64 = 72.0;
/// Height (px) of the picture of the slope at most.
const HEIGHT_MAX: f64 = 820.0;
/// Rock that stands.
const STANDS: Colour = Colour(226, 232, 236);
/// Rock that fails.
const FAILS: Colour = Colour(214, 110, 72);
/// Decades below the largest value that a frame shows at most.
const DECADES_MAX: f64 = 12.0;
/// A bound farther from the trials than this, relative to the greatest of them, is named but not drawn.
const BOUND_FAR: f64 = 1.5;
/// Length (px) of the arrow of the block that moves farthest, and of the shortest.
const ARROWS: [f64; 2] = [70.0, 10.0];

/// Draws the largest displacement of each trial against F, with the bracket and the bound of limit analysis.
pub fn trials_picture(title: &str, reduction: &Reduction) -> Picture {
    let mut sheet = Sheet::new(WIDTH, TOP + NAMES + FRAME + BELOW_FRAME + LINE_HEIGHT + MARGIN);
    draw_title(&mut sheet, title, &caption(reduction));
    let frame = Rect { left: LEFT, top: TOP + NAMES, width: WIDTH - LEFT - MARGIN, height: FRAME };
    Chart::new(frame, reduction).draw(&mut sheet, reduction);
    let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY);
    sheet.text([0.5 * WIDTH, frame.bottom() + 45.0], "F, by which the strength is divided", style);
    draw_legend(&mut sheet, reduction, frame.bottom() + BELOW_FRAME + LINE_HEIGHT);
    sheet.finish()
}

/// Factors of limit analysis with their names.
fn bounds(reduction: &Reduction) -> Vec<(&'static str, Factor)> {
    match (&reduction.bracket, &reduction.bound) {
        (Some(bracket), _) => vec![("lower bound", bracket.lower), ("upper bound", bracket.upper)],
        (None, Ok(bound)) => vec![("upper bound", bound.level_tops.factor)],
        (None, Err(_)) => Vec::new(),
    }
}

/// A factor of limit analysis in three digits, and on which side of it the factor lies.
fn factor_text(factor: Factor) -> String {
    match factor {
        Factor::Found(factor) => three_digits(factor),
        Factor::AtLeast(least) => format!("at least {}", three_digits(least)),
        Factor::AtMost(most) => format!("at most {}", three_digits(most)),
    }
}

fn caption(reduction: &Reduction) -> String {
    let bounds: String =
        bounds(reduction).into_iter().map(|(name, factor)| format!("; {name} {}", factor_text(factor))).collect();
    match (reduction.factor(), reduction.low, reduction.high) {
        (_, Some(low), _) if reduction.at_most().is_some() => {
            format!("factor of safety at most the upper bound: trials were stable up to {low:.4}{bounds}")
        }
        (Some(factor), Some(low), Some(high)) => {
            format!("factor of safety F = {}: stable at {low:.4}, not at {high:.4}{bounds}", three_digits(factor))
        }
        (_, low, high) => {
            let text = |f: Option<f64>| f.map_or("none".to_owned(), |f| format!("{f:.4}"));
            format!("no factor of safety; greatest stable F {}, least other F {}{bounds}", text(low), text(high))
        }
    }
}

/// Draws the shape of a verdict: stable is a disc.
fn draw_verdict(sheet: &mut Sheet, verdict: Verdict, at: Pixel) {
    let (corners, fill, edge) = match verdict {
        Verdict::Stable => (0, LINES[2], LINES[2]),
        Verdict::Caught => (3, WHITE, LINES[1]),
        Verdict::Unstable => (4, ACCENT, ACCENT),
    };
    draw_shape(sheet, at, corners, 8.5, Style::fill(fill).edged(edge, 2.0));
}

fn draw_legend(sheet: &mut Sheet, reduction: &Reduction, y: f64) {
    let verdicts = [
        (Verdict::Stable, "stable: comes to rest"),
        (Verdict::Caught, "caught: slides, then rests"),
        (Verdict::Unstable, "unstable: goes on moving"),
    ];
    let there = |verdict: Verdict| reduction.trials.iter().any(|trial| trial.verdict == verdict);
    let mut x = LEFT;
    for (verdict, text) in verdicts.into_iter().filter(|(verdict, _)| there(*verdict)) {
        draw_verdict(sheet, verdict, [x + 9.0, y - 5.0]);
        sheet.text([x + 28.0, y], text, TextStyle::new(LABEL_SIZE));
        x += text_width(text, LABEL_SIZE) + 76.0;
    }
    let bracket = Rect { left: x, top: y - 13.0, width: 18.0, height: 16.0 };
    sheet.rect(&bracket, Style::fill(PALE).edged(GREY, 0.9));
    sheet.text([x + 28.0, y], "F lies here", TextStyle::new(LABEL_SIZE));
}

/// A frame with F along it and a logarithm of the displacement up it.
struct Chart {
    frame: Rect,
    factors: [f64; 2],
    decades: [f64; 2],
}

impl Chart {
    fn new(frame: Rect, reduction: &Reduction) -> Self {
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        };
        let all = || reduction.trials.iter().chain(reduction.lost.iter().flat_map(|lost| &lost.trials));
        let tried = range(&mut all().map(|t| t.factor));
        let near = |factor: &f64| *factor <= BOUND_FAR * tried[1] && *factor >= tried[0] / BOUND_FAR;
        let bounds = bounds(reduction).into_iter().map(|(_, factor)| factor.value()).filter(near);
        let [low, high] = range(&mut tried.into_iter().chain(bounds));
        let margin = 0.05 * (high - low).max(0.02 * high);
        let displacements = &mut all().map(|t| t.displacement);
        let [least, most] = range(&mut displacements.filter(|v| *v > 0.0 && v.is_finite()));
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

    fn draw(&self, sheet: &mut Sheet, reduction: &Reduction) {
        if let (Some(low), Some(high)) = (reduction.low, reduction.high) {
            let (left, right) = (self.x(low), self.x(high));
            sheet.rect(&Rect { left, width: (right - left).max(2.0), ..self.frame }, Style::fill(PALE));
        }
        self.draw_ticks(sheet);
        let drawable = || reduction.trials.iter().filter(|trial| trial.displacement.is_finite());
        let position = |trial: &Trial| -> Pixel { [self.x(trial.factor), self.y(trial.displacement)] };
        sheet.path(Path::open(drawable().map(position)), Style::line(GREY, 1.4));
        if let Some(lost) = &reduction.lost {
            let line = lost.trials.iter().filter(|trial| trial.displacement.is_finite()).map(position);
            sheet.path(Path::open(line), Style::line(GREY, 1.4).dashed());
            lost.trials.iter().for_each(|trial| draw_verdict(sheet, trial.verdict, position(trial)));
        }
        self.draw_factors(sheet, reduction);
        drawable().for_each(|trial| draw_verdict(sheet, trial.verdict, position(trial)));
        sheet.rect(&self.frame, Style::line(INK, 1.2));
        let style = TextStyle::new(LABEL_SIZE).anchor(Anchor::Middle).colour(GREY).upward();
        let middle = self.frame.top + 0.5 * self.frame.height;
        sheet.text([LEFT - 76.0, middle], "largest displacement [mm]", style);
    }

    /// Upright lines at F and at the factors of limit analysis that the frame shows, with their names above it.
    fn draw_factors(&self, sheet: &mut Sheet, reduction: &Reduction) {
        let [low, high] = self.factors;
        let found = reduction.factor().map(|factor| ("F", factor, three_digits(factor), Style::line(INK, 2.4)));
        let dashed = Style::line(LINES[0], 2.4).dashed();
        let bounds =
            bounds(reduction).into_iter().map(|(name, factor)| (name, factor.value(), factor_text(factor), dashed));
        let mut taken: Vec<Rect> = Vec::new();
        for (name, factor, text, style) in found.into_iter().chain(bounds) {
            if !(low..=high).contains(&factor) {
                continue;
            }
            let x = self.x(factor);
            sheet.line([x, self.frame.top], [x, self.frame.bottom()], style);
            let label = if name == "F" { format!("F = {text}") } else { format!("{name} {text}") };
            let width = text_width(&label, LABEL_SIZE);
            let left = (x - 0.5 * width).clamp(self.frame.left, self.frame.right() - width);
            let place = |row: f64| Rect { left, top: self.frame.top - 24.0 - 20.0 * row, width, height: 18.0 };
            let row = (0..3).map(f64::from).find(|row| !taken.iter().any(|r| r.grown(6.0).overlaps(&place(*row))));
            let rect = place(row.unwrap_or_default());
            sheet.text([rect.left, rect.top + 16.0], &label, TextStyle::new(LABEL_SIZE).halo());
            taken.push(rect);
        }
    }

    fn draw_ticks(&self, sheet: &mut Sheet) {
        let ticks = Ticks::new(self.factors[0], self.factors[1], 10.0);
        for &factor in &ticks.values {
            draw_upright(sheet, &self.frame, self.x(factor), &ticks.label(factor), 4.0);
        }
        for decade in self.decades[0].ceil() as i32..=self.decades[1].floor() as i32 {
            let y = self.y(10f64.powi(decade));
            draw_level(sheet, &self.frame, y, &number_text(1e3 * 10f64.powi(decade)));
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

/// Draws the slope at the end of the least unstable trial, with the blocks that fail, how they move, bolts and water;
/// at rest when there was none.
pub fn failure_picture(title: &str, reduction: &Reduction) -> Picture {
    let simulation = &reduction.simulation;
    let snapshot = Snapshot::of(simulation);
    let trial = reduction.first_unstable();
    let failing: &[FailingBlock] = trial.map_or(&[], |trial| &trial.failing);
    let mut fails = vec![false; simulation.model().covers.block_count()];
    failing.iter().for_each(|block| fails[block.block as usize] = true);
    let area = Rect { left: LEFT, top: TOP, width: WIDTH - LEFT - MARGIN, height: HEIGHT_MAX };
    let view = View::fit(Bounds::of(&snapshot.elements.points), area);
    let mut sheet = Sheet::new(WIDTH, view.area.bottom() + BELOW_FRAME + 2.0 * LINE_HEIGHT + MARGIN);
    draw_title(&mut sheet, title, &failure_caption(reduction));
    let water = water_surface(simulation);
    sheet.clipped(&view.area, |sheet| {
        let of_element = |k: usize| snapshot.block.get(k).is_some_and(|&b| fails[b as usize]);
        draw_filled(sheet, &snapshot.elements, &view, &[STANDS, FAILS], |k| usize::from(of_element(k)));
        draw_block_outlines(sheet, &snapshot, &view);
        draw_absence(sheet, &view, &snapshot.elements);
        draw_water(sheet, &view, &water);
        draw_motion(sheet, &view, &snapshot, failing);
    });
    let has_bolts = draw_tensions(&mut sheet, &view, &bolt_marks(simulation));
    view.draw_axes(&mut sheet);
    let y = view.area.bottom() + BELOW_FRAME + LINE_HEIGHT;
    draw_failure_legend(&mut sheet, &view, y, [!failing.is_empty(), has_bolts]);
    sheet.finish()
}

/// F, the blocks that fail and how much rock they are.
fn failure_caption(reduction: &Reduction) -> String {
    let Some(trial) = reduction.first_unstable() else { return "no trial failed".to_owned() };
    let factor = match reduction.factor() {
        Some(factor) => format!("F = {}: ", three_digits(factor)),
        None => format!("at F = {}: ", three_digits(trial.factor)),
    };
    format!(
        "{factor}{} {}, {} m², {} t/m, {} % of the free rock",
        counted(trial.failing.len(), "block"),
        verb(trial),
        three_digits(trial.failing_area()),
        three_digits(1e-3 * trial.failing_mass()),
        three_digits(100.0 * trial.failing_area() / reduction.free_area)
    )
}

/// An arrow at each block that fails along its displacement; their lengths are to each other as the displacements.
fn draw_motion(sheet: &mut Sheet, view: &View, snapshot: &Snapshot, failing: &[FailingBlock]) {
    let farthest = failing.iter().map(|block| block.displacement).fold(0.0, f64::max);
    let mut arrows = Path::default();
    for block in failing.iter().filter(|block| block.displacement > 0.0) {
        let own = (0..snapshot.elements.len()).filter(|&k| snapshot.block.get(k) == Some(&block.block));
        let points = own
            .flat_map(|k| snapshot.elements.range(k))
            .filter_map(|i| Some((*snapshot.elements.points.get(i)?, *snapshot.displacement.get(i)?)));
        let points: Vec<_> = points.filter(|(place, moved)| is_drawable(place) && is_drawable(moved)).collect();
        let moved = points.iter().map(|(_, moved)| moved).sum::<Vector>();
        if moved.norm() > 0.0 {
            let centre = points.iter().map(|(place, _)| place).sum::<Vector>() / points.len() as f64;
            let length = (ARROWS[0] * block.displacement / farthest).max(ARROWS[1]);
            let way = moved * (length / moved.norm());
            let [x, y] = view.pixel(&centre);
            push_arrow(&mut arrows, [x - 0.5 * way.x, y + 0.5 * way.y], [x + 0.5 * way.x, y - 0.5 * way.y], 11.0);
        }
    }
    sheet.path(arrows.clone(), Style::line(WHITE, 5.0).opacity(0.9));
    sheet.path(arrows, Style::line(INK, 2.2));
}

fn draw_failure_legend(sheet: &mut Sheet, view: &View, y: f64, [fails, bolts]: [bool; 2]) {
    let mut x = draw_length(sheet, view, y);
    let style = TextStyle::new(LABEL_SIZE);
    let rocks = [(FAILS, "fails", fails), (STANDS, "stands", true)];
    for (colour, text, _) in rocks.into_iter().filter(|(.., there)| *there) {
        sheet.rect(&Rect { left: x, top: y - 13.0, width: 18.0, height: 16.0 }, Style::fill(colour).edged(INK, 0.9));
        sheet.text([x + 28.0, y], text, style);
        x += text_width(text, LABEL_SIZE) + 60.0;
    }
    if fails {
        let mut arrow = Path::default();
        push_arrow(&mut arrow, [x, y - 5.0], [x + 34.0, y - 5.0], 11.0);
        sheet.path(arrow, Style::line(INK, 2.2));
        sheet.text([x + 44.0, y], "displacement of a block, not to scale", style);
        x += text_width("displacement of a block, not to scale", LABEL_SIZE) + 76.0;
    }
    if bolts {
        draw_bolt(sheet, [[x, y - 5.0], [x + 34.0, y - 5.0]], Style::line(ACCENT, 2.6));
        sheet.text([x + 44.0, y], "bolt with its tension per metre of slope", style);
    }
}

/// Draws an equal-sided shape on a corner, or a disc without corners, of a radius (px) about `centre`.
fn draw_shape(sheet: &mut Sheet, centre: Pixel, corners: usize, radius: f64, style: Style) {
    if corners == 0 {
        sheet.circle(centre, radius, style);
        return;
    }
    let corner = |k: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / corners as f64);
        [centre[0] + radius * sin, centre[1] - radius * cos]
    };
    sheet.path(Path::closed((0..corners).map(corner)), style);
}
