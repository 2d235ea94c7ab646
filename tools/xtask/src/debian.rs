//! Programs that tests use where they are, and that Debian has packages of.

use std::process::Command;

use crate::repository::succeeds;

/// Whether a program is there; where Debian's packages can be installed they are installed first.
pub fn provide(purpose: &str, packages: &str, is_there: impl Fn() -> bool) -> bool {
    let is_root = || Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout.trim_ascii() == b"0");
    if is_there() || !is_root() {
        return is_there();
    }
    println!("installing {packages} for {purpose}");
    let apt = |words: &[&str]| succeeds(Command::new("apt-get").args(words).env("DEBIAN_FRONTEND", "noninteractive"));
    let mut install = vec!["install", "--yes", "--no-install-recommends"];
    install.extend(packages.split_whitespace());
    (apt(&install) || (apt(&["update"]) && apt(&install))) && is_there()
}
