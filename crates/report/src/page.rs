//! `report.html`: the viewer with a film in it, or without one for a film that is served.

use std::io::{self, BufReader, BufWriter, Write};
use std::path::Path;

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use enmm_io::files::{Unfinished, open_result};

use crate::chunk::{Chunks, Kind, MAGIC};
use crate::error::FilmError;

const EDITOR: &str = include_str!("../viewer/editor.html");
const PAGE: &str = include_str!("../viewer/viewer.html");
const STYLE: &str = include_str!("../viewer/viewer.css");
/// Scripts in the order in which a page runs them.
const SCRIPTS: [&str; 9] = [
    include_str!("../viewer/film.js"),
    include_str!("../viewer/colour.js"),
    include_str!("../viewer/elements.js"),
    include_str!("../viewer/structures.js"),
    include_str!("../viewer/slope.js"),
    include_str!("../viewer/chart.js"),
    include_str!("../viewer/panel.js"),
    include_str!("../viewer/player.js"),
    include_str!("../viewer/viewer.js"),
];

/// The script of films with blocks that have broken, behind the others.
const BREAKS: &str = include_str!("../viewer/breaks.js");
/// How a note of such a block begins.
const BREAK: &[u8] = br#"{"note":"break""#;
/// The script of films with water that flows in joints, behind the others.
const FLOW: &str = include_str!("../viewer/flow.js");
/// How a note of such water begins.
const WATER: &[u8] = br#"{"note":"water""#;
/// Scripts of a film beside those of all, and how the notes begin that ask for them.
const ADDED: [(&str, &[u8]); 2] = [(BREAKS, BREAK), (FLOW, WATER)];

/// Places in the page that are filled in.
const HOLES: [&str; 3] = ["/*style*/", "/*script*/", "<!--film-->"];

/// Writes the page of a film; a film without an end is shown as far as it goes.
///
/// # Errors
/// A file that is no film, or what the file system refuses.
pub fn write_page(film: &Path, page: &Path) -> Result<(), FilmError> {
    let no_film = |error: io::Error| FilmError::NoFilm { path: film.to_owned(), problem: error.to_string() };
    let mut chunks = open_result(film)
        .map_err(FilmError::at(film))
        .and_then(|file| Chunks::new(BufReader::new(file)).map_err(no_film))?;
    let at = FilmError::at(page);
    let (unfinished, file) = Unfinished::beside(page).map_err(&at)?;
    let mut out = BufWriter::new(file);
    let before = &halves([false; 2])[0];
    out.write_all(before.as_bytes()).map_err(&at)?;
    out.write_all(b"<script type=\"application/octet-stream;base64\" id=\"film\">").map_err(&at)?;
    let mut text = EncoderWriter::new(&mut out, &STANDARD);
    text.write_all(&MAGIC).map_err(&at)?;
    let mut added = [false; 2];
    while let Some(chunk) = chunks.next().map_err(no_film)? {
        if chunk.kind == Kind::Note {
            let note = chunk.body().map_err(no_film)?;
            added.iter_mut().zip(ADDED).for_each(|(there, (_, begin))| *there |= note.starts_with(begin));
        }
        text.write_all(&chunk.bytes).map_err(&at)?;
    }
    text.finish().map_err(&at)?;
    drop(text);
    out.write_all(b"</script>").map_err(&at)?;
    out.write_all(halves(added)[1].as_bytes()).map_err(&at)?;
    out.into_inner().map_err(|error| at(error.into_error()))?;
    unfinished.finish().map_err(&at)
}

/// The page without a film, which requests one from its server.
pub fn live_page() -> String {
    halves([true; 2]).concat()
}

/// The page of `enmm edit`, which shows the pages of models as they are built.
pub fn edit_page() -> &'static str {
    EDITOR
}

/// The page before and behind the film, with those of the scripts beside those of all that it needs.
fn halves(added: [bool; 2]) -> [String; 2] {
    let [style, script, film] = HOLES;
    let needed = ADDED.iter().zip(added).filter(|(_, needed)| *needed);
    let scripts = SCRIPTS.concat() + &needed.map(|((script, _), _)| *script).collect::<String>();
    let page = PAGE.replace(style, STYLE).replace(script, &scripts);
    let (before, after) = page.split_once(film).unwrap_or((&page, ""));
    [before.to_owned(), after.to_owned()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_hole_of_the_page_is_there_once() {
        for hole in HOLES {
            assert_eq!(PAGE.matches(hole).count(), 1, "{hole}");
            assert!(!live_page().contains(hole), "{hole} is left");
        }
    }

    #[test]
    fn the_page_asks_no_other_host() {
        for word in ["http:", "https:", "@import", " src=", "url("] {
            assert!(!live_page().contains(word), "{word}");
        }
    }
}
