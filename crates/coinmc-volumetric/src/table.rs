//! A table with an edge: tosses whose coin leaves it.
//!
//! The motion of a coin does not depend on where it is until it is beyond the edge. So a toss on a
//! table is followed as on an endless one, to rest, by the scalar path with an observer that watches
//! where the centre is; and where it was beyond the edge, the coin has left, whatever it would have
//! done there. A centre that is beyond the edge in flight lands beyond it: flights are straight seen
//! from above, and the table is convex.
//!
//! In contact the centre is looked at so often that it cannot pass the edge in between by more than
//! [`RESOLUTION`] of the coin's radius: no later than a coin as fast as its energy allows would need
//! to the edge.

use crate::finished_toss::FinishedToss;
use crate::impact::ImpactLaw;
use crate::model::Model;
use coinmc_core::{Ended, Event, EventKind, Launch, Observer, Scene, State};

/// Smallest way between two looks at the centre, in radii of the coin.
const RESOLUTION: f64 = 0.01;

/// A round table, above whose middle coins are launched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Table {
    radius_m: f64,
    /// Smallest way between two looks, m.
    resolution_m: f64,
    scene: Scene,
}

impl Table {
    /// The table of a scene; `None` if it is endless.
    pub(crate) fn new(scene: &Scene) -> Option<Self> {
        let radius_m = scene.surface.table_radius_m()?;
        Some(Self {
            radius_m,
            resolution_m: RESOLUTION * scene.coin.radius_m(),
            scene: *scene,
        })
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
struct EdgeWatch<'a, O> {
    table: &'a Table,
    observer: &'a mut O,
    /// When to look at the centre again, s since the launch.
    look_at_s: f64,
    /// The coin where it was first seen beyond the edge.
    left: Option<State>,
    last: Option<State>,
}

impl<O: Observer> EdgeWatch<'_, O> {
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

impl<O: Observer> Observer for EdgeWatch<'_, O> {
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

impl<L: ImpactLaw> Model<L> {
    /// Simulates one toss on a table.
    pub(crate) fn run_on<O: Observer>(
        &self,
        table: &Table,
        launch: &Launch,
        observer: &mut O,
    ) -> FinishedToss {
        let mut watch = EdgeWatch {
            table,
            observer,
            look_at_s: 0.0,
            left: None,
            last: None,
        };
        let mut toss = self.run(launch, &mut watch);
        let outcome = &mut toss.outcome;
        let goes_on = match outcome.ended {
            Ended::NeverSettles => true,
            Ended::Decided(_) => !self.adhesive && !self.rule.awaits_rest(),
            _ => false,
        };
        let coasts = goes_on && watch.last.is_some_and(|last| table.coasts_away(&last));
        if watch.left.is_some() || coasts {
            outcome.ended = Ended::Left;
            outcome.side_ending = None;
        }
        toss
    }
}
