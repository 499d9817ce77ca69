//! SVG elements, one a line: lines, markers, text with a white rim that keeps
//! it apart from what it lies on.

use std::fmt::Write;

/// What a point is marked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::report) enum Marker {
    None,
    Circle,
    Square,
    Triangle,
    Cross,
}

/// How a curve looks.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) struct Style {
    pub colour: [u8; 3],
    /// Pixels of a dash and of the gap behind it; `None` is a whole line.
    pub dash: Option<[u32; 2]>,
    pub marker: Marker,
    pub stroke_px: u32,
}

/// Which part of a text lies at its place.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// SVG elements, one a line.
pub(super) struct Canvas(String);

impl Canvas {
    /// White, so many pixels wide and high.
    pub fn new([width, height]: [f64; 2]) -> Self {
        Self(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        ))
    }

    /// The whole file.
    pub fn finish(self) -> String {
        self.0 + "</svg>\n"
    }

    /// Joins points.
    pub fn line(&mut self, points: &[(f64, f64)], style: Style) {
        let points: Vec<String> = points
            .iter()
            .map(|(x, y)| format!("{x:.1},{y:.1}"))
            .collect();
        let dash = style.dash.map_or(String::new(), |[dash, gap]| {
            format!(" stroke-dasharray=\"{dash} {gap}\"")
        });
        self.element(format_args!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{dash}/>",
            points.join(" "),
            rgb(style.colour),
            style.stroke_px,
        ));
    }

    /// Marks a point.
    pub fn mark(&mut self, (x, y): (f64, f64), style: Style) {
        let colour = rgb(style.colour);
        match style.marker {
            Marker::None => {}
            Marker::Circle => self.element(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>"
            )),
            Marker::Square => self.element(format_args!(
                "<path d=\"M{x:.1},{y:.1}m-3.5,-3.5h7v7h-7z\" fill=\"white\" stroke=\"{colour}\"/>"
            )),
            Marker::Triangle => self.element(format_args!(
                "<path d=\"M{x:.1},{y:.1}m0,-5l4.5,8h-9z\" fill=\"{colour}\"/>"
            )),
            Marker::Cross => self.element(format_args!(
                "<path d=\"M{x:.1},{y:.1}m-4,-4l8,8m-8,0l8,-8\" stroke=\"{colour}\"/>"
            )),
        }
    }

    /// Writes a line of text, its middle at the height of the place.
    pub fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = text
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        // Half of a capital's height below the place.
        let y = y + 4.0;
        let place = format!("x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\"");
        // The rim is a text of its own: not every viewer knows paint-order.
        let rim = "fill=\"none\" stroke=\"white\" stroke-width=\"3\"";
        self.element(format_args!("<text {place} {rim}>{text}</text>"));
        self.element(format_args!("<text {place}>{text}</text>"));
    }

    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        // A string takes everything.
        let _ = writeln!(self.0, "{element}");
    }
}

fn rgb([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
