//! Annotations of a picture of a model beside its blocks.

use enmm::geometry::ends::EndChange;
use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::case::{Anchorage, Axes, JointLaw, Load, LoadKind, Port, Rock, Side, dip_in_section};
use enmm::model::tables::EdgeId;
use enmm_observe::{SupportKind, bolts, supports, water_surface};

use crate::axes::{number_text, si_text, three_digits};
use crate::signs::Held;
use crate::{BoltMark, HeldRow, LoadMark, ModelAnnotations, PortMark, PortPlace, SetMark};

/// Distance from a supported point, relative to the mesh size, at which rock is looked for.
const BESIDE: f64 = 0.02;

/// `1 block`, `2 blocks`.
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Title, supports, loads, water, bolts, monitors, ports, joints and counts of a model as it is now.
pub fn model_annotations(simulation: &Simulation) -> ModelAnnotations {
    let (model, case, built) = (simulation.model(), simulation.case(), simulation.built());
    let covers = &model.covers;
    let boundary = &model.boundary;
    let ends = |k: EdgeId| [boundary.reference[k], boundary.reference[boundary.after(k)]];
    let joints = boundary.edges().filter_map(|k| Some((ends(k), model.trace_law[boundary.trace[k]?].number())));
    let ports = case.ports.iter().filter_map(|port| Some(PortMark { name: port.name.clone(), place: place_of(port)? }));
    let port_loads = case.ports.iter().filter_map(load_of_port);
    ModelAnnotations {
        title: case.title.clone(),
        held: held_rows(simulation),
        held_boxes: case.fixes.iter().filter_map(|fix| fix.region).collect(),
        monitors: case.monitors.iter().map(|m| (m.name.clone(), Point::from(m.point))).collect(),
        ports: ports.collect(),
        loads: case.loads.iter().filter_map(load_mark).chain(port_loads).collect(),
        facts: facts(simulation),
        section: section(simulation),
        rock_values: case.rocks.values().map(rock_values).collect(),
        law_values: case.joint_laws.values().map(law_values).collect(),
        counts: vec![counted(covers.block_count(), "block")],
        bolts: bolt_marks(simulation),
        trace_segments: joints.collect(),
        sets: sets(simulation),
        water: water_surface(simulation),
        ends: built.ends.iter().map(|end| (end.place, end.change != EndChange::Kept)).collect(),
        crumbs: built.crumbs.iter().map(|crumb| crumb.place).collect(),
        pond: case.water.as_ref().is_some_and(|water| water.faces.is_none()),
    }
}

/// Position (m) of each star of a model and the number of its physical covers.
pub fn stars(simulation: &Simulation) -> Vec<(Point, u32)> {
    let covers = &simulation.model().covers;
    covers.covers_by_star().into_iter().map(|(star, count)| (covers.mesh.node(star), count)).collect()
}

/// Where a port is marked.
fn place_of(port: &Port) -> Option<PortPlace> {
    let block = port.block.map(|point| PortPlace::Block(Point::from(point)));
    let boundary = port.boundary.map(|ends| PortPlace::Boundary(ends.map(Point::from)));
    block.or(boundary).or(port.joint.map(|ends| PortPlace::Joint(ends.map(Point::from))))
}

/// Supports of fixities, quiet boundaries and free-field sides, each as a row of points.
fn held_rows(simulation: &Simulation) -> Vec<HeldRow> {
    let case = simulation.case();
    let mut rows: Vec<((SupportKind, u32), HeldRow)> = Vec::new();
    for support in supports(simulation).into_iter().filter(|support| support.kind != SupportKind::Dashpot) {
        let key = (support.kind, support.index);
        if rows.last().is_none_or(|(last, _)| *last != key) {
            let k = support.index as usize;
            let (held, edge, axes) = match support.kind {
                SupportKind::Fixity => (None, case.fixes[k].edge, case.fixes[k].axes),
                _ if k < case.quiets.len() => (Some(Held::Quiet), Some(case.quiets[k].edge), Axes::Xy),
                _ => {
                    (Some(Held::FreeField), case.free_fields.get(k - case.quiets.len()).map(|side| side.edge), Axes::Xy)
                }
            };
            let held = held.unwrap_or(if axes == Axes::Xy { Held::Pinned } else { Held::Roller });
            let outward = outward(simulation, support.position, edge.map(|ends| ends.map(Point::from)), axes);
            rows.push((key, HeldRow { held, outward, points: Vec::new() }));
        }
        if let Some((_, row)) = rows.last_mut() {
            row.points.push(support.position);
        }
    }
    rows.into_iter().map(|(_, row)| row).collect()
}

/// Unit direction away from the rock in which the sign of a support at `point` on an edge stands.
fn outward(simulation: &Simulation, point: Point, edge: Option<[Point; 2]>, axes: Axes) -> Vector {
    let covers = &simulation.model().covers;
    let along = edge.map_or(Vector::zeros(), |[a, b]| b - a);
    let normal = if along.norm() > 0.0 { Vector::new(along.y, -along.x).normalize() } else { -Vector::y() };
    let axis = match axes {
        Axes::Xy => normal,
        Axes::X => Vector::x(),
        Axes::Y => Vector::y(),
    };
    let axis = if normal.dot(&axis) < 0.0 { -axis } else { axis };
    let near = BESIDE * covers.mesh.size;
    let has_rock = |side: Vector| covers.element_near(point + side * near, 0.1 * near).is_some();
    // A sign inside the rock points down, or left.
    match (has_rock(axis), has_rock(-axis)) {
        (true, false) => -axis,
        (true, true) if axis.y > 0.0 || (axis.y == 0.0 && axis.x > 0.0) => -axis,
        _ => axis,
    }
}

fn load_mark(load: &Load) -> Option<LoadMark> {
    let [point, force] = [load.point, load.force].map(|v| v.map(Point::from));
    let edge = load.edge.map(|ends| ends.map(Point::from));
    let named = |value: String| load.name.as_ref().map_or(value.clone(), |name| format!("{name} {value}"));
    match load.kind {
        LoadKind::Point | LoadKind::Block => {
            let (point, force) = (point?, force.unwrap_or_default());
            Some(point_load(point, force, load.moment.unwrap_or_default(), &named))
        }
        LoadKind::Traction => {
            let traction = Vector::from(load.traction?);
            Some(LoadMark::Traction { edge: edge?, traction, label: named(si_text(traction.norm(), "Pa")) })
        }
        LoadKind::Pressure => {
            let pressure = load.pressure?;
            Some(LoadMark::Pressure { edge: edge?, pressure, label: named(si_text(pressure, "Pa")) })
        }
        LoadKind::Joint => {
            let from = load.pressure?;
            let to = load.pressure_end.unwrap_or(from);
            let value = if from == to {
                si_text(from, "Pa")
            } else {
                format!("{} to {}", si_text(from, "Pa"), si_text(to, "Pa"))
            };
            Some(LoadMark::Joint { edge: edge?, label: named(value) })
        }
        LoadKind::Body => None,
    }
}

fn point_load(point: Point, force: Vector, moment: f64, named: &dyn Fn(String) -> String) -> LoadMark {
    let mut values = Vec::new();
    if force != Vector::zeros() {
        values.push(si_text(force.norm(), "N/m"));
    }
    if moment != 0.0 {
        values.push(si_text(moment.abs(), "N·m/m"));
    }
    LoadMark::Point { point, force, moment, label: named(values.join(", ")) }
}

/// Load at a port from the start.
fn load_of_port(port: &Port) -> Option<LoadMark> {
    let (force, traction) = (Vector::from(port.force), Vector::from(port.traction));
    let unnamed = |value: String| value;
    match place_of(port)? {
        PortPlace::Block(point) if force != Vector::zeros() || port.moment != 0.0 => {
            Some(point_load(point, force, port.moment, &unnamed))
        }
        PortPlace::Boundary(edge) if traction != Vector::zeros() => {
            Some(LoadMark::Traction { edge, traction, label: si_text(traction.norm(), "Pa") })
        }
        PortPlace::Boundary(edge) if port.pressure != 0.0 => {
            Some(LoadMark::Pressure { edge, pressure: port.pressure, label: si_text(port.pressure, "Pa") })
        }
        PortPlace::Joint(edge) if port.pressure != 0.0 => {
            Some(LoadMark::Joint { edge, label: si_text(port.pressure, "Pa") })
        }
        _ => None,
    }
}

/// A number in three digits, without zeros at its end.
fn short(value: f64) -> String {
    number_text(format!("{value:.2e}").parse().unwrap_or(value))
}

/// Direction of the section, in words; empty without one.
fn section(simulation: &Simulation) -> String {
    let azimuth = simulation.case().section.map(|section| section.azimuth_deg.rem_euclid(360.0));
    azimuth.map_or(String::new(), |azimuth| format!("section with its x axis towards azimuth {azimuth:03.0}°"))
}

/// Density, elasticity and strength of a rock.
fn rock_values(rock: &Rock) -> String {
    let mut values = vec![format!("{} kg/m³", rock.density), format!("E {}", si_text(rock.young, "Pa"))];
    values.extend(rock.friction_deg.map(|friction| format!("φ {}°", number_text(friction))));
    values.extend(rock.cohesion.map(|cohesion| format!("c {}", si_text(cohesion, "Pa"))));
    values.extend(rock.hoek_brown.map(|rock| {
        let [mi, gsi, d] = [rock.mi, rock.gsi, rock.d].map(number_text);
        format!("σci {}, mi {mi}, GSI {gsi}, D {d}", si_text(rock.sigma_ci, "Pa"))
    }));
    values.extend(rock.tension.map(|tension| format!("t {}", si_text(tension, "Pa"))));
    values.extend(rock.plane_of_weakness.map(|plane| {
        let [angle, friction] = [plane.angle_deg.unwrap_or_default(), plane.friction_deg].map(number_text);
        format!("weak at {angle}°: φ {friction}°, c {}", si_text(plane.cohesion, "Pa"))
    }));
    values.join(", ")
}

/// Strength of a joint law, and that after failure where it is another.
fn law_values(law: &JointLaw) -> String {
    let pascals = |name: &str, value: f64| (value != 0.0).then(|| format!("{name} {}", si_text(value, "Pa")));
    let angle = |name: &str, value: f64| format!("{name} {}°", number_text(value));
    if law.is_curved() {
        let jrc = law.jrc.map(|jrc| format!("JRC {}", number_text(jrc)));
        let jcs = law.jcs.and_then(|jcs| pascals("JCS", jcs));
        return std::iter::once(angle("φr", law.friction_deg)).chain(jrc).chain(jcs).collect::<Vec<_>>().join(", ");
    }
    let peak = [Some(angle("φ", law.friction_deg)), pascals("c", law.cohesion), pascals("t", law.tension)];
    let friction = law.residual_friction_deg.filter(|friction| *friction != law.friction_deg);
    let cohesion = law.residual_cohesion.filter(|cohesion| *cohesion != law.cohesion);
    let cohesion = cohesion.map(|cohesion| format!("c {}", si_text(cohesion, "Pa")));
    let residual: Vec<String> = friction.map(|friction| angle("φ", friction)).into_iter().chain(cohesion).collect();
    let residual = if residual.is_empty() { String::new() } else { format!("; residual {}", residual.join(", ")) };
    peak.into_iter().flatten().collect::<Vec<_>>().join(", ") + &residual
}

/// An angle counter-clockwise from the x axis (degrees) with its scatter, as a dip to a side: `20 ± 2° right`.
fn dip(angle: f64, scatter: &str) -> String {
    let (dip, side) = dip_in_section(angle);
    let side = side.map_or("", |side| if side == Side::Left { " left" } else { " right" });
    format!("dip {}{scatter}°{side}", short(dip))
}

/// Actions on all rock, in words.
fn facts(simulation: &Simulation) -> Vec<String> {
    let case = simulation.case();
    let vector = |x: f64, y: f64| format!("({}, {}) m/s²", number_text(x), number_text(y));
    let mut facts = vec![format!("gravity {}", vector(case.gravity.x, case.gravity.y))];
    let bodies = case.loads.iter().filter(|load| load.kind == LoadKind::Body).filter_map(|load| load.acceleration);
    facts.extend(bodies.map(|[x, y]| format!("body load {}", vector(x, y))));
    facts.extend(case.base_motions.iter().map(|motion| format!("base moves along {:?}", motion.axis).to_lowercase()));
    let waves = case.quiets.iter().filter_map(|quiet| {
        let peak = quiet.table.iter().flatten().map(|row| (quiet.scale * row[1]).abs()).fold(0.0, f64::max);
        Some(quiet.wave?.map(|part| part * peak))
    });
    facts.extend(waves.map(|[x, y]| format!("wave ({}, {}) m/s comes in", number_text(x), number_text(y))));
    facts.extend(case.in_situ.iter().map(|stress| {
        let [xx, yy, _] = stress.gradient;
        let by_weight = yy != 0.0 && [stress.sxx, stress.syy] == [Some(0.0); 2];
        let ratio =
            if by_weight { format!(", horizontal {} of vertical", three_digits(xx / yy)) } else { String::new() };
        format!("in-situ stress{ratio}")
    }));
    facts
}

/// One mark for each bolt of the case, from its head to its end: where they are now, or before if it is grouted.
pub fn bolt_marks(simulation: &Simulation) -> Vec<BoltMark> {
    let lines = bolts(simulation);
    let mark = |(k, bolt): (usize, &enmm::model::case::Bolt)| {
        let own = lines.iter().filter(|line| line.bolt as usize == k);
        // Grouted bars have short free lengths at joints only.
        let ends = own.clone().next().filter(|_| bolt.anchorage == Anchorage::Ends).map(|line| line.ends);
        BoltMark {
            name: bolt.name.clone(),
            ends: ends.unwrap_or(bolt.points.map(Point::from)),
            force: own.clone().map(|line| line.force).fold(0.0, f64::max),
            condition: own.map(|line| line.condition).max().unwrap_or_default(),
        }
    };
    simulation.case().bolts.iter().enumerate().map(mark).collect()
}

/// A mark for each joint set, on a piece of it away from the middle of all of them along the set.
fn sets(simulation: &Simulation) -> Vec<SetMark> {
    let (boundary, built) = (&simulation.model().boundary, simulation.built());
    let mut middles: Vec<Vec<Point>> = vec![Vec::new(); simulation.case().joint_sets.len()];
    for edge in boundary.edges() {
        let Some(trace) = boundary.trace[edge] else { continue };
        let set = built.set_start.partition_point(|&start| start <= trace.index());
        if let Some(middles) = set.checked_sub(1).and_then(|set| middles.get_mut(set)) {
            middles.push((boundary.reference[edge] + boundary.reference[boundary.after(edge)]) * 0.5);
        }
    }
    let mark = |(k, (set, middles)): (usize, (&enmm::model::case::JointSet, Vec<Point>))| {
        let centre = middles.iter().sum::<Vector>() / middles.len().max(1) as f64;
        let (sin, cos) = libm::sincos(set.angle());
        let direction = Vector::new(cos, sin);
        let reach = middles.iter().map(|p| (p - centre).dot(&direction)).fold(0.0, f64::max);
        let wanted = centre + direction * (0.6 * reach);
        let distance = |p: &&Point| (**p - wanted).norm();
        let scatter = if set.dip_sd_deg > 0.0 { format!(" ± {}", number_text(set.dip_sd_deg)) } else { String::new() };
        SetMark {
            name: simulation.case().joint_set_name(k),
            detail: format!("{}, every {} m", dip(set.angle().to_degrees(), &scatter), short(set.spacing)),
            direction,
            place: middles.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied(),
        }
    };
    simulation.case().joint_sets.iter().zip(middles).enumerate().map(mark).collect()
}
