//! Finding and starting the program under test.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The repository.
///
/// # Panics
/// Never: this package lies in the repository's folder `tests`.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the package lies in the repository")
}

/// The binary: what `COINMC_BIN` names, else one built here and now in the profile of the tests.
///
/// (Cargo tells a package where its *own* binaries are, and this one belongs to another package.)
///
/// # Panics
/// If it cannot be built.
pub fn coinmc() -> &'static Path {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    BINARY.get_or_init(|| {
        let Some(path) = env::var_os("COINMC_BIN") else {
            return build();
        };
        let path = PathBuf::from(path);
        assert!(
            path.is_file(),
            "COINMC_BIN is {}: no such file",
            path.display()
        );
        path
    })
}

/// `cargo build` beside the running test: `target/PROFILE/deps/test` makes `target/PROFILE/coinmc`.
fn build() -> PathBuf {
    let test = env::current_exe().expect("a test knows where it is");
    let folder = test
        .ancestors()
        .nth(2)
        .expect("tests lie in target/PROFILE/deps");
    // The test profile shares the folder `debug`, and its libraries are built already.
    let profile = match folder.file_name().and_then(|name| name.to_str()) {
        Some("debug") | None => "test",
        Some(profile) => profile,
    };
    let status = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args([
            "build",
            "--quiet",
            "--package",
            "coinmc-cli",
            // asks for the features of the libraries that are built already
            "--package",
            "workspace-hack",
            "--bin",
            "coinmc",
        ])
        .args(["--profile", profile])
        .arg("--target-dir")
        .arg(folder.parent().expect("the target directory"))
        .current_dir(root())
        .status()
        .expect("cargo starts");
    assert!(status.success(), "coinmc cannot be built");
    folder.join(format!("coinmc{}", env::consts::EXE_SUFFIX))
}

/// The program, ready to run in `dir` with nothing of the user's environment that changes output.
pub fn command(dir: &Path) -> Command {
    let mut command = Command::new(coinmc());
    plain(&mut command, dir);
    command
}

/// Takes out of a command's environment what changes output.
pub(crate) fn plain(command: &mut Command, dir: &Path) {
    command
        .current_dir(dir)
        .env("COLUMNS", "100")
        .env("LC_ALL", "C.UTF-8");
    command.env_remove("NO_COLOR").env_remove("TERM");
}
