//! Skins become bars between points along the face.

use super::Expanded;
use super::bolts::install_by_name;
use crate::bolt::BOLTS_MAX;
use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::validate::checks::unique;
use crate::{Bolt, Case, Skin};

/// Expands all skins, and their names in the stages that install them.
///
/// # Errors
/// The first skin that cannot be laid out.
pub fn expand(case: &mut Case, told: &mut Expanded) -> Check {
    let skins = std::mem::take(&mut case.skins);
    let key = Key::root().field("skin");
    unique(&key, "skin", skins.iter().map(|skin| skin.name.as_deref()))?;
    for (k, skin) in skins.iter().enumerate() {
        let key = key.index(k);
        check(&key, skin, case)?;
        let first = case.bolts.len();
        let points = stations(skin, case.mesh.size);
        if points.len() > BOLTS_MAX as usize {
            let message = format!("gives {} points, must give at most {BOLTS_MAX}; raise it", points.len());
            return fail(&key.field("distance"), message);
        }
        for (number, pair) in points.windows(2).enumerate() {
            let made = format!("bolt[{}]", case.bolts.len());
            for part in [".points", ".points[0]", ".points[1]"] {
                told.origins.insert(format!("{made}{part}"), key.field("line").to_string());
            }
            told.origins.insert(made, key.to_string());
            case.bolts.push(member(skin, number, [pair[0], pair[1]]));
        }
        install_by_name(case, skin.name.as_deref(), first);
    }
    Ok(())
}

fn check(key: &Key, skin: &Skin, case: &Case) -> Check {
    skin.check(key)?;
    if let Some(name) = &skin.name
        && case.bolts.iter().any(|bolt| bolt.name.as_ref() == Some(name))
    {
        return fail(&key.field("name"), format!("{name:?} is the name of a bolt too; rename one"));
    }
    if skin.name.is_none() && !skin.active {
        let message = "is false, and without a name no stage can install the skin; add `name` or remove `active`";
        return fail(&key.field("active"), message);
    }
    if skin.line.len() < 2 {
        let message = format!("has {} points, must have at least 2 on the face; add one", skin.line.len());
        return fail(&key.field("line"), message);
    }
    if let Some(k) = skin.line.windows(2).position(|pair| pair[0] == pair[1]) {
        return fail(&key.field("line").index(k + 1), "is the same as the point before; remove one");
    }
    let brittle = skin.tension.map(|tension| tension / skin.young);
    if let (Some(strain), Some(least)) = (skin.rupture_strain, brittle)
        && strain < least
    {
        let message = format!(
            "is {}, but at `tension` the strain is {} already; raise it, or leave it out for a skin that breaks there",
            Plain(strain),
            Plain(least)
        );
        return fail(&key.field("rupture_strain"), message);
    }
    Ok(())
}

/// The points that hold a skin: those of its line, and more between them.
fn stations(skin: &Skin, mesh: f64) -> Vec<[f64; 2]> {
    let most = skin.distance.unwrap_or(mesh);
    let mut points = Vec::from_iter(skin.line.first().copied());
    for pair in skin.line.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let count = (libm::hypot(b[0] - a[0], b[1] - a[1]) / most).ceil().clamp(1.0, f64::from(BOLTS_MAX)) as u32;
        for k in 1..count {
            let share = f64::from(k) / f64::from(count);
            points.push([0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share));
        }
        points.push(b);
    }
    points
}

/// A member between two neighbouring points.
fn member(skin: &Skin, number: usize, points: [[f64; 2]; 2]) -> Bolt {
    let yield_force = skin.tension.map(|tension| tension * skin.thickness);
    Bolt {
        name: skin.name.as_ref().map(|name| format!("{name}_{}", number + 1)),
        points,
        young: skin.young,
        area: skin.thickness,
        spacing: 1.0,
        yield_force,
        rupture_strain: skin.rupture_strain.or(skin.tension.map(|tension| tension / skin.young)),
        active: skin.active,
        of_skin: true,
        ..Bolt::default()
    }
}
