//! Attempts at a step of eight sliding phases at once.

use super::equations::{Arrival, Sliding};
use super::{Made, SlideEnd, SlidePhase};
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use coinmc_lanes::{Bits, Block, Lanes, WIDTH, Wide, Work};

/// What eight phases ask for, and what came of it.
#[derive(Default)]
struct Attempts {
    friction: Block,
    h: Block,
    start: Arrivals,
    end: Arrivals,
    error: Block,
    begins: Bits,
    /// A step can be made; its end is sound as well.
    possible: Bits,
    sound: Bits,
}

/// Beginnings or ends of steps; their states at the beginning are known.
#[derive(Default)]
struct Arrivals {
    state: [Block; 4],
    rates: [Block; 4],
    sin: Block,
    cos: Block,
}

/// A phase, with the motion of its coin.
type Slides<'a> = (&'a mut SlidePhase, &'a mut Motion);

/// One attempt of each phase, or one trial of its search for an event; of those that are over, how.
pub(crate) fn slide_on(
    lanes: Lanes,
    phases: &mut [Option<Slides<'_>>; WIDTH],
    adapter: &mut ObserverAdapter<'_, ()>,
) -> [Option<SlideEnd>; WIDTH] {
    let mut attempts = Attempts::default();
    let mut k = 1.0;
    for lane in 0..WIDTH {
        // where none is, a lane does the same as the first, for nothing
        if let Some((phase, _)) = phases[lane].as_ref().or(phases[0].as_ref()) {
            attempts.ask(lane, phase);
            k = phase.sliding.k;
        }
    }
    lanes.enter(Attempt {
        attempts: &mut attempts,
        k,
    });
    let mut ends = [None; WIDTH];
    for (lane, slides) in phases.iter_mut().enumerate() {
        if let Some((phase, motion)) = slides {
            ends[lane] = attempts.answer(lane, phase, motion, adapter);
        }
    }
    ends
}

impl Attempts {
    fn ask(&mut self, lane: usize, phase: &SlidePhase) {
        self.friction[lane] = phase.sliding.friction;
        self.h[lane] = phase.length();
        for (block, number) in self.start.state.iter_mut().zip(phase.y) {
            block[lane] = number;
        }
    }

    fn answer(
        &self,
        lane: usize,
        phase: &mut SlidePhase,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, ()>,
    ) -> Option<SlideEnd> {
        let has = |bits: Bits| bits & (1 << lane) != 0;
        let end = self.end.of(lane);
        if phase.search.is_some() {
            let to = has(self.possible).then_some((end.state, end.angle));
            return phase.tried(to, motion, adapter);
        }
        let made = Made {
            start: self.start.of(lane),
            begins: has(self.begins),
            end,
            error: self.error[lane],
            possible: has(self.possible & self.sound),
        };
        phase.made(made, motion, adapter)
    }
}

impl Arrivals {
    fn of(&self, lane: usize) -> Arrival {
        let gather = |blocks: &[Block; 4]| blocks.map(|block| block[lane]);
        Arrival {
            state: gather(&self.state),
            rates: gather(&self.rates),
            angle: (self.sin[lane], self.cos[lane]),
        }
    }

    #[inline(always)]
    fn set<L: Wide>(&mut self, at: &Arrival<L>) {
        for i in 0..4 {
            self.state[i] = at.state[i].store();
            self.rates[i] = at.rates[i].store();
        }
        (self.sin, self.cos) = (at.angle.0.store(), at.angle.1.store());
    }
}

struct Attempt<'a> {
    attempts: &'a mut Attempts,
    k: f64,
}

impl Work for Attempt<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let made = self.attempts;
        let sliding = Sliding {
            k: self.k,
            friction: L::load(&made.friction),
        };
        let mut state = [L::splat(0.0); 4];
        for (component, block) in state.iter_mut().zip(&made.start.state) {
            *component = L::load(block);
        }
        let (start, begins) = sliding.at(&state);
        let step = sliding.whole_step(&start, L::load(&made.h));
        made.begins = L::bits(begins);
        made.start.set(&start);
        made.end.set(&step.end);
        made.error = step.error.store();
        made.possible = L::bits(step.possible);
        made.sound = L::bits(step.sound);
    }
}
