//! Places in both nets are those of the formulas, and a net shows what its checks find.

use enmm_picture::{Projection, Stereonet};
use enmm_stability::kinematics::{Joints, Limits, Line, Plane};

#[test]
fn lines_lie_where_the_projections_put_them() {
    let close = |[x, y]: [f64; 2], [a, b]: [f64; 2]| (x - a).abs() < 1e-12 && (y - b).abs() < 1e-12;
    // A plunge of 45° towards east: √2·sin(22.5°) and tan(22.5°) from the centre; a level line lies on the rim.
    let line = Line { plunge: 45.0, trend: 90.0 };
    let turned = 22.5f64.to_radians();
    assert!(close(Projection::EqualArea.place(&line), [2f64.sqrt() * turned.sin(), 0.0]));
    assert!(close(Projection::EqualAngle.place(&line), [turned.tan(), 0.0]));
    for projection in [Projection::EqualArea, Projection::EqualAngle] {
        assert!(close(projection.place(&Line { plunge: 0.0, trend: 180.0 }), [0.0, 1.0]));
        assert!(close(projection.place(&Line { plunge: 90.0, trend: 77.0 }), [0.0, 0.0]));
    }
}

#[test]
fn a_net_names_what_fails() {
    let set =
        |name: &str, dip, direction| Joints { name: name.to_owned(), plane: Plane { dip, direction }, friction: 30.0 };
    let net = Stereonet {
        title: "A cut <north>".to_owned(),
        face: Plane { dip: 65.0, direction: 120.0 },
        sets: vec![set("bedding", 40.0, 125.0), set("K1", 60.0, 60.0), set("columns", 80.0, 300.0)],
        remarks: vec![String::new(); 3],
        limits: Limits::default(),
        projection: Projection::EqualArea,
        notes: vec!["a note".to_owned()],
    };
    assert_eq!(net.friction(), Some(30.0));
    let svg = net.picture().svg();
    for part in
        ["A cut &lt;north&gt;", "plane failure: bedding", "toppling: columns", "1+K1", "face 65°/120°", "a note"]
    {
        assert!(svg.contains(part), "{part:?} is not in the picture");
    }
    assert!(!svg.contains("NaN"));
    // A face flatter than friction has no zone, a net without sets no circle.
    let flat = Stereonet { face: Plane { dip: 20.0, direction: 0.0 }, ..net.clone() };
    assert_eq!(flat.findings(&flat.failures())[0], "plane failure: none");
    let empty = Stereonet { sets: Vec::new(), remarks: Vec::new(), ..net };
    assert!(!empty.picture().svg().contains("friction"));
}
