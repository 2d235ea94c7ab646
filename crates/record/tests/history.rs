//! Histories keep every row of a killed run, and a resumed run continues them; files are whole or absent.

use std::fs;
use std::path::Path;

use enmm_io::files::write_atomic;
use enmm_record::history::HistoryWriter;

const COLUMNS: [(&str, &str); 3] = [("time", "s"), ("crest_ux", "m"), ("open_contacts", "")];
const HEADER: &str = "time [s],crest_ux [m],open_contacts\n";

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

/// Digits read back to the same number, and a row is in the file before the writer is dropped.
#[test]
fn rows_are_in_the_file_at_once_and_exact() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut history = HistoryWriter::new(&path, &COLUMNS).unwrap();
    assert_eq!(text(&path), HEADER);
    let rows = [[0.1 + 0.2, -1e-300, 3.0], [1.0, f64::MIN_POSITIVE, f64::NAN], [2.0, 1.0 / 3.0, f64::MAX]];
    for row in rows {
        history.row(&row).unwrap();
    }
    for (line, row) in text(&path).lines().skip(1).zip(rows) {
        let read: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        assert!(read.iter().zip(row).all(|(read, value)| read.to_bits() == value.to_bits()), "{line}");
    }
    assert!(text(&path).contains("0.30000000000000004,-1e-300,3.0\n"));
}

#[test]
fn a_row_of_the_wrong_length_is_refused_and_not_written() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut history = HistoryWriter::new(&path, &COLUMNS).unwrap();
    let error = history.row(&[1.0, 2.0]).unwrap_err();
    assert!(error.to_string().contains("history.csv"), "{error}");
    assert_eq!(text(&path), HEADER);
}

/// Rows that follow may need the one before, also after a resumption and after rows that were taken back.
#[test]
fn the_last_row_is_known() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut history = HistoryWriter::new(&path, &COLUMNS).unwrap();
    assert_eq!(history.last(), None);
    for time in [0.1, 0.2, 1.0 / 3.0] {
        history.row(&[time, 2.0 * time, 1.0]).unwrap();
    }
    assert_eq!(history.last(), Some(&[1.0 / 3.0, 2.0 / 3.0, 1.0][..]));
    history.hold();
    history.row(&[0.4, 7.0, 1.0]).unwrap();
    assert_eq!(history.last(), Some(&[0.4, 7.0, 1.0][..]));
    history.discard();
    assert_eq!(history.last(), Some(&[1.0 / 3.0, 2.0 / 3.0, 1.0][..]));
    history.cut(0.25).unwrap();
    assert_eq!(history.last(), Some(&[0.2, 0.4, 1.0][..]));
    drop(history);
    let mut resumed = HistoryWriter::open_for_append(&path, &COLUMNS, 0.15).unwrap();
    assert_eq!(resumed.last(), Some(&[0.1, 0.2, 1.0][..]));
    resumed.cut(0.0).unwrap();
    assert_eq!(resumed.last(), None);
}

#[test]
fn a_resumed_history_continues_at_its_checkpoint() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut history = HistoryWriter::open_for_append(&path, &COLUMNS, 0.0).unwrap();
    for time in [0.0, 0.1, 0.2, 0.3] {
        history.row(&[time, 2.0 * time, 1.0]).unwrap();
    }
    drop(history);
    let mut resumed = HistoryWriter::open_for_append(&path, &COLUMNS, 0.1).unwrap();
    resumed.row(&[0.15, 7.0, 0.0]).unwrap();
    assert_eq!(text(&path), format!("{HEADER}0.0,0.0,1.0\n0.1,0.2,1.0\n0.15,7.0,0.0\n"));
}

/// `0.25` cut to `0.2` would read as a row of its own.
#[test]
fn a_row_cut_short_by_a_kill_is_dropped() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    for torn in ["0.1", "0.1,2.0,", "0.1,2.0,3"] {
        fs::write(&path, format!("{HEADER}0.0,1.0,2.0\n{torn}")).unwrap();
        HistoryWriter::open_for_append(&path, &COLUMNS, 9.0).unwrap().row(&[0.2, 1.0, 1.0]).unwrap();
        assert_eq!(text(&path), format!("{HEADER}0.0,1.0,2.0\n0.2,1.0,1.0\n"));
    }
    fs::write(&path, "time [s],cr").unwrap();
    HistoryWriter::open_for_append(&path, &COLUMNS, 9.0).unwrap();
    assert_eq!(text(&path), HEADER);
}

#[test]
fn another_header_or_no_numbers_are_refused_and_kept() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    for foreign in ["time [s],toe_ux [m]\n", "a\n", &format!("{HEADER}0.0,x,1\n"), &format!("{HEADER}0.0\n")] {
        fs::write(&path, foreign).unwrap();
        let error = HistoryWriter::open_for_append(&path, &COLUMNS, 9.0).unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidData);
        assert!(error.to_string().contains("history.csv"), "{error}");
        assert_eq!(text(&path), foreign);
    }
}

#[test]
fn names_with_commas_survive() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let columns = [("time", "s"), ("block \"3\", left", "m")];
    HistoryWriter::new(&path, &columns).unwrap().row(&[0.0, 1.0]).unwrap();
    HistoryWriter::open_for_append(&path, &columns, 5.0).unwrap().row(&[1.0, 2.0]).unwrap();
    assert_eq!(text(&path), "time [s],\"block \"\"3\"\", left [m]\"\n0.0,1.0\n1.0,2.0\n");
}

#[test]
fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("summary.json");
    write_atomic(&path, b"first").unwrap();
    write_atomic(&path, b"second").unwrap();
    assert_eq!(text(&path), "second");
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    write_atomic(&directory.path().join("a".repeat(255)), b"a name as long as may be").unwrap();
    write_atomic(&directory.path().join("missing/summary.json"), b"bytes").unwrap_err();
    assert!(!directory.path().join("missing").exists(), "a folder that was removed does not come back");
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let blocked = directory.path().join("taken");
    fs::create_dir(&blocked).unwrap();
    fs::write(blocked.join("inside"), "x").unwrap();
    let error = write_atomic(&blocked, b"bytes").unwrap_err();
    assert!(error.to_string().contains("taken"), "{error}");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}
