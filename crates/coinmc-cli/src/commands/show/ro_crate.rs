//! A run directory described for an archive: the text of an `ro-crate-metadata.json`, by RO-Crate 1.1 and the
//! profile Process Run Crate 0.5.

use chrono::{DateTime, SecondsFormat, Utc};
use coinmc::run::{Contribution, Provenance, Report};
use serde_json::{Value, json};
use std::path::Path;
use std::time::SystemTime;
use std::{fs, io};

const METADATA: &str = "ro-crate-metadata.json";
const SPECIFICATION: &str = "https://w3id.org/ro/crate/1.1";
const PROFILE: &str = "https://w3id.org/ro/wfrun/process/0.5";
/// Files that a run directory may hold: name, media type, what it is.
const FILES: [(&str, &str, &str); 7] = [
    ("manifest.json", "application/json", "Which run this is"),
    (
        CONFIG,
        "application/toml",
        "The config as understood: every default spelled out",
    ),
    (
        "tallies.txt",
        "text/plain",
        "The counts of every finished chunk",
    ),
    (
        "provenance.jsonl",
        "application/jsonl",
        "Who made each chunk, and in what time",
    ),
    (
        "results.csv",
        "text/csv",
        "Probabilities with intervals, for every point",
    ),
    (
        "results.parquet",
        "application/vnd.apache.parquet",
        "The same table",
    ),
    (
        "results.partial.csv",
        "text/csv",
        "The table of a run that is not finished",
    ),
];
const CONFIG: &str = "config.toml";
/// Files that work on a run reads or keeps, and does not result in.
const NOT_RESULTS: [&str; 2] = [CONFIG, "manifest.json"];

/// A file that is there.
struct Found {
    name: &'static str,
    kind: &'static str,
    what: &'static str,
    bytes: u64,
    changed: SystemTime,
}

/// The document.
pub(super) fn document(dir: &Path, report: &Report, provenance: &Provenance) -> io::Result<Value> {
    let files = found(dir)?;
    let changed = files.iter().map(|file| file.changed).max();
    let when = DateTime::<Utc>::from(changed.unwrap_or(SystemTime::UNIX_EPOCH));
    let when = when.to_rfc3339_opts(SecondsFormat::Secs, true);
    let mut builds: Vec<&str> = Vec::new();
    let mut graph = vec![
        json!({
            "@id": METADATA,
            "@type": "CreativeWork",
            "conformsTo": {"@id": SPECIFICATION},
            "about": {"@id": "./"},
        }),
        Value::Null,
        json!({"@id": PROFILE, "@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"}),
    ];
    graph.extend(files.iter().map(file));
    let mut actions = Vec::new();
    for (number, contribution) in provenance.contributions.iter().enumerate() {
        let build = contribution.maker.build.as_str();
        let place = builds.iter().position(|known| *known == build);
        let place = place.unwrap_or_else(|| {
            builds.push(build);
            builds.len() - 1
        });
        let (action, usage) = action(number, place, contribution, &files, &when);
        actions.push(reference(action["@id"].as_str().unwrap_or_default()));
        graph.push(action);
        graph.extend(usage);
    }
    graph.extend(builds.iter().enumerate().map(software));
    graph[1] = root(report, &files, &actions, &when);
    Ok(json!({
        "@context": [
            format!("{SPECIFICATION}/context"),
            {"resourceUsage": "https://w3id.org/ro/terms/workflow-run#resourceUsage"},
        ],
        "@graph": graph,
    }))
}

fn found(dir: &Path) -> io::Result<Vec<Found>> {
    let mut all = Vec::new();
    for (name, kind, what) in FILES {
        let metadata = match fs::symlink_metadata(dir.join(name)) {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(error) => return Err(error),
        };
        if metadata.is_file() {
            all.push(Found {
                name,
                kind,
                what,
                bytes: metadata.len(),
                changed: metadata.modified()?,
            });
        }
    }
    Ok(all)
}

fn reference(id: &str) -> Value {
    json!({"@id": id})
}

fn root(report: &Report, files: &[Found], actions: &[Value], when: &str) -> Value {
    let results = &report.results;
    let points = results.rows.len();
    json!({
        "@id": "./",
        "@type": "Dataset",
        "name": format!("Tosses of a thick coin, run {}", &results.plan_hash[..8]),
        "description": format!(
            "Probabilities that a tossed thick coin lands on heads, tails or its side, with intervals, as coinmc \
             computed them: {points} points, {} tosses. config.toml says of which coin, surface and launch.",
            report.tosses
        ),
        "datePublished": when,
        // one must be there, and only who publishes the run knows it
        "license": "Not stated: ask those who made the run.",
        "identifier": results.plan_hash,
        "conformsTo": {"@id": PROFILE},
        "hasPart": files.iter().map(|file| reference(file.name)).collect::<Vec<_>>(),
        // a list of one is written as that one
        "mentions": if let [one] = actions { one.clone() } else { json!(actions) },
    })
}

fn file(file: &Found) -> Value {
    json!({
        "@id": file.name,
        "@type": "File",
        "name": file.name,
        "description": file.what,
        "encodingFormat": file.kind,
        "contentSize": file.bytes.to_string(),
    })
}

fn software((place, build): (usize, &&str)) -> Value {
    json!({
        "@id": software_id(place),
        "@type": "SoftwareApplication",
        "name": "coinmc",
        "description": "Says how likely a tossed thick coin lands on heads, tails or its side",
        "softwareVersion": build,
    })
}

fn software_id(place: usize) -> String {
    format!("#build-{}", place + 1)
}

/// What a build on a kind of machine did, and what it used for it.
fn action(
    number: usize,
    build: usize,
    contribution: &Contribution,
    files: &[Found],
    when: &str,
) -> (Value, Vec<Value>) {
    let id = format!("#work-{}", number + 1);
    let maker = &contribution.maker;
    let results = files
        .iter()
        .filter(|file| !NOT_RESULTS.contains(&file.name));
    let used = [
        ("processor", json!(maker.cpu), ""),
        ("lanes", json!(maker.lanes), ""),
        ("target", json!(maker.target), ""),
        ("features", json!(maker.features.join(" ")), ""),
        ("chunks", json!(contribution.chunks), ""),
        ("tosses", json!(contribution.tosses), ""),
        ("wall time", json!(contribution.wall.as_secs_f64()), "s"),
        (
            "processor time",
            json!(contribution.processor.map(|time| time.as_secs_f64())),
            "s",
        ),
    ];
    let used = used.iter().filter(|(_, value, _)| !value.is_null());
    let usage = used.map(|(name, value, unit)| {
        let mut property = json!({
            "@id": format!("{id}-{}", name.replace(' ', "-")),
            "@type": "PropertyValue",
            "name": name,
            "value": value,
        });
        if !unit.is_empty() {
            property["unitText"] = json!(unit);
        }
        property
    });
    let usage: Vec<Value> = usage.collect();
    let ids = usage.iter().filter_map(|property| property["@id"].as_str());
    let ids: Vec<Value> = ids.map(reference).collect();
    let action = json!({
        "@id": id,
        "@type": "CreateAction",
        "name": format!("Tosses by coinmc {}", maker.build),
        "instrument": reference(&software_id(build)),
        "description": "Computed chunks of the run: tosses, or integrals of points",
        "object": reference(CONFIG),
        "result": results.map(|file| reference(file.name)).collect::<Vec<_>>(),
        "endTime": when,
        "resourceUsage": ids,
    });
    (action, usage)
}
