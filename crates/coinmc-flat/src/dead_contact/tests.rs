use super::*;
use crate::ImpactLaw;
use crate::engine::FlatEngine;
use crate::laws::chatterjee_ruina::ChatterjeeRuina;
use crate::laws::moreau::Moreau;
use crate::settings::Settings;
use coinmc_core::{Engine, Preset};
use coinmc_testkit::{Dice, preset_launch, scene};

/// A coin in contact without rebound whose friction is set against it at every instant, within its
/// cone: the worst that any friction can do.
struct Adversary {
    k: f64,
    mu: f64,
    /// Height of the centre when flat, and half the width.
    h: f64,
    w: f64,
}

impl Adversary {
    /// d(ω²)/dψ, ψ the angle from the balance over the corner, with friction `f` of the normal force
    /// that tips the coin over it.
    fn slope(&self, psi: f64, y: f64, f: f64) -> f64 {
        let (a, c) = libm::sincos(psi);
        let lever = a - f * c;
        2.0 * lever * (1.0 - c * y) / (self.k + a * lever)
    }

    fn step(&self, psi: f64, y: f64, f: f64, by: f64) -> f64 {
        let middle = y + 0.5 * by * self.slope(psi, y, f);
        y + by * self.slope(psi + 0.5 * by, middle, f)
    }

    /// Whether the coin comes over its balance, from an angle and ω², on its way out or down.
    fn escapes(&self, mut psi: f64, mut y: f64, mut out: bool) -> bool {
        const STEP: f64 = 1e-3;
        let flat = libm::atan2(self.w, self.h);
        let share = [self.mu, -self.mu].map(|f| {
            let lever = self.w * (self.w - f * self.h);
            (self.k - lever).abs() / (self.k + lever)
        });
        let share = share[0].max(share[1]);
        for _ in 0..200 {
            while out {
                let next = self.step(psi, y, self.mu, -STEP);
                out = next > 0.0;
                if out {
                    (psi, y) = (psi - STEP, next);
                }
                if psi <= 0.0 {
                    return true;
                }
            }
            while psi < flat {
                let by = STEP.min(flat - psi);
                y = self.step(psi, y.max(0.0), -self.mu, by);
                psi += by;
            }
            // the other corner
            (psi, y, out) = (flat, share * share * y, true);
            if y < 1e-6 {
                return false;
            }
        }
        false
    }

    /// The share of random states with less energy than `barrier` that escape.
    fn share_that_escapes(&self, barrier: f64, dice: &mut Dice) -> f64 {
        let flat = libm::atan2(self.w, self.h);
        let (mut states, mut escaped) = (0, 0);
        while states < 300 {
            let psi = dice.between(0.0, flat);
            let (a, c) = libm::sincos(psi);
            // most of them just below the barrier
            let energy = barrier - (barrier - self.h) * dice.between(1e-3, 0.1);
            if energy > c {
                let y = 2.0 * (energy - c) / (self.k + a * a);
                states += 1;
                escaped += i32::from(self.escapes(psi, y, dice.between(0.0, 1.0) < 0.5));
            }
        }
        f64::from(escaped) / f64::from(states)
    }
}

fn wells(ratio: f64) -> (f64, [(f64, f64); 2]) {
    let shape = Shape::new(&scene(ratio, 0.0, 0.3).coin);
    (shape.k, [shape.base(0, false), shape.base(0, true)])
}

/// No friction within the cone gets a coin over a barrier that is claimed; below 1, the barrier
/// without friction, it does.
#[test]
fn no_friction_lifts_a_coin_over_the_barrier() {
    let mut dice = Dice::new(31, 0);
    let (mut claimed, mut needed) = (0, 0);
    for ratio in [0.1, 0.5, 0.85, 1.2, 2.0, 5.0] {
        let (k, wells) = wells(ratio);
        for (h, w) in wells {
            for mu in [0.05, 0.1, 0.2, 0.3, 0.45] {
                let barrier = barrier(k, mu, (h, w));
                if barrier == f64::NEG_INFINITY {
                    continue;
                }
                let adversary = Adversary { k, mu, h, w };
                let escaped = adversary.share_that_escapes(barrier, &mut dice);
                assert_eq!(escaped, 0.0, "H/R {ratio}, μ {mu}, w {w}");
                claimed += 1;
                needed += i32::from(adversary.share_that_escapes(1.0, &mut dice) > 0.0);
            }
        }
    }
    // nearly everywhere a barrier of 1 would be wrong
    assert!(
        claimed > 30 && needed > claimed / 2,
        "{needed} of {claimed}"
    );
}

#[test]
fn the_barrier_has_its_closed_form_where_it_is_proven() {
    let (k, [face, side]) = wells(1.2);
    for (h, w) in [face, side] {
        let expected = (1.0_f64 + 0.09).sqrt() - 0.3 * w;
        assert!((barrier(k, 0.3, (h, w)) - expected).abs() < 1e-15);
        assert!((barrier(k, 1e-9, (h, w)) - 1.0).abs() < 1e-8);
    }
    // a thick coin on its face would keep too much of its rocking, a thin one trips on its side
    let (k, [face, _]) = self::wells(5.0);
    assert_eq!(barrier(k, 0.3, face), f64::NEG_INFINITY);
    let (k, [face, side]) = self::wells(0.1);
    assert_eq!(barrier(k, 0.3, side), f64::NEG_INFINITY);
    // much friction may make a thin coin lift off
    assert!(barrier(k, 0.5, face) > 0.0);
    assert_eq!(barrier(k, 0.6, face), f64::NEG_INFINITY);
}

/// The conditions of the proof, by their words: the most energy after a fall over all angles from which a coin
/// may fall, and the least loss at the other corner over all frictions.
#[test]
fn a_barrier_is_claimed_just_where_the_conditions_of_the_proof_hold() {
    const SHARES: u32 = 2000;
    let mut dice = Dice::new(32, 0);
    let (mut claimed, mut left_open) = (0, 0);
    for _ in 0..2000 {
        let (k, wells) = wells(dice.scale(0.1, 10.0));
        let mu = dice.between(0.02, 0.8);
        let (h, w) = dice.pick(&wells);
        let shares = || (0..=SHARES).map(|i| f64::from(i) / f64::from(SHARES));
        let slope = (1.0 + mu * mu).sqrt();
        let height = (slope - mu * w).min(1.0);
        let flat = libm::atan2(w, h);
        let held = libm::atan(mu);
        if flat <= held {
            assert_eq!(barrier(k, mu, (h, w)), f64::NEG_INFINITY);
            continue;
        }
        // W - μa of a coin that turns back at an angle, or that is met falling with the height as its energy
        let turned = shares().map(|share| held + share * (flat - held));
        let met = turned.clone().filter(|psi| libm::cos(*psi) <= height);
        let turned = turned.map(|psi| libm::cos(psi) - mu * libm::sin(psi));
        let met = met.map(|psi| height - mu * libm::sin(psi));
        let fall = turned.chain(met).fold(f64::NEG_INFINITY, f64::max);
        let left = shares().map(|share| {
            let lever = w * (w - mu * (2.0 * share - 1.0) * h);
            ((k - lever) / (k + lever)).abs()
        });
        let left = left.fold(0.0, f64::max);
        let spare = [
            height - h - left * left * (fall + mu * w - h),
            1.0 + 0.5 * k - slope,
            1.0 + k - mu - fall * fall,
        ];
        let spare = spare.into_iter().fold(f64::INFINITY, f64::min);
        // the maximum over a grid of angles is known to the square of its step
        if spare.abs() < 1e-3 {
            continue;
        }
        let found = barrier(k, mu, (h, w)) > f64::NEG_INFINITY;
        assert_eq!(found, spare > 0.0, "k {k}, μ {mu}, w {w}: {spare}");
        *(if found { &mut claimed } else { &mut left_open }) += 1;
    }
    assert!(claimed > 300 && left_open > 300, "{claimed} {left_open}");
}

fn same_faces<L: ImpactLaw>(law: L) {
    for (ratio, mu) in [(1.2, 0.3), (1.2, 0.1), (0.5, 0.3), (2.0, 0.2), (5.0, 0.3)] {
        let scene = scene(ratio, 0.0, mu);
        let engine = FlatEngine::new(&scene, &Settings::default(), law).expect("valid settings");
        let mut without = engine.clone();
        without.parameters.contact.dead = DeadContact::NONE;
        let (mut steps, mut steps_without) = (0, 0);
        for toss in 0..4_000 {
            let launch = preset_launch(Preset::CleanFlat, &scene, 311, toss);
            let sooner = engine.toss(&mut (), &launch, &mut ());
            let later = without.toss(&mut (), &launch, &mut ());
            assert_eq!(
                sooner.ended, later.ended,
                "H/R {ratio}, μ {mu}, toss {toss}"
            );
            assert!(sooner.impacts <= later.impacts);
            steps += sooner.contact_steps;
            steps_without += later.contact_steps;
        }
        assert!(steps < steps_without, "{steps}, {steps_without}");
    }
}

#[test]
fn no_face_changes() {
    same_faces(Moreau);
    same_faces(ChatterjeeRuina);
}

/// With any rebound nothing is proven, and nothing is decided: not even of a coin flat on its face.
#[test]
fn a_coin_that_bounces_is_not_decided_by_it() {
    for e in [0.0, 0.01, 0.5] {
        let scene = scene(1.2, e, 0.3);
        let engine = FlatEngine::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        let (parameters, shape) = (&engine.parameters, &engine.parameters.shape);
        let launch = preset_launch(Preset::CleanFlat, &scene, 1, 1);
        let mut motion = parameters.launched(&launch).motion;
        (motion.quadrant, motion.delta) = (0, -shape.first_span(0));
        (motion.z, motion.vz, motion.omega) = (shape.base(0, false).0, 0.0, 0.0);
        let decides = parameters.contact.dead.decides(&motion, shape.k);
        assert_eq!(decides, e == 0.0, "e = {e}");
    }
}

/// The barrier is that of the well on whose side of the balance the centre is: of a face or of the side, as the
/// quadrants take turns. A coin that balances on its corner at rest is in no well.
#[test]
fn the_barrier_of_the_present_well_counts() {
    let motion = |quadrant: u8, delta: f64| crate::motion::Motion {
        quadrant,
        delta,
        omega: 0.0,
        x: 0.0,
        z: 0.75,
        // sliding does not count
        vx: 3.0,
        vz: 0.0,
        time: 0.0,
    };
    // the energy is between the two
    let dead = DeadContact {
        barriers: [0.8, 0.7],
    };
    for (quadrant, face_first) in [(0, true), (1, false), (2, true), (3, false)] {
        for delta in [-0.1, 0.1] {
            let on_face = (delta < 0.0) == face_first;
            assert_eq!(
                dead.decides(&motion(quadrant, delta), 0.3),
                on_face,
                "quadrant {quadrant}, δ {delta}"
            );
        }
    }
    let balanced = crate::motion::Motion {
        z: 1.0,
        ..motion(0, 0.0)
    };
    let dead = DeadContact {
        barriers: [1.0, 1.0],
    };
    assert!(!dead.decides(&balanced, 0.3));
}
