//! Ways to find P(heads) of a scene, side by side.

use coinmc_core::{
    Domain, DynEngine, Engine, Face, Landing, LaunchDistribution, Scene, Stream, TossUniforms,
    UniformSource, unit_interval,
};
use coinmc_quadrature::{Goal, Method, Sobol, integrate};
use coinmc_volumetric::Settings;
use std::ops::ControlFlow;

/// A way, by what it does with the random numbers of the launches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// Random tosses.
    Random,
    /// The first random number of the launch in as many strata as there are tosses.
    Stratified,
    /// Random tosses, less the face in which the axis was let go, whose probability is known.
    Control,
    /// Tosses at scrambled Sobol points.
    Sobol,
    /// What `sampling.method = "auto"` does.
    Auto,
}

impl Way {
    const ALL: [Self; 5] = [
        Self::Random,
        Self::Stratified,
        Self::Control,
        Self::Sobol,
        Self::Auto,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Stratified => "stratified",
            Self::Control => "control variate",
            Self::Sobol => "Sobol tosses",
            Self::Auto => "auto",
        }
    }
}

/// A scene with its launches.
pub(super) struct Subject {
    pub(super) scene: Scene,
    pub(super) launches: LaunchDistribution,
    engine: DynEngine,
    /// P(heads) of the axis at launch.
    at_launch: f64,
}

impl Subject {
    /// # Panics
    /// If the default settings are out of range.
    pub(super) fn new(scene: Scene, launches: LaunchDistribution) -> Self {
        let engine = Settings::default().engine(&scene);
        let mut subject = Self {
            scene,
            launches,
            engine: engine.expect("the defaults are in range"),
            at_launch: 0.0,
        };
        subject.at_launch = subject.share_at_launch();
        subject
    }

    /// All ways; where the coin bounces, tosses at Sobol points are the last.
    pub(super) fn ways(&self) -> &'static [Way] {
        match self.scene.surface.landing() {
            Landing::Adhesive => &Way::ALL,
            Landing::Bouncing => &Way::ALL[..4],
        }
    }

    /// The method of `auto`, tosses at Sobol points where that would toss at random.
    pub(super) fn method(&self) -> Method {
        let method = Method::of(&self.scene, &self.launches, f64::INFINITY);
        method.unwrap_or(Method::Tossed)
    }

    /// P(heads) by as many evaluations.
    pub(super) fn heads(&self, way: Way, seed: u64, evaluations: u64) -> f64 {
        let method = match way {
            Way::Sobol => Method::Tossed,
            Way::Auto => self.method(),
            Way::Random | Way::Stratified | Way::Control => {
                return self.sampled(way, seed, evaluations);
            }
        };
        let goal = Goal {
            confidence: 0.95,
            half_width: 0.0,
            evaluations,
        };
        let scrambles = Stream::new(seed, Domain::Scramble, 0);
        let (scene, launches) = (&self.scene, &self.launches);
        let found = integrate(
            method,
            scene,
            launches,
            &self.engine,
            &scrambles,
            &goal,
            || true,
        );
        found.map_or(f64::NAN, |found| found.faces[0].p)
    }

    fn sampled(&self, way: Way, seed: u64, tosses: u64) -> f64 {
        let stream = Stream::new(seed, Domain::Launch, 0);
        let stratum = (way == Way::Stratified).then_some(1.0 / tosses as f64);
        let launch = |toss| {
            let mut uniforms = Stratified {
                toss,
                stratum,
                uniforms: stream.toss(toss),
            };
            self.launches.launch(&self.scene.coin, &mut uniforms)
        };
        let heads = self.tally(tosses, launch);
        if way != Way::Control {
            return heads;
        }
        let began = (0..tosses).filter(|&toss| self.begins_as_heads(launch(toss).axis.z));
        heads - (began.count() as f64 / tosses as f64 - self.at_launch)
    }

    fn tally(&self, tosses: u64, launch: impl Fn(u64) -> coinmc_core::Launch) -> f64 {
        let mut heads = 0_u64;
        let launches = (0..tosses).map(launch);
        self.engine.toss_all(&mut (), launches, |_, outcome| {
            heads += u64::from(outcome.face() == Some(Face::Heads));
            ControlFlow::Continue(())
        });
        heads as f64 / tosses as f64
    }

    fn begins_as_heads(&self, axis_z: f64) -> bool {
        let half = self.scene.coin.ratio() / 2.0;
        axis_z > half / libm::hypot(1.0, half)
    }

    /// P(heads) of the axis at launch, by a million Sobol points.
    fn share_at_launch(&self) -> f64 {
        const POINTS: u64 = 1 << 20;
        let words = &mut Stream::new(u64::MAX, Domain::Scramble, 0).toss(0);
        let sobol = Sobol::scrambled(3, words);
        let up = sobol.points(0..POINTS).filter(|words| {
            let axis = self.launches.orientation.axis(&mut At(words));
            self.begins_as_heads(axis.z)
        });
        up.count() as f64 / POINTS as f64
    }
}

/// A point as the uniforms of an orientation.
struct At<'a>(&'a [u64]);

impl UniformSource for At<'_> {
    fn uniform(&mut self, dimension: u32) -> f64 {
        unit_interval(self.0[dimension as usize])
    }
}

/// Random numbers of a toss, the first of the launch in a stratum of its own.
struct Stratified {
    toss: u64,
    stratum: Option<f64>,
    uniforms: TossUniforms,
}

impl UniformSource for Stratified {
    fn uniform(&mut self, dimension: u32) -> f64 {
        let uniform = self.uniforms.uniform(dimension);
        match self.stratum {
            Some(width) if dimension == 0 => (self.toss as f64 + uniform) * width,
            _ => uniform,
        }
    }
}
