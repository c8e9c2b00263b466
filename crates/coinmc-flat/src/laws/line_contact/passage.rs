//! From touch to release: steps, events between them, and what ends an impact.

use super::equations::{Body, CORNERS, Grip, LOST, Place, State};
use super::scale::Scale;
use crate::dormand_prince::{Step, System, growth};
use crate::impact_law::ImpactRecord;

/// Steps after which an impact is given up. A hard impact needs some tens, the worst of the stress
/// test a few hundred.
const MAX_STEPS: u32 = 20_000;
/// Rounding of a balance of energy.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

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
    pub(super) record: ImpactRecord,
    pub(super) scale: Scale,
    tolerance: f64,
    /// Kinetic energy before, and that along the normal: what the tolerance is a share of.
    energy: f64,
    /// Energy that is accounted for: see [`Passage::balance`].
    balance: f64,
    /// The balance at the touch.
    before: f64,
    /// d of the damping.
    pub(super) strength: f64,
    /// Least speed from which damping is set: of the first touch.
    pub(super) slowest: f64,
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
        let scale = Scale::new(body.stiffness, mass, approach);
        body.tangential = ratio * body.stiffness * libm::pow(scale.length, 1.0 / 9.0);
        let mut y = [0.0; 11];
        y[3..6].copy_from_slice(&velocity);
        let kinetic = kinetic(&body, &y);
        Self {
            body,
            y,
            time: 0.0,
            record: ImpactRecord::default(),
            scale,
            tolerance,
            energy: kinetic + 0.5 * mass * scale.speed * scale.speed,
            balance: kinetic,
            before: kinetic,
            strength,
            slowest: scale.speed,
        }
    }

    /// Follows the contact to its end, or no further than `until` after the touch: `None`, and the
    /// state is that of then.
    pub(super) fn follow(&mut self, until: f64) -> Option<Release> {
        for which in 0..CORNERS {
            let at = self.body.place(&self.y, which);
            if which == 0 || (at.depth >= 0.0 && at.rate > 0.0) {
                self.touch(which);
            }
        }
        let mut h = 0.01 * self.scale.time;
        let mut rates = self.body.rates(&self.y);
        loop {
            if self.record.steps == MAX_STEPS || !self.y.iter().all(|y| y.is_finite()) {
                return Some(Release::GivenUp);
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
            // beyond the event the force is another one, which has spoiled the step
            if (1.0 - taken) * h > self.tolerance * self.scale.time {
                h *= taken;
                continue;
            }
            let y = event.map_or(step.end, |(share, _)| step.at(share));
            let balance = self.balance(&y);
            let drift = (balance - self.balance).abs() / self.allowed_drift(taken * h);
            if drift > 1.0 {
                h *= growth(drift).min(0.9);
                continue;
            }
            if self.time + taken * h > until {
                self.y = step.at((until - self.time) / h);
                self.time = until;
                return None;
            }
            self.time += taken * h;
            (self.y, self.balance) = (y, balance);
            if let Some((_, which)) = event {
                self.change(which);
                rates = self.body.rates(&self.y);
                // a corner that has just met the surface has a force that rises steeply
                h = h.min(0.05 * self.scale.time);
            } else {
                rates = step.rates;
                h = (h * growth(error.max(drift))).min(self.scale.time / 6.0);
            }
            let end = self.end();
            if end.is_some() {
                return end;
            }
        }
    }

    /// What the integration lost track of: no change of grip moves the balance.
    pub(super) fn imbalance(&self) -> f64 {
        self.before - self.balance
    }

    /// The energy, what is stored in the corners, and what damping and friction have taken (what is
    /// in the springs along the surface counts as taken): constant, but for the integration's error.
    fn balance(&self, y: &State) -> f64 {
        let stored = |which| self.body.stored(&self.body.place(y, which));
        kinetic(&self.body, y) + y[1] + (0..CORNERS).map(stored).sum::<f64>() + y[LOST]
    }

    /// By how much the balance may drift in a time: by the tolerance's share of the energy in the time
    /// that one impact takes; below it lies rounding.
    fn allowed_drift(&self, time: f64) -> f64 {
        self.energy * (self.tolerance * time / self.scale.time).max(ROUNDING)
    }

    /// The step's error in units of what is allowed.
    fn error(&self, step: &Step<11>) -> f64 {
        let Scale { length, speed, .. } = self.scale;
        let energy = speed * speed;
        let mut worst: f64 = 0.0;
        for (i, error) in step.error.iter().enumerate() {
            let unit = match i {
                3..6 => speed,
                LOST => energy,
                _ => length,
            };
            // below this lies rounding
            let allowed = (self.tolerance * unit).max(4.0 * f64::EPSILON * step.end[i].abs());
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

    /// Whether it is over, after a step; looks at the forces on the way.
    fn end(&mut self) -> Option<Release> {
        let down = self.body.corners.map(|corner| corner.grip != Grip::Apart);
        let (mut bound, mut force, mut stored) = (true, 0.0, 0.0);
        for which in (0..CORNERS).filter(|which| down[*which]) {
            let at = self.body.place(&self.y, which);
            force += self.body.normal(which, &at);
            stored += self.body.stored(&at);
            bound &= self.is_bound(&at);
        }
        self.record.peak_force = self.record.peak_force.max(force);
        if down == [false; CORNERS] {
            Some(Release::Apart)
        } else {
            (bound || self.is_laid_down(down, stored)).then_some(Release::Bound)
        }
    }

    /// Whether a corner's motion along the normal, a mass on a spring pressed down by gravity, has
    /// too little energy to come back to the surface. Damping can only take more.
    fn is_bound(&self, at: &Place) -> bool {
        let press = 1.0 + self.y[5] * self.y[5] * at.rz;
        let energy = self.body.mass(at) * (0.5 * at.rate * at.rate - press * at.depth)
            + self.body.stored(at);
        at.depth > 0.0 && press > 0.0 && energy < 0.0
    }

    /// Whether the coin has too little energy to leave the surface as a whole: all but that of sliding
    /// is less than it takes to lie flat on the edge between the corners that are down. (Two corners
    /// that share the weight pass energy to and fro, so that neither is bound by itself.) Friction
    /// may still make it trip: so may the rigid coin that follows.
    fn is_laid_down(&self, down: [bool; CORNERS], stored: f64) -> bool {
        let corners = &self.body.corners;
        let edge = |(i, j): (usize, usize)| {
            let (x, z) = (corners[i].x + corners[j].x, corners[i].z + corners[j].z);
            0.5 * (x * x + z * z).sqrt()
        };
        let edges = [(0, 1), (0, 2), (3, 1), (3, 2)];
        let both = edges.into_iter().find(|&(i, j)| down[i] && down[j]);
        let flat = both.map_or_else(|| edge(edges[0]).min(edge(edges[1])), edge);
        let [_, z, _, _, vz, omega, ..] = self.y;
        let moving = 0.5 * (vz * vz + self.body.inertia * omega * omega);
        // the centre is above the first corner by its own height at the touch
        moving + stored + (z - corners[0].z) < flat
    }
}

fn kinetic(body: &Body, y: &State) -> f64 {
    let [_, _, _, vx, vz, omega, ..] = *y;
    0.5 * (vx * vx + vz * vz + body.inertia * omega * omega)
}
