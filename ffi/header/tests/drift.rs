//! The header that is committed is the one of the sources.

use enmm_header::{HEADER, generate, root};

#[test]
fn the_header_is_that_of_the_sources() {
    let committed = std::fs::read_to_string(root().join(HEADER)).expect(HEADER);
    let own = generate().expect("sources that can be read");
    let line = 1 + own.lines().zip(committed.lines()).take_while(|(a, b)| a == b).count();
    assert!(own == committed, "{HEADER} differs from line {line} on: run `cargo xtask header` and commit");
}

#[test]
fn every_entry_point_is_documented() {
    let header = generate().expect("sources that can be read");
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
