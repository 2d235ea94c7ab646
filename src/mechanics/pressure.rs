//! Pressure on an edge of the boundary, with rock on the left of the way from its first end to its second.

use crate::geometry::{Point, Vector};

/// Forces (N/m) at both ends of the edge from `a` to `b` under a uniform pressure (Pa) that pushes into the rock.
pub fn uniform(a: Point, b: Point, pressure: f64) -> [Vector; 2] {
    [inward(a, b) * (0.5 * pressure); 2]
}

/// Forces (N/m) at both ends of the edge from `a` to `b` under still water of unit weight `weight` (N/m³) with its
/// surface at height `level` (m): the pressure is weight·(level − y) below the level and none above (Eq. 30).
pub fn hydrostatic(a: Point, b: Point, level: f64, weight: f64) -> [Vector; 2] {
    let depth = [level - a.y, level - b.y];
    let inward = inward(a, b) * weight;
    let share = |wet: f64, dry: f64| wet / (wet - dry);
    match depth.map(|d| d > 0.0) {
        [false, false] => [Vector::zeros(); 2],
        [true, true] => [inward * ((2.0 * depth[0] + depth[1]) / 6.0), inward * ((depth[0] + 2.0 * depth[1]) / 6.0)],
        [true, false] => {
            let s = share(depth[0], depth[1]);
            [inward * (depth[0] * s * (3.0 - s) / 6.0), inward * (depth[0] * s * s / 6.0)]
        }
        [false, true] => {
            let s = share(depth[1], depth[0]);
            [inward * (depth[1] * s * s / 6.0), inward * (depth[1] * s * (3.0 - s) / 6.0)]
        }
    }
}

/// Normal into the rock, as long as the edge.
pub fn inward(a: Point, b: Point) -> Vector {
    Vector::new(a.y - b.y, b.x - a.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_on_a_submerged_square_is_its_weight_of_water_and_turns_nothing() {
        let corners = [Point::new(1.0, 1.0), Point::new(3.0, 1.5), Point::new(2.5, 3.5), Point::new(0.5, 3.0)];
        let (mut force, mut moment) = (Vector::zeros(), 0.0);
        for k in 0..4 {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            let [fa, fb] = hydrostatic(a, b, 10.0, 9810.0);
            force += fa + fb;
            moment += a.perp(&fa) + b.perp(&fb);
        }
        let area = 4.25;
        let centre = Point::new(1.75, 2.25);
        assert!((force - Vector::new(0.0, 9810.0 * area)).norm() < 1e-9, "{force}");
        assert!((moment - centre.x * 9810.0 * area).abs() < 1e-8, "{moment}");
    }

    #[test]
    fn water_on_a_wall_that_rises_above_it_acts_a_third_of_the_depth_from_the_bottom() {
        // The rock lies to the left of the way up, hence the water to the right.
        let (foot, top) = (Point::new(0.0, 0.0), Point::new(0.0, 5.0));
        let [at_foot, at_top] = hydrostatic(foot, top, 3.0, 10.0);
        assert!((at_foot.x + at_top.x + 0.5 * 10.0 * 9.0).abs() < 1e-12);
        assert!((at_top.x * 5.0 + 45.0 * 1.0).abs() < 1e-12);
        let [down_top, down_foot] = hydrostatic(top, foot, 3.0, 10.0);
        assert!((down_foot + at_foot).norm() + (down_top + at_top).norm() < 1e-12);
        assert_eq!(hydrostatic(foot, top, -1.0, 10.0), [Vector::zeros(); 2]);
    }
}
