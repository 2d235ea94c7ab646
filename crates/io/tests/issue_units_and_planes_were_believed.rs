//! GeoJSON in degrees or feet was read as metres, upright sections as lines on top of each other, and files with a byte
//! order mark, features by lines and splines by points to be fitted were refused with an error that did not say why.

use crate::support::{with_geometry, with_geometry_and};
use enmm_io::LoadedCase;

const OUTLINE: &str = "outline = [[0, 0], [9, 0], [9, 9]]";

fn points(loaded: &LoadedCase) -> &[[f64; 2]] {
    assert_eq!(loaded.case.joints.len(), 1);
    &loaded.case.joints[0].points
}

fn unit(loaded: &LoadedCase) -> String {
    let told = loaded.case.drawing_unit.as_ref().expect("a unit");
    told[told.find("g.geojson").expect("the file")..].to_owned()
}

/// A line in a coordinate reference system.
fn line_in(crs: &str) -> String {
    format!("{{\"type\": \"LineString\", {crs}\n\"coordinates\": [[1, 0], [8, 7]]}}")
}

fn named(name: &str) -> String {
    line_in(&format!("\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": {name:?}}}}},"))
}

#[test]
fn degrees_were_metres() {
    for name in [
        "urn:ogc:def:crs:OGC:1.3:CRS84",
        "EPSG:4326",
        "urn:ogc:def:crs:EPSG::4258",
        "http://www.opengis.net/def/crs/EPSG/0/4269",
        "WGS 84",
    ] {
        let error = with_geometry_and("g.geojson", &named(name), OUTLINE).unwrap_err();
        assert_eq!(
            error,
            format!(
                "g.geojson:1: crs: is {name:?}, whose coordinates are degrees, and a section is in metres; project \
                 the lines to metres (as by `ogr2ogr -t_srs`), or remove what says so where they are metres"
            )
        );
    }
    let old = line_in("\"crs\": {\"type\": \"EPSG\", \"properties\": {\"code\": 4326}},");
    assert!(with_geometry_and("g.json", &old, OUTLINE).unwrap_err().contains("\"EPSG:4326\", whose coordinates"));
    let srid = with_geometry_and("g.wkt", "SRID=4326;LINESTRING (1 0, 8 7)\n", OUTLINE).unwrap_err();
    assert!(srid.starts_with("g.wkt:1: geometry[0]: is \"EPSG:4326\", whose coordinates are degrees"), "{srid}");
    let table = "wkt\n\"SRID=4326;LINESTRING (1 0, 8 7)\"\n";
    let table = with_geometry_and("g.csv", table, OUTLINE).unwrap_err();
    assert!(table.starts_with("g.csv:2: row[0]: is \"EPSG:4326\", whose coordinates are degrees"), "{table}");
}

#[test]
fn feet_of_a_reference_system_were_metres() {
    let survey = 1200.0 / 3937.0;
    for (name, metres, shown) in [
        ("EPSG:2227", survey, "US survey feet (EPSG:2227), taken times 0.3048006096012192"),
        ("EPSG:2222", 0.3048, "feet (EPSG:2222), taken times 0.3048"),
        ("EPSG:25832", 1.0, "metres (EPSG:25832)"),
        ("WGS 84 / UTM zone 33N", 1.0, "metres as far as is known (WGS 84 / UTM zone 33N)"),
    ] {
        let loaded = with_geometry_and("g.geojson", &named(name), OUTLINE).unwrap();
        assert_eq!(points(&loaded), [[metres, 0.0], [8.0 * metres, 7.0 * metres]]);
        assert_eq!(unit(&loaded), format!("g.geojson: {shown}"));
    }
    let scaled = format!("{OUTLINE}\n[transform]\nscale = 1");
    let loaded = with_geometry_and("g.geojson", &named("EPSG:2222"), &scaled).unwrap();
    assert_eq!(points(&loaded), [[1.0, 0.0], [8.0, 7.0]]);
    assert!(loaded.case.reader_notes[0].contains("is in feet, but coordinates are taken times 1"));
    let chains = with_geometry_and("g.geojson", &named("EPSG:24571"), OUTLINE).unwrap_err();
    assert!(chains.contains("whose unit is neither metres nor feet; give `transform.scale`"), "{chains}");
    let json = "{\"outline\": [[0, 0], [9000, 0], [9000, 9000]], \"Units\": \"mm\"}";
    assert_eq!(with_geometry("g.json", json).unwrap().case.domain.outline[2], [9.0, 9.0]);
}

#[test]
fn upright_sections_lay_on_one_line() {
    let note = "the section stands upright: all points have the same y, so x is taken to the right and z up";
    let along_y = "the section stands upright: all points have the same x, so y is taken to the right and z up";
    let dxf = |entities: &str| format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n");
    let line = "0\nLINE\n8\nclean\n10\n1\n20\n5\n30\n0\n11\n8\n21\n5\n31\n7\n";
    let front = "0\nLWPOLYLINE\n8\nclean\n90\n2\n70\n0\n38\n-5\n10\n1\n20\n0\n10\n8\n20\n7\n210\n0\n220\n-1\n230\n0\n";
    let back = "0\nLWPOLYLINE\n8\nclean\n90\n2\n70\n0\n38\n5\n10\n-1\n20\n0\n10\n-8\n20\n7\n210\n0\n220\n1\n230\n0\n";
    let space = "0\nPOLYLINE\n8\nclean\n70\n8\n0\nVERTEX\n10\n1\n20\n5\n30\n0\n0\nVERTEX\n10\n8\n20\n5\n30\n7\n0\n\
                 SEQEND\n";
    for (name, text, note) in [
        ("g.dxf", dxf(line), note),
        ("g.dxf", dxf(front), note),
        ("g.dxf", dxf(back), note),
        ("g.dxf", dxf(space), note),
        ("g.geojson", line_in("").replace("[[1, 0], [8, 7]]", "[[1, 5, 0], [8, 5, 7]]"), note),
        ("g.wkt", "LINESTRING Z (1 5 0, 8 5 7)\n".to_owned(), note),
        ("g.csv", "trace,x,y,z\n1,1,5,0\n1,8,5,7\n".to_owned(), note),
        ("g.csv", "trace,x,z\n1,1,0\n1,8,7\n".to_owned(), note),
        ("g.csv", "x1,y1,z1,x2,y2,z2\n1,5,0,8,5,7\n".to_owned(), note),
        ("g.csv", "wkt\n\"LINESTRING Z (1 5 0, 8 5 7)\"\n".to_owned(), note),
        ("g.geojson", line_in("").replace("[[1, 0], [8, 7]]", "[[5, 1, 0], [5, 8, 7]]"), along_y),
        (
            "g.dxf",
            dxf(&line
                .replace("20\n5", "20\n1")
                .replace("21\n5", "21\n8")
                .replace("10\n1\n", "10\n5\n")
                .replace("11\n8\n", "11\n5\n")),
            along_y,
        ),
    ] {
        let loaded = with_geometry_and(name, &text, OUTLINE).unwrap();
        assert_eq!(points(&loaded), [[1.0, 0.0], [8.0, 7.0]], "{text}");
        assert!(loaded.case.reader_notes.iter().any(|told| told.ends_with(note)), "{text}: {loaded:?}");
        assert_eq!(loaded.warnings, [""; 0]);
    }
    // An arc about (2, 5, 0) in the upright plane, from its lowest point to the right.
    let arc = "0\nARC\n8\nclean\n10\n2\n20\n0\n30\n-5\n40\n1\n50\n270\n51\n0\n210\n0\n220\n-1\n230\n0\n";
    let loaded = with_geometry_and("g.dxf", &dxf(arc), OUTLINE).unwrap();
    let (first, last) = (points(&loaded)[0], points(&loaded)[points(&loaded).len() - 1]);
    assert!((first[1] + 1.0).abs() < 1e-12 && (last[0] - 3.0).abs() < 1e-12, "{:?}", points(&loaded));
    // Heights of points that are no section are not used.
    let loaded = with_geometry_and("g.csv", "trace,x,y,z\n1,1,0,4\n1,8,7,5\n", OUTLINE).unwrap();
    assert_eq!((points(&loaded), loaded.warnings.len()), (&[[1.0, 0.0], [8.0, 7.0]][..], 1));
    let mixed = with_geometry_and("g.dxf", &dxf(&(line.to_owned() + &arc.replace("230\n0\n", "230\n1\n"))), OUTLINE);
    assert!(mixed.is_err(), "an arc off the plane of a section was read");
}

#[test]
fn a_byte_order_mark_was_no_json() {
    let dxf = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nclean\n10\n1\n20\n0\n11\n8\n21\n7\n0\nENDSEC\n0\nEOF\n";
    for (name, text) in [
        ("g.geojson", line_in("")),
        ("g.json", "{\"joints\": [[[1, 0], [8, 7]]]}".to_owned()),
        ("g.dxf", dxf.to_owned()),
        ("g.wkt", "LINESTRING (1 0, 8 7)\n".to_owned()),
        ("g.csv", "trace,x,y\n1,1,0\n1,8,7\n".to_owned()),
    ] {
        let marked = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(points(&with_geometry_and(name, &marked, OUTLINE).unwrap()), [[1.0, 0.0], [8.0, 7.0]], "{name}");
    }
}

#[test]
fn features_by_lines_were_no_json() {
    let feature =
        |line: &str| format!("{{\"type\": \"Feature\", \"properties\": {{\"law\": \"clean\"}}, \"geometry\": {line}}}");
    let line = |x: &str| format!("{{\"type\": \"LineString\", \"coordinates\": [[{x}, 0], [8, 7]]}}");
    for mark in ["", "\u{1e}"] {
        for name in ["g.geojson", "g.geojsonl", "g.geojsons", "g.ndjson", "g.json"] {
            let text = format!("{mark}{}\n{mark}{}\n", feature(&line("1")), feature(&line("2")));
            let loaded = with_geometry_and(name, &text, OUTLINE).unwrap();
            assert_eq!(loaded.case.joints.len(), 2, "{name}");
            assert_eq!(loaded.case.joints[1].points, [[2.0, 0.0], [8.0, 7.0]]);
            let wrong = format!("{mark}{}\n{mark}{}\n", feature(&line("1")), feature(&line("\"NaN\"")));
            let error = with_geometry_and(name, &wrong, OUTLINE).unwrap_err();
            assert!(error.starts_with(&format!("{name}:2: features[1].geometry.coordinates[0]: x is NaN")), "{error}");
        }
    }
    let broken = format!("{}\n{{\"type\": \n", feature(&line("1")));
    let error = with_geometry_and("g.geojson", &broken, OUTLINE).unwrap_err();
    assert!(error.starts_with("g.geojson:2: not JSON: "), "{error}");
}

/// A cubic through points: straight through points of a line, and on a circle through points of one.
#[test]
fn splines_by_points_to_be_fitted_were_refused() {
    let spline = |points: &[[f64; 2]], more: &str| {
        let fit: String = points.iter().map(|[x, y]| format!("11\n{x}\n21\n{y}\n31\n0\n")).collect();
        let flags = if more.is_empty() { "70\n8\n" } else { more };
        let text = format!("0\nSECTION\n2\nENTITIES\n0\nSPLINE\n8\nclean\n{flags}71\n3\n{fit}0\nENDSEC\n0\nEOF\n");
        with_geometry_and("g.dxf", &text, OUTLINE).unwrap()
    };
    let straight = spline(&[[1.0, 0.0], [2.0, 1.0], [8.0, 7.0]], "");
    assert_eq!(points(&straight), [[1.0, 0.0], [2.0, 1.0], [8.0, 7.0]]);
    let note = "1 splines have points to be fitted alone; they are drawn as cubics through these, by chord length";
    assert!(straight.case.reader_notes.iter().any(|told| told.ends_with(note)), "{:?}", straight.case.reader_notes);
    let on_circle = |k: usize| {
        let (sin, cos) = (f64::from(k as u32) * 30.0).to_radians().sin_cos();
        [5.0 + 2.0 * cos, 4.0 + 2.0 * sin]
    };
    let off = |p: &[f64; 2]| (((p[0] - 5.0).powi(2) + (p[1] - 4.0).powi(2)).sqrt() - 2.0).abs();
    let round = spline(&(0..12).map(on_circle).collect::<Vec<_>>(), "70\n9\n");
    assert!(points(&round).len() > 12 && points(&round).iter().all(|p| off(p) < 1e-3), "{:?}", points(&round));
    assert_eq!(points(&round)[0], points(&round)[points(&round).len() - 1]);
    // A quarter circle with its directions at both ends, where the cubic without them would be straight at first.
    let quarter: Vec<[f64; 2]> = (0..=3).map(on_circle).collect();
    let clamped = spline(&quarter, "70\n8\n12\n0\n22\n1\n32\n0\n13\n-1\n23\n0\n33\n0\n");
    assert!(points(&clamped).iter().all(|p| off(p) < 1e-3), "{:?}", points(&clamped));
    let natural = spline(&quarter, "");
    assert!(points(&natural).iter().any(|p| off(p) > 5e-3), "{:?}", points(&natural));
}
