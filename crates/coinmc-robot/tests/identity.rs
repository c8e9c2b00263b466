//! Whose throw it is, and what stops an experiment: each find of an attack on the robot as a test.

mod world;

use coinmc_link::{Host, Reply, Request, State};
use coinmc_robot::cycle::{Cycle, Halt, Step, Stranger};
use coinmc_robot::journal::{Entry, History, Resolution, VoidReason, parse};
use world::{Bench, End, MAX_STEPS, OURS, PROGRAM, World, rules, setting};

/// The world in which the first throw is announced, and its host is gone.
fn announced() -> World {
    let mut world = World::new(Vec::new());
    let (mut history, mut checksum) = (History::default(), parse(&world.file).unwrap().checksum);
    let mut cycle = Cycle::new(rules(false), PROGRAM);
    let mut host = Host::new();
    host.open(1, 0);
    for _ in 0..MAX_STEPS {
        match cycle.step(&history, 0) {
            Step::Request(request) => {
                world.ask(&mut cycle, &mut host, &request);
            }
            Step::Wait => {
                world.pass(100);
                cycle.waited();
            }
            Step::Announce { throw, id } => {
                let (setting, at_ms) = (setting(throw), 7);
                let entry = Entry::Announced { id, setting, at_ms };
                assert!(world.append(&mut history, &mut checksum, &entry).is_ok());
                return world;
            }
            Step::Write(entry) => {
                assert!(world.append(&mut history, &mut checksum, &entry).is_ok());
                cycle.written(&entry);
            }
            other => panic!("{other:?}"),
        }
    }
    panic!("the host goes on and on");
}

/// Somebody throws by hand, with the number that the journal has announced.
fn throw_by_hand(world: &mut World) {
    let mut host = Host::new();
    host.open(900, world.now_ms);
    assert!(world.request(&mut host, None).is_err());
    let throw = Request::Throw {
        throw_id: 1,
        experiment: 0,
        spin_mrev_s: 4321,
        angle_cdeg: 1234,
    };
    assert!(matches!(
        world.request(&mut host, Some(&throw)),
        Ok(Reply::Ok { .. })
    ));
    for _ in 0..50 {
        world.pass(50);
    }
}

fn reason(world: &World) -> Option<Resolution> {
    world.history().throws()[0].resolution
}

#[test]
fn a_throw_made_by_another_program_is_not_taken_for_the_announced_one() {
    let mut world = announced();
    throw_by_hand(&mut world);
    let end = world.run(false);
    assert!(matches!(end, End::Halted(Halt::Foreign { .. })));
    assert_eq!(reason(&world), Some(Resolution::Void(VoidReason::Mismatch)));
    // a person looks, and takes the robot over
    assert!(matches!(world.run(true), End::Finished));
    let history = world.history();
    let throws = history.throws();
    assert!(
        throws[1..]
            .iter()
            .all(|t| t.resolution == Some(Resolution::Done))
    );
    assert!(throws.iter().all(|t| t.reading.is_none() || t.id > 1));
}

#[test]
fn an_erased_memory_or_another_robot_is_noticed_and_throws_nothing_twice() {
    type Change = fn(&mut Bench);
    let erase: Change = |bench| bench.memory = None;
    let swap: Change = |bench| {
        bench.memory = None;
        bench.uid += 1;
    };
    // a robot that knows the experiment, but is another one
    let clone: Change = |bench| bench.uid += 1;
    for change in [erase, swap, clone] {
        let mut world = announced();
        // thrown, and at the coin
        let mut host = Host::new();
        host.open(901, world.now_ms);
        assert!(world.request(&mut host, None).is_err());
        let throw = Request::Throw {
            throw_id: 1,
            experiment: OURS,
            spin_mrev_s: setting(0).spin_mrev_s(),
            angle_cdeg: setting(0).angle_cdeg(),
        };
        assert!(world.request(&mut host, Some(&throw)).is_ok());
        while world.device().state() != State::AtCoin {
            world.pass(50);
        }
        world.reboot(change);
        let End::Halted(Halt::Foreign { how }) = world.run(false) else {
            panic!("it is not noticed");
        };
        assert!(matches!(
            how,
            Stranger::OtherRobot { .. } | Stranger::OtherExperiment { .. }
        ));
        assert_eq!(
            reason(&world),
            None,
            "put back, it could still be photographed"
        );
        assert!(matches!(world.run(true), End::Finished));
        let foreign = Some(Resolution::Void(VoidReason::Foreign));
        assert_eq!(reason(&world), foreign);
        let releases = &world.device().hardware().releases;
        let first = releases.iter().filter(|release| release.0 == 1).count();
        assert_eq!(first, 1, "thrown again");
    }
}

#[test]
fn a_release_far_from_what_was_asked_is_void() {
    let mut world = World::new(Vec::new());
    world.device().hardware_mut().drift = 51;
    assert!(matches!(world.run(false), End::Finished));
    let off = Some(Resolution::Void(VoidReason::OffTarget));
    assert!(world.history().throws().iter().all(|t| t.resolution == off));
    let mut world = World::new(Vec::new());
    world.device().hardware_mut().drift = 50;
    assert!(matches!(world.run(false), End::Finished));
    let done = Some(Resolution::Done);
    assert!(
        world
            .history()
            .throws()
            .iter()
            .all(|t| t.resolution == done)
    );
}

#[test]
fn a_robot_with_less_reach_than_the_plan_is_found_before_the_first_throw() {
    let mut world = World::new(Vec::new());
    world.device().hardware_mut().reach = Some(499);
    assert!(matches!(
        world.run(false),
        End::Halted(Halt::OutOfReach {
            spin_mrev_s: 499,
            ..
        })
    ));
    assert!(world.history().throws().is_empty());
}

#[test]
fn an_emergency_stop_halts_until_a_person_clears_it() {
    let mut world = announced();
    world.device().hardware_mut().stopped = true;
    assert!(matches!(world.run(false), End::Halted(Halt::EmergencyStop)));
    world.device().hardware_mut().stopped = false;
    assert!(matches!(world.run(false), End::Halted(Halt::EmergencyStop)));
    let mut host = Host::new();
    host.open(902, world.now_ms);
    assert!(world.request(&mut host, None).is_err());
    let clear = Request::ClearFault {
        code: coinmc_link::fault::EMERGENCY,
    };
    assert!(world.request(&mut host, Some(&clear)).is_ok());
    assert!(matches!(world.run(false), End::Finished));
}

#[test]
fn a_camera_that_fails_again_and_again_costs_no_throw() {
    let mut world = World::new(Vec::new());
    world.camera_fails = true;
    let end = world.run(false);
    assert!(matches!(
        end,
        End::Halted(Halt::CameraFails {
            id: 1,
            count: 3,
            ..
        })
    ));
    world.camera_fails = false;
    // the coin still lies there
    assert!(matches!(world.run(false), End::Finished));
    world.audit();
    assert_eq!(reason(&world), Some(Resolution::Done));
}
