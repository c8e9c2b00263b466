//! One impact, piece by piece.

use super::super::twist::Twist;
use super::super::{ContactMatrix, Impulse, Touch};
use super::events::{Cut, Event};
use super::modes::{Couplings, Rate, Rates, Torque};
use super::path::{Drive, Line, Normal, Path, Step};
use crate::body::{Body, Friction};
use coinmc_lanes::{Lane, Mask};

/// Slip, and the rates of rolling and pivoting, below this share of the velocities are none.
const REST: f64 = 1e-13;

/// A slip that turns so little before it stops, in path length over the velocities, goes straight.
const STRAIGHT: f64 = 1e-13;

/// A growing slip that drifts sideways by less than this share of what friction could do keeps its
/// direction. (Where sticking just fails the slip grows so slowly that its path is all isocline.)
const STEADY: f64 = 1e-11;

/// The impulses so far and the modes of friction.
pub(super) struct Sweep<L: Lane> {
    k: ContactMatrix<L>,
    couplings: Couplings<L>,
    touch: Touch<L>,
    /// The size of the velocities.
    size: L,
    /// e².
    returned: L,
    twists: bool,
    contour_acts: bool,
    pivoting_acts: bool,
    x: L,
    y: L,
    z: L,
    contour: L,
    pivoting: L,
    /// The least ∫u_z dτ so far.
    least: L,
    /// What has come back since: apart, or a small e would drown in the digits of the whole.
    back: L,
    rates: Rates<L>,
    /// The contact point is at rest.
    still: L::Mask,
    /// u_z >= 0.
    opening: L::Mask,
}

/// The velocities at one moment.
struct Now<L> {
    slip_x: L,
    slip_y: L,
    normal: L,
}

/// The friction of one piece.
struct Piece<L: Lane> {
    turning: L::Mask,
    /// f where it is constant.
    x: L,
    y: L,
    /// Where a straight slip stops.
    stops: L::Mask,
    length: L,
    still: L::Mask,
    drive: Drive<L>,
    contour: Torque<L>,
    pivoting: Torque<L>,
}

impl<L: Lane> Sweep<L> {
    pub(super) fn new(body: &Body, friction: &Friction, touch: &Touch<L>, e: L) -> Self {
        let k = touch.matrix(body);
        let twist = Twist::rates(body, touch);
        let zero = L::splat(0.0);
        let limits = (
            L::splat(friction.contour) / touch.sin,
            L::splat(friction.pivoting),
        );
        let off = <L::Mask as Mask>::splat(false);
        Self {
            k,
            couplings: Couplings {
                twist,
                xx: k.xx,
                xz: k.xz,
                yy: k.yy,
                rx: touch.rx,
                rz: touch.rz,
                mu: L::splat(friction.mu),
            },
            touch: *touch,
            size: touch.slip_x.abs() + touch.slip_y.abs() + touch.approach.abs(),
            returned: e * e,
            twists: friction.twists(),
            contour_acts: friction.contour > 0.0,
            pivoting_acts: friction.pivoting > 0.0,
            x: zero,
            y: zero,
            z: zero,
            contour: zero,
            pivoting: zero,
            least: zero,
            back: zero,
            rates: Rates {
                roll: Rate::new(twist.roll, limits.0),
                pivot: Rate::new(twist.pivot, limits.1),
            },
            still: off,
            opening: off,
        }
    }

    pub(super) fn impulse(&self, sin: L) -> Impulse<L> {
        Impulse {
            x: self.x,
            y: self.y,
            z: self.z,
            contour: sin * self.contour,
            pivoting: self.pivoting,
        }
    }

    #[inline(always)]
    fn now(&self) -> Now<L> {
        let (k, t) = (&self.k, &self.couplings.twist);
        Now {
            slip_x: self.touch.slip_x + k.xx * self.x + k.xz * self.z,
            slip_y: self.touch.slip_y + k.yy * self.y - t.slip_y(self.contour, self.pivoting),
            normal: self.touch.approach + k.xz * self.x + k.zz * self.z,
        }
    }

    /// One piece of path; where the impact goes on after it.
    pub(super) fn advance(&mut self, active: L::Mask) -> L::Mask {
        let now = self.now();
        let piece = self.piece(&now, active);
        let normal = Normal {
            now: now.normal,
            zz: self.k.zz,
            xz: self.k.xz,
        };
        let gain = self.k.zz + self.k.xz * piece.x;
        let line = Line {
            x: piece.x,
            y: piece.y,
            normal: now.normal,
            half_gain: gain * L::splat(0.5),
        };
        let slip = (now.slip_x, now.slip_y);
        let path = Path::new(
            piece.turning,
            &piece.drive,
            &normal,
            slip,
            line,
            piece.length,
        );
        let cut = self.cut(&path, &piece, &now, active);
        let step = path.step(cut.at);
        self.take(&step, &piece, active);
        self.switch(&cut, &piece, active)
    }

    /// The modes of friction for what comes next.
    fn piece(&mut self, now: &Now<L>, active: L::Mask) -> Piece<L> {
        let zero = L::splat(0.0);
        let mu = self.couplings.mu;
        let frictionless = mu.le(zero);
        let speed = (now.slip_x * now.slip_x + now.slip_y * now.slip_y).sqrt();
        let at_rest = (self.still | speed.le(L::splat(REST) * self.size)) & !frictionless;
        let mut fx = zero;
        let mut fy = zero;
        let mut sticks = at_rest;
        if (active & at_rest).any() {
            let still = self
                .rates
                .still(&self.couplings, active & at_rest, self.twists);
            fx = L::select(at_rest, still.x, fx);
            fy = L::select(at_rest, still.y, fy);
            sticks = at_rest & still.sticks;
        }
        let over = mu / speed;
        let slides = !at_rest & !frictionless;
        fx = L::select(slides, -(now.slip_x * over), fx);
        fy = L::select(slides, -(now.slip_y * over), fy);
        let (contour, pivoting) = if self.twists {
            self.rates.beside(&self.couplings, fy, active)
        } else {
            let none = Torque {
                by_y: zero,
                rest: zero,
            };
            (none, none)
        };
        let t = &self.couplings.twist;
        let drive = Drive {
            mu,
            xx: self.k.xx,
            yy: self.k.yy - t.slip_y(contour.by_y, pivoting.by_y),
            bx: self.k.xz,
            by: -t.slip_y(contour.rest, pivoting.rest),
        };
        let (stop_x, stop_y, until, straight, steady) = self.stop(&drive, now, fx, fy, speed);
        let stops = slides & straight;
        let keeps = slides & !straight & steady;
        fx = L::select(stops, stop_x, fx);
        fy = L::select(stops, stop_y, fy);
        // with constant f the work is back at 0, its end for e = 1, no later than here
        let gain = self.k.zz + self.k.xz * fx;
        let root =
            (now.normal * now.normal - L::splat(2.0) * gain * (self.least + self.back)).sqrt();
        let back = (root - now.normal) / gain * L::splat(1.0 + 1e-6);
        Piece {
            turning: slides & !stops & !keeps,
            x: fx,
            y: fy,
            stops,
            length: L::select(stops, until, back),
            still: sticks,
            drive,
            contour,
            pivoting,
        }
    }

    /// The constant f that brings the slip to 0, with |f| = μ, the impulse that takes, and whether
    /// the slip turns too little on its way for this to differ from the path.
    ///
    /// Over the path the mean of f is (−slip/τ − b)/K; its length falls short of μ by the order of
    /// the square of the angle between slip and slip'.
    #[inline(always)]
    fn stop(
        &self,
        drive: &Drive<L>,
        now: &Now<L>,
        fx: L,
        fy: L,
        speed: L,
    ) -> (L, L, L, L::Mask, L::Mask) {
        let zero = L::splat(0.0);
        let (dx, dy) = (drive.xx * fx + drive.bx, drive.yy * fy + drive.by);
        let along = dx * now.slip_x + dy * now.slip_y;
        let across = dx * now.slip_y - dy * now.slip_x;
        let (gx, gy) = (now.slip_x / drive.xx, now.slip_y / drive.yy);
        let (bx, by) = (drive.bx / drive.xx, drive.by / drive.yy);
        let square = gx * gx + gy * gy;
        let mixed = gx * bx + gy * by;
        let rest = drive.mu * drive.mu - (bx * bx + by * by);
        let root = mixed * mixed + square * rest;
        // 1/τ, the larger root: the first stop
        let rate = (root.max(zero).sqrt() - mixed) / square;
        let little = (speed * across * across).le(L::splat(STRAIGHT) * self.size * along * along);
        let straight = along.lt(zero) & little & zero.le(root) & zero.lt(rate);
        let until = L::splat(1.0) / rate;
        let drift = L::splat(STEADY) * drive.mu * drive.xx * speed;
        let steady = zero.le(along) & across.abs().le(drift);
        (
            -(gx * rate) - bx,
            -(gy * rate) - by,
            until,
            straight,
            steady,
        )
    }

    /// The piece up to its first event.
    fn cut(&self, path: &Path<L>, piece: &Piece<L>, now: &Now<L>, active: L::Mask) -> Cut<L> {
        let (k, t) = (&self.k, &self.couplings.twist);
        let mut cut = Cut::new(path);
        cut.by(path, active & !self.opening, Event::Turn, |s| {
            -(now.normal + k.zz * s.z + k.xz * s.x)
        });
        let missing = -(self.returned * self.least) - self.back;
        cut.by(path, active & self.opening, Event::Over, |s| {
            missing - s.work
        });
        if !self.twists {
            return cut;
        }
        let (c, p) = (&piece.contour, &piece.pivoting);
        let turns = |s: &Step<L>| {
            (
                self.contour + c.by_y * s.y + c.rest * s.z,
                self.pivoting + p.by_y * s.y + p.rest * s.z,
            )
        };
        // f_y along a turning path
        let sideways = |s: &Step<L>| {
            let x = now.slip_x + piece.drive.xx * s.x + piece.drive.bx * s.z;
            let y = now.slip_y + piece.drive.yy * s.y + piece.drive.by * s.z;
            -(self.couplings.mu * y / (x * x + y * y).sqrt())
        };
        // a rate that has just left 0 has the sign of rounding
        let none = L::splat(REST) * (self.size + t.roll.abs() + t.pivot.abs());
        if self.contour_acts {
            let roll = &self.rates.roll;
            cut.by_bent(path, active & !roll.zero, Event::Roll, |s| {
                let (c, p) = turns(s);
                let y = self.y + s.y;
                none + roll.sign * (t.roll + t.roll_y * y - t.roll_roll * c - t.roll_pivot * p)
            });
            cut.by_bent(path, active & roll.zero & piece.turning, Event::Roll, |s| {
                roll.limit - (c.by_y * sideways(s) + c.rest).abs()
            });
        }
        if self.pivoting_acts {
            let pivot = &self.rates.pivot;
            cut.by_bent(path, active & !pivot.zero, Event::Pivot, |s| {
                let (c, p) = turns(s);
                let y = self.y + s.y;
                none + pivot.sign * (t.pivot + t.pivot_y * y - t.roll_pivot * c - t.pivot_pivot * p)
            });
            cut.by_bent(
                path,
                active & pivot.zero & piece.turning,
                Event::Pivot,
                |s| pivot.limit - (p.by_y * sideways(s) + p.rest).abs(),
            );
        }
        cut
    }

    /// Adds a piece.
    #[inline(always)]
    fn take(&mut self, step: &Step<L>, piece: &Piece<L>, active: L::Mask) {
        let (c, p) = (&piece.contour, &piece.pivoting);
        let add = |sum: &mut L, part: L| *sum = L::select(active, *sum + part, *sum);
        add(&mut self.x, step.x);
        add(&mut self.y, step.y);
        add(&mut self.z, step.z);
        add(&mut self.contour, c.by_y * step.y + c.rest * step.z);
        add(&mut self.pivoting, p.by_y * step.y + p.rest * step.z);
        add(&mut self.back, step.work);
        let deeper = active & self.back.lt(L::splat(0.0));
        self.least = L::select(deeper, self.least + self.back, self.least);
        self.back = L::select(deeper, L::splat(0.0), self.back);
    }

    /// The modes after the event that ended the piece; where the impact goes on.
    #[inline(always)]
    fn switch(&mut self, cut: &Cut<L>, piece: &Piece<L>, active: L::Mask) -> L::Mask {
        let stopped = piece.stops & cut.is(Event::End);
        self.still = (self.still & !active) | ((stopped | piece.still) & active);
        let turned = active & cut.is(Event::Turn);
        let now = self.now();
        // friction may drive the point back into the surface
        let back = active & !turned & now.normal.lt(L::splat(0.0));
        self.opening = (self.opening | turned) & !back;
        if self.twists {
            let y = -(self.couplings.mu * now.slip_y)
                / (now.slip_x * now.slip_x + now.slip_y * now.slip_y).sqrt();
            let (c, p) = (&piece.contour, &piece.pivoting);
            let on = active & cut.is(Event::Roll);
            self.rates.roll.switch(on, c.by_y * y + c.rest);
            let on = active & cut.is(Event::Pivot);
            self.rates.pivot.switch(on, p.by_y * y + p.rest);
        }
        // with e = 0 nothing comes back
        let plastic = turned & self.returned.le(L::splat(0.0));
        active & !cut.is(Event::Over) & !plastic
    }
}
