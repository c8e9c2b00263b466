//! One toss on its way: its state, its counters, and what an observer sees of it.

use crate::account::{Account, Flaw};
use crate::body::{Body, Scaled};
use crate::flight::Flight;
use crate::motion::Motion;
use crate::standing::{Pause, Standing};
use crate::verdict::Rest;
use coinmc_core::{
    Breaks, Ended, Event, EventKind, Face, Launch, Observer, Outcome, sample_between,
};
use nalgebra::Vector3;

/// What the coin does between two steps, as far as events are concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Flying,
    /// It touched in the last step, for the first time.
    Struck,
    Sticking,
    Sliding,
}

/// Slip, in sqrt(g D), above which sustained contact is called sliding in events.
const SLIP: f64 = 1e-2;

/// Where the world lies in the laboratory: the plane is the same everywhere and in all directions.
/// The coin is set down in the world's middle before every contact, and does not turn while steps
/// are left out.
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
    pub(crate) rest: Rest,
    pub(crate) standing: Standing,
    /// The surface pushed in the last step.
    pub(crate) pushed: bool,
    launched: f64,
    highest: f64,
    depth: f64,
    pub(crate) impacts: u32,
    pub(crate) steps: u32,
    pub(crate) jumps: u32,
}

impl<'a, O: Observer> Toss<'a, O> {
    pub(crate) fn new(launch: &Launch, scaled: &'a Scaled, observer: O) -> Self {
        let (motion, heads_up) = Motion::launched(launch, scaled);
        let energy = motion.energy(&scaled.body);
        let toss = Self {
            scaled,
            observer,
            motion,
            place: Place {
                offset: Vector3::zeros(),
                heading: 0.0,
            },
            standing: Standing::default(),
            pushed: false,
            time: 0.0,
            heads_up,
            phase: Phase::Flying,
            rest: Rest::default(),
            launched: energy,
            highest: f64::NEG_INFINITY,
            depth: 0.0,
            impacts: 0,
            steps: 0,
            jumps: 0,
        };
        toss.begun()
    }

    fn begun(mut self) -> Self {
        self.tell(EventKind::Launched);
        self
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
                self.tell(EventKind::LiftOff);
            }
            let (from, to) = (begin * units.time_s, until * units.time_s);
            sample_between(&mut self.observer, from, to, at);
        }
        self.phase = Phase::Flying;
        self.motion = flight.at(duration);
        self.time = until;
        self.jumps += 1;
    }

    /// Moves the world's origin below the coin.
    pub(crate) fn centre(&mut self) {
        let across = Vector3::new(self.motion.position.x, self.motion.position.y, 0.0);
        self.place.offset += self.place.turned(&across);
        self.motion.position -= across;
    }

    /// Spins on, standing, while steps are left out.
    pub(crate) fn pause(&mut self, pause: &Pause) {
        let until = self.time + pause.duration;
        let (motion, rate) = (self.motion, self.motion.spin.z);
        let turned = |time: f64| -rate * libm::expm1(-pause.decay * time) / pause.decay;
        if O::ACTIVE {
            let (units, begin) = (&self.scaled.units, self.time);
            let (place, heads_up) = (self.place, self.heads_up);
            let at = |time_s: f64| {
                let time = time_s / units.time_s - begin;
                let (mut place, mut now) = (place, motion);
                place.turn(turned(time), &motion);
                now.spin.z = rate * libm::exp(-pause.decay * time);
                place.motion(&now).state(units, time_s, heads_up)
            };
            let (from, to) = (begin * units.time_s, until * units.time_s);
            sample_between(&mut self.observer, from, to, at);
        }
        self.place.turn(turned(pause.duration), &motion);
        self.motion.spin.z *= pause.left;
        self.time = until;
        self.jumps += 1;
    }

    /// Takes up what a step of the world came to.
    pub(crate) fn stepped(&mut self, step: f64, after: &Motion, impulse: f64) {
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
        self.highest = self.highest.max(energy);
        self.depth = self.depth.max(-after.gap(self.body()));
    }

    /// Before an impact, and the instants within the step that were wanted: whichever end of the
    /// step is nearer stands for them.
    fn observe(&mut self, step: f64, before: &Motion, after: &Motion, begins: bool) {
        if begins {
            self.tell(EventKind::Touching);
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
        let slip = self.motion.touch_velocity(self.body());
        let slides = (slip.x * slip.x + slip.y * slip.y).sqrt() > SLIP;
        let next = match self.phase {
            _ if begins => Phase::Struck,
            _ if impulse <= 0.0 => Phase::Flying,
            _ if slides => Phase::Sliding,
            _ => Phase::Sticking,
        };
        if O::ACTIVE && next != self.phase {
            match (self.phase, next) {
                (_, Phase::Struck) => self.tell(EventKind::Impact),
                (_, Phase::Sliding) => self.tell(EventKind::Sliding),
                (_, Phase::Sticking) => self.tell(EventKind::Sticking),
                (Phase::Struck, Phase::Flying) => {}
                (_, Phase::Flying) => self.tell(EventKind::LiftOff),
            }
        }
        self.phase = next;
    }

    /// What is wrong with the toss, if anything is.
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

    /// The most by which the energy was above its value at launch, as a fraction of that.
    fn gain(&self) -> f64 {
        (self.highest - self.launched) / self.launched
    }

    /// The face that is up.
    pub(crate) fn face(&self) -> Face {
        if self.heads_up == (self.motion.axis.z >= 0.0) {
            Face::Heads
        } else {
            Face::Tails
        }
    }

    fn tell(&mut self, kind: EventKind) {
        if O::ACTIVE {
            let units = &self.scaled.units;
            let motion = self.place.motion(&self.motion);
            let state = motion.state(units, self.time * units.time_s, self.heads_up);
            self.observer.event(&Event { kind, state });
        }
    }

    /// The account of a toss that ends here.
    pub(crate) fn end(mut self, ended: Result<Ended, Flaw>) -> Account {
        self.tell(EventKind::Ended);
        Account {
            outcome: Outcome {
                ended: ended.unwrap_or(Ended::Failed),
                impacts: self.impacts,
                contact_steps: self.steps,
                jams: 0,
                overruled: false,
                breaks: Breaks::default(),
            },
            flaw: ended.err(),
            steps: self.steps,
            jumps: self.jumps,
            energy_gain: self.gain(),
            depth: self.depth,
        }
    }
}
