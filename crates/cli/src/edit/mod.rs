//! `enmm edit`: shows the model of a case while the case is written, and builds it again at each save.

mod build;
mod shown;

use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, SystemTime};

use clap::Args;
use enmm_report::{Server, Source};
use enmm_stability::kinematics::Plane;

use self::build::{BoundDesk, build};
use self::shown::Shown;
use crate::case::CaseArguments;
use crate::stereonet::plane;
use crate::view::serve;
use crate::{BAD_INPUT, Failure, Outcome};

/// Pause between two looks at the files of the case.
const PAUSE: Duration = Duration::from_millis(40);

/// Arguments of `enmm edit`.
#[derive(Args)]
#[command(after_help = "Example: enmm edit slope.toml --port 8080")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Port; 0 takes one that is free.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Dip and dip direction of the face (degrees) in the stereonet, such as 65/120; default: that of the outline,
    /// where its steep edges agree.
    #[arg(long, value_name = "DIP/DIRECTION", value_parser = plane)]
    face: Option<Plane>,
}

/// Serves the page of a case to browsers on this machine, until it is interrupted. Nothing is written beside the case.
pub fn edit(arguments: Arguments) -> Outcome {
    let Arguments { case, port, face } = arguments;
    if !case.path.is_file() {
        let place = case.path.display();
        let message = format!("{place} is no file: name a case file, as `enmm new slope` writes it");
        return Err(Failure::new(message, BAD_INPUT));
    }
    let shown = Arc::new(Shown::new(&case.path));
    let server = Server::of(Arc::clone(&shown) as Arc<dyn Source>, port);
    serve(server, port, || {
        thread::Builder::new().name("build".to_owned()).spawn(move || watch(&case, face, &shown)).map(|_| ())
    })
}

/// Builds the model each time that a file of the case has changed, without end.
fn watch(case: &CaseArguments, face: Option<Plane>, shown: &Arc<Shown>) {
    let bounds = BoundDesk::open(shown);
    let mut files = vec![case.path.clone()];
    let mut seen = Vec::new();
    loop {
        let stamps = stamps(&files);
        if stamps != seen {
            // A file that changes during the build is seen again, since its stamp was taken before.
            if let Some(inputs) = build(case, face, shown, &bounds) {
                seen = if inputs == files { stamps } else { Vec::new() };
                files = inputs;
            } else {
                seen = stamps;
            }
        }
        thread::sleep(PAUSE);
    }
}

/// Time of the last change and length of each file, none of one that is not there.
fn stamps(files: &[PathBuf]) -> Vec<Option<(SystemTime, u64)>> {
    let stamp = |file: &PathBuf| {
        let found = file.metadata().ok()?;
        Some((found.modified().ok()?, found.len()))
    };
    files.iter().map(stamp).collect()
}
