//! Sections of a DXF drawing, their records, and the blocks that records of type INSERT name.

use std::collections::BTreeMap;

use super::groups::{Group, Groups};
use crate::case_error::CaseError;

/// One entity as it stands in the file; a polyline comprises its vertices.
#[derive(Debug)]
pub struct Record<'a> {
    /// Type, such as `LINE`.
    pub kind: &'a str,
    /// Layer; `0` if none is given.
    pub layer: &'a str,
    /// Line of the type, counted from 1.
    pub line: usize,
    /// Its pairs, the type first.
    pub groups: &'a [Group<'a>],
    /// Pairs of the vertices of a POLYLINE.
    pub vertices: Vec<&'a [Group<'a>]>,
    ended: bool,
}

/// A block of a drawing.
#[derive(Debug)]
pub struct Block<'a> {
    /// Name as the block itself writes it.
    pub name: &'a str,
    /// Pairs of its head.
    pub head: &'a [Group<'a>],
    /// Its entities.
    pub records: Vec<Record<'a>>,
}

/// Blocks by their names in small letters.
pub type Blocks<'a> = BTreeMap<String, Block<'a>>;

const UNENDED: &str = "POLYLINE without SEQEND after its vertices; the file is damaged, save it again";

impl<'a> Record<'a> {
    /// The first pair with a code.
    pub fn find(&self, code: i32) -> Option<&'a Group<'a>> {
        find(self.groups, code)
    }

    /// The number under a code, or what holds without it.
    ///
    /// # Errors
    /// It is no number.
    pub fn number_or(&self, groups: &Groups, code: i32, default: f64) -> Result<f64, CaseError> {
        self.find(code).map_or(Ok(default), |group| groups.number(group))
    }

    /// The number under a code.
    ///
    /// # Errors
    /// It is missing or no number.
    pub fn number(&self, groups: &Groups, code: i32) -> Result<f64, CaseError> {
        match self.find(code) {
            Some(group) => groups.number(group),
            None => groups.missing(self.line, self.kind, code),
        }
    }

    /// The whole number under a code, 0 if it is not given.
    ///
    /// # Errors
    /// It is no whole number.
    pub fn whole(&self, groups: &Groups, code: i32) -> Result<i64, CaseError> {
        groups.whole(self.groups, code)
    }
}

/// The first pair of some with a code.
pub fn find<'g, 'a>(pairs: &'g [Group<'a>], code: i32) -> Option<&'g Group<'a>> {
    pairs.iter().find(|group| group.code == code)
}

/// The pairs of a section, or none if the file has no such section.
fn section<'a>(groups: &'a Groups<'a>, name: &str) -> Option<&'a [Group<'a>]> {
    let named = |pair: &[Group]| (pair[0].code, pair[0].value, pair[1].code, pair[1].value) == (0, "SECTION", 2, name);
    let start = groups.all.windows(2).position(named)?;
    let body = &groups.all[start + 2..];
    let end = body.iter().position(|group| group.code == 0 && group.value == "ENDSEC").unwrap_or(body.len());
    Some(&body[..end])
}

/// The entities of the drawing.
///
/// # Errors
/// The file has no such section, or a polyline does not end.
pub fn entities<'a>(groups: &'a Groups<'a>) -> Result<Vec<Record<'a>>, CaseError> {
    match section(groups, "ENTITIES") {
        Some(body) => records(groups, body),
        None => {
            groups.syntax(1, "no section ENTITIES, which holds the lines; save the drawing as ASCII DXF".to_string())
        }
    }
}

/// The blocks of the drawing.
///
/// # Errors
/// A polyline does not end.
pub fn blocks<'a>(groups: &'a Groups<'a>) -> Result<Blocks<'a>, CaseError> {
    let mut blocks = Blocks::new();
    let body = section(groups, "BLOCKS").unwrap_or_default();
    let is_start = |group: &Group| (group.code, group.value) == (0, "BLOCK");
    let starts: Vec<usize> = (0..body.len()).filter(|&k| is_start(&body[k])).collect();
    for (k, &start) in starts.iter().enumerate() {
        let all = &body[start..starts.get(k + 1).copied().unwrap_or(body.len())];
        let next = |from: usize| all[from..].iter().position(|group| group.code == 0).map_or(all.len(), |at| from + at);
        let head = &all[..next(1)];
        let end = all.iter().position(|group| (group.code, group.value) == (0, "ENDBLK")).unwrap_or(all.len());
        let name = find(head, 2).map_or("", |group| group.value);
        let records = records(groups, &all[head.len().min(end)..end])?;
        blocks.insert(name.to_lowercase(), Block { name, head, records });
    }
    Ok(blocks)
}

fn records<'a>(groups: &Groups, body: &'a [Group<'a>]) -> Result<Vec<Record<'a>>, CaseError> {
    let mut records: Vec<Record> = Vec::new();
    for pairs in body.chunk_by(|_, next| next.code != 0) {
        let (kind, line) = (pairs[0].value, pairs[0].line);
        match (kind, records.last_mut().filter(|last| last.kind == "POLYLINE" && !last.ended)) {
            ("VERTEX", Some(polyline)) => polyline.vertices.push(pairs),
            ("SEQEND", Some(polyline)) => polyline.ended = true,
            (_, Some(polyline)) => return groups.syntax(polyline.line, UNENDED.to_string()),
            // It ends the attributes of an INSERT, which are entities of their own here.
            ("SEQEND", None) => {}
            _ => {
                let layer = find(pairs, 8).map_or("0", |group| group.value);
                records.push(Record { kind, layer, line, groups: pairs, vertices: Vec::new(), ended: false });
            }
        }
    }
    match records.last().filter(|last| last.kind == "POLYLINE" && !last.ended) {
        Some(polyline) => groups.syntax(polyline.line, UNENDED.to_string()),
        None => Ok(records),
    }
}
