//! The page around the data: a document that needs nothing but itself.
//!
//! Data stand in the page as JSON, in an element that is not executed. Its `<` are escaped, so that no text
//! in it can end the element. A policy in the page forbids everything but its own program, named by its
//! hash, and its own style: even text that got through could neither run nor load anything.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use sha2::{Digest, Sha256};

const SCRIPT: &str = include_str!("../web/dist/report.js");
const TOSS_SCRIPT: &str = include_str!("../web/dist/toss.js");
const STYLE: &str = include_str!("../web/dist/style.css");
const LICENCES: &str = include_str!("../web/dist/LICENCES.txt");

/// How the element begins that holds a page's data.
const DATA: &str = "<script type=\"application/json\" id=\"data\">";

/// Which program a page needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Program {
    /// Everything.
    Report,
    /// The viewer of tosses alone.
    Toss,
}

impl Program {
    fn script(self) -> &'static str {
        match self {
            Self::Report => SCRIPT,
            Self::Toss => TOSS_SCRIPT,
        }
    }
}

/// The whole document.
pub(crate) fn document(title: &str, data: &Value, program: Program) -> String {
    let script = program.script();
    format!(
        "<!doctype html>\n\
         <html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; \
         script-src '{}'; style-src '{}'; img-src data:; base-uri 'none'; form-action 'none'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta name=\"generator\" content=\"coinmc {}\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <main id=\"page\"><noscript>This page draws its data with JavaScript, which is switched off here. It loads \
         nothing from a network.</noscript></main>\n\
         <footer><details><summary>Licences of the libraries in this page</summary><pre>{}</pre></details></footer>\n\
         {DATA}{}</script>\n\
         <script>{script}</script>\n</body>\n</html>\n",
        hash(script),
        hash(STYLE),
        env!("CARGO_PKG_VERSION"),
        text(title),
        text(LICENCES),
        json(data),
    )
}

/// A document of finished HTML: nothing in it runs.
pub(crate) fn still(title: &str, body: &str) -> String {
    format!(
        "<!doctype html>\n\
         <html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src '{}'; \
         img-src data:; base-uri 'none'; form-action 'none'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta name=\"generator\" content=\"coinmc {}\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>{body}</main>\n</body>\n</html>\n",
        hash(STYLE),
        env!("CARGO_PKG_VERSION"),
        text(title),
    )
}

/// The hashes of the plans whose runs a page of [`report`](crate::report()) shows; none of other pages and texts.
///
/// # Example
/// ```
/// assert!(coinmc_report::plan_hashes("<!doctype html>").is_empty());
/// ```
pub fn plan_hashes(page: &str) -> Vec<String> {
    let data = page.split_once(DATA).and_then(|(_, rest)| {
        let (data, _) = rest.split_once("</script>")?;
        serde_json::from_str::<Value>(data).ok()
    });
    let runs = data.as_ref().and_then(|data| data["runs"].as_array());
    let hashes = runs.into_iter().flatten();
    let hashes = hashes.filter_map(|run| run["plan_hash"].as_str());
    hashes.map(str::to_owned).collect()
}

/// A page inside another one, such as a notebook: a frame that holds the whole document.
///
/// # Example
/// ```
/// let frame = coinmc_report::inner("<p title=\"a\">", 480);
/// assert!(frame.contains("srcdoc=\"<p title=&quot;a&quot;>\""));
/// ```
pub fn inner(document: &str, height_px: u32) -> String {
    let document = document.replace('&', "&amp;").replace('"', "&quot;");
    format!(
        "<iframe title=\"coinmc\" sandbox=\"allow-scripts allow-downloads\" \
         style=\"width:100%;height:{height_px}px;border:0\" srcdoc=\"{document}\"></iframe>"
    )
}

/// How the policy names a program or a style.
fn hash(source: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(source)))
}

/// Text between tags.
pub(crate) fn text(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// JSON that may stand inside a `script` element. Outside of strings JSON has no `<`.
fn json(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const HOSTILE: &str = "</script><!-- <script>alert(1)</script> \u{2028}\"'& ";

    #[test]
    fn no_text_ends_the_element_that_holds_it() {
        let data = json!({ HOSTILE: [HOSTILE] });
        for program in [Program::Report, Program::Toss] {
            let page = document(HOSTILE, &data, program);
            // the data and the program
            assert_eq!(page.matches("</script").count(), 2);
            assert_eq!(page.matches("<script").count(), 2);
            assert!(!page.contains("<!--"));
            let start = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
            let end = start + page[start..].find("</script>").unwrap();
            let read: Value = serde_json::from_str(&page[start..end]).unwrap();
            assert_eq!(read, data);
        }
    }

    #[test]
    fn the_policy_names_what_the_page_holds() {
        let page = document("a", &json!(null), Program::Toss);
        assert!(page.contains(&format!("script-src '{}'", hash(TOSS_SCRIPT))));
        assert!(page.contains("default-src 'none'"));
        for source in [SCRIPT, TOSS_SCRIPT, STYLE] {
            assert!(!source.contains("</script") && !source.contains("</style"));
            // the name of SVG is no address that anything is loaded from
            assert!(
                !source
                    .replace("http://www.w3.org/2000/svg", "")
                    .contains("http")
            );
        }
        for library in ["uPlot", "OGL"] {
            assert!(page.contains(library), "{library}");
        }
    }

    /// The hash of the empty text, known from elsewhere.
    #[test]
    fn hashes_are_as_browsers_compute_them() {
        assert_eq!(
            hash(""),
            "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU="
        );
    }
}
