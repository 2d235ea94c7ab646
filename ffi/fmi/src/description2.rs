//! `modelDescription.xml` of FMI 2.0.

use std::io;

use crate::description::{Dialect, Facts, dependencies, document, identity, initial, value_attributes};
use crate::table::{Causality, Table, Type, Variable};
use crate::xml::Xml;

/// The model description; `table` is that of FMI 2.
///
/// # Errors
/// None in practice: it is written to memory.
pub fn model_description(table: &Table, facts: &Facts) -> io::Result<Vec<u8>> {
    document(&DIALECT, table, facts)
}

/// How FMI 2.0 writes.
const DIALECT: Dialect = Dialect {
    version: "2.0",
    token: "guid",
    capabilities: &[
        ("needsExecutionTool", "false"),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("canInterpolateInputs", "true"),
        ("maxOutputDerivativeOrder", "1"),
        ("canRunAsynchronuously", "false"),
        ("canBeInstantiatedOnlyOncePerProcess", "false"),
        ("canNotUseMemoryManagementFunctions", "true"),
        ("canGetAndSetFMUstate", "true"),
        ("canSerializeFMUstate", "true"),
        ("providesDirectionalDerivative", "false"),
    ],
    variable,
    structure,
};

fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let mut attributes = identity(variable);
    attributes.extend(initial(variable));
    let kind = match variable.kind {
        Type::Real => "Real",
        Type::Integer => "Integer",
        Type::Boolean => "Boolean",
        Type::String => "String",
        Type::Binary => return Err(io::Error::other("FMI 2 has no binary variables")),
    };
    let mut values = value_attributes(variable);
    if variable.kind == Type::String {
        values.push(("start", String::new()));
    }
    xml.element("ScalarVariable", &attributes, |xml| xml.leaf(kind, &values))
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
