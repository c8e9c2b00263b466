//! When the face of a toss is settled: the rules of the event-driven engine in space.
//!
//! * *Energy.* To pass from a face to the side or back, the centre must rise to D at least once. So
//!   a coin whose mechanical energy is below m g D stays in the well it is in: a face if its lowest
//!   point is beyond the centre (|u_z| > H/(2D)), else the side. Rigorous as long as energy is only
//!   lost; what Rapier gains is measured, see `docs/methods/rapier.md`.
//! * *Tilting.* Energy that cannot become tilt is left out. On the side that of straight rolling,
//!   Λ²/(2(1 + k_a/R²)) with Λ = v_y − (k_a/R) ω_a, y the horizontal direction across the axis, which
//!   no impulse at the contact changes: the less of it the faster the axis will turn about the
//!   vertical, the share 1/(1 + 2Ω_z²). Flat on a face that of sliding and of spinning about u, if
//!   friction at the leading point, μ' = μ v/slip of it ahead, cannot tip the coin (μ'H/2 <= R); what
//!   is left is then not to exceed sqrt(1 + μ'²) − μ'R, as friction helps it. With μ = 0 the
//!   horizontal velocity never changes, nor does the spin about u of a coin on its side, and both
//!   are left out. Derived in `docs/methods/space.md`, *Decisions*.

use crate::body::{Body, Scaled};
use crate::motion::Motion;
use crate::settings::Decision;

/// sin of the tilt below which a coin slides and spins flat on its face.
const FLAT: f64 = 2e-3;
/// Square of the time, in sqrt(D/g), in which a rolling coin that turns topples.
const TOPPLING: f64 = 2.0;

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
    axial_factor: f64,
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
            axial_factor: scaled.axial_factor,
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
        if self.decision == Decision::Tilting {
            let (idle, barrier) = self.idle(motion, well);
            if energy - idle < barrier {
                return well;
            }
        }
        Verdict::Open
    }

    /// Energy that cannot become tilt, and what the rest must not reach.
    fn idle(&self, motion: &Motion, well: Verdict) -> (f64, f64) {
        let velocity = &motion.velocity;
        let sliding = 0.5 * (velocity.x * velocity.x + velocity.y * velocity.y);
        let axial = motion.axial();
        let spinning = 0.5 * self.body.ka * axial * axial;
        let freely = if self.slides { sliding } else { 0.0 };
        if well == Verdict::Side {
            if self.slides {
                return (freely + spinning, 1.0);
            }
            let lean = motion.lean();
            // y = z × x, x the direction u leans to
            let across = (velocity.y * motion.axis.x - velocity.x * motion.axis.y) / lean;
            let invariant = across - self.lever * axial;
            // of Ω = L/I_t: ω but for its part along the axis
            let turn = motion.spin.z + (self.axial_factor - 1.0) * axial * motion.axis.z;
            let turns = 1.0 + TOPPLING * turn * turn;
            return (self.rolling * invariant * invariant / turns, 1.0);
        }
        // friction at the leading point is along the slip there, of which spinning makes a part
        let slip = (2.0 * sliding + (self.body.radius * axial).powi(2)).sqrt();
        let ahead = if slip > 0.0 {
            self.friction * (2.0 * sliding).sqrt() / slip
        } else {
            0.0
        };
        if motion.lean() < FLAT && ahead * self.body.half <= self.body.radius {
            let barrier = (1.0 + ahead * ahead).sqrt() - ahead * self.body.radius;
            return (sliding + spinning, barrier);
        }
        (freely, 1.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Scene, Surface};
    use nalgebra::Vector3;

    /// H/R, μ = 0.3; the centre moves at `velocity` and the coin turns at `spin`, at the height
    /// at which it lies.
    fn verdict(ratio: f64, axis: Vector3<f64>, velocity: [f64; 3], spin: [f64; 3]) -> Verdict {
        let coin = Coin::cylinder(ratio, 0.01).expect("a good coin");
        let surface = Surface::new(0.5, 0.3).expect("a good surface");
        let scene = Scene::new(coin, surface, 9.81).expect("good gravity");
        let scaled = Scaled::new(&scene);
        let motion = Motion {
            position: Vector3::new(0.0, 0.0, scaled.body.rest_height(axis.z)),
            velocity: velocity.into(),
            axis,
            spin: spin.into(),
        };
        let energy = motion.energy(&scaled.body);
        Judge::new(&scaled, Decision::Tilting).verdict(&motion, energy)
    }

    /// R/D of H/R = 0.85 is 0.92: rolling at 2 has an energy of 3 beside the potential of .92.
    #[test]
    fn a_coin_that_rolls_straight_is_on_its_side_and_one_that_turns_is_not_yet() {
        let radius = 1.0 / (1.0_f64 + 0.425 * 0.425).sqrt();
        let rolls = |turn: f64| {
            let speed = -2.0;
            verdict(
                0.85,
                Vector3::x(),
                [0.0, speed, 0.0],
                [-speed / radius, 0.0, turn],
            )
        };
        assert_eq!(rolls(0.0), Verdict::Side);
        assert_eq!(rolls(0.05), Verdict::Side);
        assert_eq!(rolls(0.3), Verdict::Open);
        assert_eq!(rolls(-0.3), Verdict::Open);
    }

    /// h = .707, and friction leaves sqrt(1.09) − .3 × .707 = .832 of the barrier of 1: what rises
    /// at less than sqrt(2 × .125) = .5 cannot be tipped.
    #[test]
    fn friction_lowers_the_barrier_of_a_coin_that_slides_flat() {
        let slides = |rises: f64| verdict(2.0, Vector3::z(), [3.0, 0.0, rises], [0.0; 3]);
        assert_eq!(slides(0.49), Verdict::Face);
        assert_eq!(slides(0.51), Verdict::Open);
    }
}
