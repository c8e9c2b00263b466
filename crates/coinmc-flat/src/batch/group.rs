//! Eight tosses in flight: one step of their search, one jump over what is high, one impact.

use crate::engine::FlatEngine;
use crate::flight::{Arc, LEAST_DEPARTURE, MAX_EVALUATIONS};
use crate::impact_law::ImpactLaw;
use crate::motion::Motion;
use crate::shape::{Shape, as_quadrant};
use crate::touching::Touching;
use coinmc_lanes::{Bits, Block, Lane, Lanes, WIDTH, Wide, Work};

/// The tosses' numbers, lane by lane, and what each is about to do.
#[derive(Debug, Clone)]
pub(super) struct Group {
    arc: Arc<Block>,
    vx: Block,
    /// Time since the arc's beginning.
    t: Block,
    /// Evaluations since the flight's beginning.
    evaluations: Block,
    least: Block,
    /// Searches for its contact, …
    pub(super) searching: Bits,
    /// … has found it, …
    pub(super) touched: Bits,
    /// … is high above the surface, …
    pub(super) high: Bits,
    /// … has been searching for too long.
    pub(super) lost: Bits,
    /// Of those just struck: what is left to the single toss, with the motion before the impact; and
    /// whose face is certain.
    pub(super) alone: Bits,
    pub(super) certain: Bits,
}

impl Default for Group {
    fn default() -> Self {
        let none = [0.0; WIDTH];
        Self {
            arc: Arc {
                quadrant: none,
                delta: none,
                omega: none,
                z: none,
                vz: none,
                end: none,
                cos_end: none,
            },
            vx: none,
            t: none,
            evaluations: none,
            least: none,
            searching: 0,
            touched: 0,
            high: 0,
            lost: 0,
            alone: 0,
            certain: 0,
        }
    }
}

impl Group {
    /// Puts a toss that begins a flight into a lane. `departing`: from the surface.
    pub(super) fn put(&mut self, lane: usize, motion: &Motion, shape: &Shape, departing: bool) {
        let mut arc = motion.arc(shape);
        let (mut t, mut least, mut evaluations) = (0.0, LEAST_DEPARTURE, 0.0);
        let bit: Bits = 1 << lane;
        let mut high = arc.z > 1.0;
        let mut touched = false;
        if departing && !high {
            let look = arc.look(t, true, &mut least);
            evaluations = 1.0;
            (high, touched) = (look.high, look.touches);
            if !(high || touched) {
                t = look.next;
                if t >= arc.end {
                    arc = arc.cross(shape);
                    (t, least) = (0.0, LEAST_DEPARTURE);
                    high = arc.z > 1.0;
                }
            }
        }
        self.arc.set(lane, &arc);
        self.vx[lane] = motion.vx;
        (self.t[lane], self.least[lane]) = (t, least);
        self.evaluations[lane] = evaluations;
        let stage = match (high, touched) {
            (true, _) => &mut self.high,
            (_, true) => &mut self.touched,
            _ => &mut self.searching,
        };
        *stage |= bit;
    }

    /// Whether any toss is on its way.
    pub(super) fn is_at_work(&self) -> bool {
        self.searching | self.touched | self.high | self.lost != 0
    }

    /// Takes a toss out of its flight.
    pub(super) fn ground(&mut self, lane: usize) {
        let others: Bits = !(1 << lane);
        self.searching &= others;
        self.high &= others;
    }

    /// The coin of a lane, but for what only observers see.
    pub(super) fn motion(&self, lane: usize) -> Motion {
        let arc = &self.arc;
        Motion {
            quadrant: as_quadrant(arc.quadrant[lane]),
            delta: arc.delta[lane],
            omega: arc.omega[lane],
            x: 0.0,
            z: arc.z[lane],
            vx: self.vx[lane],
            vz: arc.vz[lane],
            time: 0.0,
        }
    }

    /// One step of every flight on search.
    pub(super) fn sweep(groups: &mut [Self], lanes: Lanes, shape: &Shape) {
        lanes.enter(Sweep { groups, shape });
    }

    /// Jumps to where the coins that are high come down.
    pub(super) fn skip(&mut self, lanes: Lanes, shape: &Shape) {
        lanes.enter(Skip { group: self, shape });
    }

    /// Brings the coins that touch to the surface.
    pub(super) fn land(&mut self, lanes: Lanes) {
        lanes.enter(Land { group: self });
    }

    /// Throws the coins that touch back.
    pub(super) fn strike<I: ImpactLaw>(&mut self, engine: &FlatEngine<I>) {
        engine.lanes.enter(Strike {
            group: self,
            engine,
        });
    }
}

impl Arc<Block> {
    fn set(&mut self, lane: usize, arc: &Arc<f64>) {
        self.quadrant[lane] = arc.quadrant;
        self.delta[lane] = arc.delta;
        self.omega[lane] = arc.omega;
        self.z[lane] = arc.z;
        self.vz[lane] = arc.vz;
        self.end[lane] = arc.end;
        self.cos_end[lane] = arc.cos_end;
    }

    #[inline(always)]
    fn load<L: Wide>(&self) -> Arc<L> {
        Arc {
            quadrant: L::load(&self.quadrant),
            delta: L::load(&self.delta),
            omega: L::load(&self.omega),
            z: L::load(&self.z),
            vz: L::load(&self.vz),
            end: L::load(&self.end),
            cos_end: L::load(&self.cos_end),
        }
    }

    #[inline(always)]
    fn store<L: Wide>(&mut self, arc: &Arc<L>) {
        self.quadrant = arc.quadrant.store();
        self.delta = arc.delta.store();
        self.omega = arc.omega.store();
        self.z = arc.z.store();
        self.vz = arc.vz.store();
        self.end = arc.end.store();
        self.cos_end = arc.cos_end.store();
    }
}

impl<L: Lane> Arc<L> {
    #[inline(always)]
    fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            quadrant: L::select(mask, yes.quadrant, no.quadrant),
            delta: L::select(mask, yes.delta, no.delta),
            omega: L::select(mask, yes.omega, no.omega),
            z: L::select(mask, yes.z, no.z),
            vz: L::select(mask, yes.vz, no.vz),
            end: L::select(mask, yes.end, no.end),
            cos_end: L::select(mask, yes.cos_end, no.cos_end),
        }
    }
}

struct Sweep<'a> {
    groups: &'a mut [Group],
    shape: &'a Shape,
}

impl Work for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        for group in self.groups {
            if group.searching != 0 {
                group.step::<L>(self.shape);
            }
        }
    }
}

impl Group {
    #[inline(always)]
    fn step<L: Wide>(&mut self, shape: &Shape) {
        let arc: Arc<L> = self.arc.load();
        let (t, mut least) = (L::load(&self.t), L::load(&self.least));
        let evaluations = L::load(&self.evaluations);
        let lost = L::splat(f64::from(MAX_EVALUATIONS)).le(evaluations);
        let searching = L::mask(self.searching) & !lost;
        self.lost |= self.searching & L::bits(lost);
        let counted = L::select(searching, evaluations + L::splat(1.0), evaluations);
        self.evaluations = counted.store();
        let look = arc.look(t, L::mask(0), &mut least);
        let (touched, high) = (searching & look.touches, searching & look.high);
        let on = searching & !(touched | high);
        self.touched |= L::bits(touched);
        self.high |= L::bits(high);
        self.searching = L::bits(on);
        self.go_on(shape, &arc, (t, look.next, least), on);
    }

    /// Moves the search of these lanes on to `next`, across the end of the quadrant where that is
    /// reached.
    #[inline(always)]
    fn go_on<L: Wide>(
        &mut self,
        shape: &Shape,
        arc: &Arc<L>,
        (t, next, least): (L, L, L),
        on: L::Mask,
    ) {
        let clear = L::bits(on & arc.end.le(next));
        if clear == 0 {
            self.t = L::select(on, next, t).store();
            self.least = least.store();
            return;
        }
        let clear_lanes = L::mask(clear);
        let crossed = Arc::select(clear_lanes, &arc.cross(shape), arc);
        self.arc.store(&crossed);
        let t = L::select(on, next, t);
        self.t = L::select(clear_lanes, L::splat(0.0), t).store();
        self.least = L::select(clear_lanes, L::splat(LEAST_DEPARTURE), least).store();
        let high = clear & L::bits(L::splat(1.0).lt(crossed.z));
        self.high |= high;
        self.searching &= !high;
    }
}

struct Skip<'a> {
    group: &'a mut Group,
    shape: &'a Shape,
}

impl Work for Skip<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let group = self.group;
        let high = L::mask(group.high);
        let from: Arc<L> = group.arc.load();
        let mut arc = from;
        arc.advance(L::load(&group.t));
        let skipped = arc.skip_high(self.shape, arc.high_time());
        group.arc.store(&Arc::select(high, &skipped, &from));
        group.t = L::select(high, L::splat(0.0), L::load(&group.t)).store();
        let least = L::load(&group.least);
        group.least = L::select(high, L::splat(LEAST_DEPARTURE), least).store();
        group.searching |= group.high;
        group.high = 0;
    }
}

struct Land<'a> {
    group: &'a mut Group,
}

impl Work for Land<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let group = self.group;
        let touched = L::mask(group.touched);
        let from: Arc<L> = group.arc.load();
        let mut arc = from;
        arc.advance(L::load(&group.t));
        group.arc.store(&Arc::select(touched, &arc, &from));
        group.touched = 0;
    }
}

struct Strike<'a, I> {
    group: &'a mut Group,
    engine: &'a FlatEngine<I>,
}

impl<I: ImpactLaw> Work for Strike<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (group, engine) = (self.group, self.engine);
        let (shape, k) = (&engine.shape, engine.shape.k);
        let mask = L::mask(group.touched);
        let from: Arc<L> = group.arc.load();
        let mut landed = from;
        landed.advance(L::load(&group.t));
        let vx = L::load(&group.vx);
        let touching = Touching::new(landed.delta, vx, landed.vz, landed.omega);
        let p = engine.impulse(&touching, engine.restitution);
        let struck = touching.pushed(&p, k).capped(k, touching.energy(k));
        let bounces = engine.bounces_on(&touching) & !engine.may_rock_out(struck.vz);
        let energy = if engine.friction == 0.0 {
            struck.energy_without_sliding(k)
        } else {
            struck.energy(k)
        };
        let certain = energy.lt(L::splat(1.0));
        group.alone = group.touched & !L::bits(bounces);
        group.certain = group.touched & L::bits(bounces & certain);
        let flies = mask & bounces & !certain;
        let flight = [landed.delta, struck.omega, struck.cos, struck.vz];
        let arc = Arc::new(shape, landed.quadrant, flight);
        let next = arc.depart(struck.sin, struck.cos);
        let then = Arc::select(flies, &arc, &Arc::select(mask, &landed, &from));
        group.arc.store(&then);
        group.vx = L::select(flies, struck.vx, vx).store();
        let evaluations = L::load(&group.evaluations);
        group.evaluations = L::select(flies, L::splat(1.0), evaluations).store();
        let least = L::load(&group.least);
        let least = L::select(flies, L::splat(2.0 * LEAST_DEPARTURE), least);
        group.searching |= L::bits(flies);
        group.touched = 0;
        group.go_on(shape, &then, (L::load(&group.t), next, least), flies);
    }
}
