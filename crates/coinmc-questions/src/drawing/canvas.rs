//! SVG elements, with numbers rounded to a tenth of a pixel.

use std::fmt::Write;

/// Colours of text and lines.
pub(crate) const TEXT: &str = "#333333";
pub(crate) const LINE: &str = "#8a8a8a";

/// A picture being written.
pub(crate) struct Canvas {
    text: String,
}

/// Where a text stands from its point.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    pub(crate) fn new([width, height]: [f64; 2]) -> Self {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\" \
             font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        Self { text }
    }

    /// Adds a line of SVG unchanged.
    pub(crate) fn raw(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    pub(crate) fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], style: &str) {
        self.raw(&format!(
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" {style}/>"
        ));
    }

    pub(crate) fn rectangle(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], style: &str) {
        self.raw(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" {style}/>"
        ));
    }

    pub(crate) fn circle(&mut self, [x, y]: [f64; 2], radius: f64, style: &str) {
        self.raw(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {style}/>"
        ));
    }

    /// A cross of two lines.
    pub(crate) fn cross(&mut self, [x, y]: [f64; 2], size: f64, style: &str) {
        self.line([x - size, y - size], [x + size, y + size], style);
        self.line([x - size, y + size], [x + size, y - size], style);
    }

    /// A `polyline` or `polygon`.
    pub(crate) fn points(&mut self, element: &str, points: &[[f64; 2]], style: &str) {
        let mut list = String::new();
        for [x, y] in points {
            write!(list, "{x:.1},{y:.1} ").expect("writing to a string cannot fail");
        }
        self.raw(&format!(
            "<{element} points=\"{}\" {style}/>",
            list.trim_end()
        ));
    }

    /// Text with a white border, so that it can be read on any colour.
    pub(crate) fn label(&mut self, [x, y]: [f64; 2], anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escaped(text);
        self.raw(&format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{TEXT}\" \
             stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\">{text}</text>"
        ));
    }

    /// Text that reads upwards.
    pub(crate) fn upright_label(&mut self, [x, y]: [f64; 2], text: &str) {
        let text = escaped(text);
        self.raw(&format!(
            "<text transform=\"translate({x:.1} {y:.1}) rotate(-90)\" text-anchor=\"middle\" \
             fill=\"{TEXT}\">{text}</text>"
        ));
    }

    pub(crate) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// Text as XML holds it.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
