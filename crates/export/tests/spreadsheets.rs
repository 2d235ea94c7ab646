//! Claim: a spreadsheet holds all tables of a folder of results, number by number, read back by another reader.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read};

use enmm_export::{Cell, ExportError, Table, tables, workbook};
use zip::ZipArchive;

const HISTORY: &str = "time [s],stage,crest_ux [m]\n0.0,1,-1.25e-300\n0.5,1,0.1\n1.0,2,12345678.901234567\n";
const FOS: &str = "factor,verdict,failing_area [m2]\n0.8,stable,-0\n1.21,\"unstable, by <sliding> & \"\"more\"\"\",\n";
const RECORD: &str = r#"{
  "title": "A <slope> & more", "failed": false, "failure": null, "time": 1.5, "dt": {"min": 0.25, "max": 0.5},
  "seed": 18446744073709551615, "warnings": ["first", "second"], "crumbs": [],
  "stages": [{"name": "gravity", "time": 1.0, "converged": true},
             {"name": "slide", "time": 0.5, "converged": null, "place": [3.0, 4.5]}],
  "mechanisms": [{"factor": 1.2, "trials": [{"factor": 1.1, "speed": 0.5}]},
                 {"factor": 1.3, "trials": [{"factor": 1.0, "speed": 0.0}, {"factor": 1.4, "speed": 2.0}]}],
  "input": {"keys": [{"key": "mesh.size"}]}
}"#;

/// Cells of a sheet by their places, as text, with their types.
type Sheet = BTreeMap<String, (String, String)>;

/// Sheets in their order, read by what ECMA-376 says.
fn read(bytes: &[u8]) -> Vec<(String, Sheet)> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).expect("an archive");
    let mut part = |name: &str| {
        let mut text = String::new();
        archive.by_name(name).expect(name).read_to_string(&mut text).expect("UTF-8");
        text
    };
    let (book, relations) = (part("xl/workbook.xml"), part("xl/_rels/workbook.xml.rels"));
    let (book, relations) = (xml(&book), xml(&relations));
    let of = |node: &roxmltree::Node, name: &str| node.attribute(name).expect("an attribute").to_owned();
    let target = |id: &str| {
        let found = relations.descendants().find(|node| node.attribute("Id") == Some(id)).expect("a relation");
        format!("xl/{}", of(&found, "Target"))
    };
    let sheets = book.descendants().filter(|node| node.has_tag_name((MAIN, "sheet")));
    let sheets: Vec<(String, String)> =
        sheets.map(|node| (of(&node, "name"), target(node.attribute((RELATIONS, "id")).expect("an id")))).collect();
    sheets.into_iter().map(|(name, path)| (name, cells(&part(&path)))).collect()
}

const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
const RELATIONS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";

fn xml(text: &str) -> roxmltree::Document<'_> {
    roxmltree::Document::parse(text).expect("XML")
}

fn cells(sheet: &str) -> Sheet {
    let document = xml(sheet);
    let pane = document.descendants().find(|node| node.has_tag_name((MAIN, "pane"))).expect("frozen heads");
    assert_eq!((pane.attribute("ySplit"), pane.attribute("state")), (Some("1"), Some("frozen")));
    let cell = |node: roxmltree::Node| {
        let text: String = node.descendants().filter_map(|inner| inner.text().filter(|_| inner.is_text())).collect();
        let kind = node.attribute("t").unwrap_or("n").to_owned();
        (node.attribute("r").expect("a place").to_owned(), (kind, text))
    };
    document.descendants().filter(|node| node.has_tag_name((MAIN, "c"))).map(cell).collect()
}

/// Place of a cell, of fewer than 27 columns.
fn place(row: usize, column: usize) -> String {
    format!("{}{}", char::from(b'A' + column as u8), row + 1)
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("fos")).expect("made");
    for (name, text) in [("history.csv", HISTORY), ("fos/fos.csv", FOS), ("summary.json", RECORD)] {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

#[test]
fn every_cell_of_a_csv_file_is_in_its_sheet() {
    let folder = folder();
    let sheets = read(&workbook(&tables(folder.path()).expect("tables")).expect("a spreadsheet"));
    for (name, text) in [("history", HISTORY), ("fos", FOS)] {
        let (_, sheet) = sheets.iter().find(|(sheet, _)| sheet == name).expect(name);
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let mut count = 0;
        for (row, record) in reader.records().enumerate() {
            for (column, text) in record.expect("a row").iter().enumerate().filter(|(_, text)| !text.is_empty()) {
                let (kind, found) = &sheet[&place(row, column)];
                match text.parse::<f64>() {
                    Ok(number) => assert_eq!((kind.as_str(), found.parse()), ("n", Ok(number)), "{text}"),
                    Err(_) => assert_eq!((kind.as_str(), found.as_str()), ("inlineStr", text)),
                }
                count += 1;
            }
        }
        assert_eq!(sheet.len(), count, "{name} has no other cells");
    }
}

#[test]
fn records_become_single_values_with_units_and_a_sheet_for_each_list() {
    let folder = folder();
    let found = tables(folder.path()).expect("tables");
    let table = |name: &str| found.iter().find(|table| table.name == name).unwrap_or_else(|| panic!("no {name}"));
    let text = |text: &str| Cell::Text(text.to_owned());
    let facts = &table("summary.json").rows;
    for row in [
        vec![text("dt.min"), Cell::Number(0.25), text("s")],
        vec![text("time"), Cell::Number(1.5), text("s")],
        vec![text("failed"), Cell::Flag(false), Cell::Empty],
        vec![text("warnings_2"), text("second"), Cell::Empty],
        vec![text("seed"), text("18446744073709551615"), Cell::Empty],
    ] {
        assert!(facts.contains(&row), "{row:?} is not in {facts:?}");
    }
    let stages = table("summary.json.stages");
    assert_eq!(stages.columns, ["converged", "name", "time [s]", "place_x [m]", "place_y [m]"]);
    assert_eq!(stages.rows[1][2..], [Cell::Number(0.5), Cell::Number(3.0), Cell::Number(4.5)]);
    assert_eq!(stages.rows[0][3..], [Cell::Empty, Cell::Empty]);
    let trials = table("summary.json.mechanisms.trials");
    assert_eq!(trials.columns, ["of row", "factor", "speed [m/s]"]);
    let owners: Vec<&Cell> = trials.rows.iter().map(|row| &row[0]).collect();
    assert_eq!(owners, [&Cell::Number(1.0), &Cell::Number(2.0), &Cell::Number(2.0)]);
    assert!(!found.iter().any(|table| table.name.contains("input")), "the input is no result");
}

#[test]
fn the_first_sheet_lists_all_and_names_fit_a_spreadsheet() {
    let long = |end: &str| Table {
        name: format!("ensemble.json.of a very long name: [{end}]"),
        source: "ensemble.json".into(),
        columns: vec!["a".to_owned()],
        rows: vec![vec![Cell::Number(1.0)]],
    };
    let all = [long("x"), long("x"), long("X"), long("contents")];
    let bytes = workbook(&all).expect("a spreadsheet");
    assert_eq!(bytes, workbook(&all).expect("the same"), "the bytes know no clock");
    let sheets = read(&bytes);
    let mut names: Vec<String> = sheets.iter().map(|(name, _)| name.to_lowercase()).collect();
    assert_eq!(names[0], "contents");
    assert!(names.iter().all(|name| name.chars().count() <= 31 && !name.contains(['[', ']', ':', '*', '?', '/'])));
    assert_eq!(sheets[0].1["A2"].1, sheets[1].0);
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 5);
}

#[test]
fn folders_and_tables_that_cannot_be_exported_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |path: &std::path::Path| tables(path).expect_err("refused").to_string();
    assert!(refused(&folder.path().join("none")).contains("name that of the results"));
    assert!(refused(folder.path()).contains("enmm run CASE -o"));
    fs::write(folder.path().join("fos.json"), "{\"title\": ").expect("written");
    assert!(refused(folder.path()).contains("fos.json"));
    let table = |rows: usize, text: &str| Table {
        name: "history".to_owned(),
        source: "history.csv".into(),
        columns: vec!["time [s]".to_owned()],
        rows: vec![vec![Cell::Text(text.to_owned())]; rows],
    };
    let too_long = workbook(&[table(1_048_576, "")]).expect_err("refused");
    assert!(matches!(&too_long, ExportError::TooLarge { .. }), "{too_long}");
    assert!(too_long.to_string().contains("1048577 rows") && too_long.to_string().contains("history_interval"));
    assert!(workbook(&[table(2, &"x".repeat(32_768))]).expect_err("refused").to_string().contains("row 1"));
    assert!(workbook(&[table(2, &"x".repeat(32_767))]).is_ok());
}
