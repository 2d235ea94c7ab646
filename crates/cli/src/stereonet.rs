//! `enmm stereonet`: draws the joint sets of a case in space and checks which failures they allow.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_io::files::write_atomic;
use enmm_run::{NetOptions, Projection, check_output, stereonet as net_of};
use enmm_stability::kinematics::{Limits, Plane};

use crate::case::CaseArguments;
use crate::{BAD_INPUT, FAILED, OrFail, Outcome, print_line};

/// Arguments of `enmm stereonet`.
#[derive(Args)]
#[command(after_help = "Example: enmm stereonet slope.toml --face 65/120 -o net.svg")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// SVG file; default: the case file with `.stereonet.svg`.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Dip and dip direction of the face (degrees), such as 65/120; default: that of the outline, normal to the
    /// section, where its steep edges agree.
    #[arg(long, value_name = "DIP/DIRECTION", value_parser = plane)]
    face: Option<Plane>,
    /// Greatest angle (degrees) between the dip directions of a plane that slides and of the face.
    #[arg(long, value_name = "DEG", default_value_t = 20.0, value_parser = limit)]
    sliding_limit: f64,
    /// Greatest angle (degrees) between the strikes of layers that topple and of the face.
    #[arg(long, value_name = "DEG", default_value_t = 30.0, value_parser = limit)]
    toppling_limit: f64,
    /// Draws by equal angles (Wulff) instead of equal areas (Schmidt).
    #[arg(long)]
    equal_angle: bool,
}

/// Reads a plane, such as 65/120.
///
/// # Errors
/// The form of a plane, where the text has another one.
pub fn plane(text: &str) -> Result<Plane, String> {
    let parts = text.split_once('/').and_then(|(dip, azimuth)| Some((dip.parse().ok()?, azimuth.parse().ok()?)));
    match parts {
        Some((dip, direction)) if (0.0..=90.0).contains(&dip) && (-360.0..=360.0).contains(&direction) => {
            Ok(Plane { dip, direction })
        }
        _ => Err("write a dip of 0 to 90 and its azimuth of -360 to 360, such as 65/120".to_owned()),
    }
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=90.0).contains(&value) => Ok(value),
        _ => Err("write an angle of 0 to 90 degrees".to_owned()),
    }
}

/// Draws the stereonet of a case and prints what it shows.
pub fn stereonet(arguments: &Arguments) -> Outcome {
    let loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    let options = NetOptions {
        face: arguments.face,
        limits: Limits { sliding: arguments.sliding_limit, toppling: arguments.toppling_limit },
        projection: if arguments.equal_angle { Projection::EqualAngle } else { Projection::EqualArea },
    };
    let net = net_of(&loaded, &options).map_err(|message| format!("{}: {message}", loaded.source.file()));
    let net = net.or_fail(BAD_INPUT)?;
    let path = arguments.output.clone().unwrap_or_else(|| arguments.case.path.with_extension("stereonet.svg"));
    let unwritten = |error| format!("cannot write the picture ({error}): choose another file with -o");
    check_output(&path, loaded.source.inputs()).map_err(unwritten).or_fail(BAD_INPUT)?;
    write_atomic(&path, net.picture().svg().as_bytes()).map_err(unwritten).or_fail(FAILED)?;
    let mut lines = vec![format!("{:<21} {:.1}°/{:05.1}°", "face", net.face.dip, net.face.direction)];
    for (set, remark) in net.sets.iter().zip(&net.remarks) {
        let plane = format!("{:.1}°/{:05.1}°, φ {:.1}°", set.plane.dip, set.plane.direction, set.friction);
        lines.push(format!("{:<21} {plane}; {remark}", set.name));
    }
    lines.extend(net.findings(&net.failures()));
    lines.extend(net.notes.iter().map(|note| format!("note: {note}")));
    lines.push(format!("{:<21} {}", "picture", path.display()));
    print_line(&lines.join("\n"));
    Ok(ExitCode::SUCCESS)
}
