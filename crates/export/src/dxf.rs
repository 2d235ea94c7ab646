//! A drawing of a slope: ASCII DXF of release 12, which every program for drawings reads, in metres.
//!
//! | layer | entities |
//! |---|---|
//! | `rock_NAME` | loops of the blocks of a rock, closed polylines |
//! | `outline` | free faces, which no joint makes, polylines: those of all blocks are the outline |
//! | `island`, `hole` | loops of blocks that are free all round, beside the outline and within blocks |
//! | `joint_LAW` | pieces of joints, lines |
//! | `touch_LAW` | boundaries that another block has come to touch |
//! | `bolts`, `supports`, `water`, `flow` | lines, points, a polyline, and joints in which water flows |
//! | `displacement` | arrows at the blocks, enlarged as a text beside them says |
//!
//! A case takes the slope back by its layers `outline`, `island`, `hole` and `joint_LAW`, and by a
//! `domain.snap_tolerance` above the openings of its joints.

use crate::scene::{Block, Scene};

/// Largest arrow over the size of the slope, and its head over its length.
const ARROW: f64 = 0.05;
const HEAD: f64 = 0.25;
/// Height of the text over the size of the slope.
const TEXT: f64 = 0.012;
/// Most letters of the name of a layer in release 12.
const NAME_MAX: usize = 31;

/// The drawing of a slope.
pub fn drawing(scene: &Scene) -> String {
    let mut drawing = Drawing::default();
    drawing.blocks(scene);
    drawing.joints(scene);
    for bolt in &scene.bolts {
        drawing.line("bolts", bolt.ends);
    }
    for support in &scene.supports {
        let layer = drawing.layer("supports");
        drawing.put(&[(0, "POINT"), (8, &layer)]);
        drawing.place(support.place, 0);
    }
    let water = scene.water_line();
    if !water.is_empty() {
        drawing.polyline("water", &water, false);
    }
    for ends in &scene.flow.ends {
        drawing.line("flow", *ends);
    }
    drawing.arrows(scene);
    drawing.finish()
}

/// Entities so far, and the layers that they are on: names of the slope with those of the file.
#[derive(Default)]
struct Drawing {
    entities: String,
    layers: Vec<(String, String)>,
}

impl Drawing {
    fn blocks(&mut self, scene: &Scene) {
        let alone = scene.blocks.len() == 1;
        for block in &scene.blocks {
            let rock = format!("rock_{}", block.rock);
            block.loops.iter().for_each(|points| self.polyline(&rock, points, true));
            for face in &block.free {
                let layer = match face.loop_of {
                    Some(0) if alone => "outline",
                    Some(0) => "island",
                    Some(_) => "hole",
                    None => "outline",
                };
                self.polyline(layer, &face.points, face.loop_of.is_some());
            }
        }
    }

    fn joints(&mut self, scene: &Scene) {
        for (k, ends) in scene.joints.ends.iter().enumerate() {
            let law = scene.joints.name("law", k).unwrap_or_default();
            let kind = if scene.joints.number("is_joint", k) == Some(0.0) { "touch" } else { "joint" };
            self.line(&format!("{kind}_{law}"), *ends);
        }
    }

    /// Arrows of the displacements of the blocks, with their scale.
    fn arrows(&mut self, scene: &Scene) {
        let Some([low, high]) = scene.bounds() else { return };
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        let displacement =
            |block: &Block| Some([scene.number(block, "displacement_x")?, scene.number(block, "displacement_y")?]);
        let moves: Vec<([f64; 2], [f64; 2])> =
            scene.blocks.iter().filter_map(|block| Some((block.outline.centroid, displacement(block)?))).collect();
        let most = moves.iter().map(|(_, by)| libm::hypot(by[0], by[1])).fold(0.0, f64::max);
        if most == 0.0 {
            return;
        }
        let scale = round_below(ARROW * size / most).max(1.0);
        for (centroid, by) in moves.into_iter().filter(|(_, by)| by[0] != 0.0 || by[1] != 0.0) {
            let from = [0, 1].map(|axis| centroid[axis] + by[axis]);
            let to = [0, 1].map(|axis| from[axis] + scale * by[axis]);
            self.line("displacement", [from, to]);
            for side in [-0.5, 0.5] {
                let back = [by[0] + side * by[1], by[1] - side * by[0]];
                self.line("displacement", [to, [0, 1].map(|axis| to[axis] - HEAD * scale * back[axis])]);
            }
        }
        let text = format!("displacement x {scale}, largest {most:.3e} m");
        let layer = self.layer("displacement");
        self.put(&[(0, "TEXT"), (8, &layer)]);
        self.place([low[0], low[1] - 3.0 * TEXT * size], 0);
        self.put(&[(40, &(TEXT * size).to_string()), (1, &text)]);
    }

    /// Name of a layer in the file: letters, digits, `-`, `_` and `$`, at most 31, of which no two are alike.
    fn layer(&mut self, name: &str) -> String {
        if let Some((_, known)) = self.layers.iter().find(|(of, _)| of == name) {
            return known.clone();
        }
        let sign = |c: char| if c.is_ascii_alphanumeric() || "-_$".contains(c) { c } else { '_' };
        let clean: String = name.chars().map(sign).collect();
        let number = |k: usize| if k == 1 { String::new() } else { format!("_{k}") };
        let of = |k: usize| clean.chars().take(NAME_MAX - number(k).len()).collect::<String>() + &number(k);
        let is_free = |name: &String| !self.layers.iter().any(|(_, known)| known.eq_ignore_ascii_case(name));
        let found = (1..).map(of).find(is_free).unwrap_or_default();
        self.layers.push((name.to_owned(), found.clone()));
        found
    }

    /// Appends groups: a code and a value each.
    fn put(&mut self, groups: &[(u32, &str)]) {
        groups.iter().for_each(|(code, value)| self.entities.push_str(&format!("{code:>3}\n{value}\n")));
    }

    /// Appends a place (m), the first or the second of an entity.
    fn place(&mut self, at: [f64; 2], second: u32) {
        let [x, y] = at.map(|value| format!("{value:?}"));
        self.put(&[(10 + second, &x), (20 + second, &y), (30 + second, "0.0")]);
    }

    fn line(&mut self, layer: &str, [from, to]: [[f64; 2]; 2]) {
        let layer = self.layer(layer);
        self.put(&[(0, "LINE"), (8, &layer)]);
        self.place(from, 0);
        self.place(to, 1);
    }

    fn polyline(&mut self, layer: &str, points: &[[f64; 2]], closed: bool) {
        let layer = self.layer(layer);
        self.put(&[(0, "POLYLINE"), (8, &layer), (66, "1")]);
        self.place([0.0; 2], 0);
        self.put(&[(70, if closed { "1" } else { "0" })]);
        for point in points {
            self.put(&[(0, "VERTEX"), (8, &layer)]);
            self.place(*point, 0);
        }
        self.put(&[(0, "SEQEND"), (8, &layer)]);
    }

    /// The file, with the table of its layers, each in a colour of its own.
    fn finish(self) -> String {
        let Self { entities, layers } = self;
        let mut head = Self::default();
        head.put(&[(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (0, "ENDSEC")]);
        head.put(&[(0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LTYPE"), (70, "1")]);
        head.put(&[(0, "LTYPE"), (2, "CONTINUOUS"), (70, "64"), (3, "Solid line"), (72, "65"), (73, "0"), (40, "0.0")]);
        head.put(&[(0, "ENDTAB"), (0, "TABLE"), (2, "LAYER"), (70, &layers.len().to_string())]);
        for (k, (_, name)) in layers.iter().enumerate() {
            let colour = (k % 7 + 1).to_string();
            head.put(&[(0, "LAYER"), (2, name), (70, "0"), (62, &colour), (6, "CONTINUOUS")]);
        }
        head.put(&[(0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")]);
        head.entities.push_str(&entities);
        head.put(&[(0, "ENDSEC"), (0, "EOF")]);
        head.entities
    }
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above a number.
fn round_below(number: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(number)));
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= number);
    digit.unwrap_or(1.0) * power
}
