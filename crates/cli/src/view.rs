//! `enmm view`: shows the film of a run in a browser while the run goes on.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_report::{FILM, PAGE, Server, write_page};

use crate::{BAD_INPUT, FAILED, Failure, OrFail, Outcome, print_line};

/// Arguments of `enmm view`.
#[derive(Args)]
pub struct Arguments {
    /// Directory of the results of a run, which may still go on or be yet to begin.
    directory: PathBuf,
    /// Port; 0 takes one that is free.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Write report.html of the film so far instead, as after a run that was killed.
    #[arg(long)]
    page: bool,
}

/// Serves the page of a run to browsers on this machine, until it is interrupted.
pub fn view(arguments: &Arguments) -> Outcome {
    let directory = &arguments.directory;
    if !directory.is_dir() {
        let place = directory.display();
        let message = format!("{place} is no directory: name that of the results, as `enmm run -o` does");
        return Err(Failure::new(message, BAD_INPUT));
    }
    if arguments.page {
        let written = write_page(&directory.join(FILM), &directory.join(PAGE));
        return written.map(|()| ExitCode::SUCCESS).or_fail(BAD_INPUT);
    }
    serve(Server::open(&directory.join(FILM), arguments.port), arguments.port, || Ok(()))
}

/// Serves browsers on this machine until it is interrupted; `begin` is called when they can come.
pub fn serve(server: io::Result<Server>, port: u16, begin: impl FnOnce() -> io::Result<()>) -> Outcome {
    let server = server.map_err(|error| format!("cannot listen at port {port} ({error})")).or_fail(FAILED)?;
    let ended = server.address().and_then(|address| {
        print_line(&format!("open http://{address}/ in a browser; Ctrl-C ends this"));
        begin()?;
        server.run()
    });
    let ended = ended.map_err(|error| format!("cannot serve any more ({error})"));
    ended.map(|()| ExitCode::SUCCESS).or_fail(FAILED)
}
