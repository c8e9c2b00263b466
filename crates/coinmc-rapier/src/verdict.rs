//! When the face of a toss is settled: the rules of the event-driven engine in space.
//!
//! * *Energy.* To pass from a face to the side or back, the centre must rise to D at least once. So
//!   a coin whose mechanical energy is below m g D stays in the well it is in: a face if its lowest
//!   point is beyond the centre (|u_z| > H/(2D)), else the side. Rigorous as long as energy is only
//!   lost; what Rapier gains is measured, see `docs/rapier.md`.
//! * *Tilting.* Energy that cannot become tilt is left out: on the side that of straight rolling,
//!   Λ²/(2(1 + k_a/R²)) with Λ = v_y − (k_a/R) ω_a, y the horizontal direction across the axis, which
//!   no impulse at the contact changes; flat on a face that of sliding and of spinning about u, if
//!   friction at the base cannot tip the coin (μH/2 <= R). With μ = 0 the horizontal velocity never
//!   changes, nor does the spin about u of a coin on its side, and both are left out.

use crate::body::{Body, Scaled};
use crate::motion::Motion;
use crate::settings::Decision;

/// sin of the tilt below which a coin slides and spins flat on its face.
const FLAT: f64 = 2e-3;

/// What is known of a toss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    Open,
    /// The face that is up now.
    Face,
    Side,
}

/// The rules in force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Judge {
    body: Body,
    decision: Decision,
    slides: bool,
    /// ½/(1 + k_a/R²) and k_a/R of straight rolling.
    rolling: f64,
    lever: f64,
    friction: f64,
}

impl Judge {
    pub(crate) fn new(scaled: &Scaled, decision: Decision) -> Self {
        let body = scaled.body;
        Self {
            body,
            decision,
            slides: scaled.friction == 0.0,
            rolling: 0.5 / (1.0 + body.ka / (body.radius * body.radius)),
            lever: body.ka / body.radius,
            friction: scaled.friction,
        }
    }

    /// The well the coin is in.
    pub(crate) fn well(&self, motion: &Motion) -> Verdict {
        if motion.axis.z.abs() < self.body.half {
            Verdict::Side
        } else {
            Verdict::Face
        }
    }

    /// Whether energy settles the face, `energy` being the whole.
    pub(crate) fn verdict(&self, motion: &Motion, energy: f64) -> Verdict {
        if self.decision == Decision::Rest {
            return Verdict::Open;
        }
        let well = self.well(motion);
        if energy < 1.0 {
            return well;
        }
        if self.decision == Decision::Tilting && energy - self.idle(motion, well) < 1.0 {
            return well;
        }
        Verdict::Open
    }

    /// Energy that cannot become tilt.
    fn idle(&self, motion: &Motion, well: Verdict) -> f64 {
        let velocity = &motion.velocity;
        let sliding = 0.5 * (velocity.x * velocity.x + velocity.y * velocity.y);
        let axial = motion.axial();
        let spinning = 0.5 * self.body.ka * axial * axial;
        let freely = if self.slides { sliding } else { 0.0 };
        if well == Verdict::Side {
            if self.slides {
                return freely + spinning;
            }
            let lean = motion.lean();
            // y = z × x, x the direction u leans to
            let across = (velocity.y * motion.axis.x - velocity.x * motion.axis.y) / lean;
            let invariant = across - self.lever * axial;
            return self.rolling * invariant * invariant;
        }
        let slip = (2.0 * sliding + (self.body.radius * axial).powi(2)).sqrt();
        let tips =
            self.friction * (2.0 * sliding).sqrt() * self.body.half > self.body.radius * slip;
        if motion.lean() < FLAT && !tips {
            return sliding + spinning;
        }
        freely
    }
}

/// Watches for rest: slow for as long as it takes the coin to topple.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rest {
    since: Option<f64>,
}

impl Rest {
    /// Whether the coin has rested at `time`.
    pub(crate) fn has_come(&mut self, motion: &Motion, body: &Body, time: f64) -> bool {
        /// Kinetic energy of a coin at rest, in the depth of its shallower well.
        const STILL: f64 = 1e-4;
        /// For this long, in sqrt(D/g).
        const LASTS: f64 = 1.0;
        let kinetic = motion.energy(body) - motion.position.z;
        if kinetic >= STILL * body.shallower_well() {
            self.since = None;
            return false;
        }
        time - *self.since.get_or_insert(time) >= LASTS
    }
}
