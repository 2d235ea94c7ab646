//! Elements and joints of a model as its film has them.

use std::collections::HashMap;

use enmm_report::{Elements, FilmError, FilmWriter, Mesh, Outline};

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::tables::{EdgeId, ElementId};
use enmm_observe::Joints;

/// Where the numbers of elements and joints of a film come from.
#[derive(Debug)]
pub struct Meshes {
    /// Reference position (m) of each point that is no corner of a block, and an element that has it.
    points: Vec<(ElementId, Point)>,
    /// Mean of the points of each element (m).
    middles: Vec<(ElementId, Point)>,
    /// Pieces of joint along each edge that has an opening and a slip.
    faces: Vec<Vec<u32>>,
    joints: Joints,
}

impl Meshes {
    /// Gives outlines their elements. `corners` are the boundary points of all corners.
    pub fn of(simulation: &Simulation, outlines: &mut [Outline], corners: &[EdgeId]) -> Self {
        let model = simulation.model();
        let joints = Joints::of(simulation);
        let mut meshes = Self { points: Vec::new(), middles: Vec::new(), faces: Vec::new(), joints };
        let mut rest = corners;
        for (block, outline) in model.covers.blocks().zip(outlines) {
            let (own, others) = rest.split_at(outline.loops.iter().map(Vec::len).sum());
            rest = others;
            let exact = |place: &Point| [place.x.to_bits(), place.y.to_bits()];
            let corner = |(k, &point): (usize, &EdgeId)| (exact(&model.boundary.reference[point]), k as u32);
            let mut numbers: HashMap<[u64; 2], u32> = own.iter().enumerate().map(corner).collect();
            let mut mesh = Mesh::default();
            for element in model.covers.elements_of(block).map(ElementId::new) {
                let polygon = model.covers.polygon(element);
                let ring = polygon.iter().map(|place| {
                    *numbers.entry(exact(place)).or_insert_with(|| {
                        mesh.points.push([place.x, place.y]);
                        meshes.points.push((element, *place));
                        (own.len() + mesh.points.len() - 1) as u32
                    })
                });
                let ring = ring.collect();
                mesh.elements.push(ring);
                let middle = polygon.iter().sum::<Point>() / polygon.len() as f64;
                meshes.middles.push((element, middle));
            }
            for &point in own {
                let pieces = meshes.joints.along(&model.boundary, point);
                mesh.faces.push(!pieces.is_empty());
                meshes.faces.extend(Some(pieces).filter(|pieces| !pieces.is_empty()));
            }
            outline.mesh = mesh;
        }
        meshes
    }

    /// Appends the numbers of the model now, at the time (s) of the last frame.
    ///
    /// # Errors
    /// A number that cannot be shown, or what the file system refuses.
    pub fn write(&self, simulation: &Simulation, time: f64, film: &mut FilmWriter) -> Result<(), FilmError> {
        let (model, state) = (simulation.model(), simulation.state());
        let patches = model.patch_means(state, 0..model.covers.element_count());
        let sampled = |places: &[(ElementId, Point)], field: &[Vector]| -> Vec<[f64; 2]> {
            let sample = |(element, place): &(ElementId, Point)| model.sample(*element, *place, field).into();
            places.iter().map(sample).collect()
        };
        let stress = |(element, _): &(ElementId, Point)| model.stress_under(state, *element, &patches);
        let moved = self.joints.moved(simulation);
        let greatest = |pieces: &Vec<u32>| {
            let most =
                |k: usize| pieces.iter().map(|&piece| moved[piece as usize][k]).fold(f64::NEG_INFINITY, f64::max);
            [most(0), most(1)]
        };
        let elements = Elements {
            points: &sampled(&self.points, &state.displacement),
            velocity: &sampled(&self.middles, &state.velocity),
            stress: &self.middles.iter().map(stress).collect::<Vec<_>>(),
            joints: &self.faces.iter().map(greatest).collect::<Vec<_>>(),
        };
        film.elements(time, &elements)
    }
}
