//! What an engine is, and who may watch it.

use crate::{Launch, LaunchDistribution, Outcome, Scene, Stream, Tally};
use nalgebra::{UnitVector3, Vector3};
use std::ops::{ControlFlow, Range};

/// Turns launches into outcomes.
///
/// An engine is built for one scene, holds no random numbers and no history: the same launch
/// gives the same outcome on any thread, alone or in a batch, whatever the workspace did before.
pub trait Engine: Sync {
    /// Scratch memory, one a worker, reused from toss to toss. Its history must not leak.
    type Workspace: Send;

    /// A fresh workspace.
    fn workspace(&self) -> Self::Workspace;

    /// Follows one toss to its end and tells the observer what happened on the way.
    fn toss(
        &self,
        workspace: &mut Self::Workspace,
        launch: &Launch,
        observer: &mut impl Observer,
    ) -> Outcome;

    /// Follows many tosses and hands on the outcome of each with its number among the launches, in any
    /// order, until `each` breaks off.
    ///
    /// One after the other, unless the engine is faster with several at a time. Every outcome is
    /// that of [`Engine::toss`].
    fn toss_all(
        &self,
        workspace: &mut Self::Workspace,
        launches: impl Iterator<Item = Launch>,
        mut each: impl FnMut(u64, &Outcome) -> ControlFlow<()>,
    ) {
        for (number, launch) in (0..).zip(launches) {
            if each(number, &self.toss(workspace, &launch, &mut ())).is_break() {
                return;
            }
        }
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

/// Watches a toss. `()` watches nothing and compiles away.
///
/// # Example
/// ```
/// use coinmc_core::{Event, EventKind, Observer};
/// struct CountImpacts(u32);
/// impl Observer for CountImpacts {
///     fn event(&mut self, event: &Event) {
///         self.0 += u32::from(event.kind == EventKind::Impact);
///     }
/// }
/// ```
pub trait Observer {
    /// Whether events are wanted at all; engines build none for an observer that is not active.
    const ACTIVE: bool = true;

    /// Called at every event, in order of time.
    fn event(&mut self, event: &Event);

    /// The next instant, s since launch, at which the observer wants to see the coin between
    /// events; infinity (the default) for never. After each [`Observer::sample`] it must be later.
    fn wants_at_s(&self) -> f64 {
        f64::INFINITY
    }

    /// The coin at the instant that [`Observer::wants_at_s`] named: in flight from the closed form,
    /// in sustained contact from a step of the engine's own integrator. In order of time among the
    /// events; at the instant of events, after them.
    fn sample(&mut self, _: &State) {}
}

/// Shows an observer the coin at every instant it wants from `from_s` up to, and without,
/// `until_s`: what an engine does for each piece of a toss, in order. `state_at` gives the coin at
/// an instant, s since launch, of that piece.
///
/// An observer that wants what is past is shown nothing, and one that does not move on is not
/// asked again, so that no observer can hold up a toss.
///
/// # Example
/// ```
/// use coinmc_core::{Event, Observer, State, sample_between};
/// use nalgebra::Vector3;
/// struct Every(f64, Vec<f64>);
/// impl Observer for Every {
///     fn event(&mut self, _: &Event) {}
///     fn wants_at_s(&self) -> f64 {
///         self.0 * self.1.len() as f64
///     }
///     fn sample(&mut self, state: &State) {
///         self.1.push(state.time_s);
///     }
/// }
/// let at = |time_s| State {
///     time_s,
///     position_m: Vector3::zeros(),
///     velocity_m_s: Vector3::zeros(),
///     axis: Vector3::z_axis(),
///     spin_rad_s: Vector3::zeros(),
/// };
/// let mut every = Every(0.25, Vec::new());
/// sample_between(&mut every, 0.0, 0.5, at);
/// sample_between(&mut every, 0.5, 1.0, at);
/// assert_eq!(every.1, [0.0, 0.25, 0.5, 0.75]);
/// ```
pub fn sample_between<O: Observer>(
    observer: &mut O,
    from_s: f64,
    until_s: f64,
    mut state_at: impl FnMut(f64) -> State,
) {
    if !O::ACTIVE {
        return;
    }
    let mut wanted = observer.wants_at_s();
    // not a number is never reached
    while from_s <= wanted && wanted < until_s {
        observer.sample(&state_at(wanted));
        let next = observer.wants_at_s();
        if next <= wanted {
            return;
        }
        wanted = next;
    }
}

impl Observer for () {
    const ACTIVE: bool = false;

    fn event(&mut self, _: &Event) {}
}

impl<O: Observer> Observer for &mut O {
    const ACTIVE: bool = O::ACTIVE;

    fn event(&mut self, event: &Event) {
        (**self).event(event);
    }

    fn wants_at_s(&self) -> f64 {
        (**self).wants_at_s()
    }

    fn sample(&mut self, state: &State) {
        (**self).sample(state);
    }
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
    let launches = tosses.map(|toss| launches.launch(&scene.coin, &mut stream.toss(toss)));
    engine.toss_all(workspace, launches, |_, outcome| {
        tally.add(outcome);
        ControlFlow::Continue(())
    });
    tally
}
