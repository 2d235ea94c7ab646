//! The pages of `enmm fos` and `enmm bound`: the slope as it fails, tables, and the failing mass marked.

use std::io;
use std::path::Path;

use enmm_report::{Axis, FILM, Fact, MOTION, Marked, Note, Trial as Row, TrialTable};

use crate::found::{Found, remedy};
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm_io::LoadedCase;
use enmm_io::files::Unfinished;
use enmm_record::film::{Film, Opening, numbers};
use enmm_stability::limit_analysis::continuum::{Bracket, Motion};
use enmm_stability::limit_analysis::{self, Bound, Way};
use enmm_stability::strength_reduction::{Begun, Reduction, Trial, Verdict};

/// Motion of the fastest block of a mechanism in its page, over the greater side of the model.
const SHOWN: f64 = 0.05;

/// Frames of a trial that failed, both ends included.
const FRAMES: u64 = 20;

/// Writes the page of a search for the factor of safety.
///
/// # Errors
/// Whatever the file system refuses, or a number that cannot be shown.
pub fn write_fos_page(directory: &Path, loaded: &LoadedCase, found: &Found) -> io::Result<()> {
    let main = found.main();
    let Reduction { simulation, begun, .. } = main;
    let first = begun.as_ref().map_or(simulation, |begun| &begun.simulation);
    let axis = match begun {
        Some(_) => Axis::time(),
        None => Axis { name: "share of the motion".to_owned(), unit: String::new() },
    };
    let (unfinished, _) = Unfinished::beside(&directory.join(FILM))?;
    let opening = Opening {
        command: "fos",
        film: unfinished.path().to_owned(),
        axis,
        numbers: numbers(first),
        elements: true,
        columns: &[],
    };
    let mut film = Film::open(directory, loaded, first, opening, None)?;
    let end = match begun {
        Some(begun) => show_trial(&mut film, begun, simulation)?,
        None => {
            film.rigid_frame(simulation, 0.0, |_| (Vector::zeros(), 0.0))?;
            film.frame_at(simulation, 1.0)?;
            1.0
        }
    };
    for (k, search) in found.searches.iter().enumerate() {
        let name = if found.searches.len() > 1 { format!(" {}", k + 1) } else { String::new() };
        film.note(0.0, &Note::Trials(trials(search, &name)))?;
        if let Some(trial) = search.first_unstable() {
            film.note(0.0, &Note::Marked(failing(search, trial, &name)))?;
        }
        note_warnings(&mut film, search.warnings.iter().chain(remedy(search).iter()))?;
    }
    let name = main.first_unstable().map_or("that fails".to_owned(), |trial| format!("at F = {:.4}", trial.factor));
    let rows = match begun {
        Some(_) => [
            ("0 s".to_owned(), format!("the slope as the trial {name} begins, at rest")),
            (format!("{end:.3} s"), "the end of that trial".to_owned()),
        ],
        None => [("0", "before gravity acts"), ("1", "the slope at rest")].map(|(a, b)| (a.to_owned(), b.to_owned())),
    };
    film.note(0.0, &facts("What the slider shows", rows))?;
    film.note_changes(first)?;
    film.close(end, "finished".to_owned())
}

/// Appends the frames of a trial that failed, whose motion is made again; returns their last time (s) since it began.
fn show_trial(film: &mut Film, begun: &Begun, ended: &Simulation) -> io::Result<f64> {
    let start = begun.simulation.time();
    let mut last = f64::NEG_INFINITY;
    begun.replay(FRAMES - 1, |simulation| {
        last = simulation.time() - start;
        film.frame_at(simulation, last)
    })?;
    // A trial that ended by a numerical failure has no motion beyond.
    let end = ended.time() - start;
    if end > last {
        film.frame_at(ended, end)?;
    }
    Ok(end.max(last))
}

/// Begins the film of a limit analysis, whose slider is the share of a motion of free size.
fn film_of_motion(
    directory: &Path,
    loaded: &LoadedCase,
    simulation: &Simulation,
    file: &Unfinished,
) -> io::Result<Film> {
    let opening = Opening {
        command: "bound",
        film: file.path().to_owned(),
        axis: Axis { name: "share of the motion".to_owned(), unit: String::new() },
        numbers: MOTION.to_vec(),
        elements: false,
        columns: &[],
    };
    Film::open(directory, loaded, simulation, opening, None)
}

/// Writes the page of a limit analysis.
///
/// # Errors
/// A case that limit analysis refuses, as a message; else as the page of a factor of safety.
pub fn write_bound_page(directory: &Path, loaded: &LoadedCase, bound: &Bound) -> io::Result<()> {
    let (simulation, _) = limit_analysis::staged(&loaded.case).map_err(|invalid| io::Error::other(invalid.message))?;
    let (unfinished, _) = Unfinished::beside(&directory.join(FILM))?;
    let mut film = film_of_motion(directory, loaded, &simulation, &unfinished)?;
    let moving = &bound.level_tops.mechanism;
    let reach = SHOWN * greater_side(&simulation);
    for share in [0.0, 1.0] {
        film.rigid_frame(&simulation, share, |block| {
            let found = moving.iter().find(|moves| moves.block as usize == block);
            let scale = share * reach;
            found.map_or((Vector::zeros(), 0.0), |moves| (moves.velocity * scale, moves.spin * scale))
        })?;
    }
    film.note(0.0, &Note::Marked(mechanism(bound)))?;
    let factor = |row: limit_analysis::Row| (row.name.to_owned(), format!("{}: {}", row.collapse.factor, row.meaning));
    film.note(0.0, &facts("Factor of safety by limit analysis", bound.rows().into_iter().map(factor)))?;
    let shown = [
        ("0", "the slope before it moves".to_owned()),
        (
            "1",
            format!("the mechanism where level tops pass; its size is free, so the fastest block moves {reach:.3} m"),
        ),
    ];
    film.note(0.0, &facts("What the slider shows", shown.map(|(name, value)| (name.to_owned(), value))))?;
    note_warnings(&mut film, bound.warnings.iter())?;
    film.note_changes(&simulation)?;
    film.close(1.0, "finished".to_owned())
}

/// Writes the page of a limit analysis of rock that yields.
///
/// # Errors
/// As [`write_bound_page`].
pub fn write_bracket_page(directory: &Path, loaded: &LoadedCase, bracket: &Bracket) -> io::Result<()> {
    let staged = limit_analysis::staged_rock(&loaded.case);
    let (mut simulation, _) = staged.map_err(|invalid| io::Error::other(invalid.message))?;
    let (unfinished, _) = Unfinished::beside(&directory.join(FILM))?;
    let mut film = film_of_motion(directory, loaded, &simulation, &unfinished)?;
    film.frame_at(&simulation, 0.0)?;
    let reach = SHOWN * greater_side(&simulation);
    move_by(&mut simulation, bracket, reach);
    film.frame_at(&simulation, 1.0)?;
    let factors = [("lower bound", bracket.lower.to_string()), ("upper bound", bracket.upper.to_string())];
    let text = |(name, value): (&str, String)| (name.to_owned(), value);
    film.note(0.0, &facts("Factor of safety by limit analysis", factors.map(text)))?;
    let shown = [
        ("0", "the slope before it moves".to_owned()),
        ("1", format!("the mechanism of the upper bound; its size is free, so the fastest rock moves {reach:.3} m")),
    ];
    film.note(0.0, &facts("What the slider shows", shown.map(text)))?;
    note_warnings(&mut film, bracket.warnings.iter())?;
    film.note_changes(&simulation)?;
    film.close(1.0, "finished".to_owned())
}

/// Moves every cover as the triangle of its block that lies nearest to it, by `reach` (m) where that is fastest.
fn move_by(simulation: &mut Simulation, bracket: &Bracket, reach: f64) {
    let mut state = simulation.state().clone();
    let covers = &simulation.model().covers;
    for block in covers.blocks() {
        let own: Vec<&Motion> = bracket.mechanism.iter().filter(|motion| motion.block == block.number()).collect();
        for cover in covers.covers_of(block) {
            let at = covers.star_position[cover];
            let away = |motion: &Motion| (motion.position - at).norm_squared();
            let nearest = own.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
            state.displacement[cover] = nearest.map_or_else(Vector::zeros, |motion| motion.velocity * reach);
        }
    }
    simulation.restore(state);
}

fn note_warnings<'a>(film: &mut Film, warnings: impl Iterator<Item = &'a String>) -> io::Result<()> {
    for text in warnings {
        film.note(0.0, &Note::Warning { text: text.clone() })?;
    }
    Ok(())
}

fn facts(title: &str, rows: impl IntoIterator<Item = (String, String)>) -> Note {
    let rows = rows.into_iter().map(|(name, value)| Fact { name, value });
    Note::Facts { title: title.to_owned(), rows: rows.collect() }
}

fn trials(search: &Reduction, name: &str) -> TrialTable {
    let bracket = match (search.low, search.high) {
        (Some(low), Some(high)) => format!(" (stable at {low:.4}, not at {high:.4})"),
        _ => String::new(),
    };
    let result = match (search.at_most(), search.factor(), search.at_least()) {
        (Some(most), ..) => format!("at most {most:.4}{bracket}"),
        (None, Some(factor), _) => format!("{factor:.4}{bracket}"),
        (None, None, Some(least)) => format!("at least {least:.4}"),
        (None, None, None) => format!("not found{bracket}"),
    };
    let bound = match (&search.bracket, &search.bound) {
        (Some(bracket), _) => {
            format!("limit analysis: lower bound {}, upper bound {}", bracket.lower, bracket.upper)
        }
        (None, Ok(bound)) => format!("limit analysis: {}", bound.summary()),
        (None, Err(refused)) => format!("limit analysis: none, {refused}"),
    };
    let mechanism = if name.is_empty() { String::new() } else { format!("mechanism{name}: ") };
    let others: String = search.others().into_iter().map(|(name, text)| format!("; {name}: {text}")).collect();
    TrialTable {
        result: format!("{mechanism}{result}{others}; {bound}"),
        trials: search.trials.iter().map(row).collect(),
    }
}

fn row(trial: &Trial) -> Row {
    Row {
        factor: trial.factor,
        verdict: trial.verdict.name().to_owned(),
        reason: trial.word(),
        time: trial.time,
        displacement: trial.displacement,
        speed: trial.speed,
        failing: trial.failing.len() as u32,
        area: trial.failing_area(),
    }
}

fn failing(search: &Reduction, trial: &Trial, name: &str) -> Marked {
    let fate = if trial.verdict == Verdict::Caught { "slides and is caught" } else { "fails" };
    let rows = [
        ("At", format!("F = {:.4}, {fate}", trial.factor)),
        ("Blocks", trial.failing.len().to_string()),
        ("Area", format!("{:.4} m²", trial.failing_area())),
        ("Mass", format!("{:.4e} kg/m", trial.failing_mass())),
        ("Share of the free rock", format!("{:.1} %", 100.0 * trial.failing_area() / search.free_area)),
    ];
    Marked {
        name: format!("Failing mass{name}"),
        blocks: trial.failing.iter().map(|block| block.block).collect(),
        rows: rows.into_iter().map(|(name, value)| Fact { name: name.to_owned(), value }).collect(),
    }
}

fn mechanism(bound: &Bound) -> Marked {
    let moving = &bound.level_tops.mechanism;
    let sum = |of: fn(&limit_analysis::MovingBlock) -> f64| moving.iter().map(of).sum::<f64>();
    let rows = [
        ("Way", bound.level_tops.way.map_or_else(|| "none".to_owned(), Way::words)),
        ("Blocks", moving.len().to_string()),
        ("Area", format!("{:.4} m²", sum(|block| block.area))),
        ("Mass", format!("{:.4e} kg/m", sum(|block| block.mass))),
    ];
    Marked {
        name: "Mechanism".to_owned(),
        blocks: moving.iter().map(|block| block.block).collect(),
        rows: rows.into_iter().map(|(name, value)| Fact { name: name.to_owned(), value }).collect(),
    }
}

/// Greater side of the box round the model (m).
fn greater_side(simulation: &Simulation) -> f64 {
    let side = |axis: usize| {
        let places = simulation.model().boundary.reference.iter().map(|point| point[axis]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        high - low
    };
    side(0).max(side(1))
}
