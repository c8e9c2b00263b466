//! Coming to rest: a coin that rocks so little that it may be laid on its side, or that stands on
//! its face and slides.

use crate::contact::{Contact, FLAT};
use crate::engine::{Onward, VolumetricEngine};
use crate::impact::ImpactLaw;
use crate::toss::Toss;
use coinmc_core::{Ended, Observer};

/// Rocking that is laid flat, as a fraction of zeno: below it in angle, speed and rate.
pub(crate) const ROCKING: f64 = 0.1;

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// Whether the coin rocks on its side so little that it may be laid down: gap, speed and rate
    /// below a tenth of zeno of the side's half width.
    #[inline]
    pub(crate) fn rocks_out(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let small = ROCKING * self.settings.zeno * self.contact.body.half;
        m.vz.abs() < small && m.cos < small && toss.spin.tilt.abs() < small
    }

    /// Lies down on the side.
    pub(crate) fn lie<O: Observer>(
        &self,
        toss: &mut Toss,
        contact: &mut Contact<'_>,
        observer: &mut O,
    ) -> Onward {
        let (motion, spin, mut adapter) = toss.watched(&self.units, observer);
        let tips = contact.lie(motion, spin, &mut adapter);
        match tips {
            Ok(this_rim) => {
                if !this_rim {
                    toss.change_rim();
                }
                Onward::Sustain
            }
            Err(leave) => self.onward(toss, leave),
        }
    }

    /// Whether the coin stands on its face but for a little rocking.
    pub(crate) fn stands(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let body = &self.contact.body;
        let small = ROCKING * self.settings.zeno * body.radius;
        m.sin < small
            && m.vz.abs() < small
            && toss.spin.tilt.abs() < small
            && toss.spin.turn.abs() < small
    }

    /// A coin that stands on its face and slides: friction at the leading point tips it where
    /// μ n_x h > R, n the slip there. Elsewhere the face counts as decided: for certain with
    /// μh <= R, nearly so beyond, as n_x may grow where sliding and spinning die away together.
    pub(crate) fn trip(&self, toss: &mut Toss) -> Onward {
        let body = &self.contact.body;
        let m = &mut toss.motion;
        let speed = (m.vx * m.vx + m.vy * m.vy).sqrt();
        let turning = body.radius * toss.spin.axial;
        let slip = (speed * speed + turning * turning).sqrt();
        if self.contact.friction.mu * speed * body.half <= body.radius * slip {
            return Onward::End(Ended::Decided(toss.face()));
        }
        let before = m.energy(body, &toss.spin);
        let (nx, ny) = (m.vx / speed, m.vy / speed);
        m.align(nx, ny);
        // a tilt to begin with: it raises the centre by no more than itself
        m.set_tilt(FLAT, 1.0);
        (m.vz, m.z) = (0.0, m.rest_height(body));
        (toss.spin.tilt, toss.spin.turn) = (0.0, 0.0);
        m.cap_energy(body, &mut toss.spin, before);
        m.set_spin(&toss.spin, self.contact.axial_factor);
        toss.place.align(nx, ny);
        Onward::Sustain
    }
}
