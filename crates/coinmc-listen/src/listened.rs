//! Recordings heard together, and what they tell.

use crate::error::ListenError;
use crate::heard::{Bounces, NoBounces};
use crate::onsets::Onsets;
use crate::posterior::{Effort, FromDrops};
use crate::recording::Recording;
use crate::settling::rolling_friction;
use crate::whirr::{NoWhirr, Whirr};
use coinmc_calibrate::Observations;
use coinmc_core::Scene;
use coinmc_questions::Workers;
use std::f64::consts::TAU;

/// Sine of the lean up to which the pitch of a whirring coin is read.
const MOST_SINE: f64 = 0.4;
/// Lowest pitch that is read without knowing the coin: about that of a coin of 24 mm.
const USUAL_HZ: f64 = 14.0;
/// Share of clipped samples that is remarked on, and the share with which nothing is made of a recording.
const CLIPPED: [f64; 2] = [0.001, 0.1];

/// Fewer bounces than this are remarked on.
const FEW: usize = 3;

/// What a recording is taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A coin that whirrs as it settles.
    Whirr,
    /// A coin that was dropped.
    Drop,
}

/// What is heard in one recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Heard {
    /// Name of the recording.
    pub name: String,
    /// Its length, s.
    pub seconds: f64,
    /// Its samples a second.
    pub rate_hz: f64,
    /// Bits of a sample.
    pub bits: u16,
    /// The channel heard, from 1, and how many there are.
    pub channel: [u16; 2],
    /// Share of clipped samples.
    pub clipped: f64,
    /// Its onsets.
    pub onsets: Onsets,
    /// Its bounces, or why it has none.
    pub bounces: Result<Bounces, NoBounces>,
    /// Its whirr, or why it has none.
    pub whirr: Result<Whirr, NoWhirr>,
    /// What it is taken for; `None` if no coin is heard.
    pub kind: Option<Kind>,
    /// What is odd about it.
    pub doubts: Vec<String>,
}

impl Heard {
    /// Listens to a recording. The scene says at which pitch a coin begins to whirr; `as_kind` what it is known
    /// to be.
    pub fn of(recording: &Recording, scene: Option<&Scene>, as_kind: Option<Kind>) -> Self {
        let onsets = Onsets::of(recording);
        let bounces = Bounces::of(&onsets);
        let whirr = Whirr::of(recording, scene.map_or(USUAL_HZ, least_pitch_hz));
        let is = |kind: Kind| as_kind.is_none_or(|known| known == kind);
        let kind = if recording.clipped > CLIPPED[1] {
            None
        } else if whirr.is_ok() && is(Kind::Whirr) {
            Some(Kind::Whirr)
        } else if bounces.is_ok() && is(Kind::Drop) {
            Some(Kind::Drop)
        } else {
            None
        };
        let mut doubts = vec![];
        if recording.clipped > CLIPPED[0] {
            let percent = 100.0 * recording.clipped;
            doubts.push(format!("{percent:.1} % of the samples are clipped"));
        }
        if let (Some(Kind::Drop), Ok(bounces)) = (kind, &bounces)
            && bounces.others > 0
        {
            let others = bounces.others;
            doubts.push(format!(
                "{others} as loud sounds before or after the bounces are left out"
            ));
        }
        if let (Some(Kind::Drop), Ok(bounces)) = (kind, &bounces)
            && bounces.times_s.len() < FEW
        {
            doubts.push("only two bounces are heard, which other sounds may be as well".to_owned());
        }
        Self {
            name: recording.name.clone(),
            seconds: recording.seconds(),
            rate_hz: recording.rate_hz,
            bits: recording.bits,
            channel: recording.channel,
            clipped: recording.clipped,
            onsets,
            bounces,
            whirr,
            kind,
            doubts,
        }
    }

    /// Why no coin is heard; `None` if one is.
    pub fn silence(&self) -> Option<String> {
        if self.kind.is_some() {
            return None;
        }
        if self.clipped > CLIPPED[1] {
            let percent = 100.0 * self.clipped;
            return Some(format!(
                "{percent:.0} % of its samples are clipped: record farther away"
            ));
        }
        let drop = self.bounces.as_ref().err().map(ToString::to_string);
        let spin = self.whirr.as_ref().err().map(ToString::to_string);
        let both: Vec<String> = [("drop", drop), ("spin", spin)]
            .into_iter()
            .filter_map(|(kind, why)| Some(format!("as a {kind}, {}", why?)))
            .collect();
        Some(both.join("; "))
    }
}

/// The pitch of a coin that leans so much that it only begins to whirr.
fn least_pitch_hz(scene: &Scene) -> f64 {
    let kt = scene.coin.transverse_gyration_m2();
    (scene.gravity_m_s2() * scene.coin.radius_m() / (kt * MOST_SINE)).sqrt() / TAU
}

/// The rolling friction length that a whirr tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingFriction {
    /// ρ_c, m.
    pub length_m: f64,
    /// Its standard error, m.
    pub error_m: f64,
}

/// What recordings tell of the surface of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// By drops.
    pub drops: Option<FromDrops>,
    /// By whirrs.
    pub whirrs: Option<RollingFriction>,
    /// What is odd about the whirrs.
    pub doubts: Vec<String>,
}

impl Told {
    /// Puts everything that is heard together.
    ///
    /// # Errors
    /// [`ListenError`] if the scene makes no tosses that can be heard, or these are stopped.
    pub fn of(
        heard: &[Heard],
        observed: &Observations,
        effort: Effort,
        workers: &Workers<'_>,
    ) -> Result<Self, ListenError> {
        let is = |kind: Kind| heard.iter().filter(move |heard| heard.kind == Some(kind));
        let drops: Vec<Bounces> = is(Kind::Drop)
            .filter_map(|heard| heard.bounces.clone().ok())
            .collect();
        let drops = if drops.is_empty() {
            None
        } else {
            Some(FromDrops::of(&drops, observed, effort, workers)?)
        };
        let mut logs = vec![];
        let mut doubts = vec![];
        for heard in is(Kind::Whirr) {
            let Ok(whirr) = &heard.whirr else { continue };
            match rolling_friction(whirr, observed, effort.seed, workers)? {
                Some(found) => logs.push(found),
                None => doubts.push(format!(
                    "no coin of the config whirrs like {}: are coin and prior right?",
                    heard.name
                )),
            }
        }
        Ok(Self {
            drops,
            whirrs: together(&logs),
            doubts,
        })
    }
}

/// The weighted mean of ln ρ_c with their errors. What the surface leaves open is the same for all recordings, so
/// several do not lessen the error by more than the half.
fn together(logs: &[(f64, f64)]) -> Option<RollingFriction> {
    let each = || {
        logs.iter()
            .map(|(log, error)| (*log, 1.0 / (error * error)))
    };
    let total: f64 = each().map(|(_, weight)| weight).sum();
    if total <= 0.0 {
        return None;
    }
    let mean = each().map(|(log, weight)| weight * log).sum::<f64>() / total;
    let misfit: f64 = each()
        .map(|(log, weight)| weight * (log - mean) * (log - mean))
        .sum();
    let degrees = (logs.len() - 1).max(1) as f64;
    let least = 4.0 * total / logs.len() as f64;
    let share = ((misfit / degrees).max(1.0) / total.min(least)).sqrt();
    let length_m = libm::exp(mean);
    Some(RollingFriction {
        length_m,
        error_m: share * length_m,
    })
}
