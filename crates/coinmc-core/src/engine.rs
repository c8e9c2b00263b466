//! What an engine is.

use crate::{Launch, LaunchDistribution, LaunchSource, Observer, Outcome, Scene, Stream, Tally};
use coinmc_lanes::{Lanes, NoSuchLanes};
use nalgebra::{UnitVector3, Vector3};
use std::ops::{ControlFlow, Range};

/// Takes the outcomes of some tosses, each with its number among the launches, and says whether to
/// go on.
pub type OutcomeSink<'a> = dyn FnMut(&[(u64, Outcome)]) -> ControlFlow<()> + 'a;

/// Turns launches into outcomes.
///
/// An engine is built for one scene, holds no random numbers and no history: the same launch
/// gives the same outcome on any thread, scalar or in a batch, whatever the workspace did before.
///
/// Who learns the engine at run time only has a [`DynEngine`](crate::DynEngine).
pub trait Engine: Sync {
    /// Scratch memory, one a worker, reused from toss to toss. Its history must not leak.
    type Workspace: Send;

    /// A fresh workspace.
    fn workspace(&self) -> Self::Workspace;

    /// The lanes in which it follows many tosses; their launches are drawn in the same.
    fn lanes(&self) -> Lanes {
        Lanes::Scalar
    }

    /// The same engine with these lanes. One that follows its tosses in no lanes stays as it is.
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

    /// Follows one toss to its end and tells the observer what happened on the way.
    fn toss(
        &self,
        workspace: &mut Self::Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Outcome;

    /// Follows many tosses and hands on their outcomes, some at a time and in any order, until the
    /// sink breaks off.
    ///
    /// The default is the scalar path; an engine that is faster with several tosses at a time has its
    /// own. Every outcome is that of [`toss`](Self::toss).
    fn toss_many(
        &self,
        workspace: &mut Self::Workspace,
        launches: LaunchSource<'_>,
        sink: &mut OutcomeSink<'_>,
    ) {
        toss_sequential(self, workspace, launches, sink);
    }

    /// [`toss_many`](Self::toss_many) for callers that have any iterator, and look at the outcomes one
    /// by one.
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

/// Outcomes handed on together: a call of the sink then costs nothing, and tosses of milliseconds are
/// not waited for long.
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
    /// Mechanical energy per unit mass, J/kg, with the potential zero at the surface.
    pub fn energy_j_kg(&self, scene: &Scene) -> f64 {
        let axial = self.spin_rad_s.dot(&self.axis);
        let transverse = (self.spin_rad_s - self.axis.into_inner() * axial).norm_squared();
        0.5 * self.velocity_m_s.norm_squared()
            + 0.5 * scene.coin.axial_gyration_m2() * axial * axial
            + 0.5 * scene.coin.transverse_gyration_m2() * transverse
            + scene.gravity_m_s2() * self.position_m.z
    }
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The coin was let go.
    Launched,
    /// The coin touches the surface, just before the impact.
    Touching,
    /// Just after the impact.
    Impact,
    /// Sustained contact with a fixed contact point began.
    Sticking,
    /// Sustained contact with a sliding contact point began.
    Sliding,
    /// The contact force vanished: flight again.
    LiftOff,
    /// The toss ended; no further event follows.
    Ended,
}

/// An event and the state at it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happened.
    pub kind: EventKind,
    /// The coin at that instant.
    pub state: State,
}

/// Tosses number `tosses.start .. tosses.end` of a stream, tallied: the inner loop of every run.
///
/// Toss k is the same toss whatever the range around it, so tallies of disjoint ranges merge to
/// the tally of their union.
pub fn run_tosses<E: Engine>(
    engine: &E,
    workspace: &mut E::Workspace,
    scene: &Scene,
    launches: &LaunchDistribution,
    stream: &Stream,
    tosses: Range<u64>,
) -> Tally {
    let mut tally = Tally::default();
    let launches = launches.launches(&scene.coin, stream, tosses, engine.lanes());
    engine.toss_many(workspace, launches.into(), &mut |outcomes| {
        for (_, outcome) in outcomes {
            tally.add(outcome);
        }
        ControlFlow::Continue(())
    });
    tally
}
