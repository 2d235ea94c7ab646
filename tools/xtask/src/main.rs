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

use std::process::ExitCode;

use repository::{Profile, Repository};

const USAGE: &str = "\
usage: cargo xtask TASK

  test             what a newcomer and every commit runs: format, build, tests, hosts in C and C++,
                   ctypes, FMPy, header, schema, quick bits; installs nothing outside the target folder
  test --all       the same first, then what is long or needs other systems: lints, Chromium, rustdoc,
                   oldest compiler, licences, notebooks, fuzz, faults, sanitizers, long forms
  test --platforms builds for Windows and for ARM, and compares their quick results, on emulators, with the
                   golden table
  python           the Python tests alone
  long             the long campaigns: tests named long_*, with ENMM_LONG=1
  fuzz [--minutes N] [--seed S] [--part NAME]
                   throws wrong cases, joint networks, calls and states at every entrance; without
                   --minutes the share that test takes
  faults [--rounds N]
                   kills, interrupts and starves runs of the program, and compares what they leave
  sanitize         valgrind and the sanitizers of the nightly compiler, those that are there
  verify           solves the full set of verification problems and writes docs/verification.md
                   with its plots; fails when a value is missed that the report did not state
  compare          runs the comparison of the explicit with the implicit integrator
  ratio            runs explicit and implicit steps of a continuum and writes the
                   last section of docs/explicit_vs_implicit.md
  overhead         tells what a step costs through the C ABI and the FMUs above the engine's own
  schema           writes docs/case.schema.json
  reference        writes docs/book/reference.md, the reference of all keys of a case
  book             builds the site of the documents by mdBook, which it installs in the target folder
  header           writes include/enmm.h and its layouts for Python
  install [--debug] --prefix DIR
                   builds and copies program, libraries, headers, CMake and pkg-config files
  wheel            builds the Python wheel of this platform, with library and program, in the target folder
  windows [--test] builds program, libraries and wheel for Windows by mingw-w64 into windows/ of the target
                   folder; --test runs them under Wine and compares their bits with the golden table
  aarch64 [--test] the same for Linux on ARM by Debian's cross compiler, run by qemu
  ensembles        the full campaigns of the ensembles: 1000 samples each against closed forms
  bench [OPTIONS]  times standard models on one thread and writes tools/bench/; options of enmm bench
                   such as --models all; with --peers builds other programs, times them turn by turn with
                   enmm and writes tools/bench/peers.md
  ab OLD NEW [--models NAMES] [--rounds N] [--threads N]
                   times two builds of the program in turn and prints the ratios of each part
  bits [OLD NEW] [--quick]
                   runs example cases, models, FMUs and problems by two builds and fails at the first bit
                   of a result that differs; without OLD NEW compares this build with the golden table
                   tests/golden/bits.csv; --quick takes the share that test takes
  bits --renew     writes the golden table
  pictures         runs the main case, the tutorials and the couplings and writes their pictures into docs/pictures
                   and docs/book/pictures";

/// The profile by which a task builds.
fn profile(words: &[&str]) -> Profile {
    match words {
        ["install", "--debug", ..] => Profile::Tested,
        ["test" | "python" | "ensembles" | "long" | "fuzz" | "faults" | "bits" | "pictures", ..] => Profile::Tested,
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
        ["python"] => Ok(test::python(&repository)),
        ["long"] => Ok(test::long(&repository)),
        ["fuzz", ref words @ ..] => test::fuzz(&repository, words).map(|()| ExitCode::SUCCESS),
        ["faults", ref words @ ..] => faults::run(&repository, words).map(|()| ExitCode::SUCCESS),
        ["sanitize"] => sanitize::run(&repository).map(|()| ExitCode::SUCCESS),
        ["verify"] => tasks::verification(&repository, "report").map(|()| ExitCode::SUCCESS),
        ["compare"] => tasks::verification(&repository, "compare").map(|()| ExitCode::SUCCESS),
        ["overhead"] => tasks::overhead(&repository).map(|()| ExitCode::SUCCESS),
        ["ratio"] => tasks::verification(&repository, "ratio").map(|()| ExitCode::SUCCESS),
        ["header"] => tasks::write_header(&repository).map(|()| ExitCode::SUCCESS),
        ["install", "--prefix", prefix] | ["install", "--debug", "--prefix", prefix] => {
            install::install(&repository, prefix.as_ref()).map(|()| ExitCode::SUCCESS)
        }
        ["wheel"] => wheel::build(&repository, &platform::HERE).map(|_| ExitCode::SUCCESS),
        ["windows", ref words @ ..] => cross::run(&repository, &platform::WINDOWS, words).map(|()| ExitCode::SUCCESS),
        ["aarch64", ref words @ ..] => cross::run(&repository, &platform::AARCH64, words).map(|()| ExitCode::SUCCESS),
        ["ensembles"] => Ok(test::ensembles(&repository)),
        ["bench", ref options @ ..] => tasks::write_benchmark(&repository, options).map(|()| ExitCode::SUCCESS),
        ["ab", ref words @ ..] => {
            ab::Comparison::read(words).and_then(|found| found.run(&repository)).map(|()| ExitCode::SUCCESS)
        }
        ["bits", ref words @ ..] => bits::run(&repository, words).map(|()| ExitCode::SUCCESS),
        ["schema"] => tasks::write_schema(&repository).map(|()| ExitCode::SUCCESS),
        ["reference"] => book::write_reference(&repository).map(|()| ExitCode::SUCCESS),
        ["book"] => book::build(&repository).map(|()| ExitCode::SUCCESS),
        ["pictures"] => tasks::write_pictures(&repository).map(|()| ExitCode::SUCCESS),
        _ => Err(USAGE.to_owned()),
    });
    done.unwrap_or_else(|message| {
        eprintln!("{message}");
        ExitCode::FAILURE
    })
}
