//! A coin with a conical edge, or with its centre of mass off the middle, as its lower rim sees it. Units as
//! in [`Body`], with D the distance of the farther rim from the centre of mass.
//!
//! The axis points away from the lower rim, the radius R of which lies h from the centre, and that of the
//! upper rim, R', h'. Both rims touch where (h + h') c = (R' − R) s: c, s of the tilt at which the coin is
//! on its edge. For the wider rim c < 0 there, for the narrower one c > 0 with the same size. A loaded
//! cylinder has R' = R: it is on its edge, its side, at c = 0.

use crate::{Body, Coin};

/// The lower rim of a coin whose faces are not alike, and the upper one.
///
/// # Example
/// ```
/// use coinmc_core::{Coin, LowerRim};
/// let coin = Coin::cylinder(1.0, 0.01)?.with_draft(10.0)?;
/// let [with_heads_up, with_tails_up] = LowerRim::of(&coin);
/// // with tails up heads is below, the wider face: its axis points down a little where the edge lies
/// let (_, cos) = with_tails_up.on_edge();
/// assert!((cos + 10.0_f64.to_radians().sin()).abs() < 1e-15);
/// assert_eq!(with_heads_up.on_edge().1, -cos);
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LowerRim {
    /// R, h and the moments.
    pub body: Body,
    /// R', h' and the moments.
    pub upper: Body,
}

impl LowerRim {
    /// With heads up, so that the rim of tails is below, and with tails up.
    pub fn of(coin: &Coin) -> [Self; 2] {
        let d = coin.rim_distance_m();
        let [heads, tails] = coin.rims().map(|rim| Body {
            radius: rim.radius_m / d,
            half: rim.distance_m / d,
            rim: 0.0,
            kt: coin.transverse_gyration_m2() / (d * d),
            ka: coin.axial_gyration_m2() / (d * d),
        });
        let pair = |body, upper| Self { body, upper };
        [pair(tails, heads), pair(heads, tails)]
    }

    /// Sine and cosine of the tilt at which the coin is on its edge: to the last bit those of the other rim
    /// but for the sign of the cosine.
    pub fn on_edge(&self) -> (f64, f64) {
        let cot = (self.upper.radius - self.body.radius) / (self.body.half + self.upper.half);
        let sin = 1.0 / (1.0 + cot * cot).sqrt();
        (sin, cot * sin)
    }

    /// Height of the centre of a coin on its edge.
    pub fn height_on_edge(&self) -> f64 {
        let (sin, cos) = self.on_edge();
        self.body.half * cos + self.body.radius * sin
    }

    /// Distance of this rim from the centre: its height at the balance on this rim, and the energy that it
    /// takes to pass from this face to the edge or back.
    pub fn barrier(&self) -> f64 {
        barrier(&self.body)
    }

    /// The same of the upper rim.
    pub fn upper_barrier(&self) -> f64 {
        barrier(&self.upper)
    }

    /// The energy that it takes to leave the edge: over the nearer rim.
    pub fn edge_barrier(&self) -> f64 {
        self.barrier().min(self.upper_barrier())
    }

    /// Cosine of the tilt at the balance on this rim.
    pub fn balance(&self) -> f64 {
        self.body.half / self.barrier()
    }

    /// Depth of the shallowest of the three wells.
    pub fn shallowest_well(&self) -> f64 {
        let face = |body: &Body| barrier(body) - body.half;
        let edge = self.edge_barrier() - self.height_on_edge();
        edge.min(face(&self.body)).min(face(&self.upper))
    }
}

/// R² + h² is not 1 for both rims.
fn barrier(body: &Body) -> f64 {
    (body.radius * body.radius + body.half * body.half).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rims_are_level_on_the_edge_and_its_well_is_below_the_balances() {
        let cylinder = Coin::cylinder(0.7, 0.01).expect("a good coin");
        let coins = [
            cylinder.with_draft(-8.0),
            cylinder.with_centre_of_mass(0.2, None, None),
        ];
        for rim in coins.iter().flatten().flat_map(LowerRim::of) {
            let (s, c) = rim.on_edge();
            let upper = rim.upper.radius * s - rim.upper.half * c;
            assert!((rim.height_on_edge() - upper).abs() < 1e-15);
            assert!(c < rim.balance() && rim.shallowest_well() > 0.0);
            assert!(rim.edge_barrier() <= 1.0 && rim.edge_barrier() > 0.9);
        }
    }

    /// R = `radius`, and heads and tails at `distances` from the centre of mass, cm: a cylinder of two layers.
    fn two_layers(radius: f64, distances: [f64; 2]) -> [LowerRim; 2] {
        let [heads, tails] = distances;
        let height = heads + tails;
        let coin = Coin::cylinder(height / radius, 0.01 * radius).expect("a good coin");
        let coin = coin.with_centre_of_mass((tails - heads) / (2.0 * height), None, None);
        LowerRim::of(&coin.expect("a coin of two layers"))
    }

    /// To some ulp of numbers of order 1, which come from a few operations.
    fn assert_same(found: f64, expected: f64) {
        assert!((found - expected).abs() < 4e-15, "{found} {expected}");
    }

    /// R = 12, h = 5 and h' = 9: the rims are 13 and 15 = D from the centre. On its side the coin is as high
    /// as R, on a face as h; so the depths of the wells are 13 - 5, 15 - 9 and, the shallowest, 13 - 12.
    #[test]
    fn a_loaded_coin_has_the_barriers_and_wells_of_its_two_triangles() {
        let [on_tails, on_heads] = two_layers(12.0, [5.0, 9.0]);
        for (rim, barrier, upper, half) in
            [(on_tails, 15.0, 13.0, 9.0), (on_heads, 13.0, 15.0, 5.0)]
        {
            assert_same(rim.barrier(), barrier / 15.0);
            assert_same(rim.upper_barrier(), upper / 15.0);
            assert_same(rim.edge_barrier(), 13.0 / 15.0);
            assert_same(rim.balance(), half / barrier);
            assert_same(rim.shallowest_well(), 1.0 / 15.0);
            assert_eq!(rim.on_edge(), (1.0, 0.0));
            assert_same(rim.height_on_edge(), 12.0 / 15.0);
        }
    }

    /// R = 12, h = 16 and h' = 35: the rims are 20 and 37 from the centre, and the wells 20 - 16, 37 - 35 and
    /// 20 - 12 deep.
    #[test]
    fn the_shallowest_well_of_a_tall_loaded_coin_is_its_farther_face() {
        for rim in two_layers(12.0, [16.0, 35.0]) {
            assert_same(rim.shallowest_well(), 2.0 / 37.0);
        }
        let like: [f64; 2] = two_layers(12.0, [35.0, 16.0]).map(|rim| rim.shallowest_well());
        assert_same(like[0], like[1]);
    }

    /// I_a/m = R²/2 and, of two layers, I_t/m = R²/4 + H²/12 - d² with d = (h' - h)/2: here 72 and
    /// 36 + 196/12 - 4, at every scale.
    #[test]
    fn moments_are_in_units_of_the_farther_rims_distance() {
        for scale in [1.0, 1e-3, 250.0] {
            for rim in two_layers(12.0 * scale, [5.0 * scale, 9.0 * scale]) {
                for body in [rim.body, rim.upper] {
                    assert_same(body.ka, 72.0 / 225.0);
                    assert_same(body.kt, (36.0 + 196.0 / 12.0 - 4.0) / 225.0);
                }
            }
        }
    }

    /// A conical edge lies on the ground: the axis points down by the draft where the wider face is below.
    #[test]
    fn a_coin_on_its_edge_leans_by_its_draft() {
        let coin = Coin::cylinder(1.0, 0.01).and_then(|coin| coin.with_draft(10.0));
        let [on_tails, on_heads] =
            LowerRim::of(&coin.expect("a conical coin")).map(|rim| rim.on_edge());
        let (sin, cos) = libm::sincos(10.0_f64.to_radians());
        assert_same(on_heads.0, cos);
        assert_same(on_heads.1, -sin);
        assert_eq!(on_tails, (on_heads.0, -on_heads.1));
    }
}
