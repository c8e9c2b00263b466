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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact_law::tests::impact;
    use crate::motion::tests::on_corner;
    use coinmc_core::Breaks;
    use coinmc_testkit::scene;

    fn law() -> (LineContactImpact, Shape) {
        let scene = scene(1.0, 0.5, 0.3);
        let materials = Materials {
            coin_young_pa: 1e8,
            coin_poisson: 0.3,
            surface_young_pa: 1e8,
            surface_poisson: 0.3,
            length_m: 0.02,
        };
        let line = LineContact {
            materials,
            tangential: 0.8,
        };
        let law = LineContactImpact::new(&scene, line).expect("valid");
        (law, Shape::new(&scene.coin))
    }

    fn touching(quadrant: u8, delta: f64) -> Motion {
        let mut motion = on_corner(quadrant, delta, 0.5, 0.2);
        motion.vz -= 0.7;
        motion
    }

    /// The four corners of a rectangle 2R × H that is turned by θ = 90° q + φ, relative to its centre, with their heights.
    #[test]
    fn corners_are_those_of_the_turned_rectangle() {
        let (_, shape) = law();
        let (half_height, radius) = shape.base(0, false);
        for quadrant in 0..4 {
            for delta in [-0.3, 0.0, 0.2] {
                let motion = touching(quadrant, delta);
                let turn = std::f64::consts::FRAC_PI_2 * f64::from(quadrant);
                let theta = turn + delta + shape.first_span(quadrant);
                let (sin, cos) = libm::sincos(theta);
                let found = corners(&motion, &shape);
                let mut seen = [false; CORNERS];
                for (across, along) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    let (across, along) = (across * radius, along * half_height);
                    let (x, z) = (across * cos + along * sin, along * cos - across * sin);
                    let near =
                        |corner: &Corner| (corner.x - x).abs() + (corner.z - z).abs() < 1e-14;
                    let which = found.iter().position(near).expect("a corner is there");
                    seen[which] = true;
                    assert!((found[which].gap - (motion.z + z)).abs() < 1e-14);
                }
                assert_eq!(seen, [true; CORNERS]);
                assert_eq!(found[0].gap, 0.0);
            }
        }
    }

    /// The speed of the impact is that at which the corner comes down, however the coin turns.
    #[test]
    fn the_scale_is_set_by_the_approach_of_the_corner() {
        let (law, shape) = law();
        let mut motion = touching(0, 0.3);
        let mut breaks = Breaks::default();
        let impact = impact(&mut motion, &shape, &mut breaks);
        assert!((law.at_touch(&impact).scale.speed - 0.7).abs() < 1e-15);
    }

    /// An impact whose motion is no number is given up and counted, and the impulse of a rigid corner is left to
    /// follow.
    #[test]
    fn an_impact_that_is_given_up_is_counted() {
        let (law, shape) = law();
        let mut motion = touching(0, 0.3);
        motion.vx = f64::NAN;
        let mut breaks = Breaks::default();
        for times in 1..3 {
            let mut impact = impact(&mut motion, &shape, &mut breaks);
            assert_eq!(law.resolve(&mut impact), Resolution::UseImpulse);
            assert_eq!(breaks.unresolved, times);
        }
    }

    /// A viscous damper that loses all but a thousandth of the speed does not exist: such impacts are left to the
    /// impulse, untouched.
    #[test]
    fn an_impact_with_next_to_no_rebound_is_left_to_the_impulse() {
        let (law, shape) = law();
        for (restitution, resolved) in [(0.0, false), (9e-4, false), (2e-3, true)] {
            let mut motion = touching(0, 0.3);
            let before = motion.vz;
            let mut breaks = Breaks::default();
            let mut impact = impact(&mut motion, &shape, &mut breaks);
            impact.restitution = restitution;
            let found = law.resolve(&mut impact);
            assert_eq!(found != Resolution::UseImpulse, resolved, "{restitution}");
            assert_eq!(motion.vz != before, resolved);
        }
    }

    /// Of a coin that lands flat both corners press at once, and of one that lands on a corner only that.
    #[test]
    fn corners_that_touch_begin_to_press() {
        let (law, shape) = law();
        let flat = shape.last_angle(0, 1.0);
        for (delta, omega, pressing) in [
            (flat, 0.0, 2),
            (flat - 0.1, 0.0, 1),
            // the second corner rises as the first one comes down
            (flat, -1.5, 1),
        ] {
            let mut motion = on_corner(0, delta, omega, 0.0);
            motion.vz -= 0.3;
            let mut breaks = Breaks::default();
            let mut state = law.at_touch(&impact(&mut motion, &shape, &mut breaks));
            state.touch_at_start();
            let corners = state.body.corners.iter();
            let grips: Vec<_> = corners
                .map(|corner| !matches!(corner.grip, Grip::Apart))
                .collect();
            assert!(grips[0], "{delta} {omega}");
            let count = grips.iter().filter(|&&grip| grip).count();
            assert_eq!(count, pressing, "{delta} {omega}");
        }
    }
}
