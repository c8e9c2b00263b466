//! What of a toss makes sound: its strikes, and the rounds of the contact while the coin rolls.

use crate::struck::{Strike, Tosser};
use coinmc_core::{Coin, Event, EventKind, Launch, Observer, Philox4x64, State, unit_interval};
use std::f64::consts::TAU;

/// Samples of a rolling coin, 1/s.
const RATE_HZ: f64 = 8000.0;
/// Most samples: a minute.
const MOST: usize = 480_000;
/// Speed of a strike by which the rim passes its dent, over the contact's speed along the rim.
const DENT: f64 = 0.02;
/// Speed of the rattle between dents over the contact's speed, in each sample.
const RATTLE: f64 = 0.001;
/// A second dent: its place on the round, and its share of the first.
const SECOND: [f64; 2] = [2.2, 0.35];
/// Most that a dent scatters from round to round, as a share.
const UNEVEN: f64 = 0.5;
/// Second word of the key of the random numbers.
const KEY: u64 = 0x7261_7474;

/// All sounds of a toss, and when the coin rests, s since the launch.
pub(crate) fn rattle(
    tosser: &Tosser,
    coin: &Coin,
    launch: &Launch,
    seed: u64,
) -> (Vec<Strike>, f64) {
    let mut heard = Rattle::default();
    tosser.show(launch, &mut heard);
    let philox = Philox4x64::new([seed, KEY]);
    let mut strikes = heard.strikes;
    let mut turned = 0.0;
    for (number, pair) in (0_u64..).zip(heard.rolls.windows(2)) {
        let [one, next] = [&pair[0], &pair[1]];
        let step = next.time_s - one.time_s;
        if step > 1.5 / RATE_HZ {
            continue;
        }
        let by = libm::remainder(next.azimuth - one.azimuth, TAU);
        let speed = (by / step).abs() * coin.radius_m();
        let random = philox.block([number, 0, 0, 0]).map(unit_interval);
        strikes.push(Strike {
            time_s: one.time_s + random[0] * step,
            speed_m_s: RATTLE * speed * (2.0 * random[1] - 1.0),
        });
        for [place, share] in [[0.0, 1.0], SECOND] {
            let rounds = |angle: f64| ((angle - place) / TAU).floor();
            if rounds(turned + by.abs()) > rounds(turned) {
                strikes.push(Strike {
                    time_s: one.time_s + random[2] * step,
                    speed_m_s: DENT * share * speed * (1.0 - UNEVEN * random[3]),
                });
            }
        }
        turned += by.abs();
    }
    strikes.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    (strikes, heard.end_s)
}

/// A sample of a coin that rolls: the direction in which its axis leans.
#[derive(Debug, Clone, Copy)]
struct Roll {
    time_s: f64,
    azimuth: f64,
}

#[derive(Debug, Default)]
struct Rattle {
    strikes: Vec<Strike>,
    rolls: Vec<Roll>,
    before: Option<State>,
    samples: u32,
    rolling: bool,
    end_s: f64,
}

impl Observer for Rattle {
    fn event(&mut self, event: &Event) {
        self.end_s = event.state.time_s;
        match event.kind {
            EventKind::Touching => self.before = Some(event.state),
            EventKind::Impact => {
                if let Some(before) = self.before.take() {
                    self.strikes.push(Strike {
                        time_s: event.state.time_s,
                        speed_m_s: (event.state.velocity_m_s - before.velocity_m_s).z.abs(),
                    });
                }
            }
            _ => {}
        }
        self.rolling = matches!(event.kind, EventKind::Sticking | EventKind::Sliding);
    }

    fn wants_at_s(&self) -> f64 {
        if self.rolls.len() >= MOST {
            return f64::INFINITY;
        }
        f64::from(self.samples + 1) / RATE_HZ
    }

    fn sample(&mut self, state: &State) {
        self.samples += 1;
        if self.rolling {
            self.rolls.push(Roll {
                time_s: state.time_s,
                azimuth: libm::atan2(state.axis.y, state.axis.x),
            });
        }
    }

    fn has_seen_enough(&self) -> bool {
        self.strikes.len() >= MOST || self.end_s > 60.0
    }
}
