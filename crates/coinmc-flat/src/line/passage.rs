//! From touch to release: steps, events between them, and what ends an impact.

use super::equations::{Body, CORNERS, Grip, LOST, Place, State};
use super::palmgren::{deepest, duration};
use crate::dormand_prince::{Step, System, growth};
use crate::impact::Record;

/// Steps after which an impact is given up. A hard impact needs some tens, the worst of the stress
/// test a few hundred.
const MAX_STEPS: u32 = 20_000;
/// A margin of friction this far below zero, in its own unit, is broken; nearer, it is rounding.
const BROKEN: f64 = 1e-12;

/// How an impact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Release {
    /// No corner touches.
    Apart,
    /// What still touches has too little energy to leave.
    Bound,
    /// Out of steps, or no numbers any more.
    GivenUp,
}

/// One impact on its way.
pub(super) struct Passage {
    pub(super) body: Body,
    pub(super) y: State,
    pub(super) time: f64,
    pub(super) record: Record,
    scale: Scale,
    /// d of the damping.
    strength: f64,
}

/// What errors are measured against.
#[derive(Clone, Copy)]
struct Scale {
    tolerance: f64,
    length: f64,
    speed: f64,
    time: f64,
    force: f64,
}

impl Passage {
    /// The first corner (number 0) touches at `approach`; `mass` is the inverse of K_zz there. The
    /// body's tangential stiffness is set here, as `ratio` of the secant stiffness at full depth.
    pub(super) fn new(
        mut body: Body,
        velocity: [f64; 3],
        (approach, mass): (f64, f64),
        (strength, ratio): (f64, f64),
        tolerance: f64,
    ) -> Self {
        // static depth under the own weight, and the speed at which a fall by it ends: slower
        // impacts are no impacts but a loading
        let resting = libm::pow(1.0 / body.stiffness, 0.9);
        let speed = approach.max(resting.sqrt());
        let length = deepest(body.stiffness, mass, speed).max(resting);
        body.tangential = ratio * body.stiffness * libm::pow(length, 1.0 / 9.0);
        let scale = Scale {
            tolerance,
            length,
            speed,
            time: duration(body.stiffness, mass, speed),
            force: body.stiffness * libm::pow(length, 10.0 / 9.0),
        };
        let mut y = [0.0; 11];
        y[3..6].copy_from_slice(&velocity);
        Self {
            body,
            y,
            time: 0.0,
            record: Record::default(),
            scale,
            strength,
        }
    }

    /// Follows the contact to its end.
    pub(super) fn follow(&mut self) -> Release {
        let before = self.energy();
        for which in 0..CORNERS {
            let at = self.body.place(&self.y, which);
            if which == 0 || (at.depth >= 0.0 && at.rate > 0.0) {
                self.touch(which);
            }
        }
        let mut h = 0.01 * self.scale.time;
        let mut rates = self.body.rates(&self.y);
        let end = loop {
            if self.record.steps == MAX_STEPS || !self.y.iter().all(|y| y.is_finite()) {
                break Release::GivenUp;
            }
            self.record.steps += 1;
            let step = Step::take(&self.body, &self.y, &rates, h);
            let error = self.error(&step);
            if error > 1.0 || error.is_nan() {
                h *= growth(error).min(0.9);
                continue;
            }
            let event = self.first_event(&step);
            let taken = event.map_or(1.0, |(share, _)| share);
            self.time += taken * h;
            if let Some((share, which)) = event {
                self.y = step.at(share);
                self.change(which);
                rates = self.body.rates(&self.y);
                // a corner that has just met the surface has a force that rises steeply
                h = h.min(0.05 * self.scale.time);
            } else {
                (self.y, rates) = (step.end, step.rates);
                h = (h * growth(error)).min(self.scale.time / 6.0);
            }
            if let Some(end) = self.end() {
                break end;
            }
        };
        let stored = |which| self.body.stored(&self.body.place(&self.y, which));
        let held: f64 = (0..CORNERS).map(stored).sum();
        self.record.imbalance = before - self.energy() - held - self.y[LOST];
        end
    }

    /// Kinetic and potential energy, the latter since the touch.
    fn energy(&self) -> f64 {
        let [_, z, _, vx, vz, omega, ..] = self.y;
        0.5 * (vx * vx + vz * vz + self.body.inertia * omega * omega) + z
    }

    /// The step's error in units of what is allowed.
    fn error(&self, step: &Step<11>) -> f64 {
        let Scale {
            tolerance,
            length,
            speed,
            ..
        } = self.scale;
        let energy = speed * speed;
        let mut worst: f64 = 0.0;
        for (i, error) in step.error.iter().enumerate() {
            let unit = match i {
                3..6 => speed,
                LOST => energy,
                _ => length,
            };
            // below this lies rounding
            let allowed = (tolerance * unit).max(4.0 * f64::EPSILON * step.end[i].abs());
            let share = error.abs() / allowed;
            // a NaN stays one
            worst = if share > worst || share.is_nan() {
                share
            } else {
                worst
            };
        }
        worst
    }

    /// The first margin that breaks in a step, and after which share of it: on its far side, so
    /// that what follows begins beyond it.
    fn first_event(&self, step: &Step<11>) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        for which in 0..2 * CORNERS {
            let after = self.margin(&step.end, which);
            if after < 0.0 {
                let share = self.crossing(step, which, after);
                if first.is_none_or(|(earliest, _)| share < earliest) {
                    first = Some((share, which));
                }
            }
        }
        first
    }

    /// The false position with Illinois's halving and some bisections, to the far end of the
    /// bracket.
    fn crossing(&self, step: &Step<11>, which: usize, end: f64) -> f64 {
        let (mut near, mut far) = (0.0, 1.0);
        let mut low = self.margin(&step.at(0.0), which).max(f64::MIN_POSITIVE);
        let mut high = end;
        for round in 0..60 {
            let cut = far - high * (far - near) / (high - low);
            // every third time a halving, lest a curved margin creeps
            let share = if round % 3 == 2 || !(cut > near && cut < far) {
                f64::midpoint(near, far)
            } else {
                cut
            };
            let margin = self.margin(&step.at(share), which);
            if margin < 0.0 {
                (far, high) = (share, margin);
                if margin > -BROKEN {
                    break;
                }
                low *= 0.5;
            } else {
                (near, low) = (share, margin.max(f64::MIN_POSITIVE));
                high *= 0.5;
            }
            if far - near < 1e-14 {
                break;
            }
        }
        far
    }

    /// A margin without unit: of clearance for the first numbers, of friction for the others.
    fn margin(&self, y: &State, which: usize) -> f64 {
        if which < CORNERS {
            return self.body.clearance(y, which) / self.scale.length;
        }
        let which = which - CORNERS;
        let unit = match self.body.corners[which].grip {
            Grip::Slides(_) => self.scale.speed,
            _ => self.scale.force,
        };
        self.body.hold(y, which) / unit + BROKEN
    }

    /// A corner changes what it does.
    fn change(&mut self, margin: usize) {
        let which = margin % CORNERS;
        match (self.body.corners[which].grip, margin < CORNERS) {
            (Grip::Apart, _) => self.touch(which),
            (_, true) => {
                self.body.corners[which].grip = Grip::Apart;
                *Body::spring(&mut self.y, which) = 0.0;
            }
            (Grip::Slides(direction), _) => {
                let normal = self.body.normal(which, &self.body.place(&self.y, which));
                *Body::spring(&mut self.y, which) =
                    direction * self.body.mu * normal / self.body.tangential;
                self.body.corners[which].grip = Grip::Sticks;
            }
            (Grip::Sticks | Grip::Smooth, _) => {
                let stretch = *Body::spring(&mut self.y, which);
                self.body.corners[which].grip = Grip::Slides(1.0_f64.copysign(stretch));
            }
        }
    }

    fn touch(&mut self, which: usize) {
        let at = self.body.place(&self.y, which);
        let corner = &mut self.body.corners[which];
        corner.damping = self.strength / at.rate.max(self.scale.speed);
        corner.grip = if self.body.mu == 0.0 {
            Grip::Smooth
        } else if at.slip == 0.0 {
            Grip::Sticks
        } else {
            Grip::Slides(1.0_f64.copysign(at.slip))
        };
        *Body::spring(&mut self.y, which) = 0.0;
    }

    /// Whether it is over, after a step; looks at the forces on the way.
    fn end(&mut self) -> Option<Release> {
        let (mut touching, mut bound) = (false, true);
        let mut force = 0.0;
        for which in 0..CORNERS {
            if self.body.corners[which].grip == Grip::Apart {
                continue;
            }
            touching = true;
            let at = self.body.place(&self.y, which);
            force += self.body.normal(which, &at);
            bound &= self.is_bound(&at);
        }
        self.record.peak_force = self.record.peak_force.max(force);
        if touching {
            bound.then_some(Release::Bound)
        } else {
            Some(Release::Apart)
        }
    }

    /// Whether a corner's motion along the normal, a mass on a spring pressed down by gravity, has
    /// too little energy to come back to the surface. Damping can only take more.
    fn is_bound(&self, at: &Place) -> bool {
        let press = 1.0 + self.y[5] * self.y[5] * at.rz;
        let mass = 1.0 / (1.0 + at.rx * at.rx / self.body.inertia);
        let energy = mass * (0.5 * at.rate * at.rate - press * at.depth) + self.body.stored(at);
        at.depth > 0.0 && press > 0.0 && energy < 0.0
    }
}
