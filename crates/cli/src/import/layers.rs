//! Uses of the layers of a drawing, by their names and by the lines on them; other files say themselves what their
//! lines are.

use enmm_io::{LayerSurvey, Survey};

/// Words in names of layers with a water table, and with bolts.
const WATER: [&str; 6] = ["water", "gwl", "gwt", "phreatic", "piezo", "wasser"];
const BOLTS: [&str; 5] = ["bolt", "anchor", "anker", "nail", "nagel"];

/// Use of a layer with the reason for it.
#[derive(Debug)]
pub struct Mapped<'a> {
    /// The layer.
    pub layer: &'a LayerSurvey,
    /// Value of `use`.
    pub role: &'static str,
    /// Law of joints or name of bolts.
    pub name: Option<String>,
    /// Why, if the user should look at it.
    pub reason: Option<String>,
    /// Why it is open, if it is.
    pub open: Option<String>,
}

/// Maps all layers of a drawing.
pub fn mapped(survey: &Survey) -> Vec<Mapped<'_>> {
    let outline = outline(survey);
    let mut names = Vec::new();
    let open = |layer: &LayerSurvey| layer.problems.values().next().cloned();
    if !survey.is_drawing {
        return survey.layers.iter().map(said).collect();
    }
    let of = |layer| Mapped { open: open(layer), ..mapped_layer(layer, outline) };
    let mut all: Vec<Mapped> = survey.layers.iter().map(of).collect();
    for mapped in all.iter_mut().filter(|mapped| ["joint", "bolt"].contains(&mapped.role)) {
        mapped.name = Some(free_name(&mapped.layer.name, &mut names));
    }
    all
}

/// A layer that the file itself has given a meaning: a loop, or joints of the law with its name.
fn said(layer: &LayerSurvey) -> Mapped<'_> {
    let loops = ["outline", "hole", "island"].into_iter().find(|name| *name == layer.name);
    let name = if loops.is_some() { None } else { Some(layer.name.clone()) };
    Mapped { layer, role: loops.unwrap_or("joint"), name, reason: None, open: None }
}

fn mapped_layer<'a>(layer: &'a LayerSurvey, outline: Option<&LayerSurvey>) -> Mapped<'a> {
    let name = layer.name.to_lowercase();
    let says = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let of = |role, reason: Option<String>| Mapped { layer, role, name: None, reason, open: None };
    let straight = layer.loops.is_empty() && layer.lines.iter().all(|line| line.len() == 2);
    if layer.loops.is_empty() && layer.lines.is_empty() {
        return of("ignore", Some("no line of it can be read".to_owned()));
    }
    match name.as_str() {
        "outline" => return of("outline", None),
        "hole" => return of("hole", None),
        "island" => return of("island", None),
        _ => {}
    }
    if outline.is_some_and(|outline| outline.name == layer.name) {
        return of("outline", Some("its closed line is the largest of the drawing".to_owned()));
    }
    if says(&WATER) && layer.loops.is_empty() && layer.lines.len() == 1 {
        return of("water", Some("by its name, and it has one line".to_owned()));
    }
    if says(&BOLTS) && straight {
        return of("bolt", Some("by its name, and all its lines are straight".to_owned()));
    }
    of("joint", (!layer.loops.is_empty()).then(|| format!("{} of its lines are closed", layer.loops.len())))
}

/// The layer of the outline: that of this name, else the one whose only line is the largest loop of the drawing.
pub fn outline(survey: &Survey) -> Option<&LayerSurvey> {
    let named = survey.layers.iter().find(|layer| layer.name.eq_ignore_ascii_case("outline"));
    let size = |layer: &LayerSurvey| layer.loops.iter().map(|ring| area(ring)).fold(0.0, f64::max);
    let largest = || survey.layers.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    named.or_else(|| largest().filter(|layer| layer.loops.len() == 1 && layer.lines.is_empty()))
}

/// Area of a loop (m²).
fn area(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    0.5 * ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>().abs()
}

/// A name for a table of the case: the layer's in small letters, with a number where another has it.
fn free_name(layer: &str, names: &mut Vec<String>) -> String {
    let sign = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
    let plain: String = layer.to_lowercase().chars().map(sign).collect();
    let numbered = (2..).map(|number| format!("{plain}_{number}"));
    let name = std::iter::once(plain.clone()).chain(numbered).find(|name| !names.contains(name)).unwrap_or(plain);
    names.push(name.clone());
    name
}
