//! Times other programs on slopes and continua in turn with enmm, on one thread, and writes how long all took.
#![forbid(unsafe_code)]

mod peer_report;
mod peers;
mod scene;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use enmm_verification::bench::{Model, Origin};

use peer_report::{peers_markdown, write_peers};
use peers::{COMPARED, Peer, PeerOptions, compare};

/// Time other programs in turn with enmm. Cargo and pip build them from the sources of the repository.
#[derive(Parser)]
struct Arguments {
    /// Programs, separated by commas: rapier, rapier-constraints, box2d, numba, or all.
    #[arg(long, value_name = "PROGRAMS", value_delimiter = ',', num_args = 0..=1, default_value = "all",
          default_missing_value = "all")]
    peers: Vec<String>,
    /// Models, as `enmm bench` names them. Default: slopes of 500 and 2 000 blocks, continua of 10 000 and 100 000
    /// elements.
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    models: Vec<String>,
    /// Rounds of the comparison.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    rounds: u16,
    /// Simulated time of slopes (s), in whole sixtieths. A second of 100 000 blocks takes hours.
    #[arg(long, default_value_t = 1.0, value_name = "SECONDS", value_parser = duration)]
    duration: f64,
    /// Folder of the sources of the other programs.
    #[arg(long, value_name = "DIR", default_value = "tools/bench/peers")]
    peer_sources: PathBuf,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Directory for the tables (Markdown and JSON).
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Label of these results, such as commit and date.
    #[arg(long, default_value = "Measured", value_name = "TEXT")]
    label: String,
}

fn main() -> ExitCode {
    run(&Arguments::parse()).map_or_else(
        |message| {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let peers = peers(&arguments.peers)?;
    let models = models(&arguments.models, &peers)?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    let (rounds, sources) = (usize::from(arguments.rounds), arguments.peer_sources.clone());
    let (duration, builds) = (arguments.duration, target.join("peers"));
    let options = PeerOptions { models, peers, rounds, duration, sources, builds };
    let report = compare(&options, &mut |what| eprintln!("{what} …")).map_err(|error| error.to_string())?;
    let origin = Origin::of(&arguments.label, "cargo xtask bench", std::env::args().skip(1));
    if let Some(folder) = &arguments.output {
        write_peers(&report, &origin, folder).map_err(|error| error.to_string())?;
    }
    if arguments.json {
        println!("{:#}", serde_json::json!(report));
    } else {
        println!("{}", peers_markdown(&report, &origin).trim_end());
    }
    Ok(())
}

/// A simulated time: a step of the other programs is a sixtieth of a second.
fn duration(text: &str) -> Result<f64, String> {
    let steps = 60.0 * text.parse::<f64>().map_err(|error| error.to_string())?;
    let is_whole = (steps - steps.round()).abs() < 1e-6;
    let is_valid = is_whole && (1.0..=3600.0).contains(&steps.round());
    is_valid.then(|| steps.round() / 60.0).ok_or_else(|| "it must be whole sixtieths of a second, 1 to 3600".to_owned())
}

fn peers(names: &[String]) -> Result<Vec<Peer>, String> {
    if names == ["all"] {
        return Ok(Peer::ALL.to_vec());
    }
    let known = || Peer::ALL.map(|peer| peer.name).join(", ");
    let read = |name: &String| {
        Peer::parse(name)
            .ok_or_else(|| format!("there is no program {name:?} to compare with: try {}, or all", known()))
    };
    names.iter().map(read).collect()
}

fn models(names: &[String], peers: &[Peer]) -> Result<Vec<Model>, String> {
    if names.is_empty() {
        return Ok(COMPARED.into_iter().filter(|model| peers.iter().any(|peer| peer.takes(model))).collect());
    }
    let read = |name: &String| Model::parse(name).ok_or_else(|| format!("there is no model {name:?}"));
    names.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_duration_is_whole_steps_of_the_others() {
        assert_eq!(
            ["1", "0.05", "0.016666667"].map(|text| super::duration(text).ok()),
            [1.0, 0.05, 1.0 / 60.0].map(Some)
        );
        assert!(["0.06", "0", "61", "nan", "x"].iter().all(|text| super::duration(text).is_err()));
    }
}
