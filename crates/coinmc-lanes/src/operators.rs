//! The operators that every kind of lanes derives from its own methods.

/// Binary operators of a lane type by its methods of the same name, and those that assign.
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

pub(crate) use operators;
