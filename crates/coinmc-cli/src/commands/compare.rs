//! `coinmc compare`: counts of real tosses against a model.

use super::show::unfinished;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use crate::terminal::progress::Progress;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, count, grouped, in_ascii, with_interval};
use anyhow::anyhow;
use clap::Args;
use coinmc::plan::Plan;
use coinmc::results::Results;
use coinmc::run::stored_report;
use coinmc_core::{Estimate, Face};
use coinmc_questions::{self as questions, Compared, Comparison, Model, TEST};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc compare runs/wood --counts 210,190,100     heads, tails, side
  coinmc compare runs/wood runs/felt --counts 210,190,100
  coinmc compare runs/model --journal day           the throws of a robot

p-value    probability, if the point is right, of counts no more probable than these: an exact test
           that knows the point's own error
evidence   log10 of the Bayes factor for it, against a coin of which nothing is known
share      its probability, if one of the points is right
tells      tosses after which a test at 5 % rejects it in 80 % of experiments, if the first point is
           right (for the first: if the shares counted are)";

/// Rows that are shown unless all are asked for.
const SHOWN: usize = 20;
/// A p-value below this is told as such: what is left out of the sum is of that size.
const LEAST_P: f64 = 1e-12;

/// Compare counts of real tosses with the points of runs
///
/// Tests each point by an exact test, weighs the points against each other, and tells how many tosses would
/// tell them apart. Tosses of a point that left the table or are undecided are left out; a point is contradicted
/// only if it is whatever its undecided tosses would have shown.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Compare {
    /// Run directories
    #[arg(required = true, value_name = "DIR")]
    runs: Vec<PathBuf>,

    /// How many tosses showed heads, tails and the side
    #[arg(
        long,
        value_name = "HEADS,TAILS,SIDE",
        value_parser = counts,
        allow_hyphen_values = true
    )]
    #[cfg_attr(
        feature = "robot",
        arg(required_unless_present = "journal", conflicts_with = "journal")
    )]
    #[cfg_attr(not(feature = "robot"), arg(required = true))]
    counts: Option<[u64; 3]>,

    /// Directory of a robot's experiment, whose throws are counted
    #[cfg(feature = "robot")]
    #[arg(long, value_name = "DIR")]
    journal: Option<PathBuf>,

    /// Confidence of the intervals of the counts
    #[arg(long, value_name = "C", default_value_t = 0.95, value_parser = confidence)]
    confidence: f64,

    /// Show all points, not only the 20 most likely
    #[arg(long)]
    all: bool,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// Three whole numbers.
fn counts(text: &str) -> Result<[u64; 3], String> {
    let numbers: Option<Vec<u64>> = text
        .split(',')
        .map(|number| super::count(number.trim()).ok())
        .collect();
    numbers
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| {
            "expected the numbers of heads, tails and sides, each 0 or more, as in 210,190,100"
                .to_owned()
        })
}

fn confidence(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|c| *c > 0.0 && *c < 1.0);
    number.ok_or_else(|| "expected a number above 0 and below 1".to_owned())
}

impl Compare {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let runs = self.stored(&Progress::new(*console.stderr(), true))?;
        let models: Vec<Model<'_>> = runs
            .iter()
            .flat_map(|(run, results)| results.rows.iter().map(move |row| Model { run, row }))
            .collect();
        let (counts, voids) = self.counted()?;
        let answer = questions::compare(counts, &models, self.confidence)?;
        match console.format() {
            Format::Json => output::print_json(&questions::document_of_comparison(&answer, voids)),
            Format::Table => output::print(&self.text(&answer, &runs, voids, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }

    /// The runs by their names. What is missing of one is told.
    fn stored(&self, progress: &Progress) -> Result<Vec<(String, Results)>, Failure> {
        let mut plans: Vec<(String, Plan)> = vec![];
        let mut runs = vec![];
        for dir in &self.runs {
            let (plan, report) = stored_report(dir, progress)?;
            let name = dir.display().to_string();
            if let Some((first, _)) = plans.iter().find(|(_, other)| other.hash() == plan.hash()) {
                return Err(Failure::Input(anyhow!(
                    "{first} and {name} are of the same run, which would count twice: name it once, and join its \
                     parts with `coinmc merge`"
                )));
            }
            if let Some(remark) = unfinished(&report) {
                output::note(&of_run(&name, &remark));
            }
            plans.push((name.clone(), plan));
            runs.push((name, report.results));
        }
        Ok(runs)
    }

    /// The counts, and the void throws of a robot.
    #[cfg(feature = "robot")]
    fn counted(&self) -> Result<([u64; 3], Option<u64>), Failure> {
        use coinmc_robot::journal::Resolution;
        let Some(directory) = &self.journal else {
            return Ok((self.counts.expect("clap requires one of the two"), None));
        };
        let (_, history) = super::robot::read(directory)?;
        let (mut counts, mut voids) = ([0; 3], 0);
        for throw in history.throws() {
            match (&throw.reading, throw.resolution) {
                (Some((reading, _)), Some(Resolution::Done)) => counts[reading.face as usize] += 1,
                (_, Some(_)) => voids += 1,
                // still being thrown
                (_, None) => {}
            }
        }
        Ok((counts, Some(voids)))
    }

    #[cfg(not(feature = "robot"))]
    #[allow(clippy::unnecessary_wraps, reason = "a journal may be unreadable")]
    fn counted(&self) -> Result<([u64; 3], Option<u64>), Failure> {
        Ok((self.counts.expect("clap requires it"), None))
    }

    fn text(
        &self,
        answer: &Comparison<'_>,
        runs: &[(String, Results)],
        voids: Option<u64>,
        style: &Style,
    ) -> String {
        let [heads, tails, side] = answer.counts.map(grouped);
        let headline = format!(
            "{} {}: {heads} heads, {tails} tails, {side} on the side",
            grouped(answer.tosses()),
            if answer.tosses() == 1 {
                "toss"
            } else {
                "tosses"
            }
        );
        let mut text = style.paint(Colors::Strong, &headline) + "\n";
        if let Some(voids) = voids.filter(|voids| *voids > 0) {
            text += &format!(
                "{} void throws are left out: they can hide a bias as large as their share\n",
                grouped(voids)
            );
        }
        let shown = if self.all {
            answer.models.len()
        } else {
            SHOWN.min(answer.models.len())
        };
        text += &table(answer, shown, runs, style);
        let hidden = answer.models.len() - shown;
        if hidden > 0 {
            text += &format!("{} less likely points: --all\n", grouped(hidden as u64));
        }
        text += &left_out(answer);
        text += &verdict(answer);
        if style.unicode { text } else { in_ascii(&text) }
    }
}

/// A remark of the program with the run that it is about.
fn of_run(name: &str, remark: &str) -> String {
    format!("coinmc: {name}: {remark}")
}

fn table(
    answer: &Comparison<'_>,
    shown: usize,
    runs: &[(String, Results)],
    style: &Style,
) -> String {
    // what tells the points apart: the run, and whatever any run sweeps
    let mut axes: Vec<&str> = vec![];
    for axis in runs.iter().flat_map(|(_, results)| &results.axes) {
        if !axes.contains(&axis.as_str()) {
            axes.push(axis);
        }
    }
    let mut columns = vec![Column::left(if runs.len() > 1 { "run" } else { "" })];
    columns.extend(axes.iter().map(|axis| Column::right(*axis)));
    columns.extend(["P(heads)", "P(tails)"].map(|title| Column::right(title).droppable(1)));
    columns.push(Column::right("P(side)"));
    let any_without_face = has_any_without_face(answer);
    // of the tosses without a face it says of how many they are
    columns.push(Column::right(if any_without_face {
        "no face"
    } else {
        "tosses"
    }));
    columns.push(Column::right("p-value"));
    columns.push(Column::right("evidence"));
    columns.push(Column::right("share").droppable(3));
    columns.push(Column::right("tells").droppable(2));
    let mut table = Table::new(columns);
    let blank = |count: usize| std::iter::repeat_n(String::new(), count);
    let mut counted = vec!["counted".to_owned()];
    counted.extend(blank(axes.len()));
    counted.extend(answer.seen.iter().map(probability));
    counted.push(if any_without_face {
        String::new()
    } else {
        grouped(answer.tosses())
    });
    counted.extend(blank(4));
    table.push(counted);
    for compared in &answer.models[..shown] {
        table.push(cells(compared, &axes, runs.len() > 1, any_without_face));
    }
    table.render(style).text
}

fn has_any_without_face(answer: &Comparison<'_>) -> bool {
    answer.models.iter().any(|model| model.without_face() > 0)
}

fn cells(compared: &Compared<'_>, axes: &[&str], named: bool, without_face: bool) -> Vec<String> {
    let row = compared.model.row;
    let name = if named {
        compared.model.run.to_owned()
    } else {
        "model".to_owned()
    };
    let parameter = |name: &&str| row.parameter(name).map_or("-".to_owned(), compact);
    let mut cells = vec![name];
    cells.extend(axes.iter().map(parameter));
    cells.extend(Face::ALL.map(|face| probability(&compared.estimate(face))));
    let all = grouped(compared.model.row.tally.tosses());
    cells.push(if without_face {
        format!("{} of {all}", grouped(compared.without_face()))
    } else {
        all
    });
    cells.push(p_values(compared));
    cells.push(format!("{:+.1}", compared.evidence));
    cells.push(format!("{:.3}", compared.share));
    cells.push(compared.tosses_to_tell.map_or("-".to_owned(), grouped));
    cells
}

fn probability(estimate: &Estimate) -> String {
    if estimate.n == 0 {
        format!("{:.3}", estimate.p)
    } else {
        with_interval(estimate, 3, "±")
    }
}

/// The p-value, and that with the most favourable faces of undecided tosses.
fn p_values(compared: &Compared<'_>) -> String {
    let own = p_value(compared.p_value);
    if compared.p_value_at_best > compared.p_value {
        return format!("{own} to {}", p_value(compared.p_value_at_best));
    }
    own
}

fn p_value(p: f64) -> String {
    if p < LEAST_P {
        format!("< {LEAST_P:e}")
    } else if p < 1e-3 {
        format!("{p:.1e}")
    } else {
        format!("{p:.3}")
    }
}

/// Points and tosses that are left out.
fn left_out(answer: &Comparison<'_>) -> String {
    let mut text = String::new();
    if answer.left_out > 0 {
        let points = count(answer.left_out as u64, "point");
        text += &format!("{points} without a toss that shows a face: left out\n");
    }
    if has_any_without_face(answer) {
        text += "Tosses without a face are undecided or off the table, and left out: the second p-value is with the \
                 faces of\nthe undecided ones that agree best with the counts\n";
    }
    text
}

/// What it comes to, in words.
fn verdict(answer: &Comparison<'_>) -> String {
    let models = &answer.models;
    let alpha = TEST.false_alarm;
    // as many false alarms as with one test, however many points there are (Bonferroni)
    let level = alpha / models.len() as f64;
    let rejected = models.iter().filter(|model| model.is_rejected(level));
    let open = models.iter().filter(|model| model.is_open(level));
    let (rejected, open) = (rejected.count(), open.count());
    let among = if models.len() > 1 {
        format!(", shared out over {} points", models.len())
    } else {
        String::new()
    };
    let percent = compact(100.0 * alpha);
    let mut text = match (rejected, models.len()) {
        (0, 1) if open == 1 => String::new(),
        (0, 1) => format!("The counts do not contradict it (test at {percent} %)\n"),
        (1, 1) => format!("The counts contradict it (test at {percent} %)\n"),
        (rejected, all) => format!(
            "The counts contradict {} of {} points (test at {percent} %{among})\n",
            grouped(rejected as u64),
            grouped(all as u64)
        ),
    };
    if open > 0 {
        let whose = if models.len() == 1 {
            "it".to_owned()
        } else {
            count(open as u64, "other point")
        };
        text += &format!(
            "Whether they contradict {whose} depends on what undecided tosses would have shown\n"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::{config, plan::StoppedBy, results::Row};
    use coinmc_core::Tally;

    fn told(counts: [u64; 3]) -> (String, String) {
        let text = "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 2000";
        let plan = config::parse("inline", text, &[]).expect("a plan");
        let tally = Tally {
            heads: 630,
            tails: 640,
            side: 50,
            impact_limit: 680,
            ..Tally::default()
        };
        let rows =
            [tally, Tally::default()].map(|tally| Row::new(&plan, 0, tally, StoppedBy::Tosses));
        let models = rows.each_ref().map(|row| Model { run: "run", row });
        let answer = questions::compare(counts, &models, 0.95).expect("an answer");
        let cells = cells(&answer.models[0], &[], false, true);
        (cells.join("; "), left_out(&answer) + &verdict(&answer))
    }

    #[test]
    fn undecided_tosses_of_a_model_are_told_and_decide() {
        let (cells, words) = told([10, 10, 10]);
        assert!(
            cells.contains("; 680 of 2 000; ") && cells.contains(" to 1.000; "),
            "{cells}"
        );
        assert!(
            words.contains("1 point without a toss that shows a face: left out\n"),
            "{words}"
        );
        assert!(
            words.contains("\nWhether they contradict it depends on"),
            "{words}"
        );
        assert!(!words.contains("The counts contradict"), "{words}");
        let (_, words) = told([0, 0, 30]);
        assert!(
            words.ends_with("The counts contradict it (test at 5 %)\n"),
            "{words}"
        );
        let (_, words) = told([15, 15, 1]);
        assert!(
            words.ends_with("The counts do not contradict it (test at 5 %)\n"),
            "{words}"
        );
    }

    #[test]
    fn a_remark_names_its_run() {
        assert_eq!(
            of_run("r1", "this run is unfinished"),
            "coinmc: r1: this run is unfinished"
        );
    }
}
