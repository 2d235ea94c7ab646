//! Appends to a film while a run goes on.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use enmm_io::files::{Unfinished, open_result, remove_if_there};

use crate::block::{self, Outlined, Shape};
use crate::chunk::{self, Chunk, Chunks, Kind, MAGIC};
use crate::data::{Elements, Frame, Head, Note, Outline};
use crate::elements::Before;
use crate::error::{FilmError, expect, finite};
use crate::number::{Width, push_planes};

/// Rows that are gathered before they are written, unless a frame comes first.
const ROWS: usize = 256;

/// A film that grows. Every chunk reaches the file system as soon as it is complete.
#[derive(Debug)]
pub struct FilmWriter {
    path: PathBuf,
    file: File,
    shape: Shape,
    /// Name of each column, and whether it may be without values.
    columns: Vec<(String, bool)>,
    monitors: usize,
    bolts: usize,
    rows: Vec<Vec<f64>>,
    /// Stage of the last frame.
    stage: Option<u32>,
    /// Numbers of all blocks in the last frame, as a reader has them.
    numbers: Vec<Vec<f32>>,
    held: Option<Held>,
}

/// Chunks that are kept back, with the stage of the film before them.
#[derive(Debug)]
struct Held {
    bytes: Vec<u8>,
    /// Number of the rows that were gathered before.
    before: usize,
    /// These rows, once a chunk that is kept back has them.
    rows: Option<Vec<Vec<f64>>>,
    stage: Option<u32>,
    /// Outlines before, once others are kept back.
    shape: Option<Shape>,
    /// Numbers of elements before, once others of the same outlines are kept back.
    elements: Option<Before>,
}

impl FilmWriter {
    /// Begins a film; one that is there is replaced.
    ///
    /// # Errors
    /// A number that is not finite, or what the file system refuses.
    pub fn create(path: &Path, head: &Head, outlines: &[Outline]) -> Result<Self, FilmError> {
        let (bytes, shape) = checked(head, outlines)?;
        // A link of that name is replaced and not followed.
        let made = remove_if_there(path).and_then(|()| File::create_new(path));
        let mut file = made.map_err(FilmError::at(path))?;
        file.write_all(&MAGIC).map_err(FilmError::at(path))?;
        let mut film = Self::of(path, file, shape, head);
        film.append(Kind::Head, 0.0, &json(head, path)?)?;
        film.append_outlines(0.0, &bytes)?;
        Ok(film)
    }

    /// Continues a film: frames, rows and notes later than `until` (s) and a torn end leave it. A missing one is begun.
    ///
    /// # Errors
    /// A file that is no film, else as [`FilmWriter::create`].
    pub fn resume(path: &Path, head: &Head, outlines: &[Outline], until: f64) -> Result<Self, FilmError> {
        if !path.exists() {
            return Self::create(path, head, outlines);
        }
        let (_, shape) = checked(head, outlines)?;
        let (file, stage) = shorten(path, until)?;
        Ok(Self { stage, ..Self::of(path, file, shape, head) })
    }

    fn of(path: &Path, file: File, shape: Shape, head: &Head) -> Self {
        let columns = head.columns.iter().map(|column| (column.name.clone(), column.gaps)).collect();
        let (monitors, bolts) = (head.monitors.len(), head.bolts.len());
        let (rows, numbers) = (Vec::new(), Vec::new());
        Self { path: path.to_owned(), file, shape, columns, monitors, bolts, rows, stage: None, numbers, held: None }
    }

    /// Appends a frame, behind the rows that were gathered before.
    ///
    /// # Errors
    /// A list of the wrong length, a number that is not finite, or what the file system refuses.
    pub fn frame(&mut self, frame: &Frame) -> Result<(), FilmError> {
        // Supports change with the stage alone.
        let begins = self.stage != Some(frame.stage);
        let (bytes, numbers) = self.shape.frame(frame, [self.monitors, self.bolts], begins)?;
        self.flush()?;
        self.append(Kind::Frame, frame.time, &bytes)?;
        (self.stage, self.numbers) = (Some(frame.stage), numbers);
        Ok(())
    }

    /// Appends the numbers of elements and joints at the time (s) of the last frame.
    ///
    /// # Errors
    /// As [`FilmWriter::frame`]; also outlines without elements, and a film without a frame.
    pub fn elements(&mut self, time: f64, elements: &Elements) -> Result<(), FilmError> {
        expect("frames before elements", usize::from(!self.numbers.is_empty()), 1)?;
        expect("meshes of elements", usize::from(self.shape.mesh.is_some()), 1)?;
        let Some(mesh) = &mut self.shape.mesh else { return Ok(()) };
        if let Some(Held { shape: None, elements, .. }) = &mut self.held {
            elements.get_or_insert_with(|| mesh.remembered());
        }
        let bytes = mesh.frame(time, elements, &self.numbers)?;
        self.append(Kind::Elements, time, &bytes)
    }

    fn append_outlines(&mut self, time: f64, bytes: &Outlined) -> Result<(), FilmError> {
        self.append(Kind::Outlines, time, &bytes.blocks)?;
        bytes.mesh.as_ref().map_or(Ok(()), |mesh| self.append(Kind::Mesh, time, mesh))
    }

    /// Appends other outlines, which blocks have from a time (s) on: of frames that follow.
    ///
    /// # Errors
    /// As [`FilmWriter::create`].
    pub fn outlines(&mut self, time: f64, outlines: &[Outline]) -> Result<(), FilmError> {
        let (bytes, shape) = self.shape.changed(outlines)?;
        self.flush()?;
        self.append_outlines(time, &bytes)?;
        self.numbers.clear();
        let before = std::mem::replace(&mut self.shape, shape);
        if let Some(held) = &mut self.held {
            held.shape.get_or_insert(before);
        }
        Ok(())
    }

    /// Takes a row of the histories: one number per column, the time (s) first.
    ///
    /// # Errors
    /// As [`FilmWriter::frame`].
    pub fn row(&mut self, row: &[f64]) -> Result<(), FilmError> {
        expect("numbers of a row", row.len(), self.columns.len())?;
        let time = row.first().copied().unwrap_or_default();
        let is_gap = |value: f64, gaps: bool| gaps && value.is_nan();
        for (&value, (name, _)) in row.iter().zip(&self.columns).filter(|(value, column)| !is_gap(**value, column.1)) {
            finite(value, time, || format!("{name} of a row"))?;
        }
        self.rows.push(row.to_vec());
        if self.rows.len() < ROWS { Ok(()) } else { self.flush() }
    }

    /// Appends a note at a time (s).
    ///
    /// # Errors
    /// When the file system refuses it.
    pub fn note(&mut self, time: f64, note: &Note) -> Result<(), FilmError> {
        let bytes = json(note, &self.path)?;
        self.flush()?;
        self.append(Kind::Note, time, &bytes)
    }

    /// Keeps back what follows until [`FilmWriter::release`] writes it or [`FilmWriter::discard`] forgets it.
    pub fn hold(&mut self) {
        self.held = Some(Held {
            bytes: Vec::new(),
            before: self.rows.len(),
            rows: None,
            stage: self.stage,
            shape: None,
            elements: None,
        });
    }

    /// Bytes that are kept back.
    pub fn held(&self) -> usize {
        self.held.as_ref().map_or(0, |held| held.bytes.len())
    }

    /// Writes what has been kept back; what follows is no longer kept back.
    ///
    /// # Errors
    /// When the file system refuses it.
    pub fn release(&mut self) -> Result<(), FilmError> {
        let Some(held) = self.held.take() else { return Ok(()) };
        self.file.write_all(&held.bytes).map_err(FilmError::at(&self.path))
    }

    /// Forgets what has been kept back; what follows is no longer kept back.
    pub fn discard(&mut self) {
        let Some(held) = self.held.take() else { return };
        (self.stage, self.numbers) = (held.stage, Vec::new());
        if let Some(shape) = held.shape {
            self.shape = shape;
        }
        if let Some((mesh, before)) = self.shape.mesh.as_mut().zip(held.elements) {
            mesh.recall(before);
        }
        match held.rows {
            Some(rows) => self.rows = rows,
            None => self.rows.truncate(held.before),
        }
    }

    /// Removes frames, rows and notes later than `until` (s).
    ///
    /// # Errors
    /// As [`FilmWriter::resume`].
    pub fn cut(&mut self, until: f64) -> Result<(), FilmError> {
        self.release()?;
        self.flush()?;
        (self.file, self.stage) = shorten(&self.path, until)?;
        self.numbers.clear();
        // Elements that follow stand for themselves: those before may not be in the film.
        self.shape.mesh.iter_mut().for_each(|mesh| mesh.recall(None));
        Ok(())
    }

    /// Writes the rows that are gathered.
    ///
    /// # Errors
    /// When the file system refuses it.
    pub fn flush(&mut self) -> Result<(), FilmError> {
        let Some(time) = self.rows.last().and_then(|row| row.first()).copied() else { return Ok(()) };
        let mut bytes = Vec::new();
        [self.rows.len(), self.columns.len()].iter().for_each(|&n| bytes.extend((n as u32).to_le_bytes()));
        self.rows.iter().for_each(|row| bytes.extend(row[0].to_le_bytes()));
        for column in 1..self.columns.len() {
            let numbers: Vec<f32> = self.rows.iter().map(|row| row[column] as f32).collect();
            push_planes(&numbers, Width::Full, &mut bytes);
        }
        let mut rows = std::mem::take(&mut self.rows);
        if let Some(held) = self.held.as_mut().filter(|held| held.rows.is_none()) {
            rows.truncate(held.before);
            held.rows = Some(rows);
        }
        self.append(Kind::Rows, time, &bytes)
    }

    fn append(&mut self, kind: Kind, time: f64, body: &[u8]) -> Result<(), FilmError> {
        let written = chunk::pack(kind, time, body).and_then(|bytes| match &mut self.held {
            Some(held) => {
                held.bytes.extend(bytes);
                Ok(())
            }
            None => self.file.write_all(&bytes),
        });
        written.map_err(FilmError::at(&self.path))
    }
}

/// Bytes and shape of the outlines of a film, and whether its head is one.
fn checked(head: &Head, outlines: &[Outline]) -> Result<(Outlined, Shape), FilmError> {
    for monitor in &head.monitors {
        for value in monitor.place {
            finite(value, 0.0, || format!("place of monitor {:?}", monitor.name))?;
        }
    }
    for bolt in &head.bolts {
        for value in bolt.ends.into_iter().flatten() {
            finite(value, 0.0, || format!("ends of bolt {:?}", bolt.name))?;
        }
    }
    block::outlines(head, outlines)
}

fn json(value: &impl serde::Serialize, path: &Path) -> Result<Vec<u8>, FilmError> {
    serde_json::to_vec(value).map_err(io::Error::from).map_err(FilmError::at(path))
}

/// Takes frames, rows, notes and outlines later than a time (s) out of a film; returns its file, and the stage of its
/// last frame.
fn shorten(path: &Path, until: f64) -> Result<(File, Option<u32>), FilmError> {
    let (shortened, file) = Unfinished::beside(path).map_err(FilmError::at(path))?;
    let stage = keep(path, file, until)?;
    shortened.finish().map_err(FilmError::at(path))?;
    let file = OpenOptions::new().append(true).open(path).map_err(FilmError::at(path))?;
    Ok((file, stage))
}

/// Copies the chunks of a film up to a time (s); returns the stage of its last frame.
fn keep(from: &Path, file: File, until: f64) -> Result<Option<u32>, FilmError> {
    let no_film = |error: io::Error| FilmError::NoFilm { path: from.to_owned(), problem: error.to_string() };
    let unwritten = FilmError::at(from);
    let film = open_result(from).map_err(FilmError::at(from))?;
    let mut chunks = Chunks::new(BufReader::new(film)).map_err(no_film)?;
    let mut kept = BufWriter::new(file);
    kept.write_all(&MAGIC).map_err(&unwritten)?;
    let (mut last, mut has_outlines, mut has_mesh): (Option<Chunk>, bool, bool) = (None, false, false);
    while let Some(chunk) = chunks.next().map_err(no_film)? {
        // Those of the start, whose time is no time of the model.
        let is_first = chunk.kind == Kind::Outlines && !std::mem::replace(&mut has_outlines, true);
        let is_first_mesh = chunk.kind == Kind::Mesh && !std::mem::replace(&mut has_mesh, true);
        let begins = chunk.kind == Kind::Head || is_first || is_first_mesh;
        if begins || chunk.time <= until {
            kept.write_all(&chunk.bytes).map_err(&unwritten)?;
            if chunk.kind == Kind::Frame {
                last = Some(chunk);
            }
        } else if chunk.kind == Kind::Rows {
            let body = chunk.body().map_err(no_film)?;
            let Some((time, rows)) = rows_until(&body, until) else { continue };
            let bytes = chunk::pack(Kind::Rows, time, &rows).map_err(&unwritten)?;
            kept.write_all(&bytes).map_err(&unwritten)?;
        }
    }
    kept.flush().map_err(&unwritten)?;
    let body = last.map(|frame| frame.body()).transpose().map_err(no_film)?;
    Ok(body.and_then(|body| body.first_chunk().copied()).map(u32::from_le_bytes))
}

/// The rows up to a time (s) of a body of rows, and the time of the last of them; none when there is no such row.
fn rows_until(body: &[u8], until: f64) -> Option<(f64, Vec<u8>)> {
    let count = u32::from_le_bytes(*body.first_chunk()?) as usize;
    let (times, planes) = body.get(8..)?.split_at_checked(8 * count)?;
    let times = times.chunks_exact(8).filter_map(|bytes| bytes.first_chunk().copied().map(f64::from_le_bytes));
    let times: Vec<f64> = times.take_while(|&time| time <= until).collect();
    let mut kept = (times.len() as u32).to_le_bytes().to_vec();
    kept.extend(&body[4..8]);
    times.iter().for_each(|time| kept.extend(time.to_le_bytes()));
    planes.chunks_exact(count).for_each(|plane| kept.extend(&plane[..times.len()]));
    times.last().map(|&time| (time, kept))
}
