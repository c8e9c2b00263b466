//! One toss in flight: its state, its counters, and what an observer sees of it.

use crate::account::{Account, Flaw};
use crate::flight::Flight;
use crate::motion::Motion;
use crate::rest::RestDetector;
use crate::scaled::Scaled;
use crate::standing::{StandingDetector, StandingSkip};
use coinmc_core::{
    Body, Breaks, Decided, Ended, Event, EventKind, Face, Launch, Observer, Outcome, sample_between,
};
use nalgebra::Vector3;

/// What the coin does between two steps, for events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Flying,
    /// Contact began in the last step.
    Struck,
    Sticking,
    Sliding,
}

/// Slip, in sqrt(g D), above which sustained contact is called sliding in events.
const SLIP: f64 = 1e-2;

/// Where Rapier's world lies in the laboratory. The plane is the same everywhere and in all
/// directions, so the coin is placed in the middle of the world before every contact, and the world
/// turns with a standing coin while steps are skipped.
#[derive(Debug, Clone, Copy)]
struct Place {
    offset: Vector3<f64>,
    /// Turn about the vertical, rad.
    heading: f64,
}

impl Place {
    fn turned(&self, v: &Vector3<f64>) -> Vector3<f64> {
        if self.heading == 0.0 {
            return *v;
        }
        let (s, c) = libm::sincos(self.heading);
        Vector3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z)
    }

    fn motion(&self, motion: &Motion) -> Motion {
        Motion {
            position: self.offset + self.turned(&motion.position),
            velocity: self.turned(&motion.velocity),
            axis: self.turned(&motion.axis),
            spin: self.turned(&motion.spin),
        }
    }

    /// Turned by `angle` about the coin's centre.
    fn turn(&mut self, angle: f64, motion: &Motion) {
        let before = self.turned(&motion.position);
        self.heading += angle;
        self.offset += before - self.turned(&motion.position);
    }
}

/// State and counters.
pub(crate) struct Toss<'a, O> {
    scaled: &'a Scaled,
    observer: O,
    pub(crate) motion: Motion,
    place: Place,
    pub(crate) time: f64,
    /// Whether the motion's axis is u, −u otherwise.
    heads_up: bool,
    phase: Phase,
    pub(crate) rest: RestDetector,
    pub(crate) standing: StandingDetector,
    /// The surface pushed in the last step.
    pub(crate) pushed: bool,
    launch_energy: f64,
    highest_energy: f64,
    depth: f64,
    impacts: u32,
    pub(crate) steps: u32,
    jumps: u32,
}

impl<'a, O: Observer> Toss<'a, O> {
    pub(crate) fn new(launch: &Launch, scaled: &'a Scaled, observer: O) -> Self {
        let (motion, heads_up) = Motion::launched(launch, scaled);
        let energy = motion.energy(&scaled.body);
        let mut toss = Self {
            scaled,
            observer,
            motion,
            place: Place {
                offset: Vector3::zeros(),
                heading: 0.0,
            },
            standing: StandingDetector::default(),
            pushed: false,
            time: 0.0,
            heads_up,
            phase: Phase::Flying,
            rest: RestDetector::default(),
            launch_energy: energy,
            highest_energy: f64::NEG_INFINITY,
            depth: 0.0,
            impacts: 0,
            steps: 0,
            jumps: 0,
        };
        toss.notify(EventKind::Launched);
        toss
    }

    fn body(&self) -> &'a Body {
        &self.scaled.body
    }

    pub(crate) fn energy(&self) -> f64 {
        self.motion.energy(self.body())
    }

    /// Follows a flight for a time proven free of contact.
    pub(crate) fn fly(&mut self, flight: &Flight<'_>, duration: f64) {
        let until = self.time + duration;
        if O::ACTIVE {
            let (units, begin) = (&self.scaled.units, self.time);
            let (place, heads_up) = (self.place, self.heads_up);
            let at = |time_s: f64| {
                let motion = flight.at(time_s / units.time_s - begin);
                place.motion(&motion).state(units, time_s, heads_up)
            };
            if self.phase != Phase::Flying && self.phase != Phase::Struck {
                self.notify(EventKind::LiftOff);
            }
            let (from, to) = (begin * units.time_s, until * units.time_s);
            sample_between(&mut self.observer, from, to, at);
        }
        self.phase = Phase::Flying;
        self.motion = flight.at(duration);
        self.time = until;
        self.jumps += 1;
    }

    /// Moves the origin of the world below the coin.
    pub(crate) fn centre(&mut self) {
        let across = Vector3::new(self.motion.position.x, self.motion.position.y, 0.0);
        self.place.offset += self.place.turned(&across);
        self.motion.position -= across;
    }

    /// Lets a standing coin spin on while steps are skipped.
    pub(crate) fn spin_on(&mut self, skip: &StandingSkip) {
        let until = self.time + skip.duration;
        let (motion, rate) = (self.motion, self.motion.spin.z);
        let turned = |time: f64| -rate * libm::expm1(-skip.decay_rate * time) / skip.decay_rate;
        if O::ACTIVE {
            let (units, begin) = (&self.scaled.units, self.time);
            let (place, heads_up) = (self.place, self.heads_up);
            let at = |time_s: f64| {
                let time = time_s / units.time_s - begin;
                let (mut place, mut now) = (place, motion);
                place.turn(turned(time), &motion);
                now.spin.z = rate * libm::exp(-skip.decay_rate * time);
                place.motion(&now).state(units, time_s, heads_up)
            };
            let (from, to) = (begin * units.time_s, until * units.time_s);
            sample_between(&mut self.observer, from, to, at);
        }
        self.place.turn(turned(skip.duration), &motion);
        self.motion.spin.z *= skip.remaining;
        self.time = until;
        self.jumps += 1;
    }

    /// Takes over the result of a step of the world.
    pub(crate) fn take_step(&mut self, step: f64, after: &Motion, impulse: f64) {
        let before = self.motion;
        let begins = impulse > 0.0 && self.phase == Phase::Flying;
        self.impacts = self.impacts.saturating_add(u32::from(begins));
        self.steps += 1;
        self.pushed = impulse > 0.0;
        if O::ACTIVE {
            self.observe(step, &before, after, begins);
        }
        self.time += step;
        self.motion = *after;
        self.change_phase(impulse, begins);
        let energy = self.energy();
        self.highest_energy = self.highest_energy.max(energy);
        self.depth = self.depth.max(-after.gap(self.scaled));
    }

    /// Shows the state before an impact, and those within the step that the observer wants: the
    /// state at the nearer end of the step.
    fn observe(&mut self, step: f64, before: &Motion, after: &Motion, begins: bool) {
        if begins {
            self.notify(EventKind::Touching);
        }
        let (units, begin) = (&self.scaled.units, self.time);
        let (place, heads_up) = (self.place, self.heads_up);
        let middle = (begin + 0.5 * step) * units.time_s;
        let at = |time_s: f64| {
            let nearer = if time_s < middle { before } else { after };
            place.motion(nearer).state(units, time_s, heads_up)
        };
        let (from, to) = (begin * units.time_s, (begin + step) * units.time_s);
        sample_between(&mut self.observer, from, to, at);
    }

    fn change_phase(&mut self, impulse: f64, begins: bool) {
        let slip = self.motion.contact_velocity(self.body());
        let slides = (slip.x * slip.x + slip.y * slip.y).sqrt() > SLIP;
        let next = match self.phase {
            _ if begins => Phase::Struck,
            _ if impulse <= 0.0 => Phase::Flying,
            _ if slides => Phase::Sliding,
            _ => Phase::Sticking,
        };
        if O::ACTIVE && next != self.phase {
            match (self.phase, next) {
                (_, Phase::Struck) => self.notify(EventKind::Impact),
                (_, Phase::Sliding) => self.notify(EventKind::Sliding),
                (_, Phase::Sticking) => self.notify(EventKind::Sticking),
                (Phase::Struck, Phase::Flying) => {}
                (_, Phase::Flying) => self.notify(EventKind::LiftOff),
            }
        }
        self.phase = next;
    }

    /// What is wrong with the toss, if anything.
    pub(crate) fn flaw(&self, max_gain: f64) -> Option<Flaw> {
        if !self.motion.is_finite() {
            Some(Flaw::NotFinite)
        } else if self.motion.position.z < 0.0 {
            Some(Flaw::Tunnelled)
        } else if self.gain() > max_gain {
            Some(Flaw::Exploded)
        } else {
            None
        }
    }

    /// The largest excess of the energy over its value at launch, as a fraction of that.
    fn gain(&self) -> f64 {
        (self.highest_energy - self.launch_energy) / self.launch_energy
    }

    /// The end of a toss that is decided.
    pub(crate) fn ended(&self, decided: Decided) -> Ended {
        Ended::Decided(if decided == Decided::Side {
            Face::Side
        } else {
            self.face()
        })
    }

    /// The face that is up.
    fn face(&self) -> Face {
        if self.heads_up == (self.motion.axis.z >= 0.0) {
            Face::Heads
        } else {
            Face::Tails
        }
    }

    fn notify(&mut self, kind: EventKind) {
        if O::ACTIVE {
            let units = &self.scaled.units;
            let motion = self.place.motion(&self.motion);
            let state = motion.state(units, self.time * units.time_s, self.heads_up);
            self.observer.event(&Event { kind, state });
        }
    }

    /// The account of a toss that ends here.
    pub(crate) fn end(mut self, ended: Result<Ended, Flaw>) -> Account {
        self.notify(EventKind::Ended);
        Account {
            outcome: Outcome {
                ended: ended.unwrap_or(Ended::Failed),
                impacts: self.impacts,
                contact_steps: self.steps,
                jams: 0,
                overruled: false,
                breaks: Breaks::default(),
                side_ending: None,
            },
            flaw: ended.err(),
            steps: self.steps,
            jumps: self.jumps,
            energy_gain: self.gain(),
            depth: self.depth,
        }
    }
}
