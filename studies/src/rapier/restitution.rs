//! What Rapier makes of three landings that are known exactly, and of a coin that rolls on its rim.
//!
//! * *point*: on one point of the rim, without spin: v_n⁺ = −e v_n⁻ there.
//! * *flat*, *side*: on a face and on the side, without spin. The coin leaves with e times its speed
//!   and does not turn.
//! * *rim*: a coin that rolls in a steady circle about its resting centre,
//!   φ'²s(k_t c − k_a h s/R) = g r_x with r_x = R c − h s (h = H/2), loses nothing. What it does lose
//!   is what rolling friction of the length ρ would take, N ρ |ψ'|, ψ' = φ'(h s/R − c).

use super::STEPS;
use clap::Args;
use coinmc_bench::{Report, Table};
use coinmc_core::{Coin, Engine, Event, EventKind, Launch, Observer, Scene, State, Surface};
use coinmc_rapier::{Decision, RapierEngine, Settings};
use nalgebra::{UnitVector3, Vector3};

/// Radius, m, and H/R of the coin.
const RADIUS: f64 = 0.01;
const RATIO: f64 = 0.5;
/// Height, in radii, from which it falls.
const HEIGHT: f64 = 10.0;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct RapierRestitution {
    /// Restitution that is asked for
    #[arg(long, default_value_t = 0.5, value_name = "E")]
    restitution: f64,

    /// Shortest step, s
    #[arg(long, default_value_t = 5e-5, value_name = "S")]
    shortest: f64,
}

/// The states about the first impact, and samples.
#[derive(Default)]
struct Watch {
    before: Option<State>,
    after: Option<State>,
    wanted_s: Vec<f64>,
    seen: Vec<State>,
}

impl Observer for Watch {
    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::Touching => {
                self.before.get_or_insert(event.state);
            }
            EventKind::Impact => {
                self.after.get_or_insert(event.state);
            }
            _ => {}
        }
    }

    fn wants_at_s(&self) -> f64 {
        let next = self.wanted_s.get(self.seen.len());
        next.copied().unwrap_or(f64::INFINITY)
    }

    fn sample(&mut self, state: &State) {
        self.seen.push(*state);
    }
}

impl RapierRestitution {
    pub(crate) fn execute(&self) -> anyhow::Result<Report> {
        let columns = [
            "step_s",
            "point_e",
            "flat_e",
            "flat_spin",
            "side_e",
            "side_spin",
            "rim_rho_over_r",
        ];
        let title = format!(
            "Landings of a coin with H/R = {RATIO}, R = 1 cm, from {HEIGHT} R, e = {} asked for, mu = 0.3",
            self.restitution
        );
        let mut record = Table::new(title, &columns);
        for step_s in STEPS.into_iter().filter(|step| *step >= self.shortest) {
            let settings = Settings {
                step_s,
                decision: Decision::Rest,
                time_limit: 20.0,
                ..Settings::default()
            };
            let mut row = vec![format!("{step_s:.0e}")];
            for (tilt, with_spin) in [
                (0.5, false),
                (0.0, true),
                (std::f64::consts::FRAC_PI_2, true),
            ] {
                let (e, spin) = self.land(&settings, tilt)?;
                row.push(format!("{e:.4}"));
                row.extend(with_spin.then(|| format!("{spin:.3}")));
            }
            row.push(self.roll(&settings)?);
            record.push(row);
        }
        let mut report = Report::new(record);
        report.remark(
            "e: speed of the lowest point (point) or of the centre (flat, side) after the step of the \
             impact over that before. spin: rate of turning across the axis after it, in sqrt(g/D); it \
             should be 0. rim_rho_over_r: contour friction length, in radii, that would take the \
             energy that a coin loses that rolls on its rim at 45 degrees; it should be 0.",
        );
        Ok(report)
    }

    fn scene(&self) -> anyhow::Result<Scene> {
        let coin = Coin::cylinder(RATIO, RADIUS)?;
        let surface = Surface::new(self.restitution, 0.3)?;
        Ok(Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2)?)
    }

    /// Effective restitution and the rate of turning after a landing at this tilt, rad.
    fn land(&self, settings: &Settings, tilt: f64) -> anyhow::Result<(f64, f64)> {
        let scene = self.scene()?;
        let (s, c) = libm::sincos(tilt);
        let launch = Launch {
            height_m: HEIGHT * RADIUS,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(Vector3::new(s, 0.0, c)),
            spin_rad_s: Vector3::zeros(),
        };
        let watch = follow(&scene, settings, &launch, Watch::default())?;
        let (Some(before), Some(after)) = (watch.before, watch.after) else {
            return Ok((f64::NAN, f64::NAN));
        };
        let level = s == 0.0 || c.abs() < 1e-9;
        let speed = |state: &State| {
            if level {
                return state.velocity_m_s.z;
            }
            let lever = Vector3::new(
                RADIUS * c - 0.5 * RATIO * RADIUS * s,
                0.0,
                -RADIUS * s - 0.5 * RATIO * RADIUS * c,
            );
            (state.velocity_m_s + state.spin_rad_s.cross(&lever)).z
        };
        let spin = &after.spin_rad_s;
        let axial = spin.dot(&after.axis);
        let across = (spin - after.axis.into_inner() * axial).norm() * scene.time_scale_s();
        Ok((-speed(&after) / speed(&before), across))
    }

    /// Contour friction length, in radii, that takes what steady rolling on the rim loses in two
    /// units of time.
    fn roll(&self, settings: &Settings) -> anyhow::Result<String> {
        let scene = self.scene()?;
        let coin = &scene.coin;
        let (gravity, half) = (scene.gravity_m_s2(), 0.5 * coin.height_m());
        let (s, c) = libm::sincos(std::f64::consts::FRAC_PI_4);
        let (kt, ka) = (coin.transverse_gyration_m2(), coin.axial_gyration_m2());
        let lever = RADIUS * c - half * s;
        let turning = (gravity * lever / (s * (kt * c - ka * half * s / RADIUS))).sqrt();
        let axis = Vector3::new(s, 0.0, c);
        let across = Vector3::new(c, 0.0, -s);
        let spin = across * (-s * turning) + axis * (half * s * turning / RADIUS);
        let launch = Launch {
            height_m: RADIUS * s + half * c,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_unchecked(axis),
            spin_rad_s: spin,
        };
        let unit = scene.time_scale_s();
        let watch = Watch {
            wanted_s: vec![unit, 3.0 * unit],
            ..Watch::default()
        };
        let watch = follow(&scene, settings, &launch, watch)?;
        let [from, to] = &watch.seen[..] else {
            return Ok("ended".to_owned());
        };
        let lost = from.energy_j_kg(&scene) - to.energy_j_kg(&scene);
        let wander = turning * (c - half * s / RADIUS);
        let rho = lost / (gravity * wander * 2.0 * unit);
        Ok(format!("{:.5}", rho / RADIUS))
    }
}

fn follow(
    scene: &Scene,
    settings: &Settings,
    launch: &Launch,
    mut watch: Watch,
) -> anyhow::Result<Watch> {
    let engine = RapierEngine::new(scene, settings)?;
    engine.toss(&mut engine.workspace(), launch, &mut watch);
    Ok(watch)
}
