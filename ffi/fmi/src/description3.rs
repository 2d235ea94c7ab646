//! `modelDescription.xml` of FMI 3.0.

use std::io;

use crate::description::{Dialect, Facts, dependencies, document, identity, initial, value_attributes};
use crate::table::{Causality, Table, Type, Variable};
use crate::xml::Xml;

/// Media type of the output that holds the whole state.
pub const SNAPSHOT_TYPE: &str = "application/x-enmm-state";

/// The model description; `table` is that of FMI 3.
///
/// # Errors
/// None in practice: it is written to memory.
pub fn model_description(table: &Table, facts: &Facts) -> io::Result<Vec<u8>> {
    document(&DIALECT, table, facts)
}

/// `fixedInternalStepSize` is left out: internal steps are redone in halves where a step does not settle, and parts of
/// them end communication steps between two points of the grid.
const DIALECT: Dialect = Dialect {
    version: "3.0",
    token: "instantiationToken",
    capabilities: &[
        ("needsExecutionTool", "false"),
        ("canBeInstantiatedOnlyOncePerProcess", "false"),
        ("canGetAndSetFMUState", "true"),
        ("canSerializeFMUState", "true"),
        ("providesDirectionalDerivatives", "false"),
        ("providesAdjointDerivatives", "false"),
        ("canHandleVariableCommunicationStepSize", "true"),
        ("maxOutputDerivativeOrder", "1"),
        ("providesIntermediateUpdate", "true"),
        ("mightReturnEarlyFromDoStep", "true"),
        ("canReturnEarlyAfterIntermediateUpdate", "true"),
        ("hasEventMode", "true"),
        ("providesEvaluateDiscreteStates", "false"),
    ],
    variable,
    structure,
};

fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let mut attributes = identity(variable);
    // Only continuous variables may be asked for in an intermediate update.
    if variable.causality == Causality::Output && variable.is_continuous() {
        attributes.push(("intermediateUpdate", "true".to_owned()));
    }
    attributes.extend(initial(variable));
    if variable.kind == Type::Binary {
        attributes.push(("mimeType", SNAPSHOT_TYPE.to_owned()));
    }
    attributes.extend(value_attributes(variable));
    let kind = match variable.kind {
        Type::Real => "Float64",
        Type::Integer => "Int32",
        Type::Boolean => "Boolean",
        Type::String => "String",
        Type::Binary => "Binary",
    };
    if variable.length.is_none() && variable.kind != Type::String {
        return xml.leaf(kind, &attributes);
    }
    xml.element(kind, &attributes, |xml| {
        variable.length.map_or(Ok(()), |length| xml.leaf("Dimension", &[("start", length.to_string())]))?;
        match variable.kind {
            Type::String => xml.leaf("Start", &[("value", String::new())]),
            _ => Ok(()),
        }
    })
}

fn structure(xml: &mut Xml, table: &Table) -> io::Result<()> {
    let outputs = || table.variables.iter().filter(|variable| variable.causality == Causality::Output);
    let reference = |variable: &Variable| ("valueReference", variable.reference.to_string());
    xml.element("ModelStructure", &[], |xml| {
        outputs().try_for_each(|variable| {
            let mut attributes = vec![reference(variable)];
            attributes.extend(dependencies(variable));
            xml.leaf("Output", &attributes)
        })?;
        outputs().try_for_each(|variable| xml.leaf("InitialUnknown", &[reference(variable)]))
    })
}
