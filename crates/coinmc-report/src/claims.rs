//! The page of a validation: claims, data sets, and what could not be validated. It needs no program.

use crate::html::{still, text};
use serde_json::Value;

/// A p-value below this is told as such.
const LEAST_P: f64 = 1e-12;

/// The page of a validation, from the document that `coinmc validate --format json` prints.
///
/// # Example
/// ```
/// use serde_json::json;
/// let claim = json!({
///     "name": "mass", "family": "paper", "statement": "P(side) < 1", "verdict": "holds", "condition": null,
///     "evidence": [{ "what": "P(side)", "value": 0.25, "lo": 0.2, "hi": 0.3, "tosses": 1000 }],
/// });
/// let page = coinmc_report::claims(&json!({ "claims": [claim], "sets": [] }));
/// assert!(page.contains("P(side) &lt; 1") && !page.contains("<script"));
/// ```
pub fn claims(document: &Value) -> String {
    let mut body = String::from("<header><h1>Validation</h1></header>\n");
    body += &summary(document);
    body += &of_family(
        document,
        "paper",
        "Claims of Gaek & Sukhov, arXiv 2401.03557",
    );
    body += &of_family(
        document,
        "engines",
        "Engines and laws against each other, on the same launches",
    );
    body += &of_sets(document);
    still("Validation", &body)
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map_or(&[], Vec::as_slice)
}

fn words(value: &Value) -> String {
    text(value.as_str().unwrap_or_default())
}

fn summary(document: &Value) -> String {
    let prior = &document["prior"];
    format!(
        "<p class=\"lead\">Mode {}, seed {}: {} of {} predicted data sets are not rejected at {} %. Intervals \
         are 95 %.</p>\n<p>Prior: {}. {} draws, {} tosses of each coin by each.</p>\n",
        words(&document["mode"]),
        document["seed"],
        document["not_rejected"],
        document["predicted"],
        100.0 * document["level"].as_f64().unwrap_or(f64::NAN),
        words(&prior["text"]),
        prior["draws"],
        prior["tosses_of_draw"],
    )
}

fn of_family(document: &Value, family: &str, title: &str) -> String {
    let claims: Vec<_> = list(document, "claims")
        .iter()
        .filter(|claim| claim["family"] == family)
        .collect();
    if claims.is_empty() {
        return String::new();
    }
    let rows: String = claims.iter().map(|claim| of_claim(claim)).collect();
    format!("<section><h2>{}</h2>\n{rows}</section>\n", text(title))
}

fn of_claim(claim: &Value) -> String {
    let condition = match claim["condition"].as_str() {
        Some(condition) => format!(" {}", text(condition)),
        None => String::new(),
    };
    let rows: String = list(claim, "evidence").iter().map(of_evidence).collect();
    let details = if rows.is_empty() {
        String::new()
    } else {
        let table = table(&["what", "is", "95 % interval", "tosses"], &rows);
        format!("<details><summary>Evidence</summary>{table}</details>\n")
    };
    format!(
        "<h3>{0}: {1}</h3>\n<p><strong>{2}</strong>{condition}</p>\n{details}",
        words(&claim["name"]),
        words(&claim["statement"]),
        words(&claim["verdict"]),
    )
}

fn of_evidence(evidence: &Value) -> String {
    row(&[
        words(&evidence["what"]),
        number(&evidence["value"]),
        interval(evidence),
        tosses(&evidence["tosses"]),
    ])
}

fn of_sets(document: &Value) -> String {
    let (others, predicted): (Vec<_>, Vec<_>) = list(document, "sets")
        .iter()
        .partition(|set| set["p_value"].is_null());
    let predicted: String = predicted.into_iter().map(of_predicted).collect();
    let others: String = others.into_iter().map(of_other).collect();
    let section = |title: &str, body: &str, empty: bool| {
        if empty {
            String::new()
        } else {
            format!("<section><h2>{title}</h2>\n{body}</section>\n")
        }
    };
    let list = format!("<ul>{others}</ul>");
    section("Public data sets", &predicted, predicted.is_empty())
        + &section("Not validated", &list, others.is_empty())
}

fn of_predicted(set: &Value) -> String {
    let [name, doc, source, stated, verdict] =
        ["name", "doc", "source", "stated", "verdict"].map(|key| words(&set[key]));
    let titles = [
        "number",
        "published",
        "of tosses",
        "predicted",
        "95 % of draws",
        "p-value",
    ];
    let lines: String = list(set, "lines").iter().map(of_line).collect();
    format!(
        "<h3>{name}: {doc}</h3>\n<p><strong>{verdict}</strong>, p = {}</p>\n\
         <p class=\"faint\">{source}. Stated: {stated}</p>\n{}",
        p_value(set),
        table(&titles, &lines)
    )
}

fn of_other(set: &Value) -> String {
    let [name, doc, source, condition] =
        ["name", "doc", "source", "condition"].map(|key| words(&set[key]));
    format!("<li>{name}: {doc} ({source}): {condition}</li>\n")
}

fn of_line(line: &Value) -> String {
    row(&[
        match words(&line["name"]) {
            name if name.is_empty() => words(&line["quantity"]),
            name => format!("{}, {name}", words(&line["quantity"])),
        },
        number(&line["seen"]),
        tosses(&line["seen_tosses"]),
        number(&line["predicted"]),
        interval(line),
        p_value(line),
    ])
}

fn table(titles: &[&str], rows: &str) -> String {
    let cell = |title: &&str| format!("<th>{}</th>", text(title));
    let titles = titles.iter().map(cell).collect::<Vec<_>>().concat();
    format!(
        "<div class=\"scroll\"><table><thead><tr>{titles}</tr></thead>\n<tbody>{rows}</tbody></table></div>\n"
    )
}

/// Cells that are HTML already.
fn row(cells: &[String]) -> String {
    format!("<tr><td>{}</td></tr>\n", cells.join("</td><td>"))
}

fn number(value: &Value) -> String {
    let Some(x) = value.as_f64() else {
        return String::new();
    };
    if x == 0.0 || x.abs() >= 1e-3 {
        format!("{x:.4}")
    } else {
        format!("{x:.1e}")
    }
}

fn interval(value: &Value) -> String {
    if value["lo"].is_null() {
        return String::new();
    }
    format!("[{}, {}]", number(&value["lo"]), number(&value["hi"]))
}

fn tosses(value: &Value) -> String {
    match value.as_u64() {
        Some(n) if n > 0 => n.to_string(),
        _ => String::new(),
    }
}

fn p_value(of: &Value) -> String {
    let p = match of["p_value"].as_f64() {
        Some(p) if p < LEAST_P => format!("&lt; {LEAST_P:e}"),
        _ => number(&of["p_value"]),
    };
    match of["p_error"].as_f64() {
        Some(error) if error >= 5e-4 && of["p_value"] != 1.0 => format!("{p} ± {error:.3}"),
        _ => p,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const HOSTILE: &str = "</main><script>alert(1)</script> & \"";

    #[test]
    fn no_text_becomes_html() {
        let line = json!({ "name": HOSTILE, "quantity": HOSTILE, "seen": 0.5, "p_value": 0.2 });
        let set = json!({
            "name": HOSTILE, "doc": HOSTILE, "source": HOSTILE, "stated": HOSTILE, "verdict": HOSTILE,
            "condition": HOSTILE, "p_value": 0.2, "lines": [line],
        });
        let mut other = set.clone();
        other["p_value"] = Value::Null;
        let claim = json!({
            "name": HOSTILE, "family": "paper", "statement": HOSTILE, "verdict": HOSTILE,
            "condition": HOSTILE, "evidence": [{ "what": HOSTILE, "value": 1.0 }],
        });
        let document = json!({
            "mode": HOSTILE, "prior": { "text": HOSTILE }, "claims": [claim], "sets": [set, other],
        });
        let page = claims(&document);
        assert!(!page.contains("<script") && page.matches("</main>").count() == 1);
        assert!(page.contains("&lt;script&gt;"));
        // each of its texts is there
        assert_eq!(page.matches("alert(1)").count(), 18, "{page}");
    }
}
