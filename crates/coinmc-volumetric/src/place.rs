//! Where the coin is in the laboratory. The toss itself needs neither the horizontal position nor
//! the direction of the folded frame, so both are kept up to date for an observer only.

use crate::body::Units;
use crate::motion::{Motion, Spin};
use crate::series::sin_cos;
use coinmc_core::State;
use nalgebra::{UnitVector3, Vector3};

/// The folded frame in the laboratory, and the time since the launch in sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// Direction of the frame's x axis.
    heading: [f64; 2],
    /// Horizontal position of the coin's centre.
    position: [f64; 2],
    pub(crate) time: f64,
}

impl Place {
    /// At the origin at time 0, with the frame's x axis along `heading`.
    pub(crate) fn origin(heading: [f64; 2]) -> Self {
        Self {
            heading,
            position: [0.0; 2],
            time: 0.0,
        }
    }

    /// At `position` at time 0, with the frame's x axis along `heading`.
    pub(crate) fn at(position: [f64; 2], heading: [f64; 2]) -> Self {
        Self {
            heading,
            position,
            time: 0.0,
        }
    }

    /// The laboratory's components of a horizontal vector (`x`, `y`) in the frame.
    pub(crate) fn direction(&self, x: f64, y: f64) -> [f64; 2] {
        let [nx, ny] = self.heading;
        [nx * x - ny * y, nx * y + ny * x]
    }

    /// The horizontal place in the laboratory of a point at (`x`, `y`) from the centre, in the
    /// frame.
    pub(crate) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        let [dx, dy] = self.direction(x, y);
        [self.position[0] + dx, self.position[1] + dy]
    }

    /// The components in the frame of a horizontal vector of the laboratory.
    pub(crate) fn in_frame(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [nx, ny] = self.heading;
        [nx * x + ny * y, nx * y - ny * x]
    }

    /// The way of the centre from an earlier place to this one, in the laboratory.
    pub(crate) fn way_from(&self, earlier: &Self) -> [f64; 2] {
        let (now, then) = (self.position, earlier.position);
        [now[0] - then[0], now[1] - then[1]]
    }

    /// The same place, with the centre elsewhere.
    pub(crate) fn with_centre_at(self, position: [f64; 2]) -> Self {
        Self { position, ..self }
    }

    /// Turns the frame so that its new x axis is (`nx`, `ny`) in the old frame.
    pub(crate) fn align(&mut self, nx: f64, ny: f64) {
        let [x, y] = self.heading;
        self.heading = [nx * x - ny * y, nx * y + ny * x];
    }

    /// Moves the coin by (`dx`, `dy`) in the frame.
    pub(crate) fn shift(&mut self, dx: f64, dy: f64) {
        let [x, y] = self.heading;
        self.position[0] += dx * x - dy * y;
        self.position[1] += dx * y + dy * x;
    }

    /// Follows a coin in contact for a time `h` within one integrator step. The frame turns at the
    /// rate of the azimuth, φ' = −ω_θ/s. Simpson's rule on the motions that `at` returns: fourth
    /// order.
    pub(crate) fn follow(&mut self, h: f64, at: impl Fn(f64) -> (Motion<f64>, Spin<f64>)) {
        let rates = |t: f64| {
            let (motion, spin) = at(t);
            ([motion.vx, motion.vy], -spin.turn / motion.sin)
        };
        let ((v0, w0), (v1, w1), (v2, w2)) = (rates(0.0), rates(0.5 * h), rates(h));
        // the parabola through the three rates, integrated to the middle and to the end
        let middle = sin_cos(h / 24.0 * (5.0 * w0 + 8.0 * w1 - w2));
        let end = sin_cos(h / 6.0 * (w0 + 4.0 * w1 + w2));
        let turned = |[x, y]: [f64; 2], (s, c): (f64, f64)| [x * c - y * s, x * s + y * c];
        let (v1, v2) = (turned(v1, middle), turned(v2, end));
        let [dx, dy] = std::array::from_fn(|i| h / 6.0 * (v0[i] + 4.0 * v1[i] + v2[i]));
        self.shift(dx, dy);
        self.align(end.1, end.0);
        self.time += h;
    }

    /// The state in SI units in the laboratory.
    pub(crate) fn state(
        &self,
        m: &Motion<f64>,
        spin: &Spin<f64>,
        heads_up: bool,
        units: &Units,
    ) -> State {
        let [x, y] = self.heading;
        let lab = |a: f64, b: f64, c: f64| Vector3::new(a * x - b * y, a * y + b * x, c);
        let up = lab(m.sin, 0.0, m.cos);
        let across = lab(m.cos, 0.0, -m.sin);
        let spin = up * spin.axial + across * spin.turn + lab(0.0, spin.tilt, 0.0);
        let axis = if heads_up { up } else { -up };
        let [px, py] = self.position;
        State {
            time_s: self.time * units.time_s,
            position_m: Vector3::new(px, py, m.z) * units.length_m + Vector3::z() * units.rim_m,
            velocity_m_s: lab(m.vx, m.vy, m.vz) * units.speed_m_s(),
            axis: UnitVector3::new_unchecked(axis),
            spin_rad_s: spin / units.time_s,
        }
    }
}
