//! One build of `enmm edit`: from the files of the case to the view, and the bound behind it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Instant;

use enmm::model::case::Invalid;
use enmm_io::LoadedCase;
use enmm_run::{NetOptions, apparent, stereonet, write_model_page};
use enmm_stability::kinematics::Plane;
use enmm_stability::limit_analysis::Way;

use super::shown::Shown;
use crate::case::CaseArguments;

/// Name of the bound among the facts.
const BOUND: &str = "limit analysis";

/// Builds the model of a case and shows it, or the error and the model before. Returns the files that were read.
pub fn build(case: &CaseArguments, face: Option<Plane>, shown: &Shown, bounds: &BoundDesk) -> Option<Vec<PathBuf>> {
    let start = Instant::now();
    let loaded = case.load().map_err(|error| error.to_string());
    let inputs = loaded.as_ref().ok().map(|loaded| {
        let others = loaded.source.inputs().iter().filter(|input| **input != case.path).cloned();
        std::iter::once(case.path.clone()).chain(others).collect()
    });
    let told = loaded.as_ref().ok().map(|loaded| listed(&loaded.warnings, &loaded.case.reader_notes));
    match loaded.and_then(|loaded| Ok((pictured(&loaded)?, loaded))) {
        Ok((Pictured { page, facts, notes }, loaded)) => {
            let mut number = 0;
            let net = stereonet(&loaded, &NetOptions { face, ..NetOptions::default() });
            let (net, refused) = match net {
                Ok(net) => (Some((net.picture().svg(), net.findings(&net.failures()))), None),
                Err(message) => (None, Some(format!("no stereonet: {message}"))),
            };
            let seconds = start.elapsed().as_secs_f64();
            shown.change(|view| {
                view.model += 1;
                number = view.model;
                view.message = format!("{}, built in {:.0} ms", loaded.case.title, 1e3 * seconds);
                view.error = None;
                view.facts = facts;
                let findings = net.iter().flat_map(|(_, findings)| findings);
                view.facts.extend(
                    findings.filter_map(|line| {
                        line.split_once(": ").map(|(name, value)| (name.to_owned(), value.to_owned()))
                    }),
                );
                view.notes = notes;
                view.notes.extend(refused);
                view.page = Some(page);
                view.net = net.map(|(svg, _)| Arc::from(svg.into_bytes()));
            });
            let _ = bounds.asked.send((number, loaded));
        }
        Err(error) => shown.change(|view| {
            view.error = Some(error);
            view.notes = told.unwrap_or_default();
        }),
    }
    inputs
}

/// Facts of a built model.
struct Pictured {
    page: Arc<[u8]>,
    facts: Vec<(String, String)>,
    notes: Vec<String>,
}

/// The model of a case. Its page is made in a folder of the system that is gone afterwards.
fn pictured(loaded: &LoadedCase) -> Result<Pictured, String> {
    let invalid = |invalid: Invalid| loaded.source.locate(&invalid.key, &invalid.message).to_string();
    let mut simulation = enmm_implicit::build(loaded.case.clone(), &mut |_| ()).map_err(invalid)?;
    simulation.validate_stages().map_err(invalid)?;
    let page = || -> std::io::Result<Vec<u8>> {
        let folder = tempfile::tempdir()?;
        std::fs::read(write_model_page(folder.path(), loaded, &simulation)?)
    };
    let page = page().map_err(|error| format!("cannot make the page ({error})"))?;
    let (built, covers) = (simulation.built(), &simulation.model().covers);
    let fact = |name: &str, value: String| (name.to_owned(), value);
    let mut facts = vec![
        fact("blocks", covers.block_count().to_string()),
        fact("elements", covers.element_count().to_string()),
        fact("joints", loaded.case.joints.len().to_string()),
    ];
    facts.extend(loaded.orientations.planes.iter().map(|plane| fact(&plane.name, apparent(plane))));
    facts.push(fact(BOUND, "…".to_owned()));
    let warnings = [loaded.warnings.as_slice(), &built.warnings].concat();
    Ok(Pictured { page: page.into(), facts, notes: listed(&warnings, &built.notes) })
}

/// Warnings, then notes, a line each.
fn listed(warnings: &[String], notes: &[String]) -> Vec<String> {
    let warnings = warnings.iter().map(|warning| format!("warning: {warning}"));
    warnings.chain(notes.iter().map(|note| format!("note: {note}"))).collect()
}

/// Finds the bound of the latest model, beside the builds.
pub struct BoundDesk {
    asked: Sender<(u64, LoadedCase)>,
}

impl BoundDesk {
    /// Opens a desk whose answers go to a view.
    pub fn open(shown: &Arc<Shown>) -> Self {
        let (asked, questions) = channel();
        let shown = Arc::clone(shown);
        // Without a thread to spare, the view stays without a bound.
        let _ = thread::Builder::new().name("bound".to_owned()).spawn(move || answer(&questions, &shown));
        Self { asked }
    }
}

fn answer(questions: &Receiver<(u64, LoadedCase)>, shown: &Shown) {
    while let Ok(first) = questions.recv() {
        // Models that others have followed need no bound.
        let (number, loaded) = questions.try_iter().last().unwrap_or(first);
        let text = if loaded.case.yields() {
            "rock yields: see `enmm bound`".to_owned()
        } else {
            match enmm_run::bound(&loaded) {
                Ok(bound) => {
                    let way = bound.level_tops.way.map(Way::words);
                    std::iter::once(bound.summary()).chain(way).collect::<Vec<_>>().join("; ")
                }
                Err(error) => format!("none: {error}"),
            }
        };
        shown.change(|view| {
            if view.model == number {
                view.facts.iter_mut().filter(|(name, _)| name == BOUND).for_each(|(_, value)| value.clone_from(&text));
            }
        });
    }
}
