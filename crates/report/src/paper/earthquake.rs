//! The chapter of an earthquake: records, motions of monitors, slip of joints, yield acceleration.

use serde_json::Value;

use super::number::{Digits, length, plain};
use super::parts::{chapter, entries, figure, part, text};
use super::records::{Record, Records};
use super::table::{Cell, facts, paragraph, table};

use Digits::Three;

/// How the measures are to be read.
const MEASURES: &str = "\
    PGA, PGV and PGD are the largest acceleration, velocity and displacement along an axis; displacements count from \
    the start of the stage and hold what remains. The Arias intensity is π/(2g) ∫ a² dt, and D5–95 the time in which \
    it grows from 5 to 95 %. Records are shown as they act: motions of a base as they are, waves by the motion of an \
    outcrop, which is twice the wave. Accelerations of monitors are means between rows of the history.";

/// How Newmark's displacement is to be read.
const NEWMARK: &str = "\
    The yield acceleration is the horizontal acceleration of all rock, out of the slope, at which the slope just \
    stands, over that of gravity. Newmark's block is rigid, and slides on the ground while the record exceeds it; the \
    record acts both ways round.";

/// Records, motions and slips of a run that the ground shook, and the yield acceleration of a search.
pub fn earthquake_chapter(records: &Records) -> String {
    let run = records.run.as_ref().map_or_else(String::new, shaken);
    let seismic = records.fos.as_ref().map_or_else(String::new, seismic);
    chapter("Earthquake", &(run + &part("Yield acceleration and Newmark's block", &seismic)))
}

fn shaken(run: &Record) -> String {
    let earthquakes = entries(&run.json["earthquakes"]);
    if earthquakes.is_empty() {
        return String::new();
    }
    let content = [
        paragraph(MEASURES),
        figure(run, "record", "Acceleration of the records over the time since the start of their stage."),
        part("Motions", &earthquakes.iter().map(motions).collect::<String>()),
        figure(run, "spectra", "Response spectra of records and monitors: pseudo-acceleration with 5 % of damping."),
        part("Permanent displacement", &permanent(&run.json["permanent"])),
        part("Slip by joint law", &slips(&run.json["permanent"])),
    ];
    content.concat()
}

fn motions(earthquake: &Value) -> String {
    let stages: Vec<&str> = entries(&earthquake["stages"]).iter().map(text).collect();
    let row = |motion: &Value| -> Vec<Cell> {
        let of = match text(&motion["of"]) {
            "outcrop" => format!("{}, outcrop", text(&motion["name"])),
            _ => text(&motion["name"]).to_owned(),
        };
        vec![
            of.into(),
            text(&motion["axis"]).into(),
            plain(&motion["pga"], "", Three).into(),
            plain(&motion["pga_g"], "", Three).into(),
            plain(&motion["pgv"], "", Three).into(),
            length(&motion["pgd"], Three).into(),
            plain(&motion["arias"], "", Three).into(),
            plain(&motion["duration"], "", Three).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&earthquake["motions"]).iter().map(row).collect();
    let head = ["Motion", "Axis", "PGA (m/s²)", "PGA (g)", "PGV (m/s)", "PGD", "Arias (m/s)", "D5–95 (s)"];
    let times = [
        ("Stages", stages.join(", ").into()),
        ("Time between rows of the history", plain(&earthquake["interval"], "s", Three).into()),
    ];
    facts(&times) + &table(&head, &rows)
}

fn permanent(motions: &Value) -> String {
    let row = |motion: &Value| -> Vec<Cell> {
        vec![
            text(&motion["stage"]).into(),
            length(&motion["displacement"], Three).into(),
            plain(&motion["block"], "", Digits::Typed).into(),
            place(&motion["place"]),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(motions).iter().map(row).collect();
    table(&["Stage", "Largest", "of block", "at (m)"], &rows)
}

fn slips(motions: &Value) -> String {
    let of = |motion: &Value| -> Vec<Vec<Cell>> {
        let row = |slip: &Value| {
            vec![
                text(&motion["stage"]).into(),
                text(&slip["law"]).into(),
                length(&slip["slip"], Three).into(),
                place(&slip["place"]),
            ]
        };
        entries(&motion["laws"]).iter().map(row).collect()
    };
    let rows: Vec<Vec<Cell>> = entries(motions).iter().flat_map(of).collect();
    table(&["Stage", "Joint law", "Largest slip", "at (m)"], &rows)
}

fn place(place: &Value) -> Cell {
    let of = |k: usize| plain(&place[k], "", Three);
    of(0).zip(of(1)).map_or(Cell::Empty, |(x, y)| Cell::Mixed(vec![("x ".to_owned(), x), (", y ".to_owned(), y)]))
}

fn seismic(fos: &Record) -> String {
    let seismic = &fos.json["seismic"];
    if !seismic.is_object() {
        return String::new();
    }
    let found = plain(&seismic["yield_coefficient"], "", Three);
    let least = plain(&seismic["at_least"], "", Three);
    let coefficient = match (found, least) {
        (Some(found), _) => found.into(),
        (None, Some(least)) => Cell::Mixed(vec![("at least ".to_owned(), least)]),
        (None, None) => "not found".into(),
    };
    let rows = [
        ("Yield acceleration over gravity, ky", coefficient),
        ("Greatest at which the slope stands", plain(&seismic["bracket"]["stable"], "", Digits::Typed).into()),
        ("Least at which it does not", plain(&seismic["bracket"]["unstable"], "", Digits::Typed).into()),
        ("Upper bound by limit analysis", plain(&seismic["bound"], "", Three).into()),
        ("Direction", text(&seismic["direction"]).into()),
        ("Mechanism", text(&seismic["failing"]["mechanism"]).into()),
        ("Displacement of the run", length(&seismic["run"]["displacement"], Three).into()),
    ];
    let newmark = |block: &Value| -> Vec<Cell> {
        vec![
            text(&block["record"]).into(),
            plain(&block["pga_g"], "", Three).into(),
            length(&block["displacement"], Three).into(),
            length(&block["displacement_reversed"], Three).into(),
        ]
    };
    let blocks: Vec<Vec<Cell>> = entries(&seismic["newmark"]).iter().map(newmark).collect();
    let head = ["Record", "PGA (g)", "Newmark's displacement", "The record reversed"];
    let moves = figure(fos, "seismic", "Rock that moves at the least acceleration that the slope does not bear.");
    paragraph(NEWMARK) + &facts(&rows) + &table(&head, &blocks) + &moves
}
