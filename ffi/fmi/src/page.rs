//! The page about an FMU: what goes in, what comes out, how to step. It needs no other file but its picture.

use enmm::cosimulation::Cosimulation;
use quick_xml::escape::escape;

use crate::description::{Facts, tool};
use crate::log::LOG_CATEGORIES;
use crate::table::{Causality, Table, Type, Variable, Version};
use crate::xml::{clean, number};

/// File name of the picture beside the page.
pub const PICTURE: &str = "slope.png";
/// Most rows of the table of blocks.
const BLOCKS_MAX: usize = 500;

const STYLE: &str =
    "body{font:16px/1.5 system-ui,sans-serif;color:#22303c;max-width:72em;margin:2em auto;padding:0 1em}
h1{font-size:1.7em}h2{font-size:1.25em;margin-top:2em}img{max-width:100%;border:1px solid #d5dbe0}
table{border-collapse:collapse;font-size:.88em}th,td{text-align:left;vertical-align:top;padding:.25em .8em .25em 0;
border-bottom:1px solid #d5dbe0}code{font-size:.95em}td:first-child{white-space:nowrap}";

/// The page as HTML.
pub fn page(model: &Cosimulation, table: &Table, facts: &Facts) -> String {
    let title = text(&facts.title);
    let number = if table.version == Version::Two { "2.0" } else { "3.0" };
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
         img-src 'self' file:\">\n<title>{title}</title>\n\
         <style>\n{STYLE}\n</style>\n</head>\n<body>\n<h1>{title}</h1>\n\
         <p>{}. FMI {number} co-simulation, packed by {}; no file outside this FMU is needed.</p>\n\
         <p><img src=\"{PICTURE}\" alt=\"The slope before it moves\"><br>\n\
         The slope before it moves; the rings are monitors and ports.</p>\n",
        text(&facts.summary),
        tool(),
    );
    page += &signs();
    page += &stepping(facts);
    page += &states(table.version);
    for (causality, heading) in [
        (Causality::Input, "Inputs"),
        (Causality::Output, "Outputs"),
        (Causality::Parameter, "Parameters"),
        (Causality::Local, "Former names"),
    ] {
        page += &variables(table, causality, heading);
    }
    page += &blocks(model);
    page += &log();
    page + "</body>\n</html>\n"
}

fn text(raw: &str) -> String {
    escape(clean(raw)).into_owned()
}

fn section(heading: &str, items: &[String]) -> String {
    let items: String = items.iter().map(|item| format!("<li>{item}</li>\n")).collect();
    format!("<h2>{heading}</h2>\n<ul>\n{items}</ul>\n")
}

fn signs() -> String {
    let items = [
        "The model is a vertical section: x to the right, y up. Forces, moments, energies and masses are per metre of \
         depth.",
        "Rotations and moments are counter-clockwise. Stress is positive in tension; pressure is positive when \
         it pushes into the rock, and normal forces across joints are positive in compression.",
        "All values are in SI units, angles in radians.",
    ];
    section("Signs and units", &items.map(str::to_owned))
}

fn stepping(facts: &Facts) -> String {
    let (step, internal) = (number(facts.communication_step), number(facts.internal_step));
    let items = [
        format!(
            "Time 0 is the start of the first dynamic stage of the case. Static stages before it are sought as the \
             initial equilibrium when initialization ends, under the inputs and parameters set until then. The stages \
             of the case cover {} s together.",
            number(facts.stop_time)
        ),
        format!(
            "Any communication step greater than 0 may be taken, and steps may differ. The suggested one is {step} s; \
             the internal step is {internal} s."
        ),
        "Results do not depend on the communication step as long as it is a whole number of internal steps, for \
         instance the suggested one, its half or its tenth. Other steps end with a part of an internal step; the next \
         one goes on from the grid."
            .to_owned(),
        "An input acts from the start of the next step on and holds over it, or is reached linearly at its end \
         when the parameter <code>interpolate_inputs</code> is true. Inputs of arrays and of ports on the same \
         block add up."
            .to_owned(),
        "Results have the same bits for every number of threads.".to_owned(),
    ];
    section("Steps", &items)
}

fn states(version: Version) -> String {
    let mut items = vec![
        "A step is done whole or not at all: one that fails numerically is discarded, leaves the instance as it was \
         at its start, says why in the log, and can be tried again with another step or other inputs. A call with bad \
         values or out of place is an error, after which a saved state or a reset is needed."
            .to_owned(),
        "The state can be read, set, serialized and deserialized at any communication point, also in another process; \
         what follows has the same bits. A damaged state, or that of another case, is refused."
            .to_owned(),
        "First derivatives are at hand of displacements and rotations; those of other outputs are told as 0."
            .to_owned(),
    ];
    if version == Version::Three {
        items.extend([
            "A step returns early, if the host allows it, at the moment a block detaches, a joint first slips \
             or a block fails."
                .to_owned(),
            "Intermediate updates come at internal steps; all continuous outputs can then be read.".to_owned(),
            "<code>snapshot</code> is the whole state as bytes. Index k of an array is block k of the table below."
                .to_owned(),
        ]);
    }
    section("Going back and looking in", &items)
}

fn variables(table: &Table, causality: Causality, heading: &str) -> String {
    let starts = !matches!(causality, Causality::Output | Causality::Local);
    let mut rows = String::new();
    for variable in table.variables.iter().filter(|variable| variable.causality == causality) {
        let mut cells =
            vec![format!("<code>{}</code>", text(&variable.name)), kind(variable, table.version), text(variable.unit)];
        if starts {
            cells.extend([start(variable), limits(variable)]);
        }
        cells.push(text(&variable.description));
        rows += &row("td", &cells);
    }
    let mut heads = vec!["Name", "Type", "Unit"];
    if starts {
        heads.extend(["Start", "Range"]);
    }
    heads.push("What it is");
    let heads: Vec<String> = heads.into_iter().map(str::to_owned).collect();
    format!("<h2>{heading}</h2>\n<table>\n{}{rows}</table>\n", row("th", &heads))
}

fn row(cell: &str, cells: &[String]) -> String {
    let cells: String = cells.iter().map(|content| format!("<{cell}>{content}</{cell}>")).collect();
    format!("<tr>{cells}</tr>\n")
}

fn kind(variable: &Variable, version: Version) -> String {
    let name = match (variable.kind, version) {
        (Type::Real, Version::Two) => "Real",
        (Type::Real, Version::Three) => "Float64",
        (Type::Integer, Version::Two) => "Integer",
        (Type::Integer, Version::Three) => "Int32",
        (Type::Boolean, _) => "Boolean",
        (Type::String, _) => "String",
        (Type::Binary, _) => "Binary",
    };
    variable.length.map_or(name.to_owned(), |length| format!("{name}[{length}]"))
}

fn start(variable: &Variable) -> String {
    match (variable.start, variable.kind) {
        (None, _) => String::new(),
        (Some(start), Type::Boolean) => (start != 0.0).to_string(),
        (Some(start), _) => number(start),
    }
}

fn limits(variable: &Variable) -> String {
    variable.limits.map_or_else(String::new, |(low, high)| format!("{} to {}", number(low), number(high)))
}

fn blocks(model: &Cosimulation) -> String {
    let states = model.block_states();
    let heads = ["Block", "Centroid x (m)", "Centroid y (m)", "Area (m²)", "Mass (kg/m)", ""].map(str::to_owned);
    let rows: String = states
        .iter()
        .take(BLOCKS_MAX)
        .map(|state| {
            let numbers =
                [state.centroid.x, state.centroid.y, state.area, state.mass].map(|value| format!("{value:.6}"));
            let mut cells = vec![state.id.to_string()];
            cells.extend(numbers);
            cells.push(if state.fixed { "held".to_owned() } else { String::new() });
            row("td", &cells)
        })
        .collect();
    let more = states.len().saturating_sub(BLOCKS_MAX);
    let rest = if more > 0 { format!("<p>And {more} more.</p>\n") } else { String::new() };
    format!("<h2>Blocks at the start</h2>\n<table>\n{}{rows}</table>\n{rest}", row("th", &heads))
}

fn log() -> String {
    let items = LOG_CATEGORIES.map(|(name, what)| format!("<code>{name}</code>: {what}"));
    section("Log categories", &items)
}
