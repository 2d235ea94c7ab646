//! A plane of weakness in rock that yields, such as foliation: a second surface beside that of the rock between the
//! planes, and the return of a trial stress to both (Eqs. 59b, 59c).

use enmm_lanes::{Arithmetic, Values};

use super::{Elasticity, PlasticStrain};

/// Rounds in which the flow of rock and plane take turns until both agree, and more by turns of what is left.
const ROUNDS_MAX: usize = 500;
const TURNS_MAX: usize = 200;
/// Halvings that find how much of a stress both hold.
const HALVINGS: usize = 60;
/// Change of the plane's stress in a round, relative to the stress that counts as on a surface, at which both agree.
const AGREED: f64 = 1e-3;
/// Ratios of changes, relative to their distance from one, that count as equal; and most ends taken in advance.
const ALIKE: f64 = 0.01;
const LEAPS_MAX: usize = 10;

/// Strength of a plane that runs through all points of a rock and turns with it.
#[doc(alias = "ubiquitous joint")]
#[doc(alias = "foliation")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weakness {
    /// Unit vector along its trace in the section.
    pub direction: [f64; 2],
    /// Tangent of the friction angle.
    pub friction: f64,
    /// Cohesion (Pa).
    pub cohesion: f64,
    /// Tangent of the dilation angle.
    pub dilation: f64,
    /// Tensile strength (Pa); `None` for the apex c/tan φ.
    pub tension: Option<f64>,
}

/// A plane of weakness with its strength times a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakPlane {
    direction: [f64; 2],
    friction: f64,
    cohesion: f64,
    dilation: f64,
    /// Tensile strength (Pa); infinite for a plane without friction and without a given value.
    pub tension: f64,
}

impl Weakness {
    /// The plane with its shear strength and the given tensile strength times a factor; ψ is at most the φ that is
    /// left.
    pub fn plane(&self, factor: f64) -> WeakPlane {
        let (friction, cohesion) = (self.friction * factor, self.cohesion * factor);
        let apex = if friction > 0.0 { cohesion / friction } else { f64::INFINITY };
        WeakPlane {
            direction: self.direction,
            friction,
            cohesion,
            dilation: self.dilation.min(friction),
            tension: self.tension.map_or(apex, |tension| (tension * factor).min(apex)),
        }
    }
}

impl WeakPlane {
    /// Normal and shear stress (Pa) on the plane under a stress xx, yy, xy.
    #[inline(always)]
    fn traction<F: Arithmetic>(&self, &[xx, yy, xy, _]: &[F; 4]) -> [F; 2] {
        let [c, s] = self.direction;
        let (cc, ss, cs) = (xx.splat(c * c), xx.splat(s * s), xx.splat(c * s));
        [ss * xx + cc * yy - (cs + cs) * xy, cs * (yy - xx) + (cc - ss) * xy]
    }

    /// Lanes in which a stress lies inside, up to a tolerance (Pa), as bits.
    #[inline(always)]
    pub fn inside<V: Values>(&self, values: V, stress: &[V::F; 4], tolerance: V::F) -> u8 {
        let [normal, shear] = self.traction(stress);
        let size = values.max(shear, values.splat(0.0) - shear);
        let beyond = size + normal * values.splat(self.friction) - values.splat(self.cohesion);
        let beyond = values.max(beyond, normal - values.splat(self.tension));
        values.at_most(beyond, tolerance)
    }

    /// How far (Pa) a stress lies beyond the plane's strength, as shear or normal stress; negative inside.
    pub fn beyond(&self, stress: &[f64; 4]) -> f64 {
        let [normal, shear] = self.traction(stress);
        (shear.abs() + normal * self.friction - self.cohesion).max(normal - self.tension)
    }

    /// Plastic strain xx, yy, xy, zz that brings a trial stress back to the plane's strength; none inside.
    fn flow(&self, rock: &Elasticity, trial: &[f64; 4], tolerance: f64) -> Option<PlasticStrain> {
        let beyond = self.beyond(trial);
        if beyond.is_nan() || beyond <= tolerance {
            return None;
        }
        let (stiff, mu) = (rock.lambda + 2.0 * rock.mu, rock.mu);
        let [normal, shear] = self.traction(trial);
        let slip =
            (shear.abs() + normal * self.friction - self.cohesion) / (mu + stiff * self.friction * self.dilation);
        let (left, pull) = (shear.abs() - mu * slip, normal - stiff * self.dilation * slip);
        // Strain normal to the plane and twice that along it, as a size.
        let [opens, slides] = match () {
            () if slip >= 0.0 && left >= 0.0 && pull <= self.tension => [self.dilation * slip, slip],
            () => {
                let most = (self.cohesion - self.friction * self.tension).max(0.0);
                [((normal - self.tension) / stiff).max(0.0), ((shear.abs() - most) / mu).max(0.0)]
            }
        };
        let [c, s] = self.direction;
        let along = 0.5 * slides * shear.signum();
        Some([
            opens * s * s - 2.0 * along * s * c,
            opens * c * c + 2.0 * along * s * c,
            along * (c * c - s * s) - opens * s * c,
            0.0,
        ])
    }
}

/// A trial stress (Pa) beyond the surface of the rock, that of the plane, or both.
pub struct Both<'a> {
    /// The plane.
    pub plane: &'a WeakPlane,
    /// Elastic constants in the plane of the section.
    pub elasticity: &'a Elasticity,
    /// Whether there is no stress out of the plane.
    pub plane_stress: bool,
    /// Plastic strain that brings a stress back to the surface of the rock; none inside.
    pub rock: &'a dyn Fn(&[f64; 4]) -> Option<PlasticStrain>,
    /// Stress (Pa) that a plastic strain takes off.
    pub relief: &'a dyn Fn(&PlasticStrain) -> [f64; 4],
    /// Stress (Pa) beyond the plane's strength that still counts as on it, by the stress.
    pub tolerance: &'a dyn Fn(&[f64; 4]) -> f64,
}

impl Both<'_> {
    fn of_plane(&self, stress: &[f64; 4]) -> Option<PlasticStrain> {
        self.plane.flow(self.elasticity, stress, (self.tolerance)(stress))
    }

    fn less(&self, stress: &[f64; 4], flow: &PlasticStrain) -> [f64; 4] {
        let relief = (self.relief)(flow);
        [0, 1, 2, 3].map(|k| stress[k] - relief[k])
    }

    /// Plastic strain that brings a trial stress back to both surfaces; none inside of both. Each surface flows from
    /// the trial stress less what the other takes off it, in turns until neither changes (Eq. 59c).
    pub fn flow(&self, trial: &[f64; 4]) -> Option<PlasticStrain> {
        let (rock, plane) = ((self.rock)(trial), self.of_plane(trial));
        if rock.is_none() && plane.is_none() {
            return None;
        }
        let mut plane = if rock.is_none() { plane.unwrap_or_default() } else { [0.0; 4] };
        let mut rock = [0.0; 4];
        let (agreed, mut changes) = (AGREED * (self.tolerance)(trial), Changes::default());
        for _ in 0..ROUNDS_MAX {
            rock = (self.rock)(&self.less(trial, &plane)).unwrap_or_default();
            let next = self.of_plane(&self.less(trial, &rock)).unwrap_or_default();
            let change = [0, 1, 2, 3].map(|k| next[k] - plane[k]);
            let moved = greatest(&(self.relief)(&change));
            plane = next;
            if moved <= agreed {
                break;
            }
            // A leap that takes off more than there is belongs to flows of both surfaces that undo each other.
            let ahead = changes.ahead(plane, change);
            if greatest(&(self.relief)(&ahead)) <= greatest(&self.less(trial, &rock)) {
                plane = ahead;
            }
        }
        Some(self.rest(trial, sum(&rock, &plane)))
    }

    /// The same flow with what still lies beyond one of the surfaces, taken off by turns, or in proportion where turns
    /// without normality go round in circles.
    fn rest(&self, trial: &[f64; 4], mut flow: PlasticStrain) -> PlasticStrain {
        let beyond = |stress: &[f64; 4]| (self.rock)(stress).or_else(|| self.of_plane(stress));
        for _ in 0..TURNS_MAX {
            let Some(more) = beyond(&self.less(trial, &flow)) else { return flow };
            flow = sum(&flow, &more);
        }
        let stress = self.less(trial, &flow);
        let (mut held, mut too_much) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let half = 0.5 * (held + too_much);
            *if beyond(&stress.map(|s| half * s)).is_none() { &mut held } else { &mut too_much } = half;
        }
        sum(&flow, &self.strain(&stress.map(|s| (1.0 - held) * s)))
    }

    /// The strain that takes off a stress.
    fn strain(&self, &[xx, yy, xy, zz]: &[f64; 4]) -> PlasticStrain {
        let Elasticity { lambda, mu, .. } = *self.elasticity;
        let zz = if self.plane_stress { 0.0 } else { zz };
        let axes = if self.plane_stress { 2.0 } else { 3.0 };
        let volume = lambda * (xx + yy + zz) / (2.0 * mu + axes * lambda);
        let out = if self.plane_stress { 0.0 } else { 0.5 * (zz - volume) / mu };
        [0.5 * (xx - volume) / mu, 0.5 * (yy - volume) / mu, 0.5 * xy / mu, out]
    }
}

/// Changes of the plane's flow from round to round.
#[derive(Default)]
struct Changes {
    last: Option<[f64; 4]>,
    ratio: Option<f64>,
    /// How often their end was taken in advance.
    leaps: usize,
}

impl Changes {
    /// The plane's flow after a change, or its end where changes shrink alike (A. C. Aitken 1926).
    fn ahead(&mut self, plane: PlasticStrain, change: [f64; 4]) -> PlasticStrain {
        let dot = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let ratio = self.last.replace(change).map(|last| dot(&change, &last) / dot(&last, &last));
        let before = std::mem::replace(&mut self.ratio, ratio);
        let alike = |(ratio, before): &(f64, f64)| (ratio - before).abs() <= ALIKE * (1.0 - ratio);
        match ratio.zip(before).filter(alike) {
            Some((ratio, _)) if ratio > 0.0 && self.leaps < LEAPS_MAX => {
                *self = Self { leaps: self.leaps + 1, ..Self::default() };
                [0, 1, 2, 3].map(|k| plane[k] + change[k] * (ratio / (1.0 - ratio)))
            }
            _ => plane,
        }
    }
}

/// Size of the greatest part of a stress.
fn greatest(stress: &[f64; 4]) -> f64 {
    stress.iter().fold(0.0, |most, part| most.max(part.abs()))
}

fn sum(a: &PlasticStrain, b: &PlasticStrain) -> PlasticStrain {
    [0, 1, 2, 3].map(|k| a[k] + b[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rock::{Criterion, MohrCoulomb, YieldingRock};

    /// Small reproducible numbers in 0..1.
    fn dice(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Rock with a plane of weakness: degrees of friction, cohesion (Pa), share of the friction that dilates, for the
    /// rock and for the plane at an angle (rad).
    fn rock(rock: [f64; 3], plane: [f64; 3], angle: f64, tension: Option<f64>, plane_stress: bool) -> YieldingRock {
        let elasticity = match plane_stress {
            true => Elasticity::plane_stress(1e9, 0.3, 2500.0),
            false => Elasticity::plane_strain(1e9, 0.3, 2500.0),
        };
        let tangent = |degrees: f64| libm::tan(degrees.to_radians());
        let [friction, cohesion, share] = rock;
        let friction = tangent(friction);
        let criterion = MohrCoulomb { friction, cohesion, dilation: share * friction, tension: None };
        let [along, held, share] = plane;
        let (sin, cos) = libm::sincos(angle);
        let friction = tangent(along);
        let direction = [cos, sin];
        let weakness = Weakness { direction, friction, cohesion: held, dilation: share * friction, tension };
        let (criterion, weakness) = (Criterion::MohrCoulomb(criterion), Some(weakness));
        YieldingRock { elasticity, plane_stress, is_porous: false, criterion, weakness }
    }

    /// C·ε of plane strain or plane stress, by Hooke's law.
    fn hooke(rock: &YieldingRock, &[xx, yy, xy, zz]: &[f64; 4]) -> [f64; 4] {
        let (lambda, mu) = (rock.elasticity.lambda, rock.elasticity.mu);
        let zz = if rock.plane_stress { 0.0 } else { zz };
        let bulk = lambda * (xx + yy + zz);
        let out = if rock.plane_stress { 0.0 } else { 2.0 * mu * zz + bulk };
        [2.0 * mu * xx + bulk, 2.0 * mu * yy + bulk, 2.0 * mu * xy, out]
    }

    fn work(a: &[f64; 4], b: &[f64; 4]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2] + a[3] * b[3]
    }

    /// Any trial stress ends within the strength of rock and plane, a second return changes nothing, and energy is
    /// only ever taken.
    #[test]
    fn any_trial_stress_ends_on_both_surfaces() {
        let mut seed = 5;
        let (mut yielded, mut both) = (0, 0);
        for case in 0..60_000 {
            let mut number = || dice(&mut seed);
            let strength = rock(
                [50.0 * number(), 2e5 + 3e6 * number(), number()],
                [45.0 * number(), 1e6 * number(), number()],
                std::f64::consts::PI * number(),
                (case % 3 == 0).then_some(0.0),
                case % 2 == 0,
            );
            let mut number = || (2.0 * number() - 1.0) * 2e7;
            let (centre, own) = (number(), [number(), number(), number(), number()]);
            let zz = if strength.plane_stress { 0.0 } else { own[3] + centre };
            let trial = [own[0] + centre, own[1] + centre, own[2], zz];
            let surface = strength.surface(1.0);
            let flow = surface.flow(trial).unwrap_or_default();
            let relief = hooke(&strength, &flow);
            let stress = [0, 1, 2, 3].map(|k| trial[k] - relief[k]);
            assert!(surface.excess(stress) <= 1e-9 * 6e7, "{strength:?} {trial:?} {stress:?}");
            assert!(surface.flow(stress).is_none(), "{strength:?} {trial:?} {stress:?}");
            let most = flow.iter().fold(0.0f64, |most, part| most.max(part.abs()));
            assert!(most < 0.3 && work(&stress, &flow) >= -1e-9 * 6e7 * most, "{strength:?} {trial:?} {flow:?}");
            yielded += u32::from(flow != [0.0; 4]);
            let plane = strength.weakness.map(|weakness| weakness.plane(1.0));
            let alone = YieldingRock { weakness: None, ..strength }.surface(1.0);
            let on = |excess: f64| excess.abs() < 1e-6 * 2e7;
            both += u32::from(plane.is_some_and(|plane| on(plane.beyond(&stress))) && on(alone.excess(stress)));
        }
        assert!(yielded > 30_000 && both > 3_000, "{yielded} {both}");
    }

    /// Flow by normality takes the most energy that any stress within the strength could take (R. Hill 1948).
    #[test]
    fn flow_by_normality_takes_the_most_energy() {
        let mut seed = 9;
        for _ in 0..300 {
            let mut number = || dice(&mut seed);
            let own = [40.0 * number(), 3e5 + 2e6 * number(), 1.0];
            let along = [35.0 * number(), 5e5 * number(), 1.0];
            let strength = rock(own, along, std::f64::consts::PI * number(), None, false);
            let surface = strength.surface(1.0);
            let mut stress = |size: f64| [0; 4].map(|_| (2.0 * number() - 1.2) * size);
            let trial = stress(2e7);
            let flow = surface.flow(trial).unwrap_or_default();
            let relief = hooke(&strength, &flow);
            let end = [0, 1, 2, 3].map(|k| trial[k] - relief[k]);
            for _ in 0..300 {
                let other = stress(1e7);
                if surface.excess(other) <= 0.0 {
                    let less = work(&end, &flow) - work(&other, &flow);
                    assert!(less >= -1e-7 * 2e7 * 0.02, "{trial:?} {end:?} {other:?}: {less}");
                }
            }
        }
    }

    /// A plane along x in strong rock slips by what its shear stress is too much, and opens by its dilation angle.
    #[test]
    fn the_closed_form_of_a_plane_alone_is_met() {
        let strength = rock([0.0, 1e12, 0.0], [30.0, 1e5, 0.5], 0.0, None, false);
        let trial = [-1e6, -2e6, 3e6, -1.5e6];
        let flow = strength.surface(1.0).flow(trial).unwrap_or_default();
        let (mu, stiff) = (strength.elasticity.mu, strength.elasticity.lambda + 2.0 * strength.elasticity.mu);
        let (friction, dilation) = (30f64.to_radians().tan(), 0.5 * 30f64.to_radians().tan());
        let slip = (3e6 - 2e6 * friction - 1e5) / (mu + stiff * friction * dilation);
        let expected = [0.0, dilation * slip, 0.5 * slip, 0.0];
        assert!((0..4).all(|k| (flow[k] - expected[k]).abs() < 1e-12), "{flow:?} {expected:?}");
    }
}
