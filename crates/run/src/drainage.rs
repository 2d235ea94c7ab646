//! How well joints conduct water, set by set, and how fast they drain, law by law.

use serde::Serialize;

use enmm::model::Simulation;
use enmm_observe::water_weight;

/// Hydraulic conductivity of the rock mass along the joints of a set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SetConductivity {
    /// Name of the set.
    pub set: String,
    /// Hydraulic aperture (m) of its joints at the start.
    pub aperture: f64,
    /// Mean spacing (m).
    pub spacing: f64,
    /// Conductivity K = γe³/(12 μ s) (m/s).
    pub conductivity: f64,
}

/// Time in which the joints of a law drain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawDrainage {
    /// Name of the law.
    pub law: String,
    /// Hydraulic aperture (m) at the start.
    pub aperture: f64,
    /// Height (m) of the net of joints.
    pub height: f64,
    /// Time (s) in which a full joint of this height drains by its own weight: H/(γe²/12μ).
    pub time: f64,
}

/// Conductivities of the joint sets whose joints conduct; empty where water does not flow.
pub fn conductivities(simulation: &Simulation) -> Vec<SetConductivity> {
    let case = simulation.case();
    let Some(net) = &simulation.model().flow else { return Vec::new() };
    let factor = water_weight(simulation) / (12.0 * net.viscosity);
    let of_set = |k: usize| {
        let set = &case.joint_sets[k];
        let name = set.law.clone().or_else(|| case.domain.joint_law.clone());
        let law = case.joint_laws.keys().position(|law| name.as_ref().is_none_or(|name| name == law))?;
        let (aperture, spacing) = (net.apertures[law], set.spacing);
        let conductivity = factor * aperture.powi(3) / spacing;
        (aperture > 0.0).then(|| SetConductivity { set: case.joint_set_name(k), aperture, spacing, conductivity })
    };
    (0..case.joint_sets.len()).filter_map(of_set).collect()
}

/// Time to drain of each law whose joints conduct; empty where water does not flow.
pub fn drain_times(simulation: &Simulation) -> Vec<LawDrainage> {
    let Some(net) = &simulation.model().flow else { return Vec::new() };
    let factor = water_weight(simulation) / (12.0 * net.viscosity);
    let heights = net.places.iter().map(|place| place.y);
    let [low, high] = heights.fold([f64::MAX, f64::MIN], |[low, high], y| [low.min(y), high.max(y)]);
    let height = high - low;
    let laws = simulation.case().joint_laws.keys().zip(&net.apertures).enumerate();
    let used =
        laws.filter(|(k, (_, aperture))| **aperture > 0.0 && net.pieces.iter().any(|piece| piece.law.index() == *k));
    let drained = |(_, (law, &aperture)): (usize, (&String, &f64))| LawDrainage {
        law: law.clone(),
        aperture,
        height,
        time: height / (factor * aperture * aperture),
    };
    used.map(drained).collect()
}
