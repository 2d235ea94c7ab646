//! Areas, centroids and clippings of polygons are those of hand calculations.

use enmm::geometry::polygon::*;
use enmm::geometry::{Point, Vector};

fn polygon(list: &[[f64; 2]]) -> Vec<Point> {
    list.iter().map(|p| Point::new(p[0], p[1])).collect()
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<Point> {
    polygon(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
}

/// A comb: a bar with three teeth upwards, 2 wide, 1 apart, 3 high.
fn comb() -> Vec<Point> {
    let mut list = vec![[0.0, -1.0], [8.0, -1.0]];
    for k in [2.0, 1.0, 0.0] {
        let x = 3.0 * k;
        list.extend([[x + 2.0, 0.0], [x + 2.0, 3.0], [x, 3.0], [x, 0.0]]);
    }
    polygon(&list)
}

#[test]
fn moments_of_a_far_rectangle_match_the_closed_form() {
    // ∫x² over [0,w] is w³h/3, ∫xy is w²h²/4; the far position must not cost digits of area and centroid.
    let (w, h, far) = (3.0, 2.0, Vector::new(4.0e6, 6.0e6));
    let position = |k: &Point| k + far;
    let shape: Vec<Point> = rectangle(0.0, 0.0, w, h).iter().map(position).collect();
    let m = Moments::of(&shape, far);
    assert_eq!(m.area, 6.0);
    assert_eq!(m.first, Vector::new(9.0, 6.0));
    for (found, exact) in m.second.iter().zip([18.0, 8.0, 9.0]) {
        assert!((found - exact).abs() < 1e-14 * exact, "{found} {exact}"); // a few roundings of numbers of order 10
    }
    assert_eq!(centroid(&shape), far + Vector::new(1.5, 1.0));
    let about_origin = Moments::of(&shape, Point::zeros());
    let back = about_origin.shifted(-far);
    assert!((back.first - m.first).norm() < 1e-8); // 6e6·6 rounds to 7e-9
}

#[test]
fn moments_add_up_over_parts() {
    let whole = Moments::of(&rectangle(1.0, 2.0, 4.0, 3.0), Point::zeros());
    let parts = Moments::of(&rectangle(1.0, 2.0, 1.5, 3.0), Point::zeros())
        + Moments::of(&rectangle(2.5, 2.0, 2.5, 3.0), Point::zeros());
    assert!((whole.area - parts.area).abs() < 1e-13 && (whole.first - parts.first).norm() < 1e-12);
    assert!(whole.second.iter().zip(parts.second).all(|(a, b)| (a - b).abs() < 1e-11)); // sums near 300
}

#[test]
fn boundary_is_inside_and_the_notch_is_not() {
    let comb = comb();
    for p in [[0.0, 0.0], [8.0, 3.0], [1.0, 3.0], [5.0, 1.5], [2.5, 0.0], [4.0, -1.0]] {
        assert!(contains(&comb, Point::new(p[0], p[1])), "{p:?}");
    }
    for p in [[2.5, 1.0], [5.5, 3.0], [-1e-300, 0.0], [8.0 + 1e-15, 3.0 + 1e-15], [9.0, 0.0], [-1.0, 3.0]] {
        assert!(!contains(&comb, Point::new(p[0], p[1])), "{p:?}");
    }
}

#[test]
fn triangles_of_a_comb_cover_it_once() {
    let total: f64 = triangles(&comb()).iter().map(|t| area(t)).sum();
    assert_eq!(total, 26.0);
    let mut clockwise = comb();
    clockwise.reverse();
    assert_eq!(triangles(&clockwise).iter().map(|t| area(t)).sum::<f64>(), 26.0);
}

#[test]
fn overlap_of_a_bar_across_a_comb_is_its_three_teeth() {
    let bar = rectangle(-1.0, 1.0, 12.0, 0.25);
    assert!((overlap_area(&comb(), &bar) - 1.5).abs() < 1e-13);
    // No corner of one lies in the other; triangles of the comb narrow the pieces, convex shapes stay whole.
    let depth = overlap_depth(&comb(), &bar);
    assert!(depth > 0.1 && depth <= 0.25, "{depth}");
    assert!((overlap_depth(&rectangle(0.0, 0.0, 2.0, 3.0), &bar) - 0.25).abs() < 1e-15);
}

#[test]
fn depth_of_a_corner_in_a_face_is_its_distance() {
    let base = rectangle(-5.0, -2.0, 10.0, 2.0);
    let corner = polygon(&[[0.0, -0.01], [1.0, 1.0], [-1.0, 1.0]]);
    assert!((overlap_depth(&base, &corner) - 0.01).abs() < 1e-14);
    assert_eq!(overlap_depth(&base, &rectangle(0.0, 0.0, 1.0, 1.0)), 0.0);
    assert_eq!(overlap_area(&base, &rectangle(0.0, 0.0, 1.0, 1.0)), 0.0);
}

#[test]
fn polygon_that_touches_itself_keeps_its_area() {
    // A square with a triangular notch whose tip touches the opposite side.
    let shape =
        polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.5, 2.0], [1.0, 0.0], [0.5, 2.0], [0.0, 2.0]]);
    let total: f64 = triangles(&shape).iter().map(|t| area(t)).sum();
    assert!((total - area(&shape)).abs() < 1e-14);
}
