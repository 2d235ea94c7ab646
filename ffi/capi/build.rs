//! Names the shared library for the dynamic linker by its series: a program that was linked with it looks for
//! `libenmm.so.0` (macOS: `libenmm.0.dylib`), wherever the library was. A link of that name stands beside the built
//! library, so that programs run with that one as well.

use std::env::var;
use std::io::Write;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let mut cargo = std::io::stdout();
    writeln!(cargo, "cargo:rerun-if-changed=build.rs")?;
    let system = var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let [version, major, minor] = ["", "_MAJOR", "_MINOR"].map(|part| format!("CARGO_PKG_VERSION{part}"));
    let [version, major, minor] = [version, major, minor].map(|name| var(name).unwrap_or_default());
    let (names, arguments) = match system.as_str() {
        "linux" => {
            let name = format!("libenmm.so.{major}");
            let argument = format!("-Wl,-soname,{name}");
            (["libenmm.so".to_owned(), name], argument)
        }
        "macos" => {
            let name = format!("libenmm.{major}.dylib");
            let versions = format!("-compatibility_version,{major}.{minor},-current_version,{version}");
            let argument = format!("-Wl,-install_name,@rpath/{name},{versions}");
            (["libenmm.dylib".to_owned(), name], argument)
        }
        _ => return Ok(()),
    };
    // Threads of rayon sleep for ever in code of this library; dlclose would unmap it under them.
    if system == "linux" {
        writeln!(cargo, "cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete")?;
    }
    writeln!(cargo, "cargo:rustc-cdylib-link-arg={arguments}")?;
    let out = var("OUT_DIR").unwrap_or_default();
    // target/PROFILE/build/PACKAGE/out
    Path::new(&out).ancestors().nth(3).map_or(Ok(()), |folder| link(&names[0], &folder.join(&names[1])))
}

/// Makes a link to a file of the same folder.
fn link(file: &str, link: &Path) -> std::io::Result<()> {
    let _ = std::fs::remove_file(link);
    #[cfg(unix)]
    return std::os::unix::fs::symlink(file, link);
    #[cfg(not(unix))]
    return writeln!(std::io::stdout(), "cargo:warning={file} has no link {}", link.display());
}
