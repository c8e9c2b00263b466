//! The list of serial ports.

use serial2::SerialPort;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Where Linux keeps names that stay with a device whichever socket it is plugged into.
const BY_ID: &str = "/dev/serial/by-id";

/// A serial port.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct PortEntry {
    /// The name to use: the stable one, if there is one.
    pub path: PathBuf,
    /// The device that the name refers to now.
    pub device: PathBuf,
    /// Whether the name stays the same when the device is plugged in elsewhere.
    pub stable: bool,
}

/// All serial ports of this machine, those with stable names first.
///
/// # Errors
/// System errors.
pub fn ports() -> io::Result<Vec<PortEntry>> {
    let mut found = stable(Path::new(BY_ID))?;
    for path in SerialPort::available_ports()? {
        let device = fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
        if found.iter().all(|entry| entry.device != device) {
            let stable = false;
            found.push(PortEntry {
                path,
                device,
                stable,
            });
        }
    }
    found.sort_by(|a, b| b.stable.cmp(&a.stable).then_with(|| a.cmp(b)));
    Ok(found)
}

fn stable(folder: &Path) -> io::Result<Vec<PortEntry>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries?,
    };
    let mut found = Vec::new();
    for entry in entries {
        let path = entry?.path();
        // skip links whose device has just disappeared
        if let Ok(device) = fs::canonicalize(&path) {
            let stable = true;
            found.push(PortEntry {
                path,
                device,
                stable,
            });
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn stable_names_resolve_to_their_devices() {
        let dir = tempfile::tempdir().unwrap();
        let device = dir.path().join("ttyUSB7");
        fs::write(&device, "").unwrap();
        let by_id = dir.path().join("by-id");
        fs::create_dir(&by_id).unwrap();
        std::os::unix::fs::symlink("../ttyUSB7", by_id.join("usb-robot")).unwrap();
        std::os::unix::fs::symlink("../gone", by_id.join("usb-other")).unwrap();
        let found = stable(&by_id).unwrap();
        assert_eq!(found.len(), 1);
        assert!(found[0].path.ends_with("usb-robot") && found[0].stable);
        assert_eq!(found[0].device, fs::canonicalize(&device).unwrap());
        assert_eq!(stable(&dir.path().join("nothing")).unwrap(), []);
    }
}
