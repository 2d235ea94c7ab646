//! Shells and manuals know every command, and `--help` has examples and the exit status.

use std::fs;

use crate::support::Place;

const COMMANDS: [&str; 9] = ["run", "check", "fos", "bound", "sweep", "import", "stereonet", "edit", "view"];

#[test]
fn every_command_has_a_page_and_is_completed() {
    let place = Place::with("");
    place.answers(0, &["man", "-o", "pages"]);
    let pages = place.names_in("pages");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = place.answers(0, &["completions", shell]);
        for command in COMMANDS {
            assert!(script.stdout.contains(command), "{command} is not completed in {shell}");
        }
    }
    for command in COMMANDS {
        assert!(pages.contains(&format!("enmm-{command}.1")), "{pages:?}");
    }
    assert!(!pages.contains(&"enmm-draw.1".to_owned()), "a hidden command has a page");
    let first = fs::read_to_string(place.path("pages/enmm.1")).expect("a page");
    assert!(first.contains("EXIT STATUS") || first.contains("Exit status"), "{first}");
}

#[test]
fn help_has_examples_and_the_exit_status() {
    let place = Place::with("");
    let help = place.enmm(&["--help"]);
    for part in ["Examples:", "enmm fos slope.toml", "Exit status:", "130"] {
        assert!(help.stdout.contains(part), "{part:?} is not in {}", help.stdout);
    }
    for command in ["run", "check", "fos", "bound", "sweep", "import", "stereonet", "edit"] {
        let help = place.enmm(&[command, "--help"]);
        assert!(help.stdout.contains("Example: enmm "), "{command}: {}", help.stdout);
    }
}
