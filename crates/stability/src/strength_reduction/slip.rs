//! How far joints have slipped, and how far elasticity lets them.

use enmm::geometry::polygon;
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, ContactHistory};

/// Displacement, relative to the height of the model, that elasticity of stiff rock cannot explain.
pub const ELASTIC: f64 = 1e-3;
/// Acceleration of gravity (m/s²) for the scales of models that have none.
const STANDARD_GRAVITY: f64 = 9.81;

/// Largest slip (m) of a contact since it had one of the histories `before`, which are in the order of nodes. Contacts
/// of two blocks that a bolt ties are left out: a bolt carries force only after they have moved. So are those of the
/// blocks `without`, which are sorted.
pub fn largest_slip(simulation: &Simulation, before: &[ContactHistory], without: &[BlockId]) -> f64 {
    let key = |contact: &ContactHistory| (contact.node, contact.side);
    let (model, state) = (simulation.model(), simulation.state());
    let boundary = &model.boundary;
    let bolts = model.bolts.iter().zip(&state.bolts).filter(|(_, bolt)| bolt.active && !bolt.broken);
    let tied: Vec<[BlockId; 2]> = bolts.map(|(segment, _)| segment.blocks).collect();
    let mut before = before.iter().peekable();
    let counts = |contact: &&ContactHistory| {
        let points = [boundary.nodes.point[contact.node], contact.edge];
        let blocks = points.map(|point| boundary.block[point]);
        blocks.iter().all(|block| without.binary_search(block).is_err())
            && !tied.iter().any(|pair| blocks.iter().all(|block| pair.contains(block)))
    };
    let slipped = state.contacts.iter().filter(counts).map(|contact| {
        while before.next_if(|b| key(b) < key(contact)).is_some() {}
        let known = before.peek().filter(|b| key(b) == key(contact));
        contact.slip - known.map_or(0.0, |b| b.slip)
    });
    slipped.fold(0.0, f64::max)
}

/// Slip (m) of a slope at rest that is a failure: blocks slid until others caught them. None where settling explains
/// it, and in rock that yields.
pub fn slide(simulation: &Simulation) -> Option<f64> {
    let slip = largest_slip(simulation, &[], &[]);
    (!simulation.case().yields() && slip > settling_slip(simulation)).then_some(slip)
}

/// Largest slip (m) of a slope that takes up its weight and does not fail: twice the settlement ρgH²/2(λ+2μ) of its
/// softest rock, and at least the displacement that elasticity of stiff rock cannot explain (Eq. 63).
fn settling_slip(simulation: &Simulation) -> f64 {
    let (height, gravity) = height_and_gravity(simulation);
    let settlement = |density: f64, modulus: f64| density * gravity * height * height / modulus;
    let softest = simulation.model().rocks.iter().map(|rock| settlement(rock.density, rock.lambda + 2.0 * rock.mu));
    softest.fold(ELASTIC * height, f64::max)
}

/// Height of a model (m) and the gravity by which its motion is measured (m/s²), that of the earth where none acts.
pub fn height_and_gravity(simulation: &Simulation) -> (f64, f64) {
    let (low, high) = polygon::bounds(&simulation.model().covers.star_position);
    let gravity = simulation.state().drive.gravity(1.0).norm();
    ((high - low).y, if gravity > 0.0 { gravity } else { STANDARD_GRAVITY })
}
