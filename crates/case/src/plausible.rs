//! Values of a case outside the usual ranges of their keys, and the slips that they look like: warnings of
//! `enmm check`, `edit`, runs and hosts.

use serde_json::Value;

use crate::key::Key;
use crate::keys::{Rule, unit};
use crate::record::{BaseMotionKind, STANDARD_GRAVITY};
use crate::{
    Bolt, BoltPattern, Case, Drain, Flow, Gravity, HoekBrown, InSitu, JointLaw, JointSet, LawChange, Load, Mesh,
    Output, PlaneOfWeakness, Port, Rain, RandomOf, Rock, RockFracture, Skin, Stage, Tessellation, Water,
};

/// Tables whose keys have usual values, by their place in a case: without the numbers of lists, and with `*` for names.
const TABLES: [(&str, &[Rule]); 21] = [
    ("rock.*", Rock::KEYS),
    ("rock.*.hoek_brown", HoekBrown::KEYS),
    ("rock.*.fracture", RockFracture::KEYS),
    ("rock.*.plane_of_weakness", PlaneOfWeakness::KEYS),
    ("in_situ", InSitu::KEYS),
    ("joint_law.*", JointLaw::KEYS),
    ("stage", Stage::KEYS),
    ("stage.law", LawChange::KEYS),
    ("bolt", Bolt::KEYS),
    ("bolt_pattern", BoltPattern::KEYS),
    ("skin", Skin::KEYS),
    ("joint_set", JointSet::KEYS),
    ("tessellation", Tessellation::KEYS),
    ("mesh", Mesh::KEYS),
    ("gravity", Gravity::KEYS),
    ("load", Load::KEYS),
    ("port", Port::KEYS),
    ("water", Water::KEYS),
    ("flow", Flow::KEYS),
    ("rain", Rain::KEYS),
    ("drain", Drain::KEYS),
];

/// Usual values of what is measured: peaks of records of earthquakes. Below the first a record hardly moves anything,
/// and above the second hardly any has been measured.
const PEAKS: [(BaseMotionKind, [f64; 2], &str); 3] = [
    (BaseMotionKind::Acceleration, [0.01 * STANDARD_GRAVITY, 3.0 * STANDARD_GRAVITY], "the largest known is some 4 g"),
    (BaseMotionKind::Velocity, [0.005, 5.0], "the largest known is some 4 m/s"),
    (BaseMotionKind::Displacement, [0.0005, 10.0], "the largest known is some 9 m"),
];
/// Usual lengths (m) of the longer side of the box of the rock.
const SIZES: [f64; 2] = [1.0, 1e4];

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

/// The doubt about a value of a key; none where it is usual, or 0, which means "none" nearly everywhere.
fn doubt_of(rule: &Rule, value: f64, [low, high]: [f64; 2]) -> Option<String> {
    let (range, usual) = rule.usual?;
    let size = value.abs();
    let meant = |size: f64| (low..=high).contains(&size);
    if value == 0.0 || !value.is_finite() || meant(size) {
        return None;
    }
    let looks = match rule.unit.slips.iter().find(|(_, by)| meant(size * by)) {
        Some((name, by)) => format!("; {} looks like {name}: write {}", plain(value), plain(value * by)),
        None if rule.unit.name == unit::DEGREE.name => angle_meant(range, size).unwrap_or_default(),
        None => String::new(),
    };
    let space = if rule.unit.sign == rule.unit.name { " " } else { "" };
    let side = if size < low { "little" } else { "much" };
    Some(format!("is {}{space}{}, which is unusually {side}: {usual}{looks}", plain(value), rule.unit.sign))
}

/// The angle of which a value looks like the tangent or the radians.
fn angle_meant([low, high]: [f64; 2], size: f64) -> Option<String> {
    let [of_tangent, of_radians] = [libm::atan(size).to_degrees(), size.to_degrees()];
    (low..=high)
        .contains(&of_tangent)
        .then(|| format!("; {} is the tangent of {of_tangent:.1}°, and {of_radians:.1}° in radians", plain(size)))
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

/// The doubt about a value of a key, whose pattern the tables may know.
fn doubt(case: &Case, key: &str, pattern: &str, value: f64) -> Option<String> {
    let rule = rule_of(pattern)?;
    let ([mut low, mut high], _) = rule.usual?;
    if pattern == YOUNG && is_soil(case, key) {
        low = SOIL_YOUNG;
    }
    if pattern == COHESION && !is_bridge(case, key) {
        high = JOINT_COHESION;
    }
    doubt_of(rule, value, [low, high])
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

/// Rule of a key, `*` for names.
fn rule_of(pattern: &str) -> Option<&'static Rule> {
    let (table, key) = pattern.rsplit_once('.')?;
    let (_, rules) = TABLES.iter().find(|(place, _)| *place == table)?;
    rules.iter().find(|rule| rule.key == key)
}

/// Calls `see` for each number of a value in a table with usual values, with its key and the pattern of it.
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
                let is_usual = rule_of(&pattern).is_some_and(|rule| rule.usual.is_some());
                if is_usual || TABLES.iter().any(|(place, _)| place.starts_with(&pattern)) {
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
    let (size, [least, most]) = (width.max(height), SIZES);
    let remedy = if size > most {
        "coordinates are in metres, so divide those in millimetres by 1000"
    } else if size < least {
        "coordinates are in metres: a drawing in metres whose header says millimetres or inches needs \
         `transform.scale = 1`, and degrees must be projected first"
    } else {
        return None;
    };
    Some(format!("the rock is {width:.6} m by {height:.6} m, and slopes are 1 m to 10 km long; {remedy}"))
}

/// Usual peaks of records of a quantity (SI), and what is known of the largest.
pub fn usual_peaks(kind: BaseMotionKind) -> ([f64; 2], &'static str) {
    let peaks = PEAKS.iter().find(|(of, ..)| *of == kind);
    peaks.map_or(([0.0, f64::INFINITY], ""), |(_, range, words)| (*range, *words))
}
