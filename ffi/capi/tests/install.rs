//! Files of `cargo xtask install` can be moved, and are found and used by pkg-config and CMake.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::support::{SMALL, compiler, has, root, run, succeed};

const PROJECT: &str = "
cmake_minimum_required(VERSION 3.10)
project(hosts C CXX)
find_package(enmm 0.1 REQUIRED CONFIG)
add_executable(shared_host ${ROOT}/ffi/capi/tests/c/checks.c)
target_link_libraries(shared_host enmm::enmm m)
add_executable(static_host ${ROOT}/ffi/capi/tests/c/checks.c)
target_link_libraries(static_host enmm::static)
add_executable(example ${ROOT}/ffi/cpp/example.cpp)
set_target_properties(example PROPERTIES CXX_STANDARD 17)
target_link_libraries(example enmm::enmm)
find_package(enmm 99 QUIET CONFIG)
if(enmm_FOUND)
  message(FATAL_ERROR \"a version that does not exist was found\")
endif()
";

/// Where everything has been installed, and then moved.
fn prefix() -> &'static Path {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let [first, moved] = ["installed", "installed-and-moved"].map(empty);
        let mut install = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        install.args(["run", "--quiet", "--package", "xtask", "--", "install", "--debug", "--prefix"]);
        succeed(install.arg(&first));
        std::fs::rename(&first, &moved).expect("a directory that can be moved");
        moved
    })
}

/// A path for a new directory.
fn empty(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).expect("a directory that can be removed");
    }
    path
}

#[test]
fn everything_is_in_its_place() {
    let files = [
        "bin/enmm",
        "lib/libenmm.so",
        concat!("lib/libenmm.so.", env!("CARGO_PKG_VERSION_MAJOR")),
        concat!("lib/libenmm.so.", env!("CARGO_PKG_VERSION")),
        "lib/libenmm_fmu.so",
        "lib/libenmm.a",
        "include/enmm.h",
        "include/enmm.hpp",
        "lib/pkgconfig/enmm.pc",
        "lib/cmake/enmm/enmmConfig.cmake",
        "lib/cmake/enmm/enmmConfigVersion.cmake",
    ];
    let absent: Vec<_> = files.into_iter().filter(|file| !prefix().join(file).is_file()).collect();
    assert!(absent.is_empty(), "{absent:?}");
    succeed(Command::new(prefix().join("bin/enmm")).arg("--version"));
}

#[test]
fn a_linked_program_looks_for_the_library_of_its_series() {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("checks-of-a-series");
    let (source, folder) = ("ffi/capi/tests/c/checks.c", prefix().join("lib"));
    succeed(compiler(source).arg(source).arg("-o").arg(&program).arg("-L").arg(&folder).args(["-lenmm", "-lm"]));
    let series = concat!("libenmm.so.", env!("CARGO_PKG_VERSION_MAJOR"));
    let alone = empty("library-of-a-series");
    std::fs::create_dir_all(&alone).expect("a directory");
    std::fs::copy(folder.join(series), alone.join(series)).expect("a library of that name");
    let run = |folder: &Path| run(Command::new(&program).arg(SMALL).env("LD_LIBRARY_PATH", folder)).status;
    assert!(run(&alone).success());
    std::fs::rename(alone.join(series), alone.join("libenmm.so")).expect("another name");
    assert!(!run(&alone).success(), "the program has loaded a library of any series");
}

#[test]
fn pkg_config_finds_the_library() {
    if !has("pkg-config") {
        return;
    }
    let mut ask = Command::new("pkg-config");
    ask.args(["--cflags", "--libs", "enmm"]).env("PKG_CONFIG_PATH", prefix().join("lib/pkgconfig"));
    let flags = succeed(&mut ask);
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("checks-by-pkg-config");
    let source = "ffi/capi/tests/c/checks.c";
    succeed(compiler(source).arg(source).arg("-o").arg(&program).args(flags.split_whitespace()).arg("-lm"));
    succeed(Command::new(program).arg(SMALL).env("LD_LIBRARY_PATH", prefix().join("lib")));
}

#[test]
fn cmake_finds_the_library() {
    if !has("cmake") {
        return;
    }
    let project = empty("cmake-project");
    std::fs::create_dir_all(&project).expect("a directory");
    std::fs::write(project.join("CMakeLists.txt"), PROJECT).expect("a file");
    let build = project.join("build");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(&project).arg("-B").arg(&build).arg(format!("-DROOT={}", root().display()));
    succeed(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix().display())));
    succeed(Command::new("cmake").arg("--build").arg(&build));
    for host in ["shared_host", "static_host", "example"] {
        succeed(Command::new(build.join(host)).arg(SMALL));
    }
}
