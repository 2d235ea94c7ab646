//! Cells of outlines: every point of a body belongs to the face under which it lies least deep.

use enmm_patch::cell::cells;
use enmm_patch::{Outline, Vector};

use super::parts::{Random, points, rectangle};

/// Of a convex outline the owner is the nearest face, and there is one for every point inside.
#[test]
fn cells_of_convex_bodies_own_what_is_nearest() {
    let mut random = Random::new(5);
    let (mut inside, mut shapes) = (0, 0);
    while shapes < 200 {
        let count = 3 + (random.share() * 9.0) as usize;
        let mut angles: Vec<f64> = (0..count).map(|_| random.between(0.0, std::f64::consts::TAU)).collect();
        angles.sort_by(f64::total_cmp);
        let thin = random.between(0.05, 1.0);
        let outline = Outline::new(angles.iter().map(|angle| Vector::new(angle.cos(), thin * angle.sin())).collect());
        if outline.area() < 1e-2 {
            continue;
        }
        shapes += 1;
        let cells = cells(&outline, f64::INFINITY);
        for _ in 0..50 {
            let point = Vector::new(random.between(-1.0, 1.0), random.between(-thin, thin));
            let at: Vec<Vector> = (0..outline.len()).map(|k| outline.face(k).local(point)).collect();
            let depth = at.iter().map(|local| local.y).fold(f64::INFINITY, f64::min);
            let owners: Vec<usize> = (0..at.len()).filter(|&k| cells[k].owns(at[k])).collect();
            let second = at.iter().map(|local| local.y).filter(|y| *y > depth).fold(f64::INFINITY, f64::min);
            if depth.abs() < 1e-9 || second - depth < 1e-9 {
                continue;
            }
            assert_eq!(owners.len(), usize::from(depth > 0.0), "{at:?}");
            if let [owner] = owners[..] {
                assert_eq!(at[owner].y, depth);
                inside += 1;
            }
        }
    }
    assert!(inside > 2000);
}

/// The roof over a rectangle of 2 m × 1 m is known: the short faces end in triangles, the long ones in trapezoids.
#[test]
fn cells_of_a_rectangle_end_at_its_middle_line() {
    let outline = Outline::new(rectangle([0.0, 0.0], [2.0, 1.0]));
    let cells = cells(&outline, f64::INFINITY);
    for cell in &cells {
        assert_eq!(cell.bands.last().map(|band| band.depths[1]), Some(0.5));
    }
    let [long, short] = [0, 1].map(|k| cells[k].bands[0].bounds.map(|bound| bound.position(0.5)));
    assert_eq!((long, short), ([0.5, 1.5], [0.5, 0.5]));
}

/// At a reflex kink the cells meet on the bisector as well, and a face between a convex and a reflex one that has
/// vanished is passed over: depths of owners are equal on both sides of every border.
#[test]
fn depths_of_owners_are_continuous_in_bodies_with_notches() {
    let notched = Outline::new(points(&[
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 0.0],
        [0.5, 0.0],
        [0.495, -0.01],
        [0.3, -0.012],
        [0.29, 0.0],
        [-1.0, 0.0],
    ]));
    let reach = 0.08;
    let cells = cells(&notched, reach);
    let owner = |point: Vector| {
        let at: Vec<Vector> = (0..notched.len()).map(|k| notched.face(k).local(point)).collect();
        (0..at.len()).find(|&k| cells[k].owns(at[k])).map(|k| (k, at[k].y))
    };
    let (mut random, mut crossed) = (Random::new(9), 0);
    for _ in 0..40_000 {
        let from = Vector::new(random.between(0.2, 0.6), random.between(-0.07, -0.001));
        let way = Vector::new(random.between(-1e-3, 1e-3), random.between(-1e-3, 1e-3));
        let to = from + way;
        if let (Some((a, depth)), Some((b, other))) = (owner(from), owner(to)) {
            assert!((depth - other).abs() <= way.norm() + 1e-12, "{from:?} {a} {b} {depth} {other}");
            crossed += usize::from(a != b);
        }
    }
    assert!(crossed > 100, "{crossed}");
}
