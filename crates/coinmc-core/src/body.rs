//! The coin in the units of the engines in space: lengths in D = sqrt(R² + H²/4), times in
//! sqrt(D/g), masses in m (Froude scaling). Then g = 1, the energy barrier m g D between a face and
//! the side is 1, and coins of 1 cm and of 1 m need the same computation.

use crate::{Coin, LowerRim, Scene};

/// The coin's shape and its inertia divided by its mass m, in units of D = sqrt(R² + H²/4), the
/// distance of the rim from the centre: radius² + half² = 1.
///
/// A coin with rounded rims is a cylinder with a layer of thickness r all around: `radius` and `half`
/// are those of the cylinder inside, and the lowest point of the coin is r below that cylinder's.
///
/// # Example
/// ```
/// use coinmc_core::{Body, Coin};
/// let body = Body::new(&Coin::cylinder(1.5, 0.01)?);
/// assert!((body.radius - 0.8).abs() < 1e-15 && (body.half - 0.6).abs() < 1e-15);
/// // the coin's axis: I_a = m R²/2
/// assert!((body.ka - 0.32).abs() < 1e-15);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// R/D.
    pub radius: f64,
    /// H/(2D).
    pub half: f64,
    /// r/D, the radius of the rims' rounding.
    pub rim: f64,
    /// I_t/(m D²), about a diameter through the centre.
    pub kt: f64,
    /// I_a/(m D²), about the coin's axis.
    pub ka: f64,
}

impl Body {
    /// The body of a coin. Of one whose faces are not alike that of the rim of tails: see [`LowerRim`].
    pub fn new(coin: &Coin) -> Self {
        if !coin.has_like_faces() {
            return LowerRim::of(coin)[0].body;
        }
        let (radius, half) = coin.shape_by_rim_distance();
        let inner = coin.radius_m() - coin.rim_radius_m();
        let r2 = inner * inner;
        Self {
            radius,
            half,
            rim: coin.rim_radius_m() / inner * radius,
            kt: coin.transverse_gyration_m2() / r2 * radius * radius,
            ka: coin.axial_gyration_m2() / r2 * radius * radius,
        }
    }

    /// The radius of the coin itself, R/D: where it touches when it rolls on its side.
    pub fn outer_radius(&self) -> f64 {
        self.radius + self.rim
    }

    /// Ω_a/ω_a with Ω = L/I_t, the rotation that a free flight keeps: I_a/I_t, or 1 without
    /// gyroscopic torque, where a flight keeps ω itself.
    pub fn axial_factor(&self, gyroscopic_torque: bool) -> f64 {
        if gyroscopic_torque {
            self.ka / self.kt
        } else {
            1.0
        }
    }

    /// Depth, in m g D, of the shallower of the coin's two wells, on its side and on a face: the
    /// energy that just carries it over its rim from rest. Thin coins have a shallow side.
    pub fn shallower_well(&self) -> f64 {
        1.0 - self.radius.max(self.half)
    }

    /// The speed, in sqrt(g D), that just carries the coin out of its shallower well:
    /// sqrt(2 [`shallower_well`](Self::shallower_well)).
    pub fn escape_speed(&self) -> f64 {
        (2.0 * self.shallower_well()).sqrt()
    }
}

/// The units of length and time in SI units.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, Scene, Surface, Units};
/// let scene = Scene::new(Coin::cylinder(1.5, 0.008)?, Surface::new(0.5, 0.3)?, 9.81)?;
/// let units = Units::new(&scene);
/// assert!((units.length_m - 0.01).abs() < 1e-15);
/// assert!((units.speed_m_s() - (9.81_f64 * 0.01).sqrt()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// D, m.
    pub length_m: f64,
    /// r, m: engines measure the centre's height from r above the surface, where it is that of the
    /// cylinder inside above its own lowest point.
    pub rim_m: f64,
    /// sqrt(D/g), s.
    pub time_s: f64,
}

impl Units {
    /// The units of a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            length_m: scene.coin.rim_distance_m(),
            rim_m: scene.coin.rim_radius_m(),
            time_s: scene.time_scale_s(),
        }
    }

    /// One unit of speed, sqrt(g D), m/s.
    pub fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;

    fn coin(ratio: f64) -> Coin {
        Coin::cylinder(ratio, 0.01).expect("a good coin")
    }

    /// R : H/2 : D = 4 : 3 : 5 and 3 : 4 : 5. The centre of the flat one is 3 high on a face and 4 on its
    /// side, that of the tall one the other way round, and 5 on the rim.
    #[test]
    fn the_shallower_well_is_the_higher_of_the_two_ways_to_lie() {
        for ratio in [2.0 * 3.0 / 4.0, 2.0 * 4.0 / 3.0] {
            let body = Body::new(&coin(ratio));
            assert!((body.shallower_well() - 0.2).abs() < 1e-15, "{ratio}");
        }
        // of all coins the one with R = H/2 is the hardest to turn over
        let most = Body::new(&coin(2.0)).shallower_well();
        assert!((most - (1.0 - 0.5_f64.sqrt())).abs() < 1e-15);
    }

    /// v²/2 + g z is g D at the balance on the rim.
    #[test]
    fn the_escape_speed_carries_a_coin_from_its_higher_rest_to_its_rim() {
        for ratio in [0.1, 1.5, 2.0, 5.0] {
            let body = Body::new(&coin(ratio));
            let energy = 0.5 * body.escape_speed().powi(2) + body.radius.max(body.half);
            assert!((energy - 1.0).abs() < 1e-15, "{ratio}");
        }
    }

    #[test]
    fn a_rounded_coin_is_as_wide_as_its_outer_radius() {
        for rim_radius_m in [0.0, 1e-4, 3e-3] {
            let coin = coin(1.0).with_rim_radius(rim_radius_m).expect("rounded");
            let body = Body::new(&coin);
            let outer_m = body.outer_radius() * coin.rim_distance_m();
            // a few operations on a number of 1e-2
            assert!((outer_m - 0.01).abs() < 1e-17, "{rim_radius_m} {outer_m}");
        }
    }

    /// The unit of speed is what a fall through D/2 gives: v² = 2 g D/2.
    #[test]
    fn the_unit_of_speed_is_that_of_a_fall_through_half_a_rim_distance() {
        let surface = Surface::new(0.5, 0.3).expect("a surface");
        for gravity in [9.81, 1.62, 250.0] {
            let scene = Scene::new(coin(0.2), surface, gravity).expect("a scene");
            let units = Units::new(&scene);
            let square = units.speed_m_s().powi(2);
            assert!((square / (gravity * units.length_m) - 1.0).abs() < 1e-15);
            // and after one unit of time a coin at rest has just that speed
            assert!((gravity * units.time_s / units.speed_m_s() - 1.0).abs() < 1e-15);
        }
    }
}
