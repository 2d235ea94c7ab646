//! The family of checks that validation is written with, beside those of single numbers ([`crate::keys`]). Every
//! message says what, the value, the limit and the remedy.

use std::collections::BTreeMap;
use std::fmt;

use crate::key::{Check, Invalid, Key, fail, invalid, list, nearest};
use crate::keys::Plain;
use crate::limits::NAME_MAX;
use crate::text::{is_hidden, shortened};
use crate::{Case, StageKind, TimeTable};

/// Checks each entry of a list.
///
/// # Errors
/// The first entry that cannot be used.
pub fn each<T>(key: &Key, list: &[T], check: impl Fn(&Key, &T) -> Check) -> Check {
    list.iter().enumerate().try_for_each(|(i, entry)| check(&key.index(i), entry))
}

/// Checks the number of points of a list.
///
/// # Errors
/// There are fewer points than `least`.
pub fn points(key: &Key, list: &[[f64; 2]], least: usize, what: &str) -> Check {
    if list.len() < least {
        let message = format!("has {} points, {what} needs at least {least}; add points or remove it", list.len());
        return fail(key, message);
    }
    Ok(())
}

/// Checks that exactly one of some places is given, and returns its name.
///
/// # Errors
/// None is given, or several are.
pub fn only<'a>(key: &Key, places: &[(&'a str, bool)]) -> Result<&'a str, Invalid> {
    let given: Vec<&str> = places.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
    if let [only] = given[..] {
        return Ok(only);
    }
    let (count, given, all) = (given.len(), list(given), list(places.iter().map(|(name, _)| *name)));
    Err(invalid(key, format!("has {count} places ({given}), must have exactly 1 of {all}; keep or add one")))
}

/// Checks a loop, whose crossings are the builder's to judge.
///
/// # Errors
/// There are fewer than three points, or all lie on one line.
pub fn polygon(key: &Key, ring: &[[f64; 2]]) -> Check {
    points(key, ring, 3, "a loop")?;
    let [x0, y0] = ring[0];
    let off = |p: &[f64; 2]| libm::hypot(p[0] - x0, p[1] - y0);
    let far = ring.iter().max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&ring[0]);
    let (size, [dx, dy]) = (off(far), [far[0] - x0, far[1] - y0]);
    let on_line = |&[x, y]: &[f64; 2]| ((x - x0) * dy - (y - y0) * dx).abs() <= 1e-12 * size * size;
    if ring.iter().all(on_line) {
        return fail(
            key,
            format!("its {} points lie on one line, a loop has an area; add a point beside it", ring.len()),
        );
    }
    Ok(())
}

/// Checks a polygon that selects parts of the rock.
///
/// # Errors
/// There are fewer than three points, or the polygon has no area.
pub fn region(key: &Key, ring: &[[f64; 2]]) -> Check {
    polygon(key, ring)?;
    let [x0, y0] = ring[0];
    let (mut doubled, mut size) = (0.0, 0.0_f64);
    for (i, &[x, y]) in ring.iter().enumerate() {
        let [xn, yn] = ring[(i + 1) % ring.len()];
        doubled += (x - x0) * (yn - y0) - (xn - x0) * (y - y0);
        size = size.max((x - x0).abs()).max((y - y0).abs());
    }
    if doubled.abs() <= 1e-12 * size * size {
        return fail(key, "the polygon has no area; give at least 3 points that are not on one line");
    }
    Ok(())
}

/// Checks a segment.
///
/// # Errors
/// Both ends are the same point.
pub fn segment(key: &Key, edge: &[[f64; 2]; 2]) -> Check {
    if edge[0] == edge[1] {
        return fail(key, format!("both ends are {:?}, a segment needs two different points; move one", edge[0]));
    }
    Ok(())
}

/// Times of rows (s).
const TIMES: std::ops::RangeInclusive<f64> = 0.0..=1e9;

/// Checks a table of times (s) and factors.
///
/// # Errors
/// There is no row, a time is negative, or the times do not increase.
pub fn table(key: &Key, rows: &TimeTable) -> Check {
    if rows.is_empty() {
        return fail(key, "has no rows, at least 1 is needed; add `[time, factor]` or leave the table out");
    }
    for (i, &[time, _]) in rows.iter().enumerate() {
        let key = key.index(i);
        if !TIMES.contains(&time) {
            let message = format!("time is {} s, must be at least 0 and at most 1e9; correct it", Plain(time));
            return fail(&key, message);
        }
        if i > 0 && time <= rows[i - 1][0] {
            let message = format!(
                "time is {} s, must be greater than {} s of the row before; sort the rows by time",
                Plain(time),
                Plain(rows[i - 1][0])
            );
            return fail(&key, message);
        }
    }
    Ok(())
}

/// Checks that a name does no harm where it is shown: terminals obey control characters, and spreadsheets take a text
/// that begins with `=`, `+`, `-` or `@` for a formula. One of more than `most` letters fits nowhere.
///
/// # Errors
/// It has one of these.
pub fn harmless(key: &Key, name: &str, most: usize) -> Check {
    let letters = name.chars().count();
    if letters > most {
        let begin = shortened(name, 20);
        return fail(key, format!("{begin:?} has {letters} letters, must have at most {most}; shorten it"));
    }
    if let Some(sign) = name.chars().find(|letter| is_hidden(*letter)) {
        return fail(key, format!("{name:?} has the control character {sign:?}, which no name must have; remove it"));
    }
    match name.trim_start().chars().next().filter(|c| "=+-@".contains(*c)) {
        Some(sign) => {
            let message = format!(
                "{name:?} begins with `{sign}`, from which spreadsheets make a formula; begin with a letter or a digit"
            );
            fail(key, message)
        }
        None => Ok(()),
    }
}

/// Checks that names are not empty and that no two are equal; a thing without a name is skipped.
///
/// # Errors
/// A name is empty or taken.
pub fn unique<'a>(key: &Key, what: &str, names: impl Iterator<Item = Option<&'a str>>) -> Check {
    let mut seen = BTreeMap::new();
    for (i, name) in names.enumerate().filter_map(|(i, name)| Some((i, name?))) {
        let place = key.index(i).field("name");
        if name.trim().is_empty() {
            return fail(&place, format!("is {name:?}, a {what} needs at least one letter; give it a name"));
        }
        harmless(&place, name, NAME_MAX)?;
        if let Some(first) = seen.insert(name, i) {
            let message =
                format!("{name:?} is already the name of {}, names must differ; rename one", key.index(first));
            return fail(&place, message);
        }
    }
    Ok(())
}

/// The names that a reference may use.
pub struct Names<'a> {
    what: &'static str,
    remedy: &'static str,
    known: Vec<&'a str>,
}

impl<'a> Names<'a> {
    /// Returns the joint laws of a case.
    pub fn of_laws(case: &'a Case) -> Self {
        let known = case.joint_laws.keys().map(String::as_str).collect();
        Self { what: "joint law", remedy: "add [joint_law.NAME]", known }
    }

    /// Returns the named fixities of a case.
    pub fn of_fixes(case: &'a Case) -> Self {
        let known = case.fixes.iter().filter_map(|fix| fix.name.as_deref()).collect();
        Self { what: "fixity", remedy: "add [[fix]] with this `name`", known }
    }

    /// Returns the heads, the rain and the drains of a case, in this order.
    pub fn of_flow(case: &'a Case) -> [Self; 3] {
        let heads = case.heads.iter().map(|head| head.name.as_str()).collect();
        let rain = case.rains.iter().map(|rain| rain.name.as_str()).collect();
        let drains = case.drains.iter().map(|drain| drain.name.as_str()).collect();
        [
            Self { what: "head", remedy: "add [[head]] with this `name`", known: heads },
            Self { what: "rain", remedy: "add [[rain]] with this `name`", known: rain },
            Self { what: "drain", remedy: "add [[drain]] with this `name`", known: drains },
        ]
    }

    /// Returns the names.
    pub fn known(&self) -> &[&'a str] {
        &self.known
    }

    /// Returns the word for the thing that has such a name.
    pub fn what(&self) -> &'static str {
        self.what
    }

    /// Returns the dynamic stages of a case.
    pub fn of_dynamic_stages(case: &'a Case) -> Self {
        let dynamic = case.stages.iter().filter(|stage| stage.kind == StageKind::Dynamic);
        let known = dynamic.map(|stage| stage.name.as_str()).collect();
        Self { what: "dynamic stage", remedy: "add [[stage]] with this `name` and `kind = \"dynamic\"`", known }
    }

    /// Returns the stages of a case after which another one follows.
    pub fn of_followed_stages(case: &'a Case) -> Self {
        let before_last = &case.stages[..case.stages.len().saturating_sub(1)];
        let known = before_last.iter().map(|stage| stage.name.as_str()).collect();
        Self { what: "stage that another one follows", remedy: "leave it out to count from the start", known }
    }

    /// Returns the named bolts of a case.
    pub fn of_bolts(case: &'a Case) -> Self {
        let known = case.bolts.iter().filter_map(|bolt| bolt.name.as_deref()).collect();
        Self { what: "bolt", remedy: "add [[bolt]] with this `name`", known }
    }

    /// Checks that `name` is known.
    ///
    /// # Errors
    /// It is not; the message gives the nearest name.
    pub fn must_hold(&self, key: &Key, name: &str) -> Check {
        if self.known.contains(&name) {
            return Ok(());
        }
        let (what, remedy) = (self.what, self.remedy);
        let message = match nearest(name, self.known.iter().copied()) {
            Some(near) => format!("no {what} is named {name:?}, did you mean {near:?}? Known: {self}; or {remedy}"),
            None => format!("no {what} is named {name:?}, and the case has none with a name; {remedy}"),
        };
        fail(key, message)
    }
}

impl fmt::Display for Names<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&list(self.known.iter().copied()))
    }
}
