//! An answer as a JSON document: what the command line prints.

use crate::{Atlas, Counts, Faces, Launch, Place, Root};
use coinmc_core::{Estimate, Face, IntervalMethod};
use serde_json::{Map, Value, json};

/// Version of the document. It stays when fields are added.
const FORMAT_VERSION: u32 = 1;
/// Confidence of intervals.
const CONFIDENCE: f64 = 0.95;
/// Standard errors within which 95 % of a normal distribution lie.
const Z95: f64 = 1.959_964;

/// What was asked, and the answer.
#[derive(Debug, Clone)]
pub struct Answer {
    /// How the coin is let go.
    pub launch: Launch,
    /// Name of the material.
    pub material: &'static str,
    /// The coin and the surface.
    pub place: Place,
    /// The probabilities.
    pub faces: Faces,
    /// The least ratio at which the side comes up in a third of the tosses.
    pub fair: Option<Root>,
    /// Tosses of this coin, if any were asked for.
    pub counts: Option<Counts>,
}

impl Answer {
    /// The 95 % interval of a face's probability by the atlas.
    pub fn interval(&self, face: Face) -> [f64; 2] {
        let (p, error) = (
            self.faces.p[face as usize],
            Z95 * self.faces.error[face as usize],
        );
        [(p - error).max(0.0), (p + error).min(1.0)]
    }

    /// Half the width of the 95 % interval of the fair ratio.
    pub fn fair_half_width(&self) -> Option<f64> {
        Some(Z95 * self.fair?.error)
    }

    /// The probability of a face by the tosses.
    pub fn tossed(&self, face: Face) -> Option<Estimate> {
        let counts = self.counts?;
        Some(tossed(&counts, face))
    }

    /// The answer as a JSON document. docs/reference/formats.md describes its fields.
    pub fn document(&self, atlas: &Atlas) -> Value {
        let place: Map<String, Value> = self
            .place
            .named()
            .map(|(name, value)| (name.to_owned(), json!(value)))
            .collect();
        let face = |face: Face| {
            let [lo, hi] = self.interval(face);
            json!({
                "face": face.name(),
                "p": self.faces.p[face as usize],
                "error": self.faces.error[face as usize],
                "lo": lo,
                "hi": hi,
            })
        };
        let fair = |root: Root| json!({ "ratio": root.ratio, "error": root.error });
        let tossed = |counts: Counts| {
            let faces = Face::ALL.map(|face| {
                let of = tossed(&counts, face);
                json!({ "face": face.name(), "count": counts.faces[face as usize], "p": of.p, "lo": of.lo, "hi": of.hi })
            });
            json!({ "tosses": counts.tosses(), "undecided": counts.undecided, "faces": faces })
        };
        json!({
            "format_version": FORMAT_VERSION,
            "kind": "ask",
            "launch": self.launch.name(),
            "material": self.material,
            "radius_m": atlas.radius_m(),
            "place": place,
            "confidence": CONFIDENCE,
            "faces": Face::ALL.map(face),
            "fair": self.fair.map(fair),
            "atlas": { "points": atlas.points(), "tosses": atlas.tosses() },
            "tossed": self.counts.map(tossed),
        })
    }
}

/// The probability of a face by counts.
fn tossed(counts: &Counts, face: Face) -> Estimate {
    Estimate::new(
        counts.faces[face as usize],
        counts.undecided,
        counts.tosses(),
        CONFIDENCE,
        IntervalMethod::Wilson,
    )
}
