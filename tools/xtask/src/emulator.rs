//! Runs programs of other platforms on this machine.

use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use crate::platform::Cross;
use crate::repository::{self, Repository, succeeds};

/// Random numbers for a Wine that lacks the library that has them.
const RANDOM: &str = "ffi/fmi/tests/c/bcryptprimitives.c";

/// Words in front of the name of a program; none for programs of this machine.
#[derive(Default)]
pub struct Emulator {
    words: &'static [&'static str],
    variables: Vec<(&'static str, OsString)>,
}

impl Emulator {
    /// Sets up the emulator of a platform, which is installed.
    pub fn of(repository: &Repository, cross: &Cross) -> Result<Self, String> {
        let mut emulator = Self { words: cross.emulator, variables: Vec::new() };
        if cross.emulator != ["wine"] {
            return Ok(emulator);
        }
        let folder = repository.target.join("wine");
        emulator.variables = vec![
            ("WINEPREFIX", folder.clone().into()),
            ("WINEDEBUG", "-all".into()),
            // Neither .NET nor a browser is needed, and Wine would ask whether to fetch them.
            ("WINEDLLOVERRIDES", "mscoree,mshtml=".into()),
        ];
        let system = folder.join("drive_c/windows/system32");
        if !system.join("kernel32.dll").exists() && !succeeds(emulator.command(repository, "wineboot").arg("--init")) {
            return Err(format!("wine cannot make its folder {}: remove it and try again", folder.display()));
        }
        let random = system.join("bcryptprimitives.dll");
        if !random.exists() {
            let mut compile = repository.command(cross.compiler);
            compile.args(["-shared", "-O1", "-Wall", "-Wextra", "-Werror", RANDOM, "-o"]).arg(&random);
            repository::run(compile.arg("-ladvapi32"))?;
        }
        Ok(emulator)
    }

    /// Runs a program.
    pub fn command(&self, repository: &Repository, program: impl AsRef<Path>) -> Command {
        let program = program.as_ref();
        let Some((first, options)) = self.words.split_first() else { return repository.command(program) };
        let mut command = repository.command(first);
        command.args(options).arg(program);
        self.prepare(&mut command);
        command
    }

    /// Sets the variables for a program that runs the emulator itself.
    pub fn prepare(&self, command: &mut Command) {
        command.envs(self.variables.iter().map(|(name, value)| (name, value)));
    }

    /// The words before the name of a program.
    pub fn words(&self) -> &'static [&'static str] {
        self.words
    }
}
