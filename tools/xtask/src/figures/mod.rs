//! Figures that documents quote, each behind a mark that says where it comes from: `1.25<!--=plane_slide.fos-->`.
//!
//! `NAME FILE` is a constant or a default in `src/FILE`; `ID: QUANTITY` what a verification problem computed for its
//! report. A single name is what a test tells: with `ENMM_FIGURES` set it writes the value into a file of that name in
//! that folder. Names that begin with `long.` are told by long campaigns.

mod mark;
mod number;

use std::path::{Path, PathBuf};

use crate::counts::Counts;
use crate::repository::Repository;
use mark::{Mark, marks};

/// Names of figures that only long campaigns tell.
const LONG: &str = "long.";
/// Folders with documents, besides the root itself.
const FOLDERS: [&str; 3] = ["docs", "ffi", "benchmark"];
/// What `cargo xtask verify` computed.
const REPORT: &str = "docs/verification.json";
const REMEDY: &str = "run `cargo xtask figures`";

/// Forgets what tests have told.
///
/// # Errors
/// When the folder cannot be removed.
pub fn forget(repository: &Repository) -> Result<(), String> {
    let folder = repository.figures();
    if !folder.exists() {
        return Ok(());
    }
    std::fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))
}

/// Compares the figures of all documents with the constants of the sources and with what tests have told; counts those
/// that are true and those that are not. All tests must have run, but the long campaigns.
///
/// # Errors
/// When a document cannot be read, or a mark makes no sense.
pub fn compare(repository: &Repository) -> Result<Counts, String> {
    let mut counts = Counts::default();
    for document in documents(&repository.root)? {
        let text = read(&repository.root.join(&document))?;
        for mark in marks(&text).map_err(|why| format!("{document}:{why}"))? {
            match judge(repository, &document, &mark) {
                Ok(Some(())) => counts.passed += 1,
                Ok(None) if mark.name.starts_with(LONG) => {}
                Ok(None) => problem(&mut counts, &format!("{document}:{}: no test told {}", mark.line, mark.name)),
                Err(why) => problem(&mut counts, &why),
            }
        }
    }
    println!("{} figures of the documents are true, {} are not", counts.passed, counts.failed);
    Ok(counts)
}

fn problem(counts: &mut Counts, why: &str) {
    println!("{why}");
    counts.failed += 1;
}

/// Whether a figure is true; nothing when it is not known.
fn judge(repository: &Repository, document: &str, mark: &Mark) -> Result<Option<()>, String> {
    let at = format!("{document}:{}", mark.line);
    let Some(value) = value(repository, &mark.name).map_err(|why| format!("{at}: {why}"))? else { return Ok(None) };
    if mark.figures.iter().any(|figure| figure.holds(value)) {
        return Ok(Some(()));
    }
    let told: Vec<_> = mark.figures.iter().map(|figure| &*figure.text).collect();
    Err(format!("{at}: {} is {value}, the document says {}: {REMEDY}", mark.name, told.join(", ")))
}

/// Writes the figures of all documents anew, and tells which have changed.
///
/// # Errors
/// When a document cannot be read or written, or holds a figure that cannot be written.
pub fn write(repository: &Repository) -> Result<(), String> {
    let mut left = Vec::new();
    for document in documents(&repository.root)? {
        let path = repository.root.join(&document);
        let mut text = read(&path)?;
        // From the last to the first, so that places hold.
        for mark in marks(&text).map_err(|why| format!("{document}:{why}"))?.into_iter().rev() {
            if let Err(why) = rewrite(repository, &mark, &mut text) {
                left.push(format!("{document}:{}: {why}", mark.line));
            }
        }
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    if left.is_empty() { Ok(()) } else { Err(left.join("\n")) }
}

/// Writes the figure of a mark into a text, where it is not true.
fn rewrite(repository: &Repository, mark: &Mark, text: &mut String) -> Result<(), String> {
    let name = &mark.name;
    let Some(value) = value(repository, name)? else {
        return if name.starts_with(LONG) { Ok(()) } else { Err(format!("no test told {name}")) };
    };
    if mark.figures.iter().any(|figure| figure.holds(value)) {
        return Ok(());
    }
    if mark.is_behind_equation {
        return Err(format!("{name} is {value}: correct the equation by hand"));
    }
    let figure = &mark.figures[0];
    let written = figure.written(value);
    println!("{name}: {} becomes {written}", figure.text);
    text.replace_range(figure.at.clone(), &written);
    Ok(())
}

/// What a name stands for; nothing when no test has told it.
fn value(repository: &Repository, name: &str) -> Result<Option<f64>, String> {
    if let Some((problem, quantity)) = name.split_once(": ") {
        return of_report(&read(&repository.root.join(REPORT))?, problem, quantity).map(Some);
    }
    if let Some((constant, file)) = name.split_once(' ') {
        let file = source(&repository.root, file);
        let text = read(&repository.root.join(&file))?;
        return of_source(&text, constant).map(Some).map_err(|why| format!("{file}: {why}"));
    }
    let path = repository.figures().join(name);
    if !path.exists() {
        return Ok(None);
    }
    let text = read(&path)?;
    text.trim().parse().map(Some).map_err(|error| format!("{}: {text}: {error}", path.display()))
}

/// The file that a mark names: one of the engine, or of another crate, whose folder then comes first.
fn source(root: &Path, file: &str) -> String {
    let own = format!("src/{file}");
    match file.split_once('/') {
        Some((folder, rest)) if !root.join(&own).exists() => format!("{folder}/src/{rest}"),
        _ => own,
    }
}

/// Computed value of a quantity in the text of the report.
fn of_report(text: &str, problem: &str, quantity: &str) -> Result<f64, String> {
    let report: serde_json::Value = serde_json::from_str(text).map_err(|error| format!("{REPORT}: {error}"))?;
    let list = |of: &serde_json::Value, key: &str| of[key].as_array().cloned().unwrap_or_default();
    let rows = list(&report, "problems").into_iter().filter(|found| found["id"] == problem);
    let row = rows.flat_map(|found| list(&found, "rows")).find(|row| row["quantity"] == quantity);
    row.and_then(|row| row["computed"].as_f64()).ok_or_else(|| format!("{REPORT}: {problem} has no `{quantity}`"))
}

/// Value of the constant or default `name`, or `name[k]`, in the text of a source.
fn of_source(text: &str, name: &str) -> Result<f64, String> {
    let (name, index) = name.strip_suffix(']').and_then(|name| name.split_once('[')).unwrap_or((name, "0"));
    let index: usize = index.parse().map_err(|_| format!("{name}[{index}] is no place"))?;
    let mut values: Vec<f64> = text.lines().filter_map(|line| of_line(line.trim(), name, index)).collect();
    values.dedup();
    match values[..] {
        [value] => Ok(value),
        [] => Err(format!("no number is called {name}")),
        _ => Err(format!("several numbers are called {name}")),
    }
}

/// Value in `const NAME: … = VALUE;` or `NAME: VALUE,`.
fn of_line(line: &str, name: &str, index: usize) -> Option<f64> {
    let value = match line.split_once("const ") {
        Some((_, rest)) => rest.strip_prefix(name)?.strip_prefix(": ")?.split_once(" = ")?.1.strip_suffix(';')?,
        None => line.strip_prefix(name)?.strip_prefix(": ")?.strip_suffix(',')?,
    };
    let value = value.trim_matches(['[', ']']).split(", ").nth(index)?.replace('_', "");
    // Angles are told in degrees.
    let value = value.strip_suffix(" * std::f64::consts::PI / 180.0").unwrap_or(&value);
    match value.split_once(" << ") {
        Some((factor, power)) => Some(factor.parse::<f64>().ok()? * power.parse::<i32>().ok().map(|k| 2f64.powi(k))?),
        None => value.parse().ok(),
    }
}

/// Paths of all documents, in their order.
fn documents(root: &Path) -> Result<Vec<String>, String> {
    let mut found = of_kind(root, "", &["md"], false)?;
    for folder in FOLDERS {
        found.extend(of_kind(root, folder, &["md"], true)?);
    }
    Ok(found)
}

/// Paths of the files with one of the extensions in a folder and, if wanted, in those below it.
fn of_kind(root: &Path, folder: &str, extensions: &[&str], below: bool) -> Result<Vec<String>, String> {
    let place = root.join(folder);
    let entries = std::fs::read_dir(&place).map_err(|error| format!("{}: {error}", place.display()))?;
    let mut names: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    names.sort();
    let mut found = Vec::new();
    for path in names {
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
        let name = if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
        if path.is_dir() && below {
            found.extend(of_kind(root, &name, extensions, below)?);
        } else if path.extension().is_some_and(|end| extensions.iter().any(|&wanted| end == wanted)) {
            found.push(name);
        }
    }
    Ok(found)
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Test files that tell figures: those in Rust, those in Python.
///
/// # Errors
/// When a folder of tests cannot be read.
pub fn tellers(root: &Path) -> Result<[Vec<String>; 2], String> {
    let telling = |folder: &str, extension: &str| {
        let mut files = of_kind(root, folder, &[extension], false)?;
        files.retain(|file| read(&root.join(file)).is_ok_and(|text| text.contains("tell(")));
        Ok::<_, String>(files)
    };
    Ok([telling("tests", "rs")?, telling("python_tests", "py")?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repository::Profile;

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the root")
    }

    /// Marks of all documents, with theirs.
    fn all_marks() -> Vec<(String, Mark)> {
        let mut found = Vec::new();
        for document in documents(root()).expect("documents") {
            let text = read(&root().join(&document)).expect("text");
            let marks = marks(&text).unwrap_or_else(|why| panic!("{document}:{why}"));
            found.extend(marks.into_iter().map(|mark| (document.clone(), mark)));
        }
        found
    }

    #[test]
    fn constants_and_verified_values_that_documents_quote_are_true() {
        let repository = Repository::find(Profile::Shipped).expect("the repository");
        let constants: Vec<_> = all_marks().into_iter().filter(|(_, mark)| mark.name.contains(' ')).collect();
        let judged = constants.iter().map(|(document, mark)| judge(&repository, document, mark));
        let problems: Vec<_> = judged.filter_map(Result::err).collect();
        assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
        assert!(constants.len() > 40, "only {} are marked", constants.len());
    }

    #[test]
    fn every_figure_that_a_document_quotes_is_told_by_a_test() {
        let tellers = tellers(root()).expect("tests").concat();
        let texts: Vec<_> = tellers.iter().map(|file| read(&root().join(file)).expect("text")).collect();
        let is_told = |name: &str| texts.iter().any(|text| text.contains(&format!("\"{name}\"")));
        let told = all_marks().into_iter().filter(|(_, mark)| !mark.name.contains(' '));
        let unknown = told.filter(|(_, mark)| !is_told(&mark.name));
        let unknown = unknown.map(|(document, mark)| format!("{document}:{}: no test tells {}", mark.line, mark.name));
        let unknown: Vec<_> = unknown.collect();
        assert!(unknown.is_empty(), "\n{}\n", unknown.join("\n"));
    }

    /// Results in the prose and the tables of a text that stand before no mark: line and figure.
    fn bare(text: &str) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        let mut fenced = false;
        for (k, line) in text.lines().enumerate() {
            fenced ^= line.trim_start().starts_with("```");
            let code = |k: usize| fenced || line.starts_with("    ") || line[..k].matches('`').count() % 2 == 1;
            let marked = |k: usize| line[k..].trim_start_matches(['h', '$', ' ', '%']).starts_with("<!--=");
            let results = number::figures(line).into_iter().filter(number::Figure::is_result);
            let bare = results.filter(|figure| !code(figure.at.start) && !marked(figure.at.end));
            found.extend(bare.map(|figure| (k + 1, figure.text)));
        }
        found
    }

    /// Excepted are documents that a command writes as a whole, and those that tell what was at their time.
    #[test]
    fn no_result_stands_bare_in_a_document() {
        let excepted =
            ["tools/bench/", "docs/verification", "docs/explicit", "docs/implicit", "docs/performance", "CHANGELOG"];
        let mut problems = Vec::new();
        for document in documents(root()).expect("documents") {
            let text = read(&root().join(&document)).expect("text");
            let found = if excepted.iter().any(|start| document.starts_with(start)) { Vec::new() } else { bare(&text) };
            problems.extend(found.into_iter().map(|(line, figure)| format!("{document}:{line}: {figure} has no mark")));
        }
        assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
        assert_eq!(bare("it slips 0.1967 m\n"), [(1, "0.1967".to_owned())]);
        assert_eq!(bare("`0.1967`, 1.89, 0.005, $0.125h$<!--=a b.rs-->, 0.1967<!--=slip-->\n"), []);
    }

    /// The marks of a document see it: a figure that is changed by one in its last digit is named with its line.
    #[test]
    fn a_figure_that_is_wrong_is_named_with_place_and_remedy() {
        let repository = Repository::find(Profile::Shipped).expect("the repository");
        let judged = |text: &str| judge(&repository, "docs/a.md", &marks(text).expect("a mark")[0]);
        assert_eq!(judged("of 0.05<!--=LIGHT cover/host.rs-->"), Ok(Some(())));
        let why = judged("\nof 0.06<!--=LIGHT cover/host.rs-->").expect_err("a wrong figure");
        assert_eq!(why, "docs/a.md:2: LIGHT cover/host.rs is 0.05, the document says 0.06: run `cargo xtask figures`");
        let why = judged("of 0.06<!--=LIHGT cover/host.rs-->").expect_err("an unknown name");
        assert_eq!(why, "docs/a.md:1: src/cover/host.rs: no number is called LIHGT");
        assert!(judged("1.37<!--=C13: factor of safety, mesh size H/40-->").is_ok());
        assert!(judged("1.37<!--=C13: factor of safety, mesh size H/41-->").is_err());
    }

    #[test]
    fn a_told_figure_is_compared_and_written() {
        let mut repository = Repository::find(Profile::Shipped).expect("the repository");
        repository.target = std::env::temp_dir().join(format!("enmm-figures-{}", std::process::id()));
        std::fs::create_dir_all(repository.figures()).expect("a folder");
        std::fs::write(repository.figures().join("slip"), "0.19694\n").expect("a file");
        let text = "it slips 0.1967<!--=slip--> m, another 0.3<!--=other--> m\n";
        let found = marks(text).expect("marks");
        let why = judge(&repository, "a.md", &found[0]).expect_err("a wrong figure");
        assert_eq!(why, "a.md:1: slip is 0.19694, the document says 0.1967: run `cargo xtask figures`");
        assert_eq!(judge(&repository, "a.md", &found[1]), Ok(None));
        let mut written = text.to_owned();
        assert_eq!(rewrite(&repository, &found[1], &mut written), Err("no test told other".to_owned()));
        assert_eq!(rewrite(&repository, &found[0], &mut written), Ok(()));
        assert_eq!(written, text.replace("0.1967", "0.1969"));
        forget(&repository).expect("an empty folder");
        assert!(!repository.figures().exists());
        std::fs::remove_dir(&repository.target).expect("an empty folder");
    }

    #[test]
    fn constants_are_read_in_every_form() {
        let text = "/// A.\npub(super) const A: f64 = 2.5e-3;\nconst ROWS: usize = 200_000;\n\
            const W: [f64; 2] = [2.0, 8.0];\nconst B: usize = 3 << 4;\n    theta: 4.0,\n    theta_max: 5.0,\n\
            const M: f64 = 70.0 * std::f64::consts::PI / 180.0;\n";
        for (name, value) in [("A", 2.5e-3), ("ROWS", 2e5), ("W[1]", 8.0), ("B", 48.0), ("theta", 4.0), ("M", 70.0)] {
            assert_eq!(of_source(text, name), Ok(value), "{name}");
        }
        assert_eq!(of_source(text, "C"), Err("no number is called C".to_owned()));
        assert!(of_source("const A: f64 = 1.0;\nconst A: f64 = 2.0;", "A").is_err());
    }
}
