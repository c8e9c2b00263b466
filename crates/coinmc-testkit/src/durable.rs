//! A file system that forgets what was not synced: what a loss of power could take away from a process,
//! judged by its system calls.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The environment variable that tells the child where to work.
pub const PLACE: &str = "COINMC_TEST_DURABLE";

/// The system calls that matter.
const CALLS: &str = "trace=openat,mkdir,mkdirat,write,writev,pwrite64,ftruncate,fsync,fdatasync,\
                     rename,renameat,renameat2,unlink,unlinkat";

/// What a directory's files must survive.
#[derive(Debug, Clone, Copy)]
pub struct Promise<'a> {
    /// The directory.
    pub root: &'a Path,
    /// Names of files each write to which is synced before the next one.
    pub by_the_line: &'a [&'a str],
    /// Names of files that a loss of power may take.
    pub expendable: &'a [&'a str],
}

impl Promise<'_> {
    /// Runs one test of this program once more, in a process of its own that finds `root` in [`PLACE`],
    /// and lists where a loss of power could break the promise. `None`, with the reason on the standard
    /// error, where system calls cannot be watched.
    ///
    /// # Panics
    /// If that test fails.
    pub fn broken_by(&self, test: &str) -> Option<Vec<String>> {
        let works = Command::new("strace")
            .args(["-o", "/dev/null", "true"])
            .output();
        if !works.is_ok_and(|output| output.status.success()) {
            eprintln!("skipped: strace is not installed, or may not watch (apt install strace)");
            return None;
        }
        let mut system = Forgetful::new(self);
        let log = tempfile::NamedTempFile::new().expect("a temporary file");
        let child = Command::new("strace")
            .args(["-f", "-y", "-s", "0", "-e", CALLS, "-o"])
            .arg(log.path())
            .arg(std::env::current_exe().expect("this program has a path"))
            .args([test, "--exact", "--test-threads=1"])
            .env(PLACE, self.root)
            .output()
            .expect("strace starts");
        let said = String::from_utf8_lossy(&child.stdout);
        assert!(
            child.status.success() && said.contains("1 passed"),
            "{said}"
        );
        let log = std::fs::read_to_string(log.path()).expect("strace wrote its log");
        for line in log.lines() {
            system.call(line);
        }
        Some(system.end())
    }
}

struct Forgetful<'a> {
    promise: &'a Promise<'a>,
    /// Files that are there.
    known: BTreeSet<PathBuf>,
    /// Files with content that is not on the disk.
    dirty: BTreeSet<PathBuf>,
    /// Files and directories with names that are not on the disk.
    unnamed: BTreeSet<PathBuf>,
    /// Files that were written.
    written: BTreeSet<PathBuf>,
    broken: Vec<String>,
}

impl<'a> Forgetful<'a> {
    fn new(promise: &'a Promise<'a>) -> Self {
        let there = std::fs::read_dir(promise.root).into_iter().flatten();
        Self {
            promise,
            known: there.flatten().map(|entry| entry.path()).collect(),
            dirty: BTreeSet::new(),
            unnamed: BTreeSet::new(),
            written: BTreeSet::new(),
            broken: Vec::new(),
        }
    }

    /// Takes a line like `77 fsync(4</tmp/run/tallies.txt>) = 0`.
    fn call(&mut self, line: &str) {
        let line = line
            .trim_start_matches(|c: char| c.is_ascii_digit())
            .trim_start();
        let Some((name, arguments)) = line.split_once('(') else {
            return;
        };
        if arguments.contains(") = -1 ") {
            return;
        }
        let quoted: Vec<&str> = arguments.split('"').skip(1).step_by(2).collect();
        let open = arguments
            .split_once('<')
            .and_then(|(_, rest)| rest.split_once('>'));
        let open = open.map(|(path, _)| PathBuf::from(path));
        match (name, open, &quoted[..]) {
            ("openat", _, [path]) if arguments.contains("O_CREAT") => self.create(Path::new(path)),
            ("mkdir" | "mkdirat", _, [path]) => self.create(Path::new(path)),
            ("write" | "writev" | "pwrite64" | "ftruncate", Some(path), _) => self.write(&path),
            ("fsync" | "fdatasync", Some(path), _) => self.sync(&path),
            ("rename" | "renameat" | "renameat2", _, [from, to]) => {
                self.rename(Path::new(from), Path::new(to));
            }
            ("unlink" | "unlinkat", _, [path]) => self.remove(Path::new(path)),
            _ => {}
        }
    }

    fn concerns(&self, path: &Path) -> bool {
        let is_among = |names: &[&str]| names.iter().any(|name| path.ends_with(name));
        path.starts_with(self.promise.root) && !is_among(self.promise.expendable)
    }

    fn create(&mut self, path: &Path) {
        if self.concerns(path) && self.known.insert(path.to_owned()) {
            self.unnamed.insert(path.to_owned());
        }
    }

    fn write(&mut self, path: &Path) {
        let by_the_line = self
            .promise
            .by_the_line
            .iter()
            .any(|name| path.ends_with(name));
        let again = !self.written.insert(path.to_owned());
        if by_the_line && again && self.unnamed.contains(path) {
            let broken = format!("{} went on before its name was safe", path.display());
            self.broken.push(broken);
        }
        if self.concerns(path) && !self.dirty.insert(path.to_owned()) && by_the_line {
            self.broken
                .push(format!("{} went on without a sync", path.display()));
        }
    }

    fn sync(&mut self, path: &Path) {
        self.dirty.remove(path);
        self.unnamed.retain(|file| file.parent() != Some(path));
    }

    fn rename(&mut self, from: &Path, to: &Path) {
        if self.dirty.remove(from) {
            self.broken.push(format!(
                "{} took its name before its content was safe",
                to.display()
            ));
        }
        self.remove(from);
        if self.concerns(to) {
            self.known.insert(to.to_owned());
            self.unnamed.insert(to.to_owned());
        }
    }

    fn remove(&mut self, path: &Path) {
        self.known.remove(path);
        self.dirty.remove(path);
        self.unnamed.remove(path);
    }

    fn end(mut self) -> Vec<String> {
        let content = self
            .dirty
            .iter()
            .map(|path| format!("{}: its content", path.display()));
        let names = self
            .unnamed
            .iter()
            .map(|path| format!("{}: its name", path.display()));
        self.broken.extend(content.chain(names));
        self.broken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(calls: &str) -> Vec<String> {
        let promise = Promise {
            root: Path::new("/no such place/run"),
            by_the_line: &["journal"],
            expendable: &["lock"],
        };
        let mut system = Forgetful::new(&promise);
        for line in calls.lines() {
            system.call(line);
        }
        system.end()
    }

    const CREATED: &str =
        "7 openat(AT_FDCWD</x>, \"/no such place/run/journal\", O_WRONLY|O_CREAT, 0666) = 3\n";
    const WRITTEN: &str = "7 write(3</no such place/run/journal>, \"\"..., 5) = 5\n";
    const SYNCED: &str = "7 fdatasync(3</no such place/run/journal>) = 0\n";
    const NAMED: &str = "7 fsync(4</no such place/run>) = 0\n";

    #[test]
    fn what_is_synced_is_safe() {
        let safe = [CREATED, WRITTEN, SYNCED, NAMED, WRITTEN, SYNCED].concat();
        assert_eq!(broken(&safe), [""; 0]);
        let lock = CREATED.replace("journal", "lock");
        assert_eq!(broken(&lock), [""; 0]);
    }

    #[test]
    fn what_is_not_is_forgotten() {
        for (calls, lost) in [
            ([CREATED, WRITTEN, SYNCED].concat(), "its name"),
            ([CREATED, NAMED, WRITTEN].concat(), "its content"),
            (
                [CREATED, NAMED, WRITTEN, WRITTEN, SYNCED].concat(),
                "went on without",
            ),
        ] {
            let found = broken(&calls);
            assert!(found.len() == 1 && found[0].contains(lost), "{found:?}");
        }
        let failed = SYNCED.replace("= 0", "= -1 EIO (Input/output error)");
        assert_eq!(
            broken(&[CREATED, NAMED, WRITTEN, &failed].concat()).len(),
            1
        );
        let renamed = "7 rename(\"/no such place/run/journal\", \"/no such place/run/b\") = 0\n";
        let found = broken(&[CREATED, WRITTEN, renamed, NAMED].concat());
        assert!(
            found.len() == 1 && found[0].contains("before its content"),
            "{found:?}"
        );
    }
}
