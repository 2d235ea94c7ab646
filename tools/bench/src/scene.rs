//! A slope as other programs take it: the polygons of its blocks, cut into triangles, and what they are made of.

use serde::Serialize;

use enmm::geometry::{Point, polygon};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, EdgeId};

/// Types that the other programs read and write.
#[cfg(test)]
#[path = "../peers/scene.rs"]
#[expect(dead_code, reason = "the programs read and write by it; here only its types count")]
mod others;

/// Sine of the turn below which a boundary point is no corner.
const STRAIGHT: f64 = 1e-6;

/// A slope of convex blocks on one held slab, with what a program needs to simulate it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Time to simulate (s).
    pub duration: f64,
    /// Gravity (m/s²), which acts from the first instant.
    pub gravity: [f64; 2],
    /// Density (kg/m³).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Friction coefficient of all joints, the base included.
    pub friction: f64,
    /// Mesh size (m), the length that overlaps are compared with.
    pub size: f64,
    /// Corners of the held slab (m), counter-clockwise.
    pub base: Vec<[f64; 2]>,
    /// Free blocks.
    pub blocks: Vec<SceneBlock>,
    /// Boundary points that are the corners of each block.
    #[serde(skip)]
    corners: Vec<Vec<EdgeId>>,
}

/// A convex block: triangles between its sides and its centroid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneBlock {
    /// Corners counter-clockwise (m), and the centroid as the last point.
    pub points: Vec<[f64; 2]>,
    /// Points of each triangle, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
}

impl SceneBlock {
    /// Corners counter-clockwise (m).
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.points[..self.points.len() - 1]
    }
}

/// Where a program left a block: its corners (m) in the order of the scene; none for a block that it could not take.
pub type Placed = Option<Vec<[f64; 2]>>;

/// Motion of the blocks, and how well they stayed apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Outcome {
    /// Blocks that the program could take.
    pub blocks: usize,
    /// Mean distance (m) between the first and last centroids of the blocks.
    pub way: f64,
    /// Mean overlap (m) over the blocks, each with the deepest of its overlaps.
    pub overlap_mean: f64,
    /// Deepest overlap (m) of two blocks.
    pub overlap_max: f64,
}

impl Scene {
    /// The scene of a slope as built, all of whose free blocks are of one rock and have one joint law.
    ///
    /// Returns none when the case is no such slope.
    pub fn of(simulation: &Simulation, duration: f64) -> Option<Self> {
        let (model, case) = (simulation.model(), simulation.case());
        let ([rock], [law]) = (&values(&case.rocks)[..], &values(&case.joint_laws)[..]) else { return None };
        let fixed = &simulation.workspace().mass_matrix.fixed;
        let (held, free): (Vec<BlockId>, Vec<BlockId>) = model.covers.blocks().partition(|&block| fixed[block]);
        let mut points = vec![Vec::new(); model.covers.block_count()];
        model.boundary.edges().for_each(|k| points[model.boundary.block[k]].push(k));
        let place = |k: EdgeId| model.boundary.reference[k];
        let corners = |block: &BlockId| without_straight(&points[*block], place);
        let [slab] = held[..] else { return None };
        let corners_of_free: Vec<Vec<EdgeId>> = free.iter().map(corners).collect();
        let points_of = |ids: &Vec<EdgeId>| ids.iter().map(|&k| [place(k).x, place(k).y]).collect::<Vec<_>>();
        Some(Self {
            duration,
            gravity: [model.gravity.x, model.gravity.y],
            density: rock.density,
            young: rock.young,
            poisson: rock.poisson,
            friction: libm::tan(law.friction_deg.to_radians()),
            size: model.covers.mesh.size,
            base: points_of(&corners(&slab)),
            blocks: corners_of_free.iter().map(|ids| fan(points_of(ids))).collect(),
            corners: corners_of_free,
        })
    }

    /// Where the simulation has its blocks now.
    pub fn placed(&self, simulation: &Simulation) -> Vec<Placed> {
        let positions = simulation.positions();
        let corner = |k: &EdgeId| [positions[*k].x, positions[*k].y];
        self.corners.iter().map(|block| Some(block.iter().map(corner).collect())).collect()
    }

    /// How far blocks came from where the scene has them, and how deep they overlap; none when the places are not those
    /// of the blocks of the scene, or not finite.
    pub fn outcome(&self, placed: &[Placed]) -> Option<Outcome> {
        if placed.len() != self.blocks.len() {
            return None;
        }
        let (mut polygons, mut way) = (Vec::new(), 0.0);
        for (block, corners) in self.blocks.iter().zip(placed) {
            let Some(corners) = corners else { continue };
            let same = corners.len() == block.corners().len();
            if !same || corners.iter().flatten().any(|x| !x.is_finite()) {
                return None;
            }
            let polygon = to_points(corners);
            way += (polygon::centroid(&polygon) - polygon::centroid(&to_points(block.corners()))).norm();
            polygons.push(polygon);
        }
        let blocks = polygons.len();
        polygons.push(to_points(&self.base));
        let depths = overlaps(&polygons);
        let mean = |sum: f64| sum / blocks.max(1) as f64;
        Some(Outcome {
            blocks,
            way: mean(way),
            overlap_mean: mean(depths[..blocks].iter().sum()),
            overlap_max: depths.iter().copied().fold(0.0, f64::max),
        })
    }
}

/// Deepest overlap (m) of each polygon with any other.
fn overlaps(polygons: &[Vec<Point>]) -> Vec<f64> {
    let boxes: Vec<_> = polygons.iter().map(|polygon| polygon::bounds(polygon)).collect();
    let mut order: Vec<usize> = (0..polygons.len()).collect();
    order.sort_by(|&a, &b| boxes[a].0.x.total_cmp(&boxes[b].0.x));
    let mut deepest = vec![0.0f64; polygons.len()];
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| boxes[b].0.x < boxes[a].1.x) {
            if boxes[a].0.y < boxes[b].1.y && boxes[b].0.y < boxes[a].1.y {
                let depth = polygon::overlap_depth(&polygons[a], &polygons[b]);
                deepest[a] = deepest[a].max(depth);
                deepest[b] = deepest[b].max(depth);
            }
        }
    }
    deepest
}

/// A convex polygon cut into triangles between its sides and its centroid.
fn fan(mut points: Vec<[f64; 2]>) -> SceneBlock {
    let n = points.len();
    let centre = polygon::centroid(&to_points(&points));
    points.push([centre.x, centre.y]);
    SceneBlock { points, triangles: (0..n).map(|k| [k, (k + 1) % n, n]).collect() }
}

/// The points of a loop at which it turns.
fn without_straight(ids: &[EdgeId], place: impl Fn(EdgeId) -> Point) -> Vec<EdgeId> {
    let n = ids.len();
    let turns = |k: &usize| {
        let [before, here, after] = [k + n - 1, *k, k + 1].map(|k| place(ids[k % n]));
        let (a, b) = (here - before, after - here);
        (a.x * b.y - a.y * b.x).abs() > STRAIGHT * a.norm() * b.norm()
    };
    (0..n).filter(turns).map(|k| ids[k]).collect()
}

fn to_points(corners: &[[f64; 2]]) -> Vec<Point> {
    corners.iter().map(|&[x, y]| Point::new(x, y)).collect()
}

fn values<K, V>(map: &std::collections::BTreeMap<K, V>) -> Vec<&V> {
    map.values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enmm_verification::bench::Model;

    fn slope() -> (Simulation, Scene) {
        let simulation = Model::Slope(60, 4).build().unwrap_or_else(|e| panic!("{e}"));
        let scene = Scene::of(&simulation, 1.0).expect("a slope");
        (simulation, scene)
    }

    #[test]
    fn others_read_the_blocks_that_are_simulated() {
        let (simulation, scene) = slope();
        let text = serde_json::to_string(&scene).expect("a scene that can be written");
        let read: others::Scene = serde_json::from_str(&text).expect("a scene that can be read");
        assert_eq!([read.density, read.young, read.poisson, read.duration], [2650.0, 5e9, 0.25, 1.0]);
        assert!((read.friction.atan().to_degrees() - 20.0).abs() < 1e-9 && read.gravity == [0.0, -9.81]);
        assert_eq!(read.base, scene.base);
        let covers = &simulation.model().covers;
        let free = covers.blocks().filter(|&block| !simulation.workspace().mass_matrix.fixed[block]);
        let areas: Vec<f64> = free.map(|block| covers.block_area(block)).collect();
        assert_eq!(read.blocks.len(), areas.len());
        for (block, area) in read.blocks.iter().zip(areas) {
            let of_triangle = |triangle: &[u32; 3]| {
                let corners = triangle.map(|k| Point::new(block.points[k as usize][0], block.points[k as usize][1]));
                polygon::area(&corners)
            };
            let parts: Vec<f64> = block.triangles.iter().map(of_triangle).collect();
            assert!(parts.iter().all(|&part| part > 0.0), "{parts:?}");
            assert!((parts.iter().sum::<f64>() / area - 1.0).abs() < 1e-6, "{parts:?} of {area} m²");
        }
    }

    #[test]
    fn outcome_measures_ways_and_overlaps() {
        let (simulation, scene) = slope();
        let start = scene.placed(&simulation);
        let still = scene.outcome(&start).expect("an outcome");
        assert!(still.way < 1e-9 && still.overlap_max < 1e-9 && still.blocks == scene.blocks.len(), "{still:?}");
        // All blocks moved into the slab by 1 cm overlap it, and nothing else, by as much.
        let (dip_sin, dip_cos) = (0.5, 0.75f64.sqrt());
        let into = |[x, y]: &[f64; 2]| [x + 0.01 * dip_sin, y - 0.01 * dip_cos];
        let pushed: Vec<Placed> = start.iter().flatten().map(|c| Some(c.iter().map(into).collect())).collect();
        let deep = scene.outcome(&pushed).expect("an outcome");
        assert!((deep.way - 0.01).abs() < 1e-9 && (deep.overlap_max - 0.01).abs() < 1e-6, "{deep:?}");
        assert!(deep.overlap_mean > 1e-4 && deep.overlap_mean < 0.01, "{deep:?}");
    }

    #[test]
    fn places_of_other_blocks_are_refused() {
        let (simulation, scene) = slope();
        let start = scene.placed(&simulation);
        assert_eq!(scene.outcome(&start[1..]), None);
        let mut wrong = start.clone();
        wrong[0] = Some(vec![[0.0, 0.0]]);
        assert_eq!(scene.outcome(&wrong), None);
        let mut infinite = start.clone();
        infinite[0].as_mut().expect("a block")[0][0] = f64::NAN;
        assert_eq!(scene.outcome(&infinite), None);
        let mut fewer = start;
        fewer[0] = None;
        assert_eq!(scene.outcome(&fewer).expect("an outcome").blocks, scene.blocks.len() - 1);
    }
}
