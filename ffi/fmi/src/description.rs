//! Common parts of the model descriptions of both versions.

use std::io;

use enmm::cosimulation::Cosimulation;

use crate::log::LOG_CATEGORIES;
use crate::naming::convention;
use crate::table::{Causality, Table, Type, Variable};
use crate::unit;
use crate::xml::{Xml, number};

/// Made when the times of the archive begin: no clock is read, so that the same case gives the same bytes.
const MADE_AT: &str = "1980-01-01T00:00:00Z";

/// Contents of a model description beside its variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Facts {
    /// Title of the case.
    pub title: String,
    /// Name of the library, a C identifier.
    pub identifier: String,
    /// Description of the model.
    pub summary: String,
    /// Who made the case and the engine.
    pub author: String,
    /// Notices of copyright of case and library.
    pub copyright: String,
    /// Terms of use of case and library.
    pub license: String,
    /// Version of the model: that of the engine, and the fingerprint of the case.
    pub version: String,
    /// Time (s) that the stages of the case cover.
    pub stop_time: f64,
    /// Communication step (s) that the case suggests.
    pub communication_step: f64,
    /// Internal step (s).
    pub internal_step: f64,
    /// Number of blocks at the start.
    pub blocks: usize,
    /// The most that there can be.
    pub blocks_max: usize,
}

/// Details that each version of the standard writes in its own way.
pub struct Dialect {
    /// Version.
    pub version: &'static str,
    /// Attribute of the token.
    pub token: &'static str,
    /// Capabilities of the co-simulation.
    pub capabilities: &'static [(&'static str, &'static str)],
    /// Writes a variable.
    pub variable: fn(&mut Xml, &Variable) -> io::Result<()>,
    /// Writes the structure of the model.
    pub structure: fn(&mut Xml, &Table) -> io::Result<()>,
}

/// A model description in a dialect.
pub fn document(dialect: &Dialect, table: &Table, facts: &Facts) -> io::Result<Vec<u8>> {
    let mut xml = Xml::new()?;
    let attributes = [
        ("fmiVersion", dialect.version.to_owned()),
        ("modelName", facts.title.clone()),
        (dialect.token, table.token.clone()),
        ("description", facts.summary.clone()),
        ("author", facts.author.clone()),
        ("version", facts.version.clone()),
        ("copyright", facts.copyright.clone()),
        ("license", facts.license.clone()),
        ("generationTool", tool()),
        ("generationDateAndTime", MADE_AT.to_owned()),
        ("variableNamingConvention", convention(table.variables.iter().map(|v| v.name.as_str())).to_owned()),
    ];
    let mut capabilities = vec![("modelIdentifier", facts.identifier.clone())];
    capabilities.extend(dialect.capabilities.iter().map(|&(name, value)| (name, value.to_owned())));
    xml.element("fmiModelDescription", &attributes, |xml| {
        xml.leaf("CoSimulation", &capabilities)?;
        units(xml, table)?;
        log_categories(xml)?;
        experiment(xml, facts)?;
        xml.element("ModelVariables", &[], |xml| table.variables.iter().try_for_each(|v| (dialect.variable)(xml, v)))?;
        (dialect.structure)(xml, table)
    })?;
    Ok(xml.finish())
}

/// The attributes of a variable that both versions begin with.
pub fn identity(variable: &Variable) -> Vec<(&'static str, String)> {
    vec![
        ("name", variable.name.clone()),
        ("valueReference", variable.reference.to_string()),
        ("description", variable.description.clone()),
        ("causality", causality(variable)),
        ("variability", variability(variable)),
    ]
}

impl Facts {
    /// The facts of a model.
    pub fn of(model: &Cosimulation, identifier: &str) -> Self {
        let blocks = model.simulation().model().covers.block_count();
        let title = model.case().title.trim();
        let notes = model.case().fmu.clone().unwrap_or_default();
        let title = if title.is_empty() { identifier } else { title };
        Self {
            title: title.to_owned(),
            identifier: identifier.to_owned(),
            summary: format!("Jointed rock slope of {blocks} blocks, explicit numerical manifold method"),
            version: format!("{}+{}", enmm::engine_version(), model.hash()),
            stop_time: model.stop_time(),
            communication_step: short(model.communication_step()),
            internal_step: short(model.internal_step()),
            author: format!("Case: {}; engine: the enmm developers", said(&notes.author, "whoever wrote it")),
            copyright: format!(
                "Case: {}; library: Copyright (c) 2026 the enmm developers",
                said(&notes.copyright, "its author")
            ),
            license: format!(
                "Case: {}; library: MIT or Apache-2.0, see documentation/licenses/license.txt",
                said(&notes.license, "as its author says")
            ),
            blocks,
            blocks_max: model.blocks_max(),
        }
    }
}

/// The note of the case, or other words where it has none.
fn said<'a>(note: &'a Option<String>, otherwise: &'a str) -> &'a str {
    note.as_deref().map_or(otherwise, str::trim)
}

/// The value without the last digits of a rounding error: 0.012 for 0.011999999999999999.
fn short(value: f64) -> f64 {
    let rounded = format!("{value:.13e}").parse().unwrap_or(value);
    if number(rounded).len() + 3 < number(value).len() { rounded } else { value }
}

/// Name and version of the tool that made the FMU.
pub fn tool() -> String {
    format!("enmm {}", enmm::engine_version())
}

/// Writes the units that the table uses.
fn units(xml: &mut Xml, table: &Table) -> io::Result<()> {
    let used = |unit| table.variables.iter().any(|variable| unit::of(variable) == Some(unit));
    xml.element("UnitDefinitions", &[], |xml| {
        for unit in unit::UNITS.iter().filter(|unit| used(*unit)) {
            xml.element("Unit", &[("name", unit.name.to_owned())], |xml| {
                let bases = ["kg", "m", "s", "rad"].into_iter().zip(unit.exponents);
                let powers: Vec<_> =
                    bases.filter(|(_, power)| *power != 0).map(|(base, power)| (base, power.to_string())).collect();
                xml.leaf("BaseUnit", &powers)?;
                let displays = unit::DISPLAYS.iter().filter(|display| display.of == unit.name);
                displays.into_iter().try_for_each(|display| {
                    let factor = number(display.factor);
                    xml.leaf("DisplayUnit", &[("name", display.name.to_owned()), ("factor", factor)])
                })
            })?;
        }
        Ok(())
    })
}

/// Writes the log categories.
fn log_categories(xml: &mut Xml) -> io::Result<()> {
    xml.element("LogCategories", &[], |xml| {
        LOG_CATEGORIES.iter().try_for_each(|(name, description)| {
            xml.leaf("Category", &[("name", (*name).to_owned()), ("description", (*description).to_owned())])
        })
    })
}

/// Writes the default experiment.
fn experiment(xml: &mut Xml, facts: &Facts) -> io::Result<()> {
    let attributes = [
        ("startTime", number(0.0)),
        ("stopTime", number(facts.stop_time)),
        ("stepSize", number(facts.communication_step)),
    ];
    xml.leaf("DefaultExperiment", &attributes)
}

/// The word for a causality in both versions.
fn causality(variable: &Variable) -> String {
    match variable.causality {
        Causality::Independent => "independent",
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::Local => "local",
    }
    .to_owned()
}

/// The word for a variability in both versions.
fn variability(variable: &Variable) -> String {
    match variable.causality {
        Causality::Parameter if variable.is_tunable => "tunable",
        Causality::Parameter => "fixed",
        _ if variable.is_continuous() => "continuous",
        _ => "discrete",
    }
    .to_owned()
}

/// How the first value comes about: given for parameters, calculated for what is read, not to be said for all others.
pub fn initial(variable: &Variable) -> Option<(&'static str, String)> {
    match variable.causality {
        Causality::Parameter => Some(("initial", "exact".to_owned())),
        Causality::Output | Causality::Local => Some(("initial", "calculated".to_owned())),
        Causality::Independent | Causality::Input => None,
    }
}

/// Quantity, unit, display unit, least, greatest, nominal and start value, as far as the variable has them.
pub fn value_attributes(variable: &Variable) -> Vec<(&'static str, String)> {
    let mut attributes = Vec::new();
    if let Some(unit) = unit::of(variable) {
        attributes.push(("quantity", unit.quantity.to_owned()));
        attributes.push(("unit", unit.name.to_owned()));
    }
    if let Some(display) = unit::display(variable) {
        attributes.push(("displayUnit", display.name.to_owned()));
    }
    if let Some((low, high)) = variable.limits {
        attributes.extend([("min", number(low)), ("max", number(high))]);
    }
    if let Some(nominal) = variable.nominal {
        attributes.push(("nominal", number(nominal)));
    }
    if let Some(start) = variable.start {
        let one = if variable.kind == Type::Boolean { (start != 0.0).to_string() } else { number(start) };
        attributes.push(("start", vec![one; variable.size()].join(" ")));
    }
    attributes
}

/// Dependencies of the unknown of an output: nothing that a host can set, where its value is a function of the state
/// alone; unsaid, and so everything, elsewhere. Importers may then close loops over such outputs.
pub fn dependencies(variable: &Variable) -> Option<(&'static str, String)> {
    variable.quantity.is_of_state().then(|| ("dependencies", String::new()))
}
