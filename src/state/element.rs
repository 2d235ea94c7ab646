//! Stress and energy of one element: elastic stress, in-situ stress and plastic strain together.

use crate::cover::ElementId;
use crate::geometry::Vector;
use crate::mechanics::{Deformation, Elasticity, MohrCoulomb, PlasticStrain, PreStress, Strained, equivalent_strain};

use super::{Model, State};

impl Model {
    /// Deformation of an element under displacements of the covers (m).
    pub fn deformation(&self, element: ElementId, displacement: &[Vector]) -> Deformation {
        let u = self.covers.element_covers[element].map(|i| displacement[i]);
        Deformation::new(u, &self.covers.gradients[self.covers.element_triangle[element].set as usize])
    }

    /// Deformation of an element that can yield, with the volume change that its rock feels (Eq. 58a).
    fn strained(&self, element: ElementId, displacement: &[Vector]) -> Strained {
        let deformation = self.deformation(element, displacement);
        let own = |e| [self.deformation(e, displacement).dilatation()];
        let averaged = self.averaging.around(element, own);
        Strained { deformation, dilatation: averaged.map_or(deformation.dilatation(), |[dilatation]| dilatation) }
    }

    /// Elastic constants of an element.
    pub fn rock_of(&self, element: ElementId) -> &Elasticity {
        &self.rocks[self.element_rock[element] as usize]
    }

    /// Strength of an element; none when it never yields.
    pub fn strength_of(&self, element: ElementId) -> Option<&MohrCoulomb> {
        self.strengths[self.element_rock[element] as usize].as_ref()
    }

    /// In-situ stress xx, yy, xy (Pa) of an element, zero when the model has none.
    pub fn pre_stress_of(&self, element: ElementId) -> PreStress {
        self.pre_stress.get(element.index()).copied().unwrap_or_default()
    }

    /// In-situ stress xx, yy, xy, zz (Pa) of an element, zero when the model has none.
    pub fn pre_stress_and_out(&self, element: ElementId) -> [f64; 4] {
        let [xx, yy, xy] = self.pre_stress_of(element);
        [xx, yy, xy, self.pre_stress_out.get(element.index()).copied().unwrap_or_default()]
    }

    /// Strength, strain and plastic strain of an element at the displacements of a state, as the next step will find
    /// them unless an input changes; none when the element never yields.
    fn plastic_now(&self, state: &State, element: ElementId) -> Option<(&MohrCoulomb, Strained, PlasticStrain)> {
        let strength = self.strength_of(element)?;
        let before = state.plastic.get(element.index())?;
        let time = state.stage_start + state.stage_step as f64 * self.dt + state.part;
        let surface = strength.surface(state.drive.strength_factor_now(time));
        let at = self.strained(element, &state.displacement);
        let growth = surface.growth(&at, &self.pre_stress_and_out(element), before).unwrap_or_default();
        Some((strength, at, [0, 1, 2, 3].map(|k| before[k] + growth[k])))
    }

    /// Stress xx, yy, xy (Pa, tension positive) of an element in global axes.
    pub fn stress(&self, state: &State, element: ElementId) -> [f64; 3] {
        let at = self.deformation(element, &state.displacement);
        let stress = at.stress(self.rock_of(element), &self.pre_stress_of(element));
        match self.plastic_now(state, element) {
            Some((strength, at, plastic)) => {
                let relief = strength.stress(&at, &plastic);
                [0, 1, 2].map(|k| stress[k] + relief[k])
            }
            None => stress,
        }
    }

    /// Plastic strain √(⅔ εp:εp) of an element at the displacements of a state; zero when it never yields.
    pub fn plastic_strain(&self, state: &State, element: ElementId) -> f64 {
        equivalent_strain(&self.plastic_now(state, element).map_or([0.0; 4], |(.., plastic)| plastic))
    }

    /// Strain energy (J/m² of reference area) of an element with the plastic strain that the state holds.
    pub fn strain_energy(&self, state: &State, element: ElementId) -> f64 {
        let at = self.deformation(element, &state.displacement);
        let energy = at.energy(self.rock_of(element), &self.pre_stress_of(element));
        match self.strength_of(element).zip(state.plastic.get(element.index())) {
            Some((strength, plastic)) => {
                let at = self.strained(element, &state.displacement);
                energy + strength.energy(&at, &self.pre_stress_and_out(element), plastic)
            }
            None => energy,
        }
    }
}
