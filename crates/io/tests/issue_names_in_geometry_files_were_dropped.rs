//! A property `LAW` or `Layer` of GeoJSON, a key `traces` of JSON and heads of columns with a unit were passed over
//! without a word, or refused as if they were nothing: the joints took the default law, or there were none. Names are
//! read in any letter case, and what is not read is listed or refused.

use crate::support::{with_geometry, with_geometry_and};
use enmm_io::LoadedCase;

const RING: &str = "[[0, 0], [9, 0], [9, 9], [0, 0]]";

/// A collection of an outline and a line with these properties.
fn collection(properties: &str) -> String {
    format!(
        "{{\"type\": \"FeatureCollection\", \"features\": [{{\"type\": \"Feature\", \"properties\": null, \
         \"geometry\": {{\"type\": \"Polygon\", \"coordinates\": [{RING}]}}}}, {{\"type\": \"Feature\", \
         \"properties\": {{{properties}}}, \"geometry\": {{\"type\": \"LineString\", \"coordinates\": \
         [[1, 0], [8, 7]]}}}}]}}"
    )
}

fn law(loaded: &LoadedCase) -> Option<&str> {
    assert_eq!(loaded.case.joints.len(), 1);
    loaded.case.joints[0].law.as_deref()
}

#[test]
fn a_property_law_in_other_letters_took_the_default_law() {
    for name in ["law", "LAW", "Law", "law ", "joint_law", "Joint-Law", "Layer", "LAYER"] {
        let loaded = with_geometry("g.geojson", &collection(&format!("{name:?}: \"clean\""))).unwrap();
        assert_eq!((law(&loaded), loaded.warnings.len()), (Some("clean"), 0), "{name}: {:?}", loaded.warnings);
    }
    // A layer may have the law's name in other letters, as in a drawing; a law is the name itself.
    assert_eq!(law(&with_geometry("g.geojson", &collection("\"Layer\": \"CLEAN\"")).unwrap()), Some("clean"));
    let error = with_geometry("g.geojson", &collection("\"LAW\": \"CLEAN\"")).unwrap_err();
    assert!(error.contains("properties.LAW: no joint law is named \"CLEAN\""), "{error}");
    let error = with_geometry("g.geojson", &collection("\"LAW\": \"clean\", \"law\": \"clean\"")).unwrap_err();
    assert!(error.contains("is a second name of the joint law; remove one of both"), "{error}");
}

#[test]
fn properties_that_are_not_read_were_not_listed() {
    let properties = "\"Layer\": \"Faults\", \"SubClasses\": \"AcDbLine\", \"Text\": null, \"id\": 7";
    let loaded = with_geometry("g.geojson", &collection(properties)).unwrap();
    let warnings = [
        "g.geojson: properties not used: SubClasses (1), id (1)",
        "g.geojson: 1 traces on layer \"Faults\", which is no joint law, take the default law",
    ];
    assert_eq!((law(&loaded), &loaded.warnings[..]), (None, &warnings.map(str::to_owned)[..]));
    let beside = collection("").replace("\"properties\": {}", "\"law\": \"clean\", \"properties\": {}");
    let loaded = with_geometry("g.geojson", &beside).unwrap();
    assert_eq!(loaded.warnings, ["g.geojson: properties not used: \"law\" beside \"properties\" (1)"]);
    let polygon = collection("").replace("\"properties\": null", "\"properties\": {\"law\": \"clean\"}");
    let loaded = with_geometry("g.geojson", &polygon).unwrap();
    assert_eq!(loaded.warnings, ["g.geojson: properties not used: law of a polygon (1)"]);
}

/// A drawing as `ogr2ogr` converts it: closed lines on layers with the names of loops.
#[test]
fn lines_of_a_converted_drawing_are_loops_by_their_layers() {
    let text = collection("\"Layer\": \"Hole\"").replace("[[1, 0], [8, 7]]", "[[5, 1], [6, 1], [6, 2], [5, 1]]");
    let domain = with_geometry("g.geojson", &text).unwrap().case.domain;
    assert_eq!(domain.holes, [[[5.0, 1.0], [6.0, 1.0], [6.0, 2.0]]]);
    let error = with_geometry("g.geojson", &collection("\"Layer\": \"outline\"")).unwrap_err();
    assert!(error.contains("is a second outline, there can be 1; write `island`"), "{error}");
}

#[test]
fn a_key_traces_was_no_joints() {
    let text = "{\"Outline\": [[0, 0], [9, 0], [9, 9]], \"KEY\": [[[1, 0], [8, 7]]]}";
    for key in ["traces", "Traces", "JOINTS", "joints "] {
        let loaded = with_geometry("g.json", &text.replace("KEY", key)).unwrap();
        assert_eq!((law(&loaded), loaded.warnings.len()), (None, 0), "{key}");
    }
    for key in ["faults", "lines", "joint", "Polylines"] {
        let error = with_geometry("g.json", &text.replace("KEY", key)).unwrap_err();
        let message = "holds points, but the keys are outline, holes, islands, joints; rename or remove it";
        assert_eq!(error, format!("g.json:1: {key}: {message}"));
    }
    let both = text.replace("\"KEY\"", "\"joints\": [], \"traces\"");
    let error = with_geometry("g.json", &both).unwrap_err();
    assert_eq!(error, "g.json:1: traces: is a second key for `joints`; join both");
    let remarks = text.replace("\"KEY\"", "\"source\": \"a survey\", \"origin\": [466022.0, 6692120.0], \"joints\"");
    let loaded = with_geometry("g.json", &remarks).unwrap();
    assert_eq!(loaded.warnings, [""; 0]);
    assert!(loaded.case.reader_notes[0].ends_with("g.json: keys not used: origin, source"));
}

#[test]
fn columns_with_units_and_a_line_of_the_separator_were_refused() {
    let outline = "outline = [[0, 0], [9, 0], [9, 9]]";
    let read = |text: &str| with_geometry_and("g.csv", text, outline);
    for head in ["x1 [m],y1 [m],x2 [m],y2 [m],Joint_Law", "X1(m),Y1(m),X2(m),Y2(m),LAYER", "x1 / m,y1,x2,y2,law"] {
        let loaded = read(&format!("{head}\n1,0,8,7,clean\n")).unwrap();
        assert_eq!((law(&loaded), loaded.warnings.len()), (Some("clean"), 0), "{head}: {:?}", loaded.warnings);
        assert_eq!(loaded.case.joints[0].points, [[1.0, 0.0], [8.0, 7.0]]);
    }
    for first in ["sep=;", "\"sep=;\"\r", "SEP=;"] {
        let loaded = read(&format!("{first}\ntrace;x;y\n1;1;0\n1;8;7\n")).unwrap();
        assert_eq!(loaded.case.joints[0].points, [[1.0, 0.0], [8.0, 7.0]]);
    }
    let error = read("sep=;\ntrace;x;y\n1;1;0\n1;8;a\n").unwrap_err();
    assert_eq!(error, "g.csv:4: \"a\" is no finite number; correct it");
    let loaded = read("x1 [mm],y1 [mm],x2 [mm],y2 [mm]\n1000,0,8000,7000\n").unwrap();
    assert_eq!(loaded.case.joints[0].points, [[1.0, 0.0], [8.0, 7.0]]);
    assert!(loaded.case.drawing_unit.unwrap().ends_with("g.csv: millimetres (mm), taken times 0.001"));
    let error = read("x1 [m],y1 [mm],x2,y2\n1,0,8,7\n").unwrap_err();
    assert_eq!(error, "g.csv:1: the columns have the units m, mm, must have one");
    let error = read("x1 [deg],y1 [deg],x2 [deg],y2 [deg]\n1,0,8,7\n").unwrap_err();
    assert!(error.starts_with("g.csv:1: is \"deg\", whose coordinates are degrees"), "{error}");
    let error = read("x1,y1,x2,y2,law,LAW\n1,0,8,7,clean,clean\n").unwrap_err();
    assert_eq!(error, "g.csv:1: two columns name the joint law; remove one");
    let wkt = read("WKT,Layer,LAW\n\"LINESTRING (1 0, 8 7)\",x,clean\n").unwrap();
    assert_eq!(law(&wkt), Some("clean"));
}

#[test]
fn a_law_on_a_layer_in_other_letters_took_the_default_law() {
    let text = |layer: &str| {
        format!("0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n{layer}\n10\n1\n20\n0\n11\n8\n21\n7\n0\nENDSEC\n0\nEOF\n")
    };
    let outline = "outline = [[0, 0], [9, 0], [9, 9]]";
    for layer in ["clean", "CLEAN", "Clean "] {
        assert_eq!(law(&with_geometry_and("g.dxf", &text(layer), outline).unwrap()), Some("clean"));
    }
    let loaded = with_geometry_and("g.dxf", &text("cleen"), outline).unwrap();
    assert_eq!(loaded.warnings, ["g.dxf: 1 traces on layer \"cleen\", which is no joint law, take the default law"]);
}
