//! Drawings become sections: units, layers, curves, blocks; what is not used is said, what is wrong is located.

use crate::support::{with_geometry, with_geometry_and};
use enmm_io::{LoadedCase, load_case, survey_geometry};

const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]];

fn traces(loaded: &LoadedCase) -> Vec<(Vec<[f64; 2]>, Option<&str>)> {
    loaded.case.joints.iter().map(|joint| (joint.points.clone(), joint.law.as_deref())).collect()
}

/// Notes of the reader without the name of the file.
fn notes_of(loaded: &LoadedCase) -> Vec<String> {
    let notes = &loaded.case.reader_notes;
    notes.iter().map(|note| note.split_once(".dxf: ").expect("a file").1.to_owned()).collect()
}

/// A drawing: a line on layer clean, a closed outline, an old-style closed polyline on layer faults, a text.
const DXF: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
    0\nLINE\n8\nclean\n10\n0.0\n20\n1.0\n11\n5.0\n21\n6.0\n\
    0\nLWPOLYLINE\n8\noutline\n90\n3\n70\n1\n10\n0\n20\n0\n10\n9\n20\n0\n42\n0\n10\n9\n20\n9\n\
    0\nPOLYLINE\n8\nfaults\n66\n1\n70\n1\n0\nVERTEX\n10\n1\n20\n1\n0\nVERTEX\n10\n2\n20\n1\n30\n4\n\
    0\nVERTEX\n10\n2\n20\n2\n0\nSEQEND\n\
    0\nTEXT\n10\n0\n20\n0\n40\n1\n0\nENDSEC\n0\nEOF\n";

#[test]
fn dxf_gives_lines_by_layer_and_closed_loops() {
    for text in [DXF.to_string(), DXF.replace('\n', "\r\n")] {
        let loaded = with_geometry("g.dxf", &text).unwrap();
        assert_eq!(loaded.case.domain.outline, TRIANGLE);
        let expected = [
            (vec![[0.0, 1.0], [5.0, 6.0]], Some("clean")),
            (vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 1.0]], None),
        ];
        assert_eq!(traces(&loaded), expected);
        let warning = "g.dxf: 1 traces on layer \"faults\", which is no joint law, take the default law";
        assert_eq!(loaded.warnings, [warning]);
        let notes = ["1 TEXT on layer \"0\" not used: no line", "1 points whose height is not used"];
        assert_eq!(notes_of(&loaded), notes);
    }
}

#[test]
fn dxf_layers_hole_and_island_give_loops() {
    let hole = with_geometry("g.dxf", &DXF.replace("faults", "Hole")).unwrap().case.domain;
    assert_eq!(hole.holes, [[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]]);
    let island = with_geometry("g.dxf", &DXF.replace("faults", "ISLAND")).unwrap().case.domain;
    assert_eq!(island.islands, [[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]]);
}

#[test]
fn dxf_in_other_units_is_converted_and_said() {
    let of = |unit: &str, transform: &str| {
        let loaded = with_geometry_and("g.dxf", &DXF.replace("70\n6", unit), transform).unwrap();
        (loaded.case.domain.outline[2], notes_of(&loaded)[0].clone())
    };
    let mm = of("70\n4", "");
    assert_eq!(mm, ([9.0 * 0.001; 2], "$INSUNITS is 4 (millimetres): coordinates are taken times 0.001".to_string()));
    assert_eq!(of("70\n2", "").0, [9.0 * 0.3048; 2]);
    let none = "the drawing has no unit ($INSUNITS is 0 or missing): coordinates are taken as metres; \
                `transform.scale` says otherwise";
    assert_eq!(of("70\n0", ""), ([9.0; 2], none.to_string()));
    assert_eq!(of("70\n0", "[transform]\nscale = 0.5\nflip = \"xy\"\nshift = [10, 20]").0, [5.5, 15.5]);
    let said = "$INSUNITS is 4 (millimetres), but coordinates are taken times 1 (`transform.scale`), not 0.001";
    assert_eq!(of("70\n4", "[transform]\nscale = 1"), ([9.0; 2], said.to_string()));
    let error = with_geometry("g.dxf", &DXF.replace("70\n6", "70\n77")).unwrap_err();
    assert_eq!(error, "g.dxf:8: $INSUNITS is the code of no unit, 0 to 24; add `transform.scale`");
}

#[test]
fn other_formats_are_mapped_and_refuse_layers() {
    let text = "x1,y1,x2,y2\n0,0,1000,2000\n";
    let domain = "outline = [[0, 0], [9, 0], [9, 9]]\n";
    let loaded = with_geometry_and("g.csv", text, &format!("{domain}[transform]\nscale = 1e-3\nshift = [3, 0]"));
    assert_eq!(traces(&loaded.unwrap()), [(vec![[3.0, 0.0], [4.0, 2.0]], None)]);
    let error = with_geometry_and("g.csv", text, &format!("{domain}[layers.A]\nuse = \"hole\"")).unwrap_err();
    assert_eq!(error, "case.toml:5: layers: acts on a .dxf file alone; remove it (name laws in the file)");
}

#[test]
fn dxf_that_cannot_be_used_is_located() {
    let limit = "must be a finite number of at most 1e9 m in magnitude; correct it or move the origin";
    for (from, to, message) in [
        ("10\n0.0", "10\nNaN", format!("g.dxf:20: entity[0][0]: x is NaN m, {limit}").as_str()),
        ("11\n5.0", "11\nx", "g.dxf:24: \"x\" of group 11 is no number; correct it"),
        ("11\n5.0\n", "", "g.dxf:16: LINE has no coordinate 11; the file is damaged, save it again"),
        ("0\nSEQEND\n", "", "g.dxf:50: POLYLINE without SEQEND after its vertices; the file is damaged, save it again"),
        (
            "70\n1\n10",
            "70\n0\n10",
            "g.dxf:28: entity[1]: LWPOLYLINE on layer \"outline\" is open, a loop must be closed; close it",
        ),
        ("8\nclean", "8\nHOLE", "g.dxf:16: entity[0]: LINE on layer \"HOLE\" is open, a loop must be closed; close it"),
        (
            "8\nfaults",
            "8\nOUTLINE",
            "g.dxf:50: entity[2]: is a second outline, there can be 1; move it to layer \"ISLAND\"",
        ),
        (
            "70\n1\n10",
            "70\n1\n230\n0.5\n220\n-0.5\n10",
            "g.dxf:38: LWPOLYLINE is not in the x-y plane (extrusion 0, -0.5, 0.5); draw it seen from above, or turn \
             the drawing into the x-y plane",
        ),
        (
            "0\nTEXT\n",
            "0\n3DFACE\n",
            "g.dxf:80: entity[3]: 3DFACE on layer \"0\" is of a type that is not read; explode it, or write \
             `[layers.\"0\"]` with `use = \"ignore\"`",
        ),
        ("ENTITIES", "TABLES", "g.dxf:1: no section ENTITIES, which holds the lines; save the drawing as ASCII DXF"),
        ("0\nSECTION", "x\nSECTION", "g.dxf:1: the line is no group code of DXF, a whole number; save it again"),
    ] {
        assert!(DXF.contains(from), "{from:?}");
        assert_eq!(with_geometry("g.dxf", &DXF.replacen(from, to, 1)).unwrap_err(), message);
    }
    let cut = with_geometry("g.dxf", "0\nSECTION\n2").unwrap_err();
    assert_eq!(cut, "g.dxf:3: the value of group 2 is missing; the file is cut off");
    let binary = with_geometry("g.dxf", "AutoCAD Binary DXF\r\n").unwrap_err();
    let message = "\"g.dxf\": it is a binary DXF, which is not read; save the drawing as ASCII DXF";
    assert_eq!(binary, format!("case.toml:3: domain.geometry_file: {message}"));
}

/// Entities behind those of [`DXF`], and blocks before them.
fn drawing(blocks: &str, entities: &str) -> String {
    let text = DXF.replace("0\nENDSEC\n0\nEOF", &format!("{entities}0\nENDSEC\n0\nEOF"));
    let start = "0\nSECTION\n2\nENTITIES";
    text.replace(start, &format!("0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n{start}"))
}

fn near(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    let same = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9;
    assert!(found.len() == expected.len() && found.iter().zip(expected).all(same), "{found:?} for {expected:?}");
}

/// The drawing of the key reference, without its mirror: in millimetres, with eight joints as lines, arcs, a spline, a
/// bulge and blocks within blocks.
#[test]
fn a_drawing_in_millimetres_with_curves_and_blocks_is_a_section() {
    let keys = crate::common::root().join("docs/keys");
    let text = std::fs::read_to_string(keys.join("drawing.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(keys.join("section.dxf"), folder.path().join("section.dxf")).unwrap();
    let plain = text.replace("[transform]\nscale = 0.001\nflip = \"x\"\nshift = [40.0, 0.0]\n", "");
    std::fs::write(folder.path().join("case.toml"), plain).unwrap();
    let loaded = load_case(&folder.path().join("case.toml")).unwrap();
    let case = &loaded.case;
    near(&case.domain.outline, &[[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [18.0, 20.0], [10.0, 4.0], [0.0, 4.0]]);
    assert_eq!(case.joints.len(), 8);
    let law = |k: usize| case.joints[k].law.as_deref().unwrap();
    assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(law).concat(), "faultfaultfaultbeddingbeddingbeddingbeddingfault");
    let points = |k: usize| &case.joints[k].points;
    near(points(0), &[[11.0, 6.0], [40.0, 17.0]]);
    // Arcs: ends by hand, and all points on their circles; seen from below, 200° to 250° are 340° to 290° from above.
    let on = |k: usize, [x, y]: [f64; 2], radius: f64| {
        points(k).iter().for_each(|p| assert!((length(p[0] - x, p[1] - y) - radius).abs() < 1e-9, "{p:?}"));
        (points(k)[0], *points(k).last().unwrap())
    };
    let at = |[x, y]: [f64; 2], r: f64, degrees: f64| {
        [x + r * degrees.to_radians().cos(), y + r * degrees.to_radians().sin()]
    };
    let (start, end) = on(1, [30.0, 0.0], 8.0);
    near(&[start, end], &[at([30.0, 0.0], 8.0, 20.0), at([30.0, 0.0], 8.0, 160.0)]);
    let (start, end) = on(2, [25.0, 20.0], 3.0);
    near(&[start, end], &[at([25.0, 20.0], 3.0, 340.0), at([25.0, 20.0], 3.0, 290.0)]);
    // The spline goes from its first control point to its last, and at its inner knot through (P1 + 2 P2 + P3)/4.
    near(&[points(3)[0], *points(3).last().unwrap()], &[[2.0, 1.0], [22.0, 2.0]]);
    let middle = [(6.0 + 28.0 + 18.0) / 4.0, (3.0 + 1.0 + 3.0) / 4.0];
    assert!(points(3).iter().any(|p| length(p[0] - middle[0], p[1] - middle[1]) < 1e-9), "{:?}", points(3));
    // A bulge of 1 is half a circle to the right of its chord: below it.
    let lowest = points(4).iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    near(&[points(4)[0], *points(4).last().unwrap()], &[[24.0, 14.0], [32.0, 15.0]]);
    assert!((lowest - 12.0).abs() < 0.05, "{lowest}");
    // Copies of a block of 5 m, halved, turned by -30° about its middle, 10 m apart along it.
    let (cos, sin) = (0.75f64.sqrt(), -0.5);
    for (k, off) in [(5, 0.0), (6, 10.0)] {
        let along = |s: f64| [20.0 + (off + s) * cos, 17.0 + (off + s) * sin];
        near(points(k), &[along(-1.25), along(1.25)]);
    }
    // The block within a block: upright at (1, 2) from its place, and mirrored.
    near(points(7), &[[35.0, 5.5], [35.0, 10.5]]);
    near(case.water.as_ref().unwrap().table.as_ref().unwrap(), &[[10.0, 3.0], [40.0, 9.0]]);
    let shifted = std::fs::read_to_string(folder.path().join("case.toml")).unwrap() + "\n[water]\nshift = -0.75\n";
    std::fs::write(folder.path().join("shifted.toml"), shifted).unwrap();
    let shifted = load_case(&folder.path().join("shifted.toml")).unwrap().case.water.unwrap();
    near(shifted.table.as_ref().unwrap(), &[[10.0, 2.25], [40.0, 8.25]]);
    let bolts: Vec<_> = case.bolts.iter().map(|bolt| (bolt.name.clone().unwrap(), bolt.points)).collect();
    let expected = [("anchor_1", [[12.0, 8.0], [20.0, 6.0]]), ("anchor_2", [[14.0, 12.0], [22.0, 10.0]])];
    assert_eq!(bolts, expected.map(|(name, points)| (name.to_owned(), points)));
    let notes = [
        "$INSUNITS is 4 (millimetres): coordinates are taken times 0.001",
        "1 entities on paper space are not used",
        "4 arcs and splines are polylines within 0.05 m of them (`domain.curve_tolerance`)",
        "1 3DFACE on layer \"FRAME\", which is ignored",
        "1 TEXT on layer \"FAULTS\" not used: no line",
    ];
    assert_eq!(notes_of(&loaded), notes);
    assert_eq!(loaded.warnings, [""; 0]);
    assert!(enmm::model::Simulation::new(loaded.case).unwrap().built().notes[0].contains("millimetres"));

    let mirrored = load_case(&keys.join("drawing.toml")).unwrap().case;
    near(&mirrored.joints[0].points, &[[29.0, 6.0], [0.0, 17.0]]);
    assert!(mirrored.layers.is_empty() && mirrored.transform.is_none() && mirrored.domain.curve_tolerance.is_none());
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

#[test]
fn layers_must_be_those_of_the_drawing() {
    let with = |layers: &str| with_geometry_and("g.dxf", DXF, layers).map(|loaded| loaded.case);
    let all = "Layers of the drawing: 0 (1 TEXT), clean (1 LINE), faults (1 POLYLINE), outline (1 LWPOLYLINE)";
    assert_eq!(
        with("[layers.outline]\nuse = \"outline\"\n[layers.clean]\nuse = \"joint\"").unwrap_err(),
        format!(
            "case.toml:4: layers: does not say what layer \"0\" is; add `[layers.\"0\"]` with `use = \"joint\"` or \
             another use, or `[layers.\"*\"]` with `use = \"ignore\"` for all others. {all}"
        )
    );
    let named =
        with("[layers.OutLine]\nuse = \"hole\"\n[layers.FAULTS]\nuse = \"outline\"\n[layers.\"*\"]\nuse = \"ignore\"");
    let domain = named.unwrap().domain;
    assert_eq!((domain.outline.len(), domain.holes.len()), (3, 1));
    assert_eq!(
        with("[layers.fault]\nuse = \"joint\"").unwrap_err(),
        "case.toml:4: layers.fault: the drawing has nothing on a layer \"fault\", did you mean \"faults\"? \
         Its layers: 0 (1 TEXT), clean (1 LINE), faults (1 POLYLINE), outline (1 LWPOLYLINE)"
    );
    for (layers, message) in [
        (
            "[layers.clean]\nuse = \"joint\"\nlaw = \"cleen\"",
            "case.toml:6: layers.clean.law: no joint law is named \"cleen\", did you mean \"clean\"? Known: clean; or \
             add [joint_law.NAME]",
        ),
        (
            "[layers.clean]\nuse = \"hole\"\nlaw = \"clean\"",
            "case.toml:6: layers.clean.law: has no effect on a layer without joints; write `use = \"joint\"`",
        ),
        (
            "[layers.clean]\nuse = \"bolt\"",
            "case.toml:4: layers.clean.bolt: a layer of bolts needs `bolt`, the name of a `[[bolt]]` without `points`; \
             add it",
        ),
        (
            "[layers.a]\nuse = \"hole\"\n[layers.A]\nuse = \"hole\"",
            "case.toml:4: layers.a: layer \"a\" is there in other letters too; remove one",
        ),
    ] {
        assert_eq!(with(layers).unwrap_err(), message);
    }
    let terrain = with_geometry("g.dxf", &DXF.replace("outline", "TERRAIN")).unwrap_err();
    assert_eq!(
        terrain,
        "case.toml:3: domain.geometry_file: the drawing has no outline, nor has the case: closed lines are on layer \
         \"TERRAIN\" (1), \"faults\" (1); write `[layers.\"TERRAIN\"]` with `use = \"outline\"` for that of the rock. \
         Layers of the drawing: 0 (1 TEXT), TERRAIN (1 LWPOLYLINE), clean (1 LINE), faults (1 POLYLINE)"
    );
}

#[test]
fn blocks_that_cannot_be_placed_are_located() {
    let block = "0\nBLOCK\n2\nB\n70\n0\n10\n0\n20\n0\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n1\n21\n0\n0\nENDBLK\n";
    let insert = "0\nINSERT\n8\nclean\n2\nb\n10\n3\n20\n4\n";
    let loaded = with_geometry("g.dxf", &drawing(block, insert)).unwrap();
    assert_eq!(traces(&loaded)[2], (vec![[3.0, 4.0], [4.0, 4.0]], Some("clean")));
    let own = block.replace("0\nENDBLK", "0\nINSERT\n2\nB\n10\n0\n20\n0\n0\nENDBLK");
    for (blocks, entities, message) in [
        (
            block,
            insert.replace("2\nb\n", "2\nC\n"),
            "INSERT of block \"C\", which the drawing does not have; save it again",
        ),
        (&own, insert.to_owned(), "block \"B\" inserts itself; explode one of the inserts"),
        (
            &block.replace("70\n0", "70\n4"),
            insert.to_owned(),
            "block \"B\" is an external reference; bind it to the drawing",
        ),
        (block, format!("{insert}41\n0\n"), "INSERT of block \"B\" has a scale of 0; correct it or remove the insert"),
        (
            block,
            format!("{insert}70\n2000\n71\n2000\n44\n1\n45\n1\n"),
            "INSERT has 2000 × 2000 copies, must be at most 1000000; thin them",
        ),
    ] {
        let error = with_geometry("g.dxf", &drawing(blocks, &entities)).unwrap_err();
        assert!(error.starts_with("g.dxf:") && error.ends_with(message), "{error}");
    }
}

#[test]
fn curves_that_cannot_be_drawn_are_located() {
    let spline = |groups: &str| format!("0\nSPLINE\n8\nclean\n{groups}");
    for (entity, message) in [
        (
            "0\nARC\n8\nclean\n10\n0\n20\n0\n40\n-1\n50\n0\n51\n90\n".to_owned(),
            "ARC has -1 in group 40, must be above 0; correct it",
        ),
        (
            "0\nARC\n8\nclean\n10\n0\n20\n0\n40\n1\n50\n0\n".to_owned(),
            "ARC has no group 51; the file is damaged, save it again",
        ),
        (
            "0\nCIRCLE\n8\nclean\n10\n0\n20\n0\n40\n1e8\n".to_owned(),
            "CIRCLE needs more than 100000 chords to stay within 0.02 m; correct it or raise `domain.curve_tolerance`",
        ),
        (
            spline("71\n3\n11\n0\n21\n0\n"),
            "SPLINE has neither control points nor two points to be fitted; save the drawing again",
        ),
        (
            spline("71\n1\n40\n0\n40\n0\n40\n1\n10\n0\n20\n0\n10\n1\n20\n0\n"),
            "SPLINE has 3 knots, must be 4 in ascending order; save the drawing again",
        ),
    ] {
        let error = with_geometry("g.dxf", &drawing("", &entity)).unwrap_err();
        assert!(error.starts_with("g.dxf:") && error.ends_with(message), "{error}");
    }
    let ellipse = "0\nELLIPSE\n8\nhole\n10\n4\n20\n2\n11\n1\n21\n0\n40\n0.5\n41\n0\n42\n6.283185307179586\n";
    let hole = &with_geometry("g.dxf", &drawing("", ellipse)).unwrap().case.domain.holes[0];
    let off = |p: &[f64; 2]| (p[0] - 4.0).powi(2) + 4.0 * (p[1] - 2.0).powi(2) - 1.0;
    assert!(hole.len() >= 8 && hole.iter().all(|p| off(p).abs() < 1e-12), "{hole:?}");
}

/// Old drawings are in the code page of their system, and write signs of others by their numbers.
#[test]
fn layers_of_old_drawings_keep_their_letters() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("g.dxf");
    let head = "0\nSECTION\n2\nHEADER\n9\n$DWGCODEPAGE\n3\nANSI_1252\n";
    let text = DXF.replacen("0\nSECTION\n2\nHEADER\n", head, 1).replace("faults", "Kl?fte \\U+03B1");
    let bytes: Vec<u8> = text.bytes().map(|byte| if byte == b'?' { 0xfc } else { byte }).collect();
    std::fs::write(&path, &bytes).unwrap();
    let layers = survey_geometry(&path, 0.1).unwrap().layers;
    let names: Vec<&str> = layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["0", "clean", "Klüfte α", "outline"]);
    let other = String::from_utf8_lossy(&bytes).replace("1252", "932").replace('\u{fffd}', "?");
    std::fs::write(&path, other.bytes().map(|byte| if byte == b'?' { 0xfc } else { byte }).collect::<Vec<u8>>())
        .unwrap();
    let error = survey_geometry(&path, 0.1).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "it is text in the code page \"ANSI_932\", and UTF-8 and ANSI_1252 are read; save it as DXF 2007"
        )
    );
}

/// An outline that was drawn side by side, in any order and sense, is one loop; a gap is named with its width.
#[test]
fn open_lines_that_meet_are_a_loop() {
    let line = |a: [f64; 2], b: [f64; 2]| {
        format!("0\nLINE\n8\nhole\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", a[0], a[1], b[0], b[1])
    };
    let sides = |corner: [f64; 2]| {
        line([4.0, 1.0], [5.0, 1.0])
            + &line([5.0, 2.0], [5.0, 1.0])
            + &line(corner, [4.0, 1.0])
            + "0\nARC\n8\nhole\n10\n4.5\n20\n2\n40\n0.5\n50\n0\n51\n180\n"
    };
    let loaded = with_geometry("g.dxf", &drawing("", &sides([4.0, 2.0]))).unwrap();
    let hole = &loaded.case.domain.holes[0];
    near(&hole[..3], &[[4.0, 1.0], [5.0, 1.0], [5.0, 2.0]]);
    near(&hole[hole.len() - 1..], &[[4.0, 2.0]]);
    assert!(notes_of(&loaded).contains(&"1 loops joined of open lines that meet".to_owned()));
    let error = with_geometry("g.dxf", &drawing("", &sides([4.0, 2.25]))).unwrap_err();
    assert_eq!(
        error,
        "g.dxf:94: entity[4]: LINE on layer \"hole\" is open, a loop must be closed; close it; its end at (4.000000, \
         2.000000) is 2.500e-1 m from the next line of this use"
    );
}
