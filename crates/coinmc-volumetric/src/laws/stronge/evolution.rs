//! One impact, followed piece by piece.

use super::events::{Cut, Event};
use super::modes::{Couplings, Rate, Rates, Torque};
use super::path::{Drive, Line, Normal, Path, Step};
use crate::body::{Body, Friction};
use crate::impact::friction_moments::RimRates;
use crate::impact::{ContactMatrix, ContactPoint, Impulse};

/// Slip, and the rates of rolling and pivoting, below this fraction of the velocities count as 0.
const REST: f64 = 1e-13;

/// A slip that turns less than this before it stops (path length over the velocities) counts as
/// straight.
const STRAIGHT: f64 = 1e-13;

/// A growing slip keeps its direction if it drifts sideways by less than this fraction of what
/// friction could cause. (Where sticking just fails, the slip grows so slowly that it stays on the
/// isocline.)
const STEADY: f64 = 1e-11;

/// The impulses so far, and the modes of friction.
pub(super) struct Evolution {
    k: ContactMatrix<f64>,
    couplings: Couplings,
    point: ContactPoint<f64>,
    /// The size of the velocities.
    size: f64,
    /// e².
    returned: f64,
    has_lengths: bool,
    x: f64,
    y: f64,
    z: f64,
    contour: f64,
    pivoting: f64,
    /// The minimum of W = ∫u_z dτ so far.
    least: f64,
    /// The work returned since. It is kept apart because with a small e it would lose its digits.
    back: f64,
    rates: Rates,
    /// The contact point sticks.
    still: bool,
    /// u_z >= 0.
    opening: bool,
}

/// The velocities at one moment.
struct Now {
    slip_x: f64,
    slip_y: f64,
    normal: f64,
    /// |slip|.
    speed: f64,
}

/// How the slip behaves during a piece.
#[derive(Clone, Copy)]
enum Course {
    /// It turns, and f turns with it.
    Turns,
    /// It keeps its direction, and f is constant.
    Keeps,
    /// This constant f brings it to 0 within a normal impulse of `length`.
    Stops { x: f64, y: f64, length: f64 },
}

/// The friction of one piece.
struct Piece {
    course: Course,
    /// f, if it is constant.
    x: f64,
    y: f64,
    /// The largest normal impulse of the piece; where f turns, approximately.
    length: f64,
    /// The contact point sticks.
    still: bool,
    drive: Drive,
    contour: Torque,
    pivoting: Torque,
}

impl Evolution {
    pub(super) fn new(body: &Body, friction: &Friction, point: &ContactPoint<f64>, e: f64) -> Self {
        let k = point.matrix(body);
        let rim_rates = RimRates::rates(body, point);
        Self {
            k,
            couplings: Couplings {
                rates: rim_rates,
                xx: k.xx,
                xz: k.xz,
                yy: k.yy,
                rx: point.rx,
                rz: point.rz,
                mu: friction.mu,
            },
            point: *point,
            size: point.slip_x.abs() + point.slip_y.abs() + point.approach.abs(),
            returned: e * e,
            has_lengths: friction.has_lengths(),
            x: 0.0,
            y: 0.0,
            z: 0.0,
            contour: 0.0,
            pivoting: 0.0,
            least: 0.0,
            back: 0.0,
            rates: Rates {
                roll: Rate::new(rim_rates.roll, friction.contour / point.sin),
                pivot: Rate::new(rim_rates.pivot, friction.pivoting),
            },
            still: false,
            opening: false,
        }
    }

    pub(super) fn impulse(&self, sin: f64) -> Impulse<f64> {
        Impulse {
            x: self.x,
            y: self.y,
            z: self.z,
            contour: sin * self.contour,
            pivoting: self.pivoting,
        }
    }

    fn now(&self) -> Now {
        let (k, t) = (&self.k, &self.couplings.rates);
        let slip_x = self.point.slip_x + k.xx * self.x + k.xz * self.z;
        let slip_y = self.point.slip_y + k.yy * self.y - t.slip_y(self.contour, self.pivoting);
        Now {
            slip_x,
            slip_y,
            normal: self.point.approach + k.xz * self.x + k.zz * self.z,
            speed: (slip_x * slip_x + slip_y * slip_y).sqrt(),
        }
    }

    /// Follows one piece of path. Returns whether the impact goes on after it.
    pub(super) fn advance(&mut self) -> bool {
        let now = self.now();
        let piece = self.piece(&now);
        let path = self.path(&piece, &now);
        let cut = self.cut(&path, &piece, &now);
        self.add(&cut.step, &piece);
        self.switch(cut.event, &piece)
    }

    /// The friction of the next piece.
    fn piece(&mut self, now: &Now) -> Piece {
        let mu = self.couplings.mu;
        let rests = self.still || now.speed <= REST * self.size;
        let mut still = false;
        let (x, y) = if mu <= 0.0 {
            (0.0, 0.0)
        } else if rests {
            let rest = self.rates.still(&self.couplings, self.has_lengths);
            still = rest.sticks;
            (rest.x, rest.y)
        } else {
            let over = mu / now.speed;
            (-(now.slip_x * over), -(now.slip_y * over))
        };
        let (contour, pivoting) = if self.has_lengths {
            self.rates.beside(&self.couplings, y)
        } else {
            (Torque::NONE, Torque::NONE)
        };
        let t = &self.couplings.rates;
        let drive = Drive {
            mu,
            xx: self.k.xx,
            yy: self.k.yy - t.slip_y(contour.by_y, pivoting.by_y),
            bx: self.k.xz,
            by: -t.slip_y(contour.rest, pivoting.rest),
        };
        let course = if mu > 0.0 && !rests {
            self.course(&drive, now, x, y)
        } else {
            Course::Keeps
        };
        let (x, y, length) = match course {
            Course::Stops { x, y, length } => (x, y, length),
            Course::Turns | Course::Keeps => (x, y, self.longest(now, x)),
        };
        Piece {
            course,
            x,
            y,
            length,
            still,
            drive,
            contour,
            pivoting,
        }
    }

    /// The normal impulse at which, with a constant f of this x component, the work has returned to
    /// 0: the end of the impact for e = 1, and no piece is longer.
    fn longest(&self, now: &Now, x: f64) -> f64 {
        let gain = self.k.zz + self.k.xz * x;
        let root = (now.normal * now.normal - 2.0 * gain * (self.least + self.back)).sqrt();
        (root - now.normal) / gain * (1.0 + 1e-6)
    }

    /// How a slip behaves that starts with this f. If it turns so little before it stops that its
    /// path is straight to the given precision, it is followed with the constant f, |f| = μ, that
    /// brings it to 0.
    ///
    /// Along its path the mean of f is (−slip/τ − b)/K. The length of this mean is below μ by the
    /// order of the square of the angle between slip and slip'.
    fn course(&self, drive: &Drive, now: &Now, fx: f64, fy: f64) -> Course {
        let (dx, dy) = (drive.xx * fx + drive.bx, drive.yy * fy + drive.by);
        let along = dx * now.slip_x + dy * now.slip_y;
        let across = dx * now.slip_y - dy * now.slip_x;
        if 0.0 <= along {
            let drift = STEADY * drive.mu * drive.xx * now.speed;
            let is_steady = across.abs() <= drift;
            return if is_steady {
                Course::Keeps
            } else {
                Course::Turns
            };
        }
        let is_straight = now.speed * across * across <= STRAIGHT * self.size * along * along;
        if !is_straight {
            return Course::Turns;
        }
        let (gx, gy) = (now.slip_x / drive.xx, now.slip_y / drive.yy);
        let (bx, by) = (drive.bx / drive.xx, drive.by / drive.yy);
        let square = gx * gx + gy * gy;
        let mixed = gx * bx + gy * by;
        let rest = drive.mu * drive.mu - (bx * bx + by * by);
        let root = mixed * mixed + square * rest;
        // 1/τ, the larger root: the first stop; NaN if the slip does not stop
        let rate = (root.sqrt() - mixed) / square;
        if 0.0 < rate {
            Course::Stops {
                x: -(gx * rate) - bx,
                y: -(gy * rate) - by,
                length: 1.0 / rate,
            }
        } else {
            Course::Turns
        }
    }

    fn path(&self, piece: &Piece, now: &Now) -> Path {
        let k = &self.k;
        if let Course::Turns = piece.course {
            let normal = Normal {
                now: now.normal,
                zz: k.zz,
                xz: k.xz,
            };
            return Path::turning(
                &piece.drive,
                &normal,
                (now.slip_x, now.slip_y),
                piece.length,
            );
        }
        let line = Line {
            x: piece.x,
            y: piece.y,
            normal: now.normal,
            half_gain: (k.zz + k.xz * piece.x) * 0.5,
        };
        Path::straight(line, piece.length)
    }

    /// The piece up to its first event.
    fn cut<'a>(&self, path: &'a Path, piece: &Piece, now: &Now) -> Cut<'a> {
        let k = &self.k;
        let mut cut = Cut::new(path);
        if self.opening {
            let missing = -(self.returned * self.least) - self.back;
            cut.by(Event::EndOfImpact, |s| missing - s.work);
        } else {
            cut.by(Event::EndOfCompression, |s| {
                -(now.normal + k.zz * s.z + k.xz * s.x)
            });
        }
        if self.has_lengths {
            self.cut_by_rates(&mut cut, piece, now);
        }
        cut
    }

    /// Shortens the piece to where an angular velocity that friction opposes comes to 0 or leaves
    /// it.
    fn cut_by_rates(&self, cut: &mut Cut, piece: &Piece, now: &Now) {
        let t = &self.couplings.rates;
        let (c, p) = (&piece.contour, &piece.pivoting);
        let turns = matches!(piece.course, Course::Turns);
        let impulses = |s: &Step| {
            (
                self.y + s.y,
                self.contour + c.by_y * s.y + c.rest * s.z,
                self.pivoting + p.by_y * s.y + p.rest * s.z,
            )
        };
        // f_y along a turning path
        let sideways = |s: &Step| {
            let x = now.slip_x + piece.drive.xx * s.x + piece.drive.bx * s.z;
            let y = now.slip_y + piece.drive.yy * s.y + piece.drive.by * s.z;
            -(self.couplings.mu * y / (x * x + y * y).sqrt())
        };
        // the sign of a rate that has just left 0 may be that of rounding
        let rounding = REST * (self.size + t.roll.abs() + t.pivot.abs());
        let Rates { roll, pivot } = &self.rates;
        if roll.limit > 0.0 && !roll.zero {
            cut.by_bent(Event::Roll, |s| {
                let (y, c, p) = impulses(s);
                rounding + roll.sign * (t.roll + t.roll_y * y - t.roll_roll * c - t.roll_pivot * p)
            });
        } else if roll.limit > 0.0 && turns {
            cut.by_bent(Event::Roll, |s| {
                roll.limit - (c.by_y * sideways(s) + c.rest).abs()
            });
        }
        if pivot.limit > 0.0 && !pivot.zero {
            cut.by_bent(Event::Pivot, |s| {
                let (y, c, p) = impulses(s);
                rounding
                    + pivot.sign * (t.pivot + t.pivot_y * y - t.roll_pivot * c - t.pivot_pivot * p)
            });
        } else if pivot.limit > 0.0 && turns {
            cut.by_bent(Event::Pivot, |s| {
                pivot.limit - (p.by_y * sideways(s) + p.rest).abs()
            });
        }
    }

    /// Adds a piece to the impulses.
    fn add(&mut self, step: &Step, piece: &Piece) {
        let (c, p) = (&piece.contour, &piece.pivoting);
        self.x += step.x;
        self.y += step.y;
        self.z += step.z;
        self.contour += c.by_y * step.y + c.rest * step.z;
        self.pivoting += p.by_y * step.y + p.rest * step.z;
        self.back += step.work;
        if self.back < 0.0 {
            self.least += self.back;
            self.back = 0.0;
        }
    }

    /// Changes the modes at the event that ends the piece. Returns whether the impact goes on.
    fn switch(&mut self, event: Event, piece: &Piece) -> bool {
        let stopped = matches!(piece.course, Course::Stops { .. }) && event == Event::Length;
        self.still = stopped || piece.still;
        let now = self.now();
        // f_y, if the slip turns
        let y = -(self.couplings.mu * now.slip_y) / now.speed;
        let (c, p) = (&piece.contour, &piece.pivoting);
        match event {
            Event::Roll => self.rates.roll.switch(c.by_y * y + c.rest),
            Event::Pivot => self.rates.pivot.switch(p.by_y * y + p.rest),
            Event::Length | Event::EndOfCompression | Event::EndOfImpact => {}
        }
        if event == Event::EndOfCompression {
            self.opening = true;
            // with e = 0 no work is returned
            return self.returned > 0.0;
        }
        if now.normal < 0.0 {
            // friction drives the point back into the surface
            self.opening = false;
        }
        event != Event::EndOfImpact
    }
}

#[cfg(test)]
mod tests;
