//! Rock that yields: elastic, perfectly plastic by Mohr–Coulomb or Hoek–Brown with tension cut-off, by return mapping
//! in principal stresses (Eqs. 54–59).

use enmm_lanes::{Arithmetic, Values};

use super::hoek_brown::{Curve, HoekBrown, Onto, Returned};
use super::weakness::{Both, WeakPlane, Weakness};
use super::{Deformation, Elasticity};

/// Plastic strain xx, yy, xy, zz of an element in the axes that rotate with it.
pub type PlasticStrain = [f64; 4];

/// Deformation of an element, or of eight in lanes, with what its rock feels of the patches about it, or its own where
/// it is in none.
#[derive(Debug, Clone, Copy)]
pub struct Strained<F = f64> {
    /// Deformation.
    pub deformation: Deformation<F>,
    /// Mean stress in the plane (Pa), without in-situ stress (Eq. 58b).
    pub mean: F,
}

/// Stress beyond the surface, relative to the largest stress and the cohesion, that still counts as on it: far above
/// rounding, so that a second return changes nothing, and far below any measurable stress.
const ON_SURFACE: f64 = 1e-10;
/// Planes of the surface in the order in which they are tried: shear between sorted principal stresses (first, last),
/// then the three tension planes and, for plane stress, the shear planes of the opposite order.
const PLANES: [Plane; 9] = [
    Plane::Shear(0, 2),
    Plane::Shear(0, 1),
    Plane::Shear(1, 2),
    Plane::Tension(0),
    Plane::Tension(1),
    Plane::Tension(2),
    Plane::Shear(2, 0),
    Plane::Shear(1, 0),
    Plane::Shear(2, 1),
];
/// Planes that can be met when the return keeps the order of the principal stresses, as it does in plane strain.
const ORDERED: usize = 6;

/// One plane of the surface in principal stresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Plane {
    /// Shear between the stress that is the larger one on this plane and the smaller one.
    Shear(usize, usize),
    /// Tension cut-off of one stress.
    Tension(usize),
}

/// Elastic constants and strength of a rock that yields.
#[doc(alias = "elastic-plastic")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingRock {
    /// Elastic constants in the plane.
    pub elasticity: Elasticity,
    /// Whether there is no stress out of the plane, instead of no strain.
    pub plane_stress: bool,
    /// Whether water has pressure in its pores (Eq. 39a).
    pub is_porous: bool,
    /// Its strength.
    pub criterion: Criterion,
    /// A plane along which it is weaker.
    pub weakness: Option<Weakness>,
}

/// Which stresses a rock withstands, and how it flows beyond.
#[expect(clippy::large_enum_variant, reason = "a model has one for each kind of rock")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// Friction and cohesion.
    MohrCoulomb(MohrCoulomb),
    /// A curved envelope, in plane strain.
    HoekBrown(HoekBrown),
}

/// Strength by friction and cohesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MohrCoulomb {
    /// Tangent of the friction angle.
    pub friction: f64,
    /// Cohesion (Pa).
    pub cohesion: f64,
    /// Tangent of the dilation angle.
    pub dilation: f64,
    /// Tensile strength (Pa); `None` for the apex of the shear planes.
    pub tension: Option<f64>,
}

impl MohrCoulomb {
    fn planes(&self, factor: f64) -> Planes {
        let sine = |tangent: f64| tangent / (1.0 + tangent * tangent).sqrt();
        let (friction, cohesion) = (self.friction * factor, self.cohesion * factor);
        let apex = if friction > 0.0 { cohesion / friction } else { f64::INFINITY };
        Planes {
            sin_friction: sine(friction),
            sin_dilation: sine(self.dilation.min(friction)),
            shear: 2.0 * cohesion / (1.0 + friction * friction).sqrt(),
            tension: self.tension.map_or(apex, |tension| (tension * factor).min(apex)),
        }
    }
}

impl YieldingRock {
    /// The surface with its shear strength and the given tensile strength times `factor` (Eqs. 57a, 59); ψ is at most
    /// the φ that is left.
    pub fn surface(&self, factor: f64) -> YieldSurface {
        let (elasticity, plane_stress) = (self.elasticity, self.plane_stress);
        let (planes, curve) = match &self.criterion {
            Criterion::MohrCoulomb(strength) => (strength.planes(factor), None),
            Criterion::HoekBrown(strength) => {
                let curve = strength.curve(factor);
                (Planes::beside(&curve), Some(curve))
            }
        };
        let weak = self.weakness.map(|weakness| weakness.plane(factor));
        YieldSurface { elasticity, plane_stress, planes, curve, weak, least: self.least_stress(factor) }
    }

    /// Stress (Pa) beside which a rest is nothing where no other stress acts: cohesion, or uniaxial strength.
    pub fn least_stress(&self, factor: f64) -> f64 {
        match &self.criterion {
            Criterion::MohrCoulomb(strength) => strength.cohesion * factor,
            Criterion::HoekBrown(strength) => strength.compression() * factor,
        }
    }

    /// Mean of the stresses xx and yy (Pa) at an elastic volume change, without in-situ stress.
    pub fn mean_stress(&self, volume: f64) -> f64 {
        (self.elasticity.lambda + self.elasticity.mu) * volume
    }

    /// Elastic volume change of an element by which its mean stress in the plane goes (Eq. 58a).
    #[inline(always)]
    pub fn own_volume<F: Arithmetic>(&self, at: &Deformation<F>, plastic: &[F; 4]) -> F {
        at.dilatation() - volume(&self.elasticity, self.plane_stress, plastic)
    }

    /// How much (Pa) the mean stress of its patches differs from an element's own.
    #[inline(always)]
    pub fn more<F: Arithmetic>(&self, at: &Strained<F>, plastic: &[F; 4]) -> F {
        at.mean - at.mean.splat(self.mean_stress(1.0)) * self.own_volume(&at.deformation, plastic)
    }

    /// C·εp xx, yy, xy, zz (Pa): the stress that plastic strain takes off (Eq. 55).
    #[inline(always)]
    fn relief<F: Arithmetic>(&self, plastic: &[F; 4]) -> [F; 4] {
        relief(&self.elasticity, self.plane_stress, plastic)
    }

    /// First Piola–Kirchhoff stress (Pa), row by row, that plastic strain takes off, less that which `more` of the mean
    /// stress adds (Eqs. 58, 58c).
    ///
    /// The skew part makes the forces the gradient of the energy where C·εp and the stretch have different axes, so
    /// that they rotate no element (Eq. 58).
    #[inline(always)]
    pub fn taken_off<F: Arithmetic>(&self, at: &Deformation<F>, plastic: &[F; 4], more: F) -> [F; 4] {
        let [xx, yy, xy, _] = self.relief(plastic);
        let (xx, yy) = (xx - more, yy - more);
        let skew = at.skew([xx, yy, xy]);
        at.turn_rows([xx, xy + skew, xy - skew, yy])
    }

    /// Contribution of averages, plastic strain and its growth to the stress xx, yy, xy (Pa) in global axes.
    pub fn stress(&self, at: &Strained, plastic: &PlasticStrain, growth: &PlasticStrain) -> [f64; 3] {
        let more = self.more(at, plastic);
        let [xx, yy, xy, _] = self.relief(&[0, 1, 2, 3].map(|k| plastic[k] + growth[k]));
        at.deformation.turn([more - xx, more - yy, -xy])
    }

    /// Contribution of plastic strain and of the averaged volume change to the energy (J/m²) under a pre-stress xx, yy,
    /// xy, zz (Pa) (Eqs. 58, 58b).
    pub fn energy(&self, at: &Deformation, volume: f64, pre: &[f64; 4], plastic: &PlasticStrain) -> f64 {
        let own = self.own_volume(at, plastic);
        let means = self.mean_stress(own) + self.mean_stress(volume);
        let more = 0.5 * (volume - own) * means;
        let relief = self.relief(plastic);
        let [xx, yy, xy] = at.strain();
        let own = [0.5 * plastic[0] - xx, 0.5 * plastic[1] - yy, 0.5 * plastic[2] - xy, 0.5 * plastic[3]];
        more + double_dot(&relief, &own) - double_dot(pre, plastic)
    }
}

/// xx + yy + 2ν·zz of a strain: what of it acts on the mean stress in the plane.
#[inline(always)]
fn volume<F: Arithmetic>(rock: &Elasticity, plane_stress: bool, &[xx, yy, _, zz]: &[F; 4]) -> F {
    let out = if plane_stress { 0.0 } else { rock.lambda / (rock.lambda + rock.mu) };
    xx + yy + xx.splat(out) * zz
}

/// C·ε of a plane strain field with strain out of the plane; in plane stress that one costs nothing.
#[inline(always)]
fn relief<F: Arithmetic>(rock: &Elasticity, plane_stress: bool, &[xx, yy, xy, zz]: &[F; 4]) -> [F; 4] {
    let (zero, lambda, two_mu) = (xx.splat(0.0), xx.splat(rock.lambda), xx.splat(2.0 * rock.mu));
    let zz = if plane_stress { zero } else { zz };
    let volume = lambda * (xx + yy + zz);
    let out = if plane_stress { zero } else { two_mu * zz + volume };
    [two_mu * xx + volume, two_mu * yy + volume, two_mu * xy, out]
}

/// a : b of two symmetric tensors xx, yy, xy, zz.
fn double_dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2] + a[3] * b[3]
}

/// √(⅔ εp:εp): size of a plastic strain.
pub fn equivalent_strain(plastic: &PlasticStrain) -> f64 {
    (2.0 / 3.0 * double_dot(plastic, plastic)).sqrt()
}

/// The surface between elastic and plastic states of a rock (Eqs. 56, 56a).
#[doc(alias = "return mapping")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldSurface {
    elasticity: Elasticity,
    plane_stress: bool,
    planes: Planes,
    /// The curve in place of the shear planes, which then hold at the tensile strength alone.
    curve: Option<Curve>,
    /// A plane along which the rock is weaker.
    weak: Option<WeakPlane>,
    /// Stress (Pa) beside which a rest is nothing where no other stress acts.
    least: f64,
}

/// Shear planes and tensile strength.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Planes {
    sin_friction: f64,
    sin_dilation: f64,
    /// 2c·cos φ (Pa).
    shear: f64,
    /// Tensile strength (Pa); infinite for a rock without friction and without a given value.
    tension: f64,
}

impl Planes {
    /// The shear planes that touch a curve where it meets its tensile strength.
    fn beside(curve: &Curve) -> Self {
        let at = &curve.first;
        Self {
            sin_friction: at.sin_friction,
            sin_dilation: curve.sin_dilation(at),
            shear: 2.0 * (at.radius - at.centre * at.sin_friction),
            tension: curve.tension,
        }
    }

    /// Whether they meet in a point at the tensile strength, as at the end of an envelope.
    fn are_a_point(&self) -> bool {
        self.sin_friction >= 1.0
    }

    fn beyond(&self, plane: Plane, s: &[f64; 3]) -> f64 {
        match plane {
            Plane::Shear(i, j) => s[i] - s[j] + (s[i] + s[j]) * self.sin_friction - self.shear,
            Plane::Tension(i) => s[i] - self.tension,
        }
    }

    /// Gradient of a plane, with the friction angle or, for the flow, the dilation angle.
    fn normal(plane: Plane, sine: f64) -> [f64; 3] {
        let mut normal = [0.0; 3];
        match plane {
            Plane::Shear(i, j) => (normal[i], normal[j]) = (1.0 + sine, sine - 1.0),
            Plane::Tension(i) => normal[i] = 1.0,
        }
        normal
    }
}

impl YieldSurface {
    /// Tensile strength (Pa) of all axes together, at which the surface ends.
    pub fn tension(&self) -> f64 {
        self.weak.map_or(self.planes.tension, |plane| plane.tension.min(self.planes.tension))
    }

    /// Stress xx, yy, xy, zz (Pa) in the axes that rotate with the element, before any growth of plastic strain.
    #[inline(always)]
    pub fn trial<F: Arithmetic>(&self, at: &Strained<F>, pre: Option<&[F; 4]>, plastic: &[F; 4]) -> [F; 4] {
        let own = self.own_stress(at, plastic);
        let Some(&[xx, yy, xy, zz]) = pre else { return own };
        let [xx, yy, xy] = at.deformation.carried_in_turned_axes([xx, yy, xy]);
        [own[0] + xx, own[1] + yy, own[2] + xy, own[3] + zz]
    }

    /// Lanes in which trial stresses xx, yy, xy, zz (Pa) lie inside the flat planes, as bits; none where there is a
    /// curve.
    #[inline(always)]
    pub fn inside<V: Values>(&self, values: V, trial: &[V::F; 4]) -> u8 {
        if self.curve.is_some() {
            return 0;
        }
        let [xx, yy, xy, zz] = *trial;
        let (half, sine) = (values.splat(0.5), values.splat(self.planes.sin_friction));
        let (mean, difference) = (half * (xx + yy), half * (xx - yy));
        let radius = values.sqrt(difference * difference + xy * xy);
        let (largest, smallest) = (values.max(zz, mean + radius), values.min(zz, mean - radius));
        let beyond = largest - smallest + (largest + smallest) * sine - values.splat(self.planes.shear);
        let beyond = values.max(beyond, largest - values.splat(self.planes.tension));
        let most = values.max(values.max(largest, -smallest), values.splat(self.least));
        let tolerance = values.splat(ON_SURFACE) * most;
        let inside = values.at_most(beyond, tolerance);
        self.weak.as_ref().map_or(inside, |plane| inside & plane.inside(values, trial, tolerance))
    }

    /// Energy (J/m²) that a growth of plastic strain takes between the deformations of two steps: with the mean of the
    /// stress before and after, as the leapfrog's work is (Eq. 58).
    pub fn taken(&self, from: &Strained, to: &Strained, pre: &[f64; 4], change: [&PlasticStrain; 2]) -> f64 {
        let [plastic, growth] = change;
        let before = self.own_stress(from, plastic);
        let (now, relief) = (self.own_stress(to, plastic), relief(&self.elasticity, self.plane_stress, growth));
        double_dot(&[0, 1, 2, 3].map(|k| 0.5 * (before[k] + now[k] - relief[k]) + pre[k]), growth)
    }

    /// What [`Self::taken`] lacks (J/m²) of the energy that a growth takes: it reckons with the stress that the element
    /// alone takes off, and the mean stress has gone `from` that before `to` that after with the growth of all.
    pub fn taken_by_others(&self, growth: &PlasticStrain, from: f64, to: f64) -> f64 {
        let volume = self.volume(growth);
        0.5 * (to - from + (self.elasticity.lambda + self.elasticity.mu) * volume) * volume
    }

    /// Elastic volume change that a growth of plastic strain takes (Eq. 58a).
    pub fn volume(&self, growth: &PlasticStrain) -> f64 {
        volume(&self.elasticity, self.plane_stress, growth)
    }

    /// C(ε − εp) xx, yy, xy, zz (Pa) in the axes that rotate with the element (Eq. 55).
    #[inline(always)]
    fn own_stress<F: Arithmetic>(&self, at: &Strained<F>, plastic: &[F; 4]) -> [F; 4] {
        let Elasticity { lambda, mu, .. } = self.elasticity;
        let [xx, yy, xy] = at.deformation.strain();
        let mean = at.mean;
        let half = mean.splat(mu) * ((xx - plastic[0]) - (yy - plastic[1]));
        let out = if self.plane_stress {
            mean.splat(0.0)
        } else {
            let young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
            mean.splat(lambda / (lambda + mu)) * mean - mean.splat(young) * plastic[3]
        };
        [mean + half, mean - half, mean.splat(2.0 * mu) * (xy - plastic[2]), out]
    }

    /// How far (Pa) a stress xx, yy, xy, zz lies beyond the surface, measured as |s₁ − s₃| or s₁; negative inside.
    pub fn excess(&self, stress: [f64; 4]) -> f64 {
        let sorted = Principal::of(stress, self.plane_stress).sorted;
        let own = match &self.curve {
            None => PLANES[..ORDERED].iter().map(|&p| self.planes.beyond(p, &sorted)).fold(f64::NEG_INFINITY, f64::max),
            Some(curve) => curve.beyond([sorted[0], sorted[2]]).max(self.planes.beyond(PLANES[3], &sorted)),
        };
        self.weak.map_or(own, |plane| own.max(plane.beyond(&stress)))
    }

    /// As [`Self::flow`], of rock that withstands a pull (Pa) on all sides beyond its own strength (Eq. 59a).
    pub fn flow_of_hung(&self, [xx, yy, xy, zz]: [f64; 4], pull: f64) -> Option<PlasticStrain> {
        let zz = if self.plane_stress { zz } else { zz - pull };
        self.flow([xx - pull, yy - pull, xy, zz])
    }

    /// Plastic strain xx, yy, xy, zz that brings a trial stress (Pa) back to the surface; `None` inside (Eqs. 57, 59c).
    pub fn flow(&self, trial: [f64; 4]) -> Option<PlasticStrain> {
        let Some(plane) = &self.weak else { return self.flow_between_planes(trial) };
        let (elasticity, plane_stress) = (&self.elasticity, self.plane_stress);
        let rock = |trial: &[f64; 4]| self.flow_between_planes(*trial);
        let relief = |flow: &PlasticStrain| relief(elasticity, plane_stress, flow);
        let greatest = |stress: &[f64; 4]| Principal::of(*stress, plane_stress).sorted.map(f64::abs);
        let tolerance = |stress: &[f64; 4]| ON_SURFACE * greatest(stress).into_iter().fold(self.least, f64::max);
        let (rock, relief, tolerance) = (&rock, &relief, &tolerance);
        Both { plane, elasticity, plane_stress, rock, relief, tolerance }.flow(&trial)
    }

    /// The same for the rock between its planes of weakness.
    fn flow_between_planes(&self, trial: [f64; 4]) -> Option<PlasticStrain> {
        let principal = Principal::of(trial, self.plane_stress);
        let sorted = principal.sorted;
        let most = sorted.iter().fold(self.least, |a, s| a.max(s.abs()));
        let tolerance = ON_SURFACE * most;
        let tension = self.planes.beyond(PLANES[3], &sorted);
        let shear = match &self.curve {
            None => self.planes.beyond(PLANES[0], &sorted),
            Some(curve) => curve.beyond_at_most([sorted[0], sorted[2]]),
        };
        let excess = shear.max(tension);
        if excess.is_nan() || excess <= tolerance {
            return None;
        }
        let is_pulled = tension > tolerance;
        let onto = |curve| Onto { curve, rock: &self.elasticity, trial: sorted, tolerance, is_pulled }.flow();
        let back = Return { surface: self, principal: &principal, tolerance };
        let flow = match self.curve.as_ref().map(onto) {
            Some(Returned::Flows(flow)) => flow,
            Some(Returned::Inside) => return None,
            Some(_) if self.planes.are_a_point() => back.apex(),
            _ => back.flow(),
        };
        Some(principal.in_plane_axes(flow))
    }
}

/// Principal stresses, largest first, and how they lie in the plane.
struct Principal {
    sorted: [f64; 3],
    /// Which of (larger in the plane, smaller in the plane, out of the plane) each sorted one is.
    axis: [usize; 3],
    /// Half the difference of xx and yy, xy, and the radius of both.
    circle: [f64; 3],
    /// Which sorted one costs no elastic stress: the one out of the plane in plane stress.
    free: Option<usize>,
}

impl Principal {
    #[inline]
    fn of([xx, yy, xy, zz]: [f64; 4], plane_stress: bool) -> Self {
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let radius = (half * half + xy * xy).sqrt();
        let (a, b) = (mean + radius, mean - radius);
        let (sorted, axis) = match () {
            () if zz > a => ([zz, a, b], [2, 0, 1]),
            () if zz < b => ([a, b, zz], [0, 1, 2]),
            () => ([a, zz, b], [0, 2, 1]),
        };
        let free = axis.iter().position(|&k| k == 2).filter(|_| plane_stress);
        Self { sorted, axis, circle: [half, xy, radius], free }
    }

    /// A strain along the sorted axes as xx, yy, xy, zz.
    fn in_plane_axes(&self, strain: [f64; 3]) -> PlasticStrain {
        let mut own = [0.0; 3];
        self.axis.iter().zip(strain).for_each(|(&k, value)| own[k] = value);
        let (mean, half) = (0.5 * (own[0] + own[1]), 0.5 * (own[0] - own[1]));
        // Of twice the angle from x to the larger stress in the plane.
        let [cos, sin] = match self.circle {
            [half, xy, radius] if radius > 0.0 => [half / radius, xy / radius],
            _ => [1.0, 0.0],
        };
        [mean + half * cos, mean - half * cos, half * sin, own[2]]
    }
}

/// The search for the planes on which a trial stress ends up.
struct Return<'a> {
    surface: &'a YieldSurface,
    principal: &'a Principal,
    tolerance: f64,
}

impl Return<'_> {
    /// Plastic strain along the sorted axes: one plane, else an edge, else a corner, else the apex.
    fn flow(&self) -> [f64; 3] {
        let count = if self.principal.free.is_some() { PLANES.len() } else { ORDERED };
        let planes = &PLANES[..count];
        let one = (0..count).find_map(|i| self.on(&[planes[i]]));
        let two = || pairs(count).find_map(|(i, j)| self.on(&[planes[i], planes[j]]));
        let three =
            || pairs(count).find_map(|(i, j)| (j + 1..count).find_map(|k| self.on(&[planes[i], planes[j], planes[k]])));
        one.or_else(two).or_else(three).unwrap_or_else(|| self.apex())
    }

    /// Stress of a strain along the sorted axes.
    fn stress(&self, strain: &[f64; 3]) -> [f64; 3] {
        let Elasticity { lambda, mu, .. } = self.surface.elasticity;
        let bears = |k: usize| self.principal.free != Some(k);
        let volume: f64 = lambda * (0..3).filter(|&k| bears(k)).map(|k| strain[k]).sum::<f64>();
        [0, 1, 2].map(|k| if bears(k) { 2.0 * mu * strain[k] + volume } else { 0.0 })
    }

    /// Plastic strain when exactly these planes yield; `None` when one of them would have to yield backwards, or
    /// another plane is violated.
    fn on<const N: usize>(&self, planes: &[Plane; N]) -> Option<[f64; 3]> {
        let YieldSurface { planes: surface, elasticity, .. } = self.surface;
        if planes.iter().any(|&p| surface.beyond(p, &[0.0; 3]) == f64::NEG_INFINITY) {
            return None;
        }
        let flows = planes.map(|p| Planes::normal(p, surface.sin_dilation));
        let stresses = flows.map(|b| self.stress(&b));
        let normals = planes.map(|p| Planes::normal(p, surface.sin_friction));
        let matrix = normals.map(|a| stresses.map(|s| (0..3).map(|k| a[k] * s[k]).sum::<f64>()));
        let right = planes.map(|p| surface.beyond(p, &self.principal.sorted));
        let rates = solve(matrix, right, elasticity.mu)?;
        let least = -self.tolerance / elasticity.mu;
        if rates.iter().any(|rate| rate.is_nan() || *rate < least) {
            return None;
        }
        let strain = [0, 1, 2].map(|k| (0..N).map(|p| rates[p] * flows[p][k]).sum::<f64>());
        let relief = self.stress(&strain);
        let stress = [0, 1, 2].map(|k| self.principal.sorted[k] - relief[k]);
        let holds = |p: &Plane| surface.beyond(*p, &stress) <= self.tolerance;
        PLANES.iter().all(holds).then_some(strain)
    }

    /// Plastic strain that leaves the apex, or zero stress where there is no apex or it is impossible in plane stress.
    fn apex(&self) -> [f64; 3] {
        let Elasticity { lambda, mu, .. } = self.surface.elasticity;
        let free = self.principal.free;
        let target =
            if free.is_none() && self.surface.planes.tension.is_finite() { self.surface.planes.tension } else { 0.0 };
        let bears = |k: usize| free != Some(k);
        let off = [0, 1, 2].map(|k| if bears(k) { self.principal.sorted[k] - target } else { 0.0 });
        let axes = if free.is_some() { 2.0 } else { 3.0 };
        let volume = off.iter().sum::<f64>() / (2.0 * mu + axes * lambda);
        [0, 1, 2].map(|k| if bears(k) { (off[k] - lambda * volume) / (2.0 * mu) } else { 0.0 })
    }
}

/// All pairs i < j below `count`.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |i| (i + 1..count).map(move |j| (i, j)))
}

/// Solution of a small linear system by elimination; `None` when it is singular relative to `scale`.
fn solve<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N], scale: f64) -> Option<[f64; N]> {
    for k in 0..N {
        let pivot = (k..N).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        b.swap(k, pivot);
        if a[k][k].abs() <= 1e-9 * scale {
            return None;
        }
        for i in k + 1..N {
            let share = a[i][k] / a[k][k];
            (k..N).for_each(|j| a[i][j] -= share * a[k][j]);
            b[i] -= share * b[k];
        }
    }
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use enmm_case::{Envelope, HoekBrown};

    use crate::geometry::Vector;

    use super::*;
    use crate::rock::hoek_brown;

    fn rock(friction_deg: f64, dilation_deg: f64, tension: Option<f64>, plane_stress: bool) -> YieldingRock {
        let tangent = |degrees: f64| degrees.to_radians().tan();
        let elasticity = if plane_stress {
            Elasticity::plane_stress(1e9, 0.3, 2500.0)
        } else {
            Elasticity::plane_strain(1e9, 0.3, 2500.0)
        };
        let (friction, dilation) = (tangent(friction_deg), tangent(dilation_deg));
        let criterion = Criterion::MohrCoulomb(MohrCoulomb { friction, cohesion: 1e6, dilation, tension });
        YieldingRock { elasticity, plane_stress, is_porous: false, criterion, weakness: None }
    }

    /// Stress after the return of a trial stress.
    fn returned(strength: &YieldingRock, trial: [f64; 4]) -> ([f64; 4], PlasticStrain) {
        let flow = strength.surface(1.0).flow(trial).unwrap_or_default();
        let relief = strength.relief(&flow);
        ([0, 1, 2, 3].map(|k| trial[k] - relief[k]), flow)
    }

    /// On the face s₁ (1 + sin φ) − s₃ (1 − sin φ) = 2c·cos φ; the flow swells by 2 sin ψ per 2 of shear and the middle
    /// stress's axis does not flow.
    #[test]
    fn a_face_returns_along_the_dilation_angle() {
        let strength = rock(30.0, 10.0, None, false);
        let (stress, flow) = returned(&strength, [-1e6, -9e6, 0.0, -3e6]);
        assert!((stress[0] * 1.5 - stress[1] * 0.5 - 2e6 * 30f64.to_radians().cos()).abs() < 1e-3);
        assert!(flow[3].abs() < 1e-15);
        let sine = (flow[0] + flow[1]) / (flow[0] - flow[1]);
        assert!((sine - 10f64.to_radians().sin()).abs() < 1e-9, "{sine}");
    }

    /// Triaxial extension and compression end on edges; a hydrostatic pull ends at the apex c·cot φ or the cut-off.
    #[test]
    fn edges_apex_and_cut_off() {
        let strength = rock(30.0, 0.0, None, false);
        let (stress, _) = returned(&strength, [-1e6, -1.1e6, 0.0, -30e6]);
        assert!((stress[0] - stress[1]).abs() < 1e-3 && stress[3] < -3e6, "{stress:?}");
        let apex = 1e6 / 30f64.to_radians().tan();
        let (stress, _) = returned(&strength, [9e6, 8e6, 1e6, 7e6]);
        assert!([0, 1, 3].iter().all(|&k| (stress[k] - apex).abs() < 1e-3) && stress[2].abs() < 1e-3);
        let (stress, _) = returned(&rock(30.0, 0.0, Some(2e5), false), [9e6, -1e5, 0.0, 1e5]);
        assert!((stress[0] - 2e5).abs() < 1e-3, "{stress:?}");
    }

    /// Small reproducible numbers in 0..1.
    fn dice(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Any trial stress ends on the surface, a second return changes nothing, and energy is only ever taken.
    #[test]
    fn any_trial_stress_ends_on_the_surface() {
        let mut seed = 7;
        let mut yielded = 0;
        for case in 0..200_000 {
            let friction = 60.0 * dice(&mut seed) * f64::from(case % 5 != 0);
            let tension = (case % 3 == 0).then(|| 1e6 * dice(&mut seed));
            let plane_stress = case % 2 == 0;
            let strength = rock(friction, friction * dice(&mut seed), tension, plane_stress);
            let mut number = || (2.0 * dice(&mut seed) - 1.0) * 2e7;
            let (centre, own) = (number(), [number(), number(), number(), number()]);
            let trial = [own[0] + centre, own[1] + centre, own[2], own[3] + centre];
            let trial = if plane_stress { [trial[0], trial[1], trial[2], 0.0] } else { trial };
            let (stress, flow) = returned(&strength, trial);
            let surface = strength.surface(1.0);
            assert!(surface.excess(stress) <= 1e-9 * 6e7, "{strength:?} {trial:?} {stress:?}");
            assert!(surface.flow(stress).is_none(), "{strength:?} {trial:?} {stress:?}");
            assert!(double_dot(&stress, &flow) >= -1e-9 * 6e7 * equivalent_strain(&flow), "{trial:?} {flow:?}");
            yielded += u32::from(flow != [0.0; 4]);
        }
        assert!(yielded > 100_000, "{yielded}");
    }

    fn mass(gsi: f64, mi: f64, dilation: f64, tension: Option<f64>) -> (YieldingRock, Envelope) {
        let envelope = HoekBrown { sigma_ci: 30e6, mi, gsi, d: 0.0, associated: false }.envelope();
        let tension = tension.map(|share| share * envelope.tension());
        let criterion = Criterion::HoekBrown(hoek_brown::HoekBrown::new(envelope, dilation, tension));
        let elasticity = Elasticity::plane_strain(1e9, 0.3, 2500.0);
        (YieldingRock { elasticity, plane_stress: false, is_porous: false, criterion, weakness: None }, envelope)
    }

    /// Triaxial compression with the axis in the plane or out of it, and extension: at every confining pressure the
    /// largest pressure is that of the formula, to one part in a million.
    #[test]
    fn triaxial_points_are_those_of_hoek_and_brown() {
        for (gsi, mi) in [(5.0, 2.0), (45.0, 10.0), (80.0, 25.0), (100.0, 7.0)] {
            let (strength, envelope) = mass(gsi, mi, 0.0, None);
            for minor in [-0.5 * envelope.tension(), 0.0, 1e4, 3e5, 5e6, 60e6, 3e9] {
                let major = envelope.major(minor).unwrap();
                // Trial stresses from which flow without dilation leads to (−minor, −major).
                for beyond in [1e-3, 0.3, 20.0] {
                    let more = beyond * major;
                    let compression = [-minor + 2.0 * more, -major - 4.0 * more, -minor + 2.0 * more];
                    let extension = [-minor + 4.0 * more, -major - 2.0 * more, -major - 2.0 * more];
                    let middle = [-minor + more, -major - more, -0.4 * minor - 0.6 * major];
                    for [a, b, c] in [compression, extension, middle] {
                        for trial in [[a, b, 0.0, c], [a, c, 0.0, b], [b, c, 0.0, a]] {
                            let (stress, _) = returned(&strength, trial);
                            let sorted = Principal::of(stress, false).sorted;
                            let formula = envelope.major(-sorted[0]).unwrap();
                            assert!((sorted[2] / -formula - 1.0).abs() < 1e-6, "{gsi} {minor} {trial:?} {stress:?}");
                            let small = 1e-6 * (major + more);
                            assert!((sorted[0] + minor).abs() < small, "{gsi} {minor} {trial:?} {stress:?}");
                        }
                    }
                }
            }
        }
    }

    /// A reduced envelope has the same normal stress and a share of the shear strength on every plane: the circles of
    /// stresses on it touch τ(σ)/F.
    #[test]
    fn a_factor_acts_on_the_shear_strength_of_every_plane() {
        for factor in [0.3, 0.8, 1.0, 2.5] {
            let (strength, envelope) = mass(30.0, 8.0, 0.0, None);
            for k in 0..40 {
                let at = envelope.tangent(1e-3 * 1.3f64.powi(k));
                let centre = at.normal + factor * factor * at.shear * at.friction;
                let touching = (at.normal - centre).hypot(factor * at.shear);
                let trial = [3.0 * touching - centre, -3.0 * touching - centre, 0.0, -centre];
                let relief = strength.relief(&strength.surface(factor).flow(trial).unwrap());
                let radius = 3.0 * touching - 0.5 * (relief[0] - relief[1]);
                assert!((radius / touching - 1.0).abs() < 1e-9, "{factor} {k}: {radius} {touching}");
            }
        }
    }

    /// The same claims as for flat planes, for flow without dilation, with some, and associated flow, with and without
    /// a tensile strength below the end of the envelope, at several factors.
    #[test]
    fn any_trial_stress_ends_on_the_surface_of_hoek_and_brown() {
        let mut seed = 11;
        let mut yielded = 0;
        for case in 0..200_000 {
            let dilation = [0.0, dice(&mut seed), f64::INFINITY][case % 3];
            let tension = (case % 4 == 0).then(|| if case % 8 == 0 { 0.0 } else { dice(&mut seed) });
            let (gsi, mi) = (1.0 + 99.0 * dice(&mut seed), 1.0 + 49.0 * dice(&mut seed));
            let (strength, envelope) = mass(gsi, mi, dilation, tension);
            let factor = [1.0, 0.6, 3.0, 1000.0][case / 3 % 4];
            let size = 4.0 * (envelope.compression() + envelope.tension()) * libm::pow(10.0, 2.0 * dice(&mut seed));
            let mut number = || (2.0 * dice(&mut seed) - 1.0) * size;
            let (centre, own) = (number(), [number(), number(), number(), number()]);
            let trial = [own[0] + centre, own[1] + centre, own[2], own[3] + centre];
            let surface = strength.surface(factor);
            let flow = surface.flow(trial).unwrap_or_default();
            let relief = strength.relief(&flow);
            let stress = [0, 1, 2, 3].map(|k| trial[k] - relief[k]);
            let about = || format!("{gsi} {mi} {dilation} {tension:?} {factor} {trial:?} {stress:?}");
            assert!(surface.excess(stress) <= 1e-9 * size, "{}", about());
            assert!(surface.flow(stress).is_none(), "{}", about());
            assert!(double_dot(&stress, &flow) >= -1e-9 * size * equivalent_strain(&flow), "{}", about());
            yielded += u32::from(flow != [0.0; 4]);
        }
        assert!(yielded > 100_000, "{yielded}");
    }

    #[test]
    fn forces_are_minus_the_gradient_of_the_energy() {
        let gradients = [Vector::new(-1.0, -1.0), Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
        let (strength, plastic) = (rock(30.0, 0.0, None, false), [0.01, -0.02, 0.005, 0.003]);
        let u = [Vector::new(0.1, -0.2), Vector::new(-0.05, 0.3), Vector::new(0.2, 0.15)];
        let p = strength.taken_off(&Deformation::new(u, &gradients), &plastic, 0.0);
        let forces = gradients.map(|g| Vector::new(p[0] * g.x + p[1] * g.y, p[2] * g.x + p[3] * g.y));
        for k in 0..3 {
            for axis in 0..2 {
                let energy = |d: f64| {
                    let mut moved = u;
                    moved[k][axis] += d;
                    let at = Deformation::new(moved, &gradients);
                    strength.energy(&at, strength.own_volume(&at, &plastic), &[1e6, 2e6, 3e5, 0.0], &plastic)
                };
                let model = (energy(1e-6) - energy(-1e-6)) / 2e-6;
                assert!((model + forces[k][axis]).abs() < 1.0, "{model} {}", forces[k][axis]);
            }
        }
    }
}
