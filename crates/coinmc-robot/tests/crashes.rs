//! The cycle with the link's device state machine, with crashes, resets and losses at every point:
//! every planned throw ends as either done or void, none is thrown twice, and every reading is that
//! of the coin that was thrown.

mod world;

use coinmc_link::{Host, Reply, Request};
use coinmc_robot::cycle::{Cycle, Halt, Photo, Shown, Step};
use coinmc_robot::journal::{Entry, History, Pending, Resolution, VoidReason};
use proptest::prelude::*;
use world::{End, MAX_STEPS, PROGRAM, THROWS, World, rules, setting};

#[test]
fn without_faults_every_throw_is_done() {
    let mut world = World::new(Vec::new());
    assert!(matches!(world.run(false), End::Finished));
    world.audit();
    let history = world.history();
    assert!(
        history
            .throws()
            .iter()
            .all(|t| t.resolution == Some(Resolution::Done))
    );
}

#[test]
fn unread_throws_are_void_and_not_repeated() {
    let mut world = World::new(Vec::new());
    let mut cycle = Cycle::new(rules(false), PROGRAM);
    let mut history = History::default();
    let mut host = Host::new();
    host.open(1, 0);
    for steps in 0.. {
        assert!(steps < MAX_STEPS, "the host goes on and on");
        match cycle.step(&history, 0) {
            Step::Request(request) => {
                world.ask(&mut cycle, &mut host, &request);
            }
            Step::Wait => {
                world.pass(100);
                cycle.waited();
            }
            Step::Announce { throw, id } => {
                let setting = setting(throw);
                history
                    .add(&Entry::Announced {
                        id,
                        setting,
                        at_ms: 0,
                    })
                    .unwrap();
            }
            Step::Write(entry) => {
                history.add(&entry).unwrap();
                cycle.written(&entry);
            }
            Step::Photograph { id, attempt } => {
                cycle.photographing(id, attempt);
                cycle.photographed(Photo {
                    id,
                    attempt,
                    shown: Shown::Nothing,
                });
            }
            Step::Finished => break,
            Step::Halt(halt) => panic!("{halt}"),
        }
    }
    let unread = Some(Resolution::Void(VoidReason::Unread));
    assert!(
        history
            .throws()
            .iter()
            .all(|throw| throw.resolution == unread)
    );
    assert_eq!(world.device().hardware().releases.len(), THROWS as usize);
}

#[test]
fn a_counter_ahead_halts_and_is_adopted_on_demand() {
    let mut world = World::new(Vec::new());
    let mut host = Host::new();
    host.open(1, 0);
    assert!(world.request(&mut host, None).is_err());
    world.pass(100);
    let reply = world.request(
        &mut host,
        Some(&Request::SetCounter {
            throw_id: 500,
            experiment: 3,
        }),
    );
    assert!(matches!(reply, Ok(Reply::Ok { throw_id: 500, .. })));
    let ahead = Halt::Ahead {
        robot: 500,
        journal: 0,
    };
    assert!(matches!(world.run(false), End::Halted(halt) if halt == ahead));
    assert_eq!(world.history().pending(), Pending::Nothing);
    assert!(ahead.to_string().contains("--adopt"));
    assert!(matches!(world.run(true), End::Finished));
    let ids: Vec<u32> = world
        .history()
        .throws()
        .iter()
        .map(|throw| throw.id)
        .collect();
    assert_eq!(ids, (501..=500 + THROWS).collect::<Vec<_>>());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, max_shrink_time: 10_000, ..ProptestConfig::default() })]

    #[test]
    fn with_any_faults_every_throw_is_resolved_once(faults in prop::collection::vec(any::<u8>(), 0..900)) {
        let mut world = World::new(faults);
        world.run_through_halts();
        world.audit();
    }
}
