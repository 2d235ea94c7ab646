//! The unit of length of a drawing, by its header variable `$INSUNITS`.

use super::groups::Groups;
use crate::case_error::CaseError;
use crate::geometry_file::unit::Unit;

/// Metres in each unit and its name, by code; the first is none.
const UNITS: [(f64, &str); 25] = [
    (1.0, "no unit"),
    (0.0254, "inches"),
    (0.3048, "feet"),
    (1609.344, "miles"),
    (1e-3, "millimetres"),
    (1e-2, "centimetres"),
    (1.0, "metres"),
    (1e3, "kilometres"),
    (2.54e-8, "microinches"),
    (2.54e-5, "mils"),
    (0.9144, "yards"),
    (1e-10, "ångströms"),
    (1e-9, "nanometres"),
    (1e-6, "micrometres"),
    (0.1, "decimetres"),
    (10.0, "decametres"),
    (100.0, "hectometres"),
    (1e9, "gigametres"),
    (149_597_870_700.0, "astronomical units"),
    (9.460_730_472_580_8e15, "light years"),
    (3.085_677_581_491_367e16, "parsecs"),
    (1200.0 / 3937.0, "US survey feet"),
    (100.0 / 3937.0, "US survey inches"),
    (3600.0 / 3937.0, "US survey yards"),
    (6_336_000.0 / 3937.0, "US survey miles"),
];
/// Codes of no unit and of metres.
const NONE: usize = 0;
const METRES: usize = 6;

/// Returns the unit of a drawing, with a note where that is not sure.
///
/// # Errors
/// The code is no number, or that of no unit.
pub fn unit(groups: &Groups, scale: Option<f64>) -> Result<Unit, CaseError> {
    let of_header = groups.all.iter().skip_while(|group| (group.code, group.value) != (9, "$INSUNITS")).nth(1);
    let (code, line) = match of_header.filter(|group| group.code == 70) {
        Some(group) => (group.value.parse().ok(), group.line),
        None => (Some(NONE), 1),
    };
    let times = |metres: f64| scale.map_or(format!("times {metres}"), |s| format!("times {s} (`transform.scale`)"));
    let Some((code, (metres, name))) = code.and_then(|code: usize| Some((code, *UNITS.get(code)?))) else {
        if scale.is_some() {
            return Ok(Unit { metres: 1.0, text: format!("no unit, taken {}", times(1.0)), note: None });
        }
        let message = format!("$INSUNITS is the code of no unit, 0 to {}; add `transform.scale`", UNITS.len() - 1);
        return groups.syntax(line, message);
    };
    let note = match (scale, code) {
        (Some(scale), NONE) => {
            Some(format!("the drawing has no unit; coordinates are taken times {scale} (`transform.scale`)"))
        }
        (Some(scale), _) if (scale - metres).abs() > 1e-9 * metres => Some(format!(
            "$INSUNITS is {code} ({name}), but coordinates are taken times {scale} (`transform.scale`), not {metres}"
        )),
        (Some(_), _) | (None, METRES) => None,
        (None, NONE) => Some(
            "the drawing has no unit ($INSUNITS is 0 or missing): coordinates are taken as metres; \
             `transform.scale` says otherwise"
                .to_string(),
        ),
        (None, _) => Some(format!("$INSUNITS is {code} ({name}): coordinates are taken times {metres}")),
    };
    let text = match (code, scale) {
        (NONE, None) => "no unit, taken as metres".to_owned(),
        (METRES, None) => format!("{name} ($INSUNITS is {code})"),
        _ => format!("{name} ($INSUNITS is {code}), taken {}", times(metres)),
    };
    Ok(Unit { metres, text, note })
}
