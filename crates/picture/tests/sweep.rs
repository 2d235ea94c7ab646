//! Pictures of sweeps show the crossing, the line of the limit and effects, and are drawn for every input.

use enmm_picture::{Bars, Curve, Grid, bars_picture, curve_picture, grid_picture};

fn curve(points: &[[f64; 2]]) -> Curve {
    Curve {
        title: "A slope".to_owned(),
        caption: "two samples".to_owned(),
        axes: ["joint_law.plane.friction_deg", "factor"].map(str::to_owned),
        points: points.to_vec(),
        limit: Some(1.0),
        crossings: vec![26.5],
    }
}

#[test]
fn a_curve_names_its_crossing() {
    let svg = curve_picture(&curve(&[[20.0, 0.7], [30.0, 1.3], [f64::NAN, 2.0]])).svg();
    for part in ["A slope", "F = 1.00 at 26.5", "joint_law.plane.friction_deg"] {
        assert!(svg.contains(part), "{part:?} is not in the picture");
    }
    assert!(!svg.contains("NaN"));
    for points in [&[][..], &[[5.0, f64::INFINITY]]] {
        assert!(curve_picture(&curve(points)).svg().contains("no factors"));
    }
    assert!(!curve_picture(&Curve { limit: None, ..curve(&[[2.0, 2.0]]) }).svg().contains("F = "));
}

/// The field x + y on a square: the line of the limit 1 runs from corner to corner, in the four triangles of the cell.
#[test]
fn a_contour_has_the_line_of_the_limit() {
    let grid = |outputs: &[f64], limit: Option<f64>| Grid {
        axes: ["a", "b"].map(str::to_owned),
        name: "factor".to_owned(),
        values: [vec![0.0, 1.0], vec![0.0, 1.0]],
        outputs: outputs.to_vec(),
        limit,
        ..Grid::default()
    };
    // The line is white, then red, as no other mark.
    let widths = |svg: &str| ["stroke-width=\"7\"", "stroke=\"#be125a\""].map(|mark| svg.matches(mark).count());
    let svg = grid_picture(&grid(&[0.0, 1.0, 1.0, 2.0], Some(1.0))).svg();
    assert_eq!(widths(&svg), [1, 1], "{svg}");
    assert_eq!(widths(&grid_picture(&grid(&[0.0, 1.0, 1.0, 2.0], Some(3.0))).svg()), [0, 0]);
    assert_eq!(widths(&grid_picture(&grid(&[0.0, 1.0, 1.0, 2.0], None)).svg()), [0, 0]);
    for outputs in [[0.0, f64::NAN, 1.0, 2.0], [1.0; 4], [f64::NAN; 4]] {
        let svg = grid_picture(&grid(&outputs, Some(1.0))).svg();
        assert!(!svg.contains("NaN") && svg.contains("no factors") == outputs[0].is_nan(), "{outputs:?}");
    }
}

#[test]
fn bars_tell_the_values_at_their_ends_and_what_changes_nothing() {
    let bar = |key: &str, ends: &[(&str, f64)]| {
        (key.to_owned(), ends.iter().map(|(value, factor)| ((*value).to_owned(), *factor)).collect())
    };
    let bars = Bars {
        name: "factor".to_owned(),
        base: Some(1.2),
        limit: Some(1.0),
        bars: vec![bar("friction", &[("20", 0.9), ("28", 1.1), ("35", 1.6)]), bar("density", &[("2000", 1.2)])],
        ..Bars::default()
    };
    let svg = bars_picture(&bars).svg();
    for part in ["friction", "density", ">20<", ">35<", "no change"] {
        assert!(svg.contains(part), "{part:?} is not in the picture");
    }
    assert!(!svg.contains(">28<"), "values within a bar have no label");
    assert!(bars_picture(&Bars { base: None, limit: None, bars: Vec::new(), ..bars }).svg().contains("no factors"));
}
