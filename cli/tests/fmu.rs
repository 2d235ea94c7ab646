//! `enmm fmu` packs cases of both versions, always the same, and writes nothing when it cannot.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/cases/block_on_incline.toml")
}

fn enmm(folder: &Path, arguments: &[&str]) -> Output {
    run(Path::new(env!("CARGO_BIN_EXE_enmm")), folder, arguments)
}

fn run(program: &Path, folder: &Path, arguments: &[&str]) -> Output {
    Command::new(program).arg("fmu").args(arguments).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn is_empty(folder: &Path) -> bool {
    std::fs::read_dir(folder).unwrap().next().is_none()
}

#[test]
fn both_versions_are_packed_with_their_library() {
    let folder = tempfile::tempdir().unwrap();
    let case = example();
    let case = case.to_str().unwrap();
    let output = enmm(folder.path(), &[case]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    assert!(told.starts_with("block_on_incline.fmu: FMI 3.0, ") && told.ends_with(" variables, 2 blocks\n"), "{told}");
    for version in ["2", "3"] {
        let written = ["a.fmu", "b.fmu"].map(|name| {
            let output = enmm(folder.path(), &[case, "--fmi", version, "-o", name]);
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            std::fs::read(folder.path().join(name)).unwrap()
        });
        assert!(written[0] == written[1] && written[0].starts_with(b"PK"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn nothing_is_written_for_a_bad_case_or_a_bad_place() {
    let folder = tempfile::tempdir().unwrap();
    let output = enmm(folder.path(), &["missing.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).starts_with("error: missing.toml: cannot read") && is_empty(folder.path()));
    let case = folder.path().join("case.toml");
    std::fs::copy(example(), &case).unwrap();
    for (place, told) in [("case.toml", "is the case itself"), ("case.toml/x.fmu", "cannot write the FMU")] {
        let output = enmm(folder.path(), &["case.toml", "-o", place]);
        assert_eq!(output.status.code(), Some(2));
        let error = text(&output.stderr);
        assert!(error.contains(told) && error.contains("-o") && error.lines().count() == 1, "{error}");
    }
    assert_eq!(std::fs::read(&case).unwrap(), std::fs::read(example()).unwrap());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert_eq!(enmm(folder.path(), &["case.toml", "--fmi", "1"]).status.code(), Some(2));
}

#[test]
fn a_program_without_libraries_says_where_it_looked() {
    let folder = tempfile::tempdir().unwrap();
    let bin = folder.path().join("bin");
    std::fs::create_dir(&bin).unwrap();
    let program = bin.join(format!("enmm{}", std::env::consts::EXE_SUFFIX));
    std::fs::copy(env!("CARGO_BIN_EXE_enmm"), &program).unwrap();
    let empty = tempfile::tempdir().unwrap();
    let output = run(&program, empty.path(), &[example().to_str().unwrap()]);
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("enmm_fmi3") && error.contains("looked in") && error.contains("cargo build"), "{error}");
    assert!(is_empty(empty.path()));
}

#[test]
fn all_that_check_warns_of_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let soft = std::fs::read_to_string(example()).unwrap().replace("density = 2650.0", "density = 26.5");
    std::fs::write(folder.path().join("light.toml"), soft).unwrap();
    let output = enmm(folder.path(), &["light.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).starts_with("warning: rock."), "{}", text(&output.stderr));
    let mut check = Command::new(env!("CARGO_BIN_EXE_enmm"));
    let checked = text(&check.args(["check", "light.toml"]).current_dir(folder.path()).output().unwrap().stdout);
    let told: Vec<_> = checked.lines().filter(|line| line.contains("warning: ")).map(str::trim).collect();
    assert_eq!(told, text(&output.stderr).lines().collect::<Vec<_>>());
}
