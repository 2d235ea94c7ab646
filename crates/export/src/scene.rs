//! The slope at one instant of a run: blocks and structures from the film, joints from the frames for ParaView.

use std::path::Path;

use enmm_report::FILM;
use serde_json::Value;

use crate::error::ExportError;
use crate::faces::{Face, free_faces};
use crate::film::{Bolt, Film, Frame, Moved, Outline, Support};
use crate::vtu::{Collection, Lines};

/// Which instant of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Instant {
    /// The last frame.
    #[default]
    End,
    /// The frame of this number in `frames/`; in a folder without those, of this number in the film.
    Frame(usize),
    /// The frame nearest to a time (s), or to another place on the axis of a film that has another one.
    Time(f64),
}

/// A block now.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Before it moved.
    pub outline: Outline,
    /// Its rock by name.
    pub rock: String,
    /// Its numbers, in the order of [`Scene::numbers`].
    pub numbers: Vec<f64>,
    /// Corners of each loop (m), the outer one first.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// Its free faces now.
    pub free: Vec<Face>,
}

/// A free length of a bolt now.
#[derive(Debug, Clone, PartialEq)]
pub struct BoltLine {
    /// Name of its bolt.
    pub name: String,
    /// Both ends (m), the head first.
    pub ends: [[f64; 2]; 2],
    /// Tension (N per metre of depth).
    pub force: f64,
    /// Its condition in a word.
    pub state: &'static str,
}

/// Conditions of bolts by their numbers.
const CONDITIONS: [&str; 4] = ["absent", "whole", "yielded", "broken"];

/// The slope at one instant.
#[derive(Debug)]
pub struct Scene {
    /// Title of the case.
    pub title: String,
    /// Name of the axis of the film, such as `time`, its unit, and the place on it.
    pub axis: (String, String, f64),
    /// Blocks that are there.
    pub blocks: Vec<Block>,
    /// Names and units of the numbers of blocks.
    pub numbers: Vec<[String; 2]>,
    /// Free lengths of bolts that are there.
    pub bolts: Vec<BoltLine>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Surface of the water from left to right (m), level beyond.
    pub water: Vec<[f64; 2]>,
    /// Joints; none of their numbers is known where the case writes no frames.
    pub joints: Lines,
    /// Joints in which water flows.
    pub flow: Lines,
    /// Remarks for the user.
    pub notes: Vec<String>,
}

impl Scene {
    /// Reads the slope at an instant from a folder of results.
    ///
    /// # Errors
    /// The folder has no film or no such instant; or a file of it is damaged.
    pub fn read(directory: &Path, instant: Instant) -> Result<Self, ExportError> {
        if !directory.is_dir() {
            return Err(ExportError::NoFolder(directory.to_owned()));
        }
        let path = directory.join(FILM);
        if !path.exists() {
            let message = format!("holds no {FILM}, which enmm run writes; name the directory of a run");
            return Err(ExportError::Nothing { path: directory.to_owned(), message });
        }
        let film = Film::read(&path)?;
        let collection = Collection::read(directory)?;
        let found = find(&film, collection.as_ref(), instant);
        let (frame, number) =
            found.map_err(|message| ExportError::NoInstant { path: directory.to_owned(), message })?;
        let mut scene = Self::of(&film, frame)?;
        match collection.zip(number) {
            Some((collection, number)) => {
                scene.joints = collection.part(number, "joints")?.unwrap_or_default();
                scene.flow = collection.part(number, "flow")?.unwrap_or_default();
            }
            None => scene.notes.push(
                "no joints: they stand in frames/, which the case does not ask for; set `output.frames = true` and run \
                 it again"
                    .to_owned(),
            ),
        }
        Ok(scene)
    }

    /// All but the joints of a frame of a film.
    fn of(film: &Film, number: usize) -> Result<Self, ExportError> {
        let Frame { blocks, bolts, supports, water, .. } = film.frame(number)?;
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let removed = blocks.iter().filter(|block| block.removed).count();
        let note = (removed > 0).then(|| format!("{removed} blocks have been excavated and are left out"));
        let rock = |outline: &Outline| text(&film.head["rocks"][outline.rock]);
        let there = film.outlines(number).iter().zip(blocks).filter(|(_, moved)| !moved.removed);
        let block = |(outline, Moved { numbers, loops, .. }): (&Outline, Moved)| Block {
            outline: outline.clone(),
            rock: rock(outline),
            numbers,
            loops,
            free: Vec::new(),
        };
        let mut blocks: Vec<Block> = there.map(block).collect();
        let loops: Vec<_> = blocks.iter().map(|block| (&block.outline.loops[..], &block.loops[..])).collect();
        let free = free_faces(&loops);
        blocks.iter_mut().zip(free).for_each(|(block, free)| block.free = free);
        Ok(Self {
            title: text(&film.head["title"]),
            axis: (
                text(&film.head["axis"]["name"]),
                text(&film.head["axis"]["unit"]),
                film.times().nth(number).unwrap_or_default(),
            ),
            blocks,
            numbers: film.numbers(),
            bolts: bolts.iter().enumerate().filter_map(|(k, bolt)| bolt_line(&film.head["bolts"][k], bolt)).collect(),
            supports: supports.unwrap_or_default(),
            water,
            joints: Lines::default(),
            flow: Lines::default(),
            notes: note.into_iter().collect(),
        })
    }

    /// Least and greatest coordinates (m) of the blocks.
    pub fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let mut points = self.blocks.iter().flat_map(|block| block.loops.iter().flatten());
        let first = *points.next()?;
        let wider = |[low, high]: [[f64; 2]; 2], at: &[f64; 2]| {
            [[low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])]]
        };
        Some(points.fold([first, first], wider))
    }

    /// A number of a block by its name.
    pub fn number(&self, block: &Block, name: &str) -> Option<f64> {
        let place = self.numbers.iter().position(|[known, _]| known == name)?;
        block.numbers.get(place).copied()
    }

    /// Surface of the water, level up to the ends of the slope.
    pub fn water_line(&self) -> Vec<[f64; 2]> {
        let (Some([low, high]), Some(first), Some(last)) = (self.bounds(), self.water.first(), self.water.last())
        else {
            return Vec::new();
        };
        let left = (low[0] < first[0]).then_some([low[0], first[1]]);
        let right = (high[0] > last[0]).then_some([high[0], last[1]]);
        left.into_iter().chain(self.water.iter().copied()).chain(right).collect()
    }
}

fn bolt_line(place: &Value, bolt: &Bolt) -> Option<BoltLine> {
    let at = |end: usize, axis: usize| place["ends"][end][axis].as_f64();
    let [[Some(ax), Some(ay)], [Some(bx), Some(by)]] = [[at(0, 0), at(0, 1)], [at(1, 0), at(1, 1)]] else {
        return None;
    };
    let [a, b] = bolt.displacement;
    let state = CONDITIONS.get(usize::from(bolt.condition)).copied().filter(|_| bolt.condition > 0)?;
    let name = place["name"].as_str().unwrap_or_default().to_owned();
    Some(BoltLine { name, ends: [[ax + a[0], ay + a[1]], [bx + b[0], by + b[1]]], force: bolt.force, state })
}

/// The frame of the film at an instant, and its number among the frames for ParaView where there are any.
///
/// # Errors
/// There is none, with those that there are.
fn find(film: &Film, collection: Option<&Collection>, instant: Instant) -> Result<(usize, Option<usize>), String> {
    let times: Vec<f64> = film.times().collect();
    // Frames that both have: the last of several at one time, at which a stage ends and the next one begins.
    let in_film = |time: f64| times.iter().rposition(|of| *of == time);
    let both: Vec<(usize, f64, usize)> = match collection {
        Some(collection) => {
            let both = |(number, time): &(usize, f64)| in_film(*time).map(|frame| (*number, *time, frame));
            collection.frames.iter().filter_map(both).collect()
        }
        None => times.iter().enumerate().map(|(k, time)| (k, *time, k)).collect(),
    };
    let [Some(first), Some(last)] = [both.first(), both.last()] else {
        return Err("no frame in frames/ is at a time of film.bin; run the case again".to_owned());
    };
    let among = |frame: usize, number: usize| (frame, collection.is_some().then_some(number));
    match instant {
        Instant::End => Ok(among(last.2, last.0)),
        Instant::Time(time) if !(first.1..=last.1).contains(&time) => {
            Err(format!("has no frame at {time}, must be from {} to {}; choose a --time of these", first.1, last.1))
        }
        Instant::Time(time) => {
            let nearest = both.iter().min_by(|a, b| (a.1 - time).abs().total_cmp(&(b.1 - time).abs()));
            nearest.map(|(number, _, frame)| among(*frame, *number)).ok_or_else(String::new)
        }
        Instant::Frame(wanted) => match both.iter().find(|(number, ..)| *number == wanted) {
            Some((number, _, frame)) => Ok(among(*frame, *number)),
            None => {
                let listed = collection.and_then(|all| all.frames.iter().find(|(number, _)| *number == wanted));
                let why = match listed {
                    Some((_, time)) => format!("frame {wanted} (t = {time}) is not in film.bin, which has fewer"),
                    None => format!("has no frame {wanted}, must be from {} to {}", first.0, last.0),
                };
                Err(format!("{why}; choose another --frame, or the nearest to a --time"))
            }
        },
    }
}
