//! The distribution of one random quantity.

use super::LaunchError;
use super::draw::Uniforms;
use crate::schema::{
    Absent, Bounds, Field, Kind, ReadError, Value, Values, field, fields, number, table,
};
use coinmc_lanes::{Lane, Mask};

/// The distribution of one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Marginal {
    /// A constant.
    Constant(f64),
    /// Uniform between two values.
    Uniform {
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// Normal.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, not negative.
        sd: f64,
    },
}

impl Marginal {
    /// Checks that the parameters describe a distribution.
    ///
    /// # Errors
    /// [`LaunchError`] if a parameter is not finite, the range is empty or `sd` negative.
    pub fn validate(&self) -> Result<(), LaunchError> {
        match *self {
            Self::Constant(x) if !x.is_finite() => Err(LaunchError::NotFinite("constant")),
            Self::Uniform { from, to } if !(from.is_finite() && to.is_finite()) => {
                Err(LaunchError::NotFinite("end of a uniform"))
            }
            Self::Uniform { from, to } if from > to => Err(LaunchError::EmptyRange { from, to }),
            Self::Normal { mean, sd } if !(mean.is_finite() && sd.is_finite()) => {
                Err(LaunchError::NotFinite("parameter of a normal"))
            }
            Self::Normal { sd, .. } if sd < 0.0 => Err(LaunchError::NegativeDeviation(sd)),
            _ => Ok(()),
        }
    }

    /// A config's key whose value is a marginal: a number, or a table that names a distribution.
    pub(super) fn field(
        name: &'static str,
        doc: &'static str,
        bounds: Bounds,
        absent: Absent,
    ) -> Field {
        field(name, doc, Self::kind(bounds), absent)
    }

    /// What such a value may be.
    pub(super) fn kind(bounds: Bounds) -> Kind {
        let spread = Bounds::closed(0.0, bounds.high);
        let uniform = fields(vec![
            number("from", "Lower end.", bounds, Absent::Required),
            number("to", "Upper end.", bounds, Absent::Required),
        ]);
        let normal = fields(vec![
            number("mean", "Mean.", bounds, Absent::Required),
            number("sd", "Standard deviation.", spread, Absent::Required),
        ]);
        let distributions = vec![
            table(
                "uniform",
                "Uniform between two values.",
                uniform,
                Absent::Required,
            ),
            table("normal", "Normal.", normal, Absent::Required),
        ];
        Kind::Marginal(bounds, distributions)
    }

    /// The marginal that a config gives.
    pub(super) fn read(value: &Value) -> Result<Self, ReadError> {
        let Value::Tagged(name, inner) = value else {
            return Ok(Self::Constant(value.number()?));
        };
        let parameters = inner.table()?;
        match *name {
            "normal" => Ok(Self::Normal {
                mean: parameters.number("mean")?,
                sd: parameters.number("sd")?,
            }),
            "uniform" => {
                let (from, to) = (parameters.number("from")?, parameters.number("to")?);
                if from < to {
                    return Ok(Self::Uniform { from, to });
                }
                let empty = format!("a uniform distribution from {from} to {to} is empty");
                let help =
                    "`to` must be larger than `from`; for a constant write the number itself";
                Err(ReadError::new(empty).with_help(help).at("to"))
            }
            _ => Err(crate::schema::unlisted("distribution", name).into()),
        }
    }

    /// The reverse of [`read`](Self::read).
    pub(super) fn value(&self) -> Value {
        let pair = |name, a: (&'static str, f64), b: (&'static str, f64)| {
            let parameters = [a, b].map(|(key, number)| (key, Value::Number(number)));
            Value::Tagged(
                name,
                Box::new(Value::Table(Values::new(parameters.to_vec()))),
            )
        };
        match *self {
            Self::Constant(value) => Value::Number(value),
            Self::Uniform { from, to } => pair("uniform", ("from", from), ("to", to)),
            Self::Normal { mean, sd } => pair("normal", ("mean", mean), ("sd", sd)),
        }
    }

    /// The distribution of a multiple, for units; `scale` is linear.
    pub(super) fn scaled(&self, scale: impl Fn(f64) -> f64) -> Self {
        match *self {
            Self::Constant(value) => Self::Constant(scale(value)),
            Self::Uniform { from, to } => Self::Uniform {
                from: scale(from),
                to: scale(to),
            },
            Self::Normal { mean, sd } => Self::Normal {
                mean: scale(mean),
                sd: scale(sd),
            },
        }
    }

    /// The inverse CDF: the value at quantile `p` in (0, 1), in every lane.
    #[inline(always)]
    pub fn quantile<L: Lane>(&self, p: L) -> L {
        let k = L::splat;
        match *self {
            Self::Constant(x) => k(x),
            // this form is symmetric: quantile(1 − p) mirrors quantile(p) for from = −to
            Self::Uniform { from, to } => k(from) * (k(1.0) - p) + k(to) * p,
            Self::Normal { mean, sd } => k(mean) + k(sd) * inverse_normal(p),
        }
    }

    /// A value drawn from `dimension` of the source; a constant draws no random number.
    #[inline(always)]
    pub(super) fn sample<L: Lane>(&self, dimension: u32, uniforms: &mut impl Uniforms<L>) -> L {
        match *self {
            Self::Constant(x) => L::splat(x),
            _ => self.quantile(uniforms.uniform(dimension)),
        }
    }
}

/// Inverse of the standard normal CDF, for p in (0, 1): relative error about 1e-16.
///
/// Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Appl. Statist.
/// 37 (1988) 477, routine PPND16. Exactly odd about ½.
///
/// # Example
/// ```
/// use coinmc_core::inverse_normal_cdf;
/// assert!((inverse_normal_cdf(0.975) - 1.959_963_984_540_054).abs() < 1e-15);
/// assert_eq!(inverse_normal_cdf(0.25), -inverse_normal_cdf(0.75));
/// ```
#[inline]
pub fn inverse_normal_cdf(p: f64) -> f64 {
    inverse_normal(p)
}

/// Half width of the central region about ½, which holds 85 % of all p.
const CENTRE: f64 = 0.425;

/// [`inverse_normal_cdf`] in lanes: the central region for all lanes at once, the tails lane by lane.
#[inline(always)]
fn inverse_normal<L: Lane>(p: L) -> L {
    let k = L::splat;
    let q = p - k(0.5);
    let central = q.abs().le(k(CENTRE));
    let tails = p.map_where(!central, tail);
    if !central.any() {
        return tails;
    }
    let r = k(0.180_625) - q * q;
    let centre = q * polynomial(&CENTRE_NUMERATOR, r) / polynomial(&CENTRE_DENOMINATOR, r);
    L::select(central, centre, tails)
}

/// Beyond the central region.
#[inline]
fn tail(p: f64) -> f64 {
    let q = p - 0.5;
    let tail = if q < 0.0 { p } else { 1.0 - p };
    let r = (-libm::log(tail)).sqrt();
    let magnitude = if r <= 5.0 {
        polynomial(&MIDDLE_NUMERATOR, r - 1.6) / polynomial(&MIDDLE_DENOMINATOR, r - 1.6)
    } else {
        polynomial(&FAR_NUMERATOR, r - 5.0) / polynomial(&FAR_DENOMINATOR, r - 5.0)
    };
    magnitude.copysign(q)
}

/// Horner's rule, coefficients from the constant term up.
#[inline(always)]
fn polynomial<L: Lane>(coefficients: &[f64; 8], x: L) -> L {
    let mut sum = L::splat(0.0);
    for coefficient in coefficients.iter().rev() {
        sum = sum * x + L::splat(*coefficient);
    }
    sum
}

const CENTRE_NUMERATOR: [f64; 8] = [
    3.387_132_872_796_366_5,
    1.331_416_678_917_843_8e2,
    1.971_590_950_306_551_3e3,
    1.373_169_376_550_946e4,
    4.592_195_393_154_987e4,
    6.726_577_092_700_87e4,
    3.343_057_558_358_813e4,
    2.509_080_928_730_122_7e3,
];
const CENTRE_DENOMINATOR: [f64; 8] = [
    1.0,
    4.231_333_070_160_091e1,
    6.871_870_074_920_579e2,
    5.394_196_021_424_751e3,
    2.121_379_430_158_659_7e4,
    3.930_789_580_009_271e4,
    2.872_908_573_572_194_3e4,
    5.226_495_278_852_545e3,
];
const MIDDLE_NUMERATOR: [f64; 8] = [
    1.423_437_110_749_683_5,
    4.630_337_846_156_546,
    5.769_497_221_460_691,
    3.647_848_324_763_204_5,
    1.270_458_252_452_368_4,
    2.417_807_251_774_506e-1,
    2.272_384_498_926_918_4e-2,
    7.745_450_142_783_414e-4,
];
const MIDDLE_DENOMINATOR: [f64; 8] = [
    1.0,
    2.053_191_626_637_759,
    1.676_384_830_183_803_8,
    6.897_673_349_851e-1,
    1.481_039_764_274_800_8e-1,
    1.519_866_656_361_645_7e-2,
    5.475_938_084_995_345e-4,
    1.050_750_071_644_416_9e-9,
];
const FAR_NUMERATOR: [f64; 8] = [
    6.657_904_643_501_103,
    5.463_784_911_164_114,
    1.784_826_539_917_291_3,
    2.965_605_718_285_048_7e-1,
    2.653_218_952_657_612_4e-2,
    1.242_660_947_388_078_4e-3,
    2.711_555_568_743_487_6e-5,
    2.010_334_399_292_288_1e-7,
];
const FAR_DENOMINATOR: [f64; 8] = [
    1.0,
    5.998_322_065_558_88e-1,
    1.369_298_809_227_358e-1,
    1.487_536_129_085_061_5e-2,
    7.868_691_311_456_133e-4,
    1.846_318_317_510_054_8e-5,
    1.421_511_758_316_446e-7,
    2.044_263_103_389_939_8e-15,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::UniformSource;

    /// Φ(x) = erfc(−x/√2)/2, with the tail kept relative.
    #[test]
    fn inverts_the_normal_cdf_from_the_far_tail_to_the_centre() {
        for i in 1..=2000 {
            let x = -8.2 * f64::from(i) / 2000.0;
            let p = 0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2);
            // p is good to 2 ulp times its condition number |x φ(x)/Φ(x)| < x² + 1
            let tolerance = 4e-16 * (x * x + 2.0);
            assert!(
                (inverse_normal_cdf(p) / x - 1.0).abs() < tolerance / x.abs().min(1.0),
                "{x}"
            );
        }
    }

    #[test]
    fn invalid_marginals_are_refused() {
        for bad in [
            Marginal::Constant(f64::NAN),
            Marginal::Uniform { from: 1.0, to: 0.0 },
            Marginal::Uniform {
                from: f64::NEG_INFINITY,
                to: 0.0,
            },
            Marginal::Normal {
                mean: 0.0,
                sd: -1.0,
            },
            Marginal::Normal {
                mean: f64::NAN,
                sd: 1.0,
            },
        ] {
            assert!(bad.validate().is_err(), "{bad:?}");
        }
        assert!(Marginal::Uniform { from: 1.0, to: 1.0 }.validate().is_ok());
    }

    #[test]
    fn a_normal_may_have_no_spread_but_a_uniform_of_a_config_must_have_some() {
        let constant = Marginal::Normal { mean: 1.0, sd: 0.0 };
        assert!(constant.validate().is_ok());
        let empty = Marginal::Uniform { from: 1.0, to: 1.0 };
        let error = Marginal::read(&empty.value()).unwrap_err();
        assert_eq!(error.path().collect::<Vec<_>>(), ["to"]);
    }

    #[test]
    fn a_constant_draws_no_random_number() {
        struct Nothing;
        impl UniformSource for Nothing {
            fn uniform(&mut self, dimension: u32) -> f64 {
                panic!("a number was drawn from {dimension}");
            }
        }
        assert_eq!(Marginal::Constant(1.5).sample::<f64>(0, &mut Nothing), 1.5);
    }

    /// 1 + 2x + … + 8x⁷ is the derivative of (x⁹ − 1)/(x − 1): 7·2⁸ + 1 at 2.
    #[test]
    fn a_polynomial_begins_with_its_constant() {
        let coefficients = std::array::from_fn(|i| f64::from(u8::try_from(i).unwrap()) + 1.0);
        assert_eq!(polynomial(&coefficients, 0.0), 1.0);
        assert_eq!(polynomial(&coefficients, 2.0), 7.0 * 256.0 + 1.0);
    }
}
