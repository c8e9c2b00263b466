//! Whole tosses in fixed steps: Moreau–Jean time stepping.
//!
//! Away from the surface the coin moves freely (exactly) by times in which it cannot arrive. A rim
//! point that arrives collides. Points that rest on the surface make a step of contact: half a
//! step of free motion, the impulses of gravity and of all contacts together, another half.
//!
//! The textbook scheme asks that the velocity *after* the step obey the constraints. That loses
//! energy at a rate proportional to the step (½h(J'v)²/K), which acts as rolling friction and at
//! e = 0 outweighs the real one unless the step is tiny. Here a contact that already rests, or
//! sticks, obeys them with the *mean* of the velocities before and after: the work of the impulses
//! is then that of friction alone, nothing is lost, and the scheme is of second order. A contact
//! that comes to rest or to stick does so with its velocity after the step, or the difference
//! would never die out. What is left of the gap, of third order in the step, is taken back by
//! lifting the coin.
//!
//! Moreau, "Unilateral contact and dry friction in finite freedom dynamics" (1988); Jean, "The
//! non-smooth contact dynamics method", Comput. Methods Appl. Mech. Engrg. 177 (1999) 235.

use crate::coulomb::{Contacts, LAWS, NORMAL, ROWS};
use crate::decision::{decided, leans_towards};
use crate::impact::collide;
use crate::points::{OPPOSITE, POINTS, Point, points};
use crate::{Model, Motion};
use coinmc_core::{Face, Launch, Scene, State};
use nalgebra::Vector3;

/// Gap at which a point touches.
const TOUCH: f64 = 1e-8;
/// Approach speed below which a point does not arrive.
const APPROACH: f64 = 1e-10;
/// Speed below which a point counts as stopped by an impact.
const STOPPED: f64 = 1e-9;
/// Rate, in sqrt(g/D), above which steps of contact shrink in proportion.
const FAST: f64 = 4.0;
/// Largest turn of the axis in a step, as a fraction of the sine of its tilt: near level a small
/// turn makes another point of the rim the lowest.
const SWING: f64 = 0.2;
/// Sine of the tilt below which `SWING` no longer shortens steps: the gap is of the order of
/// `TOUCH`.
const LEVEL: f64 = 5e-8;

/// Kinetic energy below which a coin on a tilted table rests, if it stays there for this time.
const AT_REST: f64 = 1e-6;
const REST_TIME: f64 = 3.0;

/// How finely tosses are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepperSettings {
    /// Step in contact, sqrt(D/g). A rebound slower than this in sqrt(gD), whose flight the step
    /// could not resolve, does not take place.
    pub step: f64,
    /// Time after which a toss is given up, sqrt(D/g). Without rolling friction coins may roll on
    /// their side forever, and end here.
    pub time_limit: f64,
}

impl Default for StepperSettings {
    fn default() -> Self {
        Self {
            step: 4e-3,
            time_limit: 3e3,
        }
    }
}

/// How a toss went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    /// The face; `None` at the limit of time.
    pub face: Option<Face>,
    /// Impacts, without those that are too slow to rebound and only begin a contact.
    pub impacts: u32,
    /// Impacts in which Newton's law would have gained energy.
    pub substituted: u32,
    /// Steps of contact.
    pub steps: u64,
    /// Steps of contact whose impulses did not converge.
    pub unconverged: u64,
    /// The state at the end.
    pub end: State,
}

/// Follows tosses of one scene in fixed steps.
#[derive(Debug)]
pub struct TimeStepper {
    scene: Scene,
    model: Model,
    settings: StepperSettings,
    contacts: Contacts,
}

impl TimeStepper {
    /// A stepper for a scene. Adhesive landing is ignored: the coin bounces.
    pub fn new(scene: &Scene, settings: StepperSettings) -> Self {
        Self {
            scene: *scene,
            model: Model::new(scene),
            settings,
            contacts: Contacts::new(),
        }
    }

    /// The scene without units.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Follows a toss until energy decides its face; on a tilted table, where it does not, until the coin
    /// rests. A coin that moves there until the limit of time, most likely rolling down, counts as it leans
    /// then.
    pub fn toss(&mut self, launch: &Launch) -> History {
        let mut toss = Toss::new(Motion::launched(&self.scene, launch));
        let tilted = self.model.pull != Vector3::zeros();
        let mut moved_at = 0.0;
        let face = loop {
            if !tilted && let Some(face) = decided(&self.model, &toss.motion) {
                break Some(face);
            }
            if toss.motion.kinetic(&self.model) > AT_REST {
                moved_at = toss.time;
            }
            if tilted && toss.time > moved_at + REST_TIME {
                break Some(leans_towards(&self.model, &toss.motion));
            }
            if toss.time >= self.settings.time_limit || toss.time.is_nan() {
                break tilted.then(|| leans_towards(&self.model, &toss.motion));
            }
            self.advance(&mut toss);
        };
        History {
            face,
            impacts: toss.impacts,
            substituted: toss.substituted,
            steps: toss.steps,
            unconverged: toss.unconverged,
            end: toss.motion.state(&self.scene, toss.time),
        }
    }

    /// Follows a motion for a time, decided or not, and calls `visit` with every state: for checks
    /// of the stepper against known motions.
    pub fn follow(&mut self, start: Motion, time: f64, mut visit: impl FnMut(f64, &Motion)) {
        let mut toss = Toss::new(start);
        while toss.time < time {
            self.advance(&mut toss);
            visit(toss.time, &toss.motion);
        }
    }

    /// An impact, a step of contact or a piece of flight.
    fn advance(&mut self, toss: &mut Toss) {
        let points = points(&self.model, &toss.motion);
        if toss.arrives(&points, self.settings.step) {
            self.collide(toss, &points);
        } else if toss.rests() {
            self.rest(toss, &points);
        } else {
            toss.fly(&self.model, &points, self.settings.step);
        }
    }

    fn collide(&mut self, toss: &mut Toss, points: &[Point; POINTS]) {
        let (contacts, motion) = (&mut self.contacts, &mut toss.motion);
        // a point that parts from the surface takes no part, however near it still is
        let touching: [bool; POINTS] = std::array::from_fn(|index| {
            let point = &points[index];
            let stays = toss.resting[index].is_some() || point.velocity(motion).z < -APPROACH;
            stays && touches(points, motion, index)
        });
        let of_touching = |(point, touches): (_, bool)| touches.then_some(point);
        contacts.gather(
            &self.model,
            motion,
            points
                .iter()
                .zip(touching)
                .filter_map(of_touching)
                .map(Point::touch),
        );
        let approach = points
            .iter()
            .zip(touching)
            .filter_map(of_touching)
            .map(|point| -point.velocity(motion).z)
            .fold(0.0, f64::max);
        let lawful = collide(&self.model, motion, contacts, self.settings.step);
        toss.substituted += u32::from(!lawful);
        toss.impacts += u32::from(approach > self.settings.step);
        for (index, point) in points.iter().enumerate() {
            let v = point.velocity(motion);
            let stopped = touching[index] && v.z.abs() <= STOPPED;
            toss.resting[index] = stopped.then(|| Resting {
                impulse: [0.0; ROWS],
                stuck: [
                    v.xy().norm() <= STOPPED,
                    point.wander.dot(&motion.spin).abs() <= STOPPED,
                    motion.spin.z.abs() <= STOPPED,
                ],
            });
        }
    }

    /// A step of contact.
    fn rest(&mut self, toss: &mut Toss, now: &[Point; POINTS]) {
        let h = toss.step(now, self.settings.step);
        let mut motion = toss.motion;
        motion.drift(&self.model, h / 2.0);
        let middle = points(&self.model, &motion);
        let contacts = &mut self.contacts;
        let resting = |index: &usize| toss.resting[*index].is_some();
        let held: [usize; POINTS] = std::array::from_fn(|index| index);
        contacts.gather(
            &self.model,
            &motion,
            held.iter()
                .filter(|&i| resting(i))
                .map(|&i| middle[i].touch()),
        );
        for (contact, rest) in toss.resting.iter().flatten().enumerate() {
            contacts.impulse[contact * ROWS..][..ROWS].copy_from_slice(&rest.impulse);
        }
        let converged = solve_step(&self.model, contacts, &toss.resting, h);
        contacts.apply(&mut motion);
        motion.velocity += (self.model.pull - Vector3::z()) * h;
        motion.drift(&self.model, h / 2.0);
        toss.take_over(&self.model, contacts, motion);
        toss.time += h;
        toss.steps += 1;
        toss.unconverged += u64::from(!converged);
    }
}

/// The impulses of a step of contact. Rows that newly stick do so with their velocity after the
/// step.
fn solve_step(
    model: &Model,
    contacts: &mut Contacts,
    resting: &[Option<Resting>; POINTS],
    h: f64,
) -> bool {
    for row in 0..contacts.rows() {
        contacts.offset[row] = 2.0 * contacts.before[row] + contacts.weigh(row, model, h);
    }
    let mut converged = contacts.solve(model);
    let mut again = false;
    for (contact, rest) in resting.iter().flatten().enumerate() {
        let stuck = contacts.stuck(model, contact);
        for (law, rows) in LAWS.iter().enumerate() {
            if stuck[law] && !rest.stuck[law] {
                for row in rows.clone() {
                    let row = contact * ROWS + row;
                    contacts.offset[row] = contacts.before[row] + contacts.weigh(row, model, h);
                }
                again = true;
            }
        }
    }
    if again {
        converged = contacts.solve(model);
    }
    converged
}

/// A point that rests on the surface.
#[derive(Debug, Clone, Copy)]
struct Resting {
    /// Impulses of the last step, from which the next solution starts.
    impulse: [f64; ROWS],
    /// Which of the laws of friction held it still.
    stuck: [bool; 3],
}

/// Whether a point is near enough to touch. The two between the lowest and the one opposite come
/// second to both: while the coin goes flat they are nearer than the one opposite, and would turn
/// it over if they stopped it first.
fn touches(points: &[Point; POINTS], motion: &Motion, index: usize) -> bool {
    let near = |index: usize| points[index].gap(motion) <= TOUCH;
    near(index) && (index <= OPPOSITE || near(OPPOSITE))
}

/// A toss in flight or contact.
#[derive(Debug)]
struct Toss {
    motion: Motion,
    time: f64,
    resting: [Option<Resting>; POINTS],
    impacts: u32,
    substituted: u32,
    steps: u64,
    unconverged: u64,
}

impl Toss {
    fn new(motion: Motion) -> Self {
        Self {
            motion,
            time: 0.0,
            resting: [None; POINTS],
            impacts: 0,
            substituted: 0,
            steps: 0,
            unconverged: 0,
        }
    }

    fn rests(&self) -> bool {
        self.resting.iter().any(Option::is_some)
    }

    /// Whether a point touches that approaches: any that did not rest, or one that did and is
    /// pushed in faster than a step's own error.
    fn arrives(&self, points: &[Point; POINTS], step: f64) -> bool {
        (0..POINTS).any(|index| {
            let least = if self.resting[index].is_some() {
                0.5 * step
            } else {
                APPROACH
            };
            touches(points, &self.motion, index) && points[index].velocity(&self.motion).z < -least
        })
    }

    /// Length of a step of contact: shorter where the coin turns fast or another point arrives.
    fn step(&self, points: &[Point; POINTS], longest: f64) -> f64 {
        let motion = &self.motion;
        let swing = motion.spin.cross(&motion.axis).norm();
        let rate = motion.spin.norm() + swing / motion.sine().max(1e-4);
        let level = SWING * motion.sine().max(LEVEL) / swing;
        let mut step = (longest / (rate / FAST).max(1.0)).min(level);
        for (point, resting) in points.iter().zip(&self.resting) {
            let approach = -point.velocity(motion).z;
            if resting.is_none() && approach > 0.0 {
                step = step.min(point.gap(motion).max(0.5 * TOUCH) / approach);
            }
        }
        step
    }

    /// Takes over the state after a step of contact, and which points still rest.
    fn take_over(&mut self, model: &Model, contacts: &Contacts, motion: Motion) {
        self.motion = motion;
        let after = points(model, &self.motion);
        let mut contact = 0;
        let mut lowest = f64::INFINITY;
        for (point, slot) in after.iter().zip(&mut self.resting) {
            let Some(resting) = slot else { continue };
            let impulse = &contacts.impulse[contact * ROWS..][..ROWS];
            if impulse[NORMAL] > 0.0 {
                resting.impulse.copy_from_slice(impulse);
                resting.stuck = contacts.stuck(model, contact);
                lowest = lowest.min(point.gap(&self.motion));
            } else {
                *slot = None;
            }
            contact += 1;
        }
        if lowest == f64::INFINITY {
            return;
        }
        self.motion.position.z -= lowest;
        for (point, slot) in after.iter().zip(&mut self.resting) {
            if point.gap(&self.motion) > 10.0 * TOUCH {
                *slot = None;
            }
        }
    }

    /// Flies for a time in which nothing can arrive, or until the gap is `TOUCH` wide.
    ///
    /// No point comes down faster than −v_z + |ω| + t, since none is farther than 1 from the
    /// centre. Close to the surface steps as long as what changes the gap by half of `TOUCH`.
    fn fly(&mut self, model: &Model, points: &[Point; POINTS], step: f64) {
        let motion = &mut self.motion;
        let gap = motion.gap(model).max(0.0);
        let bound = (-motion.velocity.z).max(0.0) + motion.spin.norm();
        let safe = 2.0 * gap / (bound + (bound * bound + 2.0 * gap).sqrt());
        let speed = |point: &Point| point.velocity(motion).z.abs();
        let fastest = points.iter().map(speed).fold(0.0, f64::max);
        let time = safe.max(0.5 * TOUCH / (fastest + step));
        motion.fly(model, time);
        self.time += time;
    }
}
