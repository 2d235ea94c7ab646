//! Cells about scattered centres: polygons of Voronoi and the triangles between their centres, as edges.
//!
//! The plane is divided into squares with one centre each, drawn by the numbers of its square, and two rounds of Lloyd
//! move each centre to the centroid of its polygon. What lies in a box depends on nothing outside its neighbourhood,
//! so that the same seed gives the same cells whatever box is asked for.

use std::collections::BTreeMap;

use crate::philox::{block, unit};

/// Rounds in which centres move to the centroids of their polygons.
const ROUNDS: i64 = 2;
/// Squares beyond the box that a round looks at: more than any polygon reaches.
const REACH: i64 = 5;
/// Squares beyond the box whose centres are not relaxed in all rounds.
const RIM: i64 = (ROUNDS + 1) * REACH;
/// Second word of the key, apart from those of other random numbers with the same seed.
const LABEL: u64 = 0x7465_7373_656c_6c61;
/// Edges of polygons shorter than this part of the side of a square are drawn together.
const SHORT: f64 = 0.02;

type Point = [f64; 2];

/// Centres by their squares.
struct Centres {
    /// First square and number of squares along both axes.
    first: [i64; 2],
    count: [i64; 2],
    /// Side of the squares (m).
    side: f64,
    points: Vec<Point>,
    /// Greatest distance (m) of a centre from the middle of its square.
    strays: f64,
}

/// A polygon about a centre: each corner, and the centre beyond the edge that begins there.
type Polygon = Vec<(Point, Option<usize>)>;

impl Centres {
    /// Draws the centres of the squares about a box, `margin` squares beyond it.
    fn draw(seed: u64, side: f64, [low, high]: [Point; 2], margin: i64) -> Self {
        let square = |x: f64| (x / side).floor() as i64;
        let first = low.map(|x| square(x) - margin);
        let count = [0, 1].map(|k| square(high[k]) + margin + 1 - first[k]);
        let mut centres = Self { first, count, side, points: Vec::new(), strays: side };
        for k in 0..(count[0] * count[1]) as usize {
            let [i, j] = centres.square(k);
            let words = block([seed, LABEL], [i as u64, j as u64, 0, 0]);
            centres.points.push([(i as f64 + unit(words[0])) * side, (j as f64 + unit(words[1])) * side]);
        }
        centres
    }

    fn square(&self, k: usize) -> [i64; 2] {
        let k = k as i64;
        [self.first[0] + k % self.count[0], self.first[1] + k / self.count[0]]
    }

    fn index(&self, square: [i64; 2]) -> Option<usize> {
        let [i, j] = [0, 1].map(|k| square[k] - self.first[k]);
        let within = (0..self.count[0]).contains(&i) && (0..self.count[1]).contains(&j);
        within.then_some((j * self.count[0] + i) as usize)
    }

    /// Whether a square is at least `margin` squares inside.
    fn is_inside(&self, k: usize, margin: i64) -> bool {
        let at = self.square(k);
        (0..2).all(|axis| (margin..self.count[axis] - margin).contains(&(at[axis] - self.first[axis])))
    }

    /// The polygon of a centre: what is nearer to it than to any other one.
    fn polygon(&self, own: usize) -> Polygon {
        let centre = self.points[own];
        let wide = 4.0 * self.side;
        let corners = [[-wide, -wide], [wide, -wide], [wide, wide], [-wide, wide]];
        let mut polygon: Polygon = corners.map(|[x, y]| ([centre[0] + x, centre[1] + y], None)).to_vec();
        let at = self.square(own);
        let mut ring = 1;
        loop {
            for square in ring_about(at, ring) {
                if let Some(other) = self.index(square) {
                    polygon = cut(polygon, centre, (other, self.points[other]));
                }
            }
            let reach = polygon.iter().map(|(p, _)| square_of(*p, centre)).fold(0.0, f64::max).sqrt();
            ring += 1;
            if ring as f64 * self.side - 2.0 * self.strays > 2.0 * reach || ring > 2 * REACH {
                return polygon;
            }
        }
    }

    /// Moves the centres to the centroids of their polygons, but for those near the rim.
    fn relax(&mut self, margin: i64) {
        let all: Vec<Point> = (0..self.points.len())
            .map(|k| if self.is_inside(k, margin) { centroid(&self.polygon(k)) } else { self.points[k] })
            .collect();
        self.points = all;
        let stray = |k: usize| {
            let middle = self.square(k).map(|i| (i as f64 + 0.5) * self.side);
            square_of(self.points[k], middle)
        };
        self.strays = (0..self.points.len()).map(stray).fold(0.0, f64::max).sqrt();
    }

    /// Edges of all polygons but those near the rim: the two centres beside it, and its ends.
    fn edges(&self, margin: i64) -> Vec<([usize; 2], [Point; 2])> {
        let mut edges = Vec::new();
        for own in (0..self.points.len()).filter(|&k| self.is_inside(k, margin)) {
            let polygon = self.polygon(own);
            for (k, &(from, other)) in polygon.iter().enumerate() {
                let Some(other) = other.filter(|&other| other > own) else { continue };
                let before = polygon[(k + polygon.len() - 1) % polygon.len()].1;
                let (to, after) = polygon[(k + 1) % polygon.len()];
                let end =
                    |third: Option<usize>, found: Point| third.map_or(found, |third| self.corner([own, other, third]));
                edges.push(([own, other], [end(before, from), end(after, to)]));
            }
        }
        edges
    }

    /// The point as far from three centres, the same whichever polygon asks.
    fn corner(&self, mut of: [usize; 3]) -> Point {
        of.sort_unstable();
        let [a, b, c] = of.map(|k| self.points[k]);
        let ([bx, by], [cx, cy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (bb, cc, area) = (bx * bx + by * by, cx * cx + cy * cy, 2.0 * (bx * cy - by * cx));
        [a[0] + (cy * bb - by * cc) / area, a[1] + (bx * cc - cx * bb) / area]
    }
}

/// Edges of polygons of Voronoi about a box, of which one takes `side`² m² in the mean.
pub fn polygons(seed: u64, side: f64, box_of: [Point; 2]) -> Vec<[Point; 2]> {
    let mut edges: Vec<[Point; 2]> = relaxed(seed, side, box_of).edges(RIM).into_iter().map(|(_, ends)| ends).collect();
    draw_together(&mut edges, SHORT * side);
    edges
}

/// Sides of the triangles between the centres of such polygons.
pub fn triangles(seed: u64, side: f64, box_of: [Point; 2]) -> Vec<[Point; 2]> {
    let centres = relaxed(seed, side, box_of);
    let sides = centres.edges(RIM).into_iter();
    // Four centres on one circle leave a square.
    let is_there = |ends: &[Point; 2]| square_of(ends[0], ends[1]) > (1e-9 * side) * (1e-9 * side);
    sides.filter(|(_, ends)| is_there(ends)).map(|(beside, _)| beside.map(|k| centres.points[k])).collect()
}

fn relaxed(seed: u64, side: f64, box_of: [Point; 2]) -> Centres {
    let mut centres = Centres::draw(seed, side, box_of, RIM + REACH);
    (1..=ROUNDS).for_each(|round| centres.relax(round * REACH));
    centres
}

/// Squares at a distance of `ring` squares.
fn ring_about([i, j]: [i64; 2], ring: i64) -> impl Iterator<Item = [i64; 2]> {
    let rows = (-ring..=ring).flat_map(move |dj| (-ring..=ring).map(move |di| [di, dj]));
    rows.filter(move |[di, dj]| di.abs().max(dj.abs()) == ring).map(move |[di, dj]| [i + di, j + dj])
}

fn square_of(a: Point, b: Point) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

/// The part of a polygon that is nearer to its centre than to another one.
fn cut(polygon: Polygon, centre: Point, (other, at): (usize, Point)) -> Polygon {
    let way = [at[0] - centre[0], at[1] - centre[1]];
    let half = 0.5 * (way[0] * way[0] + way[1] * way[1]);
    let beyond = |p: Point| (p[0] - centre[0]) * way[0] + (p[1] - centre[1]) * way[1] - half;
    if polygon.iter().all(|&(p, _)| beyond(p) <= 0.0) {
        return polygon;
    }
    let mut left = Polygon::with_capacity(polygon.len() + 1);
    for (k, &(from, edge)) in polygon.iter().enumerate() {
        let (to, _) = polygon[(k + 1) % polygon.len()];
        let [here, there] = [beyond(from), beyond(to)];
        if here <= 0.0 {
            left.push((from, edge));
        }
        if (here <= 0.0) != (there <= 0.0) {
            let share = here / (here - there);
            let crossing = [from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share];
            left.push((crossing, if here <= 0.0 { Some(other) } else { edge }));
        }
    }
    left
}

fn centroid(polygon: &Polygon) -> Point {
    let origin = polygon[0].0;
    let (mut area, mut sum) = (0.0, [0.0; 2]);
    for pair in polygon[1..].windows(2) {
        let [a, b] = [0, 1].map(|k| [pair[k].0[0] - origin[0], pair[k].0[1] - origin[1]]);
        let twice = a[0] * b[1] - a[1] * b[0];
        area += 3.0 * twice;
        (0..2).for_each(|k| sum[k] += twice * (a[k] + b[k]));
    }
    [origin[0] + sum[0] / area, origin[1] + sum[1] / area]
}

/// Draws both ends of short edges together into the one that comes first, with all edges that end there.
fn draw_together(edges: &mut Vec<[Point; 2]>, least: f64) {
    let name = |p: Point| p.map(|x| (x + 0.0).to_bits());
    let mut stands_for: BTreeMap<[u64; 2], Point> = BTreeMap::new();
    let find = |stands_for: &BTreeMap<[u64; 2], Point>, mut p: Point| {
        while let Some(&other) = stands_for.get(&name(p)) {
            p = other;
        }
        p
    };
    for [a, b] in edges.iter() {
        let [kept, gone] = [find(&stands_for, *a), find(&stands_for, *b)];
        if square_of(*a, *b) < least * least && name(kept) != name(gone) {
            stands_for.insert(name(gone), kept);
        }
    }
    edges.iter_mut().flatten().for_each(|p| *p = find(&stands_for, *p));
    edges.retain(|[a, b]| name(*a) != name(*b));
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [Point; 2] = [[-7.0, 3.0], [13.0, 18.0]];

    fn inside(edges: &[[Point; 2]], [low, high]: [Point; 2]) -> Vec<[u64; 4]> {
        let within = |p: &Point| (0..2).all(|k| (low[k]..=high[k]).contains(&p[k]));
        let mut found: Vec<[u64; 4]> = (edges.iter().filter(|edge| edge.iter().all(within)))
            .map(|[a, b]| [a[0], a[1], b[0], b[1]].map(f64::to_bits))
            .collect();
        found.sort_unstable();
        found
    }

    #[test]
    fn polygons_fill_the_plane_with_one_square_each_in_the_mean() {
        for (seed, side) in [(1, 1.0), (7, 0.4), (123, 2.3)] {
            let centres = relaxed(seed, side, BOX);
            let areas: Vec<f64> = (0..centres.points.len())
                .filter(|&k| centres.is_inside(k, RIM))
                .map(|k| {
                    let corners: Vec<Point> = centres.polygon(k).iter().map(|(p, _)| *p).collect();
                    let next = |k: usize| corners[(k + 1) % corners.len()];
                    0.5 * (0..corners.len())
                        .map(|k| corners[k][0] * next(k)[1] - corners[k][1] * next(k)[0])
                        .sum::<f64>()
                })
                .collect();
            let mean = areas.iter().sum::<f64>() / areas.len() as f64 / side.powi(2);
            let least = areas.iter().copied().fold(f64::INFINITY, f64::min) / side.powi(2);
            assert!((mean - 1.0).abs() < 0.05 && least > 0.2, "{mean} {least}");
        }
    }

    #[test]
    fn cells_do_not_depend_on_the_box() {
        let small = [[0.0, 5.0], [5.0, 10.0]];
        for of in [polygons, triangles] {
            for seed in 0..20 {
                let [a, b] = [BOX, small].map(|box_of| inside(&of(seed, 0.7, box_of), small));
                assert!(a.len() > 50 && a == b, "seed {seed}: {} and {} edges", a.len(), b.len());
            }
        }
    }

    /// Mean side of triangles, and how evenly directions of edges are spread: |mean of exp(2iα)|, 0 without a
    /// direction, 1 for parallel lines, and that of exp(4iα), which squares would show.
    #[test]
    fn triangles_have_their_size_and_edges_no_direction() {
        let side = 0.75f64.sqrt().sqrt();
        for seed in 0..5 {
            let sides = triangles(seed, side, [[0.0; 2], [40.0; 2]]);
            let mean = sides.iter().map(|[a, b]| square_of(*a, *b).sqrt()).sum::<f64>() / sides.len() as f64;
            assert!((mean - 1.0).abs() < 0.05, "{mean}");
            for edges in [sides, polygons(seed, side, [[0.0; 2], [40.0; 2]])] {
                let turned = |times: f64| {
                    let angle = |e: &[Point; 2]| times * (e[1][1] - e[0][1]).atan2(e[1][0] - e[0][0]);
                    let [x, y] = edges.iter().map(angle).fold([0.0; 2], |[x, y], a| [x + a.cos(), y + a.sin()]);
                    x.hypot(y) / edges.len() as f64
                };
                assert!(turned(2.0) < 0.04 && turned(4.0) < 0.06, "seed {seed}: {} {}", turned(2.0), turned(4.0));
            }
        }
    }

    /// Ends of edges meet exactly, three or more at each, but for those at the rim; none is short.
    #[test]
    fn edges_meet_at_their_ends() {
        let edges = polygons(3, 1.0, [[0.0; 2], [30.0; 2]]);
        let mut meeting: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        for p in edges.iter().flatten() {
            *meeting.entry(p.map(f64::to_bits)).or_default() += 1;
        }
        let inner = |p: &[u64; 2]| p.iter().all(|bits| (0.0..30.0).contains(&f64::from_bits(*bits)));
        assert!(meeting.iter().all(|(p, count)| !inner(p) || *count >= 3));
        assert!(meeting.keys().filter(|p| inner(p)).count() > 1500);
        let shortest = edges.iter().map(|[a, b]| square_of(*a, *b).sqrt()).fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.5 * SHORT, "{shortest} m");
    }
}
