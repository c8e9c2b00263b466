//! Simulated recordings listened to: how near restitution and rolling friction come, and whether bad files are ever
//! answered with confidence.
//!
//! Coins of 23 mm on surfaces of wood's prior, in rooms with noise and echoes. Bad files are recordings of coins
//! that were cut, damaged byte by byte, clipped or drowned, and sounds of other things: noise, notes, speech-like
//! noise, claps.

use crate::survey::survey;
use clap::{Args, ValueEnum};
use coinmc_bench::{Report, Table, number};
use coinmc_calibrate::Observations;
use coinmc_core::{Domain, Philox4x64, Stream, UniformSource, inverse_normal_cdf, unit_interval};
use coinmc_listen::{Effort, Heard, Kind, Recording, Synthetic, Told};
use coinmc_questions::Workers;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// Second word of the key of bad files.
const BAD: u64 = 0x6261_6421;
/// Samples a second of sounds that are no coin's.
const RATE: u32 = 22_050;

/// The study's arguments.
#[derive(Debug, Args)]
pub(crate) struct Listen {
    /// What to measure
    #[arg(long, value_enum, default_value_t = Part::Whirr)]
    part: Part,

    /// Coins, or bad files
    #[arg(long, value_parser = number::count, default_value = "100", value_name = "N")]
    cases: u64,

    /// Recordings of each dropped coin
    #[arg(long, default_value_t = 5)]
    recordings: u64,

    /// Surfaces on which drops are simulated
    #[arg(long, value_parser = number::count, default_value = "10000", value_name = "N")]
    surfaces: u64,

    /// Power of the toss over the noise, dB
    #[arg(long, default_value_t = 10.0, allow_negative_numbers = true)]
    noise_db: f64,

    /// Friction is known within this share of it, as by tilting the table
    #[arg(long, value_name = "SHARE")]
    known_friction: Option<f64>,

    /// Standard deviation of the tilt of a dropped coin, degrees
    #[arg(long, default_value_t = 10.0)]
    tilt_deg: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Spun coins: rolling friction
    Whirr,
    /// Dropped coins: restitution
    Drops,
    /// Files that hold no coin, or a damaged one
    Bad,
}

impl Listen {
    pub(crate) fn execute(&self, seed: u64) -> Report {
        match self.part {
            Part::Whirr => self.whirr(seed),
            Part::Drops => self.drops(seed),
            Part::Bad => self.bad(seed),
        }
    }

    fn whirr(&self, seed: u64) -> Report {
        let cases: Vec<u64> = (0..self.cases).collect();
        let found = survey(&cases, |case| self.spin(seed, *case));
        let columns = [
            "case",
            "rolling_friction_m",
            "found_m",
            "error_m",
            "off",
            "why",
        ];
        let mut table = Table::new("Rolling friction from the whirr", &columns);
        let mut offs = vec![];
        for (case, (truth, found)) in cases.iter().zip(&found) {
            let mut row = vec![case.to_string(), format!("{truth:.3e}")];
            row.extend(match found {
                Ok((length, error)) => {
                    let off = length / truth - 1.0;
                    offs.push((off, error / length));
                    [
                        format!("{length:.3e}"),
                        format!("{error:.1e}"),
                        format!("{off:+.3}"),
                        String::new(),
                    ]
                }
                Err(why) => [String::new(), String::new(), String::new(), why.clone()],
            });
            table.push(row);
        }
        let mut report = Report::new(table);
        let within = |most: f64| offs.iter().filter(|(off, _)| off.abs() < most).count();
        let covered = offs
            .iter()
            .filter(|(off, share)| off.abs() < 1.96 * share * (1.0 + off))
            .count();
        report.remark(format!(
            "{} of {} spins whirr; within 10 %: {}, within 20 %: {}; {covered} in 1.96 standard errors; mean {:+.3}, rms {:.3}",
            offs.len(),
            cases.len(),
            within(0.1),
            within(0.2),
            offs.iter().map(|off| off.0).sum::<f64>() / offs.len() as f64,
            (offs.iter().map(|off| off.0 * off.0).sum::<f64>() / offs.len() as f64).sqrt()
        ));
        report
    }

    /// The rolling friction of a spun coin, and what is heard of it or why nothing.
    fn spin(&self, seed: u64, case: u64) -> (f64, Result<(f64, f64), String>) {
        let launch = "height_m = 0.0116\norientation = { tilt_deg = { normal = { mean = 85, sd = 3 } } }\n\
             spin = { components_rad_s = [0, 0, { normal = { mean = 60, sd = 10 } }] }";
        let (truth, made) = coin(seed, case, launch, self.known_friction);
        let recording = self.recording(&made, case, 0);
        let scene = &made.plan.points[0].scene;
        let heard = Heard::of(&recording, Some(scene), Some(Kind::Whirr));
        let told = match heard.silence() {
            Some(why) => Err(why),
            None => told(&[heard], &made, 500)
                .and_then(|told| told.whirrs.ok_or("no rolling friction".to_owned()))
                .map(|length| (length.length_m, length.error_m)),
        };
        (truth[2], told)
    }

    fn drops(&self, seed: u64) -> Report {
        let cases: Vec<u64> = (0..self.cases).collect();
        let found = survey(&cases, |case| self.drop(seed, *case));
        let columns = [
            "case",
            "restitution",
            "found",
            "lo",
            "hi",
            "heard",
            "doubts",
        ];
        let mut table = Table::new("Restitution from drops", &columns);
        let (mut squares, mut near, mut held, mut n, mut doubts) = (0.0, 0, 0, 0.0_f64, 0);
        for (case, (truth, heard, found)) in cases.iter().zip(&found) {
            let mut row = vec![case.to_string(), format!("{truth:.4}")];
            row.extend(match found {
                Ok((mean, [lo, hi], odd)) => {
                    n += 1.0;
                    squares += (mean - truth) * (mean - truth);
                    near += usize::from((mean - truth).abs() < 0.03);
                    held += usize::from((*lo..=*hi).contains(truth));
                    doubts += usize::from(*odd > 0);
                    [
                        format!("{mean:.4}"),
                        format!("{lo:.4}"),
                        format!("{hi:.4}"),
                        heard.to_string(),
                        odd.to_string(),
                    ]
                }
                Err(why) => [
                    String::new(),
                    String::new(),
                    String::new(),
                    heard.to_string(),
                    why.clone(),
                ],
            });
            table.push(row);
        }
        let mut report = Report::new(table);
        report.remark(format!(
            "{n} coins with {} recordings each: root mean square {:.4}, within .03: {near}; 95 % intervals hold {held}; {doubts} with doubts",
            self.recordings,
            (squares / n).sqrt()
        ));
        report
    }

    /// The restitution of a dropped coin, in how many recordings it was heard, and what is found.
    #[allow(clippy::type_complexity)]
    fn drop(&self, seed: u64, case: u64) -> (f64, usize, Result<(f64, [f64; 2], usize), String>) {
        let launch = format!(
            "height_m = 0.15\norientation = {{ tilt_deg = {{ normal = {{ mean = 0, sd = {:.3} }} }} }}\n\
             spin = {{ isotropic_sd_rad_s = 1 }}",
            self.tilt_deg
        );
        let (truth, made) = coin(seed, case, &launch, self.known_friction);
        let scene = &made.plan.points[0].scene;
        let heard: Vec<Heard> = (0..self.recordings)
            .map(|take| {
                Heard::of(
                    &self.recording(&made, case, take),
                    Some(scene),
                    Some(Kind::Drop),
                )
            })
            .filter(|heard| heard.silence().is_none())
            .collect();
        if heard.is_empty() {
            return (truth[0], 0, Err("no drop is heard".to_owned()));
        }
        let found = told(&heard, &made, self.surfaces).and_then(|told| {
            let drops = told.drops.ok_or("no drops".to_owned())?;
            let e = &drops.parameters[0];
            Ok((e.median, e.interval, drops.doubts.len()))
        });
        (truth[0], heard.len(), found)
    }

    fn recording(&self, made: &Observations, case: u64, take: u64) -> Recording {
        let point = &made.plan.points[0];
        let stream = Stream::new(case, Domain::Acceptance, 1);
        let launch = point
            .launches
            .launch(&point.scene.coin, &mut stream.toss(take));
        let synthetic = Synthetic {
            seed: case * 1000 + take,
            signal_to_noise_db: self.noise_db,
            ..Synthetic::default()
        };
        synthetic
            .recording(point, &launch)
            .expect("a scene with tosses")
    }

    fn bad(&self, seed: u64) -> Report {
        let cases: Vec<u64> = (0..self.cases).collect();
        let found = survey(&cases, |case| bad_file(seed, *case));
        let columns = ["case", "kind", "answer", "what"];
        let mut table = Table::new("Bad files", &columns);
        let [mut errors, mut doubted, mut confident, mut right] = [0; 4];
        for (case, (kind, answer)) in cases.iter().zip(&found) {
            let (word, what) = match answer {
                Answer::Refused(why) => {
                    errors += 1;
                    ("refused", why)
                }
                Answer::Doubted(why) => {
                    doubted += 1;
                    ("doubted", why)
                }
                Answer::Confident(what) => {
                    confident += 1;
                    ("confident", what)
                }
                Answer::Right(what) => {
                    right += 1;
                    ("right", what)
                }
            };
            table.push(vec![
                case.to_string(),
                (*kind).to_owned(),
                word.to_owned(),
                what.clone(),
            ]);
        }
        let mut report = Report::new(table);
        report.remark(format!(
            "{errors} refused, {doubted} answered with doubts, {right} damaged recordings of coins answered rightly, \
             {confident} with a wrong confidence"
        ));
        report
    }
}

/// What becomes of a bad file.
enum Answer {
    Refused(String),
    Doubted(String),
    Confident(String),
    /// Without doubt, of a damaged recording of a coin, and right.
    Right(String),
}

/// A coin on a surface drawn from wood's prior, and the config that knows coin, launch and prior.
///
/// With `known` the friction is known within this share of it.
fn coin(seed: u64, case: u64, launch: &str, known: Option<f64>) -> (Vec<f64>, Observations) {
    let text = |surface: &str, more: &str| {
        format!(
            "[coin]\nratio = 0.16\nradius_m = 0.0116\n[prior]\nmaterial = 'wood'\n{more}\n[surface]\n{surface}\n\
             [launch]\n{launch}\n[engine.volumetric]\n"
        )
    };
    let parse = |surface: &str, more: &str| {
        Observations::parse("study", &text(surface, more), &[], "".as_ref())
            .expect("a config of the study")
    };
    let prior = parse("restitution = 0.5\nfriction = 0.3", "");
    let mut uniforms = Stream::new(seed, Domain::Parameters, 1).toss(case);
    let values: Vec<f64> = (0..)
        .zip(&prior.priors)
        .map(|(d, prior)| prior.value(inverse_normal_cdf(uniforms.uniform(d))))
        .collect();
    let surface = format!(
        "restitution = {}\nfriction = {}\nrolling_friction_m = {:e}\npivoting_friction_m = {:e}",
        values[0], values[1], values[2], values[3]
    );
    let friction = known.map_or_else(String::new, |share| {
        let [low, high] = [1.0 - share, 1.0 + share].map(|by| by * values[1]);
        format!("friction = {{ low = {low}, high = {high} }}")
    });
    let made = parse(&surface, &friction);
    (values, made)
}

fn told(heard: &[Heard], observed: &Observations, surfaces: u64) -> Result<Told, String> {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: NonZeroUsize::new(1),
        cancel: &cancel,
        made: &|_| (),
    };
    let effort = Effort { surfaces, seed: 1 };
    Told::of(heard, observed, effort, &workers).map_err(|error| error.to_string())
}

/// Kinds that are recordings of coins, more or less damaged.
const OF_COINS: [&str; 4] = ["cut", "damaged", "clipped", "drowned"];
const KINDS: [&str; 10] = [
    "cut", "damaged", "clipped", "drowned", "noise", "notes", "speech", "claps", "hum", "bytes",
];

fn bad_file(seed: u64, case: u64) -> (&'static str, Answer) {
    let launch = "height_m = 0.15\norientation = { tilt_deg = { normal = { mean = 0, sd = 10 } } }\n\
                  spin = { isotropic_sd_rad_s = 1 }";
    let (truth, made) = coin(seed, case, launch, None);
    let philox = Philox4x64::new([seed, BAD]);
    let random = |place: u64| unit_interval(philox.block([case, place, 0, 0])[0]);
    #[allow(clippy::cast_possible_truncation)]
    let kind = KINDS[(case % KINDS.len() as u64) as usize];
    let bytes = bytes_of(kind, &made, case, &random);
    let answer = match Recording::from_bytes(kind, &bytes) {
        Err(error) => Answer::Refused(error.to_string()),
        Ok(recording) => match answer(&recording, &made) {
            (Answer::Confident(what), Some([lo, hi]))
                if OF_COINS.contains(&kind) && (lo..=hi).contains(&truth[0]) =>
            {
                Answer::Right(what)
            }
            (answer, _) => answer,
        },
    };
    (kind, answer)
}

/// What a recording is answered with, and the interval of the restitution.
fn answer(recording: &Recording, made: &Observations) -> (Answer, Option<[f64; 2]>) {
    let scene = &made.plan.points[0].scene;
    let heard = Heard::of(recording, Some(scene), None);
    if let Some(why) = heard.silence() {
        return (Answer::Refused(why), None);
    }
    let mut doubts = heard.doubts.clone();
    match told(&[heard], made, 2000) {
        Err(why) => (Answer::Refused(why), None),
        Ok(told) => {
            doubts.extend(told.doubts.clone());
            doubts.extend(told.drops.iter().flat_map(|drops| drops.doubts.clone()));
            let drops = told.drops.as_ref().map(|drops| &drops.parameters[0]);
            let what = format!(
                "e {:?}, rolling friction {:?}",
                drops.map(|e| (e.median, e.interval)),
                told.whirrs
            );
            let answer = if doubts.is_empty() {
                Answer::Confident(what)
            } else {
                Answer::Doubted(doubts.join("; "))
            };
            (answer, drops.map(|e| e.interval))
        }
    }
}

fn bytes_of(kind: &str, made: &Observations, case: u64, random: &dyn Fn(u64) -> f64) -> Vec<u8> {
    let point = &made.plan.points[0];
    let stream = Stream::new(case, Domain::Acceptance, 2);
    let launch = point
        .launches
        .launch(&point.scene.coin, &mut stream.toss(0));
    let drop = |synthetic: Synthetic| {
        let made = synthetic
            .recording(point, &launch)
            .expect("a scene with tosses");
        made.to_bytes().expect("a short recording")
    };
    let usual = Synthetic {
        seed: case,
        ..Synthetic::default()
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let below = |place: u64, most: usize| (random(place) * most as f64) as usize;
    match kind {
        "cut" => {
            let mut bytes = drop(usual);
            bytes.truncate(below(1, bytes.len()));
            bytes
        }
        "damaged" => {
            let mut bytes = drop(usual);
            for k in 0..=(below(2, 60) as u64) {
                // half of the damage is in the header
                let most = if k % 2 == 0 { 60 } else { bytes.len() };
                let place = below(10 + 2 * k, most);
                #[allow(clippy::cast_possible_truncation)]
                let byte = below(11 + 2 * k, 256) as u8;
                bytes[place] = byte;
            }
            bytes
        }
        "clipped" => drop(Synthetic {
            peak: 20.0 + 80.0 * random(3),
            ..usual
        }),
        "drowned" => drop(Synthetic {
            signal_to_noise_db: -5.0 - 20.0 * random(4),
            ..usual
        }),
        "bytes" => (0..below(5, 100_000) as u64)
            .map(|k| byte(random(100 + k)))
            .collect(),
        other => Recording::to_bytes(&Recording::of_samples(
            other,
            f64::from(RATE),
            sound_of(other, random),
        ))
        .expect("a short recording"),
    }
}

/// Three seconds of something that is no coin.
fn sound_of(kind: &str, random: &dyn Fn(u64) -> f64) -> Vec<f32> {
    let length = 3 * u64::from(RATE);
    let time = |k: u64| k as f64 / f64::from(RATE);
    let noise = |k: u64| 2.0 * random(1000 + k) - 1.0;
    let pitch = 200.0 * libm::exp2(3.0 * random(6));
    let tempo = 2.0 + 8.0 * random(7);
    let quiet = libm::pow(10.0, -1.0 - 2.5 * random(8));
    let mut low = 0.0;
    let sample = |k: u64| -> f32 {
        let t = time(k);
        let beat = (t * tempo).floor();
        let since = t - beat / tempo;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let number = beat as u64;
        let value = match kind {
            "notes" => {
                let note = pitch * libm::exp2((12.0 * random(20 + number)).floor() / 12.0);
                let loud = libm::exp(-since * (2.0 + 8.0 * random(9))) * (since / 0.01).min(1.0);
                let tones =
                    (1..=4).map(|h| libm::sin(TAU * note * f64::from(h) * t) / f64::from(h));
                0.2 * loud * tones.sum::<f64>()
            }
            "speech" => {
                // noise through a slow pole, in syllables of different loudness
                low = 0.8 * low + 0.2 * noise(k);
                let swell = libm::sin(std::f64::consts::PI * (since * tempo).min(1.0));
                let voice = libm::sin(TAU * (100.0 + 50.0 * random(20 + number)) * t);
                random(400 + number)
                    * swell
                    * (low + 0.5 * noise(k) * random(500 + number) + 0.3 * voice)
            }
            "claps" => {
                let jitter = 0.3 * random(300 + number) / tempo;
                let after = since - jitter;
                if after > 0.0 {
                    0.5 * libm::exp(-after / 0.01) * noise(k) * (0.7 + 0.3 * random(700 + number))
                } else {
                    0.0
                }
            }
            "hum" => 0.3 * libm::sin(TAU * 50.0 * t) + 0.1 * libm::sin(TAU * pitch * t),
            _ => 0.3 * noise(k),
        };
        #[allow(clippy::cast_possible_truncation)]
        let sample = (value + quiet * 0.1 * noise(k + 10_000_000)).clamp(-1.0, 1.0) as f32;
        sample
    };
    (0..length).map(sample).collect()
}

/// A number from 0 to 1 as a byte.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts of floats saturate"
)]
fn byte(share: f64) -> u8 {
    (share * 256.0) as u8
}
