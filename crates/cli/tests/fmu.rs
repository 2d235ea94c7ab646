//! `enmm fmu` packs cases of both versions, always the same, and writes nothing when it cannot.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases/block_on_incline.toml")
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
    for (place, told) in [("case.toml", "which is the input"), ("case.toml/x.fmu", "cannot write the FMU")] {
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
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let bin = folder.path().join("bin");
    std::fs::create_dir(&bin).unwrap();
    let program = bin.join(format!("enmm{}", std::env::consts::EXE_SUFFIX));
    // A link, because a copy cannot start while a process that another test has just forked still has it open.
    std::fs::hard_link(env!("CARGO_BIN_EXE_enmm"), &program).unwrap();
    let empty = tempfile::tempdir().unwrap();
    let output = run(&program, empty.path(), &[example().to_str().unwrap()]);
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("enmm_fmu") && error.contains("looked in") && error.contains("cargo build"), "{error}");
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

/// The headers of a 64-bit Windows library without code, and the name of an entry point.
fn windows_library() -> Vec<u8> {
    let mut bytes = vec![0; 64];
    bytes[..2].copy_from_slice(b"MZ");
    bytes[60] = 64;
    bytes.extend(b"PE\0\0");
    let words = [0x8664_u16, 0, 0, 0, 0, 0, 0, 0, 112, 0x2022, 0x20b];
    words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes.resize(64 + 24 + 112, 0);
    bytes.extend(b"\0fmi3DoStep\0");
    bytes
}

#[test]
fn libraries_of_other_platforms_are_packed_beside_that_of_this_system() {
    let folder = tempfile::tempdir().unwrap();
    let case = example();
    let case = case.to_str().unwrap();
    std::fs::write(folder.path().join("enmm_fmu.dll"), windows_library()).unwrap();
    let output = enmm(folder.path(), &[case, "--library", "win64=enmm_fmu.dll", "-o", "both.fmu"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let fmu = std::fs::read(folder.path().join("both.fmu")).unwrap();
    let own = enmm_fmi::library::platform(enmm_fmi::table::Version::Three);
    for name in ["binaries/x86_64-windows/block_on_incline.dll", &format!("binaries/{own}/block_on_incline")] {
        assert!(fmu.windows(name.len()).any(|part| part == name.as_bytes()), "{name}");
    }
}

#[test]
fn a_library_that_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let case = example();
    std::fs::write(folder.path().join("x.dll"), windows_library()).unwrap();
    let wrong: [(&[&str], &str); 6] = [
        (&["x.dll"], "has no `=`: give PLATFORM=PATH"),
        (&["win64=missing.dll"], "cannot read the library"),
        (&["windows=x.dll"], "unknown platform \"windows\": known are linux64, win64"),
        (&["linux64=x.dll"], "is a library of x86_64-windows, not of linux64"),
        (&["win64=x.dll", "--fmi", "2"], "has no entry point fmi2DoStep"),
        (&["win64=x.dll", "--library", "x86_64-windows=x.dll"], "two libraries are for binaries/x86_64-windows"),
    ];
    for (words, told) in wrong {
        let output = enmm(folder.path(), &[&[case.to_str().unwrap(), "--library"], words].concat());
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(told) && error.lines().count() == 1, "{error}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
