//! Picture of the share of its strength that each block has, in rock that can break.

use super::Picture;
use super::axes::{LABEL_SIZE, Ticks, is_drawable, three_digits};
use super::bar::{BAR_ROOM, draw_bar};
use super::colour::{INK, SLIP, WHITE, scale_step};
use super::sheet::{Path, Style, TextStyle};
use super::stage::{StageEnd, StageSheet};
use enmm::geometry::Point;
use enmm_observe::RockSection;

/// Share of strength from which on the worst section of a block is drawn.
const DRAWN: f64 = 0.5;
/// Shares that are written beside their sections at most.
const LABELS: usize = 12;

/// Draws the share of strength of each block as a colour, the worst sections of blocks near breaking, and the faces of
/// those that have broken, two each.
pub fn strength_picture(stage: &StageEnd, sections: &[RockSection], broken: &[[Point; 2]]) -> Picture {
    let mut sheet = StageSheet::new(stage, BAR_ROOM, "share of strength of the worst section of each block");
    let share = |k: usize| stage.snapshot.strength_share.get(k).copied().unwrap_or_default();
    sheet.fill(|k| scale_step(share(k)));
    sheet.draw_outlines();
    let view = sheet.view;
    let drawable = sections.iter().filter(|section| section.ends.iter().all(is_drawable));
    let mut near: Vec<&RockSection> = drawable.collect();
    near.sort_by(|a, b| b.share.total_cmp(&a.share).then(a.block.cmp(&b.block)));
    let worst = near.first().map(|section| (section.block, section.share));
    near.retain(|section| section.share >= DRAWN);
    let mut lines = Path::default();
    near.iter().for_each(|section| lines.line(section.ends.map(|end| view.pixel(&end))));
    let mut faces = Path::default();
    let drawn = broken.iter().filter(|ends| ends.iter().all(is_drawable));
    drawn.for_each(|ends| faces.line(ends.map(|end| view.pixel(&end))));
    sheet.sheet.clipped(&view.area, |sheet| {
        sheet.path(faces, Style::line(SLIP, 4.0));
        sheet.path(lines.clone(), Style::line(WHITE, 5.0));
        sheet.path(lines, Style::line(INK, 2.4));
        for section in near.iter().take(LABELS) {
            let [x, y] = view.pixel(&((section.ends[0] + section.ends[1]) * 0.5));
            sheet.text([x + 8.0, y], &format!("{:.2}", section.share), TextStyle::new(LABEL_SIZE).halo());
        }
    });
    sheet.decorate();
    let ticks = Ticks::new(0.0, 1.0, 10.0);
    let ticks: Vec<_> = ticks.values.iter().map(|&value| (value, ticks.label(value))).collect();
    draw_bar(&mut sheet.sheet, &view.area, "share of strength", &ticks);
    let most = worst.map_or_else(
        || "no section near its strength".to_owned(),
        |(block, share)| format!("block {block} has the greatest, {}", three_digits(share)),
    );
    let faces = if broken.is_empty() { "" } else { "; orange: faces of sections that have broken" };
    sheet.close(&format!("{most}; at 1 a block breaks; black: worst sections from 0.5 on{faces}"))
}
