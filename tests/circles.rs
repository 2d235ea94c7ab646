//! No circles of files: when one file of a folder imports from a second one, the second imports nothing of the first.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A module by the names on its path from the root of its crate.
type Module = Vec<String>;

/// Import of a file as it stands in the code: `super::mesh::Triangle`.
type Import = String;

#[test]
fn no_crate_has_a_circle_of_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut crates = vec![root.join("src")];
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        for path in entries.filter(|path| path.is_dir()) {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if path.join("Cargo.toml").exists() && path.join("src").exists() {
                crates.push(path.join("src"));
            } else if ["crates", "ffi", "tools"].contains(&name) {
                folders.push(path);
            }
        }
    }
    assert!(crates.len() > 15, "crates: {crates:?}");
    let circles: Vec<String> = crates.iter().flat_map(|source| circles(&sources(source))).collect();
    assert!(circles.is_empty(), "files that import from each other:\n{}", circles.join("\n"));
}

#[test]
fn a_circle_of_three_files_is_found() {
    let source = |path: &str, text: &str| (module(path), text.to_owned());
    let straight = [
        source("lib.rs", "mod a; mod b; mod c;"),
        source("a.rs", "use crate::b::{self, inner::Thing};"),
        source("b.rs", "use super::{Root, c::Other};"),
        source("b/inner.rs", "use super::super::c;\npub struct Thing;"),
        source("c.rs", "pub struct Other; // use super::a::Text;\n#[cfg(test)]\nmod tests { use super::super::a; }"),
    ];
    assert_eq!(circles(&straight.clone().into()), Vec::<String>::new());
    let mut round = BTreeMap::from(straight);
    round.insert(module("c/deep.rs"), "fn f() { crate::a::g() }".to_owned());
    assert_eq!(circles(&round), ["a, b, c"]);
}

/// The modules of a crate with their code, without comments and tests.
fn sources(folder: &Path) -> BTreeMap<Module, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(folder).expect("a path inside").to_str().expect("a readable name");
            if path.is_dir() {
                folders.push(path);
            } else if name.ends_with(".rs") {
                found.insert(module(name), std::fs::read_to_string(&path).expect("a source file"));
            }
        }
    }
    found
}

fn module(path: &str) -> Module {
    let mut names: Module = path.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    names.pop_if(|last| ["mod", "lib", "main"].contains(&last.as_str()));
    names
}

/// Modules that import from each other, each group in one line.
fn circles(sources: &BTreeMap<Module, String>) -> Vec<String> {
    let mut arrows: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
    for (own, text) in sources {
        for target in imports(text).iter().filter_map(|import| target(own, import, sources)) {
            let shared = own.iter().zip(&target).take_while(|(a, b)| a == b).count();
            // An import from a parent or from a child is none between two files of a folder.
            if shared < own.len() && shared < target.len() {
                arrows.entry(own[..=shared].into()).or_default().insert(target[..=shared].into());
            }
        }
    }
    let reached: BTreeMap<&Module, BTreeSet<&Module>> =
        arrows.keys().map(|from| (from, reach(from, &arrows))).collect();
    let both = |a: &Module, b: &Module| reached[a].contains(b) && reached.get(b).is_some_and(|of| of.contains(a));
    let groups: BTreeSet<String> = arrows
        .keys()
        .filter(|from| reached[*from].contains(*from))
        .map(|from| arrows.keys().filter(|to| both(from, to)).map(|m| m.join("::")).collect::<Vec<_>>().join(", "))
        .collect();
    groups.into_iter().collect()
}

/// Modules that a module imports from, directly or through others.
fn reach<'a>(from: &Module, arrows: &'a BTreeMap<Module, BTreeSet<Module>>) -> BTreeSet<&'a Module> {
    let mut reached = BTreeSet::new();
    let mut waiting: Vec<&Module> = arrows[from].iter().collect();
    while let Some(next) = waiting.pop() {
        if reached.insert(next) {
            waiting.extend(arrows.get(next).into_iter().flatten());
        }
    }
    reached
}

/// The file that an import leads to: the longest beginning of its path that is one.
fn target(own: &Module, import: &Import, sources: &BTreeMap<Module, String>) -> Option<Module> {
    let mut names = import.split("::").map(|name| name.trim().to_owned()).peekable();
    let mut path = own.clone();
    match names.peek()?.as_str() {
        "crate" => path.clear(),
        "self" => {}
        "super" => {
            path.pop();
        }
        child if sources.contains_key(&[own.as_slice(), &[child.to_owned()]].concat()) => path.push(child.to_owned()),
        _ => return None,
    }
    names.next();
    while names.next_if(|name| name == "super").is_some() {
        path.pop();
    }
    path.extend(names);
    while !sources.contains_key(&path) {
        path.pop()?;
    }
    Some(path)
}

/// All imports of a file and all paths that begin with `crate`, `super` or `self`, up to its tests.
fn imports(text: &str) -> Vec<Import> {
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let code = code.join("\n");
    let code = code.split("#[cfg(test)]").next().unwrap_or_default();
    let statements = code.split(';').filter_map(|statement| {
        let at =
            statement.rfind("use ").filter(|&at| statement[..at].ends_with(|c: char| c.is_whitespace()) || at == 0);
        at.map(|at| &statement[at + 4..])
    });
    let mut found: Vec<Import> = statements.flat_map(|tree| leaves("", tree.trim())).collect();
    for root in ["crate::", "super::", "self::"] {
        let paths = code.match_indices(root).filter(|(at, _)| !code[..*at].ends_with([':', '_', '{']));
        let of_path = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':');
        found.extend(paths.map(|(at, _)| code[at..].split(of_path).next().unwrap_or_default().to_owned()));
    }
    found
}

/// The single imports of a tree such as `super::{Root, mesh::{Mesh, Triangle}}`.
fn leaves(before: &str, tree: &str) -> Vec<Import> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![format!("{before}{}", tree.split(" as ").next().unwrap_or_default().trim())];
    };
    let head = format!("{before}{}", head.trim());
    let inside = rest.rsplit_once('}').map_or(rest, |(inside, _)| inside);
    let mut depth = 0;
    let branches = inside.split(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    branches.map(str::trim).filter(|branch| !branch.is_empty()).flat_map(|branch| leaves(&head, branch)).collect()
}
