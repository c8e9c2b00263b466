//! Shared by several tests.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

pub mod bed;
pub mod campaign;
#[cfg(target_os = "linux")]
pub mod simulator;

use coinmc_link::{Hardware, Info, Limits, Motion, Record, Sensors, capability};
use std::path::PathBuf;
use std::process::Command;

pub const INFO: Info = Info {
    uid: *b"coinmc-1",
    firmware: [0, 1, 0],
    capabilities: capability::LIGHT | capability::CARRIAGE,
    limits: Limits {
        spin_mrev_s: 4500,
        angle_cdeg: 18_000,
        x_um: 400_000,
        y_um: 300_000,
    },
};

/// A simulated robot: motions take time, and every release is counted.
#[derive(Debug, Clone)]
#[allow(clippy::struct_excessive_bools)] // inputs of a board
pub struct Bench {
    pub info: Info,
    pub now_ms: u32,
    done_ms: Option<u32>,
    pub stored: Option<Record>,
    pub store_works: bool,
    /// The id in the journal at each release.
    pub releases: Vec<u32>,
    pub motors_on: bool,
    /// This motion never ends.
    pub stuck: Option<Motion>,
    pub failure: u8,
    pub stopped: bool,
    /// The start never ends.
    pub never_ready: bool,
    aim: (u16, u16),
}

impl Default for Bench {
    fn default() -> Self {
        Self {
            info: INFO,
            now_ms: 0,
            done_ms: Some(0),
            stored: None,
            store_works: true,
            releases: Vec::new(),
            motors_on: false,
            stuck: None,
            failure: 0,
            stopped: false,
            never_ready: false,
            aim: (0, 0),
        }
    }
}

impl Hardware for Bench {
    fn info(&self) -> Info {
        self.info
    }

    fn load(&mut self) -> Option<Record> {
        self.stored
    }

    fn store(&mut self, record: &Record) -> bool {
        if self.store_works {
            self.stored = Some(*record);
        }
        self.store_works
    }

    fn start(&mut self, motion: Motion) {
        self.motors_on = true;
        if let Motion::Aim {
            spin_mrev_s,
            angle_cdeg,
        } = motion
        {
            self.aim = (spin_mrev_s, angle_cdeg);
        }
        if motion == Motion::Release {
            let id = self.stored.expect("released without a journal").throw_id;
            self.releases.push(id);
        }
        self.done_ms = (self.stuck != Some(motion)).then(|| self.now_ms + 200);
    }

    fn motors_off(&mut self) {
        self.motors_on = false;
        self.done_ms = Some(self.now_ms);
    }

    fn light(&mut self, _: u16) {}

    fn sense(&mut self) -> Sensors {
        Sensors {
            settled: !self.never_ready && self.done_ms.is_some_and(|done| self.now_ms >= done),
            spin_mrev_s: self.aim.0,
            angle_cdeg: self.aim.1,
            failure: self.failure,
            stopped: self.stopped,
            ..Sensors::default()
        }
    }
}

/// A compiled C program and its folder.
pub struct Program {
    pub path: PathBuf,
    _folder: tempfile::TempDir,
}

/// Compiles C sources (paths from the crate's root); prints a note if there is no C compiler.
pub fn compile(name: &str, sources: &[&str]) -> Option<Program> {
    compile_with(name, sources, &[])
}

/// Likewise, with more options.
pub fn compile_with(name: &str, sources: &[&str], options: &[&str]) -> Option<Program> {
    if Command::new("cc").arg("--version").output().is_err() {
        eprintln!("SKIPPED: no C compiler `cc`");
        return None;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    let build = |extra: &[&str]| {
        Command::new("cc")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["-std=c99", "-O1", "-Wall", "-Wextra", "-Wconversion"])
            .args(["-pedantic", "-Werror", "-Ic", "-I../../firmware/atmega328p"])
            .args(options)
            .args(extra)
            .arg("-o")
            .arg(&path)
            .args(sources)
            .output()
            .expect("the compiler runs")
    };
    // some compilers lack the libraries of the sanitizers
    let sanitized = build(&["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
    if !sanitized.status.success() {
        let output = build(&[]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
    }
    Some(Program {
        path,
        _folder: folder,
    })
}

/// Random numbers: SplitMix64 (Steele, Lea & Flood 2014).
#[derive(Debug, Clone)]
pub struct Random(pub u64);

impl Random {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From 0 to `end` − 1.
    #[allow(clippy::cast_possible_truncation)] // the product is below `end`
    pub fn below(&mut self, end: u32) -> u32 {
        ((u64::from(end) * (self.word() >> 32)) >> 32) as u32
    }

    pub fn chance(&mut self, per_mille: u32) -> bool {
        self.below(1000) < per_mille
    }

    #[allow(clippy::cast_possible_truncation)] // below 256
    pub fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(u32::try_from(from.len()).unwrap()) as usize]
    }
}
