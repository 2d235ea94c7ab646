//! Outlines and joint traces are read from JSON and GeoJSON; what is not used is reported, what is wrong located.

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
