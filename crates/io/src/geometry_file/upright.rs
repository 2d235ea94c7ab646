//! Sections that stand upright in space: all points have one y (or one x), and heights in z.

/// The plane of a section.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Plane {
    /// x to the right and y up, as cases have it; heights are not used.
    #[default]
    Flat,
    /// x to the right and z up: all points have the same y.
    AlongX,
    /// y to the right and z up: all points have the same x.
    AlongY,
}

/// Share of the size of a section by which points may lie off its plane: digits of the programs that write them.
const OFF: f64 = 1e-6;

impl Plane {
    /// The plane of points in space; flat where one has no height.
    pub fn of(points: impl IntoIterator<Item = [Option<f64>; 3]>) -> Self {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for point in points {
            for (range, value) in ranges.iter_mut().zip(point) {
                let Some(value) = value.filter(|value| value.is_finite()) else { return Self::Flat };
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
        let [x, y, z] = ranges.map(|[low, high]| high - low);
        let is_thin = |across: f64, along: f64| across <= OFF * along.min(z) && along > 0.0 && z > 0.0;
        if is_thin(y, x) {
            Self::AlongX
        } else if is_thin(x, y) {
            Self::AlongY
        } else {
            Self::Flat
        }
    }

    /// The point in the section.
    pub fn point(self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        match self {
            Self::Flat => [x, y],
            Self::AlongX => [x, z],
            Self::AlongY => [y, z],
        }
    }

    /// The axis that points towards the eye, and its sense, when the section is seen with its right at the right.
    pub fn towards(self) -> (usize, f64) {
        match self {
            Self::Flat => (2, 1.0),
            Self::AlongX => (1, -1.0),
            Self::AlongY => (0, 1.0),
        }
    }

    /// A note of a section that stands upright.
    pub fn note(self) -> Option<String> {
        let (one, right) = match self {
            Self::Flat => return None,
            Self::AlongX => ("y", "x"),
            Self::AlongY => ("x", "y"),
        };
        Some(format!(
            "the section stands upright: all points have the same {one}, so {right} is taken to the right and z up"
        ))
    }
}
