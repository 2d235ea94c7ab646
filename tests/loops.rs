//! Loops of faces are nested and directed as drawn.

use enmm::geometry::loops::*;
use enmm::geometry::polygon::area;
use enmm::geometry::{GeometryError, Point};

fn square(x: f64, y: f64, side: f64) -> Vec<Point> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|p| Point::new(x + side * p[0], y + side * p[1])).to_vec()
}

fn circle(count: usize) -> Vec<Point> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    (0..count).map(|k| Point::new(angle(k).cos(), angle(k).sin())).collect()
}

#[test]
fn clockwise_loop_with_closing_point_comes_back_counter_clockwise() {
    let mut points = square(1.0, 1.0, 2.0);
    points.reverse();
    points.push(points[0]);
    let valid = validate_loop(&points, "outline").unwrap();
    assert_eq!(valid.len(), 4);
    assert_eq!(area(&valid), 4.0);
}

#[test]
fn useless_loops_are_refused_by_name() {
    let point = Point::new;
    let bow = [point(0.0, 0.0), point(2.0, 2.0), point(2.0, 0.0), point(0.0, 2.0)];
    let Err(GeometryError::SelfIntersection { x, y, .. }) = validate_loop(&bow, "bow") else { panic!("bow") };
    assert_eq!((x, y), (1.0, 1.0));
    let spike = [point(0.0, 0.0), point(2.0, 0.0), point(1.0, 0.0), point(1.0, 1.0)];
    assert!(matches!(validate_loop(&spike, "spike"), Err(GeometryError::SelfIntersection { .. })));
    let touch = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]].map(|p| point(p[0], p[1]));
    assert!(matches!(validate_loop(&touch, "touch"), Err(GeometryError::SelfIntersection { .. })));
    let flat = [point(0.0, 0.0), point(1.0, 0.0), point(0.5, 1e-14)];
    assert!(matches!(validate_loop(&flat, "flat"), Err(GeometryError::NoArea { .. })));
    let two = [point(0.0, 0.0), point(1.0, 0.0), point(1.0, 0.0), point(0.0, 0.0)];
    assert!(matches!(validate_loop(&two, "two"), Err(GeometryError::TooFewPoints { found: 2, .. })));
    let nan = [point(0.0, 0.0), point(f64::NAN, 0.0), point(1.0, 1.0)];
    let message = validate_loop(&nan, "hole 3").unwrap_err().to_string();
    assert!(message.contains("hole 3") && message.contains("point 1"), "{message}");
}

#[test]
fn large_loops_are_checked_in_about_linear_time() {
    // A quadratic check of 200 000 sides takes minutes; only a run that never ends can fail here.
    let mut points = circle(200_000);
    assert!(validate_loop(&points, "circle").is_ok());
    points.swap(70_000, 70_001);
    assert!(matches!(validate_loop(&points, "circle"), Err(GeometryError::SelfIntersection { .. })));
}

#[test]
fn holes_and_islands_must_be_in_place() {
    let outline = square(0.0, 0.0, 10.0);
    let holes = vec![square(1.0, 1.0, 3.0), square(5.0, 5.0, 3.0)];
    let in_hole = square(2.0, 2.0, 1.0);
    let outside = square(20.0, 0.0, 5.0);
    let on_top = square(2.0, 10.0, 2.0);
    assert_eq!(validate_holes(&outline, &holes, &[in_hole.clone(), outside, on_top]), Ok(()));
    let error = |holes: &[Vec<Point>], islands: &[Vec<Point>]| validate_holes(&outline, holes, islands).unwrap_err();
    let meet = error(&[square(8.0, 8.0, 3.0)], &[]);
    assert!(matches!(meet, GeometryError::LoopsMeet { .. }), "{meet}");
    let away = error(&[square(18.0, 8.0, 3.0)], &[]);
    assert!(matches!(away, GeometryError::HoleMisplaced { hole: 0, .. }), "{away}");
    let nested = error(&[square(1.0, 1.0, 3.0), square(2.0, 2.0, 1.0)], &[]);
    assert!(matches!(nested, GeometryError::HoleMisplaced { hole: 1, .. }), "{nested}");
    for island in [square(6.0, 1.0, 1.0), square(3.0, 3.0, 2.0), square(-20.0, -20.0, 50.0)] {
        let on_rock = error(&holes, &[in_hole.clone(), island]);
        assert!(matches!(on_rock, GeometryError::IslandOnRock { island: 1, .. }), "{on_rock}");
    }
    let twice = error(&holes, &[in_hole.clone(), in_hole.clone()]);
    assert!(matches!(twice, GeometryError::IslandOnRock { island: 1, .. }), "{twice}");
}
