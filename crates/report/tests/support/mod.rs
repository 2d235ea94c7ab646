//! A slope of irregular quadrilaterals that moves, and a reader of films.

// Each test file uses a part.
#![allow(dead_code)]

use std::path::Path;

use enmm_report::{
    Axis, BlockFrame, BlockNumber, BoltFrame, BoltPlace, Column, EdgeState, FilmWriter, Frame, Head, Mesh,
    MonitorFrame, MonitorPlace, Outline, Structures, SupportFrame,
};
use miniz_oxide::inflate::decompress_to_vec_zlib;

/// Points on each side of a quadrilateral, where lines of the mesh cross it: some twelve corners a block.
const PER_SIDE: usize = 3;
/// Supports: as many as the main example has.
const SUPPORTS: usize = 230;
/// Spacing of the joints (m).
const SPACING: f64 = 3.0;

/// Numbers between −1 and 1 that look random (P. L'Ecuyer, 1999: a multiplicative congruential generator).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A jointed slope.
pub struct Slope {
    pub outlines: Vec<Outline>,
    noise: Vec<[f64; 6]>,
}

impl Slope {
    /// Blocks in rows of `across`, corners off the grid by up to a fifth of the spacing.
    pub fn new(across: usize, up: usize) -> Self {
        let mut dice = Dice::new(7);
        let mut node = vec![[0.0; 2]; (across + 1) * (up + 1)];
        for (k, place) in node.iter_mut().enumerate() {
            let (i, j) = (k % (across + 1), k / (across + 1));
            *place = [(i as f64 + 0.2 * dice.roll()) * SPACING, (j as f64 + 0.2 * dice.roll()) * SPACING];
        }
        let mut outlines = Vec::new();
        for id in 0..across * up {
            let first = id / across * (across + 1) + id % across;
            let corners = [first, first + 1, first + across + 2, first + across + 1].map(|k| node[k]);
            outlines.push(quadrilateral(id as u32, corners));
        }
        let noise = outlines.iter().map(|_| std::array::from_fn(|_| dice.roll())).collect();
        Self { outlines, noise }
    }

    /// The same slope after a block has broken in two, from the middle of its first side to that of its third: the
    /// part beyond has the next free number and stands behind all others.
    pub fn broken(&self, block: usize) -> Self {
        let (mut outlines, mut noise) = (self.outlines.clone(), self.noise.clone());
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| outlines[block].loops[0][k * PER_SIDE]);
        let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let [from, to] = [middle(a, b), middle(c, d)];
        outlines[block] = quadrilateral(outlines[block].id, [a, from, to, d]);
        outlines.push(quadrilateral(outlines.len() as u32, [from, b, c, to]));
        noise.push(noise[block]);
        Self { outlines, noise }
    }

    /// Corners of all blocks.
    pub fn corners(&self) -> usize {
        self.outlines.iter().flat_map(|block| &block.loops).map(Vec::len).sum()
    }

    /// The slope at a time (s): the upper rock slides, faster the farther out, every block with its own jitter, as
    /// blocks that knock have; strains of 1e-4, as of stiff rock under its weight.
    pub fn at(&self, time: f64) -> Moment {
        let mut moment = Moment { time, ..Moment::default() };
        for (block, noise) in self.outlines.iter().zip(&self.noise) {
            let height = block.centroid[1] / SPACING;
            let speed = height * 0.2 * time * (1.0 + 0.3 * noise[0]);
            let way = 0.5 * speed * time;
            let rotation = 0.05 * noise[1] * time;
            let displacement = [-0.8 * way, -0.6 * way + 0.01 * noise[2]];
            let numbers = vec![
                displacement[0],
                displacement[1],
                rotation,
                -0.8 * speed + 0.1 * noise[3],
                -0.6 * speed,
                0.05 * noise[1],
                -1e5 * (2.0 + noise[4]),
                -3e5 * (2.0 + noise[5] + 0.1 * time),
                1e4 * noise[2],
            ];
            let strain = [noise[4] * 1e-4, noise[5] * 1e-4];
            for corner in block.loops.iter().flatten() {
                let arm = [corner[0] - block.centroid[0], corner[1] - block.centroid[1]];
                let (sine, cosine) = rotation.sin_cos();
                moment.corners.push([
                    displacement[0] + arm[0] * (cosine - 1.0 + strain[0]) - arm[1] * sine,
                    displacement[1] + arm[0] * sine + arm[1] * (cosine - 1.0 + strain[1]),
                ]);
                moment.edges.push(if noise[2] > 0.5 {
                    EdgeState::Open
                } else if noise[0] > 0.0 {
                    EdgeState::Slip
                } else if noise[1] > 0.0 {
                    EdgeState::Broken
                } else {
                    EdgeState::Lock
                });
            }
            moment.blocks.push(BlockFrame { removed: false, numbers });
        }
        moment.wet = (0..moment.edges.len()).map(|corner| corner % 3 == 0).collect();
        let support = |k: usize| SupportFrame {
            place: [0.7 * k as f64, 0.1 * time],
            axes: [k.is_multiple_of(2), true],
            absorbs: k.is_multiple_of(5),
        };
        moment.supports = (0..SUPPORTS).map(support).collect();
        moment
    }

    /// Writes a film of so many frames of this slope, a tenth of a second apart.
    pub fn film(&self, path: &Path, frames: usize) -> Vec<Moment> {
        let mut film = FilmWriter::create(path, &head(), &self.outlines).unwrap();
        let moments: Vec<Moment> = (0..frames).map(|k| self.at(0.1 * k as f64)).collect();
        for moment in &moments {
            film.frame(&moment.frame()).unwrap();
            film.row(&[moment.time, moment.time.sin()]).unwrap();
        }
        film.flush().unwrap();
        moments
    }
}

/// A quadrilateral with points on its sides.
fn quadrilateral(id: u32, corners: [[f64; 2]; 4]) -> Outline {
    let between = |a: [f64; 2], b: [f64; 2], part: f64| [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * part);
    let mut points = Vec::new();
    for k in 0..4 {
        points.extend((0..PER_SIDE).map(|i| between(corners[k], corners[(k + 1) % 4], i as f64 / PER_SIDE as f64)));
    }
    let sum = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>();
    let [a, b, c, d] = corners;
    let area = 0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]));
    let centroid = [0.25 * sum(0), 0.25 * sum(1)];
    Outline {
        id,
        fixed: false,
        rock: 0,
        area,
        mass: 2650.0 * area,
        centroid,
        loops: vec![points],
        mesh: Mesh::default(),
    }
}

/// One instant of a slope, owned.
#[derive(Default)]
pub struct Moment {
    pub time: f64,
    pub blocks: Vec<BlockFrame>,
    pub corners: Vec<[f64; 2]>,
    pub edges: Vec<EdgeState>,
    pub wet: Vec<bool>,
    pub supports: Vec<SupportFrame>,
}

/// Numbers of a block.
const NUMBERS: [&str; 9] = [
    "displacement_x",
    "displacement_y",
    "rotation",
    "velocity_x",
    "velocity_y",
    "angular_velocity",
    "mean_stress_xx",
    "mean_stress_yy",
    "mean_stress_xy",
];

/// Surface of the water (m).
pub const SURFACE: [[f64; 2]; 2] = [[0.0, 4.0], [20.0, 9.0]];
pub const BOLT: BoltFrame = BoltFrame { condition: 2, displacement: [[0.5, -0.25], [0.125, -1.0]], force: 112_345.0 };

pub const MONITOR: MonitorFrame = MonitorFrame { displacement: [0.25, -0.5], velocity: [1.5, 2.5] };

impl Moment {
    pub fn frame(&self) -> Frame<'_> {
        Frame {
            time: self.time,
            stage: 0,
            blocks: &self.blocks,
            corners: &self.corners,
            edges: &self.edges,
            monitors: &[MONITOR],
            structures: Structures {
                bolts: &[BOLT],
                supports: &self.supports,
                water_weight: 9810.0,
                water_surface: &SURFACE,
                wet: &self.wet,
            },
        }
    }
}

pub fn head() -> Head {
    let number =
        |name: &str| BlockNumber { name: name.to_owned(), unit: "m".to_owned(), meaning: name.to_owned(), range: None };
    let column = |name: &str, quantity: &str, unit: &str| Column {
        name: name.to_owned(),
        quantity: quantity.to_owned(),
        unit: unit.to_owned(),
        gaps: false,
    };
    Head {
        title: "Synthetic".to_owned(),
        command: "run".to_owned(),
        version: "0".to_owned(),
        case_file: "synthetic.toml".to_owned(),
        case_text: "title = \"</script>\"".to_owned(),
        axis: Axis::time(),
        block_numbers: NUMBERS.map(number).into(),
        columns: vec![column("time", "time", "s"), column("wave", "Displacement", "m")],
        monitors: vec![MonitorPlace { name: "crest".to_owned(), place: [1.0, 2.0] }],
        bolts: vec![BoltPlace { name: "row".to_owned(), ends: [[0.5, 1.0], [6.0, 2.0]] }],
        rocks: vec!["gneiss".to_owned()],
    }
}

/// A chunk of a film: its kind, time and inflated body.
pub type Chunk = (String, f64, Vec<u8>);

/// All chunks, read by what `format.md` says alone.
pub fn chunks(film: &[u8]) -> Vec<Chunk> {
    assert_eq!(&film[..8], b"enmmfil6");
    let (mut rest, mut chunks) = (&film[8..], Vec::new());
    while !rest.is_empty() {
        let kind = String::from_utf8(rest[..4].to_vec()).unwrap();
        let length = u32::from_le_bytes(rest[4..8].try_into().unwrap()) as usize;
        let time = f64::from_le_bytes(rest[8..16].try_into().unwrap());
        chunks.push((kind, time, decompress_to_vec_zlib(&rest[16..16 + length]).unwrap()));
        rest = &rest[16 + length..];
    }
    chunks
}

/// Reads numbers one after the other.
pub struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    pub fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take(4).try_into().unwrap())
    }

    pub fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take(8).try_into().unwrap())
    }

    pub fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take(4).try_into().unwrap())
    }

    pub fn planes(&mut self, count: usize, width: usize) -> Vec<f32> {
        let mut bytes = vec![[0u8; 4]; count];
        for plane in 4 - width..4 {
            bytes.iter_mut().zip(self.take(count)).for_each(|(number, &byte)| number[plane] = byte);
        }
        bytes.into_iter().map(f32::from_le_bytes).collect()
    }

    pub fn integer(&mut self) -> i64 {
        let (mut value, mut shift) = (0u64, 0);
        loop {
            let byte = self.take(1)[0];
            value |= u64::from(byte & 127) << shift;
            shift += 7;
            if byte < 128 {
                return (value >> 1) as i64 ^ -((value & 1) as i64);
            }
        }
    }
}
