//! New files whose names say what is in them.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc_recording::NewFile;
use std::path::Path;

/// Begins the file that was asked for, if one was: of the format that its name ends in.
pub(super) fn begin(path: Option<&Path>, ending: &str) -> Result<Option<NewFile>, Failure> {
    let Some(path) = path else {
        return Ok(None);
    };
    must_end_in(path, ending)?;
    Ok(Some(NewFile::begin(path)?))
}

/// Refuses a name that promises another format, so that no picture.png holds what no viewer of PNG reads.
pub(super) fn must_end_in(path: &Path, ending: &str) -> Result<(), Failure> {
    let found = path.extension().and_then(|found| found.to_str());
    if found.is_some_and(|found| found.eq_ignore_ascii_case(ending)) {
        return Ok(());
    }
    Err(Failure::Input(anyhow!(
        "{}: the name must end in .{ending}, the format that is written",
        path.display()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_formats_are_refused_before_a_file_is_made() {
        let dir = tempfile::tempdir().expect("a directory");
        for name in ["x.png", "x", "svg", ".svg", "x.svg.gz"] {
            let refused = begin(Some(&dir.path().join(name)), "svg").expect_err(name);
            assert!(refused.message().contains("must end in .svg"), "{name}");
        }
        assert_eq!(dir.path().read_dir().expect("its files").count(), 0);
        assert!(begin(Some(&dir.path().join("x.SVG")), "svg").is_ok());
        assert!(begin(None, "svg").is_ok_and(|file| file.is_none()));
    }
}
