//! Picture of water that flows in joints: pressure heads, flows, water tables, outcrops that seep, drains.

use std::collections::BTreeSet;

use super::Picture;
use super::axes::{LABEL_SIZE, Ticks, View, is_drawable, three_digits};
use super::bar::{BAR_ROOM, draw_bar};
use super::colour::{Colour, GREY, INK, LINES, SCALE_STEPS, WATER, WHITE, scale, scale_step};
use super::legend::{Entry, Legend, Sign};
use super::sheet::{Path, Pixel, Rect, Sheet, Style, TextStyle};
use super::signs::{draw_seep, push_arrow};
use super::slope::Labels;
use super::stage::{StageEnd, StageSheet, quantile};
use enmm::geometry::Point;
use enmm_observe::{FlowLine, WaterInJoints};

/// Width (px) of joints in which little flows, and of those of the greatest flow.
const WIDTHS: [f64; 4] = [1.8, 3.0, 4.4, 6.0];
/// Flows of these widths, the widest first.
const SHARES: [&str; 4] = ["at least a tenth of it", "at least a hundredth", "at least a thousandth", "less"];
/// Width (px) of dry joints.
const DRY_WIDTH: f64 = 1.4;
/// Share of the pieces that have an arrow.
const ARROWS: f64 = 0.1;
/// Length of an arrow, and distance of two at least (px).
const ARROW: [f64; 2] = [20.0, 30.0];
/// Half of the length of the tick at a water table (px).
const TICK: f64 = 7.0;
/// Distance of two ticks at least (px).
const TICKS_APART: f64 = 5.0;
/// Ink of drains.
const DRAIN: Colour = LINES[2];
/// Litres per minute in a m³/s.
const LITRES_PER_MINUTE: f64 = 6e4;

/// A flow (m²/s) in words.
fn litres(flow: f64) -> String {
    format!("{} L/min per m", three_digits(flow * LITRES_PER_MINUTE))
}

/// Draws the water that flows in joints at the end of a stage.
pub fn flow_picture(stage: &StageEnd, flow: &WaterInJoints) -> Picture {
    let mut sheet = StageSheet::new(stage, BAR_ROOM, "pressure head of the water in joints, and its flow");
    sheet.draw_rock();
    let view = sheet.view;
    let drawable = |line: &&FlowLine| line.ends.iter().all(is_drawable);
    let lines: Vec<&FlowLine> = flow.lines.iter().filter(drawable).collect();
    let deepest = lines.iter().flat_map(|line| line.pressure_heads()).fold(0.0, f64::max);
    let greatest = lines.iter().map(|line| line.flow.abs()).fold(0.0, f64::max);
    sheet.sheet.clipped(&view.area, |sheet| {
        draw_lines(sheet, &view, &lines, deepest, greatest);
        draw_tables(sheet, &view, &lines);
        draw_arrows(sheet, &view, &lines);
        draw_drains(sheet, &view, flow);
        for seep in flow.seeps.iter().filter(|seep| is_drawable(&seep.place)) {
            draw_seep(sheet, view.pixel(&seep.place));
        }
    });
    sheet.decorate();
    label_drains(&mut sheet.sheet, &view, flow);
    let ticks = Ticks::new(0.0, deepest, 10.0);
    let ticks: Vec<_> = ticks.values.iter().map(|&value| (value / deepest, ticks.label(value))).collect();
    draw_bar(&mut sheet.sheet, &view.area, "pressure head [m]", &ticks);
    sheet.close_with(&legends(flow, greatest))
}

/// The class of the width of a flow by its decade below the greatest.
fn class(flow: f64, greatest: f64) -> usize {
    let decades = if flow > 0.0 && greatest > 0.0 { -libm::log10(flow / greatest) } else { f64::INFINITY };
    WIDTHS.len() - 1 - (decades.max(0.0) as usize).min(WIDTHS.len() - 1)
}

/// Joints: the wet part of each in the colours of its pressure heads, the rest grey.
fn draw_lines(sheet: &mut Sheet, view: &View, lines: &[&FlowLine], deepest: f64, greatest: f64) {
    let mut dry = Path::default();
    let mut wet = vec![vec![Path::default(); SCALE_STEPS]; WIDTHS.len()];
    for line in lines {
        let at = |share: f64| view.pixel(&(line.ends[0] + (line.ends[1] - line.ends[0]) * share));
        dry.line([at(0.0), at(1.0)]);
        if line.is_dry() {
            continue;
        }
        let [from, to] = line.wet;
        let heads = line.pressure_heads();
        // A part ends without pressure where the water table lies in the piece.
        let heads = [if from > 0.0 { 0.0 } else { heads[0] }, if to < 1.0 { 0.0 } else { heads[1] }];
        let fraction = |head: f64| if deepest > 0.0 { head / deepest } else { 0.0 };
        let steps = (fraction((heads[1] - heads[0]).abs()) * SCALE_STEPS as f64).ceil().max(1.0);
        for k in 0..steps as usize {
            let [a, b] = [k, k + 1].map(|k| k as f64 / steps);
            let head = heads[0] + (heads[1] - heads[0]) * 0.5 * (a + b);
            let path = &mut wet[class(line.flow.abs(), greatest)][scale_step(fraction(head))];
            path.line([a, b].map(|share| at(from + (to - from) * share)));
        }
    }
    sheet.path(dry, Style::line(GREY, DRY_WIDTH));
    for (paths, width) in wet.into_iter().zip(WIDTHS) {
        for (step, path) in paths.into_iter().enumerate() {
            sheet.path(path, Style::line(scale(step), width));
        }
    }
}

/// Level ticks where the water tables lie.
fn draw_tables(sheet: &mut Sheet, view: &View, lines: &[&FlowLine]) {
    let mut taken = BTreeSet::new();
    let mut path = Path::default();
    for [x, y] in lines.iter().filter_map(|line| line.table()).map(|place| view.pixel(&place)) {
        if taken.insert(cell([x, y], TICKS_APART)) {
            path.line([[x - TICK, y], [x + TICK, y]]);
        }
    }
    sheet.path(path.clone(), Style::line(WHITE, 5.0));
    sheet.path(path, Style::line(WATER, 2.6));
}

fn cell(place: Pixel, size: f64) -> [i64; 2] {
    place.map(|part| (part / size).floor() as i64)
}

/// Arrows along the pieces of the greatest flows.
fn draw_arrows(sheet: &mut Sheet, view: &View, lines: &[&FlowLine]) {
    let flows: Vec<f64> = lines.iter().map(|line| line.flow.abs()).filter(|flow| *flow > 0.0).collect();
    let least = quantile(&flows, 1.0 - ARROWS);
    let mut most: Vec<&&FlowLine> = lines.iter().filter(|line| line.flow != 0.0 && line.flow.abs() >= least).collect();
    most.sort_by(|a, b| b.flow.abs().total_cmp(&a.flow.abs()));
    let mut taken = BTreeSet::new();
    let mut path = Path::default();
    for line in most {
        let [a, b] = if line.flow > 0.0 { line.ends } else { [line.ends[1], line.ends[0]] };
        let (along, middle) = (b - a, view.pixel(&((a + b) * 0.5)));
        let long = along.norm();
        if long > 0.0 && taken.insert(cell(middle, ARROW[1])) {
            let half = [0.5 * ARROW[0] * along.x / long, -0.5 * ARROW[0] * along.y / long];
            let [from, to] = [-1.0, 1.0].map(|sign| [middle[0] + sign * half[0], middle[1] + sign * half[1]]);
            push_arrow(&mut path, from, to, 9.0);
        }
    }
    sheet.path(path.clone(), Style::line(WHITE, 5.0).opacity(0.85));
    sheet.path(path, Style::line(INK, 2.0));
}

fn draw_drains(sheet: &mut Sheet, view: &View, flow: &WaterInJoints) {
    for drain in flow.drains.iter().filter(|drain| drain.points.iter().all(is_drawable)) {
        let line = || Path::open(drain.points.iter().map(|point| view.pixel(point)));
        sheet.path(line(), Style::line(WHITE, 6.0));
        sheet.path(line(), Style::line(DRAIN, 3.0));
        if let Some(mouth) = drain.points.first() {
            sheet.circle(view.pixel(mouth), 5.0, Style::fill(WHITE).edged(DRAIN, 2.4));
        }
    }
}

/// Name and flow beside the mouth of each drain.
fn label_drains(sheet: &mut Sheet, view: &View, flow: &WaterInJoints) {
    let mut labels = Labels::new(view.area);
    for drain in flow.drains.iter().filter(|drain| drain.points.iter().all(is_drawable)) {
        let Some(mouth) = drain.points.first().map(|point: &Point| view.pixel(point)) else { continue };
        for point in &drain.points {
            let [left, top] = view.pixel(point);
            labels.avoid(Rect { left, top, width: 0.0, height: 0.0 }.grown(9.0));
        }
        let text = format!("{} {}", drain.name, litres(drain.flow));
        if let Some(position) = labels.position(mouth, &text) {
            sheet.text(position, &text, TextStyle::new(LABEL_SIZE).halo());
        }
    }
}

fn legends(flow: &WaterInJoints, greatest: f64) -> Vec<Legend> {
    let length = |dry: bool| {
        let these = flow.lines.iter().filter(|line| line.is_dry() == dry);
        these.map(|line| (line.ends[1] - line.ends[0]).norm()).fold(0.0, |sum, length| sum + length)
    };
    let joint = |sign, name: &str, dry| Entry::new(sign, format!("{name}: {} m", three_digits(length(dry))));
    let joints = vec![
        joint(Sign::Line(scale(SCALE_STEPS / 2), WIDTHS[2]), "under pressure", false),
        joint(Sign::Line(GREY, DRY_WIDTH), "without pressure", true),
    ];
    let mut flows = vec![Entry::new(Sign::None, format!("greatest {}", litres(greatest)))];
    if greatest > 0.0 {
        let width = |(k, share): (usize, &str)| {
            Entry::new(Sign::Line(scale(SCALE_STEPS / 2), WIDTHS[WIDTHS.len() - 1 - k]), share)
        };
        flows.extend(SHARES.into_iter().enumerate().map(width));
    }
    let all = [
        (lines_have_arrows(flow), Sign::Arrow(INK), "the tenth in which most flows".to_owned()),
        (flow.lines.iter().any(|line| line.table().is_some()), Sign::Tick(WATER), "water table".to_owned()),
        (!flow.seeps.is_empty(), Sign::Seep, format!("seeping outcrop, all {}", litres(seepage(flow)))),
        (!flow.drains.is_empty(), Sign::Line(DRAIN, 3.0), "drain with its flow".to_owned()),
    ];
    let marks: Vec<Entry> =
        all.into_iter().filter(|(there, ..)| *there).map(|(_, sign, text)| Entry::new(sign, text)).collect();
    let titled = [("Joints that conduct, length", joints), ("Flow", flows), ("Marks", marks)];
    let legends = titled.into_iter().map(|(title, entries)| Legend { title, entries });
    legends.filter(|legend| !legend.entries.is_empty()).collect()
}

fn lines_have_arrows(flow: &WaterInJoints) -> bool {
    flow.lines.iter().any(|line| line.flow != 0.0)
}

fn seepage(flow: &WaterInJoints) -> f64 {
    flow.seeps.iter().fold(0.0, |sum, seep| sum + seep.flow)
}
