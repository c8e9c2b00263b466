//! The equations of a coin on its edge against Newton and Euler's in vectors.

use super::Conical;
use super::edge::{Edge, EdgeState};
use crate::body::Friction;
use crate::contact::{Dynamics, Usage};
use crate::drag::Drag;
use crate::flight::Departure;
use crate::laws::Moreau;
use crate::settings::Settings;
use crate::toss::tests::stops_plainly;
use coinmc_core::{Body, Coin, Event, EventKind, Launch, LowerRim, Observer, Scene, Surface};
use coinmc_testkit::{Dice, Recorder};
use nalgebra::{Matrix3, UnitVector3, Vector3};

const RATIOS_AND_DRAFTS: [(f64, f64); 4] = [(0.2, 3.0), (0.85, 12.0), (0.85, -12.0), (2.0, 15.0)];

fn dynamics(body: Body, mu: f64, rho: f64, [linear, angular]: [f64; 2]) -> Dynamics {
    let friction = Friction {
        mu,
        contour: rho,
        pivoting: 0.3 * rho,
    };
    let drag = Drag { linear, angular };
    Dynamics::new(body, friction, drag, body.ka / body.kt, 1e-3)
}

fn rims() -> impl Iterator<Item = LowerRim> + Clone {
    RATIOS_AND_DRAFTS.into_iter().flat_map(|(ratio, draft)| {
        let coin = Coin::cylinder(ratio, 0.01).and_then(|coin| coin.with_draft(draft));
        LowerRim::of(&coin.expect("a good coin"))
    })
}

/// u, e_θ and ω of a state, in axes that turn with the coin.
fn vectors(edge: &Edge, state: &EdgeState) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
    let u = Vector3::new(edge.sin, 0.0, edge.cos);
    let across = Vector3::new(edge.cos, 0.0, -edge.sin);
    (u, across, u * state[2] + across * state[3])
}

/// Forces at the two rims' points as vectors, from their velocities, and where they act.
fn forces(
    edge: &Edge,
    rim: &LowerRim,
    state: &EdgeState,
    mu: f64,
    creep: f64,
    share: f64,
) -> [(Vector3<f64>, Vector3<f64>); 2] {
    let (u, across, spin) = vectors(edge, state);
    let arms = [
        across * rim.body.radius - u * rim.body.half,
        across * rim.upper.radius + u * rim.upper.half,
    ];
    let normals = [share, 1.0 - share];
    [0, 1].map(|i| {
        let slip = Vector3::new(state[0], state[1], 0.0) + spin.cross(&arms[i]);
        assert!(slip.z.abs() < 1e-14, "both points stay on the surface");
        let friction = -slip * (mu * normals[i] / (slip.norm_squared() + creep * creep).sqrt());
        (arms[i], friction + Vector3::z() * normals[i])
    })
}

/// Momentum and angular momentum change as forces and torques ask, in the frame that turns at φ'; and
/// about y there is no torque left that would tilt the coin.
#[test]
fn rates_are_those_of_newton_and_euler() {
    let (mu, rho, creep) = (0.3, 0.02, 0.01);
    let mut compared = 0;
    for (trial, rim) in rims().cycle().take(400).enumerate() {
        let mut dice = Dice::new(71, trial as u64);
        let (edge, body) = (Edge::new(&rim), rim.body);
        let drag = [0.0; 2].map(|_| dice.between(0.0, 1.0));
        let dynamics = dynamics(body, mu, rho, drag);
        let state = [0.0; 4].map(|_| dice.between(-0.5, 0.5));
        let now = edge.rates(&dynamics, &state, creep);
        if !(0.0..=1.0).contains(&now.share) {
            continue;
        }
        compared += 1;
        let (u, across, spin) = vectors(&edge, &state);
        let inertia =
            Matrix3::from_diagonal_element(body.kt) + u * u.transpose() * (body.ka - body.kt);
        let turning = Vector3::z() * (-state[3] / edge.sin);
        let velocity = Vector3::new(state[0], state[1], 0.0);
        let (mut force, mut torque) = (-Vector3::z(), Vector3::zeros());
        for (arm, at) in forces(&edge, &rim, &state, mu, creep, now.share) {
            force += at;
            torque += arm.cross(&at);
        }
        // contour and pivoting friction: about x at ρ_c/s, about z
        let (torque_a, torque_t) =
            dynamics.friction_torques(edge.sin, edge.cos, state[2], state[3]);
        torque -= u * torque_a + across * torque_t;
        force -= velocity * drag[0];
        torque -= inertia * spin * drag[1];
        let expected = force - turning.cross(&velocity);
        let momentum = torque - turning.cross(&(inertia * spin));
        let found = [
            now.rates[0] - expected.x,
            now.rates[1] - expected.y,
            expected.z,
            body.ka * now.rates[2] - momentum.dot(&u),
            body.kt * now.rates[3] - momentum.dot(&across),
            momentum.y,
        ];
        assert!(found.iter().all(|error| error.abs() < 1e-13), "{found:?}");
    }
    assert!(compared > 100, "{compared}");
}

/// Rolling about the apex, a known motion: the coin turns about its line of contact alone, at ω, and its
/// centre goes in a circle about the apex at the distance ζ s/c. Without friction lengths nothing changes,
/// and both rims press until the circle asks too much.
#[test]
fn a_coin_on_its_edge_rolls_about_the_apex() {
    let (mu, creep) = (0.5, 1e-9);
    for rim in rims() {
        let edge = Edge::new(&rim);
        let dynamics = dynamics(rim.body, mu, 0.0, [0.0; 2]);
        let omega = 0.2;
        let (s, c) = (edge.sin, edge.cos);
        let speed = -edge.height * omega;
        let azimuth = -c / s * omega;
        assert!(
            (speed / azimuth - edge.height * s / c).abs() < 1e-12,
            "the circle"
        );
        // the slip along x, far below the creep, that holds the centre on its circle
        let held = -azimuth * speed;
        let slip = -creep * held / (mu * mu - held * held).sqrt();
        let state = [slip, speed, s * omega, c * omega];
        let now = edge.rates(&dynamics, &state, creep);
        assert!(
            now.rates.iter().all(|rate| rate.abs() < 1e-6),
            "{:?}",
            now.rates
        );
        assert!(edge.slip(&state) < 2.0 * creep);
        // the weight's moment and that of the circle, about the point below the centre
        let resting = edge.reach[1] / (edge.reach[1] - edge.reach[0]);
        let still = edge.rates(&dynamics, &[0.0; 4], creep).share;
        assert!((still - resting).abs() < 1e-12 && still > 0.0 && still < 1.0);
    }
}

/// Contour friction takes ρ_c|ω|/s: the way to rest is that for which the energy is used up.
#[test]
fn rolling_about_the_apex_ends_when_its_energy_is_used_up() {
    for rim in rims() {
        let (edge, body) = (Edge::new(&rim), rim.body);
        let dynamics = dynamics(body, 0.5, 0.01, [0.0; 2]);
        let omega = 0.3;
        let (s, c, height) = (edge.sin, edge.cos, edge.height);
        let (motion, spin) = edge.motion(&dynamics, &[0.0, -height * omega, s * omega, c * omega]);
        let energy = motion.kinetic(&body, &spin);
        let angle = energy / (dynamics.friction.contour / s);
        let way = edge.rolling_stop(&dynamics, height * omega).distance();
        assert!((way / (angle * height) - 1.0).abs() < 1e-12);
    }
}

/// A coin that friction and its spin cannot tip has both rims down, whatever the directions of its motion. The
/// bound of what they can do is no more than some eight times what a coin does that rolls about the apex.
#[test]
fn what_cannot_overturn_a_coin_leaves_both_rims_down() {
    let mut held = 0;
    for (trial, rim) in rims().cycle().take(4000).enumerate() {
        let mut dice = Dice::new(72, trial as u64);
        let edge = Edge::new(&rim);
        let dynamics = dynamics(rim.body, dice.between(0.0, 0.3), 0.0, [0.0; 2]);
        let size = dice.between(0.0, 1.0);
        let state = [0.0; 4].map(|_| size * dice.between(-1.0, 1.0));
        if edge.overturning(&dynamics, &state) < 2.0 * edge.shorter_reach() {
            held += 1;
            let share = edge.rates(&dynamics, &state, 1e-3).share;
            assert!(share > 0.0 && share < 1.0, "{share} {state:?}");
        }
        let (s, c, omega) = (edge.sin, edge.cos, dice.between(-1.0, 1.0));
        let rolls = [0.0, -edge.height * omega, s * omega, c * omega];
        let friction = 2.0 * dynamics.friction.mu * edge.height;
        let most = edge.overturning(&dynamics, &rolls) - friction;
        let factor = dynamics.axial_factor;
        let turns = rim.body.kt * c.abs() * (factor * s + c * c / s) * omega * omega;
        assert!((2.0 * turns..8.0 * turns).contains(&most), "{most} {turns}");
    }
    assert!(held > 500, "{held}");
}

/// A coin whose rims share its weight unevenly tips onto one of them where its slip ends or begins, and that may turn
/// it back at once: no impact comes of it, or impacts would follow each other in no time until they had taken its energy.
#[test]
fn rims_do_not_strike_again_and_again_in_no_time() {
    let cylinder = |ratio| Coin::cylinder(ratio, 0.01).expect("a good cylinder");
    let coins = [
        cylinder(0.6).with_centre_of_mass(0.15, None, None),
        cylinder(0.6).with_centre_of_mass(0.18, None, None),
        cylinder(0.6).with_draft(5.0),
        cylinder(0.6).with_draft(7.0),
    ];
    for (shape, coin) in coins.into_iter().enumerate() {
        let surface = Surface::new(0.5, 0.3)
            .and_then(|surface| surface.with_friction_lengths(1e-4, 2e-5))
            .expect("a good surface");
        let scene = Scene::new(coin.expect("a good coin"), surface, 9.81).expect("a good scene");
        let conical = Conical::new(&scene, &Settings::default(), Moreau).expect("good settings");
        let conical = conical.expect("unlike faces");
        for toss in 0..500 {
            let mut dice = Dice::new(73, toss);
            let launch = Launch {
                height_m: 0.5,
                velocity_m_s: Vector3::new(0.2, 0.0, 1.0),
                axis: UnitVector3::new_normalize(dice.vector(1.0)),
                spin_rad_s: dice.vector(50.0),
            };
            let outcome = conical.run(&launch, &mut ()).outcome;
            assert!(outcome.face().is_some(), "{shape} {toss}");
            // a coin that spins rocks from rim to rim 660 times
            assert!(
                outcome.impacts < 1_000,
                "{shape} {toss}: {}",
                outcome.impacts
            );
        }
    }
}

/// Drag takes energy as well: v² at the one rate, and that of the spin at the other.
#[test]
fn rolling_about_the_apex_with_drag_ends_as_its_energy_says() {
    for rim in rims() {
        let (edge, body) = (Edge::new(&rim), rim.body);
        let dynamics = dynamics(body, 0.5, 0.01, [0.4, 0.9]);
        let (s, c, height) = (edge.sin, edge.cos, edge.height);
        let state = |omega: f64| [0.0, -height * omega, s * omega, c * omega];
        let energy = |omega: f64| {
            let (motion, spin) = edge.motion(&dynamics, &state(omega));
            motion.kinetic(&body, &spin)
        };
        // d/dt of ½Iω² is what all losses take
        let slowing = |omega: f64| {
            let [_, vy, axial, turn] = state(omega);
            let spins = body.ka * axial * axial + body.kt * turn * turn;
            let losses = 0.01 * omega / s + 0.4 * vy * vy + 0.9 * spins;
            losses / (2.0 * energy(1.0) * omega)
        };
        let (angle, time) = stops_plainly(slowing, 0.3);
        let stop = edge.rolling_stop(&dynamics, 0.3 * height);
        assert!((stop.distance() / (angle * height) - 1.0).abs() < 1e-5);
        assert!((stop.time / time - 1.0).abs() < 1e-4);
    }
}

/// Beyond the tilt of its edge a coin leans on its other rim.
#[test]
fn a_coin_is_beyond_its_edge_if_it_leans_more() {
    for (trial, rim) in rims().cycle().take(400).enumerate() {
        let mut dice = Dice::new(74, trial as u64);
        let edge = Edge::new(&rim);
        let tilt = libm::atan2(edge.sin, edge.cos);
        let lean = tilt + dice.between(-0.5, 0.5);
        let (sin, cos) = libm::sincos(lean);
        assert_eq!(edge.is_beyond(sin, cos), lean > tilt);
        assert!(!edge.is_beyond(edge.sin, edge.cos));
    }
}

/// The slip is the largest that the point which slips faster can have, whatever the signs of the rates: along the
/// axis, across it with the centre and the roll, and by turning about the vertical.
#[test]
fn the_slip_of_a_coin_on_its_edge_is_that_of_its_faster_point() {
    for (trial, rim) in rims().cycle().take(400).enumerate() {
        let mut dice = Dice::new(75, trial as u64);
        let edge = Edge::new(&rim);
        let [vx, vy, wx, wz] = [0.0; 4].map(|_| dice.between(-1.0, 1.0));
        let mut most = 0.0_f64;
        for turning in [wz, -wz] {
            let spin = Vector3::new(wx, 0.0, turning);
            let u = Vector3::new(edge.sin, 0.0, edge.cos);
            let across = Vector3::new(edge.cos, 0.0, -edge.sin);
            for arm in [
                across * rim.body.radius - u * rim.body.half,
                across * rim.upper.radius + u * rim.upper.half,
            ] {
                let slip = Vector3::new(vx, vy, 0.0) + spin.cross(&arm);
                most = most.max(slip.y.abs() + vx.abs());
            }
            let state = [vx, vy, spin.dot(&u), spin.dot(&across)];
            assert!(edge.slip(&state) >= most * (1.0 - 1e-14));
        }
        let (s, c) = (edge.sin, edge.cos);
        let found = edge.slip(&[vx, vy, s * wx + c * wz, c * wx - s * wz]);
        assert!((found / most - 1.0).abs() < 1e-12, "{found} {most}");
    }
}

/// What could overturn a coin is that of one that rolls as fast as it slides: with the draft δ of its edge the axis of
/// such a coin also turns at tan δ of its roll, and so does its angular momentum.
#[test]
fn a_sliding_coin_may_be_overturned_as_one_that_rolls() {
    let drafts = RATIOS_AND_DRAFTS
        .into_iter()
        .flat_map(|(_, draft)| [draft; 2]);
    for (trial, (rim, draft)) in rims().zip(drafts).cycle().take(400).enumerate() {
        let mut dice = Dice::new(76, trial as u64);
        let edge = Edge::new(&rim);
        let mu = dice.between(0.1, 0.5);
        let dynamics = dynamics(rim.body, mu, 0.0, [0.0; 2]);
        let tan = libm::tan(f64::to_radians(draft)).abs();
        let [vx, vy, wa, wt] = [0.0; 4].map(|_| dice.between(-3.0, 3.0));
        let moment = |axial: f64, turn: f64| {
            let body = &rim.body;
            // ω_θ (I_a ω_a + I_t φ' c), φ' s = ω_θ
            mu * edge.height + turn * (body.ka * axial + body.kt * tan * turn)
        };
        let rolls = (vx.abs() + vy.abs()) / edge.height;
        for (state, axial, turn) in [
            ([vx, vy, 0.0, 0.0], rolls, tan * rolls),
            ([0.0, 0.0, wa, 0.0], wa.abs(), tan * wa.abs()),
            ([0.0, 0.0, wa, wt], wa.abs(), wt.abs() + tan * wa.abs()),
            ([vx, vy, 0.9 * rolls, wt], rolls, wt.abs() + tan * rolls),
        ] {
            let found = edge.overturning(&dynamics, &state);
            let expected = 2.0 * moment(axial, turn);
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    }
}

/// A coin with draft and friction lengths.
pub(super) fn conical() -> Conical<Moreau> {
    let coin = Coin::cylinder(0.4, 0.01).and_then(|coin| coin.with_draft(7.0));
    let surface = Surface::new(0.5, 0.3)
        .and_then(|surface| surface.with_friction_lengths(1e-4, 2e-5))
        .expect("a good surface");
    let scene = Scene::new(coin.expect("a good coin"), surface, 9.81).expect("a good scene");
    let conical = Conical::new(&scene, &Settings::default(), Moreau).expect("good settings");
    conical.expect("unlike faces")
}

pub(super) fn launch(dice: &mut Dice) -> Launch {
    Launch {
        height_m: 0.1,
        velocity_m_s: Vector3::new(0.2, 0.0, 0.5),
        axis: UnitVector3::new_normalize(dice.vector(1.0)),
        spin_rad_s: dice.vector(50.0),
    }
}

/// A toss tells how many impacts it had: as many as an observer sees.
#[test]
fn impacts_are_counted() {
    let conical = conical();
    for toss in 0..20 {
        let mut seen = Recorder::default();
        let outcome = conical
            .run(&launch(&mut Dice::new(77, toss)), &mut seen)
            .outcome;
        let is_impact = |event: &&Event| event.kind == EventKind::Impact;
        let impacts = seen.0.iter().filter(is_impact).count();
        assert!(impacts > 0);
        assert_eq!(outcome.impacts as usize, impacts);
    }
}

/// A toss of which an observer has seen enough ends with its flight.
#[test]
fn a_toss_of_which_enough_is_seen_is_not_followed() {
    struct Enough(Vec<EventKind>);
    impl Observer for Enough {
        fn event(&mut self, event: &Event) {
            self.0.push(event.kind);
        }
        fn has_seen_enough(&self) -> bool {
            true
        }
    }
    let conical = conical();
    let mut seen = Enough(Vec::new());
    let outcome = conical
        .run(&launch(&mut Dice::new(78, 0)), &mut seen)
        .outcome;
    assert_eq!(seen.0, [EventKind::Launched, EventKind::Ended]);
    assert_eq!((outcome.impacts, outcome.face()), (0, None));
}

/// Where a flight ends one rim touches, and the other is not below the surface. The clock goes on from where it was.
#[test]
fn a_flight_ends_where_the_first_rim_touches() {
    let conical = conical();
    let mut turned = 0;
    for trial in 0..200 {
        let launch = launch(&mut Dice::new(79, trial));
        let [soon, late] = [0.0, 7.0].map(|begun| {
            let mut toss = conical.launch(&launch);
            let up = toss.heads_up;
            let mut usage = Usage {
                time: begun,
                ..Usage::default()
            };
            assert!(conical.fly(&mut toss, &mut usage, Departure::Launched, &mut ()));
            let own = &conical.model(&toss).dynamics.body;
            let other = &conical.models[usize::from(toss.heads_up)].dynamics.body;
            let m = &toss.motion;
            let lowest = m.z - own.half * m.cos - own.radius * m.sin;
            let others = m.z + other.half * m.cos - other.radius * m.sin;
            assert!(lowest.abs() < 1e-12, "{trial}: {lowest}");
            assert!(others > -1e-9, "{trial}: {others}");
            turned += u32::from(toss.heads_up != up);
            usage.time
        });
        assert!(soon > 0.0 && (late - soon - 7.0).abs() < 1e-12);
    }
    assert!(turned > 50, "both rims touch first now and then: {turned}");
}
