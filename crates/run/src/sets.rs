//! Joint sets of a case from orientations that were measured in the field.

use enmm::model::case::{Orientation, trace_angle};
use enmm_field::{Axis, BLIND_DEG, FieldError, Fisher, Scanline, Table, find_sets, given_sets, plane_of};
use enmm_picture::{FieldNet, FieldSet, Projection};

use crate::stereonet::apparent;

/// Choices of the sets of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SetOptions {
    /// Lines along which the joints were measured: poles are weighted by Terzaghi.
    pub lines: Vec<Scanline>,
    /// Number of sets; default: by the criterion.
    pub number: Option<usize>,
    /// Takes the sets that the table names.
    pub named: bool,
    /// Azimuth of the x axis of the section (degrees).
    pub section: Option<f64>,
    /// Projection of the net.
    pub projection: Projection,
}

/// A set of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundSet {
    /// Name.
    pub name: String,
    /// Mean and scatter.
    pub mean: Fisher,
    /// Its rows in the table.
    pub members: Vec<usize>,
    /// Mean spacing normal to the joints (m), where the table has distances along known lines.
    pub spacing: Option<f64>,
}

/// Sets of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundSets {
    /// All sets, the heaviest first.
    pub sets: Vec<FoundSet>,
    /// Poles with their weights.
    pub poles: Vec<(Axis, f64)>,
    /// The criterion for each number of sets that was tried, from 1.
    pub criteria: Vec<Option<f64>>,
    /// Remarks.
    pub notes: Vec<String>,
    section: Option<f64>,
}

/// Least concentration that a case takes, and that below which a set is no Fisher distribution of one direction.
const KAPPA_MIN: f64 = 5.0;
/// Greatest one that a case takes.
const KAPPA_MAX: f64 = 1e6;

/// Finds the sets of a table.
///
/// # Errors
/// A row on an unknown line, too few poles, or names of sets that the table does not have.
pub fn sets(table: &Table, options: &SetOptions) -> Result<FoundSets, FieldError> {
    let (poles, blind) = table.weighted(&options.lines)?;
    let mut notes = table.notes.clone();
    if blind > 0 {
        notes.push(format!(
            "{blind} planes are nearer to their line than {BLIND_DEG:.0}°: weights stay those of {BLIND_DEG:.0}°"
        ));
    }
    let (found, criteria) = if options.named {
        let names: Vec<Option<String>> = table.rows.iter().map(|row| row.set.clone()).collect();
        let without = names.iter().filter(|name| name.is_none()).count();
        if without == names.len() {
            let message = "the table names no sets: no row has one in a column `set`; leave --named out".to_owned();
            return Err(FieldError::Whole(message));
        }
        if without > 0 {
            notes.push(format!("{without} rows name no set and are in none"));
        }
        (given_sets(&poles, &names), Vec::new())
    } else {
        let sets = find_sets(&poles, options.number)?;
        let members = |set: usize| (0..poles.len()).filter(|&k| sets.of[k] == set).collect::<Vec<usize>>();
        let named = |(k, mean): (usize, &Fisher)| (format!("J{}", k + 1), *mean, members(k));
        (sets.means.iter().enumerate().map(named).collect(), sets.criteria)
    };
    let set = |(name, mean, members): (String, Fisher, Vec<usize>)| {
        let spacing = table.spacing(&options.lines, &mean.mean, &members);
        FoundSet { name, mean, members, spacing }
    };
    let sets: Vec<FoundSet> = found.into_iter().map(set).collect();
    for set in sets.iter().filter(|set| set.mean.kappa < KAPPA_MIN) {
        notes.push(format!(
            "{}: κ {:.1} is below {KAPPA_MIN}: its poles scatter too widely for one set",
            set.name, set.mean.kappa
        ));
    }
    Ok(FoundSets { sets, poles, criteria, notes, section: options.section })
}

impl FoundSets {
    /// Trace of a set in the section, in words; empty without a section.
    pub fn trace(&self, set: &FoundSet) -> String {
        let [dip, direction] = plane_of(&set.mean.mean);
        let words = |azimuth: f64| {
            let trace = trace_angle(dip, direction - azimuth);
            let name = set.name.clone();
            apparent(&Orientation { name, dip, direction, in_space: true, trace, friction: 0.0 })
        };
        self.section.map_or_else(String::new, words)
    }

    /// The net with poles, sets and rosette.
    pub fn net(&self, title: String, projection: Projection) -> FieldNet {
        let mut of = vec![None; self.poles.len()];
        for (k, set) in self.sets.iter().enumerate() {
            set.members.iter().for_each(|&member| of[member] = Some(k));
        }
        let shown = |set: &FoundSet| FieldSet { name: set.name.clone(), mean: set.mean, remark: self.trace(set) };
        let sets = self.sets.iter().map(shown).collect();
        FieldNet { title, poles: self.poles.clone(), of, sets, projection, notes: self.notes.clone() }
    }

    /// Lines of a case: the section and a `[[joint_set]]` for each set. What the table does not say is left open in
    /// remarks, and a case without it is refused.
    pub fn case_lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        match self.section {
            Some(azimuth) => lines.extend(["[section]".to_owned(), format!("azimuth_deg = {azimuth}"), String::new()]),
            None => lines.push("# open: [section] with azimuth_deg, the azimuth of the x axis".to_owned()),
        }
        for set in &self.sets {
            let [dip, direction] = plane_of(&set.mean.mean).map(tenth);
            let Fisher { count, kappa, cone_deg, .. } = set.mean;
            let trace = self.trace(set);
            let trace = if trace.is_empty() { trace } else { format!("; {trace}") };
            lines.push("[[joint_set]]".to_owned());
            lines.push(format!("name = {:?}  # {count} poles, mean ± {cone_deg:.1}° (95 %){trace}", set.name));
            lines.push(format!("dip_deg = {dip}"));
            lines.push(format!("dip_direction_deg = {}", direction.rem_euclid(360.0)));
            if (KAPPA_MIN..KAPPA_MAX).contains(&kappa) {
                lines.push("angle_distribution = \"fisher\"".to_owned());
                lines.push(format!("fisher_k = {}", tenth(kappa)));
            } else {
                lines.push(format!("# κ {kappa:.1} is none that `fisher_k` takes ({KAPPA_MIN} to 1e6): no scatter"));
            }
            lines.push(match set.spacing {
                Some(spacing) => format!("spacing = {spacing:.4}"),
                None => "# open: spacing, the mean distance between joints, normal to them (m)".to_owned(),
            });
            lines.push(String::new());
        }
        lines
    }
}

fn tenth(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}
