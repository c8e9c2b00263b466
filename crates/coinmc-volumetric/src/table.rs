//! A table with an edge: tosses whose coin leaves it.
//!
//! The motion of a coin does not depend on where it is until it is beyond the edge. So a toss on a
//! table is followed as on an endless one, to rest, by the scalar path with an observer that watches
//! where the centre is; and where it was beyond the edge, the coin has left, whatever it would have
//! done there. A coin that stays shows the face that is decided on an endless table: what a decision
//! rules out cannot happen afterwards, whatever small errors of long motion may do. A centre that is beyond the edge in flight lands beyond it: flights are straight seen
//! from above, and the table is convex.
//!
//! In contact the centre is looked at so often that it cannot pass the edge in between by more than
//! [`RESOLUTION`] of the coin's radius: no later than a coin as fast as its energy allows would need
//! to the edge.

use crate::finished_toss::FinishedToss;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::settings::{Settings, SettingsError};
use coinmc_core::{Ended, Event, EventKind, Launch, Observer, Scene, State};

/// Smallest way between two looks at the centre, in radii of the coin.
const RESOLUTION: f64 = 0.01;

/// A round table, above whose middle coins are launched.
#[derive(Debug, Clone)]
pub(crate) struct Table<L> {
    /// What follows tosses to rest.
    model: Model<L>,
    radius_m: f64,
    /// Smallest way between two looks, m.
    resolution_m: f64,
    scene: Scene,
}

impl<L: ImpactLaw> Table<L> {
    /// The table of a scene; `None` if it is endless.
    pub(crate) fn new(
        scene: &Scene,
        settings: &Settings,
        law: L,
    ) -> Result<Option<Self>, SettingsError> {
        let Some(radius_m) = scene.surface.table_radius_m() else {
            return Ok(None);
        };
        Ok(Some(Self {
            model: Model::new(scene, settings, law)?,
            radius_m,
            resolution_m: RESOLUTION * scene.coin.radius_m(),
            scene: *scene,
        }))
    }

    /// Whether a coin that slides on for ever without friction, slowed down by drag alone if at all,
    /// comes to rest beyond the edge.
    fn coasts_away(&self, state: &State) -> bool {
        let velocity = state.velocity_m_s.xy();
        let drag = self.scene.drag().linear_per_s();
        velocity.norm() > 0.0
            && (drag == 0.0 || (state.position_m.xy() + velocity / drag).norm() > self.radius_m)
    }
}

/// Passes on what happens on the table to an observer, and nothing of what happens beyond its edge.
struct EdgeWatch<'a, L, O> {
    table: &'a Table<L>,
    observer: &'a mut O,
    /// When to look at the centre again, s since the launch.
    look_at_s: f64,
    /// The coin where it was first seen beyond the edge.
    left: Option<State>,
    last: Option<State>,
}

impl<L, O: Observer> EdgeWatch<'_, L, O> {
    fn look(&mut self, state: &State) {
        let inside_m = self.table.radius_m - state.position_m.xy().norm();
        if self.left.is_none() && inside_m < 0.0 {
            self.left = Some(*state);
            self.look_at_s = f64::INFINITY;
            if O::ACTIVE {
                let kind = EventKind::Ended;
                self.observer.event(&Event {
                    kind,
                    state: *state,
                });
            }
        }
        if self.left.is_none() {
            let fastest = (2.0 * state.energy_j_kg(&self.table.scene).max(0.0)).sqrt();
            let way = inside_m.max(self.table.resolution_m);
            self.look_at_s = state.time_s + way / fastest;
        }
    }
}

impl<L, O: Observer> Observer for EdgeWatch<'_, L, O> {
    fn event(&mut self, event: &Event) {
        self.look(&event.state);
        self.last = Some(event.state);
        if O::ACTIVE && self.left.is_none() {
            self.observer.event(event);
        }
    }

    fn wants_at_s(&self) -> f64 {
        if self.left.is_some() {
            f64::INFINITY
        } else if O::ACTIVE {
            self.look_at_s.min(self.observer.wants_at_s())
        } else {
            self.look_at_s
        }
    }

    fn has_seen_enough(&self) -> bool {
        self.left.is_some()
    }

    fn sample(&mut self, state: &State) {
        let wanted = O::ACTIVE && self.observer.wants_at_s() <= state.time_s;
        // not at the observer's instants: observing changes nothing
        if self.look_at_s <= state.time_s {
            self.look(state);
        }
        if wanted && self.left.is_none() {
            self.observer.sample(state);
        }
    }
}

impl<L: ImpactLaw> Table<L> {
    /// Simulates one toss on the table; `endless` is the same without an edge.
    pub(crate) fn run<O: Observer>(
        &self,
        endless: &Model<L>,
        launch: &Launch,
        observer: &mut O,
    ) -> FinishedToss {
        let mut watch = EdgeWatch {
            table: self,
            observer,
            look_at_s: 0.0,
            left: None,
            last: None,
        };
        let mut toss = self.model.run(launch, &mut watch);
        let waits = self.model.rule.awaits_rest();
        let outcome = &mut toss.outcome;
        let goes_on = match outcome.ended {
            Ended::NeverSettles => true,
            Ended::Decided(_) => !self.model.adhesive && !waits,
            _ => false,
        };
        let coasts = goes_on && watch.last.is_some_and(|last| self.coasts_away(&last));
        if watch.left.is_some() || coasts {
            outcome.ended = Ended::Left;
            outcome.side_ending = None;
        } else if waits && outcome.face().is_some() {
            let decided = endless.run(launch, &mut ()).outcome;
            if decided.face().is_some() {
                outcome.ended = decided.ended;
                outcome.side_ending = decided.side_ending;
            }
        }
        toss
    }
}
