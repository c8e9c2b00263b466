//! Which unknown matters most, as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, count, decimals_for, grouped, in_ascii};
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
    for ranked in &ranking.numbers {
        table.push(cells(ranked));
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
    if ranking.deviation.lo == 0.0 {
        text += "The tosses do not show that P moves at all: it has no variance to divide.\n";
    }
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
        note += &format!("; {} without a face", grouped(ranking.undecided));
    }
    text += &format!("{}\n", style.paint(Colors::Faint, &note));
    if style.unicode { text } else { in_ascii(&text) }
}

fn cells(ranked: &Ranked) -> Vec<String> {
    let unknown = &ranked.unknown;
    let index = |index: &Option<Interval>| match index {
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

fn shown(interval: &Interval) -> String {
    format!("{:.3} ± {:.3}", interval.value, interval.half_width())
}
