//! Keeps the library in memory once an importer has loaded it.

use std::io::Write;

fn main() -> std::io::Result<()> {
    let mut cargo = std::io::stdout();
    // Threads of rayon sleep for ever in code of this library. An importer that frees its instances and calls dlclose
    // would unmap that code under them.
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        writeln!(cargo, "cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete")?;
    }
    writeln!(cargo, "cargo:rerun-if-changed=build.rs")
}
