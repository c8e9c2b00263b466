//! The variable in which a root is sought.

/// The range of a parameter, and the variable u in which it is searched: the logarithm where the
/// range spans more than a factor of two, as for a ratio of lengths, else the parameter in units of
/// a quarter of the range, so that one unit of u is much in either case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    from: f64,
    to: f64,
    logarithmic: bool,
}

impl Axis {
    /// `from` must be below `to`, both finite.
    pub(super) fn new(from: f64, to: f64) -> Self {
        Self {
            from,
            to,
            logarithmic: from > 0.0 && to > 2.0 * from,
        }
    }

    fn unit(self) -> f64 {
        0.25 * (self.to - self.from)
    }

    /// u at a value of the parameter.
    pub(super) fn u(self, value: f64) -> f64 {
        if self.logarithmic {
            libm::log(value)
        } else {
            value / self.unit()
        }
    }

    /// The value of the parameter at u, within the range.
    pub(super) fn value(self, u: f64) -> f64 {
        let value = if self.logarithmic {
            libm::exp(u)
        } else {
            u * self.unit()
        };
        value.clamp(self.from, self.to)
    }

    /// d value/du at a value.
    pub(super) fn rate(self, value: f64) -> f64 {
        if self.logarithmic { value } else { self.unit() }
    }

    /// Both ends, in u.
    pub(super) fn ends(self) -> [f64; 2] {
        [self.u(self.from), self.u(self.to)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn u_and_value_are_inverse() {
        for axis in [
            Axis::new(0.05, 4.0),
            Axis::new(0.0, 1.0),
            Axis::new(-2.0, 1.0),
        ] {
            let [from, to] = axis.ends();
            assert!(from < to);
            for share in [0.1, 0.5, 0.9] {
                let u = from + share * (to - from);
                let value = axis.value(u);
                assert!((axis.u(value) - u).abs() < 1e-12);
                let step = 1e-6;
                let rate = (axis.value(u + step) - axis.value(u - step)) / (2.0 * step);
                assert!((axis.rate(value) / rate - 1.0).abs() < 1e-6);
            }
        }
    }
}
