//! Chapters, figures, and what records hold as text.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

use super::records::Record;
use super::table::text_html;

/// A picture of a record with a caption, or why it is left out; empty where it is not there.
pub fn figure(record: &Record, name: &str, caption: &str) -> String {
    let svg = match record.picture(name) {
        Ok(Some(svg)) => svg,
        Ok(None) => return String::new(),
        Err(error) => return format!("<p>{}</p>\n", text_html(&format!("Picture {name}.svg is left out: {error}."))),
    };
    let caption = text_html(caption);
    // The section needs a page for its legend; others go two to a page.
    let class = if name == "model" { " class=\"whole\"" } else { "" };
    format!(
        "<figure{class}>\n<img alt=\"{caption}\" src=\"data:image/svg+xml;base64,{}\">\n\
         <figcaption>{caption}</figcaption>\n</figure>\n",
        STANDARD.encode(svg)
    )
}

/// A chapter; empty without content.
pub fn chapter(title: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!("<section>\n<h2>{}</h2>\n{content}</section>\n", text_html(title))
}

/// A part of a chapter; empty without content.
pub fn part(title: &str, content: &str) -> String {
    if content.is_empty() { String::new() } else { format!("<h3>{}</h3>\n{content}", text_html(title)) }
}

/// The text of a value; empty where it is no text.
pub fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// The entries of a list; none where it is no list.
pub fn entries(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// The texts of a list.
pub fn texts(value: &Value) -> Vec<String> {
    entries(value).iter().filter_map(Value::as_str).map(plain_words).collect()
}

/// A message of the program in words of a reader who does not know the method.
pub fn plain_words(message: &str) -> String {
    const WORDS: [(&str, &str); 8] = [
        ("energy ledger", "energy balance"),
        ("ledger", "energy balance"),
        ("where level tops pass", "by limit analysis"),
        ("level tops pass", "limit analysis"),
        ("level tops", "limit analysis"),
        ("physical covers", "parts of the mesh"),
        ("physical cover", "part of the mesh"),
        ("`level_tops`", "limit analysis"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to))
}
