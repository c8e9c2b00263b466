//! Several tosses in one world.
//!
//! A step of Rapier costs the same for one coin as for four: its solver works on four contacts at a
//! time, in the lanes of one register, and what it does around the contacts is shared by all coins.
//! The coins stand in one another's place and do not touch: a filter keeps their pairs out of the
//! world. No operation mixes lanes, so that every toss is, to the last bit, what it is alone (tested).

use crate::account::Account;
use crate::rules::{End, Rules};
use crate::toss::Toss;
use crate::world::World;
use coinmc_core::{Launch, Observer};
use std::ops::ControlFlow;

/// A toss on its way, and its number among the launches.
struct Seated<'a> {
    number: usize,
    toss: Toss<'a, ()>,
}

/// Follows one toss, alone.
pub(crate) fn follow<O: Observer>(
    rules: &Rules,
    world: &mut World,
    launch: &Launch,
    observer: O,
) -> Account {
    let (mut toss, mut course) = rules.begin(world, 0, launch, observer);
    let end = loop {
        if course.is_continue() {
            course = rules.before_step(world, 0, &mut toss);
        }
        if let ControlFlow::Break(end) = course {
            break end;
        }
        world.step();
        course = rules.after_step(world, 0, &mut toss);
    };
    world.clear(0);
    toss.end(end)
}

/// Follows the launches, several at a time, and hands on the account of each with its number, in any
/// order, until `each` breaks off.
pub(crate) fn toss_all_in_batch(
    rules: &Rules,
    world: &mut World,
    launches: impl Iterator<Item = Launch>,
    mut each: impl FnMut(usize, &Account) -> ControlFlow<()>,
) {
    let seats = rules.settings.seats();
    let mut launches = launches.enumerate();
    let mut seated: Vec<Option<Seated<'_>>> = Vec::new();
    seated.resize_with(seats, || None);
    let _ = run(rules, world, &mut seated, &mut launches, &mut each);
    for seat in 0..seats {
        world.clear(seat);
    }
}

/// Until there are no more launches and every seat is empty, or `each` breaks off.
fn run<'a>(
    rules: &'a Rules,
    world: &mut World,
    seated: &mut [Option<Seated<'a>>],
    launches: &mut impl Iterator<Item = (usize, Launch)>,
    each: &mut impl FnMut(usize, &Account) -> ControlFlow<()>,
) -> ControlFlow<()> {
    loop {
        let mut occupied = false;
        for (seat, place) in seated.iter_mut().enumerate() {
            fill(rules, world, seat, place, launches, each)?;
            occupied |= place.is_some();
        }
        if !occupied {
            return ControlFlow::Continue(());
        }
        world.step();
        for (seat, place) in seated.iter_mut().enumerate() {
            if let Some(Seated { toss, .. }) = place
                && let ControlFlow::Break(end) = rules.after_step(world, seat, toss)
            {
                hand_on(place, end, each)?;
            }
        }
    }
}

/// Makes the seat's toss ready for a step; one that ends gives way to the next launch.
fn fill<'a>(
    rules: &'a Rules,
    world: &mut World,
    seat: usize,
    place: &mut Option<Seated<'a>>,
    launches: &mut impl Iterator<Item = (usize, Launch)>,
    each: &mut impl FnMut(usize, &Account) -> ControlFlow<()>,
) -> ControlFlow<()> {
    loop {
        let course = if let Some(Seated { toss, .. }) = place {
            rules.before_step(world, seat, toss)
        } else if let Some((number, launch)) = launches.next() {
            let (toss, course) = rules.begin(world, seat, &launch, ());
            *place = Some(Seated { number, toss });
            match course {
                // its first step is not yet prepared
                ControlFlow::Continue(()) => continue,
                end @ ControlFlow::Break(_) => end,
            }
        } else {
            world.clear(seat);
            return ControlFlow::Continue(());
        };
        match course {
            ControlFlow::Continue(()) => return ControlFlow::Continue(()),
            ControlFlow::Break(end) => hand_on(place, end, each)?,
        }
    }
}

fn hand_on(
    place: &mut Option<Seated<'_>>,
    end: End,
    each: &mut impl FnMut(usize, &Account) -> ControlFlow<()>,
) -> ControlFlow<()> {
    match place.take() {
        Some(Seated { number, toss }) => each(number, &toss.end(end)),
        None => ControlFlow::Continue(()),
    }
}
