//! Where the repository and the built programs are, and how children are run.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// The profile of cargo by which libraries and programs are built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// `dev`: quick to build, with checks for overflow; for tests.
    Tested,
    /// `release`: optimized; for whatever is measured or leaves this machine.
    Shipped,
}

/// Paths of the repository.
pub struct Repository {
    /// Root of the repository.
    pub root: PathBuf,
    /// Cargo's target directory.
    pub target: PathBuf,
    /// The profile of cargo.
    pub profile: Profile,
    cargo: OsString,
}

impl Repository {
    /// Reads the paths from cargo.
    pub fn find(profile: Profile) -> Result<Self, String> {
        let manifest = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        let root = Path::new(&manifest).ancestors().nth(2).ok_or("xtask has no parent directory")?.to_owned();
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut ask = Command::new(&cargo);
        ask.args(["metadata", "--no-deps", "--format-version", "1"]).current_dir(&root);
        let answer = ask.output().map_err(|error| format!("cargo metadata: {error}"))?;
        let told: serde_json::Value = serde_json::from_slice(&answer.stdout).unwrap_or_default();
        let target = told["target_directory"].as_str().ok_or("cargo metadata names no target_directory")?.into();
        Ok(Self { root, target, profile, cargo })
    }

    /// Builds packages, as `args` of cargo name them, by the profile.
    pub fn build(&self, args: &[&str]) -> Result<(), String> {
        let release: &[&str] = if self.profile == Profile::Shipped { &["--release"] } else { &[] };
        run(self.cargo(&["build"]).args(release).args(args))
    }

    /// Folder in which cargo leaves libraries and programs.
    pub fn built(&self) -> PathBuf {
        self.target.join(if self.profile == Profile::Shipped { "release" } else { "debug" })
    }

    /// A program as it is built.
    pub fn program(&self, name: &str) -> PathBuf {
        self.built().join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    }

    /// The command line program as it is built.
    pub fn enmm(&self) -> PathBuf {
        self.program("enmm")
    }

    /// A command of cargo in the root.
    pub fn cargo(&self, args: &[&str]) -> Command {
        let mut command = self.command(&self.cargo);
        command.args(args);
        command
    }

    /// A command of cargo that builds what leaves this machine: paths of its folders are not written into binaries.
    pub fn cargo_to_ship(&self, args: &[&str]) -> Command {
        self.to_ship(&self.cargo, args)
    }

    /// The same by a program that calls cargo.
    pub fn to_ship(&self, program: impl AsRef<std::ffi::OsStr>, args: &[&str]) -> Command {
        let mut flags: Vec<String> =
            std::env::var("RUSTFLAGS").unwrap_or_default().split_whitespace().map(str::to_owned).collect();
        // Of several that fit, rustc takes the last.
        let names = ["/home", "/cargo", "/enmm"];
        flags.extend(
            self.build_folders().iter().zip(names).map(|(from, to)| format!("--remap-path-prefix={from}={to}")),
        );
        let mut command = self.command(program);
        command.args(args).env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"));
        command
    }

    /// Folders of this machine that no binary should name: home, that of cargo, and the repository.
    pub fn build_folders(&self) -> [String; 3] {
        let text = |path: &Path| path.display().to_string();
        let home = std::env::home_dir().unwrap_or_default();
        let cargo = std::env::var_os("CARGO_HOME").map_or_else(|| home.join(".cargo"), PathBuf::from);
        [text(&home), text(&cargo), text(&self.root)]
    }

    /// A command in the root.
    pub fn command(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(program);
        command.current_dir(&self.root).stdin(Stdio::null());
        command
    }
}

/// Runs `command` to its end with its output shown.
pub fn run(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|error| cannot_start(command, &error))?;
    if status.success() { Ok(()) } else { Err(format!("{} ended with {status}", name(command))) }
}

/// Whether a command ends well; its output is left out.
pub fn succeeds(command: &mut Command) -> bool {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// A command that runs beside others, and what it has printed so far.
pub struct Beside {
    command: Command,
    child: Child,
    printed: PathBuf,
}

/// Starts `command`, which prints into the file `printed`.
pub fn start(mut command: Command, printed: PathBuf) -> Result<Beside, String> {
    let problem = |error: std::io::Error| format!("{}: {error}", printed.display());
    let file = File::create(&printed).map_err(problem)?;
    command.stdout(file.try_clone().map_err(problem)?).stderr(file);
    let child = command.spawn().map_err(|error| cannot_start(&command, &error))?;
    Ok(Beside { command, child, printed })
}

impl Beside {
    /// Waits for its end and shows what it printed.
    pub fn finish(mut self) -> Result<(), String> {
        let status = self.child.wait().map_err(|error| cannot_start(&self.command, &error))?;
        print!("{}", fs::read_to_string(&self.printed).unwrap_or_default());
        if status.success() { Ok(()) } else { Err(format!("{} ended with {status}", name(&self.command))) }
    }
}

/// Runs `command`, shows its standard output and returns it by lines, with whether it succeeded.
pub fn run_and_listen(command: &mut Command) -> Result<(Vec<String>, bool), String> {
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| cannot_start(command, &error))?;
    let mut lines = Vec::new();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line).trim_end().to_owned();
            println!("{line}");
            lines.push(line);
        }
        let _ = std::io::stdout().flush();
    }
    let status = child.wait().map_err(|error| cannot_start(command, &error))?;
    Ok((lines, status.success()))
}

/// Runs `command` and returns its standard output.
pub fn capture(command: &mut Command) -> Result<Vec<u8>, String> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| cannot_start(command, &error))?;
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(format!("{} ended with {}", name(command), output.status))
    }
}

fn name(command: &Command) -> String {
    let words: Vec<_> = command.get_args().map(|word| word.to_string_lossy()).collect();
    format!("`{} {}`", Path::new(command.get_program()).display(), words.join(" "))
}

fn cannot_start(command: &Command, error: &std::io::Error) -> String {
    format!("{} did not run: {error}", name(command))
}

/// The program at a path: itself, or that of a build or a checkout in this folder.
pub fn program(path: &Path) -> PathBuf {
    let name = format!("enmm{}", std::env::consts::EXE_SUFFIX);
    let places = ["", "release", "target/release"].map(|folder| path.join(folder).join(&name));
    let found = places.into_iter().find(|place| path.is_dir() && place.is_file()).unwrap_or_else(|| path.to_owned());
    std::path::absolute(&found).unwrap_or(found)
}

/// A problem with a file or a folder.
pub fn at(path: &Path) -> impl Fn(std::io::Error) -> String + '_ {
    move |error| format!("{}: {error}", path.display())
}

/// Makes a folder, with those in which it lies.
pub fn make(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(at(folder))
}

/// An empty folder, without what an earlier run has left there.
pub fn fresh(folder: PathBuf) -> Result<PathBuf, String> {
    remove(&folder)?;
    make(&folder).map(|()| folder)
}

/// Reads a file.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(at(path))
}

/// Writes a file, in a folder that is made if it is not there.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), String> {
    make(path.parent().unwrap_or(Path::new("")))?;
    fs::write(path, bytes).map_err(at(path))
}

/// Removes a folder or a file, if there is one.
pub fn remove(path: &Path) -> Result<(), String> {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(format!("{}: {error}", path.display())),
        _ => Ok(()),
    }
}

/// All files below a folder but hidden ones, which a run that was killed may leave half written.
pub fn files_of(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, String> {
    let mut files = BTreeMap::new();
    let mut folders = vec![(folder.to_owned(), String::new())];
    while let Some((path, before)) = folders.pop() {
        let entries = fs::read_dir(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        for entry in entries.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if entry.path().is_dir() {
                folders.push((entry.path(), format!("{before}{name}/")));
            } else if !name.starts_with('.') {
                let bytes = fs::read(entry.path()).map_err(|error| format!("{}: {error}", entry.path().display()))?;
                files.insert(before.clone() + &name, bytes);
            }
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn program_is_found_in_a_build_and_in_a_checkout() {
        let place = std::env::temp_dir().join(format!("enmm-program-{}", std::process::id()));
        let wanted = place.join("target/release").join(format!("enmm{}", std::env::consts::EXE_SUFFIX));
        fs::create_dir_all(wanted.parent().expect("a folder")).expect("a folder");
        fs::write(&wanted, "").expect("a file");
        for given in [place.clone(), place.join("target"), place.join("target/release"), wanted.clone()] {
            assert_eq!(program(&given), wanted, "{}", given.display());
        }
        remove(&place).expect("a folder to remove");
    }
}
