//! One toss in flight or in contact: its state and its counters.

use crate::body::{Body, Units};
use crate::motion::{FLAT, Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use crate::onto_side::SideArrival;
use crate::place::Place;
use coinmc_core::{Decided, Ended, Face, Launch, Observer, State};
use nalgebra::Vector3;

/// The state of a toss and its counters.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub(crate) struct Toss {
    pub(crate) impacts: u32,
    /// How often the impacts have changed from one rim to the other since the last flight.
    pub(crate) rim_changes: u32,
    /// Whether the up-pointing axis of the folded frame is +u (heads); otherwise it is −u.
    pub(crate) heads_up: bool,
    pub(crate) motion: Motion<f64>,
    pub(crate) spin: Spin<f64>,
    pub(crate) place: Place,
    /// How the coin came onto its side, if it is there in sustained contact.
    pub(crate) side_arrival: Option<SideArrival>,
}

impl Toss {
    /// The motion of a coin in contact, and the adapter that shows it to an observer.
    #[inline]
    pub(crate) fn observed<'a, O: Observer>(
        &'a mut self,
        units: &'a Units,
        observer: &'a mut O,
    ) -> (
        &'a mut Motion<f64>,
        &'a mut Spin<f64>,
        ObserverAdapter<'a, O>,
    ) {
        let adapter = ObserverAdapter {
            observer,
            place: &mut self.place,
            heads_up: self.heads_up,
            units,
        };
        (&mut self.motion, &mut self.spin, adapter)
    }

    /// A placeholder for an unused slot: a coin that does not move.
    pub(crate) fn still() -> Self {
        Self {
            motion: Motion::still(),
            spin: Spin::still(),
            heads_up: true,
            impacts: 0,
            rim_changes: 0,
            place: Place::origin([1.0, 0.0]),
            side_arrival: None,
        }
    }

    /// The launch in the folded frame. A coin that would start inside the surface is lifted until
    /// it just touches.
    pub(crate) fn new(launch: &Launch, units: &Units, body: &Body, axial_factor: f64) -> Self {
        let axis = launch.axis.into_inner();
        let heads_up = axis.z.is_sign_positive();
        // u and −u give the same up-pointing axis, hence the same motion
        let up = if heads_up { axis } else { -axis };
        let across = (up.x * up.x + up.y * up.y).sqrt();
        let (nx, ny) = if across > 0.0 {
            (up.x / across, up.y / across)
        } else {
            (1.0, 0.0)
        };
        let along = |v: &Vector3<f64>, scale: f64| {
            (
                (v.x * nx + v.y * ny) / scale,
                (v.y * nx - v.x * ny) / scale,
                v.z / scale,
            )
        };
        let mut motion = Motion::still();
        motion.set_tilt(across, up.z);
        (motion.vx, motion.vy, motion.vz) = along(&launch.velocity_m_s, units.speed_m_s());
        let (wx, wy, wz) = along(&launch.spin_rad_s, 1.0 / units.time_s);
        let spin = Spin {
            axial: wx * motion.sin + wz * motion.cos,
            turn: wx * motion.cos - wz * motion.sin,
            tilt: wy,
        };
        motion.set_spin(&spin, axial_factor);
        motion.z = ((launch.height_m - units.rim_m) / units.length_m).max(motion.rest_height(body));
        Self {
            motion,
            spin,
            heads_up,
            impacts: 0,
            rim_changes: 0,
            place: Place::origin([nx, ny]),
            side_arrival: None,
        }
    }

    /// The face that points up.
    pub(crate) fn face(&self) -> Face {
        if self.heads_up {
            Face::Heads
        } else {
            Face::Tails
        }
    }

    /// The end of a toss whose face is decided.
    pub(crate) fn ended(&self, decided: Decided) -> Ended {
        Ended::Decided(if decided == Decided::Side {
            Face::Side
        } else {
            self.face()
        })
    }

    /// Whether the coin is level (lies flat) to within [`FLAT`].
    pub(crate) fn is_level(&self) -> bool {
        self.motion.sin <= FLAT
    }

    /// Turns the frame of a level coin towards the rim point that approaches the surface; returns
    /// whether the coin is level. Every point of the lower rim is at the surface then, and the one
    /// that approaches is where u tilts to: u' = (ω_y, −ω_θ).
    pub(crate) fn face_approaching_point(&mut self, axial_factor: f64) -> bool {
        if !self.is_level() {
            return false;
        }
        let (x, y) = (self.spin.tilt, -self.spin.turn);
        let rate = (x * x + y * y).sqrt();
        if rate > 0.0 {
            self.motion.align(x / rate, y / rate);
            self.place.align(x / rate, y / rate);
            (self.spin.tilt, self.spin.turn) = (rate, 0.0);
            self.motion.set_spin(&self.spin, axial_factor);
        }
        true
    }

    /// Reverses the axis of the folded frame of a coin on its side, so that the other rim becomes
    /// the lowest one. (e_θ points down in either frame.)
    pub(crate) fn switch_rim(&mut self) {
        self.motion.reverse_frame();
        self.spin.tilt = -self.spin.tilt;
        self.spin.axial = -self.spin.axial;
        self.heads_up = !self.heads_up;
        self.place.align(-1.0, 0.0);
    }

    /// Reverses the axis of the folded frame at any tilt, so that the other rim of a coin with a conical
    /// edge becomes the lower one.
    pub(crate) fn turn_over(&mut self) {
        self.switch_rim();
        self.motion.cos = -self.motion.cos;
    }

    /// The state in SI units in the laboratory.
    pub(crate) fn state(&self, units: &Units) -> State {
        self.place
            .state(&self.motion, &self.spin, self.heads_up, units)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_testkit::Dice;
    use nalgebra::UnitVector3;

    /// A thin coin on a plane.
    pub(crate) fn model() -> crate::model::Model<crate::laws::Moreau> {
        let coin = Coin::cylinder(0.4, 0.0116).expect("a valid coin");
        let surface = Surface::new(0.5, 0.3).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        let settings = crate::settings::Settings::default();
        crate::model::Model::new(&scene, &settings, crate::laws::Moreau).expect("valid settings")
    }

    /// A coin with rounded rims that rolls, spins and flies with friction and drag: no number of it is 0 or 1.
    pub(crate) fn generic_scene(surface: impl FnOnce(Surface) -> Surface) -> Scene {
        let coin = Coin::cylinder(0.7, 0.013).and_then(|coin| coin.with_rim_radius(0.001));
        let plane = Surface::new(0.5, 0.35)
            .and_then(|surface| surface.with_friction_lengths(1e-3, 2e-4))
            .expect("a valid surface");
        let drag = coinmc_core::Drag::new(0.8, 1.3).expect("a valid drag");
        Scene::new(coin.expect("a valid coin"), surface(plane), 9.81)
            .expect("a valid scene")
            .with_drag(drag)
    }

    /// The model of a scene by Moreau's law, with these settings.
    pub(crate) fn model_of(
        scene: &Scene,
        settings: &crate::settings::Settings,
    ) -> crate::model::Model<crate::laws::Moreau> {
        crate::model::Model::new(scene, settings, crate::laws::Moreau).expect("valid settings")
    }

    /// The way and the time to rest of a speed that falls at the rate `slowing`, by many small steps.
    pub(crate) fn stops_plainly(slowing: impl Fn(f64) -> f64, speed: f64) -> (f64, f64) {
        let step = speed / slowing(speed) * 1e-5;
        let (mut v, mut way, mut time) = (speed, 0.0, 0.0);
        loop {
            let next = v - step * slowing(v - 0.5 * step * slowing(v));
            if next <= 0.0 {
                let last = step * v / (v - next);
                return (way + 0.5 * last * v, time + last);
            }
            (way, time) = (way + 0.5 * step * (v + next), time + step);
            v = next;
        }
    }

    /// A launch anywhere above the surface, its axis at this height.
    pub(crate) fn launch(dice: &mut Dice, axis_z: Option<f64>) -> Launch {
        let mut axis = dice.vector(1.0);
        if let Some(z) = axis_z {
            let across = ((1.0 - z * z) / (axis.x * axis.x + axis.y * axis.y)).sqrt();
            axis = Vector3::new(axis.x * across, axis.y * across, z);
        }
        Launch {
            height_m: dice.between(0.05, 0.2),
            velocity_m_s: dice.vector(1.0),
            axis: UnitVector3::new_normalize(axis),
            spin_rad_s: dice.vector(30.0),
        }
    }

    /// Positions in m, velocities in m/s, axes, and spins in 30 rad/s are alike.
    pub(crate) fn agree(a: &State, b: &State, tolerance: f64) {
        let off = [
            (a.position_m - b.position_m).norm(),
            (a.velocity_m_s - b.velocity_m_s).norm(),
            (a.axis.into_inner() - b.axis.into_inner()).norm(),
            (a.spin_rad_s - b.spin_rad_s).norm() / 30.0,
        ];
        assert!(
            off.iter().all(|off| *off < tolerance),
            "{off:?}: {a:?} {b:?}"
        );
    }

    /// A toss begins as it is launched, whatever frame it is followed in.
    #[test]
    fn the_folded_frame_holds_the_launch() {
        let model = model();
        for number in 0..200 {
            let launch = launch(&mut Dice::new(515, number), None);
            let state = model.launch(&launch).state(&model.units);
            let launched = State {
                time_s: 0.0,
                position_m: Vector3::new(0.0, 0.0, launch.height_m),
                velocity_m_s: launch.velocity_m_s,
                axis: launch.axis,
                spin_rad_s: launch.spin_rad_s,
            };
            agree(&state, &launched, 1e-12);
        }
    }

    /// What turns or reverses the frame leaves the coin as it is in the laboratory: the rims of a coin on its side
    /// change roles, those of any coin with a conical edge, and a level coin's frame turns to the rim point that
    /// comes down.
    #[test]
    fn another_frame_is_the_same_coin() {
        let model = model();
        let factor = model.dynamics.axial_factor;
        for number in 0..200 {
            let mut dice = Dice::new(516, number);
            let mut toss = model.launch(&launch(&mut dice, None));
            let before = toss.state(&model.units);
            toss.turn_over();
            agree(&toss.state(&model.units), &before, 1e-12);
            assert!(!toss.face_approaching_point(factor));

            let mut toss = model.launch(&launch(&mut dice, Some(0.0)));
            let (before, face) = (toss.state(&model.units), toss.face());
            toss.switch_rim();
            agree(&toss.state(&model.units), &before, 1e-12);
            assert_ne!(toss.face(), face);

            let side = if number % 2 == 0 { 1.0 } else { -1.0 };
            let mut toss = model.launch(&launch(&mut dice, Some(side * (1.0 - 1e-20))));
            toss.motion.set_tilt(0.5 * FLAT, 1.0);
            let before = toss.state(&model.units);
            assert!(toss.face_approaching_point(factor));
            agree(&toss.state(&model.units), &before, 2.0 * FLAT);
            assert!(toss.spin.tilt > 0.0 && toss.spin.turn == 0.0);
            assert!((toss.motion.oy - toss.spin.tilt).abs() < 1e-15);
        }
    }
}
