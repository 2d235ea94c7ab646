//! The bounds with the ends of joints that almost meet a line as they are drawn, and joined to it: whether intact rock
//! before an end holds the slope.

use enmm::geometry::ends::EndChange;
use enmm::model::assemble::{Built, TraceEnd, outlines};
use enmm::model::case::{Case, JointTrace};

use super::contact::Contact;
use super::program::Unsolved;
use super::search::Search;
use super::{Blocks, Factor, RANGE, refusal};

/// Share by which the bound with the ends joined must be lower for them to decide, as for corners that carry.
const DECIDES: f64 = 0.02;
/// Ends that the warning names.
const NAMED: usize = 5;

/// Ends near a line, and the bounds without and with the stretches that are missing.
#[derive(Debug, Clone, PartialEq)]
pub struct NearEnds {
    /// The bound where all ends stay as they are drawn.
    pub drawn: Factor,
    /// The bound where all of them are joined to their lines.
    pub joined: Factor,
    /// The ends.
    pub ends: Vec<TraceEnd>,
}

impl NearEnds {
    /// Both bounds and the ends, nearest first.
    pub fn warning(&self) -> String {
        let mut ends: Vec<&TraceEnd> = self.ends.iter().collect();
        ends.sort_by(|a, b| a.gap.total_cmp(&b.gap));
        let named: Vec<String> = ends.iter().take(NAMED).map(|end| told(end)).collect();
        let more = ends.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!(
            "ends of joints that miss a line decide about the slope: the bound is {} as they are drawn and {} with \
             them joined: {}{more}; draw them up to the line, or raise domain.extend_ends above their distance, where \
             no rock holds the slope there",
            self.drawn,
            self.joined,
            named.join(", ")
        )
    }
}

/// An end in words: `joint[0] at (1.000, 2.000) m, 0.240 m from the outline (kept)`.
fn told(end: &TraceEnd) -> String {
    let TraceEnd { name, place, gap, line, .. } = end;
    let fate = if end.change == EndChange::Kept { "kept" } else { "joined" };
    format!("{name} at ({:.3}, {:.3}) m, {gap:.3} m from {line} ({fate})", place.x, place.y)
}

/// Both bounds of a case with ends near a line, of which the model as built has one or something between; none where
/// they differ by 2 % or less. Blocks are counted first: as many of them are the same blocks, whose bound is known.
///
/// # Errors
/// Why a bound was not found.
pub fn near_ends(case: &Case, built: &Built, blocks: usize, known: Factor) -> Result<Option<NearEnds>, String> {
    let is_near = |end: &&TraceEnd| end.change != EndChange::Bridged;
    let ends: Vec<TraceEnd> = built.ends.iter().filter(is_near).cloned().collect();
    let is_kept = |end: &TraceEnd| end.change == EndChange::Kept;
    let (mut drawn, mut joined) = (known, known);
    if ends.iter().any(is_kept) {
        joined = Other::of(&all_joined(case, built, &ends), blocks)?.map_or(Ok(known), |other| other.below(known))?;
    }
    if !ends.iter().all(is_kept) {
        let mut as_drawn = case.clone();
        as_drawn.domain.extend_ends = Some(0.0);
        drawn = Other::of(&as_drawn, blocks)?.map_or(Ok(known), |other| other.above(known))?;
    }
    let decide = joined.value() < (1.0 - DECIDES) * drawn.value();
    Ok(decide.then_some(NearEnds { drawn, joined, ends }))
}

/// The case with the stretches that are missing at the ends that stay in the rock.
fn all_joined(case: &Case, built: &Built, ends: &[TraceEnd]) -> Case {
    let mut case = case.clone();
    let laws: Vec<String> = case.joint_laws.keys().cloned().collect();
    let kept = ends.iter().filter(|end| end.change == EndChange::Kept);
    case.joints.extend(kept.map(|end| JointTrace {
        points: vec![end.place.into(), end.meets.into()],
        law: laws.get(built.traces[end.trace].1.index()).cloned(),
    }));
    case
}

/// Another drawing of a case.
struct Other {
    /// Its blocks; none where all of them are held, so that none fails.
    blocks: Option<Blocks>,
}

impl Other {
    /// None where it has so many blocks.
    fn of(case: &Case, blocks: usize) -> Result<Option<Self>, String> {
        let (simulation, _) = refusal::staged(case).map_err(|invalid| invalid.message)?;
        if simulation.model().covers.block_count() == blocks {
            return Ok(None);
        }
        let outlines = outlines(simulation.case()).map_err(|invalid| invalid.message)?;
        Ok(Some(Self { blocks: Blocks::new(&simulation, &outlines).ok() }))
    }

    /// Its bound, or the known one where it is not lower by more than 2 %: one program shows that.
    fn below(&self, known: Factor) -> Result<Factor, String> {
        let Some(blocks) = &self.blocks else { return Ok(known) };
        let mut search = Search { program: &blocks.program, programs: 0 };
        let strength = known.strength() / (1.0 - DECIDES);
        if search.holds(strength, &[]).map_err(status)? { Ok(known) } else { blocks.level_tops(&mut search) }
    }

    /// Its bound, or the known one where it is not higher by more than 2 %: one program shows that.
    fn above(&self, known: Factor) -> Result<Factor, String> {
        let Some(blocks) = &self.blocks else { return Ok(Factor::AtLeast(RANGE[1])) };
        let mut search = Search { program: &blocks.program, programs: 0 };
        let facets: Vec<Contact> = blocks.corners.iter().flat_map(|corner| corner.facets).collect();
        let strength = known.strength() * (1.0 - DECIDES);
        if search.holds(strength, &facets).map_err(status)? { blocks.level_tops(&mut search) } else { Ok(known) }
    }
}

impl Blocks {
    fn level_tops(&self, search: &mut Search) -> Result<Factor, String> {
        let free = search.limit_near(&[], None).map_err(status)?;
        Ok(search.facets(&self.corners, free).map_err(status)?.limit.factor())
    }
}

fn status(unsolved: Unsolved) -> String {
    format!("the linear program was not solved ({unsolved:?})")
}
