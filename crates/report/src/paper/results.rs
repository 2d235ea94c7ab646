//! Results: stages of a run, factor of safety, limit analysis, probability of failure.

use serde_json::Value;

use super::input::bolt_name;
use super::number::{Digits, length, mass, percent, plain, prefixed};
use super::parts::{chapter, entries, figure, part, plain_words, text};
use super::records::{Record, Records};
use super::table::{Cell, facts, paragraph, table};

use Digits::Three;

/// How F is to be read.
const CONVENTION: &str = "\
    F is the number by which the strength of the joints (cohesion, tan φ and tensile strength, peak and \
    residual) and of rock that yields is divided when the slope just stands. Weights, water, loads and \
    bolts are not divided: active bolts carry their pretension, passive ones their yield force, and \
    others what the motion of the rock brings to them, up to their yield force. All trials start from \
    one state of rest. A slope that slides and is caught by other blocks does not count as stable, but one \
    that comes to rest in small displacements as well does.";

/// Stages, histories, and bolts at the end of a run.
pub fn run_chapter(records: &Records) -> String {
    let Some(run) = &records.run else { return String::new() };
    let row = |stage: &Value| -> Vec<Cell> {
        let is_dynamic = text(&stage["kind"]) == "dynamic";
        let time = if is_dynamic { plain(&stage["time"], "s", Three).into() } else { Cell::Empty };
        let mechanism = text(&stage["failure"]["mechanism"]);
        let early = if stage["ended_early"] == Value::Bool(true) { ", ended early" } else { "" };
        let end = match stage["converged"].as_bool() {
            _ if !mechanism.is_empty() => Cell::from(format!("FAILED by {mechanism}{early}")),
            Some(true) => "at rest".into(),
            Some(false) => "NOT at rest".into(),
            None => Cell::from("end of its duration"),
        };
        vec![text(&stage["name"]).into(), text(&stage["kind"]).into(), end, time]
    };
    let rows: Vec<Vec<Cell>> = entries(&run.json["stages"]).iter().map(row).collect();
    let size = facts(&[
        ("Blocks", plain(&run.json["model"]["blocks"], "", Digits::Typed).into()),
        ("Area of rock", plain(&run.json["model"]["area"], "m²", Three).into()),
        ("Mesh size", length(&run.json["model"]["mesh_size"], Three).into()),
    ]);
    let stages = table(&["Stage", "Kind", "Ended", "Time"], &rows);
    let bolts = bolts(&run.json["bolts"], run);
    let histories = figure(run, "history", "Monitors, bolts and motion of the base over the stages.");
    let content = [
        part("Stages as they went", &stages),
        size,
        part("Bolts at the end of the run", &bolts),
        part("Monitors at the end of the run", &monitors(&run.json)),
        part("Blocks that broke", &breaks(&run.json["breaks"])),
        part("Blocks nearest to breaking at the end of the run", &worst_sections(&run.json["worst_sections"])),
        part("Histories", &histories),
        part("Ends of the stages", &stage_figures(run)),
    ];
    chapter("Run of the stages", &content.concat())
}

/// Monitors of points and of joints.
fn monitors(run: &Value) -> String {
    let pascal = |value: &Value| -> Cell { prefixed(value, "Pa", Three).into() };
    let point = |monitor: &Value| {
        let moved = [0, 1].map(|k| length(&monitor["displacement"][k], Three).into());
        let stress = [0, 1, 2].map(|k| pascal(&monitor["stress"][k]));
        [vec![text(&monitor["name"]).into()], moved.into(), stress.into()].concat()
    };
    let joint = |monitor: &Value| {
        let apart = ["opening", "slip"].map(|key| length(&monitor[key], Three).into());
        let stress = ["normal_stress", "shear_stress"].map(|key| pascal(&monitor[key]));
        [vec![text(&monitor["name"]).into()], apart.into(), stress.into()].concat()
    };
    let points: Vec<Vec<Cell>> = entries(&run["monitors"]).iter().map(point).collect();
    let joints: Vec<Vec<Cell>> = entries(&run["joint_monitors"]).iter().map(joint).collect();
    let since = match text(&run["since"]) {
        "" => String::new(),
        since => paragraph(&format!("Displacements, openings and slips count from the end of the stage {since}.")),
    };
    let moved = ["Monitor", "Displacement x", "y", "Stress xx", "yy", "xy"];
    let apart = ["Monitor of a joint", "Opening", "Slip", "Normal stress", "Shear stress"];
    let tables = table(&moved, &points) + &table(&apart, &joints);
    if tables.is_empty() { tables } else { since + &tables }
}

/// Blocks that broke, in the order of time.
fn breaks(records: &Value) -> String {
    let row = |broken: &Value| {
        let parts =
            vec![plain(&broken["block"], "", Digits::Typed).into(), plain(&broken["part"], "", Digits::Typed).into()];
        [vec![plain(&broken["time"], "s", Three).into()], parts, section(broken)].concat()
    };
    let rows: Vec<Vec<Cell>> = entries(records).iter().map(row).collect();
    table(&[&["Time", "Block", "New part"][..], &SECTION].concat(), &rows)
}

/// Blocks nearest to breaking, the worst first.
fn worst_sections(records: &Value) -> String {
    let row = |of: &Value| [vec![plain(&of["block"], "", Digits::Typed).into()], section(of)].concat();
    let rows: Vec<Vec<Cell>> = entries(records).iter().map(row).collect();
    table(&[&["Block"][..], &SECTION].concat(), &rows)
}

/// Columns of a section of rock.
const SECTION: [&str; 7] = ["From (m)", "To (m)", "Breaks by", "Share of strength", "N, tension positive", "V", "M"];

fn section(of: &Value) -> Vec<Cell> {
    let end = |k: usize| {
        let along = |axis: usize| plain(&of["ends"][k][axis], "", Three);
        let both = along(0).zip(along(1));
        both.map_or(Cell::Empty, |(x, y)| Cell::Mixed(vec![(String::new(), x), (", ".to_owned(), y)]))
    };
    let by = match text(&of["failure"]) {
        "bends" => "bending",
        "slides" => "shear",
        "splits" => "its core",
        _ => "tension",
    };
    let forces = [("normal", "N/m"), ("shear", "N/m"), ("moment", "N")];
    let forces = forces.map(|(key, unit)| prefixed(&of[key], unit, Three).into());
    let share = plain(&of["share"], "", Three).into();
    [end(0), end(1), by.into(), share].into_iter().chain(forces).collect()
}

/// Joints whose slip the first page has.
const JOINTS: usize = 5;

/// Where each dynamic stage has left the rock: permanent displacement, slip by joint, monitors.
pub fn permanent_motions(run: &Value) -> String {
    entries(&run["permanent"]).iter().map(permanent_motion).collect()
}

fn permanent_motion(motion: &Value) -> String {
    let at = |place: &Value| {
        let of = |k: usize| plain(&place[k], "", Three);
        of(0).zip(of(1)).map_or(Cell::Empty, |(x, y)| Cell::Mixed(vec![("x ".to_owned(), x), (", y ".to_owned(), y)]))
    };
    let joint =
        |slip: &Value| vec![text(&slip["joint"]).into(), length(&slip["slip"], Three).into(), at(&slip["place"])];
    let joints: Vec<Vec<Cell>> = entries(&motion["joints"]).iter().take(JOINTS).map(joint).collect();
    let monitor = |monitor: &Value| {
        let along = |k: usize| length(&monitor["displacement"][k], Three).into();
        vec![text(&monitor["name"]).into(), along(0), along(1)]
    };
    let monitors: Vec<Vec<Cell>> = entries(&motion["monitors"]).iter().map(monitor).collect();
    let most = [
        ("Permanent displacement, largest", length(&motion["displacement"], Three).into()),
        ("of block", plain(&motion["block"], "", Digits::Typed).into()),
        ("at (m)", at(&motion["place"])),
    ];
    let content = [
        facts(&most),
        table(&["Joint", "Largest slip", "at (m)"], &joints),
        table(&["Monitor", "Permanent displacement x", "y"], &monitors),
    ];
    part(&format!("After the stage {}, since its start", text(&motion["stage"])), &content.concat())
}

/// The stage after which a factor holds: that of the record, or the last static one before the first dynamic one.
pub fn stage_of_factor(record: &Value) -> Cell {
    let named = text(&record["stage"]);
    let statics = entries(&record["input"]["stages"]).iter().take_while(|stage| text(&stage["kind"]) == "static");
    let last = statics.last().map_or("", |stage| text(&stage["name"]));
    match (named, last) {
        ("", "") => "not recorded".into(),
        ("", last) => last.into(),
        (named, _) => named.into(),
    }
}

/// Pictures of the ends of the stages.
fn stage_figures(run: &Record) -> String {
    let kinds = [
        ("displacement_contours", "displacement since the start of the stage"),
        ("joints", "joints that lock, slip and are open"),
        ("mean_stress_contours", "mean stress"),
        ("strength", "share of strength of the worst section of each block"),
        ("flow", "pressure head of the water in joints, and its flow"),
        ("lines", "displacement across and along lines at the ends of the stages so far"),
    ];
    let of_stage = |(k, stage): (usize, &Value)| {
        let name = text(&stage["name"]);
        let picture = |(kind, what): &(&str, &str)| {
            figure(run, &format!("stage{}_{kind}", k + 1), &format!("Stage {}, {name}: {what}.", k + 1))
        };
        kinds.iter().map(picture).collect::<String>()
    };
    entries(&run.json["stages"]).iter().enumerate().map(of_stage).collect()
}

/// Bolts one by one: the largest tension along each, in percent of its yield force.
fn bolts(records: &Value, of: &Record) -> String {
    let designed = entries(&of.json["input"]["bolts"]);
    let row = |(k, bolt): (usize, &Value)| -> Option<Vec<Cell>> {
        let own = entries(records).iter().filter(|record| record["bolt"].as_u64() == Some(k as u64));
        let force = |record: &&Value| record["force"].as_f64().unwrap_or_default();
        let largest = own.max_by(|a, b| force(a).total_cmp(&force(b)))?;
        let state = match text(&largest["state"]) {
            "absent" => "not installed",
            "yielded" => "yields",
            state => state,
        };
        Some(vec![
            bolt_name(bolt, k),
            prefixed(&largest["force"], "N", Three).into(),
            prefixed(&bolt["yield_force"], "N", Digits::Typed).into(),
            percent(&largest["utilisation"]).into(),
            state.into(),
        ])
    };
    let rows: Vec<Vec<Cell>> = designed.iter().enumerate().filter_map(row).collect();
    table(&["Bolt", "Largest tension of a bar", "Yield force", "Tension over yield force", "State"], &rows)
}

/// The factor of safety, or the bound on it that was found.
pub fn factor_cell(json: &Value) -> Cell {
    let found = plain(&json["factor_of_safety"], "", Three).map(Cell::from);
    let side = |key: &str, word: &str| {
        plain(&json[key], "", Three).map(|number| Cell::Mixed(vec![(format!("{word} "), number)]))
    };
    let most = side("at_most", "at most");
    most.or(found).or(side("at_least", "at least")).unwrap_or_else(|| "not found".into())
}

/// A factor of limit analysis with the side on which it lies.
fn side(factor: &Value) -> Cell {
    let Some(limit) = plain(&factor["limit"], "", Three) else { return Cell::Empty };
    let before = match text(&factor["end"]) {
        "at_least" => "at least ",
        "at_most" => "at most ",
        _ => "",
    };
    Cell::Mixed(vec![(before.to_owned(), limit)])
}

/// The factor of limit analysis that bounds that of strength reduction, or why there is none.
pub fn limit_factor(bound: &Value) -> Cell {
    let refused = text(&bound["refused"]);
    match (side(&bound["level_tops"]), side(&bound["lower"]), side(&bound["upper"])) {
        _ if !refused.is_empty() => Cell::from(format!("none: {}", plain_words(refused))),
        (Cell::Empty, Cell::Mixed(mut lower), Cell::Mixed(upper)) => {
            lower.extend(upper.into_iter().map(|(before, number)| (format!(" to {before}"), number)));
            Cell::Mixed(lower)
        }
        (level, ..) => level,
    }
}

/// The way in which the mechanism of a bound moves.
fn way(bound: &Value) -> Cell {
    text(&bound["level_tops"]["way"]).into()
}

/// F with its convention, what fails, trials, bolts.
pub fn factor_chapter(records: &Records) -> String {
    let Some(fos) = &records.fos else { return String::new() };
    let json = &fos.json;
    let (failing, bracket) = (&json["failing"], &json["bracket"]);
    let fate = match text(&failing["verdict"]) {
        "caught" => "slides and is caught".into(),
        "unstable" => "goes on moving".into(),
        _ => Cell::Empty,
    };
    let rows = [
        ("Factor of safety F", factor_cell(json)),
        ("After the stage", stage_of_factor(json)),
        ("Greatest F at which the slope stands", plain(&bracket["stable"], "", Digits::Typed).into()),
        ("Least F at which it does not", plain(&bracket["unstable"], "", Digits::Typed).into()),
        ("F where corners hold", plain(&json["factor_corners_hold"], "", Digits::Typed).into()),
        ("F beyond which it is lost", plain(&json["factor_lost"], "", Digits::Typed).into()),
        ("F before nudges", plain(&json["factor_before_nudges"], "", Digits::Typed).into()),
        ("Upper bound by limit analysis", limit_factor(&json["bound"])),
        ("Its mechanism", way(&json["bound"])),
        ("The same, joints that open bare", side(&json["bound"]["bare"])),
        ("Estimate for joints that do not dilate by friction", side(&json["bound"]["estimate"])),
        ("Blocks that fail", plain(&failing["blocks"], "", Digits::Typed).into()),
        ("What they do", fate),
        ("Area that fails", plain(&failing["area"], "m²", Three).into()),
        ("Mass that fails", mass(&failing["mass"]).into()),
        ("Share of the free rock", percent(&failing["share"]).into()),
    ];
    let content = [
        paragraph(CONVENTION),
        facts(&rows),
        figure(fos, "failure", "Rock that fails at the least F at which the slope does not stand."),
        part("Other ways to fail", &mechanisms(json)),
        part("Bolts as the rock fails", &bolts(&json["bolts"], fos)),
        part("Trials", &(figure(fos, "fos", "Largest displacement of each trial.") + &trials(json))),
    ];
    chapter("Factor of safety", &content.concat())
}

/// All mechanisms, where more than one was found.
fn mechanisms(json: &Value) -> String {
    let all = entries(&json["mechanisms"]);
    let row = |(k, search): (usize, &Value)| -> Vec<Cell> {
        let failing = &search["failing"];
        vec![
            Cell::from(format!("{}", k + 1)),
            factor_cell(search),
            plain(&failing["blocks"], "", Digits::Typed).into(),
            plain(&failing["area"], "m²", Three).into(),
            mass(&failing["mass"]).into(),
            if search["counts"] == Value::Bool(false) { "too small to count".into() } else { Cell::Empty },
        ]
    };
    let rows: Vec<Vec<Cell>> = all.iter().enumerate().map(row).collect();
    let head = ["Mechanism", "F", "Blocks", "Area", "Mass", "Remark"];
    if rows.len() > 1 { table(&head, &rows) } else { String::new() }
}

fn trials(json: &Value) -> String {
    let row = |trial: &Value| -> Vec<Cell> {
        vec![
            plain(&trial["factor"], "", Digits::Typed).into(),
            text(&trial["verdict"]).into(),
            length(&trial["displacement"], Three).into(),
            plain(&trial["failing_blocks"], "", Digits::Typed).into(),
            plain(&trial["failing_area"], "m²", Three).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&json["trials"]).iter().map(row).collect();
    table(&["F", "Verdict", "Largest displacement", "Blocks that fail", "Area that fails"], &rows)
}

/// Limit analysis of its own.
pub fn bound_chapter(records: &Records) -> String {
    let Some(record) = &records.bound else { return String::new() };
    let bound = &record.json["bound"];
    let rows = [
        ("Upper bound by limit analysis", side(&bound["level_tops"])),
        ("Its mechanism", way(bound)),
        ("After the stage", stage_of_factor(&record.json)),
        ("Upper bound if joints dilate by their friction angle", side(&bound["associated"])),
        ("The same, joints that open bare", side(&bound["bare"])),
        ("Estimate for joints that do not dilate by friction", side(&bound["estimate"])),
        ("Upper bound if every corner holds", side(&bound["catching"])),
        ("Lower bound", side(&bound["lower"])),
        ("Upper bound", side(&bound["upper"])),
        ("Blocks", plain(&bound["blocks"], "", Digits::Typed).into()),
        ("Blocks that can move", plain(&bound["free_blocks"], "", Digits::Typed).into()),
    ];
    let note = "Limit analysis looks for forces between the blocks that hold the slope, without following its \
                motion. Its factor is a second opinion and an upper bound: the factor of safety should not lie above \
                it, and may lie far below where blocks turn or cross each other. Joints that open bear no cohesion, \
                and joints that dilate less bear less: the bound with bare joints and the estimate show how much.";
    chapter("Limit analysis", &(paragraph(note) + &facts(&rows)))
}

/// P_f with its interval, and the random values.
pub fn probability_chapter(records: &Records) -> String {
    let Some(record) = &records.ensemble else { return String::new() };
    let json = &record.json;
    let interval = percent(&json["interval"][0]).zip(percent(&json["interval"][1]));
    let interval =
        interval.map_or(Cell::Empty, |(low, high)| Cell::Mixed(vec![(String::new(), low), (" to ".to_owned(), high)]));
    let beta = plain(&json["beta"], "", Three).map_or(Cell::Empty, Cell::from);
    let by = match text(&json["ensemble"]["output"]) {
        "factor_of_safety" => "strength reduction of each sample",
        "failure" => "limit analysis, and strength reduction where that leaves it open",
        _ => "limit analysis of each sample",
    };
    let rows = [
        ("Probability of failure P_f", percent(&json["probability_of_failure"]).into()),
        ("Interval of confidence", interval),
        ("Its confidence", percent(&json["confidence"]).into()),
        ("Reliability index β", beta),
        ("Samples", plain(&json["samples"], "", Digits::Typed).into()),
        ("Samples that fail", plain(&json["failures"], "", Digits::Typed).into()),
        ("A sample fails below", plain(&json["ensemble"]["limit"], "", Digits::Typed).into()),
        ("Factor by", by.into()),
        ("Mean factor", plain(&json["mean"], "", Three).into()),
        ("Standard deviation", plain(&json["standard_deviation"], "", Three).into()),
        ("Seed", plain(&json["ensemble"]["seed"], "", Digits::Typed).into()),
    ];
    let picture =
        figure(record, "ensemble", "Factors of all samples, the share below each, and a fitted distribution.");
    let content = [facts(&rows), picture, part("Random values", &random(json))];
    chapter("Probability of failure", &content.concat())
}

fn random(json: &Value) -> String {
    let row = |value: &Value| -> Vec<Cell> {
        let key = text(&value["key"]);
        let number = |name: &str| plain(&value[name], "", Digits::Typed);
        vec![
            key.into(),
            text(&value["distribution"]).into(),
            number("mean").into(),
            number("sd").into(),
            number("least").or(number("low")).into(),
            number("mode").into(),
            number("most").or(number("high")).into(),
            plain(&json["rank_correlation"][key], "", Three).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&json["random"]).iter().map(row).collect();
    let head = [
        "Value",
        "Distribution",
        "Mean",
        "Standard deviation",
        "Least",
        "Most frequent",
        "Greatest",
        "Rank correlation with F",
    ];
    table(&head, &rows)
}
