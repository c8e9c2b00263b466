//! The regions of the box, one parameter at a time.

use crate::sample::Sample;

/// A parameter of a toss, and where its regions begin.
pub(super) struct Axis {
    pub(super) name: &'static str,
    /// Each region goes from one of these up to, and without, the next.
    edges: &'static [f64],
    of: fn(&Sample) -> f64,
}

/// Parameters by which tosses are told apart.
pub(super) const AXES: [Axis; 6] = [
    Axis {
        name: "H/R",
        edges: &[0.0, 1e-2, 0.1, 1.0, 10.0, 100.0],
        of: |sample| sample.scene.coin.ratio(),
    },
    Axis {
        name: "e",
        edges: &[0.0, f64::MIN_POSITIVE, 0.5, 0.9, 1.0],
        of: |sample| sample.scene.surface.restitution(),
    },
    Axis {
        name: "mu",
        edges: &[0.0, f64::MIN_POSITIVE, 0.1, 1.0, 10.0],
        of: |sample| sample.scene.surface.friction(),
    },
    Axis {
        name: "rho/R",
        edges: &[0.0, f64::MIN_POSITIVE, 1e-3, 1e-2],
        of: |sample| {
            let surface = &sample.scene.surface;
            surface
                .rolling_friction_m()
                .min(surface.pivoting_friction_m())
                / sample.scene.coin.radius_m()
        },
    },
    Axis {
        name: "n",
        edges: &[0.0, 1.0, 10.0, 100.0, 1e4],
        of: Sample::turns,
    },
    Axis {
        name: "height/R",
        edges: &[0.0, f64::MIN_POSITIVE, 1.0, 30.0],
        of: |sample| sample.launch.height_m / sample.scene.coin.radius_m(),
    },
];

impl Axis {
    pub(super) fn regions(&self) -> usize {
        self.edges.len()
    }

    /// The region a toss is in.
    pub(super) fn region(&self, sample: &Sample) -> usize {
        let value = (self.of)(sample);
        // the first edge is 0, and none is negative
        self.edges.partition_point(|edge| *edge <= value).max(1) - 1
    }

    /// "0.1 to 1".
    pub(super) fn label(&self, region: usize) -> String {
        let from = self.edges[region];
        match self.edges.get(region + 1) {
            Some(&to) if to == f64::MIN_POSITIVE => "0".to_owned(),
            Some(&to) if from == f64::MIN_POSITIVE => format!("above 0 to {to}"),
            Some(&to) => format!("{from} to {to}"),
            None => format!("{from} and more"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_toss_is_in_the_region_its_label_names() {
        let samples: Vec<Sample> = (0..500).map(|toss| Sample::new(1, toss)).collect();
        for axis in &AXES {
            for sample in &samples {
                let (value, region) = ((axis.of)(sample), axis.region(sample));
                assert!(axis.edges[region] <= value, "{} {value}", axis.name);
                let above = axis.edges.get(region + 1);
                assert!(above.is_none_or(|edge| value < *edge), "{value}");
            }
        }
        assert_eq!(AXES[1].label(0), "0");
        assert_eq!(AXES[1].label(1), "above 0 to 0.5");
        assert_eq!(AXES[1].label(4), "1 and more");
        assert_eq!(AXES[0].label(0), "0 to 0.01");
    }
}
