//! The part of a piece of joint that is under pressure.

use enmm_seepage::law::{pressure_head, wet_share};

/// The wet part of a piece: shares of its length from the first node on, and the pressure heads (m) there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wet {
    /// Shares of the length between which it lies.
    pub span: [f64; 2],
    /// Pressure heads (m) at both ends of that part, linear between them.
    pub heads: [f64; 2],
}

/// The wet part of a piece between nodes with these unknowns `u` and heights (m); none of a dry one. Where the upper
/// node has no pressure, the water stands below a free surface (Eq. 99).
pub fn wet(u: [f64; 2], heights: [f64; 2]) -> Option<Wet> {
    let heads = u.map(pressure_head);
    let [upper, lower] = if heights[0] < heights[1] { [1, 0] } else { [0, 1] };
    if heads[upper] > 0.0 {
        return Some(Wet { span: [0.0, 1.0], heads });
    }
    let (first, second) = if heads[lower] > 0.0 { (lower, upper) } else { return None };
    let share = wet_share(heads[first], heights[upper] - heights[lower]);
    let mut wet = Wet { span: [0.0; 2], heads: [0.0; 2] };
    wet.heads[first] = heads[first];
    wet.span[first] = first as f64;
    wet.span[second] = if second == 1 { share } else { 1.0 - share };
    Some(wet)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wet_part_ends_at_the_free_surface() {
        let part = |u, heights| wet(u, heights).map(|Wet { span, heads }| (span, heads));
        assert_eq!(part([1.0, -1.0], [0.0, 4.0]), Some(([0.0, 0.25], [1.0, 0.0])));
        assert_eq!(part([-0.5, 1.0], [4.0, 0.0]), Some(([0.75, 1.0], [0.0, 1.0])));
        assert_eq!(part([5.0, -1.0], [0.0, 4.0]), Some(([0.0, 1.0], [5.0, 0.0])));
        assert_eq!(part([-1.0, 2.0], [0.0, 4.0]), Some(([0.0, 1.0], [0.0, 2.0])));
        assert_eq!(part([3.0, 2.0], [0.0, 4.0]), Some(([0.0, 1.0], [3.0, 2.0])));
        assert_eq!(part([-1.0, 3.0], [2.0, 2.0]), Some(([0.0, 1.0], [0.0, 3.0])));
        assert_eq!(part([3.0, -1.0], [2.0, 2.0]), Some(([0.0, 1.0], [3.0, 0.0])));
        assert_eq!(part([-1.0, 0.0], [0.0, 4.0]), None);
    }
}
