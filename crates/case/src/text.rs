//! Texts from files, where they are shown.

use std::ops::RangeInclusive;

/// Characters without a sign of their own, which turn, part or hide a text: joiners, marks and overrides of direction,
/// soft hyphens, separators of lines, annotations, tags.
const HIDDEN: [RangeInclusive<char>; 10] = [
    '\u{ad}'..='\u{ad}',
    '\u{61c}'..='\u{61c}',
    '\u{180e}'..='\u{180e}',
    '\u{200b}'..='\u{200f}',
    '\u{2028}'..='\u{202e}',
    '\u{2060}'..='\u{206f}',
    '\u{feff}'..='\u{feff}',
    '\u{fff9}'..='\u{fffb}',
    // XML has no sign for these two.
    '\u{fffe}'..='\u{ffff}',
    '\u{e0000}'..='\u{e007f}',
];

/// Whether a character has no sign of its own: terminals obey control characters, and others make a text read otherwise
/// than it is.
pub fn is_hidden(letter: char) -> bool {
    letter.is_control() || HIDDEN.iter().any(|range| range.contains(&letter))
}

/// A text for a terminal, with hidden characters as their codes. These are the escapes of JSON, so that a text of JSON
/// keeps its meaning.
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if is_hidden(letter) {
            let mut units = [0; 2];
            letter.encode_utf16(&mut units).iter().for_each(|unit| shown += &format!("\\u{unit:04x}"));
        } else {
            shown.push(letter);
        }
    }
    shown
}

/// A name of at most `most` letters for a table; a longer one ends with an ellipsis.
pub fn shortened(name: &str, most: usize) -> String {
    match name.char_indices().nth(most) {
        None => name.to_owned(),
        Some(_) => name.chars().take(most.saturating_sub(1)).chain(['…']).collect(),
    }
}
