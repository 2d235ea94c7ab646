//! `terminalsAndIcons.xml` of FMI 3.0: a terminal per port, with its inputs and outputs as members.

use std::io;

use crate::table::{Table, Variable};
use crate::xml::Xml;

/// The file; the icon beside it is a square.
pub fn terminals_and_icons(table: &Table) -> io::Result<Vec<u8>> {
    let mut xml = Xml::new()?;
    let corners = || ["x1", "y1", "x2", "y2"].into_iter().zip(["-100", "-100", "100", "100"].map(str::to_owned));
    xml.element("fmiTerminalsAndIcons", &[("fmiVersion", "3.0".to_owned())], |xml| {
        xml.element("GraphicalRepresentation", &[], |xml| {
            let scale = ("suggestedScalingFactorTo_mm", "0.1".to_owned());
            xml.leaf("CoordinateSystem", &corners().chain([scale]).collect::<Vec<_>>())?;
            xml.leaf("Icon", &corners().collect::<Vec<_>>())
        })?;
        let ports = ports(table);
        if ports.is_empty() {
            return Ok(());
        }
        xml.element("Terminals", &[], |xml| ports.iter().try_for_each(|port| terminal(xml, table, port)))
    })?;
    Ok(xml.finish())
}

/// Names of the ports, in the order of the case.
fn ports(table: &Table) -> Vec<&str> {
    let mut ports: Vec<&str> = Vec::new();
    for port in table.variables.iter().filter_map(|variable| variable.port.as_deref()) {
        if !ports.contains(&port) {
            ports.push(port);
        }
    }
    ports
}

fn terminal(xml: &mut Xml, table: &Table, port: &str) -> io::Result<()> {
    let attributes = [
        ("name", port.to_owned()),
        ("matchingRule", "bus".to_owned()),
        ("description", format!("What goes into and comes out of {port}")),
    ];
    let members = || table.variables.iter().filter(|variable| variable.port.as_deref() == Some(port));
    xml.element("Terminal", &attributes, |xml| members().try_for_each(|variable| member(xml, port, variable)))
}

fn member(xml: &mut Xml, port: &str, variable: &Variable) -> io::Result<()> {
    let word = variable.name.strip_prefix(port).and_then(|rest| rest.strip_prefix('.')).unwrap_or(&variable.name);
    let attributes = [
        ("variableName", variable.name.clone()),
        ("memberName", word.to_owned()),
        ("variableKind", "signal".to_owned()),
    ];
    xml.leaf("TerminalMemberVariable", &attributes)
}
