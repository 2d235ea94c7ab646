//! Blocks put where the drawing inserts them: each entity with the map from its block to the drawing.

use super::entity::Tracer;
use super::groups::Groups;
use super::records::{Block, Blocks, Record, find};
use crate::case_error::CaseError;
use crate::geometry_file::affine::Affine;
use crate::geometry_file::upright::Plane;

/// Most entities of a drawing with all that it inserts.
const ENTITIES_MAX: usize = 1_000_000;
/// Most blocks within each other.
const DEPTH_MAX: usize = 64;
/// Flags of blocks that stand in another file.
const EXTERNAL: i64 = 4 | 8;

/// An entity at its place.
#[derive(Debug)]
pub struct Placed<'a> {
    /// The entity.
    pub record: &'a Record<'a>,
    /// Layer; of an entity on layer `0` of a block that of the INSERT.
    pub layer: &'a str,
    /// From the coordinates of the entity to the section.
    pub map: Affine,
}

/// Reader of inserts.
pub struct Inserter<'a> {
    groups: &'a Groups<'a>,
    blocks: &'a Blocks<'a>,
    placed: Vec<Placed<'a>>,
    /// Number of entities and of copies of blocks so far.
    count: usize,
    /// Names of the blocks that are being inserted.
    open: Vec<&'a str>,
    /// Drawing entities that were passed by because they lie on paper space.
    pub paper: usize,
}

impl<'a> Inserter<'a> {
    /// A reader of a drawing with these blocks.
    pub fn new(groups: &'a Groups<'a>, blocks: &'a Blocks<'a>) -> Self {
        Self { groups, blocks, placed: Vec::new(), count: 0, open: Vec::new(), paper: 0 }
    }

    /// Puts entities at their places.
    ///
    /// # Errors
    /// An INSERT names no block, one in another file, or itself; or too many entities follow.
    pub fn place(&mut self, records: &'a [Record<'a>], map: &Affine, layer: Option<&'a str>) -> Result<(), CaseError> {
        for record in records {
            if record.whole(self.groups, 67)? == 1 {
                self.paper += 1;
                continue;
            }
            let own = if record.layer == "0" { layer.unwrap_or("0") } else { record.layer };
            if record.kind == "INSERT" {
                self.insert(record, map, own)?;
                continue;
            }
            self.placed.push(Placed { record, layer: own, map: *map });
            self.add(record.line)?;
        }
        Ok(())
    }

    /// Counts an entity or a copy of a block.
    fn add(&mut self, line: usize) -> Result<(), CaseError> {
        self.count += 1;
        if self.count > ENTITIES_MAX {
            let message = format!("blocks inserted so far make more than {ENTITIES_MAX} entities; thin the drawing");
            return self.groups.syntax(line, message);
        }
        Ok(())
    }

    /// All entities at their places.
    pub fn finish(self) -> Vec<Placed<'a>> {
        self.placed
    }

    fn insert(&mut self, record: &'a Record<'a>, map: &Affine, layer: &'a str) -> Result<(), CaseError> {
        let block = self.block(record)?;
        if self.open.contains(&block.name) {
            let message = format!("block {:?} inserts itself; explode one of the inserts", block.name);
            return self.groups.syntax(record.line, message);
        }
        if self.open.len() == DEPTH_MAX {
            let message = format!("more than {DEPTH_MAX} blocks are within each other; explode some");
            return self.groups.syntax(record.line, message);
        }
        self.open.push(block.name);
        for place in self.places(record, map, block)? {
            self.add(record.line)?;
            self.place(&block.records, &place, Some(layer))?;
        }
        self.open.pop();
        Ok(())
    }

    fn block(&self, record: &Record<'a>) -> Result<&'a Block<'a>, CaseError> {
        let Some(name) = record.find(2) else { return self.groups.missing(record.line, "INSERT", 2) };
        let Some(block) = self.blocks.get(&name.value.to_lowercase()) else {
            let message = format!("INSERT of block {:?}, which the drawing does not have; save it again", name.value);
            return self.groups.syntax(name.line, message);
        };
        if self.groups.whole(block.head, 70)? & EXTERNAL != 0 {
            let message = format!("block {:?} is an external reference; bind it to the drawing", block.name);
            return self.groups.syntax(name.line, message);
        }
        Ok(block)
    }

    /// The map of each copy of a block: one, or those of rows and columns.
    fn places(&self, record: &Record, map: &Affine, block: &Block) -> Result<Vec<Affine>, CaseError> {
        let groups = self.groups;
        let number = |code, default| record.number_or(groups, code, default);
        let base = |code| find(block.head, code).map_or(Ok(0.0), |group| groups.number(group));
        let base = Affine::shift([-base(10)?, -base(20)?]);
        let facing = Tracer { groups, map: *map, plane: Plane::Flat, tolerance: 0.0 }.facing(record)?;
        let turn = Affine::rotation(number(50, 0.0)?);
        let shape = turn.after(&Affine::scaling([number(41, 1.0)?, number(42, 1.0)?])).after(&base);
        if shape.is_flat() {
            let message = format!("INSERT of block {:?} has a scale of 0; correct it or remove the insert", block.name);
            return groups.syntax(record.line, message);
        }
        let point = [number(10, 0.0)?, number(20, 0.0)?];
        let count = |code| Ok::<_, CaseError>(record.whole(groups, code)?.max(1));
        let (columns, rows) = (count(70)?, count(71)?);
        if columns.saturating_mul(rows) > ENTITIES_MAX as i64 {
            let message = format!("INSERT has {columns} × {rows} copies, must be at most {ENTITIES_MAX}; thin them");
            return groups.syntax(record.line, message);
        }
        let step = [number(44, 0.0)?, number(45, 0.0)?];
        let copies = (0..rows).flat_map(|row| (0..columns).map(move |column| [column as f64, row as f64]));
        let place = |[column, row]: [f64; 2]| {
            let off = turn.vector([column * step[0], row * step[1]]);
            facing.after(&Affine::shift([point[0] + off[0], point[1] + off[1]])).after(&shape)
        };
        Ok(copies.map(place).collect())
    }
}
