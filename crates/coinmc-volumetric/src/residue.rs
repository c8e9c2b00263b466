//! Motion that friction has stopped but for its rounding error.
//!
//! The friction lengths stop a coin's spin in an impact, up to rounding: 1e-16 of the spin is left,
//! 1e-32 after the next impact, and so on. A coin that bounces on in a plane has spins of about
//! 1e-160 soon, whose squares are subnormal numbers, with which processors calculate many times
//! slower.
//!
//! So after an impact each rate out of the xz plane below 1e-100 sqrt(g/D) (the velocity v_y below
//! 1e-100 sqrt(g D)) is zero. No term of the kinetic energy grows by that; it falls by at most
//! ½(1 + k_t + k_a) 1e-200 < 1e-199 m g D an impact, where rounding changes it by 1e-16. Each of these
//! rates is a sum of terms with relative rounding errors of 1e-16, so what is taken is less than its
//! rounding error unless all of the terms are below 1e-84. The normal velocity of the contact and
//! its slip along x do not change.

use crate::motion::{Motion, Spin};
use coinmc_lanes::Lane;

/// The least rate, in sqrt(g/D), and velocity, in sqrt(g D), of motion out of the xz plane.
const LEAST_RATE: f64 = 1e-100;

impl<L: Lane> Motion<L> {
    /// Stops each motion out of the xz plane that is slower than [`LEAST_RATE`].
    #[inline(always)]
    pub(crate) fn stop_residue(&mut self, spin: &mut Spin<L>) {
        for rate in [&mut self.vy, &mut spin.axial, &mut spin.turn] {
            *rate = L::select(rate.abs().lt(L::splat(LEAST_RATE)), L::splat(0.0), *rate);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Moreau;
    use crate::model::Model;
    use crate::settings::Settings;
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_lanes::{Block, Lanes, WIDTH, Wide, Work};

    fn model(mu: f64) -> Model<Moreau> {
        let coin = Coin::cylinder(0.85, 0.01).expect("a valid coin");
        let surface = Surface::new(0.8, mu).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        Model::new(&scene, &Settings::default(), Moreau).expect("valid settings")
    }

    /// The rates out of the plane after the impact of a coin with these before it: v_y, ω_a, ω_θ,
    /// and the motion in the plane.
    fn after<L: Lane>(model: &Model<Moreau>, [vy, axial, turn]: [L; 3]) -> [L; 6] {
        let mut motion = Motion::<L>::still();
        motion.set_tilt(L::splat(0.6), L::splat(0.8));
        motion.z = motion.rest_height(&model.dynamics.body);
        (motion.vx, motion.vy, motion.vz) = (L::splat(0.2), vy, L::splat(-1.5));
        let spin = Spin {
            axial,
            turn,
            tilt: L::splat(0.7),
        };
        motion.set_spin(&spin, model.dynamics.axial_factor);
        let bounced = model.bounce(
            &motion,
            &spin,
            <L::Mask as coinmc_lanes::Mask>::splat(false),
        );
        let (m, s) = (bounced.motion, bounced.spin);
        [m.vy, s.axial, s.turn, m.vx, m.vz, s.tilt]
    }

    /// Without friction nothing but the rule changes these rates: those below it become exactly
    /// zero, one by one, and those above it keep every bit.
    #[test]
    fn rates_below_the_least_one_become_zero_and_no_other() {
        let model = model(0.0);
        let (small, kept) = (0.9 * LEAST_RATE, 1.1 * LEAST_RATE);
        for sign in [1.0, -1.0] {
            for which in 0..3 {
                let mut rates = [sign * kept; 3];
                assert_eq!(after(&model, rates)[..3], rates);
                rates[which] = sign * small;
                let [vy, axial, turn, ..] = after(&model, rates);
                let mut expected = rates;
                expected[which] = 0.0;
                assert_eq!([vy, axial, turn], expected);
            }
        }
    }

    /// The motion in the plane after an impact is, to the last bit, that of a coin without any
    /// residue before it: the least rates are below all rounding.
    #[test]
    fn the_motion_in_the_plane_does_not_know_of_the_residue() {
        let model = model(0.3);
        let with = after(&model, [1e-101, -3e-102, 2e-101]);
        assert_eq!(with, after(&model, [0.0; 3]));
        assert_eq!(with[..3], [0.0; 3]);
        assert_eq!(with[3..], after(&model, [1e-90, -1e-90, 1e-90])[3..]);
    }

    struct Impacts<'a> {
        model: &'a Model<Moreau>,
        rates: [Block; 3],
    }

    impl Work for Impacts<'_> {
        type Output = [Block; 6];

        #[inline(always)]
        fn run<L: Wide>(self) -> [Block; 6] {
            let rates = self.rates.map(|block| L::load(&block));
            after(self.model, rates).map(L::store)
        }
    }

    #[test]
    fn lanes_stop_what_the_scalar_path_stops() {
        let model = model(0.3);
        let rates = [
            [1e-101, 1e-99, -1e-160, 0.3, 0.0, -1e-102, 1e-300, 2e-100],
            [1e-160, 1e-101, 0.2, -1e-101, 1e-99, 0.0, 1e-101, -2e-100],
            [-1e-101, 1e-160, 1e-101, 1e-101, -0.1, 1e-101, 0.0, 1e-99],
        ];
        for lanes in Lanes::wide() {
            let model = &model;
            let blocks = lanes.enter(Impacts { model, rates });
            for lane in 0..WIDTH {
                let scalar = after(model, rates.map(|block| block[lane]));
                let own = blocks.map(|block| block[lane].to_bits());
                assert_eq!(own, scalar.map(f64::to_bits), "{lanes}, lane {lane}");
            }
        }
    }
}
