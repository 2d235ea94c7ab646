//! The case for a geometry file: its text, and the report of what was read, assumed and left open.

use std::fmt::Write;
use std::path::Path;

use enmm::model::case::plausible;
use enmm::model::case::text::{is_hidden, shortened, visible};
use enmm_io::{DEFAULT_LAW, LayerSurvey, Survey};

use super::layers::{Mapped, mapped, outline};

/// Mesh sizes over the height of the rock, before rounding.
const TRIANGLES_PER_HEIGHT: f64 = 25.0;
/// Share of the height within which an edge counts as level or upright, and as on the rim.
const STRAIGHT: f64 = 1e-6;

/// Letters of a name in the table of layers.
const SHOWN: usize = 60;

/// A key whose value the drawing does not have.
struct Value {
    key: &'static str,
    example: &'static str,
    meaning: &'static str,
}

const ROCK: [Value; 3] = [
    Value { key: "density", example: "2650", meaning: "kg/m³" },
    Value { key: "young", example: "20e9", meaning: "Pa" },
    Value { key: "poisson", example: "0.25", meaning: "Poisson's ratio" },
];
const LAW: [Value; 1] = [Value { key: "friction_deg", example: "30", meaning: "degrees; add `cohesion` (Pa) if any" }];
const BOLT: [Value; 2] = [
    Value { key: "young", example: "200e9", meaning: "Pa, of the bar" },
    Value { key: "area", example: "4.9e-4", meaning: "m², of one bar" },
];

/// A case to be written.
pub struct Draft<'a> {
    survey: &'a Survey,
    layers: Vec<Mapped<'a>>,
    outline: Option<&'a LayerSurvey>,
    examples: bool,
}

impl<'a> Draft<'a> {
    /// Maps the layers of a drawing; `examples` asks for example values.
    pub fn new(survey: &'a Survey, examples: bool) -> Self {
        Self { survey, layers: mapped(survey), outline: outline(survey), examples }
    }

    /// Text of the case; `drawing` is the path that it names.
    pub fn case(&self, drawing: &str) -> String {
        let mut text = String::from("#:schema case.schema.json\n");
        for (head, lines) in self.findings() {
            lines.iter().for_each(|line| text += &format!("# {head}: {}\n", visible(line)));
        }
        let title = Path::new(drawing).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let _ = write!(text, "title = {}\n\n[domain]\n", quoted(&title));
        let _ = writeln!(text, "geometry_file = {}", quoted(drawing));
        // Joints of a file that is no drawing to which it gives no law.
        let lawless = |layer: &&LayerSurvey| !self.survey.is_drawing && layer.name == DEFAULT_LAW;
        if let Some(layer) = self.survey.layers.iter().find(lawless) {
            let _ = writeln!(text, "joint_law = {}", quoted(&layer.name));
        }
        for mapped in self.layers.iter().filter(|_| self.survey.is_drawing) {
            text += &layer_table(mapped);
        }
        let _ = write!(text, "\n[mesh]\nsize = {}\n", self.mesh_size());
        for (head, values) in self.tables() {
            let bolt = head.strip_prefix("[[bolt]] ").map(|name| format!("[[bolt]]\nname = {name}"));
            text += &self.table(&bolt.unwrap_or(head), values);
        }
        for (edge, axes) in self.fixities() {
            let [[a, b], [c, d]] = edge;
            let _ = write!(text, "\n[[fix]]\nedge = [[{a}, {b}], [{c}, {d}]]\naxes = {axes:?}\n");
        }
        text + "\n[[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration_max = 10\n"
    }

    /// Tables whose values the drawing does not have, each with its head, that of a bolt with its name.
    fn tables(&self) -> Vec<(String, &'static [Value])> {
        let mut tables = vec![("[rock.rock]".to_owned(), &ROCK[..])];
        for mapped in &self.layers {
            let name = mapped.name.as_deref().unwrap_or_default();
            match mapped.role {
                "joint" => tables.push((format!("[joint_law.{}]", key(name)), &LAW)),
                "bolt" => tables.push((format!("[[bolt]] {}", quoted(name)), &BOLT)),
                _ => {}
            }
        }
        tables
    }

    /// Lines to print: layers, assumptions and open points.
    pub fn report(&self, case: &Path) -> String {
        let names: Vec<String> = self.layers.iter().map(|mapped| shortened(&mapped.layer.name, SHOWN)).collect();
        let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(5);
        let mut lines = vec![format!("coordinates are in {}", self.survey.unit)];
        let [[left, right], [low, high]] = self.bounds();
        lines.extend(plausible::odd_size([right - left, high - low]).map(|odd| format!("warning: {odd}")));
        lines.extend(self.survey.notes.iter().map(|note| format!("note: {note}")));
        lines.push(format!("{:<width$}  {:<8}  entities", "layer", "use"));
        for (mapped, name) in self.layers.iter().zip(names) {
            let entities: Vec<String> = mapped.layer.counts.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
            let line = format!("{name:<width$}  {:<8}  {}", mapped.role, entities.join(", "));
            lines.push(line);
        }
        for (head, found) in self.findings() {
            lines.extend(found.iter().map(|line| format!("{head}: {line}")));
        }
        let case = case.display();
        let open = self.findings().into_iter().any(|(head, lines)| head == "open" && !lines.is_empty());
        let first = if open { "fill in what is open" } else { "look at what is assumed" };
        lines.push(format!("{case}: {first}, then: enmm check {case}"));
        lines.join("\n")
    }

    /// Assumptions, example values and open points, each as a line.
    fn findings(&self) -> [(&'static str, Vec<String>); 3] {
        let mut assumed = Vec::new();
        let mut open = Vec::new();
        for mapped in &self.layers {
            let name = &mapped.layer.name;
            assumed.extend(mapped.reason.iter().map(|why| format!("layer {name:?} is {:?}: {why}", mapped.role)));
            open.extend(mapped.open.iter().map(|why| format!("layer {name:?}: {why}")));
        }
        if self.outline.is_none() && !self.survey.is_drawing {
            open.push("the file has no outline: give one in `domain.outline`".to_owned());
        } else if self.outline.is_none() {
            open.push("no layer is the outline: give one `use = \"outline\"`, with one closed line".to_owned());
        }
        assumed.push(format!("mesh.size is {} m, a {TRIANGLES_PER_HEIGHT}th of the height, rounded", self.mesh_size()));
        let fixities = self.fixities();
        assumed.extend(fixities.iter().map(|(edge, axes)| {
            format!("the edge ({}, {}) to ({}, {}) is held in {axes}", edge[0][0], edge[0][1], edge[1][0], edge[1][1])
        }));
        if !fixities.iter().any(|(_, axes)| *axes == "xy") {
            open.push("the outline has no level base: add `[[fix]]` with `edge`".to_owned());
        }
        let of = |(head, values): (String, &[Value])| {
            let keys: Vec<&str> = values.iter().map(|value| value.key).collect();
            format!("{head}: {}", keys.join(", "))
        };
        let mut examples = Vec::new();
        if self.examples { &mut examples } else { &mut open }.extend(self.tables().into_iter().map(of));
        [("assumed", assumed), ("example values", examples), ("open", open)]
    }

    /// A table whose values the drawing does not have.
    fn table(&self, head: &str, values: &[Value]) -> String {
        let mut text = format!("\n{head}\n");
        for Value { key, example, meaning } in values {
            let line = if self.examples {
                format!("{key} = {example}  # EXAMPLE VALUE, put yours ({meaning})\n")
            } else {
                format!("# {key} =  # OPEN ({meaning}), such as {example}\n")
            };
            text += &line;
        }
        text
    }

    fn ring(&self) -> &[[f64; 2]] {
        self.outline.and_then(|layer| layer.loops.first()).map_or(&[], Vec::as_slice)
    }

    /// Least and greatest x and y of the outline, of all lines where there is none.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let of_layers = self.survey.layers.iter().flat_map(|layer| layer.loops.iter().chain(&layer.lines)).flatten();
        let points: Vec<&[f64; 2]> =
            if self.ring().is_empty() { of_layers.collect() } else { self.ring().iter().collect() };
        let axis = |k: usize| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = points.iter().fold(ends, |(low, high), p| (low.min(p[k]), high.max(p[k])));
            if low > high { [0.0, 1.0] } else { [low, high] }
        };
        [axis(0), axis(1)]
    }

    /// A share of the height, as one, two or five times a power of ten.
    fn mesh_size(&self) -> f64 {
        let [_, [low, high]] = self.bounds();
        let wanted = ((high - low) / TRIANGLES_PER_HEIGHT).max(1e-3);
        let power = 10f64.powi(wanted.log10().floor() as i32);
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
        let size = steps.into_iter().rev().find(|step| *step <= wanted * (1.0 + 1e-9)).unwrap_or(power);
        // Powers of ten below 1 are rounded.
        format!("{size:.6}").parse().unwrap_or(size)
    }

    /// Edges to hold: the base, and upright sides.
    fn fixities(&self) -> Vec<([[f64; 2]; 2], &'static str)> {
        let ring = self.ring();
        let [[left, right], [low, high]] = self.bounds();
        let free = STRAIGHT * (high - low).max(right - left);
        let on = |axis: usize, at: f64| {
            let edges = ring.iter().zip(ring.iter().cycle().skip(1));
            let along = edges.filter(|(a, b)| (a[axis] - at).abs() <= free && (b[axis] - at).abs() <= free);
            let ends = along.flat_map(|(a, b)| [a[1 - axis], b[1 - axis]]);
            let range = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
            (range.0 < range.1).then_some([range.0, range.1])
        };
        let base = on(1, low).map(|[a, b]| ([[a, low], [b, low]], "xy"));
        let side = |x: f64| on(0, x).map(|[a, b]| ([[x, a], [x, b]], "x"));
        base.into_iter().chain(side(left)).chain(side(right)).collect()
    }
}

/// The table that says what a layer is.
fn layer_table(mapped: &Mapped) -> String {
    let name = mapped.name.as_ref();
    let law = name.map(|name| match mapped.role {
        "bolt" => format!("bolt = {}\n", quoted(name)),
        _ => format!("law = {}\n", quoted(name)),
    });
    let head = key(&mapped.layer.name);
    format!("\n[layers.{head}]\nuse = {:?}\n{}", mapped.role, law.unwrap_or_default())
}

/// A name as a key of TOML.
fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A text as a string of TOML, with hidden characters as their codes, so that the case reads as it is.
fn quoted(text: &str) -> String {
    let escaped = |letter: char| match letter {
        '"' | '\\' => format!("\\{letter}"),
        _ if is_hidden(letter) => format!("\\U{:08X}", u32::from(letter)),
        _ => letter.to_string(),
    };
    format!("\"{}\"", text.chars().map(escaped).collect::<String>())
}
