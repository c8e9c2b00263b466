//! That a config gives another diameter than the coin of an answer has.

/// What the command line gives in place of the config's diameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct OtherSize {
    /// What was asked for: `diameter`, `volume` or `mass`.
    pub(super) asked: &'static str,
    /// The diameter that the config gives, m.
    pub(super) told_m: f64,
}

impl OtherSize {
    /// The remark on a coin of this diameter; empty if that is the config's.
    pub(super) fn remark(&self, diameter_m: f64) -> String {
        let Self { asked, told_m } = self;
        if (told_m / diameter_m - 1.0).abs() <= 1e-9 {
            return String::new();
        }
        let what = if *asked == "diameter" {
            ""
        } else {
            "diameter of "
        };
        format!(
            "(of the {asked} asked for, not the config's {what}{:.2} mm)\n",
            1e3 * told_m
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diameter_that_is_not_the_configs_is_told() {
        let remark = |asked, diameter_m| {
            let told_m = 0.01;
            OtherSize { asked, told_m }.remark(diameter_m)
        };
        assert_eq!(remark("diameter", 2.0 * 0.005), "");
        assert_eq!(
            remark("diameter", 0.024),
            "(of the diameter asked for, not the config's 10.00 mm)\n"
        );
        assert_eq!(
            remark("volume", 0.024),
            "(of the volume asked for, not the config's diameter of 10.00 mm)\n"
        );
    }
}
