//! The data sets: one entry each.

use super::{DataSet, Experiment, Kind, Predictor};

/// A coin tossed by hand onto an everyday table, of which only the thickness is stated.
const HAND: Experiment = Experiment {
    name: "hand",
    config: None,
    settings: &[],
    drawn: &["surface.", "launch.", "coin."],
};

/// The same with a US nickel, 21.21 mm in diameter.
const NICKEL: Experiment = Experiment {
    name: "nickel",
    config: None,
    settings: &["coin.radius_m=0.010605"],
    drawn: &["surface.", "launch."],
};

/// Dropped without spin, turned anyhow.
const DROP: Experiment = Experiment {
    name: "drop",
    config: None,
    settings: &["launch={ preset = 'drop' }"],
    drawn: &["surface.", "launch.height_m", "coin."],
};

/// Tossed in a browser with e = 0.15.
const BROWSER: Experiment = Experiment {
    name: "browser",
    config: None,
    settings: &["surface.restitution=0.15"],
    drawn: &[
        "surface.friction",
        "surface.rolling_friction_m",
        "surface.contact_patch_m",
        "surface.roughness_slope",
        "surface.roughness_wavelength_m",
        "launch.",
        "coin.",
    ],
};

/// The robot's toss in the plane, by a law without friction.
const ROBOT: Experiment = Experiment {
    name: "robot",
    config: Some(
        "[coin]\nratio = 1.5\nradius_m = 0.01\n[surface]\nrestitution = 0.5\nfriction = 0.0\n\
         [launch]\npreset = \"robot\"\n[engine.flat]\n",
    ),
    settings: &[],
    drawn: &["surface.restitution", "launch.height_m"],
};

/// The scene of table 1, as in examples/table1.toml.
pub(crate) const UNITY: Experiment = Experiment {
    name: "unity",
    config: Some(
        "[coin]\nratio = 1.0\nradius_m = 0.5\nmass_kg = 1.0\n\
         [surface]\nrestitution = 0.3\nfriction = 10.0\nrolling_friction_m = 0.0\n\
         pivoting_friction_m = 0.0\nrestitution_threshold_m_s = 2.0\n\
         [environment]\nlinear_drag_per_s = 1.0\nangular_drag_per_s = 0.05\n\
         gyroscopic_torque = false\n[launch]\npreset = \"table1\"\n[engine.volumetric]\n",
    ),
    settings: &[],
    drawn: &[],
};

const GAEK_SUKHOV: &str = "Gaek & Sukhov, arXiv 2401.03557 (2024)";
const NOT_TO_BE_HAD: &str = "data not to be had";

/// All data sets.
pub(crate) static SETS: [DataSet; 23] = [
    DataSet {
        name: "stand-up-maths",
        doc: "thick coins tossed by hand",
        kind: Kind::Tosses,
        source: "M. Parker & H. Hunt, How thick is a three-sided coin?, Stand-up Maths (2018)",
        stated: "H/R",
        by: Predictor::Prior(&HAND),
    },
    DataSet {
        name: "bartos",
        doc: "48 people: a caught coin shows the side that was up",
        kind: Kind::Tosses,
        source: "F. Bartoš et al., arXiv 2310.04153 (2023)",
        stated: "caught; which side is up",
        by: Predictor::Caught,
    },
    DataSet {
        name: "larwood-ku",
        doc: "two people: a coin shows the side that was up",
        kind: Kind::Tosses,
        source: "P. Ku & J. Larwood, by D. Aldous, 40,000 coin tosses yield ambiguous evidence for dynamical bias (2009)",
        stated: "which side is up; caught (our reading)",
        by: Predictor::Caught,
    },
    DataSet {
        name: "clark-westerberg",
        doc: "the best of 13 people who tried to toss heads",
        kind: Kind::Tosses,
        source: "M. Clark & B. Westerberg, CMAJ 181 (2009) E306",
        stated: "caught; heads up; the best of 13",
        by: Predictor::Caught,
    },
    DataSet {
        name: "kerrich",
        doc: "heads of a thin coin",
        kind: Kind::Tosses,
        source: "J. Kerrich, An Experimental Introduction to the Theory of Probability (1946)",
        stated: "nothing",
        by: Predictor::Even,
    },
    DataSet {
        name: "buffon",
        doc: "heads of a thin coin",
        kind: Kind::Tosses,
        source: "G.-L. Leclerc de Buffon (1777), as textbooks quote him",
        stated: "nothing",
        by: Predictor::Even,
    },
    DataSet {
        name: "pearson",
        doc: "heads of a thin coin",
        kind: Kind::Tosses,
        source: "K. Pearson (about 1900), as textbooks quote him",
        stated: "nothing",
        by: Predictor::Even,
    },
    DataSet {
        name: "unity",
        doc: "table 1: Unity (PhysX), four ratios",
        kind: Kind::Simulation,
        source: GAEK_SUKHOV,
        stated: "everything",
        by: Predictor::Stated(&UNITY),
    },
    DataSet {
        name: "blender",
        doc: "coins dropped in Blender (Bullet)",
        kind: Kind::Simulation,
        source: "I. Shcherbatyi, github.com/iaroslav-ai/coin-experiment (2018)",
        stated: "H/R; dropped, turned anyhow",
        by: Predictor::Prior(&DROP),
    },
    DataSet {
        name: "browser",
        doc: "a fair ratio found in a browser",
        kind: Kind::Simulation,
        source: "imois.in/posts/3-sided-coin (2020)",
        stated: "H/R; e = 0.15",
        by: Predictor::Prior(&BROWSER),
    },
    DataSet {
        name: "gaek-sukhov-flat",
        doc: "the fair ratio of the flat toss with bounces",
        kind: Kind::Simulation,
        source: GAEK_SUKHOV,
        stated: "H/R; the robot's launch but for its height; no friction",
        by: Predictor::Prior(&ROBOT),
    },
    DataSet {
        name: "gaek-sukhov-space",
        doc: "the fair ratio of the volumetric toss, from Unity",
        kind: Kind::Simulation,
        source: GAEK_SUKHOV,
        stated: "everything, as for its table 1",
        by: Predictor::Stated(&UNITY),
    },
    DataSet {
        name: "murray-teare",
        doc: "a nickel on its edge, 1 of 6000: an extrapolation",
        kind: Kind::Theory,
        source: "D. Murray & S. Teare, Phys. Rev. E 48 (1993) 2547",
        stated: "a US nickel",
        by: Predictor::Prior(&NICKEL),
    },
    DataSet {
        name: "pender-uhrin",
        doc: "a nickel on its edge, 1 of 2147",
        kind: Kind::Theory,
        source: "G. Pender & M. Uhrin, arXiv 1407.6307 (2014)",
        stated: "a US nickel",
        by: Predictor::Prior(&NICKEL),
    },
    DataSet {
        name: "yong-mahadevan",
        doc: "the fair ratio of a toss that does not bounce",
        kind: Kind::Theory,
        source: "E. H. Yong & L. Mahadevan, Am. J. Phys. 79 (2011) 1195",
        stated: "flat, vigorous, no bounce: everything that matters",
        by: Predictor::Arc,
    },
    DataSet {
        name: "yong-mahadevan-tosses",
        doc: "their own tosses of coins that do not bounce",
        kind: Kind::Tosses,
        source: "E. H. Yong & L. Mahadevan, Am. J. Phys. 79 (2011) 1195",
        stated: "",
        by: Predictor::Nothing(NOT_TO_BE_HAD),
    },
    DataSet {
        name: "gaek-sukhov-robot",
        doc: "the throws of the robot",
        kind: Kind::Tosses,
        source: GAEK_SUKHOV,
        stated: "",
        by: Predictor::Nothing(NOT_TO_BE_HAD),
    },
    DataSet {
        name: "smith-boll",
        doc: "thick coins tossed by hand more than 10,000 times",
        kind: Kind::Tosses,
        source: "J. Smith & D. Boll, statisticool.com/mathstat/3sided.html (2005)",
        stated: "",
        by: Predictor::Nothing("its counts are not to be had"),
    },
    DataSet {
        name: "kuindersma-blais",
        doc: "cylinders of several sizes, tossed by hand",
        kind: Kind::Tosses,
        source: "S. Kuindersma & B. Blais, The American Statistician 61 (2007) 239",
        stated: "",
        by: Predictor::Nothing(NOT_TO_BE_HAD),
    },
    DataSet {
        name: "dicephysics",
        doc: "cylinders and dice rolled by a machine on several surfaces",
        kind: Kind::Tosses,
        source: "E. Pegg, the site dicephysics",
        stated: "",
        by: Predictor::Nothing(NOT_TO_BE_HAD),
    },
    DataSet {
        name: "budden",
        doc: "square cuboids rolled by pupils",
        kind: Kind::Tosses,
        source: "F. Budden (1980), in The Mathematical Gazette 97.16 (2013)",
        stated: "",
        by: Predictor::Nothing("its bodies are no cylinders"),
    },
    DataSet {
        name: "resting-rigid-bodies",
        doc: "bodies of many shapes brought to rest",
        kind: Kind::Tosses,
        source: "H. Baktash et al., Putting Rigid Bodies to Rest, ACM Trans. Graph. (2025)",
        stated: "",
        by: Predictor::Nothing("no body of it is known to us to be a cylinder"),
    },
    DataSet {
        name: "pybullet",
        doc: "four million coins kicked in pybullet",
        kind: Kind::Simulation,
        source: "L. Zamel, github.com/LeonZamel/Three-Sided-Coin (2018)",
        stated: "",
        by: Predictor::Nothing("a kick in the coin's own frame is no launch of a config"),
    },
];
