//! The linear system of contact against the textbook and against itself.

use crate::common::in_contact;
use coinmc_oracle::newton_euler::{Contact, Twist, rates, runge_kutta, slip, twist_rates};
use coinmc_oracle::{Model, Motion, textbook, triad};
use coinmc_testkit::{Dice, rolling_scene};
use nalgebra::Vector2;

/// Full friction against what moves.
fn braking(motion: &Motion) -> Twist {
    let (wander, pivot) = twist_rates(motion);
    Twist {
        contour: wander.signum(),
        pivoting: pivot.signum(),
    }
}

fn mode(model: &Model, motion: &Motion, sticks: bool) -> (Contact, Twist) {
    let contact = if sticks {
        Contact::Stick
    } else {
        Contact::Slip(slip(model, motion).normalize())
    };
    (contact, braking(motion))
}

/// Random tilts on both rims.
fn random(dice: &mut Dice) -> (Model, Motion) {
    let model = Model::new(&rolling_scene(dice.between(0.1, 3.0), 0.5, 0.3, 0.02));
    let tilt = dice.between(0.2, 1.4);
    let tilt = if dice.between(0.0, 1.0) < 0.5 {
        tilt
    } else {
        std::f64::consts::PI - tilt
    };
    let motion = in_contact(dice, &model, tilt);
    (model, motion)
}

/// Power: what gravity and friction do is what the energy changes by. F·γ is the power of the
/// contact, to rounding (1e-13 of terms of the order of 10).
#[test]
fn the_energy_changes_by_the_work_of_friction() {
    for trial in 0..400 {
        let mut dice = Dice::new(3, trial);
        let (model, motion) = random(&mut dice);
        let (contact, twist) = mode(&model, &motion, trial % 2 == 0);
        let rates = rates(&model, &motion, contact, twist);
        let inertia = model.inertia(&motion.axis);
        // d(½ω·Iω)/dt = ω·Iω' : the part from I' vanishes, ω·(ω × Iω)
        let power = motion.velocity.dot(&rates.velocity)
            + motion.spin.dot(&(inertia * rates.spin))
            + motion.velocity.z;
        let (wander, pivot) = twist_rates(&motion);
        let friction = rates.force.xy().dot(&slip(&model, &motion))
            - rates.force.z * (model.contour * wander.abs() + model.pivoting * pivot.abs());
        assert!(
            (power - friction).abs() < 1e-11,
            "{trial}: {power} {friction}"
        );
    }
}

/// The derivatives against differences of the state after a small free-standing step: central
/// differences of the gap, of the slip and of the triad's variables along the motion.
#[test]
fn contact_is_kept_and_the_triads_rates_are_derivatives() {
    for trial in 0..100 {
        let mut dice = Dice::new(4, trial);
        let (model, motion) = random(&mut dice);
        let sticks = trial % 2 == 0;
        let h = 1e-4;
        let at = |h: f64| runge_kutta(&model, &motion, h, |m| mode(&model, m, sticks));
        let (before, after) = (at(-h), at(h));
        // no acceleration, hence errors of the order h³ at most
        assert!(after.gap(&model).abs() < 1e-9 && before.gap(&model).abs() < 1e-9);
        let now = |m: &Motion| {
            let (contact, twist) = mode(&model, m, sticks);
            triad(&model, m, &rates(&model, m, contact, twist))
        };
        let ((low, _), (high, _), (_, slope)) = (now(&before), now(&after), now(&motion));
        let pairs = [
            (low.tilt, high.tilt, slope.tilt),
            (low.rocking, high.rocking, slope.rocking),
            (low.spin, high.spin, slope.spin),
            (low.turn, high.turn, slope.turn),
            (low.slip_x, high.slip_x, slope.slip_x),
            (low.slip_y, high.slip_y, slope.slip_y),
        ];
        for (low, high, slope) in pairs {
            // a third of h² times the third derivative, a few hundred
            let difference = (high - low) / (2.0 * h);
            assert!(
                (difference - slope).abs() < 1e-5 * (1.0 + slope.abs()),
                "{trial}: {pairs:?}"
            );
        }
    }
}

/// A coin that precesses at the textbook's rate does so: its tilt stays, its axis turns about the
/// vertical at that rate.
#[test]
fn steady_precession_is_steady() {
    for (ratio, tilt, circle) in [
        (0.01, 0.1, 0.0),
        (0.2, 0.5, 0.0),
        (0.85, 0.6, 0.4),
        (0.2, 1.2, 1.5),
        (0.5, 2.6, -0.3),
    ] {
        let model = Model::new(&rolling_scene(ratio, 0.0, 1.0, 0.0));
        let start = textbook::precessing(&model, tilt, circle).expect("a speed");
        let rate = textbook::steady_precession(&model, tilt, circle).expect("a speed");
        assert!(slip(&model, &start).norm() < 1e-13);
        let rates = rates(&model, &start, Contact::Stick, Twist::default());
        let whirl = nalgebra::Vector3::z() * rate;
        for (derivative, vector) in [(rates.spin, start.spin), (rates.velocity, start.velocity)] {
            let off = derivative - whirl.cross(&vector);
            assert!(
                off.norm() < 1e-11 * (1.0 + rate * rate),
                "{ratio} {tilt}: {off}"
            );
        }
    }
}

#[test]
fn eulers_disk_turns_at_its_known_rate() {
    // corrections of the order of the tilt and of H/R
    let model = Model::new(&rolling_scene(1e-5, 0.0, 1.0, 0.0));
    for tilt in [1e-2, 1e-3] {
        let rate = textbook::steady_precession(&model, tilt, 0.0).expect("a speed");
        let known = textbook::euler_disk_rate(&model, tilt);
        assert!(
            (rate / known - 1.0).abs() < tilt + 1e-5 / tilt,
            "{tilt}: {rate} {known}"
        );
    }
}

/// A coin spun upright and a wheel, from the equations.
#[test]
fn spun_coins_and_wheels_slow_down_at_the_known_rates() {
    let model = Model::new(&rolling_scene(0.2, 0.0, 1.0, 0.02));
    // a hair off upright, so that the lowest rim is one
    let tilt = std::f64::consts::FRAC_PI_2 - 1e-9;
    let upright = in_contact(&mut Dice::new(5, 0), &model, tilt);
    let spun = Motion {
        velocity: nalgebra::Vector3::zeros(),
        spin: nalgebra::Vector3::z() * 3.0,
        ..upright
    };
    let twist = Twist {
        contour: 0.0,
        pivoting: 1.0,
    };
    // the contact lies at H/2 from the vertical through the centre: compare with it on the axis
    let thin = Model {
        half: 0.0,
        rims: [(model.radius, 0.0); 2],
        ..model
    };
    let spun_rates = rates(&thin, &spun, Contact::Slip(Vector2::zeros()), twist);
    let slowing = -spun_rates.spin.z;
    assert!((slowing - textbook::spun_coin_deceleration(&thin)).abs() < 1e-7);

    let across = nalgebra::Vector3::z().cross(&upright.axis);
    let wheel = Motion {
        velocity: across * (-3.0 * thin.radius),
        spin: upright.axis * 3.0,
        ..upright
    };
    let twist = Twist {
        contour: 1.0,
        pivoting: 0.0,
    };
    let wheel_rates = rates(&thin, &wheel, Contact::Stick, twist);
    let slowing = -wheel_rates.spin.dot(&wheel.axis);
    assert!((slowing - textbook::wheel_deceleration(&thin)).abs() < 1e-7);
}
