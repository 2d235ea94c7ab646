//! The factor, or the displacement, over values of keys.

use serde_json::Value;

use super::number::{Digits, plain};
use super::parts::{chapter, entries, figure, part, text};
use super::records::Records;
use super::table::{Cell, facts, paragraph, table};

use Digits::{Three, Typed};

/// Samples that the table has at most; `sweep.csv` has all.
const SAMPLES_MAX: usize = 60;

/// Keys with their values, picture, crossings or effects, samples.
pub fn sweep_chapter(records: &Records) -> String {
    let Some(record) = &records.sweep else { return String::new() };
    let json = &record.json;
    let is_run = text(&json["output"]) == "displacement";
    let by = match text(&json["output"]) {
        "factor_of_safety" => "factor of safety by strength reduction",
        "displacement" => "largest displacement in the last stage (m), and whether the slope fails",
        _ => "factor by limit analysis, an upper bound",
    };
    let keys: Vec<&str> = entries(&json["keys"]).iter().map(|key| text(&key["key"])).collect();
    let rows = [
        ("Result of each sample", by.into()),
        ("Values of", keys.join(", ").into()),
        ("Result of the case itself", plain(&json["of_the_case"], "", Three).into()),
        ("A slope fails below", if is_run { Cell::Empty } else { plain(&json["limit"], "", Typed).into() }),
    ];
    let content = [
        facts(&rows),
        figure(record, "sweep", "Results over the values; a red line is the limit."),
        part(if is_run { "Where it begins to fail" } else { "Where F passes the limit" }, &crossings(json, &keys)),
        part("Each key alone, the greatest effect first", &effects(json)),
        part("Samples", &samples(json, &keys)),
    ];
    chapter("Sweep of values", &content.concat())
}

/// The first place at which F passes the limit, for the first page.
pub fn first_crossing(json: &Value) -> Cell {
    let key = text(&json["keys"][0]["key"]);
    match (entries(&json["crossings"]), text(&json["kind"])) {
        ([only], "curve") => plain(&only["value"], "", Three)
            .map_or(Cell::Empty, |value| Cell::Mixed(vec![(format!("{key} = "), value)])),
        _ => Cell::Empty,
    }
}

fn crossings(json: &Value, keys: &[&str]) -> String {
    let all = entries(&json["crossings"]);
    if all.is_empty() && !json["crossings"].is_null() {
        return paragraph("Nowhere among these values.");
    }
    let row = |of: &Value| -> Vec<Cell> {
        let number = |value: &Value| plain(value, "", Digits::Typed).into();
        vec![number(&of["at"]), number(&of["value"]), number(&of["between"][0]), number(&of["between"][1])]
    };
    let rows: Vec<Vec<Cell>> = all.iter().take(SAMPLES_MAX).map(row).collect();
    let across = keys.first().copied().unwrap_or_default();
    let up = keys.get(1).copied().unwrap_or_default();
    table(&[up, &format!("{across}, by a straight line"), "Between", "and"], &rows)
}

fn effects(json: &Value) -> String {
    let row = |of: &Value| -> Vec<Cell> {
        let pair = |(k, pair): (usize, &Value)| {
            let before = if k == 0 { "" } else { "; " };
            let output = plain(&pair[1], "", Three)?;
            Some([(before.to_owned(), output), (" at ".to_owned(), plain(&pair[0], "", Typed)?)])
        };
        let outputs = entries(&of["outputs"]).iter().enumerate().filter_map(pair).flatten().collect();
        vec![text(&of["key"]).into(), Cell::Mixed(outputs), plain(&of["range"], "", Three).into()]
    };
    let rows: Vec<Vec<Cell>> = entries(&json["effects"]).iter().map(row).collect();
    table(&["Key", "Results", "Greatest less least"], &rows)
}

fn samples(json: &Value, keys: &[&str]) -> String {
    let name = text(&json["output"]);
    let all = entries(&json["samples"]);
    let row = |sample: &Value| -> Vec<Cell> {
        let status = match text(&sample["status"]) {
            "found" => Cell::Empty,
            status => status.replace('_', " ").into(),
        };
        let result = plain(&sample[name], "", Three).map_or_else(|| "no answer".into(), Cell::from);
        let values = keys.iter().map(|key| plain(&sample["values"][key], "", Typed).into());
        values.chain([result, status]).collect()
    };
    let rows: Vec<Vec<Cell>> = all.iter().take(SAMPLES_MAX).map(row).collect();
    let head: Vec<&str> = keys.iter().copied().chain(["Result", "Remark"]).collect();
    let more = if all.len() > SAMPLES_MAX {
        paragraph(&format!("The first {SAMPLES_MAX} of {} samples; sweep.csv has all.", all.len()))
    } else {
        String::new()
    };
    table(&head, &rows) + &more
}
