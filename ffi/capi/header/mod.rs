//! The C header of the C ABI, its layouts for Python and the page of its numbers, made of its sources and the tables of
//! quantities. `cargo xtask header` writes them.

#[path = "../src/layout.rs"]
mod layout;
mod page;
mod python;
mod structures;

use std::path::{Path, PathBuf};

use cbindgen::{Builder, Config, DocumentationLength, DocumentationStyle, Language};

/// Path of the header in the repository.
pub const HEADER: &str = "include/enmm.h";

/// Introduction of the header.
const INTRODUCTION: &str = "\
/*
 * enmm: explicit numerical manifold method for jointed rock. Made by `cargo xtask header`: do not edit.
 *
 * Units are SI: m, s, kg, N, Pa, rad, per metre of thickness; x to the right, y upwards, angles and moments
 * counter-clockwise, stresses positive in tension.
 *
 * Status. Every function that can fail returns enmm_status, 0 for done; when it is not 0 nothing has changed, and
 * enmm_last_error() returns the reason. ENMM_DEAD_HANDLE, ENMM_BUSY and ENMM_PANIC can come from every function with
 * a model. No exception and no panic leaves the library.
 *
 * Handles of models and states are numbers in a table of the process, and never dereferenced: a NULL or dead handle is
 * an error. Every other pointer must point to the data that the function describes. NULL is an error, except where a
 * function allows it.
 *
 * Threads. Models share nothing: any number can be used at the same time. One thread at a time may use a model, until
 * its messages have been delivered; any other gets ENMM_BUSY. enmm_interrupt alone can be called beside a call, to end
 * it. A state may be used by many.
 *
 * Processes. A forked process has models and states of its own, as they were at the fork, and may use them; one that
 * another thread was using at the fork stays ENMM_BUSY there. No call waits for a thread that the new process does not
 * have. See enmm_set_threads for models with threads.
 *
 * Structures begin with struct_size, which the caller sets to sizeof the structure. The library writes no more than
 * that, so that structures can grow and programs built with an older header still work. Members that the library does
 * not know keep their values.
 *
 * Texts are UTF-8 and end with a zero byte.
 */";

/// Section of the functions for readers in Rust, which the introduction says for all.
const SAFETY: &str = " *\n * # Safety\n * Every pointer is as the head of the header states.\n";

/// Root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Header, modules of Python and page that belong to the sources, with their paths.
///
/// # Errors
/// When the sources cannot be read, or have a type that Python has no name for.
pub fn files() -> Result<[(&'static str, String); 4], String> {
    let plain = plain()?;
    let [layouts, values] = python::modules(&plain)?;
    let header = structures::with_older_names(&plain);
    Ok([(HEADER, header), (python::LAYOUTS, layouts), (python::VALUES, values), (page::PAGE, page::page())])
}

/// The header without older names of members.
fn plain() -> Result<String, String> {
    let config = Config {
        language: Language::C,
        cpp_compat: true,
        header: Some(INTRODUCTION.to_owned()),
        include_guard: Some("ENMM_H".to_owned()),
        no_includes: true,
        sys_includes: vec!["stddef.h".to_owned(), "stdint.h".to_owned()],
        usize_is_size_t: true,
        documentation_style: DocumentationStyle::Doxy,
        documentation_length: DocumentationLength::Full,
        line_length: 120,
        ..Config::default()
    };
    let enumerations = ["enmm_interpolation", "enmm_input", "enmm_name_kind"];
    let builder = Builder::new().with_config(config);
    let mut builder = enumerations.into_iter().fold(builder, Builder::include_item);
    let sources = root().join("ffi/capi/src");
    let files = [
        "types",
        "abi/library",
        "abi/model",
        "abi/inputs",
        "abi/parameters",
        "abi/names",
        "abi/observe",
        "abi/state",
        "abi/record",
        "abi/batch",
    ];
    for file in files {
        builder = builder.with_src(sources.join(file).with_extension("rs"));
    }
    let own = std::env::temp_dir().join(format!("enmm-structures-{}.rs", std::process::id()));
    std::fs::write(&own, structures::source()).map_err(|error| format!("{}: {error}", own.display()))?;
    let bindings = builder.with_src(&own).generate().map_err(|error| error.to_string());
    std::fs::remove_file(&own).map_err(|error| format!("{}: {error}", own.display()))?;
    let mut bytes = Vec::new();
    bindings?.write(&mut bytes);
    let text = String::from_utf8(bytes).map_err(|error| error.to_string())?;
    let text: String = text.lines().map(|line| line.trim_end().to_owned() + "\n").collect();
    Ok(text.replace(SAFETY, ""))
}
