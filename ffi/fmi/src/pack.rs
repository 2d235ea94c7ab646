//! An FMU: one file that holds the description, the libraries, the case and the page about them. The same case and
//! libraries give the same bytes.

use std::io::{self, Cursor, Write};
use std::path::Path;

use enmm::cosimulation::Cosimulation;
use enmm_io::{CaseError, LoadedCase};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::description::{Facts, tool};
use crate::platform::Library;
use crate::table::{Table, Version, check_blocks};
use crate::{description2, description3, page, picture, resource, terminals};

/// A packed FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Packed {
    /// The file.
    pub bytes: Vec<u8>,
    /// Number of variables, arrays as one.
    pub variables: usize,
    /// Number of blocks.
    pub blocks: usize,
    /// Warnings about the case and about the model as built.
    pub warnings: Vec<String>,
}

/// Why a case cannot be packed.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// The model of the case cannot be built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Two libraries belong in the same folder.
    #[error("two libraries are for binaries/{0}: give one library for each platform")]
    Twice(String),
    /// A block that the notes of the case name is not there.
    #[error("{0}")]
    Block(String),
    /// A part cannot be made.
    #[error("cannot make {0} of the FMU ({1})")]
    Part(&'static str, String),
}

/// Packs a case: `name` is that of its file, `libraries` those of the version, one for each platform. Their order does
/// not matter.
///
/// # Errors
/// A case whose model cannot be built; two libraries for one platform.
pub fn pack(loaded: &LoadedCase, name: &str, version: Version, libraries: &[Library]) -> Result<Packed, PackError> {
    let libraries = in_order(libraries)?;
    let model = loaded.cosimulation()?;
    let facts = Facts::of(&model, &identifier(name));
    check_blocks(model.case(), facts.blocks_max).map_err(PackError::Block)?;
    let table = Table::new(model.case(), facts.blocks_max, &loaded.hash, version);
    let files = files(loaded, name, &model, &facts, &table, &libraries)?;
    let bytes = archive(&files).map_err(|error| PackError::Part("the archive", error.to_string()))?;
    let warnings = loaded.warnings.iter().chain(model.warnings()).cloned().collect();
    Ok(Packed { bytes, variables: table.variables.len(), blocks: facts.blocks, warnings })
}

/// The libraries by the names of their folders, so that the same ones give the same file.
fn in_order(libraries: &[Library]) -> Result<Vec<&Library>, PackError> {
    let mut sorted: Vec<&Library> = libraries.iter().collect();
    sorted.sort_by(|a, b| a.folder.cmp(&b.folder));
    match sorted.windows(2).find(|pair| pair[0].folder == pair[1].folder) {
        Some(pair) => Err(PackError::Twice(pair[0].folder.clone())),
        None => Ok(sorted),
    }
}

/// A file of the archive.
struct File {
    path: String,
    bytes: Vec<u8>,
    executable: bool,
}

fn files(
    loaded: &LoadedCase,
    name: &str,
    model: &Cosimulation,
    facts: &Facts,
    table: &Table,
    libraries: &[&Library],
) -> Result<Vec<File>, PackError> {
    let file = |path: &str, bytes: Vec<u8>| File { path: path.to_owned(), bytes, executable: false };
    let failed = |part: &'static str| move |error: io::Error| PackError::Part(part, error.to_string());
    let case = resource::encode(loaded, name).map_err(|error| PackError::Part("the case", error.to_string()))?;
    let icon = picture::icon(model.simulation()).map_err(failed("the icon"))?;
    let slope = picture::slope(model.simulation()).map_err(failed("the picture"))?;
    let (description, drawing) = match table.version {
        Version::Two => (description2::model_description(table, facts), vec![file("model.png", icon)]),
        Version::Three => {
            let terminals = terminals::terminals_and_icons(table).map_err(failed("the terminals"))?;
            let folder = "terminalsAndIcons";
            let drawing =
                vec![file(&format!("{folder}/{folder}.xml"), terminals), file(&format!("{folder}/icon.png"), icon)];
            (description3::model_description(table, facts), drawing)
        }
    };
    let mut files = vec![file("modelDescription.xml", description.map_err(failed("the model description"))?)];
    files.extend(drawing);
    files.extend(libraries.iter().map(|library| File {
        path: format!("binaries/{}/{}{}", library.folder, facts.identifier, library.suffix),
        bytes: library.bytes.clone(),
        executable: true,
    }));
    files.push(file(&format!("resources/{}", resource::FILE), case));
    files.push(file("documentation/index.html", page::page(model, table, facts).into_bytes()));
    files.push(file(&format!("documentation/{}", page::PICTURE), slope));
    files.push(file("documentation/licenses/license.txt", license(facts).into_bytes()));
    files.push(file("documentation/sbom.cdx.json", PARTS.as_bytes().to_owned()));
    Ok(files)
}

fn archive(files: &[File]) -> zip::result::ZipResult<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    // The first time that the format knows: no clock is read.
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    for file in files {
        let mode = if file.executable { 0o755 } else { 0o644 };
        archive.start_file(&file.path, plain.unix_permissions(mode))?;
        archive.write_all(&file.bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// The licences of enmm and of all crates in its libraries, and the list of these, by the build script.
const LICENSES: &str = include_str!(concat!(env!("OUT_DIR"), "/LICENSES"));
const PARTS: &str = include_str!(concat!(env!("OUT_DIR"), "/sbom.cdx.json"));

fn license(facts: &Facts) -> String {
    format!(
        "The libraries in binaries/ were made by {}. Of the case in resources/ the model description says:\n\n\
         {}\n{}\n{}\n\n{LICENSES}",
        tool(),
        facts.author,
        facts.copyright,
        facts.license,
    )
}

/// Words that C keeps for itself.
const KEYWORDS: &str = " auto break case char const continue default do double else enum extern float for goto if \
                        inline int long register restrict return short signed sizeof static struct switch \
                        typedef union unsigned void volatile while ";

/// The name of a case file, without folders and extension, as a C identifier.
pub fn identifier(name: &str) -> String {
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let word: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let taken = word.is_empty() || word.starts_with(|c: char| c.is_ascii_digit());
    if taken || KEYWORDS.contains(&format!(" {word} ")) { format!("case_{word}") } else { word }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_become_identifiers() {
        let expected = [
            ("a/b/my slope.toml", "my_slope"),
            ("block_on_incline.toml", "block_on_incline"),
            ("2 blöcke.v3.toml", "case_2_bl_cke_v3"),
            ("int.toml", "case_int"),
            ("", "case_"),
        ];
        for (name, word) in expected {
            assert_eq!(identifier(name), word);
        }
    }
}
