//! The input of a case as the records of results hold it: what the report of `enmm report` prints beside the results.
//!
//! Values are those that the user typed, so that a dip stays a dip; bolts of patterns are listed one by one.

use enmm::model::case::{Bolt, Case, JointTrace};
use enmm_io::LoadedCase;
use serde_json::{Value, json};

/// The input of a case.
pub fn input_record(loaded: &LoadedCase) -> Value {
    let LoadedCase { case, typed, .. } = loaded;
    let notes = case.report.entries().into_iter().filter_map(|(name, note)| Some((name.to_owned(), json!(note?))));
    let mut record = json!({
        "report": notes.collect::<serde_json::Map<_, _>>(),
        "section": typed.section,
        "rocks": typed.rocks,
        "joint_laws": typed.joint_laws,
        "joint_sets": typed.joint_sets.iter().map(|set| without(json!(set), &["region"])).collect::<Vec<_>>(),
        "joints": joints(typed),
        "gravity": typed.gravity,
        "in_situ": typed.in_situ,
        "water": typed.water.as_ref().map(|water| without(json!(water), &["faces"])),
        "bolts": case.bolts.iter().map(bolt).collect::<Vec<_>>(),
        "loads": typed.loads.iter().map(|load| without(json!(load), &["table"])).collect::<Vec<_>>(),
        "base_motions": case.base_motions.iter().map(|base| json!({
            "kind": base.kind,
            "axis": base.axis,
            "peak": peak(base.table.iter().flatten().map(|row| base.scale * row[1])),
        })).collect::<Vec<_>>(),
        "stages": typed.stages.iter().map(|stage| without(json!(stage), &["excavate_region"])).collect::<Vec<_>>(),
        "random": typed.random.iter().map(|row| json!(row)).collect::<Vec<_>>(),
        "case_text": loaded.source.text(),
    });
    if let Some(flow) = &typed.flow {
        record["flow"] = json!(flow);
        record["heads"] = typed.heads.iter().map(|head| without(json!(head), &["edge"])).collect();
    }
    record
}

/// An object without some of its keys.
fn without(mut object: Value, keys: &[&str]) -> Value {
    if let Value::Object(object) = &mut object {
        keys.iter().for_each(|key| _ = object.remove(*key));
    }
    object
}

fn bolt(bolt: &Bolt) -> Value {
    let [from, to] = bolt.points;
    let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
    let mut record = json!(bolt);
    record["length"] = json!(length);
    record
}

/// Number and length of the drawn joints of each law; the law without a name is that of the domain.
fn joints(case: &Case) -> Value {
    let mut laws: Vec<(Option<&String>, usize, f64)> = Vec::new();
    for JointTrace { points, law } in &case.joints {
        let law = law.as_ref().or(case.domain.joint_law.as_ref());
        let pieces = points.windows(2).map(|ends| libm::hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]));
        let length: f64 = pieces.sum();
        match laws.iter_mut().find(|(known, ..)| *known == law) {
            Some((_, count, total)) => (*count, *total) = (*count + 1, *total + length),
            None => laws.push((law, 1, length)),
        }
    }
    laws.into_iter().map(|(law, count, length)| json!({ "law": law, "count": count, "length": length })).collect()
}

/// The greatest size among values.
fn peak(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}
