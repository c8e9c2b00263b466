//! Line contact resolved in time: an elastic, damped, dry contact from touch to release.
//!
//! The coin is rigid in flight; where a corner meets the surface, both deform as a line contact
//! ([`palmgren`](crate::laws::palmgren)), with the damping that gives the wanted restitution
//! ([`damping`]) and friction in series with a spring ([`equations`]). Any number of corners may
//! touch at once. Gravity acts all the time, the coin turns and moves while it touches, and only
//! the law of force is idealised.
//!
//! An impact ends when no corner touches, or when the touching corners cannot leave any more. The
//! engine then continues with sustained contact of a rigid corner, as it does when the remaining
//! bounces would be very short. An impact that is given up is counted (`unresolved`), and
//! [`Moreau`]'s law is used.

mod damping;
mod equations;
mod events;
mod impact_state;
mod integrate;
mod release;
mod scale;

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::impact_law::{Impact, ImpactLaw, PlanarLaw, Resolution};
use crate::laws::moreau::Moreau;
use crate::laws::palmgren::{Materials, scene_stiffness};
use crate::motion::Motion;
use crate::settings_error::SettingsError;
use crate::shape::Shape;
use coinmc_core::schema::{Absent, Bounds, TableKind, Values, fields, number};
use coinmc_core::{EngineError, LawSettings, Scene};
use coinmc_lanes::{Lane, sin_cos};
use damping::{LEAST_RESTITUTION, strength};
use equations::{Body, CORNERS, Corner, Grip};
use impact_state::ImpactState;
use release::Release;

/// A corner at most this high above the surface touches it, in D.
const TOUCH: f64 = 1e-15;

/// Elastic line contact.
///
/// # Example
/// ```
/// use coinmc_flat::{Law, LineContact, Materials, Settings};
/// let materials = Materials {
///     coin_young_pa: 3e9, coin_poisson: 0.36, surface_young_pa: 1e10, surface_poisson: 0.3,
///     length_m: 0.02,
/// };
/// let line = LineContact { materials, tangential: LineContact::mindlin(0.36) };
/// let settings = Settings { law: Law::LineContact(line), ..Settings::default() };
/// assert!(settings.validate().is_ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// The materials in contact.
    pub materials: Materials,
    /// Ratio of the tangential stiffness to the normal secant stiffness at full depth.
    pub tangential: f64,
}

impl LineContact {
    /// 2(1 − ν)/(2 − ν), the ratio of tangential to normal stiffness of like elastic bodies
    /// (Mindlin, J. Appl. Mech. 16 (1949) 259).
    pub fn mindlin(poisson: f64) -> f64 {
        2.0 * (1.0 - poisson) / (2.0 - poisson)
    }
}

const TANGENTIAL: Bounds = Bounds::closed(1e-3, 1e3);
const STIFFNESS: Bounds = Bounds::open(0.0, f64::INFINITY);

impl LawSettings for LineContact {
    const NAME: &'static str = "line-contact";
    const DOC: &'static str = "Elastic line contact with damping and friction, resolved in time.";

    fn parameters() -> TableKind {
        let mut all = Materials::parameters();
        all.push(number(
            "tangential",
            "Stiffness along the surface over that along the normal (2(1 − ν)/(2 − ν) with the coin's \
             ν if absent).",
            TANGENTIAL,
            Absent::Omitted,
        ));
        fields(all)
    }

    fn read(parameters: &Values) -> Result<Self, EngineError> {
        let materials = Materials::read(parameters)?;
        let tangential = parameters.optional("tangential")?;
        Ok(Self {
            materials,
            tangential: tangential.unwrap_or_else(|| Self::mindlin(materials.coin_poisson)),
        })
    }
}

impl PlanarLaw for LineContact {
    type Impact = LineContactImpact;

    fn validate(&self) -> Result<(), SettingsError> {
        self.materials.validate()?;
        Ok(TANGENTIAL.check("tangential", self.tangential)?)
    }

    fn impact(self, scene: &Scene) -> Result<LineContactImpact, SettingsError> {
        LineContactImpact::new(scene, self)
    }
}

/// [`LineContact`] in one scene, in dimensionless units.
#[derive(Debug, Clone, Copy)]
pub struct LineContactImpact {
    line: LineContact,
    stiffness: f64,
    /// d of the damping, for the scene's restitution.
    strength: f64,
}

impl LineContactImpact {
    /// The law in this scene.
    ///
    /// # Errors
    /// [`SettingsError`] if a quantity is out of range.
    pub fn new(scene: &Scene, line: LineContact) -> Result<Self, SettingsError> {
        line.validate()?;
        let stiffness = scene_stiffness(scene, &line.materials);
        STIFFNESS.check("stiffness of the contact over the coin's weight", stiffness)?;
        Ok(Self {
            line,
            stiffness,
            strength: strength(scene.surface.restitution()),
        })
    }

    /// The impact at the touch.
    fn at_touch(&self, impact: &Impact<'_>) -> ImpactState {
        let (shape, motion) = (impact.shape, &*impact.motion);
        let (sin, cos) = sin_cos(motion.delta);
        let matrix = ContactMatrix::new(sin, cos, shape.k);
        let approach = (-(motion.vz + motion.omega * sin)).max(0.0);
        ImpactState::new(
            self.body(motion, shape, impact.friction),
            [motion.vx, motion.vz, motion.omega],
            (approach, 1.0 / matrix.zz),
            (self.strength, self.line.tangential),
            impact.tolerance,
        )
    }

    fn body(&self, motion: &Motion, shape: &Shape, mu: f64) -> Body {
        Body {
            inertia: shape.k,
            stiffness: self.stiffness,
            mu,
            // set from the speed of the impact
            tangential: 0.0,
            corners: corners(motion, shape),
        }
    }
}

/// The corners at the touch, the lowest first.
fn corners(motion: &Motion, shape: &Shape) -> [Corner; CORNERS] {
    let (sin, cos) = sin_cos(motion.delta);
    let (height, half_width) = shape.base(motion.quadrant, false);
    // the angle turned since flat at the quadrant's start
    let (sine, cosine) = sin_cos(motion.delta + shape.first_span(motion.quadrant));
    let corner = |x: f64, z: f64, gap: f64| Corner {
        x,
        z,
        gap,
        grip: Grip::Apart,
        damping: 0.0,
    };
    let next = (2.0 * height * sine, 2.0 * height * cosine);
    let last = (-2.0 * half_width * cosine, 2.0 * half_width * sine);
    let [next_gap, last_gap] = [next.1, last.1].map(|gap| if gap > TOUCH { gap } else { 0.0 });
    [
        corner(-sin, -cos, 0.0),
        corner(next.0 - sin, next.1 - cos, next_gap),
        corner(last.0 - sin, last.1 - cos, last_gap),
        corner(sin, cos, 2.0 * cos),
    ]
}

impl ImpactLaw for LineContactImpact {
    const BATCHED: bool = false;

    fn impulse<L: Lane>(&self, k: ContactMatrix<L>, ux: L, uz: L, e: f64, mu: f64) -> Impulse<L> {
        Moreau.impulse(k, ux, uz, e, mu)
    }

    fn resolve(&self, impact: &mut Impact<'_>) -> Resolution {
        if impact.restitution < LEAST_RESTITUTION {
            return Resolution::UseImpulse;
        }
        let mut state = self.at_touch(impact);
        let release = state.integrate(f64::INFINITY);
        impact.record = state.record;
        impact.record.imbalance = state.imbalance();
        let Some(release) = release.filter(|release| *release != Release::GivenUp) else {
            impact.breaks.unresolved += 1;
            return Resolution::UseImpulse;
        };
        let (shape, motion) = (impact.shape, &mut *impact.motion);
        let touched = *motion;
        apply(motion, shape, &state);
        // corners that touch are on the surface, to rounding or to the depth of a bound corner
        motion.z = motion.z.max(sin_cos(motion.delta).1);
        if release == Release::Apart {
            return Resolution::Separates;
        }
        // too little energy to rise to the surface at this angle: the coin stays as it touched
        if motion.z > touched.energy(shape.k) {
            *motion = touched;
        }
        Resolution::StaysInContact
    }

    fn resolve_until(&self, impact: &mut Impact<'_>, time: f64) {
        let mut state = self.at_touch(impact);
        state.integrate(time);
        apply(impact.motion, impact.shape, &state);
    }
}

/// Moves the coin from the touch to the state of the impact.
fn apply(motion: &mut Motion, shape: &Shape, state: &ImpactState) {
    let [x, z, turned, vx, vz, omega, ..] = state.y;
    motion.time += state.time;
    motion.x += x;
    motion.z += z;
    motion.turn(shape, turned);
    (motion.vx, motion.vz, motion.omega) = (vx, vz, omega);
}
