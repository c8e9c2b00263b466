//! Files as they are given: plain ones, each once.

use super::read::MAX_BYTES;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file for [`read`](super::read): at most one more than [`MAX_BYTES`], which shows that it is too long.
///
/// # Errors
/// That the file cannot be read, is a directory, or is no plain file: a pipe would wait for a writer, and a device need
/// not end.
///
/// # Example
/// ```
/// use coinmc_film::text::bytes_of;
/// let error = bytes_of("no/such/file".as_ref()).unwrap_err();
/// assert_eq!(error.kind(), std::io::ErrorKind::NotFound);
/// ```
pub fn bytes_of(path: &Path) -> io::Result<Vec<u8>> {
    // before it is opened, where a pipe would wait
    let kind = fs::metadata(path)?;
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is not a plain file"));
    }
    let mut bytes = Vec::new();
    let file = File::open(path)?;
    file.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The one of some files that is this one, maybe by another name: given twice, a drop would count as two.
///
/// # Example
/// ```
/// use coinmc_film::text::given_before;
/// use std::path::Path;
/// let round = given_before(Path::new("src/../Cargo.toml"), &["README.md", "Cargo.toml"]);
/// assert_eq!(round, Some(Path::new("Cargo.toml")));
/// assert_eq!(given_before(Path::new("Cargo.toml"), &["README.md"]), None);
/// ```
pub fn given_before<'a>(path: &Path, others: &'a [impl AsRef<Path>]) -> Option<&'a Path> {
    // what is not there is told when it is read
    let real = fs::canonicalize(path).ok()?;
    let mut others = others.iter().map(AsRef::as_ref);
    others.find(|other| fs::canonicalize(other).is_ok_and(|other| other == real))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn only_plain_files_are_opened() {
        let error = bytes_of("/dev/null".as_ref()).unwrap_err();
        assert_eq!(error.to_string(), "it is not a plain file");
        let error = bytes_of("src".as_ref()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::IsADirectory);
        assert!(!bytes_of("Cargo.toml".as_ref()).unwrap().is_empty());
    }

    #[test]
    fn a_file_is_known_by_another_name() {
        let before = ["no.toml", "README.md", "Cargo.toml"];
        let found = given_before("src/../Cargo.toml".as_ref(), &before);
        assert_eq!(found, Some(Path::new("Cargo.toml")));
        assert_eq!(given_before("Cargo.toml".as_ref(), &before[..2]), None);
        assert_eq!(given_before("no.toml".as_ref(), &before), None);
    }
}
