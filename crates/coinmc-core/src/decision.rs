//! The decision: when the face of a toss in space can no longer change.
//!
//! Both engines in space use this one rule. Lengths are in D, times in sqrt(D/g), energies in m g D
//! (see [`Body`]).
//!
//! # Energy
//! To pass from a face to the side or back, the centre must rise to D at least once: in contact the
//! coin then stands on its rim, in flight it is higher still. So a coin whose mechanical energy is
//! below m g D stays in the well it is in: a face if its lowest point is beyond the centre (c > h,
//! with c the cosine of the tilt and h = H/2), else the side. This is rigorous as long as contact
//! never adds energy.
//!
//! # Tilting
//! The decision `tilting` also leaves out energy that cannot become tilt:
//!
//! * *On the side*: the energy of straight rolling. A tangential impulse p at the contact changes
//!   v_y by p and ω_a by Rp/I_a, so Λ = v_y − (k_a/R) ω_a does not change, and v_y and ω_a keep at
//!   least the energy Λ²/(2(1 + k_a/R²)) as long as the axis keeps its direction. On the side the
//!   axis turns about the vertical at Ω_z, which neither weight nor free rotation changes: v_y
//!   becomes v_x, and ω_a becomes ω_θ and tilt. In the time t that the coin takes to topple, about
//!   Λ cos(Ω_z t) remains along the axis. The rule therefore leaves out a fraction 1/(1 + Ω_z² t²)
//!   of the energy, all of it for an axis that will not turn, with t² = `TOPPLING`. (The rate φ' at
//!   which the axis turns now cannot replace Ω_z: a leaning coin that spins fast nutates, and
//!   passes
//!   φ' = 0 while Ω_z holds it up.) This is nearly rigorous: `docs/validation/` gives the remaining
//!   bias.
//! * *Flat on a face*, with the sine of the tilt below `flat_sine`: the energy of sliding and of
//!   spinning about u. Sliding friction under a coin tilted by θ has a moment of at most
//!   μN(h c + R s) about the centre, against the moment N(R c − h s) of the weight. The rest of the
//!   energy must do the work of the difference, up to the tilt at which the moments are equal,
//!   tan θ = (R − μh)/(h + μR):
//!   ∫ (R c − h s − μ(h c + R s)) dθ = sqrt(1 + μ²) − (h + μR), as R² + h² = 1. The rest includes
//!   the potential h, so its barrier is not 1 but sqrt(1 + μ²) − μR. That is 1 without friction and
//!   h where μh = R; beyond that friction alone tips the coin, and nothing is left out.
//!
//!   The slip of a coin that also spins is only partly in the direction of motion, so less than μ
//!   acts towards tipping. The rule does not use this: as sliding and spinning decay together, the
//!   slip may turn into the direction of motion.
//!
//! # On a table with an edge
//! A decided coin may still roll or slide over the edge. So a toss on such a table goes on until the
//! way that is left is negligible beside the size of the coin: until the energy above that of lying
//! still as it leans, ε, carries it no farther than `WAY`. On its side it rolls for ε R/ρ_c at most. On
//! its face it slides for ε/μ, and a coin that leans and rolls falls flat within about the time 1, so that
//! ε < `WAY`²/2 is enough.
//!
//! # On a tilted table
//! The pull downhill works on a coin that moves, so no energy decides for good, and a toss goes on to
//! rest here as well. On its side a coin rolls on or holds: the engine that follows it says so, not
//! this rule. On its face it rests as on a table with an edge, once the pull, tan β of the weight,
//! cannot carry it over its rim either: the centre is |r_x| short of the balance, and may go on by
//! some `WAY` with the coin.
//!
//! # Without friction
//! With μ = 0 the horizontal velocity never changes, and the rule leaves its energy out under every
//! decision. Rolling then cannot tilt the coin, so on the side `tilting` leaves out the energy of
//! ω_a.
//!
//! Without friction lengths and drag as well, the normal force is the only force besides weight. It
//! has no moment about u or the vertical, so ω_a, L_z and the horizontal velocity never change. At
//! the balance over a rim, u_z = c* = ±h, the energy of turning about the vertical is then
//! k_t(Ω_z − Ω_a c*)²/(2s*²), and the coin cannot pass the balance with less than 1 plus that. This
//! is exact for any restitution, in flight and in contact. An engine with time steps changes ω_a
//! and L_z slightly in every contact, and does not use this part of the rule
//! ([`DecisionRule::in_time_steps`]).

mod conical;

use crate::{Body, Scene, Surface};
use coinmc_lanes::{Lane, Mask};
use conical::Barriers;
use std::f64::consts::FRAC_PI_2;

/// The state of the decision on a toss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decided {
    /// It may still change.
    Open,
    /// The face that is up.
    Face,
    /// The side.
    Side,
}

/// The state of a coin as the rule needs it, in units of D and sqrt(D/g), and in a frame in which
/// the axis points up: x is the horizontal direction towards which the axis leans, z is up, y = z ×
/// x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecisionState<L> {
    /// Mechanical energy in m g D, potential zero at the surface.
    pub energy: L,
    /// s and c, sine and cosine of the tilt of the axis.
    pub sin: L,
    /// See [`sin`](Self::sin).
    pub cos: L,
    /// v_x and v_y, horizontal velocity of the centre.
    pub vx: L,
    /// See [`vx`](Self::vx).
    pub vy: L,
    /// ω_a, angular velocity about the axis.
    pub axial: L,
    /// Ω_z, vertical component of L/I_t (of ω without gyroscopic torque).
    pub vertical: L,
}

/// The rule for one scene.
///
/// # Example
/// ```
/// use coinmc_core::{Body, Coin, Decided, DecisionRule, DecisionState, Scene, Surface};
/// let scene = Scene::new(Coin::cylinder(0.85, 0.01)?, Surface::new(0.5, 0.3)?, 9.81)?;
/// let rule = DecisionRule::new(&scene, true, 2e-3);
/// // it lies on its side, at the height R, and slides
/// let slides = |speed: f64| DecisionState {
///     energy: Body::new(&scene.coin).radius + 0.5 * speed * speed,
///     sin: 1.0, cos: 0.0, vx: speed, vy: 0.0, axial: 0.0, vertical: 0.0,
/// };
/// assert_eq!(rule.decide(&slides(0.1)), Decided::Side);
/// assert_eq!(rule.decide(&slides(2.0)), Decided::Open);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct DecisionRule {
    body: Body,
    axial_factor: f64,
    tilting: bool,
    /// μ = 0.
    slides: bool,
    /// Only weight and normal forces act, and the motion conserves ω_a and L_z.
    traps: bool,
    /// ½/(1 + k_a/R²) and k_a/R of straight rolling.
    rolling: f64,
    lever: f64,
    /// Sine of the tilt below which a coin counts as flat; 0 where friction alone could tip it.
    flat_sine: f64,
    /// Barrier of a flat coin's energy besides sliding and spinning.
    flat_barrier: f64,
    /// Energies above rest below which a decided coin on its side and on its face counts as at rest;
    /// infinite where motion that goes on does not matter.
    resting: [f64; 2],
    /// tan β of a tilted table, else 0.
    slope: f64,
    /// Cosine of the tilt at the balance: of a cylinder h, as R² + h² = 1.
    balance: f64,
    /// The energies at the two balances of a coin with a conical edge.
    conical: Option<Barriers>,
}

/// Square of the time, in sqrt(D/g), in which a rolling coin that turns topples: a choice. With 1
/// the largest bias of P(side) among the examples is 0.0018, with 2 it is 0.0004, at the cost of 5
/// % of the speed where coins roll longest.
const TOPPLING: f64 = 2.0;

/// The way, in D, that a coin that rests on a table with an edge may still make.
const WAY: f64 = 0.03;
/// How many times that way the pull of a tilted table may act on a coin that rests.
const SPARE_WAYS: f64 = 2.0;
/// Energy above rest below which a coin without rolling friction counts as at rest.
const LEAST_RESTING: f64 = 1e-6;

impl DecisionRule {
    /// The rule for a scene. `tilting` leaves out energy that cannot tilt the coin; a coin on its
    /// face counts as flat where the sine of its tilt is below `flat_sine`.
    pub fn new(scene: &Scene, tilting: bool, flat_sine: f64) -> Self {
        let body = Body::new(&scene.coin);
        let surface = &scene.surface;
        let mu = surface.friction();
        let roller = body.outer_radius();
        let coin_radius_m = scene.coin.radius_m();
        let twists = surface.rolling_friction_m() > 0.0 || surface.pivoting_friction_m() > 0.0;
        Self {
            body,
            axial_factor: body.axial_factor(scene.has_gyroscopic_torque()),
            tilting,
            slides: mu == 0.0,
            traps: mu == 0.0 && !twists && scene.drag().is_none(),
            rolling: 0.5 / (1.0 + body.ka / (roller * roller)),
            lever: body.ka / roller,
            flat_sine: if mu * (body.half + body.rim) <= body.radius {
                flat_sine
            } else {
                0.0
            },
            // at a rounded rim friction has the lever r more, over an angle of π/2 at most
            flat_barrier: (1.0 + mu * mu).sqrt() - mu * (body.radius + FRAC_PI_2 * body.rim),
            resting: resting(surface, coin_radius_m),
            slope: surface.tilt().map_or(0.0, |tilt| tilt.slope()),
            balance: body.half,
            conical: None,
        }
    }

    /// The rule for an engine with time steps, which do not conserve ω_a and L_z on a frictionless
    /// surface accurately enough: see *Without friction* in the module documentation.
    #[must_use]
    pub fn in_time_steps(self) -> Self {
        Self {
            traps: false,
            ..self
        }
    }

    /// Whether the rule leaves out energy that cannot tilt the coin.
    pub fn is_tilting(&self) -> bool {
        self.tilting
    }

    /// Whether a coin whose axis is tilted by the angle with the cosine `cos` leans towards its
    /// side.
    #[inline(always)]
    pub fn on_side<L: Lane>(&self, cos: L) -> L::Mask {
        cos.lt(L::splat(self.balance))
    }

    /// Cosine of the tilt at the balance on the lower rim.
    pub fn balance(&self) -> f64 {
        self.balance
    }

    /// The well of a coin whose axis is tilted by the angle with the cosine `cos`: where it would
    /// come to rest from there.
    #[inline]
    pub fn well(&self, cos: f64) -> Decided {
        if self.on_side(cos) {
            Decided::Side
        } else {
            Decided::Face
        }
    }

    /// Applies the rule to one coin.
    #[inline]
    pub fn decide(&self, state: &DecisionState<f64>) -> Decided {
        if self.is_decided(state) && self.rests(state) {
            self.well(state.cos)
        } else {
            Decided::Open
        }
    }

    /// Whether a coin with this sine of the tilt and these rates of rocking lies flat on its face, apart
    /// from negligible rocking, and friction will not tip it as it slides.
    pub fn lies_flat(&self, sin: f64, rocking: [f64; 3]) -> bool {
        let small = self.flat_sine * self.body.radius;
        sin < small && rocking.iter().all(|rate| rate.abs() < small)
    }

    /// Whether the toss goes on until the coin rests.
    pub fn awaits_rest(&self) -> bool {
        self.resting[1] < f64::INFINITY
    }

    /// Whether the coin rests, if that is waited for.
    #[inline]
    fn rests(&self, state: &DecisionState<f64>) -> bool {
        self.is_at_rest(state) && self.holds_on_slope(state)
    }

    /// Whether the energy above the height at rest is that of a coin at rest, if that is waited for.
    #[inline]
    fn is_at_rest(&self, state: &DecisionState<f64>) -> bool {
        if !self.awaits_rest() {
            return true;
        }
        let lowest = self.body.half * state.cos + self.body.radius * state.sin;
        let resting = self.resting[usize::from(!self.on_side(state.cos))];
        state.energy - lowest < resting
    }

    /// Whether the pull of a tilted table cannot carry the coin over its rim.
    fn holds_on_slope(&self, state: &DecisionState<f64>) -> bool {
        if self.slope == 0.0 {
            return true;
        }
        let short = (self.body.radius * state.cos - self.body.half * state.sin).abs();
        state.energy + self.slope * (short + SPARE_WAYS * WAY) < 1.0
    }

    /// Whether the face can no longer change. (Motion that goes on is left to
    /// [`decide`](Self::decide).)
    #[inline(always)]
    pub fn is_decided<L: Lane>(&self, state: &DecisionState<L>) -> L::Mask {
        if let Some(barriers) = &self.conical {
            return self.is_decided_conical(barriers, state);
        }
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let mut energy = state.energy;
        let sliding = half * (state.vx * state.vx + state.vy * state.vy);
        if self.slides {
            energy -= sliding;
        }
        let mut decided = energy.lt(one);
        if !(!decided).any() {
            return decided;
        }
        let side = self.on_side(state.cos);
        let spinning = L::splat(0.5 * self.body.ka) * state.axial * state.axial;
        if self.tilting {
            let lies = !side & state.sin.lt(L::splat(self.flat_sine));
            let flat = if self.slides {
                spinning
            } else {
                spinning + sliding
            };
            let rolling = if self.slides {
                spinning
            } else {
                self.lasting_roll(state)
            };
            let left_out = L::select(side, rolling, L::select(lies, flat, L::splat(0.0)));
            let barrier = L::select(lies, L::splat(self.flat_barrier), one);
            decided = decided | (energy - left_out).lt(barrier);
        }
        if self.traps {
            decided = decided | self.is_trapped(state, energy - spinning, side);
        }
        decided
    }

    /// The energy of a coin that leans towards its side but for what the rule leaves out: the energy
    /// that may become tilt.
    #[inline]
    pub fn loose_energy(&self, state: &DecisionState<f64>) -> f64 {
        if self.slides {
            let sliding = 0.5 * (state.vx * state.vx + state.vy * state.vy);
            state.energy - sliding - 0.5 * self.body.ka * state.axial * state.axial
        } else {
            state.energy - self.lasting_roll(state)
        }
    }

    /// Energy of straight rolling that cannot become tilt: see *Tilting* in the module
    /// documentation.
    #[inline(always)]
    fn lasting_roll<L: Lane>(&self, state: &DecisionState<L>) -> L {
        let invariant = state.vy - L::splat(self.lever) * state.axial;
        let turns = L::splat(1.0) + L::splat(TOPPLING) * state.vertical * state.vertical;
        L::splat(self.rolling) * invariant * invariant / turns
    }

    /// Whether the energy without that of ω_a, `free`, cannot carry the coin over its balance: see
    /// *Without friction* in the module documentation.
    #[inline(always)]
    fn is_trapped<L: Lane>(&self, state: &DecisionState<L>, free: L, side: L::Mask) -> L::Mask {
        let Body {
            radius, half, kt, ..
        } = self.body;
        let axial = L::splat(self.axial_factor) * state.axial;
        let near = (state.vertical - axial * L::splat(half)) / L::splat(radius);
        let far = (state.vertical + axial * L::splat(half)) / L::splat(radius);
        let barrier = |turn: L| L::splat(1.0) + L::splat(0.5 * kt) * turn * turn;
        free.lt(barrier(near)) & (!side | free.lt(barrier(far)))
    }

    /// Whether no energy is ever lost at this restitution: the face of such a toss is decided at
    /// its launch or never.
    pub fn loses_nothing(&self, restitution: f64) -> bool {
        self.traps && restitution == 1.0
    }
}

/// [`DecisionRule::resting`] of a surface.
fn resting(surface: &Surface, coin_radius_m: f64) -> [f64; 2] {
    let mu = surface.friction();
    let face = |friction: f64| (WAY * friction).min(0.5 * WAY * WAY);
    if let Some(tilt) = surface.tilt() {
        return [f64::NEG_INFINITY, face(mu - tilt.slope())];
    }
    // without friction nothing changes the horizontal velocity, and nothing need be waited for
    if surface.table_radius_m().is_none() || mu == 0.0 {
        return [f64::INFINITY; 2];
    }
    let contour = surface.rolling_friction_m() / coin_radius_m;
    [(WAY * contour).max(LEAST_RESTING), face(mu)]
}

#[cfg(test)]
mod tests;
