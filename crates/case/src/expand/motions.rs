//! Records of ground motion: accelerations and displacements of waves become velocities, displacements of the base too,
//! baselines are corrected, and records of outcrops halved (theory §14).

use crate::key::{Check, Key, fail};
use crate::record::{Baseline, RecordOrigin, WaveMotion};
use crate::validate::ground::{at_least_two, missing_table};
use crate::{BaseMotion, BaseMotionKind, Case, Quiet, TimeTable};

/// Share of the peak up to which the first velocity of a file is a residue: a base is at rest before it moves, and
/// velocities of agencies begin with some 1e-4 of their peak.
const RESIDUE: f64 = 0.01;

/// Whether something of a base motion is yet to be worked out.
pub fn is_short_base(base: &BaseMotion) -> bool {
    base.kind == BaseMotionKind::Displacement || base.baseline.is_some() || residue(base).is_some()
}

/// The first velocity of a file that stands for 0.
fn residue(base: &BaseMotion) -> Option<f64> {
    let rows = base.table.as_ref().filter(|_| base.kind == BaseMotionKind::Velocity && base.origin.file.is_some())?;
    let first = rows.first()?[1];
    (first != 0.0 && first.abs() <= RESIDUE * peak(rows)).then_some(first)
}

/// Whether something of a wave is yet to be worked out.
pub fn is_short_wave(quiet: &Quiet) -> bool {
    quiet.kind.is_some() || quiet.baseline.is_some() || quiet.motion.is_some()
}

/// Works out the ground motions of a case.
///
/// # Errors
/// Rows that cannot be used, or a wave that has none.
pub fn expand(case: &mut Case) -> Check {
    let root = Key::root();
    for (k, base) in case.base_motions.iter_mut().enumerate().filter(|(_, base)| is_short_base(base)) {
        let key = root.field("base_motion").index(k);
        let residue = residue(base);
        let Some(rows) = base.table.as_mut() else { return missing_table(&key, base.file.is_some()) };
        at_least_two(&key, rows)?;
        if let Some(first) = residue {
            rows[0][1] = 0.0;
            base.origin.format += &format!(", first velocity of {first:.1e} m/s taken as 0");
        }
        let was = base.kind;
        if was == BaseMotionKind::Displacement {
            let read = std::mem::take(rows);
            base.origin.read = Some((was, peak(&read)));
            (*rows, base.kind) = (differentiated(&read), BaseMotionKind::Velocity);
        }
        correct(base.baseline.take(), base.kind, rows, &mut base.origin);
    }
    for (k, quiet) in case.quiets.iter_mut().enumerate().filter(|(_, quiet)| is_short_wave(quiet)) {
        expand_wave(&root.field("quiet").index(k), quiet)?;
    }
    Ok(())
}

fn expand_wave(key: &Key, quiet: &mut Quiet) -> Check {
    if quiet.kind.is_some() {
        quiet.wave.get_or_insert([1.0, 0.0]);
    } else if quiet.wave.is_none() {
        let field = if quiet.motion.is_some() { "motion" } else { "baseline" };
        let message = "belongs to a wave, and the boundary has none; add `velocity = \"record.csv\"` or remove it";
        return fail(&key.field(field), message);
    }
    let Some(rows) = quiet.table.as_mut() else { return missing_table(key, quiet.file.is_some()) };
    at_least_two(key, rows)?;
    // Factors on a velocity are read as one.
    let kind = quiet.kind.take().unwrap_or(BaseMotionKind::Velocity);
    let read = std::mem::take(rows);
    quiet.origin.read = Some((kind, peak(&read)));
    *rows = match kind {
        BaseMotionKind::Acceleration => integrated(&read),
        BaseMotionKind::Velocity => read,
        BaseMotionKind::Displacement => differentiated(&read),
    };
    correct(quiet.baseline.take(), BaseMotionKind::Velocity, rows, &mut quiet.origin);
    if quiet.motion.take() == Some(WaveMotion::Outcrop) {
        rows.iter_mut().for_each(|row| row[1] *= 0.5);
        quiet.origin.halved = true;
    }
    Ok(())
}

/// Largest magnitude of the values.
pub fn peak(rows: &TimeTable) -> f64 {
    rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max)
}

/// Integral from the first row on, by trapezoids.
pub fn integrated(rows: &TimeTable) -> TimeTable {
    let mut sum = 0.0;
    let first = rows.iter().take(1).map(|row| [row[0], 0.0]);
    let others = rows.windows(2).map(|two| {
        sum += 0.5 * (two[0][1] + two[1][1]) * (two[1][0] - two[0][0]);
        [two[1][0], sum]
    });
    first.chain(others).collect()
}

/// Rates of the parabola through a row and its neighbours, at the last row through the last three; zero at the first
/// row, where the ground is at rest.
fn differentiated(rows: &TimeTable) -> TimeTable {
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let first = rows.iter().take(1).map(|row| [row[0], 0.0]);
    let inner = rows.windows(3).map(|three| {
        let steps = [three[1][0] - three[0][0], three[2][0] - three[1][0]];
        let slopes = [slope(three[0], three[1]), slope(three[1], three[2])];
        [three[1][0], (steps[1] * slopes[0] + steps[0] * slopes[1]) / (steps[0] + steps[1])]
    });
    let last = rows.windows(2).last().map(|two| {
        let [length, rate] = [two[1][0] - two[0][0], slope(two[0], two[1])];
        let bend = rows
            .iter()
            .rev()
            .nth(2)
            .map_or(0.0, |before| (rate - slope(*before, two[0])) * length / (two[1][0] - before[0]));
        [two[1][0], rate + bend]
    });
    first.chain(inner).chain(last).collect()
}

/// Final velocity and displacement of rows of acceleration or velocity that begin at rest.
pub fn ends(kind: BaseMotionKind, rows: &TimeTable) -> [f64; 2] {
    let last = |rows: &TimeTable| rows.last().map_or(0.0, |row| row[1]);
    if kind == BaseMotionKind::Acceleration {
        let velocity = integrated(rows);
        [last(&velocity), last(&integrated(&velocity))]
    } else {
        [last(rows), last(&integrated(rows))]
    }
}

/// Takes c₀ + c₁τ from the acceleration, τ since the first row, so that the motion ends at rest.
fn correct(baseline: Option<Baseline>, kind: BaseMotionKind, rows: &mut TimeTable, origin: &mut RecordOrigin) {
    let Some(baseline) = baseline else { return };
    let start = rows[0][0];
    // The terms in the quantity of the rows, for accelerations 1 and τ.
    let term = |power: i32, time: f64| {
        let tau = time - start;
        match (kind, power) {
            (BaseMotionKind::Acceleration, 0) => 1.0,
            (BaseMotionKind::Acceleration, _) | (_, 0) => tau,
            _ => 0.5 * tau * tau,
        }
    };
    let basis = [0, 1].map(|power| ends(kind, &rows.iter().map(|row| [row[0], term(power, row[0])]).collect()));
    let before = ends(kind, rows);
    let factors = match baseline {
        Baseline::None => [0.0; 2],
        Baseline::Constant => [before[0] / basis[0][0], 0.0],
        Baseline::Linear => {
            let [[v0, d0], [v1, d1]] = basis;
            let determinant = v0 * d1 - v1 * d0;
            [(before[0] * d1 - before[1] * v1) / determinant, (before[1] * v0 - before[0] * d0) / determinant]
        }
    };
    if baseline != Baseline::None && factors.iter().all(|factor| factor.is_finite()) {
        rows.iter_mut().for_each(|row| row[1] -= factors[0] * term(0, row[0]) + factors[1] * term(1, row[0]));
    }
    origin.corrected = Some((baseline, before));
}
