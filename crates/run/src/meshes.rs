//! Factors of safety on finer meshes of the same geometry, and the error of the mesh by them.

use serde_json::{Value, json};

/// A search on one mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct OnMesh {
    /// Mesh size (m).
    pub size: f64,
    /// Number of elements and of blocks; none where no model was built.
    pub counts: Option<[usize; 2]>,
    /// Greatest F that was stable and least that was not, where the factor was found.
    pub bracket: Option<[f64; 2]>,
    /// How the search ended.
    pub end: String,
}

impl OnMesh {
    /// The factor, where it was found.
    pub fn factor(&self) -> Option<f64> {
        self.bracket.map(|[low, high]| 0.5 * (low + high))
    }
}

/// Searches on meshes, from that of the case to the finest.
#[derive(Debug, Clone, PartialEq)]
pub struct Meshes {
    /// The searches.
    pub searches: Vec<OnMesh>,
    /// Whether the caller stopped them before the last.
    pub is_interrupted: bool,
}

impl Meshes {
    /// The factor at a mesh size of 0, on the straight line through the factors by least squares, and by how much the
    /// brackets leave it open; none with fewer than two factors.
    pub fn extrapolated(&self) -> Option<[f64; 2]> {
        let found: Vec<(f64, [f64; 2])> = self.searches.iter().filter_map(|on| Some((on.size, on.bracket?))).collect();
        let n = found.len() as f64;
        let middle = found.iter().map(|(size, _)| size).sum::<f64>() / n;
        let spread: f64 = found.iter().map(|(size, _)| (size - middle) * (size - middle)).sum();
        if found.len() < 2 {
            return None;
        }
        let weight = |size: f64| 1.0 / n - middle * (size - middle) / spread;
        let factor = found.iter().map(|(size, [low, high])| weight(*size) * 0.5 * (low + high)).sum();
        let half = found.iter().map(|(size, [low, high])| weight(*size).abs() * 0.5 * (high - low)).sum();
        Some([factor, half])
    }

    /// The error of the mesh of the case: its factor less the extrapolated one.
    pub fn error(&self) -> Option<f64> {
        Some(self.searches[0].factor()? - self.extrapolated()?[0])
    }

    /// As JSON.
    pub(crate) fn record(&self) -> Value {
        let on = |on: &OnMesh| {
            json!({
                "mesh_size": on.size,
                "elements": on.counts.map(|[elements, _]| elements),
                "blocks": on.counts.map(|[_, blocks]| blocks),
                "factor_of_safety": on.factor(),
                "bracket": on.bracket.map(|[stable, unstable]| json!({ "stable": stable, "unstable": unstable })),
                "status": on.end,
            })
        };
        let [factor, half] = self.extrapolated().map_or([None; 2], |both| both.map(Some));
        json!({
            "searches": self.searches.iter().map(on).collect::<Vec<_>>(),
            "extrapolated": factor,
            "extrapolated_within": half,
            "mesh_error": self.error(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meshes(factors: &[(f64, f64)]) -> Meshes {
        let on = |&(size, factor): &(f64, f64)| OnMesh {
            size,
            counts: None,
            bracket: factor.is_finite().then_some([factor - 0.01, factor + 0.01]),
            end: "found".to_owned(),
        };
        Meshes { searches: factors.iter().map(on).collect(), is_interrupted: false }
    }

    #[test]
    fn factors_on_a_line_are_extrapolated_to_its_start() {
        let line = |size: f64| (size, 1.2 + 0.05 * size);
        let three = meshes(&[line(2.0), line(2.0 / 2f64.sqrt()), line(1.0)]);
        let [factor, half] = three.extrapolated().expect("three factors");
        assert!((factor - 1.2).abs() < 1e-12 && (three.error().expect("an error") - 0.1).abs() < 1e-12);
        // Weights of two are −1 and 2: three half widths of 0.01.
        let [factor, two] = meshes(&[line(2.0), line(1.0)]).extrapolated().expect("two factors");
        assert!((factor - 1.2).abs() < 1e-12 && (two - 0.03).abs() < 1e-12 && half > 0.01);
    }

    #[test]
    fn one_factor_tells_nothing() {
        let one = meshes(&[(2.0, f64::NAN), (1.0, 1.3)]);
        assert_eq!((one.extrapolated(), one.error()), (None, None));
        let record = one.record();
        assert!(record["mesh_error"].is_null() && record["searches"][0]["factor_of_safety"].is_null());
    }
}
