//! Draws the plots of a problem.

use enmm::io::picture::{Chart, ChartSeries, Picture, chart_picture};

use crate::{Plot, Series};

/// The picture of a plot.
pub fn picture(plot: &Plot) -> Picture {
    let series = |s: &Series| ChartSeries { name: s.name.clone(), points: s.points.clone(), marks: s.marks };
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
