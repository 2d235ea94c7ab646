//! Bolt patterns become bolts with their heads on the face.

use super::Expanded;
use crate::bolt::BOLTS_MAX;
use crate::key::{Check, Key, fail, invalid};
use crate::validate::bolts::validate_bolts;
use crate::validate::checks::{segment, unique};
use crate::{Bolt, BoltPattern, Case, Invalid};

/// Expands all bolt patterns, and their names in the stages that install them.
///
/// # Errors
/// The first pattern that cannot be laid out.
pub fn expand(case: &mut Case, told: &mut Expanded) -> Check {
    let patterns = std::mem::take(&mut case.bolt_patterns);
    let key = Key::root().field("bolt_pattern");
    unique(&key, "bolt pattern", patterns.iter().map(|pattern| pattern.name.as_deref()))?;
    for (k, pattern) in patterns.iter().enumerate() {
        let key = key.index(k);
        check(&key, pattern)?;
        if let Some(name) = &pattern.name
            && case.bolts.iter().any(|bolt| bolt.name.as_ref() == Some(name))
        {
            return fail(&key.field("name"), format!("{name:?} is the name of a bolt too; rename one"));
        }
        let first = case.bolts.len();
        for (number, station) in stations(&key, pattern)?.into_iter().enumerate() {
            let bolt = bolt(&key, case, pattern, number, station)?;
            let made = format!("bolt[{}]", case.bolts.len());
            for points in [".points", ".points[0]", ".points[1]"] {
                told.origins.insert(format!("{made}{points}"), key.field("line").to_string());
            }
            told.origins.insert(made, key.to_string());
            case.bolts.push(bolt);
        }
        install_by_name(case, pattern.name.as_deref(), first);
    }
    Ok(())
}

/// Puts the names of all bolts from `first` on in place of the one name by which stages install them.
pub(super) fn install_by_name(case: &mut Case, name: Option<&str>, first: usize) {
    let Some(name) = name else { return };
    let names: Vec<String> = case.bolts[first..].iter().filter_map(|bolt| bolt.name.clone()).collect();
    for stage in &mut case.stages {
        if let Some(place) = stage.install.iter().position(|installed| installed == name) {
            stage.install.splice(place..=place, names.iter().cloned());
        }
    }
}

fn check(key: &Key, pattern: &BoltPattern) -> Check {
    pattern.check(key)?;
    segment(&key.field("line"), &pattern.line)?;
    // The bar alone, wherever it lies.
    let bar = Bolt { points: pattern.line, ..bar(pattern) };
    validate_bolts(&Key::root(), &[bar]).map_err(|mut invalid| {
        invalid.key = invalid.key.replacen("[0]", key.as_str(), 1);
        invalid
    })
}

/// Points on the head line, one for each bolt.
fn stations(key: &Key, pattern: &BoltPattern) -> Result<Vec<[f64; 2]>, Invalid> {
    let [a, b] = pattern.line;
    let shares: Vec<f64> = match (pattern.count, pattern.distance) {
        (Some(1), None) => vec![0.5],
        (Some(count), None) => (0..count).map(|k| f64::from(k) / f64::from(count - 1)).collect(),
        (None, Some(distance)) => {
            let step = distance / libm::hypot(b[0] - a[0], b[1] - a[1]);
            let count = (1.0 / step * (1.0 + 1e-12)).floor() + 1.0;
            if count > f64::from(BOLTS_MAX) {
                let message =
                    format!("is {distance} m, which gives {count} bolts, must give at most {BOLTS_MAX}; raise it");
                return Err(invalid(&key.field("distance"), message));
            }
            (0..count as u32).map(|k| f64::from(k) * step).collect()
        }
        (count, _) => {
            let given = if count.is_some() { "both" } else { "neither" };
            let message = format!("has {given} of `count` and `distance`, must have exactly 1; keep or add one");
            return Err(invalid(key, message));
        }
    };
    Ok(shares.iter().map(|share| [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share)).collect())
}

fn bar(pattern: &BoltPattern) -> Bolt {
    Bolt {
        name: pattern.name.clone(),
        points: pattern.line,
        anchorage: pattern.anchorage,
        young: pattern.young,
        area: pattern.area,
        spacing: pattern.spacing,
        yield_force: pattern.yield_force,
        rupture_strain: pattern.rupture_strain,
        pretension: pattern.pretension,
        free_length: pattern.free_length,
        bond: pattern.bond,
        bond_stiffness: pattern.bond_stiffness,
        plate: pattern.plate,
        support: pattern.support,
        active: pattern.active,
        of_skin: false,
    }
}

/// Doubts about patterns whose heads lie farther from their line than a bolt reaches: their direction leaves the rock
/// there, and the face that it enters is another one.
pub fn far_heads(case: &Case) -> impl Iterator<Item = String> {
    case.bolt_patterns.iter().enumerate().filter_map(|(k, pattern)| {
        let key = Key::root().field("bolt_pattern").index(k);
        let stations = stations(&key, pattern).ok()?;
        let heads = stations.iter().filter_map(|&station| head(case, pattern, station).0);
        let far: Vec<f64> = heads.map(f64::abs).filter(|&distance| distance > pattern.length).collect();
        let farthest = far.iter().copied().reduce(f64::max)?;
        Some(format!(
            "{key}: {} of {} heads lie up to {farthest:.3} m from `line`, farther than the bolts are long ({} m): at \
             {}° they enter the rock through another face; turn `angle_deg` by 180°, or move `line` to the face",
            far.len(),
            stations.len(),
            pattern.length,
            pattern.angle_deg
        ))
    })
}

/// Distance (m) from a point of the head line, along the direction of the bolts, to the nearest point at which the rock
/// begins; and that direction.
fn head(case: &Case, pattern: &BoltPattern, station: [f64; 2]) -> (Option<f64>, [f64; 2]) {
    let (sin, cos) = libm::sincos(pattern.angle_deg.to_radians());
    let entries = entries(case, station, [cos, sin]);
    (entries.into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs())), [cos, sin])
}

/// The bolt through a point of the head line: its head is the nearest point at which the rock begins along its
/// direction.
fn bolt(key: &Key, case: &Case, pattern: &BoltPattern, number: usize, station: [f64; 2]) -> Result<Bolt, Invalid> {
    let (nearest, [cos, sin]) = head(case, pattern, station);
    let Some(along) = nearest else {
        let message = format!(
            "bolt {} through ({}, {}) m at {}° meets no face of the rock; move the line or turn `angle_deg`",
            number + 1,
            station[0],
            station[1],
            pattern.angle_deg
        );
        return Err(invalid(&key.field("line"), message));
    };
    let at = |along: f64| [station[0] + along * cos, station[1] + along * sin];
    let name = pattern.name.as_ref().map(|name| format!("{name}_{}", number + 1));
    Ok(Bolt { name, points: [at(along), at(along + pattern.length)], ..bar(pattern) })
}

/// Distances (m) from `start` along a direction at which rock begins. Outline, holes and islands do not cross, so that
/// every other meeting leaves the rock.
fn entries(case: &Case, start: [f64; 2], direction: [f64; 2]) -> Vec<f64> {
    let domain = &case.domain;
    let mut meetings = Vec::new();
    for ring in std::iter::once(&domain.outline).chain(&domain.holes).chain(&domain.islands) {
        let off = |p: [f64; 2]| direction[0] * (p[1] - start[1]) - direction[1] * (p[0] - start[0]);
        let along = |p: [f64; 2]| direction[0] * (p[0] - start[0]) + direction[1] * (p[1] - start[1]);
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let (left, right) = (off(a), off(b));
            if (left <= 0.0) != (right <= 0.0) {
                meetings.push(along(a) + (along(b) - along(a)) * (left / (left - right)));
            }
        }
    }
    meetings.sort_by(f64::total_cmp);
    meetings.into_iter().step_by(2).collect()
}
