//! Warnings about a model that can be built: changes of its geometry, and values that fit no slope of its size.

use crate::contact::LawId;
use crate::cover::Crumb;
use crate::geometry::ends::EndDistances;
use crate::geometry::{NodingReport, Point, polygon};
use crate::model::case::{Case, Integrator, Invalid, LawRegion, Solver, plausible};
use crate::state::Model;

use super::ends::{self, TraceEnd};
use super::joints::Joints;
use super::law_of;
use super::locator::Locator;
use super::points;

/// Length of a fixed edge over that of the boundary on it.
const EDGE_RATIO: f64 = 2.0;
/// Share of the greatest in-situ stress that a tension may have, as at a rough surface.
const TENSION_SHARE: f64 = 0.01;
/// Ignored traces that are named.
const NAMED: usize = 5;

/// What the build has changed in the drawing so that ends and corners meet and no block is a crumb.
pub(super) fn notes(
    noding: &NodingReport,
    (ends, distances): (&[TraceEnd], &EndDistances),
    crumbs: &[Crumb],
) -> Vec<String> {
    let count = noding.merged_vertices;
    let merged = (count > 0).then(|| {
        let what = if count == 1 { "trace end or vertex was" } else { "trace ends or vertices were" };
        format!("{count} {what} merged within the snap tolerance {:.3e} m", noding.tolerance)
    });
    merged.into_iter().chain(ends::notes(ends, distances)).chain(note_of_crumbs(crumbs)).collect()
}

fn note_of_crumbs(crumbs: &[Crumb]) -> Option<String> {
    let tell = |crumb: &Crumb| {
        let kept = if crumb.joined { "" } else { " (alone, kept)" };
        format!("{:.2e} m² at ({:.6}, {:.6}) m{kept}", crumb.area, crumb.place.x, crumb.place.y)
    };
    let named: Vec<String> = crumbs.iter().take(NAMED).map(tell).collect();
    let more = crumbs.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let blocks = if crumbs.len() == 1 { "block has" } else { "blocks have" };
    (!crumbs.is_empty()).then(|| {
        format!(
            "{} {blocks} less than the least area and joined the neighbour across their shortest joint: {}{more}; \
             mesh.least_block = 0 keeps each",
            crumbs.len(),
            named.join(", ")
        )
    })
}

/// Warnings about changes by the noder.
pub(super) fn of_geometry(noding: &NodingReport, case: &Case, joints: &Joints) -> Vec<String> {
    let traces = &joints.traces;
    let mut warnings = lost_joints(noding, case, joints);
    if !noding.overlapping_traces.is_empty() {
        warnings.push(format!(
            "{} pairs of joint traces coincide along an edge; the first of each pair gives its law",
            noding.overlapping_traces.len()
        ));
    }
    warnings.extend(idle_regions(case, traces));
    warnings
}

/// Joints of the case that cut no rock, and sets of which no trace does. Some traces of a set always miss the rock.
fn lost_joints(noding: &NodingReport, case: &Case, Joints { traces, set_start, .. }: &Joints) -> Vec<String> {
    let ignored = ignored_traces(noding);
    let lost: Vec<usize> = ignored.iter().copied().filter(|&t| t < case.joints.len()).collect();
    let mut warnings = Vec::new();
    if !lost.is_empty() {
        let names: Vec<String> = lost.iter().take(NAMED).map(|&t| name_of_trace(t, &traces[t].0)).collect();
        let more = lost.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let traces = if lost.len() == 1 { "joint trace cuts" } else { "joint traces cut" };
        warnings.push(format!(
            "{} {traces} no rock (outside the outline, or dead ends within one triangle): {}{more}",
            lost.len(),
            names.join(", ")
        ));
    }
    // A region with another law divides traces, and the pieces are no longer with their set.
    let sets = set_start.windows(2).enumerate().filter(|_| case.law_regions.is_empty());
    let is_lost = |range: &[usize]| (range[0]..range[1]).all(|t| ignored.binary_search(&t).is_ok());
    warnings.extend(sets.filter(|(_, range)| is_lost(range)).map(|(k, range)| {
        let count = range[1] - range[0];
        format!(
            "{}: none of its {count} traces cuts rock; correct its region, origin or spacing",
            case.joint_set_name(k)
        )
    }));
    warnings
}

/// Regions of which no joint has the law.
fn idle_regions(case: &Case, traces: &[(Vec<Point>, LawId)]) -> Vec<String> {
    let is_idle = |change: &LawRegion| {
        let (region, to) = (points(&change.region), law_of(case, &change.to));
        let inside = |pair: &[Point]| polygon::contains(&region, (pair[0] + pair[1]) * 0.5);
        !traces.iter().any(|(line, law)| Some(*law) == to && line.windows(2).any(inside))
    };
    let idle = case.law_regions.iter().enumerate().filter(|(_, change)| is_idle(change));
    idle.map(|(k, change)| {
        format!("law_region[{k}]: no joint in it takes the law {:?}; correct or remove it", change.to)
    })
    .collect()
}

fn name_of_trace(trace: usize, points: &[Point]) -> String {
    let position = |p: Option<&Point>| p.map_or_else(String::new, |p| format!("({:.6}, {:.6})", p.x, p.y));
    format!("joint[{trace}] from {} to {} m", position(points.first()), position(points.last()))
}

/// Traces of which nothing cuts rock.
pub fn ignored_traces(noding: &NodingReport) -> Vec<usize> {
    (0..noding.traces.len()).filter(|&t| noding.traces[t].in_rock == 0.0).collect()
}

/// Warnings about unusual values of the case.
pub(super) fn of_values(case: &Case, model: &Model, positions: &Locator) -> Vec<String> {
    let mut warnings = without_effect(&case.solver);
    warnings.extend(extent(case, model));
    warnings.extend(gravity(case));
    warnings.extend(unheld(case));
    warnings.extend(long_edges(case, positions));
    warnings.extend(tension(model));
    warnings
}

/// Keys of the solver that the case sets and its integrator does not use.
fn without_effect(solver: &Solver) -> Vec<String> {
    let default = Solver::default();
    let (name, others): (_, &[(&str, bool)]) = match solver.integrator {
        Integrator::Implicit => (
            "implicit",
            &[
                ("contact_theta", solver.contact_theta != default.contact_theta),
                ("contact_tolerance", solver.contact_tolerance != default.contact_tolerance),
                ("sweeps_max", solver.sweeps_max != default.sweeps_max),
                ("mass_scaling", solver.mass_scaling != default.mass_scaling),
                ("dt_safety", solver.dt_safety != default.dt_safety && solver.implicit_step.is_some()),
            ],
        ),
        Integrator::Explicit => (
            "explicit",
            &[
                ("newmark", solver.newmark != default.newmark),
                ("implicit_step", solver.implicit_step.is_some()),
                ("iterations_max", solver.iterations_max != default.iterations_max),
                ("displacement_ratio", solver.displacement_ratio != default.displacement_ratio),
            ],
        ),
    };
    let tell = |(key, _): &(&str, bool)| {
        format!(
            "solver.{key}: has no effect with solver.integrator = \"{name}\"; remove it, or use the other integrator"
        )
    };
    others.iter().filter(|(_, set)| *set).map(tell).collect()
}

/// A model that is larger or smaller than slopes are, or smaller than its mesh.
fn extent(case: &Case, model: &Model) -> Option<String> {
    let (low, high) = polygon::bounds(&model.covers.polygons.points);
    let span = high - low;
    if let Some(odd) = plausible::odd_size([span.x, span.y]) {
        return Some(format!("domain.outline: {odd}"));
    }
    let size = case.mesh.size;
    (size > span.max()).then(|| {
        format!(
            "mesh.size: is {size} m, more than the whole model, {:.6} m by {:.6} m; about a fifth of the smallest \
             block is usual",
            span.x, span.y
        )
    })
}

fn gravity(case: &Case) -> Option<String> {
    let y = case.gravity.y;
    (y > 0.0).then(|| format!("gravity.y: is {y} m/s², which pulls upwards; down is negative, -9.81 is the standard"))
}

/// Rock with weight that nothing holds.
fn unheld(case: &Case) -> Option<String> {
    let held = !case.fixes.is_empty() || !case.quiets.is_empty() || !case.free_fields.is_empty();
    let heavy = [case.gravity.x, case.gravity.y] != [0.0; 2];
    (heavy && !held).then(|| {
        "fix: there is none, so nothing holds the rock and all of it falls; slopes have a `[[fix]]` with the `edge` of \
         their base"
            .into()
    })
}

/// Fixed edges that lie off the rock for the most part.
fn long_edges(case: &Case, positions: &Locator) -> Vec<String> {
    let mut warnings = Vec::new();
    for (k, fix) in case.fixes.iter().enumerate() {
        let Some([a, b]) = fix.edge else { continue };
        let key = format!("fix[{k}].edge");
        // An edge without rock was refused when the fixities were made.
        let held: f64 = positions.boundary(&key, [a, b]).iter().flatten().map(|piece| piece.length()).sum();
        let length = (Point::from(b) - Point::from(a)).norm();
        if length > EDGE_RATIO * held {
            warnings.push(format!(
                "{key}: is {length:.6} m long, but only {held:.6} m of the rock's boundary lie on it; its ends are \
                 those of a side of the outline"
            ));
        }
    }
    warnings
}

/// In-situ stress that pulls.
fn tension(model: &Model) -> Option<String> {
    let field = model.in_situ.as_ref()?;
    let stresses = model.covers.element_centroid.iter().map(|p| (field.at(*p), *p));
    let pull = |s: &[f64; 3]| s[0].max(s[1]);
    let greatest = stresses.clone().map(|(s, _)| s[0].abs().max(s[1].abs())).fold(0.0, f64::max);
    let pulled = stresses.clone().filter(|(s, _)| pull(s) > TENSION_SHARE * greatest).count();
    let (most, position) = stresses.max_by(|(s, _), (t, _)| pull(s).total_cmp(&pull(t)))?;
    (pulled > 0).then(|| {
        format!(
            "in_situ: pulls at the rock in {pulled} of {} elements, most at ({:.6}, {:.6}) m, by {:.3e} Pa; tension is \
             positive, and rock under ground is compressed: write sxx and syy negative",
            model.covers.element_count(),
            position.x,
            position.y,
            pull(&most)
        )
    })
}

/// Refuses stages that are shorter than a step.
pub(super) fn check_stages(case: &Case, model: &Model) -> Result<(), Invalid> {
    let dt = model.dt;
    match case.stages.iter().position(|stage| stage.duration < dt * (1.0 - 1e-6)) {
        None => Ok(()),
        Some(k) => Err(Invalid {
            key: format!("stage[{k}].duration"),
            message: format!(
                "is {} s, less than one internal step of {dt:.3e} s, which follows from mesh.size, young and density: \
                 correct these, give a longer stage, or set solver.dt_max",
                case.stages[k].duration
            ),
        }),
    }
}
