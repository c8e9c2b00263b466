//! One impact, beside the coin in vectors.

use super::*;
use crate::motion::Motion;
use crate::rigid::Rigid;
use coinmc_core::Coin;
use coinmc_testkit::Dice;
use nalgebra::Vector3;

/// A slip against which friction and the drive pull along one line stops: at the impulse and with the f of size
/// μ that take it to 0. A slip that they drive along that line keeps its direction.
#[test]
fn a_straight_slip_stops_where_its_speed_is_used_up() {
    let body = Body::new(&Coin::cylinder(0.7, 0.01).expect("a valid coin"));
    let friction = Friction {
        mu: 0.4,
        contour: 0.0,
        pivoting: 0.0,
    };
    let (speed, mu) = (0.5, friction.mu);
    for (angle, rate) in [
        (0.3, -0.6),
        (2.1, -0.05),
        (4.0, -2.0),
        (0.3, 0.6),
        (5.0, 0.1),
    ] {
        let (y, x) = libm::sincos(angle);
        let point = ContactPoint::at(
            &body,
            libm::sincos(1.1),
            [speed * x, speed * y, -1.0],
            [0.0; 2],
        );
        let evolution = Evolution::new(&body, &friction, &point, 0.5);
        // what drives it makes slip' = rate along the slip
        let drive = Drive {
            mu,
            xx: 2.7,
            yy: 3.6,
            bx: (rate + mu * 2.7) * x,
            by: (rate + mu * 3.6) * y,
        };
        match evolution.course(&drive, &evolution.now(), -mu * x, -mu * y) {
            Course::Stops {
                x: fx,
                y: fy,
                length,
            } => {
                assert!(rate < 0.0);
                assert!((libm::hypot(fx, fy) / mu - 1.0).abs() < 1e-12);
                let left = [
                    point.slip_x + (drive.xx * fx + drive.bx) * length,
                    point.slip_y + (drive.yy * fy + drive.by) * length,
                ];
                assert!(left.iter().all(|left| left.abs() < 1e-12), "{left:?}");
                assert!((length * rate + speed).abs() < 1e-12, "{length}");
            }
            course => assert!(rate > 0.0 && matches!(course, Course::Keeps)),
        }
    }
}

/// How often the impacts of a test met each case.
#[derive(Debug, Default)]
struct Seen {
    turning: u32,
    stopped: u32,
    sticking: u32,
    /// Slip that set in again.
    resumed: u32,
    /// ω_x, then ω_z: how often it came to 0, and how often friction could no longer hold it.
    stops: [u32; 2],
    releases: [u32; 2],
}

/// An impact beside the coin in vectors: what its law says must hold at every moment.
struct Watch<'a> {
    evolution: Evolution,
    /// The coin before the impact.
    coin: &'a Rigid,
    mu: f64,
    /// ρ_c/s and ρ_p.
    limits: [f64; 2],
    /// The impulses so far: x, y and z, then those of contour and pivoting friction.
    sum: [f64; 5],
    /// ∫u_z dτ so far, and its least value.
    work: f64,
    least: f64,
    returned: f64,
    seen: &'a mut Seen,
}

/// The impulses of a step.
fn impulses(step: &Step, piece: &Piece) -> [f64; 5] {
    let (c, p) = (&piece.contour, &piece.pivoting);
    let torque = |t: &Torque| t.by_y * step.y + t.rest * step.z;
    [step.x, step.y, step.z, torque(c), torque(p)]
}

/// The parameter at which a path has come to this normal impulse.
fn parameter(path: &Path, z: f64) -> f64 {
    let (mut low, mut high) = (0.0, path.end);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if path.step(middle).z < z {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

impl Watch<'_> {
    /// The coin after the impulses so far and those of a step.
    fn coin_after(&self, step: &Step, piece: &Piece) -> Rigid {
        let more = impulses(step, piece);
        let [x, y, z, contour, pivoting] = std::array::from_fn(|i| self.sum[i] + more[i]);
        let torque = Vector3::new(-contour, 0.0, -pivoting);
        self.coin.pushed(Vector3::new(x, y, z), torque)
    }

    /// The friction at a moment within a piece agrees with the velocities there. `rates` are those of all impulses
    /// and of the work with respect to the normal impulse.
    fn check(&mut self, step: &Step, piece: &Piece, rates: &[f64; 6]) {
        let coin = self.coin_after(step, piece);
        let [fx, fy, _, contour, pivoting, power] = *rates;
        let slip = coin.at_contact();
        let work = self.work + step.work;
        self.least = self.least.min(work);
        assert!((power - slip.z).abs() < 1e-6, "{power} {}", slip.z);
        if slip.z > 1e-9 {
            assert!(work <= self.returned * self.least + 1e-9, "too late");
        }
        let speed = libm::hypot(slip.x, slip.y);
        let size = libm::hypot(fx, fy);
        assert!(size < self.mu + 1e-6, "{size}");
        if speed > 1e-7 {
            // straight pieces are followed with a direction of f that is exact at their ends only
            let bend = (STRAIGHT * self.evolution.size / speed).sqrt();
            let allowed = 1e-6 + 2.0 * self.mu * bend;
            let wrong = libm::hypot(fx + self.mu * slip.x / speed, fy + self.mu * slip.y / speed);
            assert!(wrong < allowed, "f is off by {wrong} at {speed}");
            self.seen.turning += u32::from(matches!(piece.course, Course::Turns));
            self.seen.resumed +=
                u32::from(matches!(piece.course, Course::Keeps) && self.sum[2] > 0.0);
        } else {
            self.seen.sticking += u32::from(piece.still);
        }
        let turns = [coin.omega.x, coin.omega.z];
        for ((friction, turn), limit) in [contour, pivoting].into_iter().zip(turns).zip(self.limits)
        {
            if turn.abs() > 1e-7 {
                assert!(
                    (friction - limit * turn.signum()).abs() < 1e-6,
                    "{friction} {turn}"
                );
            } else {
                assert!(friction.abs() < limit + 1e-6, "{friction} {limit}");
            }
        }
    }

    /// The friction torques at the end of a piece, just before its event.
    fn torques(&self, coin: &Rigid, piece: &Piece) -> [f64; 2] {
        let slip = coin.at_contact();
        let y = -self.mu * slip.y / libm::hypot(slip.x, slip.y);
        [&piece.contour, &piece.pivoting].map(|t| t.by_y * y + t.rest)
    }

    /// Follows the next piece. Returns whether the impact goes on after it.
    fn advance(&mut self) -> bool {
        let now = self.evolution.now();
        let piece = self.evolution.piece(&now);
        let path = self.evolution.path(&piece, &now);
        let cut = self.evolution.cut(&path, &piece, &now);
        let (step, event) = (cut.step, cut.event);
        if step.z > 1e-9 {
            let (end, small) = (parameter(&path, step.z), 1e-4 * path.end);
            for part in [0.05, 0.3, 0.5, 0.7, 0.95] {
                let at = part * end;
                let [before, after] = [-small, small].map(|by| path.step(at + by));
                let [low, high] = [&before, &after].map(|step| impulses(step, &piece));
                let over = 1.0 / (after.z - before.z);
                let mut rates = [0.0; 6];
                for (rate, (high, low)) in rates.iter_mut().zip(high.iter().zip(&low)) {
                    *rate = (high - low) * over;
                }
                rates[5] = (after.work - before.work) * over;
                self.check(&path.step(at), &piece, &rates);
            }
        }
        let coin = self.coin_after(&step, &piece);
        let torques = self.torques(&coin, &piece);
        let more = impulses(&step, &piece);
        self.sum = std::array::from_fn(|i| self.sum[i] + more[i]);
        self.work += step.work;
        self.least = self.least.min(self.work);
        self.evolution.add(&step, &piece);
        let goes_on = self.evolution.switch(event, &piece);
        match event {
            Event::Roll => self.check_switch(0, coin.omega.x, torques[0]),
            Event::Pivot => self.check_switch(1, coin.omega.z, torques[1]),
            Event::EndOfCompression => assert!(coin.at_contact().z.abs() < 1e-9),
            Event::Length if matches!(piece.course, Course::Stops { .. }) => {
                let slip = coin.at_contact();
                assert!(libm::hypot(slip.x, slip.y) < 1e-9, "{slip}");
                self.seen.stopped += 1;
            }
            Event::Length | Event::EndOfImpact => {}
        }
        goes_on
    }

    /// A rate that is held from now on is 0. One that is released has the friction that held it, which is at its
    /// limit.
    fn check_switch(&mut self, which: usize, turn: f64, torque: f64) {
        let rates = &self.evolution.rates;
        let rate = [&rates.roll, &rates.pivot][which];
        assert!(turn.abs() < 1e-9, "{turn}");
        if rate.zero {
            self.seen.stops[which] += 1;
        } else {
            let wrong = (rate.sign * rate.limit - torque).abs();
            // a slip that nearly vanishes tells its direction less exactly
            assert!(wrong < 1e-6 + 1e-13 / self.evolution.now().speed, "{wrong}");
            self.seen.releases[which] += 1;
        }
    }
}

/// A coin at a random tilt, often with a slip or an angular velocity of exactly 0, or nearly.
fn random_coin(dice: &mut Dice) -> (Body, f64, Rigid) {
    let body = if dice.chance() {
        let ratio = dice.scale(0.05, 5.0);
        Body::new(&Coin::cylinder(ratio, 0.01).expect("a valid coin"))
    } else {
        Rigid::generic_body(0.15)
    };
    let tilt = dice.between(0.1, 1.5);
    let (velocity, mut omega) = (dice.vector(1.0), dice.vector(2.0));
    match dice.pick(&[0, 1, 2, 3]) {
        0 => omega.x = 0.0,
        1 => omega.z = 0.0,
        2 => (omega.x, omega.z) = (0.0, 0.0),
        _ => {}
    }
    let mut coin = Rigid::new(&body, tilt, velocity, omega);
    let slip = coin.at_contact();
    coin.velocity.z -= slip.z + dice.between(0.2, 1.5);
    if dice.pick(&[0, 1, 2]) == 0 {
        coin.velocity -= Vector3::new(slip.x, slip.y, 0.0);
    }
    (body, tilt, coin)
}

/// At every moment of an impact Coulomb friction opposes the slip or holds it, contour and pivoting friction oppose ω_x
/// and ω_z or hold them, all as a coin in vectors moves; and e² of the work of compression is returned.
#[test]
fn friction_agrees_with_the_velocities_at_every_moment() {
    let mut seen = Seen::default();
    for trial in 0..600 {
        let mut dice = Dice::new(331, trial);
        let (body, tilt, mut coin) = random_coin(&mut dice);
        let mut length = || dice.pick(&[0.0, 1.0]) * dice.scale(0.01, 0.3);
        let mut friction = Friction {
            contour: length(),
            pivoting: length(),
            mu: dice.scale(0.05, 3.0) * dice.pick(&[0.0, 1.0, 1.0, 1.0, 1.0, 1.0]),
        };
        let mut e = dice.between(0.0, 1.0) * dice.pick(&[0.0, 1.0, 1.0, 1.0]);
        if trial % 4 == 0 {
            // fast, at high friction
            let (x, y) = (dice.between(0.0, 6.0), dice.between(-6.0, 6.0));
            coin.velocity += Vector3::new(x * coin.arm.x.signum(), y, 0.0);
            friction.mu = dice.between(1.0, 4.0);
            e = dice.between(0.8, 1.0);
        }
        let (motion, spin) = coin.folded(body.axial_factor(true), 1.0);
        let mut point = Motion::contact_point(&motion, &body, &spin);
        if libm::hypot(point.slip_x, point.slip_y) < 1e-14 {
            (point.slip_x, point.slip_y) = (0.0, 0.0);
        }
        let mut watch = Watch {
            evolution: Evolution::new(&body, &friction, &point, e),
            coin: &coin,
            mu: friction.mu,
            limits: [friction.contour / libm::sin(tilt), friction.pivoting],
            sum: [0.0; 5],
            work: 0.0,
            least: 0.0,
            returned: 1.0 - e * e,
            seen: &mut seen,
        };
        let mut pieces = 1;
        while watch.advance() {
            pieces += 1;
            assert!(pieces < 1000, "trial {trial} does not end");
        }
        let expected = watch.returned * watch.least;
        assert!((watch.work - expected).abs() < 1e-9, "trial {trial}");
        let p = watch.evolution.impulse(point.sin);
        let after = coin.after(&p);
        assert!(after.at_contact().z > -1e-9, "trial {trial}");
        let [x, y, z, contour, pivoting] = watch.sum;
        for (found, expected) in [
            (p.x, x),
            (p.y, y),
            (p.z, z),
            (p.contour, contour * libm::sin(tilt)),
            (p.pivoting, pivoting),
        ] {
            assert!((found - expected).abs() < 1e-12, "trial {trial}");
        }
        assert!(after.kinetic() < coin.kinetic() + 1e-12, "trial {trial}");
    }
    println!("{seen:?}");
    let Seen {
        turning,
        stopped,
        sticking,
        resumed,
        stops,
        releases,
    } = seen;
    let rates = stops.into_iter().chain(releases);
    let counts = [turning, stopped, sticking, resumed];
    assert!(counts.into_iter().chain(rates).all(|count| count > 5));
}

/// No piece is longer than the normal impulse at which constant friction has returned all of the work.
#[test]
fn the_longest_piece_returns_all_of_the_work() {
    let body = Rigid::generic_body(0.0);
    let friction = Friction {
        mu: 0.4,
        contour: 0.0,
        pivoting: 0.0,
    };
    let point = ContactPoint::at(&body, libm::sincos(0.4), [0.3, 0.5, -1.3], [0.0; 2]);
    let mut evolution = Evolution::new(&body, &friction, &point, 0.5);
    let k = point.matrix(&body);
    for (least, back, normal, x) in [(0.0, 0.0, -1.3, 0.3), (-0.7, 0.2, 0.6, -0.35)] {
        (evolution.least, evolution.back) = (least, back);
        let now = Now {
            slip_x: 0.3,
            slip_y: 0.5,
            normal,
            speed: libm::hypot(0.3, 0.5),
        };
        let length = evolution.longest(&now, x);
        // u_z grows at a constant rate: the mean of both ends is that of the piece
        let end = normal + (k.zz + k.xz * x) * length;
        let work = least + back + 0.5 * (normal + end) * length;
        assert!(end > 0.0 && (0.0..1e-5).contains(&work), "{work}");
    }
}

/// A rate that friction can hold no longer takes the sign of that friction, of which slip and the rest may pull in
/// opposite directions. A point that friction drives down again is compressed again.
#[test]
fn modes_change_with_the_friction_and_the_velocity_at_the_event() {
    let body = Rigid::generic_body(0.0);
    let friction = Friction {
        mu: 0.4,
        contour: 0.1,
        pivoting: 0.1,
    };
    let at = |approach| ContactPoint::at(&body, libm::sincos(0.4), [1.0, -3.0, approach], [0.0; 2]);
    for (approach, rest, sign) in [(-1.0, -0.1, 1.0), (1.0, -0.5, -1.0)] {
        // f_y = .4·3/√10 = .379, half of which is .19
        let piece = || Piece {
            course: Course::Turns,
            x: 0.0,
            y: 0.0,
            length: 1.0,
            still: false,
            drive: Drive {
                mu: 0.4,
                xx: 2.0,
                yy: 3.0,
                bx: 0.5,
                by: 0.0,
            },
            contour: Torque { by_y: 0.5, rest },
            pivoting: Torque { by_y: 0.5, rest },
        };
        let mut evolution = Evolution::new(&body, &friction, &at(approach), 0.5);
        evolution.opening = true;
        assert!(evolution.rates.roll.zero && evolution.rates.pivot.zero);
        assert!(evolution.switch(Event::Roll, &piece()));
        let Rates { roll, pivot } = &evolution.rates;
        assert!(!roll.zero && roll.sign == sign && pivot.zero);
        assert!(evolution.switch(Event::Pivot, &piece()));
        let Rates { roll, pivot } = &evolution.rates;
        assert!(!roll.zero && !pivot.zero && pivot.sign == sign);
        assert_eq!(evolution.opening, approach > 0.0);
        assert!(!evolution.switch(Event::EndOfImpact, &piece()));
    }
}

/// A slip that would have come to 0 later does not stick at what ends its piece before.
#[test]
fn a_slip_sticks_only_where_it_has_stopped() {
    let body = Rigid::generic_body(0.0);
    let friction = Friction {
        mu: 0.4,
        contour: 0.0,
        pivoting: 0.0,
    };
    let point = ContactPoint::at(&body, libm::sincos(0.4), [1.0, 0.0, -1.0], [0.0; 2]);
    for (event, sticks) in [
        (Event::Length, true),
        (Event::EndOfCompression, false),
        (Event::Roll, false),
        (Event::Pivot, false),
        (Event::EndOfImpact, false),
    ] {
        let mut evolution = Evolution::new(&body, &friction, &point, 0.5);
        let mut piece = evolution.piece(&evolution.now());
        piece.course = Course::Stops {
            x: -0.4,
            y: 0.0,
            length: 1.0,
        };
        evolution.switch(event, &piece);
        assert_eq!(evolution.still, sticks, "{event:?}");
    }
}

/// A rate that is 0 apart from rounding, on whichever side of it, does not end a piece on which it stays as it is.
#[test]
fn rounding_of_a_rate_ends_no_piece() {
    let body = Rigid::generic_body(0.0);
    let friction = Friction {
        mu: 0.4,
        contour: 0.1,
        pivoting: 0.1,
    };
    let (s, c) = libm::sincos(0.4);
    let point = ContactPoint::at(&body, (s, c), [1.0, 0.0, -1.0], [0.0; 2]);
    for (sign, roll, pivot) in [
        (1.0, 1e-16, 0.0),
        (-1.0, 1e-16, 0.0),
        (1.0, 0.0, 1e-16),
        (-1.0, 0.0, 1e-16),
    ] {
        let mut evolution = Evolution::new(&body, &friction, &point, 0.5);
        let t = &mut evolution.couplings.rates;
        (t.roll, t.pivot) = (-sign * roll, -sign * pivot);
        for rate in [&mut evolution.rates.roll, &mut evolution.rates.pivot] {
            (rate.zero, rate.sign) = (false, sign);
        }
        let now = evolution.now();
        let piece = Piece {
            contour: Torque::NONE,
            pivoting: Torque::NONE,
            course: Course::Keeps,
            x: -0.4,
            y: 0.0,
            ..evolution.piece(&now)
        };
        let path = evolution.path(&piece, &now);
        let cut = evolution.cut(&path, &piece, &now);
        assert_eq!(cut.event, Event::EndOfCompression, "{sign} {roll}");
    }
}
