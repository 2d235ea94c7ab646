//! Stress and energy of one element: elastic stress, in-situ stress and plastic strain together.

use std::ops::Range;

use enmm_lanes::dispatch;

use crate::cover::ElementId;
use crate::geometry::Vector;
use crate::mechanics::{
    Deformation, ElasticElements, Elasticity, PlasticStrain, PreStress, Strained, YieldSurface, YieldingRock,
    equivalent_strain,
};

use super::{Model, State};

/// Height over the mesh size by which a sliver may hang on its host: that of a triangle.
const HANGING: f64 = 0.866_025_403_784_438_6;

/// Means over the patches of whole blocks whose rock yields, and its yield surfaces. Empty where no rock
/// yields.
#[derive(Debug, Clone)]
pub struct PatchMeans<'a> {
    /// Displacements of all covers (m).
    displacement: &'a [Vector],
    /// First element.
    first: usize,
    /// Averaged elastic volume change of each (Eq. 58a).
    volume: Vec<[f64; 1]>,
    /// Averaged mean stress (Pa) of each, without in-situ stress (Eq. 58b).
    mean: Vec<[f64; 1]>,
    /// Yield surface of each rock; none for one that never yields.
    surfaces: Vec<Option<YieldSurface>>,
}

impl Model {
    /// Deformation of an element under displacements of the covers (m).
    #[inline]
    pub fn deformation(&self, element: ElementId, displacement: &[Vector]) -> Deformation {
        let u = self.covers.element_covers[element].map(|i| displacement[i]);
        Deformation::new(u, &self.covers.gradients[self.covers.element_triangle[element].set as usize])
    }

    /// Means over patches for the rock of whole blocks, which have the elements of a range.
    pub fn patch_means<'a>(&self, state: &'a State, elements: Range<usize>) -> PatchMeans<'a> {
        self.patch_means_at(state, &state.displacement, elements)
    }

    /// The same at other displacements (m) than those of the state.
    fn patch_means_at<'a>(&self, state: &State, displacement: &'a [Vector], elements: Range<usize>) -> PatchMeans<'a> {
        let first = elements.start;
        if state.plastic.is_empty() {
            let (volume, mean, surfaces) = Default::default();
            return PatchMeans { displacement, first, volume, mean, surfaces };
        }
        let at = |e: ElementId| e.index() - first;
        let own = |e: ElementId| match self.strength_of(e) {
            Some(rock) => [rock.own_volume(&self.deformation(e, displacement), &state.plastic[e])],
            None => [0.0],
        };
        let averaged = |own: &[[f64; 1]], e| self.averaging.around(e, |e| own[at(e)]).unwrap_or_else(|| own[at(e)]);
        let own: Vec<_> = ElementId::range(elements.clone()).map(own).collect();
        let volume: Vec<_> = ElementId::range(elements.clone()).map(|e| averaged(&own, e)).collect();
        let stress = |e| [self.strength_of(e).map_or(0.0, |rock| rock.mean_stress(volume[at(e)][0]))];
        let own: Vec<_> = ElementId::range(elements.clone()).map(stress).collect();
        let mean = ElementId::range(elements).map(|e| averaged(&own, e)).collect();
        let time = state.stage_start + state.stage_step as f64 * self.dt + state.part;
        let surfaces = self.surfaces(state.drive.strength_factor_now(time)).collect();
        PatchMeans { displacement, first, volume, mean, surfaces }
    }

    /// The same for the block of one element.
    fn patch_means_about<'a>(&self, state: &'a State, element: ElementId) -> PatchMeans<'a> {
        self.patch_means(state, self.covers.elements_of(self.covers.element_block[element]))
    }

    /// Elastic constants of an element.
    pub fn rock_of(&self, element: ElementId) -> &Elasticity {
        &self.rocks[self.element_rock[element] as usize]
    }

    /// Strength of an element; none when it never yields.
    #[inline]
    pub fn strength_of(&self, element: ElementId) -> Option<&YieldingRock> {
        self.strengths[self.element_rock[element] as usize].as_ref()
    }

    /// Yield surface of each rock with its strength times a factor; none for one that never yields.
    pub fn surfaces(&self, factor: f64) -> impl Iterator<Item = Option<YieldSurface>> {
        self.strengths.iter().map(move |rock| rock.map(|strength| strength.surface(factor)))
    }

    /// Whether water has pressure in the pores of an element that lies below its surface (Eq. 39a).
    pub fn is_porous(&self, element: ElementId) -> bool {
        let has_water = self.water.as_ref().is_some_and(|water| water.in_rock);
        has_water && self.strength_of(element).is_some_and(|strength| strength.is_porous)
    }

    /// In-situ stress xx, yy, xy (Pa) of an element, zero when the model has none.
    #[inline]
    pub fn pre_stress_of(&self, element: ElementId) -> PreStress {
        self.pre_stress.get(element.index()).copied().unwrap_or_default()
    }

    /// In-situ stress xx, yy, xy, zz (Pa) of an element, zero when the model has none.
    #[inline]
    pub fn pre_stress_and_out(&self, element: ElementId) -> [f64; 4] {
        let [xx, yy, xy] = self.pre_stress_of(element);
        [xx, yy, xy, self.pre_stress_out.get(element.index()).copied().unwrap_or_default()]
    }

    /// Plastic strain that brings a trial stress xx, yy, xy, zz (Pa) of an element back to the surface of its rock;
    /// none where it is elastic (Eqs. 57, 59a).
    #[inline]
    pub fn flow(&self, surface: &YieldSurface, element: ElementId, trial: [f64; 4]) -> Option<PlasticStrain> {
        let host = self.covers.host[element];
        if host == element {
            return surface.flow(trial);
        }
        let weight = self.rock_of(element).density * self.gravity.norm() * HANGING * self.covers.mesh.size;
        surface.flow_of_hung(trial, (weight - surface.tension()).max(0.0))
    }

    /// Strength, strain, plastic strain and its growth of an element at the displacements of a state, as the next step
    /// will find them unless an input changes; none when the element never yields.
    fn plastic_now(
        &self,
        state: &State,
        element: ElementId,
        patches: &PatchMeans,
    ) -> Option<(&YieldingRock, Strained, [PlasticStrain; 2])> {
        let strength = self.strength_of(element)?;
        let before = state.plastic.get(element.index())?;
        let surface = patches.surfaces[self.element_rock[element] as usize].as_ref()?;
        let deformation = self.deformation(element, patches.displacement);
        let at = Strained { deformation, mean: patches.mean[element.index() - patches.first][0] };
        let trial = surface.trial(&at, Some(&self.pre_stress_and_out(element)), before);
        let growth = self.flow(surface, element, trial).unwrap_or_default();
        Some((strength, at, [*before, growth]))
    }

    /// Stress xx, yy, xy (Pa, tension positive) of an element in global axes.
    pub fn stress(&self, state: &State, element: ElementId) -> [f64; 3] {
        self.stress_under(state, element, &self.patch_means_about(state, element))
    }

    /// The same from the means over the patches of its block.
    pub fn stress_under(&self, state: &State, element: ElementId, patches: &PatchMeans) -> [f64; 3] {
        let at = self.deformation(element, patches.displacement);
        let stress = at.stress(&self.rock_of(element).constants(), &self.pre_stress_of(element));
        self.with_relief(state, element, patches, stress)
    }

    /// An elastic stress xx, yy, xy (Pa) of an element less what plastic strain takes off it.
    fn with_relief(&self, state: &State, element: ElementId, patches: &PatchMeans, stress: [f64; 3]) -> [f64; 3] {
        let Some((strength, at, [plastic, growth])) = self.plastic_now(state, element, patches) else { return stress };
        let relief = strength.stress(&at, &plastic, &growth);
        [0, 1, 2].map(|k| stress[k] + relief[k])
    }

    /// Plastic strain √(⅔ εp:εp) of an element at the displacements of a state; zero when it never yields.
    pub fn plastic_strain(&self, state: &State, element: ElementId) -> f64 {
        self.plastic_strain_under(state, element, &self.patch_means_about(state, element))
    }

    /// The same from the means over the patches of its block.
    pub fn plastic_strain_under(&self, state: &State, element: ElementId, patches: &PatchMeans) -> f64 {
        let [plastic, growth] = self.plastic_now(state, element, patches).map_or([[0.0; 4]; 2], |(.., both)| both);
        equivalent_strain(&[0, 1, 2, 3].map(|k| plastic[k] + growth[k]))
    }

    /// Strain energy (J per m² of reference area) of an element beyond the elastic one, by its plastic strain.
    fn plastic_energy(&self, state: &State, element: ElementId, patches: &PatchMeans) -> f64 {
        let yielding = self.strength_of(element).zip(state.plastic.get(element.index()));
        yielding.map_or(0.0, |(strength, plastic)| {
            let at = self.deformation(element, patches.displacement);
            let [volume] = patches.volume[element.index() - patches.first];
            strength.energy(&at, volume, &self.pre_stress_and_out(element), plastic)
        })
    }

    /// Shows stress xx, yy, xy (Pa, tension positive, global axes) and strain energy (J per m² of reference area) of
    /// the elements of whole blocks, one by one in their order, at displacements (m).
    pub fn each_stressed(
        &self,
        state: &State,
        displacement: &[Vector],
        elements: Range<usize>,
        mut see: impl FnMut(ElementId, [f64; 3], f64),
    ) {
        let patches = self.patch_means_at(state, displacement, elements.clone());
        let yields = !state.plastic.is_empty();
        let see = |element, stress, energy| {
            if yields {
                let stress = self.with_relief(state, element, &patches, stress);
                see(element, stress, energy + self.plastic_energy(state, element, &patches));
            } else {
                see(element, stress, energy);
            }
        };
        let Self { covers, rocks, element_rock, pre_stress, .. } = self;
        dispatch(ElasticElements { covers, rocks, element_rock, pre_stress, displacement, elements, see });
    }
}
