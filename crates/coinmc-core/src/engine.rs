//! The trait of all engines.

use crate::{
    Launch, LaunchDistribution, LaunchSource, Observer, Outcome, Scene, Starts, Stream, Tally,
};
use coinmc_lanes::{Lanes, NoSuchLanes};
use nalgebra::{UnitVector3, Vector3};
use std::ops::{ControlFlow, Range};

/// Receives the outcomes of some tosses, each with its number among the launches, and says whether
/// to continue.
pub type OutcomeSink<'a> = dyn FnMut(&[(u64, Outcome)]) -> ControlFlow<()> + 'a;

/// Turns launches into outcomes.
///
/// An engine is built for one scene and holds no random numbers and no history: the same launch
/// gives the same outcome on any thread, scalar or in a batch, whatever the workspace was used for.
///
/// If the engine is chosen at run time, use a [`DynEngine`](crate::DynEngine).
pub trait Engine: Sync {
    /// Scratch memory, one per worker, reused from toss to toss. Its contents must not affect
    /// outcomes.
    type Workspace: Send;

    /// A fresh workspace.
    fn workspace(&self) -> Self::Workspace;

    /// The lanes in which it computes many tosses and draws their launches.
    fn lanes(&self) -> Lanes {
        Lanes::Scalar
    }

    /// The same engine with these lanes. An engine without batches is unchanged.
    ///
    /// # Errors
    /// [`NoSuchLanes`] if this processor has no such instructions.
    fn with_lanes(self, lanes: Lanes) -> Result<Self, NoSuchLanes>
    where
        Self: Sized,
    {
        lanes.available()?;
        Ok(self)
    }

    /// Computes one toss to its end and reports its events to the observer.
    fn toss(
        &self,
        workspace: &mut Self::Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Outcome;

    /// Computes many tosses and passes on their outcomes, some at a time and in any order, until
    /// the sink breaks.
    ///
    /// The default is the scalar path; engines with batches override it. Every outcome is
    /// bit-identical to that of [`toss`](Self::toss).
    fn toss_many(
        &self,
        workspace: &mut Self::Workspace,
        launches: LaunchSource<'_>,
        sink: &mut OutcomeSink<'_>,
    ) {
        toss_sequential(self, workspace, launches, sink);
    }

    /// Like [`toss_many`](Self::toss_many), for any iterator of launches, with a callback for each
    /// outcome.
    fn toss_all(
        &self,
        workspace: &mut Self::Workspace,
        mut launches: impl Iterator<Item = Launch>,
        mut each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        self.toss_many(
            workspace,
            LaunchSource::new(&mut launches),
            &mut |outcomes| {
                let mut outcomes = outcomes.iter();
                outcomes.try_for_each(|(number, outcome)| each(*number, outcome))
            },
        );
    }
}

/// Outcomes passed on at once: enough to make calls of the sink negligible, and few enough to keep
/// it responsive when a toss takes milliseconds.
pub(crate) const AT_ONCE: usize = 32;

/// [`Engine::toss_many`] on the scalar path.
pub fn toss_sequential<E: Engine + ?Sized>(
    engine: &E,
    workspace: &mut E::Workspace,
    launches: LaunchSource<'_>,
    sink: &mut OutcomeSink<'_>,
) {
    let mut outcomes = Vec::with_capacity(AT_ONCE);
    for (number, launch) in (0..).zip(launches) {
        outcomes.push((number, engine.toss(workspace, &launch, &mut ())));
        if outcomes.len() == AT_ONCE {
            if sink(&outcomes).is_break() {
                return;
            }
            outcomes.clear();
        }
    }
    if !outcomes.is_empty() {
        let _ = sink(&outcomes);
    }
}

/// The coin's state at an instant, in the laboratory frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Time since launch, s.
    pub time_s: f64,
    /// Centre of mass, m.
    pub position_m: Vector3<f64>,
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// u, the outward normal of the heads face.
    pub axis: UnitVector3<f64>,
    /// Angular velocity, rad/s.
    pub spin_rad_s: Vector3<f64>,
}

impl State {
    /// Mechanical energy per unit mass, J/kg, with the potential zero at the surface; on a tilted
    /// table at its middle.
    pub fn energy_j_kg(&self, scene: &Scene) -> f64 {
        let axial = self.spin_rad_s.dot(&self.axis);
        let transverse = (self.spin_rad_s - self.axis.into_inner() * axial).norm_squared();
        0.5 * self.velocity_m_s.norm_squared()
            + 0.5 * scene.coin.axial_gyration_m2() * axial * axial
            + 0.5 * scene.coin.transverse_gyration_m2() * transverse
            + self.potential_j_kg(scene)
    }

    /// Potential energy per unit mass, J/kg, zero at the surface; on a tilted table at its middle.
    pub fn potential_j_kg(&self, scene: &Scene) -> f64 {
        -scene.weight_m_s2().dot(&self.position_m)
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The coin was released.
    Launched,
    /// The coin touches the surface, just before the impact.
    Touching,
    /// Just after the impact.
    Impact,
    /// Sustained contact with a fixed contact point began.
    Sticking,
    /// Sustained contact with a sliding contact point began.
    Sliding,
    /// The contact force vanished and flight began again.
    LiftOff,
    /// The toss ended; no further event follows.
    Ended,
}

/// An event and the state of the coin at that instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// The coin at that instant.
    pub state: State,
}

/// Tallies tosses `tosses.start .. tosses.end` of a stream: the inner loop of every run.
///
/// Toss k is the same toss in any range, so the tallies of disjoint ranges merge to the tally of
/// their union.
pub fn run_tosses<E: Engine>(
    engine: &E,
    workspace: &mut E::Workspace,
    scene: &Scene,
    launches: &LaunchDistribution,
    stream: &Stream,
    tosses: Range<u64>,
) -> Tally {
    let mut tally = Tally::default();
    let starts = Starts::default();
    let launches = launches.launches(&scene.coin, stream, tosses, engine.lanes());
    let launches = LaunchSource::from(launches).noting(&starts);
    engine.toss_many(workspace, launches, &mut |outcomes| {
        for (number, outcome) in outcomes {
            tally.add_started(outcome, starts.up(*number));
        }
        ControlFlow::Continue(())
    });
    tally
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{
        self, Fall, Notes, distribution, launches, outcomes_alone, scene, stream,
    };
    use crate::{Coin, Surface, TableTilt};

    /// A coin of R = 2 m and H = 1 m at rest on the plane z = 0, its axis (2, 1, 2)/3.
    fn resting() -> (Scene, State) {
        let coin = Coin::cylinder(0.5, 2.0).unwrap();
        let state = State {
            time_s: 0.0,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(Vector3::new(2.0, 1.0, 2.0)),
            spin_rad_s: Vector3::zeros(),
        };
        (Scene::new(coin, scene().surface, 10.0).unwrap(), state)
    }

    /// By König's theorem the parts add: ½v², ½ω² times R²/2 about the axis, ½ω² times
    /// (3R² + H²)/12 across it, and gz.
    #[test]
    fn energy_is_the_sum_of_motion_spin_tumbling_and_height() {
        let (scene, rest) = resting();
        let across = Vector3::new(1.0, 0.0, -1.0);
        let moving = State {
            velocity_m_s: Vector3::new(1.0, -2.0, 2.0),
            ..rest
        };
        let spinning = State {
            spin_rad_s: rest.axis.into_inner() * 3.0,
            ..rest
        };
        let tumbling = State {
            spin_rad_s: across * 6.0,
            ..rest
        };
        let raised = State {
            position_m: Vector3::new(5.0, -4.0, 0.25),
            ..rest
        };
        let all = State {
            position_m: raised.position_m,
            velocity_m_s: moving.velocity_m_s,
            spin_rad_s: spinning.spin_rad_s + tumbling.spin_rad_s,
            ..rest
        };
        let [v, spin, tumble, z] = [9.0 / 2.0, 9.0, 36.0 * 13.0 / 12.0, 2.5];
        for (state, expected) in [
            (rest, 0.0),
            (moving, v),
            (spinning, spin),
            (tumbling, tumble),
            (raised, z),
            (all, v + spin + tumble + z),
        ] {
            let energy = state.energy_j_kg(&scene);
            // some ten roundings of numbers up to 55
            assert!((energy - expected).abs() < 1e-13, "{energy} {expected}");
        }
    }

    #[test]
    fn a_falling_coin_keeps_its_energy() {
        let mut notes = Notes::new(usize::MAX);
        Fall.toss(&mut (), &launches(1)[0], &mut notes);
        assert_eq!(notes.samples.len(), 5);
        for state in notes.samples {
            // from rest at 1 m under 10 m/s²
            assert!((state.energy_j_kg(&scene()) - 10.0).abs() < 1e-14);
        }
    }

    /// Down a slope of 5° the potential falls by g sin β per metre, and rises by g cos β away from it.
    #[test]
    fn potential_falls_along_a_tilted_table() {
        let tilt = TableTilt::new(5.0, 90.0).unwrap();
        let surface = Surface::new(0.5, 0.3).unwrap().with_tilt(tilt).unwrap();
        let (level, rest) = resting();
        let tilted = Scene::new(level.coin, surface, 10.0).unwrap();
        let at = |x, y, z| State {
            position_m: Vector3::new(x, y, z),
            ..rest
        };
        let (sin, cos) = libm::sincos(5.0_f64.to_radians());
        for (state, on_level, on_tilted) in [
            (at(0.0, 0.0, 2.0), 20.0, 20.0 * cos),
            (at(0.0, 3.0, 0.0), 0.0, -30.0 * sin),
            (at(3.0, 0.0, 0.0), 0.0, 0.0),
        ] {
            assert_eq!(state.potential_j_kg(&level), on_level);
            assert!((state.potential_j_kg(&tilted) - on_tilted).abs() < 1e-14);
        }
    }

    /// Passes these launches to the engine at once; the sink breaks at this call. What it was given.
    fn passed_on(launches: &[Launch], breaks_at: usize) -> Vec<Vec<(u64, Outcome)>> {
        let mut own = launches.iter().copied();
        testing::passed_on(breaks_at, |sink| {
            Fall.toss_many(&mut (), LaunchSource::new(&mut own), sink);
        })
    }

    #[test]
    fn many_tosses_are_the_single_ones_passed_on_some_at_a_time() {
        let launches = launches(3 * AT_ONCE as u64);
        for (tosses, last) in [(0, 0), (1, 1), (64, 32), (95, 31), (96, 32)] {
            let launches = &launches[..tosses];
            let calls = passed_on(launches, usize::MAX);
            assert_eq!(calls.concat(), outcomes_alone(launches));
            let sizes: Vec<usize> = calls.iter().map(Vec::len).collect();
            assert_eq!(sizes.last().copied().unwrap_or(0), last);
            assert!(sizes.iter().rev().skip(1).all(|&size| size == AT_ONCE));
        }
        let calls = passed_on(&launches, 2);
        assert_eq!(calls.concat(), outcomes_alone(&launches)[..64]);
    }

    #[test]
    fn each_toss_is_told_until_one_is_enough() {
        let launches = launches(100);
        let alone = outcomes_alone(&launches);
        for enough in [1, 40, 100, 101] {
            let mut told = Vec::new();
            Fall.toss_all(
                &mut (),
                launches.iter().copied(),
                |number, outcome: &Outcome| {
                    told.push((number, *outcome));
                    if told.len() == enough {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                },
            );
            assert_eq!(told, alone[..enough.min(100)]);
        }
    }

    #[test]
    fn tallies_of_parts_of_a_run_add_to_that_of_the_whole() {
        let run = |tosses| {
            let (scene, launches, stream) = (scene(), distribution(), stream());
            run_tosses(&Fall, &mut (), &scene, &launches, &stream, tosses)
        };
        let mut alone = Tally::default();
        for (launch, (_, outcome)) in launches(100).iter().zip(outcomes_alone(&launches(100))) {
            alone.add_started(&outcome, launch.up());
        }
        let whole = run(0..100);
        assert_eq!(whole, alone);
        // a coin that does not turn shows the face that was up
        assert_eq!((whole.tosses(), whole.same), (100, 100));
        assert!(whole.heads > 0 && whole.tails > 0);
        assert_eq!(run(0..37).checked_merge(&run(37..100)), Some(whole));
    }
}
