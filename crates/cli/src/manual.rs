//! `enmm completions` and `enmm man`: what shells and manuals know of the commands.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;

use crate::{Arguments as Program, FAILED, fail, print_line};

/// Arguments of `enmm completions`.
#[derive(Args)]
#[command(after_help = "Example: enmm completions bash > ~/.local/share/bash-completion/completions/enmm")]
pub struct CompletionArguments {
    /// Shell whose script is printed.
    shell: Shell,
}

/// Arguments of `enmm man`.
#[derive(Args)]
#[command(after_help = "Example: enmm man -o ~/.local/share/man/man1")]
pub struct ManArguments {
    /// Directory for the pages, which is made if it is not there.
    #[arg(short, long, value_name = "DIR", default_value = "man")]
    output: PathBuf,
}

/// The commands that users call.
fn command() -> Command {
    Program::command()
}

/// Prints the script by which a shell completes commands and options.
pub fn completions(arguments: &CompletionArguments) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command(), "enmm", &mut script);
    print_line(String::from_utf8_lossy(&script).trim_end());
    ExitCode::SUCCESS
}

/// Writes a manual page of each command.
pub fn man(arguments: &ManArguments) -> ExitCode {
    let directory = &arguments.output;
    let written = std::fs::create_dir_all(directory).and_then(|()| clap_mangen::generate_to(command(), directory));
    match written {
        Ok(()) => {
            print_line(&format!("{}: a page of each command; man -l {0}/enmm.1 shows the first", directory.display()));
            ExitCode::SUCCESS
        }
        Err(error) => {
            let place = directory.display();
            fail(&format!("cannot write pages to {place} ({error}): choose another directory with -o"), FAILED)
        }
    }
}
