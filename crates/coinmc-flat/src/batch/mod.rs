//! Many tosses side by side: the same toss as [`engine`](crate::engine)'s, eight at a time.
//!
//! ```text
//! launches ─▶ on search ─▶ touching ─▶ struck ─▶ on search
//!               │    ▲                   │
//!               ▼    │                   ▼ plastic, rocking out: alone
//!            high above: skipped       sliding, eight at a time ─▶ struck, on search
//! ```
//!
//! A toss keeps its lane from launch to end. Each step of the search is made for all lanes of a group
//! that are on search; what has found its contact, or is high above the surface, waits until enough
//! others of its group have come as far, and is struck, or brought down, with them. A lane whose toss
//! ends is given to the next launch. Contact that slides is integrated for eight tosses of any groups
//! at a time. All else of contact (an impact that is the last of a sequence, a coin about to rock
//! out or pivoting, where one mode leads to another) is done alone by the code of the single toss.
//!
//! Laws of impact that are more than an impulse, and tosses that are to be decided by a share of
//! their energy, are followed one after the other: so is everything where lanes are
//! [`Scalar`](Lanes::Scalar).
//!
//! No lane sees another and every operation is IEEE 754's, so a toss has the same outcome to the
//! last bit beside whatever others, and with any instruction set.

mod group;

use crate::contact::{Contact, Slider};
use crate::engine::{Early, FlatEngine, Onward, Toss, certain};
use crate::impact_law::ImpactLaw;
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use crate::settings::Decision;
use crate::slide::slide_on;
use coinmc_core::{Breaks, Ended, Landing, Launch, Outcome, TossBatch};
use coinmc_lanes::{Bits, Lanes, WIDTH, lanes_of};
use group::Group;

/// Groups of eight: while one waits for its last result, the processor works on the others. From 4
/// to 16 the speed is the same.
const GROUPS: usize = 8;
/// So many of a group are struck together, and brought down together, unless none of it is left on
/// search: an impact costs more than a step of the search, which goes on without those that wait,
/// and a jump less. One more or less changes little.
const STRUCK: u32 = 5;
const SKIPPED: u32 = 3;

/// A toss, but for its motion.
#[derive(Debug, Clone, Copy, Default)]
struct Rider {
    /// Its number among the launches.
    number: u64,
    impacts: u32,
    steps: u32,
    jams: u32,
}

impl Rider {
    fn toss<'a, L: ImpactLaw>(&self, engine: &'a FlatEngine<L>, motion: Motion) -> Toss<'a> {
        Toss {
            motion,
            contact: Contact {
                steps: self.steps,
                jams: self.jams,
                ..engine.contact()
            },
            impacts: self.impacts,
            breaks: Breaks::default(),
        }
    }
}

/// A toss in sliding contact, whose lane waits for it.
struct Sliding {
    at: usize,
    lane: usize,
    motion: Motion,
    slider: Slider,
}

/// Nobody watches.
fn adapter<'a, L>(engine: &'a FlatEngine<L>, observer: &'a mut ()) -> ObserverAdapter<'a, ()> {
    ObserverAdapter {
        observer,
        units: &engine.units,
        shape: &engine.shape,
    }
}

pub(crate) struct Batch<'a, L> {
    engine: &'a FlatEngine<L>,
    groups: Vec<Group>,
    riders: Vec<[Rider; WIDTH]>,
    sliding: Vec<Sliding>,
    /// Lanes without a toss.
    vacant: Vec<(usize, usize)>,
    launched: u64,
    /// Tosses that have ended and are yet to be told, by number.
    ended: Vec<(u64, Outcome)>,
}

impl<'a, L: ImpactLaw> Batch<'a, L> {
    /// `None` for an engine whose tosses are followed one after the other.
    pub(crate) fn of(engine: &'a FlatEngine<L>) -> Option<Self> {
        let alone = !L::BATCHED
            || engine.lanes == Lanes::Scalar
            || engine.settings.decision != Decision::Energy;
        (!alone).then(|| Self::new(engine))
    }

    fn new(engine: &'a FlatEngine<L>) -> Self {
        let lanes = (0..GROUPS).flat_map(|group| (0..WIDTH).map(move |lane| (group, lane)));
        Self {
            engine,
            groups: vec![Group::default(); GROUPS],
            riders: vec![[Rider::default(); WIDTH]; GROUPS],
            sliding: Vec::with_capacity(GROUPS * WIDTH),
            vacant: lanes.rev().collect(),
            launched: 0,
            ended: Vec::with_capacity(2 * GROUPS * WIDTH),
        }
    }
}

impl<L: ImpactLaw> TossBatch for Batch<'_, L> {
    type End = Outcome;

    fn has_room(&self) -> bool {
        !self.vacant.is_empty() && self.ended.len() < GROUPS * WIDTH
    }

    /// Gives a vacant lane to a launch that is followed at all.
    fn launch(&mut self, launch: &Launch) {
        let (engine, number) = (self.engine, self.launched);
        self.launched += 1;
        let toss = engine.launched(launch);
        if let Some(ended) = engine.ends_at_launch(&toss, launch) {
            self.ended.push((number, toss.outcome(ended)));
            return;
        }
        let Some((at, lane)) = self.vacant.pop() else {
            // never: whoever launches sees to the room first
            return;
        };
        self.riders[at][lane] = Rider {
            number,
            ..Rider::default()
        };
        self.groups[at].put(lane, &toss.motion, &engine.shape, false);
    }

    /// One piece of work: `false` if nothing is left to do.
    fn advance(&mut self) -> bool {
        let flying = self.groups.iter().any(Group::is_at_work);
        if self.sliding.len() >= WIDTH || !flying && !self.sliding.is_empty() {
            self.slide();
        } else if flying {
            Group::sweep(&mut self.groups, self.engine.lanes, &self.engine.shape);
            for group in 0..GROUPS {
                self.attend(group);
            }
        } else {
            return false;
        }
        true
    }

    fn ended(&mut self) -> &mut Vec<(u64, Outcome)> {
        &mut self.ended
    }
}

impl<L: ImpactLaw> Batch<'_, L> {
    /// What a step of the search has led to.
    fn attend(&mut self, at: usize) {
        let engine = self.engine;
        let group = &mut self.groups[at];
        let lost = std::mem::take(&mut group.lost);
        let idle = group.searching == 0;
        let due =
            |waiting: Bits, enough: u32| waiting != 0 && (idle || waiting.count_ones() >= enough);
        if due(group.high, SKIPPED) {
            group.skip(engine.lanes, &engine.shape);
        }
        if due(group.touched, STRUCK) {
            self.bounce(at);
        }
        for lane in lanes_of(lost) {
            let ended = engine.lost(&self.groups[at].motion(lane));
            self.end(at, lane, ended);
        }
    }

    /// Throws the coins of a group that touch back.
    fn bounce(&mut self, at: usize) {
        let engine = self.engine;
        let group = &mut self.groups[at];
        let touched = group.touched;
        if engine.landing == Landing::Adhesive {
            group.land(engine.lanes);
            for lane in lanes_of(touched) {
                let ended = certain(&self.groups[at].motion(lane));
                self.end(at, lane, ended);
            }
            return;
        }
        group.strike(engine);
        let (alone, decided) = (group.alone, group.certain);
        for lane in lanes_of(touched & !alone) {
            let rider = &mut self.riders[at][lane];
            if rider.impacts == engine.settings.max_impacts {
                self.groups[at].ground(lane);
                self.end(at, lane, Ended::ImpactLimit);
                continue;
            }
            rider.impacts += 1;
            if decided & (1 << lane) != 0 {
                let ended = certain(&self.groups[at].motion(lane));
                self.end(at, lane, ended);
            }
        }
        for lane in lanes_of(alone) {
            self.bounce_alone(at, lane);
        }
    }

    /// Impacts and sustained contact of one toss, until it slides, flies again or ends.
    fn bounce_alone(&mut self, at: usize, lane: usize) {
        let engine = self.engine;
        let rider = self.riders[at][lane];
        let mut toss = rider.toss(engine, self.groups[at].motion(lane));
        let onward = engine.touch(
            &mut toss,
            &mut Early::never(),
            &mut adapter(engine, &mut ()),
        );
        self.go(at, lane, &toss, onward);
    }

    /// Brings a toss to its next stage.
    fn go(&mut self, at: usize, lane: usize, toss: &Toss, onward: Onward) {
        let rider = &mut self.riders[at][lane];
        rider.impacts = toss.impacts;
        (rider.steps, rider.jams) = (toss.contact.steps, toss.contact.jams);
        match onward {
            Onward::Fly => self.groups[at].put(lane, &toss.motion, &self.engine.shape, true),
            Onward::End(ended) => self.end(at, lane, ended),
            Onward::Slide(hold) => self.sliding.push(Sliding {
                at,
                lane,
                motion: toss.motion,
                slider: toss.contact.slider(&toss.motion, hold),
            }),
        }
    }

    /// One attempt at a step of the last tosses that slide.
    fn slide(&mut self) {
        let engine = self.engine;
        let from = self.sliding.len().saturating_sub(WIDTH);
        let mut sliding = self.sliding[from..].iter_mut();
        let mut phases = std::array::from_fn(|_| {
            let sliding = sliding.next()?;
            Some((&mut sliding.slider.phase, &mut sliding.motion))
        });
        let ends = slide_on(engine.lanes, &mut phases, &mut adapter(engine, &mut ()));
        // from the last, so that what takes its place in the list has had its turn
        for index in (from..self.sliding.len()).rev() {
            let Some(end) = ends[index - from] else {
                continue;
            };
            let sliding = &self.sliding[index];
            let (at, lane) = (sliding.at, sliding.lane);
            let mut toss = self.riders[at][lane].toss(engine, sliding.motion);
            let early = &mut Early::never();
            let mut nobody = ();
            let adapter = &mut adapter(engine, &mut nobody);
            let onward = engine.slid(&mut toss, &sliding.slider, end, early, adapter);
            self.sliding.swap_remove(index);
            self.go(at, lane, &toss, onward);
        }
    }

    fn end(&mut self, at: usize, lane: usize, ended: Ended) {
        let rider = self.riders[at][lane];
        let outcome = Outcome {
            ended,
            impacts: rider.impacts,
            contact_steps: rider.steps,
            jams: rider.jams,
            overruled: false,
            breaks: Breaks::default(),
        };
        self.ended.push((rider.number, outcome));
        self.vacant.push((at, lane));
    }
}
