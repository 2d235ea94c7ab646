//! A slope that can slide on planes which daylight in its face, with a tension crack, water and a seismic coefficient.

use enmm::geometry::Vector;
use enmm::model::Simulation;

use super::block::G;
use crate::parts::rock;
use crate::{Setup, Trouble};

/// Geometry, strength and loads; the toe is at the origin and the slope falls to the left.
#[derive(Debug, Clone, Copy)]
pub struct PlaneSlide {
    /// Height (m).
    pub height: f64,
    /// Depth of the tension crack (m).
    pub crack: f64,
    /// Dip of the face (rad).
    pub face: f64,
    /// Dip of the plane (rad).
    pub plane: f64,
    /// Cohesion of the plane (Pa).
    pub cohesion: f64,
    /// Friction of the plane (rad).
    pub friction: f64,
    /// Unit weight of the rock (N/m³).
    pub unit_weight: f64,
    /// Unit weight of the water (N/m³).
    pub water_weight: f64,
    /// Depth of the water in the crack (m).
    pub water: f64,
    /// Seismic coefficient, out of the slope.
    pub seismic: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Mesh size (m).
    pub size: f64,
    /// Parallel planes, the lowest through the toe.
    pub planes: u32,
    /// Distance (m) between them.
    pub spacing: f64,
}

impl PlaneSlide {
    /// A dry slope with one plane of the dip `plane` (degrees) and no crack, from the parameters that problems share.
    pub fn of(setup: &Setup, plane: f64, unit_weight: f64) -> Self {
        let height = setup.get("height");
        Self {
            height,
            crack: 0.0,
            face: setup.get("face_deg").to_radians(),
            plane: plane.to_radians(),
            cohesion: setup.get("cohesion"),
            friction: setup.get("phi_deg").to_radians(),
            unit_weight,
            water_weight: 1e3 * G,
            water: 0.0,
            seismic: 0.0,
            young: 2e10,
            size: 0.12 * height,
            planes: 1,
            spacing: height,
        }
    }

    /// Length of the plane (m).
    pub fn length(&self) -> f64 {
        (self.height - self.crack) / self.plane.sin()
    }

    /// Weight of the wedge (N/m): ½γH²((1 − (z/H)²)·cot ψp − cot ψf).
    pub fn weight(&self) -> f64 {
        let share = 1.0 - (self.crack / self.height).powi(2);
        0.5 * self.unit_weight * self.height.powi(2) * (share / self.plane.tan() - 1.0 / self.face.tan())
    }

    /// Factor of safety of the wedge as one rigid body, Hoek and Bray's formula with a seismic coefficient:
    /// (cA + (W(cos ψ − k sin ψ) − U − V sin ψ)·tan φ)/(W(sin ψ + k cos ψ) + V cos ψ).
    pub fn factor(&self) -> f64 {
        self.bolted_factor(0.0, 0.0)
    }

    /// The same with the tension of all bolts (N/m), which fall by `delta` (rad) into the slope: T·sin(ψ + δ) more
    /// normal force, T·cos(ψ + δ) less drive.
    pub fn bolted_factor(&self, tension: f64, delta: f64) -> f64 {
        let (s, c) = self.plane.sin_cos();
        let (pull_s, pull_c) = (self.plane + delta).sin_cos();
        let uplift = 0.5 * self.water_weight * self.water * self.length();
        let push = 0.5 * self.water_weight * self.water.powi(2);
        let (weight, k) = (self.weight(), self.seismic);
        let normal = weight * (c - k * s) - uplift - push * s + tension * pull_s;
        let drive = weight * (s + k * c) + push * c - tension * pull_c;
        (self.cohesion * self.length() + normal * self.friction.tan()) / drive
    }

    /// Where the plane ends: at the foot of the crack, or at the surface.
    fn head(&self) -> [f64; 2] {
        let y = self.height - self.crack;
        [y / self.plane.tan(), y]
    }

    /// Whether a plane and its head lie within rock: the wedge must reach behind the crest.
    pub fn is_sound(&self) -> bool {
        self.plane < self.face && self.head()[0] > self.height / self.face.tan()
    }

    /// The planes above the lowest: from the face to the crack or the surface.
    fn upper_planes(&self) -> Vec<[[f64; 2]; 2]> {
        let (face, plane) = (self.face.tan(), self.plane.tan());
        let behind = if self.crack > 0.0 { self.head()[0] } else { f64::INFINITY };
        let line = |k: u32| {
            let rise = f64::from(k) * self.spacing / self.plane.cos();
            let x = rise / (face - plane);
            let end = ((self.height - rise) / plane).min(behind);
            [[x, face * x], [end, rise + plane * end]]
        };
        (1..self.planes).map(line).filter(|[a, b]| b[0] > a[0] && a[1] < self.height).collect()
    }

    /// The case: the wedge at rest under its own strength; the ground below and behind it is held.
    pub fn text(&self, title: &str) -> String {
        self.model(title) + "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 60.0\n"
    }

    /// A point of the wedge.
    fn inside(&self) -> [f64; 2] {
        let ([x, y], h) = (self.head(), self.height);
        [(2.0 * x + h / self.face.tan()) / 4.0, (y + 2.0 * h) / 4.0]
    }

    /// Action of water on the wedge by the formula: the force (N/m) of V and U, and their moment (N) about the toe.
    pub fn water_force(&self) -> (Vector, f64) {
        let ((s, c), [x, y]) = (self.plane.sin_cos(), self.head());
        let thrust = Vector::new(-0.5 * self.water_weight * self.water.powi(2), 0.0);
        let uplift = Vector::new(-s, c) * (0.5 * self.water_weight * self.water * self.length());
        let middle = Vector::new(c, s) * (self.length() * 2.0 / 3.0);
        (thrust + uplift, Vector::new(x, y + self.water / 3.0).perp(&thrust) + middle.perp(&uplift))
    }

    /// The same pressures as loads in the joints, of a slope without water table.
    pub fn water_loads(&self) -> String {
        let ([x, y], most) = (self.head(), self.water_weight * self.water);
        let load = |from: [f64; 2], to: [f64; 2], [p, q]: [f64; 2]| {
            format!("[[load]]\nkind = \"joint\"\nedge = [{from:?}, {to:?}]\npressure = {p:?}\npressure_end = {q:?}\n")
        };
        load([0.0; 2], [x, y], [0.0, most]) + &load([x, y], [x, y + self.water], [most, 0.0])
    }

    /// Force (N/m) and moment about the toe (N) of what loads and water push the wedge with in the first step.
    ///
    /// # Errors
    /// A numerical failure, or a wedge that is not there.
    pub fn pushed(&self, simulation: &mut Simulation) -> Result<(Vector, f64), Trouble> {
        simulation.advance(false)?;
        let covers = &simulation.model().covers;
        let element = covers.element_at(self.inside().into()).ok_or(Trouble("the wedge is not there".to_owned()))?;
        let (mut force, mut moment) = (Vector::zeros(), 0.0);
        for i in covers.covers_of(covers.element_block[element]) {
            let push = simulation.workspace().load_force[i];
            force += push;
            moment += covers.star_position[i].perp(&push);
        }
        Ok((force, moment))
    }

    /// The case without stages.
    pub fn model(&self, title: &str) -> String {
        let h = self.height;
        let [x, y] = self.head();
        let (right, low) = (x + 0.3 * h, -0.25 * h);
        // The face goes on below the toe: ground in front of it would hold a wedge that the formula lets go.
        let outline = [[low / self.face.tan(), low], [right, low], [right, h], [x, h], [h / self.face.tan(), h]];
        let mut text = format!(
            "title = {title:?}\n[domain]\noutline = {outline:?}\njoint_law = \"plane\"\n[mesh]\nsize = {:e}\n\
             origin = [0.31, 0.17]\n[[joint]]\npoints = {:?}\n[joint_law.plane]\nfriction_deg = {:?}\n\
             cohesion = {:e}\n[joint_law.crack]\nfriction_deg = 0.0\n[[fix]]\nblock = {:?}\n{}",
            self.size,
            [[0.0, 0.0], [x, y]],
            self.friction.to_degrees(),
            self.cohesion,
            [0.5 * right, 0.5 * low],
            rock(self.young, self.unit_weight / G),
        );
        if self.crack > 0.0 {
            text += &format!("[[joint]]\npoints = {:?}\nlaw = \"crack\"\n", [[x, y], [x, h]]);
        }
        for plane in self.upper_planes() {
            text += &format!("[[joint]]\npoints = {plane:?}\n");
        }
        if self.water > 0.0 {
            let density = self.water_weight / G;
            text += &format!("[water]\ntable = {:?}\ndensity = {density:e}\n", [[0.0, 0.0], [x, y + self.water]]);
        }
        if self.seismic != 0.0 {
            text += &format!("[[load]]\nkind = \"body\"\nacceleration = [{:e}, 0.0]\n", -self.seismic * G);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOEK: PlaneSlide = PlaneSlide {
        height: 60.0,
        crack: 14.0,
        face: 50.0 * std::f64::consts::PI / 180.0,
        plane: 35.0 * std::f64::consts::PI / 180.0,
        cohesion: 100e3,
        friction: 35.0 * std::f64::consts::PI / 180.0,
        unit_weight: 26.5e3,
        water_weight: 9.81e3,
        water: 0.0,
        seismic: 0.0,
        young: 5e10,
        size: 8.0,
        planes: 1,
        spacing: 20.0,
    };

    #[test]
    fn the_formula_gives_the_published_numbers() {
        assert!((HOEK.length() - 80.1986).abs() < 1e-4 && (HOEK.weight() / 24388.71e3 - 1.0).abs() < 1e-6);
        let table = [(0.0, 1.57331, 1.36171), (7.0, 1.40875, 1.21645), (14.0, 1.20235, 1.03714)];
        for (water, still, shaken) in table {
            let factor = |seismic: f64| PlaneSlide { water, seismic, ..HOEK }.factor();
            assert!((factor(0.0) - still).abs() < 1e-5, "{water}: {}", factor(0.0));
            assert!((factor(0.08) - shaken).abs() < 1e-5, "{water}: {}", factor(0.08));
        }
    }

    #[test]
    fn a_slope_without_crack_gives_the_published_number() {
        let degrees = |x: f64| x.to_radians();
        let (face, plane, friction) = (degrees(55.0), degrees(35.0), degrees(40.0));
        let slope = PlaneSlide { height: 260.0, crack: 0.0, face, plane, friction, unit_weight: 2660.0 * 9.81, ..HOEK };
        assert!((slope.factor() - 1.32145).abs() < 1e-5, "{}", slope.factor());
    }
}
