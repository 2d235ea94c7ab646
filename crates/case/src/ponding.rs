//! Where a water table stands above the ground.

use super::{Case, PointList, WaterSurface};

/// Depth of water on the ground over the height of the rock below which it is no matter: digits of a line along a face.
/// The pressure that it adds is that share of the greatest.
const SHALLOW: f64 = 0.01;

/// Water on the ground beside or under a part of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Pond {
    /// Key of the table.
    pub key: String,
    /// Greatest depth (m).
    pub depth: f64,
    /// First x and last (m).
    pub span: [f64; 2],
    /// The water that stands there.
    pub part: PondPart,
    /// Shallower places of the same kind.
    pub others: usize,
}

/// The part of a table that stands above the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PondPart {
    /// The table goes on level beyond an end that lies in the rock.
    BeyondRock([f64; 2]),
    /// The table goes on level beyond an end that lies on or above the ground.
    BeyondGround([f64; 2]),
    /// A sloping part of it.
    Sloping,
}

impl Pond {
    /// Whether it is mostly a slip: still water neither slopes, nor begins in rock.
    pub fn is_slip(&self) -> bool {
        !matches!(self.part, PondPart::BeyondGround(_))
    }

    /// Its line in messages.
    pub fn text(&self) -> String {
        let short = |value: f64| (1e3 * value).round() / 1e3 + 0.0;
        let Self { key, depth, span: [from, to], part, others } = self;
        let why = match part {
            PondPart::BeyondRock([x, y]) => format!(
                "the line ends inside the rock at ({}, {}) m and is level beyond; draw it on to where the ground is \
                 dry",
                short(*x),
                short(*y)
            ),
            PondPart::BeyondGround([x, y]) => {
                format!("the line ends at ({}, {}) m and is level beyond, as a lake", short(*x), short(*y))
            }
            PondPart::Sloping => "the line slopes there, which still water does not; draw it below the face".to_owned(),
        };
        let [depth, from, to] = [*depth, *from, *to].map(short);
        let more = if *others > 0 { format!(", and in {others} shallower places") } else { String::new() };
        format!("{key}: stands {depth} m above the ground from x {from} to {to} m{more}: {why}")
    }
}

impl Case {
    /// Where the water tables of the case stand above the ground as it is drawn, but for level parts of their lines.
    pub fn ponds(&self) -> Vec<Pond> {
        let Some(water) = self.water.as_ref().filter(|water| water.faces.is_none()) else { return Vec::new() };
        let first = ("water.table".to_owned(), water.surface());
        let stages = self.stages.iter().enumerate();
        let later = stages.filter_map(|(k, stage)| Some((format!("stage[{k}].water.table"), stage.water.clone()?)));
        let ground = Ground::of(self);
        std::iter::once(first).chain(later).flat_map(|(key, surface)| ground.ponds(&key, &surface)).collect()
    }
}

/// A piece of a line from left to right.
type Straight = [[f64; 2]; 2];

/// The upper face of the rock.
struct Ground {
    /// Pieces from left to right.
    pieces: Vec<Straight>,
    /// Height of the rock (m).
    height: f64,
}

impl Ground {
    fn of(case: &Case) -> Self {
        let rings = std::iter::once(&case.domain.outline).chain(&case.domain.islands);
        let sides = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let mut sides: Vec<Straight> =
            sides.filter(|(a, b)| a[0] != b[0]).map(|(a, b)| if a[0] < b[0] { [*a, *b] } else { [*b, *a] }).collect();
        sides.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
        let mut bends: Vec<f64> = sides.iter().flatten().map(|point| point[0]).collect();
        bends.sort_by(f64::total_cmp);
        bends.dedup();
        let heights = || sides.iter().flatten().map(|point| point[1]);
        let height = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
        let (mut open, mut rest): (Vec<Straight>, _) = (Vec::new(), sides.into_iter().peekable());
        let mut pieces = Vec::new();
        for pair in bends.windows(2) {
            open.retain(|side| side[1][0] > pair[0]);
            while let Some(side) = rest.next_if(|side| side[0][0] <= pair[0]) {
                open.push(side);
            }
            let middle = f64::midpoint(pair[0], pair[1]);
            let top = open.iter().max_by(|a, b| height_on(a, middle).total_cmp(&height_on(b, middle)));
            pieces.extend(top.map(|side| [pair[0], pair[1]].map(|x| [x, height_on(side, x)])));
        }
        Self { pieces, height }
    }

    fn ponds(&self, key: &str, surface: &WaterSurface) -> Vec<Pond> {
        let table: &PointList = match &surface.table {
            Some(table) if !table.is_empty() => table,
            _ => return Vec::new(),
        };
        let (first, last) = (table[0], table[table.len() - 1]);
        let beyond = |end: [f64; 2]| match self.at(end[0]) {
            Some(ground) if end[1] < ground - SHALLOW * self.height => PondPart::BeyondRock(end),
            _ => PondPart::BeyondGround(end),
        };
        let level = |from: f64, to: f64, y: f64| [[from, y], [to, y]];
        let left = (level(f64::NEG_INFINITY, first[0], first[1]), beyond(first));
        let right = (level(last[0], f64::INFINITY, last[1]), beyond(last));
        let sloping = table.windows(2).filter(|pair| pair[0][1] != pair[1][1] && pair[0][0] < pair[1][0]);
        let sloping = sloping.map(|pair| ([pair[0], pair[1]], PondPart::Sloping));
        let mut all: Vec<Pond> = Vec::new();
        for (line, part) in std::iter::once(left).chain(sloping).chain([right]) {
            for (depth, span) in self.flooded(&line) {
                match all.last_mut().filter(|pond| pond.part == part && pond.span[1] == span[0]) {
                    Some(pond) => (pond.depth, pond.span[1]) = (pond.depth.max(depth), span[1]),
                    None => all.push(Pond { key: key.to_owned(), depth, span, part, others: 0 }),
                }
            }
        }
        all.retain(|pond| pond.depth > SHALLOW * self.height);
        let mut found: Vec<Pond> = Vec::new();
        for pond in all {
            match found.iter_mut().find(|deepest| deepest.part == pond.part) {
                Some(deepest) => {
                    let others = deepest.others + 1;
                    if pond.depth > deepest.depth {
                        *deepest = pond;
                    }
                    deepest.others = others;
                }
                None => found.push(pond),
            }
        }
        found
    }

    /// Where a straight line is above the ground: greatest depth (m) of each piece, with the span of its x.
    fn flooded(&self, line: &Straight) -> Vec<(f64, [f64; 2])> {
        let wet = |piece: &Straight| {
            let [from, to] = [piece[0][0].max(line[0][0]), piece[1][0].min(line[1][0])];
            let depth = [from, to].map(|x| water_on(line, x) - height_on(piece, x));
            if from >= to || depth.iter().all(|depth| *depth <= 0.0) {
                return None;
            }
            let crossing = from + (to - from) * depth[0] / (depth[0] - depth[1]);
            let span = [if depth[0] > 0.0 { from } else { crossing }, if depth[1] > 0.0 { to } else { crossing }];
            Some((depth[0].max(depth[1]), span))
        };
        self.pieces.iter().filter_map(wet).collect()
    }

    /// The higher of both grounds at `x` (m); none beside the rock.
    fn at(&self, x: f64) -> Option<f64> {
        let beside = self.pieces.iter().filter(|piece| piece[0][0] <= x && x <= piece[1][0]);
        beside.map(|piece| height_on(piece, x)).reduce(f64::max)
    }
}

fn height_on([a, b]: &Straight, x: f64) -> f64 {
    a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0])
}

/// Height of a line that may be level without end.
fn water_on(line: &Straight, x: f64) -> f64 {
    if line[0][1] == line[1][1] { line[0][1] } else { height_on(line, x) }
}
