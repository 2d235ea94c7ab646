//! Writes the header to the file that is named.

use std::io::{Error, Result};

fn main() -> Result<()> {
    let out = std::env::args_os().nth(1).ok_or_else(|| Error::other("name the file to write"))?;
    std::fs::write(out, enmm_header::generate().map_err(Error::other)?)
}
