//! Standard output and standard error. What cannot be written to standard output is an error of the command, unless its
//! reader has gone away.

use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;
use std::sync::Mutex;

use enmm::model::case::text::{is_hidden, visible};

use crate::FAILED;

/// The first line that could not be written.
static FAILURE: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints lines, with hidden characters as their codes; a reader that has gone away ends the output quietly, any other
/// failure is reported by [`finish`].
pub fn print_line(text: &str) {
    let shown: Vec<String> = text.split('\n').map(visible).collect();
    note(writeln!(io::stdout(), "{}", shown.join("\n")).and_then(|()| io::stdout().flush()));
}

fn note(written: io::Result<()>) {
    let Err(error) = written else { return };
    if error.kind() != ErrorKind::BrokenPipe {
        FAILURE.lock().unwrap_or_else(|poison| poison.into_inner()).get_or_insert(error);
    }
}

/// Things of a list that are named.
const NAMED: usize = 8;

/// The first names of a list, and how many more there are.
pub fn listed(names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(NAMED);
    let first = names.take(NAMED).collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{first} and {more} more") } else { first }
}

/// Prints the message of the parser of the arguments, help or error, and returns its exit status.
pub fn tell(told: &clap::Error) -> ExitCode {
    // Names of files that a shell has put in may hold what terminals obey.
    let has_hidden = std::env::args_os().any(|given| given.to_string_lossy().chars().any(is_hidden));
    if has_hidden && told.use_stderr() {
        told.render().to_string().trim_end().lines().for_each(tell_line);
    } else {
        let written = told.print();
        if !told.use_stderr() {
            note(written);
        }
    }
    finish(ExitCode::from(u8::try_from(told.exit_code()).unwrap_or(FAILED)))
}

/// The exit status of a command, or that of a failure when it could not print its output.
pub fn finish(status: ExitCode) -> ExitCode {
    let failure = FAILURE.lock().unwrap_or_else(|poison| poison.into_inner()).take();
    let Some(error) = failure else { return status };
    let failed = fail(&format!("cannot write to standard output ({error}): send it elsewhere"), FAILED);
    if status == ExitCode::SUCCESS { failed } else { status }
}

/// Prints a line to standard error, with hidden characters as their codes; a failure of that cannot be reported.
pub fn tell_line(text: &str) {
    let _ = writeln!(io::stderr(), "{}", visible(text));
}

/// Prints an error as one line and returns its exit status.
pub fn fail(message: &impl std::fmt::Display, status: u8) -> ExitCode {
    let line = message.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    tell_line(&format!("error: {line}"));
    ExitCode::from(status)
}
