//! `enmm`: runs, checks and packs case files. Exit status: 0 done, 1 a verification problem that
//! does not pass, 2 bad input, 3 numerical failure, 4 a slope that failed in a static stage, 130 interrupted.

mod bench;
mod bound;
mod caller;
mod case;
mod check;
mod draw;
mod edit;
mod export;
mod fmu;
mod fos;
mod import;
mod interrupt;
mod manual;
mod new;
mod output;
mod progress;
mod report;
mod run;
mod sample;
mod sets;
mod stereonet;
mod sweep;
mod told;
mod verify;
mod view;
mod workers;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use output::{fail, listed, print_line, tell_line};
use told::{Failure, OrFail, Outcome};

/// Bad input; nothing was written.
const BAD_INPUT: u8 = 2;
/// Numerical failure, or results that could not be written.
const FAILED: u8 = 3;
/// The slope failed in a static stage.
const SLOPE_FAILED: u8 = 4;
/// Exit status of a factor of safety of which an upper bound alone is known: trials above it were stable.
const AT_MOST: u8 = 5;
/// Interrupted by the user.
const INTERRUPTED: u8 = 130;

/// Examples and exit status, below the list of commands.
const AFTER_HELP: &str = "\
Examples:
  enmm new slope                                 a commented case to begin with
  enmm import map.dxf -o slope.toml              a case for a drawing
  enmm edit slope.toml                           the model in a browser while you write
  enmm run slope.toml                            all stages, results in the folder slope
  enmm fos slope.toml                            factor of safety
  enmm fos slope.toml --set joint_law.fault.friction_deg=25

Exit status: 0 done; 1 a verification problem missed its answer; 2 bad input, nothing written; 3 numerical failure, or
output that could not be written; 4 the slope failed in a static stage (enmm run); 5 the factor of safety is at most an
upper bound (enmm fos); 130 interrupted.";

/// Explicit numerical manifold method for jointed rock slopes.
#[derive(Parser)]
#[command(name = "enmm", version, after_help = AFTER_HELP)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// End when standard input does, with the process that holds its other end.
    #[arg(long, global = true, hide = true)]
    with_caller: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Builds a case, runs all its stages and writes the results.
    Run(run::Arguments),
    /// Builds the model of a case and reports its counts, areas, masses and warnings.
    Check(check::Arguments),
    /// Writes a commented case to begin with.
    New(new::Arguments),
    /// Writes a case for a drawing or another geometry file, and says what is left open.
    Import(import::Arguments),
    /// Packs a case as a co-simulation FMU that needs no other file.
    Fmu(fmu::Arguments),
    /// Solves problems with known answers and prints computed beside exact values.
    Verify(verify::Arguments),
    /// Finds the factor of safety of a case by dividing its strength until it fails.
    Fos(fos::Arguments),
    /// Finds the probability of failure of a case with random values from many samples.
    Sample(sample::Arguments),
    /// Finds how the factor of safety changes with keys of a case: a curve, a contour or a tornado.
    Sweep(sweep::Arguments),
    /// Draws the samples that standard input describes; how the Python package calls the program.
    #[command(hide = true)]
    Draw,
    /// Bounds the factor of safety of a case by limit analysis of its blocks as rigid bodies.
    Bound(bound::Arguments),
    /// Writes a report of results for paper: report_a4.html and, by a browser, report_a4.pdf.
    Report(report::Arguments),
    /// Writes results as a spreadsheet, a drawing (DXF) or features (GeoJSON).
    Export(export::Arguments),
    /// Draws the joint sets of a case in space and checks which failures they allow.
    Stereonet(stereonet::Arguments),
    /// Finds joint sets in a table of dips and dip directions: means, scatter, a net with a rosette, lines for a case.
    Sets(sets::Arguments),
    /// Shows the model of a case in a browser while the case is written, built again at each save.
    Edit(edit::Arguments),
    /// Shows a run in a browser while it goes on.
    View(view::Arguments),
    /// Times standard models: milliseconds per step and stage, rates, memory, limits of the machine.
    Bench(bench::Arguments),
    /// Prints the JSON Schema of the case file.
    Schema,
    /// Prints the script by which a shell completes commands and options.
    Completions(manual::CompletionArguments),
    /// Writes a manual page of each command.
    Man(manual::ManArguments),
}

fn main() -> ExitCode {
    interrupt::outlive_full_files();
    match Arguments::try_parse() {
        Ok(Arguments { command, with_caller }) => {
            if with_caller {
                caller::watch();
            }
            output::finish(execute(command).unwrap_or_else(|failure| failure.tell()))
        }
        Err(told) => output::tell(&told),
    }
}

fn execute(command: Command) -> Outcome {
    let lanes = enmm_lanes::requested();
    lanes.map_err(|message| format!("{}: {message}", enmm_lanes::VARIABLE)).or_fail(BAD_INPUT)?;
    match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Import(arguments) => import::import(&arguments),
        Command::Fmu(arguments) => fmu::fmu(&arguments),
        Command::Verify(arguments) => verify::verify(&arguments),
        Command::Fos(arguments) => fos::fos(&arguments),
        Command::Sample(arguments) => sample::sample(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Draw => draw::draw(),
        Command::Bound(arguments) => bound::bound(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Stereonet(arguments) => stereonet::stereonet(&arguments),
        Command::Sets(arguments) => sets::sets(&arguments),
        Command::Edit(arguments) => edit::edit(arguments),
        Command::View(arguments) => view::view(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Schema => schema(),
        Command::Completions(arguments) => manual::completions(&arguments),
        Command::Man(arguments) => manual::man(&arguments),
    }
}

fn schema() -> Outcome {
    print_line(&format!("{:#}", enmm_io::schema()));
    Ok(ExitCode::SUCCESS)
}
