//! The page of a validation: claims, data sets, and what could not be validated. It needs no program.

use crate::html::{still, text};
use serde_json::Value;

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
        "<p class=\"lead\">{} validation, seed {}: {} of {} predicted data sets are not rejected at {} %. Intervals \
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
    let evidence = list(claim, "evidence");
    let mut told = format!(
        "<h3 id=\"{0}\">{0}: {1}</h3>\n<p><strong>{2}</strong>{condition}</p>\n",
        words(&claim["name"]),
        words(&claim["statement"]),
        words(&claim["verdict"]),
    );
    if !evidence.is_empty() {
        let rows: String = evidence.iter().map(of_evidence).collect();
        told += &format!(
            "<details><summary>Evidence</summary>{}</details>\n",
            table(&["what", "is", "95 % interval", "tosses"], &rows)
        );
    }
    told
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
    let (mut rows, mut others) = (String::new(), String::new());
    for set in list(document, "sets") {
        let name = words(&set["name"]);
        if set["p_value"].is_null() {
            others += &format!(
                "<li>{name}: {} ({}): {}</li>\n",
                words(&set["doc"]),
                words(&set["source"]),
                words(&set["condition"])
            );
            continue;
        }
        rows += &row(&[
            format!("<strong>{name}</strong>"),
            format!(
                "{}. {}. Stated: {}",
                words(&set["doc"]),
                words(&set["source"]),
                words(&set["stated"])
            ),
            String::new(),
            String::new(),
            String::new(),
            String::new(),
            format!(
                "<strong>{}</strong>, {}",
                p_value(set),
                words(&set["verdict"])
            ),
        ]);
        rows.extend(list(set, "lines").iter().map(of_line));
    }
    if rows.is_empty() && others.is_empty() {
        return String::new();
    }
    let titles = [
        "data set",
        "number",
        "published",
        "of tosses",
        "predicted",
        "95 % of draws",
        "p-value",
    ];
    let mut told = format!(
        "<section><h2>Public data sets</h2>\n{}</section>\n",
        table(&titles, &rows)
    );
    if !others.is_empty() {
        told += &format!("<section><h2>Not validated</h2>\n<ul>{others}</ul></section>\n");
    }
    told
}

fn of_line(line: &Value) -> String {
    row(&[
        String::new(),
        format!("{}, {}", words(&line["quantity"]), words(&line["name"])),
        number(&line["seen"]),
        tosses(&line["seen_tosses"]),
        number(&line["predicted"]),
        interval(line),
        p_value(line),
    ])
}

fn table(titles: &[&str], rows: &str) -> String {
    let titles: String = titles
        .iter()
        .map(|title| format!("<th>{}</th>", text(title)))
        .collect();
    format!(
        "<div class=\"scroll\"><table><thead><tr>{titles}</tr></thead>\n<tbody>{rows}</tbody></table></div>\n"
    )
}

/// Cells that are HTML already.
fn row(cells: &[String]) -> String {
    let cells: String = cells
        .iter()
        .map(|cell| format!("<td>{cell}</td>"))
        .collect();
    format!("<tr>{cells}</tr>\n")
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
    let p = number(&of["p_value"]);
    match of["p_error"].as_f64() {
        Some(error) if error >= 5e-4 => format!("{p} ± {error:.3}"),
        _ => p,
    }
}
