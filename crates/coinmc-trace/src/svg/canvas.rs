//! SVG elements, with numbers rounded to a hundredth of a pixel.

use std::fmt::Write;

/// Colours that colour-blind readers can distinguish (Okabe & Ito, 2008), and greys.
pub(super) const HEADS: &str = "#0072b2";
pub(super) const HEADS_PALE: &str = "#9ccbe6";
pub(super) const TAILS: &str = "#d55e00";
pub(super) const TAILS_PALE: &str = "#f6c79c";
pub(super) const STICKING: &str = "#009e73";
pub(super) const SLIDING: &str = "#cc79a7";
pub(super) const TEXT: &str = "#333333";
pub(super) const FAINT: &str = "#8a8a8a";
pub(super) const LINE: &str = "#b5b5b5";
pub(super) const GROUND: &str = "#e4e0da";
pub(super) const EDGE: &str = "#4a4a4a";

/// A picture being written.
pub(super) struct Canvas {
    text: String,
}

/// Position of text relative to its point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let (w, h) = (px(width), px(height));
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             viewBox=\"0 0 {w} {h}\" font-family=\"Helvetica, Arial, sans-serif\">\n\
             <rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n"
        );
        Self { text }
    }

    /// Adds a line of SVG unchanged.
    pub(super) fn raw(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    pub(super) fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], style: &str) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(px);
        self.raw(&format!(
            "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" {style}/>"
        ));
    }

    pub(super) fn rectangle(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], style: &str) {
        let [x, y, w, h] = [x, y, w, h].map(px);
        self.raw(&format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {style}/>"
        ));
    }

    pub(super) fn circle(&mut self, [x, y]: [f64; 2], radius: f64, style: &str) {
        let [x, y, r] = [x, y, radius].map(px);
        self.raw(&format!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {style}/>"
        ));
    }

    pub(super) fn triangle(&mut self, [x, y]: [f64; 2], size: f64, style: &str) {
        let points = [
            [x, y],
            [x - 0.6 * size, y + size],
            [x + 0.6 * size, y + size],
        ];
        self.polygon("polygon", &points, style);
    }

    /// Points joined by lines; draws nothing for fewer than two.
    pub(super) fn polyline(&mut self, points: &[[f64; 2]], style: &str) {
        if points.len() > 1 {
            self.polygon("polyline", points, style);
        }
    }

    fn polygon(&mut self, element: &str, points: &[[f64; 2]], style: &str) {
        let mut list = String::new();
        for [x, y] in points {
            let separator = if list.is_empty() { "" } else { " " };
            // writing to a string cannot fail
            let _ = write!(list, "{separator}{},{}", px(*x), px(*y));
        }
        self.raw(&format!("<{element} points=\"{list}\" {style}/>"));
    }

    /// Text of a size in px, with additional `style`.
    pub(super) fn label(
        &mut self,
        [x, y]: [f64; 2],
        size: f64,
        anchor: Anchor,
        colour: &str,
        text: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let [x, y, size] = [x, y, size].map(px);
        let text = escaped(text);
        self.raw(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
             fill=\"{colour}\">{text}</text>"
        ));
    }

    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// A length rounded to hundredths of a pixel, without trailing zeros.
pub(super) fn px(value: f64) -> String {
    let mut text = format!("{value:.2}");
    while text.ends_with('0') {
        text.pop();
    }
    if text.ends_with('.') {
        text.pop();
    }
    if text == "-0" { "0".to_owned() } else { text }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
