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
