//! An FMU holds one library for each platform, each in its folder, and no file that is not the library of its platform.

use std::io::Cursor;
use std::path::Path;

use enmm_fmi::pack::{PackError, pack};
use enmm_fmi::platform::{Library, NotALibrary};
use enmm_fmi::table::Version;
use enmm_io::load_case;

const X86: u16 = 62;
const ARM: u16 = 183;
// Kinds and processors of ELF files.
const PROGRAM: u16 = 2;
const SHARED: u16 = 3;
const ENTRIES: &[u8] = b"\0fmi2DoStep\0fmi3DoStep\0";

fn with_entries(mut header: Vec<u8>) -> Vec<u8> {
    header.extend_from_slice(ENTRIES);
    header
}

/// The header of an ELF file without sections.
fn elf(kind: u16, machine: u16) -> Vec<u8> {
    let mut bytes = vec![0x7f, b'E', b'L', b'F', 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    [kind, machine].iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes.extend(1u32.to_le_bytes());
    bytes.resize(52, 0);
    [64u16, 56, 0, 64, 0, 0].iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    with_entries(bytes)
}

/// The headers of a 64-bit PE file without sections; `flags` of a library have 0x2000.
fn pe(machine: u16, flags: u16) -> Vec<u8> {
    let mut bytes = vec![0; 64];
    bytes[..2].copy_from_slice(b"MZ");
    bytes[60] = 64;
    bytes.extend(b"PE\0\0");
    [machine, 0, 0, 0, 0, 0, 0, 0, 112, flags, 0x20b].iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes.resize(64 + 24 + 112, 0);
    with_entries(bytes)
}

/// The header of a 64-bit Mach-O library without commands.
fn mach(processor: u32) -> Vec<u8> {
    let words = [0xfeed_facf, processor, 0, 6, 0, 0, 0, 0];
    with_entries(words.iter().flat_map(|word: &u32| word.to_le_bytes()).collect())
}

/// One Mach-O file with two others in it.
fn fat(parts: [(u32, Vec<u8>); 2]) -> Vec<u8> {
    let mut bytes: Vec<u8> = [0xcafe_babe_u32, 2].iter().flat_map(|word| word.to_be_bytes()).collect();
    let mut at = 8 + 2 * 20;
    for (processor, part) in &parts {
        let words = [*processor, 0, at, part.len() as u32, 0];
        bytes.extend(words.iter().flat_map(|word| word.to_be_bytes()));
        at += part.len() as u32;
    }
    parts.iter().for_each(|(_, part)| bytes.extend(part));
    bytes
}

const MAC_X86: u32 = 0x0100_0007;
const MAC_ARM: u32 = 0x0100_000c;

fn library(name: &str, version: Version, bytes: Vec<u8>) -> Library {
    Library::of(name, version, bytes).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refusal(name: &str, version: Version, bytes: Vec<u8>) -> String {
    Library::of(name, version, bytes).expect_err(name).to_string()
}

#[test]
fn both_names_of_a_platform_lead_to_the_folder_of_the_version() {
    let both = || fat([(MAC_X86, mach(MAC_X86)), (MAC_ARM, mach(MAC_ARM))]);
    let expected = [
        ("linux64", elf(SHARED, X86), ["linux64", "x86_64-linux"], ".so"),
        ("x86_64-linux", elf(SHARED, X86), ["linux64", "x86_64-linux"], ".so"),
        ("aarch64-linux", elf(SHARED, ARM), ["linux64", "aarch64-linux"], ".so"),
        ("win64", pe(0x8664, 0x2022), ["win64", "x86_64-windows"], ".dll"),
        ("x86_64-windows", pe(0x8664, 0x2022), ["win64", "x86_64-windows"], ".dll"),
        ("x86_64-darwin", mach(MAC_X86), ["darwin64", "x86_64-darwin"], ".dylib"),
        ("darwin64", mach(MAC_ARM), ["darwin64", "aarch64-darwin"], ".dylib"),
        ("aarch64-darwin", both(), ["darwin64", "aarch64-darwin"], ".dylib"),
        ("x86_64-darwin", both(), ["darwin64", "x86_64-darwin"], ".dylib"),
    ];
    for (name, bytes, folders, suffix) in expected {
        for (version, folder) in [Version::Two, Version::Three].into_iter().zip(folders) {
            let found = library(name, version, bytes.clone());
            assert_eq!((found.folder.as_str(), found.suffix), (folder, suffix), "{name}");
            assert_eq!(found.bytes, bytes);
        }
    }
}

#[test]
fn a_file_of_another_platform_or_kind_is_refused() {
    let three = Version::Three;
    let cases = [
        ("win64", elf(SHARED, X86), "is a library of x86_64-linux, not of win64"),
        ("linux64", pe(0x8664, 0x2022), "is a library of x86_64-windows, not of linux64"),
        ("x86_64-linux", elf(SHARED, ARM), "is a library of aarch64-linux, not of x86_64-linux"),
        ("x86_64-darwin", mach(MAC_ARM), "is a library of aarch64-darwin, not of x86_64-darwin"),
        ("linux64", elf(PROGRAM, X86), "is not a shared library (a Elf file of another kind"),
        ("win64", pe(0x8664, 0x22), "is not a shared library (a Pe file of another kind"),
        ("linux64", elf(SHARED, 8), "is not a shared library (a Elf file for Mips"),
        ("win64", b"no library at all, but text".to_vec(), "neither ELF, PE nor Mach-O"),
        ("win64", Vec::new(), "neither ELF, PE nor Mach-O"),
        ("linux64", elf(SHARED, X86)[..40].to_vec(), "its header cannot be read"),
    ];
    for (name, bytes, told) in cases {
        let error = refusal(name, three, bytes);
        assert!(error.contains(told) && error.contains("give the "), "{name}: {error}");
    }
    let error = refusal("solaris", three, elf(SHARED, X86));
    for name in ["\"solaris\"", "linux64", "win64", "darwin64", "x86_64-linux", "x86_64-windows", "aarch64-darwin"] {
        assert!(error.contains(name), "{error}");
    }
}

#[test]
fn a_library_without_the_entry_points_is_refused() {
    for (version, entry, other) in [(Version::Two, "fmi2", "fmi3"), (Version::Three, "fmi3", "fmi2")] {
        let mut bytes = elf(SHARED, X86);
        let at = bytes.windows(4).position(|part| part == entry.as_bytes()).unwrap();
        bytes[at..at + 4].copy_from_slice(other.as_bytes());
        let error = Library::of("linux64", version, bytes).unwrap_err();
        assert!(matches!(error, NotALibrary::Entry { .. }));
        assert!(error.to_string().contains("needs the library `enmm`"), "{error}");
    }
}

#[test]
fn all_libraries_are_packed_once_and_in_the_same_order() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases/block_on_incline.toml");
    let case = load_case(&path).unwrap();
    for (version, folders) in
        [(Version::Two, ["linux64", "win64"]), (Version::Three, ["x86_64-linux", "x86_64-windows"])]
    {
        let linux = library("linux64", version, elf(SHARED, X86));
        let windows = library("win64", version, pe(0x8664, 0x2022));
        let fmu = |libraries: &[Library]| pack(&case, "a.toml", version, libraries).map(|packed| packed.bytes);
        let bytes = fmu(&[windows.clone(), linux.clone()]).unwrap();
        assert_eq!(bytes, fmu(&[linux.clone(), windows.clone()]).unwrap());
        let archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        for (folder, end) in folders.iter().zip(["so", "dll"]) {
            assert!(archive.index_for_name(&format!("binaries/{folder}/a.{end}")).is_some(), "{folder}");
        }
        assert!(archive.index_for_name("documentation/licenses/license.txt").is_some());
        let twice = fmu(&[windows.clone(), windows]).unwrap_err();
        assert!(matches!(&twice, PackError::Twice(folder) if folder == folders[1]), "{twice}");
    }
}
