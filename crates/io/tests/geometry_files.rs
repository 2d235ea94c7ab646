//! Outlines and joint traces are read from JSON, GeoJSON and DXF; what is not used is reported, what is wrong located.

use crate::support::{with_geometry, with_geometry_and};
use enmm_io::LoadedCase;

const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]];

fn traces(loaded: &LoadedCase) -> Vec<(Vec<[f64; 2]>, Option<&str>)> {
    loaded.case.joints.iter().map(|joint| (joint.points.clone(), joint.law.as_deref())).collect()
}

/// Returns JSON with the triangle as outline and these joints, which begin on line 2.
fn json(joints: &str) -> String {
    format!("{{\"outline\": [[0, 0], [9, 0], [9, 9]], \"joints\": [\n{joints}]}}")
}

#[test]
fn json_gives_outline_loops_and_joints_and_ignores_remarks() {
    let text = r#"{"name": "g", "source": {"x": [1]}, "outline": [[0, 0], [9, 0], [9, 9]],
        "holes": [[[2, 1], [3, 1], [3, 2]]], "islands": [[[20, 0], [21, 0], [21, 1]]],
        "joints": [[[0, 0], [1, 1], [2, 3]]]}"#;
    let loaded = with_geometry("g.json", text).unwrap();
    let domain = &loaded.case.domain;
    assert_eq!(domain.outline, TRIANGLE);
    assert_eq!(domain.holes, [[[2.0, 1.0], [3.0, 1.0], [3.0, 2.0]]]);
    assert_eq!(domain.islands, [[[20.0, 0.0], [21.0, 0.0], [21.0, 1.0]]]);
    assert_eq!(domain.geometry_file, None);
    assert_eq!(traces(&loaded), [(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 3.0]], None)]);
    assert_eq!(loaded.warnings, [""; 0]);
}

#[test]
fn json_key_that_looks_misspelled_is_reported() {
    let loaded = with_geometry("g.json", r#"{"outline": [[0, 0], [9, 0], [9, 9]], "joint": []}"#).unwrap();
    assert_eq!(loaded.warnings, ["g.json: key \"joint\" is not read; rename it if you mean `joints`"]);
}

#[test]
fn joints_of_case_and_file_are_appended_and_located() {
    let inline = "[[joint]]\npoints = [[1.0, 0.0], [2.0, 2.0]]";
    let loaded = with_geometry_and("g.json", &json("[[0, 0],\n [1, 1]]"), inline).unwrap();
    assert_eq!(loaded.case.joints.len(), 2);
    let located = |key: &str| {
        let text = loaded.source.locate(key, "is bad").to_string();
        text.rsplit('/').next().unwrap().to_string()
    };
    assert_eq!(located("joint[0].points[1]"), "case.toml:5: joint[0].points[1]: is bad");
    assert_eq!(located("joint[1].points[1]"), "g.json:3: joints[0][1]: is bad");
    assert_eq!(located("joint[1]"), "g.json:2: joints[0]: is bad");
    assert_eq!(located("domain.outline[2]"), "g.json:1: outline[2]: is bad");
    assert_eq!(located("domain.holes[0]"), "case.toml:2: domain.holes[0]: is bad");
}

#[test]
fn outline_in_case_and_file_is_refused() {
    let error = with_geometry_and("g.json", &json(""), "outline = [[0, 0], [1, 0], [1, 1]]").unwrap_err();
    assert_eq!(
        error,
        "case.toml:4: domain.outline: the outline is also in \"g.json\", only one can be; remove this one"
    );
}

#[test]
fn numbers_that_are_not_finite_name_joint_and_point() {
    let limit = "must be a finite number of at most 1e9 m in magnitude; correct it or move the origin";
    for (text, shown) in [("\"NaN\"", "NaN"), ("\"Infinity\"", "inf"), ("\"-Infinity\"", "-inf"), ("2e9", "2e9")] {
        let error = with_geometry("g.json", &json(&format!("[[0, 0], [1, 1]],\n[[0, 0],\n[1, {text}]]"))).unwrap_err();
        assert_eq!(error, format!("g.json:4: joints[1][1]: y is {shown} m, {limit}"));
    }
    for token in ["NaN", "Infinity", "-Infinity"] {
        let error = with_geometry("g.json", &json(&format!("[[0, 0], [1, 1]],\n[[0, 0],\n[1, {token}]]"))).unwrap_err();
        assert_eq!(error, format!("g.json:4: joints[1][1][1]: is {token}, must be a finite number; correct it"));
    }
}

#[test]
fn json_of_the_wrong_shape_is_located() {
    let error = |text: &str| with_geometry("g.json", text).unwrap_err();
    assert_eq!(
        error(&json("[[0, 0],\n[1, \"one\"]]")),
        "g.json:3: joints[0][1][1]: is the string \"one\", must be a number; write `1.0`"
    );
    assert_eq!(
        error(&json("[[0, 0],\n[1]]")),
        "g.json:3: joints[0][1]: has 1 coordinates, must have 2; write `[x, y]`"
    );
    assert_eq!(
        error(&json("[[0, 0, 0], [1, 1]]")),
        "g.json:2: joints[0]: 1 points have more than 2 coordinates; write `[x, y]`"
    );
    assert_eq!(
        error(&json("[[0, 0]]")),
        "g.json:2: joints[0]: has 1 points, a joint trace needs at least 2; add points or remove it"
    );
    assert_eq!(error(&json("7")), "g.json:2: joints[0]: is 7, must be an array; write `[…]`");
    assert_eq!(error("[1]"), "g.json:1: the file is no object; write `{\"outline\": [[x, y], …]}`");
    assert_eq!(
        error("{\"name\": \"x\"}"),
        "g.json:1: the file has none of the keys outline, holes, islands, joints; add one"
    );
    assert_eq!(error("{\"joints\": [],\n\"joints\": []}"), "g.json:2: joints: stands twice in one object; remove one");
    assert!(error("{\"joints\": [\n").starts_with("g.json:2: not JSON: "));
}

#[test]
fn geometry_file_that_cannot_be_read_is_located_in_the_case() {
    let error = with_geometry_and("g.json", "{}", "").unwrap_err();
    assert_eq!(error, "g.json:1: the file has none of the keys outline, holes, islands, joints; add one");
    let folder = tempfile::tempdir().unwrap();
    let case = "title = \"t\"\n[domain]\ngeometry_file = \"none.json\"\n[mesh]\nsize = 1\n[rock.a]\n\
                density = 1\nyoung = 1\npoisson = 0\n[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = 1";
    let error = enmm_io::parse_case(case, "c.toml", folder.path()).unwrap_err().to_string();
    assert!(error.starts_with("c.toml:3: domain.geometry_file: "), "{error}");
    assert!(error.ends_with(
        "none.json\": cannot read the file (No such file or directory (os error 2)); check its path and permissions"
    ));
    let error = with_geometry("g.shp", "").unwrap_err();
    assert_eq!(
        error,
        "case.toml:3: domain.geometry_file: \"g.shp\": the extension is none of .json, .geojson, .dxf, .wkt, \
         .csv; convert the file"
    );
}

/// Returns GeoJSON with a polygon with a hole, a line with this property `law`, a point and two lines at once.
fn geojson(law: &str) -> String {
    format!(
        r#"{{"type": "FeatureCollection", "features": [
{{"type": "Feature", "properties": {{}}, "geometry": {{"type": "Polygon",
  "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]], [[2, 1], [3, 1], [3, 2], [2, 1]]]}}}},
{{"type": "Feature", "properties": {{"law": {law}}}, "geometry": {{"type": "LineString",
  "coordinates": [[0, 0, 5], [1, 1, 5]]}}}},
{{"type": "Feature", "properties": null, "geometry": {{"type": "Point", "coordinates": [0, 0]}}}},
{{"type": "Feature", "properties": null, "geometry": {{"type": "MultiLineString",
  "coordinates": [[[0, 1], [1, 1]], [[0, 2], [1, 2]]]}}}}
]}}"#
    )
}

#[test]
fn geojson_gives_lines_as_joints_and_polygon_as_outline_with_holes() {
    for name in ["g.geojson", "g.json"] {
        let loaded = with_geometry(name, &geojson("\"clean\"")).unwrap();
        assert_eq!(loaded.case.domain.outline, TRIANGLE);
        assert_eq!(loaded.case.domain.holes, [[[2.0, 1.0], [3.0, 1.0], [3.0, 2.0]]]);
        let expected = [
            (vec![[0.0, 0.0], [1.0, 1.0]], Some("clean")),
            (vec![[0.0, 1.0], [1.0, 1.0]], None),
            (vec![[0.0, 2.0], [1.0, 2.0]], None),
        ];
        assert_eq!(traces(&loaded), expected);
        let warnings = ["1 Point not used: no line or polygon", "the third coordinate of 2 points is not used"];
        assert_eq!(loaded.warnings, warnings.map(|warning| format!("{name}: {warning}")));
    }
}

#[test]
fn geojson_multi_polygon_gives_outline_and_islands() {
    let text = r#"{"type": "MultiPolygon", "coordinates":
        [[[[0, 0], [9, 0], [9, 9], [0, 0]]], [[[20, 0], [21, 0], [21, 1], [20, 0]]]]}"#;
    let domain = with_geometry("g.geojson", text).unwrap().case.domain;
    assert_eq!(domain.outline, TRIANGLE);
    assert_eq!(domain.islands, [[[20.0, 0.0], [21.0, 0.0], [21.0, 1.0]]]);
}

#[test]
fn geojson_that_cannot_be_used_is_located() {
    let error = |text: &str| with_geometry("g.geojson", text).unwrap_err();
    assert_eq!(
        error(&geojson("\"claen\"")),
        "g.geojson:4: features[1].properties.law: no joint law is named \"claen\", did you mean \"clean\"? \
         Known: clean; or add [joint_law.NAME]"
    );
    assert_eq!(
        error(&geojson("7")),
        "g.geojson:4: features[1].properties.law: is 7, must be a string; write the name of a joint law"
    );
    assert_eq!(
        error(&geojson("null").replace("\"MultiLineString\"", "\"MultiLine\"")),
        "g.geojson:7: features[3].geometry.type: is the string \"MultiLine\", must be one of FeatureCollection, \
         Feature, GeometryCollection, LineString, MultiLineString, Polygon, MultiPolygon, Point, MultiPoint; correct it"
    );
    let message = "features[3].geometry.coordinates[0][1]: y is NaN m, must be a finite number of at most 1e9 m in \
                   magnitude; \
                   correct it or move the origin";
    assert_eq!(
        error(&geojson("null").replace("[1, 1]], [[0, 2]", "[1, \"NaN\"]], [[0, 2]")),
        format!("g.geojson:8: {message}")
    );
}

/// A drawing: a line on layer clean, a closed outline, an old-style closed polyline on layer faults, a circle.
const DXF: &str = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n\
    0\nLINE\n8\nclean\n10\n0.0\n20\n1.0\n11\n5.0\n21\n6.0\n\
    0\nLWPOLYLINE\n8\noutline\n90\n3\n70\n1\n10\n0\n20\n0\n10\n9\n20\n0\n42\n0\n10\n9\n20\n9\n\
    0\nPOLYLINE\n8\nfaults\n66\n1\n70\n1\n0\nVERTEX\n10\n1\n20\n1\n0\nVERTEX\n10\n2\n20\n1\n30\n4\n\
    0\nVERTEX\n10\n2\n20\n2\n0\nSEQEND\n\
    0\nCIRCLE\n10\n0\n20\n0\n40\n1\n0\nENDSEC\n0\nEOF\n";

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
        let warnings = [
            "1 CIRCLE entities not used",
            "1 points whose height is not used",
            "1 traces on layer \"faults\", which is no joint law, take the default law",
        ];
        assert_eq!(loaded.warnings, warnings.map(|warning| format!("g.dxf: {warning}")));
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
fn dxf_in_other_units_is_reported() {
    let loaded = with_geometry("g.dxf", &DXF.replace("70\n6", "70\n4")).unwrap();
    assert_eq!(loaded.warnings[0], "g.dxf: $INSUNITS is 4, not 6 (metres); coordinates are taken as metres");
}

#[test]
fn dxf_that_cannot_be_used_is_located() {
    let limit = "must be a finite number of at most 1e9 m in magnitude; correct it or move the origin";
    for (from, to, message) in [
        (
            "42\n0",
            "42\n0.5",
            "g.dxf:44: LWPOLYLINE has an arc (bulge 0.5), only straight lines are read; replace arcs by short lines",
        ),
        ("10\n0.0", "10\nNaN", &format!("g.dxf:20: entity[0][0]: x is NaN m, {limit}")),
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
            "70\n1\n0\nVERTEX",
            "70\n2\n0\nVERTEX",
            "g.dxf:50: POLYLINE fitted with a curve, only straight lines are read; explode it or straighten it",
        ),
        (
            "8\nclean",
            "8\nclean\n230\n-1.0",
            "g.dxf:20: LINE is not in the x-y plane (extrusion -1.0); draw it seen from above",
        ),
        ("ENTITIES", "TABLES", "g.dxf:1: no section ENTITIES, which holds the lines; save the drawing as ASCII DXF"),
        ("0\nSECTION", "x\nSECTION", "g.dxf:1: the line is no group code of DXF, a whole number; save it again"),
    ] {
        assert!(DXF.contains(from), "{from:?}");
        assert_eq!(with_geometry("g.dxf", &DXF.replacen(from, to, 1)).unwrap_err(), *message);
    }
    let cut = with_geometry("g.dxf", "0\nSECTION\n2").unwrap_err();
    assert_eq!(cut, "g.dxf:3: the value of group 2 is missing; the file is cut off");
    let binary = with_geometry("g.dxf", "AutoCAD Binary DXF\r\n").unwrap_err();
    assert_eq!(binary, "g.dxf:1: binary DXF, which is not read; save the drawing as ASCII DXF");
}
