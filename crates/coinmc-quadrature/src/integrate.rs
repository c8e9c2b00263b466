//! The integration of one scene.

use crate::conditional::Conditional;
use crate::integral::{Integral, Share};
use crate::method::Method;
use crate::replicates::{Goal, REPLICATES};
use crate::sobol::{DIMENSIONS, Points, Sobol};
use crate::variable::upright;
use coinmc_analytic::Rule;
use coinmc_core::{Engine, Face, LaunchDistribution, Scene, Stream, UniformSource, unit_interval};
use std::ops::{ControlFlow, Range};

/// Evaluations between two calls of `keep_going`: at most milliseconds.
const BATCH: u64 = 256;

/// Sums of heads, tails and side.
type Sums = [f64; 3];

/// The sums over a sample.
struct SampleSums {
    sums: Sums,
    /// Some evaluations gave one face or none instead of probabilities.
    counts: bool,
}

/// Finds the probabilities of the faces of a scene with adhesive landing by the scene's
/// [`Method::of`], or by [`Method::Tossed`]. `None` if `keep_going`, called every few hundred
/// evaluations, returns false.
///
/// It ends when every interval is within the goal's half width, or at the goal's evaluations. The
/// result depends on the arguments alone. Only [`Method::Tossed`] uses `engine`.
pub fn integrate<E: Engine>(
    method: Method,
    scene: &Scene,
    launches: &LaunchDistribution,
    engine: &E,
    scrambles: &Stream,
    goal: &Goal,
    keep_going: impl Fn() -> bool,
) -> Option<Integral> {
    let dimensions = method.dimensions(launches);
    match method {
        Method::Zone | Method::Arc => method.by_rule(scene),
        Method::Over(variable) => {
            let conditional = Conditional::new(scene, launches, variable);
            replicated(method, &dimensions, scrambles, goal, |sample| {
                in_closed_form(&conditional, sample, &keep_going)
            })
        }
        Method::Tossed => {
            let launches = upright(launches);
            let mut workspace = engine.workspace();
            replicated(method, &dimensions, scrambles, goal, |sample| {
                let tosses = sample.map(|mut at| launches.launch(&scene.coin, &mut at));
                tossed(engine, &mut workspace, tosses, &keep_going)
            })
        }
    }
}

impl Method {
    /// The probabilities of the faces of a scene with this method, if a rule gives them: exact and
    /// at no cost.
    ///
    /// # Example
    /// ```
    /// use coinmc_core::{Coin, Scene, Surface};
    /// use coinmc_quadrature::Method;
    /// let scene = Scene::new(Coin::cylinder(2.0, 0.01)?, Surface::new(0.0, 0.3)?, 9.81)?;
    /// let found = Method::Zone.by_rule(&scene).ok_or("a rule")?;
    /// assert!(found.exact && (found.side().p - 0.5_f64.sqrt()).abs() < 1e-15);
    /// assert!(Method::Tossed.by_rule(&scene).is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn by_rule(self, scene: &Scene) -> Option<Integral> {
        let rule = match self {
            Self::Zone => Rule::Zone,
            Self::Arc => Rule::Arc,
            Self::Over(_) | Self::Tossed => return None,
        };
        let p = rule.probabilities(scene.coin.ratio());
        Some(exact(self, [p.heads, p.tails, p.side], 0))
    }
}

fn in_closed_form(
    conditional: &Conditional<'_>,
    sample: Sample<'_>,
    keep_going: impl Fn() -> bool,
) -> Option<SampleSums> {
    let mut total = SampleSums {
        sums: [0.0; 3],
        counts: false,
    };
    for (number, mut at) in (0_u64..).zip(sample) {
        if number.is_multiple_of(BATCH) && !keep_going() {
            return None;
        }
        let drawn = at.last();
        let faces = conditional.faces(&mut at, drawn);
        let sums = total.sums.iter_mut().zip(faces.p);
        sums.for_each(|(sum, p)| *sum += p);
        total.counts |= faces.drawn;
    }
    Some(total)
}

fn tossed<E: Engine>(
    engine: &E,
    workspace: &mut E::Workspace,
    launches: impl Iterator<Item = coinmc_core::Launch>,
    keep_going: impl Fn() -> bool,
) -> Option<SampleSums> {
    let (mut sums, mut tosses) = ([0.0; 3], 0_u64);
    let mut running = keep_going();
    if !running {
        return None;
    }
    engine.toss_all(workspace, launches, |_, outcome| {
        for (sum, face) in sums.iter_mut().zip(Face::ALL) {
            *sum += f64::from(u8::from(outcome.face() == Some(face)));
        }
        tosses += 1;
        running = !tosses.is_multiple_of(BATCH) || keep_going();
        if running {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    running.then_some(SampleSums { sums, counts: true })
}

fn exact(method: Method, faces: [f64; 3], evaluations: u64) -> Integral {
    Integral {
        method,
        faces: faces.map(Share::exact),
        evaluations,
        exact: true,
    }
}

/// Sums over samples, with a look at each doubling, until the goal is reached. Without dimensions
/// the sample is one point.
fn replicated(
    method: Method,
    dimensions: &[u32],
    scrambles: &Stream,
    goal: &Goal,
    mut sums_of: impl FnMut(Sample<'_>) -> Option<SampleSums>,
) -> Option<Integral> {
    if dimensions.is_empty() {
        return single_point(method, sums_of);
    }
    // the last coordinate is for the quantity that is integrated out, in case it is drawn
    let scramble = |replicate: u32| {
        let words = &mut scrambles.toss(u64::from(replicate));
        Sobol::scrambled(dimensions.len() + 1, words)
    };
    let replicates: Vec<Sobol> = (0..REPLICATES).map(scramble).collect();
    let mut sums = [[0.0; 3]; REPLICATES as usize];
    let mut found = exact(method, [0.0; 3], 0);
    found.exact = false;
    let (mut done, mut counts) = (0, false);
    for points in goal.looks() {
        for (sums, sobol) in sums.iter_mut().zip(&replicates) {
            let more = sums_of(Sample::new(sobol, dimensions, done..points))?;
            counts |= more.counts;
            sums.iter_mut()
                .zip(more.sums)
                .for_each(|(sum, more)| *sum += more);
        }
        done = points;
        found.faces = goal.shares(&sums, points, counts);
        found.evaluations = points * u64::from(REPLICATES);
        if found.half_width() <= goal.half_width {
            break;
        }
    }
    Some(found)
}

/// The integral where nothing is left to integrate over: one evaluation. The probability of no face
/// widens the interval of every face.
fn single_point(
    method: Method,
    mut sums_of: impl FnMut(Sample<'_>) -> Option<SampleSums>,
) -> Option<Integral> {
    let sobol = Sobol::plain(1);
    let faces = sums_of(Sample::new(&sobol, &[], 1..2))?.sums;
    let undecided = 1.0 - faces.iter().sum::<f64>();
    let mut found = exact(method, faces, 1);
    for share in &mut found.faces {
        share.hi = (share.p + undecided).min(1.0);
    }
    Some(found)
}

/// Points of a replicate, as uniforms of launches.
struct Sample<'a> {
    points: Points<'a>,
    /// The coordinate of each launch dimension.
    places: [usize; DIMENSIONS],
    /// The coordinate after them.
    last: usize,
}

/// The uniforms of one launch.
struct SobolUniforms {
    words: [u64; DIMENSIONS],
    places: [usize; DIMENSIONS],
    last: usize,
}

impl<'a> Sample<'a> {
    fn new(sobol: &'a Sobol, dimensions: &[u32], range: Range<u64>) -> Self {
        let mut places = [0; DIMENSIONS];
        for (place, dimension) in dimensions.iter().enumerate() {
            places[*dimension as usize] = place;
        }
        Self {
            points: sobol.points(range),
            places,
            last: dimensions.len(),
        }
    }
}

impl Iterator for Sample<'_> {
    type Item = SobolUniforms;

    #[inline]
    fn next(&mut self) -> Option<SobolUniforms> {
        let words = self.points.next()?;
        let (places, last) = (self.places, self.last);
        Some(SobolUniforms {
            words,
            places,
            last,
        })
    }
}

impl SobolUniforms {
    fn last(&self) -> f64 {
        unit_interval(self.words[self.last])
    }
}

impl UniformSource for SobolUniforms {
    #[inline]
    fn uniform(&mut self, dimension: u32) -> f64 {
        unit_interval(self.words[self.places[dimension as usize]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Domain, Marginal, Orientation, Spin, Surface};
    use nalgebra::Vector3;

    /// One evaluation, none of whose points is that of the origin; what has no face widens the interval of each up to 1.
    #[test]
    fn a_single_point_without_a_face_widens_every_interval() {
        let method = Method::Tossed;
        let found = single_point(method, |sample| {
            assert_eq!(
                sample.map(|at| at.last()).collect::<Vec<_>>(),
                [unit_interval(1 << 63)]
            );
            Some(SampleSums {
                sums: [0.25, 0.5, 0.0],
                counts: true,
            })
        });
        let found = found.unwrap();
        assert_eq!(found.faces.map(|share| share.p), [0.25, 0.5, 0.0]);
        assert_eq!(found.faces.map(|share| share.hi), [0.5, 0.75, 0.25]);
        assert!(found.exact && found.evaluations == 1);
    }

    /// The quantity that is integrated out has the coordinate after those of the launch, in case it is drawn.
    #[test]
    fn the_last_coordinate_is_one_of_its_own() {
        let sobol = Sobol::plain(3);
        let points: Vec<_> = sobol.points(1..9).collect();
        let sample = Sample::new(&sobol, &[6, 9], 1..9);
        for (mut at, point) in sample.zip(points) {
            let found = [at.uniform(6), at.uniform(9), at.last()];
            assert_eq!(found, [0, 1, 2].map(|i: usize| unit_interval(point[i])));
        }
    }

    /// Every replicate has its own points, of one coordinate more than the launch uses, and each is evaluated once.
    #[test]
    fn replicates_are_scrambles_with_a_coordinate_to_spare() {
        let scrambles = Stream::new(5, Domain::Launch, 0);
        let goal = Goal {
            confidence: 0.95,
            half_width: 0.0,
            evaluations: crate::MIN_EVALUATIONS,
        };
        let (mut evaluated, mut last) = (0, Vec::new());
        let found = replicated(Method::Tossed, &[2], &scrambles, &goal, |sample| {
            for at in sample {
                evaluated += 1;
                last.push(at.last());
            }
            Some(SampleSums {
                sums: [0.0; 3],
                counts: true,
            })
        });
        assert_eq!(found.unwrap().evaluations, evaluated);
        last.sort_by(f64::total_cmp);
        last.dedup();
        assert_eq!(last.len() as u64, evaluated);
    }

    /// Where a quantity was drawn, faces are counted, and the interval is that of counts.
    #[test]
    fn drawn_quantities_are_counts() {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.0, 0.0).unwrap(), 9.81).unwrap();
        let counts = |rate: f64| {
            let launches = LaunchDistribution {
                height_m: Marginal::Uniform { from: 0.5, to: 0.6 },
                velocity_m_s: [Marginal::Constant(0.0); 3],
                orientation: Orientation::Tilt(Marginal::Constant(0.3)),
                spin: Spin::About {
                    axis: Vector3::y_axis(),
                    rate_rad_s: Marginal::Uniform {
                        from: -rate,
                        to: rate,
                    },
                },
            };
            let conditional = Conditional::new(&scene, &launches, crate::Variable::Rate);
            let sobol = Sobol::plain(2);
            let sample = Sample::new(&sobol, &[6], 0..4);
            in_closed_form(&conditional, sample, || true)
                .unwrap()
                .counts
        };
        assert!(counts(1e5) && !counts(10.0));
    }
}
