//! An SVG canvas: shapes and text.

use super::scale::Scale;
use std::fmt::Write;

/// Colours that are distinguishable with any colour vision (Okabe and Ito).
pub(super) const SERIES: [&str; 7] = [
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444",
];
pub(super) const FAINT: &str = "#E3E7EB";
pub(super) const LINE: &str = "#B4BCC4";
pub(super) const WARM: &str = "#E69F00";
pub(super) const ALARM: &str = "#C0392B";

/// A rectangle of the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlotArea {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl PlotArea {
    /// The scale of a time axis from 0 to a duration, s, along the area.
    pub(super) fn times(&self, duration: f64) -> Scale {
        Scale::linear((0.0, duration), (self.left, self.left + self.width))
    }
}

/// Style of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ink {
    size: f64,
    colour: &'static str,
    weight: u16,
    anchor: &'static str,
}

impl Ink {
    pub(super) const TITLE: Self = Self::new(24.0, "#14202B", 600);
    pub(super) const HEADING: Self = Self::new(14.0, "#14202B", 600);
    pub(super) const PLAIN: Self = Self::new(13.0, "#14202B", 400);
    pub(super) const QUIET: Self = Self::new(13.0, "#5A6772", 400);
    pub(super) const SMALL: Self = Self::new(11.5, "#5A6772", 400);
    pub(super) const ON_COLOUR: Self = Self::new(11.0, "#FFFFFF", 700).middle();

    const fn new(size: f64, colour: &'static str, weight: u16) -> Self {
        Self {
            size,
            colour,
            weight,
            anchor: "start",
        }
    }

    pub(super) const fn middle(self) -> Self {
        Self {
            anchor: "middle",
            ..self
        }
    }

    pub(super) const fn end(self) -> Self {
        Self {
            anchor: "end",
            ..self
        }
    }

    pub(super) const fn coloured(self, colour: &'static str) -> Self {
        Self { colour, ..self }
    }
}

/// Style of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    pub(super) dashed: bool,
    pub(super) opacity: f64,
}

impl Pen {
    pub(super) const fn new(colour: &'static str, width: f64) -> Self {
        Self {
            colour,
            width,
            dashed: false,
            opacity: 1.0,
        }
    }

    pub(super) const fn dashed(self) -> Self {
        Self {
            dashed: true,
            ..self
        }
    }

    pub(super) const fn faded(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// A picture in progress. Writing to a String cannot fail.
#[derive(Debug)]
pub(super) struct Canvas {
    text: String,
}

impl Canvas {
    /// An empty white picture with an alternative text.
    pub(super) fn new(width: f64, height: f64, description: &str) -> Self {
        let description = escaped(description);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" role=\"img\" \
             font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\">\n\
             <title>{description}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
        );
        Self { text }
    }

    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    pub(super) fn text(&mut self, x: f64, y: f64, ink: Ink, words: &str) {
        let Ink {
            size,
            colour,
            weight,
            anchor,
        } = ink;
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" font-weight=\"{weight}\" \
             fill=\"{colour}\" text-anchor=\"{anchor}\">{}</text>",
            escaped(words)
        );
    }

    pub(super) fn rectangle(&mut self, frame: PlotArea, fill: &str, rounding: f64) {
        let PlotArea {
            left,
            top,
            width,
            height,
        } = frame;
        let _ = writeln!(
            self.text,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             rx=\"{rounding}\" fill=\"{fill}\"/>"
        );
    }

    pub(super) fn circle(&mut self, (x, y): (f64, f64), radius: f64, fill: &str, pen: Pen) {
        let stroke = stroke(pen);
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" {stroke}/>"
        );
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), pen: Pen) {
        self.path(&[from, to], pen);
    }

    /// An open line through points; nothing for fewer than two.
    pub(super) fn path(&mut self, points: &[(f64, f64)], pen: Pen) {
        self.shape(points, "none", pen, "");
    }

    /// A filled polygon.
    pub(super) fn area(&mut self, points: &[(f64, f64)], fill: &str, pen: Pen) {
        self.shape(points, fill, pen, "Z");
    }

    fn shape(&mut self, points: &[(f64, f64)], fill: &str, pen: Pen, end: &str) {
        let Some(((x, y), rest)) = points.split_first() else {
            return;
        };
        if rest.is_empty() {
            return;
        }
        let _ = write!(self.text, "<path d=\"M{x:.1} {y:.1}L");
        for (index, (x, y)) in rest.iter().enumerate() {
            let separator = if index == 0 { "" } else { " " };
            let _ = write!(self.text, "{separator}{x:.1} {y:.1}");
        }
        let _ = writeln!(
            self.text,
            "{end}\" fill=\"{fill}\" {} stroke-linejoin=\"round\"/>",
            stroke(pen)
        );
    }
}

fn stroke(pen: Pen) -> String {
    let Pen {
        colour,
        width,
        dashed,
        opacity,
    } = pen;
    let dashes = if dashed {
        " stroke-dasharray=\"5 4\""
    } else {
        ""
    };
    let veil = if opacity < 1.0 {
        format!(" opacity=\"{opacity}\"")
    } else {
        String::new()
    };
    format!("stroke=\"{colour}\" stroke-width=\"{width}\"{dashes}{veil}")
}

/// Text escaped for XML; characters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars().filter(|c| !c.is_control()) {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '\u{fffe}' | '\u{ffff}' => {}
            other => safe.push(other),
        }
    }
    safe
}
