//! An engine that is chosen at run time.

use crate::{DynObserver, Engine, Launch, LaunchSource, Observer, Outcome, OutcomeSink};
use coinmc_lanes::{Lanes, NoSuchLanes};
use std::fmt::Debug;
use std::sync::Arc;

/// Any [`Engine`] behind a pointer: code that uses it is compiled once for all engines, and each
/// engine once, in the crate that creates the `DynEngine`.
///
/// A batch of tosses costs one call through the pointer; a single toss costs one, and one more for
/// each of its events.
///
/// # Example
/// ```
/// use coinmc_core::{DynEngine, Engine, Face, Launch, Observer, Outcome};
/// # use coinmc_core::{Coin, Domain, Preset, Stream};
///
/// /// Ends with the face that is up at launch.
/// #[derive(Debug, Clone)]
/// struct Still;
///
/// impl Engine for Still {
///     type Workspace = ();
///     fn workspace(&self) {}
///     fn toss(&self, (): &mut (), launch: &Launch, _: &mut impl Observer) -> Outcome {
///         let shows_heads = launch.axis.z > 0.0;
///         Outcome::decided(if shows_heads { Face::Heads } else { Face::Tails })
///     }
/// }
///
/// let engine = DynEngine::new(Still);
/// # let (coin, stream) = (Coin::cylinder(1.0, 0.01)?, Stream::new(1, Domain::Launch, 0));
/// # let launch = Preset::Clean.distribution().launch(&coin, &mut stream.toss(0));
/// assert_eq!(engine.toss(&mut (), &launch, &mut ()), Still.toss(&mut (), &launch, &mut ()));
/// # Ok::<(), coinmc_core::CoinError>(())
/// ```
#[derive(Debug, Clone)]
pub struct DynEngine(Arc<dyn ErasedEngine>);

/// The methods of an [`Engine`] without generics, so that they can be called through a pointer.
trait ErasedEngine: Debug + Send + Sync {
    fn erased_lanes(&self) -> Lanes;
    fn erased_with_lanes(&self, lanes: Lanes) -> Result<DynEngine, NoSuchLanes>;
    fn toss_unobserved(&self, launch: &Launch) -> Outcome;
    fn toss_observed(&self, launch: &Launch, observer: &mut DynObserver) -> Outcome;
    fn toss_erased(&self, launches: LaunchSource<'_>, sink: &mut OutcomeSink<'_>);
}

impl<E: Engine + Debug + Clone + Send + 'static> ErasedEngine for E {
    fn erased_lanes(&self) -> Lanes {
        self.lanes()
    }

    fn erased_with_lanes(&self, lanes: Lanes) -> Result<DynEngine, NoSuchLanes> {
        self.clone().with_lanes(lanes).map(DynEngine::new)
    }

    fn toss_unobserved(&self, launch: &Launch) -> Outcome {
        self.toss(&mut self.workspace(), launch, &mut ())
    }

    fn toss_observed(&self, launch: &Launch, observer: &mut DynObserver) -> Outcome {
        self.toss(&mut self.workspace(), launch, observer)
    }

    fn toss_erased(&self, launches: LaunchSource<'_>, sink: &mut OutcomeSink<'_>) {
        self.toss_many(&mut self.workspace(), launches, sink);
    }
}

impl DynEngine {
    /// Erases the type of an engine.
    pub fn new(engine: impl Engine + Debug + Clone + Send + 'static) -> Self {
        Self(Arc::new(engine))
    }

    fn toss_for<O: Observer>(&self, launch: &Launch, observer: &mut O) -> Outcome {
        if O::ACTIVE {
            self.0
                .toss_observed(launch, &mut DynObserver::new(observer))
        } else {
            self.0.toss_unobserved(launch)
        }
    }
}

/// Every call creates its own workspace.
impl Engine for DynEngine {
    type Workspace = ();

    fn workspace(&self) {}

    fn lanes(&self) -> Lanes {
        self.0.erased_lanes()
    }

    fn with_lanes(self, lanes: Lanes) -> Result<Self, NoSuchLanes> {
        self.0.erased_with_lanes(lanes)
    }

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        self.toss_for(launch, observer)
    }

    fn toss_many(&self, (): &mut (), launches: LaunchSource<'_>, sink: &mut OutcomeSink<'_>) {
        self.0.toss_erased(launches, sink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Fall, Notes, launches, outcomes_alone};
    use std::ops::ControlFlow;

    #[test]
    fn many_tosses_behind_the_pointer_are_those_of_the_engine() {
        let launches = launches(100);
        let mut outcomes = Vec::new();
        let mut own = launches.iter().copied();
        let source = LaunchSource::new(&mut own);
        DynEngine::new(Fall).toss_many(&mut (), source, &mut |some| {
            outcomes.extend_from_slice(some);
            ControlFlow::Continue(())
        });
        assert_eq!(outcomes, outcomes_alone(&launches));
    }

    #[test]
    fn an_observer_sees_the_same_through_the_pointer() {
        let launch = launches(1)[0];
        for enough in [3, usize::MAX] {
            let (mut near, mut far) = (Notes::new(enough), Notes::new(enough));
            let outcome = Fall.toss(&mut (), &launch, &mut near);
            let erased = DynEngine::new(Fall).toss(&mut (), &launch, &mut far);
            assert_eq!((erased, far), (outcome, near));
        }
    }
}
