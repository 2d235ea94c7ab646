//! House keeping: `cargo xtask test` is the one command that tests everything; the others write what is committed but
//! generated, or run what takes too long for every change.

mod ab;
mod bits;
mod book;
mod counts;
mod cross;
mod debian;
mod emulator;
mod faults;
mod formulas;
mod install;
#[path = "../../../ffi/fmi/parts/mod.rs"]
mod parts;
mod platform;
mod python;
mod repository;
mod sanitize;
mod steps;
mod supply;
mod tasks;
mod test;
mod venv;
mod wheel;
mod zig;

use std::process::ExitCode;

use python::Share;
use repository::{Profile, Repository};

/// The commands as CONTRIBUTING.md lists them.
fn usage() -> String {
    let rows = include_str!("../../../CONTRIBUTING.md").lines().filter_map(|line| line.strip_prefix("| `cargo xtask "));
    let row = |row: &str| Some(row.trim_end_matches(" |").replacen("` | ", "\n      ", 1).replace('`', ""));
    format!("usage: cargo xtask TASK\n\n  {}", rows.filter_map(row).collect::<Vec<_>>().join("\n  "))
}

/// The profile by which a task builds.
fn profile(words: &[&str]) -> Profile {
    match words {
        ["install", "--debug", ..] => Profile::Tested,
        ["test" | "python" | "ensembles" | "long" | "fuzz" | "faults" | "bits" | "pictures" | "schema", ..] => {
            Profile::Tested
        }
        _ => Profile::Shipped,
    }
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = Repository::find(profile(&words)).and_then(|repository| match words[..] {
        ["test"] => Ok(test::usual(&repository)),
        ["test", "--all"] => Ok(test::all(&repository)),
        ["test", "--platforms"] => Ok(test::platforms(&repository)),
        ["python"] => Ok(test::python(&repository, "python", Share::All)),
        ["long"] => Ok(test::long(&repository)),
        ["fuzz", ref words @ ..] => test::fuzz(&repository, words).map(|()| ExitCode::SUCCESS),
        ["faults", ref words @ ..] => faults::run(&repository, words).map(|()| ExitCode::SUCCESS),
        ["sanitize"] => sanitize::run(&repository, false).map(|()| ExitCode::SUCCESS),
        ["verify"] => tasks::verification(&repository, "report").map(|()| ExitCode::SUCCESS),
        ["compare"] => tasks::verification(&repository, "compare").map(|()| ExitCode::SUCCESS),
        ["overhead"] => tasks::overhead(&repository).map(|()| ExitCode::SUCCESS),
        ["ratio"] => tasks::verification(&repository, "ratio").map(|()| ExitCode::SUCCESS),
        ["header"] => tasks::write_header(&repository).map(|()| ExitCode::SUCCESS),
        ["install", "--prefix", prefix] | ["install", "--debug", "--prefix", prefix] => {
            install::install(&repository, prefix.as_ref()).map(|()| ExitCode::SUCCESS)
        }
        ["wheel"] => wheel::build(&repository, &platform::HERE).map(|_| ExitCode::SUCCESS),
        ["wheel", "--old"] => wheel::build(&repository, &platform::OLD_LINUX).map(|_| ExitCode::SUCCESS),
        ["windows", ref words @ ..] => cross::run(&repository, &platform::WINDOWS, words).map(|()| ExitCode::SUCCESS),
        ["aarch64", ref words @ ..] => cross::run(&repository, &platform::AARCH64, words).map(|()| ExitCode::SUCCESS),
        ["ensembles"] => Ok(test::python(&repository, "ensembles", Share::Ensembles)),
        ["bench", ref options @ ..] => tasks::write_benchmark(&repository, options).map(|()| ExitCode::SUCCESS),
        ["ab", ref words @ ..] => {
            ab::Comparison::read(words).and_then(|found| found.run(&repository)).map(|()| ExitCode::SUCCESS)
        }
        ["bits", ref words @ ..] => bits::run(&repository, words).map(|()| ExitCode::SUCCESS),
        ["schema"] => tasks::write_schema(&repository).map(|()| ExitCode::SUCCESS),
        ["reference"] => book::write_reference(&repository).map(|()| ExitCode::SUCCESS),
        ["api"] => python::write_api(&repository).map(|()| ExitCode::SUCCESS),
        ["book"] => book::build(&repository).map(|()| ExitCode::SUCCESS),
        ["pictures"] => tasks::write_pictures(&repository).map(|()| ExitCode::SUCCESS),
        _ => Err(usage()),
    });
    done.unwrap_or_else(|message| {
        eprintln!("{message}");
        ExitCode::FAILURE
    })
}
