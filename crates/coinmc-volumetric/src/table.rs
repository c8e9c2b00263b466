//! Tables with an edge, which coins leave, and tilted tables.
//!
//! The motion of a coin does not depend on where it is until it is beyond the edge. So a toss on a
//! table is followed as on an endless one, to rest, by the scalar path with an observer that watches
//! where the centre is; and where it was beyond the edge, the coin has left, whatever it would have
//! done there. A coin that stays on a level table shows the face that is decided on an endless one:
//! what a decision rules out cannot happen afterwards, whatever small errors of long motion may do. A
//! centre that is beyond the edge of a level table in flight lands beyond it: seen from above flights are
//! straight, and the table is convex. Along the normal of a tilted table they are bent: there the edge
//! counts where a coin touches.
//!
//! In contact the centre is looked at so often that it cannot pass the edge in between by more than
//! [`RESOLUTION`] of the coin's radius: no later than a coin as fast as its energy allows would need
//! to the edge. In flight, and without friction on a plane, it goes straight on, no faster than it is.
//!
//! On a tilted table (see `pull`) the motion depends on the direction in the laboratory, which only
//! tosses with an observer know, and no energy decides for good. So they are followed in the same way.

use crate::finished_toss::FinishedToss;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::settings::{Settings, SettingsError};
use crate::toss::Toss;
use coinmc_core::{
    Ended, Event, EventKind, Face, Launch, Observer, OntoSide, Scene, SideEnding, State, TableTilt,
};
use nalgebra::Vector2;

/// Smallest way between two looks at the centre, in radii of the coin.
const RESOLUTION: f64 = 0.01;

/// A coin that rolls no faster than this, in sqrt(g D), does not roll but for the errors of its motion.
const LEAST_ROLLING: f64 = 1e-6;

/// A round or endless table, above whose middle coins are launched.
#[derive(Debug, Clone)]
pub(crate) struct Table<L> {
    /// What follows tosses to rest.
    model: Model<L>,
    /// Infinite if the table is endless.
    radius_m: f64,
    tilt: Option<TableTilt>,
    /// Smallest way between two looks, m.
    resolution_m: f64,
    scene: Scene,
}

impl<L: ImpactLaw> Table<L> {
    /// The table of a scene; `None` if it is endless and level.
    pub(crate) fn new(
        scene: &Scene,
        settings: &Settings,
        law: L,
    ) -> Result<Option<Self>, SettingsError> {
        let (radius_m, tilt) = (scene.surface.table_radius_m(), scene.surface.tilt());
        if radius_m.is_none() && tilt.is_none() {
            return Ok(None);
        }
        Ok(Some(Self {
            model: Model::new(scene, settings, law)?,
            radius_m: radius_m.unwrap_or(f64::INFINITY),
            tilt,
            resolution_m: RESOLUTION * scene.coin.radius_m(),
            scene: *scene,
        }))
    }

    /// Whether a coin that slides or rolls on for ever, slowed down by drag alone if at all, or that rolls down a
    /// slope, does so beyond the edge.
    ///
    /// Without friction nothing changes the horizontal velocity of the launch, above the middle of the table: the
    /// errors of a long motion do not move a coin. With friction it rolls, across its axis; what it creeps along it
    /// is an error, too, which friction would stop.
    fn coasts_away(&self, launch: &Launch, state: &State) -> bool {
        if self.tilt.is_some() {
            return self.radius_m < f64::INFINITY;
        }
        let (from, velocity) = if self.scene.surface.friction() == 0.0 {
            (Vector2::zeros(), launch.velocity_m_s.xy())
        } else {
            let along = state.axis.xy().try_normalize(0.0);
            let along = along.unwrap_or_else(Vector2::zeros);
            let velocity = state.velocity_m_s.xy();
            let rolling = velocity - along * along.dot(&velocity);
            let rolls = rolling.norm() > LEAST_ROLLING * self.model.units.speed_m_s();
            let rolling = if rolls { rolling } else { Vector2::zeros() };
            (state.position_m.xy(), rolling)
        };
        let drag = self.scene.drag().linear_per_s();
        velocity.norm() > 0.0 && (drag == 0.0 || (from + velocity / drag).norm() > self.radius_m)
    }
}

impl<L> Table<L> {
    /// A speed that a coin in this state does not exceed as long as it is on the table.
    fn fastest_m_s(&self, state: &State) -> f64 {
        let mut energy = state.energy_j_kg(&self.scene);
        if let Some(tilt) = &self.tilt {
            // as if it were to go down to the lowest place of the edge
            let descent = tilt.slope() * tilt.cos() * self.radius_m;
            energy += self.scene.gravity_m_s2() * descent;
        }
        (2.0 * energy.max(0.0)).sqrt()
    }

    /// How long a coin in this state need not be looked at, s.
    fn safe_for_s(&self, state: &State, flies: bool) -> f64 {
        if self.tilt.is_some() && flies {
            // the edge counts where it lands
            return f64::INFINITY;
        }
        let surface = &self.scene.surface;
        let fastest = self.fastest_m_s(state);
        let keeps_velocity = surface.friction() == 0.0 && surface.roughness().is_none();
        if self.tilt.is_none() && (flies || keeps_velocity) {
            // straight on, and no faster
            let (at, velocity) = (state.position_m.xy(), state.velocity_m_s.xy());
            let (square, towards) = (velocity.norm_squared(), at.dot(&velocity));
            let room = self.radius_m * self.radius_m - at.norm_squared();
            let root = (towards * towards + square * room.max(0.0)).sqrt();
            let reaches = if square > 0.0 {
                (root - towards) / square
            } else {
                f64::INFINITY
            };
            return reaches.max(self.resolution_m / fastest);
        }
        let inside_m = self.radius_m - state.position_m.xy().norm();
        inside_m.max(self.resolution_m) / fastest
    }

    /// How a coin ends on its side that rolls down the table.
    fn rolls_for_ever(&self) -> SideEnding {
        let onto_side = OntoSide {
            rolls_m: f64::INFINITY,
            turns: 0.0,
            turning_prevails: false,
        };
        SideEnding::new(&onto_side, self.scene.coin.radius_m())
    }

    /// A toss at its launch, in axes of the table.
    fn launch(&self, launch: &Launch) -> (Launch, Toss) {
        let Some(tilt) = &self.tilt else {
            return (*launch, self.model.launch(launch));
        };
        let (launch, centre_m) = tilt.launch_in_table_axes(launch);
        let mut toss = self.model.launch(&launch);
        let centre = centre_m.map(|x| x / self.model.units.length_m);
        toss.place = toss.place.with_centre_at(centre);
        (launch, toss)
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
    /// Whether the coin flies from the last event on, unless another one happens at the same time.
    flies: bool,
}

impl<L, O: Observer> EdgeWatch<'_, L, O> {
    /// Looks at the coin, which touches the table or does not.
    fn look(&mut self, state: &State, touches: bool) {
        let is_beyond = state.position_m.xy().norm() > self.table.radius_m;
        let counts = touches || self.table.tilt.is_none();
        if self.left.is_none() && is_beyond && counts {
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
            self.look_at_s = state.time_s + self.table.safe_for_s(state, self.flies);
        }
    }
}

impl<L, O: Observer> Observer for EdgeWatch<'_, L, O> {
    fn event(&mut self, event: &Event) {
        let begins_flight = [EventKind::Launched, EventKind::Impact, EventKind::LiftOff];
        self.flies = begins_flight.contains(&event.kind);
        self.look(&event.state, event.kind != EventKind::Launched);
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
            self.look(state, !self.flies);
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
            flies: true,
        };
        let (on_table, begun) = self.launch(launch);
        let mut toss = self.model.run_from(begun, &on_table, &mut watch);
        let waits = self.model.rule.awaits_rest();
        let outcome = &mut toss.outcome;
        let goes_on = match outcome.ended {
            Ended::NeverSettles => true,
            Ended::Decided(_) => !self.model.adhesive && !waits,
            _ => false,
        };
        let coasts = goes_on
            && watch
                .last
                .is_some_and(|last| self.coasts_away(launch, &last));
        if watch.left.is_some() || coasts {
            outcome.ended = Ended::Left;
            outcome.side_ending = None;
        } else if self.tilt.is_some() {
            // a coin that rolls down for ever on its side is on its side
            if outcome.ended == Ended::NeverSettles && self.model.rule.is_tilting() {
                outcome.ended = Ended::Decided(Face::Side);
                outcome.side_ending = Some(self.rolls_for_ever());
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Moreau;
    use coinmc_core::{Coin, Surface};
    use coinmc_testkit::Sampler;
    use nalgebra::{UnitVector3, Vector3};

    /// A coin at rest in the middle that slides down without friction has the speed sqrt(2 g r sin β) at the edge.
    #[test]
    fn no_coin_is_faster_than_the_fastest() {
        let (radius_m, gravity) = (0.3, 9.81);
        let tilt = TableTilt::new(6.0, 90.0).expect("a valid tilt");
        let surface = Surface::new(0.5, 0.3)
            .and_then(|surface| surface.with_tilt(tilt))
            .and_then(|surface| surface.with_table_radius(radius_m))
            .expect("a valid surface");
        let coin = Coin::cylinder(0.2, 0.01).expect("a valid coin");
        let scene = Scene::new(coin, surface, gravity).expect("valid gravity");
        let table = Table::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        let at_rest = State {
            time_s: 0.0,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_unchecked(Vector3::z()),
            spin_rad_s: Vector3::zeros(),
        };
        let slides = (2.0 * gravity * radius_m * libm::sin(6.0_f64.to_radians())).sqrt();
        let fastest = table.expect("an edge").fastest_m_s(&at_rest);
        assert!(fastest >= slides * (1.0 - 1e-12), "{fastest} {slides}");
    }

    fn state(time_s: f64, position_m: [f64; 3]) -> State {
        State {
            time_s,
            position_m: position_m.into(),
            velocity_m_s: Vector3::new(0.3, -0.4, 0.2),
            axis: UnitVector3::new_normalize(Vector3::new(1.0, 2.0, 2.0)),
            spin_rad_s: Vector3::new(20.0, -5.0, 12.0),
        }
    }

    fn table(angle_deg: f64) -> Table<Moreau> {
        let tilt = TableTilt::new(angle_deg, 0.0).expect("a valid tilt");
        let surface = Surface::new(0.5, 0.3)
            .and_then(|surface| surface.with_tilt(tilt))
            .and_then(|surface| surface.with_table_radius(0.3))
            .expect("a valid surface");
        let coin = Coin::cylinder(0.6, 0.01).expect("a valid coin");
        let scene = Scene::new(coin, surface, 9.81).expect("valid gravity");
        let table = Table::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        table.expect("an edge")
    }

    /// The fastest is the speed of a coin with all of its energy in motion, at the lowest place of the edge: energies of
    /// its velocity, of its spin as a uniform cylinder, of its height, and of the way down from where it is.
    #[test]
    fn the_fastest_has_all_of_its_energy_in_motion() {
        for degrees in [0.0_f64, 7.0] {
            let state = state(0.0, [0.1, -0.05, 0.03]);
            let (radius, height): (f64, f64) = (0.01, 0.006);
            let axis = Vector3::new(1.0, 2.0, 2.0) / 3.0;
            let axial = axis.dot(&state.spin_rad_s);
            let across = state.spin_rad_s - axis * axial;
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let square = state.velocity_m_s.norm_squared()
                + 0.5 * radius.powi(2) * axial * axial
                + (radius.powi(2) / 4.0 + height.powi(2) / 12.0) * across.norm_squared()
                + 2.0 * 9.81 * (0.03 * cos + (0.3 - 0.1) * sin);
            let found = table(degrees).fastest_m_s(&state);
            assert!((found / square.sqrt() - 1.0).abs() < 1e-12, "{found}");
        }
    }

    /// An observer sees what it asks for and what happens on the table. The watch looks by itself when the fastest coin
    /// could be beyond the edge; once the coin is, that is the end, and all that is seen of it.
    #[test]
    fn an_observer_sees_what_it_asks_for_until_the_coin_has_left() {
        let table = table(0.0);
        let mut sampler = Sampler::new(2.0);
        let mut watch = EdgeWatch {
            table: &table,
            observer: &mut sampler,
            look_at_s: 0.0,
            left: None,
            last: None,
            flies: false,
        };
        let event = |time_s, x| Event {
            kind: EventKind::Sliding,
            state: state(time_s, [x, 0.0, 0.0]),
        };
        watch.event(&event(0.0, -0.1));
        let look = 0.2 / table.fastest_m_s(&state(0.0, [0.0; 3]));
        assert_eq!(watch.wants_at_s(), 0.0);
        watch.sample(&state(0.0, [-0.1, 0.0, 0.0]));
        assert!((watch.wants_at_s() / look.min(0.5) - 1.0).abs() < 1e-12);
        // not asked for by the observer, whose sampler would complain
        watch.sample(&state(look, [0.1, 0.0, 0.0]));
        watch.sample(&state(0.49, [0.1, 0.0, 0.0]));
        assert!(watch.left.is_none() && !watch.has_seen_enough());
        watch.sample(&state(0.5, [0.1, 0.0, 0.0]));
        watch.event(&event(0.6, 0.29));
        watch.event(&event(0.7, 0.31));
        assert!(watch.has_seen_enough() && watch.wants_at_s() == f64::INFINITY);
        watch.event(&event(0.8, 0.0));
        watch.sample(&state(1.0, [0.0; 3]));
        assert!(watch.left.is_some_and(|left| left.time_s == 0.7));
        let kinds: Vec<_> = sampler.events.iter().map(|event| event.kind).collect();
        assert_eq!(
            kinds,
            [EventKind::Sliding, EventKind::Sliding, EventKind::Ended]
        );
        let seen: Vec<_> = sampler
            .samples
            .iter()
            .map(|seen| seen.state.time_s)
            .collect();
        assert_eq!(seen, [0.0, 0.5]);
    }

    /// In flight above a level table, and without friction, a coin is looked at again when it is above the edge, straight ahead;
    /// above a tilted one where it lands; in contact no later than a coin as fast as its energy allows could be there.
    #[test]
    fn a_coin_is_looked_at_again_before_it_may_be_beyond_the_edge() {
        let at = state(0.0, [0.1, -0.05, 0.03]);
        let (place, velocity) = (at.position_m.xy(), at.velocity_m_s.xy());
        let level = table(0.0);
        let ahead = place + velocity * level.safe_for_s(&at, true);
        assert!((ahead.norm() - 0.3).abs() < 1e-12, "{ahead}");
        assert!(level.safe_for_s(&at, false) < level.safe_for_s(&at, true));
        assert_eq!(table(7.0).safe_for_s(&at, true), f64::INFINITY);
        assert!(table(7.0).safe_for_s(&at, false) < 1.0);
        let (smooth, rest) = round(0.3, None, 0.0);
        let ahead = place + velocity * smooth.safe_for_s(&at, false);
        assert!((ahead.norm() - 0.3).abs() < 1e-12, "{ahead}");
        assert_eq!(smooth.safe_for_s(&rest, false), f64::INFINITY);
        // beside the edge it is looked at after a short way
        let beside = state(0.0, [0.3, 0.0, 0.03]);
        let resolution = level.resolution_m / level.fastest_m_s(&beside);
        assert!(level.safe_for_s(&beside, true) >= resolution);
    }

    /// A toss begins straight above the middle of the table, which is downhill of it in axes of the table.
    #[test]
    fn a_launch_above_a_tilted_table_begins_where_it_is() {
        let table = table(7.0);
        let launch = Launch {
            height_m: 0.25,
            velocity_m_s: Vector3::new(0.3, -0.4, 0.2),
            axis: UnitVector3::new_normalize(Vector3::new(1.0, 2.0, 2.0)),
            spin_rad_s: Vector3::new(20.0, -5.0, 12.0),
        };
        let (_, toss) = table.launch(&launch);
        let begun = toss.state(&table.model.units);
        let (sin, cos) = libm::sincos(7.0_f64.to_radians());
        // downhill is along x, and the vertical leans uphill of the table's normal
        let up = Vector3::new(-sin, 0.0, cos);
        assert!((begun.position_m - up * 0.25).norm() < 1e-15, "{begun:?}");
        let level = begun.velocity_m_s.dot(&up) - 0.2;
        assert!(level.abs() < 1e-15, "{level}");
    }

    /// A table of this radius, and a coin at rest on it.
    fn round(radius_m: f64, tilt: Option<TableTilt>, drag: f64) -> (Table<Moreau>, State) {
        // on a tilted table friction must hold a coin
        let mu = if tilt.is_some() { 0.3 } else { 0.0 };
        let mut surface = Surface::new(0.5, mu)
            .and_then(|surface| surface.with_table_radius(radius_m))
            .expect("a valid surface");
        if let Some(tilt) = tilt {
            surface = surface.with_tilt(tilt).expect("a valid surface");
        }
        let coin = Coin::cylinder(0.2, 0.01).expect("a valid coin");
        let drag = coinmc_core::Drag::new(drag, drag).expect("a valid drag");
        let scene = Scene::new(coin, surface, 9.81).expect("valid gravity");
        let scene = scene.with_drag(drag);
        let at_rest = State {
            time_s: 0.0,
            position_m: Vector3::new(0.1, -0.2, 0.01),
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_unchecked(Vector3::z()),
            spin_rad_s: Vector3::zeros(),
        };
        let table = Table::new(&scene, &Settings::default(), Moreau).expect("valid settings");
        (table.expect("an edge"), at_rest)
    }

    fn launched(velocity: [f64; 2]) -> Launch {
        Launch {
            height_m: 0.1,
            velocity_m_s: Vector3::new(velocity[0], velocity[1], 2.0),
            axis: UnitVector3::new_unchecked(Vector3::z()),
            spin_rad_s: Vector3::zeros(),
        }
    }

    /// A coin that slides without friction leaves a table with an edge, unless air stops it on the way, v/k, before it is
    /// there; one that is let go at rest stays, whatever the errors of its motion have made of that.
    #[test]
    fn a_coin_without_friction_coasts_over_the_edge() {
        for (drag, velocity, away) in [
            (0.0, [0.0, 0.0], false),
            (0.0, [1e-3, 0.0], true),
            // .791 m, .703 m
            (0.4, [0.3, -0.1], true),
            (0.45, [0.3, -0.1], false),
        ] {
            let (table, mut state) = round(0.75, None, drag);
            for error in [0.0, 6e-5] {
                state.velocity_m_s = Vector3::new(velocity[0] + error, velocity[1], 0.0);
                let found = table.coasts_away(&launched(velocity), &state);
                assert_eq!(found, away, "{drag} {velocity:?}");
            }
        }
        let tilt = TableTilt::new(3.0, 90.0).expect("a valid tilt");
        let (sloped, state) = round(0.75, Some(tilt), 0.5);
        assert!(sloped.coasts_away(&launched([0.0; 2]), &state));
    }

    /// With friction a coin on its side rolls across its axis; along it, it can only creep by error.
    #[test]
    fn a_coin_with_friction_rolls_over_the_edge_across_its_axis() {
        let (mut table, mut state) = round(0.75, None, 0.0);
        let surface = Surface::new(0.5, 0.3).and_then(|surface| surface.with_table_radius(0.75));
        table.scene.surface = surface.expect("a valid surface");
        state.axis = UnitVector3::new_normalize(Vector3::new(0.6, 0.8, 1e-3));
        for (velocity, away) in [
            ([0.0, 0.0], false),
            ([0.6 * 2e-3, 0.8 * 2e-3], false),
            ([-0.8 * 2e-3, 0.6 * 2e-3], true),
            ([-0.8 * 1e-10, 0.6 * 1e-10], false),
        ] {
            state.velocity_m_s = Vector3::new(velocity[0], velocity[1], 0.0);
            let found = table.coasts_away(&launched([0.1, 0.2]), &state);
            assert_eq!(found, away, "{velocity:?}");
        }
    }
}
