//! Usual ranges of all that has a unit in a case, and the slips that a value outside them looks like. One table serves
//! warnings (`enmm check`, `edit`, runs and hosts) and the errors of validation.

use serde_json::Value;

use crate::key::Key;
use crate::record::{BaseMotionKind, STANDARD_GRAVITY};
use crate::{Case, Output, RandomOf};

/// A unit with the slips that people make in it: what a number was meant in, and by what it must be multiplied.
struct Unit {
    name: &'static str,
    slips: &'static [(&'static str, f64)],
}

const PASCAL: Unit = Unit { name: "Pa", slips: &[("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("Pa times 1000", 1e-3)] };
const NEWTON: Unit = Unit { name: "N", slips: &[("kN", 1e3), ("MN", 1e6), ("mN", 1e-3)] };
const METRE: Unit = Unit { name: "m", slips: &[("mm", 1e-3), ("cm", 1e-2), ("km", 1e3)] };
const SQUARE_METRE: Unit =
    Unit { name: "m²", slips: &[("mm²", 1e-6), ("cm²", 1e-4), ("mm² divided by 1000", 1e-3)] };
const DEGREE: Unit = Unit { name: "°", slips: &[] };
const DENSITY: Unit =
    Unit { name: "kg/m³", slips: &[("t/m³", 1e3), ("kN/m³", 1e3 / 9.81), ("N/m³", 1.0 / 9.81), ("g/m³", 1e-3)] };
const STIFFNESS: Unit = Unit { name: "Pa/m", slips: &[("kPa/m", 1e3), ("MPa/m", 1e6), ("GPa/m", 1e9)] };
const ACCELERATION: Unit = Unit { name: "m/s²", slips: &[("cm/s²", 1e-2), ("mm/s²", 1e-3), ("km/s²", 1e3)] };
const SPEED: Unit = Unit { name: "m/s", slips: &[("cm/s", 1e-2), ("mm/s", 1e-3)] };
const SECOND: Unit = Unit { name: "s", slips: &[("ms", 1e-3), ("hours", 3600.0)] };
const ENERGY: Unit = Unit { name: "J/m²", slips: &[("kJ/m²", 1e3), ("N/mm", 1e3)] };

/// A row of the table: keys, without the numbers of lists and with `*` for names, and the range of the field.
struct Row {
    keys: &'static [&'static str],
    unit: &'static Unit,
    range: [f64; 2],
    usual: &'static str,
}

const fn row(keys: &'static [&'static str], unit: &'static Unit, range: [f64; 2], usual: &'static str) -> Row {
    Row { keys, unit, range, usual }
}

/// Magnitudes outside which a value is doubted; 0, which means "none" nearly everywhere, is not.
const TABLE: &[Row] = &[
    row(&["rock.*.density", "in_situ.density"], &DENSITY, [500.0, 1e4], "rock has 2000 to 3200 kg/m³"),
    row(&["rock.*.young"], &PASCAL, [1e8, 5e11], "rock masses have 1e9 to 1e11 Pa"),
    row(&["rock.*.cohesion"], &PASCAL, [500.0, 1e8], "soil has 1e3 to 1e5 Pa, rock masses 1e4 to 1e7"),
    row(&["rock.*.tension"], &PASCAL, [100.0, 5e7], "rock has 1e4 to 2e7 Pa"),
    row(&["rock.*.hoek_brown.sigma_ci"], &PASCAL, [5e5, 5e8], "rock has 5e6 to 3e8 Pa"),
    row(&["rock.*.friction_deg"], &DEGREE, [8.0, 75.0], "soil and rock have 15 to 60°"),
    row(
        &["joint_law.*.friction_deg", "joint_law.*.residual_friction_deg", "stage.law.friction_deg"],
        &DEGREE,
        [8.0, 75.0],
        "joints have 15 to 60°",
    ),
    row(&["rock.*.dilation_deg", "joint_law.*.dilation_deg"], &DEGREE, [0.5, 50.0], "rock and joints have 0 to 20°"),
    row(
        &["joint_law.*.cohesion", "joint_law.*.residual_cohesion", "stage.law.cohesion"],
        &PASCAL,
        [100.0, 1e8],
        "joints have 0 to 1e6 Pa, rock bridges up to 3e7",
    ),
    row(
        &["joint_law.*.tension", "joint_law.*.residual_tension", "stage.law.tension"],
        &PASCAL,
        [100.0, 5e7],
        "joints have 0 to 1e5 Pa, rock bridges up to 2e7",
    ),
    row(&["joint_law.*.jcs", "joint_law.*.crush"], &PASCAL, [5e5, 1e9], "walls of joints have 5e6 to 3e8 Pa"),
    row(
        &["joint_law.*.normal_stiffness", "joint_law.*.shear_stiffness"],
        &STIFFNESS,
        [1e6, 1e14],
        "joints have 1e8 to 1e12 Pa/m",
    ),
    row(&["joint_law.*.closure_max"], &METRE, [1e-6, 2e-2], "joints close by 1e-5 to 1e-3 m"),
    row(&["joint_law.*.dilation_slip"], &METRE, [1e-4, 10.0], "joints dilate over 1e-3 to 0.2 m"),
    row(&["joint_law.*.tension_energy"], &ENERGY, [1.0, 1e5], "rock takes 20 to 500 J/m²"),
    row(&["joint_law.*.shear_energy"], &ENERGY, [1.0, 1e7], "rock takes 100 to 1e5 J/m²"),
    row(&["bolt.young", "bolt_pattern.young"], &PASCAL, [2e10, 4e11], "steel has 2e11 Pa"),
    row(&["bolt.area", "bolt_pattern.area"], &SQUARE_METRE, [4e-5, 2e-2], "a bar of 25 mm has 4.9e-4 m²"),
    row(&["bolt.spacing", "bolt_pattern.spacing"], &METRE, [0.2, 50.0], "bars stand 1 to 5 m apart"),
    row(
        &["bolt.yield_force", "bolt.pretension", "bolt_pattern.yield_force", "bolt_pattern.pretension"],
        &NEWTON,
        [5e3, 2e7],
        "bars carry 1e5 to 5e5 N, anchors up to 3e6",
    ),
    row(&["bolt.free_length", "bolt_pattern.free_length"], &METRE, [0.01, 100.0], "0.05 to 0.5 m are usual at a joint"),
    row(&["bolt_pattern.length"], &METRE, [0.5, 200.0], "bars have 2 to 12 m, anchors up to 60"),
    row(&["bolt_pattern.distance"], &METRE, [0.2, 100.0], "1 to 5 m is usual"),
    row(&["joint_set.spacing", "tessellation.size"], &METRE, [0.02, 500.0], "joints stand 0.1 to 20 m apart"),
    row(&["joint_set.trace_length"], &METRE, [0.05, 5e3], "traces have 0.5 to 200 m"),
    row(&["joint_set.gap"], &METRE, [5e-3, 500.0], "rock bridges have 0.1 to 10 m"),
    row(
        &[
            "joint_set.angle_deg",
            "joint_set.dip_deg",
            "joint_set.dip_direction_deg",
            "joint.dip_deg",
            "mesh.angle_deg",
            "bolt_pattern.angle_deg",
        ],
        &DEGREE,
        [0.2, 360.0],
        "angles are in degrees, up to 360",
    ),
    row(&["gravity.x", "gravity.y"], &ACCELERATION, [1e-2, 100.0], "down is -9.81 m/s²"),
    row(&["load.acceleration"], &ACCELERATION, [1e-3, 100.0], "a tenth of gravity is 0.981 m/s²"),
    row(
        &["load.pressure", "load.pressure_end", "load.traction", "port.pressure", "port.traction"],
        &PASCAL,
        [50.0, 1e9],
        "10 m of water press with 98.1e3 Pa",
    ),
    row(&["load.force", "port.force"], &NEWTON, [10.0, 1e10], "10 t weigh 98.1e3 N"),
    row(&["water.density"], &DENSITY, [800.0, 1500.0], "water has 1000 kg/m³"),
    row(&["in_situ.sxx", "in_situ.syy", "in_situ.szz"], &PASCAL, [1e3, 1e9], "100 m of rock press with 2.6e6 Pa"),
    row(&["in_situ.gradient", "in_situ.szz_gradient"], &STIFFNESS, [50.0, 1e6], "the weight of rock makes 2.6e4 Pa/m"),
    row(&["stage.duration", "stage.duration_max"], &SECOND, [0.05, 2e3], "slopes rest or fail within 1 to 60 s"),
];

/// The same of what is measured: peaks of records of earthquakes, and the longer side of the box of the rock. Below the
/// first peak a record hardly moves anything, and above the second hardly any has been measured.
const MEASURED: &[Row] = &[
    row(
        &["record.acceleration"],
        &ACCELERATION,
        [0.01 * STANDARD_GRAVITY, 3.0 * STANDARD_GRAVITY],
        "the largest known is some 4 g",
    ),
    row(&["record.velocity"], &SPEED, [0.005, 5.0], "the largest known is some 4 m/s"),
    row(&["record.displacement"], &METRE, [0.0005, 10.0], "the largest known is some 9 m"),
    row(&["domain.size"], &METRE, [1.0, 1e4], "slopes are 1 m to 10 km long"),
];

/// Counts of frames and of rows of a history that are not doubted; a static stage may be given far more time than it
/// takes.
const FRAMES: [f64; 2] = [1.0, 5e3];
const ROWS: [f64; 2] = [5.0, 1e5];
const OUTLASTS: f64 = 1e3;
/// Tables of a case whose entries have names of the user's.
const NAMED: [&str; 2] = ["rock", "joint_law"];
/// Young's modulus of rock, and the least one (Pa) of rock that yields, which may be soil.
const YOUNG: &str = "rock.*.young";
const SOIL_YOUNG: f64 = 1e5;
/// Cohesion of a joint law, and the greatest one (Pa) of a joint that is no bridge of rock: bridges have tensile
/// strength.
const COHESION: &str = "joint_law.*.cohesion";
const JOINT_COHESION: f64 = 1e7;

impl Row {
    /// The doubt about a value; none where it is usual, or 0.
    fn doubt(&self, value: f64, [low, high]: [f64; 2]) -> Option<String> {
        let size = value.abs();
        if value == 0.0 || !value.is_finite() || (low..=high).contains(&size) {
            return None;
        }
        let meant = |size: f64| (low..=high).contains(&size);
        let slip = self.unit.slips.iter().find(|(_, by)| meant(size * by));
        let looks = match slip {
            Some((name, by)) => format!("; {} looks like {name}: write {}", plain(value), plain(value * by)),
            None => self.angle_meant(size).unwrap_or_default(),
        };
        Some(format!("is {}, which is {}: {}{looks}", measured(value, self.unit.name), side(size, low), self.usual))
    }

    /// The angle of which a value looks like the tangent or the radians.
    fn angle_meant(&self, size: f64) -> Option<String> {
        let [low, high] = self.range;
        let [of_tangent, of_radians] = [libm::atan(size).to_degrees(), size.to_degrees()];
        (self.unit.name == DEGREE.name && (low..=high).contains(&of_tangent))
            .then(|| format!("; {} is the tangent of {of_tangent:.1}°, and {of_radians:.1}° in radians", plain(size)))
    }
}

fn side(size: f64, low: f64) -> &'static str {
    if size < low { "unusually little" } else { "unusually much" }
}

fn measured(value: f64, unit: &str) -> String {
    if unit == DEGREE.name { format!("{}°", plain(value)) } else { format!("{} {unit}", plain(value)) }
}

/// A number as people write it.
fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e5).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Warnings about values of a case that are outside the usual ranges, by key, with what they look like.
pub fn doubts(case: &Case) -> Vec<String> {
    let mut found = Vec::new();
    let Ok(value) = serde_json::to_value(case) else { return found };
    walk(&value, &Key::root(), "", &mut |key, pattern, value| {
        found.extend(doubt(case, key.as_str(), pattern, value).map(|doubt| format!("{key}: {doubt}")));
    });
    found.extend(random_values(case));
    found.extend(intervals(case));
    found
}

/// The doubt about a value of a key, whose pattern the table may know.
fn doubt(case: &Case, key: &str, pattern: &str, value: f64) -> Option<String> {
    let row = row_of(pattern)?;
    let [mut low, mut high] = row.range;
    if pattern == YOUNG && is_soil(case, key) {
        low = SOIL_YOUNG;
    }
    if pattern == COHESION && !is_bridge(case, key) {
        high = JOINT_COHESION;
    }
    row.doubt(value, [low, high])
}

/// Doubts about the middles of distributions, in the units of their keys.
fn random_values(case: &Case) -> impl Iterator<Item = String> {
    case.random.iter().enumerate().filter_map(|(k, random)| {
        let middle = random.least.zip(random.most).map(|(least, most)| 0.5 * (least + most));
        let given = [(".mean", random.mean), (".mode", random.mode), (", middle", middle)];
        let (name, variable) = given.into_iter().find_map(|(name, value)| Some((name, value?)))?;
        let value = match random.of {
            RandomOf::Value => variable,
            RandomOf::Tangent => libm::atan(variable).to_degrees(),
            RandomOf::Log10 => libm::pow(10.0, variable),
        };
        let doubt = doubt(case, &random.key, &pattern_of(&random.key), value)?;
        Some(format!("random[{k}]{name}: {} {doubt}", random.key))
    })
}

/// Intervals of the output that give no row before the end, or more of them than anybody reads.
fn intervals(case: &Case) -> impl Iterator<Item = String> {
    let total: f64 = case.stages.iter().map(|stage| stage.duration_max.unwrap_or(stage.duration)).sum();
    let Output { frame_interval, history_interval, .. } = case.output;
    [("frame_interval", frame_interval, FRAMES), ("history_interval", history_interval, ROWS)].into_iter().filter_map(
        move |(name, interval, [least, most])| {
            let count = total / interval?;
            let odd = count < least || (count > most && total < OUTLASTS);
            odd.then(|| {
                let (interval, total) = (plain(interval.unwrap_or_default()), plain(total));
                format!(
                    "output.{name}: is {interval} s, and the stages take {total} s: {count:.1e} rows; 10 to 1000 are \
                     usual"
                )
            })
        },
    )
}

/// Usual values of a key, as errors give them.
pub fn usual(key: &str) -> Option<&'static str> {
    row_of(&pattern_of(key)).map(|row| row.usual)
}

/// Keys of the table, `*` for names.
pub fn keys() -> impl Iterator<Item = &'static str> {
    TABLE.iter().flat_map(|row| row.keys.iter().copied())
}

fn row_of(pattern: &str) -> Option<&'static Row> {
    TABLE.iter().chain(MEASURED).find(|row| row.keys.contains(&pattern))
}

/// Calls `see` for each number of a value that the table may know, with its key and that key as the table has it.
fn walk(value: &Value, key: &Key, pattern: &str, see: &mut impl FnMut(&Key, &str, f64)) {
    match value {
        Value::Number(number) => see(key, pattern, number.as_f64().unwrap_or(f64::NAN)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(k, item)| walk(item, &key.index(k), pattern, see));
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                let last = if NAMED.contains(&pattern) { "*" } else { name };
                let pattern = if pattern.is_empty() { last.to_owned() } else { format!("{pattern}.{last}") };
                if keys().any(|known| known.starts_with(&pattern)) {
                    walk(field, &key.field(name), &pattern, see);
                }
            }
        }
        _ => {}
    }
}

/// A key without numbers in lists, and with `*` for the names of rocks and joint laws.
fn pattern_of(key: &str) -> String {
    let mut pattern = String::new();
    let mut rest = key;
    while let Some((before, after)) = rest.split_once('[') {
        pattern += before;
        rest = after.split_once(']').map_or("", |(_, after)| after);
    }
    pattern += rest;
    let of_table = |table: &&str| pattern.strip_prefix(*table)?.strip_prefix('.').and_then(field_of_named);
    let named = NAMED.iter().find_map(|table| of_table(table).map(|field| format!("{table}.*.{field}")));
    named.unwrap_or(pattern)
}

/// The key after a name, which may be quoted, and its point.
fn field_of_named(rest: &str) -> Option<&str> {
    match rest.strip_prefix('"') {
        Some(quoted) => quoted.split_once("\".").map(|(_, field)| field),
        None => rest.split_once('.').map(|(_, field)| field),
    }
}

/// Whether a key belongs to rock that yields.
fn is_soil(case: &Case, key: &str) -> bool {
    let of = |name: &String| Key::root().field("rock").field(name).field("young").as_str() == key;
    case.rocks.iter().any(|(name, rock)| of(name) && rock.yields())
}

/// Whether a key belongs to a joint law with tensile strength, as bridges of rock have.
fn is_bridge(case: &Case, key: &str) -> bool {
    let of = |name: &String| Key::root().field("joint_law").field(name).field("cohesion").as_str() == key;
    case.joint_laws.iter().any(|(name, law)| of(name) && law.tension > 0.0)
}

/// A warning about the width and height (m) of a model that no slope has.
pub fn odd_size([width, height]: [f64; 2]) -> Option<String> {
    let row = row_of("domain.size")?;
    let (size, [least, most]) = (width.max(height), row.range);
    let remedy = if size > most {
        "coordinates are in metres, so divide those in millimetres by 1000"
    } else if size < least {
        "coordinates are in metres: a drawing in metres whose header says millimetres or inches needs \
         `transform.scale = 1`, and degrees must be projected first"
    } else {
        return None;
    };
    Some(format!("the rock is {width:.6} m by {height:.6} m, and {}; {remedy}", row.usual))
}

/// Usual peaks of records of a quantity (SI), and what is known of the largest.
pub fn usual_peaks(kind: BaseMotionKind) -> ([f64; 2], &'static str) {
    row_of(&format!("record.{}", kind.name())).map_or(([0.0, f64::INFINITY], ""), |row| (row.range, row.usual))
}
