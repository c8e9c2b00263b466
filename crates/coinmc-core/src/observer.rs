//! Observers: receive the events and states of a toss.

use crate::{Event, State};

/// Receives the events and states of a toss. `()` ignores them and compiles away.
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
    /// Whether the observer wants events; engines create none for an inactive observer.
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

    /// Whether the rest of the toss does not matter to the observer, and neither does its outcome: an
    /// engine may then end it at once, in any way.
    fn has_seen_enough(&self) -> bool {
        false
    }
}

/// Shows an observer the coin at every instant it asks for from `from_s` up to, but not including,
/// `until_s`. An engine calls this for each piece of a toss, in order. `state_at` gives the coin at
/// an instant, s since launch, of that piece.
///
/// An observer that asks for a past instant is shown nothing, and one that repeats its request is not
/// asked again, so that no observer can block a toss.
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
    // NaN is never reached
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

    fn has_seen_enough(&self) -> bool {
        (**self).has_seen_enough()
    }
}

/// Any active [`Observer`] behind a pointer: an engine that uses it is compiled once for all observers.
/// A dynamic call costs little beside an event.
///
/// # Example
/// ```
/// use coinmc_core::{Event, EventKind, Observer, DynObserver, State};
/// use nalgebra::Vector3;
/// struct Impacts(u32);
/// impl Observer for Impacts {
///     fn event(&mut self, event: &Event) {
///         self.0 += u32::from(event.kind == EventKind::Impact);
///     }
/// }
/// let state = State {
///     time_s: 0.1,
///     position_m: Vector3::zeros(),
///     velocity_m_s: Vector3::zeros(),
///     axis: Vector3::z_axis(),
///     spin_rad_s: Vector3::zeros(),
/// };
/// let mut impacts = Impacts(0);
/// let kind = EventKind::Impact;
/// DynObserver::new(&mut impacts).event(&Event { kind, state });
/// assert_eq!(impacts.0, 1);
/// ```
pub struct DynObserver<'a>(&'a mut dyn ErasedObserver);

/// The object-safe part of [`Observer`].
trait ErasedObserver {
    fn see_event(&mut self, event: &Event);
    fn instant_s(&self) -> f64;
    fn see_sample(&mut self, state: &State);
    fn is_done(&self) -> bool;
}

impl<O: Observer> ErasedObserver for O {
    fn see_event(&mut self, event: &Event) {
        self.event(event);
    }

    fn instant_s(&self) -> f64 {
        self.wants_at_s()
    }

    fn see_sample(&mut self, state: &State) {
        self.sample(state);
    }

    fn is_done(&self) -> bool {
        self.has_seen_enough()
    }
}

impl<'a> DynObserver<'a> {
    /// Forwards to `observer`.
    pub fn new<O: Observer>(observer: &'a mut O) -> Self {
        Self(observer)
    }
}

impl Observer for DynObserver<'_> {
    fn event(&mut self, event: &Event) {
        self.0.see_event(event);
    }

    fn wants_at_s(&self) -> f64 {
        self.0.instant_s()
    }

    fn sample(&mut self, state: &State) {
        self.0.see_sample(state);
    }

    fn has_seen_enough(&self) -> bool {
        self.0.is_done()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Fall, Notes, launches};
    use crate::{Engine, EventKind};
    use nalgebra::Vector3;

    fn at(time_s: f64) -> State {
        State {
            time_s,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            axis: Vector3::z_axis(),
            spin_rad_s: Vector3::zeros(),
        }
    }

    /// Asks for these instants, one after another, and notes what it is shown.
    struct Asks<'a>(&'a [f64], Vec<f64>);

    impl Observer for Asks<'_> {
        fn event(&mut self, _: &Event) {}

        fn wants_at_s(&self) -> f64 {
            self.0.get(self.1.len()).copied().unwrap_or(f64::INFINITY)
        }

        fn sample(&mut self, state: &State) {
            self.1.push(state.time_s);
        }
    }

    /// What is shown between 1 s and 2 s to an observer that asks for these instants.
    fn shown(instants: &[f64]) -> Vec<f64> {
        let mut asks = Asks(instants, Vec::new());
        sample_between(&mut asks, 1.0, 2.0, at);
        asks.1
    }

    #[test]
    fn a_piece_shows_its_start_and_what_follows_but_not_its_end() {
        assert_eq!(shown(&[1.0, 1.5, 1.99, 2.0]), [1.0, 1.5, 1.99]);
        assert_eq!(shown(&[1.5, 3.0]), [1.5]);
        assert!(shown(&[2.0]).is_empty() && shown(&[2.5]).is_empty());
    }

    #[test]
    fn no_request_blocks_a_toss() {
        assert!(shown(&[0.5, 1.5]).is_empty() && shown(&[f64::NAN, 1.5]).is_empty());
        assert_eq!(shown(&[1.5, 1.5, 1.75]), [1.5]);
        assert_eq!(shown(&[1.5, 1.25, 1.75]), [1.5]);
        assert_eq!(shown(&[1.5, f64::NAN, 1.75]), [1.5]);
    }

    #[test]
    fn an_inactive_observer_costs_no_state() {
        struct Inactive;
        impl Observer for Inactive {
            const ACTIVE: bool = false;
            fn event(&mut self, _: &Event) {}
            fn wants_at_s(&self) -> f64 {
                1.5
            }
        }
        sample_between(&mut Inactive, 1.0, 2.0, |_| unreachable!("nobody looks"));
    }

    #[test]
    fn an_observer_of_events_alone_asks_for_no_instant_and_sees_the_end() {
        struct Kinds(Vec<EventKind>);
        impl Observer for Kinds {
            fn event(&mut self, event: &Event) {
                self.0.push(event.kind);
            }
        }
        let mut kinds = Kinds(Vec::new());
        assert_eq!(kinds.wants_at_s(), f64::INFINITY);
        Fall.toss(&mut (), &launches(1)[0], &mut kinds);
        assert_eq!(kinds.0, [EventKind::Launched, EventKind::Ended]);
    }

    /// From 1 m a coin falls for 0.447 s.
    #[test]
    fn an_observer_sees_the_same_through_a_reference_and_a_pointer() {
        let launch = launches(1)[0];
        for (enough, events) in [(3, 1), (usize::MAX, 2)] {
            let [mut own, mut lent, mut erased] = [(); 3].map(|()| Notes::new(enough));
            let outcome = Fall.toss(&mut (), &launch, &mut own);
            assert_eq!((own.events.len(), own.samples.len()), (events, 5));
            assert_eq!(Fall.toss(&mut (), &launch, &mut &mut lent), outcome);
            let pointer = &mut DynObserver::new(&mut erased);
            assert_eq!(Fall.toss(&mut (), &launch, pointer), outcome);
            assert_eq!((&lent, &erased), (&own, &own));
        }
    }
}
