//! Tests whether boxes or edges are within the cutoff, eight at once.

use enmm_lanes::{LANES, Lanes};

use crate::geometry::Point;

/// Least and greatest x and y of a box.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    pub low: Point,
    pub high: Point,
}

/// Eight boxes, one in each lane: low x, low y, high x, high y.
pub type Boxes = [[f64; LANES]; 4];
/// Boxes that are near nothing.
pub const NOWHERE: Boxes = [[f64::INFINITY; LANES]; 4];

impl Span {
    /// Near nothing.
    pub const NOWHERE: Self =
        Self { low: Point::new(f64::INFINITY, f64::INFINITY), high: Point::new(f64::INFINITY, f64::INFINITY) };

    pub fn at(point: Point) -> Self {
        Self { low: point, high: point }
    }

    pub fn with(&self, point: Point) -> Self {
        Self { low: self.low.inf(&point), high: self.high.sup(&point) }
    }

    pub fn middle(&self) -> Point {
        (self.low + self.high) * 0.5
    }

    /// Puts the box into one of eight lanes.
    #[inline(always)]
    pub fn put(&self, boxes: &mut Boxes, lane: usize) {
        for (lanes, x) in boxes.iter_mut().zip([self.low.x, self.low.y, self.high.x, self.high.y]) {
            lanes[lane] = x;
        }
    }
}

/// The cutoff in all lanes.
pub struct Within<L: Lanes> {
    lanes: L,
    cutoff: L::F,
    square: L::F,
}

impl<L: Lanes> Within<L> {
    #[inline(always)]
    pub fn new(lanes: L, cutoff: f64) -> Self {
        Self { lanes, cutoff: lanes.splat(cutoff), square: lanes.splat(greatest_square(cutoff)) }
    }

    /// Which of eight boxes are within the cutoff of a box, along both axes.
    #[inline(always)]
    pub fn boxes(&self, Span { low, high }: Span, boxes: &Boxes) -> u8 {
        let Self { lanes, cutoff, .. } = *self;
        let [left, bottom] = [lanes.load(&boxes[0]), lanes.load(&boxes[1])];
        let [right, top] = [lanes.load(&boxes[2]), lanes.load(&boxes[3])];
        lanes.at_most(left - lanes.splat(high.x), cutoff)
            & lanes.at_most(bottom - lanes.splat(high.y), cutoff)
            & lanes.at_most(lanes.splat(low.x) - right, cutoff)
            & lanes.at_most(lanes.splat(low.y) - top, cutoff)
    }

    /// Which of eight consecutive edges, between nine points, are nearer to a point than the cutoff: with the bits of
    /// [`segment::distance`](crate::geometry::segment::distance).
    #[inline(always)]
    pub fn edges(&self, p: Point, x: &[f64; LANES + 1], y: &[f64; LANES + 1]) -> u8 {
        let lanes = self.lanes;
        let ([x, dx], [y, dy]) = (self.along_axis(p.x, x), self.along_axis(p.y, y));
        let [zero, one, least] = [lanes.splat(0.0), lanes.splat(1.0), lanes.splat(f64::MIN_POSITIVE)];
        let along = (x * dx + y * dy) / lanes.max(dx * dx + dy * dy, least);
        let along = lanes.min(lanes.max(along, zero), one);
        let (x, y) = (x - dx * along, y - dy * along);
        lanes.at_most(x * x + y * y, self.square)
    }

    /// Distance along one axis from the starts of eight edges to a point, and to their ends.
    #[inline(always)]
    fn along_axis(&self, p: f64, points: &[f64; LANES + 1]) -> [L::F; 2] {
        let (start, end) = (self.lanes.load_some(&points[..LANES], p), self.lanes.load_some(&points[1..], p));
        [self.lanes.splat(p) - start, end - start]
    }
}

/// The greatest number whose square root, as computed, is below a positive number.
fn greatest_square(root: f64) -> f64 {
    let mut square = root * root;
    while square.sqrt() < root {
        square = square.next_up();
    }
    while square.sqrt() >= root {
        square = square.next_down();
    }
    square
}

/// Marked lanes of up to eight groups of eight, visited together, so that the processor has to predict only their
/// number.
#[derive(Default)]
pub struct Marks {
    eights: [u32; LANES],
    count: usize,
    bits: u64,
}

impl Marks {
    /// Adds a group with its marks; visits the earlier ones first if the buffer is full.
    #[inline(always)]
    pub fn push(&mut self, eight: u32, marks: u8, see: &mut impl FnMut(u32, usize)) {
        if self.count == LANES {
            self.see(see);
        }
        self.eights[self.count] = eight;
        self.bits |= u64::from(marks) << (self.count * LANES);
        self.count += 1;
    }

    /// Visits every marked lane with its group, in order, and clears the marks.
    #[inline(always)]
    pub fn see(&mut self, see: &mut impl FnMut(u32, usize)) {
        while self.bits != 0 {
            let bit = self.bits.trailing_zeros() as usize;
            see(self.eights[bit / LANES], bit % LANES);
            self.bits &= self.bits - 1;
        }
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use enmm_lanes::{Kernel, Path, dispatch_on};

    use super::*;
    use crate::geometry::segment;

    #[test]
    fn the_greatest_square_has_a_root_below_and_the_next_one_has_not() {
        for root in [0.25, 0.1, 1.0 / 3.0, 7.3e-5, 1.9e8] {
            let square = greatest_square(root);
            assert!(square.sqrt() < root && square.next_up().sqrt() >= root, "{root}");
        }
    }

    struct Edges([f64; LANES + 1], [f64; LANES + 1], f64);

    impl Kernel for Edges {
        type Output = u8;

        #[inline(always)]
        fn run<L: Lanes>(self, lanes: L) -> u8 {
            Within::new(lanes, self.2).edges(Point::new(0.3, 0.2), &self.0, &self.1)
        }
    }

    /// The cutoff is the very distance of one of the edges, or the number after it; one edge has no length.
    #[test]
    fn edges_are_within_the_cutoff_where_their_distance_is_less() {
        let [mut x, mut y] = [7, 3].map(|step| std::array::from_fn(|k| ((k * step) % 11) as f64 / 10.0 - 0.37));
        (x[4], y[4]) = (x[3], y[3]);
        let point = |k: usize| Point::new(x[k], y[k]);
        let distances: [f64; LANES] =
            std::array::from_fn(|k| segment::distance(Point::new(0.3, 0.2), point(k), point(k + 1)));
        for cutoff in distances.into_iter().flat_map(|d| [d, d.next_up(), d.next_down()]) {
            let expected = (0..LANES).fold(0, |bits, k| bits | u8::from(distances[k] < cutoff) << k);
            for path in Path::all() {
                assert_eq!(dispatch_on(path, Edges(x, y, cutoff)), expected, "{} at {cutoff}", path.name());
            }
        }
    }
}
