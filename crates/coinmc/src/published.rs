//! Published outcomes to compare with results. The data, their sources and licences are in the
//! folder
//! `data` and are compiled into the program.

use crate::plan::Point;
use coinmc_core::{Landing, Preset, Scene};
use std::sync::LazyLock;

/// Where the counts of [`Counts`] come from.
pub const TABLE1_SOURCE: &str = "Gaek & Sukhov, arXiv 2401.03557, table 1, Unity";

/// Outcomes of the published Unity scene at one ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Counts {
    /// H/R.
    pub ratio: f64,
    /// Tosses that ended on heads.
    pub heads: u64,
    /// Tosses that ended on tails.
    pub tails: u64,
    /// Tosses that ended on the side.
    pub side: u64,
    /// Tosses with an end that the authors' rule did not recognise.
    pub unidentified: u64,
}

/// A published ratio at which P(side) = 1/3.
#[derive(Debug, Clone, PartialEq)]
pub struct FairRatio {
    /// Name of the engine that computes the same kind of toss.
    pub engine: String,
    /// H/R.
    pub ratio: f64,
    /// Its published error.
    pub half_width: f64,
    /// Authors, reference and model.
    pub source: String,
}

/// The counts published for the launch and ratio of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// The counts.
    pub counts: Counts,
    /// Config keys in which the scene of the point differs from the published one; empty if it is
    /// the same scene.
    pub differs: Vec<&'static str>,
}

static TABLE1: LazyLock<Vec<Counts>> = LazyLock::new(|| {
    let text = include_str!("../data/unity-table1.csv");
    read(text, "ratio,heads,tails,side,unidentified", counts)
});

static FAIR_RATIOS: LazyLock<Vec<FairRatio>> = LazyLock::new(|| {
    let text = include_str!("../data/fair-ratios.csv");
    let header = "engine,fair_ratio,half_width,authors,reference,model";
    read(text, header, fair_ratio)
});

/// The published counts of the Unity scene.
pub fn table1() -> &'static [Counts] {
    &TABLE1
}

/// The published fair ratios of the kind of toss that an engine computes.
pub fn fair_ratios(engine: &str) -> impl Iterator<Item = &'static FairRatio> {
    FAIR_RATIOS.iter().filter(move |fair| fair.engine == engine)
}

/// Parses a CSV file that is compiled into the program.
///
/// # Panics
/// If the file is not as described in `data`; a test reads all of them.
fn read<T>(text: &str, header: &str, parse: fn(&[&str]) -> Option<T>) -> Vec<T> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(header), "the columns in data/README.md");
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            parse(&cells).unwrap_or_else(|| panic!("not a row of {header}: {line}"))
        })
        .collect()
}

fn counts(cells: &[&str]) -> Option<Counts> {
    let [ratio, heads, tails, side, unidentified] = cells else {
        return None;
    };
    Some(Counts {
        ratio: ratio.parse().ok()?,
        heads: heads.parse().ok()?,
        tails: tails.parse().ok()?,
        side: side.parse().ok()?,
        unidentified: unidentified.parse().ok()?,
    })
}

fn fair_ratio(cells: &[&str]) -> Option<FairRatio> {
    let [engine, ratio, half_width, authors, reference, model] = cells else {
        return None;
    };
    Some(FairRatio {
        engine: (*engine).to_owned(),
        ratio: ratio.parse().ok()?,
        half_width: half_width.parse().ok()?,
        source: format!("{authors}, {reference}, {model}"),
    })
}

impl Published {
    /// The counts published for this point, if its launches are distributed like the published ones
    /// (by a preset or spelled out) and its ratio is one of the published ratios.
    ///
    /// # Example
    /// ```
    /// let plan = coinmc::config::parse("inline", "
    ///     coin.ratio = [1, 2]
    ///     surface = { restitution = 0.3, friction = 10 }
    ///     launch.preset = 'table1'
    ///     engine.volumetric = {}
    ///     stop.tosses = 1
    /// ", &[]).unwrap();
    /// let published = coinmc::published::Published::of(&plan.points[0]).unwrap();
    /// assert_eq!((published.counts.side, published.counts.tosses()), (495, 1103));
    /// assert!(published.differs.contains(&"radius_m"));
    /// assert!(coinmc::published::Published::of(&plan.points[1]).is_none());
    /// ```
    pub fn of(point: &Point) -> Option<Self> {
        if !point.engine.makes_tosses() || point.launches != Preset::Table1.distribution() {
            return None;
        }
        // ratios computed from a range are correct to 15 digits
        let same = |ratio: f64| (ratio / point.scene.coin.ratio() - 1.0).abs() < 1e-12;
        let counts = table1().iter().find(|counts| same(counts.ratio))?;
        Some(Self {
            counts: *counts,
            differs: differences(&point.scene),
        })
    }
}

/// The keys in which a scene differs from the published one. Mass has no effect and is left out.
fn differences(scene: &Scene) -> Vec<&'static str> {
    let (surface, drag) = (&scene.surface, scene.drag());
    [
        ("radius_m", scene.coin.radius_m() == 0.5),
        ("rim_radius_m", scene.coin.rim_radius_m() == 0.0),
        ("draft_deg", !scene.coin.is_conical()),
        (
            "centre_of_mass_over_height",
            scene.coin.centre_over_height() == 0.0,
        ),
        ("restitution", surface.restitution() == 0.3),
        ("friction", surface.friction() == 10.0),
        ("rolling_friction_m", surface.rolling_friction_m() == 0.0),
        ("pivoting_friction_m", surface.pivoting_friction_m() == 0.0),
        (
            "restitution_threshold_m_s",
            surface.restitution_threshold_m_s() == 2.0,
        ),
        (
            "restitution_exponent",
            surface.restitution_exponent() == 0.0,
        ),
        ("roughness_slope", surface.roughness().is_none()),
        ("table_radius_m", surface.table_radius_m().is_none()),
        ("table_tilt_deg", surface.tilt().is_none()),
        ("landing", surface.landing() == Landing::Bouncing),
        ("gravity_m_s2", scene.gravity_m_s2() == 9.81),
        ("linear_drag_per_s", drag.linear_per_s() == 1.0),
        ("angular_drag_per_s", drag.angular_per_s() == 0.05),
        ("gyroscopic_torque", !scene.has_gyroscopic_torque()),
    ]
    .into_iter()
    .filter_map(|(key, same)| (!same).then_some(key))
    .collect()
}

impl Counts {
    /// Number of tosses.
    pub fn tosses(&self) -> u64 {
        self.heads + self.tails + self.side + self.unidentified
    }

    /// Fraction of the tosses that ended on the side.
    pub fn p_side(&self) -> f64 {
        self.side as f64 / self.tosses() as f64
    }

    /// Difference between `side` of `tosses` tosses and the published fraction, in standard errors:
    /// the z-score of two proportions, with the variance of the pooled fraction. `None` if that is
    /// 0: there are no tosses, or none or all of them ended on the side.
    ///
    /// # Example
    /// ```
    /// let at_1 = coinmc::published::table1()[2];
    /// assert_eq!(at_1.z_score(495, 1103), Some(0.0));
    /// assert!(at_1.z_score(300, 1103).unwrap() < -8.0);
    /// ```
    pub fn z_score(&self, side: u64, tosses: u64) -> Option<f64> {
        let (n1, n2) = (tosses as f64, self.tosses() as f64);
        let p = side as f64 / n1;
        let pooled = (side as f64 + self.side as f64) / (n1 + n2);
        let z = (p - self.p_side()) / (pooled * (1.0 - pooled) * (1.0 / n1 + 1.0 / n2)).sqrt();
        z.is_finite().then_some(z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_data_match_the_paper() {
        let sides: Vec<_> = table1().iter().map(|c| (c.ratio, c.side)).collect();
        assert_eq!(
            sides,
            [(0.03125, 255), (0.25, 661), (1.0, 495), (5.0, 2404)]
        );
        let tosses: Vec<_> = table1().iter().map(Counts::tosses).collect();
        assert_eq!(tosses, [601_949, 11_500, 1103, 2531]);
        let [flat] = &fair_ratios("flat").collect::<Vec<_>>()[..] else {
            panic!("one")
        };
        assert_eq!((flat.ratio, flat.half_width), (1.5, 0.05));
        assert_eq!(flat.source, "Gaek & Sukhov, arXiv 2401.03557, flat");
        assert_eq!(fair_ratios("volumetric").next().unwrap().ratio, 0.8);
        assert_eq!(fair_ratios("analytic").count(), 0);
    }

    /// 400 of 1000 against 495 of 1103: pooled 895/2103, worked out by hand.
    #[test]
    fn the_z_score_compares_two_proportions() {
        let z = table1()[2].z_score(400, 1000).unwrap();
        let variance = 895.0 / 2103.0 * (1208.0 / 2103.0) * (1.0 / 1000.0 + 1.0 / 1103.0);
        assert!((z - (0.4 - 495.0 / 1103.0) / f64::sqrt(variance)).abs() < 1e-12);
        assert_eq!(table1()[2].z_score(0, 0), None);
        let never = Counts {
            side: 0,
            ..table1()[0]
        };
        assert_eq!(never.z_score(0, 100), None);
    }
}
