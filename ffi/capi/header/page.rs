//! The page of all numbers that outputs show, written from the tables of quantities.

use enmm_observe::{
    BLOCK_QUANTITIES, BOLT_QUANTITIES, ENERGIES, FLOW_QUANTITIES, INLET_QUANTITIES, JOINT_MONITOR_QUANTITIES,
    JOINT_QUANTITIES, MONITOR_QUANTITIES, MONITOR_STRESS_QUANTITIES, PORT_QUANTITIES, Quantity, REPORT_QUANTITIES,
    STRENGTH_QUANTITIES, STRESS_QUANTITIES, TOTALS,
};

/// Path of the page in the repository.
pub const PAGE: &str = "docs/book/quantities.md";

const HEAD: &str = "\
# Numbers of results

Every number that results show, kind by kind. `cargo xtask header` writes this page from the tables that all outputs
follow: files, the page of a run, C, Python and the FMUs call a number by the same name. Where one of them has to tell
it from numbers of other kinds, the table has its second name. Units are SI, per metre of depth; tension is positive, y
is up, angles are counter-clockwise.
";

/// The page.
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    page += &part(
        "Blocks",
        "Columns of `blocks.csv`, members of `enmm_block_state`, fields of `Model.blocks()`, numbers of the page of \
         a run. C and Python also know `contacts` as `contact_count` and `penetration_max` as `largest_penetration`.",
        "array of FMI 3",
        &BLOCK_QUANTITIES,
    );
    page += &part(
        "Blocks of rock that can break",
        "Further columns of `blocks.csv`, arrays of the frames for ParaView and numbers of the page of a run, where a \
         rock has a `fracture`; files of other cases do not have them. A block whose sections all have less than 0.3 \
         has an upper bound, and rock that does not break has 0.",
        "",
        &STRENGTH_QUANTITIES,
    );
    page += &part(
        "Energies and works",
        "Members of `enmm_energies`, fields of `Model.energies()`, keys of `energy` in `summary.json`.",
        "column of `history.csv`, variable of FMUs",
        &ENERGIES,
    );
    page += &part(
        "Sums and extremes",
        "Members of `enmm_totals`, fields of `Model.totals()`.",
        "variable of FMUs",
        &TOTALS,
    );
    page += &part("Steps", "Numbers of a step in `history.csv`.", "column of `history.csv`", &REPORT_QUANTITIES);
    page += &part(
        "Ports",
        "Members of `enmm_port_state`, fields of `Port.state()`; variables of FMUs with the name of the port and a dot \
         before them.",
        "",
        &PORT_QUANTITIES,
    );
    page += &monitors();
    page += &part(
        "Heads, rain and drains",
        "Water that flows in joints: members of `enmm_inlet_state`, fields of what `Model.head`, `Model.rain` and \
         `Model.drain` give; variables of FMUs with the name of the head, the rain or the drain and a dot before \
         them: `inflow` of heads and rain, `outflow` of drains, `run_off` of rain.",
        "",
        &INLET_QUANTITIES,
    );
    page += &part("Elements", "Numbers of the stress in frames for ParaView and in pictures.", "", &STRESS_QUANTITIES);
    page += &part("Joints", "Numbers of a piece of joint in frames and pictures.", "", &JOINT_QUANTITIES);
    page +=
        &part("Water in joints", "Numbers of a piece of joint in which water flows, in frames.", "", &FLOW_QUANTITIES);
    page += &part("Bolts", "Numbers of a free length of a bolt in frames and pictures.", "", &BOLT_QUANTITIES);
    page
}

/// The parts about monitors.
fn monitors() -> String {
    let mut page = part(
        "Monitors",
        "Members of `enmm_monitor_state`, fields of `Model.monitor()`; variables of FMUs with `monitor.`, the name of \
         the monitor and a dot before them.",
        "column of `history.csv` behind the name",
        &MONITOR_QUANTITIES,
    );
    page += &part(
        "Stress at monitors",
        "Of monitors with `stress = true`: columns of `history.csv` behind the name, members of `enmm_monitor_stress`, \
         fields of `Model.monitor_stress()`; variables of FMUs with `monitor.`, the name of the monitor and a dot \
         before them. It is the value at the point of the plane that fits best, by area, the stresses of those \
         elements of its block and rock that share a cover with its own. NaN where the rock has been excavated.",
        "",
        &MONITOR_STRESS_QUANTITIES,
    );
    page += &part(
        "Monitors of joints",
        "Columns of `history.csv` behind the name, members of `enmm_joint_monitor_state`, fields of \
         `Model.joint_monitor()`; variables of FMUs with `joint_monitor.`, the name of the monitor and a dot before \
         them. NaN where a side of the joint has been excavated.",
        "",
        &JOINT_MONITOR_QUANTITIES,
    );
    page
}

/// A table of quantities, with a column for second names where it has any.
fn part<T>(title: &str, text: &str, second: &str, table: &[Quantity<T>]) -> String {
    let line = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let row = |quantity: &Quantity<T>| {
        let name = format!("`{}`", quantity.name);
        let other = if quantity.column.is_empty() { "–".to_owned() } else { format!("`{}`", quantity.column) };
        let unit = if quantity.unit.is_empty() { "–" } else { quantity.unit };
        match second {
            "" => line(&[&name, unit, quantity.text]),
            _ => line(&[&name, &other, unit, quantity.text]),
        }
    };
    let head = match second {
        "" => line(&["name", "unit", "meaning"]) + "|---|---|---|\n",
        _ => line(&["name", second, "unit", "meaning"]) + "|---|---|---|---|\n",
    };
    format!("\n## {title}\n\n{}\n\n{head}", wrapped(text)) + &table.iter().map(row).collect::<String>()
}

/// A text in lines that fit the width of documents.
pub fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if line.chars().count() + word.chars().count() < WIDTH => *line += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

/// Width of documents, with room for four blanks before a line (columns).
const WIDTH: usize = 116;
