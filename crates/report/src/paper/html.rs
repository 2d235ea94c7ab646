//! The whole report.

use super::earthquake::earthquake_chapter;
use super::front::{missing, title_page, warnings};
use super::input::input_chapter;
use super::parts::{chapter, text};
use super::records::Records;
use super::results::{bound_chapter, factor_chapter, probability_chapter, run_chapter};
use super::sweep::sweep_chapter;
use super::table::text_html;

const STYLE: &str = include_str!("style.css");

/// The report of records as one HTML file, which needs no other file and no network.
pub fn report_html(records: &Records) -> String {
    let chapters = [
        title_page(records),
        input_chapter(records),
        run_chapter(records),
        earthquake_chapter(records),
        factor_chapter(records),
        bound_chapter(records),
        probability_chapter(records),
        sweep_chapter(records),
        warnings(records),
        missing(records),
        case_file(records),
    ];
    let title = records.all().next().map_or("", |record| record.json["title"].as_str().unwrap_or_default());
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\">\n<title>{}</title>\n<style>\n\
         {STYLE}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        text_html(title),
        chapters.concat()
    )
}

fn case_file(records: &Records) -> String {
    let Some(record) = records.with_input() else { return String::new() };
    let written = text(&record.json["input"]["case_text"]);
    if written.is_empty() {
        return String::new();
    }
    let name = text(&record.json["case_file"]);
    let content = format!("<p>{}</p>\n<pre>{}</pre>\n", text_html(name), text_html(written));
    chapter("Case file", &content)
}
