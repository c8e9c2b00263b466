//! The lines exchanged between host and camera.

use crate::Face;
use crate::journal::ImageName;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Longest line that a camera may send, bytes.
pub const LONGEST_LINE: usize = 1 << 16;

/// Requests of the host.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Request {
    /// Take a photo.
    Take {
        /// Which, and where to.
        take: Take,
    },
    /// Classify a photo.
    Classify(Classify),
}

/// A photo to take, and where to save it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Take {
    /// Id of the throw on the link; 0 for the test photo before the first throw.
    #[serde(rename = "throw")]
    pub throw_id: u32,
    /// Number of the photo of this throw, from 1.
    pub attempt: u32,
    /// Number of the request, another one every time: nobody can answer before it was asked.
    pub request: u32,
    /// Folder for the photo; absolute.
    pub folder: PathBuf,
    /// File name, without an extension.
    pub name: String,
}

/// A photo to classify.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Classify {
    /// Its file; absolute.
    pub classify: PathBuf,
    /// As in the request to take it.
    #[serde(rename = "throw")]
    pub throw_id: u32,
    /// As in the request to take it.
    pub attempt: u32,
    /// Number of this request.
    pub request: u32,
}

/// What a request is about: its reply must repeat it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct About {
    pub(super) throw_id: u32,
    pub(super) attempt: u32,
    pub(super) request: u32,
}

impl Request {
    /// What the reply must repeat.
    pub(super) fn about(&self) -> About {
        let (throw_id, attempt, request) = match self {
            Self::Take { take } => (take.throw_id, take.attempt, take.request),
            Self::Classify(photo) => (photo.throw_id, photo.attempt, photo.request),
        };
        About {
            throw_id,
            attempt,
            request,
        }
    }
}

/// A reply; other fields are ignored.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
pub(super) struct CameraReply {
    #[serde(rename = "throw")]
    throw_id: Option<u32>,
    attempt: Option<u32>,
    request: Option<u32>,
    image: Option<PathBuf>,
    /// When the picture was exposed, ms since 1970, if the camera knows.
    taken_ms: Option<u64>,
    face: Option<String>,
    error: Option<String>,
}

/// The content of a photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    Face(Face),
    /// No face that the camera can read with confidence.
    Nothing,
}

impl CameraReply {
    /// Parses a line, which must repeat what the request is about.
    pub(super) fn read(line: &[u8], asked: About) -> Result<Self, String> {
        let answer: Self = serde_json::from_slice(line).map_err(|error| error.to_string())?;
        if let Some(error) = answer.error {
            return Err(error.chars().take(200).collect());
        }
        let (Some(throw_id), Some(attempt), Some(request)) =
            (answer.throw_id, answer.attempt, answer.request)
        else {
            return Err(
                "an answer without `throw`, `attempt` and `request`: it must repeat those of the \
                 request"
                    .to_owned(),
            );
        };
        if (throw_id, attempt) != (asked.throw_id, asked.attempt) {
            return Err(format!(
                "an answer about throw {throw_id}, photo {attempt}, but it was asked about throw {}, \
                 photo {}",
                asked.throw_id, asked.attempt
            ));
        }
        if request != asked.request {
            return Err(format!(
                "an answer to request {request}, but the last one was {}: it came unasked",
                asked.request
            ));
        }
        Ok(answer)
    }

    /// The photo's name, if it is the one asked for, with any extension, in the requested folder.
    pub(super) fn image(&self, folder: &Path, asked: &str) -> Result<ImageName, String> {
        let image = self.image.as_ref().ok_or("no `image` in its reply")?;
        let name = image.strip_prefix(folder).unwrap_or(image);
        let name = name.to_str().ok_or("an image's name that is not text")?;
        let extension = name.strip_prefix(asked).and_then(|e| e.strip_prefix('.'));
        let plain = |e: &str| {
            (1..=8).contains(&e.len()) && e.bytes().all(|byte| byte.is_ascii_alphanumeric())
        };
        let wrong = || {
            format!(
                "the image `{}`, but it was asked for `{asked}` with an extension in the given folder",
                name.escape_debug()
            )
        };
        extension.filter(|e| plain(e)).ok_or_else(wrong)?;
        name.parse().map_err(|_| wrong())
    }

    /// Checks that the picture was exposed since `asked_ms`, if the camera says when.
    pub(super) fn check_time(&self, asked_ms: u64, now_ms: u64) -> Result<(), String> {
        match self.taken_ms {
            Some(taken) if !(asked_ms..=now_ms).contains(&taken) => Err(format!(
                "a picture of the time {taken} ms, but it was asked for at {asked_ms} ms: an old frame"
            )),
            _ => Ok(()),
        }
    }

    pub(super) fn shown(&self) -> Result<Shown, String> {
        let face = self.face.as_deref().ok_or("no `face` in its reply")?;
        let known = Face::ALL.into_iter().find(|known| known.name() == face);
        match (known, face) {
            (Some(face), _) => Ok(Shown::Face(face)),
            (None, "none") => Ok(Shown::Nothing),
            _ => Err("a face other than heads, tails, side or none".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(request: u32) -> About {
        About {
            throw_id: 12,
            attempt: 1,
            request,
        }
    }

    #[test]
    fn requests_are_the_documented_lines() {
        let take = Take {
            throw_id: 12,
            attempt: 1,
            request: 23,
            folder: "/data/photos".into(),
            name: "000012-1".into(),
        };
        let text = r#"{"take":{"throw":12,"attempt":1,"request":23,"folder":"/data/photos","name":"000012-1"}}"#;
        let take = Request::Take { take };
        assert_eq!(serde_json::to_string(&take).unwrap(), text);
        assert_eq!(serde_json::from_str::<Request>(text).unwrap(), take);
        let classify = Request::Classify(Classify {
            classify: "/data/photos/000012-1.png".into(),
            throw_id: 12,
            attempt: 1,
            request: 24,
        });
        let text =
            r#"{"classify":"/data/photos/000012-1.png","throw":12,"attempt":1,"request":24}"#;
        assert_eq!(serde_json::to_string(&classify).unwrap(), text);
        assert_eq!(serde_json::from_str::<Request>(text).unwrap(), classify);
        assert_eq!((take.about(), classify.about()), (about(23), about(24)));
    }

    #[test]
    fn answers_are_about_the_photo_that_was_asked_for() {
        let read = |text: &str| CameraReply::read(text.as_bytes(), about(24));
        assert!(read(r#"{"throw":12,"attempt":1,"request":24,"face":"heads"}"#).is_ok());
        for bad in [
            r#"{"face":"heads"}"#,
            r#"{"throw":12,"request":24,"face":"heads"}"#,
            r#"{"throw":12,"attempt":1,"face":"heads"}"#,
            r#"{"throw":11,"attempt":1,"request":24,"face":"heads"}"#,
            r#"{"throw":12,"attempt":2,"request":24,"face":"heads"}"#,
            // a second line of the answer to the request to take it, which arrives late
            r#"{"throw":12,"attempt":1,"request":23,"face":"heads"}"#,
            "heads",
        ] {
            assert!(read(bad).is_err(), "{bad}");
        }
        assert_eq!(
            read(r#"{"error":"too dark"}"#),
            Err("too dark".to_owned()),
            "an error needs no echo: it gives no face"
        );
    }

    #[test]
    fn images_have_the_name_asked_for_and_none_means_no_face() {
        let answer = |more: &str| {
            let text = format!(r#"{{"throw":12,"attempt":1,"request":24,{more}}}"#);
            CameraReply::read(text.as_bytes(), about(24)).unwrap()
        };
        let folder = Path::new("/data/photos");
        for good in [
            r#""image":"000012-1.png""#,
            r#""image":"/data/photos/000012-1.png","x":[1]"#,
        ] {
            let image = answer(good).image(folder, "000012-1").unwrap();
            assert_eq!(image.as_str(), "000012-1.png");
        }
        for bad in [
            r#""image":"../000012-1.png""#,
            r#""image":"/etc/passwd""#,
            r#""image":"000012-1""#,
            r#""image":"000012-1.a/b""#,
            r#""image":"000011-1.png""#,
            r#""image":"000012-10.png""#,
            r#""image":"""#,
            r#""face":"heads""#,
        ] {
            assert!(answer(bad).image(folder, "000012-1").is_err(), "{bad}");
        }
        assert_eq!(answer(r#""face":"none""#).shown(), Ok(Shown::Nothing));
        assert_eq!(
            answer(r#""face":"side""#).shown(),
            Ok(Shown::Face(Face::Side))
        );
        for bad in [r#""face":"edge""#, r#""face":"Heads""#, r#""image":"x""#] {
            assert!(answer(bad).shown().is_err(), "{bad}");
        }
        let timed = answer(r#""image":"000012-1.png","taken_ms":1000"#);
        assert!(timed.check_time(1000, 1100).is_ok() && timed.check_time(900, 1000).is_ok());
        assert!(timed.check_time(1001, 1100).is_err() && timed.check_time(1, 999).is_err());
    }
}
