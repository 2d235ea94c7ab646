//! How large triangles are: small where the mechanism of a coarser mesh shears the rock.

use enmm::geometry::Point;

use super::ground::Patch;
use super::mesh::Mesh;

/// Density of triangles in rock that does not shear, over the mean that shear adds.
const FLOOR: f64 = 0.1;
/// Least area of triangles for stress, over the mean: about a point stress turns as much far from it as close to it.
const LEAST: f64 = 0.3;
/// Mean rate of shear, over the greatest speed and the size of the rock, that counts as none: blocks move as rigid
/// ones.
const RIGID: f64 = 1e-4;

/// Areas (m²) of triangles, up to a factor, by position.
#[derive(Debug, Clone)]
pub struct Sizes(Vec<(Point, f64)>);

impl Sizes {
    /// The same everywhere: of all the rock.
    pub fn even(area: f64) -> Self {
        Self(vec![(Point::zeros(), area)])
    }

    /// Density of triangles in proportion to the rate of shear, with a floor; none where nothing shears for the
    /// greatest `speed`.
    pub fn of_shear(mesh: &Mesh, patches: &[Patch], shear: &[f64], speed: f64) -> Option<Self> {
        let total: f64 = patches.iter().map(Patch::area).sum();
        let mean = patches.iter().zip(shear).map(|(patch, shear)| patch.area() * shear).sum::<f64>() / total;
        if mean.is_nan() || mean <= RIGID * speed / total.sqrt() {
            return None;
        }
        let size = |t: usize| (mesh.centroid(t), 1.0 / (FLOOR + shear[t] / mean));
        let unit = (1.0 + FLOOR) * (0..patches.len()).map(|t| mesh.area(t)).sum::<f64>();
        Some(Self((0..patches.len()).map(size).map(|(at, size)| (at, size * unit)).collect()))
    }

    /// For stress, which varies over more of the rock than shear does: more even.
    pub fn for_stress(&self) -> Self {
        let unit = self.0.iter().map(|(_, area)| area).sum::<f64>() / self.0.len() as f64;
        Self(self.0.iter().map(|(at, area)| (*at, unit * libm::sqrt(area / unit).max(LEAST))).collect())
    }

    /// Area (m²) at a position.
    pub fn at(&self, p: Point) -> f64 {
        let distance = |(at, _): &(Point, f64)| (at - p).norm_squared();
        self.0.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(f64::INFINITY, |(_, area)| *area)
    }
}
