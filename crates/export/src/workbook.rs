//! A spreadsheet (Office Open XML, ECMA-376) of tables, a sheet each, behind one that lists them: numbers as numbers
//! with all their digits, heads bold and frozen. The same tables give the same bytes.

use std::io::{self, Cursor, Write};

use quick_xml::escape::escape;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::error::ExportError;
use crate::table::{Cell, Table};

/// Most rows and columns of a sheet, and letters of a cell and of the name of a sheet.
const ROWS_MAX: usize = 1_048_576;
const COLUMNS_MAX: usize = 16_384;
const LETTERS_MAX: usize = 32_767;
const NAME_MAX: usize = 31;
/// Name of the first sheet.
const CONTENTS: &str = "contents";
/// Signs that names of sheets must not have.
const FORBIDDEN: [char; 7] = ['[', ']', ':', '*', '?', '/', '\\'];
/// Widths of columns (digits): least, most, and beside the text.
const WIDTHS: [usize; 3] = [8, 40, 2];

/// Head of each part.
const XML: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n";
const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
const RELATIONS: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
const PACKAGE: &str = "http://schemas.openxmlformats.org/package/2006";
const TYPE: &str = "application/vnd.openxmlformats-officedocument.spreadsheetml";
/// Cells of style 0 are plain, those of style 1 bold.
const STYLES: &str = "<fonts count=\"2\"><font><sz val=\"11\"/><name val=\"Calibri\"/></font><font><b/><sz val=\"11\"/>\
    <name val=\"Calibri\"/></font></fonts><fills count=\"2\"><fill><patternFill patternType=\"none\"/></fill><fill>\
    <patternFill patternType=\"gray125\"/></fill></fills><borders count=\"1\"><border><left/><right/><top/><bottom/>\
    <diagonal/></border></borders><cellStyleXfs count=\"1\">\
    <xf numFmtId=\"0\" fontId=\"0\" fillId=\"0\" borderId=\"0\"/></cellStyleXfs><cellXfs count=\"2\">\
    <xf numFmtId=\"0\" fontId=\"0\" fillId=\"0\" borderId=\"0\" xfId=\"0\"/>\
    <xf numFmtId=\"0\" fontId=\"1\" fillId=\"0\" borderId=\"0\" xfId=\"0\" applyFont=\"1\"/></cellXfs>\
    <cellStyles count=\"1\"><cellStyle name=\"Normal\" xfId=\"0\" builtinId=\"0\"/></cellStyles>";

/// The bytes of a spreadsheet of tables.
///
/// # Errors
/// A table or a text that a sheet cannot hold, with its file.
pub fn workbook(tables: &[Table]) -> Result<Vec<u8>, ExportError> {
    tables.iter().try_for_each(check)?;
    let names = names(tables);
    let contents = contents(tables, &names);
    let all: Vec<(&str, &Table)> =
        std::iter::once((CONTENTS, &contents)).chain(names.iter().map(String::as_str).zip(tables)).collect();
    // The archive is in memory, whose writing cannot fail.
    archive(&all).map_err(|error| ExportError::unreadable(&contents.source, error))
}

/// Whether a sheet can hold a table.
fn check(table: &Table) -> Result<(), ExportError> {
    let too_large = |message: String| Err(ExportError::TooLarge { path: table.source.clone(), message });
    let (rows, columns) = (table.rows.len() + 1, table.columns.len());
    if rows > ROWS_MAX {
        return too_large(format!(
            "has {rows} rows with its heads, a sheet holds {ROWS_MAX}; write fewer, as by a longer \
             `output.history_interval`"
        ));
    }
    if columns > COLUMNS_MAX {
        return too_large(format!("has {columns} columns, a sheet holds {COLUMNS_MAX}; read it as it is"));
    }
    for (k, row) in table.rows.iter().enumerate() {
        for (cell, head) in row.iter().zip(&table.columns) {
            let letters = if let Cell::Text(text) = cell { text.encode_utf16().count() } else { 0 };
            if letters > LETTERS_MAX {
                let row = k + 1;
                return too_large(format!(
                    "the text of {head} in row {row} of {} has {letters} letters, a cell holds {LETTERS_MAX}; read it \
                     as it is",
                    table.name
                ));
            }
        }
    }
    Ok(())
}

/// Names of sheets: those of the tables, shortened in their middle and numbered where a spreadsheet wants it.
fn names(tables: &[Table]) -> Vec<String> {
    let mut names: Vec<String> = vec![CONTENTS.to_owned()];
    for table in tables {
        let clean: Vec<char> = table.name.chars().map(|c| if FORBIDDEN.contains(&c) { '_' } else { c }).collect();
        let name = (1..).map(|number| short(&clean, number)).find(|name| {
            // Spreadsheets take capital and small letters for the same.
            !names.iter().any(|known| known.to_lowercase() == name.to_lowercase())
        });
        names.extend(name);
    }
    names.split_off(1)
}

/// A name that fits, with a number behind it from 2 on.
fn short(name: &[char], number: usize) -> String {
    let end = if number > 1 { format!("~{number}") } else { String::new() };
    let room = NAME_MAX - end.len();
    if name.len() <= room {
        return name.iter().collect::<String>() + &end;
    }
    let (head, tail) = (room / 2 - 1, room - room / 2);
    let [head, tail] = [&name[..head], &name[name.len() - tail..]].map(|part| part.iter().collect::<String>());
    format!("{head}~{tail}{end}")
}

/// The sheet that lists the others.
fn contents(tables: &[Table], names: &[String]) -> Table {
    let text = |text: &str| Cell::Text(text.to_owned());
    let row = |(table, name): (&Table, &String)| {
        let file = table.source.file_name().unwrap_or_default().to_string_lossy();
        vec![text(name), text(&table.name), text(&file), Cell::Number(table.rows.len() as f64)]
    };
    Table {
        name: CONTENTS.to_owned(),
        source: CONTENTS.into(),
        columns: ["sheet", "table", "file", "rows"].map(str::to_owned).into(),
        rows: tables.iter().zip(names).map(row).collect(),
    }
}

fn archive(sheets: &[(&str, &Table)]) -> io::Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    // The first time that the format knows: no clock is read.
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    let mut put = |path: &str, text: String| -> io::Result<()> {
        archive.start_file(path, plain)?;
        archive.write_all(XML.as_bytes())?;
        archive.write_all(text.as_bytes())
    };
    put("[Content_Types].xml", types(sheets.len()))?;
    put("_rels/.rels", relations(&[("officeDocument", "xl/workbook.xml".to_owned())]))?;
    put("xl/workbook.xml", book(sheets))?;
    let sheet = |k: usize| ("worksheet", format!("worksheets/sheet{}.xml", k + 1));
    let parts: Vec<(&str, String)> =
        (0..sheets.len()).map(sheet).chain([("styles", "styles.xml".to_owned())]).collect();
    put("xl/_rels/workbook.xml.rels", relations(&parts))?;
    put("xl/styles.xml", format!("<styleSheet xmlns=\"{MAIN}\">{STYLES}</styleSheet>"))?;
    for (k, (_, table)) in sheets.iter().enumerate() {
        put(&format!("xl/worksheets/sheet{}.xml", k + 1), worksheet(table))?;
    }
    Ok(archive.finish()?.into_inner())
}

/// The kinds of all parts.
fn types(sheets: usize) -> String {
    let mut text = format!(
        "<Types xmlns=\"{PACKAGE}/content-types\"><Default Extension=\"rels\" \
         ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default Extension=\"xml\" \
         ContentType=\"application/xml\"/>"
    );
    let mut put = |path: &str, kind: &str| {
        text.push_str(&format!("<Override PartName=\"/xl/{path}.xml\" ContentType=\"{TYPE}.{kind}+xml\"/>"));
    };
    put("workbook", "sheet.main");
    put("styles", "styles");
    (1..=sheets).for_each(|k| put(&format!("worksheets/sheet{k}"), "worksheet"));
    text + "</Types>"
}

/// Relations of a part to others: kind and path, numbered from 1.
fn relations(parts: &[(&str, String)]) -> String {
    let mut text = format!("<Relationships xmlns=\"{PACKAGE}/relationships\">");
    for (k, (kind, path)) in parts.iter().enumerate() {
        let id = k + 1;
        text.push_str(&format!("<Relationship Id=\"rId{id}\" Type=\"{RELATIONS}/{kind}\" Target=\"{path}\"/>"));
    }
    text + "</Relationships>"
}

fn book(sheets: &[(&str, &Table)]) -> String {
    let mut text = format!("<workbook xmlns=\"{MAIN}\" xmlns:r=\"{RELATIONS}\"><sheets>");
    for (k, (name, _)) in sheets.iter().enumerate() {
        let (name, id) = (escape(*name), k + 1);
        text.push_str(&format!("<sheet name=\"{name}\" sheetId=\"{id}\" r:id=\"rId{id}\"/>"));
    }
    text + "</sheets></workbook>"
}

fn worksheet(table: &Table) -> String {
    let mut text = format!(
        "<worksheet xmlns=\"{MAIN}\"><sheetViews><sheetView workbookViewId=\"0\"><pane ySplit=\"1\" \
         topLeftCell=\"A2\" activePane=\"bottomLeft\" state=\"frozen\"/></sheetView></sheetViews><cols>"
    );
    let [least, most, beside] = WIDTHS;
    for (k, head) in table.columns.iter().enumerate() {
        let texts = table.rows.iter().map(|row| if let Cell::Text(text) = &row[k] { text.chars().count() } else { 0 });
        let width = texts.chain([head.chars().count()]).max().unwrap_or_default().clamp(least, most) + beside;
        let k = k + 1;
        text.push_str(&format!("<col min=\"{k}\" max=\"{k}\" width=\"{width}\" customWidth=\"1\"/>"));
    }
    text.push_str("</cols><sheetData>");
    let heads: Vec<Cell> = table.columns.iter().map(|head| Cell::Text(head.clone())).collect();
    push_row(0, &heads, " s=\"1\"", &mut text);
    table.rows.iter().enumerate().for_each(|(k, row)| push_row(k + 1, row, "", &mut text));
    text + "</sheetData></worksheet>"
}

fn push_row(row: usize, cells: &[Cell], style: &str, text: &mut String) {
    let row = row + 1;
    text.push_str(&format!("<row r=\"{row}\">"));
    for (k, cell) in cells.iter().enumerate() {
        let place = format!("{}{row}", letters(k));
        match cell {
            Cell::Empty => {}
            Cell::Number(number) => text.push_str(&format!("<c r=\"{place}\"{style}><v>{number:?}</v></c>")),
            Cell::Flag(flag) => {
                text.push_str(&format!("<c r=\"{place}\"{style} t=\"b\"><v>{}</v></c>", u8::from(*flag)));
            }
            Cell::Text(words) => text.push_str(&format!(
                "<c r=\"{place}\"{style} t=\"inlineStr\"><is><t xml:space=\"preserve\">{}</t></is></c>",
                escape(allowed(words))
            )),
        }
    }
    text.push_str("</row>");
}

/// A text without signs that XML cannot hold, which become spaces.
fn allowed(text: &str) -> String {
    text.chars().map(|c| if c < ' ' && !['\t', '\n', '\r'].contains(&c) { ' ' } else { c }).collect()
}

/// Name of a column: A, B, …, Z, AA, …
fn letters(column: usize) -> String {
    let (mut rest, mut name) = (column + 1, Vec::new());
    while rest > 0 {
        name.push(char::from(b'A' + ((rest - 1) % 26) as u8));
        rest = (rest - 1) / 26;
    }
    name.into_iter().rev().collect()
}
