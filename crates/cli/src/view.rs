//! `enmm view`: shows the film of a run in a browser while the run goes on.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_report::{FILM, PAGE, Server, write_page};

use crate::{BAD_INPUT, FAILED, fail, print_line};

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
pub fn view(arguments: &Arguments) -> ExitCode {
    let directory = &arguments.directory;
    if !directory.is_dir() {
        let place = directory.display();
        return fail(&format!("{place} is no directory: name that of the results, as `enmm run -o` does"), BAD_INPUT);
    }
    if arguments.page {
        return match write_page(&directory.join(FILM), &directory.join(PAGE)) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail(&error, BAD_INPUT),
        };
    }
    let server = match Server::open(&directory.join(FILM), arguments.port) {
        Ok(server) => server,
        Err(error) => return fail(&format!("cannot listen at port {} ({error})", arguments.port), FAILED),
    };
    let outcome = server.address().and_then(|address| {
        print_line(&format!("open http://{address}/ in a browser; Ctrl-C ends this"));
        server.run()
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&format!("cannot serve any more ({error})"), FAILED),
    }
}
