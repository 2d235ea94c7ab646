//! What the recipes of CONTRIBUTING.md add stands in few files: an example of each, looked for by the names that the
//! code has for it, in files that people write and that are no tests.

use super::{File, repository};

/// A recipe: what it adds, words of which a file that knows the example has one, the most files.
const RECIPES: [(&str, &[&str], usize); 4] = [
    ("a number of blocks", &["mean_stress_xx", "block_stress_xx"], 4),
    ("a case key", &["least_block"], 4),
    ("a joint law", &["BartonBandis", "barton_bandis"], 10),
    ("a function of the C ABI", &["enmm_find_block_at", "block_at"], 5),
];
/// The recipe that ends where the engine begins.
const CASE_KEY: &str = "a case key";
/// Files of code and data that a recipe may touch.
const WRITTEN: [&str; 10] = [".rs", ".py", ".js", ".html", ".css", ".hpp", ".h", ".c", ".toml", ".json"];
/// Files that commands write.
const GENERATED: [&str; 6] = [
    "include/enmm.h",
    "ffi/python/enmm/_abi.py",
    "ffi/python/enmm/_values.py",
    "docs/case.schema.json",
    "docs/verification.json",
    "docs/book/reference.md",
];
/// Folders of tests, examples and measurements, and of the pages of users.
const BESIDE: [&str; 4] = ["python_tests/", "examples/", "tools/fuzz/", "crates/verification/"];

#[test]
fn what_a_recipe_adds_stands_in_few_files() {
    let files = repository();
    for (what, words, most) in RECIPES {
        let found = homes(&files, what, words);
        assert!(!found.is_empty(), "{what}: no file has {words:?}");
        assert!(found.len() <= most, "{what}: {} files, at most {most}: {found:?}", found.len());
    }
}

#[test]
fn files_that_know_a_word_are_counted() {
    let file = |path: &str, text: &str| File { path: path.to_owned(), text: text.to_owned() };
    let files = [
        file("src/a.rs", "let depth = 1;"),
        file("crates/case/src/b.rs", "pub depth: f64"),
        file("crates/case/src/c.rs", "in_depth, depths"),
        file("crates/case/tests/d.rs", "depth"),
        file("include/enmm.h", "double depth;"),
    ];
    assert_eq!(homes(&files, "a number", &["depth"]), ["src/a.rs", "crates/case/src/b.rs"]);
    assert_eq!(homes(&files, CASE_KEY, &["depth"]), ["crates/case/src/b.rs"]);
}

/// Files that people write, but for tests, with one of the words.
fn homes<'a>(files: &'a [File], what: &str, words: &[&str]) -> Vec<&'a str> {
    let is_written = |file: &&File| WRITTEN.iter().any(|end| file.is(end)) && !GENERATED.contains(&file.path.as_str());
    let is_beside = |file: &File| file.is_test() || file.within(&BESIDE);
    let is_engine = |file: &File| what == CASE_KEY && file.within(&["src/"]);
    let found = files.iter().filter(is_written).filter(|file| !is_beside(file) && !is_engine(file));
    found.filter(|file| words.iter().any(|word| has_word(&file.text, word))).map(|file| file.path.as_str()).collect()
}

/// Whether a text has a word that is no part of a longer one.
fn has_word(text: &str, word: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(start, _)| {
        let end = start + word.len();
        !text[..start].ends_with(is_letter) && !text[end..].starts_with(is_letter)
    })
}
