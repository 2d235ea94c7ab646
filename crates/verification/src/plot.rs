//! Draws the plots of a problem.

use enmm_picture::{Chart, ChartSeries, Picture, chart_picture};

use crate::{Plot, Series};

/// Most points of a series that are drawn.
const POINTS_MAX: usize = 300;

/// The picture of a plot; a series of more points than can be distinguished is thinned.
pub fn picture(plot: &Plot) -> Picture {
    let points = |s: &Series| if s.marks { spread(&s.points) } else { outlined(&s.points) };
    let series = |s: &Series| ChartSeries { name: s.name.clone(), points: points(s), marks: s.marks };
    chart_picture(&Chart {
        title: plot.title.clone(),
        axes: plot.axes.clone(),
        logarithmic: plot.logarithmic,
        series: plot.series.iter().map(series).collect(),
    })
}

/// Name of the file of plot `k` (from 0) of a problem.
pub fn file_name(id: &str, k: usize) -> String {
    format!("{}-{}.svg", id.to_lowercase(), k + 1)
}

/// Points at even distances in their order, the first and the last among them.
fn spread(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= POINTS_MAX {
        return points.to_vec();
    }
    (0..POINTS_MAX).map(|k| points[k * (points.len() - 1) / (POINTS_MAX - 1)]).collect()
}

/// The ends of a line, and the lowest and the highest point of each of as many runs as fit, so that no peak is lost.
fn outlined(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let [first, inner @ .., last] = points else { return points.to_vec() };
    if points.len() <= POINTS_MAX {
        return points.to_vec();
    }
    let runs = POINTS_MAX / 2 - 1;
    let by_height = |a: &&(usize, &[f64; 2]), b: &&(usize, &[f64; 2])| a.1[1].total_cmp(&b.1[1]);
    let mut thin = vec![*first];
    for k in 0..runs {
        let [from, to] = [k, k + 1].map(|k| k * inner.len() / runs);
        let run: Vec<(usize, &[f64; 2])> = inner[from..to].iter().enumerate().collect();
        let mut kept: Vec<_> = run.iter().min_by(by_height).into_iter().chain(run.iter().max_by(by_height)).collect();
        kept.sort_by_key(|(place, _)| *place);
        kept.dedup();
        thin.extend(kept.into_iter().map(|(_, point)| **point));
    }
    thin.push(*last);
    thin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_peaks_and_leaves_short_series_alone() {
        let wave = |count: usize| -> Vec<[f64; 2]> {
            (0..count).map(|k| [k as f64, if k == count / 3 { 9.0 } else { (k as f64).sin() }]).collect()
        };
        for thin in [spread, outlined] {
            assert_eq!(thin(&wave(POINTS_MAX)), wave(POINTS_MAX));
            let (many, few) = (wave(10_000), thin(&wave(10_000)));
            assert!(few.len() <= POINTS_MAX && few.len() > POINTS_MAX / 2, "{}", few.len());
            assert_eq!([few[0], few[few.len() - 1]], [many[0], many[many.len() - 1]]);
            assert!(few.is_sorted_by(|a, b| a[0] < b[0]));
        }
        let heights =
            |points: &[[f64; 2]]| points.iter().map(|p| p[1]).fold([0.0f64; 2], |[a, b], y| [a.min(y), b.max(y)]);
        assert_eq!(heights(&outlined(&wave(10_000))), heights(&wave(10_000)));
    }
}
