//! Features that limit analysis cannot treat, by name, and the stage in which it looks at a model.

use enmm::model::Simulation;
use enmm::model::case::key::Key;
use enmm::model::case::{Axes, Case, Invalid, LoadKind, Plane, Port, Solver, StageKind, Support};

use crate::{left_out_stages, with_support_forces};

/// The model in its last static stage before any motion, and what was left out.
///
/// # Errors
/// A key that cannot be treated or does not fit the model.
pub fn staged(case: &Case) -> Result<(Simulation, Vec<String>), Invalid> {
    refuse_yielding(case)?;
    staged_rock(case)
}

/// The same for rock that may yield, which yields nowhere in the model: limit analysis takes strength from the case.
///
/// # Errors
/// A key that cannot be treated or does not fit the model.
pub fn staged_rock(case: &Case) -> Result<(Simulation, Vec<String>), Invalid> {
    case.validate()?;
    let mut case = with_support_forces(case);
    let active = case.bolts.iter_mut().filter(|bolt| bolt.support == Some(Support::Active));
    active.for_each(|bolt| bolt.yield_force = Some(bolt.pretension));
    // No step is taken, so the integrator and its keys do not matter.
    let Solver { integrator, newmark, implicit_step, iterations_max, displacement_ratio, .. } = Solver::default();
    case.solver = Solver { integrator, newmark, implicit_step, iterations_max, displacement_ratio, ..case.solver };
    let count = case.stages.iter().take_while(|stage| stage.kind == StageKind::Static).count();
    if count == 0 {
        let message = "is \"dynamic\", but limit analysis looks at the slope as its static stages leave it: begin with \
                       a stage of kind \"static\"";
        return Err(refused(Key::root().field("stage").index(0).field("kind"), message));
    }
    let mut warnings = Vec::from_iter(left_out_stages(&case));
    case.keep_stages(count);
    case.refuse_cuts("limit analysis")?;
    if !case.base_motions.is_empty() || case.quiets.iter().any(|quiet| quiet.wave.is_some()) {
        warnings.push("base motion and waves are left out: give a seismic coefficient as a load of kind body".into());
        case.base_motions.clear();
    }
    case.hold_quiet_edges();
    refuse_motion(&case)?;
    refuse_curves(&case)?;
    refuse_bonds(&case)?;
    if case.yields() {
        refuse_points(&case)?;
    }
    // No element takes part, so that none yields, and no doubt about elements that yield has a place.
    for rock in case.rocks.values_mut() {
        (rock.friction_deg, rock.cohesion, rock.hoek_brown) = (None, None, None);
        (rock.dilation_deg, rock.tension, rock.plane_of_weakness) = (None, None, None);
    }
    let mut simulation = Simulation::new(case)?;
    while simulation.next_stage()? {}
    warnings.extend(simulation.built().warnings.iter().cloned());
    Ok((simulation, warnings))
}

fn refused(key: Key, message: impl Into<String>) -> Invalid {
    Invalid { key: key.as_str().to_owned(), message: message.into() }
}

fn refuse_yielding(case: &Case) -> Result<(), Invalid> {
    if let Some((name, rock)) = case.rocks.iter().find(|(_, rock)| rock.yields()) {
        let key = Key::root().field("rock").field(name);
        let (field, value) = match (rock.friction_deg, rock.cohesion) {
            (Some(friction), _) => ("friction_deg", friction.to_string()),
            (None, Some(cohesion)) => ("cohesion", cohesion.to_string()),
            (None, None) => ("hoek_brown", "given".to_owned()),
        };
        let message = format!(
            "is {value}, but limit analysis of rigid blocks knows no rock that yields: leave out its strength, or \
             use `enmm bound`, which brackets the factor of such rock"
        );
        return Err(refused(key.field(field), message));
    }
    Ok(())
}

/// Refuses water that flows in joints, whose pressure in the pores of rock that yields is not known.
///
/// # Errors
/// The case has such water.
pub fn refuse_flow(case: &Case) -> Result<(), Invalid> {
    if case.flow.is_none() {
        return Ok(());
    }
    let message = "finds the pressure in joints alone, but the bracket of rock that yields needs that in its pores: \
                   give the water by `[water] table`, or use `enmm fos`";
    Err(refused(Key::root().field("flow"), message))
}

fn refuse_motion(case: &Case) -> Result<(), Invalid> {
    let varies =
        |table: &Option<Vec<[f64; 2]>>| table.as_ref().is_some_and(|rows| rows.iter().any(|row| row[1] != rows[0][1]));
    match case.loads.iter().position(|load| varies(&load.table)) {
        Some(k) => {
            let message = "changes in time, but limit analysis knows no time: leave out the table and give the load \
                           that counts";
            Err(refused(Key::root().field("load").index(k).field("table"), message))
        }
        None => Ok(()),
    }
}

/// Laws whose friction is no straight line.
fn refuse_curves(case: &Case) -> Result<(), Invalid> {
    if let Some((name, law)) = case.joint_laws.iter().find(|(_, law)| law.is_curved()) {
        let message = format!(
            "is {:?}, whose friction falls with the normal stress, but limit analysis takes straight lines: use \
             \"mohr_coulomb\" with friction and cohesion for the stress of the slope",
            law.kind.name()
        );
        return Err(refused(Key::root().field("joint_law").field(name).field("kind"), message));
    }
    Ok(())
}

/// Bars that slip in their grout: their force follows from how far the rock moves.
fn refuse_bonds(case: &Case) -> Result<(), Invalid> {
    if let Some(k) = case.bolts.iter().position(|bolt| bolt.bond.is_some()) {
        let message = "is given, but limit analysis takes bars that are fixed to the rock beside each joint: use \
                       `enmm fos`, or leave it out and give a `yield_force` that the bond can carry";
        return Err(refused(Key::root().field("bolt").index(k).field("bond"), message));
    }
    Ok(())
}

/// Rock that yields under plane stress or along planes, and what acts there on a point or on a whole block: no stress
/// that is finite carries it.
fn refuse_points(case: &Case) -> Result<(), Invalid> {
    let root = Key::root();
    for (name, rock) in &case.rocks {
        if rock.plane == Plane::Stress {
            let message = "is \"stress\", but limit analysis takes rock that yields in plane strain: use \"strain\"";
            return Err(refused(root.field("rock").field(name).field("plane"), message));
        }
        if rock.plane_of_weakness.is_some() {
            let message = "is given, but limit analysis takes rock that is as strong in all directions: use \
                           `enmm fos`, or leave it out";
            return Err(refused(root.field("rock").field(name).field("plane_of_weakness"), message));
        }
    }
    for (k, fix) in case.fixes.iter().enumerate() {
        let key = root.field("fix").index(k);
        let remedy =
            "limit analysis of rock that yields holds edges and whole blocks: give edge, or block with both axes";
        let field = match (fix.point, fix.region, fix.block) {
            (Some(_), ..) => "point",
            (_, Some(_), _) => "box",
            (.., Some(_)) if fix.axes != Axes::default() => "axes",
            _ => continue,
        };
        return Err(refused(key.field(field), format!("is given, but {remedy}")));
    }
    if let Some(k) = case.loads.iter().position(|load| matches!(load.kind, LoadKind::Point | LoadKind::Block)) {
        let message = "acts on a point or a block, but limit analysis of rock that yields spreads loads over edges: \
                       use \"traction\" or \"pressure\"";
        return Err(refused(root.field("load").index(k).field("kind"), message));
    }
    let pushes =
        |port: &Port| port.force != [0.0; 2] || port.traction != [0.0; 2] || port.moment != 0.0 || port.pressure != 0.0;
    if let Some(k) = case.ports.iter().position(pushes) {
        let message = "pushes at the start, but limit analysis of rock that yields knows no ports: give a [[load]]";
        return Err(refused(root.field("port").index(k), message));
    }
    Ok(())
}

/// Blocks that fixities hold altogether.
pub fn held_blocks(simulation: &Simulation) -> Vec<bool> {
    let covers = &simulation.model().covers;
    let mut held = vec![false; covers.block_count()];
    for (k, fix) in simulation.case().fixes.iter().enumerate() {
        let Some(point) = fix.block.filter(|_| simulation.state().fix_active[k]) else { continue };
        let element = covers.element_near(point.into(), 2.0 * simulation.built().noding.tolerance);
        if let Some(element) = element {
            held[covers.element_block[element].number() as usize] = true;
        }
    }
    held
}
