//! Parts of the problems of water that flows in joints: a plate with joints between two heads, and what is found.

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::tables::FlowNet;

use super::block::G;
use crate::Trouble;
use crate::parts::rock;

/// Unit weight of the water (N/m³).
pub const WEIGHT: f64 = 1e3 * G;
/// Viscosity (Pa s).
pub const VISCOSITY: f64 = 1e-3;
/// Why flows and forces of water may differ from the exact ones.
pub const ROUND_OFF: &str = "round-off of sums over some hundred pieces of joint";
/// How far, as a share.
pub const SHARE: f64 = 1e-12;

/// Transmissivity (m²/s) of a joint of an aperture (m) by the cubic law: γe³/12μ.
pub fn transmissivity(aperture: f64) -> f64 {
    WEIGHT * aperture.powi(3) / (12.0 * VISCOSITY)
}

/// A rectangle of rock with joints, held at its base; water passes its sides where it has heads.
#[derive(Debug, Clone)]
pub struct Plate {
    /// Width and height (m).
    pub size: [f64; 2],
    /// Mesh size (m).
    pub mesh: f64,
    /// Joints: both ends (m), and the aperture (m) of each.
    pub joints: Vec<([[f64; 2]; 2], f64)>,
    /// Heads: name, segment and level (m).
    pub heads: Vec<(&'static str, [[f64; 2]; 2], f64)>,
    /// Other parts of the case before its stage.
    pub more: String,
}

impl Plate {
    /// Without joints and heads.
    pub fn new(size: [f64; 2], mesh: f64) -> Self {
        Self { size, mesh, joints: Vec::new(), heads: Vec::new(), more: String::new() }
    }

    /// A head along the left or the right side.
    pub fn side(mut self, name: &'static str, x: f64, level: f64) -> Self {
        self.heads.push((name, [[x, 0.0], [x, self.size[1]]], level));
        self
    }

    /// The case: joints of one aperture share a law.
    pub fn text(&self, title: &str) -> String {
        let [w, h] = self.size;
        let mut text = format!(
            "title = {title:?}\n[domain]\noutline = [[0.0, 0.0], [{w:?}, 0.0], [{w:?}, {h:?}], [0.0, {h:?}]]\n[mesh]\n\
             size = {:e}\norigin = [0.131, 0.077]\n{}[flow]\nviscosity = {VISCOSITY:?}\n[[fix]]\n\
             edge = [[0.0, 0.0], [{w:?}, 0.0]]\n",
            self.mesh,
            rock(1e10, 2600.0),
        );
        let mut apertures: Vec<f64> = Vec::new();
        for (points, aperture) in &self.joints {
            let law = apertures.iter().position(|other| other == aperture).unwrap_or(apertures.len());
            if law == apertures.len() {
                apertures.push(*aperture);
                text += &format!("[joint_law.e{law}]\nfriction_deg = 40.0\naperture = {aperture:e}\n");
            }
            text += &format!("[[joint]]\npoints = {points:?}\nlaw = \"e{law}\"\n");
        }
        for (name, edge, level) in &self.heads {
            text += &format!("[[head]]\nname = {name:?}\nedge = {edge:?}\nlevel = {level:?}\n");
        }
        text + &self.more + "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1.0\n"
    }
}

fn no_flow() -> Trouble {
    Trouble("no water flows in the model".to_owned())
}

/// The net of a model.
pub fn net(simulation: &Simulation) -> Result<&FlowNet, Trouble> {
    simulation.model().flow.as_ref().ok_or_else(no_flow)
}

/// Water (m²/s) that enters, leaves and runs off at an inlet of this name.
pub fn flows(simulation: &Simulation, name: &str) -> Result<[f64; 3], Trouble> {
    let place = net(simulation)?.inlet_names().position(|own| own == name).ok_or_else(no_flow)?;
    let balance = simulation.state().seepage.as_ref().and_then(|seepage| seepage.balances.last());
    Ok(balance.ok_or_else(no_flow)?.sums[place])
}

/// Head (m) at the node nearest to a place.
pub fn head_at(simulation: &Simulation, place: [f64; 2]) -> Result<f64, Trouble> {
    heads_at(simulation, place).map(|heads| heads[0])
}

/// Head and pressure head (m) at the node nearest to a place.
pub fn heads_at(simulation: &Simulation, place: [f64; 2]) -> Result<[f64; 2], Trouble> {
    let (net, place) = (net(simulation)?, Point::from(place));
    let seepage = simulation.state().seepage.as_ref().ok_or_else(no_flow)?;
    let distance = |node: &usize| (net.places[*node] - place).norm();
    let nodes = 0..net.places.len();
    let node = nodes.min_by(|a, b| distance(a).total_cmp(&distance(b))).ok_or_else(no_flow)?;
    let pressure = seepage.unknowns[node].max(0.0);
    Ok([net.places[node].y + pressure, pressure])
}

/// Force (N/m) of the water and other loads on the block at a place (m).
pub fn push_on(simulation: &Simulation, place: [f64; 2]) -> Result<enmm::geometry::Vector, Trouble> {
    let covers = &simulation.model().covers;
    let element = covers.element_at(place.into()).ok_or(Trouble("no block is there".to_owned()))?;
    let forces = simulation.load_forces();
    Ok(covers.covers_of(covers.element_block[element]).map(|i| forces[i]).sum())
}
