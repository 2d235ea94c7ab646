//! The rules of the house, read off the files of the repository. Every check is also seen failing on a small text.

mod circles;
mod recipes;

use std::collections::BTreeSet;
use std::path::Path;

/// Rooms of `src/` in rank order, each with its most lines; each imports only from those before it.
const ROOMS: [(&str, usize); 13] = [
    ("geometry", 3450),
    ("cover", 1300),
    ("rock", 1800),
    ("mechanics", 2900),
    ("contact", 8100),
    ("flow", 700),
    ("state", 2400),
    ("step", 3550),
    ("fracture", 1260),
    ("recut", 1150),
    ("monitor", 500),
    ("model", 8450),
    ("cosimulation", 2_950),
];
const COLUMNS_MAX: usize = 120;
const README_LINES_MAX: usize = 200;
/// Most comments of the whole repository that begin with the word `What`.
const RIDDLES_MAX: usize = 60;
/// Folders of programs that may print.
const PRINTERS: [&str; 4] = ["crates/cli/", "tools/", "tests/", "examples/"];
/// Floors of the house: a crate depends on crates of lower floors alone, tests excepted.
const FLOORS: [&[&str]; 9] = [
    &["enmm-case", "enmm-field", "enmm-handles", "enmm-lanes", "enmm-patch", "enmm-seepage", "enmm-seismology"],
    &["enmm"],
    &["enmm-implicit", "enmm-io", "enmm-observe", "enmm-stability", "enmm-ensemble"],
    &["enmm-picture", "enmm-report"],
    &["enmm-export", "enmm-record"],
    &["enmm-run", "enmm-fmi"],
    &["enmm-verification", "enmm-fmu"],
    &["enmm-cli", "enmm-capi"],
    &["enmm-fuzz", "enmm-peers", "xtask"],
];
/// Rooms whose results must not depend on the order of a hash.
const ORDERED: [&str; 4] = ["src/rock/", "src/mechanics/", "src/contact/", "src/step/"];
/// Folders whose results have the same bits on every platform.
const SAME_BITS: [&str; 13] = [
    "src/",
    "crates/case/src/",
    "crates/stability/src/",
    "crates/run/src/",
    "crates/record/src/",
    "crates/report/src/",
    "crates/export/src/",
    "crates/field/src/",
    "crates/observe/src/",
    "crates/patch/src/",
    "crates/picture/src/",
    "crates/seepage/src/",
    "crates/seismology/src/",
];
/// Functions whose last bits differ from system to system; those of `libm` do not.
const OF_THE_SYSTEM: [&str; 22] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "exp2", "exp_m1",
    "ln", "ln_1p", "log2", "log10", "powf", "cbrt", "hypot", "mul_add",
];
/// Folders that may use `unsafe`: hosts' pointers, instructions of some processors.
const UNSAFE: [&str; 3] = ["ffi/", "crates/lanes/", "tools/"];
/// The crate that both versions of FMI share, and its one folder that uses `unsafe`.
const FMI: &str = "ffi/fmi/src/";
const RAW: &str = "ffi/fmi/src/raw/";
/// The door to the private rooms of the engine, its file and the folder that may go through it beside tests.
const DOOR: &str = "internals";
const BEHIND_THE_DOOR: [&str; 2] = ["src/lib.rs", "crates/implicit/"];
/// Folder of packages that are no part of a release.
const TOOLS: &str = "tools/";
/// The vertex rule, and the file with its constants.
const VERTEX_RULE: &str = "src/contact/vertex_rule/";
const CONTACT_CONSTANTS: &str = "src/contact/constants.rs";
const THEORY: &str = "docs/theory.md";
/// Documents that send the reader to files of the repository.
const GUIDES: [&str; 2] = ["ARCHITECTURE.md", "CONTRIBUTING.md"];
/// Pages for users, whose paths are those of their own folders.
const BOOK: &str = "docs/book/";
/// Paths of the reader's choice in guides.
const PLACEHOLDERS: [&str; 3] =
    ["tests/issue_what_it_did.rs", "tests/NAME.rs", "crates/verification/src/problems/xx.rs"];
/// Table of contents of the site.
const SUMMARY: &str = "docs/SUMMARY.md";
const GLOSSARY: &str = "docs/glossary.md";
/// Most rows of the glossary without a word of the field.
const WORDLESS_MAX: usize = 8;
/// Rooms with a table of types in the glossary.
const EXPLAINED: [&str; 3] = ["contact", "step", "mechanics"];
/// Heads of the sections that describe a life by names of the code.
const TALES: &str = "## The life of a ";

/// A file of the repository; `text` is empty for kinds that are not text.
struct File {
    path: String,
    text: String,
}

impl File {
    fn is(&self, extension: &str) -> bool {
        self.path.ends_with(extension)
    }

    fn within(&self, folders: &[&str]) -> bool {
        folders.iter().any(|folder| self.path.starts_with(folder))
    }

    /// Whether it lies in the tests of the engine or of another crate.
    fn is_test(&self) -> bool {
        self.path.starts_with("tests/") || self.path.contains("/tests/")
    }

    fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default()
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The repository against the rules.

#[test]
fn rooms_import_only_lower_ranks() {
    hold(each(&[""], &["src/"], room_problems));
}

#[test]
fn rooms_are_small_and_open_no_files() {
    hold(each(&[".rs"], &["src/"], file_access_problems));
    let files = repository();
    for (room, most) in ROOMS {
        let folder = format!("src/{room}/");
        let lines: usize = files.iter().filter(|file| file.within(&[&folder])).map(|f| f.text.lines().count()).sum();
        assert!((most / 2..=most).contains(&lines), "{folder} has {lines} lines of {most} at most");
    }
}

#[test]
fn lines_fit_the_width() {
    hold(each(&[".rs", ".toml", ".md"], &[""], width_problems));
}

#[test]
fn the_readme_is_short() {
    hold(each(&["README.md"], &["README.md"], readme_problems));
}

#[test]
fn comments_name_things() {
    let comments = repository().iter().filter(|file| file.is(".rs")).map(|file| riddles(&file.text)).sum::<usize>();
    assert!(comments <= RIDDLES_MAX, "{comments} comments begin with `What`: say the noun");
}

#[test]
fn constants_in_tables_of_documents_are_those_of_the_code() {
    let files = repository();
    let rows: Vec<Constant> = files.iter().filter(|file| file.is(".md")).flat_map(constants).collect();
    assert!(rows.len() > 45, "only {} constants", rows.len());
    hold(rows.iter().filter_map(|row| constant_problem(row, &files)).collect());
    hold(each(&[".md"], &[""], hidden_problems));
}

#[test]
fn functions_fit_a_screen() {
    hold(each(&[".rs"], &[""], length_problems));
}

#[test]
fn nothing_is_unfinished_switched_off_unsafe_or_printed() {
    hold(each(&[".rs"], &[""], word_problems));
}

#[test]
fn results_use_no_mathematical_functions_of_the_system() {
    hold(each(&[".rs"], &SAME_BITS, system_problems));
}

#[test]
fn packages_contain_the_files_that_they_include() {
    hold(each(&[".rs"], &[""], include_problems));
}

#[test]
fn no_mark_of_unfinished_work_is_left() {
    hold(each(&[""], &[""], mark_problems));
}

#[test]
fn no_host_of_a_registry_is_named() {
    hold(each(&[""], &[""], host_problems));
}

#[test]
fn actions_of_workflows_are_named_by_hash() {
    hold(each(&[".yml"], &[""], action_problems));
}

#[test]
fn every_test_file_says_what_it_claims_and_is_compiled() {
    hold(each(&[".rs"], &[""], header_problems));
    hold(lost_tests(&repository()));
}

#[test]
fn crates_depend_on_lower_floors_alone() {
    let manifests: Vec<File> = repository().into_iter().filter(|file| file.name() == "Cargo.toml").collect();
    let manifests: Vec<&File> = manifests.iter().filter(|file| !file.path.contains("/peers/")).collect();
    hold(manifests.iter().flat_map(|file| floor_problems(file)).collect());
    let known = manifests.iter().filter(|file| floor(&package(&file.text)).is_some()).count();
    assert_eq!(known, FLOORS.iter().map(|floor| floor.len()).sum::<usize>(), "every crate has a floor");
}

#[test]
fn only_the_implicit_integrator_and_tests_go_behind_the_interface() {
    hold(each(&[".rs"], &[""], door_problems));
}

#[test]
fn each_rule_of_contact_has_one_home_and_no_number_of_its_own() {
    let files = repository();
    let sources: Vec<&File> = files.iter().filter(|file| file.is(".rs") && file.within(&["src/"])).collect();
    for rule in ["rule 1", "rule 2", "rule 3", "rule 4"] {
        let homes: usize = sources.iter().map(|file| file.text.to_lowercase().matches(rule).count()).sum();
        assert_eq!(homes, 1, "{rule} in src/");
    }
    let of_rule: Vec<&&File> = sources.iter().filter(|file| file.within(&[VERTEX_RULE])).collect();
    assert!(of_rule.len() > 4, "the vertex rule in {VERTEX_RULE}");
    hold(of_rule.iter().flat_map(|file| number_problems(file)).collect());
    let lengths = of_rule.iter().flat_map(|file| functions(&code_only(&file.text)));
    assert!(lengths.map(|(.., length)| length).max() <= Some(40), "a function of more than 40 lines");
}

#[test]
fn modules_with_children_are_called_mod() {
    let files = repository();
    let has_folder = |file: &File| {
        let folder = format!("{}/", file.path.trim_end_matches(".rs"));
        !file.is_test() && files.iter().any(|other| other.path.starts_with(&folder) && other.is(".rs"))
    };
    let twice = files.iter().filter(|file| file.is(".rs") && has_folder(file));
    hold(twice.map(|file| format!("{}: say mod.rs in its folder", file.path)).collect());
}

#[test]
fn equations_are_numbered_in_order_and_citations_exist() {
    let files = repository();
    let theory = files.iter().find(|file| file.path == THEORY).expect("docs/theory.md");
    let numbers = equation_numbers(&theory.text);
    assert_eq!(numbers, (1..=numbers.len() as u32).collect::<Vec<_>>(), "equations of {THEORY}, in their order");
    assert!(numbers.len() >= 19);
    let citing =
        files.iter().filter(|file| (file.is(".rs") && file.within(&["src/", "crates/cli/"])) || file.is(".md"));
    hold(citing.flat_map(|file| citation_problems(file, &numbers)).collect());
}

#[test]
fn links_between_documents_resolve() {
    let files = repository();
    let exists = |path: &str| {
        let folder = format!("{}/", path.trim_end_matches('/'));
        path.is_empty() || files.iter().any(|file| file.path == path || file.path.starts_with(&folder))
    };
    hold(files.iter().filter(|file| file.is(".md")).flat_map(|file| link_problems(file, &exists)).collect());
}

#[test]
fn files_of_modules_exist() {
    let files = repository();
    let exists = |path: &str| files.iter().any(|file| file.path == path);
    hold(files.iter().filter(|file| file.is(".rs")).flat_map(|file| module_problems(file, &exists)).collect());
}

#[test]
fn every_page_is_in_the_summary_of_the_site() {
    let files = repository();
    let summary = files.iter().find(|file| file.path == SUMMARY).expect(SUMMARY);
    hold(summary_problems(summary, &files));
}

#[test]
fn paths_that_guides_name_exist() {
    let files = repository();
    let is_guide = |file: &&File| {
        GUIDES.contains(&&*file.path) || file.within(&["docs/"]) && !file.within(&[BOOK]) && file.is(".md")
    };
    let guides: Vec<&File> = files.iter().filter(is_guide).collect();
    assert!(guides.len() > GUIDES.len());
    hold(guides.into_iter().flat_map(|guide| path_problems(guide, &files)).collect());
}

#[test]
fn names_in_the_lives_of_a_step_and_a_contact_are_those_of_the_code() {
    let files = repository();
    let guide = files.iter().find(|file| file.path == GUIDES[0]).expect("ARCHITECTURE.md");
    let code: String = files.iter().filter(|file| file.within(&["src/"])).map(|file| code_only(&file.text)).collect();
    assert!(guide.text.matches(TALES).count() == 2, "the lives of a step and of a contact");
    hold(name_problems(guide, &words(&code).into_iter().map(|(_, word, _)| word).collect()));
}

#[test]
fn the_glossary_gives_words_of_the_field_for_names_of_the_code() {
    let files = repository();
    let text = |path: &str| files.iter().find(|file| file.path == path).unwrap_or_else(|| panic!("{path}"));
    let exported = exported_types(&text("src/model/mod.rs").text);
    assert!(exported.len() >= 5, "types of lower rooms that `model` exports: {exported:?}");
    let within = |file: &&File| file.is(".rs") && file.within(&["src/", "crates/"]);
    let code: String = files.iter().filter(within).map(|file| code_only(&file.text)).collect();
    let known = words(&code).into_iter().map(|(_, word, _)| word).collect();
    hold(glossary_problems(text(GLOSSARY), &exported, &known));
}

#[test]
fn no_shared_data_is_committed() {
    hold(each(&[""], &[""], shared_data_problems));
}

// ---------------------------------------------------------------------------------------------------------------------
// The rules.

fn room_problems(file: &File) -> Vec<String> {
    let inside = file.path.trim_start_matches("src/");
    if inside == "lib.rs" {
        return Vec::new();
    }
    let rank = |room: &str| ROOMS.iter().position(|(known, _)| *known == room);
    let room = inside.split('/').next().filter(|_| inside.contains('/')).unwrap_or_default();
    let Some(own) = rank(room) else { return vec![format!("{}: lies in no known room", file.path)] };
    let code = code_only(&file.text);
    let mut problems = Vec::new();
    for (line, other) in names_after(&code, "crate::") {
        match rank(&other) {
            Some(rank) if rank <= own => {}
            Some(_) => problems.push(format!("{}:{line}: room `{room}` imports the higher `{other}`", file.path)),
            None => problems.push(format!("{}:{line}: `crate::{other}` names no room", file.path)),
        }
    }
    let climbs = if file.name() == "mod.rs" && inside.matches('/').count() == 1 { "super::" } else { "super::super::" };
    for (line, other) in names_after(&code, climbs) {
        if climbs == "super::super::" || (rank(&other).is_some() && other != room) {
            problems.push(format!("{}:{line}: `{climbs}{other}` leaves the room: say `crate::`", file.path));
        }
    }
    problems
}

/// Uses of the private rooms of the engine.
fn door_problems(file: &File) -> Vec<String> {
    if file.is_test() || file.within(&BEHIND_THE_DOOR) {
        return Vec::new();
    }
    let code = code_only(&file.text);
    let named = words(&code).into_iter().filter(|(_, word, _)| *word == DOOR);
    named.map(|(line, ..)| format!("{}:{line}: `{DOOR}`: use `enmm::model`", file.path)).collect()
}

fn file_access_problems(file: &File) -> Vec<String> {
    let named = names_after(&code_only(&file.text), "std::").into_iter().filter(|(_, other)| other == "fs");
    named.map(|(line, _)| format!("{}:{line}: opens a file, which is for `crates/io/`", file.path)).collect()
}

/// Tables and lines with an address are excepted in Markdown, because neither can be broken.
fn width_problems(file: &File) -> Vec<String> {
    let excepted = |line: &str| file.is(".md") && (line.trim_start().starts_with('|') || line.contains("://"));
    let wide = |line: &str| line.chars().count() > COLUMNS_MAX && !excepted(line);
    numbered(&file.text).filter(|(_, line)| wide(line)).map(|(k, _)| format!("{}:{k}: too wide", file.path)).collect()
}

/// Lines of a README beyond its length, and those that are too wide, even with an address.
fn readme_problems(file: &File) -> Vec<String> {
    let bad = |(k, line): &(usize, &str)| *k > README_LINES_MAX || line.chars().count() > COLUMNS_MAX;
    numbered(&file.text).filter(bad).map(|(k, _)| format!("{}:{k}: too long or too wide", file.path)).collect()
}

/// Number of comments that begin with the word `What` in place of a noun.
fn riddles(text: &str) -> usize {
    let starts = |line: &&str| {
        let line = line.trim_start();
        line.starts_with("//") && line.trim_start_matches(['/', '!']).starts_with(" What ")
    };
    text.lines().filter(starts).count()
}

/// Row of a table with the columns constant, value and file.
struct Constant {
    at: String,
    name: String,
    value: String,
    file: String,
}

/// Rows of the tables of constants in a document.
fn constants(document: &File) -> Vec<Constant> {
    let mut found = Vec::new();
    let mut inside = false;
    for (k, line) in numbered(&document.text) {
        inside = line.starts_with("| constant | value | file |") || (inside && line.starts_with('|'));
        let cells: Vec<String> = line.split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect();
        if let [_, name, value, file, ..] = &cells[..]
            && inside
            && line.starts_with("| `")
        {
            let at = format!("{}:{k}", document.path);
            found.push(Constant { at, name: name.clone(), value: value.clone(), file: file.clone() });
        }
    }
    found
}

/// A constant of a document that its file does not have with this value.
fn constant_problem(row: &Constant, files: &[File]) -> Option<String> {
    let Constant { at, name, value, file } = row;
    let text = files.iter().find(|found| found.path == *file).map_or("", |found| &found.text);
    let quoted = numbers(value);
    let is_same = |line: &str| value_of(line.trim(), name).is_some_and(|value| numbers(value) == quoted);
    let fits = !quoted.is_empty() && text.lines().any(is_same);
    (!fits).then(|| format!("{at}: `{name}` is not {value} in {file}"))
}

/// Value in `const NAME: … = VALUE;`, `NAME: VALUE,` or, of a key of a case, `pub NAME: … = VALUE => …`.
fn value_of<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    match line.split_once("const ") {
        Some((_, rest)) => rest.strip_prefix(name)?.strip_prefix(": ")?.split_once(" = ")?.1.strip_suffix(';'),
        None => {
            let rest = line.trim_start_matches("pub ").strip_prefix(name)?.strip_prefix(": ")?;
            let value = rest.split_once(" = ").map_or(rest, |(_, value)| value);
            Some(value.split(" =>").next()?.trim_end_matches(','))
        }
    }
}

/// The number at the start of each part between commas; units and factors behind it do not count.
fn numbers(value: &str) -> Vec<f64> {
    let number = |part: &str| part.split(' ').next()?.trim_end_matches('°').replace('_', "").parse().ok();
    value.trim_matches(['[', ']']).split(", ").filter_map(number).collect()
}

/// Invisible marks of figures.
fn hidden_problems(file: &File) -> Vec<String> {
    let marked = numbered(&file.text).filter(|(_, line)| line.contains("<!--="));
    marked.map(|(k, _)| format!("{}:{k}: an invisible mark: use a table of constants", file.path)).collect()
}

fn length_problems(file: &File) -> Vec<String> {
    let limit = if file.is_test() || file.within(&["examples/"]) { 80 } else { 60 };
    let long = functions(&code_only(&file.text)).into_iter().filter(|&(_, _, length)| length > limit);
    long.map(|(line, name, length)| format!("{}:{line}: `{name}` has {length} lines", file.path)).collect()
}

fn word_problems(file: &File) -> Vec<String> {
    let code = code_only(&file.text);
    let mut problems = Vec::new();
    for (line, word, follows) in words(&code) {
        let bad = match word {
            "todo" | "unimplemented" | "dbg" => follows == Some('!'),
            "print" | "println" | "eprint" | "eprintln" => {
                follows == Some('!') && !file.is_test() && !file.within(&PRINTERS)
            }
            "unsafe" => !file.within(&UNSAFE) || file.within(&[FMI]) && !file.within(&[RAW]),
            "HashMap" | "HashSet" => file.within(&ORDERED),
            _ => false,
        };
        if bad {
            problems.push(format!("{}:{line}: `{word}`", file.path));
        }
    }
    let ignored = numbered(&code).filter(|(_, line)| line.replace(' ', "").contains("#[ignore"));
    problems.extend(ignored.map(|(line, _)| format!("{}:{line}: a test that is switched off", file.path)));
    problems
}

/// Numbers with a point or a power other than 0.0: constants have a name elsewhere.
fn action_problems(file: &File) -> Vec<String> {
    let is_hash = |version: &str| version.len() == 40 && version.bytes().all(|b| b.is_ascii_hexdigit());
    let used = file.text.lines().filter_map(|line| line.split_once("uses: ")?.1.split_whitespace().next());
    let loose = used.filter(|action| !action.split_once('@').is_some_and(|(_, version)| is_hash(version)));
    loose.map(|action| format!("{}: {action}: name the version by the hash of its commit", file.path)).collect()
}

fn number_problems(file: &File) -> Vec<String> {
    let is_number = |word: &&str| {
        let is_real = word.contains('.') || word.contains('e');
        *word != "0.0" && is_real && word.starts_with(|c: char| c.is_ascii_digit()) && word.parse::<f64>().is_ok()
    };
    let code = code_only(&file.text);
    let within = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let found = numbered(&code).flat_map(|(k, line)| line.split(|c| !within(c)).filter(is_number).map(move |n| (k, n)));
    found.map(|(k, number)| format!("{}:{k}: {number} belongs into {CONTACT_CONSTANTS}", file.path)).collect()
}

/// Calls of mathematical functions of the system, in front of the tests of a file.
fn system_problems(file: &File) -> Vec<String> {
    let code = code_only(&file.text);
    let code = code.split("#[cfg(test)]").next().unwrap_or_default();
    let called =
        |line: &str, name: &&str| line.contains(&format!(".{name}(")) || line.contains(&format!("f64::{name}"));
    let named =
        numbered(code).filter_map(|(k, line)| OF_THE_SYSTEM.iter().find(|name| called(line, name)).map(|n| (k, n)));
    let of_results = file.name() != "tests.rs";
    named.filter(|_| of_results).map(|(k, name)| format!("{}:{k}: `{name}`: call libm", file.path)).collect()
}

/// Files that the library of a package includes from folders of others, which its archive lacks.
fn include_problems(file: &File) -> Vec<String> {
    let Some((package, _)) = file.path.split_once("src/").filter(|_| !file.within(&[TOOLS])) else { return Vec::new() };
    let code = file.text.split("#[cfg(test)]").next().unwrap_or_default();
    let included = |line: &str| {
        let (_, rest) = line.split_once("include_str!(\"").or_else(|| line.split_once("include_bytes!(\""))?;
        Some(join(&file.path, rest.split('"').next()?))
    };
    let foreign = numbered(code).filter_map(|(k, line)| Some((k, included(line)?)));
    let foreign = foreign.filter(|(_, path)| !path.starts_with(package));
    foreign.map(|(k, path)| format!("{}:{k}: includes {path} of another package", file.path)).collect()
}

fn mark_problems(file: &File) -> Vec<String> {
    let marks = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("X", "XX")];
    let marked = words(&file.text).into_iter().filter(|(_, word, _)| marks.contains(word));
    marked.map(|(line, word, _)| format!("{}:{line}: {word}", file.path)).collect()
}

/// Cargo's own lock file names its registry and is excepted.
fn host_problems(file: &File) -> Vec<String> {
    let hosts = [
        concat!("crates", ".io"),
        concat!("static.rust", "-lang.org"),
        concat!("pypi", ".org"),
        concat!("python", "hosted.org"),
        concat!("npm", "js.org"),
        concat!("npm", "js.com"),
        concat!("deb.debian", ".org"),
        concat!("--index", "-url"),
    ];
    let named = |line: &str| hosts.into_iter().find(|host| line.contains(host));
    let lines = numbered(&file.text).filter(|_| file.name() != "Cargo.lock");
    lines.filter_map(|(k, line)| Some(format!("{}:{k}: names {}", file.path, named(line)?))).collect()
}

/// Files that are no helpers of tests begin with their claim.
fn header_problems(file: &File) -> Vec<String> {
    let own = file.path.rsplit_once('/').is_some_and(|(folder, _)| folder.ends_with("tests"));
    let bare = own && !file.path.contains("/src/") && !file.path.contains("/peers/") && !file.text.starts_with("//! ");
    bare.then(|| format!("{}: does not begin with a `//!` line", file.path)).into_iter().collect()
}

/// Files beside a `main.rs` of tests that neither it nor the manifest names: cargo compiles no others.
fn lost_tests(files: &[File]) -> Vec<String> {
    let text = |path: &str| files.iter().find(|file| file.path == path).map_or("", |file| &file.text);
    let tests = files.iter().filter(|file| file.is(".rs") && file.is_test() && !file.path.contains("/src/"));
    let lost = |file: &&File| {
        let (folder, name) = file.path.rsplit_once('/').unwrap_or_default();
        let (owner, stem) = (folder.trim_end_matches("tests"), name.trim_end_matches(".rs"));
        let named = |from: &str| text(&format!("{folder}/{from}.rs")).contains(&format!("mod {stem};"));
        let manifest = text(&format!("{owner}Cargo.toml"));
        folder.ends_with("tests")
            && manifest.contains("autotests = false")
            && !["main", "tidy"].iter().any(|from| named(from))
            && !manifest.contains(&format!("\"tests/{name}\""))
    };
    tests.filter(lost).map(|file| format!("{}: no test binary names it", file.path)).collect()
}

/// Name of the package of a manifest.
fn package(manifest: &str) -> String {
    let name = manifest.split("[package]").nth(1).and_then(|rest| rest.split("name = \"").nth(1));
    name.and_then(|rest| rest.split('"').next()).unwrap_or_default().to_owned()
}

fn floor(package: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&package))
}

/// Dependencies of a package, not those of its tests, on its own floor or above.
fn floor_problems(file: &File) -> Vec<String> {
    let own = package(&file.text);
    let Some(rank) = floor(&own) else { return vec![format!("{}: `{own}` is on no floor", file.path)] };
    let section = file.text.split("\n[dependencies]\n").nth(1).unwrap_or_default();
    let section = section.split("\n[").next().unwrap_or_default();
    let names = numbered(section).map(|(_, line)| line.split(['.', ' ', '=']).next().unwrap_or_default());
    let names = names.map(|name| if name == "engine" { "enmm" } else { name });
    let upward = names.filter(|name| floor(name).is_some_and(|other| other >= rank));
    upward.map(|name| format!("{}: `{own}` depends on `{name}`, which is no lower floor", file.path)).collect()
}

fn citation_problems(file: &File, numbers: &[u32]) -> Vec<String> {
    let wrong = citations(&file.text).into_iter().filter(|(_, number)| !numbers.contains(number));
    wrong.map(|(line, number)| format!("{}:{line}: (Eq. {number}) is not in {THEORY}", file.path)).collect()
}

fn link_problems(file: &File, exists: &dyn Fn(&str) -> bool) -> Vec<String> {
    let dead = |target: &str| {
        let path = target.split('#').next().unwrap_or_default();
        !target.contains("://")
            && !target.starts_with("mailto:")
            && !path.is_empty()
            && !exists(&join(&file.path, path))
    };
    let links = links(&file.text).into_iter().filter(|(_, target)| dead(target));
    links.map(|(line, target)| format!("{}:{line}: link to {target} leads nowhere", file.path)).collect()
}

/// Modules whose file is not where their attribute says: no test builds programs outside the workspace.
fn module_problems(file: &File, exists: &dyn Fn(&str) -> bool) -> Vec<String> {
    let path = |line: &str| Some(join(&file.path, line.strip_prefix("#[path = \"")?.split('"').next()?));
    let named = numbered(&file.text).filter_map(|(k, line)| Some((k, path(line)?)));
    let lost = named.filter(|(_, path)| !exists(path));
    lost.map(|(k, path)| format!("{}:{k}: there is no {path}", file.path)).collect()
}

/// Pages of the site that its table of contents does not list.
fn summary_problems(summary: &File, files: &[File]) -> Vec<String> {
    let listed: BTreeSet<String> = links(&summary.text).iter().map(|(_, to)| join(&summary.path, to)).collect();
    let pages = files.iter().filter(|file| file.within(&["docs/book/"]) && file.is(".md"));
    let missing = pages.filter(|page| !listed.contains(&page.path));
    missing.map(|page| format!("{}: is not in {}", page.path, summary.path)).collect()
}

/// A path may be given from the root or by its end; a `*` stands for anything at its end.
fn path_problems(guide: &File, files: &[File]) -> Vec<String> {
    let exists = |path: &str| {
        let bare = path.trim_end_matches(['*', '/']);
        let [end, folder, inner] = [format!("/{bare}"), format!("{bare}/"), format!("/{bare}/")];
        let is = |file: &File| {
            let path = &file.path;
            path == bare || path.ends_with(&end) || path.starts_with(&folder) || path.contains(&inner)
        };
        PLACEHOLDERS.contains(&path) || files.iter().any(is)
    };
    let of_path = |c: char| is_of_word(c) || "./*-".contains(c);
    let source = |name: &str| [".rs", ".py", ".c", ".h", ".hpp", ".cpp"].iter().any(|end| name.ends_with(end));
    let paths = quoted(&guide.text).into_iter().filter(|(_, word)| {
        word.chars().all(of_path) && !word.starts_with('/') && (word.contains('/') || source(word))
    });
    let dead = paths.filter(|(_, path)| !exists(path));
    dead.map(|(line, path)| format!("{}:{line}: `{path}` is no file or folder", guide.path)).collect()
}

/// Names in the sections of tales that no code has.
fn name_problems(guide: &File, known: &BTreeSet<&str>) -> Vec<String> {
    let mut problems = Vec::new();
    let mut inside = false;
    for (line, text) in numbered(&guide.text) {
        if text.starts_with("## ") {
            inside = text.starts_with(TALES);
        }
        for (_, name) in quoted(text).into_iter().filter(|_| inside) {
            let parts: Vec<&str> = name.split("::").collect();
            let is_name = parts.iter().all(|part| !part.is_empty() && part.chars().all(is_of_word));
            if is_name && !parts.iter().all(|part| known.contains(part)) {
                problems.push(format!("{}:{line}: `{name}` is no name in src/", guide.path));
            }
        }
    }
    problems
}

/// Types of the rooms with a table in the glossary that a room exports for its callers.
fn exported_types(room: &str) -> Vec<String> {
    let is_of = |path: &str| EXPLAINED.iter().any(|lower| path.starts_with(&format!("{lower}::")));
    let paths = room.lines().filter_map(|line| line.strip_prefix("pub use crate::")?.strip_suffix(';'));
    let uses = paths.filter(|path| is_of(path)).filter_map(|path| path.split_once("::"));
    uses.flat_map(|(_, names)| words(names)).map(|(_, word, _)| word.to_owned()).collect()
}

/// Exported types without a row, names between backticks that no code has, and too many rows without a word of the
/// field.
fn glossary_problems(glossary: &File, exported: &[String], known: &BTreeSet<&str>) -> Vec<String> {
    let path = &glossary.path;
    let missing = exported.iter().filter(|name| !glossary.text.contains(&format!("\n| `{name}` |")));
    let missing = missing.map(|name| format!("{path}: no row for `{name}`"));
    let is_name = |name: &str| !name.is_empty() && name.chars().all(is_of_word);
    let unknown = quoted(&glossary.text).into_iter().filter(|(_, name)| is_name(name) && !known.contains(name));
    let unknown = unknown.map(|(k, name)| format!("{path}:{k}: `{name}` is no name in the code"));
    let wordless = numbered(&glossary.text).filter(|(_, line)| line.contains("| – |")).skip(WORDLESS_MAX);
    let wordless = wordless.map(|(k, _)| format!("{path}:{k}: one row too many without a word of the field"));
    missing.chain(unknown).chain(wordless).collect()
}

/// Sources and documents may name the data that is shared; the data itself stays outside.
fn shared_data_problems(file: &File) -> Vec<String> {
    let name = file.name().to_lowercase();
    let stems = ["kb7", "kb11", "getaberget", "tyrol", "elcentro", "goodman_bray_16", "star_multi", "v02_hexagon"];
    let source = [".rs", ".py", ".md", ".toml"].iter().any(|extension| file.is(extension));
    let shared = !source && stems.iter().any(|stem| name.contains(stem));
    shared.then(|| format!("{}: shared data", file.path)).into_iter().collect()
}

// ---------------------------------------------------------------------------------------------------------------------
// Reading.

fn hold(problems: Vec<String>) {
    assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
}

/// Problems of all files with one of the `extensions` in one of the `folders`; there must be such a file.
fn each(extensions: &[&str], folders: &[&str], problems: fn(&File) -> Vec<String>) -> Vec<String> {
    let files = repository();
    let chosen = files.iter().filter(|file| file.within(folders) && extensions.iter().any(|end| file.is(end)));
    let chosen: Vec<_> = chosen.collect();
    assert!(!chosen.is_empty(), "no file to check");
    chosen.into_iter().flat_map(problems).collect()
}

/// All files but those of version control, builds, caches and environments.
fn repository() -> Vec<File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root.join(&folder)).expect("a folder that can be read") {
            let entry = entry.expect("an entry that can be read");
            let path = format!("{folder}{}", entry.file_name().to_string_lossy());
            let kind = entry.file_type().expect("a kind of entry");
            if kind.is_dir() && is_ours(&entry.path()) {
                folders.push(path + "/");
            } else if kind.is_file() {
                files.push(File { text: read(&entry.path()), path });
            }
        }
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

fn is_ours(folder: &Path) -> bool {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let hidden = name.starts_with('.') && ![".ci", ".cargo", ".github"].contains(&&*name);
    let marks = ["CACHEDIR.TAG", "pyvenv.cfg", ".git", "summary.json"];
    !hidden && !["target", "__pycache__"].contains(&&*name) && !marks.iter().any(|mark| folder.join(mark).exists())
}

/// Text of the kinds that people write; empty for others.
fn read(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let kinds = ["rs", "toml", "md", "py", "sh", "txt", "yml", "lock", "h", "c", "cpp"];
    let written = kinds.iter().any(|kind| name.ends_with(&format!(".{kind}"))) || name == "run";
    if written { std::fs::read_to_string(path).expect("UTF-8 text") } else { String::new() }
}

/// Lines with their numbers from 1.
fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(k, line)| (k + 1, line))
}

/// `text` with comments, strings and character literals blanked, so that only code and its line ends remain.
fn code_only(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut code = String::with_capacity(text.len());
    let mut at = 0;
    while at < letters.len() {
        let end = end_of_token(&letters, at);
        let keep = end == at + 1;
        code.extend(letters[at..end].iter().map(|&c| if keep || c == '\n' { c } else { ' ' }));
        at = end;
    }
    code
}

/// Index behind the comment or literal that starts at `at`; `at + 1` where none does.
fn end_of_token(letters: &[char], at: usize) -> usize {
    let next = |k: usize| letters.get(at + k).copied().unwrap_or('\n');
    let within_name = at > 0 && (letters[at - 1].is_alphanumeric() || letters[at - 1] == '_');
    match letters[at] {
        '/' if next(1) == '/' => (at..letters.len()).find(|&k| letters[k] == '\n').unwrap_or(letters.len()),
        '/' if next(1) == '*' => end_of_block_comment(letters, at),
        '"' => end_of_quote(letters, at, '"'),
        'r' if matches!(next(1), '"' | '#') && (!within_name || letters[at - 1] == 'b') => end_of_raw(letters, at),
        '\'' if next(1) == '\\' || next(2) == '\'' => end_of_quote(letters, at, '\''),
        _ => at + 1,
    }
}

fn end_of_quote(letters: &[char], at: usize, quote: char) -> usize {
    let mut k = at + 1;
    while k < letters.len() && letters[k] != quote {
        k += if letters[k] == '\\' { 2 } else { 1 };
    }
    (k + 1).min(letters.len())
}

fn end_of_raw(letters: &[char], at: usize) -> usize {
    let hashes = letters[at + 1..].iter().take_while(|&&c| c == '#').count();
    let first = at + 1 + hashes;
    if letters.get(first) != Some(&'"') {
        return at + 1;
    }
    let closes = |k: usize| letters[k] == '"' && letters[k + 1..].iter().take_while(|&&c| c == '#').count() >= hashes;
    (first + 1..letters.len()).find(|&k| closes(k)).map_or(letters.len(), |k| k + 1 + hashes)
}

fn end_of_block_comment(letters: &[char], at: usize) -> usize {
    let (mut depth, mut k) = (0, at);
    while k + 1 < letters.len() {
        match (letters[k], letters[k + 1]) {
            ('/', '*') => (depth, k) = (depth + 1, k + 2),
            ('*', '/') => (depth, k) = (depth - 1, k + 2),
            _ => k += 1,
        }
        if depth == 0 {
            return k;
        }
    }
    letters.len()
}

/// Words with their line and the letter that follows each.
fn words(text: &str) -> Vec<(usize, &str, Option<char>)> {
    let mut found = Vec::new();
    for (number, line) in numbered(text) {
        let mut rest = line;
        while let Some(start) = rest.find(is_of_word) {
            let tail = &rest[start..];
            let end = tail.find(|c| !is_of_word(c)).unwrap_or(tail.len());
            found.push((number, &tail[..end], tail[end..].chars().next()));
            rest = &tail[end..];
        }
    }
    found
}

fn is_of_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// First names of the paths that begin with `prefix`, those of a group `{a::b, c}` one by one, with their lines.
fn names_after(code: &str, prefix: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices(prefix) {
        if code[..at].ends_with(is_of_word) {
            continue;
        }
        let line = 1 + code[..at].matches('\n').count();
        let rest = &code[at + prefix.len()..];
        let firsts = if rest.starts_with('{') { group(rest) } else { vec![rest] };
        let name = |path: &str| path.trim_start().chars().take_while(|&c| is_of_word(c) || c == '*').collect();
        found.extend(firsts.into_iter().map(|path| (line, name(path))));
    }
    found
}

/// The parts between commas of the braces that `text` begins with, inner braces left whole.
fn group(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 1, Vec::new());
    for (at, letter) in text.char_indices() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        if depth == 0 || (depth == 1 && letter == ',') {
            parts.push(&text[start..at]);
            start = at + 1;
        }
        if depth == 0 {
            break;
        }
    }
    parts.retain(|part| !part.trim().is_empty());
    parts
}

/// First line, name and number of lines of every function with a body.
fn functions(code: &str) -> Vec<(usize, String, usize)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ") {
        let name: String = code[at + 3..].chars().take_while(|&c| is_of_word(c)).collect();
        let Some(length) = lines_to_closing_brace(&code[at..]) else { continue };
        if !name.is_empty() && !code[..at].ends_with(is_of_word) {
            found.push((1 + code[..at].matches('\n').count(), name, length));
        }
    }
    found
}

/// Number of lines up to the brace that closes the first one; none where a semicolon outside brackets comes before it.
fn lines_to_closing_brace(code: &str) -> Option<usize> {
    let (mut braces, mut brackets) = (0, 0);
    for (at, letter) in code.char_indices() {
        match letter {
            '(' | '[' => brackets += 1,
            ')' | ']' => brackets -= 1,
            '{' => braces += 1,
            '}' => braces -= 1,
            ';' if braces == 0 && brackets == 0 => return None,
            _ => {}
        }
        if letter == '}' && braces == 0 {
            return Some(1 + code[..at].matches('\n').count());
        }
    }
    None
}

/// Numbers at the ends of displayed equations, `\qquad (N)`, in the order of the text.
fn equation_numbers(text: &str) -> Vec<u32> {
    let ends = text.lines().filter_map(|line| line.trim_end().strip_suffix(')')?.rsplit_once("\\qquad ("));
    ends.filter_map(|(_, number)| number.parse().ok()).collect()
}

/// Line and number of every citation `(Eq. 1)` or `(Eqs. 1, 2)`.
fn citations(text: &str) -> Vec<(usize, u32)> {
    let mut found = Vec::new();
    for (line, content) in numbered(text) {
        for (at, _) in content.match_indices("(Eq") {
            let inside = content[at..].split(')').next().unwrap_or_default();
            let numbers = inside.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok());
            found.extend(numbers.map(|number| (line, number)));
        }
    }
    found
}

/// Line and target of every Markdown link or picture outside code.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut fenced = false;
    for (line, content) in numbered(text) {
        fenced ^= content.trim_start().starts_with("```");
        let prose: String = content.split('`').step_by(2).collect();
        for (at, _) in prose.match_indices("](").filter(|_| !fenced) {
            let target = prose[at + 2..].split([')', ' ']).next().unwrap_or_default();
            found.push((line, target.to_owned()));
        }
    }
    found
}

/// Texts between backticks, with their lines.
fn quoted(text: &str) -> Vec<(usize, &str)> {
    let of_line = |(number, line)| str::split(line, '`').skip(1).step_by(2).map(move |word| (number, word));
    numbered(text).flat_map(of_line).collect()
}

/// `target` as seen from the folder of `from`, without `.` and `..`.
fn join(from: &str, target: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

// ---------------------------------------------------------------------------------------------------------------------
// Every rule seen failing.

fn file(path: &str, text: &str) -> File {
    File { path: path.to_owned(), text: text.to_owned() }
}

fn count(problems: fn(&File) -> Vec<String>, path: &str, text: &str) -> usize {
    problems(&file(path, text)).len()
}

#[test]
fn rooms_rule_is_seen_failing() {
    let rule = |path, text| count(room_problems, path, text);
    assert_eq!(rule("src/contact/law.rs", "use crate::geometry::Point; // crate::io is a comment"), 0);
    assert_eq!(rule("src/contact/law.rs", "use crate::state::Model;"), 1);
    assert_eq!(rule("src/contact/law.rs", "use crate::{geometry::Point, step::{Dt, X}, state};"), 2);
    assert_eq!(rule("src/cover/mod.rs", "pub fn f(c: &crate::model::Case) -> crate::geometry::Point {}"), 1);
    assert_eq!(rule("src/cover/mod.rs", "use super::step::Dt; use super::geometry::Point;"), 2);
    assert_eq!(rule("src/cover/mod.rs", "mod tests { use super::*; }"), 0);
    assert_eq!(rule("src/cover/star.rs", "use super::super::step::Dt;"), 1);
    assert_eq!(rule("src/cover/star.rs", "use super::block::Block;"), 0);
    assert_eq!(rule("src/cover/star.rs", "use crate::*;"), 1);
    assert_eq!(rule("src/solver/mod.rs", ""), 1);
    assert_eq!(rule("src/util.rs", ""), 1);
    assert_eq!(rule("src/lib.rs", "pub use crate::io::X;"), 0);
}

#[test]
fn file_access_rule_is_seen_failing() {
    let rule = |text| count(file_access_problems, "src/a.rs", text);
    assert_eq!(rule("use std::fs::File; use std::{mem, fs};"), 2);
    assert_eq!(rule("use std::path::Path; // std::fs"), 0);
}

#[test]
fn actions_rule_is_seen_failing() {
    let rule = |text: &str| count(action_problems, ".github/workflows/a.yml", text);
    assert_eq!(rule("- uses: actions/checkout@v4"), 1);
    assert_eq!(rule(&format!("- uses: actions/checkout@{} # v4.2.2", "0".repeat(40))), 0);
}

#[test]
fn width_rule_is_seen_failing() {
    let wide = "é".repeat(121);
    assert_eq!(count(width_problems, "src/a.rs", &wide), 1);
    assert_eq!(count(width_problems, "src/a.rs", &"é".repeat(120)), 0);
    assert_eq!(count(width_problems, "a.md", &format!("{wide}\n| {wide} |\n<https://{wide}>")), 1);
    assert_eq!(count(width_problems, "a.toml", &format!("| {wide} |")), 1);
}

#[test]
fn readme_rule_is_seen_failing() {
    assert_eq!(count(readme_problems, "README.md", &"a\n".repeat(201)), 1);
    assert_eq!(count(readme_problems, "README.md", &format!("https://{}", "a".repeat(113))), 1);
}

#[test]
fn riddles_are_counted() {
    assert_eq!(riddles("//! What a\n    /// What b\n// What c\n/// Whatever\n/// Says what"), 3);
}

#[test]
fn constants_rule_is_seen_failing() {
    let code = "pub(super) const A: f64 = 2.5e-3;\nconst W: [f64; 2] = [2.0, 8_000.0];\n\
        \x20   pub theta: f64 = 4.0 => SHARE,\n    a_max: 5.0,\n\
        const M: f64 = 70.0 * std::f64::consts::PI / 180.0;";
    let wrong = |name: &str, value: &str| {
        let table = format!(
            "| constant | value | file |\n|---|---|---|\n| `{name}` | {value} | `src/a.rs` |\n\n| `B` | 1 | c |"
        );
        let rows = constants(&file("a.md", &table));
        assert_eq!(rows.len(), 1);
        constant_problem(&rows[0], &[file("src/a.rs", code)]).is_some()
    };
    for (name, value) in [("A", "0.0025 $h$"), ("W", "2, 8000"), ("theta", "4"), ("a_max", "5"), ("M", "70°")] {
        assert!(!wrong(name, value), "{name}");
    }
    for (name, value) in [("A", "0.0026"), ("W", "2"), ("a", "5"), ("theta", "four")] {
        assert!(wrong(name, value), "{name}");
    }
    assert_eq!(count(hidden_problems, "a.md", concat!("1.25<!--", "=fos-->")), 1);
}

#[test]
fn length_rule_is_seen_failing() {
    let function = |lines: usize| format!("fn f(a: [u8; 3]) -> u8 {{\n{}}}", "// }\n".repeat(lines - 2));
    assert_eq!(count(length_problems, "src/a.rs", &function(60)), 0);
    assert_eq!(count(length_problems, "src/a.rs", &function(61)), 1);
    assert_eq!(count(length_problems, "tests/a.rs", &function(80)), 0);
    assert_eq!(count(length_problems, "tests/a.rs", &function(81)), 1);
    let declared = format!("trait T {{ fn f();\n{} }}", "\n".repeat(90));
    assert_eq!(count(length_problems, "src/a.rs", &declared), 0);
}

#[test]
fn numbers_rule_is_seen_failing() {
    let rule = |text| count(number_problems, "src/contact/vertex_rule/a.rs", text);
    for text in ["a < 0.5", "2.0 * b", "x > 1e-6"] {
        assert_eq!(rule(text), 1, "{text}");
    }
    assert_eq!(rule("a > 0.0 && pair.0.x < tuple.1 && k - 1 == 3 // 0.5"), 0);
}

#[test]
fn words_rule_is_seen_failing() {
    let rule = |path, text| count(word_problems, path, text);
    for word in ["todo!()", "unimplemented!()", "dbg!(1)", "unsafe {}", "#[ignore]", "#[ignore = \"slow\"]"] {
        assert_eq!(rule("tests/a.rs", word), 1, "{word}");
    }
    for word in ["println!()", "eprintln!()", "print!()", "eprint!()"] {
        assert_eq!((rule("src/io/a.rs", word), rule("crates/cli/src/a.rs", word)), (1, 0), "{word}");
    }
    assert_eq!(rule("ffi/src/a.rs", "unsafe {}"), 0);
    assert_eq!([rule("ffi/fmi/src/a.rs", "unsafe {}"), rule("ffi/fmi/src/raw/a.rs", "unsafe {}")], [1, 0]);
    assert_eq!(rule("src/lib.rs", "#![forbid(unsafe_code)]"), 0);
    assert_eq!(rule("src/contact/a.rs", "use std::collections::HashMap; fn f(x: HashSet<u8>) {}"), 2);
    assert_eq!(rule("src/io/a.rs", "use std::collections::HashMap;"), 0);
    assert_eq!(rule("src/step/a.rs", "// unsafe HashMap println!\nlet s = \"todo!() // \\\" dbg!\";"), 0);
}

#[test]
fn system_functions_rule_is_seen_failing() {
    let rule = |text| count(system_problems, "src/a.rs", text);
    assert_eq!(rule("let a = x.sin();\nlet b = f64::exp;\nlet c = (x + y).powf(0.3);"), 3);
    assert_eq!(rule("let a = libm::sin(x); // x.sin()\nlet b = x.powi(2);\n#[cfg(test)]\nx.sin()"), 0);
    assert_eq!(count(system_problems, "src/a/tests.rs", "x.sin()"), 0);
}

#[test]
fn includes_rule_is_seen_failing() {
    let rule = |path, text| count(include_problems, path, text);
    assert_eq!(rule("a/b/src/c/d.rs", "const A: &str = include_str!(\"../../../x.toml\");"), 1);
    assert_eq!(rule("a/b/src/c/d.rs", "const A: &[u8] = include_bytes!(\"../../x.toml\");"), 0);
    assert_eq!(rule("a/b/src/d.rs", "#[cfg(test)]\nconst A: &str = include_str!(\"../../x.toml\");"), 0);
    assert_eq!(rule("tools/xtask/src/a.rs", "include_str!(\"../../x.toml\")"), 0);
}

#[test]
fn marks_rule_is_seen_failing() {
    let mark = concat!("// TO", "DO: later\n// FIX", "ME\n# X", "XX");
    assert_eq!(count(mark_problems, "src/a.rs", mark), 3);
    assert_eq!(count(mark_problems, "src/a.rs", "// todo list, TODOS"), 0);
}

#[test]
fn hosts_rule_is_seen_failing() {
    let line = concat!("pip install --index", "-url x");
    assert_eq!(count(host_problems, ".ci/run", line), 1);
    assert_eq!(count(host_problems, "a.md", concat!("see crates", ".io")), 1);
    assert_eq!(count(host_problems, "Cargo.lock", concat!("see crates", ".io")), 0);
    assert_eq!(count(host_problems, "a.rs", "http://www.w3.org/2000/svg"), 0);
}

#[test]
fn headers_rule_is_seen_failing() {
    assert_eq!(count(header_problems, "tests/a.rs", "use std::path::Path;"), 1);
    assert_eq!(count(header_problems, "tests/a.rs", "//! A claim."), 0);
    assert_eq!(count(header_problems, "tests/common/mod.rs", "use std::path::Path;"), 0);
}

#[test]
fn equations_rule_is_seen_failing() {
    assert_eq!(equation_numbers("$$\na=b \\qquad (1)\n$$\nsee (7)\n$$\nc \\qquad (3)\n$$"), [1, 3]);
    let cites = |text| citation_problems(&file("src/a.rs", text), &[1, 2, 3]).len();
    assert_eq!(cites("/// Mass (Eq. 2), energy (Eqs. 1, 3)"), 0);
    assert_eq!(cites("/// Mass (Eq. 4)"), 1);
    assert_eq!(cites("/// Mass (Eqs. 1–9)"), 1);
}

#[test]
fn links_rule_is_seen_failing() {
    let exists = |path: &str| path == "docs/theory.md" || path == "README.md";
    let dead = |path, text| link_problems(&file(path, text), &exists).len();
    assert_eq!(dead("README.md", "[a](docs/theory.md#x) [b](https://a.b/c) [c](#here) `[d](no.md)`"), 0);
    assert_eq!(dead("README.md", "![a](docs/absent.png)"), 1);
    assert_eq!(dead("docs/a.md", "[a](theory.md) [b](../README.md) [c](README.md)"), 1);
    assert_eq!(dead("README.md", "```\n[a](absent.md)\n```"), 0);
}

#[test]
fn module_rule_is_seen_failing() {
    let exists = |path: &str| path == "tests/common/clock.rs";
    let lost = |text| module_problems(&file("crates/a/tests/main.rs", text), &exists).len();
    assert_eq!(lost("#[path = \"../../../tests/common/clock.rs\"]\nmod clock;"), 0);
    assert_eq!(lost("#[path = \"../../common/clock.rs\"]\nmod clock;"), 1);
}

#[test]
fn summary_rule_is_seen_failing() {
    let files =
        ["docs/book/a.md", "docs/book/b.md", "docs/book/pictures/a.png", "docs/c.md"].map(|path| file(path, ""));
    let missing = |text| summary_problems(&file(SUMMARY, text), &files).len();
    assert_eq!(missing("- [A](book/a.md)\n- [B](book/b.md)"), 0);
    assert_eq!(missing("- [A](book/a.md)\n- [C](c.md)"), 1);
}

#[test]
fn paths_rule_is_seen_failing() {
    let files = ["src/io/run.rs", "src/io/run/rows.rs", "ffi/capi/src/safe/model.rs"].map(|path| file(path, ""));
    let dead = |text| path_problems(&file("CONTRIBUTING.md", text), &files).len();
    assert_eq!(dead("`src/io/run.rs` `src/io/` `run/rows.rs` `rows.rs` `src/safe/*` `tests/NAME.rs`"), 0);
    assert_eq!(dead("`src/io/absent.rs`"), 1);
    assert_eq!(dead("`absent.rs` and `src/model/`"), 2);
    assert_eq!(dead("`cargo xtask a/b` `/tmp/out` and src/absent.rs without marks"), 0);
}

#[test]
fn names_rule_is_seen_failing() {
    let known = BTreeSet::from(["Step", "interval"]);
    let wrong = |text: &str| name_problems(&file("ARCHITECTURE.md", text), &known).len();
    assert_eq!(wrong("## The life of a step\n`Step::interval`, `interval`, `a = b`, `src/a.rs`\n## Next\n`absent`"), 0);
    assert_eq!(wrong("## The life of a step\n`Step::absent` and `Absent`"), 2);
}

#[test]
fn glossary_rule_is_seen_failing() {
    let room =
        "pub use crate::contact::{A, Bb};\npub use crate::step::Cc;\npub use crate::state::Dd;\nuse crate::step::Ee;";
    let exported = exported_types(room);
    assert_eq!(exported, ["A", "Bb", "Cc"]);
    let known = BTreeSet::from(["A", "Bb", "Cc"]);
    let wrong = |text: &str| glossary_problems(&file(GLOSSARY, text), &exported, &known).len();
    let good = "\n| `A` | a |\n| `Bb` | `a/b.rs` |\n| `Cc` | c |\n".to_owned();
    assert_eq!(wrong(&good), 0);
    assert_eq!(wrong("\n| `A` | a |\n| `Bb` | b |"), 1);
    assert_eq!(wrong(&(good.clone() + "| star | `Gone` |")), 1);
    assert_eq!(wrong(&(good + &"| a | b | – | c |\n".repeat(WORDLESS_MAX + 2))), 2);
}

#[test]
fn door_rule_is_seen_failing() {
    let text = "use enmm::internals::contact::Pair;";
    assert_eq!(count(door_problems, "crates/run/src/a.rs", text), 1);
    assert_eq!(count(door_problems, "crates/implicit/src/a.rs", text), 0);
    assert_eq!(count(door_problems, "crates/run/tests/a.rs", text), 0);
}

#[test]
fn shared_data_rule_is_seen_failing() {
    assert_eq!(count(shared_data_problems, "examples/data/KB11.json", ""), 1);
    assert_eq!(count(shared_data_problems, "examples/tyrol_gar_profile.csv", ""), 1);
    assert_eq!(count(shared_data_problems, "tests/traces_kb11.rs", ""), 0);
}

#[test]
fn code_is_told_from_comments_and_literals() {
    let text = "a /* b /* c */ d */ e \"f \\\" g\" h r#\"i \" j\"# k 'l' m '\\'' n 'o: loop { p } r.q // s\nt";
    let kept: String = code_only(text).chars().filter(|c| !c.is_whitespace()).collect();
    assert_eq!(kept, "aehkmn'o:loop{p}r.qt");
    assert_eq!(code_only("/* a\nb */").matches('\n').count(), 1);
}
