//! Curves into an SVG file. The first one is ours: red, thick, with its points marked.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// A named curve.
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// Its points from left to right.
    pub points: Vec<(f64, f64)>,
}

const SIZE: (u32, u32) = (900, 600);

/// With both axes logarithmic.
pub fn logarithmic(path: &Path, axes: [&str; 2], series: &[Series]) -> Result<()> {
    let Some([x, y]) = ranges(series) else { return Ok(()) };
    draw(path, axes, series, (x.0 * 0.9..x.1 * 1.1).log_scale(), (y.0 * 0.8..y.1 * 1.2).log_scale())
}

/// With a logarithmic horizontal axis and a vertical one of 0 to 100.
pub fn percent(path: &Path, axes: [&str; 2], series: &[Series]) -> Result<()> {
    let Some([x, _]) = ranges(series) else { return Ok(()) };
    draw(path, axes, series, (x.0 * 0.9..x.1 * 1.1).log_scale(), 0.0..100.0)
}

/// Least and greatest of both coordinates; `None` without points.
fn ranges(series: &[Series]) -> Option<[(f64, f64); 2]> {
    let points = || series.iter().flat_map(|series| series.points.iter().copied());
    points().next()?;
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)))
    };
    Some([range(&mut points().map(|point| point.0)), range(&mut points().map(|point| point.1))])
}

fn draw<X, Y>(path: &Path, [across, up]: [&str; 2], series: &[Series], x: X, y: Y) -> Result<()>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let failed = |error: &dyn std::fmt::Display| anyhow!("{}: {error}", path.display());
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE).map_err(|error| failed(&error))?;
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(x, y)
        .map_err(|error| failed(&error))?;
    let mesh = chart.configure_mesh().x_desc(across).y_desc(up).light_line_style(BLACK.mix(0.06)).draw();
    mesh.map_err(|error| failed(&error))?;
    for (index, one) in series.iter().enumerate() {
        let style = if index == 0 { RED.stroke_width(3) } else { Palette99::pick(index).stroke_width(1) };
        let line = chart.draw_series(LineSeries::new(one.points.iter().copied(), style)).map_err(|error| failed(&error))?;
        line.label(&one.name).legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], style));
        if index == 0 {
            let dots = one.points.iter().map(|&point| Circle::new(point, 4, RED.filled()));
            chart.draw_series(dots).map_err(|error| failed(&error))?;
        }
    }
    let legend = chart.configure_series_labels().background_style(WHITE.mix(0.9)).border_style(BLACK.mix(0.3)).draw();
    legend.map_err(|error| failed(&error))?;
    area.present().map_err(|error| failed(&error))
}
