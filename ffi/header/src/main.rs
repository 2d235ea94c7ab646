//! Writes the header and the layouts for Python to their places.

use std::io::{Error, Result};

use enmm_header::{files, root};

fn main() -> Result<()> {
    files().map_err(Error::other)?.into_iter().try_for_each(|(path, text)| std::fs::write(root().join(path), text))
}
