//! Structured names, as both versions of the standard define them: identifiers, with array indices, joined by dots.

/// Naming convention of an interface: `structured` when every name keeps to its grammar, else `flat`, which allows all.
/// Rocks, joint laws and monitors have the names of the case, which may have blanks and umlauts.
pub fn convention<'a>(mut names: impl Iterator<Item = &'a str>) -> &'static str {
    if names.all(is_structured) { "structured" } else { "flat" }
}

/// Whether a name is an identifier of structured names.
pub fn is_structured(name: &str) -> bool {
    let mut rest = name;
    loop {
        let Some(after) = after_word(rest).and_then(after_indices) else { return false };
        if after.is_empty() {
            return true;
        }
        let Some(next) = after.strip_prefix('.') else { return false };
        rest = next;
    }
}

/// Text behind a word, plain or in quotes.
fn after_word(text: &str) -> Option<&str> {
    if let Some(quoted) = text.strip_prefix('\'') {
        return after_quoted(quoted);
    }
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    begins.then(|| text.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '_'))
}

/// Text behind the closing quote; between the quotes is at least one character, and some need a backslash.
fn after_quoted(text: &str) -> Option<&str> {
    let mut chars = text.char_indices();
    while let Some((at, c)) = chars.next() {
        match c {
            '\'' => return (at > 0).then(|| &text[at + 1..]),
            '\\' => chars.next().filter(|(_, escaped)| "'\"?\\abfnrtv".contains(*escaped)).map(|_| ())?,
            '"' | '`' => return None,
            ' '..='~' => {}
            _ => return None,
        }
    }
    None
}

/// Text behind array indices such as `[1,2]`, if there are any.
fn after_indices(text: &str) -> Option<&str> {
    let Some(inside) = text.strip_prefix('[') else { return Some(text) };
    let (indices, after) = inside.split_once(']')?;
    let is_number = |index: &str| !index.is_empty() && index.bytes().all(|b| b.is_ascii_digit());
    indices.split(',').all(is_number).then_some(after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_the_grammar_are_structured_and_others_are_not() {
        for name in [
            "a",
            "_a1",
            "joint_law.joint.friction",
            "a[1].b[2,30]",
            "'my port'.force_x",
            r"a.'it\'s'",
            "'1.5 (x)'.y[1]",
        ] {
            assert!(is_structured(name), "{name}");
        }
        for name in [
            "",
            ".",
            "a.",
            ".a",
            "a..b",
            "1a",
            "a b",
            "a-b",
            "Böschung.x",
            "'Böschung'.x",
            "''",
            "'a",
            "'a\"'",
            r"'\x'",
            "a[]",
            "a[1",
            "a[1,]",
            "a[x]",
            "a[1]b",
            "a\t",
            "a.1",
        ] {
            assert!(!is_structured(name), "{name}");
        }
        assert_eq!(convention(["a.b", "c"].into_iter()), "structured");
        assert_eq!(convention(["a.b", "my port.c"].into_iter()), "flat");
    }
}
