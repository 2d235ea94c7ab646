//! Marks that tell where a figure of a document comes from.

use std::ops::Range;

use super::number::{Figure, figures};

const BEGIN: &str = "<!--=";
const END: &str = "-->";

/// A mark and what it stands behind.
#[derive(Debug, PartialEq)]
pub struct Mark {
    /// Line, from 1.
    pub line: usize,
    /// What follows the equals sign: the name of a figure, or of a constant and its file.
    pub name: String,
    /// The figure before it on its line, or those of the displayed equation that it stands behind.
    pub figures: Vec<Figure>,
    /// Whether it stands behind a displayed equation, which may hold several figures.
    pub is_behind_equation: bool,
}

/// Marks of a Markdown text outside its code, in their order; places of figures are those in the whole text.
///
/// # Errors
/// Line and reason, when a mark does not end, or stands behind no figure.
pub fn marks(text: &str) -> Result<Vec<Mark>, String> {
    let mut found = Vec::new();
    let (mut fenced, mut equation, mut in_equation, mut at) = (false, 0..0, false, 0);
    for (k, line) in text.split_inclusive('\n').enumerate() {
        fenced ^= line.trim_start().starts_with("```");
        if !fenced && line.trim_end() == "$$" {
            equation = if in_equation { equation.start..at } else { at..at };
            in_equation = !in_equation;
        } else if !fenced && !in_equation {
            let marked =
                marks_of_line(text, at..at + line.len(), &equation).map_err(|why| format!("{}: {why}", k + 1))?;
            found.extend(marked.into_iter().map(|mark| Mark { line: k + 1, ..mark }));
            if !without_marks(line).trim().is_empty() {
                equation = 0..0;
            }
        }
        at += line.len();
    }
    Ok(found)
}

/// The marks of a line, with 0 for its number; the equation is the one that ends before it.
fn marks_of_line(text: &str, line: Range<usize>, equation: &Range<usize>) -> Result<Vec<Mark>, String> {
    let mut found = Vec::new();
    let mut from = line.start;
    while let Some(begin) = text[from..line.end].find(BEGIN).map(|k| from + k) {
        let name = begin + BEGIN.len();
        let Some(end) = text[name..line.end].find(END).map(|k| name + k) else {
            return Err(format!("a mark without its `{END}`"));
        };
        let is_code = text[line.start..begin].matches('`').count() % 2 == 1;
        let is_behind_equation = without_marks(&text[line.start..begin]).trim().is_empty();
        let place = if is_behind_equation { equation.clone() } else { from..begin };
        from = end + END.len();
        if is_code {
            continue;
        }
        let name = text[name..end].trim().to_owned();
        let mut behind = figures(&text[place.clone()]);
        if !is_behind_equation {
            behind.drain(..behind.len().saturating_sub(1));
        }
        if behind.is_empty() {
            return Err(format!("`{name}` is marked behind no figure"));
        }
        behind.iter_mut().for_each(|figure| figure.at = figure.at.start + place.start..figure.at.end + place.start);
        found.push(Mark { line: 0, name, figures: behind, is_behind_equation });
    }
    Ok(found)
}

fn without_marks(text: &str) -> String {
    text.split(BEGIN).map(|part| part.split_once(END).map_or(part, |(_, rest)| rest)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> Vec<(usize, String, Vec<String>)> {
        let marks = marks(text).expect("good marks").into_iter();
        marks.map(|mark| (mark.line, mark.name, mark.figures.into_iter().map(|f| f.text).collect())).collect()
    }

    fn of(line: usize, name: &str, figures: &[&str]) -> (usize, String, Vec<String>) {
        (line, name.to_owned(), figures.iter().map(|&f| f.to_owned()).collect())
    }

    #[test]
    fn a_mark_belongs_to_the_figure_before_it() {
        let text = "all 3\nof 1.25<!--=fos--> and $10^{-3}h$<!--=ledge contact/c.rs-->.\n";
        assert_eq!(told(text), [of(2, "fos", &["1.25"]), of(2, "ledge contact/c.rs", &["10^{-3}"])]);
        let mark = &marks(text).expect("good marks")[0];
        assert_eq!(&text[mark.figures[0].at.clone()], "1.25");
    }

    #[test]
    fn a_mark_behind_an_equation_belongs_to_it() {
        let text = "7\n$$\na=12b+8c\n$$\n\n<!--=A m.rs--><!--=B m.rs-->\nthen\n";
        assert_eq!(told(text), [of(6, "A m.rs", &["12", "8"]), of(6, "B m.rs", &["12", "8"])]);
        assert!(marks("$$\n12\n$$\nthen\n<!--=A m.rs-->").is_err());
    }

    #[test]
    fn code_has_no_marks() {
        assert_eq!(told("`1.25<!--=a-->`\n```\n1<!--=b-->\n```\n"), []);
    }

    #[test]
    fn marks_of_nothing_and_without_an_end_are_named_with_their_line() {
        assert_eq!(marks("3\nand<!--=a-->"), Err("2: `a` is marked behind no figure".to_owned()));
        assert_eq!(marks("3<!--=a"), Err("1: a mark without its `-->`".to_owned()));
        assert_eq!(marks("3<!--=a--><!--=b-->"), Err("1: `b` is marked behind no figure".to_owned()));
    }
}
