//! `enmm completions` and `enmm man`: what shells and manuals know of the commands.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::{Arguments as Program, FAILED, OrFail, Outcome, print_line};

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

/// Prints the script by which a shell completes commands and options.
pub fn completions(arguments: &CompletionArguments) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Program::command(), "enmm", &mut script);
    print_line(String::from_utf8_lossy(&script).trim_end());
    Ok(ExitCode::SUCCESS)
}

/// Writes a manual page of each command.
pub fn man(arguments: &ManArguments) -> Outcome {
    let (directory, place) = (&arguments.output, arguments.output.display());
    let made = std::fs::create_dir_all(directory);
    made.and_then(|()| clap_mangen::generate_to(Program::command(), directory))
        .map_err(|error| format!("cannot write pages to {place} ({error}): choose another directory with -o"))
        .or_fail(FAILED)?;
    print_line(&format!("{place}: a page of each command; man -l {place}/enmm.1 shows the first"));
    Ok(ExitCode::SUCCESS)
}
