//! From step to step: flight, steps of contact, impacts.
//!
//! Near the ground the coin moves in steps. After each one both rims are searched for minima; if a
//! point that did not rest has gone into the ground, the step is shortened until it just touches,
//! and collides. High above the ground flight is skipped in closed form.
//!
//! What touches are the rims: a crest that rises between them, under the mantle or a face, is not
//! felt. Friction, restitution and the friction lengths are those of
//! [`TimeStepper`](crate::TimeStepper), with the ground's normal at the point in place of the vertical.

use crate::coulomb::{Contacts, MOST, ROWS};
use crate::ground::Ground;
use crate::impact::collide;
use crate::rough::decision::{Ending, Quiet, decided};
use crate::rough::rim::{Minimum, Rim};
use crate::rough::step::{Resting, State};
use crate::{Model, Motion};
use coinmc_core::{Face, Launch, Scene};

/// Gap at which a point touches.
const TOUCH: f64 = 2e-8;
/// Depth that a point that touches may have.
const DEEP: f64 = 4.0 * TOUCH;
/// Gap that larger ones count as while the time of an impact is looked for.
const FAR: f64 = 1e-3;
/// Approach speed below which a point does not arrive.
const APPROACH: f64 = 1e-10;
/// Speed below which a point counts as stopped by an impact.
const STOPPED: f64 = 1e-9;
/// Speed below which a point that parts after an impact is held: rocking so slow lifts the rims of a
/// thin coin by no more than about `TOUCH`.
const HELD: f64 = 3e-5;
/// Rate, in sqrt(g/D), above which steps shrink in proportion.
const FAST: f64 = 4.0;
/// Largest turn of the axis in a step, as a fraction of the sine of its tilt.
const SWING: f64 = 0.2;
/// Sine of the tilt below which `SWING` no longer shortens steps.
const LEVEL: f64 = 1e-2;
/// Heights in σ above which no ground rises.
const HIGHEST: f64 = 6.0;
/// Bracket of an impact's time that is not narrowed further.
const SHORTEST: f64 = 1e-14;
/// Attempts at the time of an impact, which halves or better with each.
const MOST_ATTEMPTS: u32 = 60;

/// Pieces of flight, steps and impacts after which a toss is given up: a hundred times as many as usual.
const MOST_PIECES: u64 = 5_000_000;

/// How finely tosses onto rough ground are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughSettings {
    /// Longest step near the ground, sqrt(D/g). A rebound slower than this in sqrt(gD) does not
    /// take place.
    pub step: f64,
    /// Longest way of the contact along the ground in a step, in ℓ.
    pub advance: f64,
    /// Time after which a toss is given up, sqrt(D/g).
    pub time_limit: f64,
}

impl Default for RoughSettings {
    fn default() -> Self {
        Self {
            step: 4e-3,
            advance: 0.1,
            time_limit: 3e3,
        }
    }
}

/// How a toss onto rough ground went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughHistory {
    /// The face; `None` at the limit of time or steps.
    pub face: Option<Face>,
    /// What ended it.
    pub ending: Ending,
    /// Time at the end, sqrt(D/g).
    pub time: f64,
    /// Way of the centre along the mean plane, D.
    pub way: f64,
    /// Impacts that rebound.
    pub impacts: u32,
    /// Steps of contact.
    pub steps: u64,
    /// Steps of contact whose impulses did not converge.
    pub unconverged: u64,
    /// Energy that steps had gained and that was taken back, together, mgD.
    pub returned: f64,
    /// Largest gain of energy from one event to the next after that, mgD: rounding.
    pub gained: f64,
    /// The motion at the end.
    pub end: Motion,
}

/// Follows tosses of one scene onto rough grounds.
///
/// # Example
/// A coin that rolls upright falls over on ground as rough as this:
/// ```
/// use coinmc_core::{Coin, Face, Scene, Surface};
/// use coinmc_oracle::{RoughSettings, RoughStepper, Start};
///
/// let surface = Surface::new(0.5, 0.3)?.with_friction_lengths(5e-5, 5e-6)?;
/// let coin = Coin::cylinder(0.2, 0.0116)?;
/// let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2)?;
/// let mut stepper = RoughStepper::new(&scene, RoughSettings::default());
/// let mut ground = stepper.ground(0.06, 3e-3, 1);
/// let history = stepper.placed(&Start::Rolling(0.3).launch(&coin, 1e-3), &mut ground);
/// assert_ne!(history.face, Some(Face::Side));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RoughStepper {
    scene: Scene,
    model: Model,
    settings: RoughSettings,
    contacts: Contacts,
    found: Vec<Minimum>,
}

/// A toss on its way.
#[derive(Debug)]
struct Toss {
    state: State,
    pieces: u64,
    time: f64,
    way: f64,
    impacts: u32,
    steps: u64,
    unconverged: u64,
    returned: f64,
    gained: f64,
}

impl RoughStepper {
    /// A stepper for a scene. Adhesive landing is ignored: the coin bounces.
    pub fn new(scene: &Scene, settings: RoughSettings) -> Self {
        Self {
            scene: *scene,
            model: Model::new(scene),
            settings,
            contacts: Contacts::new(),
            found: Vec::new(),
        }
    }

    /// The scene without units.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// A rough ground in the scene's unit of length, from its rms slope, wavelength λ = 2πℓ in metres
    /// and seed.
    pub fn ground(&self, slope: f64, wavelength_m: f64, seed: u64) -> Ground {
        let length = wavelength_m / std::f64::consts::TAU / self.scene.coin.rim_distance_m();
        Ground::new(slope, length, seed)
    }

    /// Follows a toss until its face is decided. A coin that would begin inside the ground is
    /// lifted until it touches.
    pub fn toss(&mut self, launch: &Launch, ground: &mut Ground) -> RoughHistory {
        let start = Motion::launched(&self.scene, launch);
        let gap = self.gap(&start, ground);
        self.run(start, -gap.min(0.0), ground)
    }

    /// The same from a launch that begins on the ground: lifted or lowered until it touches.
    pub fn placed(&mut self, launch: &Launch, ground: &mut Ground) -> RoughHistory {
        let start = Motion::launched(&self.scene, launch);
        let gap = self.gap(&start, ground);
        self.run(start, -gap, ground)
    }

    fn run(&mut self, mut start: Motion, lift: f64, ground: &mut Ground) -> RoughHistory {
        start.position.z += lift;
        let mut toss = Toss::new(start);
        let mut quiet = Quiet::default();
        let (face, ending) = loop {
            let motion = &toss.state.motion;
            if let Some(face) = decided(&self.model, ground.deviation(), motion) {
                break (Some(face), Ending::Energy);
            }
            let carrying = toss.state.resting.iter().map(|resting| &resting.minimum);
            if quiet.settled(&self.model, motion, carrying, toss.time) {
                break (Some(Face::Side), Ending::Rest);
            }
            let endless = toss.time >= self.settings.time_limit || toss.pieces >= MOST_PIECES;
            if endless || toss.time.is_nan() {
                break (None, Ending::Limit);
            }
            self.advance(&mut toss, ground);
        };
        toss.history(face, ending)
    }

    /// Follows a motion for a time, decided or not, and calls `visit` with every state.
    pub fn follow(
        &mut self,
        start: Motion,
        ground: &mut Ground,
        time: f64,
        mut visit: impl FnMut(f64, &Motion),
    ) -> RoughHistory {
        let mut toss = Toss::new(start);
        while toss.time < time {
            self.advance(&mut toss, ground);
            visit(toss.time, &toss.state.motion);
        }
        toss.history(None, Ending::Limit)
    }

    /// Height of the nearest point of the rims above the ground below it.
    pub fn gap(&mut self, motion: &Motion, ground: &mut Ground) -> f64 {
        // low enough for the ground to reach it, whatever its height
        let mut low = *motion;
        let drop = motion.gap(&self.model);
        low.position.z -= drop;
        let state = State {
            motion: low,
            resting: Vec::new(),
        };
        drop + self.nearest(&state, ground)
    }

    /// Searches both rims for points that do not rest, into `found`, and returns the smallest gap.
    fn nearest(&mut self, state: &State, ground: &mut Ground) -> f64 {
        let mut known = [None; MOST];
        for (slot, resting) in known.iter_mut().zip(&state.resting) {
            *slot = Some(resting.minimum);
        }
        self.found.clear();
        for end in [-1.0, 1.0] {
            let rim = Rim::new(&self.model, &state.motion, end);
            rim.search(ground, &known, TOUCH, &mut self.found);
        }
        self.found
            .iter()
            .fold(f64::INFINITY, |least, minimum| least.min(minimum.gap))
    }

    /// A piece of flight, or a step that may end with an impact.
    fn advance(&mut self, toss: &mut Toss, ground: &mut Ground) {
        toss.pieces += 1;
        let h = self.step(&toss.state.motion, ground);
        let safe = self.safe(&toss.state, ground);
        if safe > h {
            return toss.fly(&self.model, safe);
        }
        let mut after = toss.state.clone();
        let mut converged = self.attempt(&mut after, ground, h);
        let mut time = h;
        if self.enters(&after, ground) {
            let gap = self.nearest(&toss.state, ground);
            if self.arrives(&toss.state) {
                return self.collide(toss);
            }
            if gap >= -TOUCH {
                (after, time, converged) = self.until_touch(&toss.state, gap, h, ground);
            }
        }
        toss.accept(&self.model, after, time, converged);
        let pressed = toss.state.resting.iter();
        let pushed = pressed.fold(0.0, |most: f64, resting| {
            most.max(resting.minimum.approach(&toss.state.motion))
        });
        if pushed > 0.5 * self.settings.step || (time < h && self.arrives(&toss.state)) {
            self.collide(toss);
        }
    }

    /// A step from a state, of contact or free.
    fn attempt(&mut self, state: &mut State, ground: &mut Ground, h: f64) -> bool {
        if state.resting.is_empty() {
            state.motion.fly(&self.model, h);
            true
        } else {
            state.step(&self.model, ground, &mut self.contacts, h)
        }
    }

    /// Whether a point that does not rest is inside the ground and goes deeper.
    fn enters(&mut self, state: &State, ground: &mut Ground) -> bool {
        self.nearest(state, ground) < -TOUCH
            && self
                .found
                .iter()
                .any(|m| m.gap < -TOUCH && m.approach(&state.motion) > APPROACH)
    }

    /// Whether one of the points found touches and approaches.
    fn arrives(&self, state: &State) -> bool {
        self.found
            .iter()
            .any(|m| m.gap <= TOUCH && m.approach(&state.motion) > APPROACH)
    }

    /// The step shortened until a point just touches: regula falsi (Illinois), safeguarded.
    fn until_touch(
        &mut self,
        start: &State,
        gap: f64,
        h: f64,
        ground: &mut Ground,
    ) -> (State, f64, bool) {
        let mut high = start.clone();
        let mut converged = self.attempt(&mut high, ground, h);
        let (mut low, mut above) = (0.0, gap.clamp(0.5 * TOUCH, FAR));
        let mut late = h;
        let mut depth = self.nearest(&high, ground);
        // halved while the other end of the bracket stays, as Illinois does
        let mut below = depth;
        for attempt in 0..MOST_ATTEMPTS {
            let width = late - low;
            if depth >= -TOUCH || width < SHORTEST {
                break;
            }
            let guess = (low * below - late * above) / (below - above);
            let guess = guess.clamp(low + 1e-3 * width, late - 1e-3 * width);
            let time = if attempt % 4 == 3 {
                low + 0.5 * width
            } else {
                guess
            };
            let mut state = start.clone();
            let good = self.attempt(&mut state, ground, time);
            let gap = self.nearest(&state, ground);
            if gap > 0.0 || !self.arrives(&state) {
                (low, above) = (time, gap.clamp(0.5 * TOUCH, FAR));
                below *= 0.5;
            } else {
                (late, depth, high, converged) = (time, gap, state, good);
                below = depth;
                above *= 0.5;
            }
        }
        // `found` belongs to the last attempt
        self.nearest(&high, ground);
        (high, late, converged)
    }

    /// An impact of the points found that arrive, together with those that rest.
    fn collide(&mut self, toss: &mut Toss) {
        let state = &mut toss.state;
        let motion = &mut state.motion;
        let energy = motion.energy(&self.model);
        let mut touching = touching(state.resting.iter(), &self.found, motion);
        self.found.clear();
        raise(motion, &mut touching);
        let axis = motion.axis;
        let touches = touching.iter().map(|minimum| minimum.touch(&axis));
        self.contacts.gather(&self.model, motion, touches);
        let approach = touching
            .iter()
            .fold(0.0, |most: f64, m| most.max(m.approach(motion)));
        collide(&self.model, motion, &mut self.contacts, self.settings.step);
        let (excess, sunk) = restrain(&self.model, motion, energy);
        toss.returned += excess;
        toss.gained = toss.gained.max(motion.energy(&self.model) - energy);
        toss.impacts += u32::from(approach > self.settings.step);
        let rests = |minimum: &Minimum| minimum.approach(motion).abs() <= HELD;
        state.resting = touching
            .into_iter()
            .filter(rests)
            .map(|minimum| resting(minimum, motion, sunk))
            .collect();
    }

    /// A time of flight in which the ground cannot be reached: no point comes down faster than
    /// −v_z + |ω| + t, since none is farther than 1 from the centre.
    fn safe(&self, state: &State, ground: &Ground) -> f64 {
        let motion = &state.motion;
        let gap = motion.gap(&self.model) - HIGHEST * ground.deviation();
        if !state.resting.is_empty() || gap <= 0.0 {
            return 0.0;
        }
        let bound = (-motion.velocity.z).max(0.0) + motion.spin.norm();
        2.0 * gap / (bound + (bound * bound + 2.0 * gap).sqrt())
    }

    /// Length of a step: shorter where the coin turns fast or the contact goes far.
    fn step(&self, motion: &Motion, ground: &Ground) -> f64 {
        let swing = motion.spin.cross(&motion.axis).norm();
        let sine = motion.sine().max(LEVEL);
        let rate = motion.spin.norm() + swing / sine;
        let step = (self.settings.step / (rate / FAST).max(1.0)).min(SWING * sine / swing);
        if ground.is_flat() {
            return step;
        }
        let reach = self.model.half + self.model.radius * motion.axis.z.abs() / sine;
        let speed = motion.velocity.xy().norm() + swing * reach;
        step.min(self.settings.advance * ground.correlation_length() / speed)
    }
}

impl Toss {
    fn new(motion: Motion) -> Self {
        Self {
            state: State {
                motion,
                resting: Vec::new(),
            },
            pieces: 0,
            time: 0.0,
            way: 0.0,
            impacts: 0,
            steps: 0,
            unconverged: 0,
            returned: 0.0,
            gained: 0.0,
        }
    }

    fn fly(&mut self, model: &Model, time: f64) {
        let before = self.state.motion.position;
        self.state.motion.fly(model, time);
        self.way += (self.state.motion.position - before).xy().norm();
        self.time += time;
    }

    /// Takes over the state after a step.
    fn accept(&mut self, model: &Model, mut after: State, time: f64, converged: bool) {
        let before = &self.state.motion;
        if !self.state.resting.is_empty() {
            let energy = before.energy(model);
            let (excess, sunk) = restrain(model, &mut after.motion, energy);
            self.returned += excess;
            for resting in &mut after.resting {
                resting.distance -= sunk;
            }
            self.gained = self.gained.max(after.motion.energy(model) - energy);
            self.steps += 1;
            self.unconverged += u64::from(!converged);
        }
        self.way += (after.motion.position - before.position).xy().norm();
        self.state = after;
        self.time += time;
    }

    fn history(&self, face: Option<Face>, ending: Ending) -> RoughHistory {
        RoughHistory {
            face,
            ending,
            time: self.time,
            way: self.way,
            impacts: self.impacts,
            steps: self.steps,
            unconverged: self.unconverged,
            returned: self.returned,
            gained: self.gained,
            end: self.state.motion,
        }
    }
}

/// The points that take part in an impact: those that rest, and of those found the ones that touch and
/// approach, the deepest first.
fn touching<'a>(
    resting: impl Iterator<Item = &'a Resting>,
    found: &[Minimum],
    motion: &Motion,
) -> Vec<Minimum> {
    let mut touching: Vec<Minimum> = resting.map(|resting| resting.minimum).collect();
    let mut arriving: Vec<Minimum> = found
        .iter()
        .filter(|m| m.gap <= TOUCH && m.approach(motion) > APPROACH)
        .copied()
        .collect();
    arriving.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    touching.extend(arriving);
    touching.truncate(MOST);
    touching
}

/// Raises a coin that has sunk in deeper than points may, as one does that parts from the ground more
/// slowly than the ground rises beside it: the point would arrive again and again without a step
/// between. The points that no longer touch take no part.
fn raise(motion: &mut Motion, touching: &mut Vec<Minimum>) {
    let deepest = touching.iter().fold(0.0, |least: f64, m| least.min(m.gap));
    if deepest >= -DEEP {
        return;
    }
    motion.position.z -= deepest;
    for minimum in touching.iter_mut() {
        minimum.gap -= deepest;
    }
    touching.retain(|minimum| minimum.gap <= DEEP);
}

/// A point that has come to rest by an impact.
fn resting(minimum: Minimum, motion: &Motion, sunk: f64) -> Resting {
    let v = minimum.velocity(motion);
    let rolling = minimum.touch(&motion.axis).rolling;
    Resting {
        minimum,
        force: [0.0; ROWS],
        distance: minimum.distance() - sunk,
        new: true,
        stuck: [
            v.norm() <= STOPPED,
            rolling.dot(&motion.spin).abs() <= STOPPED,
            minimum.normal.dot(&motion.spin).abs() <= STOPPED,
        ],
    }
}

/// Takes back what a motion has gained over an energy: slows it down, and if it has not that much kinetic
/// energy (at rest, by rounding and truncation), sinks it. Returns the excess and the sinking.
fn restrain(model: &Model, motion: &mut Motion, energy: f64) -> (f64, f64) {
    let excess = motion.energy(model) - energy;
    if excess <= 0.0 {
        return (0.0, 0.0);
    }
    let kinetic = motion.kinetic(model);
    let sunk = (excess - kinetic).max(0.0);
    let share = if sunk > 0.0 {
        0.0
    } else {
        (1.0 - excess / kinetic).sqrt()
    };
    motion.velocity *= share;
    motion.spin *= share;
    motion.position.z -= sunk;
    (excess, sunk)
}
