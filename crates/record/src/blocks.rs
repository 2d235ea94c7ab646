//! `blocks.csv`: the state of every block, one row each.

use std::io;
use std::path::Path;

use enmm::model::Simulation;
use enmm_io::files::{at_path, write_atomic};
use enmm_observe::{BlockState, Quantity};

/// Columns before those of the numbers.
const FLAGS: [&str; 4] = ["id", "fixed", "removed", "detached"];

/// Writes the block states as CSV, units in the header, flags as 0 and 1; digits read back to the same numbers.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_blocks(path: &Path, simulation: &Simulation) -> io::Result<()> {
    let numbers: Vec<&Quantity<BlockState>> = simulation.block_quantities().collect();
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(header(&numbers)).map_err(io::Error::from).map_err(at_path(path))?;
    for block in simulation.blocks_by_number() {
        csv.write_record(row(block, &numbers)).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}

fn header(numbers: &[&Quantity<BlockState>]) -> Vec<String> {
    let number = |q: &&Quantity<BlockState>| match q.unit {
        "" => q.name.to_owned(),
        unit => format!("{} [{unit}]", q.name),
    };
    FLAGS.into_iter().map(str::to_owned).chain(numbers.iter().map(number)).collect()
}

fn row(block: &BlockState, numbers: &[&Quantity<BlockState>]) -> Vec<String> {
    let flag = |flag: bool| u8::from(flag).to_string();
    let flags = [block.id.to_string(), flag(block.fixed), flag(block.removed), flag(block.detached)];
    let number = |q: &&Quantity<BlockState>| match q.is_count {
        true => format!("{:.0}", (q.get)(block)),
        false => format!("{:?}", (q.get)(block)),
    };
    flags.into_iter().chain(numbers.iter().map(number)).collect()
}
