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
