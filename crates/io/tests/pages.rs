//! Claim: every piece of a case that a page of the book shows is TOML, and has no key that a case has not.

use std::collections::BTreeSet;
use std::path::PathBuf;

use toml::{Table, Value};

use crate::key_reference::sections;

/// Pages of the book with their names.
fn pages() -> Vec<(String, String)> {
    let folder = crate::common::root().join("docs/book");
    let entries = std::fs::read_dir(folder).expect("the book").map(|entry| entry.expect("an entry").path());
    let pages = entries.filter(|path| path.extension().is_some_and(|end| end == "md"));
    let named = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a page");
        (path.file_name().expect("a name").to_string_lossy().into_owned(), text)
    };
    pages.map(named).collect()
}

/// The pieces of a page that are marked as TOML.
fn pieces(page: &str) -> Vec<&str> {
    page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect()
}

/// Keys of a case by the path of their table, such as `joint_law.NAME`.
fn known() -> BTreeSet<String> {
    let sections = sections();
    let of = |section: &crate::key_reference::Section| {
        let path = section.path().join(".");
        let prefix = if path.is_empty() { path.clone() } else { format!("{path}.") };
        let keys: Vec<String> = section.keys.iter().map(|(key, ..)| format!("{prefix}{key}")).collect();
        keys.into_iter().chain([path])
    };
    sections.iter().flat_map(of).collect()
}

/// Keys of a table that no case has, with their path.
fn strangers(table: &Table, path: &str, known: &BTreeSet<String>) -> Vec<String> {
    let inner = |key: &str, value: &Value| -> Vec<String> {
        let place = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let named = format!("{path}.NAME");
        let places = [place.clone(), format!("{place}[]"), named];
        let holds_more = |place: &str| known.iter().any(|other| other.starts_with(&format!("{place}.")));
        let is_known = |place: &String| known.contains(place) || holds_more(place);
        let Some(place) = places.into_iter().find(is_known) else { return vec![place] };
        // A number, a list of numbers or of names, or a table of names that are free, such as levels of heads.
        if !holds_more(&place) {
            return Vec::new();
        }
        match value {
            Value::Table(table) => strangers(table, &place, known),
            Value::Array(list) => {
                let tables = list.iter().filter_map(Value::as_table);
                tables.flat_map(|table| strangers(table, &place, known)).collect()
            }
            _ => Vec::new(),
        }
    };
    table.iter().flat_map(|(key, value)| inner(key, value)).collect()
}

#[test]
fn the_pieces_of_cases_that_pages_show_have_keys_that_cases_have() {
    let (known, mut count) = (known(), 0);
    for (name, page) in pages() {
        for piece in pieces(&page) {
            let table: Table = piece.parse().unwrap_or_else(|error| panic!("{name}: {error} in\n{piece}"));
            let lost = strangers(&table, "", &known);
            assert!(lost.is_empty(), "{name}: no case has {lost:?}, which it shows in\n{piece}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} pieces");
}

#[test]
fn a_key_that_no_case_has_is_seen() {
    let lost = |text: &str| strangers(&text.parse().expect("TOML"), "", &known());
    assert_eq!(lost("[water]\nlevle = 3.0"), ["water.levle"]);
    assert_eq!(lost("[[joint_set]]\ndip = 3.0"), ["joint_set[].dip"]);
    assert_eq!(lost("[joint_law.a]\nfriction = 30"), ["joint_law.NAME.friction"]);
    assert_eq!(lost("[[stage]]\nwater = { hight = 1.0 }"), ["stage[].water.hight"]);
    assert_eq!(lost("[[stage]]\nheads = { any = 1.0 }\n[water]\nlevel = 1.0"), [""; 0]);
}
