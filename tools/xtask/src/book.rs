//! The site of the documents, and what of it the program writes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::formulas::rendered;
use crate::repository::{self, Repository, write};

/// The version of mdBook that builds the site.
const MDBOOK: &str = "0.5.4";
/// Folders outside the documents that pages link to.
const LINKED: [&str; 6] = ["examples", "ffi/c", "ffi/cpp", "ffi/python", "include", "python_tests"];
/// Builds the site into `book/docs` in the target folder, with the files that its pages link to beside it.
pub fn build(repository: &Repository) -> Result<(), String> {
    let [site, source] = ["book", "book-source"].map(|name| repository.target.join(name));
    repository::remove(&site)?;
    write_source(repository, &source)?;
    let mut build = repository.command(mdbook(repository)?);
    repository::run(build.arg("build").arg(&source).arg("--dest-dir").arg(site.join("docs")))?;
    for folder in LINKED {
        for (name, bytes) in repository::files_of(&repository.root.join(folder))? {
            write(&site.join(folder).join(name), bytes)?;
        }
    }
    write_indices(&site)?;
    println!("wrote {}", site.join("docs/index.html").display());
    Ok(())
}

/// Writes what mdBook reads into a folder: the documents, with their formulas as MathML.
fn write_source(repository: &Repository, source: &Path) -> Result<(), String> {
    repository::remove(source)?;
    let settings = repository.root.join("book.toml");
    write(&source.join("book.toml"), repository::read(&settings)?)?;
    for (name, bytes) in repository::files_of(&repository.root.join("docs"))? {
        let bytes = if name.ends_with(".md") {
            let page = String::from_utf8(bytes).map_err(|error| format!("docs/{name}: {error}"))?;
            rendered(&page).map_err(|error| format!("docs/{name}: {error}"))?.into_bytes()
        } else {
            bytes
        };
        write(&source.join("docs").join(name), bytes)?;
    }
    Ok(())
}

/// Writes a list of its files into every folder of the site without a page, since pages link to folders.
fn write_indices(site: &Path) -> Result<(), String> {
    let mut lists: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let names: Vec<String> = repository::files_of(site)?.into_keys().collect();
    for name in &names {
        let mut entry = name.as_str();
        while let Some((folder, last)) = entry.rsplit_once('/') {
            let mark = if entry == name { "" } else { "/index.html" };
            lists.entry(folder.to_owned()).or_default().insert(format!("{last}{mark}"));
            entry = folder;
        }
    }
    for (folder, entries) in lists.into_iter().filter(|(folder, _)| !names.contains(&format!("{folder}/index.html"))) {
        let line =
            |entry: &String| format!("<li><a href=\"{entry}\">{}</a></li>\n", entry.trim_end_matches("/index.html"));
        let list: String = entries.iter().map(line).collect();
        let head = "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n";
        let page = format!("{head}<title>{folder}</title>\n<h1>{folder}</h1>\n<ul>\n{list}</ul>\n</html>\n");
        write(&site.join(&folder).join("index.html"), page)?;
    }
    Ok(())
}

/// The program mdBook in the target folder, installed there by cargo when it is missing.
fn mdbook(repository: &Repository) -> Result<PathBuf, String> {
    let tools = repository.target.join("book-tools");
    let program = tools.join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    let version = repository::capture(repository.command(&program).arg("--version")).unwrap_or_default();
    if String::from_utf8_lossy(&version).trim() != format!("mdbook v{MDBOOK}") {
        let mut install = repository.cargo(&["install", "mdbook", "--locked", "--no-default-features"]);
        install.args(["--features", "search", "--version", &format!("={MDBOOK}"), "--root"]).arg(&tools);
        repository::run(install.env("CARGO_TARGET_DIR", &tools))?;
    }
    Ok(program)
}

/// Writes the reference of the keys from schema, validation and cases.
pub fn write_reference(repository: &Repository) -> Result<(), String> {
    let mut test = repository.cargo(&["test", "--package", "enmm-io", "--test", "io", "key_reference"]);
    repository::run(test.env("ENMM_WRITE_REFERENCE", "1"))
}
