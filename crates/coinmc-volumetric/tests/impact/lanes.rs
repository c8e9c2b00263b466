//! Four lanes side by side: each is to the bit what it is alone.

use crate::common::{case, impulse, parts};
use coinmc_volumetric::{Impulse, Lane, Law, Mask, Touch};
use std::array::from_fn;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

#[derive(Debug, Clone, Copy)]
struct Four([f64; 4]);

#[derive(Debug, Clone, Copy)]
struct Bits([bool; 4]);

macro_rules! arithmetic {
    ($($trait:ident $method:ident $op:tt;)*) => {$(
        impl $trait for Four {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    )*};
}
arithmetic! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
}

impl AddAssign for Four {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Four {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl MulAssign for Four {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
impl Neg for Four {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl BitAnd for Bits {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
}
impl BitOr for Bits {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
}
impl Not for Bits {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.map(|x| !x))
    }
}
impl Mask for Bits {
    fn splat(value: bool) -> Self {
        Self([value; 4])
    }
    fn any(self) -> bool {
        self.0.iter().any(|x| *x)
    }
}

impl Lane for Four {
    type Mask = Bits;

    fn splat(value: f64) -> Self {
        Self([value; 4])
    }
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    fn copysign(self, sign: Self) -> Self {
        Self(from_fn(|i| self.0[i].copysign(sign.0[i])))
    }
    fn round(self) -> Self {
        Self(self.0.map(<f64 as Lane>::round))
    }
    fn lt(self, other: Self) -> Bits {
        Bits(from_fn(|i| self.0[i] < other.0[i]))
    }
    fn le(self, other: Self) -> Bits {
        Bits(from_fn(|i| self.0[i] <= other.0[i]))
    }
    fn select(mask: Bits, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

fn lane(p: &Impulse<Four>, i: usize) -> [f64; 5] {
    [p.x, p.y, p.z, p.contour, p.pivoting].map(|part| part.0[i])
}

#[test]
fn a_lane_does_not_see_the_others() {
    for law in Law::ALL {
        for trial in 0..25_000 {
            // body and friction are a scene's; the touch and e are a lane's
            let cases: [_; 4] = from_fn(|i| {
                let scene = case(21, 4 * trial);
                let mut other = case(21, 4 * trial + i as u64);
                let t = &other.touch;
                other.touch = crate::common::touch(
                    &scene.body,
                    t.sin,
                    [t.slip_x, t.slip_y, t.approach],
                    [t.spin, t.turn],
                );
                other.body = scene.body;
                other.friction = scene.friction;
                other
            });
            let of = |part: fn(&Touch<f64>) -> f64| Four(from_fn(|i| part(&cases[i].touch)));
            let touch = Touch {
                sin: of(|t| t.sin),
                cos: of(|t| t.cos),
                rx: of(|t| t.rx),
                rz: of(|t| t.rz),
                slip_x: of(|t| t.slip_x),
                slip_y: of(|t| t.slip_y),
                approach: of(|t| t.approach),
                spin: of(|t| t.spin),
                turn: of(|t| t.turn),
            };
            let e = Four(from_fn(|i| cases[i].e));
            let together = impulse(law, &cases[0].body, &cases[0].friction, &touch, e);
            for (i, case) in cases.iter().enumerate() {
                let alone = parts(&case.impulse(law));
                assert_eq!(
                    alone.map(f64::to_bits),
                    lane(&together, i).map(f64::to_bits),
                    "{law:?} trial {trial} lane {i} {case:?}"
                );
            }
        }
    }
}
