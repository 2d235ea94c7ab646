//! A packed FMU holds what the standard requires, says the same as the table, and is the same for the same case.

use std::collections::BTreeSet;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm_fmi::pack::{PackError, identifier, pack};
use enmm_fmi::platform::Library;
use enmm_fmi::table::{Axis, Causality, Quantity, Table, Type, Variable, Version};
use enmm_fmi::{library, log, resource};
use enmm_io::{LoadedCase, load_case, parse_case};
use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::Event;

const VERSIONS: [Version; 2] = [Version::Two, Version::Three];
const LIBRARY: &[u8] = b"not a library";
const CASES: [&str; 5] = [
    "ffi/fmi/tests/cases/ports.toml",
    "examples/cases/block_on_incline.toml",
    "examples/cases/goodman_bray.toml",
    "examples/cases/coupled_slope.toml",
    "ffi/capi/tests/cases/dam.toml",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn case(path: &str) -> LoadedCase {
    load_case(&root().join(path)).unwrap()
}

fn own(version: Version, bytes: &[u8]) -> [Library; 1] {
    [Library::of_this_system(version, bytes.to_vec())]
}

fn packed_alone(name: &str, version: Version, bytes: &[u8]) -> Vec<u8> {
    pack(&case(CASES[0]), name, version, &own(version, bytes)).unwrap().bytes
}

/// Table of the case and the files of its FMU.
fn packed(path: &str, version: Version) -> (Table, Vec<(String, Vec<u8>)>) {
    packed_of(&case(path), path, version)
}

fn packed_of(loaded: &LoadedCase, path: &str, version: Version) -> (Table, Vec<(String, Vec<u8>)>) {
    let packed = pack(loaded, path, version, &own(version, LIBRARY)).unwrap();
    let table = Table::new(&loaded.case, packed.blocks, &loaded.hash, version);
    assert_eq!(packed.variables, table.variables.len());
    let mut archive = zip::ZipArchive::new(Cursor::new(packed.bytes)).unwrap();
    let files = (0..archive.len()).map(|k| {
        let mut file = archive.by_index(k).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        (file.name().unwrap().into_owned(), bytes)
    });
    (table, files.collect())
}

fn part<'a>(files: &'a [(String, Vec<u8>)], path: &str) -> &'a [u8] {
    &files.iter().find(|(name, _)| name == path).unwrap_or_else(|| panic!("no {path}")).1
}

/// An element: its name, that of its parent, and its attributes.
struct Element {
    name: String,
    parent: String,
    attributes: Vec<(String, String)>,
}

impl Element {
    fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    fn is(&self, parent: &str, name: &str) -> bool {
        self.parent == parent && self.name == name
    }
}

/// All elements of a well-formed document.
fn elements(xml: &[u8]) -> Vec<Element> {
    let mut reader = Reader::from_str(std::str::from_utf8(xml).unwrap());
    let (mut found, mut open) = (Vec::new(), vec![String::new()]);
    loop {
        let event = reader.read_event().unwrap();
        let (start, empty) = match &event {
            Event::Start(start) => (start, false),
            Event::Empty(start) => (start, true),
            Event::End(_) => {
                open.pop();
                continue;
            }
            Event::Eof => break,
            _ => continue,
        };
        let name = start.name().as_ref().to_owned();
        let attribute = |attribute: quick_xml::events::attributes::Attribute| {
            let value = attribute.normalized_value(XmlVersion::Explicit1_0).unwrap().into_owned();
            (attribute.key.as_ref().to_owned(), value)
        };
        let attributes = start.attributes().map(|found| attribute(found.unwrap())).collect();
        found.push(Element { name: name.clone(), parent: open.last().unwrap().clone(), attributes });
        if !empty {
            open.push(name);
        }
    }
    assert_eq!(open, [""]);
    found
}

#[test]
fn the_description_says_what_the_table_says() {
    for (path, version) in CASES.iter().flat_map(|path| VERSIONS.map(|version| (path, version))) {
        let (table, files) = packed(path, version);
        let elements = elements(part(&files, "modelDescription.xml"));
        let two = version == Version::Two;
        let variables: Vec<&Element> = elements.iter().filter(|e| e.parent == "ModelVariables").collect();
        assert_eq!(variables.len(), table.variables.len());
        let units: BTreeSet<_> = elements.iter().filter(|e| e.name == "Unit").map(|e| e.get("name").unwrap()).collect();
        let mut of = "";
        let mut displays = BTreeSet::new();
        for element in elements.iter().filter(|e| e.name == "Unit" || e.name == "DisplayUnit") {
            match element.name.as_str() {
                "Unit" => of = element.get("name").unwrap(),
                _ => assert!(displays.insert((of, element.get("name").unwrap()))),
            }
        }
        let values: Vec<&Element> =
            if two { elements.iter().filter(|e| e.parent == "ScalarVariable").collect() } else { variables.clone() };
        for ((variable, element), value) in table.variables.iter().zip(variables).zip(values) {
            assert_eq!(element.get("name"), Some(variable.name.as_str()));
            assert_eq!(element.get("valueReference"), Some(variable.reference.to_string().as_str()));
            let number_alone = variable.kind == Type::Real && variable.unit.is_empty();
            let unit = if number_alone { "1" } else { variable.unit };
            assert_eq!(value.get("unit").unwrap_or_default(), unit, "{}", variable.name);
            assert!(unit.is_empty() || units.contains(unit), "{}", variable.name);
            let starts: Vec<f64> = value.get("start").unwrap_or_default().split_whitespace().map(number).collect();
            assert_eq!(starts, vec![variable.start.unwrap_or(0.0); starts.len()]);
            assert_eq!(value.get("nominal").map(number), variable.nominal, "{}", variable.name);
            let shown = value.get("displayUnit");
            assert!(shown.is_none_or(|shown| displays.contains(&(unit, shown))), "{}", variable.name);
            let expected = variable.start.map_or(0, |_| variable.size());
            assert_eq!(starts.len(), expected, "{}", variable.name);
            let given =
                matches!(variable.causality, Causality::Parameter | Causality::Input) && variable.kind != Type::String;
            assert_eq!(given, variable.start.is_some(), "{}", variable.name);
            assert_eq!(given && variable.kind != Type::Boolean, variable.limits.is_some(), "{}", variable.name);
            if let (Some((low, high)), Some(start)) = (variable.limits, variable.start) {
                assert!(low <= start && start <= high, "{}", variable.name);
            }
        }
        let first = &elements[0];
        assert_eq!(first.get(if two { "guid" } else { "instantiationToken" }), Some(table.token.as_str()));
        assert_eq!(first.get("modelName"), Some(case(path).case.title.as_str()));
        for (name, part) in [("author", "case"), ("copyright", "enmm"), ("license", "MIT or Apache-2.0")] {
            assert!(first.get(name).unwrap().to_lowercase().contains(&part.to_lowercase()), "{name}");
        }
        assert!(first.get("version").unwrap().ends_with(&format!("+{}", case(path).hash)));
        assert_eq!(first.get("generationDateAndTime"), Some("1980-01-01T00:00:00Z"));
        // The first case has a rock, a law and a monitor whose names are no words.
        let convention = if path == &CASES[0] { "flat" } else { "structured" };
        assert_eq!(first.get("variableNamingConvention"), Some(convention), "{path}");
    }
}

fn number(text: &str) -> f64 {
    match text {
        "true" => 1.0,
        "false" => 0.0,
        _ => text.parse().unwrap(),
    }
}

#[test]
fn the_structure_lists_exactly_the_outputs_in_order() {
    for (path, version) in CASES.iter().flat_map(|path| VERSIONS.map(|version| (path, version))) {
        let (table, files) = packed(path, version);
        let elements = elements(part(&files, "modelDescription.xml"));
        let is_output = |reference: &&u32| table.get(**reference).unwrap().causality == Causality::Output;
        let all: Vec<u32> = (0..table.variables.len() as u32).collect();
        let outputs: Vec<u32> = all.iter().filter(is_output).copied().collect();
        // FMI 2 counts variables from 1.
        let (key, offset, places) = match version {
            Version::Two => ("index", 1, [("Outputs", "Unknown"), ("InitialUnknowns", "Unknown")]),
            Version::Three => {
                ("valueReference", 0, [("ModelStructure", "Output"), ("ModelStructure", "InitialUnknown")])
            }
        };
        for (parent, name) in places {
            let listed = elements.iter().filter(|e| e.is(parent, name));
            let listed: Vec<u32> = listed.map(|e| e.get(key).unwrap().parse::<u32>().unwrap() - offset).collect();
            assert_eq!(listed, outputs, "{path} {version:?} {name}");
        }
        assert!(elements.iter().all(|e| e.get("derivative").is_none()));
        let categories = elements.iter().filter(|e| e.name == "Category").map(|e| e.get("name").unwrap());
        assert!(categories.eq(log::LOG_CATEGORIES.map(|(name, _)| name)));
    }
}

#[test]
fn fmi_3_has_one_time_and_arrays_over_all_blocks() {
    let (table, files) = packed(CASES[2], Version::Three);
    let elements = elements(part(&files, "modelDescription.xml"));
    let independent: Vec<_> = elements.iter().filter(|e| e.get("causality") == Some("independent")).collect();
    assert_eq!(independent.len(), 1);
    assert_eq!((independent[0].get("initial"), independent[0].get("start")), (None, None));
    let sizes: Vec<_> = elements.iter().filter(|e| e.name == "Dimension").map(|e| e.get("start").unwrap()).collect();
    assert_eq!(sizes, vec!["17"; table.variables.iter().filter(|v| v.length.is_some()).count()]);
    let intermediate = elements.iter().filter(|e| e.get("intermediateUpdate").is_some());
    assert!(intermediate.clone().count() > 20);
    assert!(intermediate.into_iter().all(|e| {
        e.name == "Float64" && e.get("causality") == Some("output") && e.get("variability") == Some("continuous")
    }));
    let binary: Vec<_> = elements.iter().filter(|e| e.name == "Binary").map(|e| e.get("mimeType").unwrap()).collect();
    assert_eq!(binary, ["application/x-enmm-state"]);
}

#[test]
fn every_port_is_a_terminal_with_all_its_variables() {
    let (table, files) = packed(CASES[0], Version::Three);
    let elements = elements(part(&files, "terminalsAndIcons/terminalsAndIcons.xml"));
    let terminals: Vec<_> = elements.iter().filter(|e| e.name == "Terminal").map(|e| e.get("name").unwrap()).collect();
    assert_eq!(terminals, ["crest", "face", "bed"]);
    let members: BTreeSet<_> = elements.iter().filter_map(|e| e.get("variableName")).collect();
    let of_ports: BTreeSet<_> = table.variables.iter().filter(|v| v.port.is_some()).map(|v| v.name.as_str()).collect();
    assert_eq!(members, of_ports);
    assert_eq!(elements.iter().filter(|e| e.get("memberName") == Some("pressure")).count(), 2);
    let (_, files) = packed(CASES[2], Version::Three);
    let without = self::elements(part(&files, "terminalsAndIcons/terminalsAndIcons.xml"));
    assert!(without.iter().all(|e| !e.name.starts_with("Terminal")));
}

#[test]
fn odd_names_go_through() {
    for version in VERSIONS {
        let (table, files) = packed(CASES[0], version);
        let names: Vec<&str> = table.variables.iter().map(|v| v.name.as_str()).collect();
        for name in ["rock.<\"&'ü>.density", "joint_law.<\"&'ü>.friction", "monitor.<\"&'ü>.velocity_y", "water_level"]
        {
            assert!(names.contains(&name), "{name}");
        }
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        let page = std::str::from_utf8(part(&files, "documentation/index.html")).unwrap();
        assert!(page.contains("<h1>&lt;&quot;&amp;&apos;ü&gt; &amp; co.</h1>"));
        let rows = page.matches("<tr><td><code>").count();
        let told = table.variables.iter().filter(|v| v.causality != Causality::Independent).count();
        assert_eq!(rows, told);
        assert!(!page.contains("://") && page.contains("src=\"slope.png\""));
    }
}

#[test]
fn the_files_are_those_of_the_standard() {
    for version in VERSIONS {
        let (_, files) = packed(CASES[1], version);
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        let drawn: &[&str] = match version {
            Version::Two => &["model.png"],
            Version::Three => &["terminalsAndIcons/terminalsAndIcons.xml", "terminalsAndIcons/icon.png"],
        };
        let place = library::platform(version);
        let binary = format!("binaries/{place}/block_on_incline{}", std::env::consts::DLL_SUFFIX);
        let rest = [
            binary.as_str(),
            "resources/case.json",
            "documentation/index.html",
            "documentation/slope.png",
            "documentation/licenses/license.txt",
            "documentation/sbom.cdx.json",
        ];
        let expected: Vec<&str> = ["modelDescription.xml"].iter().chain(drawn).copied().chain(rest).collect();
        assert_eq!(names, expected);
        assert_eq!(part(&files, &binary), LIBRARY);
        for (name, bytes) in files.iter().filter(|(name, _)| name.ends_with(".png")) {
            assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
        }
        let licenses = String::from_utf8(part(&files, "documentation/licenses/license.txt").to_vec()).unwrap();
        for words in ["MIT License", "Apache License", "Bitstream Vera Fonts Copyright", "mingw-w64", "\nrayon "] {
            assert!(licenses.contains(words), "{words}");
        }
        let parts: serde_json::Value = serde_json::from_slice(part(&files, "documentation/sbom.cdx.json")).unwrap();
        every_crate_is_listed_with_checksum_and_license(&parts, &licenses);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("case.json"), part(&files, "resources/case.json")).unwrap();
        let loaded = resource::load(folder.path()).unwrap();
        assert_eq!(loaded.hash, case(CASES[1]).hash);
    }
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        assert_eq!(VERSIONS.map(library::platform), ["linux64", "x86_64-linux"]);
    }
}

#[test]
fn packing_twice_gives_the_same_bytes_that_every_reader_of_archives_knows() {
    for version in VERSIONS {
        let [first, second] = [0, 1].map(|_| packed_alone("a/ports.toml", version, LIBRARY));
        assert_eq!(first, second);
        let elsewhere = packed_alone("ports.toml", version, b"another");
        assert_ne!(first, elsewhere);
        let headers: Vec<usize> = (0..first.len() - 30).filter(|&k| first[k..].starts_with(b"PK\x03\x04")).collect();
        assert!(headers.len() >= 7);
        for at in headers {
            let word = |offset: usize| u16::from_le_bytes([first[at + offset], first[at + offset + 1]]);
            let [needed, flags, method, time, date, extra] = [4, 6, 8, 10, 12, 28].map(word);
            assert!(needed <= 20 && flags & 0b1001 == 0 && [0, 8].contains(&method) && extra == 0);
            assert_eq!((time, date), (0, 0x21), "the first of January 1980");
        }
    }
}

#[test]
fn the_token_follows_the_case_and_the_version() {
    let tokens: BTreeSet<String> =
        CASES.iter().flat_map(|path| VERSIONS.map(|version| packed(path, version).0.token)).collect();
    assert_eq!(tokens.len(), 2 * CASES.len());
}

#[test]
fn a_model_that_cannot_be_built_is_an_error_of_the_case() {
    let mut wrong = case(CASES[0]).case;
    wrong.fixes[0].block = Some([50.0, 50.0]);
    let loaded = LoadedCase::of(wrong, "wrong.toml").unwrap();
    let error = pack(&loaded, "wrong.toml", Version::Three, &[]).unwrap_err();
    assert!(matches!(error, PackError::Case(_)) && error.to_string().starts_with("wrong.toml:"), "{error}");
}

#[test]
fn the_library_is_found_beside_the_program_and_the_newer_one_wins() {
    let folder = tempfile::tempdir().unwrap();
    let bin = folder.path().join("bin");
    let program = bin.join("enmm");
    let name = library::file_name();
    let error = library::find(&program).unwrap_err().to_string();
    let told = [name.as_str(), "-p enmm-fmu", &bin.display().to_string(), "deps", "lib", "cargo build --release"];
    assert!(told.iter().all(|word| error.contains(word)), "{error}");
    let places = ["lib", "bin/deps", "bin"].map(|place| folder.path().join(place).join(&name));
    for place in &places {
        std::fs::create_dir_all(place.parent().unwrap()).unwrap();
        std::fs::write(place, "x").unwrap();
        let now = std::time::SystemTime::now() + std::time::Duration::from_secs(9);
        let file = std::fs::File::options().write(true).open(place).unwrap();
        file.set_modified(if place.ends_with("bin") { now } else { std::time::UNIX_EPOCH }).unwrap();
        assert_eq!(&library::find(&program).unwrap(), place);
    }
    let [_, deps, _] = &places;
    std::fs::File::options().write(true).open(deps).unwrap().set_modified(std::time::SystemTime::now()).unwrap();
    assert_eq!(&library::find(&program).unwrap(), deps);
}

#[test]
fn the_library_of_a_package_of_python_serves_the_program_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("bin/enmm");
    let name = library::file_name().replace("enmm_fmu", "enmm");
    for place in ["lib64/python3.9/dist-packages/enmm", "lib/python3.12/site-packages/enmm"] {
        let place = folder.path().join(place);
        std::fs::create_dir_all(&place).unwrap();
        assert!(library::find(&program).is_err() || place.starts_with(folder.path().join("lib")));
        std::fs::write(place.join(&name), "x").unwrap();
        assert_eq!(library::find(&program).unwrap(), place.join(&name));
    }
}

/// Promise of the descriptions by `dependencies=""`.
#[test]
fn outputs_of_the_state_do_not_follow_inputs_before_the_next_step() {
    let loaded = case(CASES[0]);
    let mut model = loaded.cosimulation().unwrap();
    model.start().unwrap();
    for h in [0.01, 0.00337] {
        let time = model.time();
        model.do_step(time, h).unwrap();
        let seen = |model: &Cosimulation| {
            let ports: Vec<_> = (0..model.ports().len()).map(|k| model.port_state(k)).collect();
            format!("{ports:?} {:?} {:?} {:?}", model.block_states(), model.simulation().monitor(0), model.totals())
        };
        let before = seen(&model);
        model.set_gravity(Vector::new(1.0, -3.0)).unwrap();
        model.set_base_acceleration(Vector::new(2.0, 1.0)).unwrap();
        model.set_water_level(0.75).unwrap();
        model.set_strength_factor(0.5).unwrap();
        model.set_block_force(1, Vector::new(1e3, 2e3), 10.0).unwrap();
        model.set_boundary_traction(1, Vector::new(1e3, 0.0)).unwrap();
        model.set_pressure(1, 1e3).unwrap();
        model.set_pressure(2, 1e3).unwrap();
        assert_eq!(seen(&model), before);
        model.set_block_force(1, Vector::new(0.0, 0.0), 0.0).unwrap();
    }
    let table = Table::new(&loaded.case, 2, &loaded.hash, Version::Three);
    let of_state = table.variables.iter().filter(|v| v.quantity.is_of_state());
    assert!(of_state.clone().count() > 30);
    let is_read = |v: &Variable| matches!(v.causality, Causality::Output | Causality::Local);
    assert!(of_state.into_iter().all(|v| is_read(v) && v.kind != Type::Binary));
}

#[test]
fn start_values_are_those_that_the_model_starts_with() {
    for path in CASES {
        let loaded = case(path);
        let model = loaded.cosimulation().unwrap();
        let (inputs, blocks) = (model.inputs(), model.block_states().len());
        let of = |axis: Axis, vector: Vector| if axis == Axis::X { vector.x } else { vector.y };
        let block = |port: usize| model.ports()[port].block.index();
        for variable in Table::new(&loaded.case, blocks, &loaded.hash, Version::Three).variables {
            let own = match variable.quantity {
                Quantity::Gravity(axis) => of(axis, inputs.gravity),
                Quantity::BaseAcceleration(axis) => of(axis, inputs.base_acceleration),
                Quantity::WaterLevel => inputs.water_level,
                Quantity::StrengthFactor => inputs.strength_factor,
                Quantity::PortForce(port, axis) => of(axis, inputs.block_force[block(port)]),
                Quantity::PortMoment(port) => inputs.block_moment[block(port)],
                Quantity::PortTraction(port, axis) => of(axis, inputs.port_traction[port]),
                Quantity::PortPressure(port) => inputs.port_pressure[port],
                Quantity::Head(head) => inputs.head[head],
                Quantity::Rain(rain) => inputs.rain[rain],
                Quantity::Drain(drain) => f64::from(u8::from(inputs.drain[drain])),
                // They come on top of the forces of ports.
                Quantity::BlockForce(_) | Quantity::BlockMoment => 0.0,
                _ => continue,
            };
            assert_eq!(variable.start, Some(own), "{path} {}", variable.name);
        }
    }
}

#[test]
fn the_range_of_the_strength_factor_is_that_of_the_engine() {
    let loaded = case(CASES[0]);
    let mut model = loaded.cosimulation().unwrap();
    let table = Table::new(&loaded.case, 2, &loaded.hash, Version::Two);
    let factor = table.variables.iter().find(|v| v.name == "strength_factor").unwrap();
    let (low, high) = factor.limits.unwrap();
    assert!(model.set_strength_factor(low).is_ok() && model.set_strength_factor(high).is_ok());
    assert!(model.set_strength_factor(low - 1e-9).is_err() && model.set_strength_factor(high * 1.001).is_err());
}

#[test]
fn the_identifier_is_part_of_the_description() {
    assert_eq!(identifier("1 slope.toml"), "case_1_slope");
    let packed = pack(&case(CASES[1]), "1 slope.toml", Version::Two, &own(Version::Two, LIBRARY)).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(packed.bytes)).unwrap();
    let mut text = String::new();
    archive.by_name("modelDescription.xml").unwrap().read_to_string(&mut text).unwrap();
    assert!(text.contains("modelIdentifier=\"case_1_slope\""));
    assert!(archive.file_names().any(|name| name.unwrap().contains("/case_1_slope.")));
}

#[test]
fn a_case_says_whose_it_is() {
    let text = std::fs::read_to_string(root().join(CASES[1])).unwrap();
    let notes = "author = \"R. Ock <Slopes & Co>\"\ncopyright = \"(c) 2026 Slopes & Co\"\nlicense = \"CC BY 4.0\"\n";
    let loaded = |notes: &str| parse_case(&format!("{text}\n[fmu]\n{notes}"), "noted.toml", &root());
    for version in VERSIONS {
        let (table, files) = packed_of(&loaded(notes).unwrap(), "noted.toml", version);
        assert_eq!((table, files.clone()), packed_of(&loaded(notes).unwrap(), "noted.toml", version));
        let elements = elements(part(&files, "modelDescription.xml"));
        let head = |name| elements[0].get(name).unwrap();
        assert_eq!(head("author"), "Case: R. Ock <Slopes & Co>; engine: the enmm developers");
        assert!(head("copyright").starts_with("Case: (c) 2026 Slopes & Co; library: "), "{}", head("copyright"));
        assert!(head("license").starts_with("Case: CC BY 4.0; library: MIT or Apache-2.0"), "{}", head("license"));
        let terms = String::from_utf8_lossy(part(&files, "documentation/licenses/license.txt")).into_owned();
        assert!(terms.contains("Case: CC BY 4.0;"), "{terms}");
    }
    let error = loaded(&notes.replace("CC BY 4.0", " ")).unwrap_err().to_string();
    assert!(error.contains("noted.toml:") && error.contains("fmu.license: is empty"), "{error}");
}

fn every_crate_is_listed_with_checksum_and_license(list: &serde_json::Value, licenses: &str) {
    assert_eq!((&list["bomFormat"], &list["specVersion"]), (&"CycloneDX".into(), &"1.6".into()));
    let crates = list["components"].as_array().unwrap();
    assert!(crates.len() > 50);
    let lock = include_str!("../../../Cargo.lock");
    for part in crates {
        let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
        let [name, version] = ["name", "version"].map(|key| text(&part[key]));
        let checksum = text(&part["hashes"][0]["content"]);
        assert!(checksum.len() == 64 && lock.contains(&checksum), "{name} {version}");
        let owner = format!("\n{name} {version} ({})\n", text(&part["licenses"][0]["expression"]));
        assert!(licenses.contains(&owner), "{name} {version} has no licence");
    }
    assert!(crates.iter().any(|part| part["name"] == "rayon"));
    assert!(!crates.iter().any(|part| part["name"] == "serde_derive"), "macros are in no library");
}
