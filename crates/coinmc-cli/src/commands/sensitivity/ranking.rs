//! Which unknown matters most, as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, count, decimals_for, decimals_that_show};
use crate::terminal::{grouped, in_ascii};
use coinmc_questions::{Interval, Ranked, Ranking};

pub(super) fn text(ranking: &Ranking, style: &Style) -> String {
    let face = ranking.question.face.name();
    let mut table = Table::new(vec![
        Column::left("unknown"),
        Column::right("from"),
        Column::right("to"),
        Column::left(format!("P({face}) from")),
        Column::left("to"),
        Column::left("alone").droppable(1),
        Column::left("in all"),
    ]);
    let undecided = any_undecided(ranking);
    for ranked in &ranking.numbers {
        table.push(cells(ranked, undecided));
    }
    let decimals = decimals_for(ranking.p.half_width());
    let mut text = format!(
        "P({face}) = {:.decimals$} [{:.decimals$}, {:.decimals$}] with the scene's own numbers.\n\
         Over all ranges: mean {}, standard deviation {}.\n",
        ranking.p.p,
        ranking.p.lo,
        ranking.p.hi,
        shown(&ranking.mean),
        shown(&ranking.deviation),
    );
    text += &table.render(style).text;
    text += match (ranking.deviation.lo == 0.0, undecided) {
        (true, false) => {
            "The samples are too few to show that P moves: there is no variance to divide.\n"
        }
        (true, true) => {
            "Whether P moves depends on what the undecided tosses would have shown: no ranking.\n"
        }
        (false, true) => "Every interval holds whatever the undecided tosses would have shown.\n",
        (false, false) => "",
    };
    let percent = compact(100.0 * ranking.confidence);
    let mut note = format!(
        "{}, {} tosses at each end, {} tosses in all (engine {}, {}); ± {percent} %",
        count(ranking.question.samples, "sample"),
        grouped(ranking.question.tosses),
        grouped(ranking.tosses),
        ranking.engine,
        ranking.law
    );
    if ranking.undecided > 0 {
        note += &format!("; {} of the samples' undecided", grouped(ranking.undecided));
    }
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

/// Whether any toss of the samples or of the ends is undecided.
fn any_undecided(ranking: &Ranking) -> bool {
    let ends = ranking.numbers.iter().flat_map(|ranked| ranked.undecided);
    ranking.undecided + ends.sum::<u64>() > 0
}

fn cells(ranked: &Ranked, undecided: bool) -> Vec<String> {
    let unknown = &ranked.unknown;
    let index = |index: &Option<Interval>| match index {
        Some(index) if undecided => {
            let [value, lo, hi] = [index.value, index.lo, index.hi].map(clean);
            format!("{value:.2} [{lo:.2}, {hi:.2}]")
        }
        Some(index) => format!("{:.2} ± {:.2}", clean(index.value), index.half_width()),
        None => "-".to_owned(),
    };
    vec![
        unknown.key.clone(),
        compact(unknown.from),
        compact(unknown.to),
        shown(&ranked.ends[0]),
        shown(&ranked.ends[1]),
        index(&ranked.first),
        index(&ranked.total),
    ]
}

/// Without the sign of a negative 0.
fn clean(x: f64) -> f64 {
    libm::round(100.0 * x) / 100.0 + 0.0
}

/// A number and its interval, which ends at 0 and 1.
fn shown(interval: &Interval) -> String {
    let Interval { value, lo, hi } = interval;
    let decimals = decimals_that_show(interval.half_width(), 3);
    format!("{value:.decimals$} [{lo:.decimals$}, {hi:.decimals$}]")
}
