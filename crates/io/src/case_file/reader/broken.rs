//! Slips that make a text no TOML and that the parser reports at another line, or by its own words.

/// Line, counted from 1, and message of the first slip that is known; none if there is none.
pub fn cause(text: &str) -> Option<(usize, String)> {
    let mut open: Vec<(char, usize)> = Vec::new();
    let mut in_text = None;
    for (line, written) in text.lines().enumerate().map(|(k, line)| (k + 1, line)) {
        let code = code_of(written, &mut in_text);
        if let Some(number) = decimal_comma(&code).filter(|_| open.is_empty()) {
            let point = number.replace(',', ".");
            return Some((line, format!("the number {number} has a comma; write {point}")));
        }
        if let Some((bracket, first)) = open.last().filter(|_| begins_anew(&code)) {
            let closing = closing(*bracket);
            return Some((*first, format!("`{bracket}` is not closed before line {line}; add `{closing}`")));
        }
        for c in code.chars() {
            match c {
                '[' | '{' => open.push((c, line)),
                ']' | '}' => match open.pop() {
                    Some((bracket, _)) if closing(bracket) == c => {}
                    Some((bracket, first)) => {
                        let closing = closing(bracket);
                        let message = format!("`{c}` closes `{bracket}` of line {first}; write `{closing}`");
                        return Some((line, message));
                    }
                    None => return Some((line, format!("`{c}` closes nothing; remove it or open it before"))),
                },
                _ => {}
            }
        }
    }
    let (bracket, first) = open.last().filter(|_| in_text.is_none())?;
    Some((*first, format!("`{bracket}` is not closed; add `{}`", closing(*bracket))))
}

fn closing(bracket: char) -> char {
    if bracket == '[' { ']' } else { '}' }
}

/// A line without its strings and its comment; `in_text` is the mark of a string of several lines that is open.
fn code_of(line: &str, in_text: &mut Option<&'static str>) -> String {
    let mut code = String::new();
    let mut rest = line;
    loop {
        if let Some(mark) = *in_text {
            let Some(end) = rest.find(mark) else { return code };
            rest = &rest[end + mark.len()..];
            *in_text = None;
        }
        let Some(start) = rest.find(['"', '\'', '#']) else { return code + rest };
        code.push_str(&rest[..start]);
        rest = &rest[start..];
        let long = ["\"\"\"", "'''"].into_iter().find(|mark| rest.starts_with(mark));
        if let Some(mark) = long {
            (*in_text, rest) = (Some(mark), &rest[mark.len()..]);
            continue;
        }
        let Some(quote) = rest.chars().next().filter(|c| *c != '#') else { return code };
        let mut escaped = false;
        let end = rest.char_indices().skip(1).find(|(_, c)| {
            let ends = *c == quote && !escaped;
            escaped = quote == '"' && *c == '\\' && !escaped;
            ends
        });
        code.push_str("\"\"");
        rest = end.map_or("", |(at, _)| &rest[at + 1..]);
    }
}

/// Whether a line begins a section or gives a key, which no line within brackets does.
fn begins_anew(code: &str) -> bool {
    let code = code.trim();
    let inner = code.trim_start_matches('[');
    let section = inner.len() < code.len() && inner.starts_with(|c: char| c.is_ascii_alphabetic());
    let name = code.split('=').next().unwrap_or_default().trim();
    let word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let key = code.contains('=') && name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(word);
    section || key
}

/// The number with a decimal comma that is the whole value of a line.
fn decimal_comma(code: &str) -> Option<&str> {
    let value = code.split_once('=')?.1.trim();
    let (whole, part) = value.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let (part, power) = part.split_once(['e', 'E']).unwrap_or((part, "0"));
    let all =
        digits(whole.trim_start_matches(['-', '+'])) && digits(part) && digits(power.trim_start_matches(['-', '+']));
    all.then_some(value)
}

#[cfg(test)]
mod tests {
    use super::cause;

    #[test]
    fn slips_are_found_where_they_are() {
        for (text, line, message) in [
            ("a = 1\nfriction_deg = 35,5\n", 2, "the number 35,5 has a comma; write 35.5"),
            ("young = -2,5e9 # Pa\n", 1, "the number -2,5e9 has a comma; write -2.5e9"),
            ("a = [[0, 0],\n  [1, 0]\n# [\nb = 2\n", 1, "`[` is not closed before line 4; add `]`"),
            ("a = [[0, 0], [1, 0]\n\n[[stage]]\n", 1, "`[` is not closed before line 3; add `]`"),
            ("a = [1, 2\n", 1, "`[` is not closed; add `]`"),
            ("a = [1, 2]]\n", 1, "`]` closes nothing; remove it or open it before"),
            ("a = { b = [1 }\n", 1, "`}` closes `[` of line 1; write `]`"),
        ] {
            assert_eq!(cause(text), Some((line, message.to_owned())), "{text}");
        }
    }

    #[test]
    fn sound_text_has_no_slip() {
        for text in [
            "a = [\n  [0, 0],\n  [1.5, 2],\n]\n[[b]]\nc = \"[x = 1,5\" # ]\n",
            "d = '''\n[ e = 3,5\n'''\n[f]\ng = { h = 1 }\ni = \"a \\\" [\"\n",
        ] {
            assert_eq!(cause(text), None, "{text}");
        }
    }
}
