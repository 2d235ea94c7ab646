//! Checks of everything that can be known from the case alone: signs, ranges, alternatives, references. What needs the
//! planar arrangement (self-intersections, blocks that do not exist) is checked by the builder.

pub(crate) mod bolts;
pub(crate) mod checks;
mod drawing;
pub(crate) mod flow;
mod fracture;
pub(crate) mod ground;
mod joint_sets;
mod joints;
mod loads;
mod monitors;
mod ports;
mod random;
mod rock_strength;
mod stages;

use crate::key::{Check, Key, fail};
use crate::keys::{Range, Rule};
use crate::limits::{NAME_MAX, TITLE_MAX};
use crate::{Case, Domain, FmuNotes, InSitu, Invalid, JointLaw, Plane, ReportNotes, Rock};
use checks::{Names, each, harmless, points, polygon, region};

/// Longest line of the cover of a report (bytes).
const REPORT_NOTE_MAX: usize = 4000;

impl Case {
    /// Checks every value and reference of the case.
    ///
    /// # Errors
    /// The first value that cannot be used, in the order of the fields of [`Case`].
    pub fn validate(&self) -> Result<(), Invalid> {
        self.must_be_expanded()?;
        let root = Key::root();
        harmless(&root.field("title"), &self.title, TITLE_MAX)?;
        let sets = self.joint_sets.iter().map(|set| set.name.as_deref()).enumerate();
        sets.filter_map(|(k, name)| Some((k, name?)))
            .try_for_each(|(k, name)| harmless(&root.field("joint_set").index(k).field("name"), name, NAME_MAX))?;
        self.rocks.keys().try_for_each(|name| harmless(&root.field("rock"), name, NAME_MAX))?;
        self.joint_laws.keys().try_for_each(|name| harmless(&root.field("joint_law"), name, NAME_MAX))?;
        self.validate_drawing()?;
        domain(&root.field("domain"), &self.domain)?;
        self.mesh.check(&root.field("mesh"))?;
        self.validate_joints(&root)?;
        self.validate_rocks(&root.field("rock"))?;
        for (name, law) in &self.joint_laws {
            let key = root.field("joint_law").field(name);
            joint_law(&key, law)?;
            joints::validate_integrator(&key, law, self.solver.integrator)?;
            joints::validate_breaks(&key, law, self.has_bridges_of(name))?;
        }
        joint_sets::validate_law_regions(&root.field("law_region"), self)?;
        fracture::validate_fracture(&root, self)?;
        self.gravity.check(&root.field("gravity"))?;
        loads::validate_fixes(&root.field("fix"), &self.fixes)?;
        loads::validate_loads(&root.field("load"), &self.loads)?;
        ground::validate_base_motions(&root.field("base_motion"), self)?;
        ground::validate_quiets(&root.field("quiet"), self)?;
        ground::validate_free_fields(&root.field("free_field"), &self.free_fields)?;
        bolts::validate_bolts(&root.field("bolt"), &self.bolts)?;
        each(&root.field("initial_velocity"), &self.initial_velocities, |key, start| start.check(key))?;
        if let Some(stress) = &self.in_situ {
            stress.check(&root.field("in_situ"))?;
            self.validate_stress_out(&root.field("in_situ"), stress)?;
        }
        if let Some(water) = &self.water {
            ports::validate_water(&root.field("water"), water)?;
        }
        flow::validate_flow(&root, self)?;
        ports::validate_ports(&root.field("port"), self)?;
        if let Some(notes) = &self.fmu {
            fmu_notes(&root.field("fmu"), notes)?;
        }
        report_notes(&root.field("report"), &self.report)?;
        stages::validate_stages(&root.field("stage"), self)?;
        bolts::validate_installs(&root.field("stage"), self)?;
        monitors::validate_monitors(&root, self)?;
        self.solver.check(&root.field("solver"))?;
        random::validate_random(&root, self)?;
        self.validate_drawing_is_used()
    }

    /// Returns the law of joints that name none: `domain.joint_law`, else the only law of the case, else none.
    pub fn default_joint_law(&self) -> Option<&str> {
        let only = || self.joint_laws.keys().next().filter(|_| self.joint_laws.len() == 1);
        self.domain.joint_law.as_ref().or_else(only).map(String::as_str)
    }

    /// Whether rock bridges may have a law.
    fn has_bridges_of(&self, law: &str) -> bool {
        let of_sets = self.joint_sets.iter().filter_map(|set| set.bridge_law.as_deref());
        let mut named = self.bridges.iter().map(|bridge| bridge.law.as_str()).chain(of_sets);
        let of_regions = self.law_regions.iter().any(|region| region.to == law);
        named.any(|name| name == law) || self.domain.bridge_law.as_deref() == Some(law) || of_regions
    }

    fn validate_joints(&self, root: &Key) -> Check {
        let laws = Names::of_laws(self);
        if let Some(law) = &self.domain.joint_law {
            laws.must_hold(&root.field("domain").field("joint_law"), law)?;
        }
        for (i, trace) in self.joints.iter().enumerate() {
            let check = |key: &Key| {
                trace.check(key)?;
                points(&key.field("points"), &trace.points, 2, "a joint trace")?;
                self.validate_law_of_joint(&laws, key, trace.law.as_deref())
            };
            // To write the key of a joint takes longer than to check it.
            if check(root).is_err() {
                check(&root.field("joint").index(i))?;
            }
        }
        for (i, set) in self.joint_sets.iter().enumerate() {
            let key = root.field("joint_set").index(i);
            joint_sets::validate_set(&key, set)?;
            joint_sets::validate_end(&key, self, i)?;
            self.validate_law_of_joint(&laws, &key, set.law.as_deref())?;
            joint_sets::validate_bridges(&key, set, &laws)?;
        }
        each(&root.field("bridge"), &self.bridges, |key, bridge| {
            bridge.check(key)?;
            points(&key.field("points"), &bridge.points, 2, "a rock bridge")?;
            laws.must_hold(&key.field("law"), &bridge.law)
        })?;
        if let Some(law) = &self.domain.bridge_law {
            laws.must_hold(&root.field("domain").field("bridge_law"), law)?;
        }
        if self.domain.islands.is_empty() {
            return Ok(());
        }
        self.validate_law_of_joint(&laws, &root.field("domain").field("islands"), None)
    }

    fn validate_law_of_joint(&self, laws: &Names, key: &Key, law: Option<&str>) -> Check {
        if let Some(law) = law {
            return laws.must_hold(&key.field("law"), law);
        }
        if self.default_joint_law().is_some() {
            return Ok(());
        }
        if self.joint_laws.is_empty() {
            let remedy = "add `[joint_law.NAME]` with `friction_deg = 30.0`";
            return fail(
                &Key::root().field("joint_law"),
                format!("{key} needs a joint law, but there is none; {remedy}"),
            );
        }
        let message =
            format!("is missing, {key} names no law and there are several ({laws}); add `joint_law` or the name");
        fail(&Key::root().field("domain").field("joint_law"), message)
    }

    fn validate_rocks(&self, key: &Key) -> Check {
        if self.rocks.is_empty() {
            let remedy = "add `[rock.NAME]` with `density`, `young` and `poisson`";
            return fail(key, format!("the case has no rock, at least 1 is needed; {remedy}"));
        }
        let mut background: Option<&str> = None;
        for (name, properties) in &self.rocks {
            rock(&key.field(name), properties)?;
            if properties.region.is_some() || !properties.blocks.is_empty() {
                continue;
            }
            if let Some(other) = background.replace(name) {
                let message = format!(
                    "neither this rock nor rock {other:?} has `region` or `blocks`, at most 1 rock can be the \
                     background; add `region` or `blocks` to one of them"
                );
                return fail(&key.field(name), message);
            }
        }
        Ok(())
    }

    /// `szz` acts on rock that yields in plane strain alone.
    fn validate_stress_out(&self, key: &Key, stress: &InSitu) -> Check {
        let acts = self.rocks.values().any(|rock| rock.yields() && rock.plane == Plane::Strain);
        if stress.szz.is_some() && !acts {
            let message = "has no effect: no rock of plane strain yields; remove it, or give a rock `friction_deg`";
            return fail(&key.field("szz"), message);
        }
        if stress.szz_gradient != 0.0 && stress.szz.is_none() {
            return fail(&key.field("szz_gradient"), "has no effect without `szz`; add it or remove this");
        }
        Ok(())
    }
}

fn domain(key: &Key, domain: &Domain) -> Check {
    domain.check(key)?;
    if domain.geometry_file.is_some() {
        return fail(
            &key.field("geometry_file"),
            "the file is not merged into the case; load the case through `io::load_case`, or give `outline` and joints",
        );
    }
    if domain.outline.is_empty() {
        return fail(
            &key.field("outline"),
            "there is no outline; give `outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]` or a `geometry_file` with one",
        );
    }
    polygon(&key.field("outline"), &domain.outline)?;
    for (name, loops) in [("holes", &domain.holes), ("islands", &domain.islands)] {
        for (i, ring) in loops.iter().enumerate() {
            polygon(&key.field(name).index(i), ring)?;
        }
    }
    Ok(())
}

fn rock(key: &Key, rock: &Rock) -> Check {
    rock.check(key)?;
    if rock.plane == Plane::Strain {
        const RULE: Rule = Rock::rule("poisson").in_range(Range::above(-1.0).below(0.5));
        RULE.check(key, &rock.poisson, None)?;
    }
    rock_strength::validate_strength(key, rock)?;
    rock.region.as_ref().map_or(Ok(()), |ring| region(&key.field("region"), ring))
}

fn joint_law(key: &Key, law: &JointLaw) -> Check {
    law.check(key)?;
    joints::validate_kind(key, law)?;
    joints::validate_energies(key, law)
}

fn fmu_notes(key: &Key, notes: &FmuNotes) -> Check {
    for (name, note) in [("author", &notes.author), ("copyright", &notes.copyright), ("license", &notes.license)] {
        if note.as_ref().is_some_and(|note| note.trim().is_empty()) {
            return fail(&key.field(name), "is empty, must say something; leave it out for what holds without it");
        }
    }
    notes.check(key)?;
    for (k, block) in notes.blocks.iter().enumerate() {
        if notes.blocks[..k].contains(block) {
            return fail(&key.field("blocks").index(k), format!("names block {block} again; name each block once"));
        }
    }
    Ok(())
}

fn report_notes(key: &Key, notes: &ReportNotes) -> Check {
    for (name, note) in notes.entries() {
        let Some(note) = note else { continue };
        if note.trim().is_empty() {
            return fail(&key.field(name), "is empty, must say something; leave it out for a report without this line");
        }
        if note.len() > REPORT_NOTE_MAX {
            let message = format!("has {} bytes, the limit is {REPORT_NOTE_MAX}; shorten it", note.len());
            return fail(&key.field(name), message);
        }
    }
    Ok(())
}
