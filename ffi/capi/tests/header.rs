//! The header and the layouts for Python that are committed are those of the sources.

use crate::generator::{HEADER, files, root};

#[test]
fn the_header_and_the_layouts_for_python_are_those_of_the_sources() {
    for (path, own) in files().expect("sources that can be read") {
        let committed = std::fs::read_to_string(root().join(path)).expect(path);
        let line = 1 + own.lines().zip(committed.lines()).take_while(|(a, b)| a == b).count();
        assert!(own == committed, "{path} differs from line {line} on: run `cargo xtask header` and commit");
    }
}

#[test]
fn every_entry_point_is_documented() {
    let header = std::fs::read_to_string(root().join(HEADER)).expect("the header");
    let lines: Vec<&str> = header.lines().collect();
    let declares = |line: &str| {
        let first = line.split('(').next().unwrap_or_default();
        !line.starts_with([' ', '*', '/', '}']) && line.contains('(') && first.contains("enmm_")
    };
    let declared: Vec<usize> =
        (0..lines.len()).filter(|&k| declares(lines[k]) && !lines[k].contains("typedef")).collect();
    assert!(declared.len() >= 45, "{} functions", declared.len());
    for k in declared {
        assert!(lines[k - 1].trim() == "*/", "no text above: {}", lines[k]);
    }
}
