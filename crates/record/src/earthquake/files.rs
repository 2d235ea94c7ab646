//! Tables and pictures of earthquakes: `earthquake.csv`, `spectra.csv`, `record.png` and `spectra.png`.

use std::fs;
use std::io;
use std::path::Path;

use enmm_io::files::{at_path, write_atomic};
use enmm_picture::{Chart, ChartSeries, Series, chart_picture, history_picture};

use super::{EarthquakeRecord, MotionRecord, Place};

/// Measures of motions.
const MEASURES: &str = "earthquake.csv";
/// Response spectra.
const SPECTRA: &str = "spectra.csv";
/// Pictures of the records and of the spectra.
const PICTURES: [&str; 2] = ["record", "spectra"];
/// Columns of the measures.
const COLUMNS: [&str; 10] = [
    "stages",
    "name",
    "of",
    "axis",
    "pga [m/s2]",
    "pga [g]",
    "pgv [m/s]",
    "pgd [m]",
    "arias [m/s]",
    "duration_5_95 [s]",
];

/// Removes tables and pictures of earthquakes of an earlier run.
pub fn clear(directory: &Path) -> io::Result<()> {
    let pictures = PICTURES.iter().flat_map(|name| ["png", "svg"].map(|end| format!("{name}.{end}")));
    for name in [MEASURES, SPECTRA].map(str::to_owned).into_iter().chain(pictures) {
        let path = directory.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(at_path(&path)(error)),
            _ => {}
        }
    }
    Ok(())
}

/// Writes the tables; digits read back to the same numbers.
///
/// # Errors
/// All that the file system refuses, with the path in the message.
pub fn write(directory: &Path, earthquakes: &[EarthquakeRecord]) -> io::Result<()> {
    let of = |earthquake: &EarthquakeRecord| {
        let stages = earthquake.stages.join("; ");
        let row = |motion: &MotionRecord| {
            let MotionRecord { name, of, axis, pga, pga_g, pgv, pgd, arias, duration } = motion;
            let numbers = [pga, pga_g, pgv, pgd, arias, duration].map(|number| format!("{number:?}"));
            let texts = [stages.as_str(), name, place_name(*of), axis].map(str::to_owned);
            texts.into_iter().chain(numbers).collect::<Vec<String>>()
        };
        earthquake.motions.iter().map(row).collect::<Vec<_>>()
    };
    let head = COLUMNS.map(str::to_owned).to_vec();
    table(&directory.join(MEASURES), std::iter::once(head).chain(earthquakes.iter().flat_map(of)))?;
    let (mut head, mut columns) = (vec!["period [s]".to_owned()], Vec::new());
    for earthquake in earthquakes {
        let (periods, spectra) = earthquake.spectra();
        if columns.is_empty() {
            columns.push(periods);
        }
        head.extend(labels(earthquake, earthquakes).map(|label| format!("{label} [m/s2]")));
        columns.extend(spectra);
    }
    let cell = |value: f64| if value.is_nan() { String::new() } else { format!("{value:?}") };
    let row = |k: usize| columns.iter().map(|column| cell(column[k])).collect::<Vec<String>>();
    let count = columns.first().map_or(0, Vec::len);
    table(&directory.join(SPECTRA), std::iter::once(head).chain((0..count).map(row)))
}

/// Draws the accelerations of the records over time, and the spectra of records and monitors.
///
/// # Errors
/// As [`write`].
pub fn draw(directory: &Path, title: &str, earthquakes: &[EarthquakeRecord]) -> io::Result<()> {
    let (mut series, mut spectra) = (Vec::new(), Vec::new());
    for earthquake in earthquakes {
        let (periods, values) = earthquake.spectra();
        for ((motion, label), values) in earthquake.seismograms.iter().zip(labels(earthquake, earthquakes)).zip(values)
        {
            if motion.of != Place::Monitor {
                let points = motion.acceleration.points().iter().map(|[time, value]| (*time, *value)).collect();
                let quantity = "acceleration of the record".to_owned();
                series.push(Series { name: label.clone(), quantity, unit: "m/s²".to_owned(), points });
            }
            let points = periods.iter().zip(&values).map(|(period, value)| [*period, *value]).collect();
            spectra.push(ChartSeries { name: label, points, marks: false });
        }
    }
    history_picture(title, &series, &[]).write(directory, PICTURES[0])?;
    let chart = Chart {
        title: format!("{title}: response spectra, 5 % of damping"),
        axes: ["period [s]".to_owned(), "pseudo-acceleration [m/s²]".to_owned()],
        logarithmic: [true, false],
        series: spectra,
    };
    chart_picture(&chart).write(directory, PICTURES[1])
}

/// Names of the motions of an earthquake, with its stages where there are others.
fn labels<'a>(earthquake: &'a EarthquakeRecord, all: &[EarthquakeRecord]) -> impl Iterator<Item = String> + use<'a> {
    let before = if all.len() > 1 { format!("{}: ", earthquake.stages.join("; ")) } else { String::new() };
    earthquake.seismograms.iter().map(move |motion| before.clone() + &motion.label())
}

fn place_name(place: Place) -> &'static str {
    match place {
        Place::Monitor => "monitor",
        Place::Base => "base",
        Place::Outcrop => "outcrop",
    }
}

fn table(path: &Path, rows: impl Iterator<Item = Vec<String>>) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for row in rows {
        csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}
