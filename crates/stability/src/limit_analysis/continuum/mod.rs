//! Limit analysis of rock that yields, by finite elements: a factor with a field of stress that proves it from below,
//! and one with a mechanism that proves it from above (theory, section 22).

mod conic;
mod drawing;
mod ground;
mod loads;
mod lower;
mod marks;
mod mesh;
mod search;
mod sizes;
mod strengths;
mod upper;

use enmm::geometry::{Point, Vector, polygon};
use enmm::model::assemble::outlines;
use enmm::model::case::{self, Case, Invalid};
use enmm::model::tables::BlockId;
use enmm::model::{BoltSegment, Simulation};

use super::model::{Strengths, bodies};
use super::{BoundError, Factor, refusal};
use drawing::{Drawing, Side};
use ground::{Bar, Edge, Patch, Rock, Strength};
use loads::Loads;
use marks::Marks;
use mesh::Mesh;
use search::{Proof, Proven, prove};
use sizes::Sizes;
use strengths::strengths;
use upper::Controls;

/// Most triangles of a mesh, unless it is told otherwise.
pub const TRIANGLES: usize = 2000;
/// How many times fewer triangles the meshes have that tell where the rock shears.
const COARSER: [usize; 2] = [9, 3];
/// Strength by which the search for the lower bound begins above that of the upper bound.
const AHEAD: f64 = 0.01;
/// Speed, relative to the greatest, from which rock is part of a mechanism.
const MOVES: f64 = 0.1;
/// Most points about which the mesh for stresses has fans.
const FANNED: usize = 2;
/// Root of the area of triangles about such a point over their distance from it.
const SECTOR: f64 = 0.3;
/// Distance of both bounds, relative to the lower one, from which on they are not close.
const APART: f64 = 0.05;
/// Share of its triangles that a mesh has at least, and the meshes that are tried for it.
const FULL: f64 = 0.85;
const MESHES: usize = 8;

/// Factors between which the factor of safety of rock that flows by normality lies.
#[derive(Debug, Clone, PartialEq)]
pub struct Bracket {
    /// A field of stress in equilibrium proves it.
    pub lower: Factor,
    /// A mechanism proves it.
    pub upper: Factor,
    /// Triangles of the mesh of the lower bound, and of that of the upper bound.
    pub triangles: [usize; 2],
    /// Conic programs that were solved.
    pub programs: usize,
    /// How the rock moves in the mechanism of the upper bound; none when there is equilibrium throughout.
    pub mechanism: Vec<Motion>,
    /// What the build has changed in the drawing.
    pub notes: Vec<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl Bracket {
    /// Whether both bounds tell the factor to within 5 %, or lie outside of the range.
    pub fn is_close(&self) -> bool {
        apart(self.lower, self.upper).is_none_or(|share| share <= APART)
    }

    /// The rock that moves: triangles with more than a tenth of the greatest speed.
    pub fn moving(&self) -> impl Iterator<Item = &Motion> {
        self.mechanism.iter().filter(|motion| motion.velocity.norm() > MOVES)
    }
}

/// Motion of a triangle of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Block that it is part of.
    pub block: u32,
    /// Its centroid (m).
    pub position: Point,
    /// Velocity of the centroid over the greatest speed of all rock.
    pub velocity: Vector,
    /// Area (m²).
    pub area: f64,
    /// Mass (kg/m).
    pub mass: f64,
}

/// A model as both programs see it, in its own units.
struct Ground {
    drawing: Drawing,
    simulation: Simulation,
    loads: Loads,
    is_held: Vec<bool>,
    /// Strengths of each rock for the lower and for the upper bound; none for one that never yields.
    kinds: [Vec<Vec<Strength>>; 2],
    /// Whether water has pressure in the pores of each rock.
    is_porous: Vec<bool>,
    /// Length (m) and stress (Pa) that count as one.
    units: [f64; 2],
    area: f64,
}

/// Finds the bracket of a case with meshes of at most so many triangles.
///
/// # Errors
/// A case that cannot be built, that holds what cannot be treated, or whose program is not solved.
pub fn bracket(case: &Case, triangles: usize) -> Result<Bracket, BoundError> {
    refusal::refuse_flow(case)?;
    let (simulation, mut warnings) = refusal::staged_rock(case)?;
    let ground = Ground::new(simulation, case)?;
    let found = ground.upper(triangles)?;
    let turning = ground.turning(&found.sizes);
    let mesh = ground.mesh(&found.sizes.for_stress(), triangles / 3, &turning)?.parted();
    let stresses = ground.rock(&mesh, Proof::Equilibrium);
    let unsolved = |status| unsolved(stresses.patches.len(), status);
    let start = found.proven.factor.strength() * (1.0 + AHEAD);
    let lower = prove(|x| lower::program(&stresses, x).solve(), start, Proof::Equilibrium).map_err(unsolved)?;
    warnings.extend(warning(lower.factor, found.proven.factor));
    Ok(Bracket {
        lower: lower.factor,
        upper: found.proven.factor,
        triangles: [stresses.patches.len(), found.rock.patches.len()],
        programs: found.programs + lower.programs,
        mechanism: ground.mechanism(&found),
        notes: ground.simulation.built().notes.clone(),
        warnings,
    })
}

/// Distance of both bounds relative to the lower one.
fn apart(lower: Factor, upper: Factor) -> Option<f64> {
    match (lower, upper) {
        (Factor::Found(lower), Factor::Found(upper)) => Some(upper / lower - 1.0),
        _ => None,
    }
}

/// Remedy where the bounds are far apart.
fn warning(lower: Factor, upper: Factor) -> Option<String> {
    let share = apart(lower, upper).filter(|share| *share > APART)?;
    Some(format!(
        "the bounds are {:.1} % apart: ask `enmm bound` for more triangles with --triangles, more so where joints cut \
         the rock into many blocks",
        100.0 * share
    ))
}

fn unsolved(triangles: usize, status: impl std::fmt::Debug) -> BoundError {
    BoundError::UnsolvedRock { triangles, status: format!("{status:?}") }
}

/// The upper bound on the finest mesh.
struct Upper {
    mesh: Mesh,
    rock: Rock,
    controls: Controls,
    proven: Proven,
    /// Sizes of the triangles of the mesh, up to a factor.
    sizes: Sizes,
    /// Programs solved on all meshes.
    programs: usize,
}

impl Upper {
    /// Velocities of the control points; none where no mechanism was found.
    fn velocities(&self) -> Option<Vec<Vector>> {
        self.proven.solution.as_ref().map(|solution| self.controls.velocities(&solution.multipliers))
    }

    /// Sizes that follow the shear of the mechanism.
    fn refined(&self) -> Option<Sizes> {
        let velocities = self.velocities()?;
        let shear: Vec<f64> =
            self.rock.patches.iter().enumerate().map(|(t, patch)| self.controls.shear(patch, t, &velocities)).collect();
        let speed = velocities.iter().map(Vector::norm).fold(0.0, f64::max);
        Sizes::of_shear(&self.mesh, &self.rock.patches, &shear, speed)
    }
}

impl Ground {
    fn new(simulation: Simulation, case: &Case) -> Result<Self, Invalid> {
        let outlines = outlines(simulation.case())?;
        let bodies = bodies(&simulation);
        let loads = Loads::new(&simulation);
        let drawing = Drawing::new(&simulation, &outlines, &Strengths::new(&simulation, &bodies), &loads);
        let covers = &simulation.model().covers;
        let there = |b: &BlockId| !bodies[*b].is_gone;
        let area: f64 = covers.blocks().filter(there).map(|b| covers.block_area(b)).sum();
        let densest = simulation.model().rocks.iter().map(|rock| rock.density).fold(0.0, f64::max);
        let length = area.sqrt();
        let stress = (densest * loads.acceleration.norm() * length).max(loads.greatest());
        let stress = if stress > 0.0 { stress } else { 1.0 };
        let is_held = refusal::held_blocks(&simulation);
        let of_rocks = |proof| case.rocks.values().map(|rock| strengths(rock, proof, stress, stress)).collect();
        let kinds = [Proof::Equilibrium, Proof::Mechanism].map(of_rocks);
        let is_porous = case.rocks.values().map(case::Rock::is_porous).collect();
        Ok(Self { kinds, is_porous, units: [length, stress], drawing, loads, is_held, area, simulation })
    }

    /// The upper bound on meshes that are finer from one to the next, and finest where the last has sheared.
    fn upper(&self, triangles: usize) -> Result<Upper, BoundError> {
        let mut sizes = Sizes::even(self.area);
        let (mut start, mut programs) = (1.0, 0);
        for coarser in COARSER {
            let found = self.upper_on(sizes, (triangles / coarser).max(1), start)?;
            programs += found.programs;
            start = found.proven.factor.strength();
            sizes = found.refined().unwrap_or(found.sizes);
        }
        let found = self.upper_on(sizes, triangles, start)?;
        Ok(Upper { programs: programs + found.programs, ..found })
    }

    fn upper_on(&self, sizes: Sizes, triangles: usize, start: f64) -> Result<Upper, BoundError> {
        let mesh = self.mesh(&sizes, triangles, &[])?;
        let rock = self.rock(&mesh, Proof::Mechanism);
        let controls = Controls::new(&rock.patches);
        let solve = |x| upper::program(&rock, &controls, x).solve();
        let proven = prove(solve, start, Proof::Mechanism).map_err(|status| unsolved(rock.patches.len(), status))?;
        let programs = proven.programs;
        Ok(Upper { mesh, rock, controls, proven, sizes, programs })
    }

    /// A mesh of at most so many triangles, as far as the sides of the drawing allow; about some points of the drawing
    /// as fine as stress asks that turns about them.
    fn mesh(&self, sizes: &Sizes, triangles: usize, turning: &[usize]) -> Result<Mesh, BoundError> {
        let mut scale = 1.0 / triangles.max(1) as f64;
        let mut mesh = self.mesh_of(sizes, scale, turning)?;
        for _ in 0..MESHES {
            let excess = mesh.triangles.len() as f64 / triangles.max(1) as f64;
            if (FULL..=1.0).contains(&excess) {
                break;
            }
            scale *= excess / (1.0 + FULL) * 2.0;
            mesh = self.mesh_of(sizes, scale, turning)?;
        }
        Ok(mesh)
    }

    fn mesh_of(&self, sizes: &Sizes, scale: f64, turning: &[usize]) -> Result<Mesh, BoundError> {
        let about: Vec<(Point, f64)> =
            turning.iter().map(|&end| self.drawing.points[end]).map(|at| (at, (scale * sizes.at(at)).sqrt())).collect();
        let area = |p: Point| {
            let turns = |&(at, least): &(Point, f64)| (SECTOR * (p - at).norm().max(least)).powi(2);
            about.iter().map(turns).fold(scale * sizes.at(p), f64::min)
        };
        let mut mesh =
            Mesh::new(&self.drawing, area).map_err(|mesh::Close(at)| BoundError::Close { x: at.x, y: at.y })?;
        mesh.fan(turning);
        Ok(mesh)
    }

    /// The ends of sides on the outline where the rock shears most.
    fn turning(&self, sizes: &Sizes) -> Vec<usize> {
        let is_outer = |side: &&Side| side.marks.right.is_none() && !side.marks.is_seam;
        let mut ends: Vec<usize> = self.drawing.sides.iter().filter(is_outer).flat_map(|side| side.ends).collect();
        ends.sort_unstable();
        ends.dedup();
        let size = |end: &usize| sizes.at(self.drawing.points[*end]);
        ends.sort_by(|a, b| size(a).total_cmp(&size(b)).then(a.cmp(b)));
        ends.truncate(FANNED);
        ends
    }

    fn mechanism(&self, found: &Upper) -> Vec<Motion> {
        let Some(velocities) = found.velocities() else { return Vec::new() };
        let model = self.simulation.model();
        // The mean of a quadratic function is that of its control points.
        let mean = |of: &[usize; 6]| of.iter().map(|&c| velocities[c]).sum::<Vector>() / 6.0;
        let power: f64 = (found.rock.patches.iter().zip(&found.controls.of))
            .map(|(patch, of)| patch.area() * patch.body.dot(&mean(of)))
            .sum();
        let fastest = velocities.iter().map(Vector::norm).fold(f64::MIN_POSITIVE, f64::max) * power.signum();
        let motion = |t: usize| {
            let (block, position, area) = (found.mesh.triangles[t].block, found.mesh.centroid(t), found.mesh.area(t));
            let density = model.rocks[self.kind(block, position)].density;
            let velocity = mean(&found.controls.of[t]) / fastest;
            Motion { block: block.number(), position, velocity, area, mass: area * density }
        };
        (0..found.rock.patches.len()).map(motion).collect()
    }

    /// Triangles and bolts with all that acts on them.
    fn rock(&self, mesh: &Mesh, proof: Proof) -> Rock {
        let patches = self.patches(mesh);
        let bars = self.bars(mesh, &patches);
        let [inner, outer] = &self.kinds;
        let kinds = if proof == Proof::Equilibrium { inner.clone() } else { outer.clone() };
        Rock { kinds, patches, bars }
    }

    /// The bolts that are installed, those within one block included.
    fn bars(&self, mesh: &Mesh, patches: &[Patch]) -> Vec<Bar> {
        let [length, stress] = self.units;
        let (model, state) = (self.simulation.model(), self.simulation.state());
        let installed = model.bolts.iter().zip(&state.bolts).filter(|(_, state)| state.active && !state.broken);
        // How far a position lies outside of a triangle, by the shares of its corners.
        let outside =
            |t: usize, p: Point| patches[t].shares(p).into_iter().fold(0.0, |most: f64, share| most.max(-share));
        let holder = |block: BlockId, p: Point| {
            let own = (0..patches.len()).filter(|&t| mesh.triangles[t].block == block);
            own.min_by(|&s, &t| outside(s, p).total_cmp(&outside(t, p)))
        };
        let bar = |segment: &BoltSegment| {
            let at = segment.points.map(|p| p / length);
            let [a, b] = [0, 1].map(|end| holder(segment.blocks[end], at[end]));
            let ends = [a?, b?];
            Some(Bar {
                ends: [0, 1].map(|end| (ends[end], patches[ends[end]].shares(at[end]))),
                direction: (at[1] - at[0]).normalize(),
                most: segment.yield_force / (length * stress),
            })
        };
        installed.filter_map(|(segment, _)| bar(segment)).collect()
    }

    fn patches(&self, mesh: &Mesh) -> Vec<Patch> {
        let [length, stress] = self.units;
        let patch = |t: usize| {
            let block = mesh.triangles[t].block;
            let kind = self.kind(block, mesh.centroid(t));
            let model = self.simulation.model();
            let pore = |p: Point| if self.is_porous[kind] { self.loads.pore_pressure(p) / stress } else { 0.0 };
            Patch {
                corners: mesh.corners(t).map(|p| p / length),
                kind,
                pores: mesh.corners(t).map(pore),
                body: self.loads.acceleration * (model.rocks[kind].density * length / stress),
                is_held: self.is_held[block.number() as usize],
                edges: [0, 1, 2].map(|k| self.edge(mesh, t, k)),
            }
        };
        (0..mesh.triangles.len()).map(patch).collect()
    }

    fn edge(&self, mesh: &Mesh, t: usize, k: usize) -> Edge {
        let triangle = &mesh.triangles[t];
        let nothing = Marks::default();
        let marks = triangle.lines[k].map_or(&nothing, |line| &self.drawing.sides[mesh.lines[line].side].marks);
        let ends = [0, 1].map(|end| mesh.points[triangle.corners[(k + end) % 3]]);
        let stress = self.units[1];
        let Some(other) = triangle.across[k] else {
            let tractions = self.loads.tractions(marks, ends).map(|t| t / stress);
            return Edge::Outside(tractions, marks.held);
        };
        let behind = &mesh.triangles[other];
        let start = triangle.corners[(k + 1) % 3];
        let edge = (0..3).find(|&edge| behind.corners[edge] == start).unwrap_or_default();
        match marks.law {
            Some(law) => {
                let law = &self.simulation.state().laws[law];
                let (cohesion, tension) = (law.cohesion / stress, Some(law.tension / stress));
                let pressure = self.loads.pressures(marks, ends).map(|p| p / stress);
                Edge::Joint(other, edge, Strength { friction: law.friction, cohesion, tension }, pressure)
            }
            None => Edge::Rock(other, edge),
        }
    }

    /// Rock at a position in a block: by block, else by region, else the one that names neither.
    fn kind(&self, block: BlockId, at: Point) -> usize {
        let case = self.simulation.case();
        let covers = &self.simulation.model().covers;
        let rocks = || case.rocks.values().enumerate();
        let is_in = |p: &[f64; 2]| {
            let element = covers.element_near(Point::from(*p), self.drawing.tolerance);
            element.is_some_and(|element| covers.element_block[element] == block)
        };
        let by_block = rocks().find(|(_, rock)| rock.blocks.iter().any(is_in));
        let holds =
            |region: &Vec<[f64; 2]>| polygon::contains(&region.iter().map(|p| Point::from(*p)).collect::<Vec<_>>(), at);
        let by_region = || rocks().find(|(_, rock)| rock.region.as_ref().is_some_and(holds));
        let background = || rocks().find(|(_, rock)| rock.region.is_none() && rock.blocks.is_empty());
        by_block.or_else(by_region).or_else(background).map_or(0, |(k, _)| k)
    }
}
