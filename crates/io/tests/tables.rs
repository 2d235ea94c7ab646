//! Claim: outlines and joint traces are read from WKT and CSV files, by rules that the messages state.

use crate::support::with_geometry;
use enmm_io::LoadedCase;

const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]];

fn traces(loaded: &LoadedCase) -> Vec<(Vec<[f64; 2]>, Option<&str>)> {
    loaded.case.joints.iter().map(|joint| (joint.points.clone(), joint.law.as_deref())).collect()
}

#[test]
fn wkt_lines_are_traces_and_polygons_are_loops() {
    let text = "# mapped\nSRID=32632;POLYGON ((0 0, 9 0, 9 9, 0 0),\n (2 1, 3 1, 3 2, 2 1))\n\
                POLYGON((20 0,21 0,21 1))\nLINESTRING Z (0 0 5, 1 1 5, 2 3 5);\n\
                MULTILINESTRING ((1 0, 2 1), (3 0, 4 1))\nPOINT (1 1)\n";
    let loaded = with_geometry("g.wkt", text).unwrap();
    let domain = &loaded.case.domain;
    assert_eq!((&domain.outline[..], domain.holes.len(), domain.islands.len()), (&TRIANGLE[..], 1, 1));
    assert_eq!(
        traces(&loaded),
        [
            (vec![[0.0, 0.0], [1.0, 1.0], [2.0, 3.0]], None),
            (vec![[1.0, 0.0], [2.0, 1.0]], None),
            (vec![[3.0, 0.0], [4.0, 1.0]], None)
        ]
    );
    assert_eq!(
        loaded.warnings,
        ["g.wkt: 1 points not used: no line or polygon", "g.wkt: the third coordinate of 3 points is not used"]
    );
}

#[test]
fn rows_of_a_table_are_traces_in_each_form() {
    let outline = "outline,0,0\noutline,9,0\noutline,9,9\noutline,0,0\n";
    let points =
        format!("Trace,X,Y,Law\n{}a,0,0,\na,1,1,\nb,3,0,clean\nb,4,1,clean\n", outline.replace('\n', ",outline\n"));
    let ends = "id;x1;y1;x2;y2;law\n1;0;0;1;1;\n2;3;0;4;1;clean\n";
    let wkt = "wkt,law,note\n\"POLYGON ((0 0, 9 0, 9 9, 0 0))\",,\n\"LINESTRING (0 0, 1 1)\",,x\n\
               \"LINESTRING (3 0, 4 1)\",clean,\n";
    let expected = [(vec![[0.0, 0.0], [1.0, 1.0]], None), (vec![[3.0, 0.0], [4.0, 1.0]], Some("clean"))];
    let loaded = with_geometry("g.csv", &points).unwrap();
    assert_eq!((traces(&loaded), &loaded.case.domain.outline[..]), (expected.to_vec(), &TRIANGLE[..]));
    assert_eq!(loaded.warnings, [""; 0]);
    let loaded = with_geometry("g.csv", wkt).unwrap();
    assert_eq!((traces(&loaded), &loaded.case.domain.outline[..]), (expected.to_vec(), &TRIANGLE[..]));
    assert_eq!(loaded.warnings, ["g.csv: columns not used: note"]);
    let outline = "outline = [[0, 0], [9, 0], [9, 9]]";
    let loaded = crate::support::with_geometry_and("g.csv", ends, outline).unwrap();
    assert_eq!(traces(&loaded), expected);
    assert_eq!(loaded.warnings, ["g.csv: columns not used: id"]);
}

#[test]
fn a_line_that_cannot_be_used_is_named() {
    for (name, text, message) in [
        ("g.wkt", "LINE (0 0)\n", "g.wkt:1: geometry[0]: \"LINE (0 0)\" is no geometry ("),
        ("g.wkt", "\nLINESTRING (0 0,\n 1 1\n", "g.wkt:2: a `(` is not closed before the end of the file; add `)`"),
        ("g.wkt", "# nothing\n", "g.wkt:1: the file has no geometry; write `LINESTRING (0 0, 4 3)`"),
        (
            "g.csv",
            "a,b\n1,2\n",
            "g.csv:1: the columns are none of ours, must be `wkt`, or `x1, y1, x2, y2`, or `trace, x, y`",
        ),
        ("g.csv", "trace,x,y\n1,0,0\n1,a,0\n", "g.csv:3: \"a\" is no finite number; correct it"),
        ("g.csv", "trace;x;y\n1;0,5;0\n", "g.csv:2: \"0,5\" is no finite number; write a decimal point"),
        ("g.csv", "trace,x,y\n1,0\n", "g.csv:2: no row of the table: "),
        ("g.csv", "trace,x,y,law\n1,0,0,clean\n1,1,0,\n", "g.csv:3: trace \"1\" has another `law` than on line 2"),
        ("g.csv", "x1,y1,x2,y2,law\n0,0,1,1,claen\n", "g.csv:2: row[0]: no joint law is named \"claen\", did you mean"),
        ("g.csv", "trace,x,y\n1,0,0\n2,0,1\n2,1,1\n", "g.csv:2: row[0]: has 1 points, a joint trace needs at least 2"),
        ("g.shp", "", "the extension is none of .json, .geojson, .dxf, .wkt, .csv; convert the file"),
    ] {
        let outline = "outline = [[0, 0], [9, 0], [9, 9]]";
        let error = crate::support::with_geometry_and(name, text, outline).unwrap_err();
        assert!(error.contains(message), "{error}\nnot\n{message}");
    }
}
