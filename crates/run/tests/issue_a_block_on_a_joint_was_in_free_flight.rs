//! Runs looked for the joint of a block that cannot rest after outputs had given back the buffers with the contacts.

use std::path::Path;

use enmm_io::parse_case;
use enmm_run::RunOptions;

use crate::jittering_pit::PIT;

#[test]
fn the_law_of_a_block_that_cannot_rest_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let case = format!("{PIT}[output]\npictures = false\n");
    let loaded = parse_case(&case, "pit.toml", Path::new(".")).unwrap_or_else(|error| panic!("{error}"));
    let options = RunOptions { directory: directory.path().to_owned(), ..RunOptions::default() };
    let summary = enmm_run::run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    let named = summary.warnings.iter().find(|warning| warning.contains("is at rest but for block"));
    assert!(named.is_some_and(|warning| warning.contains("on a joint of law \"joints\"")), "{:?}", summary.warnings);
}
