//! `blocks.csv`: the state of every block, one row each.

use std::io;
use std::path::Path;

use enmm::model::BlockState;
use enmm_io::files::{at_path, write_atomic};

const HEADER: [&str; 22] = [
    "id",
    "fixed",
    "removed",
    "detached",
    "centroid_x [m]",
    "centroid_y [m]",
    "displacement_x [m]",
    "displacement_y [m]",
    "rotation [rad]",
    "velocity_x [m/s]",
    "velocity_y [m/s]",
    "angular_velocity [rad/s]",
    "mean_stress_xx [Pa]",
    "mean_stress_yy [Pa]",
    "mean_stress_xy [Pa]",
    "area [m2]",
    "mass [kg/m]",
    "kinetic_energy [J/m]",
    "strain_energy [J/m]",
    "contacts",
    "penetration_max [m]",
    "speed [m/s]",
];

/// Writes the block states as CSV, units in the header, flags as 0 and 1; digits read back to the same numbers.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_blocks(path: &Path, blocks: &[BlockState]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(HEADER).map_err(io::Error::from).map_err(at_path(path))?;
    for block in blocks {
        csv.write_record(row(block)).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}

fn row(block: &BlockState) -> Vec<String> {
    let flag = |flag: bool| u8::from(flag).to_string();
    let mut row = vec![block.id.to_string(), flag(block.fixed), flag(block.removed), flag(block.detached)];
    let number = |value: f64| format!("{value:?}");
    let [xx, yy, xy] = block.mean_stress;
    row.extend(
        [
            block.centroid.x,
            block.centroid.y,
            block.displacement.x,
            block.displacement.y,
            block.rotation,
            block.velocity.x,
            block.velocity.y,
            block.angular_velocity,
            xx,
            yy,
            xy,
            block.area,
            block.mass,
            block.kinetic_energy,
            block.strain_energy,
        ]
        .map(number),
    );
    row.push(block.contact_count.to_string());
    row.extend([block.penetration_max, block.velocity.norm()].map(number));
    row
}
