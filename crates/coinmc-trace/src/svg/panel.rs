//! A panel: ground, path, positions of the coin, impacts and scale bar.

use super::canvas::{Anchor, Canvas, FAINT, GROUND, LINE, SLIDING, STICKING, TEXT};
use super::strobe::Strobe;
use super::view::Shot;
use super::window::Window;
use super::{coin, impacts, units};
use crate::record::Mode;
use crate::trace::Trace;

/// Room below the ground for impacts and the scale bar, px.
const BELOW: f64 = 40.0;
/// Thickness of the ground, px.
const BAND: f64 = 7.0;
/// Smallest length of a contact that is drawn, px.
const TOUCH: f64 = 5.0;
/// Smallest distance between two points of a path, px.
const NEAR: f64 = 0.4;

/// Position and size of a panel, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    /// The largest area for a window within a width and a height, at the top of the picture.
    pub(super) fn fitting(window: &Window, [width, height]: [f64; 2]) -> Self {
        let scale = (width / window.width()).min((height - BELOW) / window.height());
        Self {
            left: 0.0,
            top: super::HEAD,
            width: scale * window.width(),
            height: scale * window.height() + BELOW,
        }
    }

    pub(super) fn placed(self, left: f64, top: f64) -> Self {
        Self { left, top, ..self }
    }

    pub(super) fn centred(self, left: f64, inner: f64) -> Self {
        let left = left + 0.5 * (inner - self.width);
        Self { left, ..self }
    }

    pub(super) fn at_least(self, width: f64) -> Self {
        Self {
            width: self.width.max(width),
            ..self
        }
    }

    /// Pixels per metre.
    pub(super) fn scale_of(&self, window: &Window) -> f64 {
        (self.height - BELOW) / window.height()
    }
}

/// A window of the toss in an area of the picture.
pub(super) struct Panel<'a> {
    trace: &'a Trace,
    area: Area,
    window: Window,
    scale: f64,
}

impl<'a> Panel<'a> {
    pub(super) fn new(trace: &'a Trace, area: Area, window: Window) -> Self {
        Self {
            trace,
            area,
            window,
            scale: area.scale_of(&window),
        }
    }

    /// Pixels per metre.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    pub(super) fn bottom(&self) -> f64 {
        self.area.top + self.area.height
    }

    fn ground(&self) -> f64 {
        self.bottom() - BELOW
    }

    fn at(&self, x: f64, z: f64) -> [f64; 2] {
        let middle = self.area.left + 0.5 * self.area.width;
        let centre = f64::midpoint(self.window.left, self.window.right);
        [
            middle + (x - centre) * self.scale,
            self.ground() - z * self.scale,
        ]
    }

    fn seen<'s>(&self, shots: &'s [Shot]) -> &'s [Shot] {
        shots.get(self.window.first..).unwrap_or_default()
    }

    fn strobe(&self, shots: &[Shot]) -> Strobe {
        let size = 2.0 * self.trace.scene.coin.rim_distance_m() * self.scale;
        Strobe::new(
            self.seen(shots),
            length(&self.path(shots)),
            size,
            self.trace.rate_hz,
        )
    }

    pub(super) fn draw(&self, canvas: &mut Canvas, shots: &[Shot]) {
        let Area { left, width, .. } = self.area;
        let ground = self.ground();
        canvas.rectangle([left, ground], [width, BAND], &format!("fill=\"{GROUND}\""));
        let line = format!("stroke=\"{TEXT}\" stroke-width=\"1.2\"");
        canvas.line([left, ground], [left + width, ground], &line);
        self.draw_contact(canvas, shots);
        self.draw_path(canvas, shots);
        let strobe = self.strobe(shots);
        for (shot, opacity) in strobe.positions(self.seen(shots)) {
            let at = self.at(shot.x, shot.z);
            coin::draw(
                canvas,
                &self.trace.scene.coin,
                self.scale,
                at,
                shot.axis,
                opacity,
            );
        }
        impacts::draw(canvas, shots, self.window.first, |foot| self.at(foot, 0.0));
        self.draw_scale_bar(canvas);
    }

    /// The path of the centre, without points that are too close to distinguish.
    fn path(&self, shots: &[Shot]) -> Vec<[f64; 2]> {
        let mut path: Vec<[f64; 2]> = Vec::new();
        let mut skipped = None;
        for shot in self.seen(shots) {
            let at = self.at(shot.x, shot.z);
            // keep the corners at impacts
            if shot.is_impact() || path.last().is_none_or(|last| apart(last, &at) >= NEAR) {
                path.push(at);
                skipped = None;
            } else {
                skipped = Some(at);
            }
        }
        path.extend(skipped);
        path
    }

    fn draw_path(&self, canvas: &mut Canvas, shots: &[Shot]) {
        let style = format!(
            "fill=\"none\" stroke=\"{LINE}\" stroke-width=\"1.2\" stroke-linejoin=\"round\""
        );
        canvas.polyline(&self.path(shots), &style);
    }

    /// Colours the ground along sustained contacts.
    fn draw_contact(&self, canvas: &mut Canvas, shots: &[Shot]) {
        for (mode, low, high) in spans(self.seen(shots)) {
            let ([left, ground], [right, _]) = (self.at(low, 0.0), self.at(high, 0.0));
            let grow = (TOUCH - (right - left)).max(0.0);
            let colour = if mode == Mode::Sticking {
                STICKING
            } else {
                SLIDING
            };
            canvas.rectangle(
                [left - 0.5 * grow, ground],
                [right - left + grow, BAND],
                &format!("fill=\"{colour}\""),
            );
        }
    }

    fn draw_scale_bar(&self, canvas: &mut Canvas) {
        let length_m = units::nice_below(0.25 * self.area.width / self.scale);
        let right = self.area.left + self.area.width - 2.0;
        let left = right - length_m * self.scale;
        let y = self.bottom() - 6.0;
        let style = format!("stroke=\"{TEXT}\" stroke-width=\"1.5\"");
        canvas.line([left, y], [right, y], &style);
        for x in [left, right] {
            canvas.line([x, y - 4.0], [x, y + 4.0], &style);
        }
        canvas.label(
            [left - 6.0, y + 4.0],
            12.0,
            Anchor::End,
            TEXT,
            &units::length(length_m),
        );
    }

    /// The title above the panel: its content and the time step.
    pub(super) fn name(&self, canvas: &mut Canvas, shots: &[Shot], what: &str) {
        let every = self.strobe(shots).describe();
        let text = match (what.is_empty(), every.is_empty()) {
            (true, _) => every,
            (false, true) => what.to_owned(),
            (false, false) => format!("{what}, {every}"),
        };
        let at = [self.area.left, self.area.top - 8.0];
        canvas.label(at, 12.0, Anchor::Start, FAINT, &text);
    }

    /// Marks the area that another panel magnifies.
    pub(super) fn frame(&self, canvas: &mut Canvas, other: &Panel<'_>) {
        let Window {
            left, right, top, ..
        } = other.window;
        let ([x1, y1], [x2, y2]) = (self.at(left, top), self.at(right, 0.0));
        let edge = self.area.left + self.area.width;
        let (x1, x2) = (x1.max(self.area.left), x2.min(edge));
        // not too small to see
        let (grow_x, grow_y) = ((10.0 - (x2 - x1)).max(0.0), (8.0 - (y2 - y1)).max(0.0));
        let style = format!("fill=\"none\" stroke=\"{TEXT}\" stroke-dasharray=\"3 2\"");
        canvas.rectangle(
            [x1 - 0.5 * grow_x, y1 - grow_y],
            [x2 - x1 + grow_x, y2 - y1 + grow_y],
            &style,
        );
    }
}

/// The successive modes of contact, each with its leftmost and rightmost contact point.
fn spans(seen: &[Shot]) -> Vec<(Mode, f64, f64)> {
    let mut spans: Vec<(Mode, f64, f64)> = Vec::new();
    let mut before = Mode::Flight;
    for shot in seen {
        if matches!(shot.mode, Mode::Sticking | Mode::Sliding) {
            match spans.last_mut() {
                Some((_, low, high)) if shot.mode == before => {
                    (*low, *high) = (low.min(shot.foot), high.max(shot.foot));
                }
                _ => spans.push((shot.mode, shot.foot, shot.foot)),
            }
        }
        before = shot.mode;
    }
    spans
}

fn apart(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}

fn length(points: &[[f64; 2]]) -> f64 {
    points
        .windows(2)
        .map(|pair| apart(&pair[0], &pair[1]))
        .sum()
}
