//! Hosts in C and C++ use the library as it is built: header, every function, leaks, threads, a coupled run.

use std::path::Path;
use std::process::Command;

use crate::support::{SMALL, compiler, has, host, host_with, libraries, root, run, say, succeed};

const COUPLED: &str = "examples/cases/coupled_slope.toml";

#[test]
fn the_header_compiles_alone_in_both_languages() {
    for name in ["alone.c", "alone.cpp"] {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&file, "#include \"enmm.h\"\n#include \"enmm.h\"\n").expect("a file that can be written");
        succeed(compiler(name).arg("-fsyntax-only").arg(file));
    }
}

#[test]
fn every_function_does_what_it_says_and_refuses_what_it_must() {
    succeed(Command::new(host("ffi/capi/tests/c/checks.c")).arg(SMALL));
}

#[test]
fn parameters_and_samples_are_as_the_same_calls_one_by_one() {
    succeed(Command::new(host("ffi/capi/tests/c/samples.c")).arg(SMALL));
}

#[test]
fn a_recorded_model_leaves_results_and_the_same_state() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("records");
    // That of an earlier test.
    let _ = std::fs::remove_dir_all(&folder);
    succeed(Command::new(host("ffi/capi/tests/c/records.c")).arg(SMALL).arg(folder));
}

#[test]
fn the_library_shows_nothing_but_its_functions() {
    if !has("nm") {
        return;
    }
    let listed = succeed(Command::new("nm").args(["-D", "--defined-only"]).arg(libraries().join("libenmm.so")));
    let names: Vec<_> = listed.lines().filter_map(|line| line.split_whitespace().last()).collect();
    // Those of FMUs are tested with their library.
    let names: Vec<_> =
        names.into_iter().filter(|name| !name.starts_with("fmi2") && !name.starts_with("fmi3")).collect();
    let foreign: Vec<_> = names.iter().filter(|name| !name.starts_with("enmm_")).collect();
    assert!(foreign.is_empty(), "{foreign:?}");
    let header = std::fs::read_to_string(root().join("include/enmm.h")).expect("the header");
    let absent: Vec<_> = names.iter().filter(|name| !header.contains(&format!("{name}("))).collect();
    assert!(absent.is_empty() && names.len() >= 48, "{} functions, not in the header: {absent:?}", names.len());
}

#[test]
fn valgrind_finds_nothing() {
    if !has("valgrind") {
        return;
    }
    let host = host("ffi/capi/tests/c/checks.c");
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--error-exitcode=99", "--leak-check=full", "--show-leak-kinds=definite"]);
    valgrind.arg("--errors-for-leak-kinds=definite");
    succeed(valgrind.arg(host).arg(SMALL));
}

#[test]
fn lives_of_models_leave_no_memory_behind() {
    say(&succeed(Command::new(host("ffi/capi/tests/c/cycles.c")).args([SMALL, "200"])));
}

#[test]
fn threads_with_their_own_models_give_the_bits_of_one_after_the_other() {
    say(&succeed(Command::new(host("ffi/capi/tests/c/threads.c")).arg(SMALL)));
}

#[test]
fn a_call_ends_when_another_thread_or_its_callback_wants_it_to() {
    say(&succeed(Command::new(host("ffi/capi/tests/c/interrupt.c")).arg(SMALL)));
}

#[test]
fn a_forked_process_goes_on_with_threads_of_its_own() {
    succeed(&mut Command::new(host("ffi/capi/tests/c/fork.c")));
}

/// Ten thousand forks with `ENMM_LONG=1`, six hundred otherwise; 4 of 23 hung when the tables were not waited for.
#[test]
fn long_forks_beside_threads_in_the_library_do_not_hang() {
    let forks = if std::env::var_os("ENMM_LONG").is_some() { "10000" } else { "600" };
    say(&succeed(Command::new(host("ffi/capi/tests/c/forks.c")).args([SMALL, forks])));
}

#[test]
fn lanes_that_no_processor_has_are_refused() {
    let mut forks = Command::new(host("ffi/capi/tests/c/forks.c"));
    let refused = run(forks.env("ENMM_LANES", "avx1024").args([SMALL, "0"]));
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(!refused.status.success() && told.contains("ENMM_LANES: is \"avx1024\""), "{told}");
}

#[test]
fn no_call_that_fails_changes_a_byte_of_the_state() {
    succeed(Command::new(host("ffi/capi/tests/c/unchanged.c")).arg(SMALL));
}

#[test]
fn rock_that_breaks_has_parts_and_gives_the_same_bits_again() {
    say(&succeed(Command::new(host("ffi/capi/tests/c/breaks.c")).arg("ffi/capi/tests/cases/breaking.toml")));
}

#[test]
fn bridges_that_break_are_events_and_give_the_same_bits_again() {
    say(&succeed(Command::new(host("ffi/capi/tests/c/bridges.c")).arg("ffi/capi/tests/cases/bridges.toml")));
}

#[test]
fn water_in_joints_follows_heads_rain_and_drains_to_the_same_bits() {
    let cases = ["ffi/capi/tests/cases/dam.toml", "ffi/capi/tests/cases/draining_dam.toml"];
    succeed(Command::new(host("ffi/capi/tests/c/flows.c")).args(cases));
}

#[test]
fn energy_from_nowhere_is_a_warning_in_the_log() {
    // Rock of 50 Pa instead of 1 GPa: the initial equilibrium has two steps of 3.2 s.
    let small = std::fs::read_to_string(root().join(SMALL)).expect("the case");
    let soft = small.replace("young = 1e9", "young = 50").replace("duration = 0.2", "duration = 5.0");
    let soft = soft.replace("ramp = 0.05", "").replace("duration = 1.0", "duration = 50.0");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("soft.toml");
    std::fs::write(&file, soft.replace("communication_step = 0.01", "")).expect("a file that can be written");
    succeed(Command::new(host("ffi/capi/tests/c/doubt.c")).arg(file).arg(SMALL));
}

#[test]
fn the_coupled_reservoir_holds_its_checks() {
    let host = host("ffi/c/coupled_reservoir.c");
    let table = succeed(Command::new(&host).arg(COUPLED));
    assert!(table.contains("with twice the inflow") && table.lines().count() > 12, "{table}");
    let refused = run(Command::new(&host).arg("absent.toml"));
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("absent.toml"));
}

#[test]
fn a_log_in_cpp_may_replace_itself_and_end_its_model() {
    const SANITIZER: &str = "-fsanitize=address";
    succeed(Command::new(host("ffi/capi/tests/c/relog.cpp")).arg(SMALL));
    if sanitizes(SANITIZER) {
        succeed(Command::new(host_with("ffi/capi/tests/c/relog.cpp", &[SANITIZER])).arg(SMALL));
    }
}

/// Whether programs can be built with a sanitizer and run; says so when they cannot.
fn sanitizes(flag: &str) -> bool {
    let [source, program] = ["empty.cpp", "empty"].map(|name| Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
    std::fs::write(&source, "int main() {}\n").expect("a file that can be written");
    let built = run(compiler("empty.cpp").arg(flag).arg(source).arg("-o").arg(&program)).status.success();
    let there = built && run(&mut Command::new(program)).status.success();
    if !there {
        say(&format!("left out: the compiler makes no programs with {flag}"));
    }
    there
}

#[test]
fn the_example_in_cpp_holds_its_checks() {
    succeed(Command::new(host("ffi/cpp/example.cpp")).arg(SMALL));
}
