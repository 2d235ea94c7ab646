//! Names the shared library for the dynamic linker: programs then find it by name, wherever it was when they were
//! linked.

use std::io::Write;

fn main() -> std::io::Result<()> {
    let mut cargo = std::io::stdout();
    writeln!(cargo, "cargo:rerun-if-changed=build.rs")?;
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        writeln!(cargo, "cargo:rustc-cdylib-link-arg=-Wl,-soname,libenmm.so")?;
    }
    Ok(())
}
