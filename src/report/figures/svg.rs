//! Draws figures as SVG.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Chart, Figure, Panel, Sketch, tick};

/// Width of a figure in pixels.
const WIDTH: u32 = 960;
/// Height of a chart in pixels.
const CHART_HEIGHT: u32 = 330;
/// Width of the legend of a chart in pixels.
const LEGEND_WIDTH: u32 = 138;
/// Height of a level of a hierarchy in pixels.
const LEVEL_HEIGHT: u32 = 54;
/// Height of the title in pixels.
const TITLE_HEIGHT: u32 = 34;
/// Most characters in a line of the provenance.
const PROVENANCE_CHARACTERS: usize = 150;
const FONT: &str = "sans-serif";

/// Colours that colour-blind people can tell apart (M. Okabe and K. Ito), dark ones first.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
    RGBColor(150, 150, 150),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn = Result<(), String>;

/// Draws the figure, with up to two panels in a row.
pub(super) fn draw(figure: &Figure) -> Result<String, String> {
    if figure.panels.is_empty() {
        return Err(String::from("it has no panels"));
    }
    let per_row = if figure.panels.len() == 1 { 1 } else { 2 };
    let rows: Vec<_> = figure.panels.chunks(per_row).collect();
    let heights: Vec<_> = rows
        .iter()
        .map(|row| row.iter().map(height).max().unwrap_or(0))
        .collect();
    let provenance = wrapped(&figure.provenance);
    let foot = 10 + 14 * provenance.len() as u32;
    let total = TITLE_HEIGHT + heights.iter().sum::<u32>() + foot;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, total)).into_drawing_area();
        root.fill(&WHITE).map_err(words)?;
        let title = figure.full_title();
        put(&root, &title, (WIDTH as i32 / 2, 8), 18, HPos::Center)?;
        let mut top = TITLE_HEIGHT;
        for (row, height) in rows.iter().zip(&heights) {
            let area = root.clone().shrink((0, top), (WIDTH, *height));
            for (cell, panel) in area.split_evenly((1, per_row)).iter().zip(*row) {
                match panel {
                    Panel::Chart(chart) => draw_chart(cell, chart)?,
                    Panel::Tree(sketch) => draw_sketch(cell, sketch)?,
                }
            }
            top += height;
        }
        for (index, line) in provenance.iter().enumerate() {
            let y = top as i32 + 4 + 14 * index as i32;
            put(&root, line, (10, y), 11, HPos::Left)?;
        }
        root.present().map_err(words)?;
    }
    Ok(text)
}

fn height(panel: &Panel) -> u32 {
    match panel {
        Panel::Chart(_) => CHART_HEIGHT,
        Panel::Tree(sketch) => 30 + LEVEL_HEIGHT * sketch.rows() as u32,
    }
}

fn draw_chart(area: &Area<'_>, chart: &Chart) -> Drawn {
    let Some([(left, right), (bottom, top)]) = chart.ranges() else {
        return put(
            area,
            &format!("{}: no data", chart.title),
            (20, 20),
            14,
            HPos::Left,
        );
    };
    let margin = 0.04 * (top - bottom);
    // The legend is beside the lines, so that it hides none of them.
    let (width, _) = area.dim_in_pixel();
    let (lines, legend) = area.split_horizontally(width.saturating_sub(LEGEND_WIDTH));
    let mut context = ChartBuilder::on(&lines)
        .caption(&chart.title, (FONT, 14))
        .margin(8)
        .margin_right(14)
        .x_label_area_size(36)
        .y_label_area_size(54)
        .build_cartesian_2d(left..right, bottom - margin..top + margin)
        .map_err(words)?;
    context
        .configure_mesh()
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .x_labels(8)
        .y_labels(7)
        .x_label_formatter(&|value| tick(*value))
        .y_label_formatter(&|value| tick(*value))
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .label_style((FONT, 11))
        .axis_desc_style((FONT, 12))
        .draw()
        .map_err(words)?;
    for (index, series) in chart.series.iter().enumerate() {
        let colour = COLOURS[series.mark % COLOURS.len()];
        if !series.band.is_empty() {
            let lower = series.band.iter().map(|&(x, low, _)| (x, low));
            let upper = series.band.iter().rev().map(|&(x, _, high)| (x, high));
            let band = Polygon::new(lower.chain(upper).collect::<Vec<_>>(), colour.mix(0.2));
            context.draw_series([band]).map_err(words)?;
        }
        let style = colour.stroke_width(2);
        context
            .draw_series(LineSeries::new(series.points.iter().copied(), style))
            .map_err(words)?;
        let y = 44 + 16 * index as i32;
        let sample = [(0, y), (14, y)];
        legend
            .draw(&PathElement::new(sample, style))
            .map_err(words)?;
        put(&legend, &series.name, (18, y - 6), 11, HPos::Left)?;
    }
    Ok(())
}

/// Draws a hierarchy. Composite subtasks have a box, primitive subtasks have none.
fn draw_sketch(area: &Area<'_>, sketch: &Sketch) -> Drawn {
    let (width, _) = area.dim_in_pixel();
    put(
        area,
        &sketch.caption,
        (width as i32 / 2, 4),
        14,
        HPos::Center,
    )?;
    let step = f64::from(width - 16) / sketch.columns();
    // Names must fit between neighbours. A letter is about 0.6 font sizes wide.
    let size = (step / (14.0 * 0.6)).clamp(5.0, 12.0);
    let place = |index: usize| {
        let node = &sketch.nodes[index];
        let x = 8.0 + (node.column + 0.5) * step;
        let y = 40 + LEVEL_HEIGHT as i32 * node.row as i32;
        (x.round() as i32, y)
    };
    for (index, node) in sketch.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            let [from, to] = [place(parent), place(index)];
            let line = [(from.0, from.1 + 9), (to.0, to.1 - 9)];
            area.draw(&PathElement::new(line, BLACK.mix(0.5)))
                .map_err(words)?;
        }
    }
    for (index, node) in sketch.nodes.iter().enumerate() {
        let (x, y) = place(index);
        if node.composite {
            let half = (node.name.len() as f64 * size * 0.31 + 4.0) as i32;
            let corners = [(x - half, y - 9), (x + half, y + 9)];
            area.draw(&Rectangle::new(corners, WHITE.filled()))
                .map_err(words)?;
            area.draw(&Rectangle::new(corners, COLOURS[0].stroke_width(1)))
                .map_err(words)?;
        }
        let style = (FONT, size)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Center, VPos::Center));
        area.draw(&Text::new(node.name.to_owned(), (x, y), style))
            .map_err(words)?;
    }
    Ok(())
}

fn put(area: &Area<'_>, text: &str, at: (i32, i32), size: i32, align: HPos) -> Drawn {
    let style = (FONT, size)
        .into_font()
        .color(&BLACK)
        .pos(Pos::new(align, VPos::Top));
    area.draw(&Text::new(text.to_owned(), at, style))
        .map_err(words)
}

/// Breaks a text into lines, between words.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last().map_or(0, String::len);
        if last > 0 && last + word.len() > PROVENANCE_CHARACTERS {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

fn words(error: impl std::fmt::Display) -> String {
    error.to_string()
}
