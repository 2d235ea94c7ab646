//! Nets that several tests use, and random numbers.

use enmm_seepage::{Condition, Flow, Net, law};

/// Unit weight of water (N/m³).
pub const UNIT_WEIGHT: f64 = 9810.0;
/// Its viscosity (Pa s).
pub const VISCOSITY: f64 = 1e-3;
/// A node without a condition.
pub const FREE: Condition = Condition::Free { source: 0.0 };

/// A node with a given head (m).
pub fn held(head: f64) -> Condition {
    Condition::Held { head }
}

/// Capacity (m²/s) of a joint with an aperture (m) under a unit gradient.
pub fn capacity(aperture: f64) -> f64 {
    law::conductance(aperture, aperture, 1.0, UNIT_WEIGHT, VISCOSITY)
}

/// Joints with their conditions.
pub struct Joints {
    pub places: Vec<[f64; 2]>,
    pub pipes: Vec<[u32; 2]>,
    /// Apertures at the first and second end of each pipe (m).
    pub apertures: Vec<[f64; 2]>,
    pub conditions: Vec<Condition>,
}

impl Joints {
    /// Of places and pipes, all nodes free.
    pub fn new(places: Vec<[f64; 2]>, pipes: Vec<[u32; 2]>, apertures: Vec<[f64; 2]>) -> Self {
        let conditions = vec![FREE; places.len()];
        Self { places, pipes, apertures, conditions }
    }

    pub fn net(&self) -> Net {
        let heights: Vec<f64> = self.places.iter().map(|place| place[1]).collect();
        Net::new(&heights, &self.pipes).unwrap()
    }

    pub fn lengths(&self) -> Vec<f64> {
        let between = |&[a, b]: &[u32; 2]| {
            let (from, to) = (self.places[a as usize], self.places[b as usize]);
            ((to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1])).sqrt()
        };
        self.pipes.iter().map(between).collect()
    }

    pub fn conductance(&self) -> Vec<f64> {
        let of = |(length, e): (f64, &[f64; 2])| law::conductance(e[0], e[1], length, UNIT_WEIGHT, VISCOSITY);
        self.lengths().into_iter().zip(&self.apertures).map(of).collect()
    }

    pub fn steady(&self) -> Flow {
        self.net().steady(&self.conductance(), &self.conditions).unwrap()
    }

    /// Force of the water on one face (N/m).
    pub fn uplift(&self, flow: &Flow) -> f64 {
        let ends = |&[a, b]: &[u32; 2]| [a, b].map(|node| law::pressure_head(flow.u[node as usize]));
        let forces = self.pipes.iter().zip(self.lengths()).map(|(pipe, length)| {
            let [a, b] = ends(pipe);
            0.5 * UNIT_WEIGHT * (a + b) * length
        });
        forces.sum()
    }
}

/// A line of pieces between two places, with apertures that go linearly from one to the other.
pub fn line(pieces: usize, from: [f64; 2], to: [f64; 2], apertures: [f64; 2]) -> Joints {
    let along = |ends: [f64; 2], k: usize| ends[0] + (ends[1] - ends[0]) * k as f64 / pieces as f64;
    let places = (0..=pieces).map(|k| [along([from[0], to[0]], k), along([from[1], to[1]], k)]).collect();
    let pipes = (0..pieces as u32).map(|k| [k, k + 1]).collect();
    Joints::new(places, pipes, (0..pieces).map(|k| [along(apertures, k), along(apertures, k + 1)]).collect())
}

/// A net of level and upright joints that conducts as a body with the capacity of `aperture` over half a metre: joints
/// at its edges conduct half.
pub fn grid(size: [f64; 2], spacing: f64, aperture: f64) -> (Joints, [usize; 2]) {
    let counts = size.map(|size| (size / spacing).round() as usize);
    let (columns, rows) = (counts[0] + 1, counts[1] + 1);
    let at = |i: usize, j: usize| (j * columns + i) as u32;
    let places = (0..columns * rows).map(|k| [(k % columns) as f64 * spacing, (k / columns) as f64 * spacing]);
    let inner = aperture * (spacing / 0.5).cbrt();
    let edge = inner * 0.5_f64.cbrt();
    let (mut pipes, mut apertures) = (Vec::new(), Vec::new());
    let mut add = |ends, is_edge: bool| {
        pipes.push(ends);
        apertures.push([if is_edge { edge } else { inner }; 2]);
    };
    for j in 0..rows {
        (0..counts[0]).for_each(|i| add([at(i, j), at(i + 1, j)], j == 0 || j == counts[1]));
    }
    for j in 0..counts[1] {
        (0..columns).for_each(|i| add([at(i, j), at(i, j + 1)], i == 0 || i == counts[0]));
    }
    (Joints::new(places.collect(), pipes, apertures), [columns, rows])
}

/// Random numbers by the generator xorshift64*.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Between two limits.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        low + (high - low) * (bits as f64 / (1u64 << 53) as f64)
    }

    /// With a standard deviation of 1 about 0.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.between(1e-300, 1.0).ln()).sqrt();
        radius * self.between(0.0, std::f64::consts::TAU).cos()
    }
}
