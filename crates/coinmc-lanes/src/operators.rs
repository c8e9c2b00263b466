//! Operators and routes that lane types derive from their own methods.

/// Implements the operators of a lane type by its methods of the same names.
macro_rules! operators {
    ($lane:ident, $mask:ident) => {
        operators!(@binary $lane: Add add AddAssign add_assign, Sub sub SubAssign sub_assign,
            Mul mul MulAssign mul_assign);
        operators!(@mask $mask: BitAnd bitand, BitOr bitor);
        impl std::ops::Div for $lane {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                $lane::div(self, other)
            }
        }
        impl std::ops::Neg for $lane {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $lane::neg(self)
            }
        }
        impl std::ops::Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                $mask::not(self)
            }
        }
    };
    (@binary $lane:ident: $($trait:ident $method:ident $assign:ident $assigns:ident),*) => {$(
        impl std::ops::$trait for $lane {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $lane::$method(self, other)
            }
        }
        impl std::ops::$assign for $lane {
            #[inline(always)]
            fn $assigns(&mut self, other: Self) {
                *self = $lane::$method(*self, other);
            }
        }
    )*};
    (@mask $mask:ident: $($trait:ident $method:ident),*) => {$(
        impl std::ops::$trait for $mask {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $mask::$method(self, other)
            }
        }
    )*};
}

/// Implements the route methods of [`Wide`](crate::Wide) for lane types whose registers are
/// permuted by a `$picks` of the route.
#[cfg(target_arch = "x86_64")]
macro_rules! by_permutation {
    ($picks:ident) => {
        #[inline(always)]
        fn follow<const N: usize>(route: &Route, from: &[Block; N], to: &mut [Block; N]) {
            let picks = $picks::of(route);
            for (to, from) in to.iter_mut().zip(from) {
                *to = picks.pick(Self::load(from), Self::load(to)).store();
            }
        }
        #[inline(always)]
        fn follow_bits(route: &Route, from: Bits, to: Bits) -> Bits {
            let (zero, one) = (Self::splat(0.0), Self::splat(1.0));
            let from = Self::select(Self::mask(from), one, zero);
            let to = Self::select(Self::mask(to), one, zero);
            Self::bits(zero.lt($picks::of(route).pick(from, to)))
        }
    };
}

#[cfg(target_arch = "x86_64")]
pub(crate) use by_permutation;
pub(crate) use operators;
