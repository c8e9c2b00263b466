//! The lines exchanged between host and camera.

use crate::Face;
use crate::journal::ImageName;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Longest line that a camera may send, bytes.
pub const LONGEST_LINE: usize = 1 << 16;

/// Requests of the host.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Request {
    /// Take a photo.
    Take(Take),
    /// Classify the photo in this file.
    Classify(PathBuf),
}

/// A photo to take, and where to save it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Take {
    /// Id of the throw on the link.
    #[serde(rename = "throw")]
    pub throw_id: u32,
    /// Number of the photo of this throw, from 1.
    pub attempt: u32,
    /// Folder for the photo; absolute.
    pub folder: PathBuf,
    /// File name, without an extension.
    pub name: String,
}

/// A reply; other fields are ignored.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
pub(super) struct CameraReply {
    image: Option<PathBuf>,
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
    /// Parses a line.
    pub(super) fn read(line: &[u8]) -> Result<Self, String> {
        let answer: Self = serde_json::from_slice(line).map_err(|error| error.to_string())?;
        match answer.error {
            Some(error) => Err(error.chars().take(200).collect()),
            None => Ok(answer),
        }
    }

    /// The photo's name, if it is in the requested folder.
    pub(super) fn image(&self, folder: &Path) -> Result<ImageName, String> {
        let image = self.image.as_ref().ok_or("no `image` in its reply")?;
        let name = image.strip_prefix(folder).unwrap_or(image);
        let name = name.to_str().ok_or("an image's name that is not text")?;
        name.parse().map_err(|_| {
            format!(
                "the image `{}`, which is not a file name in the given folder",
                name.escape_debug()
            )
        })
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

    #[test]
    fn requests_are_the_documented_lines() {
        let take = Request::Take(Take {
            throw_id: 12,
            attempt: 1,
            folder: "/data/photos".into(),
            name: "000012-1".into(),
        });
        let text = r#"{"take":{"throw":12,"attempt":1,"folder":"/data/photos","name":"000012-1"}}"#;
        assert_eq!(serde_json::to_string(&take).unwrap(), text);
        let classify = Request::Classify("/data/photos/000012-1.png".into());
        let text = r#"{"classify":"/data/photos/000012-1.png"}"#;
        assert_eq!(serde_json::to_string(&classify).unwrap(), text);
    }

    #[test]
    fn images_stay_in_their_folder_and_none_means_no_face() {
        let answer = |text: &str| CameraReply::read(text.as_bytes()).unwrap();
        let folder = Path::new("/data/photos");
        for good in [
            r#"{"image":"a-1.png"}"#,
            r#"{"image":"/data/photos/a-1.png","x":[1]}"#,
        ] {
            assert_eq!(answer(good).image(folder).unwrap().as_str(), "a-1.png");
        }
        for bad in [
            r#"{"image":"../a.png"}"#,
            r#"{"image":"/etc/passwd"}"#,
            r#"{"image":"a b.png"}"#,
            r#"{"image":""}"#,
            r#"{"face":"heads"}"#,
        ] {
            assert!(answer(bad).image(folder).is_err(), "{bad}");
        }
        assert_eq!(answer(r#"{"face":"none"}"#).shown(), Ok(Shown::Nothing));
        assert_eq!(
            answer(r#"{"face":"side"}"#).shown(),
            Ok(Shown::Face(Face::Side))
        );
        for bad in [
            r#"{"face":"edge"}"#,
            r#"{"face":"Heads"}"#,
            r#"{"image":"x"}"#,
        ] {
            assert!(answer(bad).shown().is_err(), "{bad}");
        }
        assert_eq!(
            CameraReply::read(br#"{"error":"too dark"}"#),
            Err("too dark".to_owned())
        );
        assert!(CameraReply::read(b"heads").is_err());
    }
}
