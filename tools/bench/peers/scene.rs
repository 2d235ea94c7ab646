//! Description of a slope by `cargo xtask bench --peers` for a program, and its answer.

use std::error::Error;
use std::fs;
use std::io::Write;

/// A slope of convex blocks on one held slab; lengths in m, SI units.
#[derive(serde::Deserialize)]
pub struct Scene {
    pub duration: f64,
    pub gravity: [f64; 2],
    pub density: f64,
    pub young: f64,
    pub poisson: f64,
    pub friction: f64,
    pub size: f64,
    pub base: Vec<[f64; 2]>,
    pub blocks: Vec<Block>,
}

/// Corners counter-clockwise and the centroid as the last point, with triangles between sides and centroid.
#[derive(serde::Deserialize)]
pub struct Block {
    pub points: Vec<[f64; 2]>,
    pub triangles: Vec<[u32; 3]>,
}

/// Answer: seconds and steps for a simulated second, or its substeps if steps have them, and where the corners of each
/// block came to be.
#[derive(serde::Serialize)]
pub struct Answer {
    pub program: String,
    pub settings: String,
    pub seconds: f64,
    pub elements: Option<usize>,
    pub steps: Option<f64>,
    pub contacts: Option<usize>,
    pub blocks: Vec<Option<Vec<[f64; 2]>>>,
}

/// Reads the file that the command line names last.
pub fn read() -> Result<Scene, Box<dyn Error>> {
    let path = std::env::args().skip(1).last().ok_or("usage: PROGRAM SCENE.json")?;
    Ok(serde_json::from_slice(&fs::read(path)?)?)
}

/// Writes the answer to the standard output.
pub fn tell(answer: &Answer) -> Result<(), Box<dyn Error>> {
    Ok(writeln!(std::io::stdout(), "{}", serde_json::to_string(answer)?)?)
}
