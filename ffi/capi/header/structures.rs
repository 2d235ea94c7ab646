//! Structures of the header whose members are rows of the engine's tables of quantities.

use engine::cosimulation::{PORT_QUANTITIES, Quantity, TOTALS};
use engine::model::{
    BLOCK_QUANTITIES, INLET_QUANTITIES, JOINT_MONITOR_QUANTITIES, MONITOR_QUANTITIES, MONITOR_STRESS_QUANTITIES,
};

use super::layout::{self, Kind};

/// Names of members in older headers, which stay beside those of the tables: structure, name, older name.
pub const OLDER_NAMES: [[&str; 3]; 2] =
    [["enmm_block_state", "contacts", "contact_count"], ["enmm_block_state", "penetration_max", "largest_penetration"]];

/// Unions without a name, which C has from C11 on and compilers before it.
const UNION: &str = "
#if defined(__GNUC__) && !defined(__cplusplus) && (!defined(__STDC_VERSION__) || __STDC_VERSION__ < 201112L)
#define ENMM_UNION __extension__ union
#else
#define ENMM_UNION union
#endif
";

/// Line of the header before the first type.
const LAST_INCLUDE: &str = "#include <stdint.h>\n";

/// Texts of the structures, and their members before those of the tables.
const BLOCK: &str = "\
A block now. Velocities are those of half an internal step ago, as the method has them.";
const BLOCK_HEAD: &str = "\
    /// Size of this structure (bytes), set by the caller; in an array that of the first is also the stride.
    pub struct_size: usize,
    /// Block id: 0, 1, ...
    pub id: u32,
    /// Sum of ENMM_BLOCK_FIXED, ENMM_BLOCK_DETACHED, ENMM_BLOCK_FAILED, ENMM_BLOCK_REMOVED.
    pub flags: u32,
";
const ENERGIES: &str = "\
Energies and works half an internal step ago, as velocities are, per metre of thickness; what contacts, supports and
/// bolts store is that of the start of the last internal step. kinetic + strain + potential + damping + yielding
/// equals contact_work + support_work + bolt_work + radiation + external_work + baseline + residual.";
const TOTALS_TEXT: &str = "Sums and extremes over the model.";
const PORT: &str = "\
A port now. A block fills all from its displacement to its stress; a boundary displacement, velocity and stress;
/// joints normal_force, shear_force, slip and, in a case with `[flow]`, the water in them; a quiet boundary
/// displacement, velocity and traction; a fixity displacement, velocity and reaction. What is not filled is 0. Motions
/// of a block are those of its mass centroid, of a boundary the mean along it.";
const MONITOR: &str = "\
A monitor now. Its velocity is that of half an internal step ago.";
const MONITOR_STRESS: &str = "\
Stress at a monitor now, of the plane through the stresses of the elements about it.";
const JOINT_MONITOR: &str = "\
A monitor of a joint now. Slip and shear stress are positive where the far side goes, or is pushed, to the right.";
const INLET: &str = "\
Water at a head, in rain or at a drain, as the flow was found last.";
const HEAD: &str = "\
    /// Size of this structure (bytes), set by the caller.
    pub struct_size: usize,
";

/// The structures as source text of Rust.
pub fn source() -> String {
    let source = |name: &str, text: &str, head: &str, members: &str| {
        format!("/// {text}\n#[repr(C)]\npub struct {name} {{\n{head}{members}}}\n")
    };
    source("enmm_block_state", BLOCK, BLOCK_HEAD, &members(BLOCK_QUANTITIES.iter()))
        + &source("enmm_energies", ENERGIES, HEAD, &members(layout::energies()))
        + &source("enmm_totals", TOTALS_TEXT, HEAD, &members(TOTALS.iter()))
        + &source("enmm_port_state", PORT, HEAD, &members(PORT_QUANTITIES.iter()))
        + &source("enmm_monitor_state", MONITOR, HEAD, &members(MONITOR_QUANTITIES.iter()))
        + &source("enmm_monitor_stress", MONITOR_STRESS, HEAD, &members(MONITOR_STRESS_QUANTITIES.iter()))
        + &source("enmm_joint_monitor_state", JOINT_MONITOR, HEAD, &members(JOINT_MONITOR_QUANTITIES.iter()))
        + &source("enmm_inlet_state", INLET, HEAD, &members(INLET_QUANTITIES.iter()))
}

fn members<T: 'static>(table: impl Iterator<Item = &'static Quantity<T>>) -> String {
    let mut text = String::new();
    let mut is_half = false;
    for quantity in table {
        let kind = Kind::of(quantity);
        if is_half && kind != Kind::ShortCount {
            text += "    /// 0.\n    pub reserved: u32,\n";
            is_half = false;
        }
        is_half ^= kind == Kind::ShortCount;
        let name = match kind {
            Kind::Real => "f64",
            Kind::ShortCount => "u32",
            Kind::Count => "u64",
        };
        let unit = if quantity.unit.is_empty() { String::new() } else { format!(" ({})", quantity.unit) };
        text += &format!("    /// {}{unit}.\n    pub {}: {name},\n", quantity.text, quantity.name);
    }
    text
}

/// The header with the older names of members beside those of the tables, in unions without a name.
pub fn with_older_names(header: &str) -> String {
    let mut text = header.replacen(LAST_INCLUDE, &format!("{LAST_INCLUDE}{UNION}"), 1);
    for [structure, name, older] in OLDER_NAMES {
        let Some(start) = text.find(&format!("typedef struct {structure} {{")) else { continue };
        let end = text[start..].find(&format!("\n}} {structure};")).map_or(text.len(), |length| start + length);
        let lines: Vec<String> = text[start..end].lines().map(|line| with_older_name(line, name, older)).collect();
        text.replace_range(start..end, &lines.join("\n"));
    }
    text
}

fn with_older_name(line: &str, name: &str, older: &str) -> String {
    match line.trim().strip_suffix(&format!(" {name};")) {
        Some(kind) => format!("  ENMM_UNION {{ {kind} {name}; {kind} {older}; }};"),
        None => line.to_owned(),
    }
}
