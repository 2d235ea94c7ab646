//! `modelDescription.xml` of FMI 2.0.

use std::io;

use crate::description::{
    Facts, causality, dependencies, experiment, initial, log_categories, tool, units, value_attributes, variability,
};
use crate::table::{Causality, Table, Type, Variable};
use crate::xml::Xml;

/// The model description; `table` is that of FMI 2.
///
/// # Errors
/// None in practice: it is written to memory.
pub fn model_description(table: &Table, facts: &Facts) -> io::Result<Vec<u8>> {
    let mut xml = Xml::new()?;
    let attributes = [
        ("fmiVersion", "2.0".to_owned()),
        ("modelName", facts.title.clone()),
        ("guid", table.token.clone()),
        ("description", facts.summary.clone()),
        ("generationTool", tool()),
        ("variableNamingConvention", "flat".to_owned()),
    ];
    xml.element("fmiModelDescription", &attributes, |xml| {
        xml.leaf("CoSimulation", &capabilities(facts))?;
        units(xml, table)?;
        log_categories(xml)?;
        experiment(xml, facts)?;
        xml.element("ModelVariables", &[], |xml| table.variables.iter().try_for_each(|v| variable(xml, v)))?;
        structure(xml, table)
    })?;
    Ok(xml.finish())
}

fn capabilities(facts: &Facts) -> Vec<(&'static str, String)> {
    let flags = [
        ("needsExecutionTool", "false"),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("canInterpolateInputs", "false"),
        ("maxOutputDerivativeOrder", "1"),
        ("canRunAsynchronuously", "false"),
        ("canBeInstantiatedOnlyOncePerProcess", "false"),
        ("canNotUseMemoryManagementFunctions", "true"),
        ("canGetAndSetFMUstate", "true"),
        ("canSerializeFMUstate", "true"),
        ("providesDirectionalDerivative", "false"),
    ];
    let mut attributes = vec![("modelIdentifier", facts.identifier.clone())];
    attributes.extend(flags.map(|(name, value)| (name, value.to_owned())));
    attributes
}

fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let mut attributes = vec![
        ("name", variable.name.clone()),
        ("valueReference", variable.reference.to_string()),
        ("description", variable.description.clone()),
        ("causality", causality(variable)),
        ("variability", variability(variable)),
    ];
    attributes.extend(initial(variable));
    let kind = match variable.kind {
        Type::Real => "Real",
        Type::Integer => "Integer",
        Type::Boolean => "Boolean",
        Type::Binary => return Err(io::Error::other("FMI 2 has no binary variables")),
    };
    xml.element("ScalarVariable", &attributes, |xml| xml.leaf(kind, &value_attributes(variable)))
}

fn structure(xml: &mut Xml, table: &Table) -> io::Result<()> {
    let outputs = || (1..).zip(&table.variables).filter(|(_, variable)| variable.causality == Causality::Output);
    xml.element("ModelStructure", &[], |xml| {
        xml.element("Outputs", &[], |xml| {
            outputs().try_for_each(|(index, variable): (usize, _)| {
                let mut attributes = vec![("index", index.to_string())];
                attributes.extend(dependencies(variable));
                xml.leaf("Unknown", &attributes)
            })
        })?;
        xml.element("InitialUnknowns", &[], |xml| {
            outputs().try_for_each(|(index, _)| xml.leaf("Unknown", &[("index", index.to_string())]))
        })
    })
}
