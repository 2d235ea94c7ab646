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

    /// Elastic volume change of an element of rock that can yield, averaged (Eq. 58a).
    fn volume(&self, state: &State, strength: &MohrCoulomb, element: ElementId) -> f64 {
        let own = |e: ElementId| {
            let at = self.deformation(e, &state.displacement);
            [strength.own_volume(&at, &state.plastic[e])]
        };
        self.averaging.around(element, own).unwrap_or_else(|| own(element))[0]
    }

    /// Deformation of an element of rock that can yield, with the averages of its patches.
    fn strained(&self, state: &State, strength: &MohrCoulomb, element: ElementId) -> Strained {
        let own = |e: ElementId| [strength.mean_stress(self.volume(state, strength, e))];
        let [mean] = self.averaging.around(element, own).unwrap_or_else(|| own(element));
        let deformation = self.deformation(element, &state.displacement);
        Strained { deformation, mean }
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

    /// Strength, strain, plastic strain and its growth of an element at the displacements of a state, as the next step
    /// will find them unless an input changes; none when the element never yields.
    fn plastic_now(&self, state: &State, element: ElementId) -> Option<(&MohrCoulomb, Strained, [PlasticStrain; 2])> {
        let strength = self.strength_of(element)?;
        let before = state.plastic.get(element.index())?;
        let time = state.stage_start + state.stage_step as f64 * self.dt + state.part;
        let surface = strength.surface(state.drive.strength_factor_now(time));
        let at = self.strained(state, strength, element);
        let growth = surface.growth(&at, &self.pre_stress_and_out(element), before).unwrap_or_default();
        Some((strength, at, [*before, growth]))
    }

    /// Stress xx, yy, xy (Pa, tension positive) of an element in global axes.
    pub fn stress(&self, state: &State, element: ElementId) -> [f64; 3] {
        let at = self.deformation(element, &state.displacement);
        let stress = at.stress(self.rock_of(element), &self.pre_stress_of(element));
        match self.plastic_now(state, element) {
            Some((strength, at, [plastic, growth])) => {
                let relief = strength.stress(&at, &plastic, &growth);
                [0, 1, 2].map(|k| stress[k] + relief[k])
            }
            None => stress,
        }
    }

    /// Plastic strain √(⅔ εp:εp) of an element at the displacements of a state; zero when it never yields.
    pub fn plastic_strain(&self, state: &State, element: ElementId) -> f64 {
        let [plastic, growth] = self.plastic_now(state, element).map_or([[0.0; 4]; 2], |(.., both)| both);
        equivalent_strain(&[0, 1, 2, 3].map(|k| plastic[k] + growth[k]))
    }

    /// Strain energy (J/m² of reference area) of an element with the plastic strain that the state holds.
    pub fn strain_energy(&self, state: &State, element: ElementId) -> f64 {
        let at = self.deformation(element, &state.displacement);
        let energy = at.energy(self.rock_of(element), &self.pre_stress_of(element));
        match self.strength_of(element).zip(state.plastic.get(element.index())) {
            Some((strength, plastic)) => {
                let volume = self.volume(state, strength, element);
                energy + strength.energy(&at, volume, &self.pre_stress_and_out(element), plastic)
            }
            None => energy,
        }
    }
}
