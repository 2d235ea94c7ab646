//! Writes the header and the layouts for Python to their places.

#[path = "mod.rs"]
mod header;

use std::io::{Error, Result};

use header::{files, root};

fn main() -> Result<()> {
    files().map_err(Error::other)?.into_iter().try_for_each(|(path, text)| std::fs::write(root().join(path), text))
}
