//! Parts of our libraries and program: a list of their Rust crates (CycloneDX) and the licences of these, which
//! travel in every FMU and wheel.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::{Value, json};

use crate::repository::{self, Repository};

/// Packages whose libraries and programs leave the repository.
const SHIPPED: [&str; 4] = ["enmm-cli", "enmm-capi", "enmm-fmi2", "enmm-fmi3"];
/// Platforms that they are built for.
const TARGETS: [&str; 5] = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-pc-windows-gnu",
    "x86_64-pc-windows-msvc",
    "aarch64-apple-darwin",
];
/// The list of crates.
pub const LIST: &str = "ffi/fmi/parts/sbom.cdx.json";
/// Licences of enmm and of these.
pub const LICENSES: &str = "ffi/fmi/parts/LICENSES";

/// Licences of what the linker of mingw-w64 adds.
const WINDOWS: &str = "ffi/fmi/parts/windows";

/// Licences of what a crate contains beside its own code: crate, file.
const CONTENTS: [(&str, &str); 1] = [("dejavu", "assets/dejavu-fonts-ttf-2.37/LICENSE")];

/// A crate from a registry.
struct Part {
    name: String,
    version: String,
    license: String,
    authors: String,
    /// Where its sources are.
    folder: String,
}

/// Writes both files.
///
/// # Errors
/// When cargo cannot name the crates, or the sources of one are missing.
pub fn write(repository: &Repository) -> Result<(), String> {
    for (path, text) in files(repository)? {
        std::fs::write(repository.root.join(path), text).map_err(|error| format!("{path}: {error}"))?;
        println!("wrote {path}");
    }
    Ok(())
}

/// Compares both files with what the dependencies are today.
///
/// # Errors
/// As [`write()`], and when a file differs.
pub fn compare(repository: &Repository) -> Result<(), String> {
    for (path, text) in files(repository)? {
        if read(&repository.root.join(path))? != text {
            return Err(format!("{path} does not list the dependencies of today: run `cargo xtask parts` and commit"));
        }
    }
    Ok(())
}

fn files(repository: &Repository) -> Result<[(&'static str, String); 2], String> {
    let mut ask = repository.cargo(&["metadata", "--locked", "--format-version", "1"]);
    TARGETS.iter().for_each(|target| {
        ask.args(["--filter-platform", target]);
    });
    let answer = repository::capture(&mut ask)?;
    let metadata: Value = serde_json::from_slice(&answer).map_err(|error| format!("cargo metadata: {error}"))?;
    let parts = parts(&metadata);
    let checksums = checksums(&read(&repository.root.join("Cargo.lock"))?);
    let list = list(&parts, &checksums)?;
    let mit = read(&repository.root.join("LICENSE-MIT"))?;
    let apache = read(&repository.root.join("LICENSE-APACHE"))?;
    let rule = "-".repeat(80);
    let head = format!(
        "enmm may be used under either of the first two licences below. Its libraries and its program contain Rust\n\
         crates under the licences behind these two; each begins with the crates that it is for. The Rust standard\n\
         library is there as well, under MIT or Apache-2.0.\n\n{rule}\n\n{mit}\n{rule}\n\n{apache}"
    );
    let windows = read(&repository.root.join(WINDOWS))?;
    Ok([(LIST, list), (LICENSES, head + &licenses(&parts, &mit)? + &windows)])
}

fn read(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(String::from_utf8_lossy(&bytes).replace("\r\n", "\n"))
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

fn items<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = &'a Value> {
    value[key].as_array().into_iter().flatten()
}

/// The crates from registries that are linked into what is shipped, by name and version. Macros and what only builds or
/// tests need are left out: their code is in no library.
fn parts(metadata: &Value) -> Vec<Part> {
    let packages: BTreeMap<&str, &Value> =
        items(metadata, "packages").map(|found| (text(found, "id"), found)).collect();
    let nodes: BTreeMap<&str, &Value> =
        items(&metadata["resolve"], "nodes").map(|node| (text(node, "id"), node)).collect();
    let is_linked = |id: &str| !items(packages[id], "targets").any(|target| target["kind"] == json!(["proc-macro"]));
    let mut open: Vec<&str> =
        packages.iter().filter(|(_, found)| SHIPPED.contains(&text(found, "name"))).map(|(id, _)| *id).collect();
    let mut seen = BTreeSet::new();
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            let linked =
                items(nodes[id], "deps").filter(|dep| items(dep, "dep_kinds").any(|kind| kind["kind"].is_null()));
            open.extend(linked.map(|dep| text(dep, "pkg")).filter(|id| is_linked(id)));
        }
    }
    let mut parts: Vec<Part> =
        seen.into_iter().map(|id| packages[id]).filter(|found| !found["source"].is_null()).map(part).collect();
    parts.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    parts
}

fn part(package: &Value) -> Part {
    let authors: Vec<&str> = items(package, "authors").filter_map(Value::as_str).collect();
    let folder = Path::new(text(package, "manifest_path")).parent().unwrap_or(Path::new(""));
    Part {
        name: text(package, "name").to_owned(),
        version: text(package, "version").to_owned(),
        // The slash is how crates wrote "or" before there were expressions.
        license: text(package, "license").replace(" / ", "/").replace('/', " OR "),
        authors: authors.join(", "),
        folder: folder.display().to_string(),
    }
}

/// Checksums in `Cargo.lock` by name and version.
fn checksums(lock: &str) -> BTreeMap<(String, String), String> {
    let value = |block: &str, key: &str| {
        let line = block.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
        line.map(|value| value.trim_matches('"').to_owned())
    };
    let entry = |block: &str| Some(((value(block, "name")?, value(block, "version")?), value(block, "checksum")?));
    lock.split("[[package]]").filter_map(entry).collect()
}

/// The list in the format CycloneDX 1.6. It has neither date nor serial number, so the same crates give the same file.
fn list(parts: &[Part], checksums: &BTreeMap<(String, String), String>) -> Result<String, String> {
    let component = |part: &Part| {
        let address = format!("pkg:cargo/{}@{}", part.name, part.version);
        let checksum = checksums.get(&(part.name.clone(), part.version.clone()));
        let checksum =
            checksum.ok_or_else(|| format!("Cargo.lock has no checksum of {} {}", part.name, part.version))?;
        Ok(json!({
            "type": "library", "bom-ref": address, "name": part.name, "version": part.version, "purl": address,
            "hashes": [{"alg": "SHA-256", "content": checksum}],
            "licenses": [{"expression": part.license}],
        }))
    };
    let components = parts.iter().map(component).collect::<Result<Vec<_>, String>>()?;
    let list = json!({
        "bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1,
        "metadata": {"component": {
            "type": "library", "bom-ref": "enmm", "name": "enmm", "version": env!("CARGO_PKG_VERSION"),
            "licenses": [{"expression": env!("CARGO_PKG_LICENSE")}],
        }},
        "components": components,
    });
    Ok(format!("{list:#}\n"))
}

/// The licences of all parts; parts with the same text share it.
fn licenses(parts: &[Part], own: &str) -> Result<String, String> {
    let mut owners: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for part in parts {
        let texts = license_texts(part)?;
        let texts = if texts.is_empty() { vec![standard(part, own)?] } else { texts };
        for text in texts {
            let owner = format!("{} {} ({})", part.name, part.version, part.license);
            owners.entry(text).or_default().push(owner);
        }
    }
    let mut groups: Vec<_> = owners.into_iter().map(|(text, owners)| (owners, text)).collect();
    groups.sort();
    let rule = "-".repeat(80);
    let mut told = String::new();
    for (owners, text) in groups {
        told += &format!("\n{rule}\n{}\n{rule}\n\n{text}\n", owners.join("\n"));
    }
    Ok(told)
}

/// Texts that lie beside the sources of a part; of several to choose from the one of MIT.
fn license_texts(part: &Part) -> Result<Vec<String>, String> {
    let entries = std::fs::read_dir(&part.folder).map_err(|error| format!("{}: {error}", part.folder))?;
    let mut names: Vec<String> = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into()).collect();
    names.sort();
    let is_license = |name: &String| {
        let name = name.to_uppercase();
        ["LICEN", "COPYING", "UNLICENSE", "NOTICE"].iter().any(|start| name.starts_with(start))
    };
    names.retain(|name| is_license(name) && Path::new(&part.folder).join(name).is_file());
    let has_choice = part.license.contains("MIT OR") || part.license.contains("OR MIT");
    let is_mit = |name: &String| name.to_uppercase().contains("MIT");
    if has_choice && !part.license.contains(" AND ") && names.iter().any(is_mit) {
        names.retain(|name| is_mit(name) || name.to_uppercase().starts_with("NOTICE"));
    }
    names.extend(CONTENTS.iter().filter(|(owner, _)| *owner == part.name).map(|(_, path)| (*path).to_owned()));
    let content = |name: &String| {
        let lines: Vec<_> =
            read(&Path::new(&part.folder).join(name))?.lines().map(|line| line.trim_end().to_owned()).collect();
        Ok(lines.join("\n").trim_matches('\n').to_owned())
    };
    names.iter().map(content).collect()
}

/// The text of MIT for a part that names this licence without its text; `own` is ours, whose words are the same.
fn standard(part: &Part, own: &str) -> Result<String, String> {
    let words = own.split_once("Permission is hereby granted").map(|(_, words)| words.trim_end());
    match words {
        Some(words) if part.license.split(" OR ").any(|license| license == "MIT") => Ok(format!(
            "MIT License (its sources name it without a text; authors: {})\n\nPermission is hereby granted{words}",
            if part.authors.is_empty() { "not named" } else { &part.authors },
        )),
        _ => Err(format!("{} {} ({}) has no text of its licence", part.name, part.version, part.license)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing but files of the repository, so this holds without network and sources of crates.
    #[test]
    fn every_part_is_the_crate_in_the_lock_file() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let list: Value = serde_json::from_str(&read(&root.join(LIST)).unwrap()).unwrap();
        let checksums = checksums(&read(&root.join("Cargo.lock")).unwrap());
        let licenses = read(&root.join(LICENSES)).unwrap();
        assert!(items(&list, "components").count() > 50);
        for part in items(&list, "components") {
            let (name, version) = (text(part, "name"), text(part, "version"));
            let locked = checksums.get(&(name.to_owned(), version.to_owned()));
            let told = text(&part["hashes"][0], "content");
            let remedy = "run `cargo xtask parts` and commit";
            assert_eq!(locked.map(String::as_str), Some(told), "{name} {version}: {remedy}");
            let owner = format!("\n{name} {version} ({})\n", text(&part["licenses"][0], "expression"));
            assert!(licenses.contains(&owner), "{name} {version} has no licence: {remedy}");
        }
        let manifest = read(&root.join("Cargo.toml")).unwrap();
        for named in ["rayon", "faer", "nalgebra", "serde"] {
            assert!(manifest.contains(named) && licenses.contains(&format!("\n{named} ")), "{named}");
        }
    }

    #[test]
    fn what_only_builds_tests_and_macros_need_is_no_part() {
        let package = |name: &str, kind: &str, source: Option<&str>| {
            json!({"id": name, "name": name, "version": "1.0.0", "license": "MIT/Apache-2.0", "source": source,
                   "manifest_path": "/x/Cargo.toml", "targets": [{"kind": [kind]}]})
        };
        let from = |name: &str, kind: Option<&str>| json!({"pkg": name, "dep_kinds": [{"kind": kind}]});
        let node = |name: &str, deps: Vec<Value>| json!({"id": name, "deps": deps});
        let names = ["linked", "below", "built", "tested", "macro"];
        let mut packages = vec![package("enmm-capi", "cdylib", None)];
        packages.extend(names.map(|name| package(name, if name == "macro" { "proc-macro" } else { "lib" }, Some("r"))));
        let mut nodes = vec![
            node("linked", vec![from("below", None)]),
            node(
                "enmm-capi",
                vec![
                    from("linked", None),
                    from("built", Some("build")),
                    from("macro", None),
                    from("tested", Some("dev")),
                ],
            ),
        ];
        nodes.extend(["below", "built", "tested", "macro"].map(|name| node(name, Vec::new())));
        let found = parts(&json!({"packages": packages, "resolve": {"nodes": nodes}}));
        let told: Vec<_> = found.iter().map(|part| (part.name.as_str(), part.license.as_str())).collect();
        assert_eq!(told, [("below", "MIT OR Apache-2.0"), ("linked", "MIT OR Apache-2.0")]);
    }

    #[test]
    fn a_part_without_any_text_of_another_licence_is_an_error() {
        let part = |license: &str| Part {
            name: "a".into(),
            version: "1.0.0".into(),
            license: license.into(),
            authors: "B".into(),
            folder: String::new(),
        };
        let own = "MIT License\n\nCopyright (c) us\n\nPermission is hereby granted, free of charge\n";
        assert!(
            standard(&part("MIT"), own)
                .unwrap()
                .ends_with("authors: B)\n\nPermission is hereby granted, free of charge")
        );
        assert!(standard(&part("BSD-3-Clause"), own).unwrap_err().contains("a 1.0.0 (BSD-3-Clause)"));
    }
}
