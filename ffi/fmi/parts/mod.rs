//! The Rust crates in our libraries and our program: a list of them (CycloneDX) and their licences, which travel in
//! every FMU and wheel. Builds make both; the same crates give the same bytes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

/// Packages whose libraries and programs leave the repository.
const SHIPPED: [&str; 3] = ["enmm-cli", "enmm-capi", "enmm-fmu"];
/// Platforms that they are built for.
const TARGETS: [&str; 5] = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-pc-windows-gnu",
    "x86_64-pc-windows-msvc",
    "aarch64-apple-darwin",
];
/// Name of the file that lists the crates.
pub const LIST: &str = "sbom.cdx.json";
/// Name of the file with the licences of enmm and of these.
pub const LICENSES: &str = "LICENSES";

/// Licences of the runtime libraries that the linker of mingw-w64 adds.
const WINDOWS: &str = include_str!("windows.txt");

/// Licences of fonts and the like inside a crate: crate, file.
const CONTENTS: [(&str, &str); 1] = [("dejavu", "assets/dejavu-fonts-ttf-2.37/LICENSE")];

/// Texts of both files.
pub struct Parts {
    /// That of [`LIST`].
    pub list: String,
    /// That of [`LICENSES`].
    pub licenses: String,
}

/// A crate from a registry.
struct Part {
    name: String,
    version: String,
    license: String,
    authors: String,
    /// Where its sources are.
    folder: String,
}

/// Lists the crates that `Cargo.lock` of the repository names, for all platforms. Without one, as in a build from
/// packages, nothing says which crates it contains, and the list is empty.
///
/// # Errors
/// When cargo cannot name the crates, or the sources or the licence of one are missing.
pub fn of(repository: Option<&Path>) -> Result<Parts, String> {
    let Some(root) = repository else {
        let licenses = "enmm may be used under MIT or Apache-2.0. This build was not made in the repository of enmm, \
                        so\nthe licences of the Rust crates in its libraries and its program are not listed here.\n";
        return Ok(Parts { list: list(&[], &BTreeMap::new())?, licenses: licenses.to_owned() });
    };
    let metadata = metadata(root)?;
    let parts = parts(&metadata);
    let checksums = checksums(&read(&root.join("Cargo.lock"))?);
    let mit = read(&root.join("LICENSE-MIT"))?;
    let apache = read(&root.join("LICENSE-APACHE"))?;
    let rule = "-".repeat(80);
    let head = format!(
        "enmm may be used under either of the first two licences below. Its libraries and its program contain Rust\n\
         crates under the licences behind these two; each begins with the crates that it is for. The Rust standard\n\
         library is there as well, under MIT or Apache-2.0.\n\n{rule}\n\n{mit}\n{rule}\n\n{apache}"
    );
    Ok(Parts { list: list(&parts, &checksums)?, licenses: head + &licenses(&parts, &mit)? + WINDOWS })
}

/// The crates as cargo resolves them. Sources of other platforms and of tests may be missing on this machine although
/// it can build: cargo then downloads them.
fn metadata(root: &Path) -> Result<Value, String> {
    let ask = |offline: &[&str]| {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["metadata", "--locked", "--format-version", "1"]).args(offline).current_dir(root);
        TARGETS.iter().for_each(|target| {
            cargo.args(["--filter-platform", target]);
        });
        // Flags of this build, such as sanitizers, need not exist for the other platforms.
        cargo.env_remove("CARGO_ENCODED_RUSTFLAGS").env_remove("RUSTFLAGS");
        cargo.output().map_err(|error| format!("cargo metadata: {error}"))
    };
    let mut answer = ask(&["--offline"])?;
    if !answer.status.success() {
        answer = ask(&[])?;
    }
    if !answer.status.success() {
        let reason = String::from_utf8_lossy(&answer.stderr);
        return Err(format!(
            "cannot list the crates for the licences of FMUs and wheels: run `cargo fetch --locked` where there is a \
             network, and build again (cargo metadata: {})",
            reason.trim()
        ));
    }
    serde_json::from_slice(&answer.stdout).map_err(|error| format!("cargo metadata: {error}"))
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
    let mut all = String::new();
    for (owners, text) in groups {
        all += &format!("\n{rule}\n{}\n{rule}\n\n{text}\n", owners.join("\n"));
    }
    Ok(all)
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

    #[test]
    fn crates_of_builds_tests_and_macros_are_left_out() {
        let package = |name: &str, kind: &str, source: Option<&str>| {
            json!({"id": name, "name": name, "version": "1.0.0", "license": "MIT/Apache-2.0", "source": source,
                   "manifest_path": "/x/Cargo.toml", "targets": [{"kind": [kind]}]})
        };
        let from = |name: &str, kind: Option<&str>| json!({"pkg": name, "dep_kinds": [{"kind": kind}]});
        let node = |name: &str, deps: Vec<Value>| json!({"id": name, "deps": deps});
        let names = ["linked", "below", "built", "tested", "macro"];
        let mut packages = vec![package("enmm-capi", "cdylib", None)];
        packages.extend(names.map(|name| package(name, if name == "macro" { "proc-macro" } else { "lib" }, Some("r"))));
        let kinds = [("linked", None), ("built", Some("build")), ("macro", None), ("tested", Some("dev"))];
        let of_library = kinds.into_iter().map(|(name, kind)| from(name, kind)).collect();
        let mut nodes = vec![node("linked", vec![from("below", None)]), node("enmm-capi", of_library)];
        nodes.extend(["below", "built", "tested", "macro"].map(|name| node(name, Vec::new())));
        let found = parts(&json!({"packages": packages, "resolve": {"nodes": nodes}}));
        let named: Vec<_> = found.iter().map(|part| (part.name.as_str(), part.license.as_str())).collect();
        assert_eq!(named, [("below", "MIT OR Apache-2.0"), ("linked", "MIT OR Apache-2.0")]);
    }

    #[test]
    fn a_part_without_any_text_of_another_licence_is_an_error() {
        let part = |license: &str| {
            let [name, version, license, authors, folder] = ["a", "1.0.0", license, "B", ""].map(str::to_owned);
            Part { name, version, license, authors, folder }
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
