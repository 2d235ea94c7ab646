//! `bolts_along.csv`: the force along bars that slip in their grout, one row for each segment from the head on.

use std::io;
use std::path::Path;

use enmm::model::Simulation;
use enmm_io::files::{at_path, write_atomic};
use enmm_observe::{BoltLine, bolts};

/// Name of the file.
pub(crate) const ALONG: &str = "bolts_along.csv";
const COLUMNS: [&str; 8] = ["bolt", "name", "along [m]", "x [m]", "y [m]", "tension [N]", "slip [m]", "state"];

/// Whether bars of a model slip in their grout.
pub fn has_bonds(simulation: &Simulation) -> bool {
    simulation.case().bolts.iter().any(|bolt| bolt.bond.is_some())
}

/// Writes the segments of all such bars: the number and name of the bolt, the middle of the segment from the head and
/// in the reference configuration, the tension of one bar, its slip along the rock towards the far end, and its state;
/// digits read back to the same numbers. Without such bars there is no file.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_along(path: &Path, simulation: &Simulation) -> io::Result<()> {
    if !has_bonds(simulation) {
        return Ok(());
    }
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(COLUMNS).map_err(io::Error::from).map_err(at_path(path))?;
    for line in bolts(simulation) {
        let case = &simulation.case().bolts[line.bolt as usize];
        if case.bond.is_some() {
            let row = row(&line, simulation.case().bolt_name(line.bolt as usize), case);
            csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
        }
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}

fn row(line: &BoltLine, name: String, case: &enmm::model::case::Bolt) -> [String; 8] {
    let middle = (line.reference[0] + line.reference[1]) * 0.5;
    let head = case.points[0];
    let along = libm::hypot(middle.x - head[0], middle.y - head[1]);
    let (force, slip) = (line.force * case.spacing, 0.5 * (line.slip[0] + line.slip[1]));
    let numbers = [along, middle.x, middle.y, force, slip].map(|number| format!("{number:?}"));
    let [along, x, y, force, slip] = numbers;
    let state = enmm_observe::BoltCondition::NAMES[line.condition.number() as usize];
    [line.bolt.to_string(), name, along, x, y, force, slip, state.to_owned()]
}
