//! Reading of case files: TOML to [`Case`], geometry file merged, every value checked, every error with its line.

mod reader;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::case_error::{CaseError, read_record, read_text};
use super::geometry_file::{self, Fault, Format, Geometry, Trace};
use super::lines::{LineMap, beginnings};
use super::record_file::{self, Record, Wanted};
use enmm::cosimulation::Cosimulation;
use enmm::model::case::key::Key;
use enmm::model::case::record::RecordOrigin;
use enmm::model::case::{BaseMotionKind, Case, Invalid, JointTrace, Orientations, RecordKeys};

/// Largest text of a case (bytes): some 100 000 traces, which take two seconds to read. Files of geometry and records
/// are read far faster.
const CASE_BYTES_MAX: usize = 8 << 20;

/// A case that has been read and checked.
#[derive(Debug, Clone)]
pub struct LoadedCase {
    /// The case; outline and joints of the geometry file and the rows of records are part of it, and the keys of those
    /// files are empty.
    pub case: Case,
    /// The case before its dips, patterns and ratios were worked out, for those who show what was typed.
    pub typed: Case,
    /// Where each value came from.
    pub source: CaseSource,
    /// Fingerprint of `case`, 16 hexadecimal digits: equal for equal models, however their files are written.
    pub hash: String,
    /// Planes in space of joint sets and joints, which the case holds as traces.
    pub orientations: Orientations,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Values that took the place of those of the case file, as `key=value`.
    pub settings: Vec<String>,
}

impl LoadedCase {
    /// A case that has been read or changed elsewhere; `file` stands in messages.
    ///
    /// # Errors
    /// The first value that cannot be used.
    pub fn of(case: Case, file: &str) -> Result<Self, CaseError> {
        let source = CaseSource { file: file.to_owned(), ..CaseSource::default() };
        // Old names were reported where the case was read; its values may be new.
        Self::checked(case, source, Vec::new()).map(|loaded| Self { warnings: loaded.typed.doubts(), ..loaded })
    }

    fn checked(mut case: Case, mut source: CaseSource, mut warnings: Vec<String>) -> Result<Self, CaseError> {
        let typed = case.clone();
        let orientations = case.orientations();
        let told = case.expand().map_err(|invalid| source.locate(&invalid.key, &invalid.message))?;
        warnings.extend(told.notes);
        source.origins = told.origins;
        let located = |invalid: Invalid| source.locate(&invalid.key, &invalid.message);
        case.validate().map_err(located)?;
        warnings.extend(typed.doubts());
        let hash = case.fingerprint().map_err(located)?;
        warnings.extend(case.ground_motions().into_iter().flat_map(|motion| motion.warnings));
        for pond in case.ponds() {
            let told = if pond.is_slip() { &mut warnings } else { &mut case.reader_notes };
            if !told.contains(&pond.text()) {
                told.push(pond.text());
            }
        }
        let settings = source.settings.values().cloned().collect();
        Ok(Self { case, typed, source, hash, orientations, warnings, settings })
    }

    /// Builds the model of the case for a host that drives it.
    ///
    /// # Errors
    /// The first value that does not fit, with file and line.
    pub fn cosimulation(&self) -> Result<Cosimulation, CaseError> {
        Cosimulation::new(self.case.clone()).map_err(|invalid| self.source.locate(&invalid.key, &invalid.message))
    }
}

/// Where the values of a case came from.
#[derive(Debug, Clone, Default)]
pub struct CaseSource {
    file: String,
    text: String,
    lines: LineMap,
    geometry_file: String,
    geometry_lines: LineMap,
    /// Keys of the geometry file by those of the case.
    geometry: BTreeMap<String, String>,
    /// File and lines of the rows of records, by the keys of their tables.
    records: BTreeMap<String, (String, Vec<usize>)>,
    /// Keys that the user wrote, by those that came of them.
    origins: BTreeMap<String, String>,
    /// Settings by their keys.
    settings: BTreeMap<String, String>,
    /// Files that were read.
    inputs: Vec<PathBuf>,
}

impl CaseSource {
    /// Returns the case file as the user named it.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns the paths of the files that the case was read from.
    pub fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }

    /// Returns the text of the case file, with settings as comments at its end; empty when the case was not read from
    /// one.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns an error at the place where the value of `key` is written: its own line, else that of the longest
    /// beginning of the key that is known; a value from the geometry file is located there.
    pub fn locate(&self, key: &str, message: &str) -> CaseError {
        let written = beginnings(key).find_map(|part| Some((self.origins.get(part)?, &key[part.len()..])));
        let key = &written.map_or_else(|| key.to_owned(), |(origin, rest)| format!("{origin}{rest}"));
        if let Some((table, (file, lines))) = self.records.iter().find(|(table, _)| key.starts_with(table.as_str())) {
            let row = key[table.len()..].trim_start_matches('[').split(']').next().and_then(|row| row.parse().ok());
            let line = row.and_then(|row: usize| lines.get(row)).copied().unwrap_or(1);
            return CaseError::at(file, line, key, message);
        }
        let below = self.settings.iter().find(|(set, _)| beginnings(set).any(|part| part == key));
        let above = || beginnings(key).find_map(|part| self.settings.get(part));
        if let Some(setting) = below.map(|(_, setting)| setting).or_else(above) {
            return CaseError::Setting { setting: setting.clone(), message: format!("{key}: {message}") };
        }
        let of_geometry = beginnings(key).find_map(|part| Some((self.geometry.get(part)?, &key[part.len()..])));
        let (file, lines, key) = match of_geometry {
            Some((place, rest)) => {
                let rest = rest.strip_prefix(".points").unwrap_or(rest);
                (&self.geometry_file, &self.geometry_lines, format!("{place}{rest}"))
            }
            None => (&self.file, &self.lines, key.to_string()),
        };
        CaseError::at(file, lines.line(&key), &key, message)
    }

    fn note(&mut self, key: String, place: String) {
        self.geometry.insert(key, place);
    }
}

/// Reads a case file and the geometry file that it names, and checks every value.
///
/// # Errors
/// The first thing that cannot be used, with file, line and key.
pub fn load_case(path: &Path) -> Result<LoadedCase, CaseError> {
    load_case_with(path, &[] as &[&str])
}

/// Reads a case file with other values: each of `settings` is `key=value`, such as `joint_law.plane.friction_deg=30` or
/// `joint_set[0].seed=7`.
///
/// # Errors
/// See [`load_case`]; what is wrong with a setting names it.
pub fn load_case_with(path: &Path, settings: &[impl AsRef<str>]) -> Result<LoadedCase, CaseError> {
    let file = path.display().to_string();
    let text = read_text(path).map_err(|message| CaseError::Unreadable { file: file.clone(), message })?;
    let mut loaded = parse_case_with(&text, &file, path.parent().unwrap_or(Path::new("")), settings)?;
    loaded.source.inputs.push(path.to_owned());
    Ok(loaded)
}

/// Reads a case from text; `file_name` stands in messages, and `base_dir` is where relative paths start.
///
/// # Errors
/// See [`load_case`].
pub fn parse_case(text: &str, file_name: &str, base_dir: &Path) -> Result<LoadedCase, CaseError> {
    parse_case_with(text, file_name, base_dir, &[] as &[&str])
}

fn parse_case_with(
    text: &str,
    file_name: &str,
    base_dir: &Path,
    settings: &[impl AsRef<str>],
) -> Result<LoadedCase, CaseError> {
    if text.len() > CASE_BYTES_MAX {
        let message = format!(
            "the case has {} bytes, the limit is {CASE_BYTES_MAX}; move outline and traces to a \
             `domain.geometry_file`, and records to a `file`",
            text.len()
        );
        return Err(CaseError::at(file_name, 1, "", message));
    }
    let (mut case, lines, settings) = reader::read(text, file_name, settings)?;
    let file = file_name.to_string();
    let notes = settings.values().map(|setting| format!("\n# --set {}", setting.replace('\n', " ")));
    let text = notes.fold(text.to_owned(), |text, note| text + &note);
    let mut source = CaseSource { file, text, lines, settings, ..CaseSource::default() };
    let warnings = merge_geometry_file(&mut case, &mut source, base_dir)?;
    merge_record_files(&mut case, &mut source, base_dir)?;
    LoadedCase::checked(case, source, warnings)
}

/// Moves the rows of the files of base motions and waves into their tables.
fn merge_record_files(case: &mut Case, source: &mut CaseSource, base_dir: &Path) -> Result<(), CaseError> {
    for (k, base) in case.base_motions.iter_mut().enumerate() {
        let kind = Some(base.kind);
        base.kind =
            merge_record(&Key::root().field("base_motion").index(k), base.record_keys(), kind, source, base_dir)?
                .unwrap_or_default();
    }
    for (k, quiet) in case.quiets.iter_mut().enumerate() {
        let kind = quiet.kind;
        quiet.kind = merge_record(&Key::root().field("quiet").index(k), quiet.record_keys(), kind, source, base_dir)?;
    }
    Ok(())
}

/// Moves the rows of the file of a ground motion into its table; returns the quantity that its keys stand for.
fn merge_record(
    at: &Key,
    keys: RecordKeys,
    kind: Option<BaseMotionKind>,
    source: &mut CaseSource,
    base_dir: &Path,
) -> Result<Option<BaseMotionKind>, CaseError> {
    let key = |field: &str| format!("{at}.{field}");
    let mut named = keys.files.into_iter().filter_map(|(field, kind, file)| Some((field, kind, file.take()?)));
    let Some((field, of_field, file)) = named.next() else { return Ok(kind) };
    if let Some((other, ..)) = named.next() {
        let message = format!("`{field}` names a file too, only one can be; remove one of them");
        return Err(source.locate(&key(other), &message));
    }
    let path = base_dir.join(file);
    let shown = path.display().to_string();
    if keys.table.is_some() {
        let message = format!("the rows are also in {shown:?}, only one can be; remove `table` or `{field}`");
        return Err(source.locate(&key("table"), &message));
    }
    let text = read_record(&path).map_err(|message| source.locate(&key(field), &format!("{shown:?}: {message}")))?;
    let kind = of_field.or(kind);
    let reading = keys.reading.take().unwrap_or_default();
    let located = |invalid: Invalid| source.locate(&invalid.key, &invalid.message);
    reading.check(&at.field("record")).map_err(located)?;
    let wanted = Wanted { kind, reading: &reading, scale: keys.scale };
    let record = record_file::parse(&shown, &text, &wanted).map_err(|fault| match fault {
        record_file::Fault::Line(line, message) => CaseError::at(&shown, line, "", message),
        record_file::Fault::Key(name, message) => source.locate(&key(name), &message),
        record_file::Fault::File(message) => source.locate(&key(field), &format!("{shown:?} {message}")),
    })?;
    source.inputs.push(path);
    let Record { rows, lines, format, unit, time_is_stated, warnings } = record;
    *keys.table = Some(rows);
    let file = Some(shown.clone());
    *keys.origin = RecordOrigin { file, format, unit, time_is_stated, warnings, ..RecordOrigin::default() };
    source.records.insert(key("table"), (shown, lines));
    Ok(kind)
}

/// Moves all that `domain.geometry_file` holds into the case, removes the keys that say how, and returns the warnings.
fn merge_geometry_file(case: &mut Case, source: &mut CaseSource, base_dir: &Path) -> Result<Vec<String>, CaseError> {
    let located = |source: &CaseSource, invalid: Invalid| source.locate(&invalid.key, &invalid.message);
    case.validate_drawing().map_err(|invalid| located(source, invalid))?;
    let Some(name) = case.domain.geometry_file.take() else { return Ok(Vec::new()) };
    let path = base_dir.join(name);
    source.geometry_file = path.display().to_string();
    let geometry = read_geometry_file(case, source, &path)?;
    source.inputs.push(path);
    if !case.domain.outline.is_empty() && geometry.outline.is_some() {
        let message = format!("the outline is also in {:?}, only one can be; remove this one", source.geometry_file);
        return Err(source.locate("domain.outline", &message));
    }
    if geometry.water.is_some()
        && let Some(key) = case.water.as_ref().and_then(|water| {
            let given = [("water.level", water.level.is_some()), ("water.table", water.table.is_some())];
            given.into_iter().find_map(|(key, is_given)| is_given.then_some(key))
        })
    {
        let message = format!("the water table is also in {:?}, only one can be; remove it", source.geometry_file);
        return Err(source.locate(key, &message));
    }
    let named = |text: &String| format!("{}: {text}", source.geometry_file);
    let warnings = geometry.warnings.iter().map(named).collect();
    case.reader_notes.extend(geometry.notes.iter().map(named));
    case.drawing_unit = Some(named(&geometry.unit));
    merge(case, source, geometry);
    case.layers.clear();
    (case.transform, case.domain.curve_tolerance) = (None, None);
    Ok(warnings)
}

fn read_geometry_file(case: &Case, source: &CaseSource, path: &Path) -> Result<Geometry, CaseError> {
    let file = &source.geometry_file;
    let located = |message: String| source.locate("domain.geometry_file", &format!("{file:?}: {message}"));
    let format = Format::of(path).map_err(located)?;
    let text = geometry_file::text(format, path).map_err(located)?;
    geometry_file::parse(format, file, &text, case).map_err(|fault| match fault {
        Fault::File(error) => error,
        Fault::Case(invalid) => source.locate(&invalid.key, &invalid.message),
    })
}

fn merge(case: &mut Case, source: &mut CaseSource, geometry: Geometry) {
    let Geometry { outline, holes, islands, traces, water, bolts, lines, .. } = geometry;
    source.geometry_lines = lines;
    if let Some((points, place)) = outline {
        case.domain.outline = points;
        source.note("domain.outline".to_string(), place);
    }
    for (name, target, loops) in
        [("holes", &mut case.domain.holes, holes), ("islands", &mut case.domain.islands, islands)]
    {
        for (points, place) in loops {
            source.note(format!("domain.{name}[{}]", target.len()), place);
            target.push(points);
        }
    }
    for Trace { points: (points, place), law } in traces {
        let key = format!("joint[{}]", case.joints.len());
        let law = law.map(|(law, place)| {
            source.note(format!("{key}.law"), place);
            law
        });
        source.note(key, place);
        case.joints.push(JointTrace { points, law });
    }
    if let Some((points, place)) = water {
        case.put_water_table(points);
        source.note("water.table".to_string(), place);
    }
    for (name, found) in bolts {
        let points: Vec<_> = found.iter().map(|(points, _)| *points).collect();
        for (at, (_, place)) in case.put_bolts(&name, &points).into_iter().zip(found) {
            source.note(format!("bolt[{at}].points"), place);
        }
    }
}
