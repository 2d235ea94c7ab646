//! Formulas of the documents as MathML, which browsers show without a script and without a network.

use std::ops::Range;

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};

/// Letters of MathML that Markdown would read, and how HTML writes them.
const ESCAPED: [(char, &str); 6] =
    [('*', "&#42;"), ('_', "&#95;"), ('|', "&#124;"), ('~', "&#126;"), ('`', "&#96;"), ('\n', " ")];

/// A page with its formulas, `$…$` and `$$…$$` outside code, as MathML.
///
/// # Errors
/// The first formula that is no TeX, with the reason.
pub fn rendered(page: &str) -> Result<String, String> {
    let (mut out, mut done) = (String::with_capacity(2 * page.len()), 0);
    for Formula { whole, tex, mode } in formulas(page) {
        out.push_str(&page[done..whole.start]);
        let text = &page[tex];
        let shown = mathml(text, mode).map_err(|error| format!("the formula {text:?}: {error}"))?;
        match mode {
            DisplayMode::Inline => out.push_str(&shown),
            DisplayMode::Block => out.push_str(&format!("<div class=\"formula\">{shown}</div>\n")),
        }
        done = whole.end;
    }
    out.push_str(&page[done..]);
    Ok(out)
}

/// A formula in a page.
struct Formula {
    /// With its signs.
    whole: Range<usize>,
    tex: Range<usize>,
    mode: DisplayMode,
}

/// Formulas in the order of the page; code in fences, indented code and code in lines are passed over.
fn formulas(page: &str) -> Vec<Formula> {
    let mut found = Vec::new();
    let (mut at, mut fenced) = (0, false);
    while at < page.len() {
        let rest = &page[at..];
        let begins = at == 0 || page.as_bytes()[at - 1] == b'\n';
        let line = rest.find('\n').map_or(rest.len(), |end| end + 1);
        let fence = begins && rest.trim_start_matches(' ').starts_with("```");
        if fence || fenced || begins && rest.starts_with("    ") {
            fenced ^= fence;
            at += line;
        } else if rest.starts_with('`') {
            let ticks = rest.len() - rest.trim_start_matches('`').len();
            let close = rest[ticks..].find(&rest[..ticks]);
            at += close.map_or(ticks, |close| close + 2 * ticks);
        } else if rest.starts_with('$') {
            let (sign, mode) =
                if rest.starts_with("$$") { ("$$", DisplayMode::Block) } else { ("$", DisplayMode::Inline) };
            let Some(length) = rest[sign.len()..].find(sign) else { break };
            let tex = at + sign.len()..at + sign.len() + length;
            let whole = at..tex.end + sign.len();
            at = whole.end;
            found.push(Formula { whole, tex, mode });
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    found
}

fn mathml(tex: &str, display_mode: DisplayMode) -> Result<String, String> {
    let storage = Storage::new();
    let events: Result<Vec<_>, _> = Parser::new(tex, &storage).collect();
    let events = events.map_err(|error| error.to_string())?;
    let mut text = String::new();
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    let events = events.into_iter().map(Ok::<_, std::convert::Infallible>);
    push_mathml(&mut text, events, config).map_err(|error| error.to_string())?;
    let text = text.replace("><<", ">&lt;<");
    Ok(ESCAPED.iter().fold(text, |text, (letter, escape)| text.replace(*letter, escape)))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::repository::files_of;

    #[test]
    fn formulas_become_mathml_and_code_stays() {
        let page = "A $x_1$ in `$INSUNITS`.\n\n$$\na*b < |c|\n$$\n\n```\n$no$\n```\n\n    $no$\n\nAnd $\\frac{1}{2}$\n";
        let shown = rendered(page).expect("TeX");
        assert_eq!(shown.matches("<math").count(), 3, "{shown}");
        assert!(
            shown.contains("<msub>") && shown.contains("<mfrac>") && shown.contains("<div class=\"formula\"><math")
        );
        assert!(shown.contains("`$INSUNITS`") && shown.contains("```\n$no$\n```\n\n    $no$\n"), "{shown}");
        let math: String = shown.split("<math").skip(1).filter_map(|rest| rest.split("</math>").next()).collect();
        assert!(!math.contains(['*', '_', '|', '\n']) && !math.contains("<<"), "{math}");
    }

    #[test]
    fn every_formula_of_the_documents_is_rendered() {
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
        let mut count = 0;
        for (name, bytes) in files_of(&docs).expect("documents") {
            if name.ends_with(".md") {
                let page = String::from_utf8(bytes).expect("UTF-8");
                count += rendered(&page).unwrap_or_else(|error| panic!("{name}: {error}")).matches("<math").count();
            }
        }
        assert!(count > 500, "{count}");
    }
}
