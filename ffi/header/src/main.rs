//! Writes the header to its place.

use std::io::{Error, Result};

use enmm_header::{HEADER, generate, root};

fn main() -> Result<()> {
    std::fs::write(root().join(HEADER), generate().map_err(Error::other)?)
}
