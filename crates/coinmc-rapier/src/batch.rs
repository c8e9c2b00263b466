//! Many tosses in one world.
//!
//! A step of Rapier costs the same for one coin as for four: its solver works on four contacts at a
//! time, in the lanes of one register, and all coins share what it does around the contacts. The
//! coins may overlap and do not touch: a filter keeps their pairs out of the world. No operation
//! mixes lanes, so every toss is bit-identical to the scalar path ([`Driver::toss`]; tested).

use crate::account::Account;
use crate::driver::{Driver, End};
use crate::toss::Toss;
use crate::world::World;
use coinmc_core::Launch;
use std::ops::ControlFlow;

/// A toss in flight and its number among the launches.
struct Slot<'a> {
    number: usize,
    toss: Toss<'a, ()>,
}

/// The tosses in flight: slot i holds the toss whose coin is in slot i of the world.
struct Batch<'a, L, F> {
    driver: &'a Driver,
    launches: L,
    /// Takes the number and the account of a toss that has ended.
    visit: F,
    slots: Vec<Option<Slot<'a>>>,
}

/// Follows the launches, several at a time, and calls `visit` with the number and the account of
/// each, in any order, until `visit` breaks off.
pub(crate) fn toss_all_in_batch(
    driver: &Driver,
    world: &mut World,
    launches: impl Iterator<Item = Launch>,
    visit: impl FnMut(usize, &Account) -> ControlFlow<()>,
) {
    let mut batch = Batch {
        driver,
        launches: launches.enumerate(),
        visit,
        slots: Vec::new(),
    };
    let slots = driver.settings.slots();
    batch.slots.resize_with(slots, || None);
    let _ = batch.run(world);
    for slot in 0..slots {
        world.clear(slot);
    }
}

impl<L, F> Batch<'_, L, F>
where
    L: Iterator<Item = (usize, Launch)>,
    F: FnMut(usize, &Account) -> ControlFlow<()>,
{
    /// Steps until there are no more launches and every slot is empty, or `visit` breaks off.
    fn run(&mut self, world: &mut World) -> ControlFlow<()> {
        loop {
            for slot in 0..self.slots.len() {
                self.prepare(world, slot)?;
            }
            if self.slots.iter().all(Option::is_none) {
                return ControlFlow::Continue(());
            }
            world.step();
            for slot in 0..self.slots.len() {
                if let Some(Slot { toss, .. }) = &mut self.slots[slot]
                    && let ControlFlow::Break(end) = self.driver.after_step(world, slot, toss)
                {
                    self.end(slot, end)?;
                }
            }
        }
    }

    /// Prepares a slot's toss for the next step; a toss that ends gives way to the next launch.
    fn prepare(&mut self, world: &mut World, slot: usize) -> ControlFlow<()> {
        loop {
            let next = if let Some(Slot { toss, .. }) = &mut self.slots[slot] {
                self.driver.before_step(world, slot, toss)
            } else if let Some((number, launch)) = self.launches.next() {
                let (toss, next) = self.driver.launch(world, slot, &launch, ());
                self.slots[slot] = Some(Slot { number, toss });
                match next {
                    // launched, but its first step is not yet prepared
                    ControlFlow::Continue(()) => continue,
                    end @ ControlFlow::Break(_) => end,
                }
            } else {
                world.clear(slot);
                return ControlFlow::Continue(());
            };
            match next {
                ControlFlow::Continue(()) => return ControlFlow::Continue(()),
                ControlFlow::Break(end) => self.end(slot, end)?,
            }
        }
    }

    /// Ends the toss of a slot.
    fn end(&mut self, slot: usize, end: End) -> ControlFlow<()> {
        match self.slots[slot].take() {
            Some(Slot { number, toss }) => (self.visit)(number, &toss.end(end)),
            None => ControlFlow::Continue(()),
        }
    }
}
