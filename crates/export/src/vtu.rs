//! Frames for ParaView as a run has written them (`run.pvd` and `frames/`): lines with their numbers.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use enmm_io::files::read_result;
use miniz_oxide::inflate::decompress_to_vec_zlib;
use roxmltree::{Document, Node};

use crate::bytes::Bytes;
use crate::error::ExportError;

/// Name of the collection, and of the folder of its files.
const COLLECTION: &str = "run.pvd";
const FRAMES: &str = "frames/";
/// Largest file that is read (bytes).
const FILE_MAX: u64 = 1 << 30;

/// The frames that a run has written.
#[derive(Debug, Default)]
pub struct Collection {
    folder: PathBuf,
    /// Number and time (s) of each.
    pub frames: Vec<(usize, f64)>,
    /// Paths by number of the frame and name of the part.
    files: BTreeMap<(usize, String), String>,
}

impl Collection {
    /// Reads the collection of a folder; none where the case wrote no frames.
    ///
    /// # Errors
    /// It is no collection of a run.
    pub fn read(folder: &Path) -> Result<Option<Self>, ExportError> {
        let path = folder.join(COLLECTION);
        let unreadable = |message: String| ExportError::unreadable(&path, message);
        let text = match read_result(&path, FILE_MAX) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|error| unreadable(error.to_string()))?,
        };
        let text = String::from_utf8(text).map_err(|error| unreadable(error.to_string()))?;
        let document = Document::parse(&text).map_err(|error| unreadable(error.to_string()))?;
        let mut found = Self { folder: folder.to_owned(), ..Self::default() };
        for entry in document.descendants().filter(|node| node.has_tag_name("DataSet")) {
            found.take(entry).ok_or_else(|| unreadable("an entry is no frame of a run".to_owned()))?;
        }
        Ok(Some(found).filter(|found| !found.frames.is_empty()))
    }

    fn take(&mut self, entry: Node) -> Option<()> {
        let (file, part) = (entry.attribute("file")?, entry.attribute("name")?);
        let number = file.strip_prefix(FRAMES)?.strip_prefix(part)?.strip_prefix('_')?.strip_suffix(".vtu")?;
        let (number, time) = (number.parse().ok()?, entry.attribute("timestep")?.parse().ok()?);
        if self.frames.last() != Some(&(number, time)) {
            self.frames.push((number, time));
        }
        self.files.insert((number, part.to_owned()), file.to_owned());
        Some(())
    }

    /// A part of a frame, such as its joints; none where the model has no such part.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn part(&self, number: usize, part: &str) -> Result<Option<Lines>, ExportError> {
        let Some(file) = self.files.get(&(number, part.to_owned())) else { return Ok(None) };
        let path = self.folder.join(file);
        let unreadable = |message: String| ExportError::unreadable(&path, message);
        let bytes = read_result(&path, FILE_MAX).map_err(|error| unreadable(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| unreadable(error.to_string()))?;
        let document = Document::parse(&text).map_err(|error| unreadable(error.to_string()))?;
        Lines::read(&document).map(Some).ok_or_else(|| unreadable("is no frame of a run, or damaged".to_owned()))
    }
}

/// Lines of two points, with arrays of numbers.
#[derive(Debug, Default)]
pub struct Lines {
    /// Both ends of each (m).
    pub ends: Vec<[[f64; 2]; 2]>,
    /// Numbers of each line, by name.
    numbers: BTreeMap<String, Vec<f64>>,
    /// Names that stand for numbers, by name of the array.
    names: BTreeMap<String, Vec<String>>,
}

impl Lines {
    fn read(document: &Document) -> Option<Self> {
        let mut found = Self::default();
        for array in document.descendants().filter(|node| node.has_tag_name("DataArray")) {
            let (name, components) = (array.attribute("Name")?, array.attribute("NumberOfComponents"));
            let components: usize = components.map_or(Some(1), |text| text.parse().ok())?;
            let component = |k: usize| array.attribute(format!("ComponentName{k}").as_str()).map(str::to_owned);
            match array.parent()?.tag_name().name() {
                "FieldData" => {
                    found.names.insert(name.to_owned(), (0..components).map_while(component).collect());
                }
                "Points" => {
                    let points: Vec<[f64; 2]> = values(array)?.chunks_exact(3).map(|at| [at[0], at[1]]).collect();
                    found.ends = points.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect();
                }
                "CellData" if components == 1 => {
                    found.numbers.insert(name.to_owned(), values(array)?);
                }
                _ => {}
            }
        }
        let is_whole = found.numbers.values().all(|numbers| numbers.len() == found.ends.len());
        is_whole.then_some(found)
    }

    /// A number of a line; none where lines do not have it.
    pub fn number(&self, name: &str, line: usize) -> Option<f64> {
        self.numbers.get(name)?.get(line).copied()
    }

    /// The name that a number of a line stands for: `law` has those of `law_names`.
    pub fn name(&self, name: &str, line: usize) -> Option<&str> {
        let number = self.number(name, line)? as usize;
        self.names.get(&format!("{name}_names"))?.get(number).map(String::as_str)
    }
}

/// Values of an array: base64 of the sizes of blocks, then of the blocks, which zlib has packed.
fn values(array: Node) -> Option<Vec<f64>> {
    let text = array.text().unwrap_or_default().trim();
    let decode = |text: &str| BASE64_STANDARD.decode(text).ok();
    // The number of blocks stands first, in eight bytes, which have eleven letters of base64 and one of the next.
    let blocks = Bytes(&decode(text.get(..12)?)?).word()?;
    let head = usize::try_from(blocks).ok()?.checked_add(3)?.checked_mul(8)?;
    let letters = head.div_ceil(3).checked_mul(4)?;
    let sizes = decode(text.get(..letters)?)?;
    let packed = decode(text.get(letters..)?)?;
    let (mut sizes, mut packed, mut plain) = (Bytes(sizes.get(24..)?), Bytes(&packed), Vec::new());
    for _ in 0..blocks {
        let size = usize::try_from(sizes.word()?).ok()?;
        plain.extend(decompress_to_vec_zlib(packed.take(size)?).ok()?);
    }
    let mut bytes = Bytes(&plain);
    let mut numbers = Vec::new();
    while !bytes.0.is_empty() {
        numbers.push(match array.attribute("type")? {
            "Float64" => bytes.f64()?,
            "Int64" => bytes.word()? as i64 as f64,
            "UInt8" => f64::from(bytes.take(1)?[0]),
            _ => return None,
        });
    }
    Some(numbers)
}
