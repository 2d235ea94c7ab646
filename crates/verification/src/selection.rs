//! From the request of a user to jobs: problems by ID or prefix, values of parameters, every mistake with its remedy.

use enmm::model::case::Integrator;
use enmm::model::case::key::{list, nearest};

use crate::{Job, Problem, Trouble, Values};

/// Problems and parameters that a user requests.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// IDs or beginnings of IDs, such as `C6` or `B`; none means all.
    pub only: Vec<String>,
    /// Values, as `NAME=VALUE` or `ID.NAME=VALUE`.
    pub set: Vec<String>,
    /// Time integration; default: explicit.
    pub integrator: Option<Integrator>,
    /// The quick set, in its quick form.
    pub quick: bool,
}

/// A value that a user gave.
struct Change<'a> {
    id: Option<&'a str>,
    name: &'a str,
    value: f64,
}

impl Change<'_> {
    fn concerns(&self, problem: &Problem) -> bool {
        self.id.is_none_or(|id| id.eq_ignore_ascii_case(problem.id))
    }

    fn fits(&self, problem: &Problem) -> bool {
        self.concerns(problem) && problem.parameters.iter().any(|p| p.name == self.name)
    }
}

/// Chooses problems of `all` and sets their parameters, in the order of `all`.
///
/// A full ID means that problem alone, anything shorter all whose IDs begin with it. Without `only`, values choose the
/// problems that know all of them, and those of an ID that problem. With `only`, every chosen problem must know a value
/// that names no ID, so that no value is dropped in silence.
///
/// # Errors
/// An unknown ID with the nearest one, an unknown parameter with those there are, a value out of range, an integrator
/// that a problem named by its ID is not solved with.
pub fn choose(all: &'static [Problem], request: &Request) -> Result<Vec<Job>, Trouble> {
    let mut problems = named(all, &request.only)?;
    let changes = request.set.iter().map(|text| parse(all, &problems, text)).collect::<Result<Vec<_>, _>>()?;
    if request.only.is_empty() {
        problems.retain(|p| !request.quick || p.quick);
        let (of_one, of_all): (Vec<&Change>, Vec<&Change>) = changes.iter().partition(|change| change.id.is_some());
        problems.retain(|p| of_all.iter().all(|change| change.fits(p)));
        problems.retain(|p| of_one.is_empty() || of_one.iter().any(|change| change.concerns(p)));
    }
    let integrator = request.integrator.unwrap_or(Integrator::Explicit);
    if integrator == Integrator::Implicit {
        problems = implicit(problems, &request.only)?;
    }
    if let Some(change) = changes.iter().find(|change| !problems.iter().any(|p| change.concerns(p))) {
        let id = change.id.unwrap_or_default();
        return Err(Trouble(format!("--set {id}.{}: {id} is not among the chosen problems: add it", change.name)));
    }
    if problems.is_empty() {
        return Err(Trouble("no problem fits all of the arguments: see --list".to_owned()));
    }
    problems.into_iter().map(|problem| job(problem, &changes, integrator, request.quick)).collect()
}

fn job(problem: &'static Problem, changes: &[Change], integrator: Integrator, quick: bool) -> Result<Job, Trouble> {
    let mut values = Values::of(problem);
    for change in changes.iter().filter(|change| change.concerns(problem)) {
        values.set(problem, change.name, change.value)?;
    }
    Ok(Job { problem, values, integrator, quick })
}

/// The problems that the names mean; all without a name.
fn named(all: &'static [Problem], names: &[String]) -> Result<Vec<&'static Problem>, Trouble> {
    let mut chosen = vec![names.is_empty(); all.len()];
    for name in names {
        let begins = |id: &str| id.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
        let exact = all.iter().position(|p| p.id.eq_ignore_ascii_case(name));
        let places: Vec<usize> = match exact {
            Some(place) => vec![place],
            None => (0..all.len()).filter(|&k| !name.is_empty() && begins(all[k].id)).collect(),
        };
        if places.is_empty() {
            let near = nearest(name, all.iter().map(|p| p.id)).unwrap_or_default();
            return Err(Trouble(format!("no problem {name:?}: the nearest is {near}, --list shows all")));
        }
        places.into_iter().for_each(|k| chosen[k] = true);
    }
    Ok(all.iter().zip(chosen).filter(|(_, chosen)| *chosen).map(|(p, _)| p).collect())
}

/// Those of the problems that the implicit integrator solves as well; one that is named by its full ID must be.
fn implicit(problems: Vec<&'static Problem>, names: &[String]) -> Result<Vec<&'static Problem>, Trouble> {
    let named = |p: &Problem| names.iter().any(|name| name.eq_ignore_ascii_case(p.id));
    if let Some(not) = problems.iter().find(|p| !p.implicit && named(p)) {
        return Err(Trouble(format!(
            "{}: not solved with the implicit integrator; see --list for those that are",
            not.id
        )));
    }
    Ok(problems.into_iter().filter(|p| p.implicit).collect())
}

/// Reads `NAME=VALUE` or `ID.NAME=VALUE`; one of the chosen problems, or the one of the ID, must know the name.
fn parse<'a>(all: &'static [Problem], chosen: &[&'static Problem], text: &'a str) -> Result<Change<'a>, Trouble> {
    let trouble = |message: String| Trouble(format!("--set {text}: {message}"));
    let parts = text.split_once('=').ok_or_else(|| trouble("must be NAME=VALUE or ID.NAME=VALUE".to_owned()))?;
    let number = parts.1.trim();
    let value: f64 = number.parse().map_err(|_| trouble(format!("{number:?} is no number: write such as 0.5")))?;
    let (id, name) = match parts.0.trim().split_once('.') {
        Some((id, name)) => (Some(id), name),
        None => (None, parts.0.trim()),
    };
    let change = Change { id, name, value };
    let of_id: Vec<&Problem> = all.iter().filter(|p| id.is_some() && change.concerns(p)).collect();
    if let Some(id) = id.filter(|_| of_id.is_empty()) {
        let near = nearest(id, all.iter().map(|p| p.id)).unwrap_or_default();
        return Err(trouble(format!("no problem {id:?}: the nearest is {near}, --list shows all")));
    }
    let asked = if id.is_some() { &of_id } else { chosen };
    if asked.iter().any(|p| change.fits(p)) {
        return Ok(change);
    }
    let mut known: Vec<&str> = Vec::new();
    for parameter in asked.iter().flat_map(|p| p.parameters) {
        if !known.contains(&parameter.name) {
            known.push(parameter.name);
        }
    }
    Err(trouble(format!("no parameter {name:?}; there are {}", list(known))))
}
