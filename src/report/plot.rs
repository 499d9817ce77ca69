//! Plots as SVG: curves over a logarithmic cost, with levels drawn across.
//!
//! ```text
//! legend, a line of keys each
//! +---------------------------+  labels of the
//! | panel                     |  levels across
//! +---------------------------+
//! ```
//!
//! No crate draws it: plotters, which would, leaves a logarithmic axis without
//! ticks below its first power of ten, and has had no release since 2024.

mod svg;

use svg::{Anchor, Canvas};
pub(super) use svg::{Marker, Style};

const WIDTH: f64 = 1000.0;
/// A panel with its title and the labels of its axes.
const PANEL: f64 = 500.0;
const LEGEND_LINE: f64 = 22.0;
/// From a panel's sides to its plane: left, right, top, bottom. Labels of
/// levels lie to the right.
const AROUND: [f64; 4] = [62.0, 280.0, 34.0, 56.0];
/// Labels are at least so many pixels apart.
const APART: f64 = 15.0;
/// No font is measured: about so wide is a letter.
const LETTER: f64 = 6.6;

/// Points that are joined.
pub(super) struct Curve {
    pub points: Vec<(f64, f64)>,
    pub style: Style,
}

/// A line across a panel.
pub(super) struct Across {
    pub y: f64,
    pub label: String,
    pub style: Style,
}

/// A word at a point.
pub(super) struct Note {
    pub at: (f64, f64),
    pub text: String,
}

/// Curves over one pair of axes.
pub(super) struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub curves: Vec<Curve>,
    pub across: Vec<Across>,
    pub notes: Vec<Note>,
}

/// A figure: what its styles mean, and its panels, one below the other.
pub(super) struct Figure {
    pub legend: Vec<Vec<(String, Style)>>,
    pub panels: Vec<Panel>,
}

impl Figure {
    /// Draws it. Equal figures are equal bytes.
    pub fn svg(&self) -> String {
        let legend = LEGEND_LINE * self.legend.len() as f64 + 14.0;
        let height = legend + PANEL * self.panels.len() as f64;
        let mut out = Canvas::new([WIDTH, height]);
        for (line, keys) in self.legend.iter().enumerate() {
            let y = 16.0 + LEGEND_LINE * line as f64;
            let mut x = AROUND[0];
            for (label, style) in keys {
                out.line(&[(x, y), (x + 34.0, y)], *style);
                out.mark((x + 17.0, y), *style);
                out.text((x + 42.0, y), Anchor::Start, label);
                x += 72.0 + LETTER * label.chars().count() as f64;
            }
        }
        for (at, panel) in self.panels.iter().enumerate() {
            panel.draw(legend + PANEL * at as f64, &mut out);
        }
        out.finish()
    }
}

/// Where the points of a panel lie.
struct Plane {
    x: [f64; 2],
    y: [f64; 2],
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Plane {
    fn x(&self, x: f64) -> f64 {
        let share = (x / self.x[0]).ln() / (self.x[1] / self.x[0]).ln();
        self.left + share * (self.right - self.left)
    }

    fn y(&self, y: f64) -> f64 {
        let share = (y - self.y[0]) / (self.y[1] - self.y[0]);
        self.bottom + share * (self.top - self.bottom)
    }

    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x(x), self.y(y))
    }
}

impl Panel {
    fn draw(&self, top: f64, out: &mut Canvas) {
        let [x, y] = self.ranges();
        let plane = Plane {
            x,
            y,
            left: AROUND[0],
            right: WIDTH - AROUND[1],
            top: top + AROUND[2],
            bottom: top + PANEL - AROUND[3],
        };
        self.draw_axes(&plane, out);
        for across in &self.across {
            let y = plane.y(across.y);
            out.line(&[(plane.left, y), (plane.right, y)], across.style);
        }
        for Curve { points, style } in &self.curves {
            let points: Vec<(f64, f64)> = points.iter().map(|&at| plane.at(at)).collect();
            out.line(&points, *style);
            points.iter().for_each(|&at| out.mark(at, *style));
        }
        self.draw_notes(&plane, out);
        self.draw_labels(&plane, out);
    }

    fn draw_axes(&self, plane: &Plane, out: &mut Canvas) {
        let middle = f64::midpoint(plane.left, plane.right);
        for x in round_numbers(plane.x) {
            let at = plane.x(x);
            out.line(&[(at, plane.top), (at, plane.bottom)], GRID);
            out.text((at, plane.bottom + 14.0), Anchor::Middle, &x.to_string());
        }
        for y in plane.y[0].ceil() as i64..=plane.y[1].floor() as i64 {
            let at = plane.y(y as f64);
            out.line(&[(plane.left, at), (plane.right, at)], GRID);
            out.text((plane.left - 8.0, at), Anchor::End, &y.to_string());
        }
        let corner = (plane.left, plane.bottom);
        out.line(
            &[(plane.left, plane.top), corner, (plane.right, plane.bottom)],
            AXIS,
        );
        out.text((middle, plane.top - 16.0), Anchor::Middle, &self.title);
        out.text((middle, plane.bottom + 34.0), Anchor::Middle, &self.x_label);
        out.text((8.0, plane.top - 16.0), Anchor::Start, &self.y_label);
    }

    /// Words below their points, lower where others are already.
    fn draw_notes(&self, plane: &Plane, out: &mut Canvas) {
        let mut taken: Vec<(f64, f64)> = Vec::new();
        for Note { at, text } in &self.notes {
            let (x, y) = plane.at(*at);
            let mut y = y + APART;
            let covers = |y: f64, other: &(f64, f64)| {
                (other.0 - x).abs() < 5.0 * LETTER && (other.1 - y).abs() < APART - 2.0
            };
            while taken.iter().any(|other| covers(y, other)) {
                y += APART - 2.0;
            }
            taken.push((x, y));
            out.text((x, y), Anchor::Middle, text);
        }
    }

    /// Labels beside the panel, spread so that none covers another, and what
    /// leads to them.
    fn draw_labels(&self, plane: &Plane, out: &mut Canvas) {
        let mut across: Vec<&Across> = self.across.iter().collect();
        across.sort_by(|a, b| b.y.total_cmp(&a.y));
        let mut free = f64::NEG_INFINITY;
        for own in across {
            let y = plane.y(own.y);
            let at = y.max(free);
            free = at + APART;
            let lead = Style {
                dash: None,
                stroke_px: 1,
                ..own.style
            };
            out.line(&[(plane.right, y), (plane.right + 12.0, at)], lead);
            out.text((plane.right + 16.0, at), Anchor::Start, &own.label);
        }
    }

    /// Least and largest x and y of everything, with some room.
    fn ranges(&self) -> [[f64; 2]; 2] {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let x = extent(points().map(|point| point.0));
        let across = self.across.iter().map(|own| own.y);
        let y = extent(points().map(|point| point.1).chain(across));
        let room = ((y[1] - y[0]) / 20.0).max(0.5);
        [[x[0] / 1.2, x[1] * 1.2], [y[0] - room, y[1] + room]]
    }
}

/// The range of finite numbers, never empty.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    let range = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |range, value| {
        [range[0].min(value), range[1].max(value)]
    });
    if range[0] <= range[1] {
        range
    } else {
        [1.0, 2.0]
    }
}

/// 1, 2 and 5 times powers of ten within a range.
fn round_numbers(range: [f64; 2]) -> Vec<f64> {
    let decades = range[0].log10().floor() as i32..=range[1].log10().ceil() as i32;
    let numbers = decades.flat_map(|decade| {
        // Divided, so that 0.2 is shown as that.
        let power = 10f64.powi(decade.abs());
        [1.0, 2.0, 5.0].map(|of| if decade < 0 { of / power } else { of * power })
    });
    numbers
        .filter(|number| (range[0]..=range[1]).contains(number))
        .collect()
}

const GRID: Style = Style {
    colour: [222; 3],
    dash: None,
    marker: Marker::None,
    stroke_px: 1,
};
const AXIS: Style = Style {
    colour: [0; 3],
    ..GRID
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(round_numbers([0.15, 12.0]), [0.2, 0.5, 1.0, 2.0, 5.0, 10.0]);
        assert_eq!(round_numbers([1.0, 2.0]), [1.0, 2.0]);
    }

    #[test]
    fn names_cannot_break_out_and_labels_do_not_touch() {
        let across = |y: f64| Across {
            y,
            label: format!("<at & {y}>"),
            style: AXIS,
        };
        let note = |x: f64| Note {
            at: (x, 29.9),
            text: "note".into(),
        };
        let panel = Panel {
            title: "a<b".into(),
            x_label: String::new(),
            y_label: String::new(),
            curves: Vec::new(),
            across: vec![across(30.0), across(30.01)],
            notes: [1.5, 1.51, 1.52].map(note).into(),
        };
        let figure = Figure {
            legend: Vec::new(),
            panels: vec![panel],
        };
        let svg = figure.svg();
        assert!(
            svg.contains("a&lt;b") && svg.contains("&lt;at &amp; 30&gt;"),
            "{svg}"
        );
        let heights = |of: &str| -> Vec<f64> {
            let lines = svg
                .lines()
                .filter(|line| line.contains(of) && !line.contains("stroke"));
            let height = lines.map(|line| line.split('"').nth(3).unwrap().parse().unwrap());
            height.collect()
        };
        for heights in [heights("&lt;at"), heights("note")] {
            let apart = heights.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(apart.into_iter().all(|apart| apart >= 12.9), "{heights:?}");
        }
    }
}
