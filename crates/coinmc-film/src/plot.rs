//! A plot of the residuals, as SVG.

use crate::drop::Coordinate;
use crate::fit::{Fit, Residual};
use std::fmt::Write as _;

const WIDTH: f64 = 720.0;
const ROW: f64 = 130.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 28.0;
const BOTTOM: f64 = 40.0;
/// Range of the axis, in standard deviations; points beyond are drawn at its edge.
const RANGE: f64 = 5.0;
/// One colour per drop, distinguishable by colour-blind readers too (Okabe & Ito).
const COLORS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// The standardised residuals of a fit against time: one row per coordinate, one colour per drop,
/// with the times of the impacts and a band of two standard deviations.
pub fn residuals_svg(fit: &Fit) -> String {
    let rows: Vec<Coordinate> = fit.noise.iter().map(|noise| noise.coordinate).collect();
    let height = TOP + ROW * rows.len() as f64 + BOTTOM;
    let starts = starts(fit);
    let longest = span(fit, &starts);
    let x = |t: f64| LEFT + t / longest * (WIDTH - LEFT - RIGHT);
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 \
         {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" \
         height=\"100%\" fill=\"#ffffff\"/>\n<text x=\"{LEFT}\" y=\"18\">Residuals of {} in standard \
         deviations</text>",
        fit.model.law.name()
    );
    for (row, coordinate) in rows.iter().enumerate() {
        let middle = TOP + ROW * (row as f64 + 0.5);
        let y = |r: f64| middle - r.clamp(-RANGE, RANGE) / RANGE * (0.5 * ROW - 8.0);
        frame(&mut svg, *coordinate, middle, &y);
        impacts(&mut svg, fit, middle, &x);
        for residual in fit.residuals.iter().filter(|r| r.coordinate == *coordinate) {
            let since = residual.time_s - starts[residual.drop];
            point(&mut svg, fit, residual, x(since), y(residual.standardised));
        }
    }
    axis(&mut svg, longest, height, &x);
    svg + "</svg>\n"
}

/// Time of each drop's first residual, s.
fn starts(fit: &Fit) -> Vec<f64> {
    let mut starts = vec![f64::INFINITY; fit.drops.len()];
    for residual in &fit.residuals {
        let start = &mut starts[residual.drop];
        *start = start.min(residual.time_s);
    }
    starts
}

/// The longest drop, s.
fn span(fit: &Fit, starts: &[f64]) -> f64 {
    let lengths = fit.residuals.iter().map(|r| r.time_s - starts[r.drop]);
    let longest = lengths.fold(0.0, f64::max);
    if longest > 0.0 { longest } else { 1.0 }
}

fn frame(svg: &mut String, coordinate: Coordinate, middle: f64, y: &impl Fn(f64) -> f64) {
    let right = WIDTH - RIGHT;
    let (high, low) = (y(2.0), y(-2.0));
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{high:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#eeeeee\"/>\n<line \
         x1=\"{LEFT}\" x2=\"{right}\" y1=\"{middle}\" y2=\"{middle}\" stroke=\"#888888\"/>\n<text x=\"8\" \
         y=\"{:.1}\">{}</text>",
        right - LEFT,
        low - high,
        middle + 4.0,
        match coordinate {
            Coordinate::X => "x",
            Coordinate::Z => "z",
            Coordinate::Theta => "θ",
        }
    );
    for tick in [-4, -2, 2, 4] {
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555555\">{tick}</text>",
            LEFT - 6.0,
            y(f64::from(tick)) + 4.0
        );
    }
}

fn impacts(svg: &mut String, fit: &Fit, middle: f64, x: &impl Fn(f64) -> f64) {
    for (drop, fitted) in fit.drops.iter().enumerate() {
        for impact in &fitted.impacts_s {
            let at = x(*impact);
            let _ = writeln!(
                svg,
                "<line x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{:.1}\" y2=\"{:.1}\" stroke=\"{}\" \
                 stroke-dasharray=\"3 3\"/>",
                middle - 0.5 * ROW + 4.0,
                middle + 0.5 * ROW - 4.0,
                COLORS[drop % COLORS.len()]
            );
        }
    }
}

fn point(svg: &mut String, fit: &Fit, residual: &Residual, x: f64, y: f64) {
    let beyond = if residual.standardised.abs() > RANGE {
        format!(
            "<title>{} frame {}: {:.1}</title>",
            escaped(&fit.drops[residual.drop].name),
            residual.frame,
            residual.standardised
        )
    } else {
        String::new()
    };
    let _ = writeln!(
        svg,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" fill=\"{}\">{beyond}</circle>",
        COLORS[residual.drop % COLORS.len()]
    );
}

fn axis(svg: &mut String, longest: f64, height: f64, x: &impl Fn(f64) -> f64) {
    let bottom = height - BOTTOM;
    for fifth in 0..=5 {
        let t = longest * f64::from(fifth) / 5.0;
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#555555\">{t:.2}</text>",
            x(t),
            bottom + 16.0
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">time since the first frame, s</text>",
        0.5 * (LEFT + WIDTH - RIGHT),
        bottom + 34.0
    );
}

/// Escapes text for XML.
fn escaped(text: &str) -> String {
    let kept: String = text.chars().filter(|c| !c.is_control()).collect();
    kept.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::blank;
    use crate::fit::{FittedDrop, Noise};

    /// Names of files may hold anything; XML 1.0 has no control characters at all.
    #[test]
    fn text_is_escaped_and_control_characters_are_left_out() {
        assert_eq!(escaped("a<b> & \u{7}\u{1b}θ"), "a&lt;b&gt; &amp; θ");
    }

    fn residual(drop: usize, time_s: f64, coordinate: Coordinate) -> Residual {
        Residual {
            drop,
            frame: 0,
            time_s,
            coordinate,
            seen: 0.0,
            residual: 0.0,
            standardised: 1.0,
        }
    }

    /// Two drops, filmed from 2 s and from 5 s on, the longer one for 4 s: x and z were marked.
    fn two_drops() -> Fit {
        let drop = |name: &str, impacts_s: &[f64]| FittedDrop {
            name: name.to_owned(),
            start: [0.0; 6],
            half_width: [None; 6],
            frames: 2,
            of_frames: 2,
            impacts_s: impacts_s.to_vec(),
        };
        let noise = |coordinate| Noise {
            coordinate,
            n: 3,
            sigma: 1.0,
            correlation: 0.0,
        };
        let residuals = [Coordinate::X, Coordinate::Z]
            .into_iter()
            .flat_map(|coordinate| {
                [(0, 2.0), (0, 3.0), (1, 5.0), (1, 9.0)]
                    .map(|(drop, time_s)| residual(drop, time_s, coordinate))
            });
        Fit {
            drops: vec![drop("a", &[1.0]), drop("b", &[2.0, 4.0])],
            noise: vec![noise(Coordinate::X), noise(Coordinate::Z)],
            residuals: residuals.collect(),
            ..blank()
        }
    }

    /// The values of an attribute in the lines with this text.
    fn values(svg: &str, with: &str, attribute: &str) -> Vec<f64> {
        let lines = svg.lines().filter(|line| line.contains(with));
        let of = |line: &str| {
            let (_, rest) = line.split_once(&format!(" {attribute}=\"")).unwrap();
            rest.split_once('"').unwrap().0.parse().unwrap()
        };
        lines.map(of).collect()
    }

    /// Times count from each drop's own first frame, and points, impacts and ticks share one scale: a second is a
    /// quarter of the width.
    #[test]
    fn points_and_impacts_stand_at_their_times() {
        let svg = residuals_svg(&two_drops());
        let (left, right) = (64.0, 704.0);
        let at = |t: f64| left + (right - left) * t / 4.0;
        assert_eq!(
            values(&svg, "<circle", "cx"),
            [0.0, 1.0, 0.0, 4.0].map(at).repeat(2)
        );
        assert_eq!(
            values(&svg, "stroke-dasharray", "x1"),
            [1.0, 2.0, 4.0].map(at).repeat(2)
        );
        assert_eq!(
            values(&svg, "stroke-dasharray", "x2"),
            [1.0, 2.0, 4.0].map(at).repeat(2)
        );
        for (fifth, label) in ["0.00", "0.80", "1.60", "2.40", "3.20", "4.00"]
            .iter()
            .enumerate()
        {
            let label = format!(">{label}</text>");
            assert_eq!(values(&svg, &label, "x"), [left + 128.0 * fifth as f64]);
        }
        assert_eq!(svg.matches("#d55e00").count(), 2 * (2 + 2));
    }

    /// One row below the other, the dashed lines within theirs, the labels of time below all, all within the picture.
    #[test]
    fn rows_stand_below_each_other() {
        let svg = residuals_svg(&two_drops());
        let middles = values(&svg, "stroke=\"#888888\"", "y1");
        assert_eq!(middles, [28.0 + 65.0, 28.0 + 195.0]);
        assert_eq!(values(&svg, "<svg", "height"), [28.0 + 260.0 + 40.0]);
        let dashed = |of| values(&svg, "stroke-dasharray", of);
        for (i, (top, bottom)) in dashed("y1").into_iter().zip(dashed("y2")).enumerate() {
            assert_eq!(
                [top, bottom],
                [middles[i / 3] - 61.0, middles[i / 3] + 61.0]
            );
        }
        // bands of two standard deviations, 57 above the middle is five
        for (band, middle) in values(&svg, "fill=\"#eeeeee\"", "y")
            .into_iter()
            .zip(&middles)
        {
            assert!((band - (middle - 57.0 * 0.4)).abs() < 0.051);
        }
        let heights = values(&svg, "fill=\"#eeeeee\"", "height");
        assert!(
            heights
                .into_iter()
                .all(|height| (height - 2.0 * 57.0 * 0.4).abs() < 0.051)
        );
        assert_eq!(values(&svg, "fill=\"#eeeeee\"", "width"), [640.0; 2]);
        assert_eq!(values(&svg, ">4.00</text>", "y"), [288.0 + 16.0]);
        assert_eq!(
            values(&svg, "time since the first frame", "y"),
            [288.0 + 34.0]
        );
        assert_eq!(values(&svg, "time since the first frame", "x"), [384.0]);
        for tick in [-4, -2, 2, 4] {
            let label = format!(">{tick}</text>");
            assert_eq!(values(&svg, &label, "x"), [58.0; 2]);
            let heights = values(&svg, &label, "y");
            for (height, middle) in heights.into_iter().zip(&middles) {
                assert!((height - (middle - 57.0 * f64::from(tick) / 5.0 + 4.0)).abs() < 0.051);
            }
        }
        for (name, middle) in [("x", middles[0]), ("z", middles[1])] {
            assert_eq!(
                values(&svg, &format!(">{name}</text>"), "y"),
                [middle + 4.0]
            );
        }
    }

    /// A single frame has no duration, and a point beyond the axis is drawn at its edge with its value.
    #[test]
    fn what_lies_beyond_the_axis_is_named() {
        let mut fit = two_drops();
        fit.residuals.truncate(1);
        let svg = residuals_svg(&fit);
        assert_eq!(values(&svg, "<circle", "cx"), [64.0]);
        assert!(svg.contains(">1.00</text>") && !svg.contains("<title>"));
        fit.residuals[0].standardised = 5.0;
        assert!(!residuals_svg(&fit).contains("<title>"));
        fit.residuals[0].standardised = -7.25;
        fit.residuals[0].frame = 12;
        let svg = residuals_svg(&fit);
        assert!(svg.contains("<title>a frame 12: -7.2</title>"), "{svg}");
        assert_eq!(values(&svg, "<circle", "cy"), [93.0 + 57.0]);
    }
}
