//! Claim: figures that pages of the book quote are those of the program, or of a hand calculation, or of a case that
//! another test holds.

use std::path::PathBuf;

use crate::common::{case, example, root};
use crate::support::without;
use enmm_stability::limit_analysis::bound;

fn page(name: &str) -> String {
    let text = std::fs::read_to_string(root().join("docs/book").join(name));
    let text = text.unwrap_or_else(|error| panic!("{name}: {error}"));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn template(name: &str) -> String {
    let path: PathBuf = root().join("crates/cli/templates").join(format!("{name}.toml"));
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Factor by `enmm bound` for joints that dilate by their friction angle.
fn limit(text: &str) -> f64 {
    bound(&case(text)).unwrap_or_else(|e| panic!("{e}")).associated.factor.value()
}

/// The same without the cohesion of joints that open.
fn bare_limit(text: &str) -> f64 {
    let found = bound(&case(text)).unwrap_or_else(|e| panic!("{e}"));
    found.bare.expect("joints that open").collapse.factor.value()
}

/// Asserts that a page has a text with figures.
fn assert_quotes(page: &str, text: &str) {
    assert!(page.contains(text), "the page has no {text:?}");
}

/// A number of a page behind a text.
fn number_after(page: &str, text: &str) -> f64 {
    let rest = page.split(text).nth(1).unwrap_or_else(|| panic!("the page has no {text:?}"));
    let digits: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    digits.trim_end_matches('.').parse().unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

/// Limit analysis is exact where the wedge slides as one, but for the cohesion of the crack behind it, which opens: so
/// it has the factors of active and passive bolts. Bars that the rock stretches yield before the slope goes, by 0.28 m:
/// their factor is that of passive ones but for the tolerance of the search, of which a page said 1.44.
#[test]
fn the_page_on_supports_has_the_factors_of_the_new_slope() {
    let page = page("supports.md");
    let text = template("slope");
    let with = |support: &str| text.replace("support = \"active\"", &format!("support = \"{support}\""));
    let bare = without(&text, "[[stage]]\nname = \"bolts\"", "[[monitor]]");
    let [none, active, passive] = [bare, with("active"), with("passive")].map(|text| bare_limit(&text));
    assert_quotes(&page, &format!("the factor is {none:.2} without bolts, {active:.2} with active"));
    assert_quotes(&page, &format!("and {passive:.2} with passive ones"));
    let stretched = number_after(&page, "`mesh.size = 1.5`) it is ");
    assert!((stretched / passive - 1.0).abs() < 1e-2, "{stretched} beside {passive}");
}

/// The wedge of `plane_slide.toml` by Hoek and Bray, whose factors its own test holds.
#[test]
fn the_page_on_factors_has_those_of_the_plane_slide() {
    let page = page("factor_of_safety.md");
    let text = example("plane_slide");
    let found = limit(&text);
    assert_quotes(&page, &format!("Here the answer is {found:.4}"));
    assert_quotes(&page, &format!("Its factor is {found:.2}, as by the formula of Hoek and Bray"));
    let bolts = text.lines().filter(|line| !line.starts_with("install")).collect::<Vec<_>>().join("\n");
    assert_quotes(&page, &format!("without bolts it is {:.2}", limit(&bolts)));
    assert_quotes(&self::page("trust.md"), &format!("| {found:.4}, rigid blocks |"));
}

/// The pages repeat what the comments of their cases say, which other tests hold.
#[test]
fn tutorials_have_the_factors_of_their_cases() {
    let cut = page("road_cut.md");
    let row = |text: &str, name: &str| -> [f64; 2] {
        let row = text.lines().find(|line| line.starts_with(&format!("# {name} "))).expect(name);
        let numbers: Vec<f64> = row.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        [numbers[0], numbers[1]]
    };
    let text = example("road_cut");
    let ([bolted, found], [wet, without_bolts]) = (row(&text, "water and bolts"), row(&text, "water, no bolts"));
    assert_quotes(&cut, &format!("The factor is {found:.2}."));
    assert_quotes(&cut, &format!("and the factor is {without_bolts:.2}"));
    assert_quotes(&cut, &format!("has its numbers: {bolted:.4} and {wet:.4}"));
    let ratio = 44f64.to_radians().tan() / (15.5 / 19.0);
    assert_quotes(&page("pit.md"), &format!("tan 44°/tan 39.2° = {ratio:.3} by hand"));
    assert_quotes(&page("toppling.md"), &format!("Limit analysis gives {:.2}", limit(&example("toppling"))));
    let none = 30f64.to_radians().tan() / 32f64.to_radians().tan();
    let steps = page("step_path.md");
    assert_quotes(&steps, &format!("tan 30°/tan 32° | {none:.2} |"));
    assert_quotes(&steps, &format!("ductile | {:.2} |", limit(&example("step_path"))));
}

/// The section of an overhang, and the stresses of columns and slabs that the tutorials work out.
#[test]
fn tutorials_have_the_stresses_of_their_formulas() {
    let overhang: f64 = 3.0 * 2600.0 * 9.81 * 25.0 / 4.0 / 1e6;
    let page = page("overhang.md");
    assert_quotes(&page, &format!("={overhang:.3}\\ \\mathrm{{MPa}}"));
    let share = overhang / 0.85;
    assert_quotes(&page, &format!("so that {share:.2} of it is used"));
    assert!((number_after(&page, "as far as at rest: ") - 2.0 * share).abs() < 0.01);
}
