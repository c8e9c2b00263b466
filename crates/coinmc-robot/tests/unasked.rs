//! A camera that speaks unasked, at the worst moment.
#![cfg(unix)]

use coinmc_robot::camera::{Camera, CameraOptions};
use std::collections::HashSet;
use std::time::Duration;

/// It answers correctly, and says a face 30 ms later, before it has been asked for one: by then the host
/// waits for the answer to its next request.
const EARLY: &str = r#"while read -r line; do
r=$(echo "$line" | sed 's/.*"request":\([0-9]*\).*/\1/'); about="\"throw\":0,\"attempt\":1,\"request\":$r"
case $line in
*take*) echo frame > "$FOLDER/test-1.png"; echo "{$about,\"image\":\"test-1.png\"}"
sleep 0.03; echo "{$about,\"face\":\"tails\"}";;
*) sleep 2; echo "{$about,\"face\":\"heads\"}";;
esac; done"#;

#[test]
fn a_line_that_came_unasked_is_not_the_answer_to_the_next_request() {
    let folder = tempfile::tempdir().unwrap();
    let failure = Camera::start(CameraOptions {
        command: format!("FOLDER='{}'; {EARLY}", folder.path().display()),
        folder: folder.path().to_owned(),
        log: None,
        timeout: Duration::from_secs(9),
        seen: HashSet::new(),
    });
    let said = failure
        .expect_err("a face that nobody asked for")
        .to_string();
    // on a busy machine the host sees it before it asks again
    let seen = ["it came unasked", "a line without a request"];
    assert!(seen.iter().any(|words| said.contains(words)), "{said}");
}
