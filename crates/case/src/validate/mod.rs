//! Checks of everything that can be known from the case alone: signs, ranges, alternatives, references. What needs the
//! planar arrangement (self-intersections, blocks that do not exist) is checked by the builder.

pub(crate) mod bolts;
pub(crate) mod checks;
mod drawing;
pub(crate) mod ground;
mod joint_sets;
mod joints;
mod loads;
mod ports;
mod random;
mod rock_strength;
mod stages;

use thiserror::Error;

use super::key::Key;
use super::{
    Case, Domain, FmuNotes, Gravity, InSitu, InitialVelocity, JointLaw, Mesh, Output, Plane, ReportNotes, Rock, Solver,
};
use checks::{
    COORDINATE_MAX, Check, Law, Names, ONE_TO_THOUSAND, Range, fail, harmless, number, optional, point, points,
    polygon, region, unique, whole,
};

/// Longest line of the cover of a report (bytes).
const REPORT_NOTE_MAX: usize = 4000;

/// A value of a case that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key}: {message}")]
pub struct Invalid {
    /// Place in the case, such as `rock.granite.young` or `joint[3].points[1]`.
    pub key: String,
    /// The fault, the value, the limit and the remedy.
    pub message: String,
}

impl Case {
    /// Checks every value and reference of the case.
    ///
    /// # Errors
    /// The first value that cannot be used, in the order of the fields of [`Case`].
    pub fn validate(&self) -> Result<(), Invalid> {
        self.must_be_expanded()?;
        let root = Key::root();
        harmless(&root.field("title"), &self.title)?;
        let sets = self.joint_sets.iter().map(|set| set.name.as_deref()).enumerate();
        sets.filter_map(|(k, name)| Some((k, name?)))
            .try_for_each(|(k, name)| harmless(&root.field("joint_set").index(k).field("name"), name))?;
        self.rocks.keys().try_for_each(|name| harmless(&root.field("rock"), name))?;
        self.joint_laws.keys().try_for_each(|name| harmless(&root.field("joint_law"), name))?;
        self.validate_drawing()?;
        domain(&root.field("domain"), &self.domain)?;
        mesh(&root.field("mesh"), &self.mesh)?;
        self.validate_joints(&root)?;
        self.validate_rocks(&root.field("rock"))?;
        for (name, law) in &self.joint_laws {
            let key = root.field("joint_law").field(name);
            joint_law(&key, law)?;
            joints::validate_integrator(&key, law, self.solver.integrator)?;
            joints::validate_breaks(&key, law, self.has_bridges_of(name))?;
        }
        joint_sets::validate_law_regions(&root.field("law_region"), self)?;
        gravity(&root.field("gravity"), &self.gravity)?;
        loads::validate_fixes(&root.field("fix"), &self.fixes)?;
        loads::validate_loads(&root.field("load"), &self.loads)?;
        ground::validate_base_motions(&root.field("base_motion"), self)?;
        ground::validate_quiets(&root.field("quiet"), self)?;
        ground::validate_free_fields(&root.field("free_field"), &self.free_fields)?;
        bolts::validate_bolts(&root.field("bolt"), &self.bolts)?;
        for (i, start) in self.initial_velocities.iter().enumerate() {
            initial_velocity(&root.field("initial_velocity").index(i), start)?;
        }
        if let Some(stress) = &self.in_situ {
            in_situ(&root.field("in_situ"), stress)?;
            self.validate_stress_out(&root.field("in_situ"), stress)?;
        }
        if let Some(water) = &self.water {
            ports::validate_water(&root.field("water"), water)?;
        }
        ports::validate_ports(&root.field("port"), &self.ports)?;
        if let Some(notes) = &self.fmu {
            fmu_notes(&root.field("fmu"), notes)?;
        }
        report_notes(&root.field("report"), &self.report)?;
        stages::validate_stages(&root.field("stage"), self)?;
        bolts::validate_installs(&root.field("stage"), self)?;
        self.validate_monitors(&root.field("monitor"))?;
        output(&root.field("output"), &self.output)?;
        solver(&root.field("solver"), &self.solver)?;
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
        for (i, bridge) in self.bridges.iter().enumerate() {
            let key = root.field("bridge").index(i);
            points(&key.field("points"), &bridge.points, 2, "a rock bridge")?;
            laws.must_hold(&key.field("law"), &bridge.law)?;
        }
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

    fn validate_monitors(&self, key: &Key) -> Check {
        for (i, monitor) in self.monitors.iter().enumerate() {
            point(&key.index(i).field("point"), &monitor.point)?;
        }
        unique(key, "monitor", self.monitors.iter().map(|monitor| Some(monitor.name.as_str())))
    }
}

fn domain(key: &Key, domain: &Domain) -> Check {
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
    optional(key, "snap_tolerance", domain.snap_tolerance, Range::above(0.0).to(1e3), "m", "1e-6 of the model's size")?;
    optional(key, "extend_ends", domain.extend_ends, Range::from(0.0).to(1e3), "m", "0.0023 of the model's size")?;
    optional(key, "near_ends", domain.near_ends, Range::from(0.0).to(1e3), "m", "0.02 of the model's size")
}

fn mesh(key: &Key, mesh: &Mesh) -> Check {
    number(key, "size", mesh.size, Range::above(0.0).to(1e6), "m", "about a fifth of the smallest block is usual")?;
    number(key, "angle_deg", mesh.angle_deg, Range::within(360.0), "degrees", "0 to 60 gives every lattice")?;
    point(&key.field("origin"), &mesh.origin)?;
    optional(key, "least_block", mesh.least_block, Range::from(0.0).to(1e6), "m²", "(size/20)² is the default")
}

fn rock(key: &Key, rock: &Rock) -> Check {
    number(key, "density", rock.density, Range::from(1e-3).to(1e6), "kg/m³", "")?;
    number(key, "young", rock.young, Range::from(1.0).to(1e15), "Pa", "")?;
    let poisson = match rock.plane {
        Plane::Strain => Range::above(-1.0).below(0.5),
        Plane::Stress => Range::above(-1.0).to(0.5),
    };
    number(key, "poisson", rock.poisson, poisson, "", "rock has 0.1 to 0.4")?;
    rock_strength::validate_strength(key, rock)?;
    if let Some(ring) = &rock.region {
        region(&key.field("region"), ring)?;
    }
    points(&key.field("blocks"), &rock.blocks, 0, "a list of blocks")
}

fn joint_law(key: &Key, law: &JointLaw) -> Check {
    optional(key, "normal_stiffness", law.normal_stiffness, Law::STIFFNESS, "Pa/m", "leave it out for the solver's")?;
    optional(key, "shear_stiffness", law.shear_stiffness, Law::STIFFNESS, "Pa/m", "leave it out for the solver's")?;
    number(key, "friction_deg", law.friction_deg, Law::ANGLE, "degrees", "rock joints have 15 to 50")?;
    number(key, "cohesion", law.cohesion, Law::STRENGTH, "Pa", "0 for a clean joint")?;
    number(key, "tension", law.tension, Law::STRENGTH, "Pa", "the tensile strength is written positive")?;
    optional(
        key,
        "residual_friction_deg",
        law.residual_friction_deg,
        Law::ANGLE,
        "degrees",
        "leave it out for the peak",
    )?;
    optional(key, "residual_cohesion", law.residual_cohesion, Law::STRENGTH, "Pa", "leave it out for the peak")?;
    number(key, "residual_tension", law.residual_tension, Law::STRENGTH, "Pa", "0 for a broken joint")?;
    number(key, "dilation_deg", law.dilation_deg, Law::ANGLE, "degrees", "0 for a smooth joint")?;
    optional(key, "dilation_slip", law.dilation_slip, Range::above(0.0).to(1e6), "m", "leave it out for 0.05 m")?;
    optional(key, "crush", law.crush, Range::from(1e3).to(1e12), "Pa", "the strength of the rock, 1e6 to 3e8")?;
    joints::validate_kind(key, law)?;
    joints::validate_energies(key, law)
}

fn gravity(key: &Key, gravity: &Gravity) -> Check {
    number(key, "x", gravity.x, Range::within(1e4), "m/s²", "the standard is 0")?;
    number(key, "y", gravity.y, Range::within(1e4), "m/s²", "the standard is -9.81")
}

fn initial_velocity(key: &Key, start: &InitialVelocity) -> Check {
    if let Some(block) = &start.block {
        point(&key.field("block"), block)?;
    }
    for (i, &value) in start.velocity.iter().enumerate() {
        number(&key.field("velocity").index(i), "", value, Range::within(1e5), "m/s", "rock falls at 1 to 100")?;
    }
    number(key, "angular_velocity", start.angular_velocity, Range::within(1e5), "rad/s", "0 for no rotation")
}

fn in_situ(key: &Key, stress: &InSitu) -> Check {
    let hint = "tension is positive, compression negative";
    for (name, value) in [("sxx", stress.sxx), ("syy", stress.syy), ("sxy", Some(stress.sxy))] {
        optional(key, name, value, Range::within(1e12), "Pa", hint)?;
    }
    for (i, &value) in stress.gradient.iter().enumerate() {
        number(
            &key.field("gradient").index(i),
            "",
            value,
            Range::within(1e9),
            "Pa/m",
            "density times gravity is usual",
        )?;
    }
    optional(key, "szz", stress.szz, Range::within(1e12), "Pa", hint)?;
    let slope = "density times gravity is usual";
    number(key, "szz_gradient", stress.szz_gradient, Range::within(1e9), "Pa/m", slope)?;
    optional(key, "y_reference", stress.y_reference, Range::within(COORDINATE_MAX), "m", "a height of the model")
}

fn fmu_notes(key: &Key, notes: &FmuNotes) -> Check {
    for (name, note) in [("author", &notes.author), ("copyright", &notes.copyright), ("license", &notes.license)] {
        if note.as_ref().is_some_and(|note| note.trim().is_empty()) {
            return fail(&key.field(name), "is empty, must say something; leave it out for what holds without it");
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

fn output(key: &Key, output: &Output) -> Check {
    for (name, value) in [
        ("frame_interval", output.frame_interval),
        ("history_interval", output.history_interval),
        ("checkpoint_interval", output.checkpoint_interval),
    ] {
        optional(key, name, value, Range::above(0.0).to(1e12), "s", "leave it out for the default")?;
    }
    Ok(())
}

fn solver(key: &Key, solver: &Solver) -> Check {
    let share = Range::above(0.0).to(1.0);
    let time = Range::above(0.0).to(1e9);
    optional(key, "communication_step", solver.communication_step, time, "s", "leave it out for the default")?;
    optional(key, "dt_max", solver.dt_max, time, "s", "leave it out for the stability limit")?;
    number(key, "dt_safety", solver.dt_safety, share, "", "0.9 is the default")?;
    number(key, "contact_stiffness", solver.contact_stiffness, Range::above(0.0).to(1e6), "", "0.6 is the default")?;
    number(key, "shear_ratio", solver.shear_ratio, Range::above(0.0).to(10.0), "", "0.5 is the default")?;
    number(key, "contact_theta", solver.contact_theta, Range::from(1.0).to(1e6), "", "4 is the default")?;
    number(key, "contact_tolerance", solver.contact_tolerance, share, "", "0.01 is the default")?;
    let hint = "leave it out for the default, a shear wave's way through the blocks";
    optional(key, "friction_delay", solver.friction_delay, Range::from(0.0).to(1.0), "s", hint)?;
    whole(key, "sweeps_max", u64::from(solver.sweeps_max), ONE_TO_THOUSAND, "100 is the default")?;
    number(key, "mass_scaling", solver.mass_scaling, Range::from(1.0).to(100.0), "", "1 is the default")?;
    number(key, "penetration_limit", solver.penetration_limit, share, "", "0.2 is the default")?;
    let hint = "leave it out for 20 explicit steps";
    optional(key, "implicit_step", solver.implicit_step, time, "s", hint)?;
    whole(key, "iterations_max", u64::from(solver.iterations_max), ONE_TO_THOUSAND, "8 is the default")?;
    number(key, "displacement_ratio", solver.displacement_ratio, share, "", "0.01 is the default")?;
    let length = Range::above(0.0).to(COORDINATE_MAX);
    let hint = "leave it out for the mesh size";
    optional(key, "failure_displacement", solver.failure_displacement, length, "m", hint)?;
    whole(key, "memory_limit", solver.memory_limit, (1, u64::MAX), "8589934592 (8 GiB) is the default")
}
